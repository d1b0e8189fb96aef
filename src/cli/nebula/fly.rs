//! `scotopic nebula fly`: frames along a camera path, shared out to any number of machines and begun again where they broke off.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde_json::json;

use self::frames::{Folder, Shard};
use self::painter::{Painter, Ready, Subject};
use self::way::Way;
use super::cache;
use super::developing::{Darkroom, DevelopArguments, Negative};
use super::eye::bounded;
use super::files::{self, VolumeArguments};
use super::lighting::{Glow, LightingArguments, Model};
use super::out::{Format, Look};
use super::scene::SceneArguments;
use super::triple::Edges;
use crate::cli::sun::picture::Size;
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json, note};
use crate::physics::dust::develop;
use crate::physics::dust::multiple::Settings;
use crate::physics::dust::render::{View, Wish};
use crate::physics::dust::scene::Scene;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Literal;
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
    scotopic nebula fly V.fits --path dome.toml --frames 900 --size 2048 --out dome/ --shard 2/5     the second of five machines\n  \
    scotopic nebula fly V.fits --path in.toml --frames 300 --format exr --through --tolerance 0.01 --out linear/\n\n\
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
    all, and one that is there is left alone, so that the same command goes on where it was broken off. The folder's flight.txt says\n\
    what its frames show, with a digest of each file that went into them: after a change there is a sentence, and nothing is mixed.")]
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
    /// Sides of a frame, pixels: one number, or WIDTHxHEIGHT [default: 512]
    #[arg(long, value_name = "N|WxH")]
    size: Option<Size>,
    #[command(flatten)]
    lighting: LightingArguments,
    /// The renderer that flies: some frames a second, its error as `scotopic nebula view` has it
    #[arg(long)]
    preview: bool,
    #[command(flatten)]
    develop: DevelopArguments,
    /// Folder for frame-00000.png and so on; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Kind of the frames' files: codes for a display, or linear light as `scotopic nebula render` writes it
    #[arg(long, value_name = "KIND", default_value = "png")]
    format: Format,
    /// Beside each frame of linear light what comes through from behind, 0 to 1: frame-00000-through.exr and so on
    #[arg(long)]
    through: bool,
    /// This machine's part: every N-th frame from the I-th
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// When all frames are there, an animated PNG of them
    #[arg(long, value_name = "FILE")]
    apng: Option<PathBuf>,
    /// How long the animated PNG shows a frame, milliseconds
    #[arg(long, value_name = "MS", default_value_t = 40)]
    frame_ms: u16,
    /// Folder of the light that was gathered before [default: scotopic/light in the user's cache folder]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Gather light again, and keep it nowhere
    #[arg(long, conflicts_with = "cache")]
    no_cache: bool,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Files of one flight, opened and checked.
struct Flight {
    way: Way,
    volume: Volume,
    scene: Scene,
    glow: Option<Glow>,
    model: Model,
    literal: Literal,
    settings: Settings,
    wish: Wish,
    size: Size,
    darkroom: Darkroom,
}

impl Flight {
    fn open(arguments: &Arguments) -> Result<Flight, Failure> {
        let way = Way::open(&arguments.path)?;
        let darkroom = arguments.develop.open()?;
        let said = arguments.scene.document()?;
        let volume = files::open(&arguments.volume.volume, arguments.volume.edge.or(said.edge.map(Edges::Longest)))?;
        let scene = arguments.scene.scene(&said)?;
        let glow = arguments.lighting.glow(&volume, scene.bands())?;
        let (model, literal) = arguments.lighting.model(&said)?;
        let size = match (arguments.size, &said.size) {
            (Some(size), _) => size,
            (None, Some(text)) => text.parse().map_err(|error| Failure::asked(format!("size = {error}")))?,
            (None, None) => Size { width: 512, height: 512 },
        };
        Ok(Flight {
            settings: arguments.lighting.settings(&volume, &said),
            wish: arguments.lighting.wish(&said, false)?,
            way,
            volume,
            scene,
            glow,
            model,
            literal,
            size,
            darkroom,
        })
    }

    /// What the frames show, a line for each thing that matters: the same on every machine. Files count by what is in them.
    fn said(&self, arguments: &Arguments) -> String {
        let volume = |volume: &Volume| {
            let ([x, y, z], edges) = (volume.size(), volume.edges());
            format!(
                "{x} x {y} x {z} voxels, edges {}, {}, {}, digest {:016x}",
                edges.x,
                edges.y,
                edges.z,
                volume.digest()
            )
        };
        let glow = self
            .glow
            .as_ref()
            .map_or("none".to_owned(), |glow| format!("{}, bands {:?}", volume(&glow.volume), glow.bands));
        format!(
            "program {} {}\nframes {}\nsize {}x{}\nformat {}, through {}\nmodel {:?}, {:?}\npreview {}\ntolerance {}, step {:?}\n\
             seed {}\nvolume {}\nemission {glow}\ndust {:?}\nstars {:?}\ngathering {:?}\ndevelopment {}\npath {:?}\n",
            env!("CARGO_PKG_NAME"),
            env!("CARGO_PKG_VERSION"),
            arguments.frames,
            self.size.width,
            self.size.height,
            arguments.format.ending(),
            arguments.through,
            self.model,
            self.literal,
            arguments.preview,
            self.wish.tolerance,
            self.wish.step,
            self.wish.seed,
            volume(&self.volume),
            self.scene.dust(),
            self.scene.stars(),
            self.settings,
            self.darkroom.said(),
            self.way,
        )
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
    let format = arguments.format;
    if format != Format::Png && (arguments.apng.is_some() || !arguments.develop.is_usual()) {
        return Err(Failure::asked(
            "frames of linear light are not developed: leave out --white, --gamma, --background and --apng, or give --format png",
        ));
    }
    if format == Format::Png && arguments.through {
        return Err(Failure::asked("--through is for frames of linear light: give --format exr, fits or npy with it"));
    }
    let begin = Instant::now();
    let flight = Flight::open(arguments)?;
    let folder = Folder::open(&arguments.out, frames, &flight.said(arguments))?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let own: Vec<usize> = (0..frames).filter(|frame| shard.has(*frame)).collect();
    let todo: Vec<usize> = own.iter().copied().filter(|frame| !folder.has(*frame, format.ending())).collect();
    let done = if todo.is_empty() { Done::default() } else { make(arguments, &flight, &folder, &todo)? };
    let missing = folder.missing(format.ending());
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
            "worst_believed_error": done.worst,
            "light_from_cache": done.cached,
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
        done.worst.map_or(String::new(), |error| format!(", worst believed error of a pixel {:.2} %", 100.0 * error)),
        animated.map_or(String::new(), |file| format!("; {file}"))
    ))
}

/// What became of the frames.
#[derive(Debug, Clone, Copy, Default)]
struct Done {
    /// The worst error that the renderer believes in, if it looked for one.
    worst: Option<f64>,
    /// The gathered light was in the cache; nothing where none was needed.
    cached: Option<bool>,
}

/// Makes frames.
fn make(arguments: &Arguments, flight: &Flight, folder: &Folder, todo: &[usize]) -> Result<Done, Failure> {
    let Size { width, height } = flight.size;
    let camera = |frame| {
        flight
            .way
            .camera(frame, arguments.frames)
            .map_err(|what| Failure::asked(format!("{}: {what}", arguments.path.display())))
    };
    // A path that cannot be flown to its end is told before the first frame.
    for frame in 0..arguments.frames {
        camera(frame)?;
    }
    let subject = Subject {
        volume: &flight.volume,
        scene: &flight.scene,
        emission: flight.glow.as_ref().map(Glow::emission),
        model: flight.model,
        literal: flight.literal,
        settings: &flight.settings,
        wish: flight.wish,
        preview: arguments.preview,
    };
    let cache = if arguments.no_cache { None } else { arguments.cache.clone().or_else(|| cache::folder("light")) };
    let first = View { camera: camera(0)?, width, height, near: 0.0 };
    bounded(&first, flight.scene.bands())?;
    let mut bar = Bar::new("frames");
    let Ready { mut painter, cached } = Painter::ready(&subject, &first, cache.as_deref(), arguments.quiet)?;
    // One white for all frames, the same on every machine.
    let white = match (arguments.format, flight.darkroom.fixed_white()) {
        (Format::Png, None) => {
            let scale = SAMPLE_SIDE as f64 / width.max(height) as f64;
            let [w, h] = [width, height].map(|side| ((side as f64 * scale.min(1.0)).round() as usize).max(1));
            let mut light = Vec::new();
            for sample in 0..SAMPLES {
                let frame = sample * (arguments.frames - 1) / (SAMPLES - 1);
                light.extend(develop::pixels(&painter.paint(&camera(frame)?, w, h)?.light));
            }
            flight.darkroom.white(&light)
        }
        (_, white) => white.unwrap_or(1.0),
    };
    let ending = arguments.format.ending();
    let mut done = Done { worst: None, cached };
    for (number, frame) in todo.iter().enumerate() {
        if !arguments.quiet {
            bar.show(number as f64 / todo.len() as f64);
        }
        // Another machine with the same part may have been faster.
        if folder.has(*frame, ending) {
            continue;
        }
        let camera = camera(*frame)?;
        let painted = painter.paint(&camera, width, height)?;
        done.worst = painted.error.map(|error| error.max(done.worst.unwrap_or(0.0)));
        let look = Look::default();
        if arguments.through {
            let bytes = arguments.format.encode(width, &painted.through, &look)?;
            folder.save_frame(*frame, &format!("-through.{ending}"), &bytes)?;
        }
        let bytes = if arguments.format == Format::Png {
            let (light, through) = (develop::pixels(&painted.light), develop::pixels(&painted.through));
            let negative = Negative { width, height, camera: &camera, light: &light, through: &through };
            let codes = flight.darkroom.develop(&negative, white)?;
            png::encode_codes(width, height, &codes).map_err(Failure::failed)?
        } else {
            arguments.format.encode(width, &painted.light, &look)?
        };
        folder.save_frame(*frame, &format!(".{ending}"), &bytes)?;
    }
    if !arguments.quiet {
        bar.show(1.0);
    }
    bar.end();
    Ok(done)
}
