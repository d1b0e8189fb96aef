//! What is left: library, limits, help, focuser, reticle, GPS, PEC. Most of it is silent or static on an Autostar II.

use std::time::Duration;

use crate::hw::mount::sim::angles::{decimal, digits};
use crate::hw::mount::sim::answer::Answer;

/// How long the mount looks for satellites.
const GPS_SEARCH: Duration = Duration::from_secs(60);

/// The settings nobody needs, and the limits.
#[derive(Debug)]
pub(super) struct Odds {
    field_arcmin: f64,
    help_line: usize,
    pub(super) lowest_deg: f64,
    pub(super) highest_deg: f64,
    pub(super) home_search: Option<Duration>,
}

impl Default for Odds {
    fn default() -> Odds {
        Odds { field_arcmin: 15.0, help_line: 0, lowest_deg: 0.0, highest_deg: 90.0, home_search: None }
    }
}

/// The help that `:??# :?+# :?-#` walk through.
const HELP: [&str; 3] = ["Use the arrow keys to move the telescope.", "Press MODE to leave.", "Press GOTO to slew."];

impl Odds {
    /// `:G0 :G1 :G2 :GF :Gb :Gf :Gl :Gs :Gq :Gy :Gh :Go`.
    pub(super) fn tell(&self, body: &[u8]) -> Option<Answer> {
        let text = match body {
            b"G0" => String::new(),
            b"G1" | b"G2" => "Align".to_owned(),
            b"GF" => format!("{:03.0}'", self.field_arcmin),
            b"Gb" => "-05.0".to_owned(),
            b"Gf" => "+15.0".to_owned(),
            b"Gl" => "200'".to_owned(),
            b"Gs" => "000'".to_owned(),
            b"Gq" => "VP".to_owned(),
            b"Gy" => "GPDCO".to_owned(),
            b"Gh" => format!("{:+03.0}*", self.highest_deg),
            b"Go" => format!("{:02.0}*", self.lowest_deg),
            _ => return None,
        };
        Some(Answer::text(&text))
    }

    /// `:SF :Sb :Sf :Sl :Ss :Sq :Sy :Sh :So`; `:Sh` is the upper limit here and `:So` the lower.
    pub(super) fn set(&mut self, letter: u8, value: &[u8]) -> Option<Answer> {
        let degrees = |most: f64| {
            let number = value.strip_suffix(b"*").unwrap_or(value);
            decimal(number).filter(|degrees| (0.0..=most).contains(degrees))
        };
        let taken = match letter {
            b'F' => digits(value).filter(|_| value.len() == 3).map(|arcmin| self.field_arcmin = arcmin),
            b'h' => degrees(90.0).map(|limit| self.highest_deg = limit),
            b'o' => degrees(90.0).map(|limit| self.lowest_deg = limit),
            b'b' | b'f' => decimal(value).map(|_| ()),
            b'l' | b's' => digits(value).map(|_| ()),
            b'y' => (value.len() == 5).then_some(()),
            b'q' => return Some(Answer::silent()),
            _ => return None,
        };
        Some(Answer::accepted(taken.is_some()))
    }

    /// The rest of the alphabet; what is not known is silent.
    pub(super) fn obey(&mut self, body: &[u8]) -> Option<Answer> {
        match body {
            b"LI" => Some(Answer::text("M31 EX GAL MAG 3.5 SZ178.0'")),
            b"Lf" => Some(Answer::text(" 0 - Objects found")),
            [b'L', b'o', b'0'..=b'9'] | [b'L', b's', b'0'..=b'9'] => Some(Answer::accepted(true)),
            b"fT" => Some(Answer::text("+12.500")),
            b"gps" => Some(Answer::text("$GPGGA,201500.00,4915.60,N,00702.40,E,1,08,1.0,230.0,M,,M,,*5A")),
            b"gT" => Some(Answer::default().then(GPS_SEARCH, *b"1")),
            [b'V', b'D' | b'R', number @ ..] => {
                digits(number).filter(|number| *number < 200.0).map(|_| Answer::text("0.0000"))
            }
            [b'?', way @ (b'?' | b'+' | b'-')] => {
                self.help_line = match way {
                    b'+' => (self.help_line + 1) % HELP.len(),
                    b'-' => self.help_line.saturating_sub(1),
                    _ => 0,
                };
                Some(Answer::text(HELP[self.help_line]))
            }
            _ => None,
        }
    }
}
