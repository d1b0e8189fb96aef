//! Conversations with a peer whose bytes are written by hand, from captures and papers: never by our own encoder.
//!
//! The peer fails on surprise (a command that the script does not have) and on silence (a command that never comes).

mod line;
mod orders;
mod stop;

use std::collections::BTreeMap;
use std::time::Duration;

use super::{Driver, Ours, Settings, Timing};
use crate::hw::mount::order::Report;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

const STEP: Duration = Duration::from_millis(1);

/// A driver, its clock, and the mount at the other end: a table of replies that the test may change as it goes.
struct Peer {
    driver: Driver,
    now: Duration,
    /// Command bytes and the reply to them; a command that is not in the table is a surprise.
    replies: BTreeMap<Vec<u8>, Vec<u8>>,
    /// Everything that was sent, with its time.
    sent: Vec<(Duration, Vec<u8>)>,
    reports: Vec<Report>,
    delay: Duration,
    pending: Vec<(Duration, Vec<u8>)>,
}

/// What a real LX200GPS, firmware 4.2l, said in the capture of 2023 (alignment and `:D#` by the papers).
const CAPTURED: &[(&[u8], &[u8])] = &[
    (b"\x06", b"A"),
    (b":GVP#", b"LX2001#"),
    (b":GVN#", b"4.2l#"),
    (b":GW#", b"AT2"),
    (b":GR#", b"05:29:28#"),
    (b":GD#", b"+37\xDF17:16#"),
    (b":D#", b"#"),
    (b":G0#", b"#"),
    (b":Gt#", b"+52\xDF10:44#"),
    (b":Gg#", b"354\xDF36:54#"),
    (b":GG#", b"-01#"),
    (b":GH#", b"1"),
    (b":GC#", b"09/07/23#"),
    (b":GL#", b"20:01:31#"),
    (b":GS#", b"17:29:15#"),
];

fn ours() -> Ours {
    let utc_at_start = Utc::from_rfc3339("2023-09-07T18:01:30Z").unwrap();
    Ours { utc_at_start, site: Some(Site::new(52.18, 5.385, 20.0).unwrap()) }
}

fn place(ra_deg: f64, dec_deg: f64) -> Equatorial<OfDate> {
    Equatorial::new(Angle::degrees(ra_deg), Angle::degrees(dec_deg))
}

impl Peer {
    /// The captured mount on a fresh line.
    fn captured() -> Peer {
        let mut peer = Peer {
            driver: Driver::new(Settings::new(Timing::SERIAL, ours())),
            now: Duration::ZERO,
            replies: CAPTURED.iter().map(|(command, reply)| (command.to_vec(), reply.to_vec())).collect(),
            sent: Vec::new(),
            reports: Vec::new(),
            delay: Duration::from_millis(20),
            pending: Vec::new(),
        };
        peer.driver.link_opened(Duration::ZERO);
        peer
    }

    /// The captured mount, asked everything.
    fn connected() -> Peer {
        let mut peer = Peer::captured();
        peer.run_until(|peer| peer.reports.contains(&Report::Compared));
        peer.run(Duration::from_millis(400)); // the first poll
        peer.reports.clear();
        peer.sent.clear();
        peer
    }

    fn reply(&mut self, command: &[u8], reply: &[u8]) {
        self.replies.insert(command.to_vec(), reply.to_vec());
    }

    fn silent_to(&mut self, command: &[u8]) {
        self.reply(command, b"");
    }

    /// One millisecond: replies that are due, the driver's time, and what it sends.
    fn step(&mut self) {
        self.now += STEP;
        let (due, later): (Vec<_>, Vec<_>) = self.pending.drain(..).partition(|(at, _)| *at <= self.now);
        self.pending = later;
        for (_, bytes) in due {
            self.driver.feed(&bytes, self.now);
        }
        self.driver.tick(self.now);
        let out = self.driver.drain();
        if !out.is_empty() {
            self.hear(&out);
        }
        self.reports.extend(std::iter::from_fn(|| self.driver.poll()));
    }

    fn hear(&mut self, out: &[u8]) {
        for command in commands(out) {
            self.sent.push((self.now, command.clone()));
            if command == b"#" || is_silent(&command) {
                continue;
            }
            let reply = self
                .replies
                .get(&command)
                .unwrap_or_else(|| panic!("{} was not expected at {:?}", String::from_utf8_lossy(&command), self.now));
            if !reply.is_empty() {
                self.pending.push((self.now + self.delay, reply.clone()));
            }
        }
    }

    fn run(&mut self, time: Duration) {
        let end = self.now + time;
        while self.now < end {
            self.step();
        }
    }

    fn run_until(&mut self, done: impl Fn(&Peer) -> bool) {
        let end = self.now + Duration::from_secs(120);
        while !done(self) {
            assert!(self.now < end, "it never came; reports: {:?}", self.reports);
            self.step();
        }
    }

    fn reported(&self, wanted: impl Fn(&Report) -> bool) -> bool {
        self.reports.iter().any(wanted)
    }

    /// How often a command was sent.
    fn count(&self, command: &[u8]) -> usize {
        self.sent.iter().filter(|(_, sent)| sent == command).count()
    }
}

/// Splits what is sent at its `#`; ACK stands alone.
fn commands(out: &[u8]) -> Vec<Vec<u8>> {
    out.split_inclusive(|byte| *byte == b'#' || *byte == 0x06).map(<[u8]>::to_vec).collect()
}

fn is_silent(command: &[u8]) -> bool {
    [&b":Q"[..], b":M", b":R", b":U#", b":EK"].iter().any(|start| command.starts_with(start)) && command != b":MS#"
}
