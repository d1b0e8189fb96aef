//! `scotopic calibrate periodic`: the drive's periodic error from the nudges that the sessions have written down.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::cli::settings::Settings;
use crate::cli::settings::disk::{Disk, Files};
use crate::cli::settings::nudges;
use crate::cli::{Failure, answer, answer_json};
use crate::registration::periodic::{BINS, PeriodicError, Worm, learned};

/// The settings of `calibrate periodic`.
#[derive(Debug, Clone, Args)]
#[command(
    after_help = "Choose a star near the celestial equator, and for two turns of the worm push the picture back onto it with\n\
    the arrow keys whenever it has wandered; the session writes each push down.\n\nExamples:\n  \
    scotopic calibrate periodic                       the curve, from the last night\n  \
    scotopic calibrate periodic --amplitude 5 --json  a trained mount"
)]
pub struct Arguments {
    /// File of nudges: a line `seconds,east_arcsec,north_arcsec` each, `sync` between two alignments [default: the sessions' own]
    #[arg(long, value_name = "FILE")]
    pub nudges: Option<PathBuf>,
    /// One turn of the worm, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 480.0, allow_negative_numbers = true)]
    pub period: f64,
    /// Peak to peak error of such a mount, arcseconds: 5 after training to 25 before [default: the settings', else 25]
    #[arg(long, value_name = "ARCSEC", allow_negative_numbers = true)]
    pub amplitude: Option<f64>,
    /// How well the star is centred, arcseconds
    #[arg(long, value_name = "ARCSEC", default_value_t = 2.0, allow_negative_numbers = true)]
    pub centring: f64,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// What `calibrate periodic --json` answers.
#[derive(Debug, Serialize)]
struct Told<'a> {
    nudges: usize,
    period_s: f64,
    peak_to_peak_arcsec: f64,
    rest_arcsec: f64,
    drift_arcsec_h: f64,
    curve_arcsec: &'a [f64],
    curve_error_arcsec: &'a [f64],
}

/// Larger files of nudges are not read.
const LARGEST_BYTES: u64 = 4 << 20;

/// Runs the subcommand.
///
/// # Errors
/// No nudges, too few of them, or a number out of its range.
pub(super) fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let path = arguments.nudges.clone().or_else(nudges::default_path);
    let path = path.ok_or_else(|| Failure::Failed("there is no folder for nudges: give --nudges FILE".into()))?;
    let unread = |why: String| Failure::Failed(format!("the nudges in {} cannot be read: {why}", path.display()));
    let bytes = Files.read(&path, LARGEST_BYTES).map_err(|error| unread(error.to_string()))?;
    let bytes = bytes.ok_or_else(|| {
        unread(
            "it is not there; in a session with a real mount, push the picture onto a star with the arrow keys".into(),
        )
    })?;
    let given = nudges::read(&String::from_utf8_lossy(&bytes)).map_err(unread)?;
    let worm = Worm {
        period_s: arguments.period,
        peak_to_peak_arcsec: arguments.amplitude.unwrap_or(settings.periodic_error_arcsec),
        centring_arcsec: arguments.centring,
    };
    let found = learned(&given, &worm).map_err(|error| match error {
        PeriodicError::OutOfRange { .. } => Failure::asked(error),
        PeriodicError::Few(_) | PeriodicError::Short { .. } => Failure::failed(error),
    })?;
    if arguments.json {
        return answer_json(&Told {
            nudges: given.len(),
            period_s: worm.period_s,
            peak_to_peak_arcsec: found.peak_to_peak_arcsec,
            rest_arcsec: found.rest_arcsec,
            drift_arcsec_h: found.drift_arcsec_h,
            curve_arcsec: &found.curve,
            curve_error_arcsec: &found.error,
        });
    }
    let typical = found.error.iter().sum::<f64>() / BINS as f64;
    let mut page = format!(
        "{} nudges: {:.1}\" peak to peak (± {typical:.1}), {:.1}\" left of each nudge, drift {:+.0}\" an hour\n\n",
        given.len(),
        found.peak_to_peak_arcsec,
        found.rest_arcsec,
        found.drift_arcsec_h
    );
    page += &drawn(&found.curve, worm.period_s);
    answer(page.trim_end())
}

/// Columns and rows of the drawn curve.
const COLUMNS: usize = 64;
const ROWS: usize = 13;

/// The curve in characters: one turn of the worm from left to right.
fn drawn(curve: &[f64], period_s: f64) -> String {
    let most = curve.iter().fold(1.0f64, |most, value| most.max(value.abs()));
    let row_of = |value: f64| ((1.0 - value / most) / 2.0 * (ROWS - 1) as f64).round() as usize;
    let column = |k: usize| curve.get(k * curve.len() / COLUMNS).copied().unwrap_or(0.0);
    let mut text = String::new();
    for row in 0..ROWS {
        let line: String = (0..COLUMNS)
            .map(|k| {
                if row_of(column(k)) == row {
                    '*'
                } else if row == ROWS / 2 {
                    '-'
                } else {
                    ' '
                }
            })
            .collect();
        let label = most * (1.0 - 2.0 * row as f64 / (ROWS - 1) as f64);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{label:+6.1}\" |{}", line.trim_end());
    }
    let _ = writeln!(text, "{:8}+{}", "", "-".repeat(COLUMNS));
    let _ = writeln!(text, "{:9}0{:>width$.0} s", "", period_s, width = COLUMNS - 2);
    text
}
