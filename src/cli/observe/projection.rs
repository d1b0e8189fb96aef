//! Pictures to the projector, and how old the position is that they were drawn from when they get there.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use super::clock::Clock;
use crate::app::scene::Scene;
use crate::cli::photographs::album::Album;
use crate::hw::projector::output::{Output, Stamp, Told};
use crate::hw::projector::{Dimmed, Nowhere, Projector};
use crate::overlay::animation::Animation;
use crate::overlay::facts::Choices;
use crate::overlay::globe::Map;
use crate::overlay::tone::Display;
use crate::overlay::{Composer, Eye, Mode, Photograph, Style, compose};
use crate::picture::Picture;
use crate::pipeline::{self, View};
use crate::sky::catalogue::Catalogue;
use crate::sky::field::FieldOfView;

/// So many ages are kept: enough for the 99th percentile, and no more memory in the longest night.
const KEPT: usize = 4096;

/// So many pictures wait for their stamp at most: the projector overtakes those that are older.
const WAITING: usize = 8;

/// Hears what the projector says.
type Listener = Box<dyn FnMut(Told) + Send>;

/// Where pictures go.
enum Screen {
    /// Not yet begun.
    Waiting(Box<dyn Projector>),
    /// In a thread of its own.
    Thread(Output),
    /// Under a virtual clock no time passes while a picture is shown.
    Stepped(Box<dyn Projector>, Listener),
}

/// What a picture was made from.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Origin {
    /// The instant that the position in it was predicted for.
    pub(super) predicted_for: Duration,
    /// When the mount told the position that the prediction began from.
    pub(super) heard_at: Option<Duration>,
    /// Whether that position has just come and caused the picture.
    pub(super) fresh: bool,
    /// When the key was pressed that caused the picture.
    pub(super) key_at: Option<Duration>,
}

/// A projector with a stopwatch.
pub(super) struct Projection {
    screen: Screen,
    waiting: VecDeque<(Arc<Picture>, Origin)>,
    composer: Composer,
    album: Album,
    animations: Vec<Animation>,
    eye: Eye,
    facts: Choices,
    display: Display,
    /// Pictures that reached the projector.
    pub(super) frames: u64,
    /// From the instant that the position was predicted for to the instant that the picture was there.
    pub(super) ages: Ages,
    /// Ages of the newest position of the mount when the picture was there.
    pub(super) samples: Ages,
    /// The same for pictures that a new position caused.
    pub(super) after_reply: Ages,
    /// From a key of the hand controller to the picture that it caused.
    pub(super) after_key: Ages,
    /// How much the time from handing a picture over to its being there differs from one picture to the next.
    pub(super) jitter: Ages,
    last_delay: Option<Duration>,
    /// The brightness that was asked of the projector, and what is left of it for the pixels.
    light: Option<f32>,
    gain: f32,
}

impl Projection {
    pub(super) fn new(projector: Box<dyn Projector>, album: Album, eye: Eye) -> Projection {
        Projection {
            screen: Screen::Waiting(projector),
            waiting: VecDeque::new(),
            composer: Composer::default(),
            album,
            animations: Vec::new(),
            eye,
            facts: Choices::default(),
            display: Display::default(),
            frames: 0,
            ages: Ages::default(),
            samples: Ages::default(),
            after_reply: Ages::default(),
            after_key: Ages::default(),
            jitter: Ages::default(),
            last_delay: None,
            light: None,
            gain: 0.0,
        }
    }

    /// What can be played, in the order in which scenes number it.
    pub(super) fn with_animations(mut self, animations: Vec<Animation>) -> Projection {
        self.animations = animations;
        self
    }

    /// Which facts are told of an object.
    pub(super) fn with_facts(mut self, facts: Choices) -> Projection {
        self.facts = facts;
        self
    }

    /// Maps that are wrapped on the discs of their bodies.
    pub(super) fn with_maps(mut self, maps: Vec<Map>) -> Projection {
        self.composer = self.composer.with_maps(maps);
        self
    }

    /// What the projector gives at the eye.
    pub(super) fn with_display(mut self, display: Display) -> Projection {
        self.display = display;
        self
    }

    /// Begins: from now on pictures can be shown, and `told` hears what came of them.
    ///
    /// # Errors
    /// The system has no more threads.
    pub(super) fn start(&mut self, clock: Clock, told: impl FnMut(Told) + Send + 'static) -> std::io::Result<()> {
        let before = std::mem::replace(&mut self.screen, Screen::Waiting(Box::new(Nowhere)));
        self.screen = match before {
            Screen::Waiting(projector) if clock.is_virtual() => Screen::Stepped(projector, Box::new(told)),
            Screen::Waiting(projector) => {
                Screen::Thread(Output::start(projector, Arc::new(move || clock.now()), told)?)
            }
            begun => begun,
        };
        Ok(())
    }

    /// The picture of a scene.
    pub(super) fn compose(&mut self, scene: &Scene) -> Picture {
        if self.light != Some(scene.brightness) {
            self.dim(scene.brightness);
        }
        let playing = scene.animation.and_then(|(index, frame)| self.animations.get(index)?.frame(frame));
        let style = Style {
            mode: scene.mode,
            gain: self.gain,
            information: scene.facts,
            facts: self.facts.clone(),
            tone: scene.tone,
            display: self.display.dimmed(f64::from(scene.brightness)),
            labels: scene.facts,
            ..Style::default()
        };
        let photographs = self.photographs(scene, &style);
        let view = View {
            instrument: &scene.instrument,
            site: scene.site.as_ref(),
            catalogue: Catalogue::embedded(),
            photographs: &photographs,
            target: scene.target.as_ref(),
            eye: &self.eye,
            style: &style,
            animation: playing.as_ref(),
            menu: scene.menu.as_ref(),
        };
        pipeline::frame(&scene.pointing, &scene.moment, &view, &mut self.composer).picture
    }

    /// Whose the photographs in the last picture are and on which terms they are shown, the finest first.
    pub(super) fn credits(&self) -> &[String] {
        self.composer.credits()
    }

    /// A sentence for each photograph that could not be read since this was last asked.
    pub(super) fn complaints(&mut self) -> Vec<String> {
        std::mem::take(&mut self.album.notes)
    }

    /// The photographs of a scene's field; none while nothing is drawn, so that no file is read on the way to an object.
    fn photographs(&mut self, scene: &Scene, style: &Style) -> Vec<Photograph> {
        if !scene.photographs || style.mode == Mode::Off || scene.animation.is_some() || self.album.is_empty() {
            return Vec::new();
        }
        let field = FieldOfView::new(&scene.pointing, &scene.instrument, &scene.moment, scene.site.as_ref());
        if !field.may_draw {
            return Vec::new();
        }
        self.album.reaching(&field.centre(), compose::reach(&field, style, scene.target.as_ref()))
    }

    /// Hands a picture over. Its stamp comes back through `told`: give it to [`Projection::stamped`].
    pub(super) fn show(&mut self, picture: &Arc<Picture>, origin: Origin, now: Duration) {
        if self.waiting.len() == WAITING {
            self.waiting.pop_front();
        }
        self.waiting.push_back((Arc::clone(picture), origin));
        match &mut self.screen {
            Screen::Waiting(_) => {}
            Screen::Thread(output) => output.show(Arc::clone(picture), origin.predicted_for),
            Screen::Stepped(projector, told) => {
                let stamp = Stamp { predicted_for: origin.predicted_for, asked: now, presented: now };
                told(projector.present(picture).map_or_else(Told::Failed, |()| Told::Shown(stamp)));
            }
        }
    }

    /// Takes the stamp of a picture in, and gives the picture; none if it has become dark since.
    pub(super) fn stamped(&mut self, stamp: &Stamp) -> Option<Arc<Picture>> {
        let place = self.waiting.iter().position(|(_, origin)| origin.predicted_for == stamp.predicted_for)?;
        // Those before it were overtaken; a key that had changed one of them has changed this one.
        let overtaken_key = self.waiting.iter().take(place).find_map(|(_, origin)| origin.key_at);
        let (picture, mut origin) = self.waiting.drain(..=place).next_back()?;
        origin.key_at = overtaken_key.or(origin.key_at);
        self.frames += 1;
        self.ages.add(stamp.age());
        if let Some(heard_at) = origin.heard_at {
            let age = stamp.presented.saturating_sub(heard_at);
            self.samples.add(age);
            if origin.fresh {
                self.after_reply.add(age);
            }
        }
        if let Some(key_at) = origin.key_at {
            self.after_key.add(stamp.presented.saturating_sub(key_at));
        }
        let delay = stamp.presented.saturating_sub(stamp.asked);
        if let Some(before) = self.last_delay.replace(delay) {
            self.jitter.add(delay.abs_diff(before));
        }
        Some(picture)
    }

    /// Black, before anything else. An error is told as every other; the projector is told again until it is dark, and at the
    /// end by its own drop.
    pub(super) fn dark(&mut self, now: Duration) {
        self.waiting.clear();
        self.last_delay = None;
        match &mut self.screen {
            Screen::Waiting(projector) => drop(projector.dark()),
            Screen::Thread(output) => output.dark(),
            Screen::Stepped(projector, told) => {
                told(projector.dark().map_or_else(Told::Failed, |()| Told::Dark(now)));
            }
        }
    }

    /// Makes the light so much of the fullest. Until the projector has said what the pixels must do they do all of it: a
    /// picture is never brighter than was asked.
    fn dim(&mut self, share: f32) {
        (self.light, self.gain) = (Some(share), share);
        match &mut self.screen {
            Screen::Waiting(projector) => drop(projector.dim(share)),
            Screen::Thread(output) => output.dim(share),
            Screen::Stepped(projector, told) => told(projector.dim(share).map_or_else(Told::Failed, Told::Dimmed)),
        }
    }

    /// Takes in what came of dimming; whether the picture must be drawn anew.
    pub(super) fn dimmed(&mut self, dimmed: &Dimmed) -> bool {
        std::mem::replace(&mut self.gain, dimmed.gain) != dimmed.gain
    }

    /// Whether the projector's thread lives and its device answers.
    pub(super) fn alive(&self) -> bool {
        match &self.screen {
            Screen::Thread(output) => output.alive(),
            Screen::Waiting(_) | Screen::Stepped(..) => true,
        }
    }

    pub(super) fn describe(&self) -> String {
        match &self.screen {
            Screen::Waiting(projector) | Screen::Stepped(projector, _) => projector.describe(),
            Screen::Thread(output) => output.describe().to_owned(),
        }
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

    #[test]
    fn a_stamp_finds_its_picture_and_one_that_comes_after_dark_does_not() {
        let ms = Duration::from_millis;
        let mut projection = Projection::new(Box::new(Nowhere), Album::default(), Eye::default());
        let (tell, told) = std::sync::mpsc::channel();
        projection.start(Clock::made(None), move |said| drop(tell.send(said))).unwrap();
        let picture = Arc::new(Picture::black(2, 2));
        let origin = Origin { predicted_for: ms(100), heard_at: Some(ms(60)), fresh: true, key_at: Some(ms(90)) };
        projection.show(&picture, origin, ms(140));
        let Ok(Told::Shown(stamp)) = told.recv() else { panic!("it is shown") };
        assert!(projection.stamped(&stamp).is_some());
        let medians = [&projection.ages, &projection.samples, &projection.after_reply, &projection.after_key];
        assert_eq!(medians.map(|ages| ages.percentile_ms(0.5)), [40.0, 80.0, 80.0, 50.0].map(Some));

        projection.show(&picture, Origin { predicted_for: ms(200), ..origin }, ms(201));
        let Ok(Told::Shown(late)) = told.recv() else { panic!("it is shown") };
        projection.dark(ms(202));
        assert!(matches!(told.recv(), Ok(Told::Dark(_))) && projection.stamped(&late).is_none());
        assert_eq!(projection.frames, 1);
    }
}
