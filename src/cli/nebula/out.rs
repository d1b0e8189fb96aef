//! Pictures of a nebula in files: linear light, or codes for a display.

use std::path::Path;

use crate::cli::Failure;
use crate::physics::dust::develop::{self, Development};
use crate::picture::{exr, fits, npy, png};

/// How a picture for a display looks.
#[derive(Debug, Clone, Copy, Default)]
pub struct Look {
    /// The light that is shown as full; found in the picture if nothing is said.
    pub white: Option<f64>,
    /// Instead of sRGB's curve.
    pub gamma: Option<f64>,
}

fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// Checks the ending of a file that will be written, before time is spent on the picture.
///
/// # Errors
/// An ending that no kind of file has.
pub fn check_ending(path: &Path) -> Result<(), Failure> {
    match ending(path).as_str() {
        "npy" | "fits" | "fit" | "exr" | "png" => Ok(()),
        _ => Err(Failure::asked(format!(
            "{}: pictures are written as .npy, .fits, .exr and .png: give it one of these endings",
            path.display()
        ))),
    }
}

/// Writes planes, row 0 on top.
///
/// # Errors
/// An unknown ending, or the disk's error with the file's name.
pub fn save(path: &Path, width: usize, planes: &[Vec<f32>], look: &Look) -> Result<(), Failure> {
    check_ending(path)?;
    let failed = |error: &dyn std::fmt::Display| Failure::failed(format!("{}: {error}", path.display()));
    let height = planes.first().map_or(0, |plane| plane.len() / width.max(1));
    let bytes = match ending(path).as_str() {
        "npy" => {
            let shape = [planes.len(), height, width];
            let shape = if planes.len() == 1 { &shape[1..] } else { &shape[..] };
            let mut bytes = Vec::with_capacity(128 + planes.len() * height * width * 4);
            npy::write(&mut bytes, shape, &planes.concat()).map_err(|error| failed(&error))?;
            bytes
        }
        "exr" => exr::planes(width, planes).map_err(|error| failed(&error))?,
        "png" => {
            let pixels = develop::pixels(planes);
            let white = look.white.unwrap_or_else(|| develop::white_of(&pixels));
            let development = Development::new(white, look.gamma).map_err(Failure::asked)?;
            let codes: Vec<[u8; 3]> = pixels.iter().map(|pixel| development.codes(*pixel)).collect();
            png::encode_codes(width, height, &codes).map_err(|error| failed(&error))?
        }
        _ => fits::write::planes(width, planes, &[("BUNIT", fits::write::Value::Text("intensity / length^2"))]),
    };
    std::fs::write(path, bytes).map_err(|error| failed(&error))
}
