//! What one scattering sends into every bin of direction, for every depth of a group.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::nodes::Group;
use super::{Parameters, Spacing, shared};
use crate::numerics::streams::Stream;

/// Above this asymmetry more directions are drawn from the law itself.
const STEEP: f64 = 0.75;
/// So many, each scattering.
const DRAWN_STEEP: usize = 16;
/// Turns between the azimuths of neighbouring bins: the golden ratio's share leaves no two alike.
const TURN: f64 = 0.618_033_988_749_894_9;

/// The bins, as the loop over them reads them.
pub(super) struct Bins {
    low: Vec<f64>,
    width: Vec<f64>,
    solid_angle: Vec<f64>,
    azimuth: Vec<(f64, f64)>,
    spacing: Spacing,
    /// Directions that are drawn from the law at each scattering, the path's own among them.
    pub(super) drawn: usize,
}

impl Bins {
    pub(super) fn new(parameters: &Parameters) -> Bins {
        let edges = parameters.edges();
        Bins {
            low: edges[..parameters.directions].to_vec(),
            width: edges.windows(2).map(|pair| pair[1] - pair[0]).collect(),
            solid_angle: parameters.solid_angles(),
            azimuth: (0..parameters.directions).map(|j| (TAU * TURN * j as f64).sin_cos()).collect(),
            spacing: parameters.spacing,
            drawn: if parameters.phase.asymmetry().abs() > STEEP { DRAWN_STEEP } else { 1 },
        }
    }
}

/// Sums of light over scatterings: for every node of a group, for every bin.
pub(super) struct Peel<'a> {
    parameters: &'a Parameters,
    bins: &'a Bins,
    group: &'a Group,
    /// Between the depths of neighbouring nodes.
    step: f64,
    /// What the path's weight is multiplied by for each node.
    factors: Vec<f64>,
    sums: Vec<f64>,
    light: Vec<f64>,
    fall: Vec<f64>,
}

impl<'a> Peel<'a> {
    pub(super) fn new(parameters: &'a Parameters, bins: &'a Bins, group: &'a Group) -> Peel<'a> {
        let (nodes, count) = (group.depths.len(), parameters.directions);
        Peel {
            parameters,
            bins,
            group,
            step: if nodes > 1 { group.depths[1] - group.depths[0] } else { 0.0 },
            factors: vec![0.0; nodes],
            sums: vec![0.0; nodes * count],
            light: vec![0.0; count],
            fall: vec![0.0; count],
        }
    }

    /// Takes note of a path's scatterings and the length of its flights so far.
    pub(super) fn weigh(&mut self, order: u32, flown: f64) {
        let base = self.group.base;
        for (factor, depth) in self.factors.iter_mut().zip(&self.group.depths) {
            // One exponential of the sum: the two factors by themselves may leave what f64 holds.
            *factor = (f64::from(order) * ((depth - base) / base).ln_1p() - (depth - base) * flown).exp();
        }
    }

    /// What a scattering sends towards one direction in each bin.
    pub(super) fn ring(&mut self, place: DVec3, direction: DVec3, weight: f64, stream: &mut Stream) {
        let (jitter, turn) = (stream.uniform(), stream.uniform());
        let (s0, c0) = (TAU * turn).sin_cos();
        let (g, inside) = (self.parameters.phase.asymmetry(), 1.0 - place.length_squared());
        let (straight, scale) = ((1.0 - g) * (1.0 - g), (1.0 - g * g) / (4.0 * PI));
        let (drawn, thinnest, step) = (self.bins.drawn as f64, self.group.depths[0], self.step);
        let bins = self.bins.low.iter().zip(&self.bins.width).zip(&self.bins.solid_angle).zip(&self.bins.azimuth);
        for ((((low, width), solid), (s, c)), (light, fall)) in bins.zip(self.light.iter_mut().zip(&mut self.fall)) {
            let z = low + jitter * width;
            let across = (1.0 - z * z).max(0.0).sqrt();
            let (x, y) = (across * (c0 * c - s0 * s), across * (s0 * c + c0 * s));
            let cosine = direction.x * x + direction.y * y + direction.z * z;
            let along = place.x * x + place.y * y + place.z * z;
            let way = (along * along + inside).max(0.0).sqrt() - along;
            let bend = straight + 2.0 * g * (1.0 - cosine);
            let into = scale / (bend * bend.sqrt()) * solid;
            *light = weight * into / (1.0 + drawn * into) * exp(-thinnest * way);
            *fall = exp(-step * way);
        }
        let count = self.light.len();
        for (factor, sums) in self.factors.iter().zip(self.sums.chunks_mut(count)) {
            for ((sum, light), fall) in sums.iter_mut().zip(&mut self.light).zip(&self.fall) {
                *sum += factor * *light;
                *light *= fall;
            }
        }
    }

    /// What a scattering sends along a direction that was drawn from the law; gives the way to the surface.
    pub(super) fn along(&mut self, place: DVec3, direction: DVec3, cosine: f64, weight: f64) -> f64 {
        let along = place.dot(direction);
        let way = ((along * along + 1.0 - place.length_squared()).max(0.0).sqrt() - along).max(0.0);
        let count = self.light.len();
        let bin = shared::bin(self.bins.spacing, count, direction.z);
        let into = self.parameters.phase.per_steradian(cosine) * self.bins.solid_angle[bin];
        let light = weight * into / (1.0 + self.bins.drawn as f64 * into);
        for (k, (factor, depth)) in self.factors.iter().zip(&self.group.depths).enumerate() {
            self.sums[k * count + bin] += factor * light * (-depth * way).exp();
        }
        way
    }

    /// The sums, node by node.
    pub(super) fn into_sums(self) -> Vec<f64> {
        self.sums
    }
}

/// e^x for x <= 0, good to 1e-11, in operations that compilers put into lanes; the library's own is a call.
#[inline(always)]
fn exp(x: f64) -> f64 {
    // x = k ln 2 + r; adding and taking away 1.5 * 2^52 rounds to an integer, which then stands in the lowest bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let scaled = x.max(-700.0) * std::f64::consts::LOG2_E + ROUND;
    let k = scaled - ROUND;
    let r = (x.max(-700.0) - k * 0.693_147_180_369_123_8) - k * 1.908_214_929_270_587_7e-10;
    let mut sum = 1.0 / 3_628_800.0;
    for over in [362_880.0, 40_320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0] {
        sum = sum * r + 1.0 / over;
    }
    sum * f64::from_bits((scaled.to_bits() << 52).wrapping_add(1f64.to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_the_librarys() {
        for i in 0..200_000 {
            let x = -f64::from(i) * 0.0034;
            assert!((exp(x) / x.exp() - 1.0).abs() < 1e-11, "{x}");
        }
        assert_eq!(exp(0.0), 1.0);
        assert!(exp(-1e9) < 1e-300);
    }
}
