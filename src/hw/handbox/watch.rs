//! The hand controller's display instead of a tapped cable: where help text appears, `?` was pressed. No soldering; works with
//! every Autostar that answers `:ED#`. An idea that nobody has tried at a telescope yet.

use std::time::Duration;

use super::Pressed;

/// The name of the key whose press can be seen.
pub const KEY: &str = "?";
/// How often the display should be read: 3 times a second.
pub const PERIOD: Duration = Duration::from_millis(333);
/// A second line with more characters than this scrolls: help, or facts of an object.
const SCROLLS: usize = 32;
/// Facts of an object are shorter than this.
const LONGEST_FACTS: usize = 200;

/// Watches what the display shows.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    /// Whether what was seen last was help.
    last: Option<bool>,
}

impl Watch {
    /// The display shows two lines now. A press of `?` when help appears where there was something else. The text that is there
    /// at first may have been there for long: it is no press.
    pub fn shown(&mut self, top: &str, bottom: &str, now: Duration) -> Option<Pressed> {
        let help = is_help(top, bottom);
        let was_help = self.last.replace(help)?;
        (help && !was_help).then(|| Pressed { key: KEY.to_owned(), long: false, at: now })
    }

    /// The link was lost: what is seen next is no news.
    pub fn reset(&mut self) {
        self.last = None;
    }

    /// Whether help is shown, which MODE closes: until then a further `?` cannot be seen.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.last == Some(true)
    }
}

/// Whether two lines are help: the first one says so and the second one scrolls, or there is far more text than facts have
/// (stroblhof-oberrohrbach.de: help may be 1000 characters).
fn is_help(top: &str, bottom: &str) -> bool {
    let length = bottom.trim_end().chars().count();
    length > LONGEST_FACTS || (length > SCROLLS && top.trim().to_lowercase().starts_with("help"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_that_appears_is_one_press_and_must_be_closed_before_the_next() {
        let mut watch = Watch::default();
        let (menu, help) =
            (("Select Item:", " Object"), ("Help:", "Use the scroll keys to choose an item, then ENTER."));
        let seen =
            [menu, help, help, menu, help].map(|(top, bottom)| watch.shown(top, bottom, Duration::ZERO).is_some());
        assert_eq!(seen, [false, true, false, false, true]);
        assert!(watch.is_open());
        watch.reset();
        assert_eq!(watch.shown(help.0, help.1, Duration::ZERO), None, "it may have been there for long");
    }

    #[test]
    fn the_scrolling_facts_of_an_object_are_no_help() {
        let mut watch = Watch::default();
        let facts = "GLOBULAR CLUSTER MAG 5.9 SIZE 16.6' HERCULES, 25100 LIGHT YEARS";
        assert_eq!(watch.shown("Select Item:", " Object", Duration::ZERO), None);
        assert_eq!(watch.shown("Messier 13", facts, Duration::ZERO), None);
        let help = "Press ENTER to choose. ".repeat(12);
        assert!(
            watch.shown("Messier Object:", &help, Duration::ZERO).is_some(),
            "so much text is help, whatever it is called"
        );
    }
}
