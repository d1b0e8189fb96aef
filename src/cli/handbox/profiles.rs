//! `scotopic handbox profiles`: the key maps that are built in, and one of them (or a file) in full.

use clap::Args;

use super::map;
use crate::cli::{Failure, answer, answer_json};
use crate::hw::handbox::KeyMap;
use crate::hw::handbox::keymap::SHIPPED;

/// Which key maps are shown.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic handbox profiles                              what is built in\n  \
    scotopic handbox profiles --map ascii > mine.toml      one of them as a file to change\n  \
    scotopic handbox profiles --map mine.toml              check a file")]
pub struct Arguments {
    /// Print this one in full, and check it: a name, or a file
    #[arg(long, value_name = "NAME|FILE")]
    map: Option<String>,
    /// For machines
    #[arg(long)]
    json: bool,
}

/// Answers.
///
/// # Errors
/// There is no such key map, or something is wrong with it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(wanted) = &arguments.map {
        let map = map::load(Some(wanted))?;
        return if arguments.json {
            answer_json(map.sheet())
        } else {
            answer(map.to_toml().map_err(Failure::failed)?.trim_end())
        };
    }
    let maps: Vec<KeyMap> = SHIPPED.iter().filter_map(|shipped| KeyMap::shipped(shipped.name)).collect();
    if arguments.json {
        return answer_json(&maps.iter().map(KeyMap::sheet).collect::<Vec<_>>());
    }
    maps.iter().try_for_each(|map| {
        let keys: Vec<&str> = map.keys().iter().map(|key| key.name.as_str()).collect();
        let guess = if map.is_guess() { "A GUESS, never measured. " } else { "" };
        let (name, line, mode) = (map.name(), map.line(), map.framing().mode);
        answer(&format!(
            "{name:16} {line}, {mode}\n{:16} {guess}{}\n{:16} {}",
            "",
            map.sheet().note,
            "",
            keys.join(" ")
        ))
    })
}
