//! `scotopic simulate`: a device that is not there, on a port that other programs open.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::{Args, Subcommand};

/// The hand controller.
pub mod handbox;
mod record;

use self::record::Recorder;
use super::{Failure, answer, answer_json};
use crate::hw::mount::sim::Simulator;
use crate::hw::mount::sim::fault::{Faults, TABLE};
use crate::hw::mount::sim::serve::{Listen, Server};
use crate::hw::mount::sim::settings::Settings;
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

/// The devices that can be simulated.
#[derive(Debug, Subcommand)]
pub enum Device {
    /// A Meade LX200GPS: slow, silent and odd as the real one, with faults on request
    Mount(Box<Mount>),
    /// A hand controller with a tapped cable: key names on standard input, bytes on a pseudo terminal
    Handbox(handbox::Handbox),
}

/// The simulated mount, and where it listens.
#[derive(Debug, Args)]
pub struct Mount {
    /// Where to listen: pty, or tcp:127.0.0.1:PORT (port 0 chooses a free one)
    #[arg(long, value_name = "PLACE", default_value = "pty")]
    listen: Listen,
    /// Switch a fault on; may be given many times. `--fault list` shows them all
    #[arg(long = "fault", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    faults: Vec<String>,
    /// Seed of everything random
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Where the mount stands: degrees north, degrees east, metres
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    site: Option<Site>,
    /// What its clock says at the start, like 2026-11-22T20:00:00Z; without it, the time of this computer
    #[arg(long, value_name = "RFC3339", value_parser = |text: &str| Utc::from_rfc3339(text))]
    time: Option<Utc>,
    /// Periodic error of each worm in arcseconds, peak to peak
    #[arg(long, value_name = "ARCSEC", default_value_t = 25.0, value_parser = size, allow_hyphen_values = true)]
    periodic_error: f64,
    /// Size of the pointing error on the sky in arcminutes
    #[arg(long, value_name = "ARCMIN", default_value_t = 2.0, value_parser = size, allow_hyphen_values = true)]
    pointing_error: f64,
    /// Drift of the true axis in azimuth, arcseconds a second
    #[arg(long, value_name = "ARCSEC_PER_S", default_value_t = 0.0, allow_hyphen_values = true)]
    drift: f64,
    /// Hand bytes on every 16 ms only, as a USB adapter does
    #[arg(long)]
    usb_batching: bool,
    /// Write every byte that passes, with its time, to this file: JSON lines after a header
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// With `--fault list`: the list as JSON (the endpoint is JSON anyway)
    #[arg(long)]
    json: bool,
}

/// Runs the simulated device until it is told to end.
///
/// # Errors
/// It was asked wrongly, or the port cannot be opened.
pub fn run(device: &Device) -> Result<(), Failure> {
    let mount = match device {
        Device::Mount(mount) => mount,
        Device::Handbox(arguments) => return handbox::run(arguments),
    };
    if mount.faults.iter().any(|fault| fault == "list") {
        return list_faults(mount.json);
    }
    let settings = settings(mount)?;
    let recorder = mount.record.as_ref().map(|path| Recorder::create(path, mount, &settings)).transpose()?;
    let simulator = Simulator::new(settings);
    let ended = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&ended)).map_err(Failure::failed)?;
    }
    let mut server = Server::open(simulator, mount.listen).map_err(|error| {
        Failure::Failed(format!(
            "the simulator cannot listen at {}: {error}; choose another port, or port 0",
            mount.listen
        ))
    })?;
    if let Some(recorder) = recorder {
        server.watch(recorder.watcher());
    }
    say_endpoint(&server.endpoint())?;
    server
        .serve(&|| ended.load(Ordering::Relaxed), &mut |endpoint| {
            // The reader of our first line may be gone; the simulator serves on.
            let _ = say_endpoint(endpoint);
        })
        .map_err(|error| Failure::Failed(format!("the simulator has lost its port: {error}")))
}

fn say_endpoint(endpoint: &str) -> Result<(), Failure> {
    answer(&format!("{{\"endpoint\": {}}}", serde_json::json!(endpoint)))
}

fn settings(mount: &Mount) -> Result<Settings, Failure> {
    let mut faults = Faults::default();
    for fault in &mount.faults {
        faults.switch(fault).map_err(Failure::asked)?;
    }
    let start = mount.time.unwrap_or_else(|| {
        Utc(SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since_1970| since_1970.as_secs_f64()))
    });
    if !mount.drift.is_finite() || mount.drift.abs() > 3600.0 {
        return Err(Failure::Asked(format!(
            "a drift of {} arcseconds a second is too much: give -3600 to 3600",
            mount.drift
        )));
    }
    Ok(Settings {
        seed: mount.seed,
        periodic_error: Angle::arcseconds(mount.periodic_error),
        pointing_error: Angle::arcminutes(mount.pointing_error),
        drift_arcsec_per_s: mount.drift,
        usb_batching: mount.usb_batching,
        faults,
        ..Settings::at(mount.site.unwrap_or(Settings::default().site), start)
    })
}

fn list_faults(json: bool) -> Result<(), Failure> {
    if json {
        let list: Vec<_> = TABLE
            .iter()
            .map(|fault| {
                serde_json::json!({
                    "name": fault.name, "values": fault.values, "example": fault.example, "meaning": fault.meaning
                })
            })
            .collect();
        return answer_json(&list);
    }
    let width = TABLE.iter().map(|fault| fault.name.len() + fault.example.len() + 1).max().unwrap_or(0);
    TABLE.iter().try_for_each(|fault| {
        let example = format!("{}={}", fault.name, fault.example);
        answer(&format!("{example:width$}  {}\n{:width$}  value: {}", fault.meaning, "", fault.values))
    })
}

/// The size of an error: a number from 0 to 10000.
fn size(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=10_000.0).contains(&value) => Ok(value),
        _ => Err("give a number from 0 to 10000".into()),
    }
}
