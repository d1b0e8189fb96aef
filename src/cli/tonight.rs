//! `scotopic tonight`: what is worth showing now, by what this telescope and eye can see.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::overlay::{instrument, now, within};
use super::settings::Settings;
use super::{Failure, answer, answer_json, note};
use crate::sky::astrometry::Reduction;
use crate::sky::catalogue::Catalogue;
use crate::sky::ephemeris::Ephemeris;
use crate::sky::horizon::Horizon;
use crate::sky::optics::Instrument;
use crate::sky::site::Site;
use crate::sky::time::{Moment, Utc};
use crate::sky::tonight::{EXTINCTION, Moving, Wanted, Worth, worth_showing};
use crate::sky::{atlas, sun};
use crate::units::{Angle, SurfaceBrightness};

/// So many are told to a person.
const TOLD: usize = 25;

/// The settings of `tonight`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    scotopic tonight --site 60.17,24.94,30 --sky 20.8\n  \
    scotopic tonight --site 60.17,24.94,30 --at 2026-11-22T20:00:00Z --minimum-altitude 25 --most 100 --json\n  \
    scotopic tonight --minimum-altitude -90 --most 0      every object that this telescope can show, risen or not\n\n\
    Objects are ranked by the reserve over the eye's threshold (Crumey 2014, behind the air) with the best eyepiece owned, by being\n\
    listed (Messier, Caldwell, Herschel 400; Moon and planets count as Messier's) and named, and by altitude. --sky is the sky\n\
    without Moon: its light is added (Krisciunas and Schaefer 1991), unless --minimum-altitude is below 0. Twilight is only in --sky.")]
pub struct Arguments {
    /// Observing site in degrees, north and east positive, and metres [default: the settings']
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    pub site: Option<Site>,
    /// Instant, UTC: 2026-11-22T20:00:00Z (default: now)
    #[arg(long, value_name = "RFC3339", value_parser = Utc::from_rfc3339)]
    pub at: Option<Utc>,
    /// Brightness of the sky's background, V magnitudes per square arcsecond [default: the settings', else 20.8]
    #[arg(long, value_name = "MAG", allow_hyphen_values = true)]
    pub sky: Option<f64>,
    /// Show nothing lower, degrees
    #[arg(long, value_name = "DEG", default_value_t = 25.0, allow_hyphen_values = true)]
    pub minimum_altitude: f64,
    /// Diameter of the eye's pupil in the dark, millimetres [default: the settings', else 7]
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub pupil_mm: Option<f64>,
    /// Magnitudes that an air mass takes
    #[arg(long, value_name = "MAG", default_value_t = EXTINCTION, allow_hyphen_values = true)]
    pub extinction: f64,
    /// Telescope and eyepieces [default: the settings', else those of the thesis]
    #[arg(long, value_name = "FILE")]
    pub instrument: Option<PathBuf>,
    /// Tell so many, 0 for all [default: 25; all with --json]
    #[arg(long, value_name = "NUMBER")]
    pub most: Option<usize>,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// One row of what `tonight --json` answers.
#[derive(Debug, Serialize)]
struct Row<'a> {
    name: &'a str,
    names: &'a [String],
    r#type: &'a str,
    constellation: &'a str,
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    alt_deg: f64,
    az_deg: f64,
    v_mag: Option<f64>,
    v_mag_estimated: bool,
    sky_mag_arcsec2: f64,
    size_arcmin: Option<[f64; 2]>,
    surface_brightness_mag_arcsec2: Option<f64>,
    reserve: f64,
    verdict: &'static str,
    best_eyepiece_mm: Option<f64>,
    useful_eyepieces_mm: Vec<f64>,
    useful_magnifications: Option<(f64, f64)>,
    larger_than_field: bool,
    uranometria_chart: u32,
    millennium_chart: u32,
    score: f64,
}

/// Runs the subcommand.
///
/// # Errors
/// No site, a number out of its range, an instrument file that cannot be used.
pub fn run(arguments: &Arguments, settings: &Settings) -> Result<(), Failure> {
    let site = arguments.site.or(settings.site).ok_or_else(|| {
        Failure::asked("the site is unknown: give --site LAT,LON,ELEV, or write [site] into the settings")
    })?;
    let sky = arguments.sky.unwrap_or(settings.sky_brightness_mag_arcsec2);
    let wanted = Wanted {
        pupil_mm: within("--pupil-mm", arguments.pupil_mm.unwrap_or(settings.pupil_mm), 0.5, 10.0)?,
        sky: within("--sky", sky, 4.0, 25.0).map(SurfaceBrightness)?,
        extinction: within("--extinction", arguments.extinction, 0.0, 5.0)?,
        minimum_altitude: Angle::degrees(within("--minimum-altitude", arguments.minimum_altitude, -90.0, 90.0)?),
    };
    let instrument = instrument(arguments.instrument.as_deref().or(settings.instrument.as_deref()), None)?;
    let moment = Moment::at(arguments.at.unwrap_or_else(now));
    let sun = sun::horizontal(&moment, &site).altitude().to_degrees();
    if sun > -12.0 {
        note(&format!("the Sun's altitude is {sun:.0}°: the sky is brighter than {sky}"));
    }

    let reduction = Reduction::at(&moment);
    let horizon = Horizon::new(&reduction, &site);
    // Beyond the years of the ephemeris there is neither Moon nor planet, and that is said.
    let moving = match Ephemeris::at(&moment) {
        Ok(ephemeris) => Moving::at(&ephemeris, &site, wanted.extinction),
        Err(error) => {
            note(&format!("no Moon and no planets: {error}"));
            Moving::default()
        }
    };
    // Below the horizon it is the list of what this telescope can show at all, whatever the Moon does now.
    let listed = wanted.minimum_altitude.to_radians() < 0.0;
    let moving = Moving { moonlight: moving.moonlight.filter(|_| !listed), ..moving };
    if let Some((light, _)) = moving.moonlight.filter(|(light, _)| light.altitude.to_radians() > 0.0) {
        let zenith = light.on(wanted.sky, Angle::degrees(90.0), Angle::degrees(90.0) - light.altitude).0;
        note(&format!(
            "the Moon is up ({:.0}° high): the zenith is at {zenith:.1} instead of {sky} mag per square arcsecond",
            light.altitude.to_degrees()
        ));
    }
    let worth = worth_showing(Catalogue::embedded(), &instrument, &reduction, &horizon, &wanted, &moving);
    let most = match arguments.most {
        Some(0) => usize::MAX,
        Some(most) => most,
        None if arguments.json => usize::MAX,
        None => TOLD,
    };
    let rows: Vec<Row<'_>> = worth.iter().take(most).map(|worth| row(worth, &instrument)).collect();
    if arguments.json {
        return answer_json(&rows);
    }
    answer(&format!(
        "{} of {} objects that can be shown at {} under {sky}, the most worth it first\n\n\
         object           type                   in    alt   az     V     size          reserve              eyepiece",
        rows.len(),
        worth.len(),
        moment.utc.to_rfc3339()
    ))?;
    for row in &rows {
        answer(&line(row))?;
    }
    Ok(())
}

fn row<'a>(worth: &'a Worth, instrument: &Instrument) -> Row<'a> {
    let (object, powers) = (&worth.object, &worth.powers);
    let place = &object.astrometry.position;
    let mm = |index: usize| instrument.eyepieces.get(index).map(|eyepiece| eyepiece.focal_length_mm);
    Row {
        name: &object.name,
        names: &object.names,
        r#type: object.type_words(),
        constellation: object.constellation,
        ra_j2000_deg: place.ra().to_degrees(),
        dec_j2000_deg: place.dec().to_degrees(),
        alt_deg: worth.horizontal.altitude().to_degrees(),
        az_deg: worth.horizontal.azimuth().to_degrees(),
        v_mag: object.v_magnitude().or_else(|| object.estimated_v_magnitude()).map(|v| v.0),
        v_mag_estimated: worth.estimated,
        sky_mag_arcsec2: worth.sky.0,
        size_arcmin: object.axes_arcmin.map(|(major, minor)| [major, minor]),
        surface_brightness_mag_arcsec2: object.surface_brightness.map(|mean| mean.0),
        reserve: worth.reserve,
        verdict: worth.verdict().words(),
        best_eyepiece_mm: powers.best.and_then(mm),
        useful_eyepieces_mm: powers.useful.iter().copied().filter_map(mm).collect(),
        useful_magnifications: powers.range,
        larger_than_field: powers.overflows,
        uranometria_chart: atlas::uranometria(place).chart,
        millennium_chart: atlas::millennium(place).chart,
        score: worth.score,
    }
}

/// A row for a person.
fn line(row: &Row<'_>) -> String {
    let size = row.size_arcmin.map_or_else(String::new, |[major, minor]| format!("{major:.1} x {minor:.1}'"));
    let eyepiece = row.best_eyepiece_mm.map_or_else(String::new, |mm| format!("{mm} mm"));
    let powers = row.useful_magnifications.map_or_else(String::new, |(low, high)| format!(" ({low:.0}-{high:.0}x)"));
    let wide = if row.larger_than_field { ", larger than the field" } else { "" };
    format!(
        "{:<17}{:<23}{:<4}{:>5.0}{:>5.0}{:>6.1}{} {size:<14}{:+.2} {:<15} {eyepiece}{powers}{wide}",
        row.name,
        row.r#type,
        row.constellation,
        row.alt_deg,
        row.az_deg,
        row.v_mag.unwrap_or(f64::NAN),
        if row.v_mag_estimated { '~' } else { ' ' },
        row.reserve,
        row.verdict,
    )
}
