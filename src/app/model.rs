//! All that the session knows, grouped by who changes it.

use std::sync::Arc;
use std::time::Duration;

use super::adapting::{Adapting, Observer};
use super::banner::Banner;
use super::bindings::Bindings;
use super::facts::Listed;
use super::log::Log;
use super::menu::{Menu, Page};
use super::scene::Scene;
use super::search::Search;
use crate::hw::mount::belief::Belief;
use crate::overlay::animation::Playable;
use crate::overlay::style::{Mode, Style};
use crate::overlay::tone::{Lights, Toning};
use crate::picture::Picture;
use crate::safety::suspend::Clocks;
use crate::safety::{Acknowledgement, Clock, Fix, Rules, TurnCounter};
use crate::sky::alignment::Pair;
use crate::sky::catalogue::Object;
use crate::sky::coords::{Airless, Equatorial, Horizontal, OfDate};
use crate::sky::ephemeris::Almanac;
use crate::sky::field::Nudge;
use crate::sky::optics::Instrument;
use crate::sky::pointing::Pointing;
use crate::sky::site::Site;
use crate::sky::time::{Moment, Utc};

/// A screen of the session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Screen {
    /// Where the telescope points, what is in the field, the picture.
    Sky,
    /// The search box.
    Search,
    /// The eyepieces.
    Eyepieces,
    /// What is believed of the mount.
    Mount,
    /// How to align.
    Align,
    /// What has happened.
    Log,
    /// Every key.
    Help,
}

impl Screen {
    /// All of them.
    pub const ALL: [Screen; 7] =
        [Screen::Sky, Screen::Search, Screen::Eyepieces, Screen::Mount, Screen::Align, Screen::Log, Screen::Help];

    /// Its name.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Screen::Sky => "sky",
            Screen::Search => "search",
            Screen::Eyepieces => "eyepieces",
            Screen::Mount => "mount",
            Screen::Align => "align",
            Screen::Log => "log",
            Screen::Help => "help",
        }
    }
}

/// What the session is opened with.
#[derive(Debug, Clone)]
pub struct Opening {
    /// Telescope, eyepieces, projector.
    pub instrument: Instrument,
    /// Our site, if we have one.
    pub site: Option<Site>,
    /// Whether the telescope is simulated.
    pub simulated: bool,
    /// Whether a person stated the time, or a simulator made it: then any date is meant as it stands.
    pub time_stated: bool,
    /// The safety rules.
    pub rules: Rules,
    /// The turns of the azimuth axis so far.
    pub turns: TurnCounter,
    /// The observer's correction of the last session: kept until the next sync.
    pub nudge: Nudge,
    /// Where the mount is, in words: `sim`, `serial:/dev/ttyUSB0`.
    pub mount: String,
    /// Where the picture goes, in words: `none`, `fb:/dev/fb0`.
    pub projector: String,
    /// What the hand controller's keys mean.
    pub bindings: Bindings,
    /// The animations that can be played.
    pub animations: Vec<Playable>,
    /// The observer's eye and wishes.
    pub observer: Observer,
}

/// Time, as the session has it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Time {
    /// Since the program started.
    pub now: Duration,
    /// The clocks at the last look.
    pub clocks: Option<Clocks>,
    /// Our clock's UTC.
    pub ours: Option<Utc>,
    /// The clock that is used: ours or the mount's.
    pub used: Clock,
}

/// Where the telescope points, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Here {
    /// With the nudge.
    pub pointing: Pointing,
    /// Against the horizon, when site and time are known.
    pub horizontal: Option<Horizontal<Airless>>,
}

/// What the projector does.
#[derive(Debug, Clone, PartialEq)]
pub enum Projector {
    /// Dark, and why.
    Dark(&'static str),
    /// Being drawn.
    Drawing,
    /// It shows the picture.
    Showing,
    /// It could not: why, and what to do.
    Failed(String),
}

/// What the session has counted itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Go-tos that the safety rules refused.
    pub refused: u64,
    /// Motions that the safety rules stopped.
    pub stopped: u64,
    /// Suspends, and times that the program stood still.
    pub gaps: u64,
    /// Keys heard from the hand controller.
    pub presses: u64,
}

/// How the terminal shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct View {
    /// Which screen.
    pub screen: Screen,
    /// The line under the bar, or the number of lines scrolled.
    pub bar: usize,
    /// 1 to 10.
    pub brightness: u8,
}

/// How the picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlay {
    /// Over, beside, off.
    pub mode: Mode,
    /// 1 to 10.
    pub brightness: u8,
    /// Whether photographs are drawn.
    pub photographs: bool,
    /// Whether words are drawn.
    pub facts: bool,
    /// Whether the object's animation is played.
    pub animation: bool,
    /// The operator, and how bright picture and words are beside the object's own light.
    pub tone: Toning,
}

/// All that the session knows.
#[derive(Debug, Clone)]
pub struct Model {
    /// What it was opened with.
    pub opening: Opening,
    /// Time.
    pub time: Time,
    /// What is believed of the mount.
    pub belief: Belief,
    /// The last position that safety judged.
    pub fix: Option<Fix>,
    /// The turns of the azimuth axis.
    pub turns: TurnCounter,
    /// The words that weaken the Sun rule, typed in this session.
    pub acknowledged: Option<Acknowledgement>,
    /// Where the telescope points.
    pub here: Option<Here>,
    /// The observer's correction.
    pub nudge: Nudge,
    /// Whether it was told that the field turns fast, so near to the zenith.
    pub turning_told: bool,
    /// The target.
    pub target: Option<Object>,
    /// What is in the field.
    pub field: Vec<Listed>,
    /// Pairs of stars to align on, as proposed when the screen was opened.
    pub pairs: Vec<Pair>,
    /// Telescope, eyepieces, projector.
    pub instrument: Instrument,
    /// The search box.
    pub search: Search,
    /// How the picture is drawn.
    pub overlay: Overlay,
    /// The menu in the eyepiece, while it is open.
    pub menu: Option<Menu>,
    /// How long the animation has been played: it stands while nothing is drawn.
    pub played: Duration,
    /// What the projector does.
    pub projector: Projector,
    /// What was drawn last, while it is shown.
    pub drawn: Option<Scene>,
    /// Where the bodies of the solar system are, remembered from picture to picture.
    pub almanac: Almanac,
    /// The picture that is shown.
    pub picture: Option<Arc<Picture>>,
    /// Whose the photographs in it are and on which terms they are shown, the finest first.
    pub credits: Vec<String>,
    /// The observer's eye.
    pub eye: Adapting,
    /// The message at the top.
    pub banner: Option<Banner>,
    /// What has happened.
    pub log: Log,
    /// How the terminal shows it.
    pub view: View,
    /// What was counted.
    pub counts: Counts,
}

impl Model {
    /// A session that knows nothing yet but what it was opened with.
    #[must_use]
    pub fn new(opening: Opening) -> Model {
        Model {
            time: Time::default(),
            belief: Belief::default(),
            fix: None,
            turns: opening.turns,
            acknowledged: None,
            here: None,
            nudge: opening.nudge,
            turning_told: false,
            target: None,
            field: Vec::new(),
            pairs: Vec::new(),
            instrument: opening.instrument.clone(),
            search: Search::default(),
            overlay: Overlay {
                mode: Mode::Over,
                brightness: opening.observer.brightness(),
                photographs: true,
                facts: true,
                animation: false,
                tone: opening.observer.tone,
            },
            menu: None,
            played: Duration::ZERO,
            projector: Projector::Dark("no position yet"),
            drawn: None,
            almanac: Almanac::default(),
            picture: None,
            credits: Vec::new(),
            eye: Adapting::default(),
            banner: None,
            log: Log::default(),
            view: View { screen: Screen::Sky, bar: 0, brightness: 6 },
            counts: Counts::default(),
            opening,
        }
    }

    /// The site that is used: what the comparison with the mount decided, else ours.
    #[must_use]
    pub fn site(&self) -> Option<Site> {
        self.belief.decision.as_ref().and_then(|decision| decision.site).or(self.opening.site)
    }

    /// The moment, if any clock can be believed.
    #[must_use]
    pub fn moment(&self) -> Option<Moment> {
        self.time.used.trusted().ok().map(Moment::at)
    }

    /// The instant that the log and the clock on the screen show.
    #[must_use]
    pub fn utc(&self) -> Utc {
        self.time.used.trusted().ok().or(self.time.ours).unwrap_or(Utc(0.0))
    }

    /// Where the target is now on the mount's sky.
    #[must_use]
    pub fn target_of_date(&self) -> Option<Equatorial<OfDate>> {
        let (target, moment) = (self.target.as_ref()?, self.moment()?);
        Some(crate::sky::astrometry::apparent(&target.astrometry, &moment))
    }

    /// Which of the animations belongs to the target, or else to something in the field.
    #[must_use]
    pub fn animation(&self) -> Option<usize> {
        let of = |name: &str| self.opening.animations.iter().position(|playable| playable.object == name);
        match &self.target {
            Some(target) => of(&target.name),
            None => self.field.iter().find_map(|listed| of(&listed.name)),
        }
    }

    /// The animation that is played now, and its frame.
    #[must_use]
    pub fn playing(&self) -> Option<(usize, usize)> {
        let index = self.animation().filter(|_| self.overlay.animation)?;
        Some((index, self.opening.animations.get(index)?.frame_at(self.played)))
    }

    /// The name of the object in the field that would be the next target; the list is nearest first.
    #[must_use]
    pub fn next_in_field(&self) -> Option<&str> {
        let names: Vec<&str> =
            self.field.iter().filter(|listed| listed.choosable).map(|listed| listed.name.as_str()).collect();
        let current = self.target.as_ref().and_then(|target| names.iter().position(|name| *name == target.name));
        let next = current.map_or(0, |place| place + 1);
        names.get(next).or(names.first()).copied()
    }

    /// How bright picture and words are, and what that is beside the target's own light.
    #[must_use]
    pub fn lights(&self) -> Lights {
        let observer = &self.opening.observer;
        let style = Style {
            tone: self.overlay.tone,
            display: observer.display.dimmed(f64::from(self.overlay.brightness) / 10.0),
            ..Style::default()
        };
        Lights::of(self.target.as_ref(), &self.instrument, &observer.eye, &style)
    }

    /// Opens a page of the menu in the eyepiece.
    pub fn open_menu(&mut self, page: Page) {
        self.menu = Some(Menu::open(page, self.time.now));
    }

    /// When something changes in the eyepiece without an event: the menu goes away, the next frame of an animation.
    #[must_use]
    pub fn wake_at(&self) -> Option<Duration> {
        let frame = self.playing().filter(|_| self.drawn.is_some());
        let frame = frame.and_then(|(index, _)| self.opening.animations.get(index));
        let frame = frame.map(|playable| self.time.now + playable.until_next(self.played));
        self.menu.as_ref().map(|menu| menu.until).into_iter().chain(frame).min()
    }

    /// Whether the picture was pushed.
    #[must_use]
    pub fn nudged(&self) -> bool {
        self.nudge != Nudge::default()
    }
}
