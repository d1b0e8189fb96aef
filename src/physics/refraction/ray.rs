//! The path of light through layered air: what a ray starts from, what comes of it, and the methods that trace it.

use crate::units::Angle;

/// The directions at which the path of a ray changes its kind.
mod critical;
/// Exact quadrature in the invariant.
pub mod exact;
/// Lehn's parabolas.
pub mod lehn;
/// Air at one wavelength around a globe.
pub mod medium;
/// Runge and Kutta's steps with error control.
pub mod runge_kutta;

pub use medium::{Absorber, Medium, MediumError};

/// Where a ray leaves the eye. Light is followed backwards, from the eye towards the Sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Launch {
    /// Altitude at which the eye sees it, measured in the air at the eye.
    pub apparent_altitude: Angle,
    /// Height of the eye above the ground, metres.
    pub height_m: f64,
}

/// How a ray ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Through the top of the air.
    Escaped,
    /// On the ground.
    Ground,
    /// In a duct: bent down above and up below, for ever.
    Trapped,
}

impl Outcome {
    /// One lower-case word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Outcome::Escaped => "escaped",
            Outcome::Ground => "ground",
            Outcome::Trapped => "trapped",
        }
    }
}

/// Optical depths along a ray.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Depths {
    /// By scattering on molecules.
    pub rayleigh: f64,
    /// By the haze.
    pub aerosol: f64,
    /// By ozone.
    pub ozone: f64,
}

/// One passage through a layer. A layer that is gone through twice, down and up again, may come as one passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Lowest height of the passage, metres.
    pub low_m: f64,
    /// Highest height of the passage, metres.
    pub high_m: f64,
    /// Length of the path, metres.
    pub path_m: f64,
    /// By how much the ray was bent.
    pub refraction: Angle,
    /// Optical depths.
    pub depths: Depths,
}

/// What came of a ray. For one that does not escape, the numbers are those up to the ground, or as far as it was followed
/// until it was known to be in a duct.
#[derive(Debug, Clone, PartialEq)]
pub struct Ray {
    /// How it ended.
    pub outcome: Outcome,
    /// Apparent minus true altitude.
    pub refraction: Angle,
    /// The altitude from which the light comes.
    pub true_altitude: Angle,
    /// Geometric length from the eye, metres.
    pub path_length_m: f64,
    /// The lowest height, if the ray turns upwards there, metres.
    pub tangent_height_m: Option<f64>,
    /// Optical depths from the eye.
    pub depths: Depths,
    /// The passages in their order from the eye.
    pub crossings: Vec<Crossing>,
    /// Layers, panels or steps taken.
    pub steps: usize,
    /// How often the index of the air was asked for; zero where it was tabulated before.
    pub evaluations: usize,
    /// The error of the refraction that the method believes it made.
    pub believed_error: Angle,
}

/// Why a ray was not traced.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RayError {
    /// No such direction.
    #[error("apparent altitude {0} degrees: give -90 to 90")]
    Altitude(f64),
    /// The eye must be in the air.
    #[error("observer height {height_m} m: give 0 to less than the top of the air, {top_m} m")]
    Height {
        /// What was asked, metres.
        height_m: f64,
        /// The top, metres.
        top_m: f64,
    },
    /// The method cannot be asked for this.
    #[error("tolerance {0} arcsec: give 1e-9 to 3600")]
    Tolerance(f64),
    /// The layers do not suffice, or are too many.
    #[error("{0} layers: give 2 to 1000000")]
    Layers(usize),
}

/// A way to trace rays.
pub trait Method: Send + Sync {
    /// A short name, as on the command line.
    fn name(&self) -> &'static str;

    /// Gets ready for one medium: whatever does not depend on the ray is computed here. The tolerance is that of the
    /// refraction; a method chooses its steps by it, and says for each ray what error it believes it made.
    ///
    /// # Errors
    /// The method cannot be asked for this tolerance.
    fn prepare<'a>(&self, medium: &'a Medium<'a>, tolerance: Angle) -> Result<Box<dyn Tracer + 'a>, RayError>;
}

/// A method made ready for a medium.
pub trait Tracer: Send + Sync {
    /// Follows one ray.
    ///
    /// # Errors
    /// The ray does not start in the air, or has no direction.
    fn trace(&self, launch: &Launch) -> Result<Ray, RayError>;
}

/// The method of a name: `exact`, `runge-kutta`, `lehn` (the thesis') or `lehn-knots`; for Lehn's with a number of layers,
/// or as many as the tolerance needs.
#[must_use]
pub fn method(name: &str, layers: Option<usize>) -> Option<Box<dyn Method>> {
    Some(match name {
        "exact" => Box::new(exact::Exact),
        "runge-kutta" => Box::new(runge_kutta::RungeKutta),
        "lehn" => Box::new(lehn::Lehn { grid: lehn::Grid::EqualMolecules, layers }),
        "lehn-knots" => Box::new(lehn::Lehn { grid: lehn::Grid::Knots, layers }),
        _ => return None,
    })
}

/// The names that [`method`] knows.
pub const METHODS: [&str; 4] = ["exact", "runge-kutta", "lehn", "lehn-knots"];

/// Whether a tolerance can be asked for; in radians.
fn admitted(tolerance: Angle) -> Result<f64, RayError> {
    let arcsec = tolerance.to_arcseconds();
    if (1e-9..=3600.0).contains(&arcsec) { Ok(tolerance.to_radians()) } else { Err(RayError::Tolerance(arcsec)) }
}

#[cfg(test)]
mod tests;
