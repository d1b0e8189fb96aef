//! `scotopic eye limit`: the faintest star at an eyepiece.

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::instrument::Given;
use crate::cli::settings::Settings;
use crate::cli::{Failure, answer, answer_json};
use crate::eye::crumey::{DARKEST_CD_M2, ONE_EYE, TYPICAL_OBSERVER};
use crate::eye::{limit, schaefer};

/// The settings of `eye limit`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic eye limit --eyepiece 24 --sky 21.5\n  \
    scotopic eye limit --aperture-mm 100 --magnification 78.125 --sky 20 --json\n\n\
    Crumey (2014); `--model schaefer` is a second opinion, which has no observer's factor. Above the power at which the sky at the eye falls under 25.08 mag per square arcsecond nothing more is won.")]
pub struct Arguments {
    /// Instrument, eye and sky.
    #[command(flatten)]
    pub given: Given,
    /// Crumey's F of this observer: 1 in the laboratory, 1.4 good, 2 typical, 2.4 poor; sqrt 2 for one eye comes on top
    #[arg(long, value_name = "FACTOR", default_value_t = TYPICAL_OBSERVER, allow_hyphen_values = true)]
    pub field_factor: f64,
    /// Whose threshold: crumey (2014) or schaefer (1990)
    #[arg(long, value_enum, value_name = "MODEL", default_value_t = LimitModel::Crumey)]
    pub model: LimitModel,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// Whose threshold for stars.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitModel {
    /// Crumey (2014).
    Crumey,
    /// Schaefer (1990) with Hecht's threshold.
    Schaefer,
}

/// What `eye limit --json` answers.
#[derive(Debug, Serialize)]
struct Answer {
    model: LimitModel,
    v_limit: f64,
    naked_eye_v_limit: f64,
    clamped: bool,
    sky_mag_arcsec2: f64,
    background_at_eye_mag_arcsec2: f64,
    background_at_eye_cd_m2: f64,
    magnification: f64,
    exit_pupil_mm: f64,
}

/// Runs the subcommand.
///
/// # Errors
/// A number out of its range, or an instrument file that cannot be used.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let sky = arguments.given.sky(settings)?;
    let viewing = arguments.given.viewing(settings, arguments.field_factor * ONE_EYE)?;
    let (v_limit, naked_eye) = match arguments.model {
        LimitModel::Crumey => (limit::through_telescope(&viewing, sky), limit::naked_eye(sky, arguments.field_factor)),
        LimitModel::Schaefer => (schaefer::through_telescope(&viewing, sky), schaefer::naked_eye(sky)),
    };
    let answered = Answer {
        model: arguments.model,
        v_limit: v_limit.0,
        naked_eye_v_limit: naked_eye.0,
        clamped: arguments.model == LimitModel::Crumey && viewing.background_cd_m2(sky) < DARKEST_CD_M2,
        sky_mag_arcsec2: sky.0,
        background_at_eye_mag_arcsec2: viewing.background(sky).0,
        background_at_eye_cd_m2: viewing.background_cd_m2(sky),
        magnification: viewing.magnification,
        exit_pupil_mm: viewing.exit_pupil_mm(),
    };
    if arguments.json {
        return answer_json(&answered);
    }
    let edge = if answered.clamped { ": more power shows no fainter star" } else { "" };
    answer(&format!(
        "stars to V {:.2} at {:.0}x under {:.1} (naked eye {:.2}); sky at the eye {:.2} mag per square arcsecond{edge}",
        answered.v_limit,
        answered.magnification,
        answered.sky_mag_arcsec2,
        answered.naked_eye_v_limit,
        answered.background_at_eye_mag_arcsec2,
    ))
}
