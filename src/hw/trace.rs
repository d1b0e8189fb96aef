//! Conversations as JSON lines, recorded once and replayed for ever: a header, then `{t_us, dir, hex, note}`.
//!
//! `dir` is `to-mount`, `from-mount`, `from-handbox` or `none` (a note alone); `hex` the bytes; `t_us` the time since the start.

mod scrub;
mod tolerant;

use std::fmt::Write as _;
use std::io::Write;
use std::time::Duration;

use serde::{Deserialize, Serialize};

pub use self::scrub::Scrubber;
pub use self::tolerant::Tolerant;

use super::port::{Port, PortError};

/// Which way the bytes went.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// From the computer to the mount.
    ToMount,
    /// From the mount to the computer.
    FromMount,
    /// From the hand controller, on its tapped line. No part of the mount's conversation.
    FromHandbox,
    /// A note, no bytes.
    None,
}

/// One line of a trace.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Microseconds since the start.
    pub t_us: u64,
    /// Which way.
    pub dir: Way,
    /// The bytes, two digits each.
    pub hex: String,
    /// A remark.
    #[serde(default)]
    pub note: String,
}

/// Why a trace cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TraceError {
    /// A line that is no JSON of the right form.
    #[error("line {line} of the trace is not understood: {why}")]
    Line {
        /// Line number, from 1.
        line: usize,
        /// What is wrong.
        why: String,
    },
    /// Odd digits, or letters beyond f.
    #[error("line {line} of the trace has bytes that are not hexadecimal: '{hex}'")]
    Hex {
        /// Line number, from 1.
        line: usize,
        /// The digits.
        hex: String,
    },
}

impl TraceError {
    /// A line that the JSON reader does not understand; its words hold pieces of the line.
    pub(in crate::hw) fn line(line: usize, error: &serde_json::Error) -> TraceError {
        TraceError::Line { line, why: shown(&error.to_string()) }
    }

    /// Digits that are none.
    pub(in crate::hw) fn hex(line: usize, hex: &str) -> TraceError {
        TraceError::Hex { line, hex: shown(hex) }
    }
}

/// Words from a file as a terminal can be shown them.
fn shown(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(200).collect()
}

/// A port whose traffic is written down. What cannot be written is lost, never the conversation.
pub struct Recording<P> {
    port: P,
    sink: Box<dyn Write + Send>,
    now: Duration,
    scrubber: Option<Scrubber>,
}

impl<P: Port> Recording<P> {
    /// Records from now on, beginning with a header of the caller's facts: firmware, line, program version.
    pub fn new(port: P, mut sink: Box<dyn Write + Send>, header: &serde_json::Value) -> Recording<P> {
        let _ = writeln!(sink, "{header}");
        Recording { port, sink, now: Duration::ZERO, scrubber: None }
    }

    /// The same without the observer's place, so that it can be given away.
    pub fn scrubbed(port: P, sink: Box<dyn Write + Send>, header: &serde_json::Value) -> Recording<P> {
        Recording { scrubber: Some(Scrubber::default()), ..Recording::new(port, sink, &scrub::header(header)) }
    }

    fn note(&mut self, dir: Way, bytes: &[u8], note: &str) {
        let bytes = match (&mut self.scrubber, dir) {
            (Some(scrubber), Way::ToMount) => scrubber.to_mount(bytes),
            (Some(scrubber), Way::FromMount) => scrubber.from_mount(bytes),
            _ => bytes.to_vec(),
        };
        let entry = Entry { t_us: self.now.as_micros() as u64, dir, hex: hex(&bytes), note: note.into() };
        if let Ok(line) = serde_json::to_string(&entry) {
            let _ = writeln!(self.sink, "{line}");
        }
    }
}

impl<P: Port> Port for Recording<P> {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let outcome = self.port.receive(buffer);
        match &outcome {
            Ok(0) => {}
            Ok(count) => self.note(Way::FromMount, &buffer[..*count], ""),
            Err(error) => self.note(Way::None, &[], &error.to_string()),
        }
        outcome
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let outcome = self.port.send(bytes);
        match &outcome {
            Ok(0) => {}
            Ok(count) => self.note(Way::ToMount, &bytes[..*count], ""),
            Err(error) => self.note(Way::None, &[], &error.to_string()),
        }
        outcome
    }

    fn set_now(&mut self, now: Duration) {
        self.now = now;
        self.port.set_now(now);
    }

    fn duplicate(&self) -> Option<std::os::fd::OwnedFd> {
        self.port.duplicate()
    }
}

/// A recorded mount. Strict: it fails on bytes that were not sent in the recording, and gives each reply only when
/// everything before it has been sent, as long after that as in the recording.
#[derive(Debug, Clone)]
pub struct Replay {
    entries: Vec<(u64, Way, Vec<u8>)>,
    step: usize,
    /// Bytes of the current entry that are done.
    done: usize,
    now: Duration,
    /// When the last entry was finished, here and in the recording.
    finished: (Duration, u64),
}

impl Replay {
    /// Reads a trace.
    ///
    /// # Errors
    /// The first line that is not understood.
    pub fn parse(trace: &str) -> Result<Replay, TraceError> {
        let entries = entries(trace)?;
        let first = entries.first().map_or(0, |(t_us, ..)| *t_us);
        Ok(Replay { entries, step: 0, done: 0, now: Duration::ZERO, finished: (Duration::ZERO, first) })
    }

    /// Whether everything recorded has happened.
    ///
    /// # Errors
    /// What is still to come.
    pub fn finish(&self) -> Result<(), PortError> {
        match self.entries.get(self.step) {
            None => Ok(()),
            Some((_, way, bytes)) => Err(self.off_script(format!("{way:?} {} never came", hex(bytes)))),
        }
    }

    fn off_script(&self, why: String) -> PortError {
        PortError::OffScript { step: self.step + 1, why }
    }

    fn advance(&mut self, count: usize) {
        let Some((t_us, _, bytes)) = self.entries.get(self.step) else { return };
        self.done += count;
        if self.done == bytes.len() {
            self.finished = (self.now, *t_us);
            self.step += 1;
            self.done = 0;
        }
    }
}

impl Port for Replay {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let Some((t_us, Way::FromMount, bytes)) = self.entries.get(self.step) else { return Ok(0) };
        let due = self.finished.0 + Duration::from_micros(t_us.saturating_sub(self.finished.1));
        if self.now < due {
            return Ok(0);
        }
        let count = buffer.len().min(bytes.len() - self.done);
        buffer[..count].copy_from_slice(&bytes[self.done..self.done + count]);
        self.advance(count);
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let mut sent = 0;
        while sent < bytes.len() {
            let Some((_, Way::ToMount, expected)) = self.entries.get(self.step) else {
                return Err(self.off_script(format!("{} was sent, nothing was expected", hex(&bytes[sent..]))));
            };
            let rest = &expected[self.done..];
            let count = rest.len().min(bytes.len() - sent);
            if rest[..count] != bytes[sent..sent + count] {
                return Err(self.off_script(format!("{} was sent, {} expected", hex(&bytes[sent..]), hex(rest))));
            }
            sent += count;
            self.advance(count);
        }
        Ok(sent)
    }

    fn set_now(&mut self, now: Duration) {
        self.now = self.now.max(now);
    }
}

/// The bytes of a trace: when, which way, what.
fn entries(trace: &str) -> Result<Vec<(u64, Way, Vec<u8>)>, TraceError> {
    let mut entries = Vec::new();
    for (index, line) in trace.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty()) {
        let line_number = index + 1;
        let entry: Entry = serde_json::from_str(line).map_err(|error| TraceError::line(line_number, &error))?;
        let bytes = unhex(&entry.hex).ok_or_else(|| TraceError::hex(line_number, &entry.hex))?;
        if matches!(entry.dir, Way::ToMount | Way::FromMount) && !bytes.is_empty() {
            entries.push((entry.t_us, entry.dir, bytes));
        }
    }
    Ok(entries)
}

pub(in crate::hw) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::with_capacity(2 * bytes.len()), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

pub(in crate::hw) fn unhex(text: &str) -> Option<Vec<u8>> {
    if !text.len().is_multiple_of(2) || !text.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).ok()).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;

    const TRACE: &str = r#"{"who":"a test"}
{"t_us":1000,"dir":"to-mount","hex":"06","note":""}
{"t_us":3000,"dir":"from-mount","hex":"41"}
{"t_us":4000,"dir":"none","hex":"","note":"client left"}
"#;

    #[test]
    fn a_replay_answers_after_the_recorded_pause_and_only_what_was_asked() {
        let mut replay = Replay::parse(TRACE).unwrap();
        let mut buffer = [0; 8];
        assert_eq!(replay.receive(&mut buffer), Ok(0));
        assert_eq!(replay.send(b"\x06"), Ok(1));
        assert_eq!(replay.receive(&mut buffer), Ok(0));
        replay.set_now(Duration::from_millis(2));
        assert_eq!(replay.receive(&mut buffer), Ok(1));
        assert_eq!(buffer[0], b'A');
        assert_eq!(replay.finish(), Ok(()));
    }

    #[test]
    fn a_replay_fails_on_surprise_and_on_silence() {
        let mut replay = Replay::parse(TRACE).unwrap();
        assert!(matches!(replay.finish(), Err(PortError::OffScript { .. })));
        assert!(matches!(replay.send(b":GR#"), Err(PortError::OffScript { .. })));
    }

    #[test]
    fn a_damaged_trace_names_its_line() {
        assert!(matches!(Replay::parse("{}\nnonsense"), Err(TraceError::Line { line: 2, .. })));
        let odd = "{}\n{\"t_us\":1,\"dir\":\"to-mount\",\"hex\":\"0\"}";
        assert!(matches!(Replay::parse(odd), Err(TraceError::Hex { line: 2, .. })));
    }

    #[test]
    fn a_damaged_trace_cannot_command_a_terminal() {
        // Found by fuzzing.
        for line in [r#"{"t_us":1,"dir":"\u001b[2J","hex":""}"#, r#"{"t_us":1,"dir":"none","hex":"\u001b[2J"}"#] {
            let error = Replay::parse(&format!("{{}}\n{line}")).unwrap_err().to_string();
            assert!(error.contains("[2J") && !error.contains(char::is_control), "{error:?}");
        }
        let sign = "{}\n{\"t_us\":1,\"dir\":\"to-mount\",\"hex\":\"+f\"}";
        assert!(matches!(Replay::parse(sign), Err(TraceError::Hex { line: 2, .. })), "a sign is no digit");
    }

    #[derive(Clone, Default)]
    struct Sheet(Arc<Mutex<Vec<u8>>>);

    impl Write for Sheet {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().extend(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn what_is_recorded_can_be_replayed() {
        let sheet = Sheet::default();
        let header = serde_json::json!({"who": "a test"});
        let mut recording = Recording::new(Replay::parse(TRACE).unwrap(), Box::new(sheet.clone()), &header);
        let mut buffer = [0; 8];
        recording.set_now(Duration::from_millis(5));
        recording.send(b"\x06").unwrap();
        recording.set_now(Duration::from_millis(9));
        recording.receive(&mut buffer).unwrap();
        let written = String::from_utf8(sheet.0.lock().unwrap().clone()).unwrap();
        let again = Replay::parse(&written).unwrap();
        assert_eq!(again.entries, [(5000, Way::ToMount, vec![0x06]), (9000, Way::FromMount, vec![0x41])]);
    }
}
