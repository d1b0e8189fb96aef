//! Sun, Moon, planets and their moons against Swiss Ephemeris, other theories of the moons, and worked examples of a textbook.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/reference.rs"]
mod reference;

use proptest::prelude::*;
use reference::{number, of_date, rows};
use scotopic::sky::ephemeris::{Body, Ephemeris, moons};
use scotopic::sky::horizon::Horizon;
use scotopic::sky::physical::{Aspect, Rotation};
use scotopic::sky::site::Site;
use scotopic::sky::time::{Moment, Utc};

fn at(utc: &str, delta_t_s: f64) -> Ephemeris {
    Ephemeris::at(&Moment { utc: Utc::from_rfc3339(utc).unwrap(), delta_t_s }).unwrap()
}

/// Terrestrial time as a Julian date.
fn at_jde(jde: f64) -> Ephemeris {
    let delta_t_s = 64.0;
    Ephemeris::at(&Moment { utc: Utc((jde - 2_440_587.5) * 86_400.0 - delta_t_s), delta_t_s }).unwrap()
}

#[test]
fn sun_moon_and_planets_stand_within_three_arcseconds_of_the_reference() {
    let rows = rows("solar_places.csv");
    assert_eq!(rows.len(), 81);
    for row in &rows {
        let [body, utc, delta_t, lat, lon, elev, ra, dec, au, ra_topo, dec_topo, diameter] = &row[..] else {
            panic!("{row:?}")
        };
        let ephemeris = at(utc, number(delta_t));
        let place = ephemeris.place(Body::from_name(body).unwrap());
        let off = place.apparent.separation(&of_date(ra, dec)).to_arcseconds();
        assert!(off < 1.5, "{body} {utc}: {off:.3} arcseconds");
        // The reference's vector has aberration in its length too: up to v/c = 1.01e-4. Without it Swiss Ephemeris agrees to 1e-5.
        assert!((place.distance_au - number(au)).abs() < 1.1e-4 * number(au), "{body} {utc}: {} au", place.distance_au);
        // From 2026 on the reference turned its sites by another delta T than the row's: half a minute of the Moon's parallax.
        if utc.as_str() > "2026" && body == "Moon" {
            continue;
        }
        let site = Site::new(number(lat), number(lon), number(elev)).unwrap();
        let seen = place.topocentric(ephemeris.reduction(), &site);
        let off = seen.apparent.separation(&of_date(ra_topo, dec_topo)).to_arcseconds();
        assert!(off < 1.8, "{body} {utc}: {off:.3} arcseconds from the site");
        let off = place.angular_diameter(seen.distance_au).to_arcseconds() - number(diameter);
        assert!(off.abs() < 2e-4 * number(diameter) + 5e-4, "{body} {utc}: diameter off by {off} arcseconds");
    }
}

#[test]
fn two_centuries_of_swiss_ephemeris_are_met_within_the_error_that_is_told() {
    let rows = rows("swisseph_places.csv");
    assert_eq!(rows.len(), 234);
    let mut outside = 0;
    for row in &rows {
        let [body, jde, ra, dec, au] = &row[..] else { panic!("{row:?}") };
        let ephemeris = at_jde(number(jde));
        let place = ephemeris.place(Body::from_name(body).unwrap());
        let off = place.apparent.separation(&of_date(ra, dec)).to_arcseconds();
        let told = ephemeris.error().to_arcseconds();
        assert!(off < told, "{body} {jde}: {off:.3} arcseconds, {told:.1} told");
        assert!((place.distance_au - number(au)).abs() < 2e-4 * number(au), "{body} {jde}");
        if ephemeris.centuries_outside() > 0.0 {
            outside += 1;
        } else {
            assert!(off < 2.0 && told <= 2.0, "{body} {jde}: {off:.3} of {told:.1} arcseconds");
        }
    }
    assert_eq!(outside, 18, "the years 1600 and 2400");
}

#[test]
fn moons_stand_where_their_theories_say() {
    let rows = rows("solar_moons.csv");
    assert_eq!(rows.len(), 127);
    for row in &rows {
        let [name, utc, delta_t, east, north, front] = &row[..] else { panic!("{row:?}") };
        let planet = match name.as_str() {
            "Phobos" | "Deimos" => Body::Mars,
            "Io" | "Europa" | "Ganymede" | "Callisto" => Body::Jupiter,
            "Ariel" | "Umbriel" | "Titania" | "Oberon" | "Miranda" => Body::Uranus,
            _ => Body::Saturn,
        };
        let most = match name.as_str() {
            "Titan" => 2.0,
            "Hyperion" | "Iapetus" => 4.0,
            _ => 1.5,
        };
        let ephemeris = at(utc, number(delta_t));
        let found = moons::beside(&ephemeris, &ephemeris.place(planet));
        let moon = found.iter().find(|moon| moon.name == name).unwrap();
        let off = (moon.east.to_arcseconds() - number(east)).hypot(moon.north.to_arcseconds() - number(north));
        assert!(off < most, "{name} {utc}: {off:.3} arcseconds");
        assert_eq!(moon.in_front, number(front) > 0.0, "{name} {utc}");
        assert!(!moon.hidden || !moon.in_front);
    }
}

/// astronomy-engine and ephem; ephem's central meridians of Jupiter and colongitudes are too rough and are held to Meeus below.
#[test]
fn poles_phases_rings_and_librations_are_within_a_tenth_of_a_degree() {
    let rows = rows("solar_physical.csv");
    assert_eq!(rows.len(), 208);
    for row in &rows {
        let [name, utc, delta_t, quantity, value] = &row[..] else { panic!("{row:?}") };
        let ephemeris = at(utc, number(delta_t));
        let body = Body::from_name(name).unwrap();
        let place = ephemeris.place(body);
        let aspect = Aspect::geocentric(&ephemeris, &place);
        let (ours, within) = match quantity.as_str() {
            "ring_tilt_earth_deg" => (aspect.ring_tilt().unwrap().to_degrees(), 0.1),
            "ring_tilt_sun_deg" => (aspect.sub_sun.1.to_degrees(), 0.1),
            "libration_lat_deg" => (aspect.libration().unwrap().1.to_degrees(), 0.1),
            "libration_lon_deg" => (aspect.libration().unwrap().0.to_degrees(), 0.1),
            "geocentric_angdiam_deg" => (place.angular_diameter(place.distance_au).to_degrees(), 1e-4),
            "phase_fraction" => (aspect.phase(), 2e-4),
            "mag" => (aspect.magnitude.0, 0.2),
            "pole_ra_j2000_h" => (aspect.pole.ra().to_hours(), 0.1 / 15.0),
            "pole_dec_j2000_deg" => (aspect.pole.dec().to_degrees(), 0.1),
            "spin_W_deg" => (Rotation::of(body, ephemeris.jde()).prime_meridian.to_degrees(), 0.1),
            other => panic!("{other}"),
        };
        let off = (ours - number(value)).abs();
        assert!(off < within || (quantity == "spin_W_deg" && off > 360.0 - within), "{row:?}: {ours}");
    }
}

fn near(what: &str, ours: f64, book: f64, within: f64) {
    assert!((ours - book).abs() <= within, "{what}: {ours:.4} is not {book}");
}

/// Meeus, *Astronomical Algorithms*, 2nd edition: examples 43.a (Jupiter; his meridians are corrected for the phase by 0.43
/// degree), 53.a (Moon), 42.a (Mars), 29.a (Sun), 45.a (Saturn).
#[test]
fn the_textbooks_examples_come_out() {
    let jupiter = at("1992-12-16T00:00:00Z", 59.0);
    let aspect = Aspect::geocentric(&jupiter, &jupiter.place(Body::Jupiter));
    let phase = 57.2958 * (aspect.phase_angle / 2.0).sin().powi(2);
    near("43.a system I", aspect.central_meridians[0].1.to_degrees() + phase, 268.06, 0.1);
    near("43.a system II", aspect.central_meridians[1].1.to_degrees() + phase, 72.74, 0.1);
    near("43.a D_E", aspect.sub_observer.1.to_degrees(), -2.48, 0.05);
    near("43.a D_S", aspect.sub_sun.1.to_degrees(), -2.20, 0.05);
    near("43.a P", aspect.pole_position_angle.to_degrees(), 24.80, 0.05);

    let moon = at("1992-04-12T00:00:00Z", 0.0);
    let aspect = Aspect::geocentric(&moon, &moon.place(Body::Moon));
    let (longitude, latitude) = aspect.libration().unwrap();
    near("53.a l", longitude.to_degrees(), -1.23, 0.05);
    near("53.a b", latitude.to_degrees(), 4.20, 0.05);
    near("53.a P", aspect.pole_position_angle.to_degrees(), 15.08, 0.05);
    near("53.a c0", aspect.colongitude().unwrap().to_degrees(), 22.11, 0.05);
    near("53.a b0", aspect.sub_sun.1.to_degrees(), 1.46, 0.05);
    near("48.a k", aspect.phase(), 0.6786, 0.001);
    near("48.a chi", aspect.bright_limb_position_angle.to_degrees(), 285.0, 0.1);

    let mars = at("1992-11-09T00:00:00Z", 59.0);
    let aspect = Aspect::geocentric(&mars, &mars.place(Body::Mars));
    near("42.a D_E", aspect.sub_observer.1.to_degrees(), 12.44, 0.05);
    near("42.a D_S", aspect.sub_sun.1.to_degrees(), -2.76, 0.05);
    near("42.a omega", aspect.central_meridians[0].1.to_degrees(), 111.55, 0.1);
    near("42.a P", aspect.pole_position_angle.to_degrees(), 347.64, 0.05);
    near("42.a k", aspect.phase(), 0.9012, 0.0005);

    let sun = at("1992-10-13T00:00:00Z", 0.0);
    let aspect = Aspect::geocentric(&sun, &sun.place(Body::Sun));
    near("29.a P", aspect.pole_position_angle.to_degrees(), 26.27, 0.05);
    near("29.a B0", aspect.sub_observer.1.to_degrees(), 5.99, 0.05);
    near("29.a L0", aspect.central_meridians[0].1.to_degrees(), 238.63, 0.05);

    let saturn = at("1992-12-16T00:00:00Z", 0.0);
    let aspect = Aspect::geocentric(&saturn, &saturn.place(Body::Saturn));
    near("45.a B", aspect.ring_tilt().unwrap().to_degrees(), 16.442, 0.05);
    near("45.a B'", aspect.sub_sun.1.to_degrees(), 14.679, 0.05);
    near("45.a P", aspect.pole_position_angle.to_degrees(), 6.741, 0.05);
}

/// Io's orbit is 5.9 radii wide: Jupiter and its shadow take 2 asin(1 / 5.9) of the turn, 5.4 %.
#[test]
fn io_is_hidden_and_eclipsed_for_a_twentieth_of_its_turns() {
    let steps = 340;
    let (mut hidden, mut eclipsed) = (0, 0);
    // Two turns of 42.46 hours, in steps of a quarter of an hour.
    let start = Utc::from_rfc3339("2026-11-14T00:00:00Z").unwrap();
    for step in 0..steps {
        let ephemeris = Ephemeris::at(&Moment::at(start.plus_seconds(f64::from(step) * 900.0))).unwrap();
        let found = moons::beside(&ephemeris, &ephemeris.place(Body::Jupiter));
        hidden += i32::from(found[0].hidden);
        eclipsed += i32::from(found[0].eclipsed);
    }
    for (what, count) in [("hidden", hidden), ("eclipsed", eclipsed)] {
        let share = f64::from(count) / f64::from(steps);
        assert!((0.035..0.07).contains(&share), "Io is {what} for {share} of the time");
    }
}

#[test]
fn dates_beyond_the_checked_centuries_are_refused_with_their_name() {
    for (date, name) in [("1499-06-01T00:00:00Z", "1499"), ("2500-12-31T00:00:00Z", "2500")] {
        let refused = Ephemeris::at(&Moment::at(Utc::from_rfc3339(date).unwrap())).unwrap_err();
        assert!(refused.to_string().contains(name), "{refused}");
    }
    for date in ["1600-01-01T00:00:00Z", "2400-01-01T00:00:00Z"] {
        let widened = Ephemeris::at(&Moment::at(Utc::from_rfc3339(date).unwrap())).unwrap();
        assert!(widened.error().to_arcseconds() > 4.0, "{date}: {:?}", widened.error());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The Moon's parallax: never more than a degree, and always downwards.
    #[test]
    fn a_site_sees_the_moon_lower_than_the_centre_of_the_earth_does(
        day in 0.0..73_000.0_f64, latitude in -89.0..89.0_f64, longitude in -180.0..180.0_f64,
    ) {
        let ephemeris = at_jde(2_415_021.0 + day);
        let site = Site::new(latitude, longitude, 0.0).unwrap();
        let place = ephemeris.place(Body::Moon);
        let seen = place.topocentric(ephemeris.reduction(), &site);
        let horizon = Horizon::new(ephemeris.reduction(), &site);
        let fallen = horizon.airless(&place.apparent).altitude() - horizon.airless(&seen.apparent).altitude();
        // The plumb line is not quite the line to the centre of the Earth: 0.2 degree of it, of a degree of parallax.
        prop_assert!(fallen.to_degrees() > -0.004 && fallen.to_degrees() < 1.03, "{}", fallen.to_degrees());
    }

    #[test]
    fn a_day_moves_no_planet_by_more_than_its_fastest(day in 0.0..73_000.0_f64) {
        let (now, later) = (at_jde(2_415_021.0 + day), at_jde(2_415_022.0 + day));
        for (body, most) in [(Body::Sun, 1.05), (Body::Moon, 15.7), (Body::Mercury, 2.3), (Body::Jupiter, 0.26), (Body::Neptune, 0.05)] {
            let moved = now.place(body).apparent.separation(&later.place(body).apparent).to_degrees();
            prop_assert!(moved < most, "{body}: {moved} degrees");
        }
    }
}
