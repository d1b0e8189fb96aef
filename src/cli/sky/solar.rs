//! `scotopic sky show` for the Sun, the Moon and the planets.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Serialize;

use super::{ShowArguments, air, moment};
use crate::cli::{Failure, answer, answer_json};
use crate::sky::catalogue::constellation;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::ephemeris::{Body, Ephemeris, moons};
use crate::sky::horizon::{self, Horizon};
use crate::sky::physical::Aspect;
use crate::sky::site::Site;
use crate::units::Angle;
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};

/// What `sky show --json` answers for a body of the solar system. What does not apply, or needs a site, is null.
#[derive(Debug, Serialize)]
struct Shown {
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    ra_apparent_deg: f64,
    dec_apparent_deg: f64,
    ra_topocentric_deg: Option<f64>,
    dec_topocentric_deg: Option<f64>,
    alt_deg: Option<f64>,
    alt_refracted_deg: Option<f64>,
    az_deg: Option<f64>,
    parallactic_deg: Option<f64>,
    distance_au: f64,
    distance_topocentric_au: Option<f64>,
    angular_diameter_arcsec: f64,
    phase: Option<f64>,
    phase_angle_deg: Option<f64>,
    bright_limb_position_angle_deg: Option<f64>,
    v_mag: f64,
    ring_tilt_deg: Option<f64>,
    ring_tilt_sun_deg: Option<f64>,
    central_meridian_deg: BTreeMap<&'static str, f64>,
    pole_ra_deg: f64,
    pole_dec_deg: f64,
    pole_position_angle_deg: f64,
    libration_lon_deg: Option<f64>,
    libration_lat_deg: Option<f64>,
    libration_topocentric_lon_deg: Option<f64>,
    libration_topocentric_lat_deg: Option<f64>,
    colongitude_deg: Option<f64>,
    moons: Vec<MoonShown>,
    r#type: &'static str,
    constellation: &'static str,
    names: [&'static str; 1],
    at: String,
    delta_t_s: f64,
    site: Option<SiteUsed>,
    error_arcsec: f64,
}

/// A moon beside its planet, geocentric.
#[derive(Debug, Serialize)]
struct MoonShown {
    name: &'static str,
    dx_east_arcsec: f64,
    dy_north_arcsec: f64,
    in_front: bool,
    hidden: bool,
    eclipsed: bool,
    v_mag: f64,
    error_arcsec: f64,
}

/// What `sky show Io --json` answers: the moon's place, and where it stands beside its planet.
#[derive(Debug, Serialize)]
struct MoonAlone {
    planet: &'static str,
    ra_j2000_deg: f64,
    dec_j2000_deg: f64,
    ra_apparent_deg: f64,
    dec_apparent_deg: f64,
    ra_topocentric_deg: Option<f64>,
    dec_topocentric_deg: Option<f64>,
    alt_deg: Option<f64>,
    az_deg: Option<f64>,
    distance_au: f64,
    #[serde(flatten)]
    moon: MoonShown,
    r#type: &'static str,
    constellation: &'static str,
    at: String,
    delta_t_s: f64,
    site: Option<SiteUsed>,
}

/// Answers for a moon of a planet. Its parallax is taken as the planet's; its distance is.
///
/// # Errors
/// A date beyond the ephemeris, or a number out of its range.
pub(super) fn show_moon(
    planet: Body,
    name: &'static str,
    arguments: &ShowArguments,
    site: Option<Site>,
) -> Result<(), Failure> {
    let moment = moment(arguments)?;
    let ephemeris = Ephemeris::at(&moment).map_err(Failure::failed)?;
    let reduction = ephemeris.reduction();
    let place = ephemeris.place(planet);
    let found = moons::beside(&ephemeris, &place).into_iter().find(|moon| moon.name == name);
    let moon = found.ok_or_else(|| Failure::Failed(format!("{name} has no place at {}", moment.utc.to_rfc3339())))?;
    let topocentric = site.map(|site| moon.beside(&place.topocentric(reduction, &site).apparent));
    let apparent = moon.beside(&place.apparent);
    let j2000 = reduction.j2000(&apparent);
    let horizontal = site.zip(topocentric).map(|(site, seen)| Horizon::new(reduction, &site).airless(&seen));
    let shown = MoonAlone {
        planet: planet.name(),
        ra_j2000_deg: j2000.ra().to_degrees(),
        dec_j2000_deg: j2000.dec().to_degrees(),
        ra_apparent_deg: apparent.ra().to_degrees(),
        dec_apparent_deg: apparent.dec().to_degrees(),
        ra_topocentric_deg: topocentric.map(|seen| seen.ra().to_degrees()),
        dec_topocentric_deg: topocentric.map(|seen| seen.dec().to_degrees()),
        alt_deg: horizontal.map(|seen| seen.altitude().to_degrees()),
        az_deg: horizontal.map(|seen| seen.azimuth().to_degrees()),
        distance_au: place.distance_au,
        moon: told(&ephemeris, &moon),
        r#type: "moon",
        constellation: constellation::at(&j2000),
        at: moment.utc.to_rfc3339(),
        delta_t_s: moment.delta_t_s,
        site: site.map(used),
    };
    if arguments.json {
        return answer_json(&shown);
    }
    let how = match (moon.hidden, moon.eclipsed, moon.in_front) {
        (true, ..) => ", behind it",
        (_, true, _) => ", in its shadow",
        (.., true) => ", nearer than it",
        _ => ", farther than it",
    };
    let position = |place: &Equatorial<OfDate>| {
        format!("{}  {}", HoursMinutesSeconds(place.ra()), DegreesMinutesSeconds(place.dec()))
    };
    let mut page = format!(
        "{name:<20}moon of {} in {}\n{:<20}{} from the centre of the Earth\n",
        planet.name(),
        constellation::full_name(shown.constellation),
        "of date",
        position(&apparent)
    );
    if let (Some(seen), Some(horizontal)) = (topocentric, horizontal) {
        let (altitude, azimuth) = (horizontal.altitude().to_degrees(), horizontal.azimuth().to_degrees());
        let _ = writeln!(page, "{:<20}{} from the site", "", position(&seen));
        let _ = writeln!(page, "{:<20}{altitude:.3}°, {azimuth:.3}° from north through east", "altitude, azimuth");
    }
    let _ = write!(
        page,
        "{:<20}{:+.2}\" east {:+.2}\" north{how}; to {:.1}\"\n{:<20}V {:.1} at mean phase\n{:<20}{} (delta T {:.2} s)",
        format!("from {}", planet.name()),
        shown.moon.dx_east_arcsec,
        shown.moon.dy_north_arcsec,
        shown.moon.error_arcsec,
        "magnitude",
        shown.moon.v_mag,
        "at",
        shown.at,
        shown.delta_t_s
    );
    answer(&page)
}

fn told(ephemeris: &Ephemeris, moon: &moons::Moon) -> MoonShown {
    MoonShown {
        name: moon.name,
        dx_east_arcsec: moon.east.to_arcseconds(),
        dy_north_arcsec: moon.north.to_arcseconds(),
        in_front: moon.in_front,
        hidden: moon.hidden,
        eclipsed: moon.eclipsed,
        v_mag: moon.magnitude.0,
        error_arcsec: moons::error(ephemeris, moon.name).to_arcseconds(),
    }
}

fn used(site: Site) -> SiteUsed {
    SiteUsed {
        latitude_deg: site.latitude.to_degrees(),
        longitude_deg: site.longitude.to_degrees(),
        elevation_m: site.elevation_m,
    }
}

/// The site that the answer is for.
#[derive(Debug, Serialize)]
struct SiteUsed {
    latitude_deg: f64,
    longitude_deg: f64,
    elevation_m: f64,
}

/// Answers for a body.
///
/// # Errors
/// A date beyond the ephemeris, or a number out of its range.
pub(super) fn show(body: Body, arguments: &ShowArguments, site: Option<Site>) -> Result<(), Failure> {
    let air = air(arguments)?;
    let moment = moment(arguments)?;
    let ephemeris = Ephemeris::at(&moment).map_err(Failure::failed)?;
    let reduction = ephemeris.reduction();
    let place = ephemeris.place(body);
    let topocentric = site.map(|site| place.topocentric(reduction, &site));
    let horizon = site.map(|site| Horizon::new(reduction, &site));
    let airless = horizon.zip(topocentric).map(|(horizon, seen)| horizon.airless(&seen.apparent));
    let j2000 = reduction.j2000(&place.apparent);
    let diameter = place.angular_diameter(topocentric.map_or(place.distance_au, |seen| seen.distance_au));
    let aspect = Aspect::geocentric(&ephemeris, &place);
    let lit = (body != Body::Sun).then_some(&aspect);
    let from_site = site.and_then(|site| Aspect::topocentric(&ephemeris, &place, &site).libration());
    let shown = Shown {
        ra_j2000_deg: j2000.ra().to_degrees(),
        dec_j2000_deg: j2000.dec().to_degrees(),
        ra_apparent_deg: place.apparent.ra().to_degrees(),
        dec_apparent_deg: place.apparent.dec().to_degrees(),
        ra_topocentric_deg: topocentric.map(|seen| seen.apparent.ra().to_degrees()),
        dec_topocentric_deg: topocentric.map(|seen| seen.apparent.dec().to_degrees()),
        alt_deg: airless.map(|seen| seen.altitude().to_degrees()),
        alt_refracted_deg: airless.map(|seen| horizon::refracted(&seen, &air).altitude().to_degrees()),
        az_deg: airless.map(|seen| seen.azimuth().to_degrees()),
        parallactic_deg: horizon
            .zip(topocentric)
            .map(|(horizon, seen)| horizon.parallactic_angle(&seen.apparent).to_degrees()),
        distance_au: place.distance_au,
        distance_topocentric_au: topocentric.map(|seen| seen.distance_au),
        angular_diameter_arcsec: diameter.to_arcseconds(),
        phase: lit.map(Aspect::phase),
        phase_angle_deg: lit.map(|aspect| aspect.phase_angle.to_degrees()),
        bright_limb_position_angle_deg: lit.map(|aspect| aspect.bright_limb_position_angle.to_degrees()),
        v_mag: aspect.magnitude.0,
        ring_tilt_deg: aspect.ring_tilt().map(Angle::to_degrees),
        ring_tilt_sun_deg: aspect.ring_tilt().map(|_open| aspect.sub_sun.1.to_degrees()),
        central_meridian_deg: aspect
            .central_meridians
            .iter()
            .map(|(system, longitude)| (*system, longitude.to_degrees()))
            .collect(),
        pole_ra_deg: aspect.pole.ra().to_degrees(),
        pole_dec_deg: aspect.pole.dec().to_degrees(),
        pole_position_angle_deg: aspect.pole_position_angle.to_degrees(),
        libration_lon_deg: aspect.libration().map(|(lon, _)| lon.to_degrees()),
        libration_lat_deg: aspect.libration().map(|(_, lat)| lat.to_degrees()),
        libration_topocentric_lon_deg: from_site.map(|(lon, _)| lon.to_degrees()),
        libration_topocentric_lat_deg: from_site.map(|(_, lat)| lat.to_degrees()),
        colongitude_deg: aspect.colongitude().map(Angle::to_degrees),
        moons: moons::beside(&ephemeris, &place).iter().map(|moon| told(&ephemeris, moon)).collect(),
        r#type: body.type_words(),
        constellation: constellation::at(&j2000),
        names: [body.name()],
        at: moment.utc.to_rfc3339(),
        delta_t_s: moment.delta_t_s,
        site: site.map(used),
        error_arcsec: ephemeris.error().to_arcseconds(),
    };
    if arguments.json {
        return answer_json(&shown);
    }
    answer(page(body, &shown).trim_end())
}

/// The answer for a person.
fn page(body: Body, shown: &Shown) -> String {
    let mut page = String::new();
    let place = |ra: f64, dec: f64| {
        format!("{}  {}", HoursMinutesSeconds(Angle::degrees(ra)), DegreesMinutesSeconds(Angle::degrees(dec)))
    };
    let mut line = |what: &str, text: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(page, "{what:<20}{text}");
    };
    line(body.name(), format!("{} in {}", shown.r#type, constellation::full_name(shown.constellation)));
    line("J2000", place(shown.ra_j2000_deg, shown.dec_j2000_deg));
    line("of date", format!("{} from the centre of the Earth", place(shown.ra_apparent_deg, shown.dec_apparent_deg)));
    if let (Some(ra), Some(dec)) = (shown.ra_topocentric_deg, shown.dec_topocentric_deg) {
        line("", format!("{} from the site", place(ra, dec)));
    }
    if let (Some(alt), Some(seen), Some(az)) = (shown.alt_deg, shown.alt_refracted_deg, shown.az_deg) {
        line("altitude, azimuth", format!("{alt:.3}° ({seen:.3}° with refraction), {az:.3}° from north through east"));
    } else {
        line("altitude, azimuth", String::from("unknown: give --site LAT,LON,ELEV"));
    }
    if let Some(parallactic) = shown.parallactic_deg {
        line("parallactic angle", format!("{parallactic:.2}°"));
    }
    line("distance", format!("{:.7} au", shown.distance_au));
    line("diameter", format!("{:.2}\"", shown.angular_diameter_arcsec));
    line("magnitude", format!("V {:.2}", shown.v_mag));
    if let (Some(phase), Some(angle)) = (shown.phase, shown.phase_angle_deg) {
        line("phase", format!("{:.1} % lit, phase angle {angle:.2}°", phase * 100.0));
    }
    if let Some(tilt) = shown.ring_tilt_deg {
        let face = if tilt >= 0.0 { "north" } else { "south" };
        line("rings", format!("open by {:.2}°, their {face} face seen", tilt.abs()));
    }
    if let (Some(lon), Some(lat)) = (shown.libration_lon_deg, shown.libration_lat_deg) {
        line("libration", format!("{lon:+.2}° in longitude, {lat:+.2}° in latitude (geocentric)"));
    }
    if let Some(colongitude) = shown.colongitude_deg {
        line("colongitude", format!("{colongitude:.1}° (the Sun rises there)"));
    }
    if body != Body::Moon {
        let meridians: Vec<String> =
            shown.central_meridian_deg.iter().map(|(system, deg)| format!("{deg:.1}° ({system})")).collect();
        line("central meridian", meridians.join(", "));
    }
    line(
        "north pole",
        format!(
            "position angle {:.1}°; axis to {:.3}°, {:+.3}° (J2000)",
            shown.pole_position_angle_deg, shown.pole_ra_deg, shown.pole_dec_deg
        ),
    );
    for moon in &shown.moons {
        let how = match (moon.hidden, moon.eclipsed, moon.in_front) {
            (true, true, _) => ", hidden and eclipsed",
            (true, ..) => ", hidden",
            (_, true, _) => ", eclipsed",
            (.., true) => ", in front",
            _ => "",
        };
        let offset = format!("{:+8.2}\" east {:+8.2}\" north", moon.dx_east_arcsec, moon.dy_north_arcsec);
        line(moon.name, format!("{offset}  V {:.1}{how}", moon.v_mag));
    }
    line("at", format!("{} (delta T {:.2} s)", shown.at, shown.delta_t_s));
    if let Some(site) = &shown.site {
        line("site", format!("{:.4}°, {:.4}°, {:.0} m", site.latitude_deg, site.longitude_deg, site.elevation_m));
    }
    line("error", format!("up to {:.1}\" if delta T is right", shown.error_arcsec));
    page
}
