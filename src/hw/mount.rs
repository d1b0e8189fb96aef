//! The mount, spoken as it really speaks.
//!
//! ```text
//! order -> driver -> command -> bytes -> port -> mount
//! report, belief <- driver <- reply <- frame <- bytes
//! ```
//!
//! Everything but `link` is pure: bytes in, bytes out, a clock handed in.

/// Which mount, and over which line.
pub mod address;
/// Where the mount and we disagree, in words, with what to do.
pub mod advice;
/// What we believe of the mount, and how sure we are.
pub mod belief;
/// What is sent to the mount, and the one place that turns it into bytes.
pub mod command;
/// How families of mounts differ, as a value.
pub mod dialect;
/// The protocol as a state machine without I/O.
pub mod driver;
/// Where the mount points between two polls.
pub mod estimate;
/// Where a reply ends.
pub mod frame;
/// The thread that owns the port.
pub mod link;
/// What may be asked of the mount, and what it reports back.
pub mod order;
/// The mount's clock and site against ours.
pub mod reconcile;
/// What the mount's answers mean.
pub mod reply;
/// Angles and times as the mount writes them.
pub mod sexagesimal;
/// A simulated mount.
pub mod sim;
/// The command table: reply shapes, and what is never sent.
pub mod table;
