//! The scattering table of the thesis (section 5.5, appendix A): how much of the light that meets a voxel leaves it scattered, by the voxel's
//! optical depth and the angle turned through.

use std::f64::consts::PI;

pub use parameters::{Accuracy, Depth, Length, Parameters, Spacing, TableError};

/// A table as text.
pub mod file;
/// Rows of like depth.
mod nodes;
/// What a table is of.
pub mod parameters;
/// What one scattering sends into every bin.
mod peel;
/// A table as the thesis makes it.
pub mod plain;
/// A table by paths that rows share.
pub mod shared;

/// Radius of the sphere with the volume of a cube of edge 1: (3 / (4 pi))^(1/3).
pub const RADIUS: f64 = 0.620_350_490_899_400_1;

/// A table, and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// The table.
    pub table: Table,
    /// Photons followed.
    pub photons: u64,
    /// Scatterings followed.
    pub events: u64,
}

/// A table.
///
/// A bin holds the share of the light entering the sphere that leaves it scattered into the bin's directions: a row's unscattered light, its
/// bins, and what the dust took add up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    parameters: Parameters,
    per_solid_angle: Vec<f64>,
    unscattered: Vec<[f64; 2]>,
    bins: Vec<f64>,
    errors: Vec<f64>,
}

impl Table {
    /// A table of what was found: the unscattered share and its standard error for each row; the bins and their standard errors, row by row.
    /// Nothing where the numbers are not as many as the parameters say, or no numbers.
    #[must_use]
    pub fn new(parameters: Parameters, unscattered: Vec<[f64; 2]>, bins: Vec<f64>, errors: Vec<f64>) -> Option<Table> {
        parameters.checked().ok()?;
        let count = parameters.depths * parameters.directions;
        let finite = bins.iter().chain(&errors).chain(unscattered.as_flattened()).all(|number| number.is_finite());
        let fits = unscattered.len() == parameters.depths && bins.len() == count && errors.len() == count;
        let per_solid_angle = parameters.solid_angles().iter().map(|angle| 1.0 / angle).collect();
        (finite && fits).then_some(Table { parameters, per_solid_angle, unscattered, bins, errors })
    }

    /// What it is of.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The share of a row that passes untouched, and its standard error.
    #[must_use]
    pub fn unscattered(&self, row: usize) -> [f64; 2] {
        self.unscattered[row]
    }

    /// The bins of a row: shares of the light that enters.
    #[must_use]
    pub fn bins(&self, row: usize) -> &[f64] {
        &self.bins[row * self.parameters.directions..][..self.parameters.directions]
    }

    /// The standard errors of a row's bins.
    #[must_use]
    pub fn errors(&self, row: usize) -> &[f64] {
        &self.errors[row * self.parameters.directions..][..self.parameters.directions]
    }

    /// The share of a row's light that leaves scattered.
    #[must_use]
    pub fn scattered(&self, row: usize) -> f64 {
        self.bins(row).iter().sum()
    }

    /// The largest error of a bin relative to its light, of the bins that hold more than 1 % of their row's largest.
    #[must_use]
    pub fn worst_error(&self) -> f64 {
        let row = |row| worst(self.bins(row), self.errors(row));
        (0..self.parameters.depths).map(row).fold(0.0, f64::max)
    }

    /// The share of the light entering a voxel that leaves it scattered, per steradian, about a direction.
    ///
    /// The depth is that of **extinction along an edge of the voxel**, whatever the rows count; `cosine` is between the way in and the way
    /// out. Over the sphere it integrates to the scattered share. Bilinear between rows and between the middles of bins; beyond the last
    /// row, and in the outer half of the outer bins, the nearest value.
    ///
    /// In thin dust it tends to `albedo p(cosine) depth c`, c the mean chord of [`Table::chord`].
    #[must_use]
    pub fn per_steradian(&self, depth: f64, cosine: f64) -> f64 {
        let Parameters { depths, directions, .. } = self.parameters;
        let (low, high, part) = between(self.place(depth), depths);
        let place = match self.parameters.spacing {
            Spacing::Cosine => (cosine + 1.0) * 0.5,
            Spacing::Angle => cosine.clamp(-1.0, 1.0).acos() / PI,
        };
        let (left, right, share) = between(place * directions as f64 - 0.5, directions);
        let at = |row: usize| {
            let value = |bin: usize| self.bins[row * directions + bin] * self.per_solid_angle[bin];
            value(left) + (value(right) - value(left)) * share
        };
        at(low) + (at(high) - at(low)) * part
    }

    /// The mean way of the entering light through the voxel's sphere, in edges of the voxel: 1.2407 for a pencil, 0.82713 for a beam.
    /// `per_steradian / chord` is the light scattered per steradian, per irradiance, from a volume of one cubic edge.
    #[must_use]
    pub fn chord(&self) -> f64 {
        self.parameters.source.mean_chord() * RADIUS
    }

    /// The depth of extinction along a voxel's edge beyond which the last row stands for all.
    #[must_use]
    pub fn deepest(&self) -> f64 {
        let last = self.parameters.depths - 1;
        last as f64 / self.place(1.0)
    }

    /// Where among the rows a depth of extinction along an edge stands.
    fn place(&self, depth: f64) -> f64 {
        let Parameters { albedo, deepest, depths, length, depth: counts, .. } = self.parameters;
        let length = if length == Length::Edge { 1.0 } else { 2.0 * RADIUS };
        let counted = if counts == Depth::Extinction { 1.0 } else { albedo };
        depth * length * counted / deepest * (depths - 1) as f64
    }
}

/// The two neighbours of a place among `count`, and how far it is from the first to the second.
fn between(place: f64, count: usize) -> (usize, usize, f64) {
    let last = count - 1;
    // A place that is no number stands at 0.
    let place = place.max(0.0).min(last as f64);
    let low = (place as usize).min(last);
    (low, (low + 1).min(last), place - low as f64)
}

/// The largest relative error among the bins that hold more than 1 % of the largest.
#[must_use]
pub fn worst(bins: &[f64], errors: &[f64]) -> f64 {
    let least = 0.01 * bins.iter().copied().fold(0.0, f64::max);
    let relative = bins.iter().zip(errors).filter(|(bin, _)| **bin > least).map(|(bin, error)| error / bin);
    relative.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::sphere::Source;

    /// A table of single scattering alone, which is what every table is at its thin end.
    fn thin(spacing: Spacing, source: Source, length: Length, depth: Depth) -> Table {
        let parameters =
            Parameters { deepest: 1e-3, depths: 11, spacing, source, length, depth, ..Parameters::thesis().unwrap() };
        let edges = parameters.edges();
        let (mut bins, mut unscattered) = (Vec::new(), Vec::new());
        for row in 0..parameters.depths {
            let met = source.mean_chord() * parameters.radius_depth(row);
            let law = |pair: &[f64]| parameters.phase.below(pair[1]) - parameters.phase.below(pair[0]);
            bins.extend(edges.windows(2).map(|pair| parameters.albedo * met * law(pair).abs()));
            unscattered.push([1.0 - met, 0.0]);
        }
        let errors = vec![0.0; bins.len()];
        Table::new(parameters, unscattered, bins, errors).unwrap()
    }

    #[test]
    fn a_thin_voxel_is_single_scattering_whatever_the_rows_count_and_however_bins_are_spaced() {
        for spacing in [Spacing::Cosine, Spacing::Angle] {
            for source in [Source::Pencil, Source::Beam] {
                for (length, depth) in [
                    (Length::Edge, Depth::Extinction),
                    (Length::Diameter, Depth::Extinction),
                    (Length::Diameter, Depth::Scattering),
                ] {
                    let table = thin(spacing, source, length, depth);
                    for cosine in [-0.9, 0.0, 0.3, 0.9] {
                        let expected = 0.6 * 3.3e-4 * table.parameters().phase.per_steradian(cosine);
                        let given = table.per_steradian(3.3e-4, cosine) / table.chord();
                        assert!((given / expected - 1.0).abs() < 0.01, "{spacing:?} {length:?} {depth:?} {cosine}");
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_its_ends_a_table_is_level_and_a_place_that_is_no_number_is_its_beginning() {
        let table = thin(Spacing::Cosine, Source::Pencil, Length::Edge, Depth::Extinction);
        assert_eq!(table.per_steradian(5.0, 0.2), table.per_steradian(1e-3, 0.2));
        assert_eq!(table.per_steradian(1e-4, 7.0), table.per_steradian(1e-4, 1.0));
        assert_eq!(table.per_steradian(f64::NAN, 0.2), 0.0);
        assert!((table.deepest() - 1e-3).abs() < 1e-18);
    }

    #[test]
    fn the_sphere_has_the_volume_of_the_voxel() {
        assert!((4.0 / 3.0 * PI * RADIUS.powi(3) - 1.0).abs() < 1e-15);
    }
}
