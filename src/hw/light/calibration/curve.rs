//! The curve through the measured steps: which code gives a luminance. Nothing is believed outside of what was measured.

use super::Row;

/// A measured step at the eyepiece, without a filter in the tray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::hw::light) struct Step {
    /// The LED current code.
    pub(in crate::hw::light) code: u16,
    /// Full white, cd/m2.
    pub(in crate::hw::light) white: f64,
    /// Full black with the LEDs on, cd/m2, if somebody measured it.
    pub(in crate::hw::light) black: Option<f64>,
}

/// Steps by rising luminance.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::hw::light) struct Curve(Vec<Step>);

impl Curve {
    /// From checked rows; `factor` takes the meter's reading to the eyepiece.
    pub(super) fn new(rows: &[Row], factor: f64, inverted: bool) -> Curve {
        let mut steps: Vec<Step> = rows
            .iter()
            .map(|row| Step { code: row.code, white: row.cd_m2 * factor, black: row.black_cd_m2.map(|b| b * factor) })
            .collect();
        if inverted {
            steps.reverse();
        }
        Curve(steps)
    }

    /// The brightest measured step that is not brighter than this.
    pub(in crate::hw::light) fn brightest_under(&self, cd_m2: f64) -> Option<Step> {
        self.0.iter().rev().find(|step| step.white <= cd_m2).copied()
    }

    /// The dimmest measured step.
    pub(in crate::hw::light) fn dimmest(&self) -> Option<Step> {
        self.0.first().copied()
    }

    /// Full white at a code, cd/m2, by a straight line between the measured steps.
    pub(in crate::hw::light) fn at(&self, code: u16) -> Option<f64> {
        self.0.windows(2).find_map(|pair| {
            let (from, to) = (f64::from(pair[0].code), f64::from(pair[1].code));
            let share = (f64::from(code) - from) / (to - from);
            (0.0..=1.0).contains(&share).then(|| pair[0].white + share * (pair[1].white - pair[0].white))
        })
    }

    /// The dimmest code that gives at least this, between the measured steps by a straight line; at most the brightest step.
    pub(in crate::hw::light) fn at_least(&self, cd_m2: f64) -> Option<Step> {
        let above = self.0.iter().position(|step| step.white >= cd_m2);
        let Some(above) = above else { return self.0.last().copied() };
        let Some(low) = above.checked_sub(1).map(|i| self.0[i]) else { return self.dimmest() };
        let high = self.0[above];
        let span = f64::from(high.code) - f64::from(low.code);
        let share = (cd_m2 - low.white) / (high.white - low.white);
        // Rounded towards the brighter step: the pixels then take the rest away. The small amount spares a code that is
        // exact but for the last digit.
        let steps = (share * span.abs() - 1e-9).ceil().clamp(0.0, span.abs());
        let code = f64::from(low.code) + steps * span.signum();
        let share = steps / span.abs();
        let between = |low: f64, high: f64| low + share * (high - low);
        let black = low.black.zip(high.black).map(|(low, high)| between(low, high));
        Some(Step { code: code as u16, white: between(low.white, high.white), black })
    }
}
