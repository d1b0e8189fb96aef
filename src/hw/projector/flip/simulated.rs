//! A simulated display: two buffers, a fixed rate, a beam that reads row after row. It knows of every frame whether it was
//! whole, and when every flip happened.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::Buffers;
use crate::hw::projector::geometry::{BitField, Geometry, GeometryError, Screen};

/// So many flips are remembered.
const KEPT: usize = 4096;

/// The time of a simulated display.
#[derive(Debug, Clone)]
pub enum Beat {
    /// The machine's.
    Real(Instant),
    /// Time that passes only while rows are written (so much a row) and while a flip is waited for.
    Made {
        /// Now.
        now: Duration,
        /// What writing one row costs.
        row: Duration,
    },
}

impl Beat {
    fn now(&self) -> Duration {
        match self {
            Beat::Real(start) => start.elapsed(),
            Beat::Made { now, .. } => *now,
        }
    }

    fn wait_until(&mut self, then: Duration) {
        match self {
            Beat::Real(start) => thread::sleep(then.saturating_sub(start.elapsed())),
            Beat::Made { now, .. } => *now = (*now).max(then),
        }
    }
}

/// A flip: when it was asked, when it happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlipStamp {
    /// The picture was whole in its buffer.
    pub asked: Duration,
    /// The frame began that showed it.
    pub shown: Duration,
    /// The buffer.
    pub buffer: usize,
}

/// What a simulated display has seen.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Record {
    /// Frames that the beam has read whole.
    pub frames: u64,
    /// Frames of them that showed anything but one whole picture as it was handed over.
    pub torn: u64,
    /// Flips.
    pub flips: u64,
    /// Frames that went by while a picture was being written, beyond the one that each needs.
    pub missed: u64,
    /// The latest flips.
    pub latest: VecDeque<FlipStamp>,
    /// Whether the last frame was black.
    pub dark: bool,
}

/// A view of a simulated display's record, also after the display is gone.
#[derive(Debug, Clone, Default)]
pub struct Watch(Arc<Mutex<Record>>);

impl Watch {
    /// What has been seen until now.
    #[must_use]
    pub fn record(&self) -> Record {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn change(&self, change: impl FnOnce(&mut Record)) {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// The display.
#[derive(Debug)]
pub struct SimulatedDisplay {
    geometry: Geometry,
    period: Duration,
    beat: Beat,
    watch: Watch,
    report: Option<PathBuf>,
    /// What each row of both buffers holds.
    buffers: [Vec<u64>; 2],
    front: usize,
    /// What the front held when it came on the screen.
    whole: Vec<u64>,
    /// When the present frame began, and the rows of it that the beam has read.
    began: Duration,
    read: Vec<u64>,
    /// When writing the next picture began.
    writing_since: Option<Duration>,
}

impl SimulatedDisplay {
    /// A display of 32-bit pixels, with some bytes of padding behind each row.
    ///
    /// # Errors
    /// No such size.
    pub fn new(width: u32, height: u32, rate_hz: f64, beat: Beat) -> Result<SimulatedDisplay, GeometryError> {
        let field = |offset| BitField { offset, length: 8, msb_right: 0 };
        let line_length = width.saturating_mul(4).saturating_add(64);
        let geometry = Geometry::new(&Screen {
            xres: width,
            yres: height,
            yres_virtual: height,
            bits_per_pixel: 32,
            red: field(16),
            green: field(8),
            blue: field(0),
            line_length,
            smem_len: line_length.saturating_mul(height),
            ..Screen::default()
        })?;
        let black = vec![content(&vec![0; geometry.row_bytes()]); geometry.size().1];
        Ok(SimulatedDisplay {
            geometry,
            period: Duration::from_secs_f64(1.0 / rate_hz.clamp(1.0, 1000.0)),
            began: beat.now(),
            beat,
            watch: Watch::default(),
            report: None,
            buffers: [black.clone(), black.clone()],
            front: 0,
            whole: black,
            read: Vec::new(),
            writing_since: None,
        })
    }

    /// The same, which at its end writes its record to a file as one line of JSON.
    #[must_use]
    pub fn reporting(mut self, report: Option<PathBuf>) -> SimulatedDisplay {
        self.report = report;
        self
    }

    /// A view of its record.
    #[must_use]
    pub fn watch(&self) -> Watch {
        self.watch.clone()
    }

    /// Lets the beam read up to an instant.
    pub(super) fn scan(&mut self, now: Duration) {
        let rows = self.whole.len();
        // Frames of which nothing has been read and that end before now are all alike: nothing is written in between.
        loop {
            let into = now.saturating_sub(self.began).as_secs_f64() / self.period.as_secs_f64();
            let reached = ((into * rows as f64).ceil() as usize).min(rows);
            if self.read.len() < reached {
                self.read.extend_from_slice(&self.buffers[self.front][self.read.len()..reached]);
            }
            if into < 1.0 {
                return;
            }
            let alike = if self.read == self.buffers[self.front] { into as u64 } else { 1 };
            let torn = self.read != self.whole;
            let dark = self.read.iter().all(|row| *row == content(&vec![0; self.geometry.row_bytes()]));
            self.watch.change(|record| {
                record.frames += alike;
                record.torn += if torn { alike } else { 0 };
                record.dark = dark;
            });
            self.began += self.period * u32::try_from(alike).unwrap_or(u32::MAX);
            self.read.clear();
        }
    }
}

/// A row's content as a number.
fn content(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish()
}

impl Buffers for SimulatedDisplay {
    fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    fn write(&mut self, buffer: usize, rows: &[(usize, Vec<u8>)]) -> Result<(), String> {
        // The last writing before a flip is the picture's; what was blackened earlier is not.
        self.writing_since = Some(self.beat.now());
        for (y, bytes) in rows {
            if let Beat::Made { now, row } = &mut self.beat {
                *now += *row;
            }
            self.scan(self.beat.now());
            self.buffers[buffer][*y] = content(bytes);
        }
        Ok(())
    }

    fn flip(&mut self, buffer: usize) -> Result<(), String> {
        let asked = self.beat.now();
        self.scan(asked);
        let shown = self.began + self.period;
        self.beat.wait_until(shown);
        // The frame that was on the screen is read to its end before the buffers change places.
        self.scan(shown);
        (self.front, self.whole) = (buffer, self.buffers[buffer].clone());
        let since = self.writing_since.take().unwrap_or(asked);
        let frames = (shown.saturating_sub(since).as_secs_f64() / self.period.as_secs_f64()).ceil() as u64;
        self.watch.change(|record| {
            record.flips += 1;
            record.missed += frames.saturating_sub(1);
            if record.latest.len() == KEPT {
                record.latest.pop_front();
            }
            record.latest.push_back(FlipStamp { asked, shown, buffer });
        });
        Ok(())
    }

    fn describe(&self) -> String {
        let (width, height) = self.geometry.size();
        format!("simulated display, {width} x {height}, {:.0} Hz", 1.0 / self.period.as_secs_f64())
    }
}

impl Drop for SimulatedDisplay {
    fn drop(&mut self) {
        // One frame more: what is left on the screen counts.
        let end = self.began + self.period;
        self.scan(end);
        let Some(report) = &self.report else { return };
        let Record { frames, torn, flips, missed, dark, .. } = self.watch.record();
        let line = format!(
            "{{\"display\":\"{}\",\"frames\":{frames},\"torn\":{torn},\"flips\":{flips},\"missed\":{missed},\"dark\":{dark}}}\n",
            self.describe()
        );
        // Nobody is left to tell of a failure.
        let _ = std::fs::write(report, line);
    }
}
