//! A flight through a nebula: where one is, what the keys change, and the screen.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use super::preview::Preview;
use super::theme::{Level, Theme};
use crate::app::key::{Arrow, Key};
use crate::picture::Picture;

/// A turn of one key press, radians.
const TURN: f64 = 0.08;
/// Nearer and further by one key press.
const NEARER: f64 = 1.08;

/// Where one flies and with what settings; pure, so that a test can fly.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// About the vertical, radians.
    pub turn: f64,
    /// Above the horizontal, radians.
    pub height: f64,
    /// From the middle of the box, in its longest edges; the eye looks at the middle, past it when nearer than nothing.
    pub distance: f64,
    /// Whether it turns by itself.
    pub turning: bool,
    /// Share of the extinction that is scattering.
    pub albedo: f64,
    /// Mean cosine of the angle that grains turn light through.
    pub asymmetry: f64,
    /// Times the extinction of the scene.
    pub depth: f64,
    /// Times the brightness of the picture.
    pub exposure: f64,
    /// Times the light of each star.
    pub stars: Vec<f64>,
    /// How far each star has been moved, in edges of the box: right, up, towards +z.
    pub moved: Vec<[f64; 3]>,
    /// The star that keys change.
    pub star: usize,
    /// 0 is the finest.
    pub quality: usize,
    /// A fisheye instead of a window.
    pub dome: bool,
    /// Whether the keys are explained.
    pub help: bool,
}

/// What a key did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Did {
    /// Nothing.
    Nothing,
    /// The eye moved, or the picture is shown otherwise.
    Moved,
    /// The dust or the stars' light changed.
    Scene,
    /// The flight is over.
    Left,
}

impl Flight {
    /// A flight that begins outside.
    #[must_use]
    pub fn new(albedo: f64, asymmetry: f64, stars: usize) -> Flight {
        Flight {
            turn: 0.5,
            height: 0.25,
            distance: 1.4,
            turning: false,
            albedo,
            asymmetry,
            depth: 1.0,
            exposure: 1.0,
            stars: vec![1.0; stars],
            moved: vec![[0.0; 3]; stars],
            star: 0,
            quality: 0,
            dome: false,
            help: false,
        }
    }

    /// Time passes: seconds.
    pub fn wait(&mut self, seconds: f64) {
        if self.turning {
            self.turn += 0.3 * seconds.min(0.5);
        }
    }

    /// A key was pressed.
    pub fn press(&mut self, key: Key) -> Did {
        match key {
            Key::Char('q') | Key::Esc | Key::Ctrl('c') => Did::Left,
            Key::Arrow(Arrow::Left) => self.go(|flight| flight.turn -= TURN),
            Key::Arrow(Arrow::Right) => self.go(|flight| flight.turn += TURN),
            Key::Arrow(Arrow::Up) => self.go(|flight| flight.height = (flight.height + TURN).min(1.5)),
            Key::Arrow(Arrow::Down) => self.go(|flight| flight.height = (flight.height - TURN).max(-1.5)),
            Key::Char('+' | 'w') | Key::PageUp => {
                self.go(|flight| flight.distance = (flight.distance / NEARER).max(0.01))
            }
            Key::Char('-' | 's') | Key::PageDown => {
                self.go(|flight| flight.distance = (flight.distance * NEARER).min(20.0))
            }
            Key::Char(' ') => self.go(|flight| flight.turning = !flight.turning),
            Key::Char('v') => self.go(|flight| flight.dome = !flight.dome),
            Key::Char('?') => self.go(|flight| flight.help = !flight.help),
            Key::Char('b') => self.go(|flight| flight.exposure *= 1.25),
            Key::Char('B') => self.go(|flight| flight.exposure /= 1.25),
            Key::Char(digit @ '1'..='4') => self.go(|flight| flight.quality = digit as usize - '1' as usize),
            Key::Char('a') => self.change(|flight| flight.albedo = (flight.albedo + 0.05).min(1.0)),
            Key::Char('A') => self.change(|flight| flight.albedo = (flight.albedo - 0.05).max(0.0)),
            Key::Char('g') => self.change(|flight| flight.asymmetry = (flight.asymmetry + 0.05).min(0.95)),
            Key::Char('G') => self.change(|flight| flight.asymmetry = (flight.asymmetry - 0.05).max(-0.95)),
            Key::Char('e') => self.change(|flight| flight.depth = (flight.depth * 1.15).min(1e4)),
            Key::Char('E') => self.change(|flight| flight.depth = (flight.depth / 1.15).max(1e-4)),
            Key::Tab if !self.stars.is_empty() => {
                self.go(|flight| flight.star = (flight.star + 1) % flight.stars.len())
            }
            Key::Char('>') => self.shine(1.25),
            Key::Char('<') => self.shine(0.8),
            Key::Shifted(Arrow::Left) => self.push(0, -0.02),
            Key::Shifted(Arrow::Right) => self.push(0, 0.02),
            Key::Shifted(Arrow::Up) => self.push(1, 0.02),
            Key::Shifted(Arrow::Down) => self.push(1, -0.02),
            _ => Did::Nothing,
        }
    }

    fn go(&mut self, how: impl FnOnce(&mut Flight)) -> Did {
        how(self);
        Did::Moved
    }

    fn change(&mut self, how: impl FnOnce(&mut Flight)) -> Did {
        how(self);
        Did::Scene
    }

    fn shine(&mut self, times: f64) -> Did {
        let Some(light) = self.stars.get_mut(self.star) else { return Did::Nothing };
        *light = (*light * times).clamp(1e-6, 1e6);
        Did::Scene
    }

    fn push(&mut self, axis: usize, by: f64) -> Did {
        let Some(moved) = self.moved.get_mut(self.star) else { return Did::Nothing };
        moved[axis] += by;
        Did::Scene
    }
}

/// What stands beside the picture.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Told {
    /// Frames a second.
    pub rate: f64,
    /// How fine the frames are, in a word.
    pub quality: String,
    /// What else is to be known: the believed error, what is still being computed.
    pub note: String,
}

/// Draws the flight.
pub fn draw(frame: &mut Frame<'_>, flight: &Flight, picture: &Picture, told: &Told, theme: &Theme) {
    let [top, middle, bottom] =
        Layout::vertical([Constraint::Length(1), Constraint::Min(1), Constraint::Length(2)]).areas(frame.area());
    let area = frame.area();
    frame.buffer_mut().set_style(area, theme.text(Level::Normal));
    let star = match flight.stars.get(flight.star) {
        Some(light) => format!("star {} of {} x {light:.2}", flight.star + 1, flight.stars.len()),
        None => "no stars".to_owned(),
    };
    let head = format!(
        "{:5.1} frames/s  {}  albedo {:.2}  g {:.2}  extinction x {:.2}  {star}",
        told.rate, told.quality, flight.albedo, flight.asymmetry, flight.depth
    );
    frame.render_widget(Paragraph::new(Line::styled(head, theme.text(Level::Normal))), top);
    frame.render_widget(Preview { picture, theme }, middle);
    let keys = if flight.help {
        "arrows orbit  + - in, out  space turn  v dome  b B brighter, darker  1-4 finer, faster\n\
         a A albedo  g G asymmetry  e E extinction  Tab next star  > < its light  shift+arrows move it  q leave"
            .to_owned()
    } else {
        format!("{}\n? keys  q leave", told.note)
    };
    frame.render_widget(Paragraph::new(keys).style(theme.text(Level::Dim)), bottom);
}

#[cfg(test)]
mod tests {
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    use super::*;
    use crate::tui::theme::{Depth, is_red};

    #[test]
    fn keys_orbit_go_in_and_change_the_dust() {
        let mut flight = Flight::new(0.6, 0.6, 2);
        assert_eq!(flight.press(Key::Arrow(Arrow::Right)), Did::Moved);
        assert!(flight.turn > 0.5);
        for _ in 0..100 {
            flight.press(Key::Char('+'));
        }
        assert!((flight.distance - 0.01).abs() < 1e-9);
        assert_eq!(flight.press(Key::Char('a')), Did::Scene);
        assert!((flight.albedo - 0.65).abs() < 1e-12);
        flight.press(Key::Tab);
        assert_eq!(flight.press(Key::Char('>')), Did::Scene);
        assert_eq!(flight.stars, [1.0, 1.25]);
        assert_eq!(flight.press(Key::Char('q')), Did::Left);
        assert_eq!(Flight::new(0.6, 0.6, 0).press(Key::Char('>')), Did::Nothing);
    }

    #[test]
    fn the_screen_is_red_and_shows_frames_a_second() {
        let mut terminal = Terminal::new(TestBackend::new(90, 20)).unwrap();
        let mut picture = Picture::black(40, 40);
        picture.row_mut(20)[20] = [0.9; 3];
        let told = Told { rate: 17.25, quality: "full".into(), note: "ok".into() };
        let theme = Theme::new(Depth::True, 10);
        terminal.draw(|frame| draw(frame, &Flight::new(0.6, 0.6, 1), &picture, &told, &theme)).unwrap();
        let buffer = terminal.backend().buffer();
        let text: String = buffer.content.iter().map(ratatui::buffer::Cell::symbol).collect();
        assert!(text.contains(" 17.2 frames/s") && text.contains("star 1 of 1"), "{text}");
        assert!(buffer.content.iter().all(|cell| is_red(cell.fg) && is_red(cell.bg)));
    }
}
