//! The colour of a star from its B-V, and of everything in the red palette.

use glam::Vec3A;

use super::style::Palette;

/// Linear sRGB of a star, its brightest channel 1.
///
/// ```text
/// T = 4600 K (1 / (0.92 (B-V) + 1.7) + 1 / (0.92 (B-V) + 0.62))
/// ```
///
/// Ballesteros (2012), EPL 97, 34008, eq. 14, for B-V from -0.4 to 2; outside, the nearest end. The colour is that of a black
/// body of temperature T, by [`black_body`]. A star of unknown colour is taken as white (0.3).
#[must_use]
pub fn of_star(bv: Option<f32>) -> [f32; 3] {
    let bv = bv.filter(|bv| bv.is_finite()).unwrap_or(0.3).clamp(-0.4, 2.0);
    black_body(4600.0 * (1.0 / (0.92 * bv + 1.7) + 1.0 / (0.92 * bv + 0.62)))
}

/// Linear sRGB of a black body, its brightest channel 1.
///
/// Chromaticity by the cubic splines of Kim et al. (2002), US patent 7024034, for 1667 to 25000 K; outside, the nearest end.
/// XYZ to linear RGB by IEC 61966-2-1. Checked: 6500 K is white to 6 % in each channel.
#[must_use]
pub fn black_body(kelvin: f32) -> [f32; 3] {
    let t = kelvin.clamp(1667.0, 25_000.0);
    let (t1, t2, t3) = (1e3 / t, 1e6 / (t * t), 1e9 / (t * t * t));
    let x = if t < 4000.0 {
        -0.266_123_9 * t3 - 0.234_358_9 * t2 + 0.877_695_6 * t1 + 0.179_910
    } else {
        -3.025_847 * t3 + 2.107_037_9 * t2 + 0.222_634_7 * t1 + 0.240_390
    };
    let (x2, x3) = (x * x, x * x * x);
    let y = if t < 2222.0 {
        -1.106_381_4 * x3 - 1.348_110_2 * x2 + 2.185_558_3 * x - 0.202_196_83
    } else if t < 4000.0 {
        -0.954_947_6 * x3 - 1.374_185_9 * x2 + 2.091_37 * x - 0.167_488_67
    } else {
        3.081_758 * x3 - 5.873_387 * x2 + 3.751_13 * x - 0.370_014_83
    };
    let (big_x, big_z) = (x / y, (1.0 - x - y) / y);
    let rgb = [
        3.2406 * big_x - 1.5372 - 0.4986 * big_z,
        -0.9689 * big_x + 1.8758 + 0.0415 * big_z,
        0.0557 * big_x - 0.2040 + 1.0570 * big_z,
    ];
    let brightest = rgb.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    rgb.map(|channel| (channel / brightest).max(0.0))
}

/// The weights of linear sRGB's channels in its luminance: IEC 61966-2-1.
pub const LUMINANCE: Vec3A = Vec3A::new(0.2126, 0.7152, 0.0722);

/// Light in the palette: as it is, or all of its luminance in red, so that white keeps its drive.
#[must_use]
#[inline]
pub fn in_palette(palette: Palette, light: Vec3A) -> Vec3A {
    match palette {
        Palette::Natural => light,
        Palette::Red => Vec3A::new(light.dot(LUMINANCE), 0.0, 0.0),
    }
}

/// Light made brighter by `gain` without losing what is bright: slope `gain` in the dark, and full light stays full light.
///
/// ```text
/// g v / (1 + (g - 1) v)        g > 1;        g v        g <= 1
/// ```
#[must_use]
#[inline]
pub fn lifted(light: Vec3A, gain: f32) -> Vec3A {
    let light = light.max(Vec3A::ZERO).min(Vec3A::ONE);
    // Most photographs are not lifted, and a division for each of their pixels is dear.
    if gain > 1.0 { light * gain / (Vec3A::ONE + light * (gain - 1.0)) } else { light * gain }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lifting_brightens_the_dark_and_keeps_the_bright_apart() {
        let lifted = |light: f32, gain| lifted(Vec3A::splat(light), gain).y;
        assert!((lifted(0.001, 5.0) - 0.005).abs() < 1e-4 && (lifted(1.0, 5.0) - 1.0).abs() < 1e-6);
        assert!(lifted(0.9, 5.0) > lifted(0.8, 5.0) + 0.02 && (lifted(0.5, 0.5) - 0.25).abs() < 1e-6);
        assert_eq!((lifted(f32::NAN, 5.0), lifted(-1.0, 0.5)), (0.0, 0.0));
    }

    #[test]
    fn daylight_is_nearly_white_and_hot_stars_are_bluer_than_cool_ones() {
        assert!(black_body(6500.0).iter().all(|channel| (channel - 1.0).abs() < 0.06), "{:?}", black_body(6500.0));
        let (rigel, betelgeuse) = (of_star(Some(-0.03)), of_star(Some(1.85)));
        assert!(rigel[2] == 1.0 && rigel[0] < 0.8, "{rigel:?}");
        assert!(betelgeuse[0] == 1.0 && betelgeuse[2] < 0.25, "{betelgeuse:?}");
        assert_eq!(of_star(Some(f32::NAN)), of_star(None));
    }

    #[test]
    fn the_red_palette_has_no_green_and_no_blue() {
        let [red, green, blue] = in_palette(Palette::Red, Vec3A::new(0.2, 0.9, 0.4)).to_array();
        assert!(red > 0.0 && green == 0.0 && blue == 0.0);
    }
}
