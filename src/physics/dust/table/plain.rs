//! A table as appendix A makes it: row by row, photons followed until they leave or are too faint, each counted in the bin it leaves by.

use rayon::prelude::*;

use super::{Accuracy, Made, Parameters, Table, TableError, shared, worst};
use crate::numerics::streams::Stream;
use crate::physics::dust::sphere::Sphere;
use crate::physics::dust::sphere::walk::{Rules, follow};

/// Photons that share a random stream.
const BATCH: u64 = 4096;
/// Batches after which errors are first looked at.
const LEAST_BATCHES: u64 = 16;
/// Batches between two looks at most.
const MOST_BATCHES: u64 = 4096;

/// A row: the unscattered share, the bins, and the standard error of each.
struct Row {
    unscattered: [f64; 2],
    bins: Vec<f64>,
    errors: Vec<f64>,
    photons: u64,
    events: u64,
}

/// Makes a table; `told` hears the share that is done.
///
/// # Errors
/// The table or its accuracy is none that can be.
pub fn make(
    parameters: &Parameters,
    accuracy: &Accuracy,
    rules: &Rules,
    seed: u64,
    told: &mut dyn FnMut(f64),
) -> Result<Made, TableError> {
    parameters.checked()?;
    accuracy.checked()?;
    let count = parameters.directions;
    let (mut bins, mut errors) = (vec![0.0; count], vec![0.0; count]);
    let (mut unscattered, mut photons, mut events) = (vec![[1.0, 0.0]], 0, 0);
    let share = accuracy.most_events / parameters.depths as u64;
    for index in 1..parameters.depths {
        let row = row(parameters, index, accuracy, rules, share, seed);
        unscattered.push(row.unscattered);
        bins.extend(row.bins);
        errors.extend(row.errors);
        photons += row.photons;
        events += row.events;
        told(index as f64 / (parameters.depths - 1) as f64);
    }
    let table = Table::new(*parameters, unscattered, bins, errors).ok_or(TableError::Deepest(parameters.deepest))?;
    Ok(Made { table, photons, events })
}

/// Sums of a batch: photons unscattered; weights and their squares for each bin; scatterings.
struct Sums {
    passed: f64,
    bins: Vec<[f64; 2]>,
    events: u64,
}

fn row(parameters: &Parameters, index: usize, accuracy: &Accuracy, rules: &Rules, most_events: u64, seed: u64) -> Row {
    let Parameters { albedo, phase, source, spacing, directions, .. } = *parameters;
    let sphere = Sphere { depth: parameters.radius_depth(index), albedo, phase, source };
    let seed = seed ^ (index as u64).wrapping_mul(0x9e37_79b9);
    let batch = |batch: u64| {
        let mut stream = Stream::part(seed, batch);
        let mut sums = Sums { passed: 0.0, bins: vec![[0.0; 2]; directions], events: 0 };
        for _ in 0..BATCH {
            let fate = follow(&sphere, rules, &mut stream);
            sums.events += fate.scatterings;
            if fate.scatterings == 0 {
                sums.passed += 1.0;
            } else {
                let bin = &mut sums.bins[shared::bin(spacing, directions, fate.cosine)];
                bin[0] += fate.escaped;
                bin[1] += fate.escaped * fate.escaped;
            }
        }
        sums
    };
    let mut all = Sums { passed: 0.0, bins: vec![[0.0; 2]; directions], events: 0 };
    let (mut done, mut round) = (0, accuracy.photons.map_or(LEAST_BATCHES, |photons| photons.div_ceil(BATCH)));
    loop {
        let parts: Vec<Sums> = (done..done + round).into_par_iter().map(batch).collect();
        // In the order of the batches, so that any number of threads gives the same bits.
        for part in &parts {
            all.passed += part.passed;
            all.events += part.events;
            for (sum, more) in all.bins.as_flattened_mut().iter_mut().zip(part.bins.as_flattened()) {
                *sum += more;
            }
        }
        done += round;
        let n = (done * BATCH) as f64;
        // A bin that no photon took is not certain to be dark: one photon more, of the first scattering's weight, bounds it.
        let error = |sum: f64, square: f64, most: f64| {
            let mean = (sum + most) / (n + 1.0);
            (((square + most * most) / (n + 1.0) - mean * mean).max(0.0) / n).sqrt()
        };
        let bins: Vec<f64> = all.bins.iter().map(|[sum, _]| sum / n).collect();
        let errors: Vec<f64> = all.bins.iter().map(|[sum, square]| error(*sum, *square, albedo)).collect();
        let worst = worst(&bins, &errors);
        let wanted = accuracy.relative.filter(|wanted| worst > *wanted && albedo > 0.0);
        let Some(wanted) = wanted.filter(|_| all.events < most_events) else {
            let unscattered = [all.passed / n, error(all.passed, all.passed, 1.0)];
            return Row { unscattered, bins, errors, photons: done * BATCH, events: all.events };
        };
        let needed = done as f64 * ((worst / wanted).powi(2) - 1.0);
        round = (needed as u64).clamp(LEAST_BATCHES, MOST_BATCHES.max(done));
    }
}
