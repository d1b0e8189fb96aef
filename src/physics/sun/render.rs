//! The picture of the disc: by curves and rows, or pixel by pixel.
//!
//! Both take the same averages over a pixel: across in closed form, upwards by Gauss' rule in each stretch between the places
//! where the limb, the horizon or a border of the air is met.

/// Pixel by pixel: every ray traced.
mod every;
/// One row of pixels.
mod line;

use std::f64::consts::PI;
use std::time::Duration;

pub use every::everything;

use self::line::Line;
use super::air::{Matter, Takes};
use super::chord::Chord;
use super::limb::Darkening;
use super::scene::{Scene, SceneError, View};
use super::transfer::{Curves, Wanted, curves};
use super::wavelengths::{BAND_NM, Sample, samples};
use crate::physics::colour::{Tone, Xyz};
use crate::physics::refraction::ray::{Launch, Outcome};
use crate::units::Angle;

/// The fewest and the most wavelengths that are chosen without being asked for.
const CHOSEN: [usize; 2] = [8, 64];

/// The curves are made so much better than the tolerance, because the thesis' tone shows a millionth of full light, and a limb
/// that is off by a hundredth of a pixel shows as much.
const FINER: f64 = 0.01;

/// Error of optical depths along the curves.
const DEPTH: f64 = 1e-3;

/// A picture: linear light.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The frame.
    pub view: View,
    /// X, Y, Z of each pixel's mean light, row 0 on top; Y in cd/m2 (10 degree observer). f32: seven digits, and down to
    /// 1e-38.
    pub xyz: Vec<[f32; 3]>,
}

impl Rendered {
    /// The largest Y, cd/m2.
    #[must_use]
    pub fn brightest(&self) -> f64 {
        f64::from(self.xyz.iter().map(|xyz| xyz[1]).fold(0.0, f32::max))
    }

    /// The codes in a tone; Y equal to `white` is full.
    #[must_use]
    pub fn codes(&self, tone: Tone, white: f64) -> Vec<[u8; 3]> {
        self.xyz.iter().map(|xyz| tone.codes(xyz.map(f64::from), white)).collect()
    }
}

/// What was done, what was left out, and what errors that can have made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Explained {
    /// Wavelengths of the picture.
    pub wavelengths: usize,
    /// Whether their number was asked for.
    pub asked: bool,
    /// Wavelengths at which rays were traced.
    pub traced_wavelengths: usize,
    /// How far neighbouring monochromatic pictures are apart.
    pub step: Angle,
    /// Rays traced.
    pub rays: usize,
    /// Rows that show light.
    pub lit_rows: usize,
    /// All rows.
    pub rows: usize,
    /// Pieces of the curves.
    pub panels: usize,
    /// Pieces not refined, because the Sun is not seen there.
    pub unreached: usize,
    /// Pieces that would not become good enough.
    pub given_up: usize,
    /// Bound of the interpolation along the curves.
    pub along: Angle,
    /// Bound of the interpolation of depths.
    pub depth: f64,
    /// Bound of the interpolation between wavelengths.
    pub between: Angle,
    /// What the method believes of its rays.
    pub believed: Angle,
    /// How long each part took.
    pub times: Vec<(&'static str, Duration)>,
}

impl Explained {
    /// All errors of place together.
    #[must_use]
    pub fn error(&self) -> Angle {
        self.along + self.between + self.believed
    }
}

/// What each sample needs.
pub(super) struct Light {
    pub(super) sample: Sample,
    pub(super) takes: Takes,
    pub(super) darkening: Darkening,
    /// Luminance of the disc's centre above the air.
    pub(super) centre: Xyz,
}

/// Makes the picture by curves. The clock gives the time since some beginning.
///
/// # Errors
/// The scene cannot be; the sentence says how it can.
pub fn render(scene: &Scene<'_>, clock: &dyn Fn() -> Duration) -> Result<(Rendered, Explained), SceneError> {
    scene.check()?;
    let mut explained = Explained { rows: scene.view.height, ..Explained::default() };
    let mut last = clock();
    let mut lap = |explained: &mut Explained, part| {
        let now = clock();
        explained.times.push((part, now.saturating_sub(last)));
        last = now;
    };
    let matter = Matter::of(scene)?;
    let spread = spread(scene, &matter)?;
    let count = scene.wavelengths.unwrap_or_else(|| count(scene, spread));
    explained.wavelengths = count;
    explained.asked = scene.wavelengths.is_some();
    explained.step = spread / count as f64;
    lap(&mut explained, "plan");
    let lights = lights(scene, count)?;
    lap(&mut explained, "particles");

    let most = lights
        .iter()
        .fold(Takes([0.0; 5]), |most, light| Takes(std::array::from_fn(|kind| most.0[kind].max(light.takes.0[kind]))));
    let samples: Vec<Sample> = lights.iter().map(|light| light.sample).collect();
    let levels = levels(scene);
    let fine = !scene.method.name().starts_with("lehn");
    let refraction = scene.tolerance.to_radians() * if fine { FINER } else { 1.0 };
    let wanted = Wanted { scene, matter: &matter, most, refraction, depth: DEPTH, levels };
    let Curves { transfers, effort } = curves(&wanted, &samples)?;
    explained.traced_wavelengths = effort.wavelengths;
    explained.rays = effort.rays;
    (explained.panels, explained.unreached, explained.given_up) = (effort.panels, effort.unreached, effort.given_up);
    (explained.along, explained.depth) = (Angle::radians(effort.refraction), effort.depth);
    (explained.between, explained.believed) = (Angle::radians(effort.between), Angle::radians(effort.believed));
    lap(&mut explained, "curves");

    let lit: Vec<Vec<[f64; 2]>> = transfers.iter().map(|transfer| transfer.between(levels)).collect();
    let View { width, height, .. } = scene.view;
    let frame = Frame::of(scene);
    let mut xyz = vec![[0f32; 3]; width * height];
    let mut line = Line::new(width);
    for (y, row) in xyz.chunks_exact_mut(width).enumerate() {
        line.clear();
        let [low, high] = frame.row(y);
        for ((light, transfer), lit) in lights.iter().zip(&transfers).zip(&lit) {
            let first = lit.partition_point(|stretch| stretch[1] <= low);
            for stretch in lit[first..].iter().take_while(|stretch| stretch[0] < high) {
                let part = [stretch[0].max(low), stretch[1].min(high)];
                for (altitude, weight) in gauss(part, [low, high]) {
                    let Some(path) = transfer.at(altitude) else { continue };
                    let chord = frame.chord(altitude, altitude - path[0]);
                    let share = weight * (-light.takes.depth(&path)).exp();
                    line.add(&chord, &light.darkening, light.centre.map(|part| part * share));
                }
            }
        }
        explained.lit_rows += usize::from(line.finish(row));
    }
    lap(&mut explained, "rows");
    Ok((Rendered { view: scene.view, xyz }, explained))
}

/// True altitudes of the lower and the upper limb.
pub(super) fn levels(scene: &Scene<'_>) -> [f64; 2] {
    let (altitude, radius) = (scene.sun_altitude.to_radians(), scene.sun_radius.to_radians());
    [altitude - radius, altitude + radius]
}

/// What each wavelength of a picture needs.
pub(super) fn lights(scene: &Scene<'_>, count: usize) -> Result<Vec<Light>, SceneError> {
    let solid_angle = PI * scene.sun_radius.sin().powi(2);
    let light = |sample: Sample| {
        let darkening = scene.limb.at(sample.nm);
        let centre = sample.light.map(|part| part / (solid_angle * darkening.mean()));
        Ok(Light { sample, takes: Takes::at(scene, sample.nm)?, darkening, centre })
    };
    samples(count, scene.spectrum).into_iter().map(light).collect()
}

/// How far the pictures of both ends of the band are apart, where the frame is.
fn spread(scene: &Scene<'_>, matter: &Matter) -> Result<Angle, SceneError> {
    let mut refractions = [Angle::ZERO; 2];
    let middle = scene.view.bottom + scene.view.pixel * (0.5 * scene.view.height as f64);
    for (refraction, nm) in refractions.iter_mut().zip(BAND_NM) {
        let medium = matter.medium(scene, nm)?;
        let tracer = scene.method.prepare(&medium, scene.tolerance)?;
        let trace = |apparent_altitude| tracer.trace(&Launch { apparent_altitude, height_m: scene.observer_height_m });
        let mut ray = trace(middle)?;
        if ray.outcome != Outcome::Escaped {
            ray = trace(Angle::ZERO.max(middle))?;
        }
        *refraction = ray.refraction;
    }
    Ok((refractions[0] - refractions[1]).abs())
}

/// As many wavelengths as bring neighbouring pictures within half a pixel, or within the tolerance if that is more.
fn count(scene: &Scene<'_>, spread: Angle) -> usize {
    let step = (scene.view.pixel * 0.5).max(scene.tolerance);
    // A cast from float to integer saturates.
    ((spread / step).ceil() as usize).clamp(CHOSEN[0], CHOSEN[1])
}

/// Points and weights of Gauss' rule on a part of a row (weights: shares of the row): two over the whole row, three over a part
/// of it, at whose end the limb may be.
pub(super) fn gauss([low, high]: [f64; 2], row: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
    const TWO: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 0.5), (0.577_350_269_189_625_8, 0.5)];
    const THREE: [(f64, f64); 3] = [
        (-0.774_596_669_241_483_4, 0.277_777_777_777_777_8),
        (0.0, 0.444_444_444_444_444_4),
        (0.774_596_669_241_483_4, 0.277_777_777_777_777_8),
    ];
    let rule: &[(f64, f64)] = if low <= row[0] && high >= row[1] { &TWO } else { &THREE };
    let share = (high - low) / (row[1] - row[0]);
    rule.iter().map(move |(x, weight)| (0.5 * (low + high) + 0.5 * (high - low) * x, weight * share))
}

/// Where pixels lie, and how rows cut the disc.
pub(super) struct Frame {
    top: f64,
    pixel: f64,
    sun: f64,
    /// sin² of half the Sun's radius.
    haversine: f64,
}

impl Frame {
    pub(super) fn of(scene: &Scene<'_>) -> Frame {
        Frame {
            top: scene.view.top().to_radians(),
            pixel: scene.view.pixel.to_radians(),
            sun: scene.sun_altitude.to_radians(),
            haversine: (0.5 * scene.sun_radius.to_radians()).sin().powi(2),
        }
    }

    /// Lower and upper edge of a row.
    pub(super) fn row(&self, y: usize) -> [f64; 2] {
        [self.top - (y + 1) as f64 * self.pixel, self.top - y as f64 * self.pixel]
    }

    /// The line that is seen at an apparent altitude and lies at a true one, with lengths in pixels.
    ///
    /// ```text
    /// hav d = hav(t - sun) + cos t cos sun hav A,   A = x/cos a,   mu² = 1 - hav d/hav radius
    /// ```
    pub(super) fn chord(&self, apparent: f64, truth: f64) -> Chord {
        let off = (0.5 * (truth - self.sun)).sin().powi(2);
        let stretch = apparent.cos().powi(2) / (truth.cos() * self.sun.cos()).max(1e-12);
        let radius_squared = 4.0 * self.haversine * stretch / (self.pixel * self.pixel);
        Chord { half_squared: radius_squared * (1.0 - off / self.haversine), radius_squared }
    }
}

#[cfg(test)]
mod tests;
