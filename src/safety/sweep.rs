//! All the ways that two axes can take from one place to another, at once: how close can any of them come to a point?
//!
//! A mount turns its two axes one after the other, in either order, or together at speeds that nobody outside knows. As long
//! as each axis turns only from where it is to where it goes, every such way lies in one rectangle of axis angles. So the
//! whole rectangle is judged, in closed form: no way is missed, and nothing can slip between samples.

use crate::units::Angle;

/// A direction as the mount's two axes have it: the turning axis (azimuth, or hour angle) and the tilting one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisAngles {
    pub(super) turning: Angle,
    pub(super) tilting: Angle,
}

impl AxisAngles {
    /// Angle on the sky to another direction.
    pub(super) fn separation(&self, other: &AxisAngles) -> Angle {
        Sweep { from: self.turning, turn: Angle::ZERO, low: self.tilting, high: self.tilting }.closest(other)
    }
}

/// A rectangle of axis angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sweep {
    from: Angle,
    turn: Angle,
    low: Angle,
    high: Angle,
}

impl Sweep {
    /// From a place, turning by `turn` (signed, any amount) and tilting to `tilt`.
    pub(super) fn new(from: &AxisAngles, turn: Angle, tilt: Angle) -> Sweep {
        Sweep { from: from.turning, turn, low: from.tilting.min(tilt), high: from.tilting.max(tilt) }
    }

    /// From one place to another the shorter way round.
    pub(super) fn shorter(from: &AxisAngles, to: &AxisAngles) -> Sweep {
        Sweep::new(from, (to.turning - from.turning).wrapped_signed(), to.tilting)
    }

    /// From one place to another the longer way round.
    pub(super) fn longer(from: &AxisAngles, to: &AxisAngles) -> Sweep {
        let shorter = (to.turning - from.turning).wrapped_signed();
        let back = Angle::degrees(if shorter > Angle::ZERO { -360.0 } else { 360.0 });
        Sweep::new(from, shorter + back, to.tilting)
    }

    /// How far the turning axis goes.
    pub(super) fn turn(&self) -> Angle {
        self.turn
    }

    /// The closest that any point of the rectangle comes to `point` on the sky.
    ///
    /// ```text
    /// cos d = sin h sin H + cos h cos H cos(a - A)          (a, h) in the rectangle, (A, H) the point
    ///       = R cos(h - p),   p = atan2(sin H, C cos H),   R = hypot(sin H, C cos H),   C = cos(a - A)
    /// ```
    ///
    /// cos h and cos H are never negative, so for every h the best a is the one with the largest C: 1 if the rectangle
    /// spans A, else the nearer of its ends. Then the best h is p if the rectangle spans it, else the nearer of its ends.
    /// The first line is the spherical law of cosines; the error near d = 30 degrees is under 1e-14 radian.
    pub(super) fn closest(&self, point: &AxisAngles) -> Angle {
        let c = if self.spans(point.turning) {
            1.0
        } else {
            (self.from - point.turning).cos().max((self.from + self.turn - point.turning).cos())
        };
        let (up, along) = (point.tilting.sin(), c * point.tilting.cos());
        let best = Angle::atan2(up, along);
        let cos_d = if self.low <= best && best <= self.high {
            up.hypot(along)
        } else {
            let at = |h: Angle| h.sin() * up + h.cos() * along;
            at(self.low).max(at(self.high))
        };
        Angle::acos(cos_d)
    }

    /// Whether the turning axis passes an angle.
    fn spans(&self, angle: Angle) -> bool {
        let passed = if self.turn < Angle::ZERO { self.from - angle } else { angle - self.from };
        passed.wrapped() <= self.turn.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::coords::{Airless, Horizontal};
    use proptest::prelude::*;

    fn axes(turning_deg: f64, tilting_deg: f64) -> AxisAngles {
        AxisAngles { turning: Angle::degrees(turning_deg), tilting: Angle::degrees(tilting_deg) }
    }

    #[test]
    fn a_turn_at_constant_altitude_passes_right_under_the_point() {
        let sweep = Sweep::shorter(&axes(90.0, 20.0), &axes(210.0, 20.0));
        assert!((sweep.closest(&axes(180.0, 50.0)).to_degrees() - 30.0).abs() < 1e-9);
    }

    #[test]
    fn the_shorter_way_through_north_does_not_see_a_point_in_the_south_and_the_longer_way_does() {
        let (from, to, south) = (axes(350.0, 30.0), axes(10.0, 30.0), axes(180.0, 30.0));
        assert!(Sweep::shorter(&from, &to).closest(&south).to_degrees() > 100.0);
        assert!(Sweep::longer(&from, &to).closest(&south).to_degrees() < 1e-6);
    }

    #[test]
    fn a_point_amid_the_rectangle_is_met_though_no_edge_comes_near() {
        let sweep = Sweep::shorter(&axes(100.0, 0.0), &axes(260.0, 80.0));
        assert!(sweep.closest(&axes(180.0, 40.0)).to_degrees() < 1e-6);
    }

    proptest! {
        /// Against vectors on a grid, which know nothing of the closed form.
        #[test]
        fn the_closed_form_agrees_with_a_dense_grid(
            a0 in 0.0..360.0f64, turn in -360.0..360.0f64, h0 in -90.0..90.0f64, h1 in -90.0..90.0f64,
            a in 0.0..360.0f64, h in -90.0..90.0f64,
        ) {
            let closed = Sweep::new(&axes(a0, h0), Angle::degrees(turn), Angle::degrees(h1)).closest(&axes(a, h));
            let point: Horizontal<Airless> = Horizontal::new(Angle::degrees(a), Angle::degrees(h));
            let steps = 180;
            let mut grid = 180.0f64;
            for i in 0..=steps {
                for j in 0..=steps {
                    let (u, v) = (f64::from(i) / f64::from(steps), f64::from(j) / f64::from(steps));
                    let on: Horizontal<Airless> =
                        Horizontal::new(Angle::degrees(a0 + turn * u), Angle::degrees(h0 + (h1 - h0) * v));
                    grid = grid.min(on.separation(&point).to_degrees());
                }
            }
            // The grid is 2 degrees by 1: its nearest point is at most 1.12 degrees from the true one.
            prop_assert!(closed.to_degrees() <= grid + 1e-6, "closed form {} above the grid's {grid}", closed.to_degrees());
            prop_assert!(closed.to_degrees() >= grid - 1.12, "closed form {} far below the grid's {grid}", closed.to_degrees());
        }
    }
}
