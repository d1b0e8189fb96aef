//! The ray equation stepped along the path by Dormand and Prince's pair, with error control and steps that end on the knots.
//!
//! ```text
//! dz/ds = sin a       da/ds = cos a (1/r + (dn/dz)/n)       dR/ds = -cos a (dn/dz)/n
//! ```
//!
//! The length of the path is the variable, so that turning points and ducts are nothing special. Each layer's formula is
//! smooth beyond its borders; a step that would cross one is cut there, so that no step sees a kink.

use super::medium::{Medium, Piece};
use super::{Crossing, Depths, Launch, Method, Outcome, Ray, RayError, Tracer, admitted};
use crate::numerics::roots::bracketed;
use crate::numerics::runge_kutta::{Step, step};
use crate::units::Angle;

/// Dormand and Prince's method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RungeKutta;

impl Method for RungeKutta {
    fn name(&self) -> &'static str {
        "runge-kutta"
    }

    fn prepare<'a>(&self, medium: &'a Medium<'a>, tolerance: Angle) -> Result<Box<dyn Tracer + 'a>, RayError> {
        Ok(Box::new(Prepared { medium, tolerance: admitted(tolerance)? }))
    }
}

struct Prepared<'a> {
    medium: &'a Medium<'a>,
    tolerance: f64,
}

/// Height, altitude of the ray, refraction, three depths.
type State = [f64; 6];

/// Of the tolerance, how much one step may spend.
const SHARE: f64 = 0.1;

/// An error in height (metres) for each radian of error in altitude that is as bad.
const HEIGHT_M: f64 = 1e4;

/// An error in optical depth (as a share of one more than the depth) for each radian of error in altitude that is as bad.
const DEPTH: f64 = 2e3;

/// The most steps, and the most for each piece of the air.
const MOST_STEPS: (usize, usize) = (20_000, 20);

/// Nearer to a border than this (metres) is on it.
const ON_BORDER_M: f64 = 1e-9;

impl Tracer for Prepared<'_> {
    fn trace(&self, launch: &Launch) -> Result<Ray, RayError> {
        self.medium.admit(launch)?;
        let mut march = March::new(self.medium, self.tolerance, launch.height_m, launch.apparent_altitude);
        let mut crossings = Vec::with_capacity(self.medium.pieces().len() + 1);
        let mut path_length_m = 0.0;
        let outcome = loop {
            let (crossing, end) = march.cross();
            path_length_m += crossing.path_m;
            if crossing.path_m > 0.0 {
                crossings.push(crossing);
            }
            if let Some(outcome) = end {
                break outcome;
            }
        };
        let [_, _, refraction, rayleigh, aerosol, ozone] = march.state;
        let refraction = Angle::radians(refraction);
        Ok(Ray {
            outcome,
            refraction,
            true_altitude: launch.apparent_altitude - refraction,
            path_length_m,
            tangent_height_m: march.tangent_height_m,
            depths: Depths { rayleigh, aerosol, ozone },
            crossings,
            steps: march.steps,
            evaluations: march.evaluations,
            believed_error: Angle::radians(march.believed),
        })
    }
}

/// A ray under way.
struct March<'a> {
    medium: &'a Medium<'a>,
    enough: f64,
    state: State,
    /// The piece it is in.
    index: usize,
    /// The next step, metres.
    length: f64,
    most_steps: usize,
    believed: f64,
    steps: usize,
    evaluations: usize,
    turns: usize,
    tangent_height_m: Option<f64>,
}

impl<'a> March<'a> {
    fn new(medium: &'a Medium<'a>, tolerance: f64, height_m: f64, altitude: Angle) -> March<'a> {
        March {
            medium,
            enough: tolerance * SHARE,
            state: [height_m, altitude.to_radians(), 0.0, 0.0, 0.0, 0.0],
            index: medium.piece_at(height_m),
            length: 1e3,
            most_steps: MOST_STEPS.0 + MOST_STEPS.1 * medium.pieces().len(),
            believed: 0.0,
            steps: 0,
            evaluations: 0,
            turns: 0,
            tangent_height_m: None,
        }
    }

    /// Goes on to the next border of the piece it is in.
    fn cross(&mut self) -> (Crossing, Option<Outcome>) {
        let piece = self.medium.pieces()[self.index];
        let from = self.state;
        let (mut path_m, mut low_m, mut high_m) = (0.0, from[0], from[0]);
        let mut slope = self.slope(&piece, &from);
        let end = loop {
            // A ray that stands on a border and heads out of the piece has left it.
            if let Some(end) = self.leave(&piece, &slope) {
                break end;
            }
            if self.turns >= 2 || self.steps >= self.most_steps {
                break Some(Outcome::Trapped);
            }
            let (gone, taken) = self.advance(&piece, &slope);
            let (before, after) = (self.state[1], taken.state[1]);
            path_m += gone;
            self.state = taken.state;
            if before * after < 0.0 {
                self.turns += 1;
            }
            if before < 0.0 && after >= 0.0 {
                // Lowest where the parabola through the two ends is level.
                let turn = self.state[0] - 0.5 * after * after * gone / (after - before);
                self.tangent_height_m = Some(turn);
                low_m = low_m.min(turn);
            }
            for border in [piece.low_m, piece.high_m] {
                if (self.state[0] - border).abs() < ON_BORDER_M {
                    self.state[0] = border;
                }
            }
            (low_m, high_m) = (low_m.min(self.state[0]), high_m.max(self.state[0]));
            slope = taken.slope;
        };
        let gone = |i: usize| self.state[i] - from[i];
        let depths = Depths { rayleigh: gone(3), aerosol: gone(4), ozone: gone(5) };
        (Crossing { low_m, high_m, path_m, refraction: Angle::radians(gone(2)), depths }, end)
    }

    /// Steps over to the neighbouring piece where the ray leaves this one; says so, and how it ends if it ends there.
    fn leave(&mut self, piece: &Piece, slope: &State) -> Option<Option<Outcome>> {
        let (z, altitude) = (self.state[0], self.state[1]);
        // Level on a border, the curvature says where it goes.
        let heading = if altitude == 0.0 { slope[1] } else { altitude };
        if z >= piece.high_m && heading > 0.0 {
            self.index += 1;
            return Some((self.index == self.medium.pieces().len()).then_some(Outcome::Escaped));
        }
        if z <= piece.low_m && heading < 0.0 {
            return Some(match self.index.checked_sub(1) {
                Some(below) => {
                    // Level on a border above which it bends down and below which it bends up, it stays for ever.
                    let below_piece = self.medium.pieces()[below];
                    let state = self.state;
                    if altitude == 0.0 && self.slope(&below_piece, &state)[1] >= 0.0 {
                        Some(Outcome::Trapped)
                    } else {
                        self.index = below;
                        None
                    }
                }
                None => Some(Outcome::Ground),
            });
        }
        None
    }

    /// One accepted step that does not cross a border; gives its length too.
    fn advance(&mut self, piece: &Piece, slope: &State) -> (f64, Step<6>) {
        loop {
            let length = self.length;
            let taken = self.step(piece, slope, length);
            let depths = (3..6).map(|i| taken.error[i].abs() / (1.0 + self.state[i]) / DEPTH).fold(0.0, f64::max);
            let wrong = taken.error[2].abs().max(taken.error[1].abs()).max(taken.error[0].abs() / HEIGHT_M).max(depths);
            // Far beyond its layer a formula may give no number: too long a step.
            if !taken.state.iter().chain(&taken.error).all(|x| x.is_finite()) {
                self.length = length * 0.2;
                continue;
            }
            // Order 5 with an estimate of order 4: the next length aims at 0.9 of what is allowed.
            let factor = (0.9 * (self.enough / wrong.max(1e-300)).powf(0.2)).clamp(0.2, 5.0);
            if wrong > self.enough && length > 1e-6 {
                self.length = length * factor;
                continue;
            }
            // The first border that the step crosses cuts it.
            let (length, taken) = match self.crossing(piece, slope, &taken, length) {
                None => {
                    self.length = length * factor;
                    (length, taken)
                }
                Some((share, border)) => self.cut(piece, slope, length * share, border),
            };
            self.believed += taken.error[2].abs() + taken.error[1].abs();
            return (length, taken);
        }
    }

    /// Where, as a share of the step, the height first passes a border, and which.
    fn crossing(&self, piece: &Piece, slope: &State, taken: &Step<6>, length: f64) -> Option<(f64, f64)> {
        let (z0, z1, s0, s1) = (self.state[0], taken.state[0], slope[0] * length, taken.slope[0] * length);
        // Hermite's cubic through both ends.
        let cubic = |u: f64| {
            let (a, b) = (3.0 * (z1 - z0) - 2.0 * s0 - s1, 2.0 * (z0 - z1) + s0 + s1);
            z0 + u * (s0 + u * (a + u * b))
        };
        let passed = |z: f64| z > piece.high_m + ON_BORDER_M || z < piece.low_m - ON_BORDER_M;
        // A step that turns may have passed and come back: the turn is near where the line through the slopes is level.
        let turn = if s0 * s1 < 0.0 { s0 / (s0 - s1) } else { 1.0 };
        let end = [turn, 1.0].into_iter().find(|&u| passed(if u == 1.0 { z1 } else { cubic(u) }))?;
        let border = if cubic(end) > piece.high_m { piece.high_m } else { piece.low_m };
        // On the way to a turn the height goes one way; after it, the other.
        let begin = if end == 1.0 && turn < 1.0 { turn } else { 0.0 };
        let share = bracketed(begin, end, 1e-12, |u| cubic(u) - border);
        Some((share, border))
    }

    /// A step as long as leads onto the border.
    fn cut(&mut self, piece: &Piece, slope: &State, mut length: f64, border: f64) -> (f64, Step<6>) {
        let mut taken = self.step(piece, slope, length);
        for _ in 0..6 {
            let miss = taken.state[0] - border;
            let rise = taken.slope[0];
            // Near the level the last metres are not worth more steps: the height is off by less than the rounding.
            if miss.abs() < ON_BORDER_M || rise.abs() * length < ON_BORDER_M {
                break;
            }
            let better = length - miss / rise;
            if !(better > 0.0 && better < 2.0 * length) {
                break;
            }
            length = better;
            taken = self.step(piece, slope, length);
        }
        taken.state[0] = border;
        (length, taken)
    }

    fn step(&mut self, piece: &Piece, slope: &State, length: f64) -> Step<6> {
        self.steps += 1;
        self.evaluations += 6;
        let (medium, layer) = (self.medium, piece.layer);
        step(&self.state, slope, length, |state| derivative(medium, layer, state))
    }

    fn slope(&mut self, piece: &Piece, state: &State) -> State {
        self.evaluations += 1;
        derivative(self.medium, piece.layer, state)
    }
}

/// The right-hand side of the ray equation.
#[inline]
fn derivative(medium: &Medium<'_>, layer: usize, state: &State) -> State {
    let local = medium.at(layer, state[0]);
    let (sin, cos) = state[1].sin_cos();
    let bend = -cos * local.slope / (1.0 + local.refractivity);
    let depths = medium.extinctions(&local, state[0]);
    [sin, cos / (medium.earth_radius_m + state[0]) - bend, bend, depths.rayleigh, depths.aerosol, depths.ozone]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::physics::air::presets;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        /// The method does not know of the invariant n r cos a, and keeps it at every border.
        #[test]
        fn the_invariant_holds_along_every_ray(arcmin in -10.0..5000.0f64, which in 0..presets::NAMES.len(), nm in 350.0..800.0f64) {
            let air = presets::named(presets::NAMES[which]).unwrap().unwrap();
            let medium = Medium::new(&air.profile, nm, 6_371_000.0, 1e5).unwrap();
            let mut march = March::new(&medium, 1e-9, air.observer_height_m.unwrap(), Angle::arcminutes(arcmin));
            let invariant = |state: &State| (1.0 + medium.refractivity(state[0]).0) * (6_371_000.0 + state[0]) * state[1].cos();
            let at_eye = invariant(&march.state);
            while march.cross().1.is_none() {
                // A millimetre in 6371 km.
                prop_assert!((invariant(&march.state) - at_eye).abs() < 1e-3, "{:?}", march.state);
            }
        }
    }
}
