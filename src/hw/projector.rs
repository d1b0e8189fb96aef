//! The projector: where pictures go. Every sink shows black when it is opened, when it is told to go dark, and when it is
//! dropped, so a picture never outlives the program that put it there.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Instant;

use crate::picture::Picture;
use flip::{Beat, Flipping, SimulatedDisplay};
use kms::plan::{KmsError, Wanted};

/// Two buffers that change places between frames; a simulated display that proves it.
pub mod flip;
/// Pictures into a folder of PNG files.
pub mod folder;
/// The Linux framebuffer device.
pub mod framebuffer;
/// The pure part of the framebuffer: the device's geometry, and pixels into its bytes.
pub mod geometry;
/// The two calls into the kernel that the framebuffer needs.
mod ioctl;
/// A display controller, without a desktop.
pub mod kms;
/// Whether a window stands on the monitor that was named.
pub mod landing;
/// A projector whose LEDs are driven too.
pub mod lit;
/// Pictures kept in memory, for tests and previews.
pub mod memory;
/// A projector in a thread of its own, that shows the latest picture.
pub mod output;
/// Where the canvas lies on the module's own pixels.
pub mod placement;
/// A window on a monitor.
#[cfg(feature = "window")]
pub mod window;

pub use memory::{Memory, Nowhere};
pub use placement::{Flip, Placement, PlacementError, Rotation, Scale};

/// Columns and rows of the canvas that pictures are drawn on, whatever the module's own pixels are.
pub const CANVAS: (usize, usize) = (1024, 768);

/// Something that shows pictures to the eyepiece.
pub trait Projector: Send {
    /// Shows a picture.
    ///
    /// # Errors
    /// The device is gone or refuses: the sentence says what to do.
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError>;

    /// Shows black. Must work at any time, after errors too.
    ///
    /// # Errors
    /// The device is gone or refuses.
    fn dark(&mut self) -> Result<(), ProjectorError>;

    /// Makes the light so much of the fullest that is allowed, 0 to 1. What the device cannot do with its lamp is left to the
    /// pixels: multiply pictures by the answer's `gain`. Without a lamp that can be dimmed that is all of it.
    ///
    /// # Errors
    /// The device is gone or refuses.
    fn dim(&mut self, share: f32) -> Result<Dimmed, ProjectorError> {
        // NaN is 0.
        Ok(Dimmed { gain: if share > 0.0 { share.min(1.0) } else { 0.0 }, advice: None })
    }

    /// What it is, in words for the screen: `framebuffer /dev/fb0, 1024 x 768, 32 bit`.
    fn describe(&self) -> String;
}

/// What came of [`Projector::dim`].
#[derive(Debug, Clone, PartialEq)]
pub struct Dimmed {
    /// What pictures are to be multiplied by, 0 to 1.
    pub gain: f32,
    /// What the observer should do, in words: which filter to insert.
    pub advice: Option<String>,
}

/// Where pictures shall go.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum ProjectorAddress {
    /// Nowhere: no projector.
    #[default]
    None,
    /// A Linux framebuffer device.
    Framebuffer(PathBuf),
    /// A folder that gets PNG files.
    Folder(PathBuf),
    /// A connector of a display controller.
    Kms(Wanted),
    /// A simulated display of 1280 x 720 pixels and 60 Hz, that writes what it saw into a file at its end.
    Simulated(Option<PathBuf>),
    /// A full-screen window, on the monitor of that name when one is given.
    Window(Option<String>),
}

impl FromStr for ProjectorAddress {
    type Err = ProjectorError;

    /// Reads `none`, `kms:CONNECTOR`, `fb:/dev/fb0`, `png:DIR`, `window`, `window:MONITOR`, `sim` or `sim:REPORT`.
    fn from_str(text: &str) -> Result<ProjectorAddress, ProjectorError> {
        match text.split_once(':') {
            _ if text == "none" => Ok(ProjectorAddress::None),
            _ if text == "window" => Ok(ProjectorAddress::Window(None)),
            _ if text == "sim" => Ok(ProjectorAddress::Simulated(None)),
            Some(("kms", wanted)) => Ok(ProjectorAddress::Kms(wanted.parse()?)),
            Some(("sim", path)) if !path.is_empty() => Ok(ProjectorAddress::Simulated(Some(path.into()))),
            Some(("fb", path)) if !path.is_empty() => Ok(ProjectorAddress::Framebuffer(path.into())),
            Some(("png", path)) if !path.is_empty() => Ok(ProjectorAddress::Folder(path.into())),
            Some(("window", name)) if !name.is_empty() => Ok(ProjectorAddress::Window(Some(name.into()))),
            _ => Err(ProjectorError::Address(text.chars().filter(|c| !c.is_control()).take(80).collect())),
        }
    }
}

impl fmt::Display for ProjectorAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProjectorAddress::None => write!(f, "none"),
            ProjectorAddress::Framebuffer(path) => write!(f, "fb:{}", path.display()),
            ProjectorAddress::Folder(path) => write!(f, "png:{}", path.display()),
            ProjectorAddress::Kms(wanted) => write!(f, "kms:{wanted}"),
            ProjectorAddress::Simulated(None) => write!(f, "sim"),
            ProjectorAddress::Simulated(Some(path)) => write!(f, "sim:{}", path.display()),
            ProjectorAddress::Window(None) => write!(f, "window"),
            ProjectorAddress::Window(Some(name)) => write!(f, "window:{name}"),
        }
    }
}

/// Why the projector shows nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProjectorError {
    /// The address was not understood.
    #[error(
        "'{0}' is no projector: give none, kms:CONNECTOR, fb:/dev/fb0, png:FOLDER, window or window:MONITOR, or sim"
    )]
    Address(String),
    /// The display controller cannot be used so.
    #[error(transparent)]
    Kms(#[from] KmsError),
    /// This program was built without display controllers.
    #[error(
        "this scotopic was built without display controllers: build it with `cargo build --release --features kms`, or use fb: or png:"
    )]
    NoKms,
    /// This program was built without windows.
    #[error(
        "this scotopic was built without windows: build it with `cargo build --release --features window`, or use fb: or png:"
    )]
    NoWindows,
    /// The device or folder cannot be opened.
    #[error("the projector {path} cannot be opened: {why}{}", advice(why))]
    Open {
        /// Device or folder.
        path: String,
        /// What the system says.
        why: String,
    },
    /// The device answers, but is nothing that pictures can be written to.
    #[error("the projector {path} cannot show pictures: {why}")]
    Geometry {
        /// The device.
        path: String,
        /// What is wrong with it.
        why: geometry::GeometryError,
    },
    /// The picture cannot be laid on the module so.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// It worked and stopped working.
    #[error("the projector {path} stopped taking pictures: {why}; check its cable and power")]
    Lost {
        /// Device or folder.
        path: String,
        /// What the system says.
        why: String,
    },
    /// Its LEDs are not as they were told.
    #[error("the projector's light: {0}")]
    Light(Box<crate::hw::light::LightError>),
    /// The window is not where it should be.
    #[error(transparent)]
    Astray(#[from] landing::Astray),
    /// No monitor has that name.
    #[error("no monitor is called '{wanted}': there is {}", list(found))]
    NoMonitor {
        /// What was asked for.
        wanted: String,
        /// What there is.
        found: Vec<String>,
    },
}

/// What to do about the commonest refusals of a device.
fn advice(why: &str) -> &'static str {
    if why.contains("ermission denied") {
        "; add yourself to the group `video` and log in again"
    } else if why.contains("No such file") {
        "; list what is there with `ls /dev/fb*`"
    } else {
        ""
    }
}

fn list(found: &[String]) -> String {
    if found.is_empty() { "no monitor at all".into() } else { found.join(", ") }
}

/// Opens a projector and makes it dark. `placement` lays every picture on its pixels.
///
/// # Errors
/// It cannot be opened: the sentence says why and what to do.
pub fn open(address: &ProjectorAddress, placement: Placement) -> Result<Box<dyn Projector>, ProjectorError> {
    Ok(match address {
        ProjectorAddress::None => Box::new(Nowhere),
        ProjectorAddress::Framebuffer(path) => Box::new(framebuffer::Framebuffer::open(path, placement)?),
        #[cfg(feature = "kms")]
        ProjectorAddress::Kms(wanted) => Box::new(kms::controller::open(wanted, placement)?),
        #[cfg(not(feature = "kms"))]
        ProjectorAddress::Kms(_) => return Err(ProjectorError::NoKms),
        ProjectorAddress::Simulated(report) => Box::new(simulated(report.clone(), placement)?),
        ProjectorAddress::Folder(path) => Box::new(folder::Folder::open(path, placement)?),
        #[cfg(feature = "window")]
        ProjectorAddress::Window(monitor) => Box::new(window::Window::open(monitor.as_deref(), placement)?),
        #[cfg(not(feature = "window"))]
        ProjectorAddress::Window(_) => return Err(ProjectorError::NoWindows),
    })
}

/// A display that is not there: its pixels and rate are those of the plainest module that takes HDMI.
fn simulated(report: Option<PathBuf>, placement: Placement) -> Result<Flipping<SimulatedDisplay>, ProjectorError> {
    let display = SimulatedDisplay::new(1280, 720, 60.0, Beat::Real(Instant::now()))
        .map_err(|why| ProjectorError::Geometry { path: "sim".into(), why })?;
    Flipping::new(display.reporting(report), placement)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_written_alike() {
        for text in [
            "none",
            "kms:card1/DPI-1",
            "sim",
            "sim:/tmp/report.json",
            "fb:/dev/fb1",
            "png:/tmp/frames",
            "window",
            "window:HDMI-A-2",
        ] {
            assert_eq!(text.parse::<ProjectorAddress>().unwrap().to_string(), text);
        }
        for wrong in ["", "fb", "fb:", "hdmi", "png:", "window:", "kms", "sim:"] {
            assert!(matches!(wrong.parse::<ProjectorAddress>(), Err(ProjectorError::Address(_))), "{wrong}");
        }
    }

    #[test]
    fn a_device_that_is_not_there_is_a_sentence_with_advice() {
        let Err(error) = open(&ProjectorAddress::Framebuffer("/dev/fb-none".into()), Placement::default()) else {
            panic!("there is no such device")
        };
        assert!(error.to_string().contains("/dev/fb-none") && error.to_string().contains("ls /dev/fb*"), "{error}");
    }
}
