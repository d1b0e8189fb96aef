//! Where the things that appear are: for each wavelength a curve from apparent altitude to what the ray from there has
//! gathered.
//!
//! Between the altitudes at which rays touch a border of the air the curve is smooth, apart from a square root at the upper
//! end, where rays begin to dip into the next layer. So each such strip is written in
//!
//! ```text
//! v = √((high - a)/(high - low))
//! ```
//!
//! and in v by polynomials of the eighth degree through Chebyshev's points, halved until they are good enough.

/// Curves for all wavelengths of a picture, from few traced ones.
mod curves;
/// Strips refined for several wavelengths at once.
mod strips;

pub(super) use curves::{Curves, curves};
pub(super) use strips::Wanted;

use super::air::{KINDS, Path};
use crate::numerics::roots::bracketed;

/// Chebyshev's points in a panel.
pub(super) const NODES: usize = 9;

/// Intervals of a panel that are looked through for crossings.
const LOOKS: usize = 16;

/// The curve of one wavelength.
#[derive(Debug, Clone, Default)]
pub(super) struct Transfer {
    /// From the highest to the lowest; where none is, no light comes from the sky.
    pub(super) strips: Vec<Strip>,
}

/// A strip between two critical altitudes, radians.
#[derive(Debug, Clone)]
pub(super) struct Strip {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether v is the root, or the share itself.
    pub(super) root: bool,
    /// By rising v, that is, by falling altitude.
    pub(super) panels: Vec<Panel>,
}

/// A stretch of v with the paths at its Chebyshev points.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) nodes: [Path; NODES],
}

/// The place of a Chebyshev point, -1 to 1.
pub(super) fn node(i: usize) -> f64 {
    (std::f64::consts::PI * i as f64 / (NODES - 1) as f64).cos()
}

impl Strip {
    /// Apparent altitude at a v.
    pub(super) fn altitude(&self, v: f64) -> f64 {
        altitude(self.low, self.high, self.root, v)
    }

    /// v at an apparent altitude.
    fn place(&self, altitude: f64) -> f64 {
        let share = ((self.high - altitude) / (self.high - self.low)).clamp(0.0, 1.0);
        if self.root { share.sqrt() } else { share }
    }
}

/// Apparent altitude at a v of a strip.
pub(super) fn altitude(low: f64, high: f64, root: bool, v: f64) -> f64 {
    high - (high - low) * if root { v * v } else { v }
}

impl Panel {
    /// The path at a v: the barycentric formula for Chebyshev's points of the second kind.
    fn at(&self, v: f64) -> Path {
        let x = (2.0 * v - self.from - self.to) / (self.to - self.from);
        let (mut sum, mut weights) = ([0.0; 1 + KINDS], 0.0);
        for (i, path) in self.nodes.iter().enumerate() {
            let distance = x - NODE_PLACES[i];
            if distance == 0.0 {
                return *path;
            }
            let half = if i == 0 || i == NODES - 1 { 0.5 } else { 1.0 };
            let weight = if i % 2 == 0 { half } else { -half } / distance;
            weights += weight;
            for (part, value) in sum.iter_mut().zip(path) {
                *part += weight * value;
            }
        }
        sum.map(|part| part / weights)
    }
}

/// cos(i pi/8).
const NODE_PLACES: [f64; NODES] = [
    1.0,
    0.923_879_532_511_286_7,
    std::f64::consts::FRAC_1_SQRT_2,
    0.382_683_432_365_089_8,
    0.0,
    -0.382_683_432_365_089_8,
    -std::f64::consts::FRAC_1_SQRT_2,
    -0.923_879_532_511_286_7,
    -1.0,
];

impl Transfer {
    /// The path of the ray that appears at an altitude (radians); nothing where no ray escapes.
    pub(super) fn at(&self, altitude: f64) -> Option<Path> {
        let index = self.strips.partition_point(|strip| strip.low > altitude);
        let strip = self.strips.get(index).filter(|strip| altitude <= strip.high)?;
        let v = strip.place(altitude);
        let index = strip.panels.partition_point(|panel| panel.to < v);
        let panel = strip.panels.get(index)?;
        (panel.from <= v).then(|| panel.at(v))
    }

    /// The stretches of apparent altitude (low, high, ascending) whose true altitudes lie between two levels.
    pub(super) fn between(&self, levels: [f64; 2]) -> Vec<[f64; 2]> {
        let mut lit = Vec::new();
        for strip in &self.strips {
            for panel in &strip.panels {
                let v = |i: usize| panel.from + (panel.to - panel.from) * i as f64 / LOOKS as f64;
                let truth = |v: f64| strip.altitude(v) - panel.at(v)[0];
                let looks: [f64; LOOKS + 1] = std::array::from_fn(|i| truth(v(i)));
                // Where the curve crosses a level, by rising v.
                let mut borders = vec![panel.from];
                for i in 0..LOOKS {
                    let mut here: Vec<f64> = levels
                        .iter()
                        .filter(|level| (looks[i] < **level) != (looks[i + 1] < **level))
                        .map(|level| bracketed(v(i), v(i + 1), 1e-14, |v| truth(v) - level))
                        .collect();
                    here.sort_by(f64::total_cmp);
                    borders.extend(here);
                }
                borders.push(panel.to);
                for pair in borders.windows(2).filter(|pair| pair[0] < pair[1]) {
                    let middle = truth(0.5 * (pair[0] + pair[1]));
                    if levels[0] < middle && middle < levels[1] {
                        lit.push([strip.altitude(pair[1]), strip.altitude(pair[0])]);
                    }
                }
            }
        }
        lit.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // Panels of one strip join without a seam.
        let mut joined: Vec<[f64; 2]> = Vec::with_capacity(lit.len());
        for stretch in lit {
            match joined.last_mut() {
                Some(last) if stretch[0] - last[1] < 1e-15 && !self.is_border(stretch[0]) => last[1] = stretch[1],
                _ => joined.push(stretch),
            }
        }
        joined
    }

    /// Whether two strips meet at an altitude.
    fn is_border(&self, altitude: f64) -> bool {
        self.strips.iter().any(|strip| (strip.low - altitude).abs() < 1e-15 || (strip.high - altitude).abs() < 1e-15)
    }
}
