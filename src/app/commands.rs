//! The one table of commands: from it come the key map, the help screen, the hints at the bottom and `docs/keys.md`.

use super::key::{Arrow, Key};
use super::model::{Model, Screen};

/// What a command does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Action {
    /// Stop the mount, whatever it does, without a question.
    Stop,
    /// Open the search box.
    Search,
    /// Go to the target.
    Goto,
    /// Take the next object in the field as the target.
    NextObject,
    /// Use the next eyepiece.
    NextEyepiece,
    /// Use the previous eyepiece.
    PreviousEyepiece,
    /// Choose the eyepiece under the bar.
    ChooseEyepiece,
    /// Over the object, beside it, off.
    OverlayMode,
    /// The picture in the eyepiece brighter.
    OverlayBrighter,
    /// The picture in the eyepiece dimmer.
    OverlayDimmer,
    /// This screen brighter.
    ScreenBrighter,
    /// This screen dimmer.
    ScreenDimmer,
    /// Push the picture.
    Nudge(Arrow),
    /// Push the picture by a single pixel.
    NudgeFinely(Arrow),
    /// Put the picture back where the mount says.
    NudgeBack,
    /// Tell the mount that the target is in the centre.
    Sync,
    /// Give the mount our clock.
    GiveClock,
    /// Give the mount our site.
    GiveSite,
    /// Ask clock and site again.
    Compare,
    /// The cable hangs free.
    MarkUnwound,
    /// Read the hand controller's display.
    ReadDisplay,
    /// Show a screen.
    Show(Screen),
    /// Scroll a page up.
    PageUp,
    /// Scroll a page down.
    PageDown,
    /// Move the bar up, or scroll a line.
    Up,
    /// Move the bar down, or scroll a line.
    Down,
    /// Put the message away.
    Dismiss,
    /// End the session.
    Quit,
}

/// Where a command's keys mean it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Where {
    /// On every screen, and while typing in the search box.
    Always,
    /// On every screen, but not while typing.
    Everywhere,
    /// On these screens.
    On(&'static [Screen]),
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// What it does.
    pub action: Action,
    /// Its keys; the first is the one that hints show.
    pub keys: &'static [Key],
    /// A word or two.
    pub name: &'static str,
    /// A line for the help screen.
    pub help: &'static str,
    /// Where its keys mean it.
    pub at: Where,
    /// When it can be done at all.
    pub when: When,
}

/// When a command can be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum When {
    /// At any time.
    AnyTime,
    /// With a target chosen.
    WithTarget,
    /// With a message to put away.
    WithMessage,
    /// With the picture pushed.
    Nudged,
}

impl When {
    /// Whether that time is now.
    #[must_use]
    pub fn is_now(self, model: &Model) -> bool {
        match self {
            When::AnyTime => true,
            When::WithTarget => model.target.is_some(),
            When::WithMessage => model.banner.is_some(),
            When::Nudged => model.nudged(),
        }
    }
}

const SKY: Where = Where::On(&[Screen::Sky]);
const LISTS: Where = Where::On(&[Screen::Eyepieces, Screen::Mount, Screen::Align, Screen::Log, Screen::Help]);

const fn row(
    action: Action,
    keys: &'static [Key],
    name: &'static str,
    help: &'static str,
    at: Where,
    when: When,
) -> Command {
    Command { action, keys, name, help, at, when }
}

/// Every command there is.
pub const COMMANDS: &[Command] = &[
    row(
        Action::Stop,
        &[Key::Esc, Key::Ctrl('x'), Key::Char(' ')],
        "stop",
        "stop the mount, from anywhere (Space: not typing)",
        Where::Always,
        When::AnyTime,
    ),
    row(
        Action::Search,
        &[Key::Char('/')],
        "search",
        "search by name; Enter there goes to it",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(Action::Goto, &[Key::Enter], "go to", "go to the target", SKY, When::WithTarget),
    row(
        Action::NextObject,
        &[Key::Tab],
        "next object",
        "the next object in the field as the target",
        SKY,
        When::AnyTime,
    ),
    row(Action::NextEyepiece, &[Key::Char('e')], "eyepiece", "use the next eyepiece", Where::Everywhere, When::AnyTime),
    row(
        Action::PreviousEyepiece,
        &[Key::Char('w')],
        "eyepiece back",
        "use the previous eyepiece",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ChooseEyepiece,
        &[Key::Enter],
        "use it",
        "use the eyepiece under the bar",
        Where::On(&[Screen::Eyepieces]),
        When::AnyTime,
    ),
    row(
        Action::OverlayMode,
        &[Key::Char('o')],
        "overlay",
        "the picture over the object, beside it, off",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::OverlayBrighter,
        &[Key::Char('.'), Key::Char('>')],
        "brighter overlay",
        "the picture in the eyepiece brighter",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::OverlayDimmer,
        &[Key::Char(','), Key::Char('<')],
        "dimmer overlay",
        "the picture in the eyepiece dimmer",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ScreenBrighter,
        &[Key::Char('+'), Key::Char('=')],
        "brighter",
        "this screen brighter",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ScreenDimmer,
        &[Key::Char('-'), Key::Char('_')],
        "dimmer",
        "this screen dimmer",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Nudge(Arrow::Left),
        &[Key::Arrow(Arrow::Left)],
        "nudge left",
        "push the picture left; kept until the next sync",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::Nudge(Arrow::Right),
        &[Key::Arrow(Arrow::Right)],
        "nudge right",
        "push the picture right",
        SKY,
        When::AnyTime,
    ),
    row(Action::Nudge(Arrow::Up), &[Key::Arrow(Arrow::Up)], "nudge up", "push the picture up", SKY, When::AnyTime),
    row(
        Action::Nudge(Arrow::Down),
        &[Key::Arrow(Arrow::Down)],
        "nudge down",
        "push the picture down",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Left),
        &[Key::Shifted(Arrow::Left)],
        "finely left",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Right),
        &[Key::Shifted(Arrow::Right)],
        "finely right",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Up),
        &[Key::Shifted(Arrow::Up)],
        "finely up",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Down),
        &[Key::Shifted(Arrow::Down)],
        "finely down",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeBack,
        &[Key::Char('0')],
        "no nudge",
        "put the picture back where the mount says",
        SKY,
        When::Nudged,
    ),
    row(
        Action::Sync,
        &[Key::Char('S')],
        "sync",
        "tell the mount it points there; ends the nudge",
        SKY,
        When::WithTarget,
    ),
    row(
        Action::Show(Screen::Eyepieces),
        &[Key::Char('p')],
        "eyepieces",
        "the eyepieces and what each gives",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Mount),
        &[Key::Char('m')],
        "mount",
        "what is believed of the mount, and how surely",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Align),
        &[Key::Char('a')],
        "align",
        "aligning, with stars for tonight; PEC",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(Action::Show(Screen::Log), &[Key::Char('l')], "log", "what has happened", Where::Everywhere, When::AnyTime),
    row(
        Action::Show(Screen::Help),
        &[Key::Char('?'), Key::Char('h')],
        "help",
        "every key",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(Action::Show(Screen::Sky), &[Key::Char('s'), Key::Backspace], "sky", "back to the sky", LISTS, When::AnyTime),
    row(
        Action::GiveClock,
        &[Key::Char('T')],
        "give time",
        "give the mount our date and time",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::GiveSite,
        &[Key::Char('L')],
        "give site",
        "give the mount our site",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::Compare,
        &[Key::Char('r')],
        "compare",
        "read the mount's clock and site again",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::ReadDisplay,
        &[Key::Char('d')],
        "display",
        "read the hand controller's display",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::MarkUnwound,
        &[Key::Char('U')],
        "unwound",
        "the cable hangs free: count the turns anew",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(Action::Up, &[Key::Arrow(Arrow::Up), Key::Char('k')], "up", "one line up", LISTS, When::AnyTime),
    row(Action::Down, &[Key::Arrow(Arrow::Down), Key::Char('j')], "down", "one line down", LISTS, When::AnyTime),
    row(Action::PageUp, &[Key::PageUp], "page up", "a page up", LISTS, When::AnyTime),
    row(Action::PageDown, &[Key::PageDown], "page down", "a page down", LISTS, When::AnyTime),
    row(Action::Dismiss, &[Key::Backspace], "put away", "put the message at the top away", SKY, When::WithMessage),
    row(
        Action::Quit,
        &[Key::Char('q'), Key::Ctrl('c')],
        "quit",
        "end the session; a slew is stopped first",
        Where::Always,
        When::AnyTime,
    ),
];

impl Command {
    /// Whether its keys mean it on this screen.
    #[must_use]
    pub fn belongs_to(&self, screen: Screen) -> bool {
        match self.at {
            Where::Always | Where::Everywhere => true,
            Where::On(screens) => screens.contains(&screen),
        }
    }

    /// Its keys in words.
    #[must_use]
    pub fn keys_in_words(&self) -> String {
        self.keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }
}

/// What a key means now, or nothing. While typing, printable characters belong to the search box.
#[must_use]
pub fn meaning(model: &Model, key: Key) -> Option<Action> {
    let typing = model.view.screen == Screen::Search;
    COMMANDS
        .iter()
        .filter(|command| command.keys.contains(&key))
        .filter(|command| !typing || (command.at == Where::Always && !matches!(key, Key::Char(_))))
        .filter(|command| command.belongs_to(model.view.screen) && command.when.is_now(model))
        .map(|command| command.action)
        .next()
}

/// The table as Markdown, for `docs/keys.md`.
#[must_use]
pub fn markdown() -> String {
    let mut text = String::from("| key | does | where |\n| --- | --- | --- |\n");
    for command in COMMANDS {
        let place = match command.at {
            Where::Always => "everywhere, also while typing".to_owned(),
            Where::Everywhere => "everywhere".to_owned(),
            Where::On(screens) => screens.iter().map(|screen| screen.title()).collect::<Vec<_>>().join(", "),
        };
        let keys: Vec<String> = command.keys.iter().map(|key| format!("`{key}`")).collect();
        text.push_str(&format!("| {} | {} | {place} |\n", keys.join(" "), command.help));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_means_two_things_in_one_place_at_one_time() {
        for screen in Screen::ALL {
            let mut seen = std::collections::HashMap::new();
            for command in COMMANDS.iter().filter(|command| command.belongs_to(screen)) {
                for key in command.keys {
                    if let Some(other) = seen.insert((*key, command.when), command.name) {
                        panic!("{key} on {} is '{other}' and '{}'", screen.title(), command.name);
                    }
                }
            }
        }
    }

    #[test]
    fn the_page_of_keys_is_the_table() {
        let page = std::fs::read_to_string("docs/keys.md").unwrap();
        if !page.contains(&markdown()) {
            panic!("docs/keys.md differs from the table of commands; it should hold:\n{}", markdown());
        }
    }
}
