//! Places of strong change: the largest gradients along their own direction, to a part of a pixel.

use super::frame::Frame;

/// A place where dark turns bright.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Unit vector to the bright side.
    pub(super) inward: (f64, f64),
    /// Change a pixel.
    pub(super) steepness: f64,
}

/// Canny's ridge of gradients (1986, IEEE PAMI 8, 679) where they are steeper than `least` a pixel, without hysteresis: what
/// does not lie on the circle is dropped later.
pub(super) fn edges(frame: &Frame, least: f64) -> Vec<Edge> {
    let (width, height) = (frame.width(), frame.height());
    let gradient = |x: usize, y: usize| {
        let across = (frame.pixel(x + 1, y) - frame.pixel(x - 1, y)) / 2.0;
        let down = (frame.pixel(x, y + 1) - frame.pixel(x, y - 1)) / 2.0;
        (across, down)
    };
    let steep = |x: usize, y: usize| {
        let (across, down) = gradient(x, y);
        across.hypot(down)
    };
    let mut found = Vec::new();
    for y in 3..height.saturating_sub(3) {
        for x in 3..width.saturating_sub(3) {
            let (across, down) = gradient(x, y);
            let here = across.hypot(down);
            if here < least {
                continue;
            }
            let inward = (across / here, down / here);
            let whole = (inward.0.round() as isize, inward.1.round() as isize);
            let ahead = steep(x.saturating_add_signed(whole.0), y.saturating_add_signed(whole.1));
            let behind = steep(x.saturating_add_signed(-whole.0), y.saturating_add_signed(-whole.1));
            if here < ahead || here <= behind {
                continue;
            }
            // The top of the parabola through the three.
            let bend = ahead - 2.0 * here + behind;
            let off = if bend < 0.0 { (0.5 * (behind - ahead) / bend).clamp(-0.5, 0.5) } else { 0.0 };
            let length = (whole.0 as f64).hypot(whole.1 as f64);
            found.push(Edge {
                x: x as f64 + 0.5 + off * length * inward.0,
                y: y as f64 + 0.5 + off * length * inward.1,
                inward,
                steepness: here,
            });
        }
    }
    found
}
