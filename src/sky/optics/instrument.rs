//! Telescope, eyepieces and projector together, one eyepiece in use; read from `instrument.toml`.

use serde::{Deserialize, Serialize};

use super::{Calibration, Eyepiece, ProjectorGeometry, Telescope, eyepiece};
use crate::eye::powers::Choice;
use crate::eye::{Viewing, limit};
use crate::units::{Angle, Magnitude, SurfaceBrightness};

/// All that stands between the sky and the eye. The default is the thesis' own.
///
/// Every table and key may be left out; what is left out has the thesis' value.
///
/// ```
/// let text = r#"
///     [telescope]
///     name = "ED 80"
///     aperture_mm = 80.0
///     focal_length_mm = 600.0
///     reflections = 0
///     diagonal = "mirror"
///     mounting = "equatorial"
///
///     [[eyepieces]]
///     focal_length_mm = 25.0
///     apparent_field_deg = 52.0
///     field_stop_mm = 21.2
///
///     [projector]
///     relay_magnification = 1.5
/// "#;
/// let instrument = scotopic::sky::optics::Instrument::from_toml(text)?;
/// assert_eq!(instrument.magnification(), 24.0);
/// # Ok::<(), scotopic::sky::optics::InstrumentError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Instrument {
    /// The telescope.
    pub telescope: Telescope,
    /// The projector in the focal plane.
    pub projector: ProjectorGeometry,
    /// The eyepieces in the case.
    pub eyepieces: Vec<Eyepiece>,
    /// What was measured of how the picture lies on the sky; not in the file, which a person writes.
    #[serde(skip)]
    pub calibration: Calibration,
    /// Which of them is in the holder: an index into `eyepieces`. Private: always inside.
    #[serde(skip)]
    in_use: usize,
}

/// Why an instrument file was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InstrumentError {
    /// Not TOML, or a key that is not known, or a value of the wrong kind: the reader's message names the line.
    #[error("the instrument file cannot be used: {0}")]
    Form(String),
    /// A number that no instrument has.
    #[error("{what} is {value} in the instrument file: give {least} to {most}")]
    OutOfRange {
        /// The table and key.
        what: String,
        /// What was given.
        value: f64,
        /// The least that is taken.
        least: f64,
        /// The most that is taken.
        most: f64,
    },
    /// An empty list.
    #[error("the instrument file has an empty list of eyepieces: add one [[eyepieces]] with its focal_length_mm")]
    NoEyepiece,
}

impl Default for Instrument {
    fn default() -> Instrument {
        Instrument {
            telescope: Telescope::default(),
            projector: ProjectorGeometry::default(),
            eyepieces: eyepiece::of_the_thesis(),
            calibration: Calibration::default(),
            in_use: 0,
        }
    }
}

impl Instrument {
    /// Reads an instrument file.
    ///
    /// # Errors
    /// Says which key or number is wrong, and what would be right.
    pub fn from_toml(text: &str) -> Result<Instrument, InstrumentError> {
        let instrument: Instrument = toml::from_str(text).map_err(|error| InstrumentError::Form(error.to_string()))?;
        instrument.check()?;
        Ok(instrument)
    }

    /// Holds every number against what an instrument can be.
    ///
    /// # Errors
    /// The first number that is out of range.
    pub fn check(&self) -> Result<(), InstrumentError> {
        let (telescope, projector) = (&self.telescope, &self.projector);
        within("telescope.aperture_mm", telescope.aperture_mm, 10.0, 20_000.0)?;
        within("telescope.focal_length_mm", telescope.focal_length_mm, 50.0, 200_000.0)?;
        within("telescope.transmission", telescope.transmission, 0.01, 1.0)?;
        within("projector.width_px", f64::from(projector.width_px), 64.0, 8192.0)?;
        within("projector.height_px", f64::from(projector.height_px), 64.0, 8192.0)?;
        within("projector.pitch_um", projector.pitch_um, 0.5, 1000.0)?;
        within("projector.relay_magnification", projector.relay_magnification, 0.01, 100.0)?;
        within("projector.angle_deg", projector.angle_deg, -360.0, 360.0)?;
        within("projector.splitter_transmission", projector.splitter_transmission, 0.01, 1.0)?;
        if self.eyepieces.is_empty() {
            return Err(InstrumentError::NoEyepiece);
        }
        for (index, eyepiece) in self.eyepieces.iter().enumerate() {
            let key = |name: &str| format!("{name} of eyepiece {}", index + 1);
            within(&key("focal_length_mm"), eyepiece.focal_length_mm, 1.0, 200.0)?;
            within(&key("apparent_field_deg"), eyepiece.apparent_field_deg, 5.0, 150.0)?;
            if let Some(stop) = eyepiece.field_stop_mm {
                within(&key("field_stop_mm"), stop, 0.5, 200.0)?;
            }
        }
        Ok(())
    }

    /// The eyepiece in the holder.
    #[must_use]
    pub fn eyepiece(&self) -> &Eyepiece {
        static NONE: Eyepiece = Eyepiece { focal_length_mm: 32.0, apparent_field_deg: 52.0, field_stop_mm: None };
        self.eyepieces.get(self.in_use).or(self.eyepieces.first()).unwrap_or(&NONE)
    }

    /// Its place in the list.
    #[must_use]
    pub fn eyepiece_index(&self) -> usize {
        self.in_use
    }

    /// Puts the eyepiece of a place in the list into the holder; a place beyond the end changes nothing.
    pub fn use_eyepiece(&mut self, index: usize) {
        if index < self.eyepieces.len() {
            self.in_use = index;
        }
    }

    /// The same instrument with the eyepiece of a focal length in the holder: one from the list (to 0.25 mm), else a plain
    /// Plössl of that focal length, added to the list.
    #[must_use]
    pub fn with_eyepiece(mut self, focal_length_mm: f64) -> Instrument {
        let same = |eyepiece: &Eyepiece| (eyepiece.focal_length_mm - focal_length_mm).abs() <= 0.25;
        self.in_use = self.eyepieces.iter().position(same).unwrap_or_else(|| {
            self.eyepieces.push(Eyepiece::plossl(focal_length_mm));
            self.eyepieces.len() - 1
        });
        self
    }

    /// Magnification with the eyepiece in use.
    #[must_use]
    pub fn magnification(&self) -> f64 {
        self.eyepiece().magnification(&self.telescope)
    }

    /// Diameter of the sky in the eyepiece in use.
    #[must_use]
    pub fn true_field(&self) -> Angle {
        self.eyepiece().true_field(&self.telescope)
    }

    /// Exit pupil with the eyepiece in use, in millimetres.
    #[must_use]
    pub fn exit_pupil_mm(&self) -> f64 {
        self.eyepiece().exit_pupil_mm(&self.telescope)
    }

    /// Sky under one pixel of the projector. The eyepiece magnifies sky and picture alike, so it does not enter.
    #[must_use]
    pub fn pixel_scale(&self) -> Angle {
        self.registration().scale
    }

    /// A typical observer's eye of pupil `pupil_mm` behind the eyepiece in use and the beam splitter.
    #[must_use]
    pub fn viewing(&self, pupil_mm: f64) -> Viewing {
        Viewing {
            transmission: self.telescope.transmission * self.projector.splitter_transmission,
            pupil_mm,
            ..Viewing::typical(self.telescope.aperture_mm, self.magnification())
        }
    }

    /// The eyepieces in the case as the choice of a magnification needs them, in their order.
    #[must_use]
    pub fn choices(&self) -> Vec<Choice> {
        let choice = |eyepiece: &Eyepiece| Choice {
            magnification: eyepiece.magnification(&self.telescope),
            true_field_arcmin: eyepiece.true_field(&self.telescope).to_arcminutes(),
        };
        self.eyepieces.iter().map(choice).collect()
    }

    /// The faintest star through the eyepiece in use, behind the beam splitter.
    #[must_use]
    pub fn limiting_magnitude(&self, pupil_mm: f64, sky: SurfaceBrightness) -> Magnitude {
        limit::through_telescope(&self.viewing(pupil_mm), sky)
    }
}

fn within(what: &str, value: f64, least: f64, most: f64) -> Result<(), InstrumentError> {
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(InstrumentError::OutOfRange { what: what.into(), value, least, most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_file_is_the_thesis_own_instrument() {
        assert_eq!(Instrument::from_toml("").unwrap(), Instrument::default());
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = toml::to_string(&Instrument::default()).unwrap();
        assert_eq!(Instrument::from_toml(&text).unwrap(), Instrument::default());
    }

    #[test]
    fn a_misspelt_key_is_refused_with_its_line_and_the_right_keys() {
        let error = Instrument::from_toml("[telescope]\napertur_mm = 200.0\n").unwrap_err().to_string();
        assert!(error.contains("line 2") && error.contains("apertur_mm") && error.contains("`aperture_mm`"), "{error}");
    }

    #[test]
    fn numbers_that_no_telescope_has_are_refused() {
        for (text, what) in [
            ("[telescope]\naperture_mm = -5.0", "telescope.aperture_mm"),
            ("[telescope]\nfocal_length_mm = nan", "telescope.focal_length_mm"),
            ("[projector]\nrelay_magnification = 0.0", "projector.relay_magnification"),
            ("[[eyepieces]]\nfocal_length_mm = 0.0", "focal_length_mm of eyepiece 1"),
        ] {
            let error = Instrument::from_toml(text).unwrap_err();
            assert!(matches!(&error, InstrumentError::OutOfRange { what: key, .. } if key == what), "{text}: {error}");
        }
        assert_eq!(Instrument::from_toml("eyepieces = []"), Err(InstrumentError::NoEyepiece));
    }

    #[test]
    fn an_eyepiece_that_is_not_in_the_case_is_taken_as_a_plossl() {
        let instrument = Instrument::default().with_eyepiece(20.0);
        assert_eq!(instrument.eyepiece(), &Eyepiece::plossl(20.0));
        assert_eq!(instrument.magnification(), 125.0);
        assert_eq!(Instrument::default().with_eyepiece(24.1).eyepieces.len(), Instrument::default().eyepieces.len());
    }
}
