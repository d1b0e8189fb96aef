//! Instrument and observer on the command line: an eyepiece of the instrument's, or numbers in its place.

use std::path::PathBuf;

use clap::Args;

use crate::cli::Failure;
use crate::cli::overlay::{instrument, within};
use crate::cli::settings::Settings;
use crate::eye::Viewing;
use crate::eye::viewing::CRUMEY_TRANSMISSION;
use crate::units::SurfaceBrightness;

/// The flags of `eye contrast` and `eye limit`.
#[derive(Debug, Args)]
pub struct Given {
    /// Focal length of the eyepiece: one of the instrument's, or any [default: the instrument's first]
    #[arg(long, value_name = "MM", conflicts_with = "magnification", allow_hyphen_values = true)]
    pub eyepiece: Option<f64>,
    /// Brightness of the sky's background, V magnitudes per square arcsecond [default: the settings', else 20.8]
    #[arg(long, value_name = "MAG", allow_hyphen_values = true)]
    pub sky: Option<f64>,
    /// Telescope and eyepieces [default: the settings', else those of the thesis]
    #[arg(long, value_name = "FILE")]
    pub instrument: Option<PathBuf>,
    /// Clear aperture in millimetres, in place of the instrument's
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub aperture_mm: Option<f64>,
    /// Magnification, in place of an eyepiece
    #[arg(long, value_name = "TIMES", allow_hyphen_values = true)]
    pub magnification: Option<f64>,
    /// Diameter of the eye's pupil in the dark, millimetres: 7 when young, 6.2 at fifty, 5.5 at seventy [default: the settings', else 7]
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub pupil_mm: Option<f64>,
    /// Share of the light that reaches the eye [default: the telescope's; with --aperture-mm 1/1.33 = 0.752, as Crumey]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub transmission: Option<f64>,
}

impl Given {
    /// Instrument and eye as given, with the observer's whole factor.
    ///
    /// # Errors
    /// A number out of its range, or an instrument file that cannot be used.
    pub(super) fn viewing(&self, settings: &Settings, field_factor: f64) -> Result<Viewing, Failure> {
        let file = self.instrument.as_deref().or(settings.instrument.as_deref());
        let instrument = instrument(file, self.eyepiece)?;
        let transmission = match (self.transmission, self.aperture_mm) {
            (Some(share), _) => within("--transmission", share, 0.001, 1.0)?,
            (None, Some(_)) => CRUMEY_TRANSMISSION,
            (None, None) => instrument.telescope.transmission,
        };
        let aperture_mm = self.aperture_mm.unwrap_or(instrument.telescope.aperture_mm);
        let magnification = self.magnification.unwrap_or_else(|| instrument.magnification());
        Ok(Viewing {
            aperture_mm: within("--aperture-mm", aperture_mm, 1.0, 100_000.0)?,
            magnification: within("--magnification", magnification, 0.1, 100_000.0)?,
            transmission,
            pupil_mm: within("--pupil-mm", self.pupil_mm.unwrap_or(settings.pupil_mm), 0.5, 10.0)?,
            field_factor: within("--field-factor", field_factor, 0.1, 1000.0)?,
        })
    }

    /// The sky as given.
    ///
    /// # Errors
    /// Brighter than the Sun's disc or darker than any sky.
    pub(super) fn sky(&self, settings: &Settings) -> Result<SurfaceBrightness, Failure> {
        let mag = self.sky.unwrap_or(settings.sky_brightness_mag_arcsec2);
        within("--sky", mag, 4.0, 25.0).map(SurfaceBrightness)
    }
}
