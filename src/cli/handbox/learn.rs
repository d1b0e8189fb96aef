//! `scotopic handbox learn`: a dialogue in the dark. Red prompts; idle noise, the speed of the line, five presses of each key, the
//! hex shown and confirmed, the map saved whole or not at all.

mod ear;
mod voice;

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use self::ear::Ear;
use self::voice::Voice;
use super::map;
use super::record::{self, Recorder};
use crate::cli::settings::Settings;
use crate::cli::settings::disk::{self, Files};
use crate::cli::{Failure, answer, answer_json};
use crate::hw::handbox::KeyMap;
use crate::hw::handbox::baud::{self, SPEEDS, Trial};
use crate::hw::handbox::keymap::{Key, Line};
use crate::hw::handbox::learn::replay::{Note, repeat};
use crate::hw::handbox::learn::{LearnError, Lesson, TAKES};
use crate::hw::handbox::source::Source;
use crate::hw::handbox::tap::refuse_mounts_port;
use crate::hw::mount::address::MountAddress;

/// A key that could not be learned so often is given up.
const MOST_TRIES: usize = 3;
/// How long the line is listened to before the presses at a speed that is only tried.
const SHORT_IDLE_S: f64 = 1.5;

/// What is taught, and where it is saved.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic handbox learn --port /dev/serial/by-id/usb-FTDI_B2-if00\n  \
    scotopic handbox learn --port /dev/ttyUSB1 --keys '?,MODE,MODE~' --map mine.toml --record lesson.jsonl\n  \
    scotopic handbox learn --replay lesson.jsonl --map mine.toml\n\n\
    NAME~ teaches what a key sends when it is held down long.")]
pub struct Arguments {
    /// The tapping adapter
    #[arg(long, value_name = "PORT", required_unless_present = "replay")]
    port: Option<Source>,
    /// Where to save the key map; without it, handbox.toml beside the settings
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// What to call it
    #[arg(long, default_value = "mine")]
    name: String,
    /// The keys to teach, with commas between
    #[arg(long, value_name = "KEYS", default_value = "?,ENTER,MODE,UP,DOWN", value_delimiter = ',')]
    keys: Vec<String>,
    /// The speed of the line, if it is known; without it the speeds are tried
    #[arg(long, value_name = "BAUD")]
    baud: Option<u32>,
    /// Seconds to listen while nobody touches a key
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, value_parser = idle)]
    idle: f64,
    /// The mount's own command port, which is never tapped; without it, the settings' mount
    #[arg(long, value_name = "ADDRESS")]
    mount: Option<MountAddress>,
    /// Print the key map as JSON in the end
    #[arg(long)]
    json: bool,
    /// Write every byte down, with its time and what was asked for
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    record: Option<PathBuf>,
    /// Learn from a recorded lesson again
    #[arg(long, value_name = "FILE", conflicts_with = "port")]
    replay: Option<PathBuf>,
}

fn idle(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|seconds| (0.5..=600.0).contains(seconds)).ok_or_else(|| "give 0.5 to 600 seconds".into())
}

/// Teaches.
///
/// # Errors
/// It was asked wrongly, the line is silent or gone, the keys cannot be told apart, or the person said no. Then nothing is saved.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let path = arguments.map.clone().or_else(map::default_path);
    let path = path.ok_or_else(|| Failure::Asked("there is no folder for settings: give --map FILE".into()))?;
    if let Some(recording) = &arguments.replay {
        let (lesson, baud) = repeat(&record::read(recording)?).map_err(Failure::failed)?;
        let line = Line { baud, ..Line::default() };
        return save(&lesson.map(&arguments.name, line).map_err(Failure::failed)?, &path, arguments.json);
    }
    let port = match &arguments.port {
        Some(Source::Tap { path }) => path,
        _ => return Err(Failure::Asked("only a tapped line can be learned: give its adapter with --port".into())),
    };
    if let Some(mount) = arguments.mount.as_ref().or(settings.mount.as_ref()) {
        refuse_mounts_port(port, mount).map_err(Failure::asked)?;
    }
    let line = Line { baud: arguments.baud.unwrap_or(SPEEDS[0]), ..Line::default() };
    let recorder = Recorder::create(arguments.record.as_deref(), &arguments.name, &line)?;
    let mut dialogue = Dialogue { voice: Voice::new()?, ear: Ear::open(port, &line, recorder)?, arguments };
    let map = dialogue.lesson()?;
    if !dialogue.voice.agrees(&format!("Save this to {}?", path.display()))? {
        return Err(Failure::Failed("nothing was saved, as you wished".into()));
    }
    save(&map, &path, arguments.json)
}

/// The map whole, or the old file as it was.
fn save(map: &KeyMap, path: &Path, as_json: bool) -> Result<(), Failure> {
    let text = map.to_toml().map_err(Failure::failed)?;
    disk::save(&mut Files, path, &text).map_err(|error| {
        Failure::Failed(format!(
            "{} could not be saved ({error}); what was in it before is still there",
            path.display()
        ))
    })?;
    if as_json {
        return answer_json(&json!({"saved": path, "map": map.sheet()}));
    }
    answer(&path.display().to_string())
}

/// A dialogue under way.
struct Dialogue<'a> {
    voice: Voice,
    ear: Ear,
    arguments: &'a Arguments,
}

impl Dialogue<'_> {
    /// All of it, to the map that is shown in the end.
    fn lesson(&mut self) -> Result<KeyMap, Failure> {
        let keys = &self.arguments.keys;
        let Some(first) = keys.first() else { return Err(Failure::Asked("give --keys".into())) };
        let (baud, mut takes) = match self.arguments.baud {
            Some(baud) => (baud, None),
            None => self.speed(first).map(|(baud, takes)| (baud, Some(takes)))?,
        };
        let line = Line { baud, ..Line::default() };
        let mut lesson = self.quiet(self.arguments.idle)?;
        for key in keys {
            let mut tries = 0;
            loop {
                let takes = match takes.take() {
                    Some(takes) => takes,
                    None => self.five(key, &lesson)?,
                };
                match lesson.learn(key, &takes) {
                    Ok(learned) if self.voice.agrees(&format!("{} Is that right?", shown(key, &learned)))? => break,
                    Ok(_) => self.voice.say("Then once more."),
                    Err(error) => {
                        self.voice.say(&error.to_string());
                        tries += 1;
                        if tries == MOST_TRIES || matches!(error, LearnError::NoSuchKey(_) | LearnError::Map(_)) {
                            return Err(Failure::failed(error));
                        }
                    }
                }
            }
        }
        let map = lesson.map(&self.arguments.name, line).map_err(Failure::failed)?;
        self.voice.say(&format!("Key map {}: {line}, framing {}", map.name(), map.framing().mode));
        for key in map.keys() {
            self.voice.say(&format!("  {}", shown(&key.name, key)));
        }
        Ok(map)
    }

    /// Tries speed after speed until one is certain, and gives the presses that were read at it.
    fn speed(&mut self, key: &str) -> Result<(u32, Vec<ear::Take>), Failure> {
        self.voice.say("The speed of the line is found first. At each speed: hands off, then five presses.");
        let mut tried: Vec<(Trial, Vec<ear::Take>)> = Vec::new();
        for baud in SPEEDS {
            self.voice.say(&format!("Speed {baud}."));
            self.ear.set(&Line { baud, ..Line::default() })?;
            let lesson = self.quiet(self.arguments.idle.min(SHORT_IDLE_S))?;
            let before = self.ear.malformed;
            let takes = self.five(key, &lesson)?;
            let presses = takes.iter().map(|take| lesson.heard(take).concat()).collect();
            let trial = Trial { baud, presses, malformed: self.ear.malformed - before };
            let certain = baud::is_certain(&trial);
            tried.push((trial, takes));
            if certain {
                break;
            }
        }
        let trials: Vec<Trial> = tried.iter().map(|(trial, _)| trial.clone()).collect();
        let chosen = baud::choose(&trials).ok_or_else(|| Failure::Failed(ear::silent(key)))?;
        self.voice.say(&format!("The line runs at {chosen} bits a second."));
        self.ear.set(&Line { baud: chosen, ..Line::default() })?;
        self.ear.note(&Note::Chosen(chosen));
        let takes = tried.into_iter().find(|(trial, _)| trial.baud == chosen).map(|(_, takes)| takes);
        Ok((chosen, takes.unwrap_or_default()))
    }

    /// Listens while nobody touches a key.
    fn quiet(&mut self, seconds: f64) -> Result<Lesson, Failure> {
        self.voice.say(&format!("Hands off the keys for {seconds} s ..."));
        self.ear.note(&Note::Idle);
        let lesson = Lesson::new(&self.ear.idle(seconds)?);
        match lesson.idle().as_slice() {
            [] => self.voice.say("The line is silent."),
            idle => self.voice.say(&format!("The line says by itself: {}", idle.join(" | "))),
        }
        Ok(lesson)
    }

    /// Five presses of a key.
    fn five(&mut self, key: &str, lesson: &Lesson) -> Result<Vec<ear::Take>, Failure> {
        let how = if key.ends_with('~') { "hold it for two seconds, then let go" } else { "let go" };
        let name = key.trim_end_matches('~');
        (1..=TAKES)
            .map(|number| {
                self.voice.say(&format!("Press {name} and {how} ({number} of {TAKES})"));
                self.ear.note(&Note::Take { key: key.to_owned(), number });
                let take = self.ear.take(key, lesson)?;
                let heard: Vec<String> =
                    lesson.heard(&take).iter().map(|burst| crate::hw::handbox::hex(burst)).collect();
                self.voice.say(&format!("  heard {}", heard.join(" | ")));
                Ok(take)
            })
            .collect()
    }
}

/// What a key sends, in words.
fn shown(name: &str, key: &Key) -> String {
    let release = key.release.as_ref().map(|release| format!(", let go {release}")).unwrap_or_default();
    let long = key.long.as_ref().map(|long| format!(", held long {long}")).unwrap_or_default();
    format!("{name} sends {}{release}{long}.", key.press)
}
