//! A recording that forgives: each command gets the reply it had in the recording, whenever it is asked and in any order.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use super::{TraceError, Way, entries};
use crate::hw::port::{Port, PortError};

/// One byte of a reply and when it comes after its command.
type Timed = (Duration, u8);

/// A recorded mount as a table: command to replies. Each is given as long after the command as it was; the last is given again
/// and again. What was never asked in the recording is not answered.
#[derive(Debug, Clone)]
pub struct Tolerant {
    table: BTreeMap<Vec<u8>, VecDeque<Vec<Timed>>>,
    command: Vec<u8>,
    due: VecDeque<Timed>,
    now: Duration,
    /// Commands that the recording does not hold.
    unknown: u64,
}

impl Tolerant {
    /// Reads a trace.
    ///
    /// # Errors
    /// The first line that is not understood.
    pub fn parse(trace: &str) -> Result<Tolerant, TraceError> {
        let mut table: BTreeMap<Vec<u8>, VecDeque<Vec<Timed>>> = BTreeMap::new();
        let (mut command, mut asked): (Vec<u8>, Option<(Vec<u8>, u64)>) = (Vec::new(), None);
        for (t_us, way, bytes) in entries(trace)? {
            for byte in bytes {
                match way {
                    Way::ToMount => {
                        if let Some(whole) = push(&mut command, byte) {
                            table.entry(whole.clone()).or_default().push_back(Vec::new());
                            asked = Some((whole, t_us));
                        }
                    }
                    Way::FromMount => {
                        let replies = asked.as_ref().and_then(|(whole, at)| Some((table.get_mut(whole)?, *at)));
                        if let Some((reply, at)) = replies.and_then(|(replies, at)| Some((replies.back_mut()?, at))) {
                            reply.push((Duration::from_micros(t_us.saturating_sub(at)), byte));
                        }
                    }
                    _ => {}
                }
            }
        }
        Ok(Tolerant { table, command: Vec::new(), due: VecDeque::new(), now: Duration::ZERO, unknown: 0 })
    }

    /// How many commands came that the recording does not hold.
    #[must_use]
    pub fn unknown(&self) -> u64 {
        self.unknown
    }
}

/// Adds a byte to the command under way; gives it when it is whole. A bare `#` between commands is nothing.
fn push(command: &mut Vec<u8>, byte: u8) -> Option<Vec<u8>> {
    match byte {
        0x06 if command.is_empty() => return Some(vec![byte]),
        b':' => command.clear(),
        b'#' if command.is_empty() => return None,
        _ if command.is_empty() || command.len() > 64 => return None,
        _ => {}
    }
    command.push(byte);
    (byte == b'#').then(|| std::mem::take(command))
}

impl Port for Tolerant {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let count = self.due.iter().take(buffer.len()).take_while(|(at, _)| *at <= self.now).count();
        for (place, (_, byte)) in buffer.iter_mut().zip(self.due.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        for byte in bytes {
            let Some(whole) = push(&mut self.command, *byte) else { continue };
            let Some(replies) = self.table.get_mut(&whole) else {
                self.unknown += 1;
                continue;
            };
            let reply = if replies.len() > 1 { replies.pop_front() } else { replies.front().cloned() };
            let now = self.now;
            self.due.extend(reply.into_iter().flatten().map(|(after, byte)| (now + after, byte)));
        }
        Ok(bytes.len())
    }

    fn set_now(&mut self, now: Duration) {
        self.now = self.now.max(now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRACE: &str = r#"{"who":"a test"}
{"t_us":1000,"dir":"to-mount","hex":"3a475223","note":""}
{"t_us":3000,"dir":"from-mount","hex":"31"}
{"t_us":4000,"dir":"from-mount","hex":"23"}
{"t_us":9000,"dir":"to-mount","hex":"3a475223"}
{"t_us":9500,"dir":"from-mount","hex":"3223"}
{"t_us":9900,"dir":"to-mount","hex":"06"}
{"t_us":9990,"dir":"from-mount","hex":"41"}
"#;

    fn read(port: &mut Tolerant, at_us: u64) -> Vec<u8> {
        let mut buffer = [0; 16];
        port.set_now(Duration::from_micros(at_us));
        let count = port.receive(&mut buffer).unwrap();
        buffer[..count].to_vec()
    }

    #[test]
    fn commands_are_answered_in_any_order_and_after_the_recorded_pause() {
        let mut port = Tolerant::parse(TRACE).unwrap();
        port.send(b"\x06").unwrap();
        assert_eq!(read(&mut port, 89), b"");
        assert_eq!(read(&mut port, 90), b"A");
        port.send(b"#:GR#").unwrap();
        assert_eq!(read(&mut port, 90 + 2000), b"1");
        assert_eq!(read(&mut port, 90 + 3000), b"#");
        // The second reply, and from then on the same again.
        for turn in 1..4 {
            port.send(b":GR#").unwrap();
            assert_eq!(read(&mut port, 10_000 * turn + 500), b"2#");
        }
    }

    #[test]
    fn what_was_never_recorded_is_not_answered_and_counted() {
        let mut port = Tolerant::parse(TRACE).unwrap();
        port.send(b":GVP#").unwrap();
        assert_eq!(read(&mut port, 10_000_000), b"");
        assert_eq!(port.unknown(), 1);
    }
}
