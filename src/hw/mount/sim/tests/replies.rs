//! Every shape of reply, and the line's time.

use super::*;
use crate::sky::site::Site;

#[test]
fn identity_answers_as_in_the_capture() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask(b":GVP#"), b"LX2001#");
    assert_eq!(bench.ask(b":GVN#"), b"4.2l#");
    assert_eq!(bench.ask(b":GW#").len(), 3, "no # after :GW");
    assert_eq!(bench.ask(b":GM#"), b"Irvine#");
    assert_eq!(bench.ask(b":GT#"), b"+60.1#");
    assert_eq!(bench.ask(b":Gc#"), b"24#");
}

#[test]
fn the_fence_and_the_running_number_of_the_capture_work() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask(b":SF021#:GF#:G0#"), b"1021'##");
}

#[test]
fn site_clock_and_sidereal_time_are_those_of_the_capture() {
    // [CAP]: latitude, longitude counted westwards, local time, date and sidereal time of one real mount, which agree with
    // one another to under a minute. Central European Summer Time.
    let site = Site::new(52.0 + 10.0 / 60.0 + 44.0 / 3600.0, 5.0 + 23.0 / 60.0 + 6.0 / 3600.0, 0.0).unwrap();
    let start = Utc::from_rfc3339("2023-09-07T18:01:31Z").unwrap();
    let settings = Settings { zone_h: -1.0, daylight_saving: true, ..Settings::at(site, start) };
    let mut bench = Bench::with(settings);
    assert_eq!(bench.ask(b":Gt#"), b"+52\xDF10:44#");
    assert_eq!(bench.ask(b":Gg#"), b"354\xDF36:54#");
    assert_eq!(bench.ask(b":GL#"), b"20:01:31#");
    assert_eq!(bench.ask(b":GC#"), b"09/07/23#");
    assert_eq!(bench.ask(b":GG#"), b"-02#");
    assert_eq!(bench.ask(b":GH#"), b"1#");
    let sidereal = bench.ask(b":GS#");
    let hours = angles::read_hours(&sidereal[..8]).unwrap();
    let captured = 17.0 + 29.0 / 60.0 + 15.0 / 3600.0;
    assert!((hours - captured).abs() < 1.0 / 60.0, "{}", sidereal.escape_ascii());
}

#[test]
fn high_precision_pointing_answers_fourteen_bytes_without_a_hash() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask(b":P#"), b"HIGH PRECISION");
    assert_eq!(bench.ask(b":P#"), b"LOW  PRECISION");
}

#[test]
fn the_format_is_toggled_for_all_angles_and_stays_when_clients_change() {
    let mut bench = Bench::new();
    for (command, long, short) in
        [(&b":GR#"[..], 9, 8), (b":GD#", 10, 7), (b":GA#", 10, 7), (b":GZ#", 10, 7), (b":Gr#", 9, 8), (b":Gd#", 10, 7)]
    {
        assert_eq!(bench.ask(command).len(), long, "{}", command.escape_ascii());
        assert_eq!(bench.ask(b":U#"), b"");
        bench.mount.client_left(bench.now);
        bench.mount.client_came(bench.now);
        assert_eq!(bench.ask(command).len(), short, "{}", command.escape_ascii());
        bench.ask(b":U#");
    }
}

#[test]
fn a_clone_writes_star_and_quote() {
    let mut bench = Bench::with_fault("degree=star");
    let dec = bench.ask(b":GD#");
    assert_eq!((dec[3], dec[6], dec.len()), (b'*', b'\'', 10));
}

#[test]
fn set_commands_take_one_space_and_refuse_nonsense() {
    let mut bench = Bench::new();
    for (command, reply) in [
        (&b":Sr12:34:56#"[..], &b"1"[..]),
        (b":Sr 12:34:56#", b"1"),
        (b":Sr  12:34:56#", b"0"),
        (b":Sr24:00:00#", b"0"),
        (b":Sd-05*23:28#", b"1"),
        (b":Sd-05\xDF23:28#", b"1"),
        (b":Sd+91*00#", b"0"),
        (b":St+52*10#", b"1"),
        (b":St +52*10#", b"1"),
        (b":Sg354*37#", b"1"),
        (b":Sg-005*23#", b"1"),
        (b":Sg361*00#", b"0"),
        (b":SL20:01:31#", b"1"),
        (b":SL 25:00:00#", b"0"),
        (b":SG-01#", b"1"),
        (b":SG+05.5#", b"1"),
        (b":SGx#", b"0"),
        (b":SC13/01/26#", b"0"),
        (b":SMMy garden#", b"1"),
        (b":Sw4#", b"1"),
        (b":Sw9#", b"0"),
    ] {
        assert_eq!(bench.ask(command), reply, "{}", command.escape_ascii());
    }
    assert_eq!(bench.ask(b":GM#"), b"My garden#");
    assert_eq!(bench.ask(b":GG#"), b"+05.5#");
    assert_eq!(bench.ask(b":Gr#"), b"12:34:56#");
    assert_eq!(bench.ask(b":Gd#"), b"-05\xDF23:28#");
}

#[test]
fn a_date_is_answered_in_two_parts_with_a_wait_between() {
    let mut bench = Bench::new();
    bench.mount.feed(b":SC03/04/27#", bench.now);
    assert_eq!(bench.wait_s(0.15), b"", "nothing before 0.2 s");
    assert_eq!(bench.wait_s(0.5), b"1Updating Planetary Data#");
    let second = bench.wait_s(6.0);
    assert_eq!(second.last(), Some(&b'#'));
    assert!(second.len() > 15 && second[..second.len() - 1].iter().all(|byte| *byte == b' '));
    assert_eq!(bench.ask(b":GC#"), b"03/04/27#");
}

#[test]
fn local_time_stays_when_the_zone_is_set_after_it() {
    let mut bench = Bench::new();
    bench.ask(b":SL22:30:00#");
    bench.ask(b":SG+03#");
    assert!(bench.shown(b":GL#").starts_with("22:30:0"));
}

#[test]
fn unknown_commands_and_stray_bytes_are_met_with_silence() {
    let mut bench = Bench::new();
    for bytes in [&b":XY#"[..], b"####", b"hello\r\n", b":#", b":GR:GD#", b":Gm#"] {
        assert_eq!(bench.ask(bytes), b"", "{}", bytes.escape_ascii());
    }
    assert_eq!(bench.ask(b"#:GVP#"), b"LX2001#", "and a leading # does no harm");
}

#[test]
fn silent_commands_are_silent() {
    let mut bench = Bench::new();
    for command in [
        ":Q#",
        ":Qn#",
        ":RG#",
        ":RS#",
        ":R7#",
        ":U#",
        ":F+#",
        ":FQ#",
        ":F3#",
        ":B+#",
        ":TQ#",
        ":T+#",
        ":hW#",
        ":W0#",
        ":g+#",
        ":r+#",
        ":$QZ+#",
        ":f+#",
        ":H#",
        ":LB#",
        ":EK9#",
        ":Mgn0100#",
        ":Rg15.0#",
        ":RA02.0#",
    ] {
        assert_eq!(bench.ask(command.as_bytes()), b"", "{command}");
    }
}

#[test]
fn a_byte_takes_a_millisecond_each_way_and_a_reply_begins_2_to_20_ms_after_the_hash() {
    for seed in 0..40 {
        let mut bench = Bench::with(Settings { seed, ..Settings::default() });
        bench.mount.feed(b":GR#", Duration::ZERO);
        let mut arrivals = Vec::new();
        for tenth in 0..1000u64 {
            let now = Duration::from_micros(100 * tenth);
            arrivals.extend(bench.mount.drain(now).into_iter().map(|_| now.as_secs_f64() * 1e3));
        }
        assert_eq!(arrivals.len(), 9);
        // Four bytes there take 4.17 ms, the first byte back 1.04 ms more.
        let wait = arrivals[0] - 4.17 - 1.04;
        assert!((1.9..20.3).contains(&wait), "seed {seed}: {wait} ms");
        let per_byte = (arrivals[8] - arrivals[0]) / 8.0;
        assert!((per_byte - 1.0417).abs() < 0.02, "{per_byte} ms a byte");
    }
}

#[test]
fn a_usb_adapter_hands_bytes_on_every_16_ms() {
    let mut bench = Bench::with(Settings { usb_batching: true, ..Settings::default() });
    bench.mount.feed(b":GR#:GD#", Duration::ZERO);
    for millisecond in 1..200 {
        let came = bench.mount.drain(Duration::from_millis(millisecond));
        assert!(came.is_empty() || millisecond % 16 == 0, "{} bytes at {millisecond} ms", came.len());
    }
}

#[test]
fn a_second_query_waits_until_the_first_is_answered() {
    let mut bench = Bench::new();
    let both = bench.ask(b":GVP#:GVN#");
    assert_eq!(both, b"LX2001#4.2l#");
}

#[test]
fn asleep_it_is_dead_until_it_is_woken() {
    let mut bench = Bench::new();
    let before = bench.shown(b":GR#");
    bench.ask(b":hN#");
    assert_eq!(bench.ask(b"\x06:GR#"), b"");
    bench.ask(b":hW#");
    assert_eq!(bench.shown(b":GR#"), before);
}

#[test]
fn commands_never_to_send_are_punished_as_on_the_real_mount() {
    for (command, ack) in [(&b"\x04"[..], &b"D"[..]), (b":SB1#", b"")] {
        let mut bench = Bench::new();
        bench.ask(command);
        assert_eq!(bench.ask(b":GR#"), b"", "after {}", command.escape_ascii());
        assert_eq!(bench.ask(b"\x06"), ack, "after {}", command.escape_ascii());
    }
}

#[test]
fn a_restart_says_x_loses_the_alignment_and_asks_for_the_date() {
    let mut bench = Bench::new();
    bench.ask(b":I#");
    assert_eq!(bench.ask(b":GR#"), b"");
    assert_eq!(bench.wait_s(11.0), b"X");
    assert_eq!(bench.ask(b":GW#"), b"AN0");
    assert!(bench.shown(b":ED#").contains("Daylight"));
    assert_eq!(bench.ask(b":hI260304223000#"), b"1");
    assert_eq!(bench.ask(b":GC#"), b"03/04/26#");
    assert!(!bench.shown(b":ED#").contains("Daylight"));
}
