//! Both photographs together: scale, turn, parity and offset, each with its error.

use super::frame::{Frame, MoonError};
use super::limb::{Limb, Shape};
use super::surface::{Laid, laid};

/// A number with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Measured {
    /// The number.
    pub value: f64,
    /// One standard deviation.
    pub error: f64,
}

/// How the projected Moon lies on the seen one.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The Moon through the telescope.
    pub telescope: Limb,
    /// The Moon that the projector drew.
    pub projected: Limb,
    /// Projected over seen size.
    pub scale: Measured,
    /// The same from the limbs alone.
    pub limb_scale: Measured,
    /// The same from maria and craters alone, where both photographs show them.
    pub surface_scale: Option<Measured>,
    /// By how many standard deviations the two differ, where both are there.
    pub contradiction: Option<f64>,
    /// Projected middle less seen middle: to the right and down, pixels of the photographs.
    pub offset_px: [Measured; 2],
    /// How far the projected Moon is turned from the seen one, counter-clockwise as one looks at the photographs, degrees (a
    /// mirror image is mirrored first); nothing where neither maria nor a terminator tell.
    pub rotation_deg: Option<Measured>,
    /// Whether the projected Moon is the mirror image of the seen one; nothing where no maria tell.
    pub mirrored: Option<bool>,
}

/// Which of the two photographs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The Moon through the telescope.
    Telescope,
    /// The projected Moon.
    Projected,
}

/// Why two photographs give no calibration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the photograph of the {} cannot be used: {why}", match which {
    Which::Telescope => "Moon through the telescope",
    Which::Projected => "projected Moon",
})]
pub struct PairError {
    /// Which of them.
    pub which: Which,
    /// Why not.
    pub why: MoonError,
}

/// The direction of the bright limb is no better known than this from a photograph with maria.
const BRIGHT_LIMB_DEG: f64 = 3.0;

impl Pair {
    /// Measures two photographs. `shape` is what the air makes of the seen Moon; the drawn one is round.
    ///
    /// # Errors
    /// Which photograph shows no Moon, why, and what to do.
    pub fn measured(telescope: &Frame, projected: &Frame, shape: Shape) -> Result<Pair, PairError> {
        let of = |frame, shape, which| Limb::of(frame, shape).map_err(|why| PairError { which, why });
        let seen = of(telescope, shape, Which::Telescope)?;
        let drawn = of(projected, Shape::ROUND, Which::Projected)?;
        let surface = laid((telescope, &seen), (projected, &drawn));
        Ok(Pair::joined(seen, drawn, surface))
    }

    /// Adds an error that is none of the photographs': relative, to everything that compares sizes.
    pub fn widen(&mut self, relative: f64) {
        for measured in
            [Some(&mut self.scale), Some(&mut self.limb_scale), self.surface_scale.as_mut()].into_iter().flatten()
        {
            measured.error = measured.error.hypot(relative * measured.value);
        }
    }

    fn joined(seen: Limb, drawn: Limb, surface: Option<Laid>) -> Pair {
        let ratio = drawn.radius / seen.radius;
        let limb_scale = Measured { value: ratio, error: ratio * seen.radius_error().hypot(drawn.radius_error()) };
        let surface_scale = surface.map(|laid| Measured {
            value: ratio * (1.0 + laid.stretch),
            error: ratio * (1.0 + laid.stretch) * laid.covariance[0][0].sqrt(),
        });
        let contradiction =
            surface_scale.map(|other| (other.value - limb_scale.value).abs() / other.error.hypot(limb_scale.error));
        let scale = match surface_scale {
            Some(other) => weighted(limb_scale, other, contradiction.unwrap_or(0.0)),
            None => limb_scale,
        };
        // From x to y is clockwise as one looks at it; through the mirror, that came after, counter-clockwise.
        let rotation_deg = match surface {
            Some(laid) => Some(Measured {
                value: if laid.mirrored { laid.turn } else { -laid.turn }.to_degrees(),
                error: laid.covariance[1][1].sqrt().to_degrees(),
            }),
            None => seen.bright.zip(drawn.bright).map(|(seen, drawn)| Measured {
                value: (seen - drawn).to_degrees(),
                error: BRIGHT_LIMB_DEG * std::f64::consts::SQRT_2,
            }),
        };
        let rotation_deg = rotation_deg.map(|turn| Measured { value: wrapped(turn.value), ..turn });
        Pair {
            offset_px: offset(&seen, &drawn, surface),
            mirrored: surface.map(|laid| laid.mirrored),
            rotation_deg,
            telescope: seen,
            projected: drawn,
            scale,
            limb_scale,
            surface_scale,
            contradiction,
        }
    }
}

/// Two measurements of one number by their errors. Where two of like precision contradict each other, the error is widened by as
/// much (Birge 1932, Phys. Rev. 40, 207); one that is five times coarser has no say in the error of the finer.
fn weighted(one: Measured, other: Measured, contradiction: f64) -> Measured {
    let weights = (one.error.powi(-2), other.error.powi(-2));
    let whole = weights.0 + weights.1;
    let alike = (0.2..5.0).contains(&(one.error / other.error));
    Measured {
        value: (one.value * weights.0 + other.value * weights.1) / whole,
        error: whole.powf(-0.5) * if contradiction > 3.0 && alike { contradiction } else { 1.0 },
    }
}

/// Where the middle of the seen Moon is drawn, less where it is. The surface carries the middle over even where the limb of a
/// short arc leaves it unsure; the limbs' own middles are the fallback.
fn offset(seen: &Limb, drawn: &Limb, surface: Option<Laid>) -> [Measured; 2] {
    let spread = |limb: &Limb, k: usize| limb.covariance[k][k].max(0.0);
    match surface {
        Some(laid) => {
            let shift = (if laid.mirrored { -laid.shift.0 } else { laid.shift.0 }, laid.shift.1);
            let (x, y) = drawn.place(shift.0, shift.1);
            let stretch = drawn.radius / seen.radius * (1.0 + laid.stretch);
            let error = |k| {
                let carried = drawn.radius * laid.covariance[2][2].max(laid.covariance[3][3]).sqrt();
                // An error of the seen middle moves the drawn one with it, but for the scale and the turn.
                let (sin, cos) = laid.turn.sin_cos();
                let loose = (stretch * cos - 1.0).powi(2) + (stretch * sin).powi(2);
                (carried.powi(2) + spread(seen, k) * loose).sqrt()
            };
            [Measured { value: x - seen.x, error: error(0) }, Measured { value: y - seen.y, error: error(1) }]
        }
        None => {
            let error = |k| (spread(seen, k) + spread(drawn, k)).sqrt();
            [
                Measured { value: drawn.x - seen.x, error: error(0) },
                Measured { value: drawn.y - seen.y, error: error(1) },
            ]
        }
    }
}

/// Degrees from -180 to 180.
fn wrapped(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}
