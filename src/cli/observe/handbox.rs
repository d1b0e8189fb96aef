//! The hand controller of a session: its source is opened beside the mount, in a thread of its own that wakes the loop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::app::bindings::Bindings;
use crate::app::commands::Action;
use crate::cli::Failure;
use crate::cli::handbox::map;
use crate::cli::settings::handbox::Handbox as Settings;
use crate::hw::handbox::presenter::{self, Buttons};
use crate::hw::handbox::source::Source;
use crate::hw::handbox::tap::{self, Tap, TapSaid};
use crate::hw::handbox::{Decoder, Heard, KeyMap, Pressed, watch};
use crate::hw::mount::address::MountAddress;

/// The key map whose bindings count while there is no hand controller: that of the mount this program is made for.
const USUAL: &str = "autostar2-guess";
/// Of a presenter or gamepad.
const PRESENTER: &str = "presenter";
/// A listener that has not shown itself for so long is taken for dead. A lost port shows itself too.
const PATIENCE: Duration = Duration::from_secs(3);
/// A line that is lost again and again is told of so often at most.
const TELL_AGAIN: Duration = Duration::from_secs(60);

/// The hand controller, ready to be listened to.
pub(super) struct Handbox {
    listener: Listener,
    /// What its keys mean.
    pub(super) bindings: Bindings,
    /// What the observer should know at the start.
    pub(super) notices: Vec<String>,
}

enum Listener {
    Nobody,
    Tap(String, Box<Decoder>),
    Evdev(String, Vec<String>),
    Display,
}

/// What the hand controller tells the session.
pub(super) enum Told {
    /// A key was pressed.
    Pressed(Pressed),
    /// Something that the observer should know.
    Notice(String),
}

/// The listener at work.
pub(super) struct Listening {
    stop: Arc<AtomicBool>,
    /// Milliseconds since the start when it showed itself last; nothing when there is no thread.
    shown: Option<Arc<AtomicU64>>,
    /// What reads the display, when that is the source.
    pub(super) watch: Option<DisplayWatch>,
}

/// The display, read over the mount's line.
pub(super) struct DisplayWatch {
    watch: watch::Watch,
    next: Duration,
    seen_at: Option<Duration>,
}

/// Prepares what the command line and the settings name.
///
/// # Errors
/// The source is the mount's own port; the key map cannot be used; a key is bound that the map does not have.
pub(super) fn prepare(
    source: Option<&Source>,
    map: Option<&str>,
    settings: &Settings,
    mount: &MountAddress,
) -> Result<Handbox, Failure> {
    let Some(source) = source.or(settings.source.as_ref()) else {
        let bindings = settings.bindings(USUAL).map_err(Failure::asked)?;
        return Ok(Handbox { listener: Listener::Nobody, bindings, notices: Vec::new() });
    };
    let name = map.or(settings.map.as_deref());
    match source {
        Source::Tap { path } => {
            tap::refuse_mounts_port(path, mount).map_err(Failure::asked)?;
            let map = map::load(name)?;
            let bindings = settings.bindings(map.name()).map_err(Failure::asked)?;
            known(&bindings, settings, &map)?;
            let notices = notices(&bindings, &map);
            let long = bindings.all().filter(|(press, _)| press.long).map(|(press, _)| press.key.clone());
            let decoder = Decoder::new(map).with_long(long.collect::<Vec<_>>());
            Ok(Handbox { listener: Listener::Tap(path.clone(), Box::new(decoder)), bindings, notices })
        }
        Source::Evdev { path } => {
            let bindings = settings.bindings(PRESENTER).map_err(Failure::asked)?;
            let long = bindings.all().filter(|(press, _)| press.long).map(|(press, _)| press.key.clone()).collect();
            Ok(Handbox { listener: Listener::Evdev(path.clone(), long), bindings, notices: Vec::new() })
        }
        Source::Display => {
            let bindings = settings.bindings("display").map_err(Failure::asked)?;
            let mut notices = vec![PATCHED.to_owned()];
            notices.push(
                "the hand controller's keys are read from its display: only ? is heard, and MODE must close its help"
                    .into(),
            );
            Ok(Handbox { listener: Listener::Display, bindings, notices })
        }
    }
}

/// The warning about firmware on which `?` is a sync.
const PATCHED: &str = "if the mount's firmware is patched (StarPatch, the 4.2g kits), ? may be a SYNC there and spoil the \
                       alignment: try it once on a star, or give another key in [handbox.keys]";

fn notices(bindings: &Bindings, map: &KeyMap) -> Vec<String> {
    let mut notices = Vec::new();
    if map.is_guess() {
        notices.push(format!(
            "the key map {} is a guess that nobody has measured: teach it your cable with `scotopic handbox learn`",
            map.name()
        ));
    }
    if bindings.all().any(|(press, _)| press.key == "?") && map.keys().iter().any(|key| key.name == "?") {
        notices.push(PATCHED.to_owned());
    }
    let deaf = bindings.all().find(|(press, _)| press.long && !map.can_be_long(&press.key));
    if let Some((press, name)) = deaf {
        notices.push(format!(
            "'{}' ({name}) cannot be heard: the key sends nothing when it is let go; bind the command to another key",
            press.words()
        ));
    }
    if bindings.words(Action::Menu).is_none() {
        notices.push("no key opens the menu in the eyepiece: bind one to 'menu' in [handbox.keys]".into());
    }
    notices
}

/// Keys that the settings name must be keys of the map.
fn known(bindings: &Bindings, settings: &Settings, map: &KeyMap) -> Result<(), Failure> {
    let has = |key: &str| map.keys().iter().any(|known| known.name == key);
    let stranger = bindings.all().map(|(press, _)| press).find(|press| {
        let written = if press.long { format!("{}~", press.key) } else { press.key.clone() };
        settings.keys.contains_key(&written) && !has(&press.key)
    });
    match stranger {
        None => Ok(()),
        Some(press) => {
            let keys: Vec<&str> = map.keys().iter().map(|key| key.name.as_str()).collect();
            Err(Failure::Asked(format!(
                "[handbox.keys] names the key '{}', which the key map {} does not have: its keys are {}",
                press.key,
                map.name(),
                keys.join(", ")
            )))
        }
    }
}

impl Handbox {
    /// Begins to listen; `told` is called from the listener's thread and wakes the session.
    ///
    /// # Errors
    /// The system has no more threads.
    pub(super) fn listen(
        self,
        start: Instant,
        mut told: impl FnMut(Told) -> bool + Send + 'static,
    ) -> std::io::Result<Listening> {
        let stop = Arc::new(AtomicBool::new(false));
        let shown = Arc::new(AtomicU64::new(millis(start.elapsed())));
        let mut heard = Ears::new(self.listener.name(), start, Arc::clone(&shown));
        let stopped = Arc::clone(&stop);
        let thread = thread::Builder::new().name("handbox".into());
        let watch = match self.listener {
            Listener::Nobody => return Ok(Listening { stop, shown: None, watch: None }),
            Listener::Display => {
                let watch = DisplayWatch { watch: watch::Watch::default(), next: Duration::ZERO, seen_at: None };
                return Ok(Listening { stop, shown: None, watch: Some(watch) });
            }
            Listener::Tap(path, decoder) => {
                thread.spawn(move || {
                    Tap::run(&path, *decoder, start, &stopped, |said| heard.said(said).into_iter().all(&mut told));
                })?;
                None
            }
            Listener::Evdev(path, long) => {
                thread.spawn(move || {
                    let buttons = Buttons::with_long(long);
                    presenter::run(&path, buttons, start, &stopped, |said| heard.said(said).into_iter().all(&mut told));
                })?;
                None
            }
        };
        Ok(Listening { stop, shown: Some(shown), watch })
    }
}

impl Listener {
    fn name(&self) -> String {
        match self {
            Listener::Nobody => String::new(),
            Listener::Tap(path, _) | Listener::Evdev(path, _) => path.clone(),
            Listener::Display => "the display".into(),
        }
    }
}

impl Listening {
    /// Whether the listener's thread shows itself; a lost port is no death.
    pub(super) fn alive(&self, now: Duration) -> bool {
        self.shown
            .as_ref()
            .is_none_or(|shown| now.saturating_sub(Duration::from_millis(shown.load(Ordering::Relaxed))) < PATIENCE)
    }
}

impl Drop for Listening {
    /// The thread looks at this ten times a second; nobody waits for it.
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl DisplayWatch {
    /// Whether the display should be read now.
    pub(super) fn is_due(&mut self, now: Duration) -> bool {
        let due = now >= self.next;
        if due {
            self.next = now + watch::PERIOD;
        }
        due
    }

    /// When it should be read next.
    pub(super) fn wake_at(&self) -> Duration {
        self.next
    }

    /// What is believed of the display: a press, when it has just changed to help.
    pub(super) fn shown(
        &mut self,
        display: &crate::hw::mount::belief::Known<crate::hw::mount::belief::Display>,
        now: Duration,
    ) -> Option<Pressed> {
        use crate::hw::mount::belief::Known;
        let (Known::Confirmed { value, at } | Known::Assumed { value, at }) = display else {
            self.watch.reset();
            return None;
        };
        if self.seen_at.replace(*at) == Some(*at) {
            return None;
        }
        self.watch.shown(&value.top, &value.bottom, now)
    }
}

/// From what the listener says to what the session is told.
struct Ears {
    name: String,
    start: Instant,
    shown: Arc<AtomicU64>,
    lost_at: Option<Duration>,
    lost: bool,
}

impl Ears {
    fn new(name: String, start: Instant, shown: Arc<AtomicU64>) -> Ears {
        Ears { name, start, shown, lost_at: None, lost: false }
    }

    fn said(&mut self, said: TapSaid) -> Option<Told> {
        let now = self.start.elapsed();
        self.shown.store(millis(now), Ordering::Relaxed);
        match said {
            TapSaid::Heard(Heard::Pressed(pressed)) => Some(Told::Pressed(pressed)),
            TapSaid::Heard(Heard::Stuck { key, .. }) => Some(Told::Notice(format!(
                "the hand controller's key {key} is stuck or bounces: it is not heard until it has been quiet"
            ))),
            TapSaid::Opened if std::mem::take(&mut self.lost) => {
                Some(Told::Notice(format!("the hand controller is back on {}", self.name)))
            }
            TapSaid::Lost { why } => {
                self.lost = true;
                let silent = self.lost_at.is_some_and(|at| now.saturating_sub(at) < TELL_AGAIN);
                if silent {
                    return None;
                }
                self.lost_at = Some(now);
                Some(Told::Notice(format!("the hand controller is not heard: {why}")))
            }
            _ => None,
        }
    }
}

fn millis(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
