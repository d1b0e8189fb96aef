//! `scotopic handbox listen`: keys as they come, from a line, an input device or a recording.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::json;

use super::map;
use super::record::{self, Recorder};
use crate::cli::settings::Settings;
use crate::cli::{Failure, answer, answer_json};
use crate::hw::handbox::capture::{self, Event};
use crate::hw::handbox::presenter::{self, Buttons};
use crate::hw::handbox::source::Source;
use crate::hw::handbox::tap::{Tap, TapSaid, refuse_mounts_port};
use crate::hw::handbox::{Decoder, Heard, KeyMap, Pressed};
use crate::hw::mount::address::MountAddress;

/// What is listened to, and how it is printed.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic handbox listen --port /dev/serial/by-id/usb-FTDI_B2-if00 --map lx200-classic\n  \
    scotopic handbox listen --port /dev/ttyUSB1 --json --record night.jsonl\n  \
    scotopic handbox listen --replay night.jsonl --map mine.toml\n  \
    scotopic handbox listen --port evdev:/dev/input/by-id/usb-Logitech_R400-event-kbd")]
pub struct Arguments {
    /// The tapping adapter, or evdev:/dev/input/... for a presenter or gamepad
    #[arg(long, value_name = "PORT", required_unless_present = "replay")]
    port: Option<Source>,
    /// The key map: a built-in name, or a file; without it the one that was learned, or else the guess
    #[arg(long, value_name = "NAME|FILE")]
    map: Option<String>,
    /// The mount's own command port, which is never tapped; without it, the settings' mount
    #[arg(long, value_name = "ADDRESS")]
    mount: Option<MountAddress>,
    /// Print one JSON object a line
    #[arg(long)]
    json: bool,
    /// Write every byte down, with its time
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    record: Option<PathBuf>,
    /// Hear a recording instead of a line
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
    replay: Option<PathBuf>,
}

/// Listens until it is asked to end.
///
/// # Errors
/// It was asked wrongly: a bad key map, or the mount's own port.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let map = map::load(arguments.map.as_deref())?;
    let long: Vec<String> = map.keys().iter().map(|key| key.name.clone()).filter(|key| map.can_be_long(key)).collect();
    if let Some(path) = &arguments.replay {
        let mut decoder = Decoder::new(map).with_long(long);
        let heard = capture::replay(&record::read(path)?, &mut decoder);
        return heard.iter().try_for_each(|heard| say(heard, arguments.json));
    }
    let Some(source) = &arguments.port else { return Err(Failure::Asked("give --port or --replay".into())) };
    let mount = arguments.mount.as_ref().or(settings.mount.as_ref());
    if let (Source::Tap { path }, Some(mount)) = (source, mount) {
        refuse_mounts_port(path, mount).map_err(Failure::asked)?;
    }
    let ended = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&ended)).map_err(Failure::failed)?;
    }
    let mut recorder = Recorder::create(arguments.record.as_deref(), map.name(), &map.line())?;
    let mut outcome = Ok(());
    let mut lost = false;
    let told = |said: TapSaid| {
        match said {
            TapSaid::Opened => {
                lost = false;
                eprintln!("listening to {source}");
            }
            // Said once, not at every attempt.
            TapSaid::Lost { why } if !std::mem::replace(&mut lost, true) => eprintln!("{why}"),
            TapSaid::Bytes { bytes, malformed, at } => {
                let note = if malformed > 0 { format!("{malformed} badly formed") } else { String::new() };
                recorder.event(&Event { at, bytes, note });
            }
            TapSaid::Heard(heard) => outcome = say(&heard, arguments.json),
            TapSaid::Lost { .. } | TapSaid::Alive => {}
        }
        outcome.is_ok()
    };
    match source {
        Source::Tap { path } => {
            warn(&map);
            Tap::run(path, Decoder::new(map).with_long(long), Instant::now(), &ended, told);
        }
        Source::Evdev { path } => {
            let long = ["?", "ENTER", "MODE", "UP", "DOWN"].map(str::to_owned);
            presenter::run(path, Buttons::with_long(long), Instant::now(), &ended, told);
        }
        Source::Display => {
            return Err(Failure::Asked(
                "the display is read over the mount's own link: use `scotopic observe --handbox display`".into(),
            ));
        }
    }
    outcome
}

/// Says what should be known before a map is trusted.
fn warn(map: &KeyMap) {
    eprintln!("key map {}: {}", map.name(), map.line());
    if map.is_guess() {
        eprintln!("this key map is a guess that nobody has measured: teach yours with `scotopic handbox learn`");
    }
}

fn seconds(at: &Duration) -> f64 {
    at.as_secs_f64()
}

/// Prints what was heard.
fn say(heard: &Heard, json: bool) -> Result<(), Failure> {
    let s = |at: &Duration| (seconds(at) * 1e6).round() / 1e6;
    if json {
        return answer_json(&match heard {
            Heard::Pressed(Pressed { key, long, at }) => {
                json!({"event": "pressed", "key": key, "long": long, "t_s": s(at)})
            }
            Heard::Released { key, at } => json!({"event": "released", "key": key, "t_s": s(at)}),
            Heard::Stuck { key, at } => json!({"event": "stuck", "key": key, "t_s": s(at)}),
            Heard::Unknown { hex, at } => json!({"event": "unknown", "hex": hex, "t_s": s(at)}),
            Heard::Noise { bytes, at } => json!({"event": "noise", "bytes": bytes, "t_s": s(at)}),
        });
    }
    let line = match heard {
        Heard::Pressed(Pressed { key, long, at }) => {
            format!("{:10.3} s  {key}{}", seconds(at), if *long { " long" } else { "" })
        }
        Heard::Released { .. } => return Ok(()),
        Heard::Stuck { key, at } => {
            format!("{:10.3} s  {key} is stuck: not heard until it is silent for a second", seconds(at))
        }
        Heard::Unknown { hex, at } => format!("{:10.3} s  unknown: {hex}", seconds(at)),
        Heard::Noise { bytes, at } => format!("{:10.3} s  {bytes} bytes of noise", seconds(at)),
    };
    answer(&line)
}
