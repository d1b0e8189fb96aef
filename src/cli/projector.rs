//! `scotopic projector`: the projector by itself, without telescope and session.

use clap::{Args, Subcommand};

use super::Failure;

/// Its light, in cd/m2 at the eyepiece.
pub mod light;
/// What could be a projector on this computer.
pub mod outputs;
/// Test patterns.
pub mod pattern;

/// The projector by itself.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic projector outputs                                             what could be a projector here\n  \
    scotopic projector pattern finder --projector kms:HDMI-A-2             which way up?\n  \
    scotopic projector pattern grid --out grid.png --pixels 1280x720       a look, without a projector\n  \
    scotopic projector --module dlpc2607 --bus 1 status\n  \
    scotopic projector --module dlpc2607 --bus 1 measure light.toml --projector fb:/dev/fb0\n  \
    scotopic projector --module dlpc2607 --bus 1 --calibration light.toml luminance 0.3\n  \
    scotopic projector --module dlpc2607 --bus 1 off\n  \
    scotopic projector --module dlpc34xx --bus fake:state.json status      without any hardware")]
pub struct Arguments {
    #[command(flatten)]
    light: light::Which,
    #[command(subcommand)]
    command: Command,
}

/// What can be done.
#[derive(Debug, Subcommand)]
enum Command {
    #[command(flatten)]
    Light(light::Command),
    /// Show a test pattern: grid, cross, eyepieces, orientation, finder, ghost, greys or full
    Pattern(pattern::Pattern),
    /// List what could be a projector on this computer: connectors, framebuffers
    Outputs,
}

/// Does it.
///
/// # Errors
/// A sentence that says what is wrong and what to do.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Light(command) => light::run(command, &arguments.light),
        Command::Pattern(pattern) => pattern.run(&arguments.light),
        Command::Outputs => outputs::run(arguments.light.json()),
    }
}
