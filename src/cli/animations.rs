//! A folder of the observer's animations: folders of PNG frames and animated PNG files, with a TOML file beside each. They lie
//! among the photographs.

use std::fs;
use std::path::{Path, PathBuf};

use super::Failure;
use crate::overlay::animation::Animation;
use crate::overlay::animation::read::{MOST_BYTES, MOST_FRAMES};

/// Most animations of a folder: each may take a quarter of a GiB.
const MOST: usize = 8;

/// All animations of a folder, and a sentence for each that cannot be played.
///
/// # Errors
/// The folder itself cannot be read.
pub fn read_folder(folder: &Path) -> Result<(Vec<Animation>, Vec<String>), Failure> {
    let (mut animations, mut notes) = (Vec::new(), Vec::new());
    for path in names(folder).map_err(|error| {
        Failure::Failed(format!(
            "the animations in {} cannot be read: {error}; give an existing folder",
            folder.display()
        ))
    })? {
        let beside = path.with_extension("toml");
        let is_apng = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("apng"));
        // A folder without a TOML file beside it is none of ours.
        if !(is_apng || path.is_dir() && beside.is_file()) {
            continue;
        }
        if animations.len() == MOST {
            notes.push(format!("more than {MOST} animations are in {}: the rest is not read", folder.display()));
            break;
        }
        match read(&path, &beside, is_apng) {
            Ok(animation) => animations.push(animation),
            Err(why) => notes.push(format!("the animation {} is not played: {why}", path.display())),
        }
    }
    Ok((animations, notes))
}

fn read(path: &Path, beside: &Path, is_apng: bool) -> Result<Animation, String> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let text = fs::read_to_string(beside).map_err(|error| {
        format!(
            "{} says of what it is, and cannot be read ({error}); write object and scale_arcsec_px into it",
            beside.display()
        )
    })?;
    if is_apng {
        let bytes = bytes(path).map_err(|error| error.to_string())?;
        return Animation::from_apng(&name, &bytes, &text).map_err(|error| error.to_string());
    }
    let frames = names(path).map_err(|error| error.to_string())?;
    let is_png = |path: &PathBuf| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    // One more than is taken, so that too many are told of.
    let frames = frames.into_iter().filter(is_png).take(MOST_FRAMES + 1);
    let frames = frames.map(|path| (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), bytes(&path)));
    Animation::from_frames(&name, frames, &text).map_err(|error| error.to_string())
}

fn bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    let size = fs::metadata(path)?.len();
    if size > MOST_BYTES {
        return Err(std::io::Error::other(format!("it has {size} bytes: at most {MOST_BYTES} are read")));
    }
    fs::read(path)
}

/// What is in a folder, in the order of its names.
fn names(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}
