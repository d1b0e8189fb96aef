//! What we believe of the mount, and how sure we are: each value is unknown, assumed or confirmed, with its age.

use std::time::Duration;

use super::advice::Disagreement;
use super::estimate::Estimate;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::pointing::{Motion, Pointing};
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

/// A value that some device holds, with where our belief in it comes from. Times are since the program started.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Known<T> {
    /// Nothing is believed: never asked, or forgotten after a lost link, a suspend or a contradiction.
    #[default]
    Unknown,
    /// We told the device so and it has not yet been read back.
    Assumed {
        /// What we sent.
        value: T,
        /// When we sent it.
        at: Duration,
    },
    /// The device said so itself.
    Confirmed {
        /// What it said.
        value: T,
        /// When its answer was complete.
        at: Duration,
    },
}

impl<T> Known<T> {
    /// The value, however it is known.
    pub fn value(&self) -> Option<&T> {
        match self {
            Known::Unknown => None,
            Known::Assumed { value, .. } | Known::Confirmed { value, .. } => Some(value),
        }
    }

    /// The value, if the device itself said it.
    pub fn confirmed(&self) -> Option<&T> {
        match self {
            Known::Confirmed { value, .. } => Some(value),
            _ => None,
        }
    }

    /// How old the belief is.
    pub fn age(&self, now: Duration) -> Option<Duration> {
        match self {
            Known::Unknown => None,
            Known::Assumed { at, .. } | Known::Confirmed { at, .. } => Some(now.saturating_sub(*at)),
        }
    }
}

/// The line to the mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinkState {
    /// No port is open.
    #[default]
    Closed,
    /// A port is open and the mount is being asked who it is.
    Connecting,
    /// The mount answers.
    Ready,
    /// The mount has stopped answering; it is being asked again.
    Mending,
    /// Nothing answers on an open port.
    Silent,
    /// What is sent comes back.
    Looped,
}

/// The form in which the mount gives coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// `HH:MM.T` and degrees and minutes: steps of 90 and 60 arcseconds.
    Short,
    /// `HH:MM:SS` and degrees, minutes and seconds: steps of 15 and 1 arcseconds.
    Long,
}

/// How the mount stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mounting {
    /// Fork in altitude and azimuth.
    AltAz,
    /// Fork on a wedge.
    Polar,
    /// German equatorial.
    German,
    /// Land mode, or an answer that only a classic gives.
    Land,
}

/// What the mount's motors do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tracking {
    /// They follow the sky.
    On,
    /// They stand.
    Off,
    /// The mount sleeps.
    Asleep,
}

/// How far the mount is aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aligned {
    /// On so many stars, 0 to 3.
    Stars(u8),
    /// On its stored home position.
    Home,
    /// It was parked.
    Parked,
    /// A mount too old to say.
    Untold,
}

/// The mount's own account of its state, from `:GW#`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Alignment {
    /// How it stands.
    pub mounting: Mounting,
    /// What its motors do.
    pub tracking: Tracking,
    /// How far it is aligned.
    pub aligned: Aligned,
}

/// The mount's clock, as it stood when it was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// The instant the clock showed, by its own zone.
    pub utc: Utc,
    /// Civil offset in hours, east of Greenwich positive, daylight saving included (the opposite sign of the mount's own).
    pub offset_hours: f64,
}

/// The hand controller's display.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Display {
    /// First line, 16 characters.
    pub top: String,
    /// Second line: 16 characters, or a long scrolling help text.
    pub bottom: String,
    /// Whether a cursor is shown: a field is being filled in.
    pub cursor_shown: bool,
    /// The cursor's row, 0 or 1.
    pub row: u8,
    /// The cursor's column, 0 to 15.
    pub column: u8,
}

/// Whose clock or site is used (section 8.7 of the thesis: the mount's, unless it is unknown or disagrees).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Source {
    /// Nobody's: it is unknown.
    #[default]
    Nobody,
    /// The mount's.
    Mount,
    /// Ours: the computer's clock, the profile's or command line's site.
    Ours,
}

/// The outcome of comparing the mount's clock and site with ours.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Decision {
    /// Whose clock is used.
    pub clock: Source,
    /// Seconds to add to our clock to have the used one: 0 when ours is used.
    pub clock_ahead_s: f64,
    /// Whose site is used.
    pub site_from: Source,
    /// The site to use, if there is any.
    pub site: Option<Site>,
    /// Each disagreement.
    pub disagreements: Vec<Disagreement>,
}

/// What the line has been through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Positions read.
    pub polls: u64,
    /// Commands sent again after a NAK or a timeout.
    pub retries: u64,
    /// Times the conversation was lost and found again.
    pub resyncs: u64,
    /// Times the port was opened again.
    pub reconnects: u64,
    /// Go-tos that the mount took.
    pub slews: u64,
    /// Go-tos that the mount refused.
    pub refused: u64,
    /// Faults reported.
    pub faults: u64,
    /// Bytes that came unasked.
    pub stray_bytes: u64,
    /// Positions not believed.
    pub jumps: u64,
}

/// Everything believed of the mount. Cheap to clone.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Belief {
    /// The line.
    pub link: LinkState,
    /// What it says it is: `LX2001` is an LX200GPS.
    pub product: Known<String>,
    /// Its firmware number.
    pub firmware: Known<String>,
    /// The form of its coordinates.
    pub precision: Known<Precision>,
    /// How it stands, tracks and is aligned.
    pub alignment: Known<Alignment>,
    /// Where it says it points, as it said it.
    pub position: Known<Equatorial<OfDate>>,
    /// What it is doing, by its positions.
    pub motion: Known<Motion>,
    /// Where it points between polls, smoothed.
    pub estimate: Option<Estimate>,
    /// Whether a go-to of ours is under way, and to where.
    pub slewing_to: Option<Equatorial<OfDate>>,
    /// Whether a move by hand of ours is under way.
    pub moving_by_order: bool,
    /// Whether a stop of ours is not yet seen to be obeyed.
    pub stopping: bool,
    /// Its site (without elevation: ours, or 0 m).
    pub site: Known<Site>,
    /// Its clock.
    pub clock: Known<Clock>,
    /// Its sidereal time.
    pub sidereal: Known<Angle>,
    /// The hand controller's display.
    pub display: Known<Display>,
    /// Clock and site compared with ours; `None` until that was done.
    pub decision: Option<Decision>,
    /// What the line has been through.
    pub counters: Counters,
}

impl Belief {
    /// Whether a go-to of ours is under way.
    #[must_use]
    pub fn slewing_by_order(&self) -> bool {
        self.slewing_to.is_some()
    }

    /// Where the telescope points at `now`, or `None` when nothing is known. Stale after 3 seconds without a position.
    #[must_use]
    pub fn pointing(&self, now: Duration) -> Option<Pointing> {
        self.estimate.as_ref().map(|estimate| estimate.at(now))
    }
}
