//! Columns of dust between two points: what star light goes through on its way.
//!
//! One column serves every band: the optical depth is extinction times column.

use glam::DVec3;

use super::camera::Ray;
use super::volume::Volume;

/// The cells of a grid along a ray, each with the density as a polynomial.
pub mod cells;
/// Columns from the stars, computed once on a lattice.
pub mod lattice;

/// The column between two points, density times length, to rounding: in each cell between voxel centres the density along a line is a
/// cubic, whose integral is known.
#[must_use]
pub fn column(volume: &Volume, from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let length = way.length();
    if length == 0.0 || !length.is_finite() {
        return 0.0;
    }
    let ray = Ray { origin: from, direction: way / length };
    let mut sum = 0.0;
    cells::walk(volume, &ray, 0.0, length, |cell| {
        sum += cell.column(cell.length());
        true
    });
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_column_through_even_dust_is_density_times_length_inside_the_box() {
        let volume = Volume::new([3, 4, 5], DVec3::new(2.0, 3.0, 4.0), vec![0.5; 60]).unwrap();
        let through = column(&volume, DVec3::new(-9.0, 0.3, 0.2), DVec3::new(9.0, 0.3, 0.2));
        assert!((through - 1.0).abs() < 1e-12, "{through}");
        let inside = column(&volume, DVec3::new(0.1, -0.2, 0.3), DVec3::new(0.4, 0.2, 0.3));
        assert!((inside - 0.25).abs() < 1e-12, "{inside}");
        assert_eq!(column(&volume, DVec3::new(3.0, 0.0, 0.0), DVec3::new(3.0, 1.0, 1.0)), 0.0);
    }

    #[test]
    fn the_column_of_uneven_dust_is_what_a_million_steps_give() {
        let density = (0..27).map(|i| (i * i % 11) as f32).collect();
        let volume = Volume::new([3, 3, 3], DVec3::splat(2.0), density).unwrap();
        let (a, b) = (DVec3::new(-0.95, -0.8, -0.99), DVec3::new(0.7, 0.95, 0.4));
        let steps = 100_000;
        let slow: f64 =
            (0..steps).map(|i| volume.at(a + (b - a) * ((f64::from(i) + 0.5) / f64::from(steps)))).sum::<f64>();
        let slow = slow * (b - a).length() / f64::from(steps);
        let quick = column(&volume, a, b);
        assert!((quick / slow - 1.0).abs() < 1e-9, "{quick} {slow}");
    }
}
