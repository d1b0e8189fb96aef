//! `scotopic photographs list`: which photographs there are, of what, whose, and whether they lie where they say.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::album::{Album, Sources};
use crate::cli::settings::Settings;
use crate::cli::{Failure, answer, answer_json, note};
use crate::overlay::Photograph;
use crate::overlay::photograph::stars;
use crate::sky::catalogue::Catalogue;
use crate::units::Angle;

/// The settings of `photographs list`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic photographs list                          all, with credit and terms\n  \
    scotopic photographs list --check M57 ngc7000      whether these lie where their stars are\n  \
    scotopic photographs list --photographs ~/sky --stellarium none --check")]
pub struct Arguments {
    /// Only those of these objects, by any name that the catalogue knows
    pub object: Vec<String>,
    /// Folder of your photographs [default: the settings']
    #[arg(long, value_name = "DIR")]
    pub photographs: Option<PathBuf>,
    /// Stellarium's folder, or none [default: the settings', else the installed one]
    #[arg(long, value_name = "DIR")]
    pub stellarium: Option<PathBuf>,
    /// Compare the stars of each with the catalogue's
    #[arg(long)]
    pub check: bool,
    /// The year of the photographs, to which the catalogue's stars are moved
    #[arg(long, value_name = "YEAR", default_value_t = 2010.0, allow_negative_numbers = true)]
    pub year: f64,
    /// Answer in JSON: one object a line
    #[arg(long)]
    pub json: bool,
}

/// A photograph in the list.
#[derive(Debug, Serialize)]
struct Line<'a> {
    name: &'a str,
    object: Option<&'a str>,
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    width_px: usize,
    height_px: usize,
    scale_arcsec_px: f64,
    /// By how much the plate misses the corners that it was made from.
    corner_miss_arcsec: Option<f64>,
    /// From its middle to where the catalogue has its object.
    object_off_middle_arcmin: Option<f64>,
    /// Magnitudes per square arcsecond of its full light.
    full_light_mag_arcsec2: Option<f64>,
    credit: Option<&'a str>,
    licence: Option<&'a str>,
    url: Option<&'a str>,
    stars: Option<Stars>,
    /// What is doubtful about its place.
    doubt: Option<String>,
}

/// How its stars lie to the catalogue's.
#[derive(Debug, Serialize)]
struct Stars {
    looked_for: usize,
    met: usize,
    by_chance: f64,
    median_arcsec: f64,
    agree: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// A folder that cannot be read; an object that no catalogue knows.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    if !(1850.0..=2150.0).contains(&arguments.year) {
        return Err(Failure::Asked(format!("--year is {}: give 1850 to 2150", arguments.year)));
    }
    let catalogue = Catalogue::embedded();
    let search = |name: &String| catalogue.search(name).map(|object| object.name).map_err(Failure::failed);
    let wanted: Vec<String> = arguments.object.iter().map(search).collect::<Result<_, _>>()?;
    let album = Album::open(Sources {
        folder: arguments.photographs.as_deref().or(settings.photographs.as_deref()),
        stellarium: arguments.stellarium.as_deref().or(settings.stellarium.as_deref()),
        soften_stars: 0.0,
    })?;
    album.notes.iter().for_each(|sentence| note(sentence));
    if album.is_empty() {
        note("there are no photographs: install stellarium-data, or give --photographs or --stellarium");
    }
    for photograph in album.each() {
        let photograph = match photograph {
            Ok(photograph) => photograph,
            Err(sentence) => {
                note(&sentence);
                continue;
            }
        };
        let of_wanted = |name: &String| photograph.object.as_ref() == Some(name);
        if !wanted.is_empty() && !wanted.iter().any(of_wanted) {
            continue;
        }
        let line = line(&photograph, arguments, catalogue);
        if arguments.json {
            answer_json(&line)?;
        } else {
            answer(&words(&line))?;
        }
    }
    Ok(())
}

fn line<'a>(photograph: &'a Photograph, arguments: &Arguments, catalogue: &Catalogue) -> Line<'a> {
    let middle = photograph.middle();
    let object = photograph.object.as_ref().and_then(|name| catalogue.search(name).ok());
    let agreement =
        arguments.check.then(|| stars::agreement(photograph, catalogue, Angle::arcseconds(60.0), arguments.year));
    let agreement = agreement.flatten();
    let (width_px, height_px) = photograph.size();
    Line {
        name: &photograph.name,
        object: photograph.object.as_deref(),
        ra_j2000_deg: middle.ra().to_degrees(),
        dec_j2000_deg: middle.dec().to_degrees(),
        width_px,
        height_px,
        scale_arcsec_px: photograph.plate.scale().to_arcseconds(),
        corner_miss_arcsec: photograph.miss.map(Angle::to_arcseconds),
        object_off_middle_arcmin: object
            .as_ref()
            .map(|object| object.astrometry.position.separation(&middle).to_arcminutes()),
        full_light_mag_arcsec2: photograph.full_light.map(|full| full.0),
        credit: photograph.credit.as_deref(),
        licence: photograph.licence.as_deref(),
        url: photograph.url.as_deref(),
        stars: agreement.map(|found| Stars {
            looked_for: found.stars,
            met: found.met,
            by_chance: found.by_chance,
            median_arcsec: found.median.to_arcseconds(),
            agree: found.holds(),
        }),
        doubt: photograph.doubt(object.as_ref(), agreement.as_ref()),
    }
}

fn words(line: &Line) -> String {
    let mut words = format!(
        "{:<22} {:<12} {:>4} x {:<4} {:>7.2}\"/px",
        line.name,
        line.object.unwrap_or("-"),
        line.width_px,
        line.height_px,
        line.scale_arcsec_px
    );
    if let Some(stars) = &line.stars {
        words += &format!("  {}/{} stars, {:.1}\"", stars.met, stars.looked_for, stars.median_arcsec);
    }
    words += &format!("  {} ({})", line.credit.unwrap_or("nobody named"), line.licence.unwrap_or("terms unknown"));
    if let Some(doubt) = &line.doubt {
        words += &format!("\n    {doubt}");
    }
    words
}
