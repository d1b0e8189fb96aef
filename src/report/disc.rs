//! The picture of the disc: what its parts cost, how far it is from the picture traced pixel by pixel, and extreme scenes.

use std::time::Duration;

use super::colour::StudyError;
use super::stability::Extreme;
use crate::physics::aerosol::climate::Climate;
use crate::physics::aerosol::components::Humidity;
use crate::physics::air::presets;
use crate::physics::air::profile::{Profile, Row};
use crate::physics::air::us76;
use crate::physics::colour::Tone;
use crate::physics::sun::scene::Haze;
use crate::physics::sun::{Explained, Scene, View, everything, render};
use crate::units::Angle;

/// The picture that is measured: its side in pixels, its wavelengths.
const SIDE: usize = 512;
const WAVELENGTHS: usize = 32;

/// Height of a picture, arcminutes.
const FIELD_ARCMIN: f64 = 40.0;

/// Columns that are traced pixel by pixel where not all are: the middle, both limbs, and between.
const COLUMNS: [usize; 4] = [54, 120, 190, 256];

/// A preset as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// The air.
    pub profile: Profile,
    /// The eye, metres.
    pub observer_height_m: f64,
    /// True altitude of the Sun's centre, arcminutes.
    pub sun_arcmin: f64,
    /// Lower edge, arcminutes.
    pub bottom_arcmin: f64,
    /// Full light, cd/m2.
    pub white: f64,
}

/// A preset with the Sun where it shows what the preset is for.
///
/// # Errors
/// None for the presets there are (tested).
pub fn shown(name: &str) -> Result<Shown, StudyError> {
    let preset = presets::named(name).ok_or_else(|| StudyError::Air(format!("no preset {name}")))?;
    let preset = preset.map_err(|error| StudyError::Air(error.to_string()))?;
    let (sun_arcmin, bottom_arcmin) = match name {
        "omega" => (-27.0, -10.0),
        "green-flash" => (-50.3, -10.0),
        _ => (-20.0, -5.0),
    };
    let observer_height_m = preset.observer_height_m.unwrap_or(2.0);
    Ok(Shown { profile: preset.profile, observer_height_m, sun_arcmin, bottom_arcmin, white: 2.4e9 })
}

/// A scene in clean air, a square picture of 40 arcminutes, to 0.1 arcsecond.
#[must_use]
pub fn scene(profile: &Profile, observer_height_m: f64, sun_arcmin: f64, side: usize, bottom_arcmin: f64) -> Scene<'_> {
    let view = View {
        width: side,
        height: side,
        bottom: Angle::arcminutes(bottom_arcmin),
        pixel: Angle::arcminutes(FIELD_ARCMIN / side as f64),
    };
    let clear = Scene::clear(profile, observer_height_m, Angle::arcminutes(sun_arcmin), view);
    Scene { wavelengths: Some(WAVELENGTHS), ..clear }
}

/// What the omega sunset cost.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Cost {
    /// The whole picture with its codes, the fastest of five, milliseconds.
    pub picture_ms: f64,
    /// Its parts, milliseconds.
    pub parts_ms: Vec<(&'static str, f64)>,
    /// Rays traced.
    pub rays: usize,
    /// Error of place that is believed, arcseconds.
    pub believed_arcsec: f64,
    /// Columns traced pixel by pixel.
    pub columns: usize,
    /// The whole picture pixel by pixel, milliseconds: what the columns took, times all over those.
    pub everything_ms: f64,
    /// The largest difference in them, codes of 255.
    pub worst_code: u8,
}

/// Measures the omega sunset, 512 x 512 pixels at 32 wavelengths to 0.1 arcsecond; with all columns pixel by pixel, or four.
///
/// # Errors
/// None for the preset (tested).
pub fn cost(clock: &dyn Fn() -> Duration, all_columns: bool, done: &mut dyn FnMut(f64)) -> Result<Cost, StudyError> {
    let Shown { profile, observer_height_m, sun_arcmin, bottom_arcmin, white } = shown("omega")?;
    let scene = scene(&profile, observer_height_m, sun_arcmin, SIDE, bottom_arcmin);
    let mut best: Option<(Duration, Explained, Vec<[u8; 3]>, Duration)> = None;
    for _ in 0..5 {
        let begin = clock();
        let (picture, explained) = render(&scene, clock)?;
        let middle = clock();
        let codes = picture.codes(Tone::Thesis, white);
        let end = clock();
        let time = end.saturating_sub(begin);
        if best.as_ref().is_none_or(|best| time < best.0) {
            best = Some((time, explained, codes, end.saturating_sub(middle)));
        }
    }
    let Some((time, explained, codes, tone)) = best else { return Err(StudyError::Air("nothing measured".to_owned())) };
    let every: Vec<usize> = (0..SIDE).collect();
    let columns = if all_columns { &every[..] } else { &COLUMNS[..] };
    let begin = clock();
    let traced = everything(&scene, Some(columns), done)?.codes(Tone::Thesis, white);
    let everything_ms = clock().saturating_sub(begin).as_secs_f64() * 1e3 * SIDE as f64 / columns.len() as f64;
    let mut worst_code = 0;
    for y in 0..SIDE {
        for x in columns {
            let (a, b) = (codes[y * SIDE + x], traced[y * SIDE + x]);
            worst_code = a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).fold(worst_code, u8::max);
        }
    }
    let mut parts_ms: Vec<(&'static str, f64)> =
        explained.times.iter().map(|(part, time)| (*part, time.as_secs_f64() * 1e3)).collect();
    parts_ms.push(("tone", tone.as_secs_f64() * 1e3));
    Ok(Cost {
        picture_ms: time.as_secs_f64() * 1e3,
        parts_ms,
        rays: explained.rays,
        believed_arcsec: explained.error().to_arcseconds(),
        columns: columns.len(),
        everything_ms,
        worst_code,
    })
}

/// The cost as lines for people.
#[must_use]
pub fn lines(cost: &Cost) -> String {
    let parts: Vec<String> = cost.parts_ms.iter().map(|(part, ms)| format!("{part} {ms:.1}")).collect();
    format!(
        "The omega sunset, {SIDE} x {SIDE} pixels, {WAVELENGTHS} wavelengths, 0.1\", one core, without PNG\n  \
         picture           {:.1} ms ({}), {} rays, believed to {:.1e}\"\n  \
         pixel by pixel    {:.0} ms ({} of {SIDE} columns traced), {:.0} times as long\n  \
         worst difference  {} of 255\n",
        cost.picture_ms,
        parts.join(", "),
        cost.rays,
        cost.believed_arcsec,
        cost.everything_ms,
        cost.columns,
        cost.everything_ms / cost.picture_ms,
        cost.worst_code
    )
}

/// Tries something, and says what came of it, or why it did not hold.
type Attempt = fn() -> Result<String, String>;

/// Runs all extreme scenes.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let cases: [(&'static str, Attempt); 10] = [
        ("disc: a duct for all colours, and for blue only", ducts),
        ("disc: an eye in an inversion, at its edges, at 0 m, 8 km", eyes),
        ("disc: a jump of 10 K in 1 m; two points", jumps),
        ("disc: a profile with 100,000 points", many_points),
        ("disc: a Sun wholly below the horizon", || {
            let picture = pixels(&us76::profile(), 2.0, -120.0, 32, |_| ())?;
            if picture.0 == 0.0 { Ok("black".to_owned()) } else { Err(format!("{picture:?}")) }
        }),
        ("disc: 1 x 1 and 8192 rows", sizes),
        ("disc: 1 and 256 wavelengths", || {
            let air = us76::profile();
            let [one, many] =
                [1, 256].map(|count| pixels(&air, 2.0, -20.0, 32, move |scene| scene.wavelengths = Some(count)));
            Ok(format!("brightest {:.2e} and {:.2e} cd/m2", one?.0, many?.0))
        }),
        ("disc: the haze of a city at 99 %", || {
            let humidity = Humidity::percent(99.0).map_err(|error| error.to_string())?;
            let haze = Haze { climate: Climate::Urban, humidity, less_forward: false };
            let picture = pixels(&us76::profile(), 0.0, -20.0, 32, move |scene| scene.haze = Some(haze))?;
            Ok(format!("brightest {:.1e} cd/m2", picture.0))
        }),
        ("disc: rays that graze the ground, pixels of 1/1000\"", || {
            let air = us76::profile();
            let picture = pixels(&air, 0.0, -20.0, 32, |scene| {
                scene.view.bottom = Angle::arcseconds(-0.016);
                scene.view.pixel = Angle::arcseconds(0.001);
            })?;
            Ok(format!("brightest {:.2e} cd/m2 in {} rays", picture.0, picture.1))
        }),
        ("disc: frames, suns and tolerances that cannot be", refused),
    ];
    cases
        .into_iter()
        .map(|(name, case)| match case() {
            Ok(what) => Extreme { name, held: true, what },
            Err(what) => Extreme { name, held: false, what },
        })
        .collect()
}

/// More rays than this for one picture are not bounded.
const MOST_RAYS: usize = 2_000_000;

/// The brightest pixel of a picture and its rays; all must be finite.
fn pixels(
    profile: &Profile,
    height_m: f64,
    sun_arcmin: f64,
    side: usize,
    change: impl Fn(&mut Scene<'_>),
) -> Result<(f64, usize), String> {
    let mut scene = scene(profile, height_m, sun_arcmin, side, -25.0);
    scene.wavelengths = Some(8);
    change(&mut scene);
    let (picture, explained) = render(&scene, &|| Duration::ZERO).map_err(|error| error.to_string())?;
    if !picture.xyz.iter().flatten().all(|part| part.is_finite() && *part >= 0.0) {
        return Err("a pixel is not finite, or negative".to_owned());
    }
    if explained.rays > MOST_RAYS {
        return Err(format!("{} rays", explained.rays));
    }
    Ok((picture.brightest(), explained.rays))
}

fn air(pairs: &[(f64, f64)]) -> Result<Profile, String> {
    let row = |&(height_m, temperature_k): &(f64, f64)| Row { height_m, temperature_k, humidity_percent: 0.0 };
    Profile::new(&pairs.iter().map(row).collect::<Vec<_>>(), us76::P0_PA).map_err(|error| error.to_string())
}

fn ducts() -> Result<String, String> {
    let for_all = air(&[(0.0, 283.0), (60.0, 283.0), (70.0, 293.0), (11e3, 222.0)])?;
    let for_blue = air(&[(0.0, 288.0), (10.0, 288.0), (40.0, 288.0 + 30.0 * 0.1284), (11e3, 222.0)])?;
    let mut rays = Vec::new();
    for (profile, height_m) in
        [(&for_all, 65.0), (&for_all, 75.0), (&for_all, 20.0), (&for_blue, 20.0), (&for_blue, 50.0)]
    {
        for sun in [-30.0, 0.0] {
            rays.push(pixels(profile, height_m, sun, 32, |_| ())?.1);
        }
    }
    Ok(format!("finite, with at most {} rays", rays.iter().max().copied().unwrap_or_default()))
}

fn eyes() -> Result<String, String> {
    let inversion = air(&[(0.0, 285.0), (50.0, 285.0), (80.0, 288.0), (11e3, 217.0)])?;
    let mut brightest = f64::INFINITY;
    for height_m in [0.0, 50.0, 65.0, 80.0, 8000.0] {
        let sun = if height_m > 1000.0 { -190.0 } else { -25.0 };
        let low = if height_m > 1000.0 { -170.0 } else { -25.0 };
        brightest =
            brightest.min(pixels(&inversion, height_m, sun, 32, |scene| scene.view.bottom = Angle::arcminutes(low))?.0);
    }
    if brightest > 0.0 {
        Ok(format!("each shows the Sun, at least {brightest:.1e} cd/m2"))
    } else {
        Err("no Sun".to_owned())
    }
}

fn jumps() -> Result<String, String> {
    for rows in [
        &[(0.0, 288.0), (20.0, 288.0), (21.0, 298.0), (11e3, 222.0)][..],
        &[(0.0, 298.0), (20.0, 298.0), (21.0, 288.0), (11e3, 222.0)],
        &[(0.0, 288.0), (11e3, 216.0)],
    ] {
        for height_m in [2.0, 30.0] {
            pixels(&air(rows)?, height_m, -30.0, 32, |_| ())?;
        }
    }
    Ok("finite".to_owned())
}

fn many_points() -> Result<String, String> {
    let rows: Vec<(f64, f64)> = (0..100_000).map(|i| (f64::from(i) * 0.5, 288.15 - 0.001 * f64::from(i))).collect();
    let picture = pixels(&air(&rows)?, 2.0, -20.0, 4, |scene| scene.wavelengths = Some(1))?;
    Ok(format!("{} rays", picture.1))
}

fn sizes() -> Result<String, String> {
    let air = us76::profile();
    pixels(&air, 2.0, -20.0, 1, |scene| scene.view.bottom = Angle::arcminutes(-5.0))?;
    let tall = pixels(&air, 2.0, -20.0, 8192, |scene| {
        scene.view.width = 2;
        scene.wavelengths = Some(2);
    })?;
    Ok(format!("the tall one in {} rays", tall.1))
}

fn refused() -> Result<String, String> {
    let air = us76::profile();
    let changes: [fn(&mut Scene<'_>); 7] = [
        |scene| scene.view.bottom = Angle::degrees(81.0),
        |scene| scene.view.bottom = Angle::degrees(f64::NAN),
        |scene| scene.view.pixel = Angle::ZERO,
        |scene| scene.view.width = 8193,
        |scene| scene.sun_altitude = Angle::degrees(91.0),
        |scene| scene.tolerance = Angle::arcseconds(f64::NAN),
        |scene| scene.top_m = 1.0,
    ];
    for (i, change) in changes.iter().enumerate() {
        if let Ok(picture) = pixels(&air, 2.0, 0.0, 8, change) {
            return Err(format!("case {i} was not refused: {picture:?}"));
        }
    }
    Ok("each refused with a sentence".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extreme_scene_is_borne() {
        for extreme in extremes() {
            assert!(extreme.held, "{extreme:?}");
        }
    }
}
