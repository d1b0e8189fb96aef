//! `scotopic observe`: the field session. Opens the mount, the projector, the settings and the catalogue, and runs the
//! session in a red terminal, or without one.

use std::io::IsTerminal;
use std::path::PathBuf;

use clap::Args;

use super::Failure;
use crate::hw::handbox::source::Source;
use crate::hw::mount::address::MountAddress;
use crate::hw::projector::ProjectorAddress;
use crate::sky::site::Site;
use crate::sky::time::Utc;

/// Threads that break.
mod alarm;
/// Clocks: the machine's, or one that runs as fast as the machine can.
mod clock;
/// The supervisor beside an open line.
mod guard;
/// The hand controller's keys.
mod handbox;
/// What must be remembered over restarts.
mod keeper;
/// The line to the mount: a thread, or stepped by a virtual clock.
mod line;
/// Everything that is opened before the session begins.
mod opening;
/// Pictures to the projector, and how old they are when they get there.
mod projection;
/// The conversation with the mount, written down.
mod record;
/// The one event loop.
mod session;
/// SIGTERM, SIGINT, SIGHUP.
pub(super) mod signals;
/// What a session without a terminal ends with.
mod summary;
/// The service manager's watchdog.
mod watchdog;

/// What the session is opened with. Everything left out comes from the settings file, then from the defaults.
#[derive(Debug, Clone, Default, Args)]
#[command(after_help = "Examples:\n  \
    scotopic observe                                          a simulated telescope, in the middle of the coming night\n  \
    scotopic observe --mount serial:/dev/serial/by-id/usb-FTDI_...-if00-port0\n  \
    scotopic observe --mount tcp:192.168.4.1:4030 --projector fb:/dev/fb0\n  \
    scotopic observe --site -24.6,-70.4,2635 --time 2026-11-22T02:00:00Z\n  \
    scotopic observe --headless --handbox /dev/serial/by-id/usb-...-if00-port0 --projector fb:/dev/fb0
  \
    scotopic observe --headless --for 60 --goto M31 --projector png:frames\n  \
    scotopic observe --headless --for 21600 --fast            six hours of a simulated night in a minute")]
pub struct Arguments {
    /// The mount: sim, `serial:PATH[@BAUD]` or tcp:HOST:PORT [default: the settings', else sim]
    #[arg(long, value_name = "MOUNT")]
    pub mount: Option<MountAddress>,
    /// Where the picture goes: kms:CONNECTOR, window:MONITOR, fb:/dev/fbN, png:DIR or none [default: the settings', else none]
    #[arg(long, value_name = "PROJECTOR")]
    pub projector: Option<ProjectorAddress>,
    /// Settings file [default: scotopic/settings.toml in the user's configuration folder]
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Observing site: latitude, longitude (east positive), elevation in metres
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    pub site: Option<Site>,
    /// Date and time to begin at, instead of this computer's: 2026-11-22T20:00:00Z
    #[arg(long, value_name = "RFC3339", value_parser = Utc::from_rfc3339)]
    pub time: Option<Utc>,
    /// Run without a terminal; ends with a JSON summary on standard output
    #[arg(long)]
    pub headless: bool,
    /// The hand controller's keys: the tapping adapter's /dev/serial/by-id/NAME, evdev:/dev/input/by-id/NAME, or display
    #[arg(long, value_name = "SOURCE")]
    pub handbox: Option<Source>,
    /// Its key map: lx200-classic, autostar2-guess, ascii, or a file [default: the settings', else autostar2-guess]
    #[arg(long, value_name = "MAP", requires = "handbox")]
    pub handbox_map: Option<String>,
    /// Folder of your photographs and animations [default: the settings']
    #[arg(long, value_name = "DIR")]
    pub photographs: Option<PathBuf>,
    /// Stellarium's folder, whose photographs are drawn too, or none [default: the settings', else the installed one]
    #[arg(long, value_name = "DIR")]
    pub stellarium: Option<PathBuf>,
    /// Write all that passes between mount and computer to this file (without your site)
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// How long a session without a terminal lasts, in seconds [default: until it is asked to end]
    #[arg(long = "for", value_name = "SECONDS", requires = "headless")]
    pub seconds: Option<f64>,
    /// Without a terminal: search this and go there as soon as the mount answers (may be given many times)
    #[arg(long, value_name = "NAME", requires = "headless")]
    pub goto: Vec<String>,
    /// Without a terminal, on a simulated telescope: time runs as fast as this computer can make it
    #[arg(long, requires = "headless")]
    pub fast: bool,
}

/// Runs the session.
///
/// # Errors
/// A sentence that says what is wrong and what to do.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let terminal = std::io::stdin().is_terminal() && std::io::stdout().is_terminal();
    if !terminal && !arguments.headless {
        return Err(Failure::asked(
            "there is no terminal here to draw the session in: start it in a terminal, or add --headless",
        ));
    }
    let seconds = arguments.seconds.unwrap_or(f64::INFINITY);
    if arguments.seconds.is_some() && !(seconds > 0.0 && seconds <= 604_800.0) {
        return Err(Failure::Asked(format!(
            "--for {seconds} is no length of a session: give 1 to 604800 seconds (a week)"
        )));
    }
    let opened = opening::open(arguments)?;
    if arguments.headless {
        session::without_terminal(opened, seconds, &arguments.goto)
    } else {
        session::in_terminal(opened)
    }
}
