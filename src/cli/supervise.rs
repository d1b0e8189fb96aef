//! `scotopic supervise`: the small process that stops the mount if the session dies. Hidden: the session starts it.

use super::Failure;
use crate::hw::supervisor::{self, SupervisorError};

/// Watches until the session ends.
///
/// # Errors
/// Started by hand.
pub fn run() -> Result<(), Failure> {
    match supervisor::supervise() {
        Ok(_) => Ok(()),
        Err(error @ SupervisorError::ByHand) => Err(Failure::asked(error)),
        Err(error) => Err(Failure::failed(error)),
    }
}
