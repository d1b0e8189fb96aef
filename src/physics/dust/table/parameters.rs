//! What a scattering table is of, and how good it is to be.

use std::f64::consts::PI;

use super::RADIUS;
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::sphere::{Source, THICKEST};

/// Most rows of a table.
pub const MOST_DEPTHS: usize = 100_000;
/// Most directions of a table.
pub const MOST_DIRECTIONS: usize = 3600;

/// How the directions of a table are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Spacing {
    /// Equal in the cosine, from -1 to 1: the thesis' way, and equal in solid angle.
    Cosine,
    /// Equal in the angle, from 0 to pi.
    Angle,
}

/// Along which length of the voxel the depth of a row is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Length {
    /// An edge of the voxel, as the thesis has it: the sphere's radius is 0.62035 of it.
    Edge,
    /// The diameter of the sphere.
    Diameter,
}

/// What the depth of a row counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Depth {
    /// Extinction; flights are drawn from it.
    Extinction,
    /// Scattering, as on the thesis' axis; flights are drawn from the extinction, depth / albedo.
    Scattering,
    /// Scattering, and flights are drawn from it as appendix A prints it, though each scattering takes (1 - albedo) too.
    Printed,
}

/// What a table is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// Share of the extinction that is scattering.
    pub albedo: f64,
    /// How the dust turns light aside.
    pub phase: HenyeyGreenstein,
    /// Depth of the last row; the first is 0.
    pub deepest: f64,
    /// Rows, evenly spaced.
    pub depths: usize,
    /// Bins of direction.
    pub directions: usize,
    /// How these are spaced.
    pub spacing: Spacing,
    /// Pencil (the thesis) or beam.
    pub source: Source,
    /// Along what a row's depth is counted.
    pub length: Length,
    /// What a row's depth counts.
    pub depth: Depth,
}

/// A table that cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Albedo outside 0 to 1.
    #[error("an albedo of {0}: it is a share from 0 (black) to 1 (white)")]
    Albedo(f64),
    /// Rows to nowhere.
    #[error("a last depth of {0}: it is above 0, and at most 10000 along a radius")]
    Deepest(f64),
    /// Too few or too many rows.
    #[error("{0} depths: a table has 2 to 100000")]
    Depths(usize),
    /// Too few or too many directions.
    #[error("{0} directions: a table has 2 to 3600")]
    Directions(usize),
    /// More numbers than are kept.
    #[error("{0} depths x {1} directions: a table has at most 10 million numbers")]
    Large(usize, usize),
    /// Scattering depth of dust that does not scatter.
    #[error("rows of scattering depth need an albedo above 0: count depths as extinction")]
    Black,
    /// A voxel is lit from outside.
    #[error("a voxel is lit from outside: its source is pencil or beam")]
    Source,
    /// An error that cannot be reached.
    #[error("a relative error of {0}: give 1e-4 to 1, such as 0.01")]
    Accuracy(f64),
    /// Nobody to follow.
    #[error("no photons: give at least 64")]
    Photons,
}

impl Parameters {
    /// The thesis' table: albedo and g 0.6, 1000 depths from 0 to 10, 72 directions, with depths counted as extinction along an edge.
    #[must_use]
    pub fn thesis() -> Option<Parameters> {
        Some(Parameters {
            albedo: 0.6,
            phase: HenyeyGreenstein::new(0.6)?,
            deepest: 10.0,
            depths: 1000,
            directions: 72,
            spacing: Spacing::Cosine,
            source: Source::Pencil,
            length: Length::Edge,
            depth: Depth::Extinction,
        })
    }

    /// Whether such a table can be made.
    ///
    /// # Errors
    /// What cannot be, with its value.
    pub fn checked(&self) -> Result<(), TableError> {
        if !(0.0..=1.0).contains(&self.albedo) {
            return Err(TableError::Albedo(self.albedo));
        }
        if self.depth == Depth::Scattering && self.albedo == 0.0 {
            return Err(TableError::Black);
        }
        if !(2..=MOST_DEPTHS).contains(&self.depths) {
            return Err(TableError::Depths(self.depths));
        }
        if !(2..=MOST_DIRECTIONS).contains(&self.directions) {
            return Err(TableError::Directions(self.directions));
        }
        if self.depths * self.directions > 10_000_000 {
            return Err(TableError::Large(self.depths, self.directions));
        }
        if !matches!(self.source, Source::Pencil | Source::Beam) {
            return Err(TableError::Source);
        }
        let thickest = self.radius_depth(self.depths - 1);
        if !(self.deepest > 0.0 && thickest > 0.0 && thickest <= THICKEST) {
            return Err(TableError::Deepest(self.deepest));
        }
        Ok(())
    }

    /// The depth of a row, as the table counts it.
    #[must_use]
    pub fn row(&self, index: usize) -> f64 {
        self.deepest * index as f64 / (self.depths - 1) as f64
    }

    /// The depth along the sphere's radius from which a row's flights are drawn.
    #[must_use]
    pub fn radius_depth(&self, index: usize) -> f64 {
        let along = if self.depth == Depth::Scattering { 1.0 / self.albedo } else { 1.0 };
        self.row(index) * along * self.radius()
    }

    /// The sphere's radius in the length along which depths are counted.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match self.length {
            Length::Edge => RADIUS,
            Length::Diameter => 0.5,
        }
    }

    /// Edges of the bins of direction, as cosines: rising for [`Spacing::Cosine`], falling for [`Spacing::Angle`].
    #[must_use]
    pub fn edges(&self) -> Vec<f64> {
        let count = self.directions as f64;
        let edge = |j: usize| match self.spacing {
            Spacing::Cosine => 2.0 * j as f64 / count - 1.0,
            Spacing::Angle => (PI * j as f64 / count).cos(),
        };
        (0..=self.directions).map(edge).collect()
    }

    /// The solid angle of each bin, steradians.
    #[must_use]
    pub fn solid_angles(&self) -> Vec<f64> {
        self.edges().windows(2).map(|pair| 2.0 * PI * (pair[1] - pair[0]).abs()).collect()
    }
}

/// How good a table is to be, and how much work may be done for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Standard error of each bin relative to its light, for bins above 1 % of their row's largest; photons are followed until it is reached.
    pub relative: Option<f64>,
    /// Photons that are followed before errors are looked at: for each row, or for each group of rows that share paths.
    pub photons: Option<u64>,
    /// Scatterings after which no more photons are begun, whatever the error.
    pub most_events: u64,
}

impl Accuracy {
    /// Whether it can be reached.
    ///
    /// # Errors
    /// What cannot be, with its value.
    pub fn checked(&self) -> Result<(), TableError> {
        match (self.relative, self.photons) {
            (Some(relative), _) if !(1e-4..=1.0).contains(&relative) => Err(TableError::Accuracy(relative)),
            (_, Some(photons)) if photons < 64 => Err(TableError::Photons),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_that_cannot_be_are_refused_in_words() {
        let thesis = Parameters::thesis().unwrap();
        assert_eq!(thesis.checked(), Ok(()));
        for (wrong, word) in [
            (Parameters { albedo: f64::NAN, ..thesis }, "NaN"),
            (Parameters { depths: 1, ..thesis }, "1 depths"),
            (Parameters { directions: 0, ..thesis }, "0 directions"),
            (Parameters { depths: 100_000, directions: 3600, ..thesis }, "10 million"),
            (Parameters { deepest: f64::INFINITY, ..thesis }, "inf"),
            (Parameters { albedo: 0.0, depth: Depth::Scattering, ..thesis }, "extinction"),
            (Parameters { source: Source::Centre, ..thesis }, "outside"),
        ] {
            let told = wrong.checked().unwrap_err().to_string();
            assert!(told.contains(word), "{told}");
        }
    }
}
