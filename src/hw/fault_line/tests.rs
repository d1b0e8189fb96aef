//! A bad cable between a test and a far end that repeats a script.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use super::{Cable, FaultLine, Mischief, Side, Spell, When};
use crate::hw::port::{Port, PortError};

/// The far end: what it was sent, and what it has to say.
#[derive(Debug, Clone, Default)]
struct FarEnd(Arc<Mutex<(Vec<u8>, VecDeque<u8>)>>);

impl FarEnd {
    fn says(&self, bytes: &[u8]) {
        self.0.lock().unwrap().1.extend(bytes);
    }

    fn heard(&self) -> Vec<u8> {
        self.0.lock().unwrap().0.clone()
    }
}

impl Port for FarEnd {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let mut inside = self.0.lock().unwrap();
        let count = buffer.len().min(inside.1.len());
        for place in &mut buffer[..count] {
            *place = inside.1.pop_front().unwrap();
        }
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.0.lock().unwrap().0.extend(bytes);
        Ok(bytes.len())
    }
}

const ALWAYS: Duration = Duration::from_secs(1000);

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn line(baud: Option<u32>, spells: Vec<Spell>) -> (Cable, FarEnd, FaultLine<FarEnd>) {
    let (cable, far) = (Cable::new(1, baud, spells), FarEnd::default());
    let line = cable.open(|_| Ok(far.clone())).unwrap();
    (cable, far, line)
}

fn always(mischief: Mischief) -> Vec<Spell> {
    vec![Spell::at(Duration::ZERO, ALWAYS, mischief)]
}

fn read(line: &mut FaultLine<FarEnd>) -> Vec<u8> {
    let mut buffer = [0; 4096];
    let count = line.receive(&mut buffer).unwrap();
    buffer[..count].to_vec()
}

#[test]
fn a_good_cable_changes_nothing() {
    let (cable, far, mut line) = line(None, Vec::new());
    line.set_now(ms(1));
    assert_eq!(line.send(b":GR#"), Ok(4));
    far.says(b"05:29:28#");
    assert_eq!((read(&mut line), far.heard()), (b"05:29:28#".to_vec(), b":GR#".to_vec()));
    assert_eq!(cable.ledger().struck.iter().sum::<u64>(), 0);
}

#[test]
fn bytes_take_a_tenth_of_the_baud_rate_both_ways() {
    // 9600 baud, 8N1: ten bits, 1.0417 ms a byte; :GR# is out after 4.2 ms.
    let (_, far, mut line) = line(Some(9600), Vec::new());
    line.send(b":GR#").unwrap();
    for (at_us, out) in [(1_000, 0), (1_050, 1), (4_100, 3), (4_200, 4)] {
        line.set_now(Duration::from_micros(at_us));
        assert_eq!(far.heard().len(), out, "after {at_us} us");
    }
    far.says(b"05:29:28#");
    assert!(read(&mut line).is_empty());
    line.set_now(Duration::from_micros(4_200 + 9_300));
    assert_eq!(read(&mut line).len(), 8);
    line.set_now(Duration::from_micros(4_200 + 9_400));
    assert_eq!(read(&mut line), b"#");
}

#[test]
fn each_mischief_does_what_its_name_says() {
    for (mischief, expected) in [
        (Mischief::Drop(1.0), &b""[..]),
        (Mischief::Duplicate(1.0), b"11##"),
        (Mischief::Truncate(1), b"1"),
        (Mischief::MidPacket(1), b"#"),
        (Mischief::Break, b"\0"),
        (Mischief::Unasked(1.0), b"1#$GPRMC,235959.00,V,,,,,,,010100,,,N*7F\r\n"),
    ] {
        let (cable, far, mut line) = line(None, always(mischief));
        far.says(b"1#");
        assert_eq!(read(&mut line), expected, "{}", mischief.name());
        assert!(cable.ledger().struck[mischief.index()] > 0, "{}", mischief.name());
    }
    let (_, far, mut line) = line(None, always(Mischief::Flip(1.0)));
    far.says(b"1");
    assert_eq!((read(&mut line)[0] ^ b'1').count_ones(), 1);
}

#[test]
fn a_stalled_reply_goes_on_late_and_a_delayed_one_begins_late() {
    let (_, far, mut held) = line(None, always(Mischief::Stall(2, ms(700))));
    far.says(b"05:29#");
    assert_eq!(read(&mut held), b"05");
    held.set_now(ms(699));
    assert!(read(&mut held).is_empty());
    held.set_now(ms(700));
    assert_eq!(read(&mut held), b":29#");
    let (_, far, mut late) = line(None, always(Mischief::Delay(ms(500))));
    far.says(b"05:29#");
    assert!(read(&mut late).is_empty());
    late.set_now(ms(500));
    assert_eq!(read(&mut late), b"05:29#");
}

#[test]
fn a_swapped_reply_is_the_one_before_and_glued_ones_come_at_once() {
    let (_, far, mut line1) = line(None, always(Mischief::Swap(1.0)));
    far.says(b"A");
    assert_eq!(read(&mut line1), b"A");
    line1.send(b":GR#").unwrap();
    far.says(b"05:29:28#");
    assert_eq!(read(&mut line1), b"A");
    let (_, far, mut line2) = line(None, vec![Spell::at(Duration::ZERO, ms(10), Mischief::Glue(1.0))]);
    far.says(b"A");
    assert!(read(&mut line2).is_empty());
    line2.set_now(ms(20));
    line2.send(b":GR#").unwrap();
    far.says(b"05:29:28#");
    assert_eq!(read(&mut line2), b"A05:29:28#");
}

#[test]
fn a_flood_has_its_size_and_no_hash() {
    let (_, _, mut line) = line(None, always(Mischief::Flood(10_000)));
    let mut flooded = Vec::new();
    loop {
        let bytes = read(&mut line);
        if bytes.is_empty() {
            break;
        }
        flooded.extend(bytes);
    }
    assert_eq!(flooded.len(), 10_000);
    assert!(!flooded.contains(&b'#'));
}

#[test]
fn a_renamed_port_is_not_there_and_then_there_under_the_next_number() {
    let spell = Spell { when: When::Sent(ms(0), b":MS#".to_vec()), ..Spell::at(ms(0), ms(500), Mischief::Rename) };
    let (cable, far, mut line) = line(None, vec![spell]);
    line.set_now(ms(100));
    // The cable comes out with the last byte of :MS#: what comes behind it never leaves.
    assert_eq!(line.send(b":MS#:GR#"), Ok(4));
    assert_eq!(far.heard(), b":MS#");
    assert!(matches!(line.receive(&mut [0; 8]), Err(PortError::Unplugged { .. })));
    assert!(matches!(cable.open(|_| Ok(far.clone())), Err(PortError::NotThere { .. })));
    cable.set_now(ms(600));
    let mut number = None;
    cable
        .open(|n| {
            number = Some(n);
            Ok(far.clone())
        })
        .unwrap();
    assert_eq!(number, Some(1));
}

#[test]
fn a_port_that_is_held_or_forbidden_says_so() {
    for (mischief, held) in [(Mischief::Hold, true), (Mischief::Forbid, false)] {
        let cable = Cable::new(1, None, always(mischief));
        let error = cable.open(|_| Ok(FarEnd::default())).unwrap_err();
        assert_eq!(matches!(error, PortError::Held { .. }), held);
        assert_eq!(matches!(error, PortError::Permission { .. }), !held);
    }
}

#[test]
fn a_slow_port_takes_its_bytes_a_second_and_a_full_one_none() {
    let (_, far, mut line) = line(None, always(Mischief::Slow(10)));
    line.set_now(ms(200));
    assert_eq!(line.send(b":GR#"), Ok(2));
    assert_eq!(line.send(b"R#"), Ok(0));
    line.set_now(ms(400));
    assert_eq!(line.send(b"R#"), Ok(2));
    assert_eq!(far.heard(), b":GR#");
}

#[test]
fn a_device_that_opening_restarts_is_deaf_for_two_seconds_and_says_x() {
    let (_, far, mut line) = line(None, always(Mischief::Reset));
    line.set_now(ms(100));
    line.send(b":GR#").unwrap();
    far.says(b"05:29:28#");
    assert!(read(&mut line).is_empty());
    assert!(far.heard().is_empty());
    line.set_now(ms(2100));
    assert_eq!(read(&mut line), b"X");
}

#[test]
fn one_seed_makes_one_conversation() {
    let play = |seed| {
        let cable =
            Cable::new(seed, None, vec![Spell { side: Side::Both, ..Spell::at(ms(0), ALWAYS, Mischief::Flip(0.2)) }]);
        let far = FarEnd::default();
        let mut line = cable.open(|_| Ok(far.clone())).unwrap();
        far.says(&[b'0'; 64]);
        line.send(&[b'1'; 64]).unwrap();
        (read(&mut line), far.heard())
    };
    assert_eq!(play(3), play(3));
    assert_ne!(play(3), play(4));
}
