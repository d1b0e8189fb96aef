//! How light is scattered and given off, and how exactly it is followed, as flags and scene files say it.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::cache;
use super::files;
use super::scene::Document;
use super::triple::Edges;
use crate::cli::{Failure, note};
use crate::physics::dust::drawing::Light;
use crate::physics::dust::march::Emission;
use crate::physics::dust::multiple::{self, Field, Settings};
use crate::physics::dust::render::Wish;
use crate::physics::dust::scene::Scene;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Literal;

/// Relative error of a pixel where nothing is said: pictures are within a 512th of what they are with nothing left out.
pub const USUAL_TOLERANCE: f64 = 1e-3;
/// Gathered light in the user's cache, all of it together: the oldest goes first.
const MOST_KEPT: u64 = 512 << 20;
/// Larger fields are not kept.
const LARGEST_KEPT: usize = 256 << 20;

/// How light is scattered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Model {
    /// The thesis': each voxel by the scattering table
    Table,
    /// Light that has been scattered once, exactly
    Single,
    /// Single, and light that has been scattered before
    Multiple,
}

/// A formula of the thesis that may be taken as it is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LiteralForm {
    /// Equation 5.2: times the albedo once more
    Albedo,
    /// Equation 5.7: the eye's ray is dimmed by depth / albedo
    Depth,
}

/// The model and its settings.
#[derive(Debug, Clone, Args)]
pub struct LightingArguments {
    /// How light is scattered [default: multiple]
    #[arg(long, value_name = "NAME")]
    model: Option<Model>,
    /// For table: a formula of the thesis as it is printed, again for more [default: the corrected forms]
    #[arg(long, value_name = "FORM", value_delimiter = ',')]
    literal: Vec<LiteralForm>,
    /// Relative error of a pixel to stay below [default: 0.001]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Longest piece of a ray, voxels [default: what the tolerance needs]
    #[arg(long, value_name = "VOXELS", allow_negative_numbers = true)]
    step: Option<f64>,
    /// For multiple: most flights of photons [default: 1000000]
    #[arg(long, value_name = "N")]
    flights: Option<u64>,
    /// For multiple: highest order of spherical harmonics, 0 to 8 [default: 4]
    #[arg(long, value_name = "L")]
    harmonics: Option<usize>,
    /// For multiple: cells along the longest edge [default: half the voxels, 16 to 32]
    #[arg(long, value_name = "N")]
    cells: Option<usize>,
    /// Light that the dust itself gives off: a volume in the same box
    #[arg(long, value_name = "FILE")]
    emission: Option<PathBuf>,
    /// Its radiance per unit of length at 1, a number for each band [default: 1]
    #[arg(long, value_name = "E[,E...]", value_delimiter = ',', allow_hyphen_values = true, requires = "emission")]
    emission_bands: Option<Vec<f64>>,
    /// Seed of photons and of the rays on which errors are measured [default: 1]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
}

/// A volume that glows.
pub struct Glow {
    /// How much, relative.
    pub volume: Volume,
    /// Times this, band by band.
    pub bands: Vec<f64>,
}

impl Glow {
    /// As the renderer takes it.
    #[must_use]
    pub fn emission(&self) -> Emission<'_> {
        Emission { volume: &self.volume, bands: &self.bands }
    }
}

/// Gathered light, and whether it was there before.
pub struct Gathered {
    /// The light.
    pub field: Field,
    /// It came from the cache.
    pub cached: bool,
}

impl LightingArguments {
    /// What error is asked for, and how.
    ///
    /// # Errors
    /// A tolerance or a step that cannot be.
    pub fn wish(&self, said: &Document, everything: bool) -> Result<Wish, Failure> {
        let tolerance = self.tolerance.or(said.tolerance).unwrap_or(USUAL_TOLERANCE);
        if !(1e-6..=0.5).contains(&tolerance) {
            return Err(Failure::asked(format!("a tolerance of {tolerance}: give a relative error from 1e-6 to 0.5")));
        }
        let step = self.step.or(said.step);
        if let Some(step) = step.filter(|step| !(0.01..=64.0).contains(step)) {
            return Err(Failure::asked(format!("a step of {step} voxels: give 0.01 to 64")));
        }
        Ok(Wish { tolerance, step, everything, seed: self.seed.or(said.seed).unwrap_or(1) })
    }

    /// The model, and the formulas of the thesis that are taken as printed.
    ///
    /// # Errors
    /// A model that is not there, or literal forms without the table.
    pub fn model(&self, said: &Document) -> Result<(Model, Literal), Failure> {
        let model = match (self.model, &said.model) {
            (Some(model), _) => model,
            (None, Some(name)) => Model::from_str(name, false).map_err(|_unknown| {
                Failure::asked(format!("model = '{name}': there are table, single and multiple"))
            })?,
            (None, None) => Model::Multiple,
        };
        let has = |form| self.literal.contains(&form) || said.literal.contains(&form);
        let literal = Literal { albedo: has(LiteralForm::Albedo), depth: has(LiteralForm::Depth) };
        if model != Model::Table && literal != Literal::default() {
            return Err(Failure::asked(
                "literal forms are those of the table: give --model table with them, or leave --literal out",
            ));
        }
        Ok((model, literal))
    }

    /// The light of the dust itself, if there is any.
    ///
    /// # Errors
    /// A file that is no volume, or numbers that are no light.
    pub fn glow(&self, volume: &Volume, bands: usize) -> Result<Option<Glow>, Failure> {
        let Some(path) = &self.emission else { return Ok(None) };
        let volume = files::open(path, Some(Edges::Each(volume.edges())))?;
        let glow = match self.emission_bands.as_deref() {
            None => vec![1.0; bands],
            Some([one]) => vec![*one; bands],
            Some(list) => list.to_vec(),
        };
        if glow.len() != bands || glow.iter().any(|light| !(light.is_finite() && *light >= 0.0)) {
            return Err(Failure::asked(format!(
                "--emission-bands {glow:?}: give one number of 0 or more, or one for each of {bands} bands"
            )));
        }
        Ok(Some(Glow { volume, bands: glow }))
    }

    /// How light is gathered.
    #[must_use]
    pub fn settings(&self, volume: &Volume, said: &Document) -> Settings {
        let usual = Settings::fitting(volume);
        Settings {
            order: self.harmonics.unwrap_or(usual.order),
            cells: self.cells.unwrap_or(usual.cells),
            flights: self.flights.unwrap_or(usual.flights),
            seed: self.seed.or(said.seed).unwrap_or(usual.seed),
            ..usual
        }
    }
}

/// Gathers light, or takes what a folder holds of this dust, these stars and these settings.
///
/// # Errors
/// Settings that cannot be. A folder that cannot be written is only noted.
pub fn gathered(
    volume: &Volume,
    scene: &Scene,
    settings: &Settings,
    folder: Option<&Path>,
) -> Result<Gathered, Failure> {
    // The first number changes when light is gathered in another way.
    let key = format!("1;{:016x};{scene:?};{settings:?}", volume.digest());
    let path = folder.map(|folder| cache::path(folder, &key, "field"));
    if let Some(field) = path.as_deref().and_then(|path| remembered(path, &key)) {
        return Ok(Gathered { field, cached: true });
    }
    let field = multiple::gather(volume, scene, settings).map_err(Failure::asked)?;
    if let (Some(folder), Some(path)) = (folder, path) {
        let mut bytes = field.to_bytes();
        bytes.extend(key.as_bytes());
        bytes.extend((key.len() as u64).to_le_bytes());
        if bytes.len() <= LARGEST_KEPT {
            match cache::keep(&path, &bytes) {
                Ok(()) => cache::trim(folder, "field", MOST_KEPT),
                Err(error) => note(&format!("the gathered light is not kept: {}: {error}", path.display())),
            }
        }
    }
    Ok(Gathered { field, cached: false })
}

/// Light that was kept under a key.
fn remembered(path: &Path, key: &str) -> Option<Field> {
    let length = std::fs::metadata(path).ok()?.len();
    let bytes = (length <= LARGEST_KEPT as u64).then(|| std::fs::read(path).ok())??;
    let (rest, length) = bytes.split_last_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let (field, there) = rest.split_at_checked(rest.len().checked_sub(length)?)?;
    if there != key.as_bytes() {
        return None;
    }
    Field::from_bytes(field)
}

/// The table for pictures of a volume, as a model of light.
///
/// # Errors
/// A table that cannot be.
pub fn table(volume: &Volume, scene: &Scene, literal: Literal, quiet: bool) -> Result<Light, Failure> {
    let dust = scene.dust();
    let table = super::table::for_pictures(dust.albedo, dust.phase, deepest_voxel(volume, scene), quiet)?;
    Ok(Light::Table(Box::new(table), literal))
}

/// Depth of extinction along the edge of the densest voxel, in the band with the most: how far the table has to go.
fn deepest_voxel(volume: &Volume, scene: &Scene) -> f64 {
    let most = volume.density().iter().copied().fold(0.0, f32::max);
    let voxel = volume.voxel();
    let edge = (voxel.x * voxel.y * voxel.z).cbrt();
    let steepest = scene.dust().extinction.iter().copied().fold(0.0, f64::max);
    // The table's rows are at most 10000 deep along a radius, and thin dust needs a table too.
    (f64::from(most) * edge * steepest * 1.000_001).clamp(1e-3, 1e4)
}
