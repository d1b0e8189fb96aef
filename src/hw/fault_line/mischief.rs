//! What can go wrong on a cable, by name, and when it does.

use std::time::Duration;

/// One thing that goes wrong while its [`Spell`] lasts. Chances are 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mischief {
    /// Chance of each byte to be lost.
    Drop(f64),
    /// Chance of each byte to come twice.
    Duplicate(f64),
    /// Chance of each byte to have one bit wrong.
    Flip(f64),
    /// Chance of a 0xFF or a NUL before each byte.
    Insert(f64),
    /// Each reply ends after so many bytes.
    Truncate(usize),
    /// Each reply stops after so many bytes, and its rest comes so much later.
    Stall(usize, Duration),
    /// Each reply comes later by this.
    Delay(Duration),
    /// Chance that the reply before comes in place of this one.
    Swap(f64),
    /// Chance that a reply waits for the next, and both come at once.
    Glue(f64),
    /// Chance of text that nobody asked for behind a reply.
    Unasked(f64),
    /// So many bytes without any `#`, as fast as they are read.
    Flood(usize),
    /// The other end has another baud rate: garbage, both ways.
    WrongBaud,
    /// What is sent comes back before the answer.
    Echo,
    /// The line is held low: one NUL, then nothing, both ways.
    Break,
    /// The cable is out; the port comes back under its old name.
    Unplug,
    /// The cable is out; the port comes back under another name.
    Rename,
    /// The port is lost, and may then not be opened by this user.
    Forbid,
    /// The port is lost, and then another program has it.
    Hold,
    /// Each opening restarts what is at the other end (DTR): it is deaf and mute for two seconds, then says `X`.
    Reset,
    /// The port takes so many bytes a second; 0 is none.
    Slow(u32),
    /// The first bytes after each opening are missed: listening begins in the middle of a packet.
    MidPacket(usize),
    /// Both directions are on the one line that is listened to: display traffic stands between the bytes, with this chance.
    Crosstalk(f64),
}

/// Every name with its meaning, in the order of the enum.
pub const MENU: [(&str, &str); 22] = [
    ("drop", "bytes are lost"),
    ("duplicate", "bytes come twice"),
    ("flip", "one bit of a byte is wrong"),
    ("insert", "0xFF or NUL between the bytes"),
    ("truncate", "replies end after k bytes"),
    ("stall", "replies stop in their middle, their rest comes late"),
    ("delay", "replies come late"),
    ("swap", "the reply to the command before"),
    ("glue", "two replies at once"),
    ("unasked", "text that nobody asked for"),
    ("flood", "bytes without end and without #"),
    ("wrong-baud", "garbage both ways"),
    ("echo", "what is sent comes back"),
    ("break", "the line is held low"),
    ("unplug", "unplugged, back under the same name"),
    ("rename", "unplugged, back under another name"),
    ("forbid", "lost, then not permitted"),
    ("hold", "lost, then held by another program"),
    ("reset", "opening restarts the device (DTR)"),
    ("slow", "the port takes few bytes, or none"),
    ("mid-packet", "listening begins in the middle of a packet"),
    ("crosstalk", "both directions on one line"),
];

impl Mischief {
    /// Its place in [`MENU`].
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Mischief::Drop(_) => 0,
            Mischief::Duplicate(_) => 1,
            Mischief::Flip(_) => 2,
            Mischief::Insert(_) => 3,
            Mischief::Truncate(_) => 4,
            Mischief::Stall(..) => 5,
            Mischief::Delay(_) => 6,
            Mischief::Swap(_) => 7,
            Mischief::Glue(_) => 8,
            Mischief::Unasked(_) => 9,
            Mischief::Flood(_) => 10,
            Mischief::WrongBaud => 11,
            Mischief::Echo => 12,
            Mischief::Break => 13,
            Mischief::Unplug => 14,
            Mischief::Rename => 15,
            Mischief::Forbid => 16,
            Mischief::Hold => 17,
            Mischief::Reset => 18,
            Mischief::Slow(_) => 19,
            Mischief::MidPacket(_) => 20,
            Mischief::Crosstalk(_) => 21,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        MENU[self.index()].0
    }

    /// Whether the port is gone while it lasts.
    #[must_use]
    pub fn takes_the_port(self) -> bool {
        matches!(self, Mischief::Unplug | Mischief::Rename | Mischief::Forbid | Mischief::Hold)
    }
}

/// Which way the bytes go that suffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// What comes in.
    #[default]
    Replies,
    /// What is sent.
    Commands,
    /// Both.
    Both,
}

/// When something begins to go wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum When {
    /// At this time.
    At(Duration),
    /// After this time, as soon as the bytes sent end so: the rest of what is being sent does not go out.
    Sent(Duration, Vec<u8>),
    /// After this time, as soon as so many bytes of one reply have come.
    Read(Duration, usize),
}

/// Something that goes wrong for a while.
#[derive(Debug, Clone, PartialEq)]
pub struct Spell {
    /// When it begins.
    pub when: When,
    /// For how long.
    pub lasts: Duration,
    /// What.
    pub mischief: Mischief,
    /// Which way, where that makes a difference.
    pub side: Side,
}

impl Spell {
    /// A spell on the bytes that come in, by the clock.
    #[must_use]
    pub fn at(from: Duration, lasts: Duration, mischief: Mischief) -> Spell {
        Spell { when: When::At(from), lasts, mischief, side: Side::Replies }
    }
}
