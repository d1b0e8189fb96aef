//! What a controller says of itself. Only reads.

use super::super::error::{Doing, LightError};
use super::super::module::Module;
use super::super::wire;
use super::{Controller, Identity};
use crate::hw::i2c::pace::Within;

/// What a controller says of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Status {
    /// Who it is.
    pub identity: Identity,
    /// Which LEDs are on: 1 red, 2 green, 4 blue.
    pub leds: u8,
    /// The LED current codes: red, green, blue.
    pub codes: [u16; 3],
    /// Whether the curtain is drawn.
    pub curtain: bool,
    /// What is not well with it, in words. Empty is well.
    pub complaints: Vec<String>,
}

impl Controller {
    /// Reads identity, LEDs, currents, curtain and what is not well.
    ///
    /// # Errors
    /// As [`Controller::identify`].
    pub fn status(&mut self, within: &mut Within<'_>) -> Result<Status, LightError> {
        let identity = self.identify(within)?;
        let leds = self.value(&wire::ENABLE_ASK, within)? as u8 & 7;
        let codes = self.codes(within)?;
        let curtain = self.value(&wire::CURTAIN_ASK, within)? & 1 == 1;
        let complaints = match self.module {
            Module::Dlpc2607 => wire::complaints_2607(self.value(&[&[0x15, 0x03], &[0xD0]], within)?),
            Module::Dlpc34xx => {
                let mut long = [0; 4];
                self.ask(Doing::Reading, &[0xD1], &mut long, within)?;
                wire::complaints_34xx(self.value(&[&[], &[0xD0]], within)? as u8, long)
            }
        };
        Ok(Status { identity, leds, codes, curtain, complaints })
    }

    /// The LED enable bits and current codes as the module holds them: to see whether it was reset behind our back.
    ///
    /// # Errors
    /// The bus fails.
    pub fn read_back(&mut self, within: &mut Within<'_>) -> Result<super::Drive, LightError> {
        Ok(super::Drive { leds: self.value(&wire::ENABLE_ASK, within)? as u8 & 7, codes: self.codes(within)? })
    }

    fn codes(&mut self, within: &mut Within<'_>) -> Result<[u16; 3], LightError> {
        let mask = self.module.largest_code();
        let mut codes = [0; 3];
        match self.module {
            Module::Dlpc2607 => {
                for (code, register) in codes.iter_mut().zip([0x12, 0x13, 0x14]) {
                    *code = self.value(&[&[0x15, register], &[]], within)? as u16 & mask;
                }
            }
            Module::Dlpc34xx => {
                let mut bytes = [0; 6];
                self.ask(Doing::Reading, &[0x55], &mut bytes, within)?;
                for (code, pair) in codes.iter_mut().zip(bytes.chunks_exact(2)) {
                    *code = u16::from_le_bytes([pair[0], pair[1]]) & mask;
                }
            }
        }
        Ok(codes)
    }

    /// The identity and whether it is ready.
    pub(super) fn presence(&mut self, within: &mut Within<'_>) -> Result<(u8, bool), LightError> {
        match self.module {
            Module::Dlpc2607 => {
                let status = self.value(&[&[0x15, 0x03], &[]], within)?;
                Ok((status as u8, status >> 11 & 1 == 1))
            }
            Module::Dlpc34xx => {
                let id = self.value(&[&[], &[0xD4]], within)? as u8;
                Ok((id, self.value(&[&[], &[0xD0]], within)? & 1 == 1))
            }
        }
    }

    /// A number: 4 bytes, high first, of a DLPC2607; one byte of a DLPC34xx. The question is given for both.
    fn value(&mut self, questions: &[&[u8]; 2], within: &mut Within<'_>) -> Result<u32, LightError> {
        match self.module {
            Module::Dlpc2607 => {
                let mut bytes = [0; 4];
                self.ask(Doing::Reading, questions[0], &mut bytes, within)?;
                Ok(u32::from_be_bytes(bytes))
            }
            Module::Dlpc34xx => {
                let mut byte = [0];
                self.ask(Doing::Reading, questions[1], &mut byte, within)?;
                Ok(u32::from(byte[0]))
            }
        }
    }
}
