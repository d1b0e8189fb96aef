//! The light of the sky around a low Sun, against photons followed one by one.

use std::time::Duration;

use super::stability::Extreme;
use super::{Answer, Case, Contender, Study, seconds_each};
use crate::physics::aerosol::climate::{AerosolError, Climate, Column};
use crate::physics::aerosol::components::{ComponentError, Humidity};
use crate::physics::air::profile::Profile;
use crate::physics::skylight::monte_carlo::{Estimate, MonteCarlo};
use crate::physics::skylight::{Scene, SkyError, Skylight};
use crate::units::Angle;

const WAVELENGTHS_NM: [f64; 3] = [450.0, 550.0, 650.0];
/// Directions: apparent altitude, azimuth from the Sun, degrees.
const DIRECTIONS_DEG: [(f64, f64); 3] = [(1.0, 20.0), (8.0, 10.0), (40.0, 120.0)];
const SUN_DEG: f64 = 1.0;
const GLOBE_M: f64 = 6_371_000.0;
/// Photons of the references: a standard error of about one percent.
const PHOTONS: usize = 20_000;
const SEED: u64 = 1;

/// Why the study could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// A sky was refused.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// Particles were refused.
    #[error(transparent)]
    Aerosol(#[from] AerosolError),
    /// A humidity was refused.
    #[error(transparent)]
    Component(#[from] ComponentError),
}

/// The sky of one wavelength, by both methods.
pub struct Sky {
    wavelength_nm: f64,
    ours: Skylight,
    chance: MonteCarlo,
    references: Vec<Estimate>,
    /// What making it ready took, seconds.
    pub ready_s: f64,
}

/// The particles of the study: clean continental air at half humidity.
///
/// # Errors
/// None for the climate there is (tested).
pub fn particles() -> Result<Vec<Column>, StudyError> {
    let humidity = Humidity::percent(50.0)?;
    let column = |nm| Ok(Climate::ContinentalClean.column(humidity, nm, 0.01)?);
    WAVELENGTHS_NM.into_iter().map(column).collect()
}

/// The skies with their references; `told` hears of each before it is begun.
///
/// # Errors
/// None for the skies there are (tested).
pub fn skies(
    air: &Profile,
    particles: &[Column],
    clock: &dyn Fn() -> Duration,
    mut told: impl FnMut(&str),
) -> Result<Vec<Sky>, StudyError> {
    let mut skies = Vec::new();
    for (wavelength_nm, aerosol) in WAVELENGTHS_NM.into_iter().zip(particles) {
        told(&format!("{wavelength_nm} nm: {PHOTONS} photons in each of {} directions", DIRECTIONS_DEG.len()));
        let scene = Scene {
            profile: air,
            aerosol: Some(aerosol),
            ozone: None,
            wavelength_nm,
            earth_radius_m: GLOBE_M,
            observer_height_m: 2.0,
            sun_true_altitude: Angle::degrees(SUN_DEG),
            ground_albedo: 0.1,
        };
        let (ours, chance) = (Skylight::new(&scene)?, MonteCarlo::new(&scene)?);
        let ready_s = seconds_each(clock, || drop(std::hint::black_box(Skylight::new(&scene))));
        let reference =
            |(altitude, azimuth)| chance.radiance(Angle::degrees(altitude), Angle::degrees(azimuth), PHOTONS, SEED);
        let references = DIRECTIONS_DEG.into_iter().map(reference).collect();
        skies.push(Sky { wavelength_nm, ours, chance, references, ready_s });
    }
    Ok(skies)
}

/// Every method in every direction, as shares of what the photons say.
#[must_use]
pub fn study(skies: &[Sky]) -> Study<'_> {
    let pick = |index: usize| {
        let (altitude, azimuth) = DIRECTIONS_DEG[index % DIRECTIONS_DEG.len()];
        let sky = &skies[index / DIRECTIONS_DEG.len()];
        (sky, Angle::degrees(altitude), Angle::degrees(azimuth), sky.references[index % DIRECTIONS_DEG.len()])
    };
    let cases = (0..skies.len() * DIRECTIONS_DEG.len())
        .map(|index| {
            let (sky, altitude, azimuth, reference) = pick(index);
            let (altitude, azimuth) = (altitude.to_degrees(), azimuth.to_degrees());
            let noise = 100.0 * reference.standard_error / reference.radiance.total();
            Case {
                group: format!("{} nm", sky.wavelength_nm),
                name: format!(
                    "{altitude:.0} degrees up, {azimuth:.0} from the Sun ({:.3e}/sr, {noise:.1} % by chance)",
                    reference.radiance.total()
                ),
                reference: 1.0,
            }
        })
        .collect();
    let mut contenders = vec![
        Contender {
            method: "sky",
            setting: "all orders".to_owned(),
            answer: Box::new(move |index| {
                let (sky, altitude, azimuth, reference) = pick(index);
                let value = sky.ours.radiance(altitude, azimuth).total() / reference.radiance.total();
                Some(Answer { value, believed: sky.ours.believed_error(), steps: 0 })
            }),
        },
        Contender {
            method: "sky",
            setting: "single only".to_owned(),
            answer: Box::new(move |index| {
                let (sky, altitude, azimuth, reference) = pick(index);
                let light = sky.ours.radiance(altitude, azimuth);
                let value = light.single / reference.radiance.total();
                Some(Answer { value, believed: light.multiple / reference.radiance.total(), steps: 0 })
            }),
        },
    ];
    for photons in [100, 1000] {
        contenders.push(Contender {
            method: "photons",
            setting: photons.to_string(),
            answer: Box::new(move |index| {
                let (sky, altitude, azimuth, reference) = pick(index);
                let chance = sky.chance.radiance(altitude, azimuth, photons, SEED + 1);
                let whole = reference.radiance.total();
                let value = chance.radiance.total() / whole;
                Some(Answer { value, believed: chance.standard_error / whole, steps: photons })
            }),
        });
    }
    Study { title: "The sky around a Sun 1 degree up, clean continental air", unit: "share", cases, contenders }
}

/// Extreme skies: finite and not negative, or refused.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let air = crate::physics::air::us76::profile();
    let base = |sun_deg: f64| Scene {
        profile: &air,
        aerosol: None,
        ozone: None,
        wavelength_nm: 550.0,
        earth_radius_m: GLOBE_M,
        observer_height_m: 0.0,
        sun_true_altitude: Angle::degrees(sun_deg),
        ground_albedo: 0.1,
    };
    let thick = Humidity::percent(99.0).ok().and_then(|humid| Climate::Urban.column(humid, 380.0, 0.05).ok());
    // The faintest and the brightest light of some directions, if all of it is light.
    let finite = |scene: &Scene| -> Result<String, String> {
        let sky = Skylight::new(scene).map_err(|error| error.to_string())?;
        let lights: Vec<f64> = [-90.0, -1.0, 0.0, 0.01, 5.0, 90.0]
            .into_iter()
            .map(|altitude| sky.radiance(Angle::degrees(altitude), Angle::degrees(0.5)).total())
            .collect();
        let (low, high) = lights.iter().fold((f64::MAX, 0.0f64), |(low, high), l| (low.min(*l), high.max(*l)));
        let what = format!("{low:.1e} to {high:.1e} /sr");
        if lights.iter().all(|l| l.is_finite() && *l >= 0.0) { Ok(what) } else { Err(what) }
    };
    let refused = |scene: &Scene| match Skylight::new(scene) {
        Err(why) => Ok(format!("refused: {why}")),
        Ok(_) => Err("not refused".to_owned()),
    };
    let cases = [
        ("sky: Sun 12 degrees down", finite(&base(-12.0))),
        ("sky: Sun 60 degrees up", finite(&base(60.0))),
        ("sky: eye at 8 km", finite(&Scene { observer_height_m: 8e3, ..base(0.0) })),
        ("sky: optical depth above 745", finite(&Scene { aerosol: thick.as_ref(), wavelength_nm: 380.0, ..base(0.0) })),
        ("sky: white ground", finite(&Scene { ground_albedo: 1.0, ..base(0.0) })),
        ("sky: Sun at NaN", refused(&base(f64::NAN))),
        ("sky: ground that gives back twice what it gets", refused(&Scene { ground_albedo: 2.0, ..base(0.0) })),
        ("sky: 200 nm", refused(&Scene { wavelength_nm: 200.0, ..base(0.0) })),
    ];
    cases
        .into_iter()
        .map(|(name, outcome)| Extreme {
            name,
            held: outcome.is_ok(),
            what: match outcome {
                Ok(what) | Err(what) => what,
            },
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extreme_sky_holds() {
        let failed: Vec<_> = extremes().into_iter().filter(|extreme| !extreme.held).collect();
        assert!(failed.is_empty(), "{failed:?}");
    }
}
