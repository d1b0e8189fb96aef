//! What the mount answers: each reply by itself, and whole conversations in which a simulated mount answers well and the line
//! loses, changes and adds bytes.

use std::time::Duration;

use scotopic::hw::mount::belief::{LinkState, Precision};
use scotopic::hw::mount::command::{Command, Question};
use scotopic::hw::mount::driver::{Driver, Ours, Settings, Timing};
use scotopic::hw::mount::frame::{Framer, LONGEST, Step};
use scotopic::hw::mount::order::{Direction, Key, Order, Rate};
use scotopic::hw::mount::reply::{Reply, parse};
use scotopic::hw::mount::sim::{self, Simulator};
use scotopic::hw::mount::table;
use scotopic::hw::port::PortError;
use scotopic::sky::coords::Equatorial;
use scotopic::units::Angle;

use super::assert_harmless;
use super::script::Script;

/// A conversation ends after this time, so that many can be had.
const ENOUGH: Duration = Duration::from_secs(15);

/// Checks one input: the first byte says whether it is a reply or a conversation.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    match data.split_first() {
        Some((0, reply)) => every_reading_of(reply),
        Some((_, script)) => Conversation::new().play(Script(script)),
        None => {}
    }
}

/// Every command whose answer is read in a way of its own.
fn commands() -> Vec<Command> {
    let here = Angle::degrees(10.0);
    let mut all = vec![
        Command::Ack,
        Command::Product,
        Command::Status,
        Command::Fence,
        Command::Ra,
        Command::Dec,
        Command::Bars,
        Command::Date,
        Command::Time,
        Command::Sidereal,
        Command::Zone,
        Command::Latitude,
        Command::Longitude,
        Command::Summer,
        Command::TargetRa(here, Precision::Long),
        Command::SetDate(0),
        Command::Slew,
        Command::Sync,
        Command::Display,
        Command::Stop,
    ];
    all.extend(["GT", "GVD", "P"].into_iter().filter_map(|letters| Question::new(letters).ok().map(Command::Ask)));
    all
}

fn every_reading_of(bytes: &[u8]) {
    for command in commands() {
        let mut framer = Framer::new(command.shape());
        for byte in bytes {
            if framer.push(*byte) != Step::More {
                break;
            }
        }
        assert!(framer.reply().len() <= LONGEST);
        for read in [bytes, framer.reply()] {
            if let Some(reply) = parse(&command, read) {
                reads_sensibly(&reply);
            }
        }
    }
}

/// A reply that was believed lies where such a thing can lie.
fn reads_sensibly(reply: &Reply) {
    let within = |angle: &Angle, low: f64, high: f64| {
        assert!((low..=high).contains(&angle.to_degrees()), "{reply:?} is out of range");
    };
    match reply {
        Reply::Ra(angle, _) | Reply::Sidereal(angle) => within(angle, 0.0, 360.0),
        Reply::Dec(angle, _) | Reply::Latitude(angle) => within(angle, -90.0, 90.0),
        Reply::Longitude(angle) => within(angle, -360.0, 360.0),
        Reply::Time(seconds) => assert!(*seconds < 86_400),
        Reply::HoursToUtc(hours) => assert!(hours.abs() <= 24.0, "{hours} hours to UTC"),
        Reply::Text(text) | Reply::SlewRefused(text) => assert_harmless(text),
        Reply::Display(display) => {
            assert_harmless(&display.top);
            assert_harmless(&display.bottom);
        }
        _ => {}
    }
}

/// A driver, a simulated mount, and a bad line between them.
struct Conversation {
    driver: Driver,
    mount: Simulator,
    now: Duration,
}

impl Conversation {
    fn new() -> Conversation {
        let simulated = sim::settings::Settings::default();
        let ours = Ours { utc_at_start: simulated.start, site: Some(simulated.site) };
        let driver = Driver::new(Settings::new(Timing::SERIAL, ours));
        let mut conversation = Conversation { driver, mount: Simulator::new(simulated), now: Duration::ZERO };
        conversation.open();
        conversation
    }

    fn play(mut self, mut script: Script<'_>) {
        while self.now < ENOUGH {
            let Some(what) = script.byte() else { break };
            let (what, how) = (what & 7, usize::from(what >> 3));
            match what {
                0 => self.hear(script.bytes(how + 1)),
                1 => self.wait(Duration::from_millis(10 << (how % 10)), None),
                2 => self.order(how, &mut script),
                3 => self.wait(Duration::from_millis(40 * (how as u64 + 1)), Some((0, Change::None))),
                4 => {
                    let change = Change::of(script.byte(), script.byte());
                    self.wait(Duration::from_millis(500), Some((how, change)));
                }
                5 => {
                    self.driver.link_lost(PortError::NotThere { name: "line".into() }, self.now);
                    assert!(self.driver.drain().is_empty(), "bytes for a line that is gone");
                    self.now += Duration::from_millis(20 * how as u64);
                    self.open();
                }
                6 => self.wait(Duration::from_secs(3), Some((0, Change::None))),
                _ => self.hear(script.bytes(1)),
            }
            self.look();
        }
    }

    /// Opens the line; a stop that is still owed goes out first.
    fn open(&mut self) {
        let owed = self.driver.belief().stopping;
        self.driver.link_opened(self.now);
        self.mount.client_came(self.now);
        let first = self.drain();
        assert!(!owed || first.starts_with(b"#:Q#"), "a stop was owed, and {first:?} went out first");
    }

    fn hear(&mut self, bytes: &[u8]) {
        self.driver.feed(bytes, self.now);
        self.drain();
    }

    fn order(&mut self, how: usize, script: &mut Script<'_>) {
        let mut angle = |full: f64| Angle::degrees(full * f64::from(script.byte().unwrap_or(0)) / 255.0);
        let direction = Direction::ALL[how % 4];
        let order = match how {
            0..=7 => Order::Stop,
            8..=11 => Order::Goto(Equatorial::new(angle(360.0), angle(180.0) - Angle::degrees(90.0))),
            12..=13 => Order::Sync(Equatorial::new(angle(360.0), angle(180.0) - Angle::degrees(90.0))),
            14..=17 => Order::Move(direction, Rate::Find),
            18..=21 => Order::MoveEnd(direction),
            22 => Order::ReadDisplay,
            23 => Order::PressKey(Key::Help),
            24 => Order::Compare,
            25 => Order::SetSite(sim::settings::Settings::default().site),
            26 => Order::SetClock(sim::settings::Settings::default().start, 1.0),
            _ => match Question::new("GT") {
                Ok(question) => Order::Ask(question),
                Err(_) => return,
            },
        };
        let open = !matches!(self.driver.belief().link, LinkState::Closed | LinkState::Silent | LinkState::Looped);
        let stop = order == Order::Stop;
        self.driver.order(order, self.now);
        let sent = self.drain();
        assert!(!(stop && open) || sent.starts_with(b"#:Q#"), "a stop was ordered, and {sent:?} was sent");
    }

    /// Lets time pass, with a mount that answers, the n-th byte of it changed, or with nobody there.
    fn wait(&mut self, time: Duration, mut answers: Option<(usize, Change)>) {
        let end = self.now + time;
        while self.now < end {
            let mount = answers.as_ref().and_then(|_| self.mount.wake_at()).unwrap_or(Duration::MAX);
            let next = self.driver.wake_at().min(mount);
            self.now = next.max(self.now + Duration::from_millis(1)).min(end);
            self.driver.tick(self.now);
            let sent = self.drain();
            if let Some((left, change)) = &mut answers {
                self.mount.feed(&sent, self.now);
                let heard = change.apply(self.mount.drain(self.now), left);
                self.hear(&heard);
            }
            if self.driver.wants_reopening() {
                self.now += Duration::from_millis(250);
                self.open();
            }
        }
    }

    /// The bytes for the mount: never one of the commands that are never sent.
    fn drain(&mut self) -> Vec<u8> {
        let sent = self.driver.drain();
        assert!(sent.len() <= 256, "{} bytes at once", sent.len());
        for command in sent.split_inclusive(|byte| *byte == b'#') {
            let command = command.strip_prefix(b"\x06").unwrap_or(command);
            if !matches!(command, b"" | b"#") {
                assert_eq!(table::forbidden(command), None, "{command:?} was sent");
            }
        }
        sent
    }

    /// What is reported can be shown, and what is believed can be.
    fn look(&mut self) {
        while let Some(report) = self.driver.poll() {
            assert_harmless(&report.to_string());
        }
        let belief = self.driver.belief();
        if let Some(position) = belief.position.value() {
            assert!((0.0..360.0 + 1e-9).contains(&position.ra().to_degrees()), "{position:?}");
            assert!(position.dec().to_degrees().abs() <= 90.0 + 1e-9, "{position:?}");
        }
    }
}

/// What the line does to a byte.
enum Change {
    None,
    Drop,
    Double,
    Flip(u8),
    Insert(u8),
}

impl Change {
    fn of(kind: Option<u8>, byte: Option<u8>) -> Change {
        let byte = byte.unwrap_or(0);
        match kind.unwrap_or(0) % 5 {
            0 => Change::None,
            1 => Change::Drop,
            2 => Change::Double,
            3 => Change::Flip(byte | 1),
            _ => Change::Insert(byte),
        }
    }

    /// Changes the byte that is `left` bytes away, if it is among these.
    fn apply(&self, mut bytes: Vec<u8>, left: &mut usize) -> Vec<u8> {
        let at = *left;
        *left = left.saturating_sub(bytes.len());
        if at >= bytes.len() || (at == 0 && matches!(self, Change::None)) {
            return bytes;
        }
        *left = usize::MAX;
        match self {
            Change::None => {}
            Change::Drop => drop(bytes.remove(at)),
            Change::Double => bytes.insert(at, bytes[at]),
            Change::Flip(mask) => bytes[at] ^= mask,
            Change::Insert(byte) => bytes.insert(at, *byte),
        }
        bytes
    }
}
