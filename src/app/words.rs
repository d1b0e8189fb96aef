//! What is believed of the mount, in words: each value with how it is known and how old it is.

use std::time::Duration;

use super::log::printable;
use super::model::Model;
use crate::hw::mount::belief::{Aligned, Known, LinkState, Mounting, Precision, Source, Tracking};
use crate::sky::alignment::Proposed;
use crate::sky::alignment::guide::{self, Guide};
use crate::sky::pointing::Motion;
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};

/// How a value is known, and its age: `confirmed 0.3 s ago`.
#[must_use]
pub fn how<T>(known: &Known<T>, now: Duration) -> String {
    let age = known.age(now).map(spell).unwrap_or_default();
    match known {
        Known::Unknown => "unknown".to_owned(),
        Known::Assumed { .. } => format!("assumed {age} ago"),
        Known::Confirmed { .. } => format!("confirmed {age} ago"),
    }
}

/// A time span as a person says it.
#[must_use]
pub fn spell(span: Duration) -> String {
    match span.as_secs_f64() {
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}

/// The line to the mount, in a few words, and whether all is well with it.
#[must_use]
pub fn link(model: &Model) -> (String, bool) {
    let product = model.belief.product.value().map(|product| printable(product));
    match model.belief.link {
        LinkState::Closed => ("no link: the port is being opened".to_owned(), false),
        LinkState::Connecting => ("connecting".to_owned(), false),
        LinkState::Ready => {
            let firmware = model.belief.firmware.value().map(|number| format!(" {}", printable(number)));
            (format!("linked to {}{}", product.unwrap_or_default(), firmware.unwrap_or_default()), true)
        }
        LinkState::Mending => ("the mount has stopped answering: asking again".to_owned(), false),
        LinkState::Silent => ("the mount is silent: is it on, and the cable in?".to_owned(), false),
        LinkState::Looped => ("the cable is looped: what is sent comes back".to_owned(), false),
    }
}

/// What the mount is doing.
#[must_use]
pub fn motion(model: &Model) -> &'static str {
    if model.belief.stopping {
        return "STOPPING";
    }
    match (model.belief.motion.value(), model.belief.slewing_by_order()) {
        (_, true) => "SLEWING",
        (Some(Motion::Slewing), false) => "MOVING",
        (Some(Motion::Tracking), false) => "tracking",
        (Some(Motion::Stopped), false) => "standing still",
        (None, false) => "doing what is not known",
    }
}

/// A value that is believed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// What it is.
    pub label: &'static str,
    /// Its value.
    pub value: String,
    /// How it is known, and its age.
    pub how: String,
}

/// Every value that is believed of the mount.
#[must_use]
pub fn rows(model: &Model) -> Vec<Row> {
    let (belief, now) = (&model.belief, model.time.now);
    fn row<T>(now: Duration, label: &'static str, known: &Known<T>, words: impl Fn(&T) -> String) -> Row {
        Row { label, value: known.value().map_or_else(|| "?".to_owned(), words), how: how(known, now) }
    }
    vec![
        row(now, "product", &belief.product, |product| printable(product)),
        row(now, "firmware", &belief.firmware, |number| printable(number)),
        row(now, "format", &belief.precision, |precision| match precision {
            Precision::Long => "long".to_owned(),
            Precision::Short => "short: good to 1.5 arcminutes only".to_owned(),
        }),
        row(now, "stands", &belief.alignment, |alignment| {
            let stands = match alignment.mounting {
                Mounting::AltAz => "alt-azimuth",
                Mounting::Polar => "on a wedge",
                Mounting::German => "German equatorial",
                Mounting::Land => "land mode",
            };
            let tracks = match alignment.tracking {
                Tracking::On => "tracking",
                Tracking::Off => "not tracking",
                Tracking::Asleep => "asleep",
            };
            let aligned = match alignment.aligned {
                Aligned::Stars(stars) => format!("aligned on {stars} stars"),
                Aligned::Home => "aligned on its home position".to_owned(),
                Aligned::Parked => "was parked".to_owned(),
                Aligned::Untold => "does not tell whether it is aligned".to_owned(),
            };
            format!("{stands}, {tracks}, {aligned}")
        }),
        row(now, "position", &belief.position, |position| {
            format!("{} {}", HoursMinutesSeconds(position.ra()), DegreesMinutesSeconds(position.dec()))
        }),
        row(now, "site", &belief.site, |site| {
            format!("{:+.3}° {:+.3}° east", site.latitude.to_degrees(), site.longitude.to_degrees())
        }),
        row(now, "clock", &belief.clock, |clock| {
            format!("{} (zone {:+.1} h)", clock.utc.to_rfc3339(), clock.offset_hours + 0.0)
        }),
        row(now, "sidereal", &belief.sidereal, |time| HoursMinutesSeconds(*time).to_string()),
    ]
}

/// Whose clock and site are used.
#[must_use]
pub fn sources(model: &Model) -> String {
    let whose = |source| match source {
        Source::Nobody => "nobody's",
        Source::Mount => "the mount's",
        Source::Ours => "ours",
    };
    match &model.belief.decision {
        None => "clock and site are not yet compared with the mount's".to_owned(),
        Some(decision) => format!("used: clock {}, site {}", whose(decision.clock), whose(decision.site_from)),
    }
}

/// What the observer may want explained about aligning, in the order in which it is needed.
#[must_use]
pub fn guides() -> [Guide; 3] {
    [guide::two_star_alignment(), guide::high_precision(), guide::periodic_error()]
}

/// The pairs of stars to align on tonight, a line each.
#[must_use]
pub fn pairs(model: &Model) -> Vec<String> {
    let star = |star: &Proposed| {
        let (altitude, azimuth) = (star.seen.altitude().to_degrees(), star.seen.azimuth().to_degrees());
        format!("{} ({:.1} mag, alt {altitude:.0}°, az {azimuth:.0}°)", printable(&star.name), star.v_mag)
    };
    let pairs = model.pairs.iter();
    pairs
        .map(|p| format!("{} and {}: {:.0}° apart", star(&p.first), star(&p.second), p.separation.to_degrees()))
        .collect()
}
