//! What is lit and by what: the dust's properties in each band, and the stars.

use glam::DVec3;

use super::phase::HenyeyGreenstein;

/// Most bands of a scene.
pub const MOST_BANDS: usize = 64;
/// Most stars of a scene.
pub const MOST_STARS: usize = 64;

/// Extinction relative to V in the thesis' three bands, red first: `A_R/A_V`, 1, `A_B/A_V` (Binney and Merrifield 1998).
pub const RED_GREEN_BLUE: [f64; 3] = [0.748, 1.0, 1.324];

/// A scene that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// Albedo outside 0 to 1.
    #[error("an albedo of {0}: it is a share from 0 (black) to 1 (white)")]
    Albedo(f64),
    /// Asymmetry outside -1 to 1.
    #[error("an asymmetry of {0}: it is a mean cosine from -1 to 1")]
    Asymmetry(f64),
    /// Extinction that is no extinction.
    #[error("an extinction of {0}: it is per unit of length and density, a number of 0 or more")]
    Extinction(f64),
    /// None or too many.
    #[error("{0} bands: a scene has 1 to 64")]
    Bands(usize),
    /// Too many.
    #[error("{0} stars: a scene has at most 64")]
    Stars(usize),
    /// A star that is nowhere, or has no light for each band.
    #[error("star {number}: {what}")]
    Star {
        /// Counted from 1.
        number: usize,
        /// What is wrong, and what to do.
        what: &'static str,
    },
}

/// The dust, the same grains everywhere; their number varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Dust {
    /// Extinction per unit of length at density 1, one number a band. f64: optical depths of 1e-6 and 1e3 are both asked for.
    pub extinction: Vec<f64>,
    /// Share of the extinction that is scattering.
    pub albedo: f64,
    /// How it turns light aside.
    pub phase: HenyeyGreenstein,
}

/// A star: a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Star {
    /// Where, in the volume's unit of length from the centre of its box.
    pub position: DVec3,
    /// Radiant intensity in each band, per steradian.
    pub intensity: Vec<f64>,
}

/// Dust and stars.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    dust: Dust,
    stars: Vec<Star>,
}

impl Scene {
    /// A scene.
    ///
    /// # Errors
    /// What cannot be, with its value.
    pub fn new(dust: Dust, stars: Vec<Star>) -> Result<Scene, SceneError> {
        let bands = dust.extinction.len();
        if !(1..=MOST_BANDS).contains(&bands) {
            return Err(SceneError::Bands(bands));
        }
        if let Some(wrong) = dust.extinction.iter().find(|e| !(e.is_finite() && **e >= 0.0)) {
            return Err(SceneError::Extinction(*wrong));
        }
        if !(0.0..=1.0).contains(&dust.albedo) {
            return Err(SceneError::Albedo(dust.albedo));
        }
        if stars.len() > MOST_STARS {
            return Err(SceneError::Stars(stars.len()));
        }
        for (star, number) in stars.iter().zip(1..) {
            let what = if !star.position.is_finite() {
                "its place is not a number: give three, such as 0,0,0.5"
            } else if star.intensity.len() != bands {
                "it needs one intensity for each band"
            } else if star.intensity.iter().any(|i| !(i.is_finite() && *i >= 0.0)) {
                "its intensity is a number of 0 or more in each band"
            } else {
                continue;
            };
            return Err(SceneError::Star { number, what });
        }
        Ok(Scene { dust, stars })
    }

    /// The dust.
    #[must_use]
    pub fn dust(&self) -> &Dust {
        &self.dust
    }

    /// The stars.
    #[must_use]
    pub fn stars(&self) -> &[Star] {
        &self.stars
    }

    /// How many bands.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.dust.extinction.len()
    }
}
