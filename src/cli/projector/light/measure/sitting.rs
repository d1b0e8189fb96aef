//! The steps from one measured code to the next. Pure: codes out, readings in.

use crate::hw::light::calibration::{Calibration, CalibrationError, Row, Sheet};

/// What became of a reading.
#[derive(Debug, PartialEq)]
pub(super) enum Heard {
    /// It is kept.
    Kept,
    /// It makes no sense: measure again.
    Again(String),
    /// It is not kept, and no brighter step may follow.
    Enough(String),
}

/// A measurement under way. It goes from dim to bright, and the last step aims right under the ceiling.
pub(super) struct Sitting {
    sheet: Sheet,
    left: Vec<u16>,
    now: u16,
    last: bool,
}

impl Sitting {
    /// A measurement of these codes; `sheet` has no rows yet.
    pub(super) fn new(sheet: Sheet, codes: &[u16]) -> Result<Sitting, String> {
        let most = sheet.module.largest_code();
        if codes.len() < 2 || codes.windows(2).any(|pair| pair[0] >= pair[1]) || codes.iter().any(|code| *code > most) {
            return Err(format!("--codes must rise, be two or more, and none above {most}"));
        }
        // Everything but the rows is checked before anything is lit.
        let rows = [(0, 1.0), (1, 2.0)].map(|(code, cd_m2)| Row { code, cd_m2, black_cd_m2: None });
        let id = sheet.module.usual_id();
        let probe = Sheet { id, rows: rows.to_vec(), inverted: false, ..sheet.clone() };
        Calibration::checked(probe).map_err(|error: CalibrationError| error.to_string())?;
        let mut left = codes.to_vec();
        // Taken from the end: the dimmest first.
        if !sheet.inverted {
            left.reverse();
        }
        Ok(Sitting { sheet, left, now: 0, last: false })
    }

    /// The identity of the module that is measured.
    pub(super) fn of(&mut self, id: u8) {
        self.sheet.id = id;
    }

    /// The next code to light.
    pub(super) fn next(&mut self) -> Option<u16> {
        if self.last {
            return None;
        }
        let code = self.left.pop()?;
        self.now = match self.sheet.rows.last() {
            Some(row) if !self.sheet.inverted && row.code > 0 => {
                // Light goes with current, or slower (LEDs droop): a straight line through zero never aims too low.
                let share = self.sheet.ceiling_cd_m2 / self.at_the_eyepiece(row.cd_m2);
                if f64::from(code) <= f64::from(row.code) * share {
                    code
                } else {
                    self.last = true;
                    let aimed = (f64::from(row.code) * share * 0.99).floor() as u16;
                    Some(aimed).filter(|aimed| *aimed > row.code)?
                }
            }
            _ => code,
        };
        Some(self.now)
    }

    /// A reading of full white.
    pub(super) fn white(&mut self, cd_m2: f64) -> Heard {
        if !(cd_m2 > 0.0 && cd_m2 < 1e7) {
            return Heard::Again(format!("{cd_m2} cd/m2 cannot be: give what the meter reads, above 0"));
        }
        if self.at_the_eyepiece(cd_m2) > self.sheet.ceiling_cd_m2 {
            return Heard::Enough(format!(
                "{:.3} cd/m2 at the eyepiece is above the ceiling of {}: not kept, and nothing brighter is lit",
                self.at_the_eyepiece(cd_m2),
                self.sheet.ceiling_cd_m2
            ));
        }
        if let Some(before) = self.sheet.rows.last().filter(|before| cd_m2 <= before.cd_m2) {
            return Heard::Again(format!(
                "{cd_m2} cd/m2 is no more than the {} cd/m2 at code {}: not monotone; measure again, or start anew with --inverted if larger codes are dimmer",
                before.cd_m2, before.code
            ));
        }
        self.sheet.rows.push(Row { code: self.now, cd_m2, black_cd_m2: None });
        Heard::Kept
    }

    /// A reading of black, for the white just kept.
    pub(super) fn black(&mut self, cd_m2: f64) -> Heard {
        match self.sheet.rows.last_mut() {
            Some(row) if cd_m2 >= 0.0 && cd_m2 < row.cd_m2 => {
                row.black_cd_m2 = Some(cd_m2);
                Heard::Kept
            }
            _ => Heard::Again(format!("{cd_m2} cd/m2 cannot be black: give 0 or more, and less than white")),
        }
    }

    /// The sheet with its rows by rising code.
    pub(super) fn done(mut self) -> Sheet {
        self.sheet.rows.sort_by_key(|row| row.code);
        self.sheet
    }

    fn at_the_eyepiece(&self, cd_m2: f64) -> f64 {
        cd_m2 * self.sheet.optics.factor()
    }
}
