//! `scotopic sun`: the low Sun, and what its picture is made of.

use clap::{Args, Subcommand};

use super::Failure;

/// What particles in the air do to light.
pub mod aerosol;
/// The refractive index of air.
pub mod air;
/// The atmosphere that a name or a file stands for.
pub mod atmosphere;
/// The thesis' figures, made again.
pub mod gallery;
/// What is asked of a picture.
pub mod picture;
/// How far something is.
pub mod progress;
/// The picture.
pub mod render;
/// The Sun as it sets.
pub mod sequence;
/// The sky around the Sun.
pub mod sky;
/// One ray.
pub mod trace;

/// What is asked of the low Sun.
#[derive(Debug, Clone, Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Clone, Subcommand)]
enum Command {
    /// What the particles in the air of a climate do to light (OPAC)
    Aerosol(aerosol::Arguments),
    /// The refractive index of moist air (Ciddor 1996)
    Air(air::Arguments),
    /// How bright the sky is in a direction around the low Sun
    Sky(sky::Arguments),
    /// Make the thesis' pictures of the Sun again, each with its command line
    Gallery(gallery::Arguments),
    /// Make a picture of the low Sun
    Render(Box<render::Arguments>),
    /// Make pictures of the Sun as it sets
    Sequence(Box<sequence::Arguments>),
    /// Follow one ray from the eye through the air
    Trace(trace::Arguments),
}

/// Answers it.
///
/// # Errors
/// A sentence that says what is wrong and what to do.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Aerosol(arguments) => aerosol::run(arguments),
        Command::Air(arguments) => air::run(arguments),
        Command::Sky(arguments) => sky::run(arguments),
        Command::Gallery(arguments) => gallery::run(arguments),
        Command::Render(arguments) => render::run(arguments),
        Command::Sequence(arguments) => sequence::run(arguments),
        Command::Trace(arguments) => trace::run(arguments),
    }
}
