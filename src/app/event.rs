//! What happens to the session.

use std::sync::Arc;

use super::key::Key;
use crate::hw::handbox::Pressed;
use crate::hw::mount::belief::Belief;
use crate::hw::mount::order::Report;
use crate::picture::Picture;
use crate::safety::suspend::Clocks;

/// Something that happened.
#[derive(Debug, Clone)]
pub enum Event {
    /// A key was pressed.
    Key(Key),
    /// A key of the hand controller was pressed.
    Handbox(Pressed),
    /// Time has passed: the clocks, read together.
    Clocks(Clocks),
    /// The mount told something.
    Mount(Box<Belief>, Vec<Report>),
    /// The picture was handed to the projector.
    Shown(Arc<Picture>),
    /// Whose the photographs in the picture are and on which terms they are shown, the finest first.
    Photographs(Vec<String>),
    /// The projector could not show it: why, and what to do.
    ProjectorFailed(String),
    /// Something around the session went wrong: what, and what to do.
    Notice(String),
    /// Somebody outside asks the session to end.
    AskedToEnd,
}
