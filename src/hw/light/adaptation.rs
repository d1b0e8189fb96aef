//! What the light costs eyes that are adapted to the dark, while it is on.

/// Scotopic over photopic luminance of white light (CIE D65, 1700 V' / 683 V).
const WHITE: f64 = 2.46;
/// The same of a red LED at 625 nm; at 635 nm it is 0.030, at 617 nm 0.065.
const RED: f64 = 0.045;

/// By how much fainter a thing the rods can just see beside light of this luminance (cd/m2), in magnitudes, compared with the
/// dark. Red alone is taken for 625 nm, every other mixture for white.
///
/// ```text
/// lg T = -2.86                              lg L <= -3.94
///        (0.405 lg L + 1.6)^2.18 - 2.86     between
///        lg L - 0.395                       lg L >= -1.44        L scotopic, cd/m2
/// ```
///
/// Ferwerda, Pattanaik, Shirley and Greenberg (1996), Proc. SIGGRAPH, 249, the rods' thresholds. For a field that is lit
/// throughout; words and stars light a small part of it.
#[must_use]
pub fn rods_lose_mag(cd_m2: f64, leds: u8) -> f64 {
    let scotopic = cd_m2 * if leds == 1 { RED } else { WHITE };
    let lg = scotopic.max(1e-9).log10();
    let above_dark = if lg <= -3.94 {
        0.0
    } else if lg >= -1.44 {
        lg - 0.395 + 2.86
    } else {
        (0.405 * lg + 1.6).powf(2.18)
    };
    2.5 * above_dark
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tenth_of_a_candela_of_white_costs_1_86_dex_and_of_red_little() {
        // Computed from the paper's formula by somebody else's program: white 0.001 0.27 dex, 0.01 0.89, 0.1 1.86.
        for (cd_m2, dex) in [(1e-3, 0.27), (0.01, 0.89), (0.1, 1.86)] {
            assert!((rods_lose_mag(cd_m2, 7) / 2.5 - dex).abs() < 0.01, "{cd_m2}: {}", rods_lose_mag(cd_m2, 7));
        }
        assert!(rods_lose_mag(0.03, 1) / 2.5 < 0.2);
        assert_eq!(rods_lose_mag(0.0, 7), 0.0);
    }
}
