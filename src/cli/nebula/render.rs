//! `scotopic nebula render`: the accurate picture of a nebula, with its error.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::json;

use super::eye::{EyeArguments, bounded};
use super::files::{self, VolumeArguments};
use super::lighting::{self, Glow, LightingArguments, Model};
use super::out;
use super::scene::{Document, SceneArguments};
use super::triple::Edges;
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::dust::drawing::{Drawing, Light, Prepared};
use crate::physics::dust::multiple;
use crate::physics::dust::multiple::field::Told;
use crate::physics::dust::render::{Rendered, View, Wish};
use crate::physics::dust::scene::Scene;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Literal;

/// What is told of a picture.
mod explain;

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
    #[command(flatten)]
    lighting: LightingArguments,
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
        out::Format::of(path)?;
    }
    let said = arguments.scene.document()?;
    let (scene, wish) = (arguments.scene.scene(&said)?, arguments.lighting.wish(&said, arguments.everything)?);
    let (model, literal) = arguments.lighting.model(&said)?;
    let edge = arguments.volume.edge.or(said.edge.map(Edges::Longest));
    let volume = files::open(&arguments.volume.volume, edge)?;
    let view = arguments.eye.view(&said, &volume)?;
    bounded(&view, scene.bands())?;
    let glow = arguments.lighting.glow(&volume, scene.bands())?;
    let emission = glow.as_ref().map(Glow::emission);

    let begin = Instant::now();
    if let Some(orders) = arguments.orders {
        if glow.is_some() {
            return Err(Failure::asked(
                "--orders parts the stars' light by how often it was scattered, and the dust's own was never: leave --emission out",
            ));
        }
        return arguments.by_order(&volume, &scene, &view, &wish, (orders, &said));
    }
    let (light, told) = arguments.light((model, literal), &volume, &scene, &said)?;
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
    fn light(
        &self,
        (model, literal): (Model, Literal),
        volume: &Volume,
        scene: &Scene,
        said: &Document,
    ) -> Result<(Light, Option<Told>), Failure> {
        match model {
            Model::Single => Ok((Light::Single, None)),
            Model::Multiple => {
                let settings = self.lighting.settings(volume, said);
                let field = multiple::gather(volume, scene, &settings).map_err(Failure::asked)?;
                let told = field.told();
                Ok((Light::Multiple(Box::new(field)), Some(told)))
            }
            Model::Table => Ok((lighting::table(volume, scene, literal, self.quiet)?, None)),
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
    fn by_order(
        &self,
        volume: &Volume,
        scene: &Scene,
        view: &View,
        wish: &Wish,
        (orders, said): (usize, &Document),
    ) -> Result<(), Failure> {
        if !(1..=20).contains(&orders) {
            return Err(Failure::asked(format!("--orders {orders}: give 1 to 20")));
        }
        let mut lights = vec![Light::Single];
        if orders > 1 {
            let settings = self.lighting.settings(volume, said);
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
