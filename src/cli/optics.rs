//! `scotopic optics`: what the telescope shows with each eyepiece.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::overlay::{instrument, sky_brightness};
use super::settings::Settings;
use super::{Failure, answer, answer_json};
use crate::sky::optics::Instrument;
use crate::units::SurfaceBrightness;

/// The settings of `optics`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Telescope, eyepieces and projector [default: the settings', else those of the thesis]
    #[arg(long, value_name = "FILE")]
    pub instrument: Option<PathBuf>,
    /// Brightness of the sky's background in magnitudes per square arcsecond [default: the settings', else 20.8]
    #[arg(long, value_name = "MAG")]
    pub sky_brightness: Option<f64>,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// What `optics --json` answers.
#[derive(Debug, Serialize)]
struct Answer {
    telescope: String,
    aperture_mm: f64,
    focal_length_mm: f64,
    dawes_arcsec: f64,
    mirrored: bool,
    scale_arcsec_px: f64,
    picture_mm: (f64, f64),
    eyepieces: Vec<Row>,
}

/// One eyepiece.
#[derive(Debug, Serialize)]
struct Row {
    focal_length_mm: f64,
    magnification: f64,
    true_field_arcmin: f64,
    field_stop_known: bool,
    exit_pupil_mm: f64,
    limiting_magnitude: f64,
    field_covered: f64,
    picture_visible: f64,
}

/// Runs the subcommand.
///
/// # Errors
/// The instrument file cannot be read or is wrong.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let sky = sky_brightness(arguments.sky_brightness, settings)?;
    let instrument = instrument(arguments.instrument.as_deref().or(settings.instrument.as_deref()), None)?;
    let answered = derived(&instrument, settings.pupil_mm, sky);
    if arguments.json {
        return answer_json(&answered);
    }
    answer(&format!(
        "{}, {} mm, f = {} mm: splits {:.2}\", view {}\nprojector {:.2} x {:.2} mm in the focal plane, {:.3}\" a pixel\n\n\
         eyepiece   power   field  pupil  stars to  picture covers  picture visible",
        answered.telescope,
        answered.aperture_mm,
        answered.focal_length_mm,
        answered.dawes_arcsec,
        if answered.mirrored { "mirrored" } else { "not mirrored" },
        answered.picture_mm.0,
        answered.picture_mm.1,
        answered.scale_arcsec_px,
    ))?;
    for row in &answered.eyepieces {
        answer(&format!(
            "{:>5.1} mm {:>6.0}x {:>6.1}' {:>3.1} mm {:>9.1} {:>9.0} % of field {:>9.0} %",
            row.focal_length_mm,
            row.magnification,
            row.true_field_arcmin,
            row.exit_pupil_mm,
            row.limiting_magnitude,
            row.field_covered * 100.0,
            row.picture_visible * 100.0,
        ))?;
    }
    Ok(())
}

fn derived(instrument: &Instrument, pupil_mm: f64, sky: SurfaceBrightness) -> Answer {
    let telescope = &instrument.telescope;
    let rows = instrument.eyepieces.iter().enumerate().map(|(index, eyepiece)| {
        let mut with = instrument.clone();
        with.use_eyepiece(index);
        let coverage = with.projector.coverage(eyepiece.field_circle_mm(telescope));
        Row {
            focal_length_mm: eyepiece.focal_length_mm,
            magnification: with.magnification(),
            true_field_arcmin: with.true_field().to_arcminutes(),
            field_stop_known: eyepiece.field_stop_mm.is_some(),
            exit_pupil_mm: with.exit_pupil_mm(),
            limiting_magnitude: with.limiting_magnitude(pupil_mm, sky).0,
            field_covered: coverage.of_field,
            picture_visible: coverage.of_picture,
        }
    });
    Answer {
        telescope: telescope.name.clone(),
        aperture_mm: telescope.aperture_mm,
        focal_length_mm: telescope.focal_length_mm,
        dawes_arcsec: telescope.dawes_limit().to_arcseconds(),
        mirrored: telescope.mirrored(),
        scale_arcsec_px: instrument.pixel_scale().to_arcseconds(),
        picture_mm: instrument.projector.size_mm(),
        eyepieces: rows.collect(),
    }
}
