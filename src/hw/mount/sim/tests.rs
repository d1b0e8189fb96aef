//! The simulator from outside: bytes in, bytes out, in virtual time. Bytes called [CAP] are those of a real LX200GPS 4.2l,
//! recorded in 2023 (`lima-bravo/LX200emulator`, astropad-20231013.log).

mod faults;
mod handset;
mod motion;
mod properties;
mod replies;

use super::*;
use crate::sky::time::Utc;

/// A mount and a clock that runs while one waits for replies.
struct Bench {
    mount: Simulator,
    now: Duration,
}

impl Bench {
    fn new() -> Bench {
        Bench::with(Settings::default())
    }

    fn with(settings: Settings) -> Bench {
        Bench { mount: Simulator::new(settings), now: Duration::ZERO }
    }

    fn with_fault(fault: &str) -> Bench {
        let mut settings = Settings::default();
        settings.faults.switch(fault).unwrap();
        Bench::with(settings)
    }

    /// Lets time pass in steps, as a program would, and gives what arrived.
    fn wait(&mut self, time: Duration) -> Vec<u8> {
        let (end, mut heard) = (self.now + time, Vec::new());
        while self.now < end {
            self.now = (self.now + Duration::from_millis(5)).min(end);
            heard.extend(self.mount.drain(self.now));
        }
        heard
    }

    fn wait_s(&mut self, seconds: f64) -> Vec<u8> {
        self.wait(Duration::from_secs_f64(seconds))
    }

    /// Sends, and gives what has come back after 150 ms.
    fn ask(&mut self, command: &[u8]) -> Vec<u8> {
        self.mount.feed(command, self.now);
        self.wait_s(0.15)
    }

    /// As [`Bench::ask`], shown so that a failed test can be read.
    fn shown(&mut self, command: &[u8]) -> String {
        self.ask(command).escape_ascii().to_string()
    }

    /// Sets a target so many degrees of azimuth and altitude from where the mount points, and goes there.
    fn go_by(&mut self, azimuth: f64, altitude: f64) -> Vec<u8> {
        let (a, e) = self.mount.controller.encoders();
        let target = self.mount.controller.sky_of((a + azimuth, e + altitude), self.now);
        self.go_to(target)
    }

    fn go_to(&mut self, target: Equatorial<OfDate>) -> Vec<u8> {
        let form = angles::Form { long: true, degree: b'*', minute: b':' };
        let ra = [b":Sr", &form.hours(target.ra().to_hours())[..]].concat();
        let dec = [b":Sd", &form.signed(target.dec().to_degrees())[..]].concat();
        assert_eq!(self.ask(&ra), b"1");
        assert_eq!(self.ask(&dec), b"1");
        self.ask(b":MS#")
    }

    /// Waits until the bars are gone; gives the seconds it took.
    fn arrive(&mut self) -> f64 {
        let start = self.now;
        while self.ask(b":D#") != b"#" {
            assert!(self.now - start < Duration::from_secs(120), "it never arrives");
        }
        (self.now - start).as_secs_f64()
    }
}

#[test]
fn it_starts_aligned_awake_tracking_and_above_the_horizon() {
    for latitude in [-90.0, -50.0, -24.6, 0.0, 49.26, 60.0, 90.0] {
        let site = crate::sky::site::Site::new(latitude, -70.4, 0.0).unwrap();
        let mut bench = Bench::with(Settings::at(site, Utc(1_795_730_400.0)));
        assert_eq!(bench.ask(b":GW#"), b"AT2");
        assert_eq!(bench.ask(b"\x06"), b"A");
        assert_eq!(bench.ask(b":D#"), b"#");
        assert!(bench.shown(b":GA#").starts_with("+4"), "at latitude {latitude}");
    }
}
