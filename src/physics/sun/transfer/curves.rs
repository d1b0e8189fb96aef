//! Curves for all wavelengths of a picture, from few traced ones: what rays gather is a smooth function of the refractivity
//! of the air, which is what tells the wavelengths apart.

use super::strips::{Effort, Strips, Wanted, critical, strips};
use super::{NODES, Panel, Strip, Transfer};
use crate::physics::sun::air::Path;
use crate::physics::sun::scene::SceneError;
use crate::physics::sun::wavelengths::{Sample, wavelength_of};

/// Wavelengths that are traced in place of many.
const TRACED: usize = 6;

/// All curves, and what was done for them.
pub(in crate::physics::sun) struct Curves {
    /// One for each sample.
    pub(in crate::physics::sun) transfers: Vec<Transfer>,
    /// What was done.
    pub(in crate::physics::sun) effort: Effort,
}

/// The curves of samples.
pub(in crate::physics::sun) fn curves(wanted: &Wanted<'_>, samples: &[Sample]) -> Result<Curves, SceneError> {
    let mut effort = Effort::default();
    if samples.len() > TRACED
        && let Some(transfers) = between(wanted, samples, &mut effort)?
    {
        return Ok(Curves { transfers, effort });
    }
    // Few wavelengths, or wavelengths of different kinds (a duct for some of them): each by itself.
    let mut transfers = Vec::with_capacity(samples.len());
    effort = Effort { rays: effort.rays, ..Effort::default() };
    for sample in samples {
        let found = strips(wanted, &[sample.nm], &mut effort)?.unwrap_or_default();
        transfers.push(Transfer { strips: found.into_iter().map(alone).collect() });
    }
    Ok(Curves { transfers, effort })
}

fn alone(strips: Strips) -> Strip {
    let panel = |panel: super::strips::Panels| {
        panel.nodes.first().map(|nodes| Panel { from: panel.from, to: panel.to, nodes: *nodes })
    };
    Strip {
        low: strips.low[0],
        high: strips.high[0],
        root: strips.root,
        panels: ordered(strips.panels.into_iter().filter_map(panel).collect()),
    }
}

fn ordered(mut panels: Vec<Panel>) -> Vec<Panel> {
    panels.sort_by(|a, b| a.from.total_cmp(&b.from));
    panels
}

/// The curves of samples from those at [`TRACED`] wavelengths; nothing if that would not be good enough.
fn between(wanted: &Wanted<'_>, samples: &[Sample], effort: &mut Effort) -> Result<Option<Vec<Transfer>>, SceneError> {
    let refractivities = samples.iter().map(|sample| sample.refractivity);
    let (least, most) = refractivities.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    // Chebyshev's points of the first kind, a little beyond the samples so that nothing is extrapolated.
    let places: [f64; TRACED] = std::array::from_fn(|i| {
        let x = (std::f64::consts::PI * (i as f64 + 0.5) / TRACED as f64).cos();
        0.5 * (least + most) + 0.5 * (most - least) * x
    });
    let nms = places.map(wavelength_of);
    let Some(found) = strips(wanted, &nms, effort)? else { return Ok(None) };

    // The last term of Newton's polynomial is more than the error of the whole.
    let highest: [f64; TRACED] = std::array::from_fn(|m| {
        let others = places.iter().enumerate().filter(|(k, _)| *k != m);
        1.0 / others.map(|(_, place)| places[m] - place).product::<f64>()
    });
    let reach = 2.0 * (0.25 * (most - least)).powi(TRACED as i32 - 1);
    for panel in found.iter().flat_map(|strip| &strip.panels) {
        for i in 0..NODES {
            let term: f64 = highest.iter().zip(&panel.nodes).map(|(d, nodes)| d * nodes[i][0]).sum();
            effort.between = effort.between.max(term.abs() * reach);
        }
    }
    if effort.between > wanted.refraction {
        return Ok(None);
    }

    let mut transfers = Vec::with_capacity(samples.len());
    let first = wanted.matter.medium(wanted.scene, nms[0])?;
    let (_, kept) = critical(wanted.scene, &first, None);
    let count = first.critical_altitudes(wanted.scene.observer_height_m).len();
    for sample in samples {
        let medium = wanted.matter.medium(wanted.scene, sample.nm)?;
        let (borders, of) = critical(wanted.scene, &medium, Some(&kept));
        if of != [count] {
            return Ok(None);
        }
        let shares: [f64; TRACED] = std::array::from_fn(|m| {
            let others = places.iter().enumerate().filter(|(k, _)| *k != m);
            others.map(|(_, place)| (sample.refractivity - place) / (places[m] - place)).product()
        });
        let mixed = |list: &[f64]| list.iter().zip(shares).map(|(value, share)| value * share).sum::<f64>();
        let strips = found.iter().map(|strip| {
            let panels = strip.panels.iter().map(|panel| {
                let mut nodes: [Path; NODES] = [[0.0; 6]; NODES];
                for (traced, share) in panel.nodes.iter().zip(shares) {
                    for (node, traced) in nodes.iter_mut().zip(traced) {
                        node.iter_mut().zip(traced).for_each(|(value, traced)| *value += share * traced);
                    }
                }
                Panel { from: panel.from, to: panel.to, nodes }
            });
            // The borders are known without tracing; where the frame cuts a strip, they are the frame's.
            let nearest = |value: f64| {
                let close = borders.iter().copied().min_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()));
                close.filter(|border| (border - value).abs() < wanted.refraction).unwrap_or(value)
            };
            Strip {
                low: nearest(mixed(&strip.low)),
                high: nearest(mixed(&strip.high)),
                root: strip.root,
                panels: ordered(panels.collect()),
            }
        });
        transfers.push(Transfer { strips: strips.collect() });
    }
    Ok(Some(transfers))
}
