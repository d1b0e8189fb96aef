//! `scotopic handbox`: teach the program a hand controller's cable, hear its keys, see the key maps that are built in.

use clap::Subcommand;

use super::Failure;
use super::settings::Settings;

/// Teaching a cable.
pub mod learn;
/// Hearing keys.
pub mod listen;
/// Key maps by name or file.
pub mod map;
/// The key maps that are built in.
pub mod profiles;
/// Recordings of what was heard.
pub mod record;

/// What can be done with a hand controller.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Teach the program what the keys of your cable send: red prompts, five presses of each key
    Learn(Box<learn::Arguments>),
    /// Print the keys as they are pressed
    Listen(Box<listen::Arguments>),
    /// The key maps that are built in
    Profiles(profiles::Arguments),
}

/// Answers.
///
/// # Errors
/// It was asked wrongly, or it failed.
pub fn run(command: &Command, settings: &Settings) -> Result<(), Failure> {
    match command {
        Command::Learn(arguments) => learn::run(arguments, settings),
        Command::Listen(arguments) => listen::run(arguments, settings),
        Command::Profiles(arguments) => profiles::run(arguments),
    }
}
