//! `scotopic mount stop`: stops the mount without a session. For scripts, and for the system service after its session.

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use clap::{Args, Subcommand};
use serde::Serialize;

use super::settings::Settings;
use super::{Failure, answer, answer_json};
use crate::hw::mount::address::MountAddress;
use crate::hw::mount::driver::{self, Ours};
use crate::hw::mount::link::{self, Pump};
use crate::hw::mount::order::{Order, Report};
use crate::sky::time::Utc;

/// A mount that answers is waited for so long: the stop is repeated, an LX200GPS comes to rest within 3 s.
const PATIENCE: Duration = Duration::from_secs(20);

/// One that has not answered is waited for so long: a supervisor holds the line for 3 s after its session.
const UNANSWERED: Duration = Duration::from_secs(8);

/// Between two looks at a line that is not open.
const LOOK: Duration = Duration::from_millis(10);

/// What can be done to a mount without a session.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Stop all motion, and wait until the mount says that it stands still
    Stop(Arguments),
}

/// Which mount.
#[derive(Debug, Args)]
#[command(
    after_help = "Tracking goes on: the stop ends slews and moves by hand. The stop is the first thing that is sent.\n\n\
    Examples:\n  \
    scotopic mount stop                                   the mount that the settings name\n  \
    scotopic mount stop --mount serial:/dev/scotopic-mount\n  \
    scotopic mount stop --mount tcp:192.168.4.1:4030 --json"
)]
pub struct Arguments {
    /// The mount: `serial:PATH[@BAUD]` or tcp:HOST:PORT [default: the settings']
    #[arg(long, value_name = "MOUNT")]
    pub mount: Option<MountAddress>,
    /// Settings file [default: scotopic/settings.toml in the user's configuration folder]
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Answer as JSON
    #[arg(long)]
    pub json: bool,
}

/// What `mount stop --json` answers.
#[derive(Debug, Serialize)]
struct Answered {
    mount: String,
    stopped: bool,
    seconds: f64,
}

/// Does it.
///
/// # Errors
/// The mount does not say that it stands still: what to do then.
pub fn run(command: &Command) -> Result<(), Failure> {
    let Command::Stop(arguments) = command;
    let settings = Settings::load(arguments.config.as_deref())?;
    let mount = arguments.mount.clone().or(settings.mount).unwrap_or(MountAddress::Sim);
    let Some(opener) = link::opener(&mount) else {
        return say(arguments, &mount, Duration::ZERO); // a simulated telescope ends with its session
    };
    let utc_at_start = Utc(SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64()));
    let ours = Ours { utc_at_start, site: settings.site };
    let mut pump = Pump::new(driver::Settings::new(link::timing(&mount), ours), opener);
    let after = stop(&mut pump, &mount)?;
    say(arguments, &mount, after)
}

/// Stops, and gives the time until the mount stood still.
fn stop(pump: &mut Pump, mount: &MountAddress) -> Result<Duration, Failure> {
    let started = Instant::now();
    let (mut answered, mut why) = (false, None);
    pump.order(Order::Stop, Duration::ZERO);
    loop {
        let now = started.elapsed();
        for report in pump.step(now).into_iter().flat_map(|update| update.reports) {
            match report {
                Report::Stopped => return Ok(now),
                Report::Connected { .. } | Report::Position => answered = true,
                Report::StillLost { .. } | Report::Lost(_) | Report::Fault(_) => why = Some(report.to_string()),
                _ => {}
            }
        }
        if now > if answered { PATIENCE } else { UNANSWERED } {
            let why = why.unwrap_or_else(|| "it has not come to rest".into());
            return Err(Failure::Failed(format!(
                "{mount} has not said that it stands still ({why}): look at it; if it moves, cut its power"
            )));
        }
        if !pump.is_open() {
            thread::sleep(LOOK);
        }
    }
}

fn say(arguments: &Arguments, mount: &MountAddress, after: Duration) -> Result<(), Failure> {
    let seconds = after.as_secs_f64();
    if arguments.json {
        return answer_json(&Answered { mount: mount.to_string(), stopped: true, seconds });
    }
    answer(&format!("{mount} stands still (after {seconds:.1} s)"))
}
