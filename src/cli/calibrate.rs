//! `scotopic calibrate`: how the projected sky lies on the seen one, measured.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::settings::Settings;
use super::settings::calibration::{self, Kept};
use super::settings::disk::Files;
use super::{Failure, answer, answer_json};

/// Two photographs of the Moon.
pub mod moon;
/// The drive's periodic error.
pub mod periodic;
/// A photograph's file as numbers.
mod photograph;

/// The settings of `calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic calibrate moon seen.jpg drawn.jpg --at 2026-11-22T20:00:00Z --site 60.17,24.94,30\n  \
    scotopic calibrate moon seen.fits drawn.fits --json")]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

/// What can be calibrated.
#[derive(Debug, Subcommand)]
enum Command {
    /// Scale, offset, turn and parity of the picture, from a photograph of the Moon and one of the projected Moon
    Moon(Box<moon::Arguments>),
    /// Say what is kept of earlier calibrations
    Show {
        /// Answer in JSON
        #[arg(long)]
        json: bool,
    },
    /// Take away what is kept: the picture is drawn as the instrument's file says
    Forget,
    /// The drive's periodic error, learned from a night's nudges, as a curve
    Periodic(periodic::Arguments),
}

/// Runs the subcommand; what the command line leaves out comes from the settings.
///
/// # Errors
/// A file that cannot be read, or a photograph without a Moon.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    match &arguments.command {
        Command::Moon(arguments) => moon::run(arguments, settings),
        Command::Show { json } => show(*json),
        Command::Forget => forget(),
        Command::Periodic(arguments) => periodic::run(arguments, settings),
    }
}

fn show(json: bool) -> Result<(), Failure> {
    let path = path()?;
    let kept = Kept::load(&path, &mut Files)?;
    if json {
        return answer_json(&kept);
    }
    let Some(Kept { now, photographed, .. }) = kept else {
        return answer("nothing is kept: the picture is drawn as the instrument's file says");
    };
    answer(&format!(
        "scale     {:.4} ± {:.4}, drawn over seen\nturned    {:+.2}° ± {:.2}° counter-clockwise\nmirrored  {}\n\
         axis      {:+.1} px right, {:+.1} px down of the canvas' middle (± {:.1})\nMoon of   {}\nin        {}",
        now.scale,
        now.scale_error,
        now.turn_deg,
        now.turn_error_deg,
        if now.mirrored { "yes" } else { "no" },
        now.right_px,
        now.down_px,
        now.offset_error_px,
        if photographed.is_empty() { "a time that was not told" } else { &photographed },
        path.display(),
    ))
}

fn forget() -> Result<(), Failure> {
    let path = path()?;
    match std::fs::remove_file(&path) {
        Ok(()) => answer(&format!("forgotten: {} is gone", path.display())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => answer("nothing was kept"),
        Err(error) => Err(Failure::Failed(format!("{} cannot be taken away: {error}", path.display()))),
    }
}

fn path() -> Result<PathBuf, Failure> {
    calibration::default_path()
        .ok_or_else(|| Failure::Failed("there is no folder for what is kept: set XDG_STATE_HOME or HOME".into()))
}
