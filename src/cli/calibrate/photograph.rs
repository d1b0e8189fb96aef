//! A photograph's file as numbers: PNG, JPEG or FITS, of its channels the one that tells most, as the file encodes it.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{ImageReader, Limits};

use crate::cli::Failure;
use crate::overlay::photograph::MOST_BYTES;
use crate::picture::fits::Fits;
use crate::registration::Frame;

/// Memory that decoding may take.
const MOST_MEMORY: u64 = 2 << 30;

/// The longest side that is decoded.
const LONGEST_SIDE: u32 = 16_384;

/// Reads a photograph.
///
/// # Errors
/// The file cannot be read, or it is nothing that a Moon can be found in.
pub(super) fn read(path: &Path) -> Result<Frame, Failure> {
    let wrong = |why: String| Failure::Failed(format!("the photograph {} cannot be used: {why}", path.display()));
    let size = fs::metadata(path).map_err(|error| wrong(error.to_string()))?.len();
    if size > MOST_BYTES {
        return Err(wrong(format!("it has {size} bytes, and at most {MOST_BYTES} are read; save a smaller copy")));
    }
    let bytes = fs::read(path).map_err(|error| wrong(error.to_string()))?;
    let (width, height, channels) =
        if bytes.starts_with(b"SIMPLE") { fits(&bytes) } else { image(&bytes) }.map_err(wrong)?;
    Frame::new(width, height, telling(channels)).map_err(|error| wrong(error.to_string()))
}

/// A number that says which file this is: Fowler, Noll and Vo's hash (FNV-1a, 64 bits) of its bytes.
///
/// # Errors
/// The file cannot be read.
pub(super) fn digest(path: &Path) -> Result<u64, Failure> {
    let bytes = fs::read(path).map_err(Failure::failed)?;
    let mixed = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    Ok(bytes.iter().fold(0xcbf2_9ce4_8422_2325, mixed))
}

/// Columns, rows, and the brightness of each channel.
type Channels = (usize, usize, Vec<Vec<f32>>);

fn image(bytes: &[u8]) -> Result<Channels, String> {
    let broken =
        |error: &dyn std::fmt::Display| format!("it cannot be read as PNG, JPEG or FITS ({error}); save it again");
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| broken(&error))?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LONGEST_SIDE), Some(LONGEST_SIDE));
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    let rgb = reader.decode().map_err(|error| broken(&error))?.into_rgb32f();
    let (width, height) = (rgb.width() as usize, rgb.height() as usize);
    let channel = |c: usize| rgb.as_raw().iter().skip(c).step_by(3).copied().collect();
    Ok((width, height, (0..3).map(channel).collect()))
}

/// FITS values have no white of their own: the brightest thousandth part is taken for it, unless the file's numbers are those of
/// a camera of 16 bits or fewer.
fn fits(bytes: &[u8]) -> Result<Channels, String> {
    let fits = Fits::read(bytes).map_err(|error| error.to_string())?;
    let most =
        fits.planes.iter().flatten().copied().filter(|value| value.is_finite()).fold(f32::MIN_POSITIVE, f32::max);
    let white = [1.0, 255.0, 4095.0, 16_383.0, 65_535.0].into_iter().find(|white| most <= *white).unwrap_or(most);
    let planes = fits.planes.iter().map(|plane| {
        // FITS counts rows from below.
        let rows = plane.chunks_exact(fits.width).rev();
        rows.flatten().map(|value| value / white).collect()
    });
    Ok((fits.width, fits.height, planes.collect()))
}

/// The channels' mean, or a single channel if it has much more contrast: a red picture is best seen in red.
fn telling(channels: Vec<Vec<f32>>) -> Vec<f32> {
    let count = channels.len().max(1) as f32;
    let mean: Vec<f32> = match channels.first() {
        Some(first) if channels.len() > 1 => {
            (0..first.len()).map(|k| channels.iter().map(|channel| channel[k]).sum::<f32>() / count).collect()
        }
        _ => return channels.into_iter().next().unwrap_or_default(),
    };
    let spread = |values: &[f32]| {
        let step = (values.len() / 50_000).max(1);
        let mut some: Vec<f32> = values.iter().step_by(step).copied().collect();
        some.sort_unstable_by(f32::total_cmp);
        some.get(some.len() * 99 / 100).copied().unwrap_or(0.0) - some.get(some.len() / 100).copied().unwrap_or(0.0)
    };
    let best = channels.into_iter().max_by(|a, b| spread(a).total_cmp(&spread(b))).unwrap_or_default();
    if spread(&best) > 1.5 * spread(&mean) { best } else { mean }
}
