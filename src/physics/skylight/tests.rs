//! The sky against closed formulae, against rays traced by another method, and against chance.

use super::monte_carlo::MonteCarlo;
use super::*;
use crate::physics::aerosol::climate::Climate;
use crate::physics::aerosol::components::Humidity;
use crate::physics::air::us76;
use crate::physics::refraction::ray::exact::Exact;
use crate::physics::refraction::ray::{Launch, Medium, Method};

const GLOBE_M: f64 = 6_371_000.0;

fn scene(profile: &Profile, wavelength_nm: f64, sun_deg: f64) -> Scene<'_> {
    Scene {
        profile,
        aerosol: None,
        ozone: None,
        wavelength_nm,
        earth_radius_m: GLOBE_M,
        observer_height_m: 0.0,
        sun_true_altitude: Angle::degrees(sun_deg),
        ground_albedo: 0.1,
    }
}

#[test]
fn the_direct_beam_is_that_of_rays_traced_exactly() {
    let air = us76::profile();
    let shells = Shells::fine(&scene(&air, 550.0, 0.0)).unwrap();
    let medium = Medium::new(&air, 550.0, GLOBE_M, shells::TOP_M - 1e3).unwrap();
    let tracer = Exact.prepare(&medium, Angle::arcseconds(0.01)).unwrap();
    let sunlight = Sunlight::new(&shells, 90f64.to_radians());
    for apparent_deg in [0.05, 1.0, 5.0, 15.0] {
        let ray = tracer.trace(&Launch { apparent_altitude: Angle::degrees(apparent_deg), height_m: 0.0 }).unwrap();
        let beam = sunlight.at(0.0, std::f64::consts::FRAC_PI_2 - ray.true_altitude.to_radians());
        let refraction = Angle::radians(beam.bending).to_arcminutes();
        let exact = ray.refraction.to_arcminutes();
        assert!((refraction / exact - 1.0).abs() < 0.02, "{apparent_deg}: {refraction} for {exact} arcmin");
        // What is left beside extinction is the spreading of the beam, at most 20 % at the horizon.
        let spread = (beam.irradiance.ln() + ray.depths.rayleigh).exp();
        assert!((0.78..=1.001).contains(&spread), "{apparent_deg}: {spread}");
    }
}

#[test]
fn scattered_once_over_a_flat_earth_is_the_closed_formula() {
    let air = us76::profile();
    let flat = Scene { earth_radius_m: 1e9, ..scene(&air, 550.0, 30.0) };
    let sky = Skylight::new(&flat).unwrap();
    let depth: f64 = shells_depth(&flat);
    for (view_deg, azimuth_deg) in [(60.0f64, 0.0), (20.0, 90.0), (45.0, 180.0)] {
        let (mu, mu0) = (view_deg.to_radians().sin(), 30f64.to_radians().sin());
        let cos = direction(Angle::degrees(view_deg), Angle::degrees(azimuth_deg)).dot(flat.sun());
        let formula = phase::rayleigh(cos) * mu0 / (mu0 - mu) * ((-depth / mu0).exp() - (-depth / mu).exp());
        let single = sky.radiance(Angle::degrees(view_deg), Angle::degrees(azimuth_deg)).single;
        assert!((single / formula - 1.0).abs() < 3e-3, "{view_deg}, {azimuth_deg}: {single} for {formula}");
    }
}

fn shells_depth(scene: &Scene) -> f64 {
    let shells = Shells::fine(scene).unwrap();
    let borders = shells.borders_m();
    (0..borders.len() - 1).map(|i| shells.shell(i).extinction() * (borders[i + 1] - borders[i])).sum()
}

/// What comes in goes out: without absorption and over black ground, all light that enters a flat atmosphere leaves it again,
/// upwards or into the ground. Nothing of this is shared with the photons.
#[test]
fn no_light_is_lost_or_made() {
    let air = us76::profile();
    let below = Scene { earth_radius_m: 1e9, ground_albedo: 0.0, ..scene(&air, 450.0, 40.0) };
    let above = Scene { observer_height_m: 9e4, ..below };
    let (up, down) = (Skylight::new(&below).unwrap(), Skylight::new(&above).unwrap());
    // Flux through a level plane from one side: the middles of 24 steps of sine squared and 12 of azimuth.
    let flux = |sky: &Skylight, side: f64| {
        let mut sum = 0.0;
        for i in 0..24 {
            let altitude = Angle::radians(side * ((f64::from(i) + 0.5) / 24.0).sqrt().asin());
            for k in 0..12 {
                let azimuth = Angle::degrees((f64::from(k) + 0.5) * 15.0);
                sum += sky.radiance(altitude, azimuth).total() * std::f64::consts::PI / (24.0 * 12.0);
            }
        }
        sum
    };
    let sine = 40f64.to_radians().sin();
    let beam = up.sunlight.at(0.0, 50f64.to_radians()).irradiance * sine;
    let (through, back) = (flux(&up, 1.0), flux(&down, -1.0));
    assert!(through > 0.02 && back > 0.02, "{through}, {back}");
    let balance = (beam + through + back) / sine;
    assert!((balance - 1.0).abs() < 0.01, "{balance}: beam {beam}, through {through}, back {back}");
}

#[test]
fn the_column_of_shells_is_the_published_rayleigh_depth() {
    // Bodhaine et al. (1999), table 3: 0.09727 at 550 nm, 45 degrees, 360 ppm; 0.1 % of it lies above 100 km or in rounding.
    let air = us76::profile();
    let depth = shells_depth(&scene(&air, 550.0, 0.0));
    assert!((depth / 0.0971 - 1.0).abs() < 5e-3, "{depth}");
}

/// Three altitudes and three wavelengths through haze, and a clean sky: within 10 % of photons followed one by one.
#[test]
fn the_sky_agrees_with_photons_followed_one_by_one() {
    let air = us76::profile();
    let haze =
        |nm: f64| Climate::ContinentalClean.column(Humidity::percent(50.0).unwrap(), nm, 0.02).map(Some).unwrap();
    for (nm, aerosol) in [(450.0, haze(450.0)), (550.0, haze(550.0)), (650.0, haze(650.0)), (450.0, None)] {
        let scene = Scene { aerosol: aerosol.as_ref(), ..scene(&air, nm, 1.0) };
        let (sky, chance) = (Skylight::new(&scene).unwrap(), MonteCarlo::new(&scene).unwrap());
        for (altitude, azimuth) in [(1.0, 20.0), (8.0, 10.0), (40.0, 120.0)] {
            let (altitude, azimuth) = (Angle::degrees(altitude), Angle::degrees(azimuth));
            let theirs = chance.radiance(altitude, azimuth, 1500, 7);
            let ratio = sky.radiance(altitude, azimuth).total() / theirs.radiance.total();
            let noise = 2.0 * theirs.standard_error / theirs.radiance.total();
            assert!((ratio - 1.0).abs() < 0.1 + noise, "{nm} nm at {} degrees: {ratio}", altitude.to_degrees());
        }
    }
}

#[test]
fn the_sky_grows_dark_and_its_horizon_red_as_the_sun_sets() {
    let air = us76::profile();
    let sky = |nm: f64, sun_deg: f64| Skylight::new(&scene(&air, nm, sun_deg)).unwrap();
    let towards_sun = |sky: &Skylight, deg: f64| sky.radiance(Angle::degrees(deg), Angle::degrees(5.0)).total();
    let setting = [sky(450.0, 0.0), sky(650.0, 0.0)];
    let higher = [sky(450.0, 10.0), sky(650.0, 10.0)];
    let redness = |[blue, red]: &[Skylight; 2], deg: f64| towards_sun(red, deg) / towards_sun(blue, deg);
    assert!(redness(&setting, 1.0) > 5.0 * redness(&setting, 40.0));
    assert!(redness(&setting, 1.0) > redness(&higher, 1.0));
    // Twilight: from sunset to 6 degrees below, the sky fades by one to four orders of magnitude.
    let fading = towards_sun(&sky(450.0, -6.0), 20.0) / towards_sun(&setting[0], 20.0);
    assert!((1e-4..1e-1).contains(&fading), "{fading}");
}
