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

    /// The stream of one part of a seed's work: parts may be done in any order, on any number of threads, with the same result.
    #[must_use]
    pub fn part(seed: u64, part: u64) -> Stream {
        // The finaliser of SplitMix64 (Steele, Lea & Flood 2014), so that neighbouring seeds and parts share nothing.
        let mut mixed = seed.wrapping_add((part.wrapping_add(1)).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        for (shift, factor) in [(30, 0xbf58_476d_1ce4_e5b9), (27, 0x94d0_49bb_1331_11eb)] {
            mixed = (mixed ^ (mixed >> shift)).wrapping_mul(factor);
        }
        Stream::seeded(mixed ^ (mixed >> 31))
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

    #[test]
    fn the_parts_of_neighbouring_seeds_share_no_number() {
        let parts = (0..40).flat_map(|seed| (0..40).map(move |part| Stream::part(seed, part).uniform().to_bits()));
        let mut first: Vec<u64> = parts.collect();
        first.sort_unstable();
        first.dedup();
        assert_eq!(first.len(), 1600);
        let mean = first.iter().map(|bits| f64::from_bits(*bits)).sum::<f64>() / 1600.0;
        assert!((mean - 0.5).abs() < 4.0 / 12f64.sqrt() / 40.0, "{mean}");
    }
}
