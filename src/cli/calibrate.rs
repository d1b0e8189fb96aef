//! `scotopic calibrate`: how the projected sky lies on the seen one, measured.

use clap::{Args, Subcommand};

use super::Failure;
use super::settings::Settings;

/// Two photographs of the Moon.
pub mod moon;
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
}

/// Runs the subcommand; what the command line leaves out comes from the settings.
///
/// # Errors
/// A file that cannot be read, or a photograph without a Moon.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    match &arguments.command {
        Command::Moon(arguments) => moon::run(arguments, settings),
    }
}
