//! `scotopic eye contrast`: whether an object can be seen at an eyepiece, and by how much.

use clap::Args;
use serde::Serialize;

use super::instrument::Given;
use crate::cli::overlay::within;
use crate::cli::settings::Settings;
use crate::cli::{Failure, answer, answer_json, note};
use crate::eye::crumey::{ONE_EYE, TYPICAL_OBSERVER};
use crate::eye::{Model, Patch, Reading, Viewing, glare};
use crate::sky::catalogue::Catalogue;
use crate::units::SurfaceBrightness;

/// The settings of `eye contrast`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic eye contrast M57 --eyepiece 24 --sky 21.5\n  \
    scotopic eye contrast M31 --eyepiece 32 --sky 20.5 --model blackwell --json\n  \
    scotopic eye contrast --v-mag 9.9 --major-arcmin 3.4 --minor-arcmin 3.3 --sky 18.5 \\\n      \
        --aperture-mm 254 --magnification 104 --transmission 0.7 --field-factor 2.83\n\n\
    The reserve is the common logarithm of contrast over threshold: above 0 the object is seen. The mean over the\n\
    catalogue's ellipse is what is judged; the cores of galaxies and globular clusters are far brighter. The scales of\n\
    the two models differ by about 0.45 and their reserves cannot be compared with each other. Outside what a model was\n\
    measured for its edge is taken, and told; nothing is extrapolated.")]
pub struct Arguments {
    /// A deep-sky object: M57, ngc 7331, ring nebula
    #[arg(value_name = "NAME", required_unless_present = "v_mag")]
    pub name: Vec<String>,
    /// Total V magnitude, in place of the catalogue's
    #[arg(long, value_name = "MAG", allow_hyphen_values = true)]
    pub v_mag: Option<f64>,
    /// Full major axis in arcminutes, in place of the catalogue's
    #[arg(long, value_name = "ARCMIN", allow_hyphen_values = true)]
    pub major_arcmin: Option<f64>,
    /// Full minor axis in arcminutes [default: the catalogue's, or the major one]
    #[arg(long, value_name = "ARCMIN", allow_hyphen_values = true)]
    pub minor_arcmin: Option<f64>,
    /// Whose threshold: crumey (2014), or blackwell as Clark and ODM tabulate it, with its own pupil, transmission and observer
    #[arg(long, value_name = "MODEL", default_value_t = Model::Crumey)]
    pub model: Model,
    /// Instrument, eye and sky.
    #[command(flatten)]
    pub given: Given,
    /// All that makes this observer need more contrast than Blackwell's, one eye included (crumey only) [default: 2 sqrt 2]
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true)]
    pub field_factor: Option<f64>,
    /// A bright star near by: its V magnitude. Its glare in the eye lifts background and threshold (CIE 146)
    #[arg(long, value_name = "MAG", requires = "star_arcmin", allow_hyphen_values = true)]
    pub star_mag: Option<f64>,
    /// How far from the object that star is on the sky
    #[arg(long, value_name = "ARCMIN", requires = "star_mag", allow_hyphen_values = true)]
    pub star_arcmin: Option<f64>,
    /// The observer's age in years, for the glare
    #[arg(long, value_name = "YEARS", default_value_t = 35.0, allow_hyphen_values = true)]
    pub age: f64,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// What `eye contrast --json` answers.
#[derive(Debug, Serialize)]
struct Answer<'a> {
    name: Option<&'a str>,
    model: &'a str,
    log10_contrast: f64,
    log10_threshold: f64,
    reserve: f64,
    verdict: &'a str,
    clamped: bool,
    surface_brightness_mag_arcsec2: f64,
    sky_mag_arcsec2: f64,
    background_at_eye_mag_arcsec2: f64,
    magnification: f64,
    exit_pupil_mm: f64,
    glare: Option<Glare>,
}

/// What a bright star near by does.
#[derive(Debug, Serialize)]
struct Glare {
    veil_cd_m2: f64,
    sky_at_eye_cd_m2: f64,
    /// The reserve with the veil over object and background.
    reserve: f64,
    verdict: &'static str,
    /// Whether the angle at the eye was beyond the equation's.
    clamped: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// No such name, nothing known of its brightness or size, or a number out of its range.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let (name, object) = patch(arguments)?;
    let sky = arguments.given.sky(settings)?;
    let viewing = arguments.given.viewing(settings, arguments.field_factor.unwrap_or(TYPICAL_OBSERVER * ONE_EYE))?;
    let given = &arguments.given;
    let observer = given.pupil_mm.is_some() || given.transmission.is_some() || arguments.field_factor.is_some();
    if arguments.model == Model::Blackwell && observer {
        note(
            "the blackwell model has its own eye (pupil 7.5 mm, transmission 0.7): --pupil-mm, --transmission and \
             --field-factor change nothing in it",
        );
    }
    let reading = Reading::of(&object, &viewing, sky, arguments.model);
    let answered = Answer {
        name: name.as_deref(),
        model: arguments.model.name(),
        log10_contrast: reading.log10_contrast,
        log10_threshold: reading.log10_threshold,
        reserve: reading.reserve(),
        verdict: reading.verdict().words(),
        clamped: reading.clamped,
        surface_brightness_mag_arcsec2: object.surface_brightness().0,
        sky_mag_arcsec2: sky.0,
        background_at_eye_mag_arcsec2: reading.background.0,
        magnification: viewing.magnification,
        exit_pupil_mm: viewing.exit_pupil_mm(),
        glare: glare(arguments, &object, &viewing, sky)?,
    };
    if arguments.json { answer_json(&answered) } else { answer(&page(&answered, &reading, &object, &viewing, sky)) }
}

/// The veil of the star near by and what is left of the reserve, by Crumey's model: the other has an eye of its own.
fn glare(
    arguments: &Arguments,
    object: &Patch,
    viewing: &Viewing,
    sky: SurfaceBrightness,
) -> Result<Option<Glare>, Failure> {
    let (Some(v_mag), Some(arcmin)) = (arguments.star_mag, arguments.star_arcmin) else { return Ok(None) };
    let v_mag = within("--star-mag", v_mag, -30.0, 30.0)?;
    let arcmin = within("--star-arcmin", arcmin, 0.0, 10_800.0)?;
    let age_years = within("--age", arguments.age, 1.0, 120.0)?;
    let observer = glare::Observer { age_years, ..glare::Observer::default() };
    let veil = glare::veil(glare::lux_of_star(v_mag, viewing), arcmin / 60.0 * viewing.magnification, &observer);
    let background = viewing.background_cd_m2(sky);
    // The veil is light at the eye: before the instrument it would be so much sky more.
    let veiled = SurfaceBrightness(sky.0 - 2.5 * ((background + veil.cd_m2) / background).log10());
    let reading = Reading::of(object, viewing, veiled, Model::Crumey);
    if veil.clamped {
        note("the equation of the glare holds from 0.1 to 100 degrees at the eye: the nearer end is taken");
    }
    Ok(Some(Glare {
        veil_cd_m2: veil.cd_m2,
        sky_at_eye_cd_m2: background,
        reserve: reading.reserve(),
        verdict: reading.verdict().words(),
        clamped: veil.clamped,
    }))
}

/// The object of the catalogue, with what the command line says in its place.
fn patch(arguments: &Arguments) -> Result<(Option<String>, Patch), Failure> {
    let found = match arguments.name.as_slice() {
        [] => None,
        words => Some(Catalogue::embedded().search(&words.join(" ")).map_err(Failure::failed)?),
    };
    let name = found.as_ref().map(|object| object.name.clone());
    let axes = found.as_ref().and_then(|object| object.axes_arcmin);
    let v_mag = arguments.v_mag.or(found.as_ref().and_then(|object| object.v_magnitude()).map(|v| v.0));
    let major = arguments.major_arcmin.or(axes.map(|axes| axes.0));
    let unknown = |what: &str, flag: &str| match &name {
        Some(name) => Failure::Failed(format!("the catalogue has no {what} of {name}: give {flag}")),
        None => Failure::Asked(format!("{flag} is missing: give it with --v-mag, or a NAME")),
    };
    let v_mag = v_mag.ok_or_else(|| unknown("V magnitude", "--v-mag"))?;
    let major = major.ok_or_else(|| unknown("size (a star? ask `scotopic eye limit`)", "--major-arcmin"))?;
    let minor = arguments.minor_arcmin.or(axes.map(|axes| axes.1).filter(|_| arguments.major_arcmin.is_none()));
    let object = Patch {
        v_mag: within("--v-mag", v_mag, -30.0, 40.0)?,
        major_arcmin: within("--major-arcmin", major, 1e-4, 10_800.0)?,
        minor_arcmin: within("--minor-arcmin", minor.unwrap_or(major), 1e-4, 10_800.0)?,
    };
    Ok((name, object))
}

/// The answer for a person.
fn page(answered: &Answer<'_>, reading: &Reading, object: &Patch, viewing: &Viewing, sky: SurfaceBrightness) -> String {
    let second = if reading.model == Model::Crumey { Model::Blackwell } else { Model::Crumey };
    let other = Reading::of(object, viewing, sky, second);
    let edge = |reading: &Reading| if reading.clamped { "  (at the edge of what was measured)" } else { "" };
    let glare = answered.glare.as_ref().map_or_else(String::new, |glare| {
        format!(
            "\n{:<20}{:.1e} cd/m2 over a sky of {:.1e}: reserve {:+.3}, {} (crumey)",
            "with the glare", glare.veil_cd_m2, glare.sky_at_eye_cd_m2, glare.reserve, glare.verdict
        )
    });
    format!(
        "{}: {} at {:.0}x under {:.1}\n\
         {:<20}{:.2} mag per square arcsecond on average\n\
         {:<20}{:+.3} (log10)\n\
         {:<20}{:+.3}{}\n\
         {:<20}{:+.3}\n\
         {:<20}{:.2} mag per square arcsecond, exit pupil {:.2} mm\n\
         {:<20}{}: reserve {:+.3}, {}{}",
        answered.name.unwrap_or("object"),
        answered.verdict,
        answered.magnification,
        answered.sky_mag_arcsec2,
        "surface brightness",
        answered.surface_brightness_mag_arcsec2,
        "contrast",
        answered.log10_contrast,
        format!("threshold, {}", answered.model),
        answered.log10_threshold,
        edge(reading),
        "reserve",
        answered.reserve,
        "sky at the eye",
        answered.background_at_eye_mag_arcsec2,
        answered.exit_pupil_mm,
        "second opinion",
        second,
        other.reserve(),
        other.verdict().words(),
        edge(&other),
    ) + &glare
}
