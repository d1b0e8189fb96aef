//! `scotopic nebula render`: the accurate picture of a nebula, with its error.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use serde_json::json;

use super::eye::EyeArguments;
use super::files::{self, VolumeArguments};
use super::out;
use super::scene::{Document, SceneArguments};
use super::triple::Edges;
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::dust::drawing::{Drawing, Light, Prepared};
use crate::physics::dust::march::Emission;
use crate::physics::dust::multiple::field::Told;
use crate::physics::dust::multiple::{self, Settings};
use crate::physics::dust::render::{Rendered, View, Wish};
use crate::physics::dust::scene::Scene;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Literal;

/// What is told of a picture.
mod explain;

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

/// The nebula, the eye and where the picture goes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula render V.fits --out nebula.png\n  \
    scotopic nebula render V.fits --star 0,0,0,20000 --view perspective --eye 1.5,1,2 --fov-deg 35 --out nebula.exr\n  \
    scotopic nebula render V.fits --view domemaster --eye 0.2,0,0.3 --size 1024 --out dome.png --explain\n  \
    scotopic nebula render GRID.npy --edge 2 --extinction 4 --albedo 0.6 --asymmetry 0.6 --star=0.15,0.1,-0.2 \\\n      \
        --model single --view orthographic --size 64x64 --out X.npy\n  \
    scotopic nebula render V.fits --scene five-stars.toml --model single --everything --explain --out check.fits\n\n\
    The picture is linear radiance, averaged over each pixel, one plane for each band: .npy ([row, col] or [plane, row, col],\n\
    f32), .fits, .exr, and .png (normalised, red green blue). The direct light of the stars is not drawn. A scene file has\n\
    the flags' names as keys (look_at, fov_deg, wavelengths_nm ...) and [[star]] tables with position, kelvin, intensity.")]
pub struct Arguments {
    #[command(flatten)]
    volume: VolumeArguments,
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    eye: EyeArguments,
    /// How light is scattered [default: multiple]
    #[arg(long, value_name = "NAME")]
    model: Option<Model>,
    /// For table: a formula of the thesis as it is printed, again for more [default: the corrected forms]
    #[arg(long, value_name = "FORM", value_delimiter = ',')]
    literal: Vec<LiteralForm>,
    /// The picture, again for more: .npy, .fits, .exr, .png
    #[arg(long, value_name = "FILE", required = true)]
    out: Vec<PathBuf>,
    /// What comes through from behind, 0 to 1, for each band: to lay the nebula over a picture
    #[arg(long, value_name = "FILE")]
    through: Option<PathBuf>,
    /// The believed relative error of each pixel, one plane
    #[arg(long, value_name = "FILE")]
    errors: Option<PathBuf>,
    /// One picture for each number of scatterings, up to N (the last holds all that follow): FILE-1, FILE-2, ...
    #[arg(long, value_name = "N")]
    orders: Option<usize>,
    /// Relative error to stay below [default: 0.001]
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
    /// For .png: the light that is shown as full [default: the brightest but for 0.5 % of the pixels]
    #[arg(long, value_name = "RADIANCE", allow_negative_numbers = true)]
    white: Option<f64>,
    /// For .png: codes are light to the power of 1/GAMMA [default: sRGB's curve]
    #[arg(long, value_name = "GAMMA", allow_negative_numbers = true)]
    gamma: Option<f64>,
    /// Leave nothing out (slow), and say how far the quick picture is from it
    #[arg(long)]
    everything: bool,
    /// Say what was left out and why, and the error reached
    #[arg(long)]
    explain: bool,
    /// Seed of photons and of the rays on which errors are measured [default: 1]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Print no notes and no progress
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// All that was done for one picture.
struct Made {
    rendered: Rendered,
    prepared: Option<Prepared>,
    model_error: f64,
    leaves_out: Option<&'static str>,
    name: &'static str,
    time: Duration,
}

/// Makes the picture.
///
/// # Errors
/// The volume or the scene cannot be, or a file could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    for path in arguments.out.iter().chain(&arguments.through).chain(&arguments.errors) {
        out::check_ending(path)?;
    }
    let said = arguments.scene.document()?;
    let (scene, wish, model) = (arguments.scene.scene(&said)?, arguments.wish(&said)?, arguments.model(&said)?);
    let edge = arguments.volume.edge.or(said.edge.map(Edges::Longest));
    let volume = files::open(&arguments.volume.volume, edge)?;
    let view = arguments.eye.view(&said, &volume)?;
    let glow = match &arguments.emission {
        Some(path) => {
            let glow = files::open(path, Some(Edges::Each(volume.edges())))?;
            Some((glow, arguments.glow_bands(scene.bands())?))
        }
        None => None,
    };
    let emission = glow.as_ref().map(|(volume, bands)| Emission { volume, bands });

    if model != Model::Table && arguments.literal(&said) != Literal::default() {
        return Err(Failure::asked(
            "literal forms are those of the table: give --model table with them, or leave --literal out",
        ));
    }
    let begin = Instant::now();
    if let Some(orders) = arguments.orders {
        return arguments.by_order(&volume, &scene, &view, &wish, orders);
    }
    let (light, told) = arguments.light(model, &volume, &scene, &said)?;
    let light_time = begin.elapsed();
    let quick = Wish { everything: false, ..wish };
    let made = arguments.draw(Drawing::new(&volume, &scene, light.clone(), emission), &view, &quick);
    // With everything, the picture is the slow one, and the quick one is held against it.
    let (made, against) = if arguments.everything {
        let slow = arguments.draw(Drawing::new(&volume, &scene, light, emission), &view, &wish);
        let against = explain::difference(&made, &slow);
        (slow, Some(against))
    } else {
        (made, None)
    };
    let mut files = Vec::new();
    let look = out::Look { white: arguments.white, gamma: arguments.gamma };
    for path in &arguments.out {
        out::save(path, made.rendered.width, &made.rendered.radiance, &look)?;
        files.push(path.display().to_string());
    }
    if let Some(path) = &arguments.through {
        out::save(path, made.rendered.width, &made.rendered.through, &out::Look { white: Some(1.0), gamma: None })?;
        files.push(path.display().to_string());
    }
    if let Some(path) = &arguments.errors {
        let errors = std::slice::from_ref(&made.rendered.believed);
        out::save(path, made.rendered.width, errors, &out::Look::default())?;
        files.push(path.display().to_string());
    }
    if !arguments.quiet {
        files.iter().for_each(|file| eprintln!("wrote {file}"));
    }
    let facts = explain::Facts { made: &made, view: &view, wish: &wish, told, light_time, against, files: &files };
    if arguments.json {
        return answer_json(&facts.json());
    }
    answer(&if arguments.explain { facts.long() } else { facts.short() })
}

impl Arguments {
    fn wish(&self, said: &Document) -> Result<Wish, Failure> {
        let tolerance = self.tolerance.or(said.tolerance).unwrap_or(1e-3);
        if !(1e-6..=0.5).contains(&tolerance) {
            return Err(Failure::asked(format!("a tolerance of {tolerance}: give a relative error from 1e-6 to 0.5")));
        }
        let step = self.step.or(said.step);
        if let Some(step) = step.filter(|step| !(0.01..=64.0).contains(step)) {
            return Err(Failure::asked(format!("a step of {step} voxels: give 0.01 to 64")));
        }
        let seed = self.seed.or(said.seed).unwrap_or(1);
        Ok(Wish { tolerance, step, everything: self.everything, seed })
    }

    fn model(&self, said: &Document) -> Result<Model, Failure> {
        match (self.model, &said.model) {
            (Some(model), _) => Ok(model),
            (None, Some(name)) => Model::from_str(name, false)
                .map_err(|_unknown| Failure::asked(format!("model = '{name}': there are table, single and multiple"))),
            (None, None) => Ok(Model::Multiple),
        }
    }

    fn glow_bands(&self, bands: usize) -> Result<Vec<f64>, Failure> {
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
        Ok(glow)
    }

    fn settings(&self, volume: &Volume, said: &Document) -> Settings {
        let usual = Settings::fitting(volume);
        Settings {
            order: self.harmonics.unwrap_or(usual.order),
            cells: self.cells.unwrap_or(usual.cells),
            flights: self.flights.unwrap_or(usual.flights),
            seed: self.seed.or(said.seed).unwrap_or(usual.seed),
            ..usual
        }
    }

    /// The formulas of the thesis that are taken as printed, from flags and scene file together.
    fn literal(&self, said: &Document) -> Literal {
        let has = |form| self.literal.contains(&form) || said.literal.contains(&form);
        Literal { albedo: has(LiteralForm::Albedo), depth: has(LiteralForm::Depth) }
    }

    fn light(
        &self,
        model: Model,
        volume: &Volume,
        scene: &Scene,
        said: &Document,
    ) -> Result<(Light, Option<Told>), Failure> {
        match model {
            Model::Single => Ok((Light::Single, None)),
            Model::Multiple => {
                let field = multiple::gather(volume, scene, &self.settings(volume, said)).map_err(Failure::asked)?;
                let told = field.told();
                Ok((Light::Multiple(Box::new(field)), Some(told)))
            }
            Model::Table => {
                let table = super::table::for_pictures(
                    scene.dust().albedo,
                    scene.dust().phase,
                    deepest_voxel(volume, scene),
                    self.quiet,
                )?;
                Ok((Light::Table(Box::new(table), self.literal(said)), None))
            }
        }
    }

    fn draw(&self, mut drawing: Drawing<'_>, view: &View, wish: &Wish) -> Made {
        let begin = Instant::now();
        let quiet = self.quiet;
        let shown = |bar: &mut Bar, share| {
            if !quiet {
                bar.show(share);
            }
        };
        let mut bar = Bar::new("star light");
        let prepared = drawing.prepare(view, wish, &mut |share| shown(&mut bar, share));
        bar.end();
        let mut bar = Bar::new(if wish.everything { "the picture, nothing left out" } else { "the picture" });
        let rendered = drawing.draw(view, wish, &mut |share| shown(&mut bar, share));
        bar.end();
        Made {
            rendered,
            prepared,
            model_error: drawing.model_error(),
            leaves_out: drawing.leaves_out(),
            name: drawing.name(),
            time: begin.elapsed(),
        }
    }

    /// One picture for each number of scatterings.
    fn by_order(&self, volume: &Volume, scene: &Scene, view: &View, wish: &Wish, orders: usize) -> Result<(), Failure> {
        if !(1..=20).contains(&orders) {
            return Err(Failure::asked(format!("--orders {orders}: give 1 to 20")));
        }
        let mut lights = vec![Light::Single];
        if orders > 1 {
            let settings = self.settings(volume, &Document::default());
            let fields = multiple::gather_by_order(volume, scene, &settings, orders - 1).map_err(Failure::asked)?;
            lights.extend(fields.into_iter().map(|field| Light::Before(Box::new(field))));
        }
        let mut means = Vec::new();
        for (light, order) in lights.into_iter().zip(1usize..) {
            let made = self.draw(Drawing::new(volume, scene, light, None), view, wish);
            means.push(explain::means(&made.rendered));
            for path in &self.out {
                let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
                let ending = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
                let path = path.with_file_name(format!("{stem}-{order}.{ending}"));
                let look = out::Look { white: self.white, gamma: self.gamma };
                out::save(&path, made.rendered.width, &made.rendered.radiance, &look)?;
                if !self.quiet {
                    eprintln!("wrote {}", path.display());
                }
            }
        }
        if self.json {
            return answer_json(&json!({ "mean_radiance_by_order": means }));
        }
        let line = |(order, bands): (usize, &Vec<f64>)| {
            let bands: Vec<String> = bands.iter().map(|mean| format!("{mean:.6}")).collect();
            format!("{order} scatterings: mean radiance {}", bands.join(", "))
        };
        let lines: Vec<String> = (1..).zip(&means).map(line).collect();
        answer(&lines.join("\n"))
    }
}

/// Depth of extinction along the edge of the densest voxel, in the band with the most: how far the table has to go.
pub(super) fn deepest_voxel(volume: &Volume, scene: &Scene) -> f64 {
    let most = volume.density().iter().copied().fold(0.0, f32::max);
    let voxel = volume.voxel();
    let edge = (voxel.x * voxel.y * voxel.z).cbrt();
    let steepest = scene.dust().extinction.iter().copied().fold(0.0, f64::max);
    // The table's rows are at most 10000 deep along a radius, and thin dust needs a table too.
    (f64::from(most) * edge * steepest * 1.000_001).clamp(1e-3, 1e4)
}
