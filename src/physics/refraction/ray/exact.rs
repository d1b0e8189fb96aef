//! The exact method: refraction, length and depths as integrals over height, with the invariant n r cos a in place of the angle.
//!
//! ```text
//! R = ∫ -(dn/dz)/n · p dz/√((n r)² - p²)       s = ∫ n r dz/√((n r)² - p²)       p = n r cos a
//! ```
//!
//! Bouguer's invariant; the integrals as in Auer & Standish (2000), Astron. J. 119, 2472, but over height, because their
//! variable, the angle, stands still where a ray bends like the globe. What is below the root is formed without
//! cancellation: with y = n r - p it is y (y + 2 p), and
//!
//! ```text
//! y = n (z - z0) + (N - N0) r0 + n0 r0 · 2 sin²(a0/2)
//! ```
//!
//! The air is cut where the profile has knots and where n r is stationary, so that n r is monotone in each piece: a
//! piece holds one turning point or none, also in a duct. From its end with the smaller y the variable is
//! v = √(δ + |z - z_end|) - √δ, δ = y/|dy/dz|, in which the integrand is smooth, at a turning point too.

use super::medium::{Local, Medium, Piece};
use super::{Crossing, Depths, Launch, Method, Outcome, Ray, RayError, Tracer, admitted};
use crate::numerics::quadrature::{Points, panel};
use crate::numerics::roots::bracketed;
use crate::units::Angle;

/// The exact method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exact;

impl Method for Exact {
    fn name(&self) -> &'static str {
        "exact"
    }

    fn prepare<'a>(&self, medium: &'a Medium<'a>, tolerance: Angle) -> Result<Box<dyn Tracer + 'a>, RayError> {
        Ok(Box::new(Prepared { medium, tolerance: admitted(tolerance)? }))
    }
}

struct Prepared<'a> {
    medium: &'a Medium<'a>,
    tolerance: f64,
}

/// The constants of one ray.
struct Invariant {
    /// Height, refractivity and radius at the eye.
    z0: f64,
    n0: f64,
    r0: f64,
    /// n0 r0 (1 - cos a0).
    lift: f64,
    /// n r cos a, metres.
    p: f64,
}

impl Invariant {
    /// y = n r - p at a height, metres.
    #[inline]
    fn excess(&self, z: f64, refractivity: f64) -> f64 {
        (1.0 + refractivity) * (z - self.z0) + (refractivity - self.n0) * self.r0 + self.lift
    }
}

/// What has been added up: refraction, length, depths.
const SUMS: usize = 5;

/// One way out from the eye: up to the top, down to the ground, or to a turning point.
struct Leg {
    sums: [f64; SUMS],
    error: f64,
    /// Where it turns, if it does.
    turn_m: Option<f64>,
    crossings: Vec<Crossing>,
}

/// How the work is going.
#[derive(Default)]
struct Effort {
    steps: usize,
    evaluations: usize,
}

/// Panels narrower than this share of their piece are not halved any more.
const FINEST: f64 = 1e-12;

/// The most panels in a piece.
const MOST_PANELS: usize = 400;

/// Nearer than this (metres) to the end with the smaller y, y is summed up from its slopes, because there the rounding of
/// the index would show.
const NEAR_M: f64 = 0.02;

/// Over pieces thinner than this (metres) the air hardly changes.
const EVEN_M: f64 = 300.0;

impl Tracer for Prepared<'_> {
    fn trace(&self, launch: &Launch) -> Result<Ray, RayError> {
        self.medium.admit(launch)?;
        let start = self.medium.piece_at(launch.height_m);
        let local = self.medium.at(self.medium.pieces()[start].layer, launch.height_m);
        let (z0, r0) = (launch.height_m, self.medium.earth_radius_m + launch.height_m);
        let altitude = launch.apparent_altitude.to_radians();
        let nr = (1.0 + local.refractivity) * r0;
        let ray = Invariant {
            z0,
            n0: local.refractivity,
            r0,
            lift: nr * 2.0 * (0.5 * altitude).sin().powi(2),
            p: nr * altitude.cos(),
        };

        // Go the first way; from a turning point the ray comes back the same way and goes the other.
        let mut effort = Effort { evaluations: 1, ..Effort::default() };
        let upwards = altitude >= 0.0;
        let mut first = self.leg(&ray, start, upwards, &mut effort);
        let mut tangent_height_m = None;
        let mut outcome = if upwards { Outcome::Escaped } else { Outcome::Ground };
        if let Some(turn) = first.turn_m {
            let second = self.leg(&ray, start, !upwards, &mut effort);
            outcome = match (second.turn_m, upwards) {
                (Some(_), _) => Outcome::Trapped,
                (None, true) => Outcome::Ground,
                (None, false) => Outcome::Escaped,
            };
            tangent_height_m = if upwards { second.turn_m } else { Some(turn) };
            first.double();
            first.add(second, outcome == Outcome::Trapped);
        }
        let [refraction, path_length_m, rayleigh, aerosol, ozone] = first.sums;
        let refraction = Angle::radians(refraction);
        Ok(Ray {
            outcome,
            refraction,
            true_altitude: launch.apparent_altitude - refraction,
            path_length_m,
            tangent_height_m,
            depths: Depths { rayleigh, aerosol, ozone },
            crossings: first.crossings,
            steps: effort.steps,
            evaluations: effort.evaluations,
            believed_error: Angle::radians(first.error),
        })
    }
}

impl Leg {
    /// There and back.
    fn double(&mut self) {
        self.sums = self.sums.map(|sum| 2.0 * sum);
        self.error *= 2.0;
        for crossing in &mut self.crossings {
            crossing.path_m *= 2.0;
            crossing.refraction = crossing.refraction * 2.0;
            let Depths { rayleigh, aerosol, ozone } = &mut crossing.depths;
            (*rayleigh, *aerosol, *ozone) = (*rayleigh * 2.0, *aerosol * 2.0, *ozone * 2.0);
        }
    }

    /// And on, one way or there and back.
    fn add(&mut self, mut next: Leg, and_back: bool) {
        if and_back {
            next.double();
        }
        for (sum, more) in self.sums.iter_mut().zip(next.sums) {
            *sum += more;
        }
        self.error += next.error;
        self.crossings.append(&mut next.crossings);
    }
}

impl Prepared<'_> {
    /// Follows the ray from the eye one way.
    fn leg(&self, ray: &Invariant, start: usize, upwards: bool, effort: &mut Effort) -> Leg {
        let pieces = self.medium.pieces();
        let mut leg =
            Leg { sums: [0.0; SUMS], error: 0.0, turn_m: None, crossings: Vec::with_capacity(pieces.len() + 1) };
        let (mut at, mut index) = (ray.z0, start);
        // Going down from a border, the piece below is the first.
        if !upwards && at <= pieces[start].low_m {
            match start.checked_sub(1) {
                Some(below) => index = below,
                None => return leg,
            }
        }
        loop {
            let piece = &pieces[index];
            let (far, refractivity) =
                if upwards { (piece.high_m, piece.high_refractivity) } else { (piece.low_m, piece.low_refractivity) };
            // The ray turns where y falls to zero.
            let turn = (ray.excess(far, refractivity) <= 0.0).then(|| {
                bracketed(at, far, 0.0, |z| {
                    effort.evaluations += 1;
                    ray.excess(z, self.medium.at(piece.layer, z).refractivity)
                })
            });
            self.cross(ray, piece, at, turn.unwrap_or(far), turn.is_some(), &mut leg, effort);
            if turn.is_some() {
                leg.turn_m = turn;
                return leg;
            }
            at = far;
            match if upwards { index.checked_add(1) } else { index.checked_sub(1) } {
                Some(next) if next < pieces.len() => index = next,
                _ => return leg,
            }
        }
    }

    /// Adds the integrals over a part of a piece.
    #[expect(clippy::too_many_arguments, reason = "each is one plain thing, and they meet only here")]
    fn cross(
        &self,
        ray: &Invariant,
        piece: &Piece,
        from: f64,
        to: f64,
        turns: bool,
        leg: &mut Leg,
        effort: &mut Effort,
    ) {
        if from == to {
            return;
        }
        // Choose the end from which the variable runs: that with the smaller y.
        let end = |z: f64| {
            let local = self.medium.at(piece.layer, z);
            (
                ray.excess(z, local.refractivity).max(0.0),
                1.0 + local.refractivity + (self.medium.earth_radius_m + z) * local.slope,
            )
        };
        effort.evaluations += 2;
        let (mut base, mut slow) = (to, end(to));
        if turns {
            slow.0 = 0.0;
        } else {
            let here = end(from);
            if here.0 <= slow.0 {
                (base, slow) = (from, here);
            }
        }
        let length = (to - from).abs();
        let sign = if base == to { (from - to).signum() } else { (to - from).signum() };
        let delta = slow.0 / slow.1.abs();
        let bent = delta < 100.0 * length;
        let root = if bent { delta.sqrt() } else { 0.0 };
        let most = if bent { length / (root + (delta + length).sqrt()) } else { length };

        let mut evaluations = 0;
        let mut integrand = |v: f64| {
            evaluations += 1;
            let (distance, stretch) = if bent { (v * (2.0 * root + v), 2.0 * (root + v)) } else { (v, 1.0) };
            let z = base + sign * distance;
            let local = self.medium.at(piece.layer, z);
            let rise = 1.0 + local.refractivity + (self.medium.earth_radius_m + z) * local.slope;
            let y = if distance < NEAR_M {
                slow.0 + 0.5 * (slow.1.abs() + rise.abs()) * distance
            } else {
                ray.excess(z, local.refractivity)
            };
            self.integrand(ray, &local, z, y, stretch)
        };

        // Halve panels until each is good enough.
        let points = if length < EVEN_M { Points::Seven } else { Points::Fifteen };
        let enough = self.tolerance / 16.0;
        let mut waiting = vec![(0.0, most, points)];
        let (mut sums, mut error, mut panels) = ([0.0; SUMS], 0.0, 0);
        while let Some((low, high, points)) = waiting.pop() {
            let (value, wrong) = panel(points, low, high, &mut integrand);
            panels += 1;
            let good = wrong[0] <= enough && wrong[1] <= value[1].abs() * (self.tolerance / 0.01).max(1e-13);
            if good || panels > MOST_PANELS || high - low < FINEST * most {
                for (sum, more) in sums.iter_mut().zip(value) {
                    *sum += more;
                }
                error += wrong[0];
            } else if points == Points::Seven {
                waiting.push((low, high, Points::Fifteen));
            } else {
                let middle = 0.5 * (low + high);
                waiting.extend([(low, middle, points), (middle, high, points)]);
            }
        }
        effort.steps += panels;
        effort.evaluations += evaluations;
        for (sum, more) in leg.sums.iter_mut().zip(sums) {
            *sum += more;
        }
        leg.error += error + f64::EPSILON * sums[0].abs() * 8.0;
        leg.crossings.push(Crossing {
            low_m: from.min(to),
            high_m: from.max(to),
            path_m: sums[1],
            refraction: Angle::radians(sums[0]),
            depths: Depths { rayleigh: sums[2], aerosol: sums[3], ozone: sums[4] },
        });
    }

    /// Refraction, length and depths for each unit of the variable.
    #[inline]
    fn integrand(&self, ray: &Invariant, local: &Local, z: f64, y: f64, stretch: f64) -> [f64; SUMS] {
        let n = 1.0 + local.refractivity;
        // Rounding can leave a y of nothing at a turning point; there the stretch is nothing as well.
        let y = y.max(1e-14);
        let per_root = stretch / (y * (y + 2.0 * ray.p)).sqrt();
        let length = n * (self.medium.earth_radius_m + z) * per_root;
        let depths = self.medium.extinctions(local, z);
        [
            -local.slope / n * ray.p * per_root,
            length,
            depths.rayleigh * length,
            depths.aerosol * length,
            depths.ozone * length,
        ]
    }
}
