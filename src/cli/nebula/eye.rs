//! Where the eye stands and what it sees, as flags and scene files say it.

use clap::{Args, ValueEnum};
use glam::DVec3;

use super::scene::Document;
use super::triple::Place;
use crate::cli::Failure;
use crate::cli::sun::picture::Size;
use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::render::{MOST_BYTES, View};
use crate::physics::dust::volume::Volume;

/// How directions are laid on the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Parallel rays
    Orthographic,
    /// A pinhole
    Perspective,
    /// Equidistant fisheye, for domes
    Domemaster,
}

/// The eye and the frame.
#[derive(Debug, Clone, Default, Args)]
pub struct EyeArguments {
    /// How directions are laid on the picture [default: orthographic]
    #[arg(long, value_name = "KIND")]
    pub view: Option<Kind>,
    /// Sides of the picture, pixels: one number, or WIDTHxHEIGHT [default: 512]
    #[arg(long, value_name = "N|WxH")]
    pub size: Option<Size>,
    /// Where the eye is [default: on +z, outside the box; for a domemaster half way to the face]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub eye: Option<Place>,
    /// What it looks at [default: 0,0,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub look_at: Option<Place>,
    /// What is up [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub up: Option<Place>,
    /// Full angle, degrees: horizontally, or across a domemaster's circle [default: 40, or 180]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub fov_deg: Option<f64>,
    /// Width of an orthographic picture [default: the box's edge along x]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub width: Option<f64>,
    /// What is nearer to the eye than this is not seen [default: 0]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub near: Option<f64>,
}

/// Refuses a picture that takes more memory than any should.
///
/// # Errors
/// Its size, what it takes, and what to do.
pub fn bounded(view: &View, bands: usize) -> Result<(), Failure> {
    let bytes = view.bytes(bands);
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
    Err(Failure::asked(format!(
        "{} x {} pixels in {bands} bands take {:.1} GiB of memory, and {:.0} GiB are the most: ask for fewer pixels, or for some bands at a time",
        view.width,
        view.height,
        gib(bytes),
        gib(MOST_BYTES)
    )))
}

impl EyeArguments {
    /// Puts flags and scene file together.
    ///
    /// # Errors
    /// What cannot be, with its value.
    pub fn view(&self, said: &Document, volume: &Volume) -> Result<View, Failure> {
        let kind = match (self.view, &said.view) {
            (Some(kind), _) => kind,
            (None, Some(name)) => Kind::from_str(name, false).map_err(|_unknown| {
                Failure::asked(format!("view = '{name}': there are orthographic, perspective and domemaster"))
            })?,
            (None, None) => Kind::Orthographic,
        };
        let size = match (self.size, &said.size) {
            (Some(size), _) => size,
            (None, Some(text)) => text.parse().map_err(|error| Failure::asked(format!("size = {error}")))?,
            (None, None) => Size { width: 512, height: 512 },
        };
        let longest = volume.edges().max_element();
        let place = |flag: Option<Place>, said: Option<[f64; 3]>| {
            flag.map(|place| place.0).or(said.map(DVec3::from_array)).filter(|place| place.is_finite())
        };
        let usual = match kind {
            Kind::Orthographic => 2.0,
            Kind::Perspective => 1.75,
            Kind::Domemaster => 0.25,
        };
        let eye = place(self.eye, said.eye).unwrap_or(DVec3::Z * usual * longest);
        let at = place(self.look_at, said.look_at).unwrap_or(if eye == DVec3::ZERO { -DVec3::Z } else { DVec3::ZERO });
        let up = place(self.up, said.up).unwrap_or(DVec3::Y);
        let degrees = self.fov_deg.or(said.fov_deg);
        let field = |usual: f64, most: f64, open: bool| {
            let degrees = degrees.unwrap_or(usual);
            match degrees > 0.0 && (degrees < most || !open && degrees == most) {
                true => Ok(degrees.to_radians()),
                false => Err(Failure::asked(format!(
                    "a field of {degrees} degrees: above 0, and {} {most} for this view",
                    if open { "below" } else { "at most" }
                ))),
            }
        };
        let lens = match kind {
            Kind::Orthographic => Lens::Orthographic { width: self.width.or(said.width).unwrap_or(volume.edges().x) },
            Kind::Perspective => Lens::Perspective { field: field(40.0, 180.0, true)? },
            Kind::Domemaster => Lens::Domemaster { field: field(180.0, 360.0, false)? },
        };
        let near = self.near.or(said.near).unwrap_or(0.0);
        if !(near >= 0.0 && near.is_finite()) {
            return Err(Failure::asked(format!("a near plane at {near}: it is a distance of 0 or more from the eye")));
        }
        let camera = Camera::looking(eye, at, up, lens).ok_or_else(|| {
            Failure::asked(format!(
                "an eye at {},{},{} that looks at {},{},{} gives no picture: these are two places, and --width is above 0",
                eye.x, eye.y, eye.z, at.x, at.y, at.z
            ))
        })?;
        Ok(View { camera, width: size.width, height: size.height, near })
    }
}
