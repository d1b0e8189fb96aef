//! Hashes by which things that are kept are named and known again; no secrets.

/// The hash of Fowler, Noll and Vo (1a, 64 bits).
#[must_use]
pub fn fnv(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A hash with one number more: the finish of Steele, Lea and Flood (2014), SplitMix, over both. For long lists of numbers.
#[must_use]
#[inline]
pub fn mixed(hash: u64, number: u64) -> u64 {
    let z = (hash ^ number).wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fowler_noll_and_vos() {
        // Their own list of test vectors, FNV-1a 64.
        let known =
            [(&b""[..], 0xcbf2_9ce4_8422_2325), (b"a", 0xaf63_dc4c_8601_ec8c), (b"foobar", 0x8594_4171_f739_67e8)];
        assert!(known.iter().all(|(bytes, hash)| fnv(bytes) == *hash));
    }

    #[test]
    fn a_number_is_mixed_as_split_mix_does() {
        // java.util.SplittableRandom, seed 0: its first number is the finish of 0x9E3779B97F4A7C15.
        assert_eq!(mixed(0, 0), 0xE220_A839_7B1D_CDAF);
        assert_ne!(mixed(mixed(0, 1), 2), mixed(mixed(0, 2), 1));
    }
}
