//! Tumblin, Hodgins and Guenter's revision of 1999, which holds in the dark.

/// Exponent for an eye adapted to a luminance in cd/m2.
///
/// ```text
/// gamma = 1.855 + 0.4 lg(L + 2.3e-5), 2.655 above 100 cd/m2
/// ```
pub(super) fn gamma(adaptation_cd_m2: f64) -> f64 {
    if adaptation_cd_m2 > 100.0 { 2.655 } else { 1.855 + 0.4 * (adaptation_cd_m2 + 2.3e-5).log10() }
}

/// The luminance to display.
///
/// ```text
/// L_d = L_da sqrt(C)^(gamma_wd - 1) (L / L_wa)^(gamma_w / gamma_d),  gamma_wd = gamma_w / (1.855 + 0.4 lg L_da)
/// ```
///
/// Tumblin, Hodgins and Guenter (1999), ACM TOG 18(1), 56; C is the display's contrast. The second gamma has no constant
/// 2.3e-5 and is 0 at that luminance: hand in no adaptation under 1e-4.
pub(super) fn display(world_cd_m2: f64, display_cd_m2: f64, contrast: f64, luminance_cd_m2: f64) -> f64 {
    let world = gamma(world_cd_m2);
    let middle = world / (1.855 + 0.4 * display_cd_m2.log10()).min(2.655);
    let gained = contrast.max(1.0).sqrt().powf(middle - 1.0);
    display_cd_m2 * gained * (luminance_cd_m2 / world_cd_m2).powf(world / gamma(display_cd_m2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponents_are_those_of_the_table() {
        let text = include_str!("../../../fixtures/reference/eye/tumblin_rushmeier_check.csv");
        for row in text.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let n = |i: usize| cells[i].parse::<f64>().unwrap();
            assert!((gamma(n(0)) - n(9)).abs() < 6e-6 && (gamma(n(1)) - n(10)).abs() < 6e-6, "{row}");
        }
        assert_eq!(gamma(1e4), 2.655);
    }

    #[test]
    fn a_bright_room_shown_on_a_dim_display_gains_the_contrast_that_the_eye_loses() {
        // By hand: L_wa 100, L_da 0.03, C 60: gamma_w 2.655, 1.855 + 0.4 lg 0.03 = 1.24585.
        let shown = display(100.0, 0.03, 60.0, 100.0);
        let by_hand = 0.03 * 60f64.sqrt().powf(2.655 / 1.245_849 - 1.0);
        assert!((shown / by_hand - 1.0).abs() < 1e-5, "{shown} {by_hand}");
    }
}
