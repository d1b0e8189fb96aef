//! A sphere of even dust: what passes it, in closed form, and photons followed through it one by one (thesis, appendix A).

use super::phase::HenyeyGreenstein;

/// The share of light that passes untouched, in closed form.
pub mod closed;
/// Photons followed one by one.
pub mod photons;
/// One photon's way.
pub mod walk;

/// Where the light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Source {
    /// Parallel light from outside, even over the sphere's disc.
    Beam,
    /// A thin ray from outside along a diameter: the thesis' way.
    Pencil,
    /// A star in the centre, alike in all directions.
    Centre,
    /// All of the sphere glows evenly, alike in all directions.
    Uniform,
}

impl Source {
    /// All of them, as the command line names them.
    pub const ALL: [(Source, &'static str); 4] =
        [(Source::Beam, "beam"), (Source::Pencil, "pencil"), (Source::Centre, "centre"), (Source::Uniform, "uniform")];

    /// Its word on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        Source::ALL.iter().find(|(source, _)| *source == self).map_or("", |(_, name)| name)
    }

    /// Mean way through a sphere of radius 1 as far as nothing scatters: what the thin sphere's scattering is proportional to.
    #[must_use]
    pub fn mean_chord(self) -> f64 {
        match self {
            Source::Beam => 4.0 / 3.0,
            Source::Pencil => 2.0,
            Source::Centre => 1.0,
            Source::Uniform => 0.75,
        }
    }
}

impl std::str::FromStr for Source {
    type Err = String;

    fn from_str(word: &str) -> Result<Source, String> {
        let found = Source::ALL.iter().find(|(_, name)| *name == word);
        found
            .map(|(source, _)| *source)
            .ok_or_else(|| format!("'{word}' is no source: give beam, pencil, centre or uniform"))
    }
}

/// Thickest sphere that is asked for. A photon in its middle scatters half its square times.
pub const THICKEST: f64 = 1e4;

/// A sphere that cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SphereError {
    /// A depth that is no depth.
    #[error("a depth of {0}: it is the optical depth of extinction along a radius, 0 to 10000")]
    Depth(f64),
    /// Albedo outside 0 to 1.
    #[error("an albedo of {0}: it is a share from 0 (black) to 1 (white)")]
    Albedo(f64),
    /// Asymmetry outside -1 to 1.
    #[error("an asymmetry of {0}: it is a mean cosine from -1 to 1")]
    Asymmetry(f64),
    /// A threshold that would lose light.
    #[error("a threshold of {0}: photons may be given up at a weight of at most 1e-10, and above 0")]
    Threshold(f64),
    /// Nobody to follow.
    #[error("no photons: give at least 1")]
    Photons,
}

/// A sphere of even dust and its light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Optical depth of extinction along a radius.
    pub depth: f64,
    /// Share of the extinction that is scattering.
    pub albedo: f64,
    /// How the dust turns light aside.
    pub phase: HenyeyGreenstein,
    /// Where the light comes from.
    pub source: Source,
}

impl Sphere {
    /// A sphere.
    ///
    /// # Errors
    /// What cannot be, with its value.
    pub fn new(depth: f64, albedo: f64, asymmetry: f64, source: Source) -> Result<Sphere, SphereError> {
        if !(0.0..=THICKEST).contains(&depth) {
            return Err(SphereError::Depth(depth));
        }
        if !(0.0..=1.0).contains(&albedo) {
            return Err(SphereError::Albedo(albedo));
        }
        let phase = HenyeyGreenstein::new(asymmetry).ok_or(SphereError::Asymmetry(asymmetry))?;
        Ok(Sphere { depth, albedo, phase, source })
    }

    /// The share of the light that leaves without having met a grain.
    #[must_use]
    pub fn unscattered(&self) -> f64 {
        closed::unscattered(self.source, self.depth)
    }
}
