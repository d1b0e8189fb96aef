//! `scotopic calibrate moon`: two photographs of the Moon through the eyepiece, one seen and one projected (section 8.7.1).

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::photograph;
use crate::cli::overlay::{instrument, within};
use crate::cli::settings::Settings;
use crate::cli::settings::calibration::{self, Kept};
use crate::cli::settings::disk::Files;
use crate::cli::{Failure, answer, answer_json, note};
use crate::physics::refraction::{Air, of_true_altitude};
use crate::registration::{Limb, Pair, Shape};
use crate::sky::delta_t;
use crate::sky::ephemeris::{Body, Ephemeris};
use crate::sky::horizon::{self, Horizon};
use crate::sky::optics::{Calibration, Instrument};
use crate::sky::physical::Aspect;
use crate::sky::site::Site;
use crate::sky::time::{Moment, Utc};
use crate::units::Angle;

/// The settings of `calibrate moon`.
#[derive(Debug, Args)]
#[command(
    after_help = "Both photographs are taken through the eyepiece by a camera that is not moved in between: the Moon with the\n\
    projector dark, then the drawn Moon (`scotopic overlay Moon --out moon.png`, and show it) with the tube covered.\n\n\
    The scale is the drawn size over the seen one: 0.6 says that all is drawn 40 % too small. --at and --site tell how large the\n\
    Moon is, and how much flatter the air makes it when it is low.\n\nExamples:\n  \
    scotopic calibrate moon seen.jpg drawn.jpg --at 2026-11-22T20:00:00Z --site 60.17,24.94,30\n  \
    scotopic calibrate moon seen.fits drawn.fits --json"
)]
pub struct Arguments {
    /// Photograph of the Moon through the telescope: PNG, JPEG or FITS
    #[arg(value_name = "TELESCOPE")]
    pub telescope: PathBuf,
    /// Photograph of the projected Moon through the same eyepiece
    #[arg(value_name = "PROJECTED")]
    pub projected: PathBuf,
    /// When the Moon was photographed, UTC: 2026-11-22T20:00:00Z
    #[arg(long, value_name = "RFC3339", value_parser = Utc::from_rfc3339)]
    pub at: Option<Utc>,
    /// Observing site in degrees, north and east positive, and metres [default: the settings']
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    pub site: Option<Site>,
    /// TT - UT1 in seconds (default: measured, then Espenak and Meeus)
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub delta_t: Option<f64>,
    /// Direction of the zenith in the telescope's photograph, degrees clockwise from its top (default: from the bright limb)
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub up: Option<f64>,
    /// Telescope, eyepieces and projector [default: the settings', else those of the thesis]
    #[arg(long, value_name = "FILE")]
    pub instrument: Option<PathBuf>,
    /// Measure only: keep nothing
    #[arg(long)]
    pub measure_only: bool,
    /// The drawn Moon was drawn as if nothing had been calibrated: begin anew instead of adding to what is kept
    #[arg(long)]
    pub anew: bool,
    /// Keep scale, turn and parity, and not the offset: for a Moon that was not centred before it was photographed
    #[arg(long)]
    pub without_offset: bool,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// The Moon's diameter at its mean distance.
const MEAN_DIAMETER_ARCSEC: f64 = 1865.2;

/// The Moon as the almanac has it.
#[derive(Debug, Clone, Copy, Serialize)]
struct Known {
    diameter_arcsec: f64,
    phase: f64,
    altitude_deg: f64,
    flattening: f64,
    /// Position angles of date: the middle of the bright limb, and the zenith.
    #[serde(skip)]
    bright_limb: Angle,
    #[serde(skip)]
    zenith: Angle,
}

/// A limb as it is told.
#[derive(Debug, Serialize)]
struct ToldLimb {
    x_px: f64,
    y_px: f64,
    radius_px: f64,
    radius_error_px: f64,
    arc_deg: f64,
    blur_px: f64,
    roughness_px: f64,
    camera_curve: f64,
}

/// What `calibrate moon --json` answers. Errors are one standard deviation; what is unknown is null.
#[derive(Debug, Serialize)]
struct Told<'a> {
    scale: f64,
    scale_error: f64,
    offset_px: [f64; 2],
    offset_error_px: [f64; 2],
    rotation_deg: Option<f64>,
    rotation_error_deg: Option<f64>,
    mirrored: Option<bool>,
    limb_scale: f64,
    limb_scale_error: f64,
    surface_scale: Option<f64>,
    surface_scale_error: Option<f64>,
    contradiction_sigma: Option<f64>,
    telescope: ToldLimb,
    projected: ToldLimb,
    camera_arcsec_px: Option<f64>,
    moon: Option<Known>,
    kept: Option<Calibration>,
    kept_in: Option<PathBuf>,
    notes: &'a [String],
}

/// Runs the subcommand.
///
/// # Errors
/// A file that cannot be read, a photograph without a Moon, a Moon below the horizon.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let file = arguments.instrument.as_deref().or(settings.instrument.as_deref());
    let instrument = instrument(file, None)?;
    let known = known(arguments, settings)?;
    let (telescope, projected) = (photograph::read(&arguments.telescope)?, photograph::read(&arguments.projected)?);
    let mut notes = Vec::new();
    let (shape, doubt) = shape(arguments, &instrument, known.as_ref(), &telescope, &mut notes)?;
    let mut pair = Pair::measured(&telescope, &projected, shape).map_err(Failure::failed)?;
    pair.widen(doubt);
    if pair.contradiction.is_some_and(|sigmas| sigmas > 3.0) {
        notes.push(
            "limb and surface disagree by more than three standard deviations, so the error was widened: look whether one \
             photograph is unsharp, or the drawn Moon is of another hour"
                .into(),
        );
    }
    if known.is_none() {
        notes.push("without --at and a site the Moon's size and its flattening by the air are unknown".into());
    }
    let kept =
        if arguments.measure_only { None } else { keep(arguments, &instrument, &pair, known.as_ref(), &mut notes)? };
    let mut told = told(&pair, known, &notes);
    (told.kept, told.kept_in) = kept.unzip();
    if arguments.json {
        return answer_json(&told);
    }
    notes.iter().for_each(|sentence| note(sentence));
    answer(page(&told).trim_end())
}

/// Where and how large the Moon was, if time and site are known.
fn known(arguments: &Arguments, settings: &Settings) -> Result<Option<Known>, Failure> {
    let (Some(utc), Some(site)) = (arguments.at, arguments.site.or(settings.site)) else { return Ok(None) };
    let moment = match arguments.delta_t {
        Some(seconds) => Moment { utc, delta_t_s: within("--delta-t", seconds, -100_000.0, 100_000.0)? },
        None => Moment { utc, delta_t_s: delta_t::default_seconds(utc) },
    };
    let ephemeris = Ephemeris::at(&moment).map_err(Failure::asked)?;
    let place = ephemeris.place(Body::Moon);
    let seen = place.topocentric(ephemeris.reduction(), &site);
    let horizon = Horizon::new(ephemeris.reduction(), &site);
    let (air, altitude) = (Air::default(), horizon.airless(&seen.apparent));
    let apparent = horizon::refracted(&altitude, &air).altitude();
    if apparent.to_degrees() < 0.0 {
        return Err(Failure::Asked(format!(
            "the Moon was at {:.1} degrees of altitude at that time and site: see that --at is UTC and east is positive in --site",
            apparent.to_degrees()
        )));
    }
    let lift = |by: f64| of_true_altitude(altitude.altitude() + Angle::arcminutes(by), &air).to_arcminutes();
    let aspect = Aspect::topocentric(&ephemeris, &place, &site);
    Ok(Some(Known {
        diameter_arcsec: place.angular_diameter(seen.distance_au).to_arcseconds(),
        phase: aspect.phase(),
        altitude_deg: apparent.to_degrees(),
        flattening: ((lift(-15.0) - lift(15.0)) / 30.0).clamp(0.0, 0.5),
        bright_limb: aspect.bright_limb_position_angle,
        zenith: horizon.parallactic_angle(&seen.apparent),
    }))
}

/// What two photographs say of a canvas whose pixels are so many of the camera's. The camera is held upright: the canvas' upper
/// edge is the photographs'. A turn that is not known to a degree is left out.
#[must_use]
pub fn calibration_of(pair: &Pair, camera_per_canvas: f64) -> Calibration {
    // What was drawn too far right is to be drawn further left.
    let [right, down] = pair.offset_px.map(|offset| -offset.value / camera_per_canvas);
    let turn = pair.rotation_deg.filter(|turn| turn.error < 1.0);
    Calibration {
        scale: pair.scale.value,
        scale_error: pair.scale.error,
        turn_deg: turn.map_or(0.0, |turn| turn.value),
        turn_error_deg: turn.map_or(0.0, |turn| turn.error),
        mirrored: pair.mirrored.unwrap_or(false),
        right_px: right,
        down_px: down,
        offset_error_px: pair.offset_px[0].error.max(pair.offset_px[1].error) / camera_per_canvas,
    }
}

/// Keeps what was measured, in pixels of the canvas; nothing where it would make no sense.
fn keep(
    arguments: &Arguments,
    instrument: &Instrument,
    pair: &Pair,
    known: Option<&Known>,
    notes: &mut Vec<String>,
) -> Result<Option<(Calibration, PathBuf)>, Failure> {
    let Some(path) = calibration::default_path() else {
        notes.push("nothing was kept: there is no folder for it; set XDG_STATE_HOME or HOME".into());
        return Ok(None);
    };
    let before = if arguments.anew { None } else { Kept::load(&path, &mut Files)? };
    // The drawn Moon has so many pixels on the canvas as its diameter has of them: so many camera pixels are one of the canvas.
    let diameter = known.map_or(MEAN_DIAMETER_ARCSEC, |known| known.diameter_arcsec);
    let drawn_with = before.as_ref().map_or(Calibration::default(), |kept| kept.now).scale;
    let per_px = instrument.projector.pixel_scale(instrument.telescope.focal_length_mm).to_arcseconds() * drawn_with;
    let camera_per_canvas = pair.projected.radius / (diameter / 2.0 / per_px);
    let mut measured = calibration_of(pair, camera_per_canvas);
    if measured.turn_error_deg == 0.0 {
        notes.push("the turn was not kept: it is not known to a degree".into());
    }
    if arguments.without_offset {
        measured = Calibration { right_px: 0.0, down_px: 0.0, offset_error_px: 0.0, ..measured };
    }
    let photographed = arguments.at.map_or_else(String::new, |utc| utc.to_rfc3339());
    let photographs = format!(
        "{:016x}-{:016x}",
        photograph::digest(&arguments.telescope)?,
        photograph::digest(&arguments.projected)?
    );
    let kept = Kept::after(before.as_ref(), &photographs, &photographed, &measured);
    if !kept.now.is_sane() {
        notes.push(format!(
            "nothing was kept: with what was measured before, the scale would be {:.3}; see `scotopic calibrate show`, or give --anew",
            kept.now.scale
        ));
        return Ok(None);
    }
    kept.save(&path, &mut Files)?;
    Ok(Some((kept.now, path)))
}

/// What the air makes of the disc, and how much that may be wrong, relative to the scale.
fn shape(
    arguments: &Arguments,
    instrument: &Instrument,
    known: Option<&Known>,
    telescope: &crate::registration::Frame,
    notes: &mut Vec<String>,
) -> Result<(Shape, f64), Failure> {
    let up = arguments.up.map(|up| within("--up", up, -360.0, 360.0)).transpose()?;
    let Some(known) = known.filter(|known| known.flattening > 1e-4) else { return Ok((Shape::ROUND, 0.0)) };
    // Refraction near the horizon is known to a tenth, higher up to a hundredth.
    let doubt = known.flattening * if known.altitude_deg < 5.0 { 0.1 } else { 0.01 };
    if let Some(up) = up {
        // From the picture's x axis to its y axis; the top is at -90 degrees.
        return Ok((Shape { flattening: known.flattening, up: Angle::degrees(up - 90.0) }, doubt));
    }
    let limb = Limb::of(telescope, Shape::ROUND).ok();
    let bright = limb.and_then(|limb| limb.bright).filter(|_| known.phase < 0.985);
    let Some(bright) = bright else {
        notes.push(format!(
            "the air flattens the Moon by {:.2} %, and near full moon nothing tells where its upper side is in the photograph: the \
             error was widened; give --up",
            100.0 * known.flattening
        ));
        return Ok((Shape::ROUND, known.flattening / 3.0));
    };
    // Position angles grow counter-clockwise in the plain view, clockwise in the mirrored one.
    let from_bright = known.zenith - known.bright_limb;
    let from_bright = if instrument.telescope.mirrored() { from_bright } else { -from_bright };
    Ok((Shape { flattening: known.flattening, up: Angle::radians(bright) + from_bright }, doubt))
}

fn told<'a>(pair: &Pair, known: Option<Known>, notes: &'a [String]) -> Told<'a> {
    let limb = |limb: &Limb| ToldLimb {
        x_px: limb.x,
        y_px: limb.y,
        radius_px: limb.radius,
        radius_error_px: limb.radius * limb.radius_error(),
        arc_deg: limb.arc_deg,
        blur_px: limb.blur_px,
        roughness_px: limb.roughness_px,
        camera_curve: limb.tone,
    };
    Told {
        scale: pair.scale.value,
        scale_error: pair.scale.error,
        offset_px: pair.offset_px.map(|offset| offset.value),
        offset_error_px: pair.offset_px.map(|offset| offset.error),
        rotation_deg: pair.rotation_deg.map(|turn| turn.value),
        rotation_error_deg: pair.rotation_deg.map(|turn| turn.error),
        mirrored: pair.mirrored,
        limb_scale: pair.limb_scale.value,
        limb_scale_error: pair.limb_scale.error,
        surface_scale: pair.surface_scale.map(|scale| scale.value),
        surface_scale_error: pair.surface_scale.map(|scale| scale.error),
        contradiction_sigma: pair.contradiction,
        telescope: limb(&pair.telescope),
        projected: limb(&pair.projected),
        camera_arcsec_px: known.map(|known| known.diameter_arcsec / (2.0 * pair.telescope.radius)),
        moon: known,
        kept: None,
        kept_in: None,
        notes,
    }
}

/// The answer for a person.
fn page(told: &Told<'_>) -> String {
    let mut page = String::new();
    let mut line = |what: &str, text: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(page, "{what:<20}{text}");
    };
    line("scale", format!("{:.4} ± {:.4}, drawn over seen", told.scale, told.scale_error));
    let [x, y] = told.offset_px;
    line(
        "offset",
        format!(
            "{x:+.1} px right, {y:+.1} px down (± {:.1}), of the photographs",
            told.offset_error_px[0].max(told.offset_error_px[1])
        ),
    );
    match (told.rotation_deg, told.rotation_error_deg) {
        (Some(turn), Some(error)) => line("turned", format!("{turn:+.2}° ± {error:.2}° counter-clockwise")),
        _ => line("turned", "unknown: neither maria nor a terminator tell; take photographs near half moon".into()),
    }
    line(
        "mirrored",
        match told.mirrored {
            Some(true) => "yes: the drawn Moon is the seen one's mirror image".into(),
            Some(false) => "no".into(),
            None => "unknown: the drawn Moon shows no maria; give it a map (overlay --maps)".into(),
        },
    );
    line("by the limbs", format!("{:.4} ± {:.4}", told.limb_scale, told.limb_scale_error));
    if let (Some(scale), Some(error)) = (told.surface_scale, told.surface_scale_error) {
        line("by the maria", format!("{scale:.4} ± {error:.4}"));
    }
    for (what, limb) in [("seen", &told.telescope), ("drawn", &told.projected)] {
        line(
            what,
            format!(
                "radius {:.2} ± {:.2} px over {:.0}° of limb, blur {:.1} px, rough to {:.2} px",
                limb.radius_px, limb.radius_error_px, limb.arc_deg, limb.blur_px, limb.roughness_px
            ),
        );
    }
    if let (Some(moon), Some(per_px)) = (&told.moon, told.camera_arcsec_px) {
        line(
            "the Moon",
            format!(
                "{:.1}\" across, {:.1}° high, flattened by {:.2} %; {per_px:.3}\" a pixel of the camera",
                moon.diameter_arcsec,
                moon.altitude_deg,
                100.0 * moon.flattening
            ),
        );
    }
    if let (Some(kept), Some(path)) = (&told.kept, &told.kept_in) {
        line(
            "kept",
            format!(
                "scale {:.4}, turn {:+.2}°, axis {:+.1}, {:+.1} px off the canvas' middle, in {}",
                kept.scale,
                kept.turn_deg,
                kept.right_px,
                kept.down_px,
                path.display()
            ),
        );
    }
    page
}
