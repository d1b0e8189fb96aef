//! Reading animations from the bytes of files: frames of PNG, or one animated PNG, with a TOML file beside them. Everything
//! that a file claims is bounded before memory is asked for.

use std::io::Cursor;

use glam::{DMat2, DVec2};
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, ImageDecoder, ImageReader, Limits, RgbaImage};
use serde::Deserialize;

use super::{Animation, Frame, Playable};
use crate::overlay::photograph::Plate;
use crate::sky::catalogue::Catalogue;
use crate::units::Angle;

/// Largest file that is read.
pub const MOST_BYTES: u64 = 64 << 20;
/// Most frames: forty seconds at twenty-five a second.
pub const MOST_FRAMES: usize = 1000;
/// Longest side of a frame that is kept: more is averaged away, since an eyepiece's circle is hardly larger.
const KEPT_SIDE: usize = 512;
/// Longest side that is read.
const LONGEST_SIDE: u32 = 4096;
/// Memory that all frames of an animation may take.
const MOST_MEMORY: usize = 256 << 20;
/// Frames a second when nothing is said.
const USUAL_SPEED: f64 = 12.0;

/// Why an animation is not played.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AnimationError {
    /// A frame that is no PNG, or a broken one.
    #[error("{which} cannot be read as PNG: {why}; make it again")]
    Frame {
        /// Which frame.
        which: String,
        /// What is wrong with it.
        why: String,
    },
    /// A frame of another size than the first.
    #[error("{which} has {width} x {height} pixels and the first frame another size: make them all alike")]
    Size {
        /// Which frame.
        which: String,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Nothing to play.
    #[error("it has no frame: put PNG files into its folder, named in their order")]
    Empty,
    /// Too much.
    #[error("it has more than {frames} frames, or more than 256 MiB of them: leave some out, or make them smaller")]
    Large {
        /// Most frames.
        frames: usize,
    },
    /// A wrong TOML file beside it.
    #[error("the TOML file beside it cannot be used: {0}")]
    Beside(String),
}

/// The TOML file beside an animation.
///
/// ```toml
/// object = "M57"
/// scale_arcsec_px = 0.4
/// angle_deg = 0.0            # position angle of the picture's top, from north through east; 0 if left out
/// flipped = false            # true when east is right of north
/// frames_per_second = 12.0   # 0.2 to 30
/// # ra_deg, dec_deg          # of the picture's middle (J2000), if that is not the object
/// credit = "A. Animator"
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Beside {
    object: String,
    scale_arcsec_px: f64,
    ra_deg: Option<f64>,
    dec_deg: Option<f64>,
    #[serde(default)]
    angle_deg: f64,
    #[serde(default)]
    flipped: bool,
    frames_per_second: Option<f64>,
    credit: Option<String>,
}

impl Animation {
    /// An animation from single PNG frames, each with its name, and the text of the TOML file beside their folder.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn from_frames<E: std::fmt::Display>(
        name: &str,
        frames: impl IntoIterator<Item = (String, Result<Vec<u8>, E>)>,
        beside: &str,
    ) -> Result<Animation, AnimationError> {
        let mut film = Film::default();
        for (which, bytes) in frames {
            let bytes = bytes.map_err(|why| frame_error(&which, &why))?;
            film.add(&which, &still(&bytes).map_err(|why| frame_error(&which, &why))?)?;
        }
        film.finished(name, beside, None)
    }

    /// An animation from an animated PNG and the text of the TOML file beside it.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn from_apng(name: &str, bytes: &[u8], beside: &str) -> Result<Animation, AnimationError> {
        let refused = |why: &dyn std::fmt::Display| frame_error("it", why);
        let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits()).map_err(|error| refused(&error))?;
        checked(decoder.dimensions()).map_err(|why| refused(&why))?;
        let animated = decoder.is_apng().map_err(|error| refused(&error))?;
        if !animated {
            return Err(refused(&"it is a single picture, not an animated PNG"));
        }
        let mut film = Film::default();
        let mut first_delay = None;
        for (index, frame) in decoder.apng().map_err(|error| refused(&error))?.into_frames().enumerate() {
            let which = format!("frame {index}");
            let frame = frame.map_err(|error| frame_error(&which, &error))?;
            let (numerator, denominator) = frame.delay().numer_denom_ms();
            first_delay.get_or_insert(f64::from(numerator) / f64::from(denominator.max(1)));
            film.add(&which, frame.buffer())?;
        }
        let speed = first_delay.filter(|ms| *ms > 0.0).map(|ms| 1000.0 / ms);
        film.finished(name, beside, speed)
    }
}

/// Frames as they are gathered.
#[derive(Default)]
struct Film {
    /// Columns and rows as read, and how many pixels a side became one.
    size: Option<(usize, usize, usize)>,
    width: usize,
    frames: Vec<Frame>,
}

impl Film {
    fn add(&mut self, which: &str, frame: &RgbaImage) -> Result<(), AnimationError> {
        let (width, height) = (frame.width() as usize, frame.height() as usize);
        let (own_width, own_height, factor) =
            *self.size.get_or_insert((width, height, width.max(height).div_ceil(KEPT_SIDE)));
        if (own_width, own_height) != (width, height) {
            return Err(AnimationError::Size { which: which.to_owned(), width, height });
        }
        let (w, h) = ((width / factor).max(1), (height / factor).max(1));
        if self.frames.len() >= MOST_FRAMES || (self.frames.len() + 1) * w * h * 3 > MOST_MEMORY {
            return Err(AnimationError::Large { frames: MOST_FRAMES });
        }
        self.width = w;
        self.frames.push(averaged(frame, w, h, factor));
        Ok(())
    }

    fn finished(self, name: &str, beside: &str, speed: Option<f64>) -> Result<Animation, AnimationError> {
        let wrong = |what: String| AnimationError::Beside(what);
        let beside: Beside = toml::from_str(beside).map_err(|error| wrong(error.to_string()))?;
        let (width, height, factor) = self.size.ok_or(AnimationError::Empty)?;
        let object = Catalogue::embedded().search(&beside.object).map_err(|error| wrong(error.to_string()))?;
        let speed = beside.frames_per_second.or(speed.map(|speed| speed.clamp(0.2, 30.0))).unwrap_or(USUAL_SPEED);
        if !(0.2..=30.0).contains(&speed) {
            return Err(wrong(format!("frames_per_second is {speed}: give 0.2 to 30")));
        }
        for (key, value, least, most) in [
            ("ra_deg", beside.ra_deg.unwrap_or(0.0), 0.0, 360.0),
            ("dec_deg", beside.dec_deg.unwrap_or(0.0), -90.0, 90.0),
            ("angle_deg", beside.angle_deg, -360.0, 360.0),
        ] {
            if !(least..=most).contains(&value) {
                return Err(wrong(format!("{key} is {value}: give {least} to {most}")));
            }
        }
        let centre = match (beside.ra_deg, beside.dec_deg) {
            (None, None) => object.astrometry.position,
            (Some(ra), Some(dec)) => crate::sky::coords::Equatorial::new(Angle::degrees(ra), Angle::degrees(dec)),
            _ => return Err(wrong("it has only one of ra_deg and dec_deg: give both, or neither".into())),
        };
        let plate = Plate::of_picture(
            centre,
            (width as f64, height as f64),
            beside.scale_arcsec_px,
            beside.angle_deg,
            beside.flipped,
        )
        .map_err(|error| wrong(error.to_string()))?;
        let shrink = factor as f64;
        Ok(Animation {
            playable: Playable { object: object.name, frames: self.frames.len(), frames_per_second: speed },
            name: name.chars().filter(|c| !c.is_control()).take(120).collect(),
            credit: beside.credit.map(|credit| credit.chars().filter(|c| !c.is_control()).take(120).collect()),
            plate: Plate {
                reference: DVec2::new(plate.reference.x / shrink, plate.reference.y / shrink),
                matrix: plate.matrix * DMat2::from_diagonal(DVec2::splat(shrink)),
                ..plate
            },
            width: self.width,
            frames: self.frames,
        })
    }
}

fn frame_error(which: &str, why: &dyn std::fmt::Display) -> AnimationError {
    let why = why.to_string().chars().filter(|c| !c.is_control()).take(200).collect();
    AnimationError::Frame { which: which.to_owned(), why }
}

fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(LONGEST_SIDE);
    limits.max_image_height = Some(LONGEST_SIDE);
    limits.max_alloc = Some(256 << 20);
    limits
}

fn checked((width, height): (u32, u32)) -> Result<(), String> {
    if width.max(height) <= LONGEST_SIDE && width.min(height) > 0 {
        Ok(())
    } else {
        Err(format!("it claims {width} x {height} pixels: at most {LONGEST_SIDE} a side are read"))
    }
}

/// A single PNG.
fn still(bytes: &[u8]) -> Result<RgbaImage, String> {
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("it has {} bytes: at most {MOST_BYTES} are read", bytes.len()));
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), image::ImageFormat::Png);
    reader.limits(limits());
    reader.decode().map(|image| image.into_rgba8()).map_err(|error| error.to_string())
}

/// Each kept pixel is the mean of `factor` x `factor`; what is transparent is black.
fn averaged(frame: &RgbaImage, width: usize, height: usize, factor: usize) -> Frame {
    let (across, down) = (factor.min(frame.width() as usize), factor.min(frame.height() as usize));
    let count = (across * down) as u32;
    let mut kept = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0u32; 3];
            for (i, j) in (0..across).flat_map(|i| (0..down).map(move |j| (i, j))) {
                let [r, g, b, alpha] = frame.get_pixel((x * factor + i) as u32, (y * factor + j) as u32).0;
                for (sum, channel) in sum.iter_mut().zip([r, g, b]) {
                    *sum += u32::from(channel) * u32::from(alpha) / 255;
                }
            }
            kept.push(sum.map(|sum| (sum / count) as u8));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{Picture, png};
    use std::time::Duration;

    const BESIDE: &str = "object = \"ring nebula\"\nscale_arcsec_px = 2.0\nframes_per_second = 4.0\n";

    /// A frame with one lit pixel.
    fn frame(width: usize, height: usize, lit: usize) -> Vec<u8> {
        let mut picture = Picture::black(width, height);
        picture.row_mut(0)[lit] = [1.0; 3];
        png::encode(&picture).unwrap()
    }

    fn read(frames: &[Vec<u8>], beside: &str) -> Result<Animation, AnimationError> {
        let named = frames.iter().enumerate().map(|(i, bytes)| (format!("{i:04}.png"), Ok::<_, String>(bytes.clone())));
        Animation::from_frames("ring", named, beside)
    }

    #[test]
    fn frames_are_played_in_their_order_at_their_speed_at_the_objects_place() {
        let animation = read(&[frame(8, 4, 0), frame(8, 4, 5)], BESIDE).unwrap();
        let playable = &animation.playable;
        assert_eq!((playable.object.as_str(), playable.frames), ("M57", 2));
        let due: Vec<usize> = (0..4).map(|n| playable.frame_at(Duration::from_millis(250 * n + 1))).collect();
        assert_eq!(due, [0, 1, 0, 1]);
        assert_eq!(playable.until_next(Duration::from_millis(100)), Duration::from_millis(150));
        let m57 = Catalogue::embedded().search("M57").unwrap();
        let second = animation.frame(1).unwrap();
        assert!(second.plate.position(4.0, 2.0).separation(&m57.astrometry.position).to_arcseconds() < 1e-3);
        assert_ne!(animation.frame(0), animation.frame(1));
        assert_eq!(animation.frame(9), animation.frame(1), "beyond the end is the last");
    }

    #[test]
    fn large_frames_are_made_smaller_and_keep_their_place() {
        let animation = read(&[frame(1024, 600, 3)], BESIDE).unwrap();
        assert_eq!((animation.width, animation.frames[0].len()), (512, 512 * 300));
        let m57 = Catalogue::embedded().search("M57").unwrap().astrometry.position;
        let kept = animation.frame(0).unwrap();
        assert!(kept.plate.position(256.0, 150.0).separation(&m57).to_arcseconds() < 1e-3);
        let corner = kept.plate.position(0.0, 0.0).separation(&m57).to_arcseconds();
        assert!((corner - 2.0 * 512f64.hypot(300.0)).abs() < 1.0, "{corner}");
    }

    #[test]
    fn an_animated_png_is_read_and_a_still_one_refused() {
        let bytes = include_bytes!("../../../fixtures/animation/three.apng");
        let animation = Animation::from_apng("three", bytes, "object = \"M42\"\nscale_arcsec_px = 5.0\n").unwrap();
        assert_eq!(animation.playable, Playable { object: "M42".into(), frames: 3, frames_per_second: 5.0 });
        let reds: Vec<u8> = animation.frames.iter().map(|frame| frame[5][0]).collect();
        assert_eq!(reds, [60, 120, 240]);
        let error = Animation::from_apng("still", &frame(8, 4, 0), BESIDE).unwrap_err();
        assert!(error.to_string().contains("single picture"), "{error}");
    }

    #[test]
    fn what_cannot_be_played_is_a_sentence() {
        let two_sizes = read(&[frame(8, 4, 0), frame(9, 4, 0)], BESIDE).unwrap_err();
        assert!(matches!(two_sizes, AnimationError::Size { width: 9, .. }), "{two_sizes}");
        assert_eq!(read(&[], BESIDE), Err(AnimationError::Empty));
        assert!(matches!(read(&[vec![1, 2, 3]], BESIDE), Err(AnimationError::Frame { .. })));
        for (beside, word) in [
            ("object = \"M57\"", "scale_arcsec_px"),
            ("object = \"nothing so called\"\nscale_arcsec_px = 1.0", "nothing so called"),
            ("object = \"M57\"\nscale_arcsec_px = -1.0", "-1"),
            ("object = \"M57\"\nscale_arcsec_px = 1.0\nframes_per_second = 1000", "0.2 to 30"),
            ("object = \"M57\"\nscale_arcsec_px = 1.0\nra_deg = 3", "only one of"),
        ] {
            let error = read(&[frame(8, 4, 0)], beside).unwrap_err().to_string();
            assert!(error.contains(word), "{beside}: {error}");
        }
    }
}
