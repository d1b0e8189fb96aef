//! Pictures that another program made of known dust, and how ours are held against them.

use glam::DVec3;

use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::render::View;
use crate::physics::dust::scene::{Dust, Scene, Star};
use crate::physics::dust::volume::Volume;
use crate::picture::npy;

/// Side of the pictures, pixels.
pub const SIDE: usize = 64;

/// Side of a block, pixels.
const BLOCK: usize = 8;

/// Pixels about the star that are left out: a few photons make or break their light.
const MASK: f64 = 3.0;

/// Why the study could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// A reference is damaged.
    #[error("the reference {0} cannot be read")]
    Damaged(&'static str),
    /// Something was refused that is known to be sound.
    #[error("{0}")]
    Refused(String),
}

/// A cloud with a star in it, and the pictures that others made of it.
#[derive(Debug, Clone)]
pub struct Known {
    /// Its name.
    pub name: &'static str,
    /// The dust.
    pub volume: Volume,
    /// Its extinction and the star.
    pub scene: Scene,
    /// All orders of scattering (Mitsuba 3.9.1), and its standard error.
    pub all: Vec<f64>,
    /// Standard error of each pixel.
    pub error: Vec<f64>,
    /// Light scattered once, by a quadrature without noise.
    pub once: Vec<f64>,
}

/// How a picture compares with the reference.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Compared {
    /// Total of the picture less the reference's, as a share of it.
    pub total: f64,
    /// Blocks that hold more than 1 % of the light and are known to 2 %.
    pub blocks: usize,
    /// Their root mean square difference, as a share of each.
    pub rms: f64,
    /// Their worst.
    pub worst: f64,
    /// Blocks further from the reference than 3 % and three of its standard errors.
    pub over: usize,
}

macro_rules! scene {
    ($name:literal, $grid:literal, $file:literal, $extinction:literal, $star:expr) => {
        (
            $name,
            $extinction,
            $star,
            [
                include_bytes!(concat!("../../../fixtures/reference/mitsuba/grid_", $grid, "_32.npy")).as_slice(),
                include_bytes!(concat!("../../../fixtures/reference/mitsuba/", $file, "_multi.npy")),
                include_bytes!(concat!("../../../fixtures/reference/mitsuba/", $file, "_multi_stderr.npy")),
                include_bytes!(concat!("../../../fixtures/reference/mitsuba/", $file, "_singlequad.npy")),
            ],
        )
    };
}

/// The three clouds.
///
/// # Errors
/// A file is damaged.
pub fn all() -> Result<Vec<Known>, StudyError> {
    [
        scene!("even ball", "sphere", "sphere_k1_a0.6_g0.6_ortho", 1.0, DVec3::ZERO),
        scene!("shell", "radial", "radial_k5_a0.6_g0.6_ortho", 5.0, DVec3::ZERO),
        scene!("clumps", "noise", "noise_k4_a0.6_g0.6_ortho", 4.0, DVec3::new(0.15, 0.1, -0.2)),
    ]
    .into_iter()
    .map(|(name, extinction, star, files)| {
        let [grid, all, error, once] = files.map(|mut bytes| {
            let length = bytes.len() as u64;
            npy::read(&mut bytes, length).map_err(|_damaged| StudyError::Damaged(name))
        });
        let numbers = |array: npy::Array| array.values.into_iter().map(f64::from).collect::<Vec<f64>>();
        let (all, error, once) = (numbers(all?), numbers(error?), numbers(once?));
        if [&all, &error, &once].iter().any(|picture| picture.len() != SIDE * SIDE) {
            return Err(StudyError::Damaged(name));
        }
        let volume = Volume::new([32; 3], DVec3::splat(2.0), grid?.values).map_err(refused)?;
        Ok(Known { name, volume, scene: scene(vec![extinction], star)?, all, error, once })
    })
    .collect()
}

/// The thesis' grains with a star of intensity 1 at a place.
///
/// # Errors
/// Never for numbers that are sound.
pub fn scene(extinction: Vec<f64>, star: DVec3) -> Result<Scene, StudyError> {
    let phase = HenyeyGreenstein::new(0.6).ok_or(StudyError::Damaged("asymmetry"))?;
    let stars = vec![Star { position: star, intensity: vec![1.0; extinction.len()] }];
    Scene::new(Dust { extinction, albedo: 0.6, phase }, stars).map_err(refused)
}

pub(super) fn refused(error: impl std::fmt::Display) -> StudyError {
    StudyError::Refused(error.to_string())
}

/// The eye of the references: from +z over the whole box from -1 to 1.
///
/// # Errors
/// Never.
pub fn view(side: usize) -> Result<View, StudyError> {
    let lens = Lens::Orthographic { width: 2.0 };
    let camera = Camera::looking(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y, lens);
    Ok(View { camera: camera.ok_or(StudyError::Damaged("camera"))?, width: side, height: side, near: 0.0 })
}

impl Known {
    fn masked(&self, row: usize, column: usize) -> bool {
        let half = SIDE as f64 / 2.0;
        self.scene.stars().iter().any(|star| {
            let (x, y) = ((star.position.x + 1.0) * half, (1.0 - star.position.y) * half);
            (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y) <= MASK
        })
    }

    /// Sums over the pixels of a square that are not left out.
    fn sum(&self, side: usize, (top, left): (usize, usize), of: impl Fn(usize) -> f64) -> f64 {
        let pixels = (0..side * side).map(|i| (top + i / side, left + i % side));
        pixels.filter(|(row, column)| !self.masked(*row, *column)).map(|(row, column)| of(row * SIDE + column)).sum()
    }

    /// Holds a picture of all orders of scattering against the reference.
    #[must_use]
    pub fn compare(&self, picture: &[f32]) -> Compared {
        let ours = |i: usize| picture.get(i).map_or(f64::NAN, |value| f64::from(*value));
        let light = self.sum(SIDE, (0, 0), |i| self.all[i]);
        let mut compared = Compared { total: self.sum(SIDE, (0, 0), ours) / light - 1.0, ..Compared::default() };
        for block in 0..(SIDE / BLOCK).pow(2) {
            let corner = (block * BLOCK / SIDE * BLOCK, block * BLOCK % SIDE);
            let here = self.sum(BLOCK, corner, |i| self.all[i]);
            let error = self.sum(BLOCK, corner, |i| self.error[i].powi(2)).sqrt() / here;
            if here > 0.01 * light && error < 0.02 {
                let difference = self.sum(BLOCK, corner, ours) / here - 1.0;
                compared.blocks += 1;
                compared.rms += difference * difference;
                compared.worst = compared.worst.max(difference.abs());
                compared.over += usize::from(difference.abs() > 0.03 + 3.0 * error || difference.is_nan());
            }
        }
        compared.rms = (compared.rms / compared.blocks.max(1) as f64).sqrt();
        compared
    }

    /// Median relative difference of a picture of light scattered once from the quadrature, over the pixels with light.
    #[must_use]
    pub fn median(&self, picture: &[f32]) -> f64 {
        let bright = 1e-3 * self.once.iter().sum::<f64>() / self.once.len() as f64;
        let pixels = (0..SIDE * SIDE).filter(|i| !self.masked(i / SIDE, i % SIDE) && self.once[*i] > bright);
        let mut all: Vec<f64> =
            pixels.filter_map(|i| Some((f64::from(*picture.get(i)?) / self.once[i] - 1.0).abs())).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
    }
}
