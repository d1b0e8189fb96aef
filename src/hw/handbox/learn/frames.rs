//! Whole frames around the sequences that tell keys apart: of one length with one first byte, or ended by silence.

use super::Bursts;
use super::sequence::{Found, has};
use crate::hw::handbox::keymap::{Framing, Lead, Mode};
use crate::hw::handbox::pattern::{LONGEST, Pattern};

/// How the bursts of a line are made of frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Frames {
    /// Every burst is one or more frames of this length with this first byte.
    Fixed { length: usize, lead: u8 },
    /// A burst is a frame.
    Gap,
}

impl Frames {
    /// Judges by all presses of all keys.
    pub(super) fn of<'a>(takes: impl Iterator<Item = &'a Bursts>) -> Frames {
        let bursts: Vec<&Vec<u8>> = takes.flatten().collect();
        let length = bursts.iter().map(|burst| burst.len()).min().unwrap_or(0);
        let lead = bursts.first().and_then(|burst| burst.first());
        let fits = |burst: &Vec<u8>| {
            burst.len().is_multiple_of(length) && burst.chunks(length).all(|frame| frame.first() == lead)
        };
        match lead {
            Some(lead) if (2..=LONGEST).contains(&length) && bursts.iter().all(|burst| fits(burst)) => {
                Frames::Fixed { length, lead: *lead }
            }
            _ => Frames::Gap,
        }
    }

    /// The framing of a key map.
    pub(super) fn framing(self) -> Framing {
        match self {
            Frames::Fixed { length, lead } => {
                Framing { mode: Mode::Fixed, length: Some(length), lead: Some(Lead(lead)), ..Framing::default() }
            }
            Frames::Gap => Framing { mode: Mode::Gap, ..Framing::default() },
        }
    }

    /// The frames around a key's press and release; the bare sequences where the frames differ in length.
    pub(super) fn around(self, found: &Found) -> (Pattern, Option<Pattern>) {
        let whole = |pattern: &Pattern| self.frame(pattern, &found.takes).unwrap_or_else(|| pattern.clone());
        (whole(&found.press), found.release.as_ref().map(whole))
    }

    /// The frame with a sequence in it, wildcards where it differs from press to press.
    fn frame(self, sequence: &Pattern, takes: &[Bursts]) -> Option<Pattern> {
        let sequence: Vec<u8> = sequence.places().iter().copied().flatten().collect();
        let frames = takes.iter().map(|take| self.split(take).find(|frame| has(frame, &sequence)));
        let frames: Vec<&[u8]> = frames.collect::<Option<_>>()?;
        let first = frames.first()?;
        if frames.iter().any(|frame| frame.len() != first.len()) {
            return None;
        }
        let place =
            |index: usize, byte: &u8| frames.iter().all(|frame| frame.get(index) == Some(byte)).then_some(*byte);
        Pattern::new(first.iter().enumerate().map(|(index, byte)| place(index, byte)).collect()).ok()
    }

    fn split(self, take: &Bursts) -> impl Iterator<Item = &[u8]> {
        take.iter().flat_map(move |burst| {
            let length = match self {
                Frames::Fixed { length, .. } => length,
                Frames::Gap => burst.len(),
            };
            burst.chunks(length.max(1))
        })
    }
}
