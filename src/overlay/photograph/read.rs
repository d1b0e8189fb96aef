//! Reading photographs from the bytes of files: FITS with its astrometric cards, PNG and JPEG with a TOML file beside them.
//! Everything a file claims is bounded before memory is asked for.

use std::io::Cursor;

use glam::{DMat2, DVec2};
use image::{ImageReader, Limits};
use serde::Deserialize;

use super::{Photograph, Plate, wcs};
use crate::picture::fits::{Fits, FitsError, LONGEST_SIDE};
use crate::picture::{Picture, srgb};
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// Largest file that is read.
pub const MOST_BYTES: u64 = 64 << 20;
/// Memory that decoding may take.
const MOST_MEMORY: u64 = 512 << 20;
/// Pixels kept: more are averaged away, since the canvas has fewer than a million.
const MOST_KEPT: usize = 4 << 20;

/// Why a photograph is not drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PhotographError {
    /// Too large a file.
    #[error("it has {0} bytes: at most 67108864 are read; save a smaller copy")]
    Bytes(u64),
    /// Too long a side.
    #[error("it claims {width} x {height} pixels: at most 8192 a side are read; save a smaller copy")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// Not a PNG or JPEG, or a broken one.
    #[error("it cannot be read as PNG or JPEG: {0}; fetch it again")]
    Image(String),
    /// A broken FITS file.
    #[error("it cannot be read as FITS: {0}")]
    Fits(#[from] FitsError),
    /// A FITS file without a place on the sky.
    #[error(
        "its header has no {0}, so nobody knows where on the sky it is: solve it first, for instance at nova.astrometry.net"
    )]
    NoWcs(&'static str),
    /// A FITS file in another projection or frame.
    #[error("its {key} is '{there}': only {wanted} is understood")]
    Projection {
        /// The card.
        key: &'static str,
        /// Its value.
        there: String,
        /// What would be understood.
        wanted: &'static str,
    },
    /// A scale that no photograph has.
    #[error("its scale is {0} arcseconds a pixel: 0.001 to 10000 are believed")]
    Scale(f64),
    /// Corners that lie on a line, or half a sky apart.
    #[error("its corners on the sky enclose no area, or half the sky: correct them")]
    Corners,
    /// A wrong TOML file beside it.
    #[error("the TOML file beside it cannot be used: {0}")]
    Beside(String),
}

/// The TOML file beside a PNG or JPEG.
///
/// ```toml
/// ra_deg = 10.6847        # J2000, of the picture's middle
/// dec_deg = 41.2690
/// scale_arcsec_px = 1.8
/// angle_deg = 12.0        # position angle of the picture's top, from north through east; 0 if left out
/// flipped = false         # true when east is right of north
/// credit = "A. Observer"
/// licence = "CC-BY-4.0"
/// object = "M31"          # of which it is; if left out, what fills it
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Beside {
    ra_deg: f64,
    dec_deg: f64,
    scale_arcsec_px: f64,
    #[serde(default)]
    angle_deg: f64,
    #[serde(default)]
    flipped: bool,
    #[serde(default)]
    credit: Option<String>,
    #[serde(default)]
    licence: Option<String>,
    #[serde(default)]
    object: Option<String>,
}

impl Photograph {
    /// A FITS image with its place in its header.
    ///
    /// # Errors
    /// What is wrong with the file, and what to do.
    pub fn from_fits(name: &str, bytes: &[u8]) -> Result<Photograph, PhotographError> {
        check_bytes(bytes)?;
        let fits = Fits::read(bytes)?;
        let mut plate = wcs::plate(&fits)?;
        let stretch = Stretch::of(&fits);
        let plane = |c: usize| &fits.planes[c.min(fits.planes.len() - 1)];
        let factor = reduction(fits.width, fits.height);
        let picture = averaged(fits.width, fits.height, factor, |x, y| {
            [0, 1, 2].map(|c| stretch.light(plane(c)[y * fits.width + x]))
        });
        reduce_plate(&mut plate, factor);
        let credit = fits.text("OBSERVER").or(fits.text("AUTHOR")).map(clean).filter(|credit| !credit.is_empty());
        Ok(Photograph::new(clean(name), credit, plate, picture))
    }

    /// A PNG or JPEG with the text of the TOML file beside it.
    ///
    /// # Errors
    /// What is wrong with either file, and what to do.
    pub fn from_image(name: &str, bytes: &[u8], beside: &str) -> Result<Photograph, PhotographError> {
        check_bytes(bytes)?;
        let beside: Beside = toml::from_str(beside).map_err(|error| PhotographError::Beside(error.to_string()))?;
        let picture = decode(bytes)?;
        let (width, height, factor) = (picture.width(), picture.height(), picture.factor);
        let mut plate = beside.plate(width as f64, height as f64)?;
        reduce_plate(&mut plate, factor);
        let mut photograph = Photograph::new(clean(name), beside.credit.as_deref().map(clean), plate, picture.picture);
        photograph.licence = beside.licence.as_deref().map(clean);
        photograph.object = beside.object.as_deref().map(clean);
        Ok(photograph)
    }
}

impl Beside {
    fn plate(&self, width: f64, height: f64) -> Result<Plate, PhotographError> {
        for (key, value, least, most) in [
            ("ra_deg", self.ra_deg, 0.0, 360.0),
            ("dec_deg", self.dec_deg, -90.0, 90.0),
            ("angle_deg", self.angle_deg, -360.0, 360.0),
        ] {
            if !(least..=most).contains(&value) {
                return Err(PhotographError::Beside(format!("{key} is {value}: give {least} to {most}")));
            }
        }
        let centre = Equatorial::new(Angle::degrees(self.ra_deg), Angle::degrees(self.dec_deg));
        Plate::of_picture(centre, (width, height), self.scale_arcsec_px, self.angle_deg, self.flipped)
    }
}

impl Plate {
    /// The plate of a picture of so many columns and rows, of which the middle's place, the scale and the position angle of
    /// its top (from north through east) are known.
    ///
    /// # Errors
    /// A scale that no picture has.
    pub(in crate::overlay) fn of_picture(
        centre: Equatorial<J2000>,
        (width, height): (f64, f64),
        scale_arcsec_px: f64,
        angle_deg: f64,
        flipped: bool,
    ) -> Result<Plate, PhotographError> {
        if !(1e-3..=1e4).contains(&scale_arcsec_px) {
            return Err(PhotographError::Scale(scale_arcsec_px));
        }
        let scale = Angle::arcseconds(scale_arcsec_px).to_radians();
        let up = Angle::degrees(angle_deg);
        let right = up + Angle::degrees(if flipped { 90.0 } else { -90.0 });
        Ok(Plate {
            centre,
            reference: DVec2::new(width, height) / 2.0,
            // Rows run downwards.
            matrix: DMat2::from_cols(DVec2::new(right.sin(), right.cos()), -DVec2::new(up.sin(), up.cos())) * scale,
        })
    }
}

/// The picture of a PNG or JPEG file, without a place on the sky.
///
/// # Errors
/// What is wrong with the file, and what to do.
pub fn picture(bytes: &[u8]) -> Result<Picture, PhotographError> {
    check_bytes(bytes)?;
    decode(bytes).map(|decoded| decoded.picture)
}

fn check_bytes(bytes: &[u8]) -> Result<(), PhotographError> {
    if bytes.len() as u64 > MOST_BYTES { Err(PhotographError::Bytes(bytes.len() as u64)) } else { Ok(()) }
}

/// Text from a file, without what could move a cursor.
pub(super) fn clean(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(120).collect::<String>().trim().to_owned()
}

/// A decoded picture, perhaps averaged, with the size it had.
struct Decoded {
    picture: Picture,
    full: (usize, usize),
    factor: usize,
}

impl Decoded {
    fn width(&self) -> usize {
        self.full.0
    }
    fn height(&self) -> usize {
        self.full.1
    }
}

fn decode(bytes: &[u8]) -> Result<Decoded, PhotographError> {
    let unreadable = |error: &dyn std::fmt::Display| PhotographError::Image(error.to_string());
    let reader = |()| ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| unreadable(&error));
    let (width, height) = reader(())?.into_dimensions().map_err(|error| unreadable(&error))?;
    if width.max(height) as usize > LONGEST_SIDE || width.min(height) == 0 {
        return Err(PhotographError::Size { width, height });
    }
    let mut reader = reader(())?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LONGEST_SIDE as u32);
    limits.max_image_height = Some(LONGEST_SIDE as u32);
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| unreadable(&error))?.into_rgb8();
    let (width, height) = (width as usize, height as usize);
    let factor = reduction(width, height);
    let picture = averaged(width, height, factor, |x, y| image.get_pixel(x as u32, y as u32).0.map(srgb::from_byte));
    Ok(Decoded { picture, full: (width, height), factor })
}

/// How many pixels a side become one.
fn reduction(width: usize, height: usize) -> usize {
    let mut factor = 1;
    while (width / factor) * (height / factor) > MOST_KEPT {
        factor *= 2;
    }
    factor
}

/// A picture of which each pixel is the mean of `factor` x `factor`; what is left over at the edges is left out.
fn averaged(width: usize, height: usize, factor: usize, light: impl Fn(usize, usize) -> [f32; 3]) -> Picture {
    let (w, h) = ((width / factor).max(1), (height / factor).max(1));
    let (across, down) = (factor.min(width), factor.min(height));
    let share = 1.0 / (across * down) as f32;
    let mut picture = Picture::black(w, h);
    for y in 0..h {
        for (x, pixel) in picture.row_mut(y).iter_mut().enumerate() {
            for (i, j) in (0..across).flat_map(|i| (0..down).map(move |j| (i, j))) {
                let own = light(x * factor + i, y * factor + j);
                pixel.iter_mut().zip(own).for_each(|(sum, own)| *sum += own * share);
            }
        }
    }
    picture
}

/// The plate of a picture that was averaged.
fn reduce_plate(plate: &mut Plate, factor: usize) {
    plate.reference /= factor as f64;
    plate.matrix *= factor as f64;
}

/// From a camera's numbers to light between 0 and 1: the sky's background black, faint parts lifted.
///
/// ```text
/// L = asinh(a t) / asinh(a),   t = (v - low) / (high - low),   a = 10
/// ```
///
/// The form of Lupton et al. (2004), PASP 116, 133; low is the 20th percentile (background), high the 99.7th.
struct Stretch {
    low: f32,
    span: f32,
}

impl Stretch {
    fn of(fits: &Fits) -> Stretch {
        let all = fits.planes.len() * fits.width * fits.height;
        let every = (all / 65_536).max(1);
        let mut values: Vec<f32> =
            fits.planes.iter().flatten().step_by(every).copied().filter(|value| value.is_finite()).collect();
        values.sort_by(f32::total_cmp);
        let at = |share: f64| values.get((values.len() as f64 * share) as usize).copied().unwrap_or(0.0);
        let (low, high) = (at(0.2), at(0.997));
        // A flat picture, or one with a few bright dots only: take the brightest.
        let high = if high > low { high } else { values.last().copied().unwrap_or(1.0) };
        Stretch { low, span: if high > low { high - low } else { 1.0 } }
    }

    fn light(&self, value: f32) -> f32 {
        let t = ((value - self.low) / self.span).clamp(0.0, 1.0);
        let light = (10.0 * t).asinh() / 10f32.asinh();
        if light.is_finite() { light } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::png;

    const BESIDE: &str = "ra_deg = 10.0\ndec_deg = 40.0\nscale_arcsec_px = 2.0\n";

    fn grey(width: usize, height: usize) -> Vec<u8> {
        png::encode(&Picture::black(width, height)).unwrap()
    }

    /// Where a place in a photograph of 100 x 60 pixels is, in arcseconds east and north of its middle.
    fn offset(beside: &str, x: f64, y: f64) -> (i64, i64) {
        let photograph = Photograph::from_image("test", &grey(100, 60), beside).unwrap();
        let plane = photograph.plate.matrix * (DVec2::new(x, y) - photograph.plate.reference);
        let arcsec = |radians: f64| (radians.to_degrees() * 3600.0).round() as i64;
        (arcsec(plane.x), arcsec(plane.y))
    }

    #[test]
    fn the_file_beside_says_which_way_up() {
        assert_eq!(offset(BESIDE, 50.0, 30.0), (0, 0));
        assert_eq!(offset(BESIDE, 50.0, 20.0), (0, 20), "its top is north");
        assert_eq!(offset(BESIDE, 40.0, 30.0), (20, 0), "its left is east");
        let turned = format!("{BESIDE}angle_deg = 90.0\n");
        assert_eq!(offset(&turned, 50.0, 20.0), (20, 0), "its top is east");
        assert_eq!(offset(&turned, 40.0, 30.0), (0, -20), "its left is south");
        let flipped = format!("{BESIDE}flipped = true\n");
        assert_eq!(offset(&flipped, 50.0, 20.0), (0, 20));
        assert_eq!(offset(&flipped, 40.0, 30.0), (-20, 0), "its left is west");
    }

    #[test]
    fn bad_photographs_are_sentences() {
        let cut = &grey(100, 60)[..60];
        let error = Photograph::from_image("cut", cut, BESIDE).unwrap_err();
        assert!(matches!(error, PhotographError::Image(_)), "{error}");

        // The same file with 100000 pixels a side in its header, its checksum mended.
        let mut wide = grey(100, 60);
        wide[16..24].copy_from_slice(&[0, 1, 0x86, 0xA0, 0, 1, 0x86, 0xA0]);
        let checksum = crc32(&wide[12..29]).to_be_bytes();
        wide[29..33].copy_from_slice(&checksum);
        let error = Photograph::from_image("wide", &wide, BESIDE).unwrap_err();
        assert_eq!(error, PhotographError::Size { width: 100_000, height: 100_000 });

        for beside in ["ra_deg = 10.0", "ra_deg = 400.0\ndec_deg = 0.0\nscale_arcsec_px = 1.0", "ra = 1"] {
            let error = Photograph::from_image("beside", &grey(4, 4), beside).unwrap_err();
            assert!(matches!(error, PhotographError::Beside(_)), "{error}");
        }
        assert!(matches!(Photograph::from_fits("none", b"SIMPLE"), Err(PhotographError::Fits(FitsError::NotFits))));
    }

    /// CRC-32 of PNG's chunks (ISO 3309).
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 })
        })
    }

    #[test]
    fn nan_pixels_are_black_and_the_brightest_are_white() {
        let mut values: Vec<f32> = (0..1000u16).map(f32::from).collect();
        values.extend([f32::NAN, f32::INFINITY]);
        let mut text = String::new();
        for card in ["SIMPLE  = T", "BITPIX  = -32", "NAXIS   = 2", "NAXIS1  = 501", "NAXIS2  = 2", "END"] {
            text += &format!("{card:<80}");
        }
        let mut bytes = text.into_bytes();
        bytes.resize(2880, b' ');
        bytes.extend(values.iter().flat_map(|value| value.to_be_bytes()));
        let fits = Fits::read(&bytes).unwrap();
        let stretch = Stretch::of(&fits);
        assert_eq!((stretch.light(f32::NAN), stretch.light(100.0)), (0.0, 0.0));
        assert!((stretch.light(999.0) - 1.0).abs() < 1e-6 && stretch.light(f32::INFINITY) == 1.0);
        assert!(stretch.light(400.0) < stretch.light(500.0));
    }
}
