//! The first guess of the limb's circle: the circle on which most edges lie, whatever craters, the terminator and the
//! picture's own borders add.

use super::edges::{Edge, edges};
use super::frame::{FULL, Frame, MoonError};
use super::linear::Normal;
use crate::numerics::streams::Stream;

/// A circle in a photograph, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Circle {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) radius: f64,
}

/// The search is made on a picture of about so many pixels a side.
const SIDE: usize = 480;
/// Circles through three edges that are tried.
const TRIALS: usize = 20_000;
/// So many of the steepest edges are tried.
const MOST_EDGES: usize = 2500;
/// An edge belongs to a circle within so many (reduced) pixels.
const NEAR_PX: f64 = 1.3;
/// An arc must rise so many (reduced) pixels over its chord: less is a straight line.
const LEAST_RISE_PX: f64 = 4.0;
/// The least arc, degrees.
const LEAST_ARC_DEG: f64 = 24.0;
/// The seed of the trials: one photograph always gives one circle.
const SEED: u64 = 0x4d6f_6f6e;

/// Finds the limb to about a pixel of the reduced photograph; with it, how far the circle can be believed, in pixels, and the
/// degrees of arc that it has.
///
/// # Errors
/// Too bright, too dark, or no circle.
pub(super) fn circle(frame: &Frame) -> Result<(Circle, f64, f64), MoonError> {
    let factor = frame.width().max(frame.height()).div_ceil(SIDE).max(1);
    let small = frame.reduced(factor);
    let noise = small.noise();
    let small = small.softened();
    let [low, high] = small.quantiles([0.005, 0.995]);
    let full = frame.values().iter().filter(|value| **value >= FULL).count() as f64 / frame.values().len() as f64;
    if full > 0.98 {
        return Err(MoonError::Saturated { percent: 100.0 * full });
    }
    let contrast = high - low;
    if contrast < (6.0 * noise).max(0.02) {
        return Err(MoonError::Dark { contrast, noise });
    }
    // Softening leaves a quarter of the noise, so this is five times what it makes of gradients.
    let mut edges = edges(&small, (0.05 * contrast).max(noise));
    edges.sort_by(|a, b| b.steepness.total_cmp(&a.steepness));
    let found = best(&edges, (small.width() as f64).hypot(small.height() as f64));
    let (circle, arc_deg) = found.ok_or_else(|| no_limb(0.0))?;
    if arc_deg < LEAST_ARC_DEG {
        return Err(no_limb(arc_deg));
    }
    let factor = factor as f64;
    let large = Circle { x: circle.x * factor, y: circle.y * factor, radius: circle.radius * factor };
    Ok((large, 1.5 * factor, arc_deg))
}

fn no_limb(arc_deg: f64) -> MoonError {
    MoonError::NoLimb { found: format!("{arc_deg:.0} degrees"), wanted: format!("{LEAST_ARC_DEG:.0}") }
}

/// The circle with most edges, and the degrees of arc on which it has them. The steepest come first, and are tried most: a full
/// Moon has twenty edges of craters for one of a short arc of limb, but none so steep.
fn best(edges: &[Edge], diagonal: f64) -> Option<(Circle, f64)> {
    if edges.len() < 12 {
        return None;
    }
    let some = &edges[..edges.len().min(MOST_EDGES)];
    let mut stream = Stream::seeded(SEED);
    let mut pick = || some[((stream.uniform().powi(2) * some.len() as f64) as usize).min(some.len() - 1)];
    let mut best: Option<(Circle, usize)> = None;
    for _ in 0..TRIALS {
        let three = [pick(), pick(), pick()];
        let Some(circle) = through(&three) else { continue };
        if !(16.0..1.5 * diagonal).contains(&circle.radius) || !three.iter().all(|edge| looks_in(edge, &circle)) {
            continue;
        }
        let votes = some.iter().filter(|edge| belongs(edge, &circle)).count();
        if votes > best.map_or(8, |(_, most)| most) {
            let arc = arc_deg(some, &circle);
            if circle.radius * (1.0 - (arc.min(180.0) / 2.0).to_radians().cos()) >= LEAST_RISE_PX {
                best = Some((circle, votes));
            }
        }
    }
    let mut circle = best?.0;
    for _ in 0..4 {
        let mut normal = Normal::<3>::new();
        for edge in edges.iter().filter(|edge| belongs(edge, &circle)) {
            let (dx, dy) = (edge.x - circle.x, edge.y - circle.y);
            let away = dx.hypot(dy).max(1e-9);
            normal.add(&[dx / away, dy / away, 1.0], away - circle.radius, 1.0);
        }
        let ([x, y, radius], _) = normal.solve()?;
        circle = Circle { x: circle.x + x, y: circle.y + y, radius: circle.radius + radius };
    }
    Some((circle, arc_deg(edges, &circle)))
}

/// The circle through three places.
fn through(three: &[Edge; 3]) -> Option<Circle> {
    let [a, b, c] = three;
    let (bx, by, cx, cy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    let twice = 2.0 * (bx * cy - by * cx);
    if twice.abs() < 40.0 {
        return None;
    }
    let (b2, c2) = (bx * bx + by * by, cx * cx + cy * cy);
    let (x, y) = ((cy * b2 - by * c2) / twice, (bx * c2 - cx * b2) / twice);
    Some(Circle { x: a.x + x, y: a.y + y, radius: x.hypot(y) })
}

/// Whether an edge's bright side is the circle's inside.
fn looks_in(edge: &Edge, circle: &Circle) -> bool {
    let (dx, dy) = (circle.x - edge.x, circle.y - edge.y);
    edge.inward.0 * dx + edge.inward.1 * dy > 0.85 * (dx * dx + dy * dy).sqrt()
}

fn belongs(edge: &Edge, circle: &Circle) -> bool {
    // Nearly all of the search's time is spent here: no root for what is far away.
    let away2 = (edge.x - circle.x).powi(2) + (edge.y - circle.y).powi(2);
    let (within, beyond) = ((circle.radius - NEAR_PX).powi(2), (circle.radius + NEAR_PX).powi(2));
    within < away2 && away2 < beyond && looks_in(edge, circle)
}

/// Degrees of arc with edges, counted by two.
fn arc_deg(edges: &[Edge], circle: &Circle) -> f64 {
    let mut seen = [false; 180];
    for edge in edges.iter().filter(|edge| belongs(edge, circle)) {
        let angle = (edge.y - circle.y).atan2(edge.x - circle.x).to_degrees().rem_euclid(360.0);
        seen[(angle / 2.0) as usize % 180] = true;
    }
    2.0 * seen.iter().filter(|seen| **seen).count() as f64
}
