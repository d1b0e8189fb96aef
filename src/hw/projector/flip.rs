//! Pictures through two buffers: one is on the screen while the other is drawn on, and they change places between two frames.
//! What draws is the same for a display controller and for the simulated display that proves that nothing is ever torn.

use super::geometry::Geometry;
use super::{CANVAS, Placement, Projector, ProjectorError};
use crate::picture::Picture;

/// A simulated display of a fixed rate that knows what it showed.
pub mod simulated;

pub use simulated::{Beat, Record, SimulatedDisplay, Watch};

/// A display with two buffers, numbered 0 and 1. Buffer 0 is on the screen when it is opened.
pub trait Buffers: Send {
    /// How a buffer's pixels lie in its memory.
    fn geometry(&self) -> &Geometry;

    /// Writes rows of a buffer: their numbers and their bytes as [`Geometry::encode_row`] makes them.
    ///
    /// # Errors
    /// What the system says.
    fn write(&mut self, buffer: usize, rows: &[(usize, Vec<u8>)]) -> Result<(), String>;

    /// Asks that a buffer be on the screen from the next frame on, and waits until it is. When the wait fails it may come on
    /// the screen later.
    ///
    /// # Errors
    /// What the system says.
    fn flip(&mut self, buffer: usize) -> Result<(), String>;

    /// What it is, in words.
    fn describe(&self) -> String;
}

/// A projector on a display with two buffers. [`Projector::present`] comes back when the picture is on the screen.
#[derive(Debug)]
pub struct Flipping<B: Buffers> {
    buffers: B,
    placement: Placement,
    /// The buffer that is on the screen.
    front: usize,
    /// The bytes of each row of both buffers, where they are known: only rows that change are written.
    held: [Vec<Option<Vec<u8>>>; 2],
}

impl<B: Buffers> Flipping<B> {
    /// Makes the display dark.
    ///
    /// # Errors
    /// The placement leaves nothing on it, or it does not take black.
    pub fn new(buffers: B, placement: Placement) -> Result<Flipping<B>, ProjectorError> {
        let size = buffers.geometry().size();
        let placement = placement.seen(CANVAS, size)?;
        let mut flipping = Flipping { buffers, placement, front: 0, held: [vec![None; size.1], vec![None; size.1]] };
        flipping.dark()?;
        Ok(flipping)
    }

    /// Writes what differs from what a buffer holds.
    fn fill(&mut self, buffer: usize, rows: impl Iterator<Item = Vec<u8>>) -> Result<(), ProjectorError> {
        let held = &mut self.held[buffer];
        let changed: Vec<(usize, Vec<u8>)> =
            rows.enumerate().filter(|(y, bytes)| held[*y].as_ref() != Some(bytes)).collect();
        // Forgotten first: a row of which half was written is written again.
        changed.iter().for_each(|(y, _)| held[*y] = None);
        self.buffers.write(buffer, &changed).map_err(|why| lost(&self.buffers, why))?;
        for (y, bytes) in changed {
            self.held[buffer][y] = Some(bytes);
        }
        Ok(())
    }

    fn blacken(&mut self, buffer: usize) -> Result<(), ProjectorError> {
        let geometry = *self.buffers.geometry();
        self.fill(buffer, (0..geometry.size().1).map(|_| vec![0; geometry.row_bytes()]))
    }

    fn flip(&mut self, buffer: usize) -> Result<(), ProjectorError> {
        self.buffers.flip(buffer).map_err(|why| lost(&self.buffers, why))?;
        self.front = buffer;
        Ok(())
    }
}

impl<B: Buffers> Projector for Flipping<B> {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        let geometry = *self.buffers.geometry();
        let placed = self.placement.apply(picture, geometry.size());
        let back = 1 - self.front;
        let encoded = |y: usize| {
            let mut bytes = vec![0; geometry.row_bytes()];
            geometry.encode_row(y, placed.row(y), &mut bytes);
            bytes
        };
        self.fill(back, (0..geometry.size().1).map(encoded))?;
        self.flip(back)
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        let back = 1 - self.front;
        let whole = self.blacken(back).and_then(|()| self.flip(back));
        // The other is on no screen now; or, if the flip failed, on it: half a frame of black is better than light.
        let other = self.blacken(1 - back);
        whole.and(other)
    }

    fn describe(&self) -> String {
        self.buffers.describe()
    }
}

impl<B: Buffers> Drop for Flipping<B> {
    fn drop(&mut self) {
        // Nobody is left to tell of a failure.
        let _ = self.dark();
    }
}

fn lost(buffers: &impl Buffers, why: String) -> ProjectorError {
    ProjectorError::Lost { path: buffers.describe(), why }
}

#[cfg(test)]
mod tests;
