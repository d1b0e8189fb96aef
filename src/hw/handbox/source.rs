//! Where keys come from: a tapped line, an input device, or the display.

use std::fmt;
use std::str::FromStr;

/// A source of keys: `PATH` (or `serial:PATH`), `evdev:PATH`, or `display`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// The tapped line of a hand controller.
    Tap {
        /// The adapter's path.
        path: String,
    },
    /// A presenter, a gamepad, a keyboard.
    Evdev {
        /// Its path, best under /dev/input/by-id.
        path: String,
    },
    /// The hand controller's display, read over the mount's command port.
    Display,
}

/// Why a text is no source.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "'{0}' is no source of keys: write the tapping adapter's /dev/serial/by-id/NAME, evdev:/dev/input/by-id/NAME, or display"
)]
pub struct SourceError(String);

impl FromStr for Source {
    type Err = SourceError;

    fn from_str(text: &str) -> Result<Source, SourceError> {
        let path = |path: &str| (path.starts_with('/')).then(|| path.to_owned());
        let source = match text.split_once(':') {
            None if text == "display" => Some(Source::Display),
            Some(("evdev", rest)) => path(rest).map(|path| Source::Evdev { path }),
            Some(("serial", rest)) => path(rest).map(|path| Source::Tap { path }),
            _ => path(text).map(|path| Source::Tap { path }),
        };
        source.ok_or_else(|| SourceError(text.chars().filter(|c| !c.is_control()).take(80).collect()))
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Source::Tap { path } => f.write_str(path),
            Source::Evdev { path } => write!(f, "evdev:{path}"),
            Source::Display => f.write_str("display"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_is_written_as_it_is_read() {
        for text in ["/dev/ttyUSB1", "/dev/serial/by-id/a:b", "evdev:/dev/input/event3", "display"] {
            assert_eq!(text.parse::<Source>().unwrap().to_string(), text);
        }
        assert_eq!("serial:/dev/x".parse(), Ok(Source::Tap { path: "/dev/x".into() }));
        for text in ["", "evdev:", "tcp:host:1", "keyboard", "ttyUSB0"] {
            assert!(text.parse::<Source>().unwrap_err().to_string().contains("by-id"), "{text}");
        }
    }
}
