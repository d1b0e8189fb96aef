//! The drive's periodic error, learned from the nudges of a night: each nudge says how far the mount was off at that time, and
//! what comes back with the worm is the worm's.

use super::linear::Normal;

/// Bins of the mount's own training over one turn of the worm: 200 of 2.4 s (Greiner 1998, in the thesis' figure 8.4).
pub const BINS: usize = 200;

/// A nudge: when, and how far the true place was from where the mount said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nudged {
    /// Seconds, since any beginning.
    pub at_s: f64,
    /// Along the sky's turning, arcseconds.
    pub east_arcsec: f64,
    /// Which stretch between two syncs it belongs to: a sync begins anew.
    pub stretch: usize,
}

/// What is believed of the worm before the night.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worm {
    /// One turn, seconds.
    pub period_s: f64,
    /// Peak to peak error that such a mount has, arcseconds: 5 after training, 25 before.
    pub peak_to_peak_arcsec: f64,
    /// How well the observer centres, arcseconds.
    pub centring_arcsec: f64,
}

impl Default for Worm {
    fn default() -> Worm {
        Worm { period_s: 480.0, peak_to_peak_arcsec: 25.0, centring_arcsec: 2.0 }
    }
}

/// The learned curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Periodic {
    /// Error at each bin of the worm's turn, arcseconds east; the beginning is that of the first nudge.
    pub curve: Vec<f64>,
    /// One standard deviation of each.
    pub error: Vec<f64>,
    /// From the least to the greatest of the curve, arcseconds.
    pub peak_to_peak_arcsec: f64,
    /// What is left of the nudges, root of the mean square, arcseconds.
    pub rest_arcsec: f64,
    /// The steady drift of each stretch's alignment, arcseconds an hour, their mean.
    pub drift_arcsec_h: f64,
}

/// Why no curve can be learned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PeriodicError {
    /// Too few nudges.
    #[error(
        "{0} nudges are too few: push the picture onto its star at least {LEAST} times, over more than one turn of the worm"
    )]
    Few(usize),
    /// Nothing of the second turn.
    #[error("the nudges span {span_s:.0} s, and the worm turns once in {period_s:.0} s: go on for more than one turn")]
    Short {
        /// From first to last.
        span_s: f64,
        /// One turn.
        period_s: f64,
    },
    /// Numbers that make no sense.
    #[error("{what} is {value}: give {least} to {most}")]
    OutOfRange {
        /// Which.
        what: &'static str,
        /// What was given.
        value: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
}

/// Least number of nudges.
const LEAST: usize = 8;
/// Most stretches between syncs that are told apart.
const STRETCHES: usize = 6;
/// Unknowns: sine and cosine of the turn and of twice and three times it, a drift, and a constant of each stretch.
const UNKNOWNS: usize = 7 + STRETCHES;

/// Learns the curve.
///
/// ```text
/// off(t) = constant of the stretch + drift t + sum over k = 1..3 of a_k cos(2 pi k t / P) + b_k sin(2 pi k t / P)
/// ```
///
/// The amplitudes are believed to be those of such a mount, falling as 1/k: a part of the turn that nobody nudged in is filled
/// with that belief, and its error says so.
///
/// # Errors
/// Too few or too short; a number out of range.
pub fn learned(nudges: &[Nudged], worm: &Worm) -> Result<Periodic, PeriodicError> {
    for (what, value, least, most) in [
        ("the worm's period in seconds", worm.period_s, 30.0, 7200.0),
        ("the peak to peak error in arcseconds", worm.peak_to_peak_arcsec, 1.0, 200.0),
        ("the error of centring in arcseconds", worm.centring_arcsec, 0.05, 60.0),
    ] {
        if !(least..=most).contains(&value) {
            return Err(PeriodicError::OutOfRange { what, value, least, most });
        }
    }
    let nudges: Vec<Nudged> =
        nudges.iter().filter(|nudge| nudge.at_s.is_finite() && nudge.east_arcsec.is_finite()).copied().collect();
    if nudges.len() < LEAST {
        return Err(PeriodicError::Few(nudges.len()));
    }
    let times = || nudges.iter().map(|nudge| nudge.at_s);
    let (begin, end) = (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max));
    if end - begin < worm.period_s {
        return Err(PeriodicError::Short { span_s: end - begin, period_s: worm.period_s });
    }
    let row = |nudge: &Nudged| {
        let mut row = [0.0; UNKNOWNS];
        row[..6].copy_from_slice(&waves((nudge.at_s - begin) / worm.period_s));
        row[6] = (nudge.at_s - begin) / 3600.0;
        row[7 + nudge.stretch.min(STRETCHES - 1)] = 1.0;
        row
    };
    let weight = worm.centring_arcsec.powi(-2);
    let mut normal = Normal::<UNKNOWNS>::new();
    for k in 0..UNKNOWNS {
        let mut unit = [0.0; UNKNOWNS];
        unit[k] = 1.0;
        let believed = match k {
            0..6 => worm.peak_to_peak_arcsec / 2.0 / (k / 2 + 1) as f64,
            6 => 600.0,
            _ => 1000.0,
        };
        normal.add(&unit, 0.0, believed.powi(-2));
    }
    nudges.iter().for_each(|nudge| normal.add(&row(nudge), nudge.east_arcsec, weight));
    let Some((found, inverse)) = normal.solve() else { return Err(PeriodicError::Few(nudges.len())) };
    let dot = |row: &[f64]| row.iter().zip(&found).map(|(a, b)| a * b).sum::<f64>();
    let squares: f64 = nudges.iter().map(|nudge| (nudge.east_arcsec - dot(&row(nudge))).powi(2)).sum();
    let bins = || (0..BINS).map(|bin| waves(bin as f64 / BINS as f64));
    let curve: Vec<f64> = bins().map(|waves| dot(&waves)).collect();
    let variance = |waves: &[f64; 6]| -> f64 {
        (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).map(|(i, j)| waves[i] * inverse[i][j] * waves[j]).sum()
    };
    let most = curve.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = curve.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(Periodic {
        error: bins().map(|waves| variance(&waves).max(0.0).sqrt()).collect(),
        peak_to_peak_arcsec: most - least,
        rest_arcsec: (squares / nudges.len() as f64).sqrt(),
        drift_arcsec_h: found[6],
        curve,
    })
}

/// Cosine and sine of one, two and three times the worm's turn.
fn waves(turn: f64) -> [f64; 6] {
    let mut waves = [0.0; 6];
    for k in 0..3 {
        let (sin, cos) = (std::f64::consts::TAU * (k + 1) as f64 * turn).sin_cos();
        (waves[2 * k], waves[2 * k + 1]) = (cos, sin);
    }
    waves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::streams::Stream;

    /// A worm of 20 arcseconds peak to peak with a bump at twice its turn, a drift of 30 arcseconds an hour, a sync after half
    /// the time, and an observer who centres to about 2 arcseconds.
    fn night(count: usize, span_s: f64, seed: u64) -> Vec<Nudged> {
        let mut stream = Stream::seeded(seed);
        (0..count)
            .map(|k| {
                let at_s = span_s * (k as f64 + 0.8 * stream.uniform()) / count as f64;
                let noise = 2.0 * (stream.uniform() + stream.uniform() + stream.uniform() - 1.5) * 2.0;
                let stretch = usize::from(at_s > span_s / 2.0);
                let east_arcsec = worm(at_s) + 30.0 * at_s / 3600.0 + [15.0, -40.0][stretch] + noise;
                Nudged { at_s: 1.8e9 + at_s, east_arcsec, stretch }
            })
            .collect()
    }

    fn worm(at_s: f64) -> f64 {
        let turn = std::f64::consts::TAU * at_s / 480.0;
        9.0 * (turn + 0.4).sin() + 2.5 * (2.0 * turn + 1.1).cos()
    }

    #[test]
    fn the_worm_is_found_within_its_stated_error_under_drift_and_a_sync() {
        let (mut inside, mut all) = (0usize, 0usize);
        for seed in 0..20 {
            let nudges = night(40, 2000.0, seed);
            let found = learned(&nudges, &Worm::default()).unwrap();
            let begin = nudges[0].at_s - 1.8e9;
            for (bin, (curve, error)) in found.curve.iter().zip(&found.error).enumerate().step_by(10) {
                let truth = worm(begin + bin as f64 * 2.4);
                inside += usize::from((curve - truth).abs() < 2.0 * error);
                all += 1;
                assert!((curve - truth).abs() < 4.5 && *error < 2.0, "{curve} {truth} {error}");
            }
        }
        let share = inside as f64 / all as f64;
        assert!((0.88..1.0).contains(&share), "{share} of the curve within two standard deviations");
    }

    #[test]
    fn what_was_never_nudged_has_a_large_error() {
        let nudges: Vec<Nudged> =
            night(200, 4000.0, 3).into_iter().filter(|n| (n.at_s - 1.8e9).rem_euclid(480.0) < 150.0).collect();
        let found = learned(&nudges, &Worm::default()).unwrap();
        assert!(found.error[140] > 2.0 * found.error[25], "{} {}", found.error[140], found.error[25]);
    }

    #[test]
    fn too_little_is_refused_with_what_to_do() {
        assert_eq!(learned(&night(5, 2000.0, 1), &Worm::default()), Err(PeriodicError::Few(5)));
        assert!(matches!(learned(&night(20, 300.0, 1), &Worm::default()), Err(PeriodicError::Short { .. })));
        let wrong = Worm { peak_to_peak_arcsec: f64::NAN, ..Worm::default() };
        assert!(matches!(learned(&night(20, 2000.0, 1), &wrong), Err(PeriodicError::OutOfRange { .. })));
    }
}
