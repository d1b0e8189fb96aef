//! How fine the rays of a picture must be: tried out on some of its rays against the exact ones.

use super::{Explained, Subject, View, Wish, difference};
use crate::numerics::streams::Stream;
use crate::physics::dust::camera::Ray;
use crate::physics::dust::light::cells;
use crate::physics::dust::light::lattice::{self, Lattice};
use crate::physics::dust::march::{Enough, Fineness, Gathered, March, Tally};
use crate::physics::dust::model::Scattering;
use crate::physics::dust::scene::Scene;
use crate::physics::dust::single::Single;
use crate::physics::dust::volume::Volume;

/// Rays that are compared.
const PROBES: usize = 128;
/// Places looked at for rays that meet the box.
const PLACES: usize = 4096;
/// The rung of the ladder that rays are held against.
const TRUTH: usize = 4;
/// Darker pixels than this share of the picture's mean are judged as if they had it.
const FLOOR: f64 = 0.01;
/// Radiance below this share of the stars' intensity over the box's face is no light.
const DARKEST: f64 = 1e-15;
/// Columns that a lattice may hold: 4 bytes each.
const MOST_COLUMNS: usize = 200_000_000;

/// What was chosen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    pub(super) fineness: Fineness,
    /// Radiance in each band below which errors are not relative.
    pub(super) floor: Vec<f64>,
    probes: usize,
    worst: f64,
    mean: f64,
}

impl Plan {
    /// The coarsest rung of the ladder that keeps to half of the tolerance on every probe; the other half is for the average over a pixel.
    pub(super) fn new(subject: &Subject<'_>, view: &View, wish: &Wish) -> Plan {
        let rays = probes(subject.volume, view, wish.seed);
        let finest = Fineness::LADDER[TRUTH];
        let enough = enough(subject, wish);
        let gather = |model: &dyn Scattering, fineness| gather(subject, model, fineness, &enough, view.near, &rays);
        let truth = gather(subject.exact, finest);
        let floor = floor(&truth, &enough);
        let against = |got: &[Gathered], truth: &[Gathered]| {
            let each = got.iter().zip(truth).map(|(got, truth)| difference(&got.radiance, &truth.radiance, &floor));
            let (worst, sum) = each.fold((0.0f64, 0.0), |(worst, sum), error| (worst.max(error), sum + error));
            (worst, sum / rays.len().max(1) as f64)
        };
        let errors = |fineness| against(&gather(subject.model, fineness), &truth);
        let made = |fineness, (worst, mean)| Plan { fineness, floor: floor.clone(), probes: rays.len(), worst, mean };
        if wish.everything {
            // Its own error is that of the truth: what halving the pieces again would change.
            let finer = gather(subject.exact, finest.finer());
            return made(finest, against(&truth, &finer));
        }
        if let Some(step) = wish.step {
            let fineness = Fineness::of_step(step);
            return made(fineness, errors(fineness));
        }
        let mut best = made(Fineness::LADDER[0], (f64::INFINITY, f64::INFINITY));
        for fineness in Fineness::LADDER.into_iter().take(TRUTH) {
            let reached = errors(fineness);
            // A finer rung that is hardly better (the lattice's error is what remains) is not worth its time.
            if reached.0 < 0.8 * best.worst {
                best = made(fineness, reached);
            }
            if best.worst <= 0.5 * wish.tolerance {
                return best;
            }
        }
        // Not even the rung before the truth will do: the truth itself, held against what is finer still.
        for fineness in Fineness::LADDER.into_iter().skip(TRUTH) {
            let reached = against(&gather(subject.model, fineness), &gather(subject.exact, fineness.finer()));
            if reached.0 < 0.8 * best.worst {
                best = made(fineness, reached);
            }
            if best.worst <= 0.5 * wish.tolerance {
                break;
            }
        }
        best
    }

    pub(super) fn explained(&self) -> Explained {
        Explained {
            fineness: self.fineness,
            probes: self.probes,
            worst_ray: self.worst,
            mean_ray: self.mean,
            worst: 0.0,
            mean: 0.0,
            lit: 0,
            one_ray: 0,
            missed: 0,
            starred: 0,
            given_up: 0,
            tally: Tally::default(),
        }
    }
}

/// Rays of some places of the picture that meet the box.
fn probes(volume: &Volume, view: &View, seed: u64) -> Vec<Ray> {
    let mut stream = Stream::seeded(seed);
    let mut place = |side: usize| stream.uniform() * side as f64;
    let places = PLACES.min(64 * view.width * view.height);
    (0..places)
        .filter_map(|_| view.camera.ray(place(view.width), place(view.height), view.width, view.height))
        .filter(|ray| cells::inside(volume, ray, view.near, f64::INFINITY).is_some())
        .take(PROBES)
        .collect()
}

fn gather(
    subject: &Subject<'_>,
    model: &dyn Scattering,
    fineness: Fineness,
    enough: &Enough,
    near: f64,
    rays: &[Ray],
) -> Vec<Gathered> {
    use rayon::prelude::*;
    let march = March {
        volume: subject.volume,
        scene: subject.scene,
        model,
        emission: subject.emission,
        densest: subject.densest(),
        fineness,
        enough: Some(enough),
        bricks: None,
    };
    rays.par_iter().map(|ray| march.gather(ray, near)).collect()
}

/// Rays that are compared end where what is still to come is far below the tolerance, or below any light that the stars could be said to
/// give: a star in dust a thousand deep is not followed to where its light underflows.
fn enough(subject: &Subject<'_>, wish: &Wish) -> Enough {
    let area = subject.volume.edges().max_element().powi(2);
    let light = |band: usize| subject.scene.stars().iter().map(|star| star.intensity[band]).sum::<f64>();
    let floor = (0..subject.scene.bands()).map(|band| (DARKEST * light(band) / area).max(1e-280)).collect();
    Enough { share: 1e-3 * wish.tolerance, floor }
}

/// A share of the probes' mean, in each band.
fn floor(truth: &[Gathered], least: &Enough) -> Vec<f64> {
    let mean = |band: usize| truth.iter().map(|got| got.radiance[band]).sum::<f64>() / truth.len().max(1) as f64;
    least.floor.iter().enumerate().map(|(band, least)| (FLOOR * mean(band)).max(*least)).collect()
}

/// A lattice of columns that is fine enough, or none where the columns of every point cost less.
///
/// Tried on a few rays without being filled: the spacings along the longest side, and the worst relative error that they make on those
/// rays.
#[must_use]
pub fn lattice_for(volume: &Volume, scene: &Scene, view: &View, wish: &Wish) -> Option<(usize, f64)> {
    let exact = Single::exact(volume, scene);
    let subject = Subject { volume, scene, model: &exact, exact: &exact, emission: None };
    let mut rays = probes(volume, view, wish.seed);
    rays.truncate(PROBES / 4);
    if wish.everything || rays.is_empty() || scene.stars().is_empty() {
        return None;
    }
    let fineness = Fineness::LADDER[1];
    let enough = enough(&subject, wish);
    let truth = gather(&subject, &exact, fineness, &enough, view.near, &rays);
    let floor = floor(&truth, &enough);
    let sources: u64 = truth.iter().map(|got| got.tally.sources).sum();
    // Tight tolerances ask for some rays a pixel and for finer ones than are tried here.
    let expected = (0.03 / wish.tolerance).clamp(3.0, 30.0) * sources as f64 / rays.len() as f64
        * (view.width * view.height) as f64;
    let mut spacings = 16;
    while lattice::points(volume, spacings) * scene.stars().len() <= MOST_COLUMNS
        && lattice::points(volume, spacings) as f64 <= expected
    {
        let lattice = Lattice::untried(volume, scene.stars(), spacings);
        let model = Single::quick(volume, scene, &lattice);
        let got = gather(&subject, &model, fineness, &enough, view.near, &rays);
        let each = got.iter().zip(&truth).map(|(got, truth)| difference(&got.radiance, &truth.radiance, &floor));
        let worst = each.fold(0.0, f64::max);
        if worst <= 0.3 * wish.tolerance {
            return Some((spacings, worst));
        }
        spacings *= 2;
    }
    None
}
