//! `scotopic nebula view`: a flight through a nebula in the terminal, in red.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use clap::Args;
use glam::DVec3;

use self::seen::Seen;
use super::files::VolumeArguments;
use super::scene::SceneArguments;
use crate::cli::{Failure, note};
use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::fast::{Flyer, Frame, Quality};
use crate::physics::dust::multiple::{self, Field, Settings};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::scene::{Dust, Scene, Star};
use crate::physics::dust::volume::Volume;
use crate::picture::Picture;
use crate::tui::keys::{self, Input};
use crate::tui::nebula::{Did, Flight, Told, draw};
use crate::tui::terminal::Taken;
use crate::tui::theme::{Depth, STEPS, Theme};

/// How much a frame shows.
mod seen;

/// Flights of photons for the light that has scattered more than once, while flying: a second or two.
const FLIGHTS: u64 = 400_000;

/// With the first two qualities steps are as long as leaves each pixel within this share of the brightest.
const TOLERANCE: f32 = 1.0 / 512.0;

/// What 1 to 4 choose.
const QUALITIES: [(&str, Quality); 4] = [
    ("full", Quality::FULL),
    ("between rays", Quality::FLYING),
    ("moving", Quality::MOVING),
    ("draft", Quality::DRAFT),
];

/// The dust, and what lights it.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula view V.fits\n  \
    scotopic nebula view V.fits --star 0,0,0,12000 --star=-0.4,0.3,0.1,20000,0.5 --extinction 3,4,5.3\n\n\
    Keys: arrows orbit, + and - go in and out, space turns by itself, ? shows all. Frames are rendered at --size and shown in the\n\
    terminal's cells; frames a second are those rendered. Light that has scattered more than once is gathered beside the flight,\n\
    again after each change; until then the picture holds that of before, and says so.")]
pub struct Arguments {
    #[command(flatten)]
    volume: VolumeArguments,
    #[command(flatten)]
    scene: SceneArguments,
    /// Pixels of a frame
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "512x512", value_parser = size)]
    size: (usize, usize),
    /// Only light that has scattered once
    #[arg(long)]
    single: bool,
    /// Turn by itself for so many seconds without a terminal, then say how many frames a second there were
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    turn_for: Option<f64>,
    /// With --turn-for: 1 (full) to 4 (draft), as the keys
    #[arg(long, value_name = "1-4", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=4))]
    quality: u8,
    /// With --turn-for: the figures for programs
    #[arg(long, requires = "turn_for")]
    json: bool,
}

fn size(text: &str) -> Result<(usize, usize), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    match sides {
        Some((w, h)) if (1..=8192).contains(&w) && (1..=8192).contains(&h) => Ok((w, h)),
        _ => Err(format!("'{text}': give width and height in pixels, 1 to 8192, such as 512x512")),
    }
}

/// Flies.
///
/// # Errors
/// The volume, the scene or the terminal.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let volume = Arc::new(arguments.volume.open()?);
    let document = arguments.scene.document()?;
    let scene = arguments.scene.scene(&document)?;
    let flyer = Flyer::new(&volume, &scene, None).map_err(Failure::asked)?;
    let flight = Flight::new(scene.dust().albedo, scene.dust().phase.asymmetry(), scene.stars().len());
    let mut flying = Flying {
        volume,
        said: scene.clone(),
        flyer,
        flight,
        size: arguments.size,
        single: arguments.single,
        gathering: None,
        stale: false,
        white: 0.0,
        step: None,
    };
    flying.gather(&scene);
    match arguments.turn_for {
        Some(seconds) => flying.turn_for(seconds, usize::from(arguments.quality) - 1, arguments.json),
        None => flying.in_terminal(),
    }
}

/// A flight under way.
struct Flying {
    volume: Arc<Volume>,
    /// The scene as it was asked for.
    said: Scene,
    flyer: Flyer,
    flight: Flight,
    size: (usize, usize),
    single: bool,
    gathering: Option<Receiver<Option<Field>>>,
    /// Whether the scene has changed since the light that is being gathered was asked for.
    stale: bool,
    /// The radiance that is shown white.
    white: f32,
    /// Steps along rays, voxels; chosen anew for each scene.
    step: Option<f64>,
}

impl Flying {
    /// The scene as the keys have made it.
    fn scene(&self) -> Result<Scene, Failure> {
        let dust = Dust {
            extinction: self.said.dust().extinction.iter().map(|k| k * self.flight.depth).collect(),
            albedo: self.flight.albedo,
            phase: HenyeyGreenstein::new(self.flight.asymmetry).unwrap_or(self.said.dust().phase),
        };
        let edge = self.volume.edges().max_element();
        let changed = self.flight.stars.iter().zip(&self.flight.moved);
        let stars = self.said.stars().iter().zip(changed).map(|(star, (times, moved))| Star {
            position: star.position + DVec3::from_array(*moved) * edge,
            intensity: star.intensity.iter().map(|light| light * times).collect(),
        });
        Scene::new(dust, stars.collect()).map_err(Failure::asked)
    }

    /// Begins to gather the light that has scattered more than once, beside the flight.
    fn gather(&mut self, scene: &Scene) {
        if self.single {
            return;
        }
        let (volume, scene) = (Arc::clone(&self.volume), scene.clone());
        let settings = Settings { flights: FLIGHTS, ..Settings::fitting(&volume) };
        let (done, result) = channel();
        self.stale = false;
        self.gathering = Some(result);
        std::thread::spawn(move || {
            // On a thread of its own: the frames have the others.
            let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
            let field =
                alone.ok().and_then(|alone| alone.install(|| multiple::gather(&volume, &scene, &settings)).ok());
            // Nobody listens any more when the flight is over.
            let _ = done.send(field);
        });
    }

    /// Takes what has been gathered, if it is there.
    fn gathered(&mut self) -> Result<bool, Failure> {
        let Some(result) = &self.gathering else { return Ok(false) };
        let field = match result.try_recv() {
            Err(TryRecvError::Empty) => return Ok(false),
            Err(TryRecvError::Disconnected) => None,
            Ok(field) => field,
        };
        self.gathering = None;
        if let Some(field) = field {
            self.step = None;
            self.flyer.glow(field);
        }
        if self.stale {
            let scene = self.scene()?;
            self.gather(&scene);
        }
        Ok(true)
    }

    fn camera(&self) -> Option<Camera> {
        let edge = self.volume.edges().max_element();
        let (turn, height) = (self.flight.turn, self.flight.height);
        let away = DVec3::new(turn.sin() * height.cos(), height.sin(), turn.cos() * height.cos());
        let eye = away * self.flight.distance * edge;
        let lens = if self.flight.dome {
            Lens::Domemaster { field: std::f64::consts::PI }
        } else {
            Lens::Perspective { field: 1.0 }
        };
        Camera::looking(eye, DVec3::ZERO, DVec3::Y, lens)
    }

    fn frame(&mut self) -> Result<Frame, Failure> {
        let camera = self.camera().ok_or_else(|| Failure::Failed("the eye has no direction".into()))?;
        let (_, mut quality) = QUALITIES[self.flight.quality.min(QUALITIES.len() - 1)];
        if quality.step <= Quality::FULL.step {
            quality.step = match self.step {
                Some(step) => step,
                None => self.flyer.longest_step(&camera, &quality, TOLERANCE).map_err(Failure::asked)?,
            };
            self.step = Some(quality.step);
        }
        self.flyer.frame(&camera, self.size.0, self.size.1, &quality).map_err(Failure::asked)
    }

    /// The frame as a picture: white is what 99 % of the lit pixels stay below, followed slowly.
    fn developed(&mut self, frame: &Frame) -> Picture {
        let mut lights: Vec<f32> =
            frame.pixels.iter().map(|p| p[0].max(p[1]).max(p[2])).filter(|light| *light > 0.0).collect();
        if !lights.is_empty() {
            let at = lights.len() * 99 / 100;
            let white = *lights.select_nth_unstable_by(at, f32::total_cmp).1;
            self.white = if self.white > 0.0 { self.white * 0.8 + white * 0.2 } else { white };
        }
        let times = self.flight.exposure as f32 / self.white.max(f32::MIN_POSITIVE);
        let mut picture = Picture::black(frame.width, frame.height);
        for (out, pixel) in picture.pixels_mut().iter_mut().zip(&frame.pixels) {
            *out = pixel.map(|light| (light * times).min(1.0));
        }
        picture
    }

    fn in_terminal(&mut self) -> Result<(), Failure> {
        let term = std::env::var("TERM").ok();
        if term.as_deref() == Some("dumb") {
            return Err(Failure::asked(
                "this terminal (TERM=dumb) cannot place text: use another, or --turn-for SECONDS",
            ));
        }
        let depth = Depth::of(std::env::var("COLORTERM").ok().as_deref(), term.as_deref());
        let theme = Theme::new(depth, STEPS);
        let mut taken =
            Taken::take(depth).map_err(|error| Failure::Failed(format!("the terminal cannot be used: {error}")))?;
        let (mut rate, mut due) = (0.0, true);
        loop {
            let began = Instant::now();
            due |= self.gathered()? || self.flight.turning;
            if due {
                let frame = self.frame()?;
                let seconds = began.elapsed().as_secs_f64();
                rate = if rate > 0.0 { 0.7 * rate + 0.3 / seconds } else { 1.0 / seconds };
                let picture = self.developed(&frame);
                let told = Told { rate, quality: self.quality().to_owned(), note: self.words(&frame) };
                taken
                    .terminal
                    .draw(|screen| draw(screen, &self.flight, &picture, &told, &theme))
                    .map_err(|error| Failure::Failed(format!("the terminal is gone: {error}")))?;
                due = false;
            }
            let wait = if self.flight.turning { Duration::ZERO } else { Duration::from_millis(100) };
            let mut changed = false;
            let mut input = keys::within(wait).map_err(Failure::failed)?;
            // Keys held down come faster than frames: all that wait are taken before the next frame.
            while let Some(key) = input {
                due = true;
                if let Input::Key(key) = key {
                    match self.flight.press(key) {
                        Did::Left => return Ok(()),
                        Did::Scene => changed = true,
                        Did::Moved | Did::Nothing => {}
                    }
                }
                input = keys::within(Duration::ZERO).map_err(Failure::failed)?;
            }
            if changed {
                self.changed()?;
            }
            self.flight.wait(began.elapsed().as_secs_f64());
        }
    }

    fn changed(&mut self) -> Result<(), Failure> {
        let scene = self.scene()?;
        self.step = None;
        self.flyer.change(&self.volume, &scene).map_err(Failure::asked)?;
        if self.gathering.is_some() {
            self.stale = true;
        } else {
            self.gather(&scene);
        }
        Ok(())
    }

    fn quality(&self) -> &'static str {
        QUALITIES[self.flight.quality.min(QUALITIES.len() - 1)].0
    }

    /// What stands below the picture.
    fn words(&self, frame: &Frame) -> String {
        let share = frame.work.samples as f64 / frame.work.everything.max(1) as f64;
        let multiple = if self.single {
            "scattered once only"
        } else if self.gathering.is_some() {
            "gathering what has scattered more than once"
        } else {
            "full scattering"
        };
        let left_out = f64::from(frame.left_out) / f64::from(self.white.max(f32::MIN_POSITIVE));
        format!("{multiple}; {:.0} % of the samples taken, at most {left_out:.1e} of white left out", 100.0 * share)
    }

    /// Flies a circle without a terminal, once the light that has scattered more than once is there.
    fn turn_for(&mut self, seconds: f64, quality: usize, json: bool) -> Result<(), Failure> {
        if !(seconds > 0.0 && seconds <= 3600.0) {
            return Err(Failure::asked(format!("a flight of {seconds} seconds: more than 0, and 3600 at most")));
        }
        while self.gathering.is_some() && !self.gathered()? {
            std::thread::sleep(Duration::from_millis(20));
        }
        self.flight.quality = quality;
        let began = Instant::now();
        let mut frames = 0u32;
        let mut last = self.frame()?;
        while began.elapsed().as_secs_f64() < seconds {
            self.flight.turn += 0.03;
            last = self.frame()?;
            frames += 1;
        }
        let rate = f64::from(frames) / began.elapsed().as_secs_f64();
        // Finds the white that the words speak of.
        drop(self.developed(&last));
        note(&self.words(&last));
        let seen = Seen::of(&last, &self.volume, 1.min(self.said.bands() - 1));
        if json {
            return crate::cli::answer_json(&serde_json::json!({
                "frames_per_second": rate,
                "width": self.size.0,
                "height": self.size.1,
                "stars": self.said.stars().len(),
                "quality": self.quality(),
                "step_voxels": self.step,
                "covered_share": seen.covered,
                "filled_share": seen.filled,
                "central_depth": seen.depth,
                "samples_a_frame": last.work.samples,
                "left_out_of_white": f64::from(last.left_out) / f64::from(self.white.max(f32::MIN_POSITIVE)),
            }));
        }
        let step = self.step.map_or(String::new(), |step| format!(", steps of {step} voxels"));
        crate::cli::answer(&format!(
            "{rate:.2} frames a second, {} x {} pixels, {} stars, quality {}{step}\n{:.0} % of the pixels covered, {:.0} % of the voxels \
             filled, depth {:.2} in the middle",
            self.size.0,
            self.size.1,
            self.said.stars().len(),
            self.quality(),
            100.0 * seen.covered,
            100.0 * seen.filled,
            seen.depth
        ))
    }
}
