//! The rig file of `cargo test --test hil`: which ports are there, how they are wired, and what is fitted.
//!
//! A second rig is a text file, not code. What the file does not name is not fitted, and the checks that need it are named in
//! the report as not run.

use std::path::Path;

use serde::Deserialize;

use super::settings::explain;

/// A rig.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rig {
    /// What it is called in reports.
    pub name: String,
    /// A remark for the report.
    #[serde(default)]
    pub note: String,
    /// Whether it is made of pseudo terminals and fakes alone: the loopback rig.
    #[serde(default)]
    pub loopback: bool,
    /// The mount's command port.
    pub mount: Option<MountPort>,
    /// The hand controller's tap.
    pub tap: Option<TapPort>,
    /// Two adapters joined by a null-modem cable.
    pub null_modem: Option<NullModem>,
    /// The projector.
    pub projector: Option<ProjectorFitted>,
}

/// The mount's command port and what may be done with it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MountPort {
    /// The stable name: /dev/serial/by-id/..., or a by-path name.
    pub port: String,
    /// Its baud rate.
    #[serde(default = "nine_thousand_six_hundred")]
    pub baud: u32,
    /// The dialect it is expected to speak, as its answer to `:GVP#`: `LX2001`.
    pub dialect: Option<String>,
    /// How it is wired, in words for the report.
    #[serde(default)]
    pub wiring: String,
    /// Whether the motors have power. Nothing is ever sent that moves, unless this says so AND `may_move`.
    #[serde(default)]
    pub motors: bool,
    /// A person stands at the power switch, and the telescope may move.
    #[serde(default)]
    pub may_move: bool,
}

/// The hand controller's tap.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TapPort {
    /// The stable name.
    pub port: String,
    /// The key map: a shipped profile or a file.
    pub map: String,
    /// How it is wired, in words for the report.
    #[serde(default)]
    pub wiring: String,
}

/// Two adapters joined by a null-modem cable: the simulated mount is at the far end.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NullModem {
    /// Our end, by its stable name.
    pub near: String,
    /// The simulated mount's end.
    pub far: String,
    /// A third adapter whose receiver is parallel to the near end's transmitter.
    pub listener: Option<String>,
    /// The baud rate of all.
    #[serde(default = "nine_thousand_six_hundred")]
    pub baud: u32,
}

/// The projector.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProjectorFitted {
    /// As `--projector` takes it: `kms:DPI-1`, `fb:/dev/fb0`.
    pub output: String,
    /// The light module: `dlpc2607` or `dlpc34xx`.
    pub module: Option<String>,
    /// The number of its I2C bus.
    pub bus: Option<u32>,
}

fn nine_thousand_six_hundred() -> u32 {
    9600
}

/// Why a rig file is refused. Nothing is opened.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RigError {
    /// It cannot be read.
    #[error("the rig file {path} cannot be read ({why}): SCOTOPIC_RIG names a file like hil/rigs/loopback.toml")]
    Unreadable {
        /// Its path.
        path: String,
        /// The system's words.
        why: String,
    },
    /// A key or value that is not understood.
    #[error("the rig file, {}{what}", line.map(|line| format!("line {line}: ")).unwrap_or_default())]
    Wrong {
        /// The line, from 1, if it can be told.
        line: Option<usize>,
        /// What is wrong.
        what: String,
    },
    /// The same port twice.
    #[error(
        "the rig file gives {port} both to the {one} and to the {other}: each needs a port of its own; \
         look in /dev/serial/by-id for the name of the second adapter"
    )]
    SamePort {
        /// The port.
        port: String,
        /// The first that names it.
        one: &'static str,
        /// The second.
        other: &'static str,
    },
    /// A name that changes when a cable is plugged in again.
    #[error(
        "the rig file names {port} for the {what}: that number changes when the adapter is plugged in again. \
         Name it as in /dev/serial/by-id or /dev/serial/by-path"
    )]
    PassingName {
        /// The port.
        port: String,
        /// Whose it is.
        what: &'static str,
    },
    /// Motion without power for it.
    #[error(
        "the rig file lets the mount move (may_move) while its motors have no power: set motors = true, or take may_move away"
    )]
    MovesWithoutMotors,
    /// Loopback and something real.
    #[error(
        "the rig file says loopback and names a {what}: a loopback rig has no real ports, so take one of the two away"
    )]
    LoopbackWithPorts {
        /// What it names.
        what: &'static str,
    },
    /// A baud rate of nothing.
    #[error("the rig file gives the {what} {baud} baud: it must be 300 to 230400, and an LX200GPS has 9600")]
    Baud {
        /// Whose.
        what: &'static str,
        /// The rate.
        baud: u32,
    },
    /// No such module.
    #[error("the rig file names the light module '{0}': it is dlpc2607 or dlpc34xx")]
    Module(String),
}

/// A rig file is no longer than this.
const LONGEST: usize = 65_536;

impl Rig {
    /// The rig that is there when no file is named: pseudo terminals and fakes.
    #[must_use]
    pub fn loopback() -> Rig {
        Rig { name: "loopback".into(), loopback: true, ..Rig::default() }
    }

    /// Reads a rig file.
    ///
    /// # Errors
    /// It cannot be read, or [`Rig::from_toml`] refuses it.
    pub fn read(path: &Path) -> Result<Rig, RigError> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| RigError::Unreadable { path: path.display().to_string(), why: error.to_string() })?;
        Rig::from_toml(&text)
    }

    /// A rig from the text of its file.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn from_toml(text: &str) -> Result<Rig, RigError> {
        if text.len() > LONGEST {
            let what = format!("it is {} bytes long; a rig file has at most {LONGEST}", text.len());
            return Err(RigError::Wrong { line: None, what });
        }
        let rig: Rig = toml::from_str(text).map_err(|error| {
            let wrong = explain::wrong(&error, text);
            RigError::Wrong { line: wrong.line, what: wrong.what }
        })?;
        rig.judge()?;
        Ok(rig)
    }

    /// Every port with the name of what hangs on it.
    #[must_use]
    pub fn ports(&self) -> Vec<(&'static str, &str)> {
        let mount = self.mount.iter().map(|mount| ("mount", mount.port.as_str()));
        let tap = self.tap.iter().map(|tap| ("tap", tap.port.as_str()));
        let modem = self.null_modem.iter().flat_map(|modem| {
            let listener = modem.listener.iter().map(|port| ("null-modem listener", port.as_str()));
            [("null-modem near end", modem.near.as_str()), ("null-modem far end", modem.far.as_str())]
                .into_iter()
                .chain(listener)
        });
        mount.chain(tap).chain(modem).collect()
    }

    fn judge(&self) -> Result<(), RigError> {
        let ports = self.ports();
        for (index, (other, port)) in ports.iter().enumerate() {
            if let Some((one, _)) = ports[..index].iter().find(|(_, before)| same(before, port)) {
                return Err(RigError::SamePort { port: super::printable(port), one, other });
            }
        }
        for (what, port) in &ports {
            let number = port.rsplit('/').next().unwrap_or_default();
            if port.starts_with("/dev/") && ["ttyUSB", "ttyACM"].iter().any(|kind| number.starts_with(kind)) {
                return Err(RigError::PassingName { port: super::printable(port), what });
            }
        }
        if self.loopback
            && let Some((what, _)) = ports.first()
        {
            return Err(RigError::LoopbackWithPorts { what });
        }
        let mount = self.mount.iter().map(|mount| ("mount", mount.baud));
        let modem = self.null_modem.iter().map(|modem| ("null modem", modem.baud));
        if let Some((what, baud)) = mount.chain(modem).find(|(_, baud)| !(300..=230_400).contains(baud)) {
            return Err(RigError::Baud { what, baud });
        }
        if self.mount.as_ref().is_some_and(|mount| mount.may_move && !mount.motors) {
            return Err(RigError::MovesWithoutMotors);
        }
        let module = self.projector.as_ref().and_then(|projector| projector.module.as_deref());
        match module {
            None | Some("dlpc2607" | "dlpc34xx") => Ok(()),
            Some(other) => Err(RigError::Module(super::printable(other))),
        }
    }
}

/// Whether two names are one port: by their letters, or, where they exist, by where they lead.
fn same(a: &str, b: &str) -> bool {
    let resolved = |name: &str| std::fs::canonicalize(name).ok();
    a == b || resolved(a).is_some_and(|path| Some(path) == resolved(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        Rig::from_toml(text).unwrap_err().to_string()
    }

    #[test]
    fn the_same_port_twice_is_refused_with_both_its_users() {
        let said = refused(
            "name = 'x'\n[mount]\nport = '/dev/serial/by-id/a'\n[tap]\nport = '/dev/serial/by-id/a'\nmap = 'ascii'",
        );
        assert!(said.contains("mount") && said.contains("tap") && said.contains("by-id/a"), "{said}");
    }

    #[test]
    fn two_names_of_one_port_are_one_port() {
        let folder = std::env::temp_dir().join(format!("scotopic-rig-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let (device, name) = (folder.join("port"), folder.join("by-id"));
        std::fs::write(&device, "").unwrap();
        let _ = std::os::unix::fs::symlink(&device, &name);
        let text = format!("name = 'x'\n[null_modem]\nnear = '{}'\nfar = '{}'", device.display(), name.display());
        assert!(matches!(Rig::from_toml(&text), Err(RigError::SamePort { .. })));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_would_go_wrong_at_night_is_refused_by_day() {
        for (text, words) in [
            ("name = 'x'\n[mount]\nport = '/dev/ttyUSB0'", "by-id"),
            ("name = 'x'\n[mount]\nport = '/dev/serial/by-id/a'\nmay_move = true", "motors"),
            ("name = 'x'\nloopback = true\n[mount]\nport = '/dev/serial/by-id/a'", "loopback"),
            ("name = 'x'\n[mount]\nport = '/dev/serial/by-id/a'\nbaud = 9", "9600"),
            ("name = 'x'\n[projector]\noutput = 'kms:DPI-1'\nmodule = 'dlp9'", "dlpc2607"),
            ("name = 'x'\n[mount]\nprot = '/dev/serial/by-id/a'", "did you mean 'port'"),
        ] {
            let said = refused(text);
            assert!(said.contains(words), "{said}");
        }
    }

    #[test]
    fn a_whole_rig_is_read() {
        let rig = Rig::from_toml(
            "name = 'terrace'\n[mount]\nport = '/dev/serial/by-id/a'\ndialect = 'LX2001'\n[tap]\nport = '/dev/serial/by-id/b'\nmap = 'lx200-classic'",
        )
        .unwrap();
        assert_eq!(rig.ports(), [("mount", "/dev/serial/by-id/a"), ("tap", "/dev/serial/by-id/b")]);
        assert_eq!(rig.mount.map(|mount| (mount.baud, mount.motors)), Some((9600, false)));
    }
}
