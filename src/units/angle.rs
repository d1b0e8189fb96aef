//! A plane angle: f64 radians inside, because 0.01 arcsecond needs eight digits and f32 has seven.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A plane angle.
///
/// ```
/// use scotopic::units::Angle;
/// assert!((Angle::degrees(180.0).to_hours() - 12.0).abs() < 1e-12);
/// assert!((Angle::arcseconds(3600.0).to_degrees() - 1.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Angle(f64);

impl Angle {
    /// No angle.
    pub const ZERO: Angle = Angle(0.0);

    /// From radians.
    #[must_use]
    pub const fn radians(value: f64) -> Angle {
        Angle(value)
    }

    /// From degrees.
    #[must_use]
    pub const fn degrees(value: f64) -> Angle {
        Angle(value * (PI / 180.0))
    }

    /// From arcminutes.
    #[must_use]
    pub const fn arcminutes(value: f64) -> Angle {
        Angle::degrees(value / 60.0)
    }

    /// From arcseconds.
    #[must_use]
    pub const fn arcseconds(value: f64) -> Angle {
        Angle::degrees(value / 3600.0)
    }

    /// From hours of right ascension: 24 to the turn.
    #[must_use]
    pub const fn hours(value: f64) -> Angle {
        Angle::degrees(value * 15.0)
    }

    /// In radians.
    #[must_use]
    pub const fn to_radians(self) -> f64 {
        self.0
    }

    /// In degrees.
    #[must_use]
    pub const fn to_degrees(self) -> f64 {
        self.0 * (180.0 / PI)
    }

    /// In arcminutes.
    #[must_use]
    pub const fn to_arcminutes(self) -> f64 {
        self.to_degrees() * 60.0
    }

    /// In arcseconds.
    #[must_use]
    pub const fn to_arcseconds(self) -> f64 {
        self.to_degrees() * 3600.0
    }

    /// In hours of right ascension.
    #[must_use]
    pub const fn to_hours(self) -> f64 {
        self.to_degrees() / 15.0
    }

    /// The sine.
    #[must_use]
    pub fn sin(self) -> f64 {
        self.0.sin()
    }

    /// The cosine.
    #[must_use]
    pub fn cos(self) -> f64 {
        self.0.cos()
    }

    /// The tangent.
    #[must_use]
    pub fn tan(self) -> f64 {
        self.0.tan()
    }

    /// Sine and cosine.
    #[must_use]
    pub fn sin_cos(self) -> (f64, f64) {
        self.0.sin_cos()
    }

    /// The angle whose tangent is `y / x`, in the quadrant of (x, y): -pi to pi.
    #[must_use]
    pub fn atan2(y: f64, x: f64) -> Angle {
        Angle(y.atan2(x))
    }

    /// The angle whose sine is `s`, with rounding beyond +-1 held at +-90 degrees.
    #[must_use]
    pub fn asin(s: f64) -> Angle {
        Angle(s.clamp(-1.0, 1.0).asin())
    }

    /// The angle whose cosine is `c`, with rounding beyond +-1 held at 0 and 180 degrees.
    #[must_use]
    pub fn acos(c: f64) -> Angle {
        Angle(c.clamp(-1.0, 1.0).acos())
    }

    /// The same direction in 0 (included) to 360 degrees (excluded).
    #[must_use]
    pub fn wrapped(self) -> Angle {
        let turned = self.0.rem_euclid(TAU);
        Angle(if turned >= TAU { 0.0 } else { turned })
    }

    /// The same direction in -180 (excluded) to 180 degrees (included).
    #[must_use]
    pub fn wrapped_signed(self) -> Angle {
        let turned = self.wrapped().0;
        Angle(if turned > PI { turned - TAU } else { turned })
    }

    /// The angle without its sign.
    #[must_use]
    pub fn abs(self) -> Angle {
        Angle(self.0.abs())
    }

    /// Whether the angle is a finite number.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// The smaller of two angles.
    #[must_use]
    pub fn min(self, other: Angle) -> Angle {
        Angle(self.0.min(other.0))
    }

    /// The larger of two angles.
    #[must_use]
    pub fn max(self, other: Angle) -> Angle {
        Angle(self.0.max(other.0))
    }
}

/// The nearest whole `1/scale` of a unit, split into (whole units, minutes, seconds, parts of a second).
/// Rounding comes first, so that 60 never appears in a place of minutes or seconds.
fn sexagesimal(units: f64, parts_per_second: u64) -> (u64, u64, u64, u64) {
    let parts = (units * 3600.0 * parts_per_second as f64).round() as u64;
    let seconds = parts / parts_per_second;
    (seconds / 3600, seconds / 60 % 60, seconds % 60, parts % parts_per_second)
}

/// Shows an angle as `+41°16′09″`.
pub struct DegreesMinutesSeconds(pub Angle);

impl fmt::Display for DegreesMinutesSeconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (d, m, s, _) = sexagesimal(self.0.to_degrees().abs(), 1);
        let sign = if self.0.to_radians() < 0.0 { '-' } else { '+' };
        write!(f, "{sign}{d:02}°{m:02}′{s:02}″")
    }
}

/// Shows an angle as hours of right ascension: `00h42m44.3s`. Never 24 hours.
pub struct HoursMinutesSeconds(pub Angle);

impl fmt::Display for HoursMinutesSeconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (h, m, s, tenths) = sexagesimal(self.0.wrapped().to_hours(), 10);
        write!(f, "{:02}h{m:02}m{s:02}.{tenths}s", h % 24)
    }
}

impl Add for Angle {
    type Output = Angle;
    fn add(self, other: Angle) -> Angle {
        Angle(self.0 + other.0)
    }
}

impl Sub for Angle {
    type Output = Angle;
    fn sub(self, other: Angle) -> Angle {
        Angle(self.0 - other.0)
    }
}

impl AddAssign for Angle {
    fn add_assign(&mut self, other: Angle) {
        self.0 += other.0;
    }
}

impl SubAssign for Angle {
    fn sub_assign(&mut self, other: Angle) {
        self.0 -= other.0;
    }
}

impl Neg for Angle {
    type Output = Angle;
    fn neg(self) -> Angle {
        Angle(-self.0)
    }
}

impl Mul<f64> for Angle {
    type Output = Angle;
    fn mul(self, factor: f64) -> Angle {
        Angle(self.0 * factor)
    }
}

impl Div<f64> for Angle {
    type Output = Angle;
    fn div(self, divisor: f64) -> Angle {
        Angle(self.0 / divisor)
    }
}

impl Div for Angle {
    type Output = f64;
    fn div(self, other: Angle) -> f64 {
        self.0 / other.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_never_writes_sixty() {
        assert_eq!(HoursMinutesSeconds(Angle::hours(23.999_999_9)).to_string(), "00h00m00.0s");
        assert_eq!(DegreesMinutesSeconds(Angle::degrees(-0.999_999_99)).to_string(), "-01°00′00″");
    }

    #[test]
    fn a_negative_angle_under_one_degree_keeps_its_sign() {
        assert_eq!(DegreesMinutesSeconds(Angle::degrees(-0.5)).to_string(), "-00°30′00″");
    }

    #[test]
    fn wrapping_a_tiny_negative_angle_stays_below_a_turn() {
        assert!(Angle::radians(-1e-18).wrapped().to_radians() < TAU);
    }
}
