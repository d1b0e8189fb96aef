//! Rows of like depth, whose light is found together at a few depths and interpolated between these.

use std::ops::Range;

use super::Parameters;

/// Depths of a group at which light is found. Between them its rows are polynomials of one degree less: over a group the light changes by
/// some 20 %, and what the polynomial leaves is far below 1e-3 of it (tested path by path).
const NODES: usize = 6;

/// How far a path may be from the depth it was drawn at: its weight there spreads by about this much.
const SPREAD: f64 = 0.3;

/// Rows of like depth.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Group {
    /// The rows.
    pub(super) rows: Range<usize>,
    /// Depths along the sphere's radius at which light is found, evenly spaced, rising.
    pub(super) depths: Vec<f64>,
    /// The depth at which paths are drawn.
    pub(super) base: f64,
}

impl Group {
    /// What stands at the nodes, as the polynomial through them at a depth.
    pub(super) fn interpolate(&self, depth: f64, nodes: &[f64], into: &mut [f64]) {
        for (k, node) in nodes.chunks(into.len()).enumerate() {
            let others = self.depths.iter().enumerate().filter(|(i, _)| *i != k);
            let weight: f64 = others.map(|(_, other)| (depth - other) / (self.depths[k] - other)).product();
            into.iter_mut().zip(node).for_each(|(sum, x)| *sum += weight * x);
        }
    }

    /// What stands at the nodes, linear between the two neighbours of a depth: for errors, which are never below 0.
    pub(super) fn between(&self, depth: f64, nodes: &[f64], into: &mut [f64]) {
        let count = into.len();
        let high = self.depths.partition_point(|node| *node < depth).clamp(1, self.depths.len().max(2) - 1);
        let Some((low, high)) = self.depths.get(high).map(|top| (high - 1, (high, *top))) else {
            into.copy_from_slice(&nodes[..count]);
            return;
        };
        let part = ((depth - self.depths[low]) / (high.1 - self.depths[low])).clamp(0.0, 1.0);
        for (j, x) in into.iter_mut().enumerate() {
            *x = nodes[low * count + j] * (1.0 - part) + nodes[high.0 * count + j] * part;
        }
    }
}

/// The rows of a table above depth 0 in groups, from the thinnest.
pub(super) fn groups(parameters: &Parameters) -> Vec<Group> {
    let mut groups = Vec::new();
    let mut end = parameters.depths;
    while end > 1 {
        let thick = parameters.radius_depth(end - 1);
        // A photon of a thick sphere scatters some 2 t times, and each time its weight at another depth spreads more.
        let half = SPREAD / (1.0 + 2.0 * thick).sqrt();
        let thin = thick * (1.0 - half) / (1.0 + half);
        let mut begin = end - 1;
        while begin > 1 && parameters.radius_depth(begin - 1) >= thin {
            begin -= 1;
        }
        let (thin, count) = (parameters.radius_depth(begin), (end - begin).min(NODES));
        let step = (thick - thin) / (count.max(2) - 1) as f64;
        let depths = (0..count).map(|k| thin + step * k as f64).collect();
        groups.push(Group { rows: begin..end, depths, base: 0.5 * (thin + thick) });
        end = begin;
    }
    groups.reverse();
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_above_zero_is_in_one_group() {
        for (depths, deepest) in [(1000, 10.0), (2, 10.0), (3, 1e-6), (100_000, 1000.0), (7, 1e4)] {
            let parameters = Parameters { depths, deepest, directions: 2, ..Parameters::thesis().unwrap() };
            let mut next = 1;
            for group in groups(&parameters) {
                assert_eq!(group.rows.start, next);
                assert!(!group.depths.is_empty() && group.base > 0.0);
                next = group.rows.end;
            }
            assert_eq!(next, depths);
        }
    }

    #[test]
    fn rows_between_nodes_follow_light_of_many_orders() {
        let parameters = Parameters { directions: 2, ..Parameters::thesis().unwrap() };
        for group in groups(&parameters) {
            // Of the n scatterings and the whole way of a path, n is near way x depth, and off it by some roots of n.
            for (order, off) in [(1, -1.0), (1, 2.0), (4, -2.0), (4, 2.0), (15, -2.0), (15, 0.0), (15, 2.0)] {
                if f64::from(order) > 1.0 + 4.0 * group.base {
                    continue;
                }
                let way = (f64::from(order) + off * f64::from(order).sqrt()) / group.base;
                let light = |t: f64| (t / group.base).powi(order) * (-way * (t - group.base)).exp();
                let nodes: Vec<f64> = group.depths.iter().flat_map(|t| [light(*t), 1.0]).collect();
                for row in group.rows.clone() {
                    let depth = parameters.radius_depth(row);
                    let (mut found, mut plain) = ([0.0; 2], [0.0; 2]);
                    group.interpolate(depth, &nodes, &mut found);
                    group.between(depth, &nodes, &mut plain);
                    assert!((found[0] / light(depth) - 1.0).abs() < 1e-3, "{depth} {order} {off}: {found:?}");
                    assert!((found[1] - 1.0).abs() < 1e-12 && plain[1] == 1.0);
                }
            }
        }
    }
}
