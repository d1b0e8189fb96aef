//! `scotopic eye`: what the observer can see, what a light costs, and how a scene is toned for the eye.

use clap::Subcommand;

use super::Failure;
use super::settings::Settings;

/// Whether an object can be seen.
pub mod contrast;
/// Instrument and observer on the command line.
pub mod instrument;
/// The faintest star.
pub mod limit;
/// What a light costs the dark-adapted eye.
pub mod recovery;
/// The luminance to display.
pub mod tone;

/// What can be asked of the eye.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Say whether an object can be seen at an eyepiece, and by how much
    Contrast(contrast::Arguments),
    /// Say how faint a star can be seen at an eyepiece
    Limit(limit::Arguments),
    /// Say what luminance a display should show for one of a scene
    Tone(tone::Arguments),
    /// Say what a light costs the dark-adapted eye, and how long until it is back
    Recovery(recovery::Arguments),
}

/// Runs the subcommand.
///
/// # Errors
/// No such name, nothing known of its brightness or size, or a number out of its range.
pub fn run(command: &Command, settings: &Settings) -> Result<(), Failure> {
    match command {
        Command::Contrast(arguments) => contrast::run(arguments, settings),
        Command::Limit(arguments) => limit::run(arguments, settings),
        Command::Tone(arguments) => tone::run(arguments),
        Command::Recovery(arguments) => recovery::run(arguments),
    }
}
