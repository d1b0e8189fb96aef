//! The whole program over ptys: a tapped key to a changed picture, the age of the overlay, frames and tears, a key to a stop.
//!
//! Wiring: none. The mount is a simulated one behind a pty at 9600 baud, the hand controller a pty into which key codes are written,
//! the projector a simulated display of 60 Hz that knows what its beam has read.

use std::io::{Read, Write};
use std::process::Stdio;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use scotopic::cli::rig::Rig;
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::serve::{Listen, Passed, Server};
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::sky::time::Utc;
use serde_json::Value;

use super::program::{Program, command, home, raw_pty, wait_for};
use super::report::{Outcome, Report, histogram, record};
use super::truth::STOP_BUDGET;

pub(crate) const TIME: &str = "2026-11-22T20:00:00Z";

/// A simulated mount behind a pty, and what it is sent, with the time.
pub(crate) struct Mount {
    pub(crate) endpoint: String,
    over: Arc<AtomicBool>,
    heard: std::sync::mpsc::Receiver<(Instant, Vec<u8>)>,
    thread: Option<JoinHandle<()>>,
}

impl Mount {
    pub(crate) fn new() -> Mount {
        let over = Arc::new(AtomicBool::new(false));
        let ((named, name), (tell, heard)) = (std::sync::mpsc::channel(), std::sync::mpsc::channel());
        let ended = Arc::clone(&over);
        let thread = std::thread::spawn(move || {
            let settings = Settings::default();
            let settings = Settings::at(settings.site, Utc::from_rfc3339(TIME).unwrap());
            let mut server = Server::open(Simulator::new(settings), Listen::Pty).unwrap();
            server.watch(Box::new(move |_, passed| {
                if let Passed::ToMount(bytes) = passed {
                    // Whoever listened may be gone.
                    let _ = tell.send((Instant::now(), bytes.to_vec()));
                }
            }));
            named.send(server.endpoint()).unwrap();
            server.serve(&|| ended.load(Ordering::Relaxed), &mut |_| {}).unwrap();
        });
        Mount { endpoint: name.recv().unwrap(), over, heard, thread: Some(thread) }
    }
}

impl Drop for Mount {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

fn number(summary: &Value, group: &str, key: &str) -> Option<f64> {
    summary[group][key].as_f64()
}

/// Half a minute with nothing but a hand controller.
pub(crate) fn by_hand_controller(rig: &Rig, report: &mut Report) {
    let began = Instant::now();
    let (folder, mount) = (home("field"), Mount::new());
    let (mut handset, tap, _open) = raw_pty();
    let display = folder.join("display.json");
    let (line, shown) = (format!("serial:{}", mount.endpoint), format!("sim:{}", display.display()));
    let arguments = [
        "observe",
        "--headless",
        "--for",
        "32",
        "--site",
        "49.26,7.04,230",
        "--time",
        TIME,
        "--mount",
        &line,
        "--handbox",
        &tap,
        "--handbox-map",
        "ascii",
        "--projector",
        &shown,
    ];
    let mut child = command(&folder, &arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = child.stdout.take().unwrap();
    let mut err = child.stderr.take().unwrap();
    let said = std::thread::spawn(move || {
        let mut text = String::new();
        err.read_to_string(&mut text).map(|_| text).unwrap_or_default()
    });
    // The session asks the mount everything first.
    sleep(Duration::from_secs(4));
    for _press in 0..56 {
        handset.write_all(b"?").unwrap();
        sleep(Duration::from_millis(450));
    }
    let mut text = String::new();
    out.read_to_string(&mut text).unwrap();
    let ended = child.wait().unwrap();
    let said = said.join().unwrap();
    let summary: Value = text.lines().last().and_then(|line| serde_json::from_str(line).ok()).unwrap_or_default();
    let seen: Value =
        std::fs::read_to_string(&display).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
    let mut wrong = Vec::new();
    if !ended.success() {
        wrong.push(format!("it ended with {ended}: {text} {said}"));
    }
    let presses = summary["key_presses"].as_u64().unwrap_or_default();
    if presses < 50 {
        wrong.push(format!("of 56 presses {presses} were heard; {said}"));
    }
    let mut figure = |what: &str, asked: &str, most: f64, group: &str, key: &str, with: String| {
        let measured = number(&summary, group, key);
        let told = measured.map_or("not measured".into(), |ms| format!("{ms:.1} ms{with}"));
        report.figure(what, asked, told, measured.is_some_and(|ms| ms < most));
        if measured.is_none() {
            wrong.push(format!("{what} was not measured: {summary}"));
        }
    };
    figure(
        "tapped key to changed picture, 99th percentile",
        "< 60 ms",
        60.0,
        "key_to_picture_ms",
        "p99",
        format!(" ({presses} presses)"),
    );
    let sample = number(&summary, "sample_age_ms", "p95").unwrap_or(f64::NAN);
    figure(
        "overlay age, 95th percentile, 2 Hz polls",
        "< 150 ms",
        150.0,
        "overlay_age_ms",
        "p95",
        format!(" (newest mount sample then: p95 {sample:.0} ms old)"),
    );
    figure(
        "frame jitter on a 60 Hz display, 99th percentile",
        "< 34 ms",
        34.0,
        "frame_jitter_ms",
        "p99",
        String::new(),
    );
    let torn = seen["torn"].as_u64();
    let frames = seen["frames"].as_u64().unwrap_or_default();
    report.figure(
        "torn frames on a simulated 60 Hz display",
        "none",
        format!("{torn:?} of {frames} frames"),
        torn == Some(0),
    );
    if torn != Some(0) {
        wrong.push(format!("torn frames: {seen}"));
    }
    report.count("program: missed frames", seen["missed"].as_u64().unwrap_or_default());
    report.count("program: pictures shown", summary["frames"].as_u64().unwrap_or_default());
    report.inventory("session summary", summary);
    let _ = (std::fs::remove_dir_all(&folder), rig);
    let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
    report.check("program", "half a minute with nothing but a hand controller", outcome, began.elapsed());
}

/// The stop key in a terminal, the stop's bytes at the mount's end of the pty.
pub(crate) fn stop_key(_rig: &Rig, report: &mut Report) {
    let began = Instant::now();
    let (folder, mount) = (home("stop"), Mount::new());
    let line = format!("serial:{}", mount.endpoint);
    let mut program =
        Program::start(&folder, &[], &["observe", "--site", "49.26,7.04,230", "--time", TIME, "--mount", &line]);
    let (mut late, mut wrong) = (histogram(), Vec::new());
    if !wait_for(|| program.shows("linked to")) {
        wrong.push(format!("never linked: {}", program.screen().screen().contents()));
    }
    for press in 0..12u32 {
        if !wrong.is_empty() {
            break;
        }
        sleep(Duration::from_millis(700 + 37 * u64::from(press)));
        while mount.heard.try_recv().is_ok() {}
        let pressed = Instant::now();
        program.press("\x18");
        let mut sent: Vec<u8> = Vec::new();
        let taken = loop {
            match mount.heard.recv_timeout(Duration::from_secs(2)) {
                Ok((at, bytes)) => {
                    sent.extend(bytes);
                    if sent.windows(4).any(|window| window == b"#:Q#") {
                        break Some(at);
                    }
                }
                Err(_) => break None,
            }
        };
        match taken {
            Some(at) => record(&mut late, at - pressed),
            None => wrong.push(format!("press {press}: no stop in two seconds")),
        }
    }
    program.press("q");
    program.ended();
    report.times("program: stop key to its bytes at the mount's end", &late);
    let (p99, most) = (late.value_at_quantile(0.99) as f64 / 1000.0, late.max() as f64 / 1000.0);
    let in_time = late.max() < u64::try_from(STOP_BUDGET.as_micros()).unwrap();
    report.figure(
        "stop key in a terminal to the stop on the wire",
        "< 50 ms",
        format!("p99 {p99:.1} ms, max {most:.1} ms of {}", late.len()),
        in_time && wrong.is_empty(),
    );
    let _ = std::fs::remove_dir_all(&folder);
    let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
    report.check("program", "the stop key, in a terminal", outcome, began.elapsed());
}
