//! How far an object stands above the threshold of the eye at the eyepiece.

use std::f64::consts::FRAC_PI_4;
use std::fmt;
use std::str::FromStr;

use super::crumey::{self, Range};
use super::{Viewing, blackwell};
use crate::units::{Magnitude, SurfaceBrightness};

/// An object as the models take it: an ellipse of even brightness with sharp edges. Galaxies and globular clusters are not:
/// their cores are seen long before the whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Total V magnitude.
    pub v_mag: f64,
    /// Full major axis in arcminutes.
    pub major_arcmin: f64,
    /// Full minor axis in arcminutes.
    pub minor_arcmin: f64,
}

impl Patch {
    /// Mean surface brightness.
    #[must_use]
    pub fn surface_brightness(&self) -> SurfaceBrightness {
        SurfaceBrightness::of_ellipse(Magnitude(self.v_mag), self.major_arcmin, self.minor_arcmin)
    }

    /// Common logarithm of the object's own light over the sky's.
    ///
    /// ```text
    /// lg C = -0.4 (SB - mu)
    /// ```
    ///
    /// Weber contrast. It changes neither with magnification nor behind a beam splitter, which dim both alike.
    #[must_use]
    pub fn log10_contrast(&self, sky: SurfaceBrightness) -> f64 {
        log10_contrast(self.surface_brightness(), sky)
    }
}

/// Common logarithm of a surface's own light over the sky's: [`Patch::log10_contrast`].
#[must_use]
pub fn log10_contrast(surface: SurfaceBrightness, sky: SurfaceBrightness) -> f64 {
    -0.4 * (surface.0 - sky.0)
}

/// Whose threshold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Model {
    /// Crumey (2014): the model, with this eye and this instrument.
    #[default]
    Crumey,
    /// Blackwell's table as Clark and "ODM" use it: the second opinion, in the form in which other programs give it.
    Blackwell,
}

impl Model {
    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Model::Crumey => "crumey",
            Model::Blackwell => "blackwell",
        }
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Model {
    type Err = String;

    fn from_str(text: &str) -> Result<Model, String> {
        let named = [Model::Crumey, Model::Blackwell].into_iter().find(|model| model.name() == text);
        named.ok_or_else(|| String::from("a model is crumey or blackwell"))
    }
}

/// What a reserve means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Below the threshold.
    NotVisible,
    /// At the threshold: it depends on the observer.
    Questionable,
    /// Above it, for who knows where to look.
    Difficult,
    /// Seen after a while.
    QuiteDifficult,
    /// Seen at once.
    Easy,
    /// Obvious.
    VeryEasy,
}

impl Verdict {
    /// In words: those of DeepskyLog.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Verdict::NotVisible => "not visible",
            Verdict::Questionable => "questionable",
            Verdict::Difficult => "difficult",
            Verdict::QuiteDifficult => "quite difficult",
            Verdict::Easy => "easy",
            Verdict::VeryEasy => "very easy",
        }
    }

    /// The verdict on a reserve.
    ///
    /// For the table of Blackwell, DeepskyLog's classes. Crumey's reserve has the observer in it already, so its lower bounds
    /// are where a good observer (F = 1.4) and a poor one (2.4) begin to see what the typical one (2) does at 0; the upper
    /// ones are DeepskyLog's. The two scales are not interchangeable: for one sight they differ by about 0.45.
    #[must_use]
    pub fn of(model: Model, reserve: f64) -> Verdict {
        let (unseen, doubtful) = match model {
            Model::Blackwell => (-0.2, 0.1),
            Model::Crumey => (-0.155, 0.08),
        };
        if reserve < unseen {
            Verdict::NotVisible
        } else if reserve < doubtful {
            Verdict::Questionable
        } else if reserve < 0.35 {
            Verdict::Difficult
        } else if reserve < 0.5 {
            Verdict::QuiteDifficult
        } else if reserve < 1.0 {
            Verdict::Easy
        } else {
            Verdict::VeryEasy
        }
    }
}

/// An object at the eyepiece held against a model's threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Whose threshold.
    pub model: Model,
    /// Common logarithm of the contrast.
    pub log10_contrast: f64,
    /// Common logarithm of the threshold contrast.
    pub log10_threshold: f64,
    /// The sky at the eye as this model counts it.
    pub background: SurfaceBrightness,
    /// Whether size or background lay outside what the model was measured for, so that its edge was taken.
    pub clamped: bool,
}

impl Reading {
    /// Reads an object under a sky at an eyepiece.
    ///
    /// ```text
    /// Crumey:    A = pi/4 a b M^2, B_a = T min(1, d/p)^2 B             this instrument, eye and observer
    /// Blackwell: theta = M b, mu_eye = mu + 5 lg(M / (2.833 D/25.4))    the smaller axis; ODM's own eye
    /// ```
    ///
    /// ODM's 2.833 for each inch stands for a pupil of 7.5 mm and a transmission of 0.7, whatever the observer's own, and its
    /// table has no observer's factor: so the number is the one that other programs print. Checked against 124 values for eleven
    /// objects, three skies and five powers: within 3e-4 dex.
    #[must_use]
    pub fn of(object: &Patch, viewing: &Viewing, sky: SurfaceBrightness, model: Model) -> Reading {
        let log10_contrast = object.log10_contrast(sky);
        let power = viewing.magnification;
        match model {
            Model::Crumey => {
                let side = |arcmin: f64| (arcmin / 60.0).to_radians() * power;
                let area = FRAC_PI_4 * side(object.major_arcmin) * side(object.minor_arcmin);
                let background = viewing.background_cd_m2(sky);
                let log10_threshold = crumey::log10_threshold(area, background, viewing.field_factor, Range::All);
                let clamped = background < crumey::DARKEST_CD_M2;
                Reading { model, log10_contrast, log10_threshold, background: viewing.background(sky), clamped }
            }
            Model::Blackwell => {
                let dimming = 5.0 * (power / (2.833 * viewing.aperture_mm / 25.4)).log10();
                // An exit pupil wider than ODM's 7.5 mm makes nothing brighter: only its transmission is lost.
                let background = SurfaceBrightness(sky.0 + dimming.max(-2.5 * 0.7f64.log10()));
                let threshold = blackwell::threshold(power * object.minor_arcmin, background.0);
                let (log10_threshold, clamped) = (threshold.log10, threshold.clamped);
                Reading { model, log10_contrast, log10_threshold, background, clamped }
            }
        }
    }

    /// Powers of ten between the contrast and its threshold: above 0 it is seen.
    #[must_use]
    pub fn reserve(&self) -> f64 {
        self.log10_contrast - self.log10_threshold
    }

    /// What that means.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        Verdict::of(self.model, self.reserve())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn viewing(magnification: f64) -> Viewing {
        Viewing { transmission: 0.7, field_factor: 2.0 * crumey::ONE_EYE, ..Viewing::typical(254.0, magnification) }
    }

    #[test]
    fn reserves_of_eleven_objects_are_those_of_an_independent_implementation() {
        let text = include_str!("../../fixtures/reference/eye/odm_check.csv");
        let mut compared = 0;
        for row in text.lines().skip(1) {
            let cells: Vec<f64> = row.split(',').skip(1).map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
            let [v_mag, major_arcmin, minor_arcmin, _, sky, power, background, contrast, blackwell, ..] = cells[..]
            else {
                panic!()
            };
            let (object, sky) = (Patch { v_mag, major_arcmin, minor_arcmin }, SurfaceBrightness(sky));
            let table = Reading::of(&object, &viewing(power), sky, Model::Blackwell);
            assert!((table.log10_contrast - contrast).abs() < 6e-5, "{row}");
            assert!((table.background.0 - background).abs() < 6e-4, "{row}: {table:?}");
            assert!((table.log10_threshold - blackwell).abs() < 3e-4, "{row}: {table:?}");
            let crumey = Reading::of(&object, &viewing(power), sky, Model::Crumey);
            assert!((crumey.log10_threshold - cells[11]).abs() < 1.1e-4, "{row}: {crumey:?}");
            assert!((crumey.reserve() - cells[12]).abs() < 1.6e-4, "{row}: {crumey:?}");
            compared += 1;
        }
        assert!(compared > 120, "{compared}");
    }

    #[test]
    fn the_second_opinion_is_never_extended_beyond_its_table() {
        let m31 = Patch { v_mag: 3.4, major_arcmin: 190.0, minor_arcmin: 60.0 };
        let reading = Reading::of(&m31, &viewing(500.0), SurfaceBrightness(21.5), Model::Blackwell);
        assert!(reading.clamped && (reading.log10_threshold + 0.121).abs() < 1e-9, "{reading:?}");
    }

    #[test]
    fn the_classes_are_in_their_order_and_in_deepskylogs_words() {
        let words: Vec<&str> =
            [-1.0, 0.0, 0.2, 0.4, 0.7, 2.0].map(|reserve| Verdict::of(Model::Blackwell, reserve).words()).to_vec();
        assert_eq!(words, ["not visible", "questionable", "difficult", "quite difficult", "easy", "very easy"]);
        assert_eq!(Verdict::of(Model::Crumey, -0.18), Verdict::NotVisible);
        assert_eq!(Verdict::of(Model::Blackwell, -0.18), Verdict::Questionable);
    }
}
