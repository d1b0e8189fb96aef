//! What the session asks of the world. Data, so that a test can read it.

use super::scene::Scene;
use crate::hw::mount::order::Order;
use crate::safety::TurnCounter;
use crate::sky::field::Nudge;

/// Something to be done outside.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Give the mount an order that safety has judged.
    Order(Order),
    /// Compose this and hand it to the projector.
    Draw(Box<Scene>),
    /// Make the projector dark.
    Dark,
    /// Forget all that is believed of the mount, and ask it anew.
    Forget,
    /// Keep the turns of the azimuth axis and the nudge over restarts.
    Keep(TurnCounter, Nudge),
    /// End the session: projector dark, terminal as it was.
    Quit,
}
