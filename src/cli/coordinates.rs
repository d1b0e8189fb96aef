//! The hand controller's own places of objects: a list named in the settings, laid over the catalogue's.

use std::path::Path;

use super::Failure;
use super::settings::disk::{Disk, Files};
use crate::sky::catalogue::{Catalogue, places};

/// Larger files are no lists of coordinates.
const LARGEST_BYTES: u64 = 16 << 20;

/// So many names are told of those that were not taken.
const TOLD: usize = 8;

/// Reads the list and takes its places; what a person should know of it. Without a file nothing is done.
///
/// # Errors
/// The file cannot be read, or a line of it is wrong: then none of its places is taken.
pub(super) fn take(file: Option<&Path>) -> Result<Vec<String>, Failure> {
    let Some(path) = file else { return Ok(Vec::new()) };
    let bytes = match Files.read(path, LARGEST_BYTES) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => {
            return Err(Failure::Asked(format!(
                "the list of coordinates {} is not there: check `coordinates` in the settings",
                path.display()
            )));
        }
        Err(error) => return Err(Failure::Failed(format!("{} cannot be read: {error}", path.display()))),
    };
    let placed = places::read(&String::from_utf8_lossy(&bytes))
        .map_err(|error| Failure::Asked(format!("{}: {error}", path.display())))?;
    let catalogue = Catalogue::embed_with(&placed)
        .ok_or_else(|| Failure::Failed(String::from("the catalogue was in use before its coordinates were read")))?;
    let not_placed = catalogue.not_placed(&placed);
    if not_placed.is_empty() {
        return Ok(Vec::new());
    }
    let some: Vec<&str> = not_placed.iter().take(TOLD).copied().collect();
    let more = if not_placed.len() > TOLD { " ..." } else { "" };
    Ok(vec![format!(
        "{} of {} places of {} are of stars, or of names that the catalogue does not have, and are not used: {}{more}",
        not_placed.len(),
        placed.len(),
        path.display(),
        some.join(", ")
    )])
}
