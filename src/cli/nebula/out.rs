//! Pictures of a nebula in files: linear light, or codes for a display.

use std::path::Path;

use clap::ValueEnum;

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

/// Kinds of files for pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Codes for a display
    Png,
    /// Linear light, OpenEXR
    Exr,
    /// Linear light, FITS
    Fits,
    /// Linear light, NumPy: [row, col] or [plane, row, col], f32
    Npy,
}

impl Format {
    /// By the ending of a file's name.
    ///
    /// # Errors
    /// An ending that no kind of file has.
    pub fn of(path: &Path) -> Result<Format, Failure> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "png" => Ok(Format::Png),
            "exr" => Ok(Format::Exr),
            "fits" | "fit" => Ok(Format::Fits),
            "npy" => Ok(Format::Npy),
            _ => Err(Failure::asked(format!(
                "{}: pictures are written as .npy, .fits, .exr and .png: give it one of these endings",
                path.display()
            ))),
        }
    }

    /// What its files' names end with.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Format::Png => "png",
            Format::Exr => "exr",
            Format::Fits => "fits",
            Format::Npy => "npy",
        }
    }

    /// The bytes of a file with these planes, row 0 on top.
    ///
    /// # Errors
    /// A white or a gamma that cannot be, or a picture that this kind of file cannot hold.
    pub fn encode(self, width: usize, planes: &[Vec<f32>], look: &Look) -> Result<Vec<u8>, Failure> {
        let height = planes.first().map_or(0, |plane| plane.len() / width.max(1));
        match self {
            Format::Npy => {
                let shape = [planes.len(), height, width];
                let shape = if planes.len() == 1 { &shape[1..] } else { &shape[..] };
                let mut bytes = Vec::with_capacity(128 + planes.len() * height * width * 4);
                npy::write(&mut bytes, shape, &planes.concat()).map_err(Failure::failed)?;
                Ok(bytes)
            }
            Format::Exr => exr::planes(width, planes).map_err(Failure::failed),
            Format::Png => {
                let pixels = develop::pixels(planes);
                let white = look.white.unwrap_or_else(|| develop::white_of(&pixels));
                let development = Development::new(white, look.gamma).map_err(Failure::asked)?;
                let codes: Vec<[u8; 3]> = pixels.iter().map(|pixel| development.codes(*pixel)).collect();
                png::encode_codes(width, height, &codes).map_err(Failure::failed)
            }
            Format::Fits => {
                let unit = [("BUNIT", fits::write::Value::Text("intensity / length^2"))];
                Ok(fits::write::planes(width, planes, &unit))
            }
        }
    }
}

/// Writes planes, row 0 on top, as the ending says.
///
/// # Errors
/// An unknown ending, or what is wrong with the file's name.
pub fn save(path: &Path, width: usize, planes: &[Vec<f32>], look: &Look) -> Result<(), Failure> {
    let bytes = Format::of(path)?.encode(width, planes, look).map_err(|error| match error {
        Failure::Failed(what) => Failure::failed(format!("{}: {what}", path.display())),
        asked @ Failure::Asked(_) => asked,
    })?;
    std::fs::write(path, bytes).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))
}
