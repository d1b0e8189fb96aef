//! Pictures kept in memory, for tests and for the preview in the terminal.

use std::sync::{Arc, Mutex, PoisonError};

use super::{Projector, ProjectorError};
use crate::picture::Picture;

/// Keeps the last picture where whoever holds a clone can look at it.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    shown: Arc<Mutex<Shown>>,
}

/// What a [`Memory`] has been told.
#[derive(Debug, Clone, Default)]
pub struct Shown {
    /// The last picture; none is black.
    pub picture: Option<Picture>,
    /// How many pictures were presented.
    pub presented: u64,
}

impl Memory {
    /// What is shown now.
    #[must_use]
    pub fn shown(&self) -> Shown {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether it is dark now.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        self.shown().picture.is_none_or(|picture| picture.is_black())
    }
}

impl Projector for Memory {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        shown.picture = Some(picture.clone());
        shown.presented += 1;
        Ok(())
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).picture = None;
        Ok(())
    }

    fn describe(&self) -> String {
        "memory".into()
    }
}

/// No projector: everything presented is forgotten.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nowhere;

impl Projector for Nowhere {
    fn present(&mut self, _picture: &Picture) -> Result<(), ProjectorError> {
        Ok(())
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        Ok(())
    }

    fn describe(&self) -> String {
        "no projector".into()
    }
}
