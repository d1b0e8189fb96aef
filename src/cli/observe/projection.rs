//! Pictures to the projector, and how old the position is that they were drawn from when they get there.

use std::time::Duration;

use crate::app::scene::Scene;
use crate::hw::projector::{Projector, ProjectorError};
use crate::overlay::{Composer, Eye, Photograph, Style};
use crate::picture::Picture;
use crate::pipeline::{self, View};
use crate::sky::catalogue::Catalogue;

/// So many ages are kept: enough for the 99th percentile, and no more memory in the longest night.
const KEPT: usize = 4096;

/// A projector with a stopwatch.
pub(super) struct Projection {
    projector: Box<dyn Projector>,
    composer: Composer,
    photographs: Vec<Photograph>,
    eye: Eye,
    /// Pictures handed over.
    pub(super) frames: u64,
    /// Ages of the positions they were drawn from: the mount's reply to the picture handed over.
    pub(super) ages: Ages,
    /// The same for pictures that a new position caused.
    pub(super) after_reply: Ages,
}

impl Projection {
    pub(super) fn new(projector: Box<dyn Projector>, photographs: Vec<Photograph>, eye: Eye) -> Projection {
        Projection {
            projector,
            composer: Composer::default(),
            photographs,
            eye,
            frames: 0,
            ages: Ages::default(),
            after_reply: Ages::default(),
        }
    }

    /// The picture of a scene.
    pub(super) fn compose(&mut self, scene: &Scene) -> Picture {
        let view = View {
            instrument: &scene.instrument,
            site: scene.site.as_ref(),
            catalogue: Catalogue::embedded(),
            photographs: if scene.photographs { &self.photographs } else { &[] },
            target: scene.target.as_ref(),
            eye: &self.eye,
            style: &Style {
                mode: scene.mode,
                gain: scene.brightness,
                information: scene.facts,
                labels: scene.facts,
                ..Style::default()
            },
            animation: None,
            menu: scene.menu.as_ref(),
        };
        pipeline::frame(&scene.pointing, &scene.moment, &view, &mut self.composer).picture
    }

    pub(super) fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        self.projector.present(picture)?;
        self.frames += 1;
        Ok(())
    }

    /// Black. An error is not told: the projector is told again at the next chance, and at the end by its own drop.
    pub(super) fn dark(&mut self) {
        let _ = self.projector.dark();
    }

    pub(super) fn describe(&self) -> String {
        self.projector.describe()
    }
}

/// The latest ages.
#[derive(Debug, Clone, Default)]
pub(super) struct Ages {
    kept: Vec<Duration>,
    next: usize,
}

impl Ages {
    pub(super) fn add(&mut self, age: Duration) {
        if self.kept.len() < KEPT {
            self.kept.push(age);
        } else {
            self.kept[self.next] = age;
            self.next = (self.next + 1) % KEPT;
        }
    }

    /// The age that a share of all ages does not exceed, in milliseconds.
    pub(super) fn percentile_ms(&self, share: f64) -> Option<f64> {
        let mut sorted = self.kept.clone();
        sorted.sort_unstable();
        let place = (share * sorted.len() as f64).ceil() as usize;
        sorted.get(place.saturating_sub(1)).map(|age| (age.as_secs_f64() * 1e5).round() / 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_one_to_a_hundred_are_themselves_and_memory_is_bounded() {
        let mut ages = Ages::default();
        assert_eq!(ages.percentile_ms(0.5), None);
        (1..=100).for_each(|ms| ages.add(Duration::from_millis(ms)));
        assert_eq!([0.5, 0.95, 0.99].map(|share| ages.percentile_ms(share)), [Some(50.0), Some(95.0), Some(99.0)]);
        (0..100_000).for_each(|_| ages.add(Duration::from_millis(7)));
        assert_eq!((ages.kept.len(), ages.percentile_ms(0.99)), (KEPT, Some(7.0)));
    }
}
