//! `scotopic projector measure`: a builder with a luminance meter is led from code to code, and the calibration is saved.

use std::io::{BufRead, IsTerminal};
use std::path::PathBuf;
use std::sync::mpsc;

use clap::Args;

use super::{Failure, answer, controller, guard, named, printable};
use crate::cli::observe::signals;
use crate::cli::settings::disk::{self, Files};
use crate::cli::settings::light::Light;
use crate::hw::i2c::pace::{Wall, Within};
use crate::hw::light::calibration::{BRIGHTEST_CD_M2, Calibration, Filter, Meter, Optics, Row, Sheet};
use crate::hw::light::controller::Drive;
use crate::hw::light::lamp::{ENDING, POWER_UP, SWITCHING};
use crate::hw::light::{Controller, LightError};
use crate::hw::projector::{self, Placement, Projector, ProjectorAddress};
use crate::picture::Picture;

/// The steps from one measured code to the next.
mod sitting;

use sitting::{Heard, Sitting};

/// From 25 mA to 750 mA of the DLPA2000 driver, each step half as much again (DLPS043: codes 0x00C to 0x307).
const CODES: [u16; 11] = [12, 18, 27, 41, 61, 91, 137, 205, 308, 461, 692];

/// A measurement.
#[derive(Debug, Args)]
#[command(
    after_help = "Before each step the LEDs are off while the current is set. Begin with the densest filter fixed: on an unknown module the\n\
    lowest code may be the brightest. Nobody looks into the eyepiece meanwhile. Answer each question with what the meter reads in\n\
    cd/m2; an empty line leaves the step out, `end` ends.\n\n\
    Examples:\n  \
    scotopic projector --module dlpc2607 --bus 1 measure light.toml --projector fb:/dev/fb0 --beam-splitter 0.1\n  \
    scotopic projector --module dlpc34xx --bus 7 measure light.toml --meter module --fixed-nd 1e-4 --nd '10 %=0.1'"
)]
pub struct Measure {
    /// Where the calibration is saved when all is measured
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Show full white there while measuring; without it, show full white on the module yourself
    #[arg(long, value_name = "PROJECTOR")]
    projector: Option<ProjectorAddress>,
    /// Where the meter stands: eyepiece (behind everything), fixed-nd (before the beam splitter), module (before both)
    #[arg(long, value_name = "PLACE", default_value = "eyepiece", value_parser = place)]
    meter: Meter,
    /// Transmission of the fixed filter, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 1.0)]
    fixed_nd: f64,
    /// The share of the projector's light that the beam splitter sends to the eye
    #[arg(long, value_name = "SHARE", default_value_t = 0.1)]
    beam_splitter: f64,
    /// Transmission of a filter that is in the tray while measuring
    #[arg(long, value_name = "SHARE", default_value_t = 1.0)]
    filter_at_the_meter: f64,
    /// A filter for the tray: `10 %=0.1`; may be given many times
    #[arg(long = "nd", value_name = "NAME=SHARE", value_parser = filter)]
    filters: Vec<Filter>,
    /// Which LEDs: r, g, b or several
    #[arg(long, value_name = "LETTERS", default_value = "rgb", value_parser = leds)]
    leds: u8,
    /// The codes to measure, rising
    #[arg(long, value_name = "CODE,CODE", value_delimiter = ',')]
    codes: Vec<u16>,
    /// Ask for the luminance of black too
    #[arg(long, requires = "projector")]
    black: bool,
    /// A larger code gives less light on this module
    #[arg(long)]
    inverted: bool,
    /// Never brighter than this at the eyepiece, cd/m2
    #[arg(long, value_name = "CD_M2", default_value_t = BRIGHTEST_CD_M2)]
    ceiling: f64,
    /// A note for the file: which meter, when, who
    #[arg(long, default_value = "")]
    note: String,
}

fn place(text: &str) -> Result<Meter, String> {
    match text {
        "eyepiece" => Ok(Meter::Eyepiece),
        "fixed-nd" => Ok(Meter::FixedNd),
        "module" => Ok(Meter::Module),
        _ => Err("give eyepiece, fixed-nd or module".into()),
    }
}

fn filter(text: &str) -> Result<Filter, String> {
    let parsed = text.rsplit_once('=').and_then(|(name, share)| Some((name.trim(), share.trim().parse::<f64>().ok()?)));
    match parsed {
        Some((name, transmission)) if !name.is_empty() && transmission > 0.0 && transmission < 1.0 => {
            Ok(Filter { name: printable(name), transmission })
        }
        _ => Err("give a name and a transmission above 0 and below 1: '10 %=0.1'".into()),
    }
}

fn leds(text: &str) -> Result<u8, String> {
    text.chars().try_fold(0, |bits, letter| match letter {
        'r' => Ok(bits | 1),
        'g' => Ok(bits | 2),
        'b' => Ok(bits | 4),
        _ => Err(format!("'{}' is no LED: give r, g, b or several", printable(text))),
    })
}

/// What comes in while measuring.
enum Input {
    Line(String),
    /// The end of input, or a signal.
    End,
}

/// A controller that goes dark when it is dropped.
struct Safe {
    controller: Controller,
    wall: Wall,
}

impl Safe {
    fn light(&mut self, drive: Drive) -> Result<(), LightError> {
        self.controller.light(drive, &mut Within::new(&mut self.wall, SWITCHING))
    }

    fn dark(&mut self) -> Result<(), LightError> {
        self.controller.dark(&mut Within::new(&mut self.wall, ENDING))
    }
}

impl Drop for Safe {
    fn drop(&mut self) {
        // Told by `Measure::run` if it fails; after an error or a panic nobody is left to tell.
        let _ = self.dark();
    }
}

impl Measure {
    /// Leads through the measurement.
    pub(super) fn run(&self, light: &Light) -> Result<(), Failure> {
        let (module, _) = named(light)?;
        let codes = if self.codes.is_empty() { CODES.to_vec() } else { self.codes.clone() };
        let mut sitting = Sitting::new(self.sheet(module, 0), &codes).map_err(Failure::Asked)?;
        let input = input()?;
        let mut safe = Safe { controller: controller(light)?, wall: Wall::begun() };
        let found = safe.controller.identify(&mut Within::new(&mut safe.wall, POWER_UP)).map_err(Failure::failed)?;
        sitting.of(found.id);
        let guard = guard(light)?;
        let mut projector = self
            .projector
            .as_ref()
            .map(|address| projector::open(address, Placement::default()))
            .transpose()
            .map_err(Failure::failed)?;
        if projector.is_none() {
            say("show a full white picture on the module, and keep it there");
        }
        while let Some(code) = sitting.next() {
            show(&mut projector, 1.0)?;
            safe.light(Drive { leds: self.leds, codes: [code; 3] }).map_err(Failure::failed)?;
            let Some(read) = ask(&input, &mut sitting, &format!("code {code}: cd/m2?"), Sitting::white)? else { break };
            if read && self.black {
                show(&mut projector, 0.0)?;
                let question = format!("code {code}, black: cd/m2?");
                if ask(&input, &mut sitting, &question, Sitting::black)?.is_none() {
                    break;
                }
            }
        }
        safe.dark().map_err(Failure::failed)?;
        guard.release();
        let calibration = Calibration::checked(sitting.done()).map_err(Failure::failed)?;
        let text = calibration.to_toml().map_err(Failure::failed)?;
        let header = "# Written by `scotopic projector measure`: LED current codes and the luminance they gave.\n";
        disk::save(&mut Files, &self.file, &format!("{header}{text}"))
            .map_err(|error| Failure::Failed(format!("{} could not be saved: {error}", self.file.display())))?;
        answer(&format!(
            "{} measured steps of the {} are in {}",
            calibration.sheet().rows.len(),
            found.chip,
            self.file.display()
        ))
    }

    fn sheet(&self, module: crate::hw::light::Module, id: u8) -> Sheet {
        Sheet {
            module,
            id,
            note: printable(&self.note),
            leds: self.leds,
            balance: [1.0; 3],
            inverted: self.inverted,
            ceiling_cd_m2: self.ceiling,
            optics: Optics {
                meter: self.meter,
                fixed_nd: self.fixed_nd,
                beam_splitter: self.beam_splitter,
                filter_at_the_meter: self.filter_at_the_meter,
            },
            filters: self.filters.clone(),
            rows: Vec::<Row>::new(),
        }
    }
}

/// Asks until the answer makes sense. `Some(true)` if a number was taken, `None` at the end.
fn ask(
    input: &mpsc::Receiver<Input>,
    sitting: &mut Sitting,
    question: &str,
    take: fn(&mut Sitting, f64) -> Heard,
) -> Result<Option<bool>, Failure> {
    loop {
        say(question);
        let Ok(Input::Line(line)) = input.recv() else { return Ok(None) };
        match line.trim() {
            "" => return Ok(Some(false)),
            "end" => return Ok(None),
            text => match text.parse::<f64>().map(|number| take(sitting, number)) {
                Ok(Heard::Kept) => return Ok(Some(true)),
                Ok(Heard::Enough(why)) => {
                    say(&why);
                    return Ok(None);
                }
                Ok(Heard::Again(why)) => say(&why),
                Err(_number) => say("that is no number: give cd/m2 like 0.125, an empty line, or `end`"),
            },
        }
    }
}

fn show(projector: &mut Option<Box<dyn Projector>>, grey: f32) -> Result<(), Failure> {
    let Some(projector) = projector else { return Ok(()) };
    let mut picture = Picture::black(1024, 768);
    picture.pixels_mut().fill([grey; 3]);
    projector.present(&picture).map_err(Failure::failed)
}

/// A prompt, red where it is read in the dark.
fn say(text: &str) {
    if std::io::stderr().is_terminal() {
        eprintln!("\u{1b}[31m{text}\u{1b}[0m");
    } else {
        eprintln!("{text}");
    }
}

/// Lines of standard input, and signals that ask to end.
fn input() -> Result<mpsc::Receiver<Input>, Failure> {
    let (tell, input) = mpsc::channel();
    let ending = tell.clone();
    // Nobody may be listening any more.
    signals::listen(move || ending.send(Input::End).unwrap_or(())).map_err(Failure::failed)?;
    std::thread::Builder::new()
        .name("answers".into())
        .spawn(move || {
            for line in std::io::stdin().lock().lines() {
                let Ok(line) = line else { break };
                if tell.send(Input::Line(line)).is_err() {
                    return;
                }
            }
            // Nobody may be listening any more.
            let _ = tell.send(Input::End);
        })
        .map_err(Failure::failed)?;
    Ok(input)
}
