//! `scotopic observe`: the field session. Opens the mount, the projector, the settings and the catalogue, and runs the
//! session in a red terminal, or without one.

use std::io::IsTerminal;
use std::path::PathBuf;

use clap::Args;

use super::Failure;
use crate::sky::site::Site;
use crate::sky::time::Utc;

/// What the session is opened with. Everything left out comes from the settings file, then from the defaults.
#[derive(Debug, Clone, Default, Args)]
#[command(after_help = "Examples:\n  \
    scotopic observe                                          a simulated telescope, in the middle of the coming night\n  \
    scotopic observe --mount serial:/dev/serial/by-id/usb-FTDI_...-if00-port0\n  \
    scotopic observe --mount tcp:192.168.4.1:4030 --projector fb:/dev/fb0\n  \
    scotopic observe --site -24.6,-70.4,2635 --time 2026-11-22T02:00:00Z\n  \
    scotopic observe --headless --for 60 --projector png:frames   no terminal; ends with a JSON summary")]
pub struct Arguments {
    /// The mount: sim, serial:PATH[@BAUD] or tcp:HOST:PORT [default: the settings', else sim]
    #[arg(long, value_name = "MOUNT")]
    pub mount: Option<String>,
    /// Where the picture goes: window, fb:/dev/fbN, png:DIR or none [default: the settings', else none]
    #[arg(long, value_name = "PROJECTOR")]
    pub projector: Option<String>,
    /// Settings file [default: scotopic/settings.toml in the user's configuration folder]
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Observing site: latitude, longitude (east positive), elevation in metres
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    pub site: Option<Site>,
    /// Time to start at, for a simulated telescope: 2026-11-22T20:00:00Z
    #[arg(long, value_name = "RFC3339", value_parser = Utc::from_rfc3339)]
    pub time: Option<Utc>,
    /// Run without a terminal; ends with a JSON summary on standard output
    #[arg(long)]
    pub headless: bool,
    /// How long a session without a terminal lasts, in seconds
    #[arg(long = "for", value_name = "SECONDS", requires = "headless")]
    pub seconds: Option<f64>,
}

/// Runs the session.
///
/// # Errors
/// A sentence that says what is wrong and what to do.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let terminal = std::io::stdin().is_terminal() && std::io::stdout().is_terminal();
    if !terminal && !arguments.headless {
        return Err(Failure::asked(
            "there is no terminal here to draw the session in: start it in a terminal, or add --headless --for SECONDS",
        ));
    }
    Err(Failure::failed("the session is not built yet"))
}
