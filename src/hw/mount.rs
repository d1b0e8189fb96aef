//! The mount, spoken as it really speaks.
//!
//! ```text
//! order -> driver -> command -> bytes -> port -> mount
//! report, belief <- driver <- reply <- frame <- bytes
//! ```
//!
//! Everything but [`link`] is pure: bytes in, bytes out, a clock handed in.

/// Which mount, and over which line.
pub mod address;
/// Where the mount and we disagree, in words, with what to do.
pub mod advice;
/// What we believe of the mount, and how sure we are.
pub mod belief;
/// What is sent to the mount, and the one place that turns it into bytes.
pub mod command;
/// The protocol as a state machine without I/O.
pub mod driver;
/// Where the mount points between two polls.
pub mod estimate;
/// The thread that owns the port.
pub mod link;
/// What may be asked of the mount, and what it reports back.
pub mod order;
/// A simulated mount.
pub mod sim;
