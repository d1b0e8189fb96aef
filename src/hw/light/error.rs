//! Why the light is not as it was asked.

use std::fmt;

use super::calibration::CalibrationError;
use super::module::Module;
use super::plan::PlanError;
use crate::hw::i2c::I2cError;

/// What was being done when it went wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Doing {
    /// Reading.
    Reading,
    /// Switching LEDs.
    Enable,
    /// Setting LED currents.
    Current,
    /// Making LED currents count.
    Propagating,
    /// Drawing the curtain.
    Curtain,
    /// Parking the mirrors.
    Park,
    /// Turning to the picture's input.
    Input,
    /// Switching the automatic brightness off.
    Automatic,
}

impl fmt::Display for Doing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Doing::Reading => "its status",
            Doing::Enable => "the LED switches",
            Doing::Current => "the LED currents",
            Doing::Propagating => "passing on the LED currents",
            Doing::Curtain => "the curtain",
            Doing::Park => "the mirrors' parking",
            Doing::Input => "the picture's input",
            Doing::Automatic => "the automatic brightness",
        })
    }
}

/// Why the light is not as it was asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LightError {
    /// The bus failed until the time was over.
    #[error("the light's controller, {doing}: {why}")]
    Bus {
        /// What was being done.
        doing: Doing,
        /// What the bus says.
        why: I2cError,
    },
    /// Another chip answers.
    #[error(
        "the controller answers with identity 0x{id:02X}, which is no {module}{}: name the right --module; nothing was written to it",
        other(*module, *id)
    )]
    WrongId {
        /// The family that was named.
        module: Module,
        /// What was read.
        id: u8,
    },
    /// It answers but does not become ready.
    #[error(
        "the {chip} answers but does not become ready: give it more time after power-up, switch it off and on, or name the right --module if it is another chip"
    )]
    NotReady {
        /// The chip.
        chip: &'static str,
    },
    /// How to turn it to its input is not known.
    #[error("how a {chip} is turned to its input is not known here: its board does it; say input = \"as-it-is\"")]
    NoInput {
        /// The chip.
        chip: &'static str,
    },
    /// A compound command did not end.
    #[error("the controller stays busy with {doing}: switch the module off and on")]
    Busy {
        /// What it is busy with.
        doing: Doing,
    },
    /// It holds another value than was written.
    #[error("{what}: asked for {asked}, read back {got}: the module limits it, or the bus is noisy; the LEDs stay off")]
    Mismatch {
        /// What was set.
        what: Doing,
        /// What was asked.
        asked: String,
        /// What it holds.
        got: String,
    },
    /// Nobody has measured this module.
    #[error(
        "the LEDs stay off: nobody has measured what they give. Measure them with `scotopic projector measure`, or name a calibration with --calibration FILE"
    )]
    NoCalibration,
    /// The calibration is another module's.
    #[error(
        "the calibration was made with {calibrated}, and a {found} answers: measure this one with `scotopic projector measure`; the LEDs stay off"
    )]
    OtherModule {
        /// The chip in the calibration.
        calibrated: String,
        /// The chip that answers.
        found: &'static str,
    },
    /// The calibration cannot be used.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// The luminance cannot be given.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The bus cannot be opened.
    #[error(transparent)]
    NoBus(#[from] I2cError),
}

/// What else it might be.
fn other(module: Module, id: u8) -> &'static str {
    match (module, id) {
        (Module::Dlpc2607, 0x82) => " (it is a DLPC2601)",
        (_, 0xFF) => " (0xFF is what an open line reads)",
        _ => "",
    }
}
