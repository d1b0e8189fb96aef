//! The hand controller's display and keys.

use super::*;

/// Status byte, line 1, rest.
fn display(bench: &mut Bench) -> (u8, String, String) {
    let frame = bench.ask(b":ED#");
    assert_eq!(frame.last(), Some(&b'#'));
    assert!(frame.len() >= 34, "status, 16 characters, 16 characters, #");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (frame[0], text(&frame[1..17]), text(&frame[17..frame.len() - 1]))
}

#[test]
fn the_first_menu_is_the_frame_of_the_capture() {
    // [CAP]: status 97 = row 1, column 7, with " Object" on the second line.
    let mut bench = Bench::new();
    assert_eq!(display(&mut bench), (0x97, "Select Item:    ".into(), " Object         ".into()));
}

#[test]
fn entering_a_messier_number_moves_the_cursor_as_in_the_capture() {
    // [CAP]: D0, then D1 after one digit.
    let mut bench = Bench::new();
    for key in [b":EK13#", b":EK68#", b":EK13#", b":EK13#"] {
        bench.ask(key);
    }
    assert_eq!(display(&mut bench).0, 0xD0);
    bench.ask(b":EK51#");
    assert_eq!(display(&mut bench).0, 0xD1);
}

#[test]
fn parking_shows_the_frame_of_the_capture() {
    // [CAP]: 8D = row 0, column 13, "Parking Scope".
    let mut bench = Bench::new();
    bench.ask(b":hP#");
    let (status, top, _) = display(&mut bench);
    assert_eq!((status, top.trim_end()), (0x8D, "Parking Scope"));
}

#[test]
fn the_menu_tree_begins_as_in_the_capture() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask(b":EQ 0#"), b"3820 3852 Object#");
    assert_eq!(bench.ask(b":EQ 3820#").split(|byte| *byte == b' ').next_back(), Some(&b"Event#"[..]));
    assert_eq!(bench.ask(b":EQ 1#"), b"", "no such node");
    bench.ask(b":ES3820#");
    assert_eq!(display(&mut bench).2.trim(), "Event");
}

#[test]
fn help_is_one_long_text_and_mode_closes_it() {
    let mut bench = Bench::new();
    bench.ask(b":EK63#");
    bench.mount.feed(b":ED#", bench.now);
    let help = bench.wait_s(1.0);
    assert!(help.len() > 300 && help.last() == Some(&b'#'));
    bench.ask(b":EK9#");
    assert_eq!(display(&mut bench).2.trim(), "Object");
}

#[test]
fn a_messier_object_can_be_gone_to_from_the_keys() {
    let mut bench = Bench::new();
    for key in [13, 68, 13, 13, 51, 49, 13, 24] {
        bench.ask(format!(":EK{key}#").as_bytes());
    }
    assert_eq!(bench.ask(b":D#"), b"\x7F#");
    bench.arrive();
    // M31 of late 2026: 0h 44m 12s, +41 deg 25 arcmin (J2000 0h 42m 44s, +41 deg 16 arcmin, precessed by hand).
    assert!(bench.shown(b":GR#").starts_with("00:44:1"), "{}", bench.shown(b":GR#"));
    assert!(bench.shown(b":GD#").starts_with("+41\\xdf24:5"), "{}", bench.shown(b":GD#"));
}

#[test]
fn mode_held_shows_the_position() {
    let mut bench = Bench::new();
    bench.ask(b":EK11#");
    let (_, top, bottom) = display(&mut bench);
    assert!(top.starts_with("RA:") && bottom.starts_with("Dec:"), "{top} {bottom}");
}
