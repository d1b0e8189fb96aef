//! What somebody measured: LED current codes and the luminance they gave, and the glass between the module and the eye.
//!
//! ```text
//! luminance at the eyepiece = reading of the meter x (glass that the meter had not behind it) x inserted filter
//! ```
//!
//! Each piece of glass is counted once: the calibration says which of them the light had passed when it was measured.

use serde::{Deserialize, Serialize};

use super::module::Module;

/// The curve through the measured steps.
mod curve;

pub(super) use curve::Curve;

/// A projector at the eyepiece is never brighter (cd/m2): the thesis' module at its brightest.
pub const BRIGHTEST_CD_M2: f64 = 1.8;
/// Nor is it asked to be dimmer without a filter (cd/m2): the thesis' module at its dimmest.
pub const DIMMEST_CD_M2: f64 = 0.03;

/// So many steps and filters at most.
const MOST_ROWS: usize = 256;

/// What the light had passed before it reached the meter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Meter {
    /// All of it: the meter looked into the eyepiece's place, behind the beam splitter.
    #[default]
    Eyepiece,
    /// The fixed filter, but not the beam splitter.
    FixedNd,
    /// Neither: the meter looked at the module itself.
    Module,
}

/// The glass on the way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Optics {
    /// Where the meter stood.
    pub meter: Meter,
    /// Transmission of the fixed neutral-density filter, 0 to 1.
    pub fixed_nd: f64,
    /// The share of the projector's light that the beam splitter sends to the eye, 0 to 1.
    pub beam_splitter: f64,
    /// Transmission of a filter that was in the tray while measuring, 0 to 1; 1 without one.
    #[serde(default = "one")]
    pub filter_at_the_meter: f64,
}

fn one() -> f64 {
    1.0
}

/// A neutral-density filter for the tray.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// What is written on it: `10 %`.
    pub name: String,
    /// The share of light that it lets through, 0 to 1.
    pub transmission: f64,
}

/// One measured step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The LED current code.
    pub code: u16,
    /// What the meter read with a full white picture, cd/m2.
    pub cd_m2: f64,
    /// What it read with a full black picture and the LEDs on, cd/m2; left out if not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub black_cd_m2: Option<f64>,
}

/// A calibration as it stands in its file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// The family of the module that was measured.
    pub module: Module,
    /// The identity that its controller answers with.
    pub id: u8,
    /// Anything worth knowing: which meter, when.
    #[serde(default)]
    pub note: String,
    /// Which LEDs were on: 1 red, 2 green, 4 blue.
    #[serde(default = "all_leds")]
    pub leds: u8,
    /// Each LED's share of the code: red, green, blue; 1 is the whole code.
    #[serde(default = "evenly")]
    pub balance: [f64; 3],
    /// Whether a larger code gives less light (some controllers count that way).
    #[serde(default)]
    pub inverted: bool,
    /// Never brighter than this at the eyepiece, cd/m2.
    #[serde(default = "brightest")]
    pub ceiling_cd_m2: f64,
    /// The glass.
    pub optics: Optics,
    /// The filters for the tray.
    #[serde(default, rename = "filter")]
    pub filters: Vec<Filter>,
    /// The measured steps, by rising code.
    #[serde(default, rename = "row")]
    pub rows: Vec<Row>,
}

fn all_leds() -> u8 {
    7
}

fn evenly() -> [f64; 3] {
    [1.0; 3]
}

fn brightest() -> f64 {
    BRIGHTEST_CD_M2
}

/// What is wrong with a calibration. Nothing is lit with one that has a fault.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    /// It is no TOML, or has a wrong key.
    #[error("the calibration cannot be read: {}", shown(.0.message()))]
    Toml(Box<toml::de::Error>),
    /// Too few steps.
    #[error(
        "the calibration has {0} measured steps: it needs 2 to {MOST_ROWS}; measure them with `scotopic projector measure`"
    )]
    Rows(usize),
    /// Codes do not rise.
    #[error("row {row} of the calibration has code {code} after {before}: sort the rows by rising code, each once")]
    Code {
        /// The row, counted from 1.
        row: usize,
        /// Its code.
        code: u16,
        /// The code before it.
        before: u16,
    },
    /// The luminance does not follow the code.
    #[error(
        "row {row} of the calibration is not monotone: code {code} gave {cd_m2} cd/m2 after {before} cd/m2 at the code before; measure it again{}",
        if *inverted { "" } else { ", or say `inverted = true` if a larger code gives less light throughout" }
    )]
    NotMonotone {
        /// The row, counted from 1.
        row: usize,
        /// Its code.
        code: u16,
        /// Its luminance.
        cd_m2: f64,
        /// The luminance of the row before.
        before: f64,
        /// Whether a falling luminance was expected.
        inverted: bool,
    },
    /// A number of a row makes no sense.
    #[error("row {row} of the calibration: {what} = {value} makes no sense: {want}")]
    Row {
        /// The row, counted from 1.
        row: usize,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it should be.
        want: &'static str,
    },
    /// Another number makes no sense.
    #[error("the calibration's {what} = {value} makes no sense: {want}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it should be.
        want: &'static str,
    },
    /// A filter is listed twice, or has no sense.
    #[error(
        "the filter '{name}' of the calibration, transmission {transmission}: give each filter once, with a name that can be read and a transmission above 0 and below 1"
    )]
    Filter {
        /// Its name.
        name: String,
        /// Its transmission.
        transmission: f64,
    },
    /// No filter has that name.
    #[error("there is no filter '{wanted}' in the calibration: it has {have}")]
    NoFilter {
        /// The name asked for.
        wanted: String,
        /// The names there are.
        have: String,
    },
}

/// A calibration that has been checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    sheet: Sheet,
    curve: Curve,
}

impl Calibration {
    /// Reads and checks a calibration's text.
    ///
    /// # Errors
    /// What is wrong, with the row.
    pub fn from_toml(text: &str) -> Result<Calibration, CalibrationError> {
        let sheet: Sheet = toml::from_str(text).map_err(|error| CalibrationError::Toml(Box::new(error)))?;
        Calibration::checked(sheet)
    }

    /// Checks a calibration.
    ///
    /// # Errors
    /// What is wrong, with the row.
    pub fn checked(sheet: Sheet) -> Result<Calibration, CalibrationError> {
        check_values(&sheet)?;
        check_filters(&sheet.filters)?;
        check_rows(&sheet)?;
        let curve = Curve::new(&sheet.rows, sheet.optics.factor(), sheet.inverted);
        Ok(Calibration { sheet, curve })
    }

    /// The text that [`Calibration::from_toml`] reads.
    ///
    /// # Errors
    /// TOML cannot hold it.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(&self.sheet)
    }

    /// What stands in the file.
    #[must_use]
    pub fn sheet(&self) -> &Sheet {
        &self.sheet
    }

    /// The luminance at the eyepiece by code, without a filter in the tray.
    pub(super) fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The same calibration under a lower ceiling. A higher one changes nothing.
    #[must_use]
    pub fn under(mut self, ceiling_cd_m2: f64) -> Calibration {
        self.sheet.ceiling_cd_m2 = self.sheet.ceiling_cd_m2.min(ceiling_cd_m2.max(0.0));
        self
    }

    /// The filter of that name.
    ///
    /// # Errors
    /// There is none: the names there are.
    pub fn filter(&self, name: &str) -> Result<&Filter, CalibrationError> {
        let plain = |name: &str| name.chars().filter(|c| !c.is_whitespace()).collect::<String>();
        self.sheet.filters.iter().find(|filter| plain(&filter.name) == plain(name)).ok_or_else(|| {
            let names: Vec<&str> = self.sheet.filters.iter().map(|filter| filter.name.as_str()).collect();
            CalibrationError::NoFilter {
                wanted: name.chars().filter(|c| !c.is_control()).take(40).collect(),
                have: if names.is_empty() { "none".into() } else { names.join(", ") },
            }
        })
    }

    /// What a full white picture has at the eyepiece with these LED codes, cd/m2. None where nothing was measured, or if the
    /// codes are not balanced as they were measured.
    #[must_use]
    pub fn white_cd_m2(&self, codes: [u16; 3], fitted: Option<&Filter>) -> Option<f64> {
        let share = self.sheet.balance.iter().copied().fold(0.0, f64::max);
        let code = (f64::from(codes.into_iter().max().unwrap_or(0)) / share).round() as u16;
        if self.codes(code) != codes {
            return None;
        }
        Some(self.curve.at(code)? * fitted.map_or(1.0, |filter| filter.transmission))
    }

    /// The codes of the three LEDs for one code of the table.
    #[must_use]
    pub fn codes(&self, code: u16) -> [u16; 3] {
        let most = self.sheet.module.largest_code();
        self.sheet.balance.map(|share| ((f64::from(code) * share).round() as u16).min(most))
    }
}

impl Optics {
    /// From the meter's reading to the luminance at the eyepiece without a filter in the tray.
    #[must_use]
    pub fn factor(&self) -> f64 {
        let glass = match self.meter {
            Meter::Eyepiece => 1.0,
            Meter::FixedNd => self.beam_splitter,
            Meter::Module => self.fixed_nd * self.beam_splitter,
        };
        glass / self.filter_at_the_meter
    }
}

fn check_values(sheet: &Sheet) -> Result<(), CalibrationError> {
    let share = |what, value: f64| {
        let fine = value > 0.0 && value <= 1.0;
        if fine {
            Ok(())
        } else {
            Err(CalibrationError::Value { what, value, want: "give a share above 0 and up to 1" })
        }
    };
    share("optics.fixed_nd", sheet.optics.fixed_nd)?;
    share("optics.beam_splitter", sheet.optics.beam_splitter)?;
    share("optics.filter_at_the_meter", sheet.optics.filter_at_the_meter)?;
    sheet.balance.iter().try_for_each(|value| share("balance", *value))?;
    if sheet.leds == 0 || sheet.leds > 7 {
        let want = "add up 1 for red, 2 for green, 4 for blue";
        return Err(CalibrationError::Value { what: "leds", value: sheet.leds.into(), want });
    }
    if sheet.module.chip(sheet.id).is_none() {
        let want = "give the identity that `scotopic projector status` prints";
        return Err(CalibrationError::Value { what: "id", value: sheet.id.into(), want });
    }
    if !(sheet.ceiling_cd_m2 > 0.0 && sheet.ceiling_cd_m2 <= BRIGHTEST_CD_M2) {
        let want = "give more than 0 and at most 1.8 cd/m2";
        return Err(CalibrationError::Value { what: "ceiling_cd_m2", value: sheet.ceiling_cd_m2, want });
    }
    Ok(())
}

/// Words from a file as a terminal can be shown them.
fn shown(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(200).collect()
}

fn check_filters(filters: &[Filter]) -> Result<(), CalibrationError> {
    for (place, filter) in filters.iter().enumerate() {
        let twice = filters[..place].iter().any(|other| other.name == filter.name);
        let inside = filter.transmission > 0.0 && filter.transmission < 1.0;
        let named = !filter.name.trim().is_empty() && filter.name == shown(&filter.name);
        if twice || !inside || !named || place >= MOST_ROWS {
            return Err(CalibrationError::Filter { name: shown(&filter.name), transmission: filter.transmission });
        }
    }
    Ok(())
}

fn check_rows(sheet: &Sheet) -> Result<(), CalibrationError> {
    if !(2..=MOST_ROWS).contains(&sheet.rows.len()) {
        return Err(CalibrationError::Rows(sheet.rows.len()));
    }
    for (place, row) in sheet.rows.iter().enumerate() {
        let wrong = |what, value, want| CalibrationError::Row { row: place + 1, what, value, want };
        if row.code > sheet.module.largest_code() {
            return Err(wrong("code", row.code.into(), "it is larger than the controller takes"));
        }
        if !(row.cd_m2 > 0.0 && row.cd_m2 < 1e7) {
            return Err(wrong("cd_m2", row.cd_m2, "give what the meter read, above 0"));
        }
        if row.black_cd_m2.is_some_and(|black| !(black >= 0.0 && black < row.cd_m2)) {
            return Err(wrong("black_cd_m2", row.black_cd_m2.unwrap_or(0.0), "give 0 or more, and less than white"));
        }
        let Some(before) = place.checked_sub(1).map(|i| sheet.rows[i]) else { continue };
        if row.code <= before.code {
            return Err(CalibrationError::Code { row: place + 1, code: row.code, before: before.code });
        }
        let follows = if sheet.inverted { row.cd_m2 < before.cd_m2 } else { row.cd_m2 > before.cd_m2 };
        if !follows {
            return Err(CalibrationError::NotMonotone {
                row: place + 1,
                code: row.code,
                cd_m2: row.cd_m2,
                before: before.cd_m2,
                inverted: sheet.inverted,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
