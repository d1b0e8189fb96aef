//! From cd/m2 at the eyepiece to LED current, pixel gain and filter. Pure.
//!
//! ```text
//! L = S(code) x g x T
//! S(code)   full white at the eyepiece without a filter in the tray, measured
//! g <= 1    what the pixels take away: only what the LEDs cannot, and the step between two codes
//! T         the filter in the tray
//! ```
//!
//! The thesis' module holds 500:1 from 1.8 down to 0.3 cd/m2 and less below (section 8.5). So a filter is preferred to
//! dimming: the best filter is the densest behind which the module still reaches what is asked.

use serde::Serialize;

use super::calibration::{BRIGHTEST_CD_M2, Calibration, DIMMEST_CD_M2, Filter};
use super::controller::Drive;

/// The module's contrast where it is best (thesis, section 8.5).
pub const CONTRAST: f64 = 500.0;
/// Down to this luminance of the module, before any filter in the tray, the contrast holds (cd/m2).
pub const CONTRAST_HOLDS_CD_M2: f64 = 0.3;
/// What is asked may be missed by this share where the measured steps end under the ceiling.
pub const TOLERANCE: f64 = 0.02;
/// Sums of tenths are allowed to be what they look like.
const ROUNDING: f64 = 1e-9;

/// Where black and contrast come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// Measured, in the calibration.
    Measured,
    /// Not measured with this module: the thesis' figures.
    Thesis,
}

/// How a luminance is made.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What was asked at the eyepiece, cd/m2.
    pub asked_cd_m2: f64,
    /// What a full white picture will have, cd/m2.
    pub predicted_cd_m2: f64,
    /// The LEDs.
    pub drive: Drive,
    /// What every pixel is multiplied with, in linear light, 0 to 1.
    pub pixel_gain: f64,
    /// The module's own luminance, before the filter in the tray, cd/m2.
    pub module_cd_m2: f64,
    /// The filter that is in the tray.
    pub fitted: Option<Filter>,
    /// A filter that would serve better, since the module would be dimmed less.
    pub insert: Option<Filter>,
    /// A black pixel at the eyepiece while the LEDs are on, cd/m2.
    pub black_cd_m2: f64,
    /// White to black.
    pub contrast: f64,
    /// Where black and contrast come from.
    pub source: Source,
}

/// Why a luminance cannot be given. The LEDs stay as they are.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// Outside of what such a projector does.
    #[error("{asked} cd/m2 cannot be asked: give {least} to {most} cd/m2{advice}")]
    OutOfRange {
        /// What was asked.
        asked: f64,
        /// The least that may be asked.
        least: f64,
        /// The most.
        most: f64,
        /// What to do.
        advice: String,
    },
    /// Above what the owner allows.
    #[error("{asked} cd/m2 is above the ceiling of {ceiling} cd/m2: ask for less, or raise ceiling_cd_m2")]
    AboveCeiling {
        /// What was asked.
        asked: f64,
        /// The ceiling.
        ceiling: f64,
    },
    /// The measured steps do not reach it.
    #[error(
        "{asked} cd/m2 is brighter than the brightest measured step under the ceiling, {brightest:.4} cd/m2{}",
        out(fitted)
    )]
    TooBright {
        /// What was asked.
        asked: f64,
        /// The brightest step, behind the filter that is in.
        brightest: f64,
        /// The filter that is in.
        fitted: Option<String>,
    },
    /// Even the dimmest measured step is above the ceiling.
    #[error(
        "the dimmest measured step, {dimmest:.4} cd/m2 at the eyepiece, is above the ceiling of {ceiling} cd/m2: insert a denser filter, or fix a denser one"
    )]
    NothingUnderCeiling {
        /// The dimmest step behind the filter that is in.
        dimmest: f64,
        /// The ceiling.
        ceiling: f64,
    },
}

fn out(fitted: &Option<String>) -> String {
    fitted.as_ref().map_or_else(
        || ": measure a step nearer to the ceiling".into(),
        |name| format!(" with the filter {name} in the tray: take it out"),
    )
}

/// Plans a luminance at the eyepiece, cd/m2, with a filter (or none) in the tray.
///
/// Asked may be 0.03 to 1.8 cd/m2; behind a filter the lower end sinks by its transmission, which is what the filter is for.
///
/// # Errors
/// It is outside of that range, above the ceiling, or beyond the measured steps.
pub fn plan(asked_cd_m2: f64, calibration: &Calibration, fitted: Option<&Filter>) -> Result<Plan, PlanError> {
    let transmission = fitted.map_or(1.0, |filter| filter.transmission);
    let least = DIMMEST_CD_M2 * transmission;
    if !(asked_cd_m2 >= least * (1.0 - ROUNDING) && asked_cd_m2 <= BRIGHTEST_CD_M2 * (1.0 + ROUNDING)) {
        let advice = dimmer_by_filter(asked_cd_m2, calibration);
        return Err(PlanError::OutOfRange { asked: asked_cd_m2, least, most: BRIGHTEST_CD_M2, advice });
    }
    dimmed(asked_cd_m2, calibration, fitted)
}

/// As [`plan`], but as dim as one likes: what the LEDs cannot do, the pixels do.
///
/// # Errors
/// Above the ceiling, or beyond the measured steps.
pub fn dimmed(asked_cd_m2: f64, calibration: &Calibration, fitted: Option<&Filter>) -> Result<Plan, PlanError> {
    let ceiling = calibration.sheet().ceiling_cd_m2;
    if asked_cd_m2.is_nan() || asked_cd_m2 > ceiling * (1.0 + ROUNDING) {
        return Err(PlanError::AboveCeiling { asked: asked_cd_m2, ceiling });
    }
    let transmission = fitted.map_or(1.0, |filter| filter.transmission);
    let curve = calibration.curve();
    // Beyond the brightest step that was measured under the ceiling nothing is driven: whatever the lamp does between two
    // steps, a full white pixel stays under the ceiling.
    let Some(top) = curve.brightest_under(ceiling / transmission * (1.0 + ROUNDING)) else {
        let dimmest = curve.dimmest().map_or(0.0, |step| step.white * transmission);
        return Err(PlanError::NothingUnderCeiling { dimmest, ceiling });
    };
    let module = asked_cd_m2.max(0.0) / transmission;
    if module > top.white * (1.0 + TOLERANCE) {
        let fitted = fitted.map(|filter| filter.name.clone());
        return Err(PlanError::TooBright { asked: asked_cd_m2, brightest: top.white * transmission, fitted });
    }
    let step = curve.at_least(module.min(top.white)).unwrap_or(top);
    let gain = (module / step.white).min(1.0);
    let (black, source) = match step.black {
        Some(black) => (black, Source::Measured),
        None => (step.white.max(CONTRAST_HOLDS_CD_M2) / CONTRAST, Source::Thesis),
    };
    Ok(Plan {
        asked_cd_m2,
        predicted_cd_m2: step.white * gain * transmission,
        drive: Drive { leds: calibration.sheet().leds, codes: calibration.codes(step.code) },
        pixel_gain: gain,
        module_cd_m2: step.white * gain,
        fitted: fitted.cloned(),
        insert: better(asked_cd_m2, calibration, transmission).cloned(),
        black_cd_m2: black * transmission,
        contrast: if black > 0.0 { step.white * gain / black } else { f64::INFINITY },
        source,
    })
}

/// The densest filter behind which the module reaches what is asked, if it is denser than what is in the tray.
fn better(asked_cd_m2: f64, calibration: &Calibration, fitted: f64) -> Option<&Filter> {
    let ceiling = calibration.sheet().ceiling_cd_m2;
    let reaches = |filter: &&Filter| {
        let module = asked_cd_m2 / filter.transmission;
        let most = BRIGHTEST_CD_M2.min(ceiling / filter.transmission) * (1.0 + ROUNDING);
        calibration.curve().brightest_under(most).is_some_and(|top| module <= top.white)
    };
    let denser = calibration.sheet().filters.iter().filter(|filter| filter.transmission < fitted).filter(reaches);
    denser.min_by(|a, b| a.transmission.total_cmp(&b.transmission))
}

/// For something too dim: the least dense filter that makes it possible to ask.
fn dimmer_by_filter(asked_cd_m2: f64, calibration: &Calibration) -> String {
    let possible = |filter: &&Filter| asked_cd_m2 > 0.0 && asked_cd_m2 >= DIMMEST_CD_M2 * filter.transmission;
    let filters = calibration.sheet().filters.iter().filter(|_| asked_cd_m2 < DIMMEST_CD_M2).filter(possible);
    filters.max_by(|a, b| a.transmission.total_cmp(&b.transmission)).map_or_else(String::new, |filter| {
        format!(
            "; with the filter {name} in the tray it can be: insert it and add --filter '{name}'",
            name = filter.name
        )
    })
}

impl Plan {
    /// What to tell the observer about filter and contrast.
    #[must_use]
    pub fn advice(&self) -> Option<String> {
        let insert = self.insert.as_ref()?;
        Some(format!(
            "insert the filter {}{}: the module then runs at {:.2} cd/m2 instead of {:.2}{}",
            insert.name,
            self.fitted.as_ref().map(|fitted| format!(" in place of {}", fitted.name)).unwrap_or_default(),
            self.asked_cd_m2 / insert.transmission,
            self.module_cd_m2,
            if self.keeps_contrast() { "" } else { ", and its contrast holds" },
        ))
    }

    /// Whether the module runs where its contrast holds. The part of a step between two codes that the pixels take away is
    /// not held against it.
    #[must_use]
    pub fn keeps_contrast(&self) -> bool {
        self.contrast >= 0.9 * CONTRAST
    }
}

#[cfg(test)]
mod tests;
