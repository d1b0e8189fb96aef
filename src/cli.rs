//! The command line: parse, wire, run, print. One file a subcommand.
//!
//! Every subcommand answers on standard output (`--json` for machines), prints progress and notes on standard error, and
//! exits 0 (done), 1 (it failed) or 2 (it was asked wrongly).

use std::io::Write;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use self::settings::Settings;

/// A folder of the observer's animations.
pub mod animations;
/// How the projected sky lies on the seen one.
pub mod calibrate;
/// The catalogue files that are built into the program.
pub mod catalogue;
/// The hand controller's own places of objects.
pub mod coordinates;
/// What the observer can see.
pub mod eye;
/// How a subcommand ends without doing what was asked.
pub mod failure;
/// The mount's own hand controller as an input device.
pub mod handbox;
/// The mount without a session.
pub mod mount;
/// Reflection nebulae.
pub mod nebula;
/// The field session.
pub mod observe;
/// What the telescope shows with each eyepiece.
pub mod optics;
/// One picture as the projector would show it.
pub mod overlay;
/// A folder of the observer's photographs.
pub mod photographs;
/// The projector by itself.
pub mod projector;
/// What the methods cost and what errors they make.
pub mod report;
/// The rig file of the hardware tests.
pub mod rig;
/// The observer's settings, and what is remembered between sessions.
pub mod settings;
/// Devices that are not there.
pub mod simulate;
/// Where things are, and what is in a field.
pub mod sky;
/// The low Sun.
pub mod sun;
/// The process that stops the mount if the session dies.
pub mod supervise;
/// What is worth showing now.
pub mod tonight;

pub use failure::Failure;

/// The whole command line.
#[derive(Debug, Parser)]
#[command(
    name = "scotopic",
    version,
    about,
    long_about = "Augments the view through a goto telescope: facts and pictures in the eyepiece, dim enough to stay dark adapted.\n\n\
                  Without a subcommand it opens the field session (`observe`) with a simulated telescope.",
    after_help = "Examples:\n  \
        scotopic                                        the field session, on a simulated telescope\n  \
        scotopic observe --mount serial:/dev/ttyUSB0    the field session, on yours\n  \
        scotopic observe --help                         all its settings\n  \
        scotopic completions bash > ~/.local/share/bash-completion/completions/scotopic",
    subcommand_help_heading = "Commands",
    disable_help_subcommand = true
)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

/// What can be asked.
#[derive(Debug, Subcommand)]
enum Command {
    /// Point, see, know: the field session in a red terminal
    Observe(Box<observe::Arguments>),
    /// Stop the mount without a session
    #[command(subcommand)]
    Mount(mount::Command),
    /// Play a device that is not there, on a port that other programs open
    #[command(subcommand)]
    Simulate(simulate::Device),
    /// Hear the keys of the mount's own hand controller on its tapped cable
    #[command(subcommand)]
    Handbox(handbox::Command),
    /// Watch over a session; started by the session itself
    #[command(hide = true)]
    Supervise,
    /// Say where something is, or what is in a field
    #[command(subcommand)]
    Sky(sky::Command),
    /// What the eye can see, what a light costs it, and tone
    #[command(subcommand)]
    Eye(eye::Command),
    /// Make the catalogue files that are built into the program
    #[command(subcommand)]
    Catalogue(catalogue::Command),
    /// Make one picture as the projector would show it, without a session
    Overlay(Box<overlay::Arguments>),
    /// Say which photographs there are
    #[command(subcommand)]
    Photographs(photographs::Command),
    /// Drive the projector by itself: its light, test patterns
    Projector(Box<projector::Arguments>),
    /// Measure how the projected sky lies on the seen one
    Calibrate(Box<calibrate::Arguments>),
    /// Rank what is worth showing now, by what this telescope and eye can see
    Tonight(Box<tonight::Arguments>),
    /// Say what the telescope shows with each eyepiece
    Optics(optics::Arguments),
    /// The low Sun through real air: single rays, the index of air
    Sun(sun::Arguments),
    /// Reflection nebulae: dust lit by stars, made, rendered, flown through
    Nebula(nebula::Arguments),
    /// What the methods cost and what errors they make, measured here and now
    Report(report::Arguments),
    /// Print the completions of a shell
    Completions {
        /// The shell to complete in
        shell: clap_complete::Shell,
    },
}

/// Parses the process' arguments, runs, prints the error, and gives the exit code.
#[must_use]
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Nothing can be done about a terminal that does not take the message.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let _ = writeln!(std::io::stderr(), "scotopic: {}", printable(&failure.to_string()));
            failure.exit_code()
        }
    }
}

fn run(cli: Cli) -> Result<(), Failure> {
    match cli.command {
        None => observe::run(&observe::Arguments::default()),
        Some(Command::Observe(arguments)) => observe::run(&arguments),
        Some(Command::Mount(command)) => mount::run(&command),
        Some(Command::Simulate(device)) => simulate::run(&device),
        Some(Command::Handbox(command)) => handbox::run(&command, &Settings::load(None)?),
        Some(Command::Supervise) => supervise::run(),
        Some(Command::Sky(command)) => sky::run(&command, settings()?.site),
        Some(Command::Eye(command)) => eye::run(&command, &settings()?),
        Some(Command::Catalogue(command)) => catalogue::run(&command),
        Some(Command::Overlay(arguments)) => overlay::run(&arguments, &settings()?),
        Some(Command::Photographs(command)) => photographs::run(&command, &settings()?),
        Some(Command::Projector(arguments)) => projector::run(&arguments),
        Some(Command::Calibrate(arguments)) => calibrate::run(&arguments, &Settings::load(None)?),
        Some(Command::Tonight(arguments)) => tonight::run(&arguments, &settings()?),
        Some(Command::Optics(arguments)) => optics::run(&arguments, &Settings::load(None)?),
        Some(Command::Sun(arguments)) => sun::run(&arguments),
        Some(Command::Nebula(arguments)) => nebula::run(&arguments),
        Some(Command::Report(arguments)) => report::run(&arguments),
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "scotopic", &mut script);
            answer_bytes(&script)
        }
    }
}

/// The settings, with the hand controller's own places laid over the catalogue's.
fn settings() -> Result<Settings, Failure> {
    let settings = Settings::load(None)?;
    coordinates::take(settings.coordinates.as_deref())?.iter().for_each(|sentence| note(sentence));
    Ok(settings)
}

/// Prints a line of the answer. A reader that has heard enough (`| head`) is no failure.
///
/// # Errors
/// Standard output could not be written.
pub fn answer(text: &str) -> Result<(), Failure> {
    answer_bytes(format!("{text}\n").as_bytes())
}

/// Prints a value as the machine-readable answer: one line of JSON.
///
/// # Errors
/// Standard output could not be written, or a number in the value is not finite.
pub fn answer_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    answer(&serde_json::to_string(value).map_err(Failure::failed)?)
}

fn answer_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::failed(error)),
        _ => Ok(()),
    }
}

/// A note on standard error.
pub(crate) fn note(sentence: &str) {
    let _ = writeln!(std::io::stderr(), "scotopic: {}", printable(sentence));
}

/// Text from outside without control characters, so that it cannot move the cursor or colour the screen. Line ends stay.
#[must_use]
pub fn printable(text: &str) -> String {
    text.chars().filter(|c| *c == '\n' || !c.is_control()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_southern_western_site_needs_no_equals_sign() {
        let cli = Cli::try_parse_from(["scotopic", "observe", "--site", "-24.6,-70.4,2635"]).unwrap();
        let Some(Command::Observe(arguments)) = cli.command else { panic!("observe was asked") };
        assert_eq!(arguments.site.map(|site| site.latitude.to_degrees().round()), Some(-25.0));
    }

    #[test]
    fn latitude_91_is_asked_wrongly() {
        let error = Cli::try_parse_from(["scotopic", "observe", "--site", "91,0"]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("91"), "{error}");
    }

    #[test]
    fn escapes_do_not_reach_the_terminal() {
        assert_eq!(printable("M\u{1b}[31m31\u{9b}2J\u{7}"), "M[31m312J");
    }
}
