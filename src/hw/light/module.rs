//! The families of projector modules that can be driven, and the identities their controllers answer with.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// All these controllers listen at this 7-bit address.
pub const ADDRESS: u8 = 0x1B;

/// The family of a module's controller. It is told by the settings and only verified on the bus: the byte that is "read a
/// register" to one family is "read the orientation" to the other, so that nothing may be probed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Module {
    /// DLPC2607: the DLPDLCR2000 evaluation module.
    Dlpc2607,
    /// DLPC3430 to DLPC3479 and DLPC3421: the DLPDLCR230NP, 2010 and 3010 modules.
    Dlpc34xx,
}

impl Module {
    /// The largest LED current code: 11 bits, or 10.
    #[must_use]
    pub fn largest_code(self) -> u16 {
        match self {
            Module::Dlpc2607 => 0x7FF,
            Module::Dlpc34xx => 0x3FF,
        }
    }

    /// The chip that answers with this identity, if it is of this family.
    #[must_use]
    pub fn chip(self, id: u8) -> Option<&'static str> {
        match self {
            Module::Dlpc2607 => (id == 0x8A).then_some("DLPC2607"),
            Module::Dlpc34xx => CHIPS_34XX.get(usize::from(id)).copied().filter(|name| !name.is_empty()),
        }
    }

    /// The identity that a made-up module answers with: of the module that can be bought for it.
    #[must_use]
    pub fn usual_id(self) -> u8 {
        match self {
            Module::Dlpc2607 => 0x8A,
            Module::Dlpc34xx => 6,
        }
    }
}

/// What opcode 0xD4 answers, by number; 13 is nobody's.
const CHIPS_34XX: [&str; 16] = [
    "DLPC3430", "DLPC3433", "DLPC3432", "DLPC3434", "DLPC3435", "DLPC3438", "DLPC3436", "DLPC3437", "DLPC3472",
    "DLPC3439", "DLPC3440", "DLPC3478", "DLPC3479", "", "DLPC3421", "DLPC3470",
];

/// A text that names no family.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is no module: give dlpc2607 (DLPDLCR2000) or dlpc34xx (DLPDLCR230NP, 2010, 3010)")]
pub struct NoModule(String);

impl FromStr for Module {
    type Err = NoModule;

    fn from_str(text: &str) -> Result<Module, NoModule> {
        match text {
            "dlpc2607" => Ok(Module::Dlpc2607),
            "dlpc34xx" => Ok(Module::Dlpc34xx),
            _ => Err(NoModule(text.chars().filter(|c| !c.is_control()).take(80).collect())),
        }
    }
}

impl TryFrom<String> for Module {
    type Error = NoModule;

    fn try_from(text: String) -> Result<Module, NoModule> {
        text.parse()
    }
}

impl From<Module> for String {
    fn from(module: Module) -> String {
        module.to_string()
    }
}

impl fmt::Display for Module {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Module::Dlpc2607 => "dlpc2607",
            Module::Dlpc34xx => "dlpc34xx",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_are_those_of_the_makers_tables() {
        // TI's libraries: register 0x03 of a DLPC2607 reads 0x8A (a DLPC2601 0x82); opcode 0xD4 of a DLPC3436 reads 6.
        assert_eq!(Module::Dlpc2607.chip(0x8A), Some("DLPC2607"));
        assert_eq!(Module::Dlpc2607.chip(0x82), None);
        assert_eq!(Module::Dlpc34xx.chip(1), Some("DLPC3433"));
        assert_eq!(Module::Dlpc34xx.chip(6), Some("DLPC3436"));
        assert_eq!(Module::Dlpc34xx.chip(13), None);
        assert_eq!(Module::Dlpc34xx.chip(0xFF), None);
    }
}
