//! The picture held against itself pixel by pixel, and against what is known of the Sun.

use super::*;
use crate::physics::aerosol::climate::Climate;
use crate::physics::aerosol::components::Humidity;
use crate::physics::air::presets;
use crate::physics::air::profile::Profile;
use crate::physics::refraction::ray::exact::Exact;
use crate::physics::sun::scene::{Haze, SUN_RADIUS};

fn scene(
    profile: &Profile,
    observer_height_m: f64,
    sun_arcmin: f64,
    size: usize,
    bottom_arcmin: f64,
    field_arcmin: f64,
) -> Scene<'_> {
    let view = View {
        width: size,
        height: size,
        bottom: Angle::arcminutes(bottom_arcmin),
        pixel: Angle::arcminutes(field_arcmin / size as f64),
    };
    Scene::clear(profile, observer_height_m, Angle::arcminutes(sun_arcmin), view)
}

fn still() -> Duration {
    Duration::ZERO
}

/// White for codes, cd/m2.
const WHITE: f64 = 2e8;

fn worst_code(scene: &Scene<'_>, columns: &[usize]) -> u8 {
    let (quick, _) = render(scene, &still).unwrap();
    let every = everything(scene, Some(columns), &mut |_| ()).unwrap();
    let (quick, every) = (quick.codes(Tone::Thesis, WHITE), every.codes(Tone::Thesis, WHITE));
    let width = scene.view.width;
    let mut worst = 0;
    for y in 0..scene.view.height {
        for x in columns {
            let (a, b) = (quick[y * width + x], every[y * width + x]);
            for (a, b) in a.iter().zip(b) {
                worst = worst.max(a.abs_diff(b));
            }
        }
    }
    worst
}

#[test]
fn the_quick_way_is_pixel_by_pixel_within_one_code_of_255() {
    let air = |name: &str| presets::named(name).unwrap().unwrap().profile;
    for (name, height_m, sun, bottom) in [
        ("us76", 2.0, -20.0, -5.0),
        ("omega", 9.28, -28.0, -10.0),
        ("mock-mirage", 54.0, -40.0, -14.0),
        ("us76", 2.0, 600.0, 580.0),
    ] {
        let profile = air(name);
        let scene = scene(&profile, height_m, sun, 40, bottom, 40.0);
        let worst = worst_code(&scene, &[3, 11, 20]);
        assert!(worst <= 1, "{name}: {worst}");
    }
}

#[test]
fn a_sun_without_air_is_round_and_has_the_luminance_of_the_sun() {
    let thin = Profile::new(
        &[(0.0, 250.0), (1000.0, 250.0)].map(|(height_m, temperature_k)| crate::physics::air::profile::Row {
            height_m,
            temperature_k,
            humidity_percent: 0.0,
        }),
        1.0,
    )
    .unwrap();
    let scene = scene(&thin, 2.0, 300.0, 64, 280.0, 40.0);
    let (picture, _) = render(&scene, &still).unwrap();
    let pixel = scene.view.pixel.to_radians();
    let flux: f64 = picture.xyz.iter().map(|xyz| f64::from(xyz[1])).sum::<f64>() * pixel * pixel;
    // All the light above the air, less what lies outside the band.
    let light: f64 = samples(8, scene.spectrum).iter().map(|sample| sample.light[1]).sum();
    assert!((flux / light - 1.0).abs() < 3e-3, "{flux} {light}");
    // The Sun's centre has 2e9 cd/m2 or a little more (Allen's Astrophysical Quantities: 1.98e9 in the mean).
    assert!((2.2e9..2.8e9).contains(&picture.brightest()), "{}", picture.brightest());
    // The same upside down and on its side.
    let at = |x: usize, y: usize| picture.xyz[y * 64 + x][1];
    for i in 0..64 {
        for j in 0..64 {
            assert!((at(i, j) - at(j, i)).abs() < 0.06 * at(32, 32), "{i} {j}");
            assert_eq!(at(i, j), at(63 - i, j));
        }
    }
}

/// Height over width of what is brighter than a hundredth of the brightest: of the disc whose lower limb stands on the horizon.
fn flattening(height_m: f64) -> f64 {
    let air = presets::named("us76").unwrap().unwrap().profile;
    let medium = crate::physics::refraction::ray::Medium::new(&air, 550.0, 6_371_000.0, 1e5).unwrap();
    let horizon = medium.critical_altitudes(height_m)[0].to_arcminutes();
    let tracer = crate::physics::refraction::ray::Method::prepare(&Exact, &medium, Angle::arcseconds(0.01)).unwrap();
    let launch = Launch { apparent_altitude: Angle::arcminutes(horizon + 1e-6), height_m };
    let truth = tracer.trace(&launch).unwrap().true_altitude.to_arcminutes();
    let sun = truth + SUN_RADIUS.to_arcminutes();
    let size = 400;
    let scene = scene(&air, height_m, sun, size, horizon - 2.0, 40.0);
    let (picture, _) = render(&scene, &still).unwrap();
    let bright = 0.01 * picture.brightest();
    let lit = |x: usize, y: usize| f64::from(picture.xyz[y * size + x][1]) > bright;
    let high = (0..size).filter(|y| lit(size / 2, *y)).count();
    let wide = (0..size).map(|y| (0..size).filter(|x| lit(*x, y)).count()).max().unwrap();
    high as f64 / wide as f64
}

#[test]
fn the_disc_on_the_horizon_is_0_83_to_0_85_as_high_as_wide() {
    for height_m in [0.0, 10.0, 30.0, 60.0] {
        let ratio = flattening(height_m);
        // A pixel is 0.003 of the width, and the blue that reaches beyond the green limb one pixel more.
        assert!((0.83..0.855).contains(&ratio), "{height_m} m: {ratio}");
    }
}

#[test]
fn the_upper_rim_is_green_or_blue_and_the_lower_red() {
    let air = presets::named("us76").unwrap().unwrap().profile;
    let mut scene = scene(&air, 2.0, 0.0, 400, 5.0, 45.0);
    scene.wavelengths = Some(32);
    let (picture, _) = render(&scene, &still).unwrap();
    let middle: Vec<[f32; 3]> = (0..400).map(|y| picture.xyz[y * 400 + 200]).collect();
    let shares: Vec<f32> = middle.iter().map(|xyz| xyz[0] / (xyz[0] + xyz[1] + xyz[2])).collect();
    let first = middle.iter().position(|xyz| xyz[1] > 1e3).unwrap();
    let last = middle.iter().rposition(|xyz| xyz[1] > 1e3).unwrap();
    let centre = (first + last) / 2;
    assert!(shares[first] < shares[centre] - 0.1, "above: {} {}", shares[first], shares[centre]);
    assert!(shares[last] > shares[centre] + 0.1, "below: {} {}", shares[last], shares[centre]);
}

#[test]
fn a_sun_below_the_horizon_is_not_seen_and_the_smallest_picture_is_made() {
    let air = presets::named("us76").unwrap().unwrap().profile;
    let (black, explained) = render(&scene(&air, 2.0, -90.0, 20, -10.0, 40.0), &still).unwrap();
    assert_eq!((black.brightest(), explained.lit_rows), (0.0, 0));
    let (one, _) = render(&scene(&air, 2.0, 0.0, 1, 5.0, 40.0), &still).unwrap();
    assert_eq!(one.xyz.len(), 1);
    assert!(one.brightest() > 1e6);
}

#[test]
fn haze_darkens_with_humidity_and_less_by_the_thesis_law() {
    let air = presets::named("us76").unwrap().unwrap().profile;
    let bright = |percent: f64, less_forward: bool| {
        let humidity = Humidity::percent(percent).unwrap();
        let haze = Some(Haze { climate: Climate::ContinentalAverage, humidity, less_forward });
        let mut scene = scene(&air, 2.0, -10.0, 20, -5.0, 40.0);
        scene.haze = haze;
        render(&scene, &still).unwrap().0.brightest()
    };
    assert!(bright(50.0, false) > bright(80.0, false) && bright(80.0, false) > bright(95.0, false));
    assert!(bright(80.0, true) > 3.0 * bright(80.0, false));
}

#[test]
fn scenes_that_cannot_be_are_refused_in_words() {
    let air = presets::named("us76").unwrap().unwrap().profile;
    let good = scene(&air, 2.0, 0.0, 10, 0.0, 40.0);
    let refused = |change: fn(&mut Scene<'_>)| {
        let mut wrong = good;
        change(&mut wrong);
        render(&wrong, &still).unwrap_err().to_string()
    };
    assert!(refused(|s| s.view.width = 0).contains("0 x 10"));
    assert!(refused(|s| s.view.height = 8193).contains("8193"));
    assert!(refused(|s| s.wavelengths = Some(0)).contains("wavelengths"));
    assert!(refused(|s| s.sun_altitude = Angle::degrees(f64::NAN)).contains("NaN"));
    assert!(refused(|s| s.tolerance = Angle::ZERO).contains("tolerance 0"));
    assert!(refused(|s| s.observer_height_m = -1.0).contains("-1"));
    assert!(refused(|s| s.top_m = 1.0).contains("2"));
}
