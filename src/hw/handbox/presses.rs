//! Keys going down and up -> presses, as a person meant them: worn keys bounce, repeat, stick and miss.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::time::Duration;

use super::{Heard, Pressed};

/// A key that goes down again sooner after it last did is bouncing.
pub const BOUNCE: Duration = Duration::from_millis(150);
/// A key that goes down again sooner after it came up is bouncing.
pub const RELEASE_BOUNCE: Duration = Duration::from_millis(50);
/// A key that goes down again without having come up, sooner than this, repeats by itself; later, its release was missed.
pub const REPEAT: Duration = Duration::from_millis(400);
/// A key held longer than this is a long press.
pub const LONG: Duration = Duration::from_millis(800);
/// A key that goes down more often than this in a second is stuck.
pub const MOST_A_SECOND: usize = 10;
/// A stuck key is heard again after so much silence.
pub const SILENCE: Duration = Duration::from_secs(1);

const SECOND: Duration = Duration::from_secs(1);

/// One key.
#[derive(Debug, Clone, Default)]
struct State {
    /// Down since then.
    down: Option<Duration>,
    /// When it last went down by a person's hand, for a bounce that takes the hold up again.
    since: Duration,
    /// Whether this hold has been told as a press.
    told: bool,
    /// When a short press that may be a bounce will be told.
    pending: Option<Duration>,
    /// When it last went down, bounces included.
    last_press: Option<Duration>,
    last_release: Option<Duration>,
    last_long: Option<Duration>,
    /// When it went down in the last second, bounces included.
    recent: VecDeque<Duration>,
    stuck: bool,
}

/// All keys of one device.
#[derive(Debug, Clone, Default)]
pub struct Presses {
    keys: BTreeMap<String, State>,
    long: BTreeSet<String>,
}

impl Presses {
    /// Keys whose long press means something: only of these is a short press told when the key comes up.
    #[must_use]
    pub fn with_long(long: impl IntoIterator<Item = String>) -> Presses {
        Presses { keys: BTreeMap::new(), long: long.into_iter().collect() }
    }

    /// A key went down. `comes_up`: whether the device says when it comes up again.
    pub fn press(&mut self, key: &str, comes_up: bool, at: Duration, heard: &mut Vec<Heard>) {
        let long = self.long.contains(key);
        let state = self.keys.entry(key.to_owned()).or_default();
        let before = state.last_press.replace(at).map(|last| at.saturating_sub(last));
        if state.sticks(key, at, heard) {
            return;
        }
        let came_up_just_now = state.last_release.is_some_and(|last| at.saturating_sub(last) < RELEASE_BOUNCE);
        if came_up_just_now || before.is_some_and(|before| before < BOUNCE) {
            if came_up_just_now && comes_up {
                // It opened for a moment only: the hold goes on.
                (state.down, state.pending) = (Some(state.since), None);
            }
            return;
        }
        if comes_up && state.down.is_some() && before.is_some_and(|before| before < REPEAT) {
            return;
        }
        state.tell_held_back(key, at, heard);
        state.since = at;
        state.down = comes_up.then_some(at);
        state.told = !(comes_up && long);
        if state.told {
            heard.push(pressed(key, false, at));
        }
    }

    /// A key sent what it sends when it is held long.
    pub fn long(&mut self, key: &str, at: Duration, heard: &mut Vec<Heard>) {
        let state = self.keys.entry(key.to_owned()).or_default();
        let before = state.last_press.replace(at).map(|last| at.saturating_sub(last));
        if state.sticks(key, at, heard) {
            return;
        }
        let repeats = state.last_long.replace(at).is_some_and(|last| at.saturating_sub(last) < REPEAT);
        if repeats || before.is_some_and(|before| before < BOUNCE) {
            return;
        }
        (state.since, state.told, state.pending) = (at, true, None);
        state.down = state.down.or(Some(at));
        heard.push(pressed(key, true, at));
    }

    /// A key came up.
    pub fn release(&mut self, key: &str, at: Duration, heard: &mut Vec<Heard>) {
        let Some(state) = self.keys.get_mut(key) else { return };
        if state.stuck {
            state.last_release = Some(at);
            return;
        }
        // A key that is not down cannot come up: noise, which the next press must not be taken for a bounce of.
        let Some(since) = state.down.take() else { return };
        state.last_release = Some(at);
        let held = at.saturating_sub(since);
        if !state.told {
            if held >= LONG {
                heard.push(pressed(key, true, since.saturating_add(LONG)));
                state.told = true;
            } else if held < RELEASE_BOUNCE {
                // Nobody taps so fast: this may be a bounce, and the key still be down.
                state.pending = Some(at.saturating_add(RELEASE_BOUNCE));
            } else {
                heard.push(pressed(key, false, at));
                state.told = true;
            }
        }
        heard.push(Heard::Released { key: key.to_owned(), at });
    }

    /// Tells what only time decides: long presses while the key is still down, and keys that are no longer stuck.
    pub fn tick(&mut self, now: Duration, heard: &mut Vec<Heard>) {
        for (key, state) in &mut self.keys {
            if state.stuck {
                if state.quiet_at().is_none_or(|quiet| quiet <= now) {
                    *state = State::default();
                }
                continue;
            }
            if let Some(at) = state.pending.filter(|at| *at <= now) {
                state.tell_held_back(key, at, heard);
            }
            if let Some(since) = state.down.filter(|since| !state.told && now.saturating_sub(*since) >= LONG) {
                state.told = true;
                heard.push(pressed(key, true, since.saturating_add(LONG)));
            }
        }
    }

    /// When [`Presses::tick`] has something to do.
    #[must_use]
    pub fn wake_at(&self) -> Option<Duration> {
        let of = |state: &State| match state {
            state if state.stuck => state.quiet_at(),
            state => {
                let long = state.down.filter(|_| !state.told).map(|since| since.saturating_add(LONG));
                [state.pending, long].into_iter().flatten().min()
            }
        };
        self.keys.values().filter_map(of).min()
    }

    /// Forgets what is held: the line was lost, and releases with it.
    pub fn reset(&mut self) {
        self.keys.clear();
    }
}

impl State {
    /// Notes that it went down, and says whether it is stuck.
    fn sticks(&mut self, key: &str, at: Duration, heard: &mut Vec<Heard>) -> bool {
        self.recent.push_back(at);
        while self.recent.front().is_some_and(|first| at.saturating_sub(*first) >= SECOND) {
            self.recent.pop_front();
        }
        if self.recent.len() > MOST_A_SECOND {
            self.recent.clear();
            if !std::mem::replace(&mut self.stuck, true) {
                (self.down, self.pending) = (None, None);
                heard.push(Heard::Stuck { key: key.to_owned(), at });
            }
        }
        self.stuck
    }

    /// When a stuck key will have been silent long enough.
    fn quiet_at(&self) -> Option<Duration> {
        self.last_press.max(self.last_release).map(|last| last.saturating_add(SILENCE))
    }

    /// Tells the short press that was held back, and the one whose release was missed.
    fn tell_held_back(&mut self, key: &str, at: Duration, heard: &mut Vec<Heard>) {
        let untold = self.pending.take().is_some() || (self.down.is_some() && !self.told);
        if untold {
            self.told = true;
            heard.push(pressed(key, false, at));
        }
    }
}

fn pressed(key: &str, long: bool, at: Duration) -> Heard {
    Heard::Pressed(Pressed { key: key.to_owned(), long, at })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    /// What is told of downs (`true`) and ups at these milliseconds, and by one second after: `?` short, `?~` long, `!` stuck.
    fn told(long: bool, events: &[(u64, bool)]) -> Vec<(u64, &'static str)> {
        let mut presses = Presses::with_long(long.then(|| "?".to_owned()));
        let (mut heard, mut now) = (Vec::new(), 0);
        let end = events.last().map_or(0, |(at, _)| at + 1000);
        for (at, down) in events.iter().map(|(at, down)| (*at, Some(*down))).chain([(end, None)]) {
            while now <= at {
                presses.tick(ms(now), &mut heard);
                now += 5;
            }
            match down {
                Some(true) => presses.press("?", true, ms(at), &mut heard),
                Some(false) => presses.release("?", ms(at), &mut heard),
                None => {}
            }
        }
        heard
            .iter()
            .filter_map(|heard| match heard {
                Heard::Pressed(Pressed { long, at, .. }) => {
                    Some((at.as_millis() as u64, if *long { "?~" } else { "?" }))
                }
                Heard::Stuck { at, .. } => Some((at.as_millis() as u64, "!")),
                _ => None,
            })
            .collect()
    }

    #[test]
    fn a_key_without_a_long_meaning_is_told_when_it_goes_down() {
        assert_eq!(told(false, &[(100, true), (180, false)]), [(100, "?")]);
        assert_eq!(told(false, &[(100, true), (3000, false)]), [(100, "?")]);
    }

    #[test]
    fn a_key_with_a_long_meaning_is_told_when_it_comes_up_or_has_been_down_for_800_ms() {
        assert_eq!(told(true, &[(100, true), (180, false)]), [(180, "?")]);
        assert_eq!(told(true, &[(100, true), (2000, false)]), [(900, "?~")]);
    }

    #[test]
    fn a_release_out_of_nowhere_makes_no_hold_of_the_next_press() {
        // Found by fuzzing: the hold was counted from the press before, or from the program's start.
        let noise = [(100, true), (180, false), (5000, false), (5030, true), (5110, false)];
        assert_eq!(told(true, &noise), [(180, "?"), (5110, "?")]);
    }

    #[test]
    fn a_key_that_bounces_is_one_press() {
        let bouncing = [
            (100, true),
            (103, false),
            (106, true),
            (109, false),
            (112, true),
            (260, false),
            (264, true),
            (267, false),
        ];
        assert_eq!(told(false, &bouncing), [(100, "?")]);
        assert_eq!(told(true, &bouncing).len(), 1);
        let held = [(100, true), (103, false), (106, true), (1500, false), (1503, true), (1506, false)];
        assert_eq!(told(true, &held), [(900, "?~")]);
    }

    #[test]
    fn quick_taps_are_each_a_press() {
        let taps = [(0, true), (80, false), (200, true), (280, false), (400, true), (480, false)];
        assert_eq!(told(false, &taps), [(0, "?"), (200, "?"), (400, "?")]);
        assert_eq!(told(true, &taps), [(80, "?"), (280, "?"), (480, "?")]);
    }

    #[test]
    fn a_missed_release_does_not_make_the_key_deaf() {
        assert_eq!(told(false, &[(0, true), (600, true), (680, false)]), [(0, "?"), (600, "?")]);
        assert_eq!(told(true, &[(0, true), (600, true), (680, false)]), [(600, "?"), (680, "?")]);
    }

    #[test]
    fn a_held_key_that_repeats_by_itself_is_one_press() {
        let repeats: Vec<_> = (0..10).map(|n| (200 * n, true)).chain([(1900, false)]).collect();
        assert_eq!(told(false, &repeats), [(0, "?")]);
        assert_eq!(told(true, &repeats), [(800, "?~")]);
    }

    #[test]
    fn a_stuck_key_is_told_once_and_heard_again_after_a_second_of_silence() {
        let flood = |from: u64| (0..100).map(move |n| (from + 20 * n, n % 2 == 0));
        let mut events: Vec<_> = flood(0).collect();
        events.extend([(4000, true), (4080, false)]);
        let told = told(false, &events);
        assert_eq!(told.iter().filter(|(_, what)| *what == "!").count(), 1, "{told:?}");
        assert_eq!(told.last(), Some(&(4000, "?")));
        assert!(told.len() <= 3, "{told:?}");
    }
}
