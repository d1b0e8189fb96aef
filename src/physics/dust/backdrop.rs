//! What is behind a nebula: a field of stars at infinity, or a photograph (thesis, figure 5.6).

use glam::DVec3;

use super::camera::Camera;
use super::starlight::{RED_GREEN_BLUE_NM, colour};
use crate::numerics::streams::Stream;
use crate::picture::Picture;

/// Faintest to brightest star of a field.
const RANGE: f64 = 1000.0;
/// Every so many-th star is on the sheet that an eye with parallel rays sees: as many as in a view of about 45 degrees.
const SHEET: usize = 25;
/// Radius of a star's image, pixels (of a Gaussian).
const BLUR_PX: f64 = 0.6;

/// Stars at infinity, strewn evenly over the whole sky; how many are brighter than F falls as F^(-3/2), as in space that is evenly
/// filled with stars.
#[derive(Debug, Clone, PartialEq)]
pub struct StarField {
    stars: Vec<(DVec3, [f32; 3])>,
}

impl StarField {
    /// So many stars of a seed, the brightest pixels about 1.
    #[must_use]
    pub fn seeded(seed: u64, count: usize) -> StarField {
        let mut stream = Stream::seeded(seed);
        let star = |_| {
            let height = 2.0 * stream.uniform() - 1.0;
            let (sine, cosine) = (std::f64::consts::TAU * stream.uniform()).sin_cos();
            let level = (1.0 - height * height).sqrt();
            let flux = (1.0 - stream.uniform()).powf(-2.0 / 3.0).min(RANGE) / RANGE;
            let kelvin = 3000.0 * 6f64.powf(stream.uniform());
            let tint = colour(kelvin, &RED_GREEN_BLUE_NM).unwrap_or_default();
            let light = std::array::from_fn(|band| (flux * tint.get(band).copied().unwrap_or(1.0)) as f32);
            (DVec3::new(level * sine, height, level * cosine), light)
        };
        StarField { stars: (0..count).map(star).collect() }
    }

    /// The field as a camera sees it, row by row. An eye with parallel rays sees one direction of the sky: it gets a sheet of stars.
    #[must_use]
    pub fn draw(&self, camera: &Camera, width: usize, height: usize) -> Vec<[f32; 3]> {
        let mut pixels = vec![[0.0; 3]; width * height];
        let parallel = camera.parallel().is_some();
        let stars = self.stars.iter().step_by(if parallel { SHEET } else { 1 });
        for (direction, light) in stars {
            let place = if parallel {
                // Lambert's cylinder: even on the sphere is even on the sheet.
                let turn = direction.x.atan2(direction.z) / std::f64::consts::TAU + 0.5;
                Some((turn * width as f64, (direction.y + 1.0) * 0.5 * height as f64))
            } else {
                camera.place(camera.eye() + *direction, width, height)
            };
            if let Some((x, y)) = place {
                dot(&mut pixels, width, height, (x, y), *light);
            }
        }
        pixels
    }
}

/// Adds the image of a star.
fn dot(pixels: &mut [[f32; 3]], width: usize, height: usize, (x, y): (f64, f64), light: [f32; 3]) {
    let reach = 3.0 * BLUR_PX;
    // The casts saturate: places beside the picture give empty ranges.
    let span = |at: f64, side: usize| (at - reach).max(0.0) as usize..((at + reach).max(0.0) as usize + 1).min(side);
    for row in span(y, height) {
        for column in span(x, width) {
            let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
            let share = (-(dx * dx + dy * dy) / (2.0 * BLUR_PX * BLUR_PX)).exp() as f32;
            pixels[row * width + column].iter_mut().zip(light).for_each(|(pixel, light)| *pixel += share * light);
        }
    }
}

/// A photograph that fills a frame: scaled until it covers it, cut evenly at two sides, and averaged where it has more pixels.
#[must_use]
pub fn photograph(picture: &Picture, width: usize, height: usize) -> Vec<[f32; 3]> {
    let scale = |picture: &Picture| {
        (picture.width() as f32 / width.max(1) as f32).min(picture.height() as f32 / height.max(1) as f32)
    };
    let mut small = picture.clone();
    while scale(&small) >= 2.0 {
        small = small.halved();
    }
    let step = scale(&small);
    let from = |pixels: usize, frame: usize| 0.5 * (pixels as f32 - step * frame as f32);
    let (left, top) = (from(small.width(), width), from(small.height(), height));
    (0..width * height)
        .map(|i| {
            let (column, row) = ((i % width) as f32 + 0.5, (i / width) as f32 + 0.5);
            small.sample(left + step * column, top + step * row)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::camera::Lens;

    fn seen(look_at: DVec3) -> Vec<[f32; 3]> {
        let lens = Lens::Perspective { field: 1.0 };
        let camera = Camera::looking(DVec3::new(7.0, 0.0, 0.0), DVec3::new(7.0, 0.0, 0.0) + look_at, DVec3::Y, lens);
        StarField::seeded(3, 20_000).draw(&camera.unwrap(), 200, 100)
    }

    #[test]
    fn every_part_of_the_sky_has_about_as_many_stars_and_one_seed_the_same_ones() {
        let lit = |pixels: &[[f32; 3]]| pixels.iter().filter(|pixel| pixel[1] > 2e-4).count();
        let one = seen(DVec3::Z);
        assert_eq!(one, seen(DVec3::Z));
        for direction in [DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, 2.0, -1.0)] {
            let other = seen(direction);
            let ratio = lit(&other) as f64 / lit(&one) as f64;
            assert!((0.9..1.1).contains(&ratio), "{ratio}");
            assert_ne!(other, one);
        }
    }

    #[test]
    fn parallel_rays_see_a_sheet_that_is_even_to_its_corners() {
        let camera = Camera::looking(DVec3::Z, DVec3::ZERO, DVec3::Y, Lens::Orthographic { width: 2.0 }).unwrap();
        let sheet = StarField::seeded(3, 40_000).draw(&camera, 90, 90);
        let lit = |column: usize, row: usize| {
            let rows = (0..30).flat_map(|y| sheet[(row + y) * 90 + column..][..30].iter());
            rows.filter(|pixel| pixel[1] > 2e-4).count() as f64
        };
        for (column, row) in [(0, 0), (60, 0), (0, 60), (60, 60)] {
            assert!((0.75..1.25).contains(&(lit(column, row) / lit(30, 30))), "{column} {row}");
        }
    }

    #[test]
    fn a_step_aside_does_not_move_stars_at_infinity() {
        let from = |eye: DVec3| {
            let camera = Camera::looking(eye, eye + DVec3::Z, DVec3::Y, Lens::Perspective { field: 1.0 }).unwrap();
            StarField::seeded(3, 1000).draw(&camera, 64, 64)
        };
        let (here, there) = (from(DVec3::ZERO), from(DVec3::new(5.0, 2.0, 0.0)));
        assert!(here.as_flattened().iter().zip(there.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-4));
    }

    #[test]
    fn a_photograph_covers_the_frame_and_is_cut_evenly() {
        let mut picture = Picture::black(8, 2);
        for row in 0..2 {
            for (column, pixel) in picture.row_mut(row).iter_mut().enumerate() {
                *pixel = [column as f32; 3];
            }
        }
        let frame = photograph(&picture, 4, 2);
        assert_eq!(frame[..4], [[2.0; 3], [3.0; 3], [4.0; 3], [5.0; 3]]);
        // Twice as small: the mean of four pixels, columns 2 to 5.
        assert_eq!(photograph(&picture, 2, 1), [[2.5; 3], [4.5; 3]]);
    }
}
