//! Strips refined for several wavelengths at once, so that the same places of each can be compared.

use super::{NODES, altitude, node};
use crate::physics::refraction::ray::{Launch, Medium, Outcome, Tracer};
use crate::physics::sun::air::{Matter, Path, Takes, molecule_m2};
use crate::physics::sun::scene::{Scene, SceneError};
use crate::units::Angle;

/// A panel that has been halved so often is taken as it is.
const MOST_HALVINGS: u32 = 10;

/// A strip with more panels than this is taken as it is.
const MOST_PANELS: usize = 120;

/// A ray at the very end of a strip that does not escape is traced again so much further inside, as a share of the strip.
const NUDGES: [f64; 3] = [1e-11, 1e-8, 1e-5];

/// Deeper than this nothing is seen, whatever the error of the depth.
const BLACK: f64 = 40.0;

/// What is asked of the curves.
pub(in crate::physics::sun) struct Wanted<'s> {
    pub(in crate::physics::sun) scene: &'s Scene<'s>,
    pub(in crate::physics::sun) matter: &'s Matter,
    /// The most that each kind of matter takes at any wavelength.
    pub(in crate::physics::sun) most: Takes,
    /// Error of refraction, radians, and of depth, that panels may have.
    pub(in crate::physics::sun) refraction: f64,
    pub(in crate::physics::sun) depth: f64,
    /// True altitudes that matter, radians.
    pub(in crate::physics::sun) levels: [f64; 2],
}

/// What was done for the curves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::physics::sun) struct Effort {
    /// Rays traced.
    pub(in crate::physics::sun) rays: usize,
    /// Wavelengths at which they were traced.
    pub(in crate::physics::sun) wavelengths: usize,
    /// Panels made.
    pub(in crate::physics::sun) panels: usize,
    /// Panels not refined because the Sun cannot be seen in them.
    pub(in crate::physics::sun) unreached: usize,
    /// Panels taken as they were, because they would not become good enough.
    pub(in crate::physics::sun) given_up: usize,
    /// The largest difference between a polynomial of the fourth degree and a ray, in panels that were good enough, radians;
    /// those used have the eighth.
    pub(in crate::physics::sun) refraction: f64,
    /// The same of depths.
    pub(in crate::physics::sun) depth: f64,
    /// The largest error that the method believed it made, radians.
    pub(in crate::physics::sun) believed: f64,
    /// The last term of the polynomial between wavelengths, radians.
    pub(in crate::physics::sun) between: f64,
}

/// A strip at several wavelengths.
pub(super) struct Strips {
    pub(super) low: Vec<f64>,
    pub(super) high: Vec<f64>,
    pub(super) root: bool,
    pub(super) panels: Vec<Panels>,
}

/// A panel at several wavelengths.
pub(super) struct Panels {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) nodes: Vec<[Path; NODES]>,
}

/// Nearer to the one below than this, a critical altitude is not worth a strip.
const LEAST_GAP: Angle = Angle::arcseconds(0.5);

/// Critical altitudes of a medium that are worth a strip, radians, ascending, and their places in the list of all; with places
/// given, those, and how many there are in all.
pub(in crate::physics::sun) fn critical(
    scene: &Scene<'_>,
    medium: &Medium<'_>,
    keep: Option<&[usize]>,
) -> (Vec<f64>, Vec<usize>) {
    let all: Vec<f64> = medium.critical_altitudes(scene.observer_height_m).iter().map(|a| a.to_radians()).collect();
    if let Some(keep) = keep {
        return (keep.iter().filter_map(|i| all.get(*i).copied()).collect(), vec![all.len()]);
    }
    let gap = LEAST_GAP.to_radians();
    let mut kept: Vec<usize> = Vec::new();
    for (i, a) in all.iter().enumerate() {
        if kept.last().is_none_or(|last| a - all[*last] > gap) {
            kept.push(i);
        }
    }
    (kept.iter().map(|i| all[*i]).collect(), kept)
}

/// The strips at several wavelengths; nothing if they are not alike there.
pub(super) fn strips(wanted: &Wanted<'_>, nms: &[f64], effort: &mut Effort) -> Result<Option<Vec<Strips>>, SceneError> {
    let Wanted { scene, matter, .. } = wanted;
    let mut mediums = Vec::with_capacity(nms.len());
    for nm in nms {
        mediums.push(matter.medium(scene, *nm)?);
    }
    let fine = scene.method.name() == "exact" || scene.method.name() == "runge-kutta";
    let tolerance = if fine {
        (0.1 * wanted.refraction).max(Angle::arcseconds(1e-8).to_radians())
    } else {
        scene.tolerance.to_radians()
    };
    let mut tracers: Vec<Box<dyn Tracer + '_>> = Vec::with_capacity(nms.len());
    for medium in &mediums {
        tracers.push(scene.method.prepare(medium, Angle::radians(tolerance))?);
    }
    let (first, kept) = critical(scene, &mediums[0], None);
    let count = mediums[0].critical_altitudes(scene.observer_height_m).len();
    let mut borders = vec![first];
    for medium in &mediums[1..] {
        let (altitudes, of) = critical(scene, medium, Some(&kept));
        if of != [count] {
            return Ok(None);
        }
        borders.push(altitudes);
    }
    effort.wavelengths += nms.len();

    let (bottom, top) = (scene.view.bottom.to_radians(), scene.view.top().to_radians());
    let molecules: Vec<f64> = nms.iter().map(|nm| molecule_m2(scene, *nm)).collect();
    let mut work = Work { wanted, tracers, molecules, effort };
    let mut found = Vec::new();
    for index in (0..kept.len()).rev() {
        let last = index + 1 == kept.len();
        let (mut low, mut high): (Vec<f64>, Vec<f64>) = (
            borders.iter().map(|list| list[index]).collect(),
            borders.iter().map(|list| list.get(index + 1).copied().unwrap_or(top)).collect(),
        );
        let above = |list: &[f64], edge: f64| list.iter().all(|a| *a >= edge);
        if above(&low, top) || !high.iter().any(|a| *a > bottom) {
            continue;
        }
        if last {
            // The highest strip has no critical altitude above it.
            for a in &mut low {
                *a = a.max(bottom).min(top);
            }
            if low.iter().zip(&high).any(|(low, high)| high - low <= 0.0) {
                return Ok(None);
            }
        }
        high.iter_mut().zip(&low).for_each(|(high, low)| *high = high.max(*low));
        let Some(strip) = work.refine(low, high, !last, bottom, top)? else { return Ok(None) };
        found.push(strip);
    }
    Ok(Some(found))
}

struct Work<'w, 'e> {
    wanted: &'w Wanted<'w>,
    tracers: Vec<Box<dyn Tracer + 'w>>,
    molecules: Vec<f64>,
    effort: &'e mut Effort,
}

impl Work<'_, '_> {
    /// Halves panels of a strip until each is good enough; nothing if rays of some wavelengths escape and others do not.
    fn refine(
        &mut self,
        low: Vec<f64>,
        high: Vec<f64>,
        root: bool,
        bottom: f64,
        top: f64,
    ) -> Result<Option<Strips>, SceneError> {
        // Only what lies in the frame, at any of the wavelengths.
        let place = |a: f64, m: usize| {
            let share = ((high[m] - a) / (high[m] - low[m])).clamp(0.0, 1.0);
            if root { share.sqrt() } else { share }
        };
        let from = (0..low.len()).map(|m| place(top, m)).fold(1.0, f64::min);
        let to = (0..low.len()).map(|m| place(bottom, m)).fold(0.0, f64::max);
        let mut waiting = vec![(from, to, 0u32)];
        let mut panels = Vec::new();
        while let Some((from, to, halvings)) = waiting.pop() {
            if to <= from {
                continue;
            }
            let mut nodes = Vec::with_capacity(low.len());
            let (mut dark, mut lit) = (0, 0);
            for m in 0..low.len() {
                let mut paths = [[0.0; 6]; NODES];
                for (i, path) in paths.iter_mut().enumerate() {
                    let v = 0.5 * (from + to) + 0.5 * (to - from) * node(i);
                    match self.trace(m, &low, &high, root, v)? {
                        Some(traced) => (*path, lit) = (traced, lit + 1),
                        None => dark += 1,
                    }
                }
                nodes.push(paths);
            }
            let last = halvings >= MOST_HALVINGS || panels.len() + waiting.len() >= MOST_PANELS;
            let middle = 0.5 * (from + to);
            if lit == 0 || (dark > 0 && last) {
                continue;
            }
            if dark > 0 {
                if low.len() > 1 {
                    return Ok(None);
                }
                waiting.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
                continue;
            }
            self.effort.panels += 1;
            let panel = Panels { from, to, nodes };
            if !self.reaches(&panel, &low, &high, root) {
                self.effort.unreached += 1;
                panels.push(panel);
                continue;
            }
            let (refraction, depth) = self.error(&panel);
            if refraction <= self.wanted.refraction && depth <= self.wanted.depth {
                self.effort.refraction = self.effort.refraction.max(refraction);
                self.effort.depth = self.effort.depth.max(depth);
                panels.push(panel);
            } else if last {
                self.effort.given_up += 1;
                panels.push(panel);
            } else {
                self.effort.panels -= 1;
                waiting.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
            }
        }
        Ok(Some(Strips { low, high, root, panels }))
    }

    /// The path of the ray at a v; nothing if it does not escape.
    fn trace(&mut self, m: usize, low: &[f64], high: &[f64], root: bool, v: f64) -> Result<Option<Path>, SceneError> {
        let scene = self.wanted.scene;
        let inwards = if v > 0.5 { -1.0 } else { 1.0 };
        for nudge in std::iter::once(0.0).chain(NUDGES) {
            if nudge > 0.0 && v > 1e-9 && v < 1.0 - 1e-9 {
                break;
            }
            let altitude = altitude(low[m], high[m], root, v) - inwards * nudge * (high[m] - low[m]);
            let launch = Launch { apparent_altitude: Angle::radians(altitude), height_m: scene.observer_height_m };
            let ray = self.tracers[m].trace(&launch)?;
            self.effort.rays += 1;
            if ray.outcome == Outcome::Escaped {
                self.effort.believed = self.effort.believed.max(ray.believed_error.to_radians());
                return Ok(Some(self.wanted.matter.path(&ray, self.molecules[m])));
            }
        }
        Ok(None)
    }

    /// Whether the levels that matter may be met in a panel: what its points span, and half as much again on both sides.
    fn reaches(&self, panel: &Panels, low: &[f64], high: &[f64], root: bool) -> bool {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (m, nodes) in panel.nodes.iter().enumerate() {
            for (i, path) in nodes.iter().enumerate() {
                let v = 0.5 * (panel.from + panel.to) + 0.5 * (panel.to - panel.from) * node(i);
                let truth = altitude(low[m], high[m], root, v) - path[0];
                (least, most) = (least.min(truth), most.max(truth));
            }
        }
        let margin = 0.5 * (most - least);
        least - margin <= self.wanted.levels[1] && most + margin >= self.wanted.levels[0]
    }

    /// How far the polynomial through every second point is from the points between.
    fn error(&self, panel: &Panels) -> (f64, f64) {
        let (mut refraction, mut depth) = (0f64, 0f64);
        for nodes in &panel.nodes {
            for i in (1..NODES).step_by(2) {
                let wrong = skipped(nodes, i);
                refraction = refraction.max(wrong[0].abs());
                if self.wanted.most.depth(&nodes[i]) < BLACK {
                    depth = depth.max(self.wanted.most.depth(&wrong.map(f64::abs)));
                }
            }
        }
        (refraction, depth)
    }
}

/// The polynomial of the fourth degree through every second node, at another node, less what is there.
fn skipped(nodes: &[Path; NODES], at: usize) -> Path {
    let x = node(at);
    let (mut sum, mut weights) = ([0.0; 6], 0.0);
    for i in (0..NODES).step_by(2) {
        let half = if i == 0 || i == NODES - 1 { 0.5 } else { 1.0 };
        let weight = if i % 4 == 0 { half } else { -half } / (x - node(i));
        weights += weight;
        for (part, value) in sum.iter_mut().zip(&nodes[i]) {
            *part += weight * value;
        }
    }
    std::array::from_fn(|k| sum[k] / weights - nodes[at][k])
}
