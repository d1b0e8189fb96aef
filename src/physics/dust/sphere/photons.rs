//! Many photons through a sphere, counted, with the standard error of each count.

use rayon::prelude::*;

use super::walk::{Fate, Rules, follow};
use super::{Sphere, SphereError};
use crate::numerics::streams::Stream;

/// Photons that share a random stream.
const BATCH: u64 = 64;
/// Batches of the first round, and of the longest. Between rounds the limit of work is looked at.
const ROUNDS: (u64, u64) = (16, 32_768);

/// A mean and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub value: f64,
    /// One standard deviation of the mean.
    pub error: f64,
}

/// How many photons, and how they are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// Photons.
    pub photons: u64,
    /// Seed of the random numbers; the result does not depend on the number of threads.
    pub seed: u64,
    /// How each is followed.
    pub rules: Rules,
    /// Scatterings of all photons together after which no more are begun.
    pub most_events: u64,
}

/// What became of the light. The shares of all light: `unscattered + scattered + absorbed + unfinished` is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Photons that were followed: fewer than ordered where the limit of work was reached.
    pub photons: u64,
    /// Scatterings followed.
    pub events: u64,
    /// Left without meeting a grain.
    pub unscattered: Estimate,
    /// Left after one scattering or more.
    pub scattered: Estimate,
    /// Taken by the dust.
    pub absorbed: Estimate,
    /// Still under way when its photon had scattered as often as is allowed.
    pub unfinished: f64,
    /// How often a photon met a grain before it left or was given up, whatever its weight.
    pub mean_scatterings: Estimate,
    /// Mean cosine of the scattered light against its first direction; nothing where no light was scattered.
    pub mean_cosine: Option<Estimate>,
}

/// Sums over photons.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    photons: f64,
    events: u64,
    events_square: f64,
    passed: f64,
    scattered: [f64; 2],
    absorbed: [f64; 2],
    unfinished: f64,
    /// Of the scattered weight w and its cosine c: w c, w^2 c, w^2 c^2.
    cosine: [f64; 3],
}

impl Sums {
    fn take(&mut self, fate: &Fate) {
        self.photons += 1.0;
        self.events += fate.scatterings;
        self.events_square += (fate.scatterings as f64).powi(2);
        self.absorbed[0] += fate.absorbed;
        self.absorbed[1] += fate.absorbed * fate.absorbed;
        self.unfinished += fate.unfinished;
        if fate.scatterings == 0 {
            self.passed += fate.escaped;
            return;
        }
        let (w, c) = (fate.escaped, fate.cosine);
        self.scattered[0] += w;
        self.scattered[1] += w * w;
        for (sum, term) in self.cosine.iter_mut().zip([w * c, w * w * c, w * w * c * c]) {
            *sum += term;
        }
    }

    fn add(&mut self, other: &Sums) {
        self.photons += other.photons;
        self.events += other.events;
        self.events_square += other.events_square;
        self.passed += other.passed;
        self.unfinished += other.unfinished;
        let pairs = [(&mut self.scattered, &other.scattered), (&mut self.absorbed, &other.absorbed)];
        for (mine, others) in pairs {
            mine.iter_mut().zip(others).for_each(|(a, b)| *a += b);
        }
        self.cosine.iter_mut().zip(other.cosine).for_each(|(a, b)| *a += b);
    }

    /// The mean of a weight between 0 and `most`. Its error is that of the sample with one photon of weight 0 and one of `most` added
    /// (Laplace's rule of succession): where no photon of a million did something, it is not certain that none does.
    fn share(&self, [sum, squares]: [f64; 2], most: f64) -> Estimate {
        let with = self.photons + 2.0;
        let mean = (sum + most) / with;
        let variance = ((squares + most * most) / with - mean * mean).max(0.0);
        Estimate { value: sum / self.photons, error: (variance / self.photons).sqrt() }
    }

    fn shares(&self, albedo: f64) -> Shares {
        let mean = self.events as f64 / self.photons;
        let spread = (self.events_square / self.photons - mean * mean).max(0.0);
        let w = self.scattered[0];
        let mean_cosine = (w > 0.0).then(|| {
            let value = self.cosine[0] / w;
            let square = self.cosine[2] - 2.0 * value * self.cosine[1] + value * value * self.scattered[1];
            // A single photon tells nothing of the spread: its cosine may be anything.
            Estimate { value, error: (square.max(0.0) + self.scattered[1] / self.photons).sqrt() / w }
        });
        Shares {
            photons: self.photons as u64,
            events: self.events,
            unscattered: self.share([self.passed, self.passed], 1.0),
            scattered: self.share(self.scattered, albedo),
            absorbed: self.share(self.absorbed, if albedo < 1.0 { 1.0 } else { 0.0 }),
            unfinished: self.unfinished / self.photons,
            mean_scatterings: Estimate { value: mean, error: ((spread + 1.0 / self.photons) / self.photons).sqrt() },
            mean_cosine,
        }
    }
}

/// Follows photons; `told` hears the share that is done.
///
/// # Errors
/// A threshold that would lose light, or no photons.
pub fn shares(sphere: &Sphere, order: &Order, told: &mut dyn FnMut(f64)) -> Result<Shares, SphereError> {
    if !(order.rules.threshold > 0.0 && order.rules.threshold <= 1e-10) {
        return Err(SphereError::Threshold(order.rules.threshold));
    }
    if order.photons == 0 {
        return Err(SphereError::Photons);
    }
    let batches = order.photons.div_ceil(BATCH);
    let batch = |index: u64| {
        let mut stream = Stream::part(order.seed, index);
        let mut sums = Sums::default();
        for _ in index * BATCH..((index + 1) * BATCH).min(order.photons) {
            sums.take(&follow(sphere, &order.rules, &mut stream));
        }
        sums
    };
    let (mut sums, mut done, mut round) = (Sums::default(), 0, ROUNDS.0);
    while done < batches && sums.events < order.most_events {
        let end = (done + round).min(batches);
        let parts: Vec<Sums> = (done..end).into_par_iter().map(batch).collect();
        // In the order of the batches, so that any number of threads gives the same bits.
        parts.iter().for_each(|part| sums.add(part));
        (done, round) = (end, (round * 2).min(ROUNDS.1));
        told(done as f64 / batches as f64);
    }
    Ok(sums.shares(sphere.albedo))
}
