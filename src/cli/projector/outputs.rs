//! `scotopic projector outputs`: what could be a projector on this computer, from the kernel's own lists. Changes nothing.

use std::fs;
use std::path::Path;

use serde::Serialize;

use crate::cli::{Failure, answer, answer_json, printable};

/// Something that pictures can be sent to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
struct Found {
    /// What to give as `--projector`.
    projector: String,
    /// What it is.
    what: String,
    /// Whether something is connected, where that is known.
    connected: Option<bool>,
    /// The sizes it takes.
    modes: Vec<String>,
}

/// Lists them.
///
/// # Errors
/// Standard output could not be written.
pub fn run(json: bool) -> Result<(), Failure> {
    let mut found = connectors(Path::new("/sys/class/drm"));
    found.extend(framebuffers(Path::new("/sys/class/graphics")));
    if json {
        return answer_json(&found);
    }
    if found.is_empty() {
        answer("no display controller and no framebuffer: only png:FOLDER and sim are possible here")?;
    }
    for Found { projector, what, connected, modes } in &found {
        let plugged = match connected {
            Some(true) => "connected",
            Some(false) => "nothing connected",
            None => "",
        };
        let modes = if modes.is_empty() { String::new() } else { format!("  {}", modes.join(" ")) };
        answer(format!("{projector:<28} {what:<20} {plugged}{modes}").trim_end())?;
    }
    if cfg!(feature = "kms") { Ok(()) } else { answer("(kms: needs a scotopic built with --features kms)") }
}

/// The folders of a folder, by name.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().chars().filter(|c| !c.is_control()).collect())
        .collect();
    names.sort();
    names
}

/// One line of a file of the kernel's, without control characters; empty if it is not there.
fn line(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_default();
    text.lines().next().unwrap_or_default().chars().filter(|c| !c.is_control()).take(80).collect()
}

/// `card1-HDMI-A-2` and its like.
fn connectors(class: &Path) -> Vec<Found> {
    let mut found = Vec::new();
    for name in names(class) {
        let Some((card, connector)) = name.split_once('-').filter(|(card, _)| card.starts_with("card")) else {
            continue;
        };
        let folder = class.join(&name);
        let modes = fs::read_to_string(folder.join("modes")).unwrap_or_default();
        let mut modes: Vec<String> = modes.lines().take(40).map(printable).collect();
        modes.dedup();
        let connected = match line(&folder.join("status")).as_str() {
            "connected" => Some(true),
            "disconnected" => Some(false),
            _ => None,
        };
        let projector = format!("kms:{card}/{connector}");
        found.push(Found { projector, what: "connector".into(), connected, modes });
    }
    found
}

/// `fb0` and its like.
fn framebuffers(class: &Path) -> Vec<Found> {
    let mut found = Vec::new();
    for name in names(class).into_iter().filter(|name| name.starts_with("fb") && name != "fbcon") {
        let folder = class.join(&name);
        let (driver, bits) = (line(&folder.join("name")), line(&folder.join("bits_per_pixel")));
        let modes = vec![line(&folder.join("virtual_size")).replace(',', "x")];
        let what = format!("framebuffer {driver}, {bits} bit");
        found.push(Found { projector: format!("fb:/dev/{name}"), what, connected: None, modes });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connectors_and_framebuffers_are_named_as_they_are_given_back() {
        let root = std::env::temp_dir().join(format!("scotopic-outputs-{}", std::process::id()));
        let write = |path: &str, text: &str| {
            let path = root.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write("drm/version", "drm 1.1.0\n");
        write("drm/card1/dev", "226:1\n");
        write("drm/card1-HDMI-A-2/status", "connected\n");
        write("drm/card1-HDMI-A-2/modes", "1280x720\n1280x720\n640x480\u{1b}[31m\n");
        write("drm/card1-DPI-1/status", "disconnected\n");
        write("graphics/fb0/name", "vc4drmfb\n");
        write("graphics/fb0/virtual_size", "1280,720\n");
        write("graphics/fb0/bits_per_pixel", "16\n");
        write("graphics/fbcon/rotate", "0\n");
        let (connectors, framebuffers) = (connectors(&root.join("drm")), framebuffers(&root.join("graphics")));
        fs::remove_dir_all(&root).unwrap();
        let names: Vec<&str> = connectors.iter().chain(&framebuffers).map(|found| found.projector.as_str()).collect();
        assert_eq!(names, ["kms:card1/DPI-1", "kms:card1/HDMI-A-2", "fb:/dev/fb0"]);
        assert_eq!(connectors[1].modes, ["1280x720", "640x480[31m"]);
        assert_eq!((connectors[0].connected, connectors[1].connected), (Some(false), Some(true)));
        assert_eq!(framebuffers[0].what, "framebuffer vc4drmfb, 16 bit");
        for found in connectors.iter().chain(&framebuffers) {
            assert!(found.projector.parse::<crate::hw::projector::ProjectorAddress>().is_ok());
        }
    }
}
