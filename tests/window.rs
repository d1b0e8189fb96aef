//! The window as projector: on a display of its own (Xvfb, if it is installed), whose screen the test reads back.
//!
//! `cargo test --features window --test window`

#![cfg(feature = "window")]
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use scotopic::hw::projector::{Placement, ProjectorAddress, ProjectorError, open};
use scotopic::picture::Picture;

/// A display in memory, of 1280 x 720 pixels, whose picture lies in a file of a folder.
struct Display {
    server: Child,
    name: String,
    folder: PathBuf,
}

impl Display {
    /// None if there is no Xvfb.
    fn start() -> Option<Display> {
        let number = 90 + std::process::id() % 800;
        let folder = std::env::temp_dir().join(format!("scotopic-xvfb-{number}"));
        std::fs::create_dir_all(&folder).unwrap();
        let server = Command::new("Xvfb")
            .arg(format!(":{number}"))
            .args(["-screen", "0", "1280x720x24", "-nolisten", "tcp", "-fbdir"])
            .arg(&folder)
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let display = Display { server, name: format!(":{number}"), folder };
        let socket = PathBuf::from(format!("/tmp/.X11-unix/X{number}"));
        let patience = Instant::now() + Duration::from_secs(30);
        while !socket.exists() {
            assert!(Instant::now() < patience, "Xvfb does not start");
            std::thread::sleep(Duration::from_millis(20));
        }
        Some(display)
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// The screen's pixels, blue, green, red and a byte of nothing, from the X window dump that Xvfb keeps: its header's length is
/// in the first word, the number of colour map entries of 12 bytes in the twentieth.
fn screen(folder: &Path) -> Vec<[u8; 4]> {
    let bytes = std::fs::read(folder.join("Xvfb_screen0")).unwrap();
    let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let start = word(0) + word(76) * 12;
    bytes[start..start + 1280 * 720 * 4].chunks_exact(4).map(|pixel| pixel.try_into().unwrap()).collect()
}

#[test]
fn a_window_fills_its_monitor_shows_pictures_there_and_closes_and_another_monitor_is_refused() {
    let Some(folder) = std::env::var_os("SCOTOPIC_XVFB_FOLDER") else {
        let Some(display) = Display::start() else {
            eprintln!("skipped: Xvfb is not installed");
            return;
        };
        // The display's name is handed to a second run of this test: changing it in a running process would not be sound.
        let status = Command::new(std::env::current_exe().unwrap())
            .args(["--nocapture", "a_window_fills"])
            .env("SCOTOPIC_XVFB_FOLDER", &display.folder)
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            .status();
        assert!(status.unwrap().success());
        return;
    };
    // The server draws a moment after it is told to.
    let comes = |expected: &dyn Fn(&[[u8; 4]]) -> bool| {
        (0..500).any(|_| {
            std::thread::sleep(Duration::from_millis(20));
            expected(&screen(Path::new(&folder)))
        })
    };
    let count = |screen: &[[u8; 4]], colour: [u8; 3]| screen.iter().filter(|pixel| pixel[..3] == colour).count();

    // Its only monitor is called `screen`: full-screen there, without any window manager.
    let mut window = open(&ProjectorAddress::Window(Some("screen".into())), Placement::default()).unwrap();
    assert_eq!(window.describe(), "window on screen");
    let mut picture = Picture::black(1024, 768);
    picture.pixels_mut().fill([1.0, 0.0, 0.0]);
    picture.row_mut(0)[0] = [0.0, 1.0, 0.0];
    window.present(&picture).unwrap();
    // 960 x 720 of it are the picture, but for the corner; the rest is black.
    assert!(comes(&|screen| {
        (960 * 720 - 4..960 * 720).contains(&count(screen, [0, 0, 255])) && count(screen, [0; 3]) == 320 * 720
    }));
    // The canvas' upper left corner is the picture's upper left corner.
    assert!(comes(&|screen| screen[160][1] > 200));
    window.dark().unwrap();
    assert!(comes(&|screen| count(screen, [0; 3]) == 1280 * 720));
    drop(window);

    // One process may open a display's event loop once only; a second time is an error, not a panic.
    match open(&ProjectorAddress::Window(Some("no such monitor".into())), Placement::default()) {
        Err(ProjectorError::NoMonitor { .. } | ProjectorError::Open { .. }) => {}
        Err(other) => panic!("{other}"),
        Ok(window) => panic!("opened {}", window.describe()),
    }
}
