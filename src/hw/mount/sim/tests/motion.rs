//! Go-tos, moves by hand, tracking, and what the true axis does that the mount does not know.

use super::*;
use crate::units::Angle;

/// Right ascension as told, in seconds of time.
fn ra_s(bench: &mut Bench) -> f64 {
    let text = bench.ask(b":GR#");
    angles::read_hours(&text[..8]).unwrap() * 3600.0
}

#[test]
fn a_goto_answers_a_bare_zero_shows_its_bar_and_arrives() {
    let mut bench = Bench::new();
    assert_eq!(bench.go_by(60.0, 10.0), b"0");
    assert_eq!(bench.ask(b":D#"), b"\x7F#");
    let seconds = bench.arrive();
    // 60 degrees at 8 degrees a second, and two seconds to speed up and slow down.
    assert!((8.0..13.0).contains(&seconds), "{seconds} s");
    assert_eq!(bench.ask(b":GR#"), bench.ask(b":Gr#"));
    assert_eq!(bench.ask(b":GD#"), bench.ask(b":Gd#"));
}

#[test]
fn below_the_horizon_and_above_the_limit_it_says_so_and_stays() {
    let mut bench = Bench::new();
    assert_eq!(bench.go_by(0.0, -50.0), b"1Object Below Horizon#");
    bench.ask(b":Sh60#");
    assert_eq!(bench.go_by(0.0, 30.0), b"2Object Above Limit#");
    assert_eq!(bench.ask(b":D#"), b"#");
    assert!(bench.mount.axis_speeds_deg_s(bench.now).0.abs() < 0.1);
}

#[test]
fn an_abort_coasts_out_within_two_seconds_and_then_tracks() {
    let mut bench = Bench::new();
    bench.go_by(90.0, 0.0);
    bench.wait_s(3.0);
    assert!((bench.mount.axis_speeds_deg_s(bench.now).0 - 8.0).abs() < 0.01, "full speed");
    let before = bench.mount.controller.encoders().0;
    bench.ask(b":Q#");
    bench.wait_s(2.1);
    let coasted = bench.mount.controller.encoders().0 - before;
    // v^2 / 2a = 8 degrees, and what it ran while the command was on its way.
    assert!((7.5..10.0).contains(&coasted), "{coasted} degrees");
    let stopped = (bench.shown(b":GR#"), bench.shown(b":GD#"));
    bench.wait_s(30.0);
    assert_eq!((bench.shown(b":GR#"), bench.shown(b":GD#")), stopped);
}

#[test]
fn a_move_by_hand_lasts_until_its_stop_and_shows_no_bar() {
    let mut bench = Bench::new();
    bench.ask(b":R8#");
    let (_, before) = bench.mount.controller.encoders();
    bench.ask(b":Mn#");
    bench.wait_s(5.0);
    assert_eq!(bench.ask(b":D#"), b"#");
    let (_, after) = bench.mount.controller.encoders();
    assert!((14.0..16.0).contains(&(after - before)), "3 degrees a second for 5 s: {}", after - before);
    bench.ask(b":Qn#");
    bench.wait_s(1.0);
    let still = bench.shown(b":GD#");
    bench.wait_s(10.0);
    assert_eq!(bench.shown(b":GD#"), still);
}

#[test]
fn east_makes_right_ascension_grow_in_both_hemispheres() {
    for latitude in [49.0, -49.0] {
        let site = crate::sky::site::Site::new(latitude, 0.0, 0.0).unwrap();
        let mut bench = Bench::with(Settings::at(site, Utc(1_795_730_400.0)));
        // Look at the equator on the meridian, where east is plain.
        bench.ask(if latitude > 0.0 { b":Sz180*00#" } else { b":Sz000*00#" });
        bench.ask(b":Sa+41*00#");
        assert_eq!(bench.ask(b":MA#"), b"0");
        bench.arrive();
        let before = ra_s(&mut bench);
        bench.ask(b":R7#:Me#");
        bench.wait_s(2.0);
        bench.ask(b":Qe#");
        let moved = (ra_s(&mut bench) - before).rem_euclid(86_400.0);
        assert!((300.0..2000.0).contains(&moved), "latitude {latitude}: {moved} s");
    }
}

#[test]
fn without_tracking_right_ascension_grows_by_a_second_a_second() {
    // [CAP]: RA 05:29:28 -> :29 -> :30 while :GW# said N.
    let mut bench = Bench::with_fault("not-tracking=on");
    assert_eq!(bench.ask(b":GW#"), b"AN2");
    let before = ra_s(&mut bench);
    bench.wait_s(59.85);
    assert!((ra_s(&mut bench) - before - 60.16).abs() < 1.1);
}

#[test]
fn tracking_holds_the_coordinates_for_hours_while_the_axes_turn() {
    let mut bench = Bench::new();
    let before = (bench.shown(b":GR#"), bench.shown(b":GD#"));
    let (_, altitude) = bench.mount.controller.encoders();
    bench.now += Duration::from_secs(3 * 3600);
    bench.mount.drain(bench.now);
    assert_eq!((bench.shown(b":GR#"), bench.shown(b":GD#")), before);
    assert!((bench.mount.controller.encoders().1 - altitude).abs() > 10.0);
}

#[test]
fn the_lunar_rate_lets_right_ascension_creep_as_the_moon_does() {
    let mut bench = Bench::new();
    let before = ra_s(&mut bench);
    bench.ask(b":TL#");
    bench.wait_s(600.0);
    // (1 - 57.9 / 60.164) of 15.04 arcseconds a second: 34 arcseconds a minute, the Moon's mean motion being 33.
    let arcsec_per_minute = (ra_s(&mut bench) - before) * 15.0 / 10.0;
    assert!((30.0..38.0).contains(&arcsec_per_minute), "{arcsec_per_minute}");
}

#[test]
fn a_sync_moves_what_is_believed_and_not_the_tube() {
    let mut bench = Bench::new();
    let tube = bench.mount.true_axis(bench.now);
    bench.ask(b":Sr06:38:00#");
    bench.ask(b":Sd+69*00:00#");
    assert_eq!(bench.ask(b":CM#"), b" M31 EX GAL MAG 3.5 SZ178.0'#");
    assert_eq!(bench.ask(b":GR#"), b"06:38:00#");
    assert_eq!(bench.ask(b":GD#"), b"+69\xDF00:00#");
    assert!(bench.mount.true_axis(bench.now).separation(&tube).to_arcseconds() < 10.0);
}

#[test]
fn a_guide_pulse_moves_by_its_milliseconds() {
    let mut bench = Bench::new();
    let (_, before) = bench.mount.controller.encoders();
    let sky = bench.mount.reported(bench.now);
    bench.ask(b":Mgn2000#");
    bench.wait_s(3.0);
    let moved = bench.mount.reported(bench.now).separation(&sky).to_arcseconds();
    assert!((28.0..32.0).contains(&moved), "15 arcseconds a second for 2 s: {moved} (altitude was {before})");
}

#[test]
fn pointing_error_worm_drift_and_push_move_the_true_axis_only() {
    let mut settings = Settings { drift_arcsec_per_s: 0.5, ..Settings::default() };
    settings.faults.switch("push=100,3,-1").unwrap();
    let mut bench = Bench::with(settings);
    let apart = |bench: &mut Bench| {
        let reported = bench.mount.reported(bench.now);
        bench.mount.true_axis(bench.now).separation(&reported)
    };
    let told = bench.shown(b":GR#:GD#");
    let at_first = apart(&mut bench);
    assert!((20.0..400.0).contains(&at_first.to_arcseconds()), "{}", at_first.to_arcseconds());
    bench.wait_s(90.0);
    assert!((apart(&mut bench) - at_first).abs().to_arcseconds() > 5.0, "drift and worms");
    bench.wait_s(20.0);
    assert!(apart(&mut bench) > Angle::degrees(1.0), "pushed");
    assert_eq!(bench.shown(b":GR#:GD#"), told);
}

#[test]
fn without_errors_the_true_axis_is_the_reported_one() {
    let settings = Settings { pointing_error: Angle::ZERO, periodic_error: Angle::ZERO, ..Settings::default() };
    let mut bench = Bench::with(settings);
    bench.go_by(50.0, -20.0);
    bench.arrive();
    let (told, real) = (bench.mount.reported(bench.now), bench.mount.true_axis(bench.now));
    assert!(told.separation(&real).to_arcseconds() < 1e-6);
}

#[test]
fn parked_it_answers_and_does_not_move() {
    let mut bench = Bench::new();
    bench.ask(b":hP#");
    bench.wait_s(40.0);
    assert_eq!(bench.ask(b":GW#"), b"ANP", "as the capture says it");
    bench.ask(b":Sr06:00:00#");
    bench.ask(b":Sd+69*00:00#");
    bench.ask(b":MS#");
    bench.ask(b":Mn#");
    bench.wait_s(2.0);
    assert_eq!(bench.mount.axis_speeds_deg_s(bench.now), (0.0, 0.0));
}
