//! The window as projector, on whatever display there is: `xvfb-run cargo test --features window --test window`.

#![cfg(feature = "window")]
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use scotopic::hw::projector::{Placement, ProjectorAddress, ProjectorError, open};
use scotopic::picture::Picture;

#[test]
fn a_window_opens_takes_pictures_and_closes_and_a_monitor_that_is_not_there_is_named() {
    if std::env::var_os("DISPLAY").is_none() && std::env::var_os("WAYLAND_DISPLAY").is_none() {
        eprintln!("skipped: no display; run it under xvfb-run");
        return;
    }
    let mut window = open(&ProjectorAddress::Window(None), Placement::default()).unwrap();
    assert!(window.describe().starts_with("window on"), "{}", window.describe());
    let mut picture = Picture::black(1024, 768);
    picture.pixels_mut().fill([1.0, 0.0, 0.0]);
    for _ in 0..3 {
        window.present(&picture).unwrap();
    }
    if let Some(seconds) = std::env::var("SCOTOPIC_LOOK_S").ok().and_then(|text| text.parse().ok()) {
        std::thread::sleep(std::time::Duration::from_secs(seconds));
    }
    window.dark().unwrap();
    drop(window);

    // One process may open a display's event loop once only; a second time is an error, not a panic.
    match open(&ProjectorAddress::Window(Some("no such monitor".into())), Placement::default()) {
        Err(ProjectorError::NoMonitor { .. } | ProjectorError::Open { .. }) => {}
        Err(other) => panic!("{other}"),
        Ok(window) => panic!("opened {}", window.describe()),
    }
}
