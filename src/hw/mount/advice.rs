//! Where the mount and we disagree, in words, with what to do.

use std::fmt;

/// A disagreement between the mount and us, or a state of the mount that spoils pointing.
#[derive(Debug, Clone, PartialEq)]
pub enum Disagreement {
    /// The mount's clock is off by this many seconds (positive: the mount is ahead).
    Clock {
        /// Mount minus ours.
        seconds: f64,
    },
    /// The mount's clock is off by whole hours: daylight saving, or a wrong zone.
    Zone {
        /// Mount minus ours.
        hours: f64,
    },
    /// The mount's zone has the wrong sign: its clock is off by twice the zone.
    ZoneSign {
        /// The mount's zone, hours east.
        hours: f64,
    },
    /// The mount's date is 1024 weeks in the past: its GPS week number rolled over.
    GpsRollover {
        /// The mount's year.
        year: i32,
    },
    /// The mount's date is off by whole days.
    Date {
        /// Mount minus ours.
        days: f64,
    },
    /// The mount's sidereal time does not follow from its own clock and site (or from ours).
    Sidereal {
        /// Mount minus computed.
        seconds: f64,
    },
    /// The mount's longitude has the other sign.
    LongitudeSign {
        /// The mount's, degrees east.
        mount_deg: f64,
        /// Ours, degrees east.
        ours_deg: f64,
    },
    /// The mount's site is elsewhere.
    Site {
        /// Great-circle distance.
        kilometres: f64,
    },
    /// The mount is not aligned.
    NotAligned {
        /// Stars it was aligned on.
        stars: u8,
    },
    /// The mount does not track.
    NotTracking,
    /// The mount sleeps.
    Asleep,
    /// The mount was parked.
    Parked,
    /// The mount insists on the short coordinate format.
    ShortFormat,
    /// Not an LX200GPS.
    Clone {
        /// What it says it is.
        product: String,
    },
    /// The mount is set up as a German equatorial: it may flip at the meridian.
    German,
}

impl Disagreement {
    /// What the observer should do.
    #[must_use]
    pub fn what_to_do(&self) -> &'static str {
        match self {
            Disagreement::Clock { .. } => "Set the mount's clock from here, or check this computer's clock.",
            Disagreement::Zone { .. } => {
                "Check daylight saving and time zone on the hand controller (Setup, Time Zone), or set the clock from here."
            }
            Disagreement::ZoneSign { .. } => {
                "The mount counts the hours that must be added to local time: east of Greenwich is negative. Set the clock from here."
            }
            Disagreement::GpsRollover { .. } => {
                "Set the date by hand or from here each night, or update the firmware (4.2k or later, or StarPatch)."
            }
            Disagreement::Date { .. } => "Set the mount's date (month first), or set the clock from here.",
            Disagreement::Sidereal { .. } => {
                "Its clock, date, zone or longitude is wrong: check all four on the hand controller, or set clock and site from here."
            }
            Disagreement::LongitudeSign { .. } => "Check east and west of the site, here and on the hand controller.",
            Disagreement::Site { .. } => {
                "Check the site here (--site) and on the hand controller; set it from here if ours is right."
            }
            Disagreement::NotAligned { .. } => {
                "Align on two stars at least 90 degrees apart before trusting the position."
            }
            Disagreement::NotTracking => {
                "Choose alt-az or polar (not land) as the telescope's mount, so that it follows the sky."
            }
            Disagreement::Asleep => "Press any key of the hand controller to wake it.",
            Disagreement::Parked => {
                "Switch the mount off and on again; it takes its place up from where it was parked."
            }
            Disagreement::ShortFormat => {
                "Positions are good to 1.5 arcminutes only: choose the long format on the hand controller."
            }
            Disagreement::Clone { .. } => "Reading works; try a go-to with a hand on the switch.",
            Disagreement::German => "Watch the tube when a go-to crosses the meridian.",
        }
    }
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Disagreement::Clock { seconds } => {
                write!(f, "the mount's clock is {} {} ours", spell_seconds(*seconds), ahead(*seconds))
            }
            Disagreement::Zone { hours } => {
                write!(f, "the mount's clock is {:.1} h {} ours: zone or daylight saving", hours.abs(), ahead(*hours))
            }
            Disagreement::ZoneSign { hours } => {
                write!(f, "the mount's time zone ({hours:+.1} h) seems to have the wrong sign")
            }
            Disagreement::GpsRollover { year } => {
                write!(f, "the mount's date ({year}) is 1024 weeks in the past: its GPS clock has rolled over")
            }
            Disagreement::Date { days } => {
                write!(f, "the mount's date is {:.0} days {} ours", days.abs(), ahead(*days))
            }
            Disagreement::Sidereal { seconds } => {
                write!(
                    f,
                    "the mount's sidereal time is {} {} what its site and time give",
                    spell_seconds(*seconds),
                    ahead(*seconds)
                )
            }
            Disagreement::LongitudeSign { mount_deg, ours_deg } => {
                write!(
                    f,
                    "the mount's longitude is {mount_deg:+.2}° east and ours {ours_deg:+.2}°: one has the wrong sign"
                )
            }
            Disagreement::Site { kilometres } => write!(f, "the mount's site is {kilometres:.0} km from ours"),
            Disagreement::NotAligned { stars } => {
                write!(f, "the mount is aligned on {stars} stars, which is not enough")
            }
            Disagreement::NotTracking => f.write_str("the mount does not follow the sky"),
            Disagreement::Asleep => f.write_str("the mount sleeps"),
            Disagreement::Parked => f.write_str("the mount was parked"),
            Disagreement::ShortFormat => f.write_str("the mount gives positions in the short format"),
            Disagreement::Clone { product } => write!(f, "this is '{product}', not an LX200GPS (LX2001)"),
            Disagreement::German => f.write_str("the mount is set up as a German equatorial"),
        }?;
        write!(f, ". {}", self.what_to_do())
    }
}

fn ahead(difference: f64) -> &'static str {
    if difference < 0.0 { "behind" } else { "ahead of" }
}

fn spell_seconds(seconds: f64) -> String {
    let s = seconds.abs();
    if s < 120.0 { format!("{s:.0} s") } else { format!("{:.0} min {:.0} s", (s / 60.0).floor(), s % 60.0) }
}
