//! `scotopic overlay`: one picture as the projector would show it, without a session.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use clap::Args;
use serde::Serialize;

use super::photographs::album::{Album, Sources};
use super::projector::light;
use super::settings::Settings;
use super::settings::calibration::{self, Kept};
use super::settings::disk::Files;
use super::{Failure, answer, answer_json, note, photographs};
use crate::eye::tone::Method;
use crate::overlay::globe::Map;
use crate::overlay::tone::{Lights, Toning};
use crate::overlay::{Composer, Eye, Mode, Palette, Photograph, Style, compose};
use crate::picture::png;
use crate::pipeline::{self, Frame, View};
use crate::sky::astrometry::{Astrometry, Reduction};
use crate::sky::catalogue::{Catalogue, Object};
use crate::sky::coords::Equatorial;
use crate::sky::delta_t;
use crate::sky::ephemeris::{Body, Ephemeris, InView};
use crate::sky::field::FieldOfView;
use crate::sky::optics::{Calibration, Instrument};
use crate::sky::pointing::{Motion, Pointing};
use crate::sky::site::Site;
use crate::sky::time::{Moment, Utc};
use crate::units::{Angle, SurfaceBrightness};

/// The settings of `overlay`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A name: Jupiter, Moon, M31, ngc 224, andromeda galaxy, Polaris, HIP 11767, C 14, alpha centauri, α Cen, 61 Cyg
    #[arg(value_name = "NAME", required_unless_present = "ra", conflicts_with = "ra")]
    pub name: Vec<String>,
    /// Right ascension (J2000) in degrees, in place of a name
    #[arg(long, value_name = "DEG", requires = "dec", allow_hyphen_values = true)]
    pub ra: Option<f64>,
    /// Declination (J2000) in degrees, with --ra
    #[arg(long, value_name = "DEG", requires = "ra", allow_hyphen_values = true)]
    pub dec: Option<f64>,
    /// Focal length of the eyepiece: one of the instrument's, or any, taken as a Plössl (default: the instrument's first)
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub eyepiece: Option<f64>,
    /// Over the object, beside it, or off
    #[arg(long, value_name = "MODE", default_value_t = Mode::Over)]
    pub mode: Mode,
    /// Instant, UTC: 2026-11-22T20:00:00Z (default: now)
    #[arg(long, value_name = "RFC3339", value_parser = Utc::from_rfc3339)]
    pub at: Option<Utc>,
    /// Observing site in degrees, north and east positive, and metres: it turns the field of an alt-azimuth mount
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    pub site: Option<Site>,
    /// Folder of your photographs: FITS with WCS, PNG or JPEG with a TOML file beside each [default: the settings']
    #[arg(long, value_name = "DIR")]
    pub photographs: Option<PathBuf>,
    /// Stellarium's folder, whose photographs are drawn too, or none [default: the settings', else the installed one]
    #[arg(long, value_name = "DIR")]
    pub stellarium: Option<PathBuf>,
    /// How much of the light of stars in photographs is taken away, 0 to 1 [default: the settings', else 0]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub soften_stars: Option<f32>,
    /// Folder of maps of Sun, Moon and planets to wrap on their discs: moon.jpg, jupiter.png..., equirectangular, longitude
    /// -180 degrees at the left edge [default: the settings']
    #[arg(long, value_name = "DIR")]
    pub maps: Option<PathBuf>,
    /// TT - UT1 in seconds (default: measured, then Espenak and Meeus)
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub delta_t: Option<f64>,
    /// Telescope, eyepieces and projector [default: the settings', else those of the thesis]
    #[arg(long, value_name = "FILE")]
    pub instrument: Option<PathBuf>,
    /// Brightness of the sky's background in magnitudes per square arcsecond [default: the settings', else 20.8]
    #[arg(long, value_name = "MAG")]
    pub sky_brightness: Option<f64>,
    /// Uncertainty of the pointing in arcminutes
    #[arg(long, value_name = "ARCMIN", default_value_t = 2.0)]
    pub uncertainty: f64,
    /// Move the picture by pixels to the right and down, as the arrow keys do
    #[arg(long, value_name = "RIGHT,DOWN", value_parser = pair, allow_hyphen_values = true)]
    pub nudge: Option<(f64, f64)>,
    /// Everything red, also stars and photographs
    #[arg(long)]
    pub red: bool,
    /// Overall brightness, 0 to 1
    #[arg(long, value_name = "GAIN", default_value_t = 1.0)]
    pub gain: f32,
    /// Operator that tones picture and words: tr93, tr99, ward or linear [default: the settings', else tr93]
    #[arg(long, value_name = "METHOD")]
    pub tone: Option<Method>,
    /// White of pictures, in magnitudes brighter than the object's own surface [default: the settings', else as --gain makes it]
    #[arg(long, value_name = "MAG", allow_hyphen_values = true)]
    pub picture_mag: Option<f64>,
    /// The same of words and marks, which are never brighter than the picture's white
    #[arg(long, value_name = "MAG", allow_hyphen_values = true)]
    pub words_mag: Option<f64>,
    /// Write the picture to this PNG file
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// What `overlay --json` answers.
#[derive(Debug, Serialize)]
struct Answer<'a> {
    out: &'a Path,
    width_px: usize,
    height_px: usize,
    target: Option<&'a str>,
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    eyepiece_mm: f64,
    magnification: f64,
    true_field_arcmin: f64,
    scale_arcsec_px: f64,
    /// From the picture's top counter-clockwise.
    north_deg: f64,
    mirrored: bool,
    mode: Mode,
    stars: usize,
    objects: Vec<&'static str>,
    bodies: Vec<&'static str>,
    photographs: Vec<&'a str>,
    /// Whose they are, and on which terms.
    credits: Vec<String>,
    black: bool,
    tone: Option<Tone>,
}

/// How bright it was made, in cd/m2 at the eye.
#[derive(Debug, Serialize)]
struct Tone {
    method: Method,
    clamped: bool,
    adaptation_world: f64,
    adaptation_display: f64,
    display_white: f64,
    display_black: f64,
    display_measured: bool,
    object: f64,
    object_is_sky: bool,
    picture_white: f64,
    words: f64,
    picture_over_object_mag: f64,
    words_over_object_mag: f64,
}

impl Tone {
    fn of(lights: &Lights) -> Tone {
        Tone {
            method: lights.method,
            clamped: lights.clamped,
            adaptation_world: lights.adapted.world_cd_m2,
            adaptation_display: lights.adapted.display_cd_m2,
            display_white: lights.display.full_cd_m2,
            display_black: lights.display.black_cd_m2,
            display_measured: lights.display.measured,
            object: lights.own_cd_m2,
            object_is_sky: !lights.of_object,
            picture_white: lights.picture_cd_m2(),
            words: lights.captions_cd_m2(),
            picture_over_object_mag: lights.over_own_mag(lights.picture_cd_m2()),
            words_over_object_mag: lights.over_own_mag(lights.captions_cd_m2()),
        }
    }
}

/// Runs the subcommand; what the command line leaves out comes from the settings.
///
/// # Errors
/// No such name, a number out of its range, a file that cannot be read or written.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    // Where to look, when, through what.
    let catalogue = Catalogue::embedded();
    let instrument_file = arguments.instrument.as_deref().or(settings.instrument.as_deref());
    let instrument = instrument(instrument_file, arguments.eyepiece)?;
    let site = arguments.site.or(settings.site);
    if site.is_none() {
        note("no --site was given: the field is drawn with north where the tube's upper side is");
    }
    let utc = arguments.at.unwrap_or_else(now);
    let moment = match arguments.delta_t {
        Some(seconds) => Moment { utc, delta_t_s: within("--delta-t", seconds, -100_000.0, 100_000.0)? },
        None => Moment { utc, delta_t_s: delta_t::default_seconds(utc) },
    };
    let target = target(arguments, catalogue, &moment, site.as_ref())?;
    let entry = match &target {
        Some(object) => object.astrometry,
        None => Astrometry::fixed(position(arguments)?),
    };
    let style = style(arguments, settings)?;
    let eye = Eye { sky: sky_brightness(arguments.sky_brightness, settings)?, pupil_mm: settings.pupil_mm };
    let soften = arguments.soften_stars.unwrap_or(settings.soften_stars);
    let mut album = Album::open(Sources {
        folder: arguments.photographs.as_deref().or(settings.photographs.as_deref()),
        stellarium: arguments.stellarium.as_deref().or(settings.stellarium.as_deref()),
        soften_stars: within("--soften-stars", f64::from(soften), 0.0, 1.0)? as f32,
    })?;

    let mut composer = Composer::default().with_maps(maps(arguments.maps.as_deref().or(settings.maps.as_deref()))?);

    // The field, what is in it, and the picture.
    let mut pointing = Pointing {
        position: Reduction::at(&moment).apparent(&entry),
        uncertainty: Angle::arcminutes(within("--uncertainty", arguments.uncertainty, 0.0, 600.0)?),
        motion: Motion::Tracking,
        stale: false,
    };
    if let Some((right, down)) = arguments.nudge {
        let field = FieldOfView::new(&pointing, &instrument, &moment, site.as_ref());
        pointing.position = field.nudge(right, down).applied(&pointing.position);
    }
    let field = FieldOfView::new(&pointing, &instrument, &moment, site.as_ref());
    let photographs = album.reaching(&field.centre(), compose::reach(&field, &style, target.as_ref()));
    album.notes.iter().for_each(|sentence| note(sentence));
    doubts(&photographs);
    let view = View {
        instrument: &instrument,
        site: site.as_ref(),
        catalogue,
        photographs: &photographs,
        target: target.as_ref(),
        eye: &eye,
        style: &style,
        animation: None,
        menu: None,
    };
    let Frame { field, found, picture } = pipeline::frame(&pointing, &moment, &view, &mut composer);
    write(&arguments.out, &png::encode(&picture).map_err(Failure::failed)?)?;

    let shown = Answer {
        out: &arguments.out,
        width_px: picture.width(),
        height_px: picture.height(),
        target: target.as_ref().map(|target| target.name.as_str()),
        ra_j2000_deg: field.centre().ra().to_degrees(),
        dec_j2000_deg: field.centre().dec().to_degrees(),
        eyepiece_mm: instrument.eyepiece().focal_length_mm,
        magnification: instrument.magnification(),
        true_field_arcmin: instrument.true_field().to_arcminutes(),
        scale_arcsec_px: instrument.pixel_scale().to_arcseconds(),
        north_deg: field.projection.north().wrapped().to_degrees(),
        mirrored: field.projection.mirrored(),
        mode: style.mode,
        stars: found.stars.len(),
        objects: found.objects.iter().map(|object| object.name).collect(),
        bodies: found.bodies.iter().map(|seen| seen.body.name()).collect(),
        photographs: photographs.iter().map(|photograph| photograph.name.as_str()).collect(),
        credits: photographs.iter().filter_map(Photograph::credit_line).collect(),
        black: picture.is_black(),
        tone: composer.lights().map(Tone::of),
    };
    composer.lights().map(Lights::notes).into_iter().flatten().for_each(|sentence| note(&sentence));
    if arguments.json {
        return answer_json(&shown);
    }
    answer(&format!(
        "{}: {} mm, {:.0}x, {:.1}' of sky, {:.3}\"/px, {} stars, {} deep-sky objects",
        arguments.out.display(),
        shown.eyepiece_mm,
        shown.magnification,
        shown.true_field_arcmin,
        shown.scale_arcsec_px,
        shown.stars,
        shown.objects.len()
    ))
}

/// What is looked at: a body of the solar system where it is at that moment, or what the catalogue has of that name.
fn target(
    arguments: &Arguments,
    catalogue: &Catalogue,
    moment: &Moment,
    site: Option<&Site>,
) -> Result<Option<Object>, Failure> {
    if arguments.ra.is_some() {
        return Ok(None);
    }
    let name = arguments.name.join(" ");
    if let Some(body) = Body::from_name(&name) {
        let ephemeris = Ephemeris::at(moment).map_err(Failure::failed)?;
        return Ok(Some(InView::of(&ephemeris, body, site).object()));
    }
    catalogue.search(&name).map(Some).map_err(Failure::failed)
}

/// The maps of a folder, by the names of their bodies.
fn maps(folder: Option<&Path>) -> Result<Vec<Map>, Failure> {
    let Some(folder) = folder else { return Ok(Vec::new()) };
    let (maps, notes) = photographs::read_maps(folder)?;
    notes.iter().for_each(|sentence| note(sentence));
    Ok(maps)
}

fn position(arguments: &Arguments) -> Result<Equatorial<crate::sky::coords::J2000>, Failure> {
    let ra = within("--ra", arguments.ra.unwrap_or(f64::NAN), 0.0, 360.0)?;
    let dec = within("--dec", arguments.dec.unwrap_or(f64::NAN), -90.0, 90.0)?;
    Ok(Equatorial::new(Angle::degrees(ra), Angle::degrees(dec)))
}

/// The instrument of a file, or the thesis' own, with an eyepiece in the holder.
///
/// # Errors
/// The file cannot be read or is wrong; an eyepiece of no believable focal length.
pub(super) fn instrument(file: Option<&Path>, eyepiece_mm: Option<f64>) -> Result<Instrument, Failure> {
    let instrument = match file {
        Some(path) => {
            let text = fs::read_to_string(path).map_err(|error| {
                Failure::Failed(format!("the instrument file {} cannot be read: {error}", path.display()))
            })?;
            Instrument::from_toml(&text).map_err(Failure::failed)?
        }
        None => Instrument::default(),
    };
    let instrument = calibrated(instrument);
    match eyepiece_mm {
        Some(mm) => Ok(instrument.with_eyepiece(within("--eyepiece", mm, 1.0, 200.0)?)),
        None => Ok(instrument),
    }
}

/// With what `calibrate moon` has kept. A file of it that cannot be used stops nobody: it is told, and left out.
fn calibrated(mut instrument: Instrument) -> Instrument {
    let kept = calibration::default_path().map(|path| Kept::load(&path, &mut Files)).transpose();
    match kept {
        Ok(kept) => instrument.calibration = kept.flatten().map_or(Calibration::default(), |kept| kept.now),
        Err(error) => note(&format!("the picture is drawn as if nothing was calibrated: {error}")),
    }
    instrument
}

/// The sky's brightness from the command line, else from the settings.
///
/// # Errors
/// Brighter than any twilight or darker than any sky.
pub(super) fn sky_brightness(given: Option<f64>, settings: &Settings) -> Result<SurfaceBrightness, Failure> {
    let mag = given.unwrap_or(settings.sky_brightness_mag_arcsec2);
    within("--sky-brightness", mag, 10.0, 25.0).map(SurfaceBrightness)
}

fn style(arguments: &Arguments, settings: &Settings) -> Result<Style, Failure> {
    let palette = if arguments.red { Palette::Red } else { Palette::Natural };
    within("--gain", f64::from(arguments.gain), 0.0, 1.0)?;
    let tone = Toning {
        method: arguments.tone.unwrap_or(settings.tone.method),
        picture_over_object_mag: arguments.picture_mag.or(settings.tone.picture_over_object_mag),
        captions_over_object_mag: arguments.words_mag.or(settings.tone.captions_over_object_mag),
    };
    tone.checked().map_err(Failure::Asked)?;
    Ok(Style {
        mode: arguments.mode,
        palette,
        gain: arguments.gain,
        facts: settings.facts.clone(),
        tone,
        display: light::display(&settings.light)?.dimmed(f64::from(arguments.gain)),
        ..Style::default()
    })
}

/// Tells of photographs that do not show what they are named after.
fn doubts(photographs: &[Photograph]) {
    for photograph in photographs {
        let object = photograph.object.as_ref().and_then(|name| Catalogue::embedded().search(name).ok());
        if let Some(doubt) = photograph.doubt(object.as_ref(), None) {
            note(&format!("the photograph {}: {doubt}", photograph.name));
        }
    }
}

/// Writes a file whole: beside, then renamed.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    fs::write(&part, bytes)
        .and_then(|()| fs::rename(&part, path))
        .map_err(|error| Failure::Failed(format!("the picture {} cannot be written: {error}", path.display())))
}

/// A number in its range.
///
/// # Errors
/// Names the option, the value and the range.
pub(super) fn within(option: &str, value: f64, least: f64, most: f64) -> Result<f64, Failure> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(Failure::Asked(format!("{option} is {value}: give {least} to {most}")))
    }
}

/// Reads `RIGHT,DOWN`.
fn pair(text: &str) -> Result<(f64, f64), String> {
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|part| part.trim().parse().ok().filter(|n: &f64| n.abs() <= 1e5)).collect();
    match numbers.as_deref() {
        Some(&[right, down]) => Ok((right, down)),
        _ => Err("a nudge is two numbers of pixels, right and down, like 12,-30".into()),
    }
}

/// The instant that the computer's clock shows.
pub(super) fn now() -> Utc {
    Utc(SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64()))
}
