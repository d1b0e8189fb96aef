//! The Moon's calibration on photographs of a Moon that never was: error against run time, and how often the stated interval
//! holds the truth.

use std::time::Duration;

use super::stability::Extreme;
use crate::registration::{Frame, Limb, MoonError, Pair, Shape};
use photograph::{Face, Photographed};

/// The photographs.
pub mod photograph;

/// Two photographs with a known scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// What it shows.
    pub name: &'static str,
    /// Angle at the Moon between Sun and observer, degrees.
    pub phase_deg: f64,
    /// Whether the picture shows 40 degrees of limb only.
    pub cut: bool,
    /// Whether both photographs show maria.
    pub maria: bool,
    /// Relief of the seen limb, arcseconds.
    pub relief_arcsec: f64,
}

/// The scenes that are asked for, and two that show what the limb knows by itself.
pub const SCENES: [Scene; 8] = [
    Scene { name: "quarter", phase_deg: 90.0, cut: false, maria: true, relief_arcsec: 2.0 },
    Scene { name: "gibbous", phase_deg: 45.0, cut: false, maria: true, relief_arcsec: 2.0 },
    Scene { name: "full", phase_deg: 0.0, cut: false, maria: true, relief_arcsec: 2.0 },
    Scene { name: "quarter, 40 degrees of limb", phase_deg: 90.0, cut: true, maria: true, relief_arcsec: 2.0 },
    Scene { name: "gibbous, 40 degrees of limb", phase_deg: 45.0, cut: true, maria: true, relief_arcsec: 2.0 },
    Scene { name: "full, 40 degrees of limb", phase_deg: 0.0, cut: true, maria: true, relief_arcsec: 2.0 },
    Scene { name: "quarter, limb alone", phase_deg: 90.0, cut: false, maria: false, relief_arcsec: 2.0 },
    Scene { name: "full, limb alone", phase_deg: 0.0, cut: false, maria: false, relief_arcsec: 2.0 },
];

/// One photograph made, and where its Moon is.
#[derive(Debug, Clone)]
pub struct Made {
    /// Its pixels.
    pub frame: Frame,
    /// Its Moon.
    pub moon: Photographed,
}

impl Scene {
    /// The pair of a seed: the seen Moon, the drawn one, and the true scale. The smaller disc is 800 pixels across.
    ///
    /// # Errors
    /// None that is expected: the photographs are large enough.
    pub fn made(&self, seed: u64) -> Result<(Made, Made, f64), MoonError> {
        let scale = 0.7 + 0.005 * (seed % 61) as f64;
        let face = Face::of(seed);
        let radius = 400.0;
        let seen = self.one(&face, radius / scale.min(1.0), self.relief_arcsec, 0.0, 2 * seed)?;
        let drawn = self.one(&face, radius.max(seen.moon.radius * scale), 0.0, 5.0, 2 * seed + 1)?;
        let truth = drawn.moon.radius / seen.moon.radius;
        Ok((seen, drawn, truth))
    }

    fn one(&self, face: &Face, radius: f64, relief_arcsec: f64, turned_deg: f64, seed: u64) -> Result<Made, MoonError> {
        let moon = Photographed {
            radius,
            relief_arcsec,
            phase_deg: self.phase_deg,
            maria: self.maria,
            ..Photographed::default()
        };
        let (moon, width, height) = if self.cut {
            // The Sun is on the right: of the bright limb only 40 degrees are in the picture.
            let height = 2.0 * radius * 20f64.to_radians().sin();
            let middle = (0.9 * radius - radius - 30.0 + 0.3, height / 2.0 + 0.2);
            (Photographed { middle, ..moon }, (0.9 * radius) as usize, height as usize)
        } else {
            let side = (2.2 * radius) as usize;
            let middle = (1.1 * radius + 3.3, 1.1 * radius - 2.2);
            (Photographed { middle, turned_deg, ..moon }, side, side)
        };
        let frame = Frame::new(width, height, face.photographed(&moon, width, height, seed))?;
        Ok(Made { frame, moon })
    }
}

/// What one method made of all seeds of a scene.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Row {
    /// The scene.
    pub scene: &'static str,
    /// Limb, maria, or both.
    pub method: &'static str,
    /// Pairs that it answered.
    pub answered: usize,
    /// Pairs whose truth lies within twice the stated error.
    pub covered: usize,
    /// Root mean square of the relative error, percent.
    pub rms_percent: f64,
    /// The greatest relative error, percent.
    pub worst_percent: f64,
    /// The greatest stated two-sigma interval to one side, percent.
    pub widest_percent: f64,
    /// Mean time of a pair, seconds, for all methods together.
    pub time_s: f64,
}

/// Measures seeds of scenes; `told` hears of each scene.
///
/// # Errors
/// A photograph could not be made.
pub fn rows(seeds: u64, clock: &dyn Fn() -> Duration, mut told: impl FnMut(&str)) -> Result<Vec<Row>, MoonError> {
    let mut rows = Vec::new();
    for scene in SCENES {
        told(scene.name);
        let mut errors: [Vec<(f64, f64)>; 3] = Default::default();
        let mut time = Duration::ZERO;
        for seed in 0..seeds {
            let (seen, drawn, truth) = scene.made(seed)?;
            let begin = clock();
            let pair = Pair::measured(&seen.frame, &drawn.frame, Shape::ROUND);
            time += clock().saturating_sub(begin);
            let Ok(pair) = pair else { continue };
            for (list, measured) in errors.iter_mut().zip([Some(pair.limb_scale), pair.surface_scale, Some(pair.scale)])
            {
                list.extend(measured.map(|m| (m.value / truth - 1.0, m.error / truth)));
            }
        }
        for (method, list) in ["limb", "maria", "both"].into_iter().zip(&errors) {
            let most = |of: &dyn Fn(&(f64, f64)) -> f64| list.iter().map(of).fold(0.0, f64::max);
            let squares = list.iter().fold(0.0, |sum, (off, _)| sum + off * off);
            rows.push(Row {
                scene: scene.name,
                method,
                answered: list.len(),
                covered: list.iter().filter(|(off, error)| off.abs() <= 2.0 * error).count(),
                rms_percent: 100.0 * (squares / list.len().max(1) as f64).sqrt(),
                worst_percent: 100.0 * most(&|(off, _)| off.abs()),
                widest_percent: 200.0 * most(&|(_, error)| *error),
                time_s: time.as_secs_f64() / seeds.max(1) as f64,
            });
        }
    }
    Ok(rows)
}

/// The rows as a table for people.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<30} {:<6} {:>9} {:>8} {:>9} {:>9} {:>12} {:>8}\n",
        "scene", "method", "answered", "covered", "rms %", "worst %", "2 sigma <= %", "time s"
    );
    for row in rows {
        text += &format!(
            "{:<30} {:<6} {:>9} {:>8} {:>9.4} {:>9.4} {:>12.4} {:>8.2}\n",
            row.scene,
            row.method,
            row.answered,
            row.covered,
            row.rms_percent,
            row.worst_percent,
            row.widest_percent,
            row.time_s
        );
    }
    text
}

/// Photographs without a Moon, and worse: each is refused in words.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let square = |value: f32| Frame::new(300, 300, vec![value; 300 * 300]);
    let tried: [(&'static str, Result<Frame, MoonError>); 6] = [
        ("a photograph of one pixel", Frame::new(1, 1, vec![0.5])),
        ("a photograph of numbers that are none", Frame::new(64, 64, vec![f32::NAN; 64 * 64])),
        ("a black photograph", square(0.0)),
        ("a white photograph", square(1.0)),
        ("a photograph of noise without Moon", noise()),
        ("a photograph of a straight roof", roof()),
    ];
    tried
        .into_iter()
        .map(|(name, frame)| match frame.and_then(|frame| Limb::of(&frame, Shape::ROUND)) {
            Ok(limb) => Extreme { name, held: false, what: format!("a Moon of {:.1} pixels was found", limb.radius) },
            Err(error) => Extreme { name, held: true, what: format!("refused: {error}") },
        })
        .collect()
}

fn noise() -> Result<Frame, MoonError> {
    let mut stream = crate::numerics::streams::Stream::seeded(3);
    Frame::new(300, 300, (0..300 * 300).map(|_| 0.2 + 0.1 * stream.uniform() as f32).collect())
}

fn roof() -> Result<Frame, MoonError> {
    let bright = |k: usize| k % 300 > 100 + k / 300 / 3;
    Frame::new(300, 300, (0..300 * 300).map(|k| if bright(k) { 0.8 } else { 0.1 }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extreme_photograph_is_refused() {
        assert!(extremes().iter().all(|extreme| extreme.held), "{:?}", extremes());
    }
}
