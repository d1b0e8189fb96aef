//! A calibrated lamp: a controller, what was measured of it, and the luminance it is to give. It is dark until told to light,
//! and dark again when dropped.

use std::time::Duration;

use super::calibration::{Calibration, Filter};
use super::controller::{Controller, Drive};
use super::error::LightError;
use super::plan::{self, Plan};
use crate::hw::i2c::pace::{Pace, Within};

/// A module that has just got power answers within this (TI: 0.5 to 1.8 s until it takes commands).
pub const POWER_UP: Duration = Duration::from_secs(3);
/// Lighting, changing and switching off.
pub const SWITCHING: Duration = Duration::from_millis(300);
/// The four steps to darkness at the end.
pub const ENDING: Duration = Duration::from_secs(1);
/// So often is a lit lamp asked whether it still is as it was told: a module may reset itself.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// Where the module's picture comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Input {
    /// Wherever it is turned to.
    #[default]
    AsItIs,
    /// Its parallel input: the module is turned there at the start, and again after it has reset itself.
    Parallel,
}

/// A lamp of known luminance.
pub struct Lamp {
    controller: Controller,
    calibration: Calibration,
    fitted: Option<Filter>,
    input: Input,
    pace: Box<dyn Pace>,
    plan: Plan,
    /// The LEDs are on, or may be.
    lit: bool,
    looked: Duration,
    /// How often the module had to be told again.
    relit: u64,
}

impl Lamp {
    /// A lamp for that luminance at the eyepiece (cd/m2), dark. Nothing is written to a controller that is not the one that
    /// was measured.
    ///
    /// # Errors
    /// The luminance cannot be given, nobody answers, another module answers, or the LEDs cannot be switched off.
    pub fn ready(
        mut controller: Controller,
        calibration: Calibration,
        fitted: Option<Filter>,
        luminance_cd_m2: f64,
        mut pace: Box<dyn Pace>,
    ) -> Result<Lamp, LightError> {
        let plan = plan::plan(luminance_cd_m2, &calibration, fitted.as_ref())?;
        let mut within = Within::new(&mut *pace, POWER_UP);
        let identity = controller.identify(&mut within)?;
        let sheet = calibration.sheet();
        if (sheet.module, sheet.id) != (controller.module(), identity.id) {
            let calibrated = sheet.module.chip(sheet.id).unwrap_or("another module").into();
            return Err(LightError::OtherModule { calibrated, found: identity.chip });
        }
        controller.leds_off(&mut within)?;
        let looked = pace.now();
        let input = Input::AsItIs;
        Ok(Lamp { controller, calibration, fitted, input, pace, plan, lit: false, looked, relit: 0 })
    }

    /// The same lamp with its module turned to an input.
    ///
    /// # Errors
    /// As [`Controller::take_parallel_input`].
    pub fn turned_to(mut self, input: Input) -> Result<Lamp, LightError> {
        self.input = input;
        self.turn(POWER_UP)?;
        Ok(self)
    }

    fn turn(&mut self, time: Duration) -> Result<(), LightError> {
        match self.input {
            Input::AsItIs => Ok(()),
            Input::Parallel => self.controller.take_parallel_input(&mut Within::new(&mut *self.pace, time)),
        }
    }

    /// How the luminance is made.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Whether the LEDs are on, or may be.
    #[must_use]
    pub fn is_lit(&self) -> bool {
        self.lit
    }

    /// How often the module was found not as it was told (it had reset itself), and was told again.
    #[must_use]
    pub fn relit(&self) -> u64 {
        self.relit
    }

    /// What it is, in words.
    #[must_use]
    pub fn describe(&self) -> String {
        format!("{}, {:.3} cd/m2", self.controller.describe(), self.plan.predicted_cd_m2)
    }

    /// Lights the LEDs, if they are not lit.
    ///
    /// # Errors
    /// The bus or the module fails: the LEDs are then off if they can be reached at all.
    pub fn on(&mut self) -> Result<(), LightError> {
        if self.lit {
            return Ok(());
        }
        self.lit = true;
        self.controller.light(self.plan.drive, &mut Within::new(&mut *self.pace, SWITCHING))?;
        self.looked = self.pace.now();
        Ok(())
    }

    /// Switches the LEDs off, if they are lit or may be.
    ///
    /// # Errors
    /// The bus or the module fails: the LEDs may still be on.
    pub fn off(&mut self) -> Result<(), LightError> {
        if self.lit {
            self.controller.leds_off(&mut Within::new(&mut *self.pace, SWITCHING))?;
            self.lit = false;
        }
        Ok(())
    }

    /// Another luminance at the eyepiece, cd/m2, as dim as one likes. What the LEDs cannot do is left to the pixel gain of
    /// the plan.
    ///
    /// # Errors
    /// It cannot be given (then all stays as it was), or the module fails (then the LEDs are off).
    pub fn dim(&mut self, luminance_cd_m2: f64) -> Result<&Plan, LightError> {
        let plan = plan::dimmed(luminance_cd_m2, &self.calibration, self.fitted.as_ref())?;
        let drive = std::mem::replace(&mut self.plan, plan).drive;
        if self.lit && drive != self.plan.drive {
            self.controller.change(self.plan.drive, &mut Within::new(&mut *self.pace, SWITCHING))?;
        }
        Ok(&self.plan)
    }

    /// What the module holds, compared with what it was told: once a second while it is lit. A module that has reset itself
    /// is told again.
    ///
    /// # Errors
    /// As [`Lamp::on`].
    pub fn look(&mut self) -> Result<(), LightError> {
        if !self.lit || self.pace.now().saturating_sub(self.looked) < LOOK_EVERY {
            return Ok(());
        }
        self.looked = self.pace.now();
        let mut within = Within::new(&mut *self.pace, SWITCHING);
        let held = self.controller.read_back(&mut within);
        // One wrong bit on the bus must not make the picture blink: what is strange is read twice.
        let held = if held.as_ref() == Ok(&self.plan.drive) { held } else { self.controller.read_back(&mut within) };
        if held? == self.plan.drive {
            return Ok(());
        }
        self.relit += 1;
        // Whoever sits there now is asked again who it is.
        self.controller.identify(&mut Within::new(&mut *self.pace, SWITCHING))?;
        self.turn(POWER_UP)?;
        self.controller.light(self.plan.drive, &mut Within::new(&mut *self.pace, SWITCHING))
    }

    /// What the module holds now: LEDs and current codes.
    ///
    /// # Errors
    /// The bus fails.
    pub fn read_back(&mut self) -> Result<Drive, LightError> {
        self.controller.read_back(&mut Within::new(&mut *self.pace, SWITCHING))
    }

    /// Dark for good: LEDs off, currents 0, curtain, mirrors parked.
    ///
    /// # Errors
    /// The first step that failed; the others were tried too.
    pub fn dark(&mut self) -> Result<(), LightError> {
        self.controller.dark(&mut Within::new(&mut *self.pace, ENDING))?;
        self.lit = false;
        Ok(())
    }
}

impl Drop for Lamp {
    fn drop(&mut self) {
        // Nobody is left to tell of a failure.
        let _ = self.dark();
    }
}
