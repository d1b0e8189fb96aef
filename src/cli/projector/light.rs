//! `scotopic projector status | luminance | off | measure`: the LEDs of the projector's module, over I2C.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;

use clap::{Args, Subcommand};
use serde_json::json;

use crate::cli::observe::signals;
use crate::cli::settings::Settings;
use crate::cli::settings::disk::{Disk, Files};
use crate::cli::settings::explain;
use crate::cli::settings::light::Light;
use crate::cli::{Failure, answer, answer_json, printable};
use crate::hw::i2c::BusAddress;
use crate::hw::i2c::pace::{Wall, Within};
use crate::hw::light::adaptation::rods_lose_mag;
use crate::hw::light::calibration::{CalibrationError, Filter};
use crate::hw::light::guard::{self, Guard};
use crate::hw::light::lamp::{ENDING, POWER_UP};
use crate::hw::light::{self, Calibration, Controller, Lamp, LightError, Module, Plan};
use crate::hw::projector::lit::Lit;
use crate::hw::projector::{self, Placement, Projector, ProjectorAddress, ProjectorError};
use crate::overlay::tone::Display;
use crate::picture::Picture;

/// Guiding a builder through the measurement.
mod measure;

/// Larger files are no calibrations.
const LARGEST_BYTES: u64 = 1 << 20;

/// Which module, where, and what is known of it. Everything left out comes from the settings' table `[light]`.
#[derive(Debug, Clone, Default, Args)]
pub struct Which {
    /// The module's family: dlpc2607 (DLPDLCR2000) or dlpc34xx (DLPDLCR230NP, 2010, 3010)
    #[arg(long, value_name = "MODULE", global = true)]
    module: Option<Module>,
    /// Its I2C bus: a number (1 is /dev/i2c-1), /dev/i2c-N, pi:N, or fake:FILE
    #[arg(long, value_name = "BUS", global = true)]
    bus: Option<BusAddress>,
    /// What was measured of this module
    #[arg(long, value_name = "FILE", global = true)]
    calibration: Option<PathBuf>,
    /// The filter that is in the tray now, by its name in the calibration
    #[arg(long, value_name = "NAME", global = true)]
    filter: Option<String>,
    /// Settings file [default: scotopic/settings.toml in the user's configuration folder]
    #[arg(long, value_name = "FILE", global = true)]
    config: Option<PathBuf>,
    /// Answer as one line of JSON
    #[arg(long, global = true)]
    json: bool,
}

/// What can be done with the light.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Ask the module who it is and how its LEDs are; changes nothing
    Status,
    /// Light the LEDs to a luminance at the eyepiece in cd/m2, until Ctrl-C
    Luminance(Luminance),
    /// Make it dark: LEDs off, currents 0, curtain, mirrors parked
    Off(Off),
    /// Measure the module with a luminance meter, step by step, and save its calibration
    Measure(measure::Measure),
}

/// A luminance.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic projector --module dlpc2607 --bus 1 luminance 0.3\n  \
    scotopic projector luminance 0.3 --plan                        what would be done; the bus is not touched\n  \
    scotopic projector --filter '10 %' luminance 0.05 --for 60 --projector fb:/dev/fb0")]
pub struct Luminance {
    /// At the eyepiece, full white, cd/m2: 0.03 to 1.8; less behind a filter
    #[arg(value_name = "CD_M2", allow_hyphen_values = true)]
    cd_m2: f64,
    /// Only say what would be done
    #[arg(long)]
    plan: bool,
    /// So many seconds, instead of until Ctrl-C
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    seconds: Option<Duration>,
    /// Show full white there, dimmed as the plan says
    #[arg(long, value_name = "PROJECTOR")]
    projector: Option<ProjectorAddress>,
}

/// Darkness.
#[derive(Debug, Args)]
pub struct Off {
    /// Wait until the program that started this one dies, and only then make it dark
    #[arg(long, hide = true)]
    when_abandoned: bool,
}

pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_number| format!("'{}' is no number of seconds", printable(text)))?;
    if seconds > 0.0 && seconds <= 604_800.0 {
        Ok(Duration::from_secs_f64(seconds))
    } else {
        Err(format!("{seconds} is no time to wait: give up to 604800 seconds (a week)"))
    }
}

/// Does it.
///
/// # Errors
/// A sentence that says what is wrong and what to do.
pub fn run(command: &Command, which: &Which) -> Result<(), Failure> {
    let light = match Settings::load(which.config.as_deref()) {
        Ok(settings) => settings.light,
        // Darkness must not depend on a file that somebody is editing.
        Err(error) if matches!(command, Command::Off(_)) => {
            eprintln!("scotopic: {}", printable(&error.to_string()));
            which.config.as_deref().map(Light::salvaged).unwrap_or_default()
        }
        Err(error) => return Err(error.into()),
    };
    let light = which.over(light);
    match command {
        Command::Status => status(&light, which.json),
        Command::Luminance(luminance) => luminance.run(&light, which.json),
        Command::Off(_) if which.config.is_some() && light.module.is_none() && light.bus.is_none() => {
            answer("nothing to do: the settings name no module in their table [light]")
        }
        Command::Off(Off { when_abandoned }) => off(&light, *when_abandoned, which.json),
        Command::Measure(measure) => measure.run(&light),
    }
}

impl Which {
    /// The settings, with the command line over their table `[light]`.
    pub(super) fn settings(&self) -> Result<Settings, Failure> {
        let settings = Settings::load(self.config.as_deref())?;
        Ok(Settings { light: self.over(settings.light.clone()), ..settings })
    }

    /// Whether the answer is to be JSON.
    pub(super) fn json(&self) -> bool {
        self.json
    }

    /// The command line over the settings.
    fn over(&self, light: Light) -> Light {
        Light {
            module: self.module.or(light.module),
            bus: self.bus.clone().or(light.bus),
            calibration: self.calibration.clone().or(light.calibration),
            filter: self.filter.clone().or(light.filter),
            ..light
        }
    }
}

/// The module and bus that are named.
fn named(light: &Light) -> Result<(Module, &BusAddress), Failure> {
    match (light.module, &light.bus) {
        (Some(module), Some(bus)) => Ok((module, bus)),
        (None, _) => Err(Failure::asked(
            "which module? add --module dlpc2607 or --module dlpc34xx, or set `module` in the table [light] of the settings",
        )),
        (_, None) => Err(Failure::asked(
            "on which bus? add --bus N (list them with `ls /dev/i2c-*`), or set `bus` in the table [light] of the settings",
        )),
    }
}

fn controller(light: &Light) -> Result<Controller, Failure> {
    let (module, bus) = named(light)?;
    let bus = light::open_bus(bus, module).map_err(Failure::failed)?;
    Ok(Controller::new(module, bus))
}

/// The calibration under the settings' ceiling, and the filter in the tray.
fn calibration(light: &Light) -> Result<(Calibration, Option<Filter>), Failure> {
    let path = light.calibration.as_deref().ok_or_else(|| Failure::asked(LightError::NoCalibration))?;
    let calibration = read_calibration(path)?;
    let calibration = match light.ceiling_cd_m2 {
        Some(ceiling) if ceiling > 0.0 => calibration.under(ceiling),
        Some(ceiling) => {
            return Err(Failure::Asked(format!("ceiling_cd_m2 = {ceiling} lets no light through: give more than 0")));
        }
        None => calibration,
    };
    let fitted = light.filter.as_deref().map(|name| calibration.filter(name).cloned());
    let fitted = fitted.transpose().map_err(Failure::asked)?;
    Ok((calibration, fitted))
}

fn read_calibration(path: &Path) -> Result<Calibration, Failure> {
    let wrong = |what: String| Failure::Asked(format!("{}{what}; the LEDs stay off", path.display()));
    let bytes = match Files.read(path, LARGEST_BYTES) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => {
            return Err(wrong(" is not there: measure the module with `scotopic projector measure`".into()));
        }
        Err(error) => return Err(wrong(format!(" cannot be read ({error})"))),
    };
    let text = String::from_utf8(bytes).map_err(|error| wrong(format!(" is not text ({error})")))?;
    Calibration::from_toml(&text).map_err(|error| match error {
        CalibrationError::Toml(error) => {
            let explained = explain::wrong(&error, &text);
            wrong(format!("{}: {}", explained.line.map(|n| format!(", line {n}")).unwrap_or_default(), explained.what))
        }
        error => wrong(format!(": {error}")),
    })
}

/// Wraps a projector in its light, if the settings name one: the LEDs are then on only while there is a picture, and a guard
/// process makes it dark should this one be killed.
///
/// # Errors
/// The calibration or the module is not right: nothing is lit.
pub fn lit(projector: Box<dyn Projector>, light: &Light) -> Result<Box<dyn Projector>, Failure> {
    if light.module.is_none() && light.bus.is_none() {
        return Ok(projector);
    }
    Ok(Box::new(Lit::new(projector, lamp(light, light.luminance_cd_m2)?, Some(guard(light)?))))
}

/// What the projector gives at the eye: as its calibration plans it with the filter in the tray, else as the settings claim.
///
/// # Errors
/// The calibration is wrong, or does not reach what is asked.
pub fn display(light: &Light) -> Result<Display, Failure> {
    if light.calibration.is_none() {
        return Ok(Display::assumed(light.luminance_cd_m2));
    }
    let (calibration, fitted) = calibration(light)?;
    let plan = light::plan(light.luminance_cd_m2, &calibration, fitted.as_ref()).map_err(Failure::asked)?;
    Ok(Display { full_cd_m2: plan.predicted_cd_m2, black_cd_m2: plan.black_cd_m2, measured: true })
}

/// A lamp for a luminance, dark.
fn lamp(light: &Light, cd_m2: f64) -> Result<Lamp, Failure> {
    named(light)?;
    let (calibration, fitted) = calibration(light)?;
    // What cannot be asked is told before the bus is touched.
    light::plan(cd_m2, &calibration, fitted.as_ref()).map_err(Failure::asked)?;
    let lamp = Lamp::ready(controller(light)?, calibration, fitted, cd_m2, Box::new(Wall::begun()));
    lamp.and_then(|lamp| lamp.turned_to(light.input)).map_err(Failure::failed)
}

/// The process that makes it dark if this one is killed.
fn guard(light: &Light) -> Result<Guard, Failure> {
    let (module, bus) = named(light)?;
    let arguments: Vec<OsString> = ["projector", "--module", &module.to_string(), "--bus", &bus.to_string(), "off"]
        .iter()
        .map(OsString::from)
        .chain(["--when-abandoned".into()])
        .collect();
    Guard::start(&arguments)
        .map_err(|error| Failure::Failed(format!("the guard of the LEDs could not be started: {error}")))
}

fn status(light: &Light, json: bool) -> Result<(), Failure> {
    // What was measured is told too, where it is known; a calibration that is not right must not hide the module.
    let measured = light.calibration.as_ref().map(|_| calibration(light));
    let measured = measured.transpose().unwrap_or_else(|failure| {
        eprintln!("scotopic: {}", printable(&failure.to_string()));
        None
    });
    let mut controller = controller(light)?;
    let mut wall = Wall::begun();
    let status = controller.status(&mut Within::new(&mut wall, POWER_UP)).map_err(Failure::failed)?;
    let white = measured.and_then(|(calibration, fitted)| calibration.white_cd_m2(status.codes, fitted.as_ref()));
    if json {
        return answer_json(&json!({
            "chip": status.identity.chip,
            "id": status.identity.id,
            "leds": status.leds,
            "lit": status.leds != 0,
            "codes": status.codes,
            "white_cd_m2": white,
            "curtain": status.curtain,
            "complaints": status.complaints,
        }));
    }
    answer(&format!("{} (identity 0x{:02X})", controller.describe(), status.identity.id))?;
    answer(&format!("LEDs       {}", leds(status.leds)))?;
    let [red, green, blue] = status.codes;
    answer(&format!("codes      red {red}, green {green}, blue {blue}"))?;
    if let Some(white) = white {
        answer(&format!("white      {white:.4} cd/m2 at the eyepiece while the LEDs are on, by the calibration"))?;
    }
    answer(&format!("curtain    {}", if status.curtain { "drawn" } else { "open" }))?;
    let complaints = if status.complaints.is_empty() { "none".into() } else { status.complaints.join(", ") };
    answer(&format!("complaints {complaints}"))
}

/// `red, green on`.
fn leds(bits: u8) -> String {
    let on: Vec<&str> =
        ["red", "green", "blue"].into_iter().enumerate().filter(|(i, _)| bits >> i & 1 == 1).map(|(_, n)| n).collect();
    if on.is_empty() { "off".into() } else { format!("{} on", on.join(", ")) }
}

fn off(light: &Light, when_abandoned: bool, json: bool) -> Result<(), Failure> {
    if when_abandoned && !guard::is_abandoned(std::io::stdin()).unwrap_or(true) {
        return Ok(());
    }
    let mut controller = controller(light)?;
    let mut wall = Wall::begun();
    controller.identify(&mut Within::new(&mut wall, POWER_UP)).map_err(Failure::failed)?;
    controller.dark(&mut Within::new(&mut wall, ENDING)).map_err(Failure::failed)?;
    if json {
        return answer_json(&json!({ "dark": true }));
    }
    answer("dark: LEDs off, currents 0, curtain drawn, mirrors parked where the module can do it over I2C")
}

impl Luminance {
    fn run(&self, light: &Light, json: bool) -> Result<(), Failure> {
        if self.plan {
            let (calibration, fitted) = calibration(light)?;
            let plan = light::plan(self.cd_m2, &calibration, fitted.as_ref()).map_err(Failure::asked)?;
            return tell(&plan, None, json);
        }
        let ended = ending()?;
        let mut lamp = lamp(light, self.cd_m2)?;
        let guard = guard(light)?;
        let plan = lamp.plan().clone();
        // The picture before the light; without a projector of ours the picture is somebody else's.
        let projector = self.projector.as_ref().map(|address| white(address, plan.pixel_gain)).transpose();
        let projector = projector.map_err(Failure::failed)?;
        lamp.on().map_err(Failure::failed)?;
        let held = lamp.read_back().map_err(Failure::failed)?;
        tell(&plan, Some(held.codes), json)?;
        if projector.is_none() && plan.pixel_gain < 0.995 {
            eprintln!(
                "show pixels at {:.1} % of full white (linear light), or name a --projector",
                100.0 * plan.pixel_gain
            );
        }
        match self.seconds {
            Some(time) => eprintln!("the LEDs are on for {} s; Ctrl-C turns them off", time.as_secs_f64()),
            None => eprintln!("the LEDs are on; Ctrl-C turns them off"),
        }
        let done = hold(&mut lamp, &ended, self.seconds);
        // LEDs before mirrors.
        let dark = lamp.dark();
        drop(projector);
        // A guard that is not released makes it dark itself.
        if dark.is_ok() {
            guard.release();
        }
        done.and(dark).map_err(Failure::failed)
    }
}

/// Keeps the lamp lit, and looks after it, until the time is over or somebody asks to end.
fn hold(lamp: &mut Lamp, ended: &mpsc::Receiver<()>, time: Option<Duration>) -> Result<(), LightError> {
    let begun = std::time::Instant::now();
    loop {
        let left = time.map_or(Duration::MAX, |time| time.saturating_sub(begun.elapsed()));
        match ended.recv_timeout(left.min(Duration::from_millis(250))) {
            Err(mpsc::RecvTimeoutError::Timeout) if !left.is_zero() => lamp.look()?,
            _ => return Ok(()),
        }
    }
}

/// A channel that hears of signals that ask to end.
fn ending() -> Result<mpsc::Receiver<()>, Failure> {
    let (tell, ended) = mpsc::channel();
    // Nobody may be listening any more.
    let told = move || tell.send(()).unwrap_or(());
    signals::listen(told).map_err(Failure::failed)?;
    Ok(ended)
}

/// A projector that shows full white.
fn white(address: &ProjectorAddress, gain: f64) -> Result<Box<dyn Projector>, ProjectorError> {
    let mut projector = projector::open(address, Placement::default())?;
    let mut picture = Picture::black(1024, 768);
    picture.pixels_mut().fill([gain as f32; 3]);
    projector.present(&picture)?;
    Ok(projector)
}

fn tell(plan: &Plan, held: Option<[u16; 3]>, json: bool) -> Result<(), Failure> {
    if json {
        return answer_json(&json!({
            "asked_cd_m2": plan.asked_cd_m2,
            "predicted_cd_m2": plan.predicted_cd_m2,
            "leds": plan.drive.leds,
            "codes": plan.drive.codes,
            "read_back_codes": held,
            "pixel_gain": plan.pixel_gain,
            "module_cd_m2": plan.module_cd_m2,
            "filter": plan.fitted.as_ref().map(|filter| &filter.name),
            "insert_filter": plan.insert.as_ref().map(|filter| &filter.name),
            "black_cd_m2": plan.black_cd_m2,
            "contrast": plan.contrast,
            "contrast_from": plan.source,
            "rods_lose_mag": rods_lose_mag(plan.predicted_cd_m2, plan.drive.leds),
        }));
    }
    let [red, green, blue] = plan.drive.codes;
    let filter = plan
        .fitted
        .as_ref()
        .map_or("no filter in the tray".into(), |fitted| format!("the filter {} in the tray", fitted.name));
    answer(&format!(
        "luminance  {:.4} cd/m2 at the eyepiece, asked {}, with {filter}",
        plan.predicted_cd_m2, plan.asked_cd_m2
    ))?;
    answer(&format!("LEDs       {}, codes red {red}, green {green}, blue {blue}", leds(plan.drive.leds)))?;
    answer(&format!("pixels     {:.1} % of full white (linear light)", 100.0 * plan.pixel_gain))?;
    let source = match plan.source {
        light::plan::Source::Measured => "measured",
        light::plan::Source::Thesis => "not measured: the thesis' 500:1 down to 0.3 cd/m2 of the module is assumed",
    };
    answer(&format!(
        "black      {:.2e} cd/m2 at the eyepiece, contrast {:.0}:1 ({source})",
        plan.black_cd_m2, plan.contrast
    ))?;
    answer(&format!(
        "eyes       a field of full white costs the rods {:.1} mag while it is on",
        rods_lose_mag(plan.predicted_cd_m2, plan.drive.leds)
    ))?;
    plan.advice().map_or(Ok(()), |advice| answer(&format!("filter     {advice}")))
}
