//! Every way in which a session can end: the LEDs are off afterwards, and the terminal is as it was.
//!
//! Wiring: none. The light module is a made-up one whose registers are in a file (`fake:FILE`) and outlive the program, as a real
//! module's do; the terminal is a pty.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use rustix::process::Signal;
use scotopic::hw::light::fake::stored::StoredBus;

use super::field::{Mount, TIME};
use super::program::{Program, command, home, raw_pty, wait_at_most, wait_for};
use super::report::{Outcome, Report};

/// LEDs must be off so soon after the end: the guard of a killed program has some work to do.
const DARK_WITHIN: Duration = Duration::from_secs(5);

const CALIBRATION: &str = "module = \"dlpc2607\"\nid = 0x8A\nleds = 1\n\n[optics]\nmeter = \"eyepiece\"\nfixed_nd = 1e-4\n\
    beam_splitter = 0.1\n\n[[row]]\ncode = 12\ncd_m2 = 0.06\n\n[[row]]\ncode = 775\ncd_m2 = 1.8\n";

/// What a session has beside the light.
#[derive(Clone, Copy, PartialEq)]
enum Fitted {
    Nothing,
    /// A tapped hand controller, of which a key is pressed in the end.
    HandController,
    /// A mount on a cable: only of a real one something is remembered. The picture is pushed in the end, which is remembered.
    Cable,
}

/// A way to end.
struct Way {
    name: &'static str,
    environment: &'static [(&'static str, &'static str)],
    /// Beside the light.
    fitted: Fitted,
    end: fn(&mut Program, &Path),
    /// Whether the program can give the terminal back: nothing that is killed can.
    gives_back: bool,
    /// Whether the program ends; otherwise only the light has to go.
    ends: bool,
}

const fn way(name: &'static str, end: fn(&mut Program, &Path)) -> Way {
    Way { name, environment: &[], fitted: Fitted::Nothing, end, gives_back: true, ends: true }
}

const fn panic(name: &'static str, environment: &'static [(&'static str, &'static str)]) -> Way {
    Way { environment, ..way(name, |_, _| {}) }
}

const WAYS: &[Way] = &[
    way("quit with q", |program, _| program.press("q")),
    way("quit with Ctrl-C as a key", |program, _| program.press("\x03")),
    way("SIGINT", |program, _| program.signal(Signal::INT)),
    way("SIGTERM", |program, _| program.signal(Signal::TERM)),
    way("SIGHUP", |program, _| program.signal(Signal::HUP)),
    Way { gives_back: false, ..way("SIGKILL", |program, _| program.signal(Signal::KILL)) },
    Way {
        gives_back: false,
        ..way("SIGABRT, as the service manager's watchdog sends it", |program, _| program.signal(Signal::ABORT))
    },
    Way { gives_back: false, ..way("SIGQUIT", |program, _| program.signal(Signal::QUIT)) },
    panic("panic in the session's loop", &[("SCOTOPIC_TEST_PANIC", "6")]),
    panic("panic in the mount's thread", &[("SCOTOPIC_TEST_PANIC", "6@mount")]),
    panic("panic in the projector's thread", &[("SCOTOPIC_TEST_PANIC", "6@projector")]),
    panic("panic in the keys' thread", &[("SCOTOPIC_TEST_PANIC", "6@keys")]),
    Way {
        fitted: Fitted::HandController,
        ..panic("panic in the hand controller's thread", &[("SCOTOPIC_TEST_PANIC", "6@handbox")])
    },
    Way {
        fitted: Fitted::Cable,
        ..panic("panic in the thread that remembers", &[("SCOTOPIC_TEST_PANIC", "6@keeper")])
    },
    Way { gives_back: false, ..way("lost terminal", Program::lose_terminal) },
    Way {
        ends: false,
        ..way("lost projector", |_, home| {
            // What must become a file of the folder is a folder now: no picture can be written any more.
            let _ = fs::remove_dir_all(home.join("frames"));
            fs::write(home.join("frames"), "").unwrap();
        })
    },
];

fn settle(home: &Path) -> (String, std::path::PathBuf) {
    let (settings, light) = (home.join("settings.toml"), home.join("light.json"));
    fs::write(home.join("calibration.toml"), CALIBRATION).unwrap();
    fs::create_dir_all(home.join("frames")).unwrap();
    let text = format!(
        "[light]\nmodule = \"dlpc2607\"\nbus = \"fake:{}\"\ncalibration = \"calibration.toml\"\nluminance_cd_m2 = 0.3\n",
        light.display()
    );
    fs::write(&settings, text).unwrap();
    (settings.to_string_lossy().into_owned(), light)
}

fn lit(light: &Path) -> bool {
    StoredBus::look(light).is_ok_and(|module| module.lit)
}

/// One way out; what was wrong.
fn leave(number: usize, way: &Way) -> Vec<String> {
    let home = home(&format!("exit-{number}"));
    let (settings, light) = settle(&home);
    let mut arguments = vec!["observe", "--config", &settings, "--projector", "png:frames", "--time", TIME];
    let handset = (way.fitted == Fitted::HandController).then(raw_pty);
    let mount = (way.fitted == Fitted::Cable).then(Mount::new);
    let line = mount.as_ref().map(|mount| format!("serial:{}", mount.endpoint));
    if let Some((_, tap, _)) = &handset {
        arguments.extend(["--handbox", tap, "--handbox-map", "ascii"]);
    }
    if let Some(line) = &line {
        arguments.extend(["--site", "49.26,7.04,230", "--mount", line]);
    }
    let mut program = Program::start(&home, way.environment, &arguments);
    let mut wrong = Vec::new();
    if !wait_for(|| lit(&light) || program.child.try_wait().unwrap().is_some()) || !lit(&light) {
        wrong.push(format!("the LEDs never came on; the screen: {}", program.screen().screen().contents()));
        return wrong;
    }
    (way.end)(&mut program, &home);
    if way.name.contains("keys") {
        // That thread wakes when a key is pressed.
        std::thread::sleep(Duration::from_secs(8));
        program.press("l");
    }
    if way.fitted != Fitted::Nothing {
        std::thread::sleep(Duration::from_secs(8));
        program.press("\x1b[C");
    }
    if let Some((mut master, ..)) = handset {
        master.write_all(b"?").unwrap();
    }
    if way.ends && program.ended().is_none() {
        wrong.push("the program did not end".into());
    }
    if !wait_at_most(DARK_WITHIN + if way.ends { Duration::ZERO } else { Duration::from_secs(10) }, || !lit(&light)) {
        wrong.push("the LEDs are still on".into());
    }
    if way.ends && way.gives_back && !program.given_back() {
        wrong.push("the terminal is not as it was".into());
    }
    drop(program);
    let _ = fs::remove_dir_all(&home);
    wrong
}

/// Where a disk is full.
#[derive(Clone, Copy, PartialEq)]
enum Full {
    Nowhere,
    Summary,
    Recording,
}

/// Without a terminal: the end of its time, SIGTERM, and nobody who reads its summary.
fn headless(number: usize, seconds: &str, end: Option<Signal>, full: Full) -> Vec<String> {
    let home = home(&format!("headless-{number}"));
    let (settings, light) = settle(&home);
    let mut arguments = vec![
        "observe",
        "--headless",
        "--for",
        seconds,
        "--config",
        &settings,
        "--projector",
        "png:frames",
        "--time",
        TIME,
    ];
    if full == Full::Recording {
        arguments.extend(["--record", "/dev/full"]);
    }
    let out = if full == Full::Summary {
        Stdio::from(fs::File::options().write(true).open("/dev/full").unwrap())
    } else {
        Stdio::null()
    };
    let mut child = command(&home, &arguments).stdin(Stdio::null()).stdout(out).stderr(Stdio::null()).spawn().unwrap();
    let mut wrong = Vec::new();
    if !wait_for(|| lit(&light) || child.try_wait().unwrap().is_some()) || !lit(&light) {
        wrong.push("the LEDs never came on".to_owned());
    }
    if let Some(signal) = end {
        rustix::process::kill_process(rustix::process::Pid::from_child(&child), signal).unwrap();
    }
    if !wait_for(|| child.try_wait().unwrap().is_some()) {
        wrong.push("the program did not end".into());
    }
    if !wait_at_most(DARK_WITHIN, || !lit(&light)) {
        wrong.push("the LEDs are still on".into());
    }
    let _ = child.kill();
    let _ = child.wait();
    let _ = fs::remove_dir_all(&home);
    wrong
}

/// Whether SIGQUIT is ignored here: a child inherits that, and convention says that it then stays so.
fn quit_is_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).map(str::trim);
    ignored
        .and_then(|mask| u64::from_str_radix(mask, 16).ok())
        .is_some_and(|mask| mask & (1 << (Signal::QUIT.as_raw() - 1)) != 0)
}

pub(crate) fn every_way(report: &mut Report) {
    let mut results: Vec<(String, Vec<String>, Duration)> = Vec::new();
    // Seven at once: a session mostly waits.
    let ignored = quit_is_ignored();
    if ignored {
        let why = "whoever started this test has it ignored (a shell's background job does), and so would the program";
        report.not_run("exits", "SIGQUIT", why);
    }
    let jobs: Vec<(usize, &Way)> =
        WAYS.iter().enumerate().filter(|(_, way)| !(ignored && way.name == "SIGQUIT")).collect();
    for some in jobs.chunks(7) {
        std::thread::scope(|scope| {
            let threads: Vec<_> = some
                .iter()
                .map(|(number, way)| {
                    scope.spawn(move || {
                        let began = Instant::now();
                        (way.name.to_owned(), leave(*number, way), began.elapsed())
                    })
                })
                .collect();
            results.extend(threads.into_iter().map(|thread| thread.join().unwrap()));
        });
    }
    std::thread::scope(|scope| {
        let threads = [
            scope.spawn(|| (Instant::now(), "headless, its time is over", headless(0, "8", None, Full::Nowhere))),
            scope.spawn(|| (Instant::now(), "headless, SIGTERM", headless(1, "60", Some(Signal::TERM), Full::Nowhere))),
            scope.spawn(|| {
                (Instant::now(), "headless, its summary meets a full disk", headless(2, "8", None, Full::Summary))
            }),
            scope.spawn(|| {
                (Instant::now(), "headless, its recording meets a full disk", headless(3, "8", None, Full::Recording))
            }),
        ];
        results.extend(threads.into_iter().map(|thread| {
            let (began, name, wrong) = thread.join().unwrap();
            (name.to_owned(), wrong, began.elapsed())
        }));
    });
    let dark = results.iter().filter(|(_, wrong, _)| wrong.is_empty()).count();
    let measured = format!("{dark} of {} ways", results.len());
    report.figure(
        "exit paths that leave LEDs off and the terminal as it was",
        "12 at least, all of them",
        measured,
        dark == results.len() && dark >= 12,
    );
    for (name, wrong, took) in results {
        let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
        report.check("exits", name, outcome, took);
    }
}
