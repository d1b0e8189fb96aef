//! A table by paths that rows share: every flight ends in a scattering, every scattering is seen from all directions, and each path counts
//! for all rows of like depth.
//!
//! ```text
//! forced flights      q(l) = s e^(-s l) / (1 - e^(-s L))          the weight takes 1 - e^(-s L), L the way to the surface
//! peel-off            w p(cos) Omega e^(-s L')                    to every bin, along one direction drawn in it
//! another depth s'    (s'/s)^n e^(-(s' - s) (all flights + L'))   the path's probability there over that of its drawing
//! ```
//!
//! Peel-off after Yusef-Zadeh, Morris & White (1984); forced scattering after Cashwell & Everett (1959). A direction drawn in a bin is blind
//! to a steep law, a direction drawn from the law is blind to dim bins: both are asked and weighed by the balance heuristic (Veach 1997, section 9.2).

use rayon::prelude::*;

use super::nodes::{Group, groups};
use super::peel::{Bins, Peel};
use super::{Accuracy, Made, Parameters, Spacing, Table, TableError, worst};
use crate::numerics::streams::Stream;
use crate::physics::dust::sphere::walk::{azimuth, turned};
use crate::physics::dust::sphere::{Source, closed};
use glam::DVec3;

/// Photons of a batch: they share a random stream, and their first flights are spread evenly.
const BATCH: usize = 256;
/// Batches from whose differences errors are first taken.
const LEAST_BATCHES: u64 = 64;
/// A path of less than this share of its first weight goes on only by chance.
const LIGHT: f64 = 0.1;
/// What the closed form of the unscattered share is good to.
const CLOSED_FORM_ERROR: f64 = 1e-15;
/// The golden ratio's share, by which the beam's second even spread goes round.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Makes a table; `told` hears the share that is done.
///
/// # Errors
/// The table or its accuracy is none that can be.
pub fn make(
    parameters: &Parameters,
    accuracy: &Accuracy,
    seed: u64,
    told: &mut dyn FnMut(f64),
) -> Result<Made, TableError> {
    parameters.checked()?;
    accuracy.checked()?;
    let bins = Bins::new(parameters);
    let groups = groups(parameters);
    let count = parameters.directions;
    let (mut values, mut errors) = (vec![0.0; parameters.depths * count], vec![0.0; parameters.depths * count]);
    let (mut photons, mut events) = (0, 0);
    let share = accuracy.most_events / groups.len().max(1) as u64;
    if parameters.albedo > 0.0 {
        for (index, group) in (0u64..).zip(&groups) {
            let found = follow(parameters, &bins, group, accuracy, share, seed ^ index.wrapping_mul(0x9e37_79b9));
            photons += found.photons;
            events += found.events;
            for row in group.rows.clone() {
                let at = parameters.radius_depth(row);
                let into = row * count..(row + 1) * count;
                group.interpolate(at, &found.means, &mut values[into.clone()]);
                group.between(at, &found.errors, &mut errors[into]);
            }
            told((index + 1) as f64 / groups.len() as f64);
        }
    }
    let unscattered = (0..parameters.depths)
        .map(|row| [closed::unscattered(parameters.source, parameters.radius_depth(row)), CLOSED_FORM_ERROR])
        .collect();
    let table = Table::new(*parameters, unscattered, values, errors).ok_or(TableError::Deepest(parameters.deepest))?;
    Ok(Made { table, photons, events })
}

/// What a group's photons found: means and their standard errors, node by node.
struct Found {
    means: Vec<f64>,
    errors: Vec<f64>,
    photons: u64,
    events: u64,
}

/// Follows batches of photons for a group until its errors are as asked, or its share of the work is done.
fn follow(
    parameters: &Parameters,
    bins: &Bins,
    group: &Group,
    accuracy: &Accuracy,
    most_events: u64,
    seed: u64,
) -> Found {
    let size = group.depths.len() * parameters.directions;
    let (mut sums, mut squares, mut events) = (vec![0.0; size], vec![0.0; size], 0);
    let (mut done, mut round) =
        (0, accuracy.photons.map_or(LEAST_BATCHES, |photons| photons.div_ceil(BATCH as u64)).max(2));
    loop {
        let parts: Vec<(Vec<f64>, u64)> = (done..done + round)
            .into_par_iter()
            .map(|batch| one(parameters, bins, group, Stream::part(seed, batch)))
            .collect();
        // In the order of the batches, so that any number of threads gives the same bits.
        for (part, count) in &parts {
            events += count;
            for ((sum, square), x) in sums.iter_mut().zip(&mut squares).zip(part) {
                *sum += x;
                *square += x * x;
            }
        }
        done += round;
        let n = done as f64;
        let means: Vec<f64> = sums.iter().map(|sum| sum / n).collect();
        let spread = |(square, mean): (&f64, &f64)| ((square / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
        let errors: Vec<f64> = squares.iter().zip(&means).map(spread).collect();
        let rows = means.chunks(parameters.directions).zip(errors.chunks(parameters.directions));
        let worst = rows.map(|(means, errors)| worst(means, errors)).fold(0.0, f64::max);
        let wanted = accuracy.relative.filter(|wanted| worst > *wanted);
        let Some(wanted) = wanted.filter(|_| events < most_events) else {
            return Found { means, errors, photons: done * BATCH as u64, events };
        };
        // As many more as the errors so far let expect, and at most what the limit of work lets expect.
        let needed = n * ((worst / wanted).powi(2) * 1.05 - 1.0);
        let allowed = (most_events - events) as f64 / (events as f64 / n).max(1.0);
        round = needed.min(allowed).clamp(8.0, 4.0 * n) as u64;
    }
}

/// One batch of photons: shares of light, node by node and bin by bin, and the scatterings followed.
fn one(parameters: &Parameters, bins: &Bins, group: &Group, mut stream: Stream) -> (Vec<f64>, u64) {
    let mut peel = Peel::new(parameters, bins, group);
    let base = group.base;
    let start = -(-base * parameters.source.mean_chord()).exp_m1();
    let (shift, spin) = (stream.uniform(), stream.uniform());
    let mut events = 0;
    for i in 0..BATCH {
        let first = (i as f64 + shift) / BATCH as f64;
        let square = if parameters.source == Source::Beam { (i as f64 * GOLDEN + spin).fract() } else { 0.0 };
        let mut place = DVec3::new(square.sqrt(), 0.0, -(1.0 - square).sqrt());
        let mut direction = DVec3::Z;
        let (mut weight, mut flown, mut order) = (1.0 / BATCH as f64, 0.0, 0);
        let mut way = 2.0 * (1.0 - square).sqrt();
        loop {
            // A flight that ends before the surface.
            let met = -(-base * way).exp_m1();
            let u = if order == 0 { first } else { stream.uniform() };
            let length = -(-u * met).ln_1p() / base;
            weight *= met * parameters.albedo;
            place += direction * length;
            flown += length;
            order += 1;
            events += 1;

            // Every direction hears of it, and so does the one in which the path goes on.
            peel.weigh(order, flown);
            peel.ring(place, direction, weight, &mut stream);
            for _ in 1..bins.drawn {
                let turn = parameters.phase.turn(stream.uniform());
                peel.along(place, turned(direction, turn, azimuth(&mut stream)), turn.0, weight);
            }
            let turn = parameters.phase.turn(stream.uniform());
            direction = turned(direction, turn, azimuth(&mut stream));
            way = peel.along(place, direction, turn.0, weight);

            // Faint paths end by chance, the others of their kind carry their weight.
            let light = LIGHT * start / BATCH as f64;
            if weight < light {
                if !stream.chance(weight / light) {
                    break;
                }
                weight = light;
            }
        }
    }
    (peel.into_sums(), events)
}

/// The bin of a cosine.
pub(super) fn bin(spacing: Spacing, count: usize, cosine: f64) -> usize {
    let place = match spacing {
        Spacing::Cosine => 0.5 * (cosine + 1.0),
        Spacing::Angle => cosine.clamp(-1.0, 1.0).acos() / std::f64::consts::PI,
    };
    ((place * count as f64) as usize).min(count - 1)
}
