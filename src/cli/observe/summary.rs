//! What a session without a terminal ends with: one line of JSON.

use serde::Serialize;

use super::projection::{Ages, Projection};
use crate::app::Model;
use crate::overlay::Mode;

/// Percentiles in milliseconds; null when there was nothing to measure.
#[derive(Debug, Clone, Serialize)]
struct Percentiles {
    p50: Option<f64>,
    p95: Option<f64>,
    p99: Option<f64>,
}

impl Percentiles {
    fn of(ages: &Ages) -> Percentiles {
        Percentiles { p50: ages.percentile_ms(0.5), p95: ages.percentile_ms(0.95), p99: ages.percentile_ms(0.99) }
    }
}

/// The session in numbers.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Summary {
    /// Pictures that reached the projector.
    frames: u64,
    /// From the instant that the position was predicted for to the instant that the picture was there.
    overlay_age_ms: Percentiles,
    /// Age of the mount's newest reply when the picture was there.
    sample_age_ms: Percentiles,
    /// How much the time from handing a picture over to its being there differs from one picture to the next.
    frame_jitter_ms: Percentiles,
    /// Age of the reply, only for pictures that a new reply caused.
    reply_to_picture_ms: Percentiles,
    /// Keys heard from the hand controller.
    key_presses: u64,
    /// From the instant that such a key was heard to the instant that the picture that it changed was there.
    key_to_picture_ms: Percentiles,
    /// The eyepiece that was in use at the end.
    eyepiece_mm: f64,
    /// Over, beside or off at the end.
    overlay: Mode,
    /// Positions read.
    polls: u64,
    /// Commands sent again.
    retries: u64,
    /// Conversations lost and found again.
    resyncs: u64,
    /// Ports opened again.
    reconnects: u64,
    /// Go-tos that the mount took.
    slews: u64,
    /// Go-tos refused, by the safety rules or the mount.
    refused: u64,
    /// Faults reported.
    faults: u64,
    /// Suspends and standstills.
    gaps: u64,
    /// Whether the telescope was simulated.
    simulated: bool,
    /// Where the telescope pointed at the end: degrees of date, nudge included.
    ra_deg: Option<f64>,
    /// See `ra_deg`.
    dec_deg: Option<f64>,
    /// Most memory held, in mebibytes.
    peak_memory_mib: Option<f64>,
}

impl Summary {
    pub(super) fn of(model: &Model, projection: &Projection) -> Summary {
        let counters = &model.belief.counters;
        let place = model.here.map(|here| here.pointing.position);
        Summary {
            frames: projection.frames,
            overlay_age_ms: Percentiles::of(&projection.ages),
            sample_age_ms: Percentiles::of(&projection.samples),
            frame_jitter_ms: Percentiles::of(&projection.jitter),
            reply_to_picture_ms: Percentiles::of(&projection.after_reply),
            key_presses: model.counts.presses,
            key_to_picture_ms: Percentiles::of(&projection.after_key),
            eyepiece_mm: model.instrument.eyepiece().focal_length_mm,
            overlay: model.overlay.mode,
            polls: counters.polls,
            retries: counters.retries,
            resyncs: counters.resyncs,
            reconnects: counters.reconnects,
            slews: counters.slews,
            refused: counters.refused + model.counts.refused,
            faults: counters.faults,
            gaps: model.counts.gaps,
            simulated: model.opening.simulated,
            ra_deg: place.map(|place| place.ra().to_degrees()),
            dec_deg: place.map(|place| place.dec().to_degrees()),
            peak_memory_mib: peak_memory_mib(),
        }
    }
}

/// `VmHWM` of `/proc/self/status`.
fn peak_memory_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some((kib / 102.4).round() / 10.0)
}
