//! No accepted go-to ever passes the Sun: held against a dense check of every path, written here from other formulas
//! (the almanac's Sun of Meeus, mean sidereal time, plain vectors) than the judgement's own.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::time::Duration;

use proptest::prelude::*;
use scotopic::numerics::streams::Stream;
use scotopic::safety::{
    Acknowledgement, Clock, Fix, Hazard, Mounting, Rules, Situation, TurnCounter, Verdict, judge_goto, judge_motion,
};
use scotopic::sky::coords::{Airless, Equatorial, Horizontal, OfDate};
use scotopic::sky::horizon::Horizon;
use scotopic::sky::pointing::Motion;
use scotopic::sky::site::Site;
use scotopic::sky::time::{Moment, Utc};
use scotopic::units::Angle;

/// The Sun and the sky of this test's own: degrees throughout.
mod almanac {
    /// Right ascension and declination of the Sun, to 0.01 degree. Meeus, *Astronomical Algorithms*, ch. 25, low accuracy.
    pub(crate) fn sun(unix_s: f64) -> (f64, f64) {
        let t = (unix_s / 86_400.0 + 2_440_587.5 - 2_451_545.0) / 36_525.0;
        let l0 = 280.466_46 + 36_000.769_83 * t;
        let m = (357.529_11 + 35_999.050_29 * t).to_radians();
        let centre = (1.914_602 - 0.004_817 * t) * m.sin()
            + (0.019_993 - 0.000_101 * t) * (2.0 * m).sin()
            + 0.000_289 * (3.0 * m).sin();
        let omega = (125.04 - 1934.136 * t).to_radians();
        let lambda = (l0 + centre - 0.005_69 - 0.004_78 * omega.sin()).to_radians();
        let eps = (23.439_29 - 0.013_004 * t + 0.002_56 * omega.cos()).to_radians();
        ((eps.cos() * lambda.sin()).atan2(lambda.cos()).to_degrees(), (eps.sin() * lambda.sin()).asin().to_degrees())
    }

    /// Mean sidereal time at Greenwich. Meeus, eq. 12.4.
    pub(crate) fn sidereal(unix_s: f64) -> f64 {
        280.460_618_37 + 360.985_647_366_29 * (unix_s / 86_400.0 + 2_440_587.5 - 2_451_545.0)
    }

    /// Azimuth (north through east) and altitude. Meeus, eqs. 13.5 and 13.6, azimuth counted from north.
    pub(crate) fn altaz(ra: f64, dec: f64, unix_s: f64, latitude: f64, longitude: f64) -> (f64, f64) {
        let h = (sidereal(unix_s) + longitude - ra).to_radians();
        let (phi, delta) = (latitude.to_radians(), dec.to_radians());
        let azimuth = h.sin().atan2(h.cos() * phi.sin() - delta.tan() * phi.cos()).to_degrees() + 180.0;
        (azimuth, (phi.sin() * delta.sin() + phi.cos() * delta.cos() * h.cos()).asin().to_degrees())
    }

    /// Distance on the sphere by the haversine.
    pub(crate) fn distance((a, h): (f64, f64), (b, k): (f64, f64)) -> f64 {
        let s = |x: f64| (x.to_radians() / 2.0).sin().powi(2);
        2.0 * (s(k - h) + h.to_radians().cos() * k.to_radians().cos() * s(b - a)).sqrt().min(1.0).asin().to_degrees()
    }
}

/// One go-to on one night at one place.
#[derive(Debug, Clone, Copy)]
struct Case {
    unix_s: f64,
    latitude: f64,
    longitude: f64,
    /// Azimuth and altitude of the start and of the target, at that time.
    from: (f64, f64),
    to: (f64, f64),
}

impl Case {
    fn site(&self) -> Site {
        Site::new(self.latitude, self.longitude, 0.0).expect("the case is on Earth")
    }

    fn of_date(&self, (azimuth, altitude): (f64, f64)) -> Equatorial<OfDate> {
        let at: Horizontal<Airless> = Horizontal::new(Angle::degrees(azimuth), Angle::degrees(altitude));
        Horizon::at(&Moment::at(Utc(self.unix_s)), &self.site()).of_date(&at)
    }

    fn situation(&self) -> Situation {
        Situation {
            position: Some(self.of_date(self.from)),
            motion: Motion::Tracking,
            site: Some(self.site()),
            clock: Clock::Stated(Utc(self.unix_s)),
            ..Situation::unknown()
        }
    }

    fn judged(&self) -> Verdict {
        judge_goto(&self.situation(), &self.of_date(self.to))
    }

    /// A place where the Sun stands at an hour angle now.
    fn by_day(unix_s: f64, latitude: f64, hour_angle: f64) -> Case {
        let longitude = almanac::sun(unix_s).0 + hour_angle - almanac::sidereal(unix_s);
        let longitude = (longitude + 180.0).rem_euclid(360.0) - 180.0;
        Case { unix_s, latitude, longitude, from: (0.0, 0.0), to: (0.0, 0.0) }
    }

    /// The Sun's azimuth and altitude some seconds later.
    fn sun(&self, after_s: f64) -> (f64, f64) {
        let (ra, dec) = almanac::sun(self.unix_s);
        almanac::altaz(ra, dec, self.unix_s + after_s, self.latitude, self.longitude)
    }

    /// The closest to a Sun above -2 degrees on one path, walked in steps of 0.25 degree: the axes at the given speeds, each
    /// waiting until its share of the way has come. `None` while the Sun is down.
    fn closest_on_path(&self, turn: f64, speeds: (f64, f64), waits: (f64, f64)) -> Option<f64> {
        let tilt = self.to.1 - self.from.1;
        let ends_s = (waits.0 + turn.abs() / speeds.0).max(waits.1 + tilt.abs() / speeds.1);
        let steps = (ends_s * speeds.0.max(speeds.1) / 0.25).ceil() as usize;
        let mut closest: Option<f64> = None;
        for step in 0..=steps {
            let t = ends_s * step as f64 / steps.max(1) as f64;
            let gone = |wait: f64, speed: f64, way: f64| way.signum() * (speed * (t - wait).max(0.0)).min(way.abs());
            let at = (self.from.0 + gone(waits.0, speeds.0, turn), self.from.1 + gone(waits.1, speeds.1, tilt));
            let sun = self.sun(t);
            if sun.1 > -2.0 {
                let distance = almanac::distance(at, sun);
                closest = Some(closest.map_or(distance, |least| least.min(distance)));
            }
        }
        closest
    }

    /// The turns of the azimuth axis: the shorter way and the longer one.
    fn turns(&self) -> (f64, f64) {
        let shorter = (self.to.0 - self.from.0 + 540.0).rem_euclid(360.0) - 180.0;
        (shorter, shorter - 360.0f64.copysign(shorter))
    }

    /// The closest of many paths: both ways round, either axis first, both together at several speeds.
    fn closest_on_paths(&self, turns: &[f64]) -> f64 {
        let tilt_s = |speed: f64| (self.to.1 - self.from.1).abs() / speed;
        let mut closest = f64::INFINITY;
        for turn in turns {
            let turn_s = |speed: f64| turn.abs() / speed;
            for (speeds, waits) in [
                ((8.0, 8.0), (0.0, 0.0)),
                ((8.0, 8.0), (tilt_s(8.0), 0.0)),
                ((8.0, 8.0), (0.0, turn_s(8.0))),
                ((8.0, 2.0), (0.0, 0.0)),
                ((2.0, 8.0), (0.0, 0.0)),
                ((6.0, 3.0), (tilt_s(3.0) / 2.0, 0.0)),
            ] {
                closest = closest.min(self.closest_on_path(*turn, speeds, waits).unwrap_or(f64::INFINITY));
            }
        }
        closest
    }

    /// The closest to a Sun above -2 degrees in an hour of tracking the target.
    fn closest_in_the_hour(&self) -> f64 {
        let target = self.of_date(self.to);
        (0..=360)
            .map(|step| f64::from(step) * 10.0)
            .filter(|after_s| self.sun(*after_s).1 > -2.0)
            .map(|after_s| {
                let (ra, dec) = almanac::sun(self.unix_s + after_s);
                almanac::distance((ra, dec), (target.ra().to_degrees(), target.dec().to_degrees()))
            })
            .fold(f64::INFINITY, f64::min)
    }
}

/// 1990 to 2090, anywhere, from and to anywhere above the horizon.
fn any_case() -> impl Strategy<Value = Case> {
    let altitude = || 0.5..89.5f64;
    (6.3e8..3.78e9f64, -90.0..90.0f64, -180.0..180.0f64, (0.0..360.0f64, altitude()), (0.0..360.0f64, altitude()))
        .prop_map(|(unix_s, latitude, longitude, from, to)| Case { unix_s, latitude, longitude, from, to })
}

fn seeded_case(stream: &mut Stream) -> Case {
    let mut between = |least: f64, most: f64| least + (most - least) * stream.uniform();
    Case {
        unix_s: between(6.3e8, 3.78e9),
        latitude: between(-90.0, 90.0),
        longitude: between(-180.0, 180.0),
        from: (between(0.0, 360.0), between(0.5, 89.5)),
        to: (between(0.0, 360.0), between(0.5, 89.5)),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, max_global_rejects: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The heart of it.
    #[test]
    fn no_accepted_goto_passes_the_sun_on_any_path_nor_tracks_into_it(case in any_case()) {
        if !case.judged().is_refused() {
            let start = case.sun(0.0);
            let started_inside = start.1 > -2.0 && almanac::distance(case.from, start) < 31.0;
            let (shorter, longer) = case.turns();
            let (turns, least) = if started_inside {
                // It may only leave, and the longer way is watched while it happens.
                (vec![shorter], almanac::distance(case.from, start).min(30.0) - 0.5)
            } else {
                (vec![shorter, longer], 30.0)
            };
            let closest = case.closest_on_paths(&turns);
            prop_assert!(closest >= least, "a path passes {closest} degrees from the Sun");
            let tracked = case.closest_in_the_hour();
            prop_assert!(tracked >= 30.0 - 0.02, "tracking comes within {tracked} degrees of the Sun");
        }
    }

    /// A guard that refuses everything is no guard: what is refused for its path has such a path.
    #[test]
    fn a_goto_refused_for_its_path_has_a_path_that_passes_the_sun(case in any_case()) {
        if let Verdict::Refused(Hazard::SunOnPath { closest, longer_way, .. }) = case.judged() {
            let (shorter, longer) = case.turns();
            let turn = if longer_way { longer } else { shorter };
            let sun = case.sun(0.0);
            let mut grid = f64::INFINITY;
            for i in 0..=360 {
                for j in 0..=180 {
                    let (u, v) = (f64::from(i) / 360.0, f64::from(j) / 180.0);
                    let at = (case.from.0 + turn * u, case.from.1 + (case.to.1 - case.from.1) * v);
                    grid = grid.min(almanac::distance(at, sun));
                }
            }
            prop_assert!((grid - closest.to_degrees()).abs() < 0.7, "said {}, found {grid}", closest.to_degrees());
        }
    }

    /// Straight up, straight down, or straight round away from the Sun, from within its cone.
    #[test]
    fn a_goto_that_leaves_the_cone_is_allowed(
        unix_s in 6.3e8..3.78e9f64, latitude in -50.0..50.0f64, hour_angle in -70.0..70.0f64,
        inside in 1.0..29.0f64, on in 32.0..45.0f64,
    ) {
        let mut case = Case::by_day(unix_s, latitude, hour_angle);
        let sun = case.sun(0.0);
        prop_assume!(sun.1 > 0.0);
        let away = if sun.1 < 45.0 { 1.0 } else { -1.0 };
        (case.from, case.to) = ((sun.0, sun.1 + away * inside), (sun.0, sun.1 + away * on));
        prop_assume!(case.to.1.min(case.from.1) > 0.0);
        let verdict = case.judged();
        prop_assert!(verdict.hazards().iter().any(|h| matches!(h, Hazard::LeavingSun { .. })), "{verdict:?}");
        prop_assert!(!verdict.is_refused(), "{verdict:?}");
        // The same way back is refused.
        (case.from, case.to) = (case.to, case.from);
        prop_assert!(case.judged().is_refused());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, max_global_rejects: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Motion by hand at full speed: by the time the stop takes hold, the tube is still outside the cone.
    #[test]
    fn a_slew_by_hand_is_stopped_before_the_cone(
        unix_s in 6.3e8..3.78e9f64, latitude in -50.0..50.0f64, hour_angle in -70.0..70.0f64,
        speed in 1.0..8.0f64, towards in -60.0..60.0f64, poll_s in 0.2..1.0f64,
    ) {
        let mut case = Case::by_day(unix_s, latitude, hour_angle);
        let sun = case.sun(0.0);
        prop_assume!(sun.1 > 0.0);
        // Round the azimuth axis towards the Sun, from 100 degrees away at another altitude.
        let altitude = (sun.1 + towards).clamp(1.0, 85.0);
        let mut azimuth = sun.0 - 100.0;
        prop_assume!(almanac::distance((azimuth, altitude), sun) > 50.0);
        loop {
            case.from = (azimuth, altitude);
            let before = Fix { at: Duration::from_secs_f64(100.0 - poll_s), position: case.of_date((azimuth - speed * poll_s, altitude)) };
            let latest = Fix { at: Duration::from_secs(100), position: case.of_date(case.from) };
            let situation = Situation { motion: Motion::Slewing, ..case.situation() };
            if judge_motion(&situation, &before, &latest).is_refused() {
                let separation = almanac::distance(case.from, sun);
                prop_assert!(separation >= 30.0 - 0.1, "seen only {separation} degrees from the Sun");
                break;
            }
            // Not stopped: the next second and a half cannot reach the cone.
            let reached = almanac::distance((azimuth + speed * 1.5, altitude), sun);
            prop_assert!(reached >= 30.0 - 0.1, "let go on to {reached} degrees");
            azimuth += speed * poll_s;
            if azimuth > sun.0 {
                break;
            }
        }
    }
}

#[test]
fn the_random_cases_are_not_empty() {
    let mut stream = Stream::seeded(8);
    let (mut day_allowed, mut day_refused, mut night_allowed) = (0, 0, 0);
    for _ in 0..3000 {
        let case = seeded_case(&mut stream);
        match (case.sun(0.0).1 > -2.0, case.judged().is_refused()) {
            (true, true) => day_refused += 1,
            (true, false) => day_allowed += 1,
            (false, false) => night_allowed += 1,
            (false, true) => {}
        }
    }
    assert!(
        day_allowed > 200 && day_refused > 200 && night_allowed > 1000,
        "{day_allowed} {day_refused} {night_allowed}"
    );
}

/// Helsinki, 2026-11-22T20:00:00Z: deep night.
fn night() -> Case {
    Case { unix_s: 1_795_377_600.0, latitude: 60.17, longitude: 24.94, from: (120.0, 40.0), to: (250.0, 60.0) }
}

/// The same place at noon of midsummer: the Sun 53 degrees high in the south.
fn noon() -> Case {
    let unix_s = Utc::from_rfc3339("2026-06-21T10:22:00Z").expect("a time").0;
    Case { unix_s, latitude: 60.17, longitude: 24.94, from: (0.0, 70.0), to: (0.0, 40.0) }
}

#[test]
fn at_night_a_goto_is_allowed() {
    assert_eq!(night().judged(), Verdict::Allowed);
}

#[test]
fn an_unknown_clock_site_or_position_refuses_and_says_what_to_do() {
    let case = night();
    let target = case.of_date(case.to);
    for (situation, reason, advice) in [
        (Situation { clock: Clock::Unknown, ..case.situation() }, "date and time are unknown", "set date and time"),
        (Situation { site: None, ..case.situation() }, "site is unknown", "--site"),
        (Situation { position: None, ..case.situation() }, "not known now", "wait for the mount's position"),
        (Situation { clock: Clock::Measured(Utc(1.05e9)), ..case.situation() }, "2003-04-10", "set date and time"),
    ] {
        let Verdict::Refused(hazard) = judge_goto(&situation, &target) else { panic!("allowed without {reason}") };
        assert!(hazard.to_string().contains(reason), "{hazard}");
        assert!(hazard.advice().contains(advice), "{}", hazard.advice());
    }
}

#[test]
fn a_target_beside_the_sun_is_refused_with_its_distance_and_allowed_with_a_filter_and_the_words() {
    let mut case = noon();
    let sun = case.sun(0.0);
    (case.from, case.to) = ((sun.0, 89.0), (sun.0, sun.1 + 20.0));
    let Verdict::Refused(hazard) = case.judged() else { panic!("a go-to 20 degrees from the Sun was allowed") };
    assert!(hazard.to_string().starts_with("the target is 20.0° from the Sun, inside the cone of 30.0°"), "{hazard}");
    assert!(hazard.advice().contains("certified solar filter fitted"));

    let rules = Rules { sun_cone_deg: 5.0, either_way_round: false, ..Rules::default() };
    let target = case.of_date(case.to);
    let asked = Situation { rules, ..case.situation() };
    assert!(judge_goto(&asked, &target).is_refused(), "a smaller cone in the settings is not enough");
    let words = Acknowledgement::typed("certified solar filter fitted").expect("the words");
    assert!(!judge_goto(&Situation { acknowledged: Some(words), ..asked }, &target).is_refused());
}

#[test]
fn the_longer_way_round_counts_because_the_mount_chooses() {
    // From north-west to north-east at 40 degrees: the shorter way through north is free, the longer one meets the Sun.
    let case = Case { from: (300.0, 40.0), to: (60.0, 40.0), ..noon() };
    let Verdict::Refused(Hazard::SunOnPath { longer_way: true, closest, .. }) = case.judged() else {
        panic!("{:?}", case.judged())
    };
    assert!((closest.to_degrees() - (case.sun(0.0).1 - 40.0)).abs() < 0.1);
    // Nothing stands against it high up, where both ways keep away.
    assert!(!Case { from: (300.0, 86.0), to: (60.0, 86.0), ..noon() }.judged().is_refused());
}

#[test]
fn a_sunrise_within_the_hour_refuses_what_the_sun_will_reach_and_not_the_rest() {
    let mut case = night();
    // Walk to 40 minutes before the Sun counts.
    while case.sun(2400.0).1 < -2.0 {
        case.unix_s += 60.0;
    }
    let rising = case.sun(2400.0);
    let sun_now = case.sun(0.0);
    assert!(sun_now.1 < -4.0, "the Sun is down: {}", sun_now.1);
    case.from = (rising.0 + 180.0, 50.0);
    case.to = (sun_now.0, 10.0);
    let Verdict::Refused(Hazard::SunRises { minutes, .. }) = case.judged() else { panic!("{:?}", case.judged()) };
    assert!((minutes - 40.0).abs() <= 2.0, "{minutes} min");
    case.to = (rising.0 + 180.0, 30.0);
    assert!(!case.judged().is_refused());
}

#[test]
fn the_polar_night_is_free_and_the_polar_day_guarded_at_midnight() {
    let at = |time: &str| Utc::from_rfc3339(time).expect("a time").0;
    let winter = Case { unix_s: at("2026-12-21T11:00:00Z"), latitude: 78.2, longitude: 15.6, ..night() };
    let summer = Case { unix_s: at("2026-06-21T23:00:00Z"), ..winter };
    let towards = |case: Case| Case { from: (case.sun(0.0).0 + 180.0, 80.0), to: (case.sun(0.0).0, 20.0), ..case };
    assert!(!towards(winter).judged().is_refused());
    assert!(towards(summer).judged().is_refused());
}

#[test]
fn below_the_floor_is_refused_and_coming_up_from_below_is_allowed() {
    let low = Case { to: (250.0, -5.0), ..night() };
    let Verdict::Refused(hazard) = low.judged() else { panic!("a go-to below the horizon was allowed") };
    assert!(hazard.to_string().contains("-5.0° high there, below the floor of 0.0°"), "{hazard}");
    let up = Case { from: (250.0, -60.0), to: (250.0, 30.0), ..night() };
    assert!(
        matches!(up.judged(), Verdict::Warned(h) if matches!(h[..], [Hazard::Returning { .. }])),
        "{:?}",
        up.judged()
    );
    let on_the_way = Case { from: (250.0, -60.0), to: (250.0, -10.0), ..night() };
    assert!(!on_the_way.judged().is_refused(), "higher than it stands is on the way back");
    let further = Case { from: (250.0, -10.0), to: (250.0, -60.0), ..night() };
    assert!(further.judged().is_refused());
}

#[test]
fn a_ceiling_refuses_what_is_above_it_and_names_both_numbers() {
    let case = Case { to: (250.0, 88.0), ..night() };
    let situation = Situation { rules: Rules { altitude_ceiling_deg: 80.0, ..Rules::default() }, ..case.situation() };
    let Verdict::Refused(hazard) = judge_goto(&situation, &case.of_date(case.to)) else { panic!("above the ceiling") };
    assert_eq!(hazard.to_string(), "it is 88.0° high there, above the ceiling of 80.0°");
}

#[test]
fn a_target_that_crosses_the_zenith_within_the_hour_is_allowed_with_a_word() {
    // 20 minutes of time east of the meridian at the declination of the latitude: overhead in 20 minutes.
    let case = night();
    let sidereal = Moment::at(Utc(case.unix_s)).sidereal_time(Angle::degrees(case.longitude));
    let target = Equatorial::new(sidereal + Angle::degrees(5.0), Angle::degrees(case.latitude));
    let verdict = judge_goto(&case.situation(), &target);
    assert!(matches!(verdict.hazards(), [Hazard::NearZenith { .. }]) && !verdict.is_refused(), "{verdict:?}");
}

/// A cable wound by so much, at the end of it the telescope at an azimuth.
fn turned(degrees: f64, azimuth: f64) -> TurnCounter {
    let mut turns = TurnCounter::unwound();
    for i in 0..=100u64 {
        let passing = azimuth - degrees + degrees * i as f64 / 100.0;
        turns.observe(Angle::degrees(passing), Duration::from_millis(i * 500));
    }
    turns
}

#[test]
fn the_cable_is_warned_of_at_270_refused_at_360_and_free_to_unwind() {
    // End at azimuth 120, where the night's telescope points.
    let turned = |degrees| turned(degrees, 120.0);
    let judge = |degrees: f64, azimuth: f64| {
        let case = Case { to: (azimuth, 50.0), ..night() };
        judge_goto(&Situation { turns: turned(degrees), ..case.situation() }, &case.of_date(case.to))
    };
    assert_eq!(judge(100.0, 220.0), Verdict::Allowed);
    assert!(matches!(judge(200.0, 220.0).hazards(), [Hazard::WindingUp { .. }]));
    let refused = judge(300.0, 220.0);
    let Verdict::Refused(hazard) = &refused else { panic!("{refused:?}") };
    assert!(
        hazard.to_string().contains("turned 300.0°") && hazard.to_string().contains("would reach 400.0°"),
        "{hazard}"
    );
    assert!(hazard.to_string().contains("end at 40.0°"), "{hazard}");
    assert!(hazard.advice().contains("anticlockwise"), "{}", hazard.advice());
    assert!(!judge(300.0, 20.0).is_refused(), "turning back is allowed");
    assert!(!judge(400.0, 20.0).is_refused(), "turning back from beyond the limit is allowed");
    assert!(judge(-300.0, 20.0).is_refused());
}

/// The motion between two azimuths and altitudes half a second apart.
fn moving(case: &Case, motion: Motion, from: (f64, f64), to: (f64, f64)) -> Verdict {
    let before = Fix { at: Duration::from_millis(10_000), position: case.of_date(from) };
    let latest = Fix { at: Duration::from_millis(10_500), position: case.of_date(to) };
    judge_motion(&Situation { motion, ..case.situation() }, &before, &latest)
}

#[test]
fn a_slew_by_hand_down_to_the_floor_is_stopped_in_time_and_up_from_below_is_not() {
    let case = night();
    let stopped = moving(&case, Motion::Slewing, (200.0, 14.0), (200.0, 10.0));
    assert!(
        matches!(stopped, Verdict::Refused(Hazard::TooLow { .. })),
        "8 degrees a second, 10 degrees high: {stopped:?}"
    );
    assert!(!moving(&case, Motion::Slewing, (200.0, 34.0), (200.0, 30.0)).is_refused());
    assert!(!moving(&case, Motion::Slewing, (200.0, 10.1), (200.0, 10.0)).is_refused());
    assert!(!moving(&case, Motion::Slewing, (200.0, -30.0), (200.0, -26.0)).is_refused());
}

#[test]
fn an_ordered_slew_is_not_stopped_for_running_fast_towards_a_low_target() {
    let case = Case { to: (200.0, 2.0), ..night() };
    let before = Fix { at: Duration::from_millis(10_000), position: case.of_date((200.0, 14.0)) };
    let latest = Fix { at: Duration::from_millis(10_500), position: case.of_date((200.0, 10.0)) };
    let situation = Situation { motion: Motion::Slewing, ordered: Some(case.of_date(case.to)), ..case.situation() };
    assert!(!judge_motion(&situation, &before, &latest).is_refused());
}

#[test]
fn a_goto_out_of_the_cone_is_not_stopped_before_the_mount_gets_going() {
    let mut case = noon();
    let (az, alt) = case.sun(0.0);
    (case.from, case.to) = ((az, alt - 20.0), (az, alt - 45.0));
    let fix = |ms| Fix { at: Duration::from_millis(ms), position: case.of_date(case.from) };
    let tracking = Situation { motion: Motion::Tracking, ..case.situation() };
    assert!(judge_motion(&tracking, &fix(0), &fix(500)).is_refused());
    let ordered = Situation { ordered: Some(case.of_date(case.to)), ..tracking };
    assert!(!judge_motion(&ordered, &fix(0), &fix(500)).is_refused());
}

#[test]
fn an_ordered_slew_that_takes_the_dangerous_way_round_is_stopped() {
    // Ordered out of the cone through the north; the mount goes the other way, under the Sun.
    let case = Case { to: (10.0, 40.0), ..noon() };
    let sun = case.sun(0.0);
    let situation = |motion| Situation { motion, ordered: Some(case.of_date(case.to)), ..case.situation() };
    let fix = |ms, azimuth: f64| Fix { at: Duration::from_millis(ms), position: case.of_date((azimuth, 40.0)) };
    let wrong = judge_motion(&situation(Motion::Slewing), &fix(0, sun.0 + 54.0), &fix(500, sun.0 + 50.0));
    assert!(wrong.is_refused(), "{wrong:?}");
    let right = judge_motion(&situation(Motion::Slewing), &fix(0, sun.0 + 50.0), &fix(500, sun.0 + 54.0));
    assert!(!right.is_refused(), "{right:?}");
}

#[test]
fn a_slew_that_overshoots_its_target_is_not_taken_for_one_the_long_way_round() {
    let case = Case { to: (170.0, 82.0), ..night() };
    let ordered = Some(case.of_date(case.to));
    let situation = Situation { motion: Motion::Slewing, ordered, turns: turned(138.5, 170.0), ..case.situation() };
    let fix = |ms, azimuth: f64| Fix { at: Duration::from_millis(ms), position: case.of_date((azimuth, 82.0)) };
    let past = judge_motion(&situation, &fix(0, 169.8), &fix(250, 170.4));
    assert!(!past.is_refused(), "{past:?}");
    let away = judge_motion(&situation, &fix(0, 208.0), &fix(250, 210.0));
    assert!(matches!(away, Verdict::Refused(Hazard::Wound { .. })), "{away:?}");
}

#[test]
fn in_the_cone_motion_away_goes_on_and_motion_towards_is_stopped() {
    let case = noon();
    let (az, alt) = case.sun(0.0);
    let at = |distance: f64| (az, alt - distance);
    assert!(matches!(moving(&case, Motion::Slewing, at(20.0), at(22.0)).hazards(), [Hazard::LeavingSun { .. }]));
    assert!(matches!(moving(&case, Motion::Slewing, at(22.0), at(20.0)), Verdict::Refused(Hazard::SunInField { .. })));
    assert!(matches!(moving(&case, Motion::Slewing, at(38.0), at(36.0)), Verdict::Refused(Hazard::SunAhead { .. })));
    assert!(matches!(moving(&case, Motion::Tracking, at(20.0), at(20.0)), Verdict::Refused(Hazard::SunInField { .. })));
}

#[test]
fn a_telescope_that_stands_still_is_warned_before_the_sun_drifts_in() {
    let case = noon();
    // The Sun moves west, towards larger azimuth, here by about 25 degrees an hour.
    let (az, alt) = case.sun(0.0);
    let ahead = (az + 65.0, alt);
    assert!(almanac::distance(ahead, (az, alt)) > 34.0);
    let verdict = moving(&case, Motion::Stopped, ahead, ahead);
    let [Hazard::SunDriftsIn { minutes, .. }] = verdict.hazards() else { panic!("{verdict:?}") };
    let found =
        (0..3600).map(f64::from).find(|s| almanac::distance(ahead, case.sun(*s)) < 30.0).expect("it drifts in") / 60.0;
    assert!((minutes - found).abs() < 2.5, "said {minutes}, found {found}");
}

#[test]
fn motion_without_a_clock_is_told_and_left_to_the_person_at_the_hand_controller() {
    let case = night();
    let fix = |ms, altitude| Fix { at: Duration::from_millis(ms), position: case.of_date((100.0, altitude)) };
    let situation = Situation { clock: Clock::Unknown, motion: Motion::Slewing, ..case.situation() };
    let verdict = judge_motion(&situation, &fix(0, 40.0), &fix(500, 41.0));
    assert!(matches!(verdict.hazards(), [Hazard::Clock(_)]) && !verdict.is_refused());
}

#[test]
fn on_a_wedge_the_way_is_judged_in_hour_angle_and_declination() {
    // Same declination, both sides of the Sun: an alt-azimuth way over the top is free, the wedge passes the Sun.
    let case = noon();
    let sidereal = Moment::at(Utc(case.unix_s)).sidereal_time(Angle::degrees(case.longitude));
    let (ra, dec) = almanac::sun(case.unix_s);
    let at = |offset: f64| Equatorial::new(Angle::degrees(ra + offset), Angle::degrees(dec));
    assert!(sidereal.is_finite());
    let situation = Situation { mounting: Mounting::Equatorial, position: Some(at(-60.0)), ..case.situation() };
    let verdict = judge_goto(&situation, &at(60.0));
    let Verdict::Refused(Hazard::SunOnPath { closest, .. }) = verdict else { panic!("{verdict:?}") };
    assert!(closest.to_degrees() < 0.1, "straight through the Sun: {}", closest.to_degrees());
}
