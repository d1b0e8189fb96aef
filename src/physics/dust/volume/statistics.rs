//! What a volume holds, in numbers.

use glam::DVec3;
use rayon::prelude::*;

use super::Volume;
use super::slice::{Axis, column};

/// The numbers. Densities are relative, columns are density times length: times the extinction they are optical depths.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Least density.
    pub least: f32,
    /// Most density.
    pub most: f32,
    /// Mean density of all voxels.
    pub mean: f64,
    /// Share of the voxels that have dust.
    pub filled: f64,
    /// Density below which lie 5, 50 and 95 % of the voxels that have dust; zero where none has.
    pub filled_quantiles: [f32; 3],
    /// Centre of mass, in the volume's unit of length; nothing without dust.
    pub centre_of_mass: Option<DVec3>,
    /// Columns along x, y and z.
    pub columns: [Columns; 3],
}

/// What a ray along an axis meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Columns {
    /// Through the middle half of the box's face, the median.
    pub central: f64,
    /// The most of all.
    pub most: f64,
}

/// The sums of one plane.
struct Plane {
    least: f32,
    most: f32,
    sum: f64,
    filled: usize,
    moment: DVec3,
}

impl Volume {
    /// Its numbers. In parallel, sums in the order of planes: the same for any number of threads.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        let [width, height, depth] = self.size;
        let planes: Vec<Plane> = self
            .density
            .par_chunks(width * height)
            .enumerate()
            .map(|(z, values)| {
                let mut plane = Plane { least: f32::INFINITY, most: 0.0, sum: 0.0, filled: 0, moment: DVec3::ZERO };
                for (y, row) in values.chunks_exact(width).enumerate() {
                    let (mut sum, mut along) = (0.0, 0.0);
                    for (x, density) in row.iter().enumerate() {
                        plane.least = plane.least.min(*density);
                        plane.most = plane.most.max(*density);
                        plane.filled += usize::from(*density > 0.0);
                        sum += f64::from(*density);
                        along += f64::from(*density) * (x as f64 + 0.5);
                    }
                    plane.sum += sum;
                    plane.moment += DVec3::new(along, sum * (y as f64 + 0.5), sum * (z as f64 + 0.5));
                }
                plane
            })
            .collect();
        let voxels = (width * height * depth) as f64;
        let sum: f64 = planes.iter().map(|plane| plane.sum).sum();
        let moment = planes.iter().fold(DVec3::ZERO, |total, plane| total + plane.moment);
        let sides = DVec3::new(width as f64, height as f64, depth as f64);
        let filled: usize = planes.iter().map(|plane| plane.filled).sum();
        Statistics {
            least: planes.iter().map(|plane| plane.least).fold(f32::INFINITY, f32::min),
            most: planes.iter().map(|plane| plane.most).fold(0.0, f32::max),
            mean: sum / voxels,
            filled: filled as f64 / voxels,
            filled_quantiles: quantiles(&self.density, filled),
            centre_of_mass: (sum > 0.0).then(|| self.edges * (moment / sum / sides - 0.5)),
            columns: [Axis::X, Axis::Y, Axis::Z].map(|axis| columns(self, axis)),
        }
    }
}

/// Most densities that are sorted; of more, evenly chosen ones.
const MOST_SORTED: usize = 1 << 20;

fn quantiles(density: &[f32], filled: usize) -> [f32; 3] {
    let every = filled.div_ceil(MOST_SORTED).max(1);
    let mut some: Vec<f32> = density.iter().copied().filter(|density| *density > 0.0).step_by(every).collect();
    some.sort_unstable_by(f32::total_cmp);
    [0.05, 0.5, 0.95].map(|share| some.get((share * some.len() as f64) as usize).copied().unwrap_or(0.0))
}

fn columns(volume: &Volume, axis: Axis) -> Columns {
    let plane = column(volume, axis);
    let middle = |side: usize| side / 4..side - side / 4;
    let mut central: Vec<f32> = middle(plane.height)
        .flat_map(|row| plane.values[row * plane.width..][middle(plane.width)].iter().copied())
        .collect();
    central.sort_unstable_by(f32::total_cmp);
    let most = plane.values.iter().copied().fold(0.0, f32::max);
    Columns { central: f64::from(central[central.len() / 2]), most: f64::from(most) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_of_one_density_has_its_length_as_column_and_its_middle_as_centre() {
        let volume = Volume::new([4, 6, 8], DVec3::new(1.0, 2.0, 3.0), vec![0.5; 192]).unwrap();
        let numbers = volume.statistics();
        assert_eq!((numbers.least, numbers.most, numbers.mean, numbers.filled), (0.5, 0.5, 0.5, 1.0));
        let centrals = numbers.columns.map(|columns| columns.central);
        for (central, length) in centrals.into_iter().zip([1.0, 2.0, 3.0]) {
            assert!((central - 0.5 * length).abs() < 1e-6);
        }
        assert!(numbers.centre_of_mass.unwrap().length() < 1e-12);
        assert_eq!(numbers.filled_quantiles, [0.5; 3]);
    }

    #[test]
    fn one_voxel_of_dust_is_where_it_is_and_a_volume_of_zeros_has_no_centre() {
        let mut density = vec![0.0; 64];
        let empty = Volume::new([4; 3], DVec3::splat(2.0), density.clone()).unwrap().statistics();
        assert_eq!((empty.centre_of_mass, empty.filled, empty.columns[0].most), (None, 0.0, 0.0));
        density[3] = 2.0;
        let one = Volume::new([4; 3], DVec3::splat(2.0), density).unwrap().statistics();
        assert!((one.centre_of_mass.unwrap() - DVec3::new(0.75, -0.75, -0.75)).length() < 1e-12);
        assert_eq!((one.filled, one.columns[0].most, one.columns[2].central), (1.0 / 64.0, 1.0, 0.0));
    }
}
