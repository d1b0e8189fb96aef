//! `scotopic eye tone`: the luminance that a display should show for one of a scene.

use clap::Args;
use serde::Serialize;

use crate::cli::overlay::within;
use crate::cli::{Failure, answer, answer_json, note};
use crate::eye::tone::{Adapted, Method, PROJECTOR_CONTRAST, display_luminance, least_adaptation_cd_m2};

/// The settings of `eye tone`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic eye tone --adaptation-world 0.01 --adaptation-display 0.03 --luminance 0.001\n  \
    scotopic eye tone --method tr99 --adaptation-world 1e-4 --adaptation-display 0.03 --luminance 1e-3 --json\n\n\
    The 1993 form is undefined for an eye adapted to less than 1.6e-4 cd/m2 (a dark sky in the eyepiece) and explodes near\n\
    it: an adaptation below 0.01 cd/m2 is taken as 0.01, and `clamped` says so. The 1999 form holds down to 1e-4.")]
pub struct Arguments {
    /// Operator: tr93, tr99 (Tumblin and Rushmeier 1993, Tumblin and others 1999), ward (1994) or linear
    #[arg(long, value_name = "METHOD", default_value_t = Method::Tr93)]
    pub method: Method,
    /// Luminance to which the eye is adapted in front of the scene, cd/m2: the scene's logarithmic mean
    #[arg(long, value_name = "CD/M2", allow_hyphen_values = true)]
    pub adaptation_world: f64,
    /// Luminance to which the eye is adapted in front of the display, cd/m2
    #[arg(long, value_name = "CD/M2", allow_hyphen_values = true)]
    pub adaptation_display: f64,
    /// Luminance in the scene, cd/m2
    #[arg(long, value_name = "CD/M2", allow_hyphen_values = true)]
    pub luminance: f64,
    /// The display's brightest over its darkest, for tr99: the thesis' projector has 1.8 over 0.03 cd/m2
    #[arg(long, value_name = "RATIO", default_value_t = PROJECTOR_CONTRAST, allow_hyphen_values = true)]
    pub contrast: f64,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// What `eye tone --json` answers.
#[derive(Debug, Serialize)]
struct Answer {
    method: &'static str,
    display_luminance: f64,
    clamped: bool,
    least_adaptation: f64,
}

/// Runs the subcommand.
///
/// # Errors
/// A number out of its range.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let adapted = Adapted {
        world_cd_m2: within("--adaptation-world", arguments.adaptation_world, 0.0, 1e10)?,
        display_cd_m2: within("--adaptation-display", arguments.adaptation_display, 0.0, 1e10)?,
        contrast: within("--contrast", arguments.contrast, 1.0, 1e10)?,
    };
    let luminance = within("--luminance", arguments.luminance, 0.0, 1e10)?;
    let toned = display_luminance(arguments.method, &adapted, luminance);
    let least = least_adaptation_cd_m2(arguments.method);
    if adapted.world_cd_m2 < least || adapted.display_cd_m2 < least {
        note(&format!("{} does not hold below {least} cd/m2: the eye is taken as adapted to that", arguments.method));
    }
    let answered = Answer {
        method: arguments.method.name(),
        display_luminance: toned.display_cd_m2,
        clamped: toned.clamped,
        least_adaptation: least,
    };
    if arguments.json {
        return answer_json(&answered);
    }
    let clamped = if toned.clamped { " (clamped)" } else { "" };
    answer(&format!("{}: {luminance:e} cd/m2 is shown as {:.4e}{clamped}", arguments.method, toned.display_cd_m2))
}
