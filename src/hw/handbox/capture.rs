//! What was heard on a tapped line, as JSON lines (`crate::hw::trace` has their form), so that an observer's capture becomes a
//! test: a header, then bytes with their times and notes of what was being done.

use std::time::Duration;

use super::Heard;
use super::decoder::Decoder;
use super::keymap::Line;
use crate::hw::trace::{Entry, TraceError, Way, hex, unhex};

/// More lines are not read.
const MOST_LINES: usize = 1_000_000;

/// One thing that happened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// Since the recording began.
    pub at: Duration,
    /// Bytes of the line.
    pub bytes: Vec<u8>,
    /// A note: what was being done from then on.
    pub note: String,
}

/// The first line of a recording.
#[must_use]
pub fn header(map: &str, line: &Line) -> serde_json::Value {
    serde_json::json!({
        "who": "scotopic handbox, listening on a tapped line",
        "version": env!("CARGO_PKG_VERSION"),
        "map": map,
        "line": line.to_string(),
    })
}

/// An event as a line of a recording.
#[must_use]
pub fn line(event: &Event) -> String {
    let dir = if event.bytes.is_empty() { Way::None } else { Way::FromHandbox };
    let t_us = u64::try_from(event.at.as_micros()).unwrap_or(u64::MAX);
    let entry = Entry { t_us, dir, hex: hex(&event.bytes), note: event.note.clone() };
    serde_json::to_string(&entry).unwrap_or_default()
}

/// Reads a recording.
///
/// # Errors
/// The first line that is not understood.
pub fn read(text: &str) -> Result<Vec<Event>, TraceError> {
    let lines = text.lines().enumerate().skip(1).take(MOST_LINES).filter(|(_, line)| !line.trim().is_empty());
    let event = |(index, line): (usize, &str)| {
        let line_number = index + 1;
        let entry: Entry = serde_json::from_str(line).map_err(|error| TraceError::line(line_number, &error))?;
        let bytes = unhex(&entry.hex).ok_or_else(|| TraceError::hex(line_number, &entry.hex))?;
        let note = entry.note.chars().filter(|c| !c.is_control()).collect();
        Ok(Event { at: Duration::from_micros(entry.t_us), bytes, note })
    };
    lines
        .map(event)
        .filter(|event| !matches!(event, Ok(event) if event.bytes.is_empty() && event.note.is_empty()))
        .collect()
}

/// What a decoder hears in a recording, timed as it was.
#[must_use]
pub fn replay(events: &[Event], decoder: &mut Decoder) -> Vec<Heard> {
    let mut heard = Vec::new();
    for event in events {
        // What only time decides comes first, at its own time.
        while let Some(due) = decoder.wake_at().filter(|due| *due < event.at) {
            heard.extend(decoder.tick(due));
        }
        heard.extend(decoder.feed(&event.bytes, event.at));
    }
    while let Some(due) = decoder.wake_at() {
        heard.extend(decoder.tick(due));
    }
    heard
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hw::handbox::KeyMap;

    #[test]
    fn a_recording_is_read_as_it_was_written_and_heard_as_it_was() {
        let event =
            |ms, bytes: &[u8]| Event { at: Duration::from_millis(ms), bytes: bytes.to_vec(), note: String::new() };
        let events = vec![event(10, &[0x0D]), event(110, &[0x8D]), event(500, &[0x99])];
        let map = KeyMap::shipped("lx200-classic").unwrap();
        let text =
            format!("{}\n{}\n", header("m", &map.line()), events.iter().map(line).collect::<Vec<_>>().join("\n"));
        assert_eq!(read(&text).unwrap(), events);
        let heard = replay(&events, &mut Decoder::new(map));
        assert!(
            matches!(&heard[..], [Heard::Pressed(pressed), Heard::Released { .. }, Heard::Unknown { .. }]
            if pressed.key == "ENTER" && pressed.at == Duration::from_millis(10)),
            "{heard:?}"
        );
        assert!(read("{}\nnonsense").unwrap_err().to_string().contains("line 2"));
    }
}
