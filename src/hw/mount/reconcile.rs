//! The mount's clock and site against ours: whose is used, and what is wrong with the other's.
//!
//! Section 8.7 of the thesis: date, time and site are the mount's own, "to assure full consistency"; ours are used where the
//! mount's are unknown or disagree.

use super::advice::Disagreement;
use super::belief::{Clock, Decision, Source};
use crate::sky::site::Site;
use crate::sky::time::{Moment, Utc};
use crate::units::Angle;

/// What the mount said, all at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Theirs {
    /// Its clock.
    pub clock: Option<Clock>,
    /// Its site.
    pub site: Option<Site>,
    /// Its sidereal time.
    pub sidereal: Option<Angle>,
}

/// Clocks further apart than this disagree: 15 arcminutes of sky.
pub const CLOCK_TOLERANCE_S: f64 = 60.0;
/// Sidereal times further apart than this disagree: 75 arcseconds of sky.
pub const SIDEREAL_TOLERANCE_S: f64 = 5.0;
/// Sites further apart than this disagree. The mount keeps minutes of arc (1.9 km), and a town's site is good enough.
pub const SITE_TOLERANCE_KM: f64 = 10.0;

const HOUR: f64 = 3600.0;
const DAY: f64 = 86_400.0;
/// 1024 weeks: the GPS week number has ten bits.
const ROLLOVER: f64 = 1024.0 * 7.0 * DAY;

/// Compares what the mount said with our clock (UTC at that instant) and site.
#[must_use]
pub fn reconcile(theirs: &Theirs, utc: Utc, site: Option<Site>) -> Decision {
    let mut disagreements = Vec::new();
    disagreements.extend(theirs.clock.and_then(|clock| clock_disagreement(&clock, utc)));
    disagreements.extend(theirs.site.zip(site).and_then(|(mount, ours)| site_disagreement(&mount, &ours)));
    let (clock_agrees, site_agrees) = (
        !disagreements.iter().any(of_the_clock),
        !disagreements.iter().any(|d| matches!(d, Disagreement::Site { .. } | Disagreement::LongitudeSign { .. })),
    );

    // Sidereal time follows from clock and longitude: with both agreeing (or not to be compared) it finds what they hide.
    let longitude = theirs.site.or(site).map(|site| site.longitude);
    let sidereal = theirs.sidereal.zip(longitude).map(|(sidereal, longitude)| {
        let by_clock = theirs.clock.filter(|_| clock_agrees).map_or(utc, |clock| clock.utc);
        sidereal_seconds(sidereal, by_clock, longitude)
    });
    let sidereal_agrees = sidereal.is_none_or(|seconds| seconds.abs() <= SIDEREAL_TOLERANCE_S);
    if let Some(seconds) = sidereal.filter(|_| !sidereal_agrees) {
        // A longitude with the wrong sign may be all that is wrong.
        let mirrored = theirs.sidereal.zip(longitude).is_some_and(|(sidereal, longitude)| {
            sidereal_seconds(sidereal, utc, -longitude).abs() <= CLOCK_TOLERANCE_S && longitude.to_degrees().abs() > 0.5
        });
        disagreements.push(match (longitude, mirrored) {
            (Some(ours), true) => {
                Disagreement::LongitudeSign { mount_deg: -ours.to_degrees(), ours_deg: ours.to_degrees() }
            }
            _ => Disagreement::Sidereal { seconds },
        });
    }

    let clock = match theirs.clock {
        Some(_) if clock_agrees && sidereal_agrees => Source::Mount,
        _ => Source::Ours,
    };
    let (site_from, site) = match (theirs.site, site) {
        (Some(mount), ours) if site_agrees && (sidereal_agrees || ours.is_none()) => {
            (Source::Mount, Some(Site { elevation_m: ours.map_or(0.0, |s| s.elevation_m), ..mount }))
        }
        (_, Some(ours)) => (Source::Ours, Some(ours)),
        (_, None) => (Source::Nobody, None),
    };
    let clock_ahead_s = match (clock, theirs.clock) {
        (Source::Mount, Some(theirs)) => theirs.utc.0 - utc.0,
        _ => 0.0,
    };
    Decision { clock, clock_ahead_s, site_from, site, disagreements }
}

fn of_the_clock(disagreement: &Disagreement) -> bool {
    use Disagreement::{Clock, Date, GpsRollover, Zone, ZoneSign};
    matches!(disagreement, Clock { .. } | Zone { .. } | ZoneSign { .. } | GpsRollover { .. } | Date { .. })
}

/// The mount's clock from its local date and time, its zone and its daylight saving flag.
///
/// The papers say that the zone includes daylight saving; a captured LX200GPS in Dutch summer time (20:01:31, zone -01)
/// gave a sidereal time that follows only with another hour. So the flag counts where sidereal time says so.
#[must_use]
pub fn clock(local: Utc, hours_to_utc: f64, summer: bool, sidereal: Option<Angle>, longitude: Option<Angle>) -> Clock {
    let reading = |hours: f64| Clock { utc: local.plus_seconds(hours * HOUR), offset_hours: -hours };
    let (plain, shifted) = (reading(hours_to_utc), reading(hours_to_utc - 1.0));
    let off = |clock: &Clock| {
        sidereal.zip(longitude).map(|(sidereal, longitude)| sidereal_seconds(sidereal, clock.utc, longitude).abs())
    };
    match (off(&plain), off(&shifted)) {
        (Some(plain_s), Some(shifted_s)) if summer && shifted_s < plain_s => shifted,
        _ => plain,
    }
}

/// The one cause that explains the difference of the clocks.
fn clock_disagreement(theirs: &Clock, utc: Utc) -> Option<Disagreement> {
    let seconds = theirs.utc.0 - utc.0;
    let near = |expected: f64, within: f64| (seconds - expected).abs() <= within;
    if near(0.0, CLOCK_TOLERANCE_S) {
        return None;
    }
    if near(-ROLLOVER, 2.0 * DAY) {
        let year = 1970.0 + theirs.utc.0 / (365.2425 * DAY);
        return Some(Disagreement::GpsRollover { year: year as i32 });
    }
    // With the sign of the zone wrong, UTC is reckoned local - offset' where offset' = -offset: off by twice the zone.
    let zone = theirs.offset_hours;
    if zone.abs() >= 0.5 && near(-2.0 * zone * HOUR, CLOCK_TOLERANCE_S) {
        return Some(Disagreement::ZoneSign { hours: zone });
    }
    let hours = (seconds / HOUR * 2.0).round() / 2.0;
    if hours.abs() <= 14.0 && hours != 0.0 && near(hours * HOUR, CLOCK_TOLERANCE_S) {
        return Some(Disagreement::Zone { hours });
    }
    let days = (seconds / DAY).round();
    if days != 0.0 && near(days * DAY, CLOCK_TOLERANCE_S) {
        return Some(Disagreement::Date { days });
    }
    Some(Disagreement::Clock { seconds })
}

fn site_disagreement(mount: &Site, ours: &Site) -> Option<Disagreement> {
    let kilometres = distance_km(mount, ours);
    let mirrored = Site { longitude: -mount.longitude, ..*mount };
    (kilometres > SITE_TOLERANCE_KM).then(|| {
        if distance_km(&mirrored, ours) <= SITE_TOLERANCE_KM {
            Disagreement::LongitudeSign {
                mount_deg: mount.longitude.to_degrees(),
                ours_deg: ours.longitude.to_degrees(),
            }
        } else {
            Disagreement::Site { kilometres }
        }
    })
}

/// Great-circle distance on a sphere of 6371 km: good to 0.5 %.
fn distance_km(a: &Site, b: &Site) -> f64 {
    let direction = |site: &Site| {
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (site.latitude.sin_cos(), site.longitude.sin_cos());
        glam::DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    };
    crate::sky::coords::separation(direction(a), direction(b)).to_radians() * 6371.0
}

/// Seconds of sidereal time by which the mount is ahead of `utc` at `longitude`.
fn sidereal_seconds(mount: Angle, utc: Utc, longitude: Angle) -> f64 {
    let computed = Moment { utc, delta_t_s: 70.0 }.sidereal_time(longitude);
    (mount - computed).wrapped_signed().to_hours() * HOUR
}

#[cfg(test)]
mod tests {
    use super::*;

    const UTC: &str = "2023-09-07T19:01:31Z";

    fn utc() -> Utc {
        Utc::from_rfc3339(UTC).unwrap()
    }

    /// The site and times of the capture of 2023: 5.385 degrees east, 21:01:31 in summer time.
    fn captured() -> Theirs {
        let site = Site::new(52.0 + 10.0 / 60.0 + 44.0 / 3600.0, 5.385, 0.0).unwrap();
        Theirs {
            clock: Some(Clock { utc: utc(), offset_hours: 2.0 }),
            site: Some(site),
            sidereal: Some(Moment { utc: utc(), delta_t_s: 69.2 }.sidereal_time(site.longitude)),
        }
    }

    fn shifted(seconds: f64) -> Theirs {
        let mut theirs = captured();
        if let Some(clock) = &mut theirs.clock {
            clock.utc = clock.utc.plus_seconds(seconds);
        }
        theirs.sidereal = None;
        theirs
    }

    #[test]
    fn the_mounts_own_are_used_when_nothing_disagrees() {
        let decision = reconcile(&captured(), utc().plus_seconds(-3.0), captured().site);
        assert_eq!(decision.disagreements, []);
        assert_eq!((decision.clock, decision.site_from), (Source::Mount, Source::Mount));
        assert!((decision.clock_ahead_s - 3.0).abs() < 1e-6);
    }

    #[test]
    fn the_captured_sidereal_time_follows_when_summer_time_is_counted() {
        // Bytes of the capture: 09/07/23, 20:01:31, zone -01, longitude 354 36:54, sidereal 17:29:15.
        let local = Utc::from_rfc3339("2023-09-07T20:01:31Z").unwrap();
        let (sidereal, longitude) = (Angle::hours(17.0 + 29.0 / 60.0 + 15.0 / 3600.0), Angle::degrees(5.385));
        let read = |summer| clock(local, -1.0, summer, Some(sidereal), Some(longitude));
        assert_eq!(read(true).offset_hours, 2.0);
        assert!(sidereal_seconds(sidereal, read(true).utc, longitude).abs() < 60.0);
        assert_eq!(read(false).offset_hours, 1.0);
        assert_eq!(clock(local, -1.0, true, None, None).offset_hours, 1.0);
    }

    #[test]
    fn each_wrong_clock_is_called_by_its_name_and_ours_is_used() {
        let named = |seconds: f64| {
            let decision = reconcile(&shifted(seconds), utc(), captured().site);
            assert_eq!(decision.clock, Source::Ours);
            assert_eq!(decision.clock_ahead_s, 0.0);
            decision.disagreements[0].clone()
        };
        assert!(matches!(named(300.0), Disagreement::Clock { .. }));
        assert!(matches!(named(3600.0), Disagreement::Zone { hours } if hours == 1.0));
        assert!(matches!(named(-2.0 * 2.0 * 3600.0), Disagreement::ZoneSign { .. }));
        assert!(matches!(named(86_400.0), Disagreement::Date { days } if days == 1.0));
        assert!(matches!(named(-1024.0 * 7.0 * 86_400.0), Disagreement::GpsRollover { year: 2004 }));
    }

    #[test]
    fn a_sidereal_time_that_does_not_follow_is_found_though_the_clock_agrees() {
        let mut theirs = captured();
        theirs.sidereal = theirs.sidereal.map(|s| s + Angle::hours(236.0 / 3600.0)); // one day
        let decision = reconcile(&theirs, utc(), theirs.site);
        assert!(
            matches!(decision.disagreements[..], [Disagreement::Sidereal { seconds }] if (seconds - 236.0).abs() < 1.0)
        );
        assert_eq!(decision.clock, Source::Ours);
    }

    #[test]
    fn a_mirrored_longitude_is_called_so() {
        let ours = captured().site.map(|site| Site { longitude: -site.longitude, ..site });
        let decision = reconcile(&captured(), utc(), ours);
        assert!(matches!(decision.disagreements[0], Disagreement::LongitudeSign { .. }));
        assert_eq!(decision.site_from, Source::Ours);
        assert_eq!(decision.site, ours);
    }

    #[test]
    fn a_mount_that_says_nothing_leaves_ours_and_two_that_say_nothing_leave_nothing() {
        let ours = captured().site;
        let decision = reconcile(&Theirs::default(), utc(), ours);
        assert_eq!((decision.clock, decision.site_from, decision.site), (Source::Ours, Source::Ours, ours));
        assert_eq!(reconcile(&Theirs::default(), utc(), None).site_from, Source::Nobody);
    }

    #[test]
    fn our_elevation_is_kept_with_the_mounts_site() {
        let ours = captured().site.map(|site| Site { elevation_m: 30.0, ..site });
        assert_eq!(reconcile(&captured(), utc(), ours).site.map(|s| s.elevation_m), Some(30.0));
    }
}
