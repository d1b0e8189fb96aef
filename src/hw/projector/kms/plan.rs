//! The pure part of the display controller: what is asked for, and which connector, mode and scan-out that is.

use std::fmt;
use std::str::FromStr;

use crate::hw::projector::geometry::{BitField, Geometry, GeometryError, Screen};

/// What is asked for: `HDMI-A-1`, `card1/HDMI-A-1`, `DPI-1@640x360`, `HDMI-A-1@1280x720@60`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wanted {
    /// The controller, when there are several: `card1`.
    pub card: Option<String>,
    /// The connector, as the kernel names it.
    pub connector: String,
    /// Columns and rows; the display's own choice without.
    pub size: Option<(u32, u32)>,
    /// Frames a second; the first that fits without.
    pub hz: Option<u32>,
}

impl FromStr for Wanted {
    type Err = KmsError;

    fn from_str(text: &str) -> Result<Wanted, KmsError> {
        let refused = || KmsError::Name(text.chars().filter(|c| !c.is_control()).take(80).collect());
        let mut parts = text.split('@');
        let place = parts.next().unwrap_or_default();
        let (card, connector) = place.split_once('/').map_or((None, place), |(card, name)| (Some(card), name));
        let named = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
        if !named(connector) || !card.is_none_or(named) {
            return Err(refused());
        }
        let size = parts.next().map(|size| {
            let (width, height) = size.split_once('x').ok_or_else(refused)?;
            width.parse().ok().zip(height.parse().ok()).ok_or_else(refused)
        });
        let hz = parts.next().map(|hz| hz.parse().map_err(|_number| refused()));
        if parts.next().is_some() {
            return Err(refused());
        }
        let (card, connector) = (card.map(str::to_owned), connector.to_owned());
        Ok(Wanted { card, connector, size: size.transpose()?, hz: hz.transpose()? })
    }
}

impl fmt::Display for Wanted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(card) = &self.card {
            write!(f, "{card}/")?;
        }
        f.write_str(&self.connector)?;
        if let Some((width, height)) = self.size {
            write!(f, "@{width}x{height}")?;
        }
        self.hz.map_or(Ok(()), |hz| write!(f, "@{hz}"))
    }
}

/// A picture size and rate that a display takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModeLine {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Frames a second, rounded.
    pub hz: u32,
    /// The display's own choice.
    pub preferred: bool,
}

impl fmt::Display for ModeLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}@{}", self.width, self.height, self.hz)
    }
}

/// A socket of a controller, and what is in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Connector {
    /// As the kernel names it.
    pub name: String,
    /// Whether something is connected.
    pub connected: bool,
    /// What it takes.
    pub modes: Vec<ModeLine>,
    /// The scan-outs (by their place in the controller's list) that can feed it.
    pub possible: Vec<usize>,
    /// The scan-out that feeds it now.
    pub current: Option<usize>,
}

/// A display controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Card {
    /// `card0`.
    pub name: String,
    /// Its connectors.
    pub connectors: Vec<Connector>,
}

/// What is taken: places in the lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The controller.
    pub card: usize,
    /// Its connector.
    pub connector: usize,
    /// The connector's mode.
    pub mode: usize,
    /// The controller's scan-out.
    pub crtc: usize,
}

/// Why no display is taken.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum KmsError {
    /// The address was not understood.
    #[error("'kms:{0}' names no connector: give kms:HDMI-A-1, kms:card1/DPI-1 or kms:HDMI-A-1@1280x720@60")]
    Name(String),
    /// No controller at all.
    #[error(
        "there is no display controller in /dev/dri: on a Raspberry Pi add dtoverlay=vc4-kms-v3d to config.txt; in a virtual \
         machine give it a graphics card"
    )]
    NoController,
    /// There are some, and none may be opened.
    #[error("no display controller can be opened: {0}")]
    Closed(String),
    /// No such connector.
    #[error("no connector is called '{wanted}': there is {found}; list them with `scotopic projector outputs`")]
    NoConnector {
        /// What was asked for.
        wanted: String,
        /// What there is.
        found: String,
    },
    /// Two controllers have one of that name.
    #[error("{name} is on {cards}: say which, as in kms:card1/{name}")]
    Ambiguous {
        /// The connector.
        name: String,
        /// The controllers.
        cards: String,
    },
    /// Nothing is plugged in.
    #[error("nothing is connected to {0}: check the module's power and cable, then try again")]
    Empty(String),
    /// No such mode.
    #[error("{connector} does not take {wanted}: it takes {found}")]
    NoMode {
        /// The connector.
        connector: String,
        /// What was asked for.
        wanted: String,
        /// What there is.
        found: String,
    },
    /// All scan-outs are in use.
    #[error("all that could feed {0} feed other displays: unplug one of them")]
    Taken(String),
}

/// Chooses connector, mode and scan-out. `closed` are controllers that could not be opened, with the reason.
///
/// The mode is the one asked for, else the display's own choice, else the largest. The scan-out is the one that feeds the
/// connector already, else the first that may and feeds no other connected display.
///
/// # Errors
/// What is missing, and what there is instead.
pub fn plan(cards: &[Card], closed: &[(String, String)], wanted: &Wanted) -> Result<Plan, KmsError> {
    // The connector: one and only one.
    let asked = |card: &Card| wanted.card.as_ref().is_none_or(|name| *name == card.name);
    let all = || cards.iter().enumerate().flat_map(|(place, card)| (0..card.connectors.len()).map(move |c| (place, c)));
    let fits: Vec<(usize, usize)> = all()
        .filter(|&(card, connector)| asked(&cards[card]) && cards[card].connectors[connector].name == wanted.connector)
        .collect();
    let (card, connector) = match fits[..] {
        [one] => one,
        [] if cards.is_empty() && closed.is_empty() => return Err(KmsError::NoController),
        [] if cards.is_empty() => {
            let all: Vec<String> = closed.iter().map(|(path, why)| format!("{path}: {why}")).collect();
            return Err(KmsError::Closed(all.join("; ")));
        }
        [] => {
            let names = all()
                .map(|(card, connector)| format!("{}/{}", cards[card].name, cards[card].connectors[connector].name));
            let found = names.reduce(|list, name| format!("{list}, {name}")).unwrap_or_else(|| "none at all".into());
            return Err(KmsError::NoConnector { wanted: wanted.to_string(), found });
        }
        [..] => {
            let cards: Vec<&str> = fits.iter().map(|(card, _)| cards[*card].name.as_str()).collect();
            return Err(KmsError::Ambiguous { name: wanted.connector.clone(), cards: cards.join(" and ") });
        }
    };
    let chosen = &cards[card].connectors[connector];
    if !chosen.connected || chosen.modes.is_empty() {
        return Err(KmsError::Empty(chosen.name.clone()));
    }
    Ok(Plan { card, connector, mode: mode(chosen, wanted)?, crtc: scan_out(&cards[card], connector)? })
}

fn mode(connector: &Connector, wanted: &Wanted) -> Result<usize, KmsError> {
    let fits = |mode: &ModeLine| {
        wanted.size.is_none_or(|size| size == (mode.width, mode.height)) && wanted.hz.is_none_or(|hz| hz == mode.hz)
    };
    let modes = connector.modes.iter().enumerate().filter(|(_, mode)| fits(mode));
    // Of equals the first: displays list their better modes first.
    let best = modes.rev().max_by_key(|(_, mode)| (mode.preferred, mode.width * mode.height, mode.hz));
    best.map(|(place, _)| place).ok_or_else(|| {
        let found: Vec<String> = connector.modes.iter().map(ModeLine::to_string).collect();
        let size = wanted.size.map_or_else(|| "any size".into(), |(width, height)| format!("{width}x{height}"));
        let wanted = wanted.hz.map_or(size.clone(), |hz| format!("{size}@{hz}"));
        KmsError::NoMode { connector: connector.name.clone(), wanted, found: found.join(", ") }
    })
}

fn scan_out(card: &Card, place: usize) -> Result<usize, KmsError> {
    let connector = &card.connectors[place];
    let others = card.connectors.iter().enumerate().filter(|(other, own)| *other != place && own.connected);
    let taken: Vec<usize> = others.filter_map(|(_, own)| own.current).collect();
    let own = connector.current.into_iter().chain(connector.possible.iter().copied());
    own.into_iter()
        .find(|crtc| connector.possible.contains(crtc) && !taken.contains(crtc))
        .ok_or_else(|| KmsError::Taken(connector.name.clone()))
}

/// The geometry of a dumb buffer of 32-bit pixels: its rows lie `pitch` bytes apart, which is the controller's choice.
///
/// # Errors
/// The numbers do not hold together.
pub fn geometry(size: (u32, u32), pitch: u32) -> Result<Geometry, GeometryError> {
    let field = |offset| BitField { offset, length: 8, msb_right: 0 };
    Geometry::new(&Screen {
        xres: size.0,
        yres: size.1,
        yres_virtual: size.1,
        bits_per_pixel: 32,
        red: field(16),
        green: field(8),
        blue: field(0),
        line_length: pitch,
        smem_len: pitch.saturating_mul(size.1),
        ..Screen::default()
    })
}

/// An error of the kernel's, with what to do about the commonest.
#[must_use]
pub fn advised(error: &std::io::Error) -> String {
    // Numbers of linux/errno: they are the same on every machine that Linux runs on for these.
    let advice = match error.raw_os_error() {
        Some(1 | 13) => {
            "; another program has the display (a desktop: use window:MONITOR there; another virtual terminal: switch back), \
             or you are not in the group `video`"
        }
        Some(16) => "; another program has the display: end the desktop or use window:MONITOR",
        Some(2 | 19) => "; the controller is gone",
        Some(28) => "; the picture is too large for its memory: ask for a smaller mode, kms:NAME@1280x720",
        _ => "",
    };
    format!("{error}{advice}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn mode(width: u32, height: u32, hz: u32, preferred: bool) -> ModeLine {
        ModeLine { width, height, hz, preferred }
    }

    /// A Raspberry Pi 4 with an operator's screen on its first socket and a DLP on its second.
    fn pi() -> Vec<Card> {
        let screen = Connector {
            name: "HDMI-A-1".into(),
            connected: true,
            modes: vec![mode(1920, 1080, 60, true)],
            possible: vec![0, 1, 2],
            current: Some(1),
        };
        let dlp = Connector {
            name: "HDMI-A-2".into(),
            connected: true,
            modes: vec![mode(1920, 1080, 60, false), mode(1280, 720, 60, true), mode(1280, 720, 50, false)],
            possible: vec![1, 0, 2],
            current: None,
        };
        vec![
            Card { name: "card0".into(), connectors: vec![] },
            Card { name: "card1".into(), connectors: vec![screen, dlp] },
        ]
    }

    fn asked(text: &str) -> Result<Plan, KmsError> {
        plan(&pi(), &[], &text.parse().unwrap())
    }

    #[test]
    fn addresses_are_read_and_written_alike() {
        for text in ["HDMI-A-2", "card1/DPI-1", "DPI-1@640x360", "card0/HDMI-A-1@1280x720@60"] {
            assert_eq!(text.parse::<Wanted>().unwrap().to_string(), text);
        }
        for wrong in
            ["", "/HDMI", "HDMI/", "a b", "HDMI@", "HDMI@1280", "HDMI@1x2@", "HDMI@1x2@3@4", "HDMI@-1x2", "../etc"]
        {
            assert!(matches!(wrong.parse::<Wanted>(), Err(KmsError::Name(_))), "{wrong}");
        }
    }

    #[test]
    fn the_displays_own_mode_is_taken_and_a_scan_out_that_feeds_nobody_else() {
        assert_eq!(asked("HDMI-A-2"), Ok(Plan { card: 1, connector: 1, mode: 1, crtc: 0 }));
        assert_eq!(asked("HDMI-A-2@1920x1080"), Ok(Plan { card: 1, connector: 1, mode: 0, crtc: 0 }));
        assert_eq!(asked("card1/HDMI-A-2@1280x720@50"), Ok(Plan { card: 1, connector: 1, mode: 2, crtc: 0 }));
        assert_eq!(asked("HDMI-A-1").map(|plan| plan.crtc), Ok(1), "the one it has already");
    }

    #[test]
    fn what_is_missing_is_a_sentence_that_says_what_there_is() {
        for (text, words) in [
            ("HDMI-A-3", "card1/HDMI-A-1, card1/HDMI-A-2"),
            ("card0/HDMI-A-1", "no connector is called"),
            ("HDMI-A-2@640x480", "it takes 1920x1080@60, 1280x720@60, 1280x720@50"),
            ("HDMI-A-2@1280x720@25", "1280x720@25"),
        ] {
            let said = asked(text).unwrap_err().to_string();
            assert!(said.contains(words), "{text}: {said}");
        }
        let wanted = "HDMI-A-2".parse().unwrap();
        assert_eq!(plan(&[], &[], &wanted), Err(KmsError::NoController));
        let closed = [("/dev/dri/card0".to_owned(), advised(&std::io::Error::from_raw_os_error(13)))];
        assert!(plan(&[], &closed, &wanted).unwrap_err().to_string().contains("group `video`"));
        let mut empty = pi();
        empty[1].connectors[1].connected = false;
        assert_eq!(plan(&empty, &[], &wanted), Err(KmsError::Empty("HDMI-A-2".into())));
        let mut twice = pi();
        twice[0].connectors = twice[1].connectors.clone();
        assert!(plan(&twice, &[], &wanted).unwrap_err().to_string().contains("card0 and card1"));
        let mut full = pi();
        full[1].connectors[1].possible = vec![1];
        assert_eq!(plan(&full, &[], &wanted), Err(KmsError::Taken("HDMI-A-2".into())));
    }

    #[test]
    fn rows_lie_at_the_pitch_that_the_controller_chose() {
        let padded = geometry((640, 360), 2816).unwrap();
        assert_eq!((padded.row_start(2), padded.row_bytes()), (5632, 2560));
        assert!(geometry((640, 360), 2559).is_err() && geometry((0, 360), 2560).is_err());
    }

    prop_compose! {
        fn any_connector()(
            name in "[AB]", connected in any::<bool>(), possible in prop::collection::vec(0..4usize, 0..4),
            current in prop::option::of(0..4usize),
            modes in prop::collection::vec((0..3u32, 0..3u32, 0..3u32, any::<bool>()), 0..4),
        ) -> Connector {
            let modes = modes.into_iter().map(|(w, h, hz, p)| mode(w, h, hz, p)).collect();
            Connector { name, connected, modes, possible, current }
        }
    }

    proptest! {
        #[test]
        fn a_plan_is_always_of_what_was_asked_and_takes_nobodys_picture_away(
            connectors in prop::collection::vec(any_connector(), 0..4),
            size in prop::option::of((0..3u32, 0..3u32)),
        ) {
            let cards = [Card { name: "card0".into(), connectors }];
            let wanted = Wanted { card: None, connector: "A".into(), size, hz: None };
            if let Ok(plan) = plan(&cards, &[], &wanted) {
                let chosen = &cards[plan.card].connectors[plan.connector];
                prop_assert!(chosen.connected && chosen.name == "A" && chosen.possible.contains(&plan.crtc));
                let mode = chosen.modes[plan.mode];
                prop_assert!(size.is_none_or(|size| size == (mode.width, mode.height)));
                for (place, other) in cards[0].connectors.iter().enumerate() {
                    prop_assert!(place == plan.connector || !other.connected || other.current != Some(plan.crtc));
                }
            }
        }
    }
}
