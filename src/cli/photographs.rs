//! A folder of the observer's photographs: FITS files, and PNG or JPEG files with a TOML file beside each.

use std::fs;
use std::path::Path;

use clap::Subcommand;

use super::Failure;
use super::settings::Settings;
use crate::overlay::Photograph;
use crate::overlay::globe::Map;
use crate::overlay::photograph::read::picture;
use crate::overlay::photograph::{MOST_BYTES, PhotographError};
use crate::sky::ephemeris::Body;

/// All photographs there are, read when they are needed.
pub mod album;
/// `photographs list`.
pub mod list;

/// What can be asked of the photographs.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// List them: of what, whose, on which terms, and whether they lie where they say
    List(list::Arguments),
}

/// Runs a subcommand.
///
/// # Errors
/// As the subcommand has them.
pub fn run(command: &Command, settings: &Settings) -> Result<(), Failure> {
    match command {
        Command::List(arguments) => list::run(arguments, settings),
    }
}

/// Most files that are looked at.
const MOST_FILES: usize = 1000;

/// All photographs of a folder, and a sentence for each file that could not be used.
///
/// # Errors
/// The folder itself cannot be read.
pub fn read_folder(folder: &Path) -> Result<(Vec<Photograph>, Vec<String>), Failure> {
    let unreadable = |error| {
        Failure::Failed(format!(
            "the photographs in {} cannot be read: {error}; give an existing folder",
            folder.display()
        ))
    };
    let entries = fs::read_dir(folder).map_err(unreadable)?;
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    let (mut photographs, mut notes) = (Vec::new(), Vec::new());
    for path in paths.into_iter().take(MOST_FILES) {
        match read(&path) {
            Some(Ok(photograph)) => photographs.push(photograph),
            Some(Err(why)) => notes.push(format!("the photograph {} is not drawn: {why}", path.display())),
            None => {}
        }
    }
    Ok((photographs, notes))
}

/// The maps of a folder (`jupiter.png`, `moon.jpg`...), and a sentence for each that could not be used. Files of other names are
/// left alone.
///
/// # Errors
/// The folder itself cannot be read.
pub fn read_maps(folder: &Path) -> Result<(Vec<Map>, Vec<String>), Failure> {
    let unreadable = |error| {
        Failure::Failed(format!("the maps in {} cannot be read: {error}; give an existing folder", folder.display()))
    };
    let entries = fs::read_dir(folder).map_err(unreadable)?;
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    let (mut maps, mut notes) = (Vec::new(), Vec::new());
    for path in paths.into_iter().take(MOST_FILES) {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let body = Body::from_name(&path.file_stem().unwrap_or_default().to_string_lossy());
        let Some(body) = body.filter(|_| matches!(ending.as_str(), "png" | "jpg" | "jpeg")) else { continue };
        match bounded(&path).and_then(|bytes| picture(&bytes).map_err(|error| error.to_string())) {
            Ok(picture) => maps.push(Map::new(body, picture)),
            Err(why) => notes.push(format!("the map {} is not used: {why}", path.display())),
        }
    }
    Ok((maps, notes))
}

/// The bytes of a file that is not too large.
fn bounded(path: &Path) -> Result<Vec<u8>, String> {
    let size = fs::metadata(path).map_err(|error| error.to_string())?.len();
    if size > MOST_BYTES {
        return Err(PhotographError::Bytes(size).to_string());
    }
    fs::read(path).map_err(|error| error.to_string())
}

/// A file's photograph; `None` for a file of another kind.
fn read(path: &Path) -> Option<Result<Photograph, String>> {
    let ending = path.extension()?.to_string_lossy().to_lowercase();
    let fits = matches!(ending.as_str(), "fits" | "fit" | "fts");
    if !fits && !matches!(ending.as_str(), "png" | "jpg" | "jpeg") {
        return None;
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Some(read_as(path, &name, fits))
}

fn read_as(path: &Path, name: &str, fits: bool) -> Result<Photograph, String> {
    let bytes = bounded(path)?;
    if fits {
        return Photograph::from_fits(name, &bytes).map_err(|error| error.to_string());
    }
    let beside = path.with_extension("toml");
    let text = fs::read_to_string(&beside).map_err(|error| {
        format!("{} says where it is on the sky, and cannot be read ({error}); write ra_deg, dec_deg and scale_arcsec_px into it", beside.display())
    })?;
    Photograph::from_image(name, &bytes, &text).map_err(|error| error.to_string())
}
