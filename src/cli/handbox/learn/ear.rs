//! The tapped line as the dialogue hears it: idle noise, and one press at a time.

use std::time::{Duration, Instant};

use crate::cli::Failure;
use crate::cli::handbox::record::Recorder;
use crate::hw::handbox::capture::Event;
use crate::hw::handbox::keymap::Line;
use crate::hw::handbox::learn::Lesson;
use crate::hw::handbox::learn::replay::Note;
use crate::hw::handbox::tap::Tap;

/// A press is over after so much silence.
const QUIET: Duration = Duration::from_millis(600);
/// A press that does not come by then will not come.
const PATIENCE: Duration = Duration::from_secs(30);
/// More bytes of one press are not waited for.
const LONGEST_TAKE: usize = 64 * 1024;
/// The longest wait for a byte.
const LOOK: Duration = Duration::from_millis(50);

/// The bytes of one press.
pub(super) type Take = Vec<Event>;

/// What hears.
pub(super) struct Ear {
    tap: Tap,
    recorder: Recorder,
    start: Instant,
    /// Badly formed characters so far.
    pub(super) malformed: usize,
}

impl Ear {
    /// Opens the line.
    pub(super) fn open(port: &str, line: &Line, recorder: Recorder) -> Result<Ear, Failure> {
        let tap = Tap::open(port, line).map_err(Failure::failed)?;
        let mut ear = Ear { tap, recorder, start: Instant::now(), malformed: 0 };
        ear.note(&Note::Speed(line.baud));
        Ok(ear)
    }

    /// Reads at another speed.
    pub(super) fn set(&mut self, line: &Line) -> Result<(), Failure> {
        self.tap.set(line).map_err(Failure::failed)?;
        self.note(&Note::Speed(line.baud));
        Ok(())
    }

    /// Notes in the recording what is asked for.
    pub(super) fn note(&mut self, note: &Note) {
        self.recorder.event(&Event { at: self.start.elapsed(), bytes: Vec::new(), note: note.to_string() });
    }

    /// All that comes in so many seconds.
    pub(super) fn idle(&mut self, seconds: f64) -> Result<Vec<Event>, Failure> {
        let end = Instant::now() + Duration::from_secs_f64(seconds);
        let mut events: Vec<Event> = Vec::new();
        while Instant::now() < end {
            events.extend(self.read()?.0.filter(|_| events.len() < LONGEST_TAKE));
        }
        Ok(events)
    }

    /// One press: all that comes until the line is as quiet as it was before.
    pub(super) fn take(&mut self, key: &str, lesson: &Lesson) -> Result<Take, Failure> {
        let begun = Instant::now();
        let (mut take, mut heard, mut last) = (Vec::new(), 0, None);
        loop {
            let (event, malformed) = self.read()?;
            let came = event.is_some();
            take.extend(event);
            let now_heard = if came { lesson.heard(&take).iter().map(Vec::len).sum() } else { heard };
            if now_heard > heard || malformed > 0 {
                (heard, last) = (now_heard, Some(Instant::now()));
            }
            match last {
                Some(last) if last.elapsed() >= QUIET || take.len() >= LONGEST_TAKE => return Ok(take),
                None if begun.elapsed() >= PATIENCE => return Err(Failure::Failed(silent(key))),
                _ => {}
            }
        }
    }

    /// What came in one go, and how many characters were badly formed.
    fn read(&mut self) -> Result<(Option<Event>, usize), Failure> {
        let read = self.tap.read(LOOK).map_err(Failure::failed)?;
        self.malformed += read.malformed;
        if read.bytes.is_empty() {
            return Ok((None, read.malformed));
        }
        let event = Event { at: self.start.elapsed(), bytes: read.bytes, note: String::new() };
        self.recorder.event(&event);
        Ok((Some(event), read.malformed))
    }
}

/// A line on which nothing comes.
pub(super) fn silent(key: &str) -> String {
    let key = key.trim_end_matches('~');
    format!(
        "nothing came of key '{key}': are ground and the wire from the keys connected, is the wire perhaps the one to the display, and \
         does the level need inverting?"
    )
}
