//! The one table of commands: from it come the key map, the help screen, the hints at the bottom and `docs/keys.md`.

use super::key::{Arrow, Key};
use super::menu::Page;
use super::model::{Model, Screen};
use crate::overlay::style::Mode;

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
    /// One of them.
    Overlay(Mode),
    /// Photographs in the picture, or none.
    Photographs,
    /// Words in the picture, or none.
    Facts,
    /// The object's animation, or none.
    Animation,
    /// The menu in the eyepiece.
    Menu,
    /// What the hand controller's keys do, in the eyepiece.
    EyepieceHelp,
    /// In the eyepiece's menu: the next line.
    MenuDown,
    /// In the eyepiece's menu: the line before.
    MenuUp,
    /// In the eyepiece's menu: do what the line says.
    MenuChoose,
    /// Put the eyepiece's menu away.
    MenuClose,
    /// The picture in the eyepiece brighter.
    OverlayBrighter,
    /// The picture in the eyepiece dimmer.
    OverlayDimmer,
    /// The picture brighter beside the object's own light.
    PictureBrighter,
    /// The picture dimmer beside the object's own light.
    PictureDimmer,
    /// The words brighter beside the object's own light.
    WordsBrighter,
    /// The words dimmer beside the object's own light.
    WordsDimmer,
    /// Picture and words as bright as the projector's brightness makes them.
    LightByItself,
    /// The next operator that tones the light.
    ToneMethod,
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
    /// Its name in settings.
    pub id: &'static str,
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
    /// With lines to choose from in the eyepiece.
    MenuOpen,
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
            When::MenuOpen => model.menu.as_ref().is_some_and(|menu| menu.page != Page::Eyepieces),
        }
    }
}

const SKY: Where = Where::On(&[Screen::Sky]);
const LISTS: Where = Where::On(&[Screen::Eyepieces, Screen::Mount, Screen::Align, Screen::Log, Screen::Help]);

const fn row(
    action: Action,
    id: &'static str,
    keys: &'static [Key],
    name: &'static str,
    help: &'static str,
    at: Where,
    when: When,
) -> Command {
    Command { action, id, keys, name, help, at, when }
}

/// Every command there is.
pub const COMMANDS: &[Command] = &[
    row(
        Action::Stop,
        "stop",
        &[Key::Esc, Key::Ctrl('x'), Key::Char(' ')],
        "stop",
        "stop the mount, from anywhere (Space: not typing)",
        Where::Always,
        When::AnyTime,
    ),
    row(
        Action::Search,
        "search",
        &[Key::Char('/')],
        "search",
        "search by name; Enter there goes to it",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(Action::Goto, "go-to", &[Key::Enter], "go to", "go to the target", SKY, When::WithTarget),
    row(
        Action::NextObject,
        "next-object",
        &[Key::Tab],
        "next object",
        "the next object in the field as the target",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NextEyepiece,
        "next-eyepiece",
        &[Key::Char('e')],
        "eyepiece",
        "use the next eyepiece",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::PreviousEyepiece,
        "previous-eyepiece",
        &[Key::Char('w')],
        "eyepiece back",
        "use the previous eyepiece",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ChooseEyepiece,
        "choose-eyepiece",
        &[Key::Enter],
        "use it",
        "use the eyepiece under the bar",
        Where::On(&[Screen::Eyepieces]),
        When::AnyTime,
    ),
    row(
        Action::OverlayMode,
        "overlay",
        &[Key::Char('o')],
        "overlay",
        "the picture over the object, beside it, off",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Overlay(Mode::Over),
        "overlay-over",
        &[],
        "over",
        "the picture over the object",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Overlay(Mode::Beside),
        "overlay-beside",
        &[],
        "beside",
        "the picture beside the object",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(Action::Overlay(Mode::Off), "overlay-off", &[], "off", "no picture", Where::Everywhere, When::AnyTime),
    row(
        Action::Photographs,
        "picture",
        &[Key::Char('i')],
        "photographs",
        "photographs in the picture, or none",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Facts,
        "facts",
        &[Key::Char('f')],
        "facts",
        "words in the picture, or none",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Animation,
        "animation",
        &[Key::Char('v')],
        "animation",
        "play the animation of the object, or stop it",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::OverlayBrighter,
        "brighter",
        &[Key::Char('.'), Key::Char('>')],
        "brighter overlay",
        "the picture in the eyepiece brighter",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::OverlayDimmer,
        "dimmer",
        &[Key::Char(','), Key::Char('<')],
        "dimmer overlay",
        "the picture in the eyepiece dimmer",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::PictureBrighter,
        "picture-brighter",
        &[Key::Char(']')],
        "picture up",
        "the picture brighter beside the object's own light",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::PictureDimmer,
        "picture-dimmer",
        &[Key::Char('[')],
        "picture down",
        "the picture dimmer beside the object's own light",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::WordsBrighter,
        "words-brighter",
        &[Key::Char('}')],
        "words up",
        "the words brighter; never brighter than the picture",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::WordsDimmer,
        "words-dimmer",
        &[Key::Char('{')],
        "words down",
        "the words dimmer beside the object's own light",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::LightByItself,
        "light-by-itself",
        &[Key::Char('n')],
        "plain light",
        "picture and words only by the overlay's brightness",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ToneMethod,
        "tone",
        &[Key::Char('t')],
        "tone",
        "the next operator: tr93, tr99, ward, linear",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ScreenBrighter,
        "screen-brighter",
        &[Key::Char('+'), Key::Char('=')],
        "brighter",
        "this screen brighter",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::ScreenDimmer,
        "screen-dimmer",
        &[Key::Char('-'), Key::Char('_')],
        "dimmer",
        "this screen dimmer",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Nudge(Arrow::Left),
        "nudge-left",
        &[Key::Arrow(Arrow::Left)],
        "nudge left",
        "push the picture left; kept until the next sync",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::Nudge(Arrow::Right),
        "nudge-right",
        &[Key::Arrow(Arrow::Right)],
        "nudge right",
        "push the picture right",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::Nudge(Arrow::Up),
        "nudge-up",
        &[Key::Arrow(Arrow::Up)],
        "nudge up",
        "push the picture up",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::Nudge(Arrow::Down),
        "nudge-down",
        &[Key::Arrow(Arrow::Down)],
        "nudge down",
        "push the picture down",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Left),
        "nudge-left-finely",
        &[Key::Shifted(Arrow::Left)],
        "finely left",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Right),
        "nudge-right-finely",
        &[Key::Shifted(Arrow::Right)],
        "finely right",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Up),
        "nudge-up-finely",
        &[Key::Shifted(Arrow::Up)],
        "finely up",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeFinely(Arrow::Down),
        "nudge-down-finely",
        &[Key::Shifted(Arrow::Down)],
        "finely down",
        "push the picture by one pixel",
        SKY,
        When::AnyTime,
    ),
    row(
        Action::NudgeBack,
        "nudge-back",
        &[Key::Char('0')],
        "no nudge",
        "put the picture back where the mount says",
        SKY,
        When::Nudged,
    ),
    row(
        Action::Sync,
        "sync",
        &[Key::Char('S')],
        "sync",
        "tell the mount it points there; ends the nudge",
        SKY,
        When::WithTarget,
    ),
    row(
        Action::Menu,
        "menu",
        &[Key::Char('M')],
        "menu",
        "the menu in the eyepiece; it goes away by itself",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::EyepieceHelp,
        "help",
        &[],
        "help in the eyepiece",
        "the hand controller's keys, in the eyepiece",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::MenuDown,
        "menu-down",
        &[Key::Arrow(Arrow::Down)],
        "next line",
        "the next line",
        Where::Everywhere,
        When::MenuOpen,
    ),
    row(
        Action::MenuUp,
        "menu-up",
        &[Key::Arrow(Arrow::Up)],
        "line before",
        "the line before",
        Where::Everywhere,
        When::MenuOpen,
    ),
    row(
        Action::MenuChoose,
        "menu-choose",
        &[Key::Enter],
        "choose",
        "do what the line says",
        Where::Everywhere,
        When::MenuOpen,
    ),
    row(
        Action::MenuClose,
        "menu-close",
        &[Key::Backspace],
        "close menu",
        "put the menu away",
        Where::Everywhere,
        When::MenuOpen,
    ),
    row(
        Action::Show(Screen::Eyepieces),
        "show-eyepieces",
        &[Key::Char('p')],
        "eyepieces",
        "the eyepieces and what each gives",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Mount),
        "show-mount",
        &[Key::Char('m')],
        "mount",
        "what is believed of the mount, and how surely",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Align),
        "show-align",
        &[Key::Char('a')],
        "align",
        "aligning, with stars for tonight; PEC",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Log),
        "show-log",
        &[Key::Char('l')],
        "log",
        "what has happened",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Help),
        "show-help",
        &[Key::Char('?'), Key::Char('h')],
        "help",
        "every key",
        Where::Everywhere,
        When::AnyTime,
    ),
    row(
        Action::Show(Screen::Sky),
        "show-sky",
        &[Key::Char('s'), Key::Backspace],
        "sky",
        "back to the sky",
        LISTS,
        When::AnyTime,
    ),
    row(
        Action::GiveClock,
        "give-time",
        &[Key::Char('T')],
        "give time",
        "give the mount our date and time",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::GiveSite,
        "give-site",
        &[Key::Char('L')],
        "give site",
        "give the mount our site",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::Compare,
        "compare",
        &[Key::Char('r')],
        "compare",
        "read the mount's clock and site again",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::ReadDisplay,
        "read-display",
        &[Key::Char('d')],
        "display",
        "read the hand controller's display",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(
        Action::MarkUnwound,
        "mark-unwound",
        &[Key::Char('U')],
        "unwound",
        "the cable hangs free: count the turns anew",
        Where::On(&[Screen::Mount]),
        When::AnyTime,
    ),
    row(Action::Up, "up", &[Key::Arrow(Arrow::Up), Key::Char('k')], "up", "one line up", LISTS, When::AnyTime),
    row(
        Action::Down,
        "down",
        &[Key::Arrow(Arrow::Down), Key::Char('j')],
        "down",
        "one line down",
        LISTS,
        When::AnyTime,
    ),
    row(Action::PageUp, "page-up", &[Key::PageUp], "page up", "a page up", LISTS, When::AnyTime),
    row(Action::PageDown, "page-down", &[Key::PageDown], "page down", "a page down", LISTS, When::AnyTime),
    row(
        Action::Dismiss,
        "put-away",
        &[Key::Backspace],
        "put away",
        "put the message at the top away",
        SKY,
        When::WithMessage,
    ),
    row(
        Action::Quit,
        "quit",
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

/// The command of a name in the settings.
#[must_use]
pub fn called(id: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.id == id)
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
        // The menu in the eyepiece, while it is open, comes before what a key means else.
        .min_by_key(|command| command.when != When::MenuOpen)
        .map(|command| command.action)
}

/// The table as Markdown, for `docs/keys.md`.
#[must_use]
pub fn markdown() -> String {
    let mut text = String::from("| key | does | where | name in settings |\n| --- | --- | --- | --- |\n");
    for command in COMMANDS {
        let place = match command.at {
            _ if command.when == When::MenuOpen => "the menu in the eyepiece".to_owned(),
            Where::Always => "everywhere, also while typing".to_owned(),
            Where::Everywhere => "everywhere".to_owned(),
            Where::On(screens) => screens.iter().map(|screen| screen.title()).collect::<Vec<_>>().join(", "),
        };
        let keys: Vec<String> = command.keys.iter().map(|key| format!("`{key}`")).collect();
        text.push_str(&format!("| {} | {} | {place} | `{}` |\n", keys.join(" "), command.help, command.id));
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
    fn every_command_has_a_name_of_its_own_for_settings() {
        let ids: std::collections::HashSet<_> = COMMANDS.iter().map(|command| command.id).collect();
        assert_eq!(ids.len(), COMMANDS.len());
        assert!(ids.iter().all(|id| id.chars().all(|c| c.is_ascii_lowercase() || c == '-')));
        assert_eq!(called("next-eyepiece").map(|command| command.action), Some(Action::NextEyepiece));
    }

    #[test]
    fn the_page_of_keys_is_the_table() {
        let page = std::fs::read_to_string("docs/keys.md").unwrap();
        if !page.contains(&markdown()) {
            panic!("docs/keys.md differs from the table of commands; it should hold:\n{}", markdown());
        }
    }
}
