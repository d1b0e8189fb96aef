//! The hand controller: what its two lines show (`:ED#`), and what its keys do (`:EK`).

mod menu;

pub(super) use self::menu::messier_position;

use self::menu::Inside;
use super::answer::Answer;

/// A line of the display.
const WIDTH: usize = 16;
/// Columns of the cursor end here in the status byte.
const LAST_COLUMN: usize = 15;

/// What a key asks the controller to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wish {
    /// Nothing but another picture on the display.
    Nothing,
    /// Slew to a Messier object.
    Messier(usize),
    /// One of the speeds 1 to 9.
    Speed(u8),
    /// The question about daylight saving was answered.
    Daylight,
}

/// What the display is about.
#[derive(Debug, Clone, PartialEq)]
enum Page {
    /// The chosen item of each level of the menu.
    Menu(Vec<usize>),
    /// Digits of a Messier number.
    Number(String),
    /// A Messier object.
    Found(usize),
    /// Right ascension and declination of the telescope.
    Position,
    /// Help text, and where MODE leads back to.
    Help(Box<Page>),
    /// The question after the start.
    Daylight,
    /// Two lines.
    Says(String, String),
}

/// The hand controller.
#[derive(Debug)]
pub(super) struct Handset {
    page: Page,
}

impl Default for Handset {
    fn default() -> Handset {
        Handset { page: Page::Menu(vec![0]) }
    }
}

/// The scrolling help text: all of it comes in one reply.
const HELP: &str = "This menu holds the objects of the library: Solar System, constellations, deep-sky objects, stars, \
    satellites, user objects and landmarks. Use the scroll keys to choose one, ENTER to open it, MODE to go back and GOTO \
    to slew to it. The telescope must be aligned first. Never look at the Sun through the telescope or its finder. \
    Scroll faster with the scroll keys; press MODE to leave this help.";

impl Handset {
    /// Back to the first menu.
    pub(super) fn home(&mut self) {
        *self = Handset::default();
    }

    /// Shows two lines.
    pub(super) fn say(&mut self, top: &str, bottom: &str) {
        self.page = Page::Says(top.to_owned(), bottom.to_owned());
    }

    /// The question after the start.
    pub(super) fn ask_daylight(&mut self) {
        self.page = Page::Daylight;
    }

    /// `:ED#`: status byte, 16 characters, the rest, `#`.
    ///
    /// Status: bit 7 always; bit 6 the cursor shows; bit 4 its row; bits 0 to 3 its column, 15 at most.
    pub(super) fn display(&self, ra: &str, dec: &[u8]) -> Answer {
        let (top, bottom, entry): (Vec<u8>, Vec<u8>, bool) = match &self.page {
            Page::Menu(path) => {
                let (title, item) = menu::titles(path);
                (format!("{title}:").into_bytes(), format!(" {item}").into_bytes(), false)
            }
            Page::Number(digits) => (b"Messier Object:".to_vec(), digits.clone().into_bytes(), true),
            Page::Found(number) => {
                (format!("Messier {number}").into_bytes(), menu::facts(*number).as_bytes().to_vec(), false)
            }
            Page::Position => (format!("RA:  {ra}").into_bytes(), [b"Dec: ", dec].concat(), false),
            Page::Help(_) => (b"Help:".to_vec(), HELP.into(), false),
            Page::Daylight => (b"Daylight Savings".to_vec(), b"1-Yes 2-No".to_vec(), false),
            Page::Says(top, bottom) => (top.clone().into_bytes(), bottom.clone().into_bytes(), false),
        };
        let on_bottom = entry || !bottom.is_empty();
        let column = if on_bottom { bottom.len() } else { top.len() }.min(LAST_COLUMN) as u8;
        let status = 0x80 | if entry { 0x40 } else { 0 } | if on_bottom { 0x10 } else { 0 } | column;
        let mut bytes = vec![status];
        bytes.extend(padded(top));
        bytes.extend(padded(bottom));
        bytes.push(b'#');
        Answer::bytes(bytes)
    }

    /// One key, by its code in `:EK`.
    pub(super) fn press(&mut self, code: u8) -> Wish {
        let page = std::mem::replace(&mut self.page, Page::Menu(vec![0]));
        let (page, wish) = next(page, code);
        self.page = page;
        wish
    }

    /// `:EQ n#`: a node of the menu as `next enter text`, addresses as the firmware has them.
    pub(super) fn query(&self, address: usize) -> Option<Answer> {
        menu::node(address).map(|text| Answer::text(&text))
    }

    /// `:ES n#`: opens a node of the menu.
    pub(super) fn jump(&mut self, address: usize) {
        if let Some(path) = menu::path(address) {
            self.page = Page::Menu(path);
        }
    }
}

/// The page after a key, and what the key asks for.
fn next(page: Page, code: u8) -> (Page, Wish) {
    match (page, code) {
        (Page::Help(back), 9) => (*back, Wish::Nothing),
        (Page::Help(back), _) => (Page::Help(back), Wish::Nothing),
        (page, b'?') => (Page::Help(Box::new(page)), Wish::Nothing),
        (Page::Daylight, b'1' | b'2' | 13) => (Page::Menu(vec![0]), Wish::Daylight),
        (Page::Daylight, _) => (Page::Daylight, Wish::Nothing),
        (_, 11) => (Page::Position, Wish::Nothing),
        (Page::Menu(path), code) => menu_key(path, code),
        (Page::Number(_), 9) => (Page::Menu(menu::messier()), Wish::Nothing),
        (Page::Number(mut digits), b'0'..=b'9') => {
            if digits.len() < 3 {
                digits.push(char::from(code));
            }
            (Page::Number(digits), Wish::Nothing)
        }
        (Page::Number(digits), 13) => match digits.parse() {
            Ok(number @ 1..=110) => (Page::Found(number), Wish::Nothing),
            _ => (Page::Number(String::new()), Wish::Nothing),
        },
        (Page::Found(number), 24 | 71) => (Page::Found(number), Wish::Messier(number)),
        (Page::Found(_), 9) => (Page::Number(String::new()), Wish::Nothing),
        (Page::Position | Page::Says(..), 9) => (Page::Menu(vec![0]), Wish::Nothing),
        (page, _) => (page, Wish::Nothing),
    }
}

fn menu_key(mut path: Vec<usize>, code: u8) -> (Page, Wish) {
    let (items, chosen) = menu::level(&path);
    match code {
        b'U' | b'^' => turn(&mut path, (chosen + items.len() - 1) % items.len()),
        b'D' | b'v' => turn(&mut path, (chosen + 1) % items.len()),
        13 | b'E' => match items[chosen].inside {
            Inside::Items(_) => path.push(0),
            Inside::Messier => return (Page::Number(String::new()), Wish::Nothing),
            Inside::Text(text) => return (Page::Says(items[chosen].text.to_owned(), text.to_owned()), Wish::Nothing),
        },
        9 | b'W' if path.len() > 1 => {
            path.pop();
        }
        b'1'..=b'9' => return (Page::Menu(path), Wish::Speed(code - b'0')),
        _ => {}
    }
    (Page::Menu(path), Wish::Nothing)
}

fn turn(path: &mut [usize], chosen: usize) {
    if let Some(last) = path.last_mut() {
        *last = chosen;
    }
}

fn padded(mut line: Vec<u8>) -> Vec<u8> {
    while line.len() < WIDTH {
        line.push(b' ');
    }
    line
}
