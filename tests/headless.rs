//! A session without screen and keyboard: only bytes of a hand controller on a pseudo-terminal go in, and the pictures that
//! reached the projector are looked at. The service manager's watchdog, and what is refused at the start.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::{self, File};
use std::io::Write;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

use image::{Rgb, RgbImage};
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// No step takes so long on the slowest machine that is meant.
const PATIENCE: Duration = Duration::from_secs(120);

/// The key `?` of the Autostar II as its key map guesses it, and the same let go.
const HELP: u8 = 0x3F;

/// A folder of this test for settings and pictures.
fn folder(name: &str) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("scotopic-headless-{}-{count}-{name}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn scotopic(home: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_scotopic"));
    command
        .args(["observe", "--headless", "--time", "2026-11-22T19:00:00Z", "--site", "49.26,7.04,230"])
        .args(arguments)
        .env("XDG_CONFIG_HOME", home)
        .env("XDG_STATE_HOME", home)
        .env("XDG_DATA_HOME", home)
        .env("XDG_DATA_DIRS", home)
        .env("HOME", home)
        .env_remove("NOTIFY_SOCKET")
        .env_remove("WATCHDOG_USEC")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// A hand controller's cable: bytes written here are heard by who listens at `name`.
struct Cable {
    end: File,
    name: String,
    /// Held open, so that the line does not hang up before anybody listens.
    _line: OwnedFd,
}

impl Cable {
    fn new() -> Cable {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
        let line: OwnedFd = File::options().read(true).write(true).open(&name).unwrap().into();
        let mut modes = tcgetattr(&line).unwrap();
        modes.make_raw();
        tcsetattr(&line, OptionalActions::Now, &modes).unwrap();
        Cable { end: File::from(master), name, _line: line }
    }

    /// A key goes down, and comes up after a while.
    fn press(&mut self, key: u8, held: Duration) {
        self.end.write_all(&[key]).unwrap();
        sleep(held);
        self.end.write_all(&[key | 0x80]).unwrap();
        sleep(Duration::from_millis(250));
    }
}

/// A session whose pictures go into a folder.
struct Session {
    child: Option<Child>,
    frames: PathBuf,
    cable: Cable,
}

impl Session {
    fn start(home: &Path, arguments: &[&str]) -> Session {
        let (cable, frames) = (Cable::new(), home.join("frames"));
        let projector = format!("png:{}", frames.display());
        let all = [&["--handbox", &cable.name, "--projector", &projector], arguments].concat();
        let child = scotopic(home, &all).spawn().unwrap();
        Session { child: Some(child), frames, cable }
    }

    /// What the projector shows now.
    fn latest(&self) -> Option<RgbImage> {
        Some(image::open(self.frames.join("latest.png")).ok()?.to_rgb8())
    }

    fn wait(&self, what: &str, seen: impl Fn(&RgbImage) -> bool) -> RgbImage {
        let deadline = Instant::now() + PATIENCE;
        loop {
            if let Some(picture) = self.latest().filter(|picture| seen(picture)) {
                return picture;
            }
            assert!(Instant::now() < deadline, "{what} did not come: look at {}", self.frames.display());
            sleep(Duration::from_millis(30));
        }
    }

    /// `?`, and the picture after it.
    fn tap(&mut self, what: &str) -> RgbImage {
        self.pressed(what, Duration::from_millis(80))
    }

    /// `?` held.
    fn hold(&mut self, what: &str) -> RgbImage {
        self.pressed(what, Duration::from_millis(1600))
    }

    /// Waits for a menu that says something else than before; the sky beside it drifts by itself.
    fn pressed(&mut self, what: &str, held: Duration) -> RgbImage {
        let before = self.latest().map(|picture| inside(&picture));
        self.cable.press(HELP, held);
        self.wait(what, |picture| card(picture).is_some() && Some(inside(picture)) != before)
    }

    fn end(&mut self) -> serde_json::Value {
        let child = self.child.take().unwrap();
        kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
        let output = ended(child);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if let Some(child) = &mut self.child {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn ended(mut child: Child) -> Output {
    let deadline = Instant::now() + PATIENCE;
    while child.try_wait().unwrap().is_none() {
        if Instant::now() >= deadline {
            let _ = child.kill();
        }
        assert!(Instant::now() < deadline, "the program did not end");
        sleep(Duration::from_millis(20));
    }
    child.wait_with_output().unwrap()
}

fn lit(picture: &RgbImage) -> usize {
    picture.pixels().filter(|pixel| pixel.0 != [0, 0, 0]).count()
}

/// The frame of the menu: the longest upright line of red on the right side; its column, first and last row.
fn card(picture: &RgbImage) -> Option<(u32, u32, u32)> {
    let (mut best, mut found) = (0, None);
    for x in 540..1016 {
        let (mut from, mut long) = (0, 0);
        for y in 60..700 {
            let Rgb([red, green, blue]) = *picture.get_pixel(x, y);
            // The session begins so dim that the eye soon forgets it.
            let on = red > 12 && green == 0 && blue == 0;
            (from, long) = if on { (if long == 0 { y } else { from }, long + 1) } else { (0, 0) };
            if long > best {
                (best, found) = (long, Some((x, from, y)));
            }
        }
    }
    found.filter(|_| best > 90)
}

/// What stands on the card of the menu; nothing without one.
fn inside(picture: &RgbImage) -> Vec<u8> {
    let Some((edge, top, bottom)) = card(picture) else { return Vec::new() };
    // Its left edge is found, or its right one.
    let (from, to) = if edge < 900 { (edge + 5, (edge + 205).min(1010)) } else { (edge - 205, edge - 5) };
    (top..bottom).flat_map(|y| (from..to).flat_map(move |x| picture.get_pixel(x, y).0)).collect()
}

/// Everything on the card is red or black: nothing of the sky is read through it.
fn assert_red(picture: &RgbImage, (right, top, bottom): (u32, u32, u32)) {
    for (x, y) in (right - 100..right).flat_map(|x| (top..bottom).map(move |y| (x, y))) {
        let Rgb([_, green, blue]) = *picture.get_pixel(x, y);
        assert_eq!((green, blue), (0, 0), "at {x}, {y}");
    }
}

/// Two frames of the Ring Nebula that can be told from anything in the sky: all blue, then all green.
fn animation(photographs: &Path) {
    let frames = photographs.join("ring");
    fs::create_dir_all(&frames).unwrap();
    for (name, colour) in [("0.png", [0, 0, 255]), ("1.png", [0, 255, 0])] {
        RgbImage::from_pixel(32, 32, Rgb(colour)).save(frames.join(name)).unwrap();
    }
    let beside = "object = \"M57\"\nscale_arcsec_px = 2.0\nframes_per_second = 4.0\n";
    fs::write(photographs.join("ring.toml"), beside).unwrap();
}

#[test]
fn a_session_is_lived_through_with_the_question_mark_alone() {
    let home = folder("alone");
    let photographs = home.join("photographs");
    fs::create_dir_all(&photographs).unwrap();
    animation(&photographs);
    let photographs = photographs.display().to_string();
    let mut session = Session::start(&home, &["--goto", "M57", "--photographs", &photographs]);

    // The mount has arrived and the picture stands: no menu.
    session.wait("a picture", |picture| lit(picture) > 2000 && card(picture).is_none());
    sleep(Duration::from_secs(12));
    let sky = session.wait("the sky after the slew", |picture| lit(picture) > 2000 && card(picture).is_none());

    // `?` steps to the second eyepiece and shows the list; it goes away by itself.
    let list = session.tap("the list of eyepieces");
    let place = card(&list).expect("a list on the right side");
    assert_red(&list, place);
    let after = session.wait("the list to go away", |picture| lit(picture) > 2000 && card(picture).is_none());
    assert_ne!(lit(&sky), lit(&after), "the second eyepiece shows another field");

    // Held it opens the menu; four lines down is the animation, held again chooses it.
    let menu = session.hold("the menu");
    assert_red(&menu, card(&menu).expect("the menu on the right side"));
    for line in 1..=4 {
        session.tap(&format!("line {line}"));
    }
    session.hold("the animation");
    let middle = |picture: &RgbImage, channel: usize| picture.get_pixel(505, 384).0[channel] > 40;
    session.wait("its blue frame", |picture| middle(picture, 2) && !middle(picture, 1));
    session.wait("its green frame", |picture| middle(picture, 1) && !middle(picture, 2));
    session.wait("the menu to go away", |picture| card(picture).is_none());

    // Overlay off: the menu is still drawn, and when it goes away all is dark.
    session.hold("the menu again");
    session.tap("the overlay's line");
    session.hold("beside");
    let off = session.hold("off, with the menu");
    assert!(card(&off).is_some());
    session.wait("darkness", |picture| lit(picture) == 0);
    session.tap("the list although the overlay is off");

    let summary = session.end();
    assert_eq!(lit(&session.latest().unwrap()), 0, "dark at the end");
    assert_eq!(summary["overlay"], "off");
    assert_eq!(summary["eyepiece_mm"], 15.0, "two steps from the first eyepiece");
    assert_eq!(summary["key_presses"], 12);
    assert!(summary["key_to_picture_ms"]["p99"].as_f64().is_some(), "{summary}");
    assert_eq!(summary["faults"], 0);
    println!("key to picture: {}; overlay age: {}", summary["key_to_picture_ms"], summary["overlay_age_ms"]);
    fs::remove_dir_all(home).unwrap();
}

/// What the service manager hears.
struct Manager {
    socket: UnixDatagram,
    path: PathBuf,
}

impl Manager {
    fn new(home: &Path) -> Manager {
        let path = home.join("notify");
        let socket = UnixDatagram::bind(&path).unwrap();
        Manager { socket, path }
    }

    /// Hears until something is said, or nothing for so long.
    fn hear(&self, silence: Duration) -> Option<String> {
        self.socket.set_read_timeout(Some(silence)).unwrap();
        let mut said = [0; 1024];
        let count = self.socket.recv(&mut said).ok()?;
        Some(String::from_utf8_lossy(&said[..count]).into_owned())
    }

    /// Hears until all words have been said, in whatever order.
    fn wait_for(&self, words: &[&str]) {
        let (deadline, mut heard) = (Instant::now() + PATIENCE, String::new());
        while !words.iter().all(|words| heard.contains(words)) {
            assert!(Instant::now() < deadline, "of {words:?} only this was said:\n{heard}");
            heard.extend(self.hear(Duration::from_secs(1)));
        }
    }
}

#[test]
fn the_service_manager_hears_that_it_is_ready_that_it_lives_and_that_it_ends() {
    let home = folder("manager");
    let manager = Manager::new(&home);
    let cable = Cable::new();
    let child = scotopic(&home, &["--handbox", &cable.name])
        .env("NOTIFY_SOCKET", &manager.path)
        .env("WATCHDOG_USEC", "600000")
        .spawn()
        .unwrap();
    manager.wait_for(&["READY=1", "WATCHDOG=1", "STATUS=linked to LX2001"]);
    for _ in 0..3 {
        manager.wait_for(&["WATCHDOG=1"]);
    }
    kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
    manager.wait_for(&["STOPPING=1"]);
    assert!(ended(child).status.success());
    fs::remove_dir_all(home).unwrap();
}

#[test]
fn a_projector_that_hangs_lets_the_watchdog_starve() {
    let home = folder("hangs");
    let frames = home.join("frames");
    fs::create_dir_all(&frames).unwrap();
    // Whoever opens a pipe for writing waits for a reader.
    rustix::fs::mknodat(
        rustix::fs::CWD,
        frames.join("frame-0000.png.part"),
        rustix::fs::FileType::Fifo,
        rustix::fs::Mode::from_raw_mode(0o600),
        0,
    )
    .unwrap();
    let manager = Manager::new(&home);
    let mut child = scotopic(&home, &["--projector", &format!("png:{}", frames.display())])
        .env("NOTIFY_SOCKET", &manager.path)
        .env("WATCHDOG_USEC", "1000000")
        .spawn()
        .unwrap();
    manager.wait_for(&["WATCHDOG=1"]);
    let deadline = Instant::now() + PATIENCE;
    let mut fed_at = Instant::now();
    while fed_at.elapsed() < Duration::from_secs(4) {
        assert!(Instant::now() < deadline, "it was fed although the projector hangs");
        if manager.hear(Duration::from_millis(500)).is_some_and(|said| said.contains("WATCHDOG=1")) {
            fed_at = Instant::now();
        }
    }
    assert!(child.try_wait().unwrap().is_none(), "the session itself goes on: it is for the manager to end it");
    child.kill().unwrap();
    child.wait().unwrap();
    fs::remove_dir_all(home).unwrap();
}

#[test]
fn what_cannot_be_done_with_a_hand_controller_is_refused_in_a_sentence() {
    let home = folder("refused");
    let cable = Cable::new();
    let mount = format!("serial:{}", cable.name);
    let settings = |text: &str| {
        let path = home.join("settings.toml");
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let cases: Vec<(Vec<&str>, String, &str)> = vec![
        (vec!["--handbox", &cable.name, "--mount", &mount], settings(""), "mount's own command port"),
        (vec!["--handbox", "usb"], settings(""), "no source of keys"),
        (vec!["--handbox", &cable.name, "--handbox-map", "no-such-map"], settings(""), "key map no-such-map"),
    ];
    for (arguments, config, words) in &cases {
        refused(&home, arguments, config, words);
    }
    for (text, words) in [
        ("[handbox.keys]\n\"5\" = \"go-to\"\n", "it moves the telescope"),
        ("[handbox.keys]\n\"HELP\" = \"menu\"\n", "its keys are ?, MODE"),
        ("[handbox]\nmapp = \"ascii\"\n", "did you mean 'map'?"),
    ] {
        refused(&home, &["--handbox", &cable.name], &settings(text), words);
    }
    fs::remove_dir_all(&home).unwrap();
}

fn refused(home: &Path, arguments: &[&str], config: &str, words: &str) {
    let all = [arguments, &["--config", config, "--for", "1"]].concat();
    let output = ended(scotopic(home, &all).spawn().unwrap());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert!(said.contains(words), "{arguments:?}: {said}");
}
