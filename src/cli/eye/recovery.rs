//! `scotopic eye recovery`: what a light costs the dark-adapted eye, and how long until it is back.

use clap::Args;
use serde::Serialize;

use crate::cli::overlay::within;
use crate::cli::{Failure, answer, answer_json};
use crate::eye::adaptation::{BACK_DEX, CALIBRATION_NOTE, brightest_for, cost_while_on_dex};
use crate::eye::lamp::pupil_mm;
use crate::eye::{Adaptation, Lamp};

/// The settings of `eye recovery`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic eye recovery --light white --luminance 0.03 --seconds 60\n  \
    scotopic eye recovery --light led635 --luminance 1.8 --seconds 600 --json\n\n\
    The luminance is photopic, at the eye, over the part of the retina that is lit: adaptation is local. The loss after the\n\
    light is off rests on our own calibration, good to a factor of 2; the kinetics are Lamb and Pugh's (2004).")]
pub struct Arguments {
    /// Which light: led635, lcd-red or white
    #[arg(long, value_name = "LIGHT")]
    pub light: Lamp,
    /// Photopic luminance at the eye, cd/m2
    #[arg(long, value_name = "CD/M2", allow_hyphen_values = true)]
    pub luminance: f64,
    /// How long it is on
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub seconds: f64,
    /// Diameter of the pupil in millimetres [default: 7 to 0.03 cd/m2, 6 to 0.5, 5 above]
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub pupil_mm: Option<f64>,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// What `eye recovery --json` answers.
#[derive(Debug, Serialize)]
struct Answer {
    light: &'static str,
    loss_magnitudes: f64,
    minutes_to_0_1_dex: f64,
    minutes_to_0_3_dex: f64,
    while_on_dex: f64,
    bleached_fraction: f64,
    pupil_mm: f64,
    scotopic_over_photopic: f64,
    brightest_for_one_minute_cd_m2: f64,
    calibration: &'static str,
}

/// Runs the subcommand.
///
/// # Errors
/// A number out of its range.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let luminance = within("--luminance", arguments.luminance, 0.0, 1e8)?;
    let seconds = within("--seconds", arguments.seconds, 0.0, 1e7)?;
    let given = arguments.pupil_mm.map(|pupil| within("--pupil-mm", pupil, 0.5, 10.0)).transpose()?;
    let light = arguments.light;
    let eye = Adaptation::default().after(light, luminance, given, seconds);
    let answered = Answer {
        light: light.name(),
        loss_magnitudes: eye.loss_magnitudes(),
        minutes_to_0_1_dex: eye.minutes_until_back(),
        minutes_to_0_3_dex: eye.minutes_to(0.3),
        while_on_dex: cost_while_on_dex(light, luminance),
        bleached_fraction: eye.bleached(),
        pupil_mm: given.unwrap_or_else(|| pupil_mm(luminance)),
        scotopic_over_photopic: light.scotopic_over_photopic(),
        brightest_for_one_minute_cd_m2: brightest_for(light, seconds, 1.0, given),
        calibration: CALIBRATION_NOTE,
    };
    if arguments.json {
        return answer_json(&answered);
    }
    answer(&format!(
        "{luminance} cd/m2 of {} for {seconds} s, pupil {} mm\n\
         {:<16}{:.2} dex, gone within seconds\n\
         {:<16}{:.2} magnitudes ({CALIBRATION_NOTE})\n\
         {:<16}{:.1} minutes to within {BACK_DEX} dex\n\
         {:<16}up to {:.2e} cd/m2 of this light the eye is back within a minute",
        light.words(),
        answered.pupil_mm,
        "while it is on",
        answered.while_on_dex,
        "after it",
        answered.loss_magnitudes,
        "back in",
        answered.minutes_to_0_1_dex,
        "",
        answered.brightest_for_one_minute_cd_m2,
    ))
}
