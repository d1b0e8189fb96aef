//! `scotopic nebula fly`: frames along a camera path, shared out to any number of machines and begun again where they broke off.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde_json::json;

use self::frames::{Folder, Shard};
use self::painter::{Model, Painter};
use self::way::Way;
use super::developing::{Darkroom, DevelopArguments, Negative};
use super::files::{self, VolumeArguments};
use super::scene::SceneArguments;
use super::triple::Edges;
use crate::cli::sun::picture::Size;
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json, note};
use crate::physics::dust::march::Emission;
use crate::picture::png;

/// Numbered frames.
pub mod frames;
/// The renderers.
mod painter;
/// Camera paths in files.
pub mod way;

/// The most frames.
const MOST_FRAMES: usize = 100_000;

/// Small pictures along the path by which one white is found for all.
const SAMPLES: usize = 9;
/// Their longest side, pixels.
const SAMPLE_SIDE: usize = 64;

/// The flight.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula fly V.fits --path orbit.toml --frames 120 --out orbit/ --apng orbit.png\n  \
    scotopic nebula fly V.fits --path in.toml --frames 300 --size 512 --preview --out in/ --star 0,0,0,12000\n  \
    scotopic nebula fly V.fits --path dome.toml --frames 900 --size 2048 --out dome/ --shard 2/5     the second of five machines\n\n\
    A path:\n\n  \
    fov_deg = 50                    # view = \"perspective\" (or \"domemaster\", or \"orthographic\" with a width)\n  \
    [[key]]\n  \
    time = 0\n  \
    eye = [0, 1, 4]                 # look_at = [0, 0, 0], up = [0, 1, 0]\n  \
    [[key]]\n  \
    time = 5\n  \
    eye = [0, 0, 0.5]\n  \
    fov_deg = 80\n\n\
    or [orbit] with radius, centre, elevation_deg, from_deg, turns. Frames are evenly spaced in time. Each is written whole or not at\n\
    all, and one that is there is left alone, so that the same command goes on where it was broken off.")]
pub struct Arguments {
    #[command(flatten)]
    volume: VolumeArguments,
    #[command(flatten)]
    scene: SceneArguments,
    /// The camera's path, a TOML file
    #[arg(long, value_name = "PATH.toml")]
    path: PathBuf,
    /// Number of frames
    #[arg(long, value_name = "N", default_value_t = 120)]
    frames: usize,
    /// Sides of a frame, pixels: one number, or WIDTHxHEIGHT
    #[arg(long, value_name = "N|WxH", default_value = "512")]
    size: Size,
    /// Where light comes from that reaches the eye: scattered once, any number of times, or by the thesis' table
    #[arg(long, value_enum, default_value_t = Model::Multiple)]
    model: Model,
    /// The renderer that flies: some frames a second, its error as `scotopic nebula view` has it
    #[arg(long)]
    preview: bool,
    /// Relative error of a pixel to stay below, of frames that are no preview
    #[arg(long, value_name = "SHARE", default_value_t = 0.02, allow_negative_numbers = true)]
    tolerance: f64,
    /// Light that the dust itself gives off: a volume in the same box
    #[arg(long, value_name = "FILE")]
    emission: Option<PathBuf>,
    /// Its radiance per unit of length at 1
    #[arg(long, value_name = "E", default_value_t = 1.0, allow_negative_numbers = true, requires = "emission")]
    emission_light: f64,
    /// Seed of the photons
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    develop: DevelopArguments,
    /// Folder for frame-00000.png and so on; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// This machine's part: every N-th frame from the I-th
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// When all frames are there, an animated PNG of them
    #[arg(long, value_name = "FILE")]
    apng: Option<PathBuf>,
    /// How long the animated PNG shows a frame, milliseconds
    #[arg(long, value_name = "MS", default_value_t = 40)]
    frame_ms: u16,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// What the frames show, a line for each thing that matters: the same on every machine.
    fn settings(&self) -> Result<String, Failure> {
        let path = std::fs::read_to_string(&self.path)
            .map_err(|error| Failure::asked(format!("{}: {error}", self.path.display())))?;
        let said = self.scene.document()?;
        Ok(format!(
            "frames {}\nsize {}x{}\nmodel {:?}\npreview {}\ntolerance {}\nseed {}\nvolume {} {:?}\nemission {:?} {}\nscene {:?} {:?}\n\
             develop {:?}\npath {:?}\n",
            self.frames,
            self.size.width,
            self.size.height,
            self.model,
            self.preview,
            self.tolerance,
            self.seed,
            self.volume.volume.display(),
            self.volume.edge,
            self.emission,
            self.emission_light,
            self.scene,
            said,
            self.develop,
            path,
        ))
    }
}

/// Makes the frames that are missing.
///
/// # Errors
/// What was asked cannot be, or a file could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let frames = arguments.frames;
    if !(1..=MOST_FRAMES).contains(&frames) {
        return Err(Failure::asked(format!("{frames} frames: give 1 to {MOST_FRAMES}")));
    }
    let begin = Instant::now();
    let way = Way::open(&arguments.path)?;
    let darkroom = arguments.develop.open()?;
    let folder = Folder::open(&arguments.out, frames, &arguments.settings()?)?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let own: Vec<usize> = (0..frames).filter(|frame| shard.has(*frame)).collect();
    let todo: Vec<usize> = own.iter().copied().filter(|frame| !folder.has(*frame, "png")).collect();
    let worst = if todo.is_empty() { None } else { make(arguments, &way, &darkroom, &folder, &todo)? };
    let missing = folder.missing("png");
    let mut animated = None;
    if let Some(file) = &arguments.apng {
        if missing == 0 {
            folder.animate(file, arguments.frame_ms)?;
            animated = Some(file.display().to_string());
        } else {
            note(&format!(
                "{missing} frames of other machines are missing: the animated PNG is made by the last of them"
            ));
        }
    }
    let seconds = begin.elapsed().as_secs_f64();
    if arguments.json {
        return answer_json(&json!({
            "worst_believed_error": worst,
            "out": arguments.out.display().to_string(),
            "made": todo.len(),
            "left_alone": own.len() - todo.len(),
            "missing": missing,
            "apng": animated,
            "seconds": seconds,
        }));
    }
    answer(&format!(
        "{}: {} frames made, {} left alone, {missing} missing, {seconds:.1} s{}{}",
        arguments.out.display(),
        todo.len(),
        own.len() - todo.len(),
        worst.map_or(String::new(), |error| format!(", worst believed error of a pixel {:.2} %", 100.0 * error)),
        animated.map_or(String::new(), |file| format!("; {file}"))
    ))
}

/// Makes frames; the worst error that the renderer believes in, if it looks for one.
fn make(
    arguments: &Arguments,
    way: &Way,
    darkroom: &Darkroom,
    folder: &Folder,
    todo: &[usize],
) -> Result<Option<f64>, Failure> {
    let Size { width, height } = arguments.size;
    let camera = |frame| {
        way.camera(frame, arguments.frames)
            .map_err(|what| Failure::asked(format!("{}: {what}", arguments.path.display())))
    };
    // A path that cannot be flown to its end is told before the first frame.
    for frame in 0..arguments.frames {
        camera(frame)?;
    }
    let said = arguments.scene.document()?;
    let volume = files::open(&arguments.volume.volume, arguments.volume.edge.or(said.edge.map(Edges::Longest)))?;
    let scene = arguments.scene.scene(&said)?;
    let mut bar = Bar::new("frames");
    let glow = match &arguments.emission {
        Some(path) => Some(files::open(path, Some(Edges::Each(volume.edges())))?),
        None => None,
    };
    let bands = vec![arguments.emission_light; scene.bands()];
    let emission = glow.as_ref().map(|volume| Emission { volume, bands: &bands });
    let mut painter = Painter::new(&volume, &scene, emission, &camera(0)?, arguments)?;
    // One white for all frames, the same on every machine.
    let white = match darkroom.fixed_white() {
        Some(white) => white,
        None => {
            let scale = SAMPLE_SIDE as f64 / width.max(height) as f64;
            let [w, h] = [width, height].map(|side| ((side as f64 * scale.min(1.0)).round() as usize).max(1));
            let mut light = Vec::new();
            for sample in 0..SAMPLES {
                let frame = sample * (arguments.frames - 1) / (SAMPLES - 1);
                light.extend(painter.paint(&camera(frame)?, w, h)?.light);
            }
            darkroom.white(&light)
        }
    };
    let mut worst = None;
    for (done, frame) in todo.iter().enumerate() {
        if !arguments.quiet {
            bar.show(done as f64 / todo.len() as f64);
        }
        // Another machine with the same part may have been faster.
        if folder.has(*frame, "png") {
            continue;
        }
        let camera = camera(*frame)?;
        let painted = painter.paint(&camera, width, height)?;
        worst = painted.error.map(|error| error.max(worst.unwrap_or(0.0)));
        let negative = Negative { width, height, camera: &camera, light: &painted.light, through: &painted.through };
        let codes = darkroom.develop(&negative, white)?;
        let bytes = png::encode_codes(width, height, &codes).map_err(Failure::failed)?;
        folder.save_frame(*frame, "png", &bytes)?;
    }
    if !arguments.quiet {
        bar.show(1.0);
    }
    bar.end();
    Ok(worst)
}
