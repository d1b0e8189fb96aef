//! What the simulator is to be: site, time, seed, errors, faults.

use std::time::Duration;

use super::fault::Faults;
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

/// Everything that makes one simulated mount. The default is a well mannered one with the errors of an ordinary 10-inch.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Seed of every random thing: reply times, faults, the phases of the worms.
    pub seed: u64,
    /// Where it stands, and what its first site memory says.
    pub site: Site,
    /// UTC at `now` = 0, which is also what its clock says.
    pub start: Utc,
    /// Hours to add to the mount's local time for UTC, daylight saving left out: -1 for Central Europe.
    pub zone_h: f64,
    /// Whether the mount's local time is daylight saving time.
    pub daylight_saving: bool,
    /// Periodic error of each worm, peak to peak: 25 arcseconds for a 10-inch before training, 5 after.
    pub periodic_error: Angle,
    /// Size of the pointing error on the sky: 2 arcminutes for a well aligned mount.
    pub pointing_error: Angle,
    /// Drift of the true axis in azimuth while the mount believes it tracks, arcseconds a second.
    pub drift_arcsec_per_s: f64,
    /// Acceleration of each axis, degrees per second squared.
    pub acceleration_deg_s2: f64,
    /// Shortest and longest time between the `#` of a command and the start of its reply.
    pub reply_delay: (Duration, Duration),
    /// Whether a USB adapter hands on what it has received every 16 ms only.
    pub usb_batching: bool,
    /// What goes wrong.
    pub faults: Faults,
}

impl Settings {
    /// The default mount at this site, its clock started here, in the zone of the site's longitude.
    #[must_use]
    pub fn at(site: Site, start: Utc) -> Settings {
        let zone_h = -(site.longitude.to_degrees() / 15.0).round();
        Settings { site, start, zone_h, ..Settings::default() }
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            seed: 1,
            site: Site { latitude: Angle::degrees(49.26), longitude: Angle::degrees(7.04), elevation_m: 230.0 },
            start: Utc(1_795_730_400.0),
            zone_h: -1.0,
            daylight_saving: false,
            periodic_error: Angle::arcseconds(25.0),
            pointing_error: Angle::arcminutes(2.0),
            drift_arcsec_per_s: 0.0,
            acceleration_deg_s2: 4.0,
            reply_delay: (Duration::from_millis(2), Duration::from_millis(20)),
            usb_batching: false,
            faults: Faults::default(),
        }
    }
}
