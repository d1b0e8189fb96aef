//! `scotopic projector pattern`: test patterns on the projector, or into a file.

use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::Duration;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::light::{self, Which};
use crate::cli::observe::signals;
use crate::cli::settings::disk::{self, Disk, Files};
use crate::cli::{Failure, answer, answer_json, overlay};
use crate::hw::projector::{self, CANVAS, Flip, Placement, ProjectorAddress, Rotation};
use crate::overlay::patterns::{self, Look};
use crate::picture::png;

/// The ways of the finder's eight signs.
const WAYS: [(f64, &str); 8] = [
    (0.0, "none"),
    (90.0, "none"),
    (180.0, "none"),
    (270.0, "none"),
    (0.0, "horizontal"),
    (90.0, "horizontal"),
    (180.0, "horizontal"),
    (270.0, "horizontal"),
];

/// A test pattern.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic projector pattern finder --projector kms:HDMI-A-2     the sign that reads rightly gives rotation_deg and flip\n  \
    scotopic projector pattern cross --projector window:HDMI-2 --for 600\n  \
    scotopic projector pattern ghost --light 1 --colour white\n  \
    scotopic projector pattern eyepieces --out eyepieces.png       a look, without a projector\n  \
    scotopic projector pattern grid --out grid.png --pixels 1280x720   as the settings lay it on a module of 1280 x 720")]
pub struct Pattern {
    /// grid, cross, eyepieces, orientation, finder, ghost, greys or full
    #[arg(value_name = "NAME")]
    name: patterns::Pattern,
    /// Where to show it [default: the settings']
    #[arg(long, value_name = "PROJECTOR")]
    projector: Option<ProjectorAddress>,
    /// So many seconds, instead of until Ctrl-C
    #[arg(long = "for", value_name = "SECONDS", value_parser = light::seconds)]
    seconds: Option<Duration>,
    /// Write it to this PNG file instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["projector", "seconds"])]
    out: Option<PathBuf>,
    /// The module's own columns and rows, for the file [default: those of the canvas]
    #[arg(long, value_name = "WxH", requires = "out", value_parser = pixels)]
    pixels: Option<(usize, usize)>,
    /// Light of its brightest parts, 0 to 1 of the projector's full drive
    #[arg(long, value_name = "SHARE", default_value_t = Look::default().light)]
    light: f32,
    /// Its colour: red spares the dark-adapted eye
    #[arg(long, value_enum, default_value_t = Colour::Red)]
    colour: Colour,
    /// Telescope, eyepieces and projector [default: the settings', else those of the thesis]
    #[arg(long, value_name = "FILE")]
    instrument: Option<PathBuf>,
}

/// The colours of patterns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Colour {
    Red,
    White,
}

impl Pattern {
    /// Shows it, or writes it.
    ///
    /// # Errors
    /// A sentence that says what is wrong and what to do.
    pub fn run(&self, which: &Which) -> Result<(), Failure> {
        overlay::within("--light", f64::from(self.light), 0.0, 1.0)?;
        let settings = which.settings()?;
        let file = self.instrument.as_deref().or(settings.instrument.as_deref());
        let instrument = overlay::instrument(file, None)?;
        let colour = if self.colour == Colour::Red { [1.0, 0.0, 0.0] } else { [1.0; 3] };
        let picture = patterns::draw(self.name, &instrument, Look { light: self.light, colour });
        let placement = match self.name {
            // Its signs are laid in all ways already.
            patterns::Pattern::Finder => Placement { rotation: Rotation::None, flip: Flip::None, ..settings.placement },
            _ => settings.placement.mirrored(instrument.projector.must_mirror()),
        };

        if let Some(out) = &self.out {
            let size = self.pixels.unwrap_or(CANVAS);
            let placement = placement.seen(CANVAS, size).map_err(Failure::asked)?;
            let bytes = png::encode_dithered(&placement.apply(&picture, size)).map_err(Failure::failed)?;
            let part = disk::with_suffix(out, "new");
            Files.write_and_sync(&part, &bytes).and_then(|()| Files.rename(&part, out)).map_err(|error| {
                Failure::Failed(format!("the picture {} cannot be written: {error}", out.display()))
            })?;
            return self.tell(which, &format!("{}, {} x {}", out.display(), size.0, size.1));
        }

        let address =
            self.projector.clone().or(settings.projector).filter(|address| *address != ProjectorAddress::None);
        let Some(address) = address else {
            return Err(Failure::asked(
                "where to? add --projector kms:CONNECTOR (list them with `scotopic projector outputs`), window:MONITOR, \
                 fb:/dev/fb0 or png:FOLDER; or --out FILE for a look without a projector",
            ));
        };
        // Whoever ends us is heard before anything is lit.
        let (tell, told) = mpsc::channel();
        signals::listen(move || {
            // A second signal may find nobody.
            let _ = tell.send(());
        })
        .map_err(Failure::failed)?;
        let projector = projector::open(&address, placement).map_err(Failure::failed)?;
        let mut projector = light::lit(projector, &settings.light)?;
        let shown = projector.present(&picture).map_err(Failure::failed);
        if shown.is_ok() {
            self.tell(which, &projector.describe())?;
            match self.seconds {
                Some(seconds) => drop(told.recv_timeout(seconds)),
                None => {
                    let _ = writeln!(std::io::stderr(), "scotopic: shown until Ctrl-C");
                    let _ = told.recv();
                }
            }
        }
        shown.and(projector.dark().map_err(Failure::failed))
    }

    /// The answer: what is shown where, what to look for, and for the finder what each number means.
    fn tell(&self, which: &Which, place: &str) -> Result<(), Failure> {
        let ways = (self.name == patterns::Pattern::Finder).then_some(WAYS);
        if which.json() {
            let ways =
                ways.map(|ways| ways.map(|(rotation_deg, flip)| json!({"rotation_deg": rotation_deg, "flip": flip})));
            return answer_json(&json!({"pattern": self.name.name(), "on": place, "light": self.light, "signs": ways}));
        }
        answer(&format!("{} on {place}: {}", self.name, self.name.purpose()))?;
        for (number, (rotation_deg, flip)) in (1..).zip(ways.into_iter().flatten()) {
            answer(&format!("  if {number} reads rightly:  rotation_deg = {rotation_deg:<3}  flip = \"{flip}\""))?;
        }
        Ok(())
    }
}

/// Reads `1280x720`.
fn pixels(text: &str) -> Result<(usize, usize), String> {
    let sides = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    sides
        .filter(|(width, height)| (1..=8192).contains(width) && (1..=8192).contains(height))
        .ok_or_else(|| "give columns and rows, 1 to 8192 each, like 1280x720".into())
}
