//! What the hand controller's keys mean: a table of key to command. Nothing that moves the telescope can stand in it.

use std::collections::BTreeMap;

use super::commands::{Action, COMMANDS, called};
use super::log::printable;

/// A key of the hand controller, short or long.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Press {
    /// The key's name in its map: `?`, `ENTER`, `2`.
    pub key: String,
    /// Held rather than tapped.
    pub long: bool,
}

/// What the keys mean.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Bindings(BTreeMap<Press, Action>);

/// Why a key cannot mean that.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BindingError {
    /// No such command.
    #[error(
        "the key '{key}' of the hand controller is to mean '{id}', which is no command{near}: docs/keys.md lists them"
    )]
    Unknown {
        /// The key.
        key: String,
        /// What was written.
        id: String,
        /// `: did you mean ...?`, or nothing.
        near: String,
    },
    /// A command that a tapped key must not give.
    #[error(
        "the key '{key}' of the hand controller may not mean '{id}', since {why}: give that command from the keyboard"
    )]
    Forbidden {
        /// The key.
        key: String,
        /// The command.
        id: &'static str,
        /// Why not.
        why: &'static str,
    },
    /// A key without a name.
    #[error("a key of the hand controller without a name is to mean '{id}': write the key's name as its map has it")]
    Nameless {
        /// The command.
        id: String,
    },
}

/// Takes a key's default meaning away.
pub const NOTHING: &str = "nothing";

/// What `?` alone can do: step through the eyepieces, and with a long press the whole menu.
const QUESTION: &[(&str, &str)] = &[("?", "next-eyepiece"), ("?~", "menu")];

/// The Autostar II: its scroll keys walk the menu while it is open, and change nothing but the display otherwise.
const AUTOSTAR: &[(&str, &str)] = &[("?", "next-eyepiece"), ("?~", "menu"), ("UP", "menu-up"), ("DOWN", "menu-down")];

/// The Classic has no `?`; its two list keys do least on the mount.
const CLASSIC: &[(&str, &str)] =
    &[("NEXT", "next-eyepiece"), ("NEXT~", "menu"), ("PREV", "previous-eyepiece"), ("PREV~", "overlay")];

/// A terminal or a box of one's own: none of its keys does anything on the mount, so that each can have a command.
const ASCII: &[(&str, &str)] = &[
    ("?", "next-eyepiece"),
    ("MODE", "menu"),
    ("UP", "menu-up"),
    ("DOWN", "menu-down"),
    ("ENTER", "menu-choose"),
    ("0", "menu-close"),
    ("1", "overlay"),
    ("2", "picture"),
    ("3", "facts"),
    ("4", "animation"),
    ("5", "dimmer"),
    ("6", "brighter"),
    ("7", "next-object"),
    ("8", "help"),
    ("9", "previous-eyepiece"),
];

/// A presenter or a gamepad: two keys go through eyepieces and lines, a third opens the menu and chooses.
const PRESENTER: &[(&str, &str)] = &[
    ("DOWN", "next-eyepiece"),
    ("UP", "previous-eyepiece"),
    ("ENTER", "menu"),
    ("?", "overlay"),
    ("?~", "picture"),
    ("MODE", "menu-close"),
    ("1", "overlay"),
    ("2", "picture"),
    ("3", "facts"),
    ("4", "animation"),
    ("5", "dimmer"),
    ("6", "brighter"),
    ("7", "next-object"),
    ("8", "help"),
];

impl Press {
    /// Reads `?` or, for the long press, `?~`.
    #[must_use]
    pub fn named(text: &str) -> Press {
        match text.strip_suffix('~') {
            Some(key) if !key.is_empty() => Press { key: key.to_owned(), long: true },
            _ => Press { key: text.to_owned(), long: false },
        }
    }

    /// In words: `?`, `hold ?`.
    #[must_use]
    pub fn words(&self) -> String {
        let key = printable(&self.key);
        if self.long { format!("hold {key}") } else { key }
    }
}

impl Bindings {
    /// What the keys of a profile mean unless the settings say otherwise; of a map that is not shipped, what `?` means.
    #[must_use]
    pub fn of_profile(profile: &str) -> Bindings {
        let table = match profile {
            "lx200-classic" => CLASSIC,
            "autostar2-guess" => AUTOSTAR,
            "ascii" => ASCII,
            "presenter" => PRESENTER,
            _ => QUESTION,
        };
        let meant = table.iter().filter_map(|(key, id)| Some((Press::named(key), called(id)?.action)));
        Bindings(meant.collect())
    }

    /// The same keys with those of the settings added or changed: key to command, `nothing` to take a meaning away.
    ///
    /// # Errors
    /// A command that is not there, or one that a tapped key must not give.
    pub fn with<'a>(mut self, table: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Bindings, BindingError> {
        for (key, id) in table {
            let press = Press::named(key.trim());
            if press.key.is_empty() {
                return Err(BindingError::Nameless { id: printable(id) });
            }
            if id == NOTHING {
                self.0.remove(&press);
                continue;
            }
            let Some(command) = called(id) else {
                return Err(BindingError::Unknown { key: printable(key), id: printable(id), near: nearest(id) });
            };
            if let Some(why) = forbidden(command.action) {
                return Err(BindingError::Forbidden { key: printable(key), id: command.id, why });
            }
            self.0.insert(press, command.action);
        }
        Ok(self)
    }

    /// What a press means.
    #[must_use]
    pub fn meaning(&self, key: &str, long: bool) -> Option<Action> {
        self.0.get(&Press { key: key.to_owned(), long }).copied()
    }

    /// Whether holding a key means something of its own; else a press can be answered before the key is let go.
    #[must_use]
    pub fn long_is_meant(&self, key: &str) -> bool {
        self.meaning(key, true).is_some()
    }

    /// The first press that means something, in words.
    #[must_use]
    pub fn words(&self, action: Action) -> Option<String> {
        self.0.iter().find(|(_, meant)| **meant == action).map(|(press, _)| press.words())
    }

    /// Every press with the name of what it means.
    pub fn all(&self) -> impl Iterator<Item = (&Press, &'static str)> {
        self.0.iter().filter_map(|(press, action)| {
            COMMANDS.iter().find(|command| command.action == *action).map(|command| (press, command.name))
        })
    }

    /// Whether no key means anything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Why a tapped key must not give a command; `None` when it may. A tapped key also does what it does on the mount, and a worn
/// one repeats: nothing that moves the telescope, or changes what the mount believes, may hang on it.
fn forbidden(action: Action) -> Option<&'static str> {
    match action {
        Action::Goto => Some("it moves the telescope"),
        Action::Sync => Some("it changes where the mount believes that it points"),
        Action::GiveClock | Action::GiveSite => Some("it changes the mount's own clock or site"),
        Action::MarkUnwound => Some("only who has looked at the cable can say it"),
        Action::Search => Some("a name has to be typed"),
        _ => None,
    }
}

/// `: did you mean 'overlay'?`: the command with the most letters in common from the start.
fn nearest(id: &str) -> String {
    let common = |other: &str| id.chars().zip(other.chars()).take_while(|(a, b)| a == b).count();
    let best = COMMANDS.iter().max_by_key(|command| (common(command.id), std::cmp::Reverse(command.id.len())));
    best.filter(|command| common(command.id) >= 3)
        .map_or_else(String::new, |command| format!("; did you mean '{}'?", command.id))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROFILES: [&str; 5] = ["lx200-classic", "autostar2-guess", "ascii", "presenter", "my-own-cable"];

    #[test]
    fn every_profile_steps_through_the_eyepieces_and_opens_the_menu() {
        for profile in PROFILES {
            let bindings = Bindings::of_profile(profile);
            assert!(bindings.words(Action::NextEyepiece).is_some(), "{profile}");
            assert!(bindings.words(Action::Menu).is_some(), "{profile}");
            assert!(bindings.all().all(|(press, _)| bindings.meaning(&press.key, press.long).is_some()));
        }
        for table in [QUESTION, AUTOSTAR, CLASSIC, ASCII, PRESENTER] {
            assert_eq!(Bindings::default().with(table.iter().copied()).unwrap().0.len(), table.len());
        }
    }

    #[test]
    fn what_moves_the_telescope_is_refused_by_name() {
        for (id, why) in [("go-to", "moves the telescope"), ("sync", "believes that it points"), ("give-time", "clock")]
        {
            let error = Bindings::default().with([("7", id)]).unwrap_err().to_string();
            assert!(error.contains(&format!("'{id}'")) && error.contains(why) && error.contains("'7'"), "{error}");
        }
        assert!(Bindings::default().with([("0", "stop")]).is_ok());
    }

    #[test]
    fn a_misspelt_command_is_named_with_the_nearest() {
        let error = Bindings::default().with([("?", "next-eyepeice")]).unwrap_err().to_string();
        assert!(error.contains("did you mean 'next-eyepiece'?"), "{error}");
        let error = Bindings::default().with([("?", "\u{1b}[2Jx")]).unwrap_err().to_string();
        assert!(!error.chars().any(char::is_control));
    }

    #[test]
    fn settings_change_and_take_away() {
        let bindings = Bindings::of_profile("ascii").with([("?", "menu"), ("7", NOTHING), ("~", "facts")]).unwrap();
        assert_eq!(bindings.meaning("?", false), Some(Action::Menu));
        assert_eq!(bindings.meaning("7", false), None);
        assert_eq!(bindings.meaning("~", false), Some(Action::Facts), "a key may be called ~");
        assert!(Bindings::of_profile("autostar2-guess").long_is_meant("?") && !bindings.long_is_meant("?"));
    }
}
