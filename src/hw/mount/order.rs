//! What may be asked of the mount, and what it reports back.

use std::fmt;
use std::time::Duration;

use super::advice::Disagreement;
use super::command::Question;
use crate::hw::port::PortError;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

/// A direction of the hand controller's arrow keys. On an alt-azimuth mount north is up and east is left or right by the
/// firmware's taste: try it on the sky before trusting it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Up, towards higher declination.
    North,
    /// Down, towards lower declination.
    South,
    /// Towards higher right ascension.
    East,
    /// Towards lower right ascension.
    West,
}

impl Direction {
    /// All four.
    pub const ALL: [Direction; 4] = [Direction::North, Direction::South, Direction::East, Direction::West];
}

/// How fast a move by hand goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Rate {
    /// Twice sidereal and slower: 15 arcseconds a second on top of tracking.
    Guide,
    /// 16 times sidereal: 4 arcminutes a second.
    Centre,
    /// About 2 degrees a second.
    Find,
    /// As fast as it goes: up to 8 degrees a second.
    Slew,
}

/// A key of the Autostar II hand controller, pressed by wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Key {
    /// MODE: back, leave the menu.
    Mode,
    /// MODE, held: status display.
    ModeLong,
    /// ENTER.
    Enter,
    /// ENTER, held.
    EnterLong,
    /// GO TO.
    Goto,
    /// The `?` key: help.
    Help,
    /// Scroll up.
    Up,
    /// Scroll down.
    Down,
    /// Arrow left.
    Left,
    /// Arrow right.
    Right,
    /// A digit, 0 to 9 (0 is also the light).
    Digit(u8),
}

/// An order to the mount. Safety has judged it before it comes here.
#[derive(Debug, Clone, PartialEq)]
pub enum Order {
    /// Slew there.
    Goto(Equatorial<OfDate>),
    /// Stop all motion. Overtakes everything and is repeated until the position is still.
    Stop,
    /// Tell the mount that it points there now.
    Sync(Equatorial<OfDate>),
    /// Move by hand. Ends by itself after [`super::driver::Settings::move_bound`] unless the order is given again.
    Move(Direction, Rate),
    /// End the move in this direction.
    MoveEnd(Direction),
    /// Give the mount this site.
    SetSite(Site),
    /// Give the mount this time, and its civil offset (hours east of Greenwich, daylight saving included).
    SetClock(Utc, f64),
    /// Read the hand controller's display once.
    ReadDisplay,
    /// Press a key of the hand controller.
    PressKey(Key),
    /// Ask anything else of the command table that is safe to ask.
    Ask(Question),
    /// Compare clock and site again: ours have changed, or the mount was set by hand.
    Compare,
}

/// What went wrong on the line, in one word for the counters and a sentence for the log.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// Nothing answers.
    #[error(
        "the mount does not answer: is it switched on, aligned, and the cable in the RS-232 socket next to the handbox port?"
    )]
    Silent,
    /// What we send comes back.
    #[error("the cable is looped: what is sent comes back unchanged. Plug it into the mount's RS-232 socket")]
    Looped,
    /// Bytes that are no reply.
    #[error("the mount answered '{got}' to {command}, which is no answer to it: check baud rate (9600) and cable")]
    Garbled {
        /// What was asked.
        command: String,
        /// What came, made printable.
        got: String,
    },
    /// No reply, or half of one, in time.
    #[error("no answer to {command} within {waited_ms} ms")]
    TimedOut {
        /// What was asked.
        command: String,
        /// How long we waited.
        waited_ms: u64,
    },
    /// More bytes than any reply has.
    #[error("bytes come in without end and without meaning ({bytes} so far): wrong baud rate, or not a mount")]
    Babbling {
        /// How many came since the last good reply.
        bytes: u64,
    },
    /// The mount stayed busy.
    #[error("the mount is busy (it refused {command} {tries} times): wait for it to finish, then order again")]
    Busy {
        /// What was asked.
        command: String,
        /// How often it was asked.
        tries: u32,
    },
    /// A position that no telescope can have reached.
    #[error(
        "the mount's position jumped {degrees:.1} degrees in {seconds:.1} s, which it cannot: not believed until it says so again"
    )]
    Jump {
        /// Distance on the sky.
        degrees: f64,
        /// Time since the last position.
        seconds: f64,
    },
    /// Too many orders at once.
    #[error("{0} orders are waiting already: this one was dropped")]
    QueueFull(usize),
}

/// What the mount's driver reports. Every variant can be shown to the observer as it is.
#[derive(Debug, Clone, PartialEq)]
pub enum Report {
    /// Asked who it is, and it answered.
    Connected {
        /// Product name, or what we take it for.
        product: String,
        /// Firmware number, if it told.
        firmware: Option<String>,
    },
    /// The port is gone; it is being reopened.
    Lost(PortError),
    /// The port could not be reopened; the next try comes after a pause.
    StillLost {
        /// Why.
        why: PortError,
        /// How many tries so far.
        tries: u32,
        /// Pause before the next.
        retry_in: Duration,
    },
    /// A new position was believed.
    Position,
    /// The slew has begun.
    SlewStarted,
    /// The slew has ended at its target.
    Arrived {
        /// Distance of the reported position from the target.
        off_by: Angle,
    },
    /// The slew has ended somewhere else: stopped by hand, or at a limit.
    EndedShort {
        /// Distance of the reported position from the target.
        off_by: Angle,
    },
    /// The mount refused to go there.
    GotoRefused {
        /// Its words, without control characters.
        reason: String,
    },
    /// The go-to could not be put through.
    GotoFailed {
        /// What happened on the line.
        why: Fault,
    },
    /// The mount took the synchronisation; its words, which on an LX200GPS are always the same.
    Synced {
        /// Its words, without control characters.
        reply: String,
    },
    /// Any order but a go-to that could not be put through, or was refused.
    OrderFailed {
        /// Which order, in words.
        order: &'static str,
        /// What happened.
        why: String,
    },
    /// The stop was sent.
    Stopping,
    /// The position is still.
    Stopped,
    /// The mount still moves, or does not answer, after the stop was sent again and again.
    StopNotObeyed {
        /// How long the stop has been repeated.
        after: Duration,
        /// Whether positions come in at all.
        answers: bool,
    },
    /// A move by hand ended because it was not renewed.
    MoveBounded(Direction),
    /// Something went wrong on the line; it is being mended.
    Fault(Fault),
    /// The mount said that it is busy; the command is sent again.
    BusyNak {
        /// Which command.
        command: String,
    },
    /// The conversation was lost and found again.
    Resynchronised,
    /// The mount and we disagree.
    Disagreement(Disagreement),
    /// Clock and site have been compared: the belief holds the outcome.
    Compared,
    /// The site was given and read back.
    SiteSet,
    /// The clock was given and agrees by sidereal time.
    ClockSet,
    /// The hand controller's display was read: the belief holds it.
    Display,
    /// The answer to [`Order::Ask`].
    Answer {
        /// What was asked.
        command: String,
        /// The answer, without control characters.
        text: String,
    },
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Direction::North => "north",
            Direction::South => "south",
            Direction::East => "east",
            Direction::West => "west",
        })
    }
}

impl fmt::Display for Report {
    /// One sentence for the log.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Report::Connected { product, firmware: Some(firmware) } => {
                write!(f, "connected to {product}, firmware {firmware}")
            }
            Report::Connected { product, firmware: None } => write!(f, "connected to {product}"),
            Report::Lost(why) => write!(f, "{why}"),
            Report::StillLost { why, tries, retry_in } => {
                write!(f, "{why} (try {tries}, next in {:.1} s)", retry_in.as_secs_f64())
            }
            Report::Position => f.write_str("position read"),
            Report::SlewStarted => f.write_str("slewing"),
            Report::Arrived { off_by } => write!(f, "arrived, {:.1}′ from the target", off_by.to_arcminutes()),
            Report::EndedShort { off_by } => {
                write!(f, "the slew ended {:.1}° from the target: order it again", off_by.to_degrees())
            }
            Report::GotoRefused { reason } => write!(f, "the mount refuses to go there: {reason}"),
            Report::GotoFailed { why } => write!(f, "the go-to was not put through: {why}"),
            Report::Synced { reply } => write!(f, "synchronised ({reply})"),
            Report::OrderFailed { order, why } => write!(f, "{order} failed: {why}"),
            Report::Stopping => f.write_str("stop sent"),
            Report::Stopped => f.write_str("stopped: the position is still"),
            Report::StopNotObeyed { after, answers: true } => write!(
                f,
                "STOP NOT OBEYED: still moving {:.0} s after the stop was sent. Cut the mount's power",
                after.as_secs_f64()
            ),
            Report::StopNotObeyed { after, answers: false } => write!(
                f,
                "STOP NOT CONFIRMED: no position for {:.0} s since the stop was sent. Look at the tube; cut the mount's power if it moves",
                after.as_secs_f64()
            ),
            Report::MoveBounded(direction) => write!(f, "move {direction} ended: the key was not renewed"),
            Report::Fault(fault) => write!(f, "{fault}"),
            Report::BusyNak { command } => write!(f, "the mount is busy: {command} is sent again"),
            Report::Resynchronised => f.write_str("the conversation with the mount was lost and found again"),
            Report::Disagreement(disagreement) => write!(f, "{disagreement}"),
            Report::Compared => f.write_str("clock and site compared"),
            Report::SiteSet => f.write_str("the mount has the site"),
            Report::ClockSet => f.write_str("the mount has the time"),
            Report::Display => f.write_str("hand controller read"),
            Report::Answer { command, text } => write!(f, "{command} answers {text}"),
        }
    }
}
