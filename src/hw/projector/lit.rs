//! A projector whose LEDs are driven too: they are on only while there is a picture, and go off before it does.

use super::{Dimmed, Projector, ProjectorError};
use crate::hw::light::error::LightError;
use crate::hw::light::guard::Guard;
use crate::hw::light::lamp::Lamp;
use crate::picture::Picture;

/// A projector with a lamp. A black picture is LEDs off, not mirrors turned away: black leaks.
pub struct Lit {
    lamp: Lamp,
    /// The luminance of full brightness, cd/m2.
    full_cd_m2: f64,
    guard: Option<Guard>,
    inner: Box<dyn Projector>,
}

impl Lit {
    /// A projector lit by a lamp whose present luminance is full brightness, watched over by a guard.
    #[must_use]
    pub fn new(inner: Box<dyn Projector>, lamp: Lamp, guard: Option<Guard>) -> Lit {
        let full_cd_m2 = lamp.plan().asked_cd_m2;
        Lit { lamp, full_cd_m2, guard, inner }
    }

    /// The lamp.
    #[must_use]
    pub fn lamp(&self) -> &Lamp {
        &self.lamp
    }

    /// After a failure of the lamp there is no picture either.
    fn failed(&mut self, error: LightError) -> ProjectorError {
        // The lamp's error is the one to tell.
        let _ = self.inner.dark();
        error.into()
    }
}

impl From<LightError> for ProjectorError {
    fn from(error: LightError) -> ProjectorError {
        ProjectorError::Light(Box::new(error))
    }
}

impl Projector for Lit {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        if picture.is_black() {
            return self.dark();
        }
        if let Err(error) = self.inner.present(picture) {
            // What the mirrors show now is not known.
            let _ = self.lamp.off();
            return Err(error);
        }
        let lit = self.lamp.on().and_then(|()| self.lamp.look());
        lit.map_err(|error| self.failed(error))
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        let off = self.lamp.off();
        self.inner.dark().and(off.map_err(ProjectorError::from))
    }

    fn dim(&mut self, share: f32) -> Result<Dimmed, ProjectorError> {
        let share = if share > 0.0 { f64::from(share.min(1.0)) } else { 0.0 };
        let done = self.lamp.dim(share * self.full_cd_m2).map(|plan| Dimmed {
            gain: plan.pixel_gain as f32,
            advice: if plan.keeps_contrast() { None } else { plan.advice() },
        });
        done.map_err(|error| self.failed(error))
    }

    fn describe(&self) -> String {
        format!("{}, lit by {}", self.inner.describe(), self.lamp.describe())
    }
}

impl Drop for Lit {
    fn drop(&mut self) {
        // A guard that is not released sees to it itself.
        if self.lamp.dark().is_ok()
            && let Some(guard) = self.guard.take()
        {
            guard.release();
        }
    }
}

#[cfg(test)]
mod tests;
