//! One part of the photons: from a star through the dust, counted in every cell that they cross once they have been scattered.

use glam::DVec3;

use super::cells::{Cells, NONE, Segment};
use super::harmonics::Harmonics;
use crate::numerics::streams::Stream;
use crate::physics::dust::phase::HenyeyGreenstein;

/// Bands that one walk carries.
pub(super) const LANES: usize = 4;

/// Behind this optical depth of the clearest band a flight is no longer followed: e^-16 of its light is left.
const BLACK: f64 = 16.0;

/// A walk whose weight falls below this share of its first scattered weight goes on with a chance only, so that all count alike.
const LIGHT: f64 = 0.5;

/// Where photons begin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source {
    pub(super) from: From,
    /// What all photons of the source carry together in each band.
    pub(super) power: [f64; LANES],
}

/// The kind of source.
#[derive(Debug, Clone, Copy)]
pub(super) enum From {
    /// A point, into a cone about an axis; 1 less the cosine of its half angle.
    Point { position: DVec3, axis: DVec3, cap: f64 },
    /// Down the z axis, evenly over the upper face.
    Above,
}

/// What the dust does to the bands of a walk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grains {
    pub(super) extinction: [f64; LANES],
    pub(super) albedo: f64,
    pub(super) phase: HenyeyGreenstein,
}

/// What one part has done.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Done {
    pub(super) photons: u64,
    pub(super) flights: u64,
    pub(super) scatterings: u64,
    /// Weights of all bands together: scattered once, and cut while still on the way.
    pub(super) once: f64,
    pub(super) cut: f64,
    pub(super) most_scatterings: u32,
}

/// One part of the photons, with random numbers and tallies of its own.
pub(super) struct Part<'a> {
    cells: &'a Cells,
    harmonics: &'a Harmonics,
    grains: Grains,
    sources: &'a [Source],
    stream: Stream,
    shift: [f64; 6],
    /// By tally of orders, slot, function and band: weight times length.
    pub(super) tally: Vec<f32>,
    orders: usize,
    longest_walk: u32,
    way: Vec<Segment>,
    /// From the beginning of the way to the box.
    entry: f64,
    pub(super) done: Done,
}

/// Steps of an additive sequence that fills five dimensions evenly: powers of the root of x^6 = x + 1 (Roberts 2018), and of the golden
/// ratio for the choice of the source.
const EVEN: [f64; 6] = [
    0.881_271_361_633_569_6,
    0.776_639_389_089_768_3,
    0.684_430_129_585_342_7,
    0.603_168_740_685_728_3,
    0.531_555_397_715_791_4,
    0.618_033_988_749_894_9,
];

impl<'a> Part<'a> {
    /// A part that has not begun. Its tally keeps `orders` orders of scattering apart, the last of them with all that follow.
    pub(super) fn new(
        cells: &'a Cells,
        harmonics: &'a Harmonics,
        (grains, sources): (Grains, &'a [Source]),
        (orders, longest_walk): (usize, u32),
        seed: u64,
    ) -> Part<'a> {
        let mut stream = Stream::seeded(seed);
        let shift = std::array::from_fn(|_| stream.uniform());
        let tally = vec![0.0; orders * cells.used * harmonics.count() * LANES];
        let done = Done::default();
        Part {
            cells,
            harmonics,
            grains,
            sources,
            stream,
            shift,
            tally,
            orders,
            longest_walk,
            way: Vec::new(),
            entry: 0.0,
            done,
        }
    }

    /// Follows photons until this many more flights are done; the last photon is followed to its end.
    pub(super) fn run(&mut self, flights: u64) {
        let until = self.done.flights + flights;
        while self.done.flights < until {
            self.photon();
        }
    }

    fn photon(&mut self) {
        let number = self.done.photons as f64;
        self.done.photons += 1;
        self.done.flights += 1;
        let even: [f64; 6] = std::array::from_fn(|d| (self.shift[d] + number * EVEN[d]).fract());
        let (source, probability) = self.chosen(even[5]);
        let (mut place, mut direction) = match source.from {
            From::Point { position, axis, cap } => (position, turned(axis, cap * even[0], even[1])),
            From::Above => {
                let over = DVec3::new(even[0] - 0.5, even[1] - 0.5, 0.5) * self.cells.edges;
                (over, -DVec3::Z)
            }
        };
        let mut weights = source.power.map(|power| power / probability);
        let depth = self.follow(place, direction);
        let Some(first) = self.collide(&mut place, direction, &mut weights, depth, even[2]) else { return };
        self.done.once += first;
        let mut chances = (even[3], even[4]);
        let mut scatterings = 1;
        loop {
            direction = turned(direction, 1.0 - self.grains.phase.cosine(chances.0), chances.1);
            self.done.flights += 1;
            self.done.scatterings += 1;
            self.done.most_scatterings = self.done.most_scatterings.max(scatterings);
            let depth = self.follow(place, direction);
            self.count(direction, &weights, (scatterings as usize - 1).min(self.orders - 1));
            let chance = self.stream.uniform();
            let Some(weight) = self.collide(&mut place, direction, &mut weights, depth, chance) else { return };
            if scatterings >= self.longest_walk {
                self.done.cut += weight;
                return;
            }
            let lasting = weight / (LIGHT * first);
            if lasting < 1.0 {
                if self.stream.uniform() >= lasting {
                    return;
                }
                weights = weights.map(|w| w / lasting);
            }
            chances = (self.stream.uniform(), self.stream.uniform());
            scatterings += 1;
        }
    }

    /// A source by a number from 0 to 1, and the probability of this choice: its mean share of the bands' light.
    fn chosen(&self, mut u: f64) -> (&'a Source, f64) {
        let share = |source: &Source| source.power.iter().sum::<f64>();
        let all: f64 = self.sources.iter().map(share).sum();
        for source in self.sources {
            let here = share(source) / all;
            if u < here {
                return (source, here);
            }
            u -= here;
        }
        let last = &self.sources[self.sources.len() - 1];
        (last, share(last) / all)
    }

    /// Lays the way from a place; gives its density-length.
    fn follow(&mut self, place: DVec3, direction: DVec3) -> f64 {
        let clearest = self.grains.extinction.iter().filter(|k| **k > 0.0).fold(f64::INFINITY, |a, b| a.min(*b));
        let (entry, depth) = self.cells.follow(place, direction, BLACK / clearest, &mut self.way);
        self.entry = entry;
        depth
    }

    /// Moves to the next scattering on the way just followed and weighs what is scattered there; `None` where nothing is.
    ///
    /// No photon escapes: its weight is what would have been scattered. The place is drawn from the mixture of all bands' laws, each with
    /// what it scatters, and each band is weighed against the mixture, so that no weight is ever larger than their sum:
    ///
    /// ```text
    /// S = albedo sum_b w_b (1 - exp(-k_b D)),   w_b' = S w_b k_b exp(-k_b d) / sum_j w_j k_j exp(-k_j d)
    /// ```
    ///
    /// The one-sample balance heuristic of Veach (1997), section 9.2, over wavelengths as in Wilkie et al. (2014).
    fn collide(
        &mut self,
        place: &mut DVec3,
        direction: DVec3,
        weights: &mut [f64; LANES],
        depth: f64,
        chance: f64,
    ) -> Option<f64> {
        let k = self.grains.extinction;
        let scattered: [f64; LANES] = std::array::from_fn(|b| weights[b] * -(-k[b] * depth).exp_m1());
        let all: f64 = scattered.iter().sum();
        let sum = self.grains.albedo * all;
        if sum.is_nan() || sum <= 0.0 {
            return None;
        }
        let (mut band, mut u) = (0, chance * all);
        while band + 1 < LANES && u >= scattered[band] {
            u -= scattered[band];
            band += 1;
        }
        while scattered[band] <= 0.0 && band > 0 {
            band -= 1;
        }
        let u = (u / scattered[band]).clamp(0.0, 1.0);
        let wanted = (-(u * (-k[band] * depth).exp_m1()).ln_1p() / k[band]).clamp(0.0, depth);
        *place = self.cells.inside(*place + direction * self.reach(wanted));
        let law: [f64; LANES] = std::array::from_fn(|b| weights[b] * k[b] * (-k[b] * wanted).exp());
        let mixture: f64 = law.iter().sum();
        if mixture.is_nan() || mixture <= 0.0 {
            return None;
        }
        *weights = law.map(|l| sum * l / mixture);
        Some(sum)
    }

    /// How far from its beginning the way has this density-length behind it.
    fn reach(&self, wanted: f64) -> f64 {
        let mut at = self.entry;
        let mut left = wanted;
        for segment in &self.way {
            let depth = f64::from(segment.depth);
            if left <= depth && depth > 0.0 {
                return at + f64::from(segment.length) * left / depth;
            }
            left -= depth;
            at += f64::from(segment.length);
        }
        at
    }

    /// Counts the way just followed in its cells: the mean light of each part of it, times its length, times each function.
    fn count(&mut self, direction: DVec3, weights: &[f64; LANES], order: usize) {
        let per_slot = self.harmonics.count() * LANES;
        let functions = self.harmonics.at(direction).map(|y| y as f32);
        let tally = &mut self.tally[order * self.cells.used * per_slot..][..self.cells.used * per_slot];
        let mut add = |slot: u32, here: [f32; LANES]| {
            if slot != NONE {
                let sums = &mut tally[slot as usize * per_slot..][..per_slot];
                for (sums, function) in sums.chunks_exact_mut(LANES).zip(&functions) {
                    for b in 0..LANES {
                        sums[b] += here[b] * function;
                    }
                }
            }
        };
        let k = self.grains.extinction.map(|k| k as f32);
        let mut light = weights.map(|w| w as f32);
        let (mut slot, mut here) = (NONE, [0.0_f32; LANES]);
        for segment in &self.way {
            if segment.slot != slot {
                add(slot, here);
                (slot, here) = (segment.slot, [0.0; LANES]);
            }
            for b in 0..LANES {
                let depth = k[b] * segment.depth;
                let left = faded(depth);
                let mean = if depth < 1e-3 { 1.0 - 0.5 * depth } else { (1.0 - left) / depth };
                here[b] += light[b] * mean * segment.length;
                light[b] *= left;
            }
        }
        add(slot, here);
    }
}

/// e^-x for x of 0 or more, to 3e-7; below e^-80 that. Four of them are one vector operation, which the library's function is not.
fn faded(x: f32) -> f32 {
    // Adding 1.5 2^23 leaves the nearest whole number in the last bits.
    const ROUND: f32 = 12_582_912.0;
    let y = x.min(80.0) * -std::f32::consts::LOG2_E;
    let shifted = y + ROUND;
    let r = (y - (shifted - ROUND)) * std::f32::consts::LN_2;
    let series = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
    series * f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23))
}

/// A direction turned by an angle whose cosine is 1 less this, about itself by a share of a full turn.
fn turned(direction: DVec3, less: f64, share: f64) -> DVec3 {
    let (a, b) = direction.any_orthonormal_pair();
    let (sine_turn, cosine_turn) = (std::f64::consts::TAU * share).sin_cos();
    let sine = (less * (2.0 - less)).max(0.0).sqrt();
    ((a * cosine_turn + b * sine_turn) * sine + direction * (1.0 - less)).normalize()
}
