//! `scotopic sun sequence`: the Sun as it sets, frame by frame.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use serde_json::json;

use super::picture::PictureArguments;
use super::progress::Bar;
use super::render::white;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::sun::{render, sky};
use crate::picture::apng::Apng;
use crate::picture::png;
use crate::units::Angle;

/// The most frames.
const MOST_FRAMES: usize = 10_000;

/// The scene, the frames, and where they go.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic sun sequence --preset omega --frames 24 --out omega.apng\n  \
    scotopic sun sequence --preset red-flash --from-arcmin -31 --to-arcmin -36 --frames 12 --out frames/\n\n\
    The Sun sinks from one true altitude to the other in even steps; near the equator it sinks 15' a minute. All frames have\n\
    the same frame and the same white.")]
pub struct Arguments {
    #[command(flatten)]
    picture: PictureArguments,
    /// True altitude of the Sun's centre in the first frame, arcminutes [default: the one of `render`]
    #[arg(long, value_name = "ARCMIN", allow_negative_numbers = true, conflicts_with = "sun_altitude_arcmin")]
    from_arcmin: Option<f64>,
    /// True altitude of the Sun's centre in the last frame, arcminutes [default: all of it is set]
    #[arg(long, value_name = "ARCMIN", allow_negative_numbers = true)]
    to_arcmin: Option<f64>,
    /// Number of frames
    #[arg(long, value_name = "N", default_value_t = 24)]
    frames: usize,
    /// How long each frame of an animated PNG is shown, milliseconds
    #[arg(long, value_name = "MS", default_value_t = 120)]
    frame_ms: u16,
    /// A folder for PNG files, or a file ending in .apng or .png for an animated PNG
    #[arg(long, value_name = "DIR|FILE.apng")]
    out: PathBuf,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Makes the frames.
///
/// # Errors
/// The scene cannot be, or a file could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let frames = arguments.frames;
    if !(1..=MOST_FRAMES).contains(&frames) {
        return Err(Failure::asked(format!("{frames} frames: give 1 to {MOST_FRAMES}")));
    }
    let picture = arguments.picture.open()?;
    let (usual, set) = picture.altitudes()?;
    let from = arguments.from_arcmin.map_or(usual, Angle::arcminutes);
    let to = arguments.to_arcmin.map_or(set, Angle::arcminutes);
    let view = picture.view([from, to])?;
    let mut writer = Frames::begin(&arguments.out, view.width, view.height, frames, arguments.frame_ms)?;
    let begin = Instant::now();
    let mut bar = Bar::new("frames");
    let mut level = None;
    for i in 0..frames {
        bar.show(i as f64 / frames as f64);
        let share = if frames == 1 { 0.0 } else { i as f64 / (frames - 1) as f64 };
        let scene = picture.scene(from + (to - from) * share, view);
        let (mut rendered, _) = render(&scene, &|| begin.elapsed()).map_err(Failure::asked)?;
        if let Some(albedo) = picture.sky {
            sky::add(&scene, albedo, &mut rendered, &mut |_| ()).map_err(Failure::asked)?;
        }
        let level = *level.get_or_insert_with(|| white(&picture, &rendered));
        writer.frame(view.width, view.height, &rendered.codes(picture.tone, level))?;
    }
    bar.show(1.0);
    bar.end();
    let files = writer.end()?;
    let seconds = begin.elapsed().as_secs_f64();
    if arguments.json {
        return answer_json(&json!({
            "files": files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
            "frames": frames,
            "from_arcmin": from.to_arcminutes(),
            "to_arcmin": to.to_arcminutes(),
            "seconds": seconds,
        }));
    }
    answer(&format!(
        "{}: {frames} frames, the Sun's centre from {:.3}' to {:.3}' (true altitude), {seconds:.1} s, {}",
        picture.air.name,
        from.to_arcminutes(),
        to.to_arcminutes(),
        arguments.out.display()
    ))
}

/// Where frames go.
pub(super) enum Frames {
    /// Files in a folder.
    Folder { folder: PathBuf, files: Vec<PathBuf> },
    /// One animated file.
    Animated { path: PathBuf, apng: Apng<BufWriter<File>> },
}

impl Frames {
    pub(super) fn begin(
        out: &Path,
        width: usize,
        height: usize,
        frames: usize,
        frame_ms: u16,
    ) -> Result<Frames, Failure> {
        let failed = |error: std::io::Error| Failure::failed(format!("{}: {error}", out.display()));
        let animated = out.extension().is_some_and(|e| e.eq_ignore_ascii_case("apng") || e.eq_ignore_ascii_case("png"));
        if animated {
            let file = BufWriter::new(File::create(out).map_err(failed)?);
            let apng = Apng::begin(file, width, height, frames, frame_ms).map_err(Failure::asked)?;
            return Ok(Frames::Animated { path: out.to_path_buf(), apng });
        }
        std::fs::create_dir_all(out).map_err(failed)?;
        Ok(Frames::Folder { folder: out.to_path_buf(), files: Vec::new() })
    }

    pub(super) fn frame(&mut self, width: usize, height: usize, codes: &[[u8; 3]]) -> Result<(), Failure> {
        match self {
            Frames::Animated { apng, .. } => apng.frame(codes).map_err(Failure::failed),
            Frames::Folder { folder, files } => {
                let bytes = png::encode_codes(width, height, codes).map_err(Failure::failed)?;
                let path = folder.join(format!("frame-{:04}.png", files.len()));
                let failed = |error| Failure::failed(format!("{}: {error}", path.display()));
                File::create(&path).and_then(|mut file| file.write_all(&bytes)).map_err(failed)?;
                files.push(path);
                Ok(())
            }
        }
    }

    pub(super) fn end(self) -> Result<Vec<PathBuf>, Failure> {
        match self {
            Frames::Folder { files, .. } => Ok(files),
            Frames::Animated { path, apng } => {
                apng.end().map_err(Failure::failed)?;
                Ok(vec![path])
            }
        }
    }
}
