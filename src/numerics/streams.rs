//! Random numbers that are the same for one seed on every machine and in every version.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A stream of random numbers. PCG is chosen over the library's standard generator because its algorithm never changes.
#[derive(Debug, Clone)]
pub struct Stream(Pcg64Mcg);

impl Stream {
    /// The stream of a seed.
    #[must_use]
    pub fn seeded(seed: u64) -> Stream {
        Stream(Pcg64Mcg::seed_from_u64(seed))
    }

    /// Uniform in 0 (included) to 1 (excluded), all 53 bits.
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// True with a probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// A byte.
    pub fn byte(&mut self) -> u8 {
        (self.0.next_u64() >> 56) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_seed_gives_one_sequence_and_it_is_uniform() {
        let draw = |seed| {
            let mut stream = Stream::seeded(seed);
            (0..10_000).map(|_| stream.uniform()).collect::<Vec<_>>()
        };
        let numbers = draw(7);
        assert_eq!(numbers, draw(7));
        assert_ne!(numbers, draw(8));
        assert!(numbers.iter().all(|u| (0.0..1.0).contains(u)));
        assert!((numbers.iter().sum::<f64>() / 1e4 - 0.5).abs() < 0.01);
    }
}
