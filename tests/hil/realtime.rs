//! Two hundred of the nights again in real time, over pseudo terminals.
//!
//! Wiring: none. Each night has a pty: the driver opens its slave as a serial port, a simulated mount is behind its master. A pty
//! enforces no baud rate; the simulated mount paces its own bytes at 9600.

use std::fs::File;
use std::io::{Read, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use scotopic::hw::mount::sim::port::SimulatedMount;
use scotopic::hw::port::{Port, PortError};
use scotopic::hw::serial::SerialLine;

use super::bench::Bench;
use super::faults::Tally;
use super::night::Night;
use super::report::{Outcome, Report};
use super::truth::STOP_BUDGET;

const NIGHTS: u64 = 200;
/// So many at once: they wait most of the time.
const AT_ONCE: usize = 67;

/// A serial port whose other end is a simulated mount, through a pty.
struct PtyPort {
    line: SerialLine,
    over: Arc<AtomicBool>,
    far: Option<JoinHandle<()>>,
}

impl PtyPort {
    fn open(mount: &SimulatedMount, start: Instant) -> Result<PtyPort, PortError> {
        let failed =
            |error: &dyn std::fmt::Display| PortError::Unusable { name: "a pty".into(), why: error.to_string() };
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).map_err(|e| failed(&e))?;
        grantpt(&master).map_err(|e| failed(&e))?;
        unlockpt(&master).map_err(|e| failed(&e))?;
        let name = ptsname(&master, Vec::new()).map_err(|e| failed(&e))?.to_string_lossy().into_owned();
        let line = SerialLine::open(&name, 9600)?;
        fcntl_setfl(&master, fcntl_getfl(&master).map_err(|e| failed(&e))? | OFlags::NONBLOCK)
            .map_err(|e| failed(&e))?;
        let (port, over) = (mount.open()?, Arc::new(AtomicBool::new(false)));
        let ended = Arc::clone(&over);
        let far = std::thread::spawn(move || relay(File::from(master), port, start, &ended));
        Ok(PtyPort { line, over, far: Some(far) })
    }
}

/// Carries bytes between the master and the mount until it is over.
fn relay(mut master: File, mut mount: impl Port, start: Instant, over: &AtomicBool) {
    let mut buffer = [0; 512];
    while !over.load(Ordering::Relaxed) {
        mount.set_now(start.elapsed());
        let Ok(count) = mount.receive(&mut buffer) else { return };
        // A client that does not read loses the rest.
        let _ = master.write(&buffer[..count]);
        let mut files = [PollFd::new(&master, PollFlags::IN)];
        let _ = poll(&mut files, Some(&Timespec { tv_sec: 0, tv_nsec: 4_000_000 }));
        if let Ok(count) = master.read(&mut buffer) {
            let _ = mount.send(&buffer[..count]);
        }
    }
}

impl Port for PtyPort {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        self.line.receive(buffer)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.line.send(bytes)
    }
}

impl Drop for PtyPort {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        if let Some(far) = self.far.take() {
            let _ = far.join();
        }
    }
}

/// A bench in real time.
pub(crate) fn bench(night: &Night) -> (Bench, Instant) {
    let start = Instant::now();
    let bench = Bench::new(night.settings(), night.cable(), Some(start), move |mount| {
        Ok(Box::new(PtyPort::open(mount, start)?))
    });
    (bench, start)
}

/// The nights, many at once.
pub(crate) fn nights(report: &mut Report) {
    let began = Instant::now();
    let (next, tally, seed) = (AtomicU64::new(0), Mutex::new(Tally::new()), report.seed);
    let wanted = std::env::var("SCOTOPIC_RIG_REAL_NIGHTS").ok().and_then(|n| n.parse().ok()).unwrap_or(NIGHTS);
    std::thread::scope(|scope| {
        for _ in 0..AT_ONCE.min(usize::try_from(wanted).unwrap()) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= wanted {
                        break;
                    }
                    let night = Night::of(seed.wrapping_add(number)).without_leap();
                    let (mut bench, start) = bench(&night);
                    let broken = night.play(&mut bench, |bench| {
                        if !bench.pump.is_open() {
                            // The port waits for bytes; without one, we do.
                            std::thread::sleep(Duration::from_millis(5));
                        }
                        start.elapsed()
                    });
                    let mut tally = tally.lock().unwrap();
                    tally.add(&bench);
                    if !broken.is_empty() {
                        tally.fail(&night, &broken.join("\n  "));
                    }
                }
            });
        }
    });
    let tally = tally.into_inner().unwrap();
    tally.tell(report, "real nights");
    let measured = format!("{} nights, {} broken", tally.nights, tally.failures.len());
    report.figure(
        "200 of them again in real time, over ptys",
        "200 without a broken invariant",
        measured,
        tally.failures.is_empty() && wanted >= NIGHTS,
    );
    let in_time = tally.stops.count_between(0, u64::try_from(STOP_BUDGET.as_micros()).unwrap());
    let measured = format!(
        "{in_time} of {} within 50 ms, p99 {:.1} ms, max {:.1} ms",
        tally.stops.len(),
        tally.stops.value_at_quantile(0.99) as f64 / 1000.0,
        tally.stops.max() as f64 / 1000.0
    );
    report.figure(
        "real time: stop ordered to bytes in the port, when it takes bytes",
        "< 50 ms",
        measured,
        in_time == tally.stops.len(),
    );
    let outcome = if tally.failures.is_empty() { Outcome::Passed } else { Outcome::Failed(tally.failures.join("\n")) };
    report.check("mount", format!("{wanted} nights with a bad cable, real time over ptys"), outcome, began.elapsed());
}
