//! The one event loop: keys, the mount, signals and time go in; orders, pictures and the screen come out.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::alarm::{Alarm, rehearse};
use super::clock::Clock;
use super::handbox::{self, DisplayWatch, Listening};
use super::keeper::Keeper;
use super::line::{Alive, Line, Said};
use super::opening::Opened;
use super::projection::{Origin, Projection};
use super::record::Complaint;
use super::signals;
use super::summary::Summary;
use super::watchdog::Watchdog;
use crate::app::key::Key;
use crate::app::scene::Scene;
use crate::app::{Effect, Event, Model, update, words};
use crate::cli::settings::state::{KeptNudge, State};
use crate::cli::{Failure, answer_json};
use crate::hw::handbox::Pressed;
use crate::hw::mount::belief::LinkState;
use crate::hw::mount::driver::Ours;
use crate::hw::mount::link::Update;
use crate::hw::mount::order::{Order, Report};
use crate::hw::projector::output::Told;
use crate::sky::catalogue::Catalogue;
use crate::sky::pointing::Motion;
use crate::tui::terminal::Taken;
use crate::tui::theme::Depth;
use crate::tui::{self, keys};

/// Time passes in such steps while nothing happens and the field stands.
const QUIET: Duration = Duration::from_millis(250);

/// ... and in such while the field moves.
const MOVING: Duration = Duration::from_millis(50);

/// ... and in no shorter ones.
const SHORTEST: Duration = Duration::from_millis(1);

/// The screen is drawn at least so often, for the ages on it.
const REDRAW: Duration = Duration::from_millis(500);

/// A step of virtual time.
const STEP: Duration = Duration::from_millis(10);

/// At the end the mount gets so long to be seen standing still.
const LAST_STOP: Duration = Duration::from_millis(1500);

/// What wakes the loop.
enum Wake {
    Input(keys::Input),
    Mount(Box<Update>),
    Handbox(handbox::Told),
    Notice(String),
    Projector(Told),
    AskedToEnd,
    TerminalGone,
    /// A thread has panicked: which.
    Broke(&'static str),
}

/// The session at work.
struct Session {
    model: Model,
    clock: Clock,
    ours: Ours,
    line: Line,
    projection: Projection,
    keeper: Keeper,
    alive: Alive,
    handbox: Listening,
    /// Why the recording has ended, when it has.
    recording: Option<Complaint>,
    watchdog: Watchdog,
    /// Whose the photographs in the last picture are.
    credits: Vec<String>,
    /// When the key of the hand controller was heard whose doing is drawn now.
    key_at: Option<Duration>,
    screen: Option<(Taken, Depth)>,
    inbox: Receiver<Wake>,
    ended: bool,
    /// The thread that has panicked.
    broke: Option<&'static str>,
    dirty: bool,
    drawn_at: Option<Duration>,
}

/// Runs the session in the terminal.
pub(super) fn in_terminal(opened: Opened) -> Result<(), Failure> {
    let term = std::env::var("TERM").ok();
    if term.as_deref() == Some("dumb") {
        return Err(Failure::asked(
            "this terminal (TERM=dumb) cannot place text: use another, or add --headless --for SECONDS",
        ));
    }
    let depth = Depth::of(std::env::var("COLORTERM").ok().as_deref(), term.as_deref());
    let (wakes, inbox) = channel();
    let mut session = Session::new(opened, &wakes, inbox)?;
    let taken = Taken::take(depth).map_err(|error| Failure::Failed(format!("the terminal cannot be used: {error}")))?;
    session.screen = Some((taken, depth));
    let clock = session.clock;
    std::thread::Builder::new().name("keys".into()).spawn(move || listen(&wakes, clock)).map_err(Failure::failed)?;
    session.run(|_| false)?;
    Ok(())
}

/// Runs the session without a terminal, for so many seconds.
pub(super) fn without_terminal(opened: Opened, seconds: f64, targets: &[String]) -> Result<(), Failure> {
    let (wakes, inbox) = channel();
    let mut session = Session::new(opened, &wakes, inbox)?;
    let end = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    let mut targets = targets.iter();
    let mut next_at = Duration::ZERO;
    session.run(|session| {
        // Before clock and site have been compared every go-to would be refused.
        let belief = &session.model.belief;
        let idle = belief.link == LinkState::Ready && belief.decision.is_some() && session.model.here.is_some();
        let free = idle && !session.model.belief.slewing_by_order() && session.clock.now() >= next_at;
        if free && let Some(name) = targets.next() {
            session.type_and_enter(name);
            // The order is on its way, the belief is not yet back; each target is looked at for a while.
            next_at = session.clock.now() + Duration::from_secs(10);
        }
        session.clock.now() >= end
    })?;
    answer_json(&Summary::of(&session.model, &session.projection))?;
    if session.model.belief.counters.polls == 0 {
        let heard = session.model.log.lines().next_back().map(|line| line.text.clone());
        return Err(Failure::Failed(format!(
            "the mount was never heard: {}",
            heard.unwrap_or_else(|| "is it switched on, and the cable in?".to_owned())
        )));
    }
    Ok(())
}

/// Waits for keys, in a thread of its own.
fn listen(wakes: &Sender<Wake>, clock: Clock) {
    let _alarm = Alarm::new(wakes, Wake::Broke("keyboard"));
    loop {
        let wake = keys::next().map_or(Wake::TerminalGone, Wake::Input);
        rehearse("keys", clock.now());
        let gone = matches!(wake, Wake::TerminalGone);
        if wakes.send(wake).is_err() || gone {
            return;
        }
    }
}

impl Session {
    fn new(opened: Opened, wakes: &Sender<Wake>, inbox: Receiver<Wake>) -> Result<Session, Failure> {
        let Opened { mut opening, clock, ours, pump, mut projection, state_path, notices, handbox, recording } = opened;
        opening.projector = projection.describe();
        let (told, alarm) = (wakes.clone(), Alarm::new(wakes, Wake::Broke("projector")));
        let started = projection.start(clock, move |said| {
            let _held = &alarm;
            rehearse("projector", clock.now());
            drop(told.send(Wake::Projector(said)));
        });
        started.map_err(Failure::failed)?;
        let (told, alarm) = (wakes.clone(), Alarm::new(wakes, Wake::Broke("settings' file")));
        let keeper = Keeper::new(state_path, clock, move |why| {
            let _held = &alarm;
            drop(told.send(Wake::Notice(why)));
        });
        for notice in notices {
            // The inbox is at hand: it cannot be closed.
            let _ = wakes.send(Wake::Notice(notice));
        }
        let alive = Alive::default();
        // The catalogue is unpacked while the screen is already up.
        std::thread::spawn(|| drop(Catalogue::embedded().complete("M", 1)));
        let told = wakes.clone();
        signals::listen(move || drop(told.send(Wake::AskedToEnd))).map_err(Failure::failed)?;
        let (told, alarm) = (wakes.clone(), Alarm::new(wakes, Wake::Broke("hand controller")));
        let handbox = handbox.listen(clock.start(), move |said| {
            let _held = &alarm;
            rehearse("handbox", clock.now());
            told.send(Wake::Handbox(said)).is_ok()
        });
        let (told, alarm) = (wakes.clone(), Alarm::new(wakes, Wake::Broke("mount")));
        let line = match clock {
            Clock::Real { .. } => Line::threaded(pump, clock, alive.clone(), move |said| {
                let _held = &alarm;
                rehearse("mount", clock.now());
                let wake = match said {
                    Said::Update(update) => Wake::Mount(update),
                    Said::Unguarded(why) => Wake::Notice(why),
                };
                told.send(wake).is_ok()
            }),
            Clock::Virtual { .. } => Ok(Line::Stepped(Box::new(pump))),
        };
        Ok(Session {
            model: Model::new(opening),
            clock,
            ours,
            line: line.map_err(Failure::failed)?,
            projection,
            keeper: keeper.map_err(Failure::failed)?,
            alive,
            handbox: handbox.map_err(Failure::failed)?,
            recording,
            watchdog: Watchdog::new(),
            credits: Vec::new(),
            key_at: None,
            screen: None,
            inbox,
            ended: false,
            broke: None,
            dirty: true,
            drawn_at: None,
        })
    }

    /// The loop. `over` is asked after each round.
    fn run(&mut self, mut over: impl FnMut(&mut Session) -> bool) -> Result<(), Failure> {
        self.happened(Event::Clocks(self.clock.read()));
        self.draw_screen()?;
        self.watchdog.ready(self.clock.now());
        while !self.ended {
            let now = self.clock.now();
            self.alive.now(now);
            self.watchdog.turned(self.lives(now), now);
            self.watchdog.status(&format!("{}, {}", words::link(&self.model).0, words::motion(&self.model)));
            self.read_display(now);
            if let Some(why) = self.recording.as_ref().and_then(Complaint::take) {
                self.notice(why);
            }
            self.wait();
            self.happened(Event::Clocks(self.clock.read()));
            if over(self) {
                self.happened(Event::AskedToEnd);
            }
            self.draw_screen()?;
            if std::env::var_os("SCOTOPIC_TEST_PANIC").is_some_and(|after| {
                after
                    .to_str()
                    .and_then(|text| text.parse().ok())
                    .is_some_and(|s: f64| self.clock.now().as_secs_f64() > s)
            }) {
                #[expect(clippy::panic, reason = "asked for, to show that the terminal is given back")]
                {
                    panic!("SCOTOPIC_TEST_PANIC asked for it");
                }
            }
        }
        self.watchdog.stopping();
        self.projection.dark(self.clock.now());
        self.see_it_stop();
        // What the projector has said in the meantime counts.
        while let Ok(wake) = self.inbox.try_recv() {
            if let Wake::Projector(Told::Shown(stamp)) = wake {
                self.projection.stamped(&stamp);
            }
        }
        match self.broke {
            None => Ok(()),
            Some(thread) => Err(Failure::Failed(format!(
                "the part that serves the {thread} broke (its own words stand above), so the session has ended: look at the \
                 telescope, then start again"
            ))),
        }
    }

    /// Waits for the next thing to happen, and takes in all that has.
    fn wait(&mut self) {
        if let Line::Stepped(_) = self.line {
            self.step();
            return;
        }
        let moving = !matches!(self.model.belief.motion.value(), Some(Motion::Tracking));
        let longest = if moving { MOVING } else { QUIET };
        let due =
            [self.model.wake_at(), self.watchdog.wake_at(), self.handbox.watch.as_ref().map(DisplayWatch::wake_at)];
        let due = due.into_iter().flatten().min().map_or(longest, |at| at.saturating_sub(self.clock.now()));
        let mut wake = match self.inbox.recv_timeout(due.clamp(SHORTEST, longest)) {
            Ok(wake) => Some(wake),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Wake::AskedToEnd),
        };
        while let Some(now) = wake.take() {
            self.woken(now);
            wake = self.inbox.try_recv().ok();
        }
    }

    /// A quarter of a second of virtual time.
    fn step(&mut self) {
        while let Ok(wake) = self.inbox.try_recv() {
            self.woken(wake);
        }
        for _ in 0..QUIET.as_millis() / STEP.as_millis() {
            self.clock.advance(STEP);
            let now = self.clock.now();
            let Line::Stepped(pump) = &mut self.line else { return };
            if let Some(update) = pump.step(now) {
                self.happened(Event::Clocks(self.clock.read()));
                self.woken(Wake::Mount(Box::new(update)));
            }
        }
    }

    fn woken(&mut self, wake: Wake) {
        self.dirty = true;
        match wake {
            Wake::Input(keys::Input::Key(key)) => self.happened(Event::Key(key)),
            Wake::Input(keys::Input::Resized) => {}
            Wake::Mount(update) => {
                self.happened(Event::Clocks(self.clock.read()));
                self.happened(Event::Mount(Box::new(update.belief), update.reports));
                let now = self.clock.now();
                if let Some(watch) = &mut self.handbox.watch
                    && let Some(pressed) = watch.shown(&self.model.belief.display, now)
                {
                    self.pressed(pressed);
                }
            }
            Wake::Handbox(handbox::Told::Pressed(pressed)) => self.pressed(pressed),
            Wake::Handbox(handbox::Told::Notice(text)) | Wake::Notice(text) => self.notice(text),
            Wake::Projector(told) => self.projected(told),
            Wake::Broke(thread) => {
                self.broke = Some(thread);
                // As if somebody had asked: what moves is stopped before the session ends.
                self.happened(Event::AskedToEnd);
            }
            Wake::AskedToEnd | Wake::TerminalGone => self.happened(Event::AskedToEnd),
        }
    }

    /// A key of the hand controller. What it draws is timed from the instant that it was heard.
    fn pressed(&mut self, mut pressed: Pressed) {
        self.happened(Event::Clocks(self.clock.read()));
        if self.clock.is_virtual() {
            // The listener's clock is the machine's.
            pressed.at = self.clock.now();
        }
        self.key_at = Some(pressed.at).filter(|_| !self.clock.is_virtual());
        self.happened(Event::Handbox(pressed));
        self.key_at = None;
    }

    /// Without a terminal the journal is all that there is to read.
    fn notice(&mut self, text: String) {
        if self.screen.is_none() {
            crate::cli::note(&text);
        }
        self.happened(Event::Notice(text));
    }

    /// Whether all that must live lives: the projector, the line to the mount, the hand controller's listener.
    fn lives(&self, now: Duration) -> bool {
        self.projection.alive() && self.line.alive(now) && self.handbox.alive(now)
    }

    /// Reads the hand controller's display, when its keys come from there and the mount has time.
    fn read_display(&mut self, now: Duration) {
        let belief = &self.model.belief;
        let free = belief.link == LinkState::Ready && !belief.slewing_by_order() && !belief.stopping;
        if free
            && let Some(watch) = &mut self.handbox.watch
            && watch.is_due(now)
        {
            self.line.order(Order::ReadDisplay, now);
        }
    }

    /// As if a person had searched for a name and pressed Enter.
    fn type_and_enter(&mut self, name: &str) {
        let keys = [Key::Char('/')].into_iter().chain(name.chars().map(Key::Char)).chain([Key::Enter]);
        keys.for_each(|key| self.happened(Event::Key(key)));
    }

    /// An event, and what comes of it.
    fn happened(&mut self, event: Event) {
        let fresh = matches!(&event, Event::Mount(_, reports) if reports.contains(&Report::Position));
        for effect in update(&mut self.model, event) {
            self.carry_out(effect, fresh);
        }
    }

    fn carry_out(&mut self, effect: Effect, fresh: bool) {
        let now = self.clock.now();
        match effect {
            Effect::Order(order) => self.line.order(order, now),
            Effect::Draw(scene) => self.draw_picture(&scene, fresh),
            Effect::Dark => self.projection.dark(now),
            Effect::Forget => {
                self.ours.utc_at_start = self.clock.utc_at_start();
                self.line.forget(self.ours, now);
            }
            Effect::Keep(turns, nudge) => {
                self.keeper.keep(State { turns, nudge: KeptNudge::new(nudge.east, nudge.north) });
            }
            Effect::Quit => self.ended = true,
        }
    }

    fn draw_picture(&mut self, scene: &Scene, fresh: bool) {
        let now = self.clock.now();
        let age = self.model.belief.position.age(now);
        let origin = Origin {
            predicted_for: self.model.time.now,
            heard_at: age.map(|age| now.saturating_sub(age)),
            // Under a virtual clock no time passes while a picture is made.
            fresh: fresh && !self.clock.is_virtual(),
            key_at: self.key_at,
        };
        let picture = Arc::new(self.projection.compose(scene));
        self.projection.show(&picture, origin, now);
        if self.projection.credits() != self.credits {
            self.credits = self.projection.credits().to_vec();
            self.happened(Event::Photographs(self.credits.clone()));
        }
        for complaint in self.projection.complaints() {
            self.notice(complaint);
        }
    }

    /// What the projector says.
    fn projected(&mut self, told: Told) {
        match told {
            Told::Shown(stamp) => {
                if let Some(picture) = self.projection.stamped(&stamp) {
                    self.happened(Event::Shown(picture));
                }
            }
            Told::Failed(error) => {
                if self.screen.is_none() {
                    crate::cli::note(&error.to_string());
                }
                self.happened(Event::ProjectorFailed(error.to_string()));
            }
            Told::Dimmed(dimmed) => {
                if self.projection.dimmed(&dimmed)
                    && let Some(scene) = self.model.drawn.clone()
                {
                    self.draw_picture(&scene, false);
                }
                if let Some(advice) = dimmed.advice {
                    self.notice(advice);
                }
            }
            Told::Dark(_) => {}
        }
    }

    fn draw_screen(&mut self) -> Result<(), Failure> {
        let Some((taken, depth)) = &mut self.screen else { return Ok(()) };
        let now = self.clock.now();
        let due = self.drawn_at.is_none_or(|at| now.saturating_sub(at) >= REDRAW);
        if !self.dirty && !due {
            return Ok(());
        }
        self.dirty = false;
        self.drawn_at = Some(now);
        match taken.terminal.draw(|frame| tui::draw(&self.model, *depth, frame)) {
            Ok(_) => Ok(()),
            Err(_gone) if self.ended => Ok(()),
            Err(error) => Err(Failure::Failed(format!("the terminal is gone: {error}"))),
        }
    }

    /// After the end: a stop that was ordered is seen through.
    fn see_it_stop(&mut self) {
        let deadline = self.clock.now() + LAST_STOP;
        while matches!(self.line, Line::Thread(..)) && self.clock.now() < deadline {
            let belief = &self.model.belief;
            if !(belief.slewing_by_order() || belief.moving_by_order || belief.stopping) {
                return;
            }
            if let Ok(Wake::Mount(update)) = self.inbox.recv_timeout(MOVING) {
                self.model.belief = update.belief;
            }
        }
    }
}
