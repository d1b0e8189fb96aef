//! The limb to a part of a pixel: straightened along the first circle, its blurred edge compared with its own mean profile,
//! stretch by stretch.

use super::arc::{Stretch, robust, weighed};
use super::frame::{FULL, Frame, MoonError};
use super::linear::quantile;
use super::profile::{Point, Profile, cut_noise};
use super::search;
use crate::units::Angle;

/// What the air makes of the disc: how much flatter it is, and where its upper side is in the photograph.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// 1 less the ratio of height to width.
    pub flattening: f64,
    /// The direction of the zenith, from the photograph's x axis to its y axis (clockwise as one looks at it).
    pub up: Angle,
}

impl Shape {
    /// A circle.
    pub const ROUND: Shape = Shape { flattening: 0.0, up: Angle::ZERO };

    /// Radius of an ellipse of half width 1 in a direction.
    ///
    /// ```text
    /// r = 1 / sqrt(cos^2 a / (1 - f)^2 + sin^2 a)          a from the short axis
    /// ```
    #[must_use]
    pub fn radius(&self, angle: f64) -> f64 {
        let (sin, cos) = (angle - self.up.to_radians()).sin_cos();
        (cos / (1.0 - self.flattening)).hypot(sin).recip()
    }
}

/// The limb of the Moon in a photograph.
#[derive(Debug, Clone, PartialEq)]
pub struct Limb {
    /// The middle of the disc, pixels from the left.
    pub x: f64,
    /// The middle of the disc, pixels from the top.
    pub y: f64,
    /// Half of the disc's width, pixels: what it is across the direction in which the air flattens it.
    pub radius: f64,
    /// Covariance of x, y and radius, square pixels.
    pub covariance: [[f64; 3]; 3],
    /// The shape that was assumed.
    pub shape: Shape,
    /// Degrees of bright limb that were used.
    pub arc_deg: f64,
    /// How far the limb lies off the circle, root of the mean square, pixels.
    pub roughness_px: f64,
    /// Blur of the edge, a Gaussian's standard deviation in pixels.
    pub blur_px: f64,
    /// The exponent of the camera's curve, as the edge shows it: 1 is linear.
    pub tone: f64,
    /// Where the bright limb's middle stands, from the photograph's x axis to its y axis, radians; nothing when it is lit all round.
    pub bright: Option<f64>,
}

/// Most stretches into which the found arc is cut.
const STRETCHES: f64 = 160.0;
/// Least length of a stretch, pixels.
const SHORTEST_PX: f64 = 8.0;
/// Samples across the limb a pixel.
const PER_PX: f64 = 2.0;
/// A stretch is lit if it is so bright, compared with the brightest fifth.
const LIT: f64 = 0.6;
/// Less arc is no circle.
const LEAST_ARC_DEG: f64 = 20.0;

/// The mean brightness across one stretch of limb.
struct Cut {
    angle: f64,
    points: Vec<Point>,
    /// Bright inside less dark outside.
    rise: f64,
    /// Share of the inside at full white.
    full: f64,
}

impl Limb {
    /// Finds the Moon's limb in a photograph, for the shape that the air gives its disc.
    ///
    /// # Errors
    /// Nothing bright, too bright, no circle, too short an arc.
    pub fn of(frame: &Frame, shape: Shape) -> Result<Limb, MoonError> {
        let (mut circle, coarse, found_deg) = search::circle(frame)?;
        let noise = frame.noise().max(1e-3);
        let mut reach = (3.0 * coarse + 8.0).min(circle.radius / 4.0);
        let step = step(circle.radius, found_deg);
        let black = cut_noise_of(frame, &circle, coarse);
        let mut profile = None;
        for round in 0..5 {
            let cuts = lit(cut(frame, &circle, &shape, reach, step))?;
            let arc_deg = (cuts.len() as f64 * step).to_degrees();
            if arc_deg < LEAST_ARC_DEG {
                return Err(MoonError::NoLimb {
                    found: format!("{arc_deg:.0} degrees"),
                    wanted: LEAST_ARC_DEG.to_string(),
                });
            }
            let mean = mean(&cuts);
            // Neighbouring samples share pixels: two of them are worth one.
            let per_point = 1.5 * noise / (cuts.len() as f64 * step * circle.radius).sqrt();
            let start = profile.unwrap_or_else(|| first(&mean, black));
            let (fitted, edge_error) = start.fitted(&mean, per_point.max(1e-4));
            let mut stretches: Vec<Stretch> =
                cuts.iter().filter_map(|cut| stretch(cut, &fitted, &shape, reach)).collect();
            let (by, kept) = robust(&stretches)
                .ok_or(MoonError::NoLimb { found: format!("{} stretches", stretches.len()), wanted: "6".into() })?;
            circle.x += by[0];
            circle.y += by[1];
            circle.radius += by[2];
            reach = (6.0 * fitted.blur()).clamp(8.0, 0.25 * circle.radius);
            // The profile is centred anew on the limb it has found.
            profile = Some(fitted.with_edge(0.0));
            if round == 4 {
                let mut kept = kept.into_iter();
                stretches.retain(|_| kept.next().unwrap_or(false));
                let all_round = arc_deg > 300.0;
                let correction = weighed(&stretches, step)
                    .ok_or(MoonError::NoLimb { found: format!("{} stretches", stretches.len()), wanted: "6".into() })?;
                let rough: f64 = stretches
                    .iter()
                    .map(|s| s.off - s.angle.cos() * by[0] - s.angle.sin() * by[1] - s.per_radius * by[2])
                    .map(|off| off * off)
                    .sum();
                return Ok(Limb {
                    x: circle.x + correction.by[0] - by[0],
                    y: circle.y + correction.by[1] - by[1],
                    radius: circle.radius + correction.by[2] - by[2],
                    covariance: {
                        let mut covariance = correction.covariance;
                        covariance[2][2] += edge_error * edge_error;
                        covariance
                    },
                    shape,
                    arc_deg: (stretches.len() as f64 * step).to_degrees(),
                    roughness_px: (rough / stretches.len() as f64).sqrt(),
                    blur_px: fitted.blur(),
                    tone: fitted.tone(),
                    bright: (!all_round).then(|| {
                        let (sin, cos) = stretches
                            .iter()
                            .fold((0.0, 0.0), |(sin, cos), s| (sin + s.angle.sin(), cos + s.angle.cos()));
                        sin.atan2(cos)
                    }),
                });
            }
        }
        Err(MoonError::NoLimb { found: "nothing".into(), wanted: LEAST_ARC_DEG.to_string() })
    }

    /// The relative error of the radius.
    #[must_use]
    pub fn radius_error(&self) -> f64 {
        self.covariance[2][2].max(0.0).sqrt() / self.radius
    }

    /// The place in the photograph of a place on the disc, in half widths of it.
    pub(super) fn place(&self, u: f64, v: f64) -> (f64, f64) {
        let (sin, cos) = self.shape.up.sin_cos();
        let squeezed = -self.shape.flattening * (u * cos + v * sin);
        (self.x + self.radius * (u + squeezed * cos), self.y + self.radius * (v + squeezed * sin))
    }
}

/// Radians of a stretch, when so many degrees of limb were found.
fn step(radius: f64, found_deg: f64) -> f64 {
    let around = std::f64::consts::TAU * radius;
    std::f64::consts::TAU
        / (around / SHORTEST_PX).min(STRETCHES * 360.0 / found_deg.clamp(20.0, 360.0)).floor().max(24.0)
}

/// The noise that the file cut off at black, from what is outside of the disc.
fn cut_noise_of(frame: &Frame, circle: &search::Circle, coarse: f64) -> f64 {
    let (mut zeros, mut sum, mut count) = (0.0, 0.0, 0.0f64);
    let beyond = circle.radius + 4.0 * coarse + 10.0;
    for y in (0..frame.height()).step_by(2) {
        for x in (0..frame.width()).step_by(2) {
            let away = (x as f64 + 0.5 - circle.x).hypot(y as f64 + 0.5 - circle.y);
            if away > beyond && away < 1.5 * beyond {
                let value = frame.pixel(x, y);
                zeros += f64::from(u8::from(value < 0.002));
                sum += value;
                count += 1.0;
            }
        }
    }
    if count < 50.0 || sum < 0.0 { 0.0 } else { cut_noise(zeros / count, sum / count) }
}

/// Brightness across every stretch of the circle that is in the picture whole.
fn cut(frame: &Frame, circle: &search::Circle, shape: &Shape, reach: f64, step: f64) -> Vec<Cut> {
    let rays = (step * circle.radius).ceil().max(4.0) as usize;
    let samples = (reach * PER_PX) as i32;
    let offsets: Vec<f64> = (-samples * 5 / 4..=samples * 3 / 4).map(|k| f64::from(k) / PER_PX).collect();
    let count = (std::f64::consts::TAU / step).round() as usize;
    let mut cuts = Vec::new();
    for place in 0..count {
        let mut sums = vec![0.0; offsets.len()];
        let (mut whole, mut full) = (0usize, 0usize);
        for ray in 0..rays {
            let angle = (place as f64 + (ray as f64 + 0.5) / rays as f64) * step;
            let (sin, cos) = angle.sin_cos();
            let limb = circle.radius * shape.radius(angle);
            let at = |off: &f64| frame.at(circle.x + (limb + off) * cos, circle.y + (limb + off) * sin);
            let Some(values) = offsets.iter().map(at).collect::<Option<Vec<f64>>>() else { continue };
            whole += 1;
            full += values[..offsets.len() / 3].iter().filter(|value| **value >= f64::from(FULL)).count();
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        if whole * 10 < rays * 9 {
            continue;
        }
        let points: Vec<Point> = offsets.iter().zip(&sums).map(|(x, sum)| (*x, sum / whole as f64)).collect();
        let mean = |part: &[Point]| part.iter().map(|(_, v)| v).sum::<f64>() / part.len().max(1) as f64;
        let third = points.len() / 3;
        cuts.push(Cut {
            angle: (place as f64 + 0.5) * step,
            rise: mean(&points[third / 2..third * 3 / 2]) - mean(&points[points.len() - third / 2..]),
            full: full as f64 / (whole * (offsets.len() / 3)) as f64,
            points,
        });
    }
    cuts
}

/// The stretches of bright limb: not the dark one, nor what is burnt out.
fn lit(mut cuts: Vec<Cut>) -> Result<Vec<Cut>, MoonError> {
    let mut rises: Vec<f64> = cuts.iter().map(|cut| cut.rise).collect();
    let bright = quantile(&mut rises, 0.9);
    cuts.retain(|cut| cut.rise > LIT * bright && cut.rise > 0.0);
    let all = cuts.len();
    cuts.retain(|cut| cut.full < 0.3);
    if cuts.len() * 2 < all {
        return Err(MoonError::Saturated { percent: 100.0 * (1.0 - cuts.len() as f64 / all as f64) });
    }
    Ok(cuts)
}

/// All stretches' mean profile, each scaled to rise by 1, times the mean rise.
fn mean(cuts: &[Cut]) -> Vec<Point> {
    let Some(first) = cuts.first() else { return Vec::new() };
    let mut mean: Vec<Point> = first.points.iter().map(|(x, _)| (*x, 0.0)).collect();
    for cut in cuts {
        mean.iter_mut().zip(&cut.points).for_each(|((_, sum), (_, value))| *sum += value);
    }
    mean.iter_mut().for_each(|(_, sum)| *sum /= cuts.len() as f64);
    mean
}

/// A first profile: blur from how far apart a quarter and three quarters are.
fn first(mean: &[Point], cut: f64) -> Profile {
    let level = |part: &[Point]| part.iter().map(|(_, v)| v).sum::<f64>() / part.len().max(1) as f64;
    let quarter = mean.len() / 4;
    let (bright, dark) = (level(&mean[..quarter]), level(&mean[mean.len() - quarter..]));
    let crossing = |share: f64| {
        let wanted = dark + share * (bright - dark);
        mean.iter().rev().find(|(_, v)| *v >= wanted).map_or(0.0, |(x, _)| *x)
    };
    let blur = ((crossing(0.25) - crossing(0.75)) / 1.35).clamp(0.5, 20.0);
    Profile::plain(blur, dark, (bright - dark).max(1e-3), cut).with_edge(crossing(0.5))
}

/// How far a stretch lies outside: the shift, rise and dark level that take the profile to it, by Gauss-Newton.
fn stretch(cut: &Cut, profile: &Profile, shape: &Shape, reach: f64) -> Option<Stretch> {
    use super::linear::Normal;
    let near = (3.5 * profile.blur()).max(4.0).min(reach);
    let own = profile.with_edge(0.0);
    let dark = own.at(1e3);
    let (mut off, mut rise, mut base) = (profile.edge, 1.0, dark);
    let mut error = f64::NAN;
    for _ in 0..6 {
        let mut normal = Normal::<3>::new();
        for (x, value) in cut.points.iter().filter(|(x, _)| (x - profile.edge).abs() <= near) {
            let here = own.at(x - off) - dark;
            let slope = (own.at(x - off + 0.02) - own.at(x - off - 0.02)) / 0.04;
            normal.add(&[1.0, here, -rise * slope], value - base - rise * here, 1.0);
        }
        let (by, inverse) = normal.solve()?;
        base += by[0];
        rise += by[1];
        off += by[2].clamp(-1.5, 1.5);
        error = inverse[2][2].sqrt();
    }
    let fits = rise > 0.2 && (off - profile.edge).abs() < near && error.is_finite() && error > 0.0;
    fits.then(|| Stretch { angle: cut.angle, per_radius: shape.radius(cut.angle), off, error })
}
