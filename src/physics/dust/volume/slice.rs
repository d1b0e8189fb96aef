//! Planes of a volume: cut at an index, or summed along an axis.

use std::str::FromStr;

use super::Volume;

/// An axis of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// x, the fastest.
    X,
    /// y.
    Y,
    /// z, the slowest.
    Z,
}

impl FromStr for Axis {
    type Err = String;

    fn from_str(text: &str) -> Result<Axis, String> {
        match text {
            "x" => Ok(Axis::X),
            "y" => Ok(Axis::Y),
            "z" => Ok(Axis::Z),
            _ => Err(format!("'{text}': give x, y or z")),
        }
    }
}

impl Axis {
    /// As a person writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Axis::X => "x",
            Axis::Y => "y",
            Axis::Z => "z",
        }
    }

    /// 0, 1 or 2.
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        }
    }
}

/// A plane of numbers as an eye on the positive end of its axis sees it: for z, +y is up and +x is right; for x, +y is up and +z is
/// left; for y, +z is down and +x is right. Row 0 on top, column 0 on the left.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The numbers, row by row.
    pub values: Vec<f32>,
}

/// The plane whose pixels are made of a column and a row of the picture.
fn plane(volume: &Volume, axis: Axis, value: impl Fn([usize; 3]) -> f32) -> Plane {
    let [x, y, z] = volume.size;
    let (width, height) = match axis {
        Axis::X => (z, y),
        Axis::Y => (x, z),
        Axis::Z => (x, y),
    };
    let mut values = Vec::with_capacity(width * height);
    for row in 0..height {
        for column in 0..width {
            values.push(value(match axis {
                Axis::X => [0, y - 1 - row, z - 1 - column],
                Axis::Y => [column, 0, row],
                Axis::Z => [column, y - 1 - row, 0],
            }));
        }
    }
    Plane { width, height, values }
}

impl Volume {
    /// The density of a voxel.
    fn density_at(&self, [x, y, z]: [usize; 3]) -> f32 {
        self.density[(z * self.size[1] + y) * self.size[0] + x]
    }
}

/// The plane at an index along an axis; nothing beyond the volume.
#[must_use]
pub fn slice(volume: &Volume, axis: Axis, index: usize) -> Option<Plane> {
    (index < volume.size[axis.index()]).then(|| {
        plane(volume, axis, |mut voxel| {
            voxel[axis.index()] = index;
            volume.density_at(voxel)
        })
    })
}

/// Density times length along an axis: times the extinction it is an optical depth.
#[must_use]
pub fn column(volume: &Volume, axis: Axis) -> Plane {
    let (along, side) = (axis.index(), volume.size[axis.index()]);
    let step = volume.edges[along] / side as f64;
    // Voxel by voxel in the order of memory: a walk along z for each pixel would miss the cache at every step.
    let [width, height, _] = volume.size;
    let shape = plane(volume, axis, |_| 0.0);
    let mut sums = vec![0.0f64; shape.values.len()];
    for (row, values) in volume.density.chunks_exact(width).enumerate() {
        let (y, z) = (row % height, row / height);
        match axis {
            Axis::X => {
                sums[(height - 1 - y) * shape.width + shape.width - 1 - z] =
                    values.iter().copied().map(f64::from).sum();
            }
            Axis::Y => add(&mut sums[z * width..][..width], values),
            Axis::Z => add(&mut sums[(height - 1 - y) * width..][..width], values),
        }
    }
    Plane { values: sums.into_iter().map(|sum| (sum * step) as f32).collect(), ..shape }
}

fn add(sums: &mut [f64], values: &[f32]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += f64::from(*value));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::camera::{Camera, Lens};
    use glam::DVec3;

    fn some() -> Volume {
        let values = (0..60u8).map(f32::from).collect();
        Volume::new([3, 4, 5], DVec3::new(3.0, 8.0, 5.0), values).unwrap()
    }

    #[test]
    fn a_slice_is_laid_as_an_orthographic_camera_on_the_axis_sees_it() {
        let volume = some();
        for (axis, eye, up) in
            [(Axis::X, DVec3::X, DVec3::Y), (Axis::Y, DVec3::Y, DVec3::NEG_Z), (Axis::Z, DVec3::Z, DVec3::Y)]
        {
            let plane = slice(&volume, axis, 1).unwrap();
            let (across, level) = match axis {
                Axis::X => (5.0, volume.centre(1, 0, 0).x),
                Axis::Y => (3.0, volume.centre(0, 1, 0).y),
                Axis::Z => (3.0, volume.centre(0, 0, 1).z),
            };
            let camera = Camera::looking(eye * 9.0, DVec3::ZERO, up, Lens::Orthographic { width: across }).unwrap();
            for (row, column) in [(0, 0), (0, plane.width - 1), (plane.height - 1, 0), (1, 2)] {
                // Pixels of a plane are as high as the volume's voxels are; the camera's are square.
                let down = across / plane.width as f64;
                let high = volume.edges()[if axis == Axis::Y { 2 } else { 1 }] / plane.height as f64;
                let y = (row as f64 + 0.5 - plane.height as f64 / 2.0) * high / down + plane.height as f64 / 2.0;
                let ray = camera.ray(column as f64 + 0.5, y, plane.width, plane.height).unwrap();
                let mut point = ray.origin;
                point[axis.index()] = level;
                assert_eq!(
                    volume.at(point),
                    f64::from(plane.values[row * plane.width + column]),
                    "{axis:?} {row} {column}"
                );
            }
        }
        assert!(slice(&volume, Axis::Z, 5).is_none());
    }

    #[test]
    fn a_column_is_the_sum_of_the_slices_times_the_voxel_s_length() {
        let volume = some();
        for (axis, side, step) in [(Axis::X, 3, 1.0), (Axis::Y, 4, 2.0), (Axis::Z, 5, 1.0)] {
            let whole = column(&volume, axis);
            for (pixel, value) in whole.values.iter().enumerate() {
                let sum: f32 = (0..side).map(|index| slice(&volume, axis, index).unwrap().values[pixel]).sum();
                assert_eq!(*value, sum * step);
            }
        }
    }
}
