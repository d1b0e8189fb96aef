//! Pictures of lit dust, with the error they are believed to have.
//!
//! A pixel is the average of the radiance over its square. Every pixel gets one ray; where the neighbours tell that the middle is not the
//! average, more, until the error is below the tolerance; where a star stands behind the pixel, rays in polar order round it, since there
//! the radiance grows as one over the distance from the star.

use rayon::prelude::*;

use super::bricks::Bricks;
use super::camera::{Camera, Ray};
use super::march::{Emission, Enough, Fineness, March, Tally};
use super::model::Scattering;
use super::scene::{MOST_BANDS, Scene};
use super::volume::Volume;

/// The average of a pixel.
mod pixel;
/// How fine the rays must be, found out on some of them.
pub mod plan;

use pixel::{MARGIN, Pixel, Sampler};
use plan::Plan;

/// Longest side of a picture, pixels.
pub const LONGEST_SIDE: usize = 8192;
/// Larger pictures are for nobody's memory: see [`View::bytes`].
pub const MOST_BYTES: u64 = 4 << 30;
/// Rows that are worked on at one time.
const STRIP: usize = 32;

/// An eye and the frame before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The eye.
    pub camera: Camera,
    /// Columns, 1 to [`LONGEST_SIDE`].
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// What is nearer to the eye than this is not seen: the near plane (for a pinhole and a dome, a sphere).
    pub near: f64,
}

impl View {
    /// Memory that its picture takes in so many bands until it is written: planes of light, of what comes through and of believed errors, and a
    /// plane of light twice more on its way into a file. Strips of rays add nothing that grows with the picture.
    #[must_use]
    pub fn bytes(&self, bands: usize) -> u64 {
        let pixels = self.width as u64 * self.height as u64;
        pixels.saturating_mul(4 * (4 * bands as u64 + 1))
    }

    /// The ray of a place in the picture. Outside a dome's circle, that of its edge: so pixels on the edge are averages of what is inside.
    fn ray(&self, x: f64, y: f64) -> Option<Ray> {
        self.camera.ray(x, y, self.width, self.height).or_else(|| {
            let (w, h) = (self.width as f64 / 2.0, self.height as f64 / 2.0);
            let (dx, dy) = (x - w, y - h);
            let inside = w.min(h) / dx.hypot(dy) * (1.0 - 1e-12);
            self.camera.ray(w + dx * inside, h + dy * inside, self.width, self.height)
        })
    }
}

/// What is drawn.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The dust.
    pub volume: &'a Volume,
    /// Its properties and the stars.
    pub scene: &'a Scene,
    /// The light in it, as it is used for the picture.
    pub model: &'a dyn Scattering,
    /// The same light without any short cut, which the picture's error is measured against.
    pub exact: &'a dyn Scattering,
    /// Light of its own.
    pub emission: Option<Emission<'a>>,
}

impl Subject<'_> {
    /// The most density anywhere.
    fn densest(&self) -> f64 {
        self.volume.density().par_iter().copied().reduce(|| 0.0, f32::max).into()
    }
}

/// How it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// The relative error to stay below (of a pixel, or of a hundredth of the picture's mean where a pixel is darker).
    pub tolerance: f64,
    /// Longest piece of a ray, voxels; if nothing is said, what the tolerance needs.
    pub step: Option<f64>,
    /// Leave nothing out: the exact model, no cell passed over, no ray ended early, every pixel averaged over 16 rays or more.
    pub everything: bool,
    /// Seed of the choice of rays on which errors are measured.
    pub seed: u64,
}

/// What was done, what was left out, and how right it is believed to be.
#[derive(Debug, Clone, PartialEq)]
pub struct Explained {
    /// How fine rays are.
    pub fineness: Fineness,
    /// Rays compared with the exact ones.
    pub probes: usize,
    /// Their worst relative error.
    pub worst_ray: f64,
    /// Their mean relative error.
    pub mean_ray: f64,
    /// Believed relative error of the worst pixel: of its average and of its rays.
    pub worst: f64,
    /// Of the pixels with light in them, the mean.
    pub mean: f64,
    /// Pixels that see light.
    pub lit: u64,
    /// Pixels for which one ray was enough.
    pub one_ray: u64,
    /// Pixels that miss the box.
    pub missed: u64,
    /// Pixels with a star behind them, whose rays are laid round it.
    pub starred: u64,
    /// Pixels whose average did not become as good as asked with the most rays that are spent on one.
    pub given_up: u64,
    /// Counts over all rays.
    pub tally: Tally,
}

/// A picture: planes of radiance, one a band, and the share of light from behind that comes through, one a band. Row 0 on top.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Radiance: radiant intensity of the stars per unit of length squared. f32: the eye sees steps of 1 %.
    pub radiance: Vec<Vec<f32>>,
    /// 1 where nothing is in the way.
    pub through: Vec<Vec<f32>>,
    /// Believed relative error of each pixel, its average's and its rays' (see [`Wish::tolerance`] for what it is relative to).
    pub believed: Vec<f32>,
    /// How it came about.
    pub explained: Explained,
}

/// Draws.
///
/// `told` hears the share that is done. The picture is the same for any number of threads.
#[must_use]
pub fn render(subject: &Subject<'_>, view: &View, wish: &Wish, told: &mut dyn FnMut(f64)) -> Rendered {
    let plan = Plan::new(subject, view, wish);
    let bricks = Bricks::of(subject.volume);
    let enough = Enough { share: 0.1 * wish.tolerance, floor: plan.floor.clone() };
    let march = March {
        volume: subject.volume,
        scene: subject.scene,
        model: if wish.everything { subject.exact } else { subject.model },
        emission: subject.emission,
        densest: subject.densest(),
        fineness: plan.fineness,
        enough: (!wish.everything).then_some(&enough),
        bricks: (!wish.everything).then_some(&bricks),
    };
    let bands = subject.scene.bands();
    let sampler = Sampler::new(march, view, wish, &plan.floor);
    let pixels = view.width * view.height;
    let mut rendered = Rendered {
        width: view.width,
        height: view.height,
        radiance: vec![vec![0.0; pixels]; bands],
        through: vec![vec![1.0; pixels]; bands],
        believed: vec![0.0; pixels],
        explained: plan.explained(),
    };
    let (mut sum, mut error) = (0u64, 0.0);
    // One ray a pixel, with some rows above and below: a strip begins with the last ones of the one before.
    let mut rows: Vec<Vec<Pixel>> = Vec::new();
    for top in (0..view.height).step_by(STRIP) {
        let bottom = (top + STRIP).min(view.height);
        let first = top as isize - MARGIN as isize + rows.len() as isize;
        let last = (bottom + MARGIN) as isize;
        rows.par_extend((first..last).into_par_iter().map(|y| sampler.middles(y)));
        let done: Vec<Vec<(Pixel, pixel::Kind)>> =
            (top..bottom).into_par_iter().map(|y| sampler.averages(&rows[y - top..=y - top + 2 * MARGIN], y)).collect();
        for (y, row) in (top..bottom).zip(&done) {
            for (x, (pixel, kind)) in row.iter().enumerate() {
                let at = y * view.width + x;
                for band in 0..bands {
                    rendered.radiance[band][at] = pixel.radiance[band] as f32;
                    let depth = subject.scene.dust().extinction[band] * pixel.column;
                    rendered.through[band][at] = (-depth).exp() as f32;
                }
                let explained = &mut rendered.explained;
                explained.tally += pixel.tally;
                rendered.believed[at] = (pixel.error + explained.worst_ray) as f32;
                if pixel.is_lit(bands) {
                    sum += 1;
                    error += pixel.error;
                    explained.worst = explained.worst.max(pixel.error);
                }
                match kind {
                    pixel::Kind::Missed => explained.missed += 1,
                    pixel::Kind::OneRay => explained.one_ray += 1,
                    pixel::Kind::Many => {}
                    pixel::Kind::Starred => explained.starred += 1,
                }
                explained.given_up += u64::from(pixel.given_up);
            }
        }
        rows.drain(..rows.len() - 2 * MARGIN);
        told(bottom as f64 / view.height as f64);
    }
    let explained = &mut rendered.explained;
    explained.lit = sum;
    explained.worst += explained.worst_ray;
    explained.mean = explained.mean_ray + if sum > 0 { error / sum as f64 } else { 0.0 };
    rendered
}

/// Relative difference of radiances, the largest of the bands; against the larger of the truth and a floor.
fn difference(a: &[f64; MOST_BANDS], truth: &[f64; MOST_BANDS], floor: &[f64]) -> f64 {
    let of = |band: usize| (a[band] - truth[band]).abs() / truth[band].abs().max(floor[band]);
    (0..floor.len()).map(of).fold(0.0, f64::max)
}
