//! Each fault does what its line in the list says.

use super::*;

/// How many of `count` queries are answered as they should be.
fn right(bench: &mut Bench, count: usize) -> usize {
    (0..count).filter(|_| bench.ask(b":GVP#") == b"LX2001#").count()
}

#[test]
fn bytes_are_dropped_inserted_flipped_and_doubled_as_often_as_asked() {
    for fault in ["drop=0.05", "insert=0.05", "flip=0.05", "duplicate=0.05"] {
        let right = right(&mut Bench::with_fault(fault), 200);
        // Seven bytes come through with a chance of 0.95^7 = 0.70.
        assert!((110..170).contains(&right), "{fault}: {right} of 200");
    }
}

#[test]
fn a_busy_mount_says_nak_within_10_ms_and_does_not_obey() {
    let mut bench = Bench::with_fault("nak=1");
    assert_eq!(bench.ask(b":GR#"), b"\x15");
    bench.mount.feed(b":U#", bench.now);
    assert_eq!(bench.wait_s(0.016), b"\x15", "10 ms, and the bytes' own time");
    assert!(bench.mount.controller.form().long);
    let naks = (0..300).filter(|_| bench.ask(b"\x06") == b"\x15").count();
    assert_eq!(naks, 300);
    let mut bench = Bench::with_fault("nak=0.1");
    let naks = (0..300).filter(|_| bench.ask(b"\x06") == b"\x15").count();
    assert!((30..110).contains(&naks), "bursts of one to three: {naks}");
}

#[test]
fn silence_has_its_time() {
    let mut bench = Bench::with_fault("silence=1,2");
    assert_eq!(right(&mut bench, 5), 5);
    bench.wait_s(0.5);
    assert_eq!(right(&mut bench, 5), 0);
    bench.wait_s(2.0);
    assert_eq!(right(&mut bench, 5), 5);
}

#[test]
fn replies_break_off_end_early_stall_and_come_late() {
    assert_eq!(Bench::with_fault("half=1").ask(b":GVP#"), b"LX2");
    assert_eq!(Bench::with_fault("truncate=5").ask(b":GVP#"), b"LX200");
    let mut bench = Bench::with_fault("stall=1,700");
    assert_eq!(bench.ask(b":GVP#"), b"LX2");
    assert_eq!(bench.wait_s(1.0), b"001#");
    let mut bench = Bench::with_fault("delay=500");
    assert_eq!(bench.ask(b":GVP#"), b"");
    assert_eq!(bench.wait_s(0.5), b"LX2001#");
}

#[test]
fn replies_are_swapped_glued_and_followed_by_what_nobody_asked_for() {
    let mut bench = Bench::with_fault("swap=1");
    bench.ask(b":GVP#");
    assert_eq!(bench.ask(b":GVN#"), b"LX2001#");
    assert_eq!(bench.ask(b":GM#"), b"4.2l#");
    let mut bench = Bench::with_fault("glue=0.5");
    let all: Vec<Vec<u8>> = (0..40).map(|_| bench.ask(b":GVN#")).collect();
    assert!(all.iter().any(|reply| reply.is_empty()) && all.iter().any(|reply| reply.starts_with(b"4.2l#4.2l#")));
    assert!(Bench::with_fault("unsolicited=1").ask(b":GVN#").starts_with(b"4.2l#$GPRMC"));
}

#[test]
fn a_flood_runs_at_line_speed_and_holds_no_hash() {
    let mut bench = Bench::with_fault("flood=1,3000");
    bench.wait_s(1.0);
    let flood = bench.wait_s(1.0);
    assert!((900..=961).contains(&flood.len()), "{} bytes in a second", flood.len());
    assert!(!flood.contains(&b'#'));
    bench.wait_s(5.0);
    assert_eq!(bench.ask(b":GVP#"), b"LX2001#");
}

#[test]
fn a_wrong_baud_rate_is_garbage_and_a_break_is_one_nul() {
    let garbage = Bench::with_fault("wrong-baud=on").ask(b"\x06:GR#:GR#");
    assert!(garbage.is_empty() || garbage.iter().all(|byte| !byte.is_ascii()));
    let mut bench = Bench::with_fault("break=0.5,1");
    assert_eq!(right(&mut bench, 2), 2);
    bench.now = Duration::from_millis(500);
    assert_eq!(bench.ask(b":GVP#"), b"\0");
    assert_eq!(bench.ask(b":GVP#"), b"");
    bench.wait_s(1.0);
    assert_eq!(right(&mut bench, 2), 2);
}

#[test]
fn a_looped_cable_gives_back_what_was_sent_and_an_echo_answers_too() {
    assert_eq!(Bench::with_fault("loop=on").ask(b":GVP#"), b":GVP#");
    assert_eq!(Bench::with_fault("echo=on").ask(b":GVP#"), b":GVP#LX2001#");
}

#[test]
fn stale_bytes_wait_for_each_client() {
    let mut bench = Bench::with_fault("stale=on");
    bench.mount.client_came(bench.now);
    assert_eq!(bench.ask(b":GVN#"), b"+37\xDF17:16#05:24.2l#");
}

#[test]
fn the_reply_to_a_sync_is_held_until_the_next_byte() {
    let mut bench = Bench::with_fault("hold-sync=on");
    bench.ask(b":Sr06:38:00#");
    bench.ask(b":Sd+69*00:00#");
    assert_eq!(bench.ask(b":CM#"), b"");
    assert_eq!(bench.ask(b"\x06"), b" M31 EX GAL MAG 3.5 SZ178.0'#A");
}

#[test]
fn the_port_goes_and_comes_back() {
    let mut bench = Bench::with_fault("unplug=1,2");
    assert!(bench.mount.plugged(bench.now));
    bench.now = Duration::from_secs(2);
    assert!(!bench.mount.plugged(bench.now));
    assert_eq!(bench.ask(b":GVP#"), b"");
    bench.now = Duration::from_secs(3);
    assert!(bench.mount.plugged(bench.now));
    assert_eq!(bench.ask(b":GVP#"), b"LX2001#");
    let mut bench = Bench::with_fault("unplug-at=:MS");
    bench.go_by(10.0, 0.0);
    assert!(!bench.mount.plugged(bench.now));
    bench.wait_s(3.0);
    assert!(bench.mount.plugged(bench.now), "once, for two seconds");
}

#[test]
fn after_a_park_with_its_fault_nothing_is_answered() {
    let mut bench = Bench::with_fault("park-silence=on");
    bench.ask(b":hP#");
    bench.wait_s(40.0);
    assert_eq!(bench.ask(b"\x06:GR#"), b"");
}

#[test]
fn clock_faults_show_in_the_clock_and_in_sidereal_time() {
    let sidereal_s = |bench: &mut Bench| angles::read_hours(&bench.ask(b":GS#")[..8]).unwrap() * 3600.0;
    let right = sidereal_s(&mut Bench::new());
    let off = |fault: &str| {
        let mut bench = Bench::with_fault(fault);
        (sidereal_s(&mut bench) - right + 43_200.0).rem_euclid(86_400.0) - 43_200.0
    };
    assert!((off("clock-error=3600") - 3610.0).abs() < 2.0);
    assert!((off("zone-sign=on") - 7219.7).abs() < 2.0, "two hours, and sidereal time's gain");
    assert!((off("longitude-sign=on") + 2.0 * 7.04 * 240.0).abs() < 2.0);
    let mut bench = Bench::with_fault("rollover=on");
    // The default start is 2026-11-26 local; 1024 weeks before it is 2007-04-12.
    assert_eq!(bench.ask(b":GC#"), b"04/12/07#");
    let mut bench = Bench::with_fault("clock-jump=10,-3600");
    let before = bench.ask(b":GL#");
    bench.now = Duration::from_secs(11);
    assert_ne!(bench.ask(b":GL#")[..2], before[..2]);
}

#[test]
fn coordinates_freeze_jump_and_altitude_is_declination() {
    let mut bench = Bench::with_fault("frozen=1");
    bench.wait_s(2.0);
    let frozen = bench.shown(b":GR#:GD#");
    bench.go_by(90.0, 0.0);
    bench.wait_s(5.0);
    assert_eq!(bench.shown(b":GR#:GD#"), frozen);
    assert_eq!(bench.ask(b":D#"), b"\x7F#");

    let mut bench = Bench::with_fault("jump=0.2");
    let told: Vec<String> = (0..100).map(|_| bench.shown(b":GR#")).collect();
    let wild = told.iter().filter(|ra| told.iter().filter(|other| other == ra).count() < 3).count();
    assert!((8..35).contains(&wild), "{wild}");

    let mut bench = Bench::with_fault("wrong-altitude=on");
    assert_eq!(bench.ask(b":GA#"), bench.ask(b":GD#"));
}

#[test]
fn the_format_is_short_or_changes_by_itself() {
    assert_eq!(Bench::with_fault("short=on").ask(b":GR#").len(), 8);
    let mut bench = Bench::with_fault("format-switch=1");
    assert_eq!(bench.ask(b":GR#").len(), 9);
    bench.wait_s(1.0);
    assert_eq!(bench.ask(b":GR#").len(), 8);
}

#[test]
fn it_can_say_that_it_is_another_or_a_classic_without_a_name() {
    assert_eq!(Bench::with_fault("product=Autostar").ask(b":GVP#"), b"Autostar#");
    assert_eq!(Bench::with_fault("product=none").ask(b":GVP#"), b"");
    assert!(Bench::with_fault("escapes=on").ask(b":GVP#").contains(&0x1B));
}

#[test]
fn stops_are_ignored_as_often_as_asked() {
    let mut bench = Bench::with_fault("ignore-stop=2");
    bench.go_by(170.0, 0.0);
    bench.wait_s(2.0);
    for (stop, moves) in [(1, true), (2, true), (3, false)] {
        bench.ask(b":Q#");
        bench.wait_s(2.2);
        let speed = bench.mount.axis_speeds_deg_s(bench.now).0.abs();
        assert_eq!(speed > 1.0, moves, "after stop {stop}: {speed} degrees a second");
    }
}

#[test]
fn a_goto_is_refused_and_its_bar_comes_late_as_asked() {
    assert_eq!(Bench::with_fault("refuse=3").go_by(1.0, 0.0), b"3Object Can Hit Tripod#");
    let mut bench = Bench::with_fault("late-bar=2");
    bench.go_by(90.0, 0.0);
    assert_eq!(bench.ask(b":D#"), b"#");
    bench.wait_s(2.0);
    assert_eq!(bench.ask(b":D#"), b"\x7F#");
}

#[test]
fn somebody_holds_a_key_and_the_mount_reports_it() {
    let mut bench = Bench::with_fault("keypad=2,n,3");
    let before = bench.mount.reported(bench.now);
    bench.wait_s(10.0);
    let moved = bench.mount.reported(bench.now).separation(&before).to_degrees();
    assert!((20.0..26.0).contains(&moved), "three seconds at eight degrees a second: {moved}");
    assert_eq!(bench.ask(b":D#"), b"#");
}

#[test]
fn the_power_fails_and_the_alignment_is_lost() {
    let mut bench = Bench::with_fault("restart=1");
    bench.wait_s(0.9);
    assert_eq!(bench.ask(b":GW#"), b"AT2");
    assert_eq!(bench.wait_s(11.0), b"X");
    assert_eq!(bench.ask(b":GW#"), b"AN0");
}

#[test]
fn it_starts_unaligned_or_asleep_on_request() {
    assert_eq!(Bench::with_fault("unaligned=on").ask(b":GW#"), b"AT0");
    let mut bench = Bench::with_fault("asleep=on");
    assert_eq!(bench.ask(b"\x06"), b"");
    bench.ask(b":hW#");
    assert_eq!(bench.ask(b"\x06"), b"A");
}

#[test]
fn sites_are_counted_from_naught_or_from_one() {
    let mut bench = Bench::new();
    bench.ask(b":W1#");
    assert_eq!(bench.ask(b":Gg#"), b"117\xDF45:36#", "the second memory, Irvine");
    let mut bench = Bench::with_fault("sites-from-one=on");
    bench.ask(b":W1#");
    assert_eq!(bench.ask(b":Gg#"), b"352\xDF57:36#", "the first memory");
}

#[test]
fn the_date_is_taken_as_that_of_utc_on_request() {
    let mut bench = Bench::with_fault("utc-date=on");
    bench.ask(b":SG+03#");
    bench.ask(b":SL22:30:00#");
    bench.mount.feed(b":SC03/04/27#", bench.now);
    bench.wait_s(7.0);
    assert_eq!(bench.ask(b":GC#"), b"03/03/27#", "01:30 UTC of the 4th is the evening of the 3rd");
}

#[test]
fn east_and_west_are_exchanged_on_request() {
    let moved = |mut bench: Bench| {
        let before = bench.mount.controller.encoders().0;
        bench.ask(b":Me#");
        bench.wait_s(1.0);
        bench.mount.controller.encoders().0 - before
    };
    assert!(moved(Bench::new()) < -1.0);
    assert!(moved(Bench::with_fault("reversed=on")) > 1.0);
}

#[test]
fn spans_of_no_length_and_times_of_naught_do_no_harm() {
    for fault in ["unplug=0,0", "break=1,0", "silence=0,0", "restart=0", "flood=0,0", "format-switch=0", "keypad=0,n,0"]
    {
        let mut bench = Bench::with_fault(fault);
        bench.wait_s(12.0);
        assert!(bench.ask(b":GVP#").ends_with(b"LX2001#"), "{fault}");
    }
}
