//! `scotopic sky`: where something is, and what is in a field.

/// Sun, Moon and planets.
mod solar;

use std::fmt::Write;

use clap::{Args, Subcommand};
use serde::Serialize;

use super::{Failure, answer, answer_json};
use crate::physics::refraction::Air;
use crate::sky::astrometry::{Astrometry, Reduction};
use crate::sky::atlas;
use crate::sky::catalogue::{Band, Catalogue, Object, constellation};
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::ephemeris::{Body, moons};
use crate::sky::horizon::{self, Horizon};
use crate::sky::site::Site;
use crate::sky::time::{Moment, Utc};
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};
use crate::units::{Angle, Magnitude};

/// What can be asked of the sky.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Say where a star or deep-sky object is, and what is known of it
    Show(ShowArguments),
    /// List what is in a circle on the sky, nearest first
    Field(FieldArguments),
}

/// The settings of `sky show`.
#[derive(Debug, Args)]
pub struct ShowArguments {
    /// A name: Jupiter, Io, Moon, M31, ngc 224, andromeda galaxy, Polaris, HIP 11767, C 14, alpha centauri, α Cen, 61 Cyg
    #[arg(value_name = "NAME", required_unless_present = "ra", conflicts_with = "ra")]
    pub name: Vec<String>,
    /// Right ascension (J2000) in degrees, in place of a name
    #[arg(long, value_name = "DEG", requires = "dec", allow_hyphen_values = true)]
    pub ra: Option<f64>,
    /// Declination (J2000) in degrees, with --ra
    #[arg(long, value_name = "DEG", requires = "ra", allow_hyphen_values = true)]
    pub dec: Option<f64>,
    /// Instant, UTC: 2026-11-22T20:00:00Z (default: now)
    #[arg(long, value_name = "RFC3339", value_parser = Utc::from_rfc3339)]
    pub at: Option<Utc>,
    /// Observing site in degrees, north and east positive, and metres
    #[arg(long, value_name = "LAT,LON,ELEV", allow_hyphen_values = true)]
    pub site: Option<Site>,
    /// TT - UT1 in seconds (default: measured, then Espenak and Meeus)
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub delta_t: Option<f64>,
    /// Air pressure at the site, for refraction
    #[arg(long, value_name = "HPA", default_value_t = 1010.0)]
    pub pressure: f64,
    /// Air temperature at the site in degrees Celsius, for refraction
    #[arg(long, value_name = "CELSIUS", default_value_t = 10.0, allow_hyphen_values = true)]
    pub temperature: f64,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// The settings of `sky field`.
#[derive(Debug, Args)]
pub struct FieldArguments {
    /// Right ascension (J2000) of the centre in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub ra: f64,
    /// Declination (J2000) of the centre in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub dec: f64,
    /// Radius of the circle in arcminutes
    #[arg(long, value_name = "ARCMIN", allow_hyphen_values = true)]
    pub radius_arcmin: f64,
    /// Leave out what is fainter (objects of unknown magnitude stay)
    #[arg(long, value_name = "MAG", default_value_t = 99.0, allow_hyphen_values = true)]
    pub faintest: f64,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand; `profile_site` is the observer's own site, used where none is given.
///
/// # Errors
/// No such name, or a number out of its range.
pub fn run(command: &Command, profile_site: Option<Site>) -> Result<(), Failure> {
    match command {
        Command::Show(arguments) => show(arguments, profile_site),
        Command::Field(arguments) => field(arguments),
    }
}

/// What `sky show --json` answers. What is unknown is null.
#[derive(Debug, Serialize)]
struct Shown<'a> {
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    ra_apparent_deg: f64,
    dec_apparent_deg: f64,
    alt_deg: Option<f64>,
    alt_refracted_deg: Option<f64>,
    az_deg: Option<f64>,
    parallactic_deg: Option<f64>,
    /// Null at the zenith itself, where it has no bound.
    field_rotation_deg_per_h: Option<f64>,
    v_mag: Option<f64>,
    surface_brightness_mag_arcsec2: Option<f64>,
    size_arcmin: Option<[f64; 2]>,
    r#type: Option<&'a str>,
    constellation: &'a str,
    names: &'a [String],
    distance_pc: Option<f64>,
    absolute_v_mag: Option<f64>,
    hand_controllers_place: bool,
}

fn show(arguments: &ShowArguments, profile_site: Option<Site>) -> Result<(), Failure> {
    let name = arguments.name.join(" ");
    if let Some((planet, moon)) = moons::named(&name) {
        return solar::show_moon(planet, moon, arguments, arguments.site.or(profile_site));
    }
    if let Some(body) = Body::from_name(&name) {
        return solar::show(body, arguments, arguments.site.or(profile_site));
    }
    let object = match (arguments.ra, arguments.dec) {
        (Some(ra), Some(dec)) => Err(position(ra, dec)?),
        _ => Ok(Catalogue::embedded().search(&arguments.name.join(" ")).map_err(Failure::failed)?),
    };
    let astrometry = match &object {
        Ok(object) => object.astrometry,
        Err(position) => Astrometry::fixed(*position),
    };
    let object = object.ok();
    let moment = moment(arguments)?;
    let reduction = Reduction::at(&moment);
    let apparent = reduction.apparent(&astrometry);
    let site = arguments.site.or(profile_site);
    let horizon = site.map(|site| Horizon::new(&reduction, &site));
    let airless = horizon.map(|horizon| horizon.airless(&apparent));
    let air = air(arguments)?;
    let words = object.as_ref().map(Object::type_words);
    let shown = Shown {
        ra_j2000_deg: astrometry.position.ra().to_degrees(),
        dec_j2000_deg: astrometry.position.dec().to_degrees(),
        ra_apparent_deg: apparent.ra().to_degrees(),
        dec_apparent_deg: apparent.dec().to_degrees(),
        alt_deg: airless.map(|seen| seen.altitude().to_degrees()),
        alt_refracted_deg: airless.map(|seen| horizon::refracted(&seen, &air).altitude().to_degrees()),
        az_deg: airless.map(|seen| seen.azimuth().to_degrees()),
        parallactic_deg: horizon.map(|horizon| horizon.parallactic_angle(&apparent).to_degrees()),
        field_rotation_deg_per_h: horizon
            .map(|horizon| horizon.field_rotation(&apparent).to_degrees() * 3600.0)
            .filter(|rate| rate.is_finite()),
        v_mag: object.as_ref().and_then(Object::v_magnitude).map(|magnitude| magnitude.0),
        surface_brightness_mag_arcsec2: object.as_ref().and_then(|object| object.surface_brightness).map(|mean| mean.0),
        size_arcmin: object.as_ref().and_then(|object| object.axes_arcmin).map(|(major, minor)| [major, minor]),
        r#type: words,
        constellation: object
            .as_ref()
            .map_or_else(|| constellation::at(&astrometry.position), |object| object.constellation),
        names: object.as_ref().map_or(&[], |object| &object.names),
        distance_pc: object.as_ref().and_then(|object| object.distance).map(|distance| distance.parsec),
        absolute_v_mag: object.as_ref().and_then(Object::absolute_magnitude),
        hand_controllers_place: object.as_ref().is_some_and(|object| object.hand_controllers_place),
    };
    if arguments.json {
        return answer_json(&shown);
    }
    answer(page(&shown, object.as_ref(), &moment).trim_end())
}

/// The answer for a person.
fn page(shown: &Shown<'_>, object: Option<&Object>, moment: &Moment) -> String {
    let mut page = String::new();
    let place = |ra: f64, dec: f64| {
        format!("{}  {}", HoursMinutesSeconds(Angle::degrees(ra)), DegreesMinutesSeconds(Angle::degrees(dec)))
    };
    let mut line = |what: &str, text: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(page, "{what:<20}{text}");
    };
    let sort = shown.r#type.map_or(String::new(), |words| format!(", {words}"));
    let con = constellation::full_name(shown.constellation);
    match object {
        Some(object) => line(&object.name, format!("{} in {con}", shown.r#type.unwrap_or("object"))),
        None => line("position", format!("in {con}{sort}")),
    }
    if shown.names.len() > 1 {
        line("also", shown.names[1..].join(", "));
    }
    line("J2000", place(shown.ra_j2000_deg, shown.dec_j2000_deg));
    if shown.hand_controllers_place {
        line("", String::from("the hand controller's own place, from your list of coordinates"));
    }
    let at = Equatorial::new(Angle::degrees(shown.ra_j2000_deg), Angle::degrees(shown.dec_j2000_deg));
    line("charts", format!("Uranometria 2000.0 {}, Millennium {}", atlas::uranometria(&at), atlas::millennium(&at)));
    line("of date", place(shown.ra_apparent_deg, shown.dec_apparent_deg));
    if let (Some(alt), Some(seen), Some(az)) = (shown.alt_deg, shown.alt_refracted_deg, shown.az_deg) {
        line("altitude, azimuth", format!("{alt:.3}° ({seen:.3}° with refraction), {az:.3}° from north through east"));
    } else {
        line("altitude, azimuth", String::from("unknown: give --site LAT,LON,ELEV"));
    }
    if let Some(parallactic) = shown.parallactic_deg {
        let turning = match shown.field_rotation_deg_per_h {
            Some(rate) if rate.abs() > 100.0 => {
                format!("; an alt-azimuth field turns {rate:+.0}° an hour so near the zenith")
            }
            Some(rate) => format!("; an alt-azimuth field turns {rate:+.1}° an hour"),
            None => "; an alt-azimuth field turns without bound at the zenith".into(),
        };
        line("parallactic angle", format!("{parallactic:.2}°{turning}"));
    }
    if let Some(object) = object {
        describe(object, &mut line);
    }
    line("at", format!("{} (delta T {:.1} s)", moment.utc.to_rfc3339(), moment.delta_t_s));
    page
}

/// Brightness, size and motion, as far as they are known.
fn describe(object: &Object, line: &mut impl FnMut(&str, String)) {
    if let Some(magnitude) = object.magnitude {
        let band = if object.band == Band::V { "V" } else { "B" };
        let colour = object.colour_bv.map_or(String::new(), |bv| format!(", B-V {bv:.2}"));
        line("magnitude", format!("{band} {:.2}{colour}", magnitude.0));
    }
    if let Some(mean) = object.surface_brightness {
        line("surface brightness", format!("{:.1} mag per square arcsecond on average", mean.0));
    }
    if let Some((major, minor)) = object.axes_arcmin {
        let angle =
            object.position_angle.map_or(String::new(), |pa| format!(", position angle {:.0}°", pa.to_degrees()));
        line("size", format!("{major} x {minor} arcminutes{angle}"));
    }
    if let Some(distance) = object.distance {
        let absolute =
            object.absolute_magnitude().map_or(String::new(), |mag| format!(", absolute magnitude V {mag:.1}"));
        let rough = if distance.rough { " (to a factor of 2)" } else { "" };
        line("distance", format!("{}{rough}{absolute}", distance.words()));
    }
    if let Some(hubble) = object.hubble {
        line("Hubble type", hubble.to_owned());
    }
    let motion = object.astrometry;
    if motion.pm_east_mas_yr != 0.0 || motion.pm_north_mas_yr != 0.0 {
        line(
            "proper motion",
            format!("{:+.1} mas a year east, {:+.1} north", motion.pm_east_mas_yr, motion.pm_north_mas_yr),
        );
    }
    if motion.parallax_mas > 0.0 {
        line("parallax", format!("{:.2} mas ({:.1} light years)", motion.parallax_mas, 3261.56 / motion.parallax_mas));
    }
}

/// One row of what `sky field --json` answers.
#[derive(Debug, Serialize)]
struct Inside {
    name: String,
    r#type: &'static str,
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    separation_arcmin: f64,
    v_mag: Option<f64>,
}

fn field(arguments: &FieldArguments) -> Result<(), Failure> {
    let centre = position(arguments.ra, arguments.dec)?;
    let radius = within("--radius-arcmin", arguments.radius_arcmin, 0.0, 10_800.0)?;
    if arguments.faintest.is_nan() {
        return Err(Failure::Asked(String::from("--faintest is not a number: give a magnitude such as 9.5")));
    }
    let catalogue = Catalogue::embedded();
    let found = catalogue.within(&centre, Angle::arcminutes(radius), Magnitude(arguments.faintest));
    let stars = found.stars.iter().map(|star| Inside {
        name: catalogue.star_label(star),
        r#type: "star",
        ra_j2000_deg: star.astrometry.position.ra().to_degrees(),
        dec_j2000_deg: star.astrometry.position.dec().to_degrees(),
        separation_arcmin: star.separation.to_arcminutes(),
        v_mag: Some((f64::from(star.v_mag) * 100.0).round() / 100.0),
    });
    let objects = found.objects.iter().map(|inside| Inside {
        name: inside.name.to_owned(),
        r#type: catalogue.object(inside.index).map_or(inside.kind.words(), |object| object.type_words()),
        ra_j2000_deg: inside.position.ra().to_degrees(),
        dec_j2000_deg: inside.position.dec().to_degrees(),
        separation_arcmin: inside.separation.to_arcminutes(),
        v_mag: inside.magnitude.filter(|_| inside.band == Band::V).map(|magnitude| magnitude.0),
    });
    let mut inside: Vec<Inside> = stars.chain(objects).collect();
    inside.sort_by(|a, b| a.separation_arcmin.total_cmp(&b.separation_arcmin));
    if arguments.json {
        return answer_json(&inside);
    }
    let mut page = String::new();
    for row in &inside {
        let magnitude = row.v_mag.map_or(String::from("    -"), |v| format!("{v:5.2}"));
        let _ = writeln!(page, "{:7.2}'  {magnitude}  {:<24}{}", row.separation_arcmin, row.name, row.r#type);
    }
    let _ = write!(page, "{} objects within {radius} arcminutes", inside.len());
    answer(&page)
}

/// A J2000 position from numbers that were typed.
fn position(ra_deg: f64, dec_deg: f64) -> Result<Equatorial<J2000>, Failure> {
    let ra = within("--ra", ra_deg, -360.0, 360.0)?;
    let dec = within("--dec", dec_deg, -90.0, 90.0)?;
    Ok(Equatorial::new(Angle::degrees(ra), Angle::degrees(dec)))
}

/// The number, if it is in its range.
fn within(what: &str, value: f64, low: f64, high: f64) -> Result<f64, Failure> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(Failure::Asked(format!("{what} {value} is out of range: give {low} to {high}")))
    }
}

/// The air at the site.
fn air(arguments: &ShowArguments) -> Result<Air, Failure> {
    Ok(Air {
        pressure_hpa: within("--pressure", arguments.pressure, 0.0, 1100.0)?,
        temperature_c: within("--temperature", arguments.temperature, -90.0, 60.0)?,
    })
}

fn moment(arguments: &ShowArguments) -> Result<Moment, Failure> {
    let utc = match arguments.at {
        Some(utc) => utc,
        None => {
            let since_1970 = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_err(|_early| {
                Failure::Failed(String::from("this computer's clock stands before 1970: set it, or give --at"))
            })?;
            Utc(since_1970.as_secs_f64())
        }
    };
    Ok(match arguments.delta_t {
        Some(seconds) => Moment { utc, delta_t_s: within("--delta-t", seconds, -100_000.0, 100_000.0)? },
        None => Moment::at(utc),
    })
}
