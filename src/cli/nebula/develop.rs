//! `scotopic nebula develop`: linear light in a file becomes a picture for people, before a photograph or a field of stars.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use serde_json::json;

use super::developing::{DevelopArguments, Negative};
use crate::cli::{Failure, answer, answer_json};
use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::develop::pixels;
use crate::picture::fits::Fits;
use crate::picture::{npy, png};

/// Longest side of a picture, pixels.
const LONGEST_SIDE: usize = 8192;
/// Larger FITS files are not read into memory.
const LARGEST_FITS: u64 = 1 << 30;

/// The light, and how it is shown.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula develop light.npy --gamma 2.2 --out lifted.png\n  \
    scotopic nebula render V.fits --out light.npy --through through.npy\n  \
    scotopic nebula develop light.npy --through through.npy --background milky-way.jpg --out composite.png\n  \
    scotopic nebula develop light.npy --through through.npy --background stars:3 --out composite.png\n\n\
    The light is as `scotopic nebula render` writes it: .npy ([row, col] or [plane, row, col]) or .fits of 1 or 3 planes. One\n\
    plane is grey, three are red, green and blue. Stars are strewn evenly over the picture; `scotopic nebula fly` has them at\n\
    infinity, where they stay while the eye moves.")]
pub struct Arguments {
    /// Linear light: .npy or .fits
    #[arg(value_name = "LIGHT")]
    light: PathBuf,
    /// Share of the light behind that comes through, as `render --through` writes it [default: all of it]
    #[arg(long, value_name = "FILE")]
    through: Option<PathBuf>,
    #[command(flatten)]
    develop: DevelopArguments,
    /// The PNG file
    #[arg(long, value_name = "FILE.png")]
    out: PathBuf,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Pixels with their sides.
struct Light {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

/// Makes the picture.
///
/// # Errors
/// A file cannot be read or written, or the two have not one size.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Light { width, height, pixels: light } = read(&arguments.light)?;
    let through = match &arguments.through {
        None => vec![[1.0; 3]; light.len()],
        Some(path) => {
            let through = read(path)?;
            if (through.width, through.height) != (width, height) {
                return Err(Failure::asked(format!(
                    "{}: {} x {} pixels, and the light has {width} x {height}: give the file of the same render",
                    path.display(),
                    through.width,
                    through.height
                )));
            }
            through.pixels
        }
    };
    let lens = Lens::Orthographic { width: 2.0 };
    let camera = Camera::looking(DVec3::Z, DVec3::ZERO, DVec3::Y, lens).ok_or_else(|| Failure::failed("no camera"))?;
    let darkroom = arguments.develop.open()?;
    let white = darkroom.white(&light);
    let negative = Negative { width, height, camera: &camera, light: &light, through: &through };
    let codes = darkroom.develop(&negative, white)?;
    let bytes = png::encode_codes(width, height, &codes).map_err(Failure::failed)?;
    std::fs::write(&arguments.out, bytes)
        .map_err(|error| Failure::failed(format!("{}: {error}", arguments.out.display())))?;
    if arguments.json {
        return answer_json(
            &json!({ "out": arguments.out.display().to_string(), "width": width, "height": height, "white": white }),
        );
    }
    answer(&format!("{}: {width} x {height} pixels, white is a radiance of {white:.4e}", arguments.out.display()))
}

fn read(path: &Path) -> Result<Light, Failure> {
    let asked = |error: &dyn std::fmt::Display| Failure::asked(format!("{}: {error}", path.display()));
    let file = File::open(path).map_err(|error| asked(&error))?;
    let length = file.metadata().map_err(|error| asked(&error))?.len();
    let mut file = BufReader::new(file);
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let (width, height, planes) = match ending.as_str() {
        "npy" => {
            let array = npy::read(&mut file, length).map_err(|error| asked(&error))?;
            let (planes, height, width) = match *array.shape {
                [height, width] => (1, height, width),
                [planes, height, width] => (planes, height, width),
                _ => return Err(asked(&"it is no picture: give [row, col] or [plane, row, col]")),
            };
            let planes = array.values.chunks_exact(array.values.len() / planes).map(<[f32]>::to_vec).collect();
            (width, height, planes)
        }
        "fits" | "fit" | "fts" => {
            if length > LARGEST_FITS {
                return Err(asked(&format!("{length} bytes are too many for a picture")));
            }
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).map_err(|error| asked(&error))?;
            let fits = Fits::read(&bytes).map_err(|error| asked(&error))?;
            // The first row of a FITS image is its lowest.
            let upright = |plane: &Vec<f32>| plane.chunks_exact(fits.width).rev().flatten().copied().collect();
            (fits.width, fits.height, fits.planes.iter().map(upright).collect())
        }
        _ => return Err(asked(&"light is read from .npy and .fits")),
    };
    if width.max(height) > LONGEST_SIDE {
        return Err(asked(&format!("{width} x {height} pixels: at most {LONGEST_SIDE} a side are shown")));
    }
    let planes: Vec<Vec<f32>> = planes;
    Ok(Light { width, height, pixels: pixels(&planes) })
}
