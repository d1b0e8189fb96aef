//! Where dust is, coarsely: which bricks hold any, how far the next one is, and which voxels a ray can ask for.

use std::collections::VecDeque;

use glam::DVec3;

use super::grid::{Grid, LANES};
use crate::physics::dust::bricks::{Bricks, SIDE};

/// Which bricks hold dust.
#[derive(Debug, Clone)]
pub(super) struct Occupancy {
    count: [usize; 3],
    /// By brick: the most dust in it, 0 where it may be passed over.
    most: Vec<f32>,
    /// By brick: how many bricks away the nearest with dust is, straight or diagonally; 0 for those themselves.
    away: Vec<u8>,
    /// By [`LANES`] voxels of the padded rows: whether a ray can ask for one of them.
    wanted: Vec<bool>,
    /// The most dust in any brick passed over.
    passed_over: f32,
}

impl Occupancy {
    /// Bricks with no more dust than `negligible` are passed over.
    pub(super) fn new(grid: &Grid, bricks: &Bricks, negligible: f32) -> Occupancy {
        let count = bricks.count();
        let mut passed_over = 0.0f32;
        let most: Vec<f32> = bricks
            .ranges()
            .iter()
            .map(|range| {
                if range.most > negligible {
                    return range.most;
                }
                passed_over = passed_over.max(range.most);
                0.0
            })
            .collect();
        let away = distances(count, &most);
        let mut occupancy = Occupancy { count, most, away, wanted: Vec::new(), passed_over };
        occupancy.wanted = occupancy.asked_for(grid);
        occupancy
    }

    /// The most dust in any brick passed over.
    pub(super) fn passed_over(&self) -> f32 {
        self.passed_over
    }

    /// Whether a ray can ask for a voxel of a piece of [`LANES`] of them, counted along padded rows.
    pub(super) fn wants(&self, piece: usize) -> bool {
        self.wanted.get(piece).copied().unwrap_or(false)
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.count[1] + j) * self.count[0] + i
    }

    /// The brick of an index, which need not be in the box.
    fn brick(&self, index: DVec3) -> [usize; 3] {
        // The cast saturates at 0.
        [0, 1, 2].map(|axis| (((index[axis] - 0.5) / SIDE as f64) as usize).min(self.count[axis] - 1))
    }

    /// How far one can go from an index, along each axis, without meeting dust.
    pub(super) fn free(&self, index: DVec3) -> f64 {
        let away = self.away[self.at(self.brick(index))];
        (f64::from(away) - 1.0).max(0.0) * SIDE as f64
    }

    /// The most dust anywhere between two corners.
    pub(super) fn densest(&self, low: DVec3, high: DVec3) -> f32 {
        let (low, high) = (self.brick(low), self.brick(high));
        let mut most = 0.0f32;
        for k in low[2]..=high[2] {
            for j in low[1]..=high[1] {
                for i in low[0]..=high[0] {
                    most = most.max(self.most[self.at([i, j, k])]);
                }
            }
        }
        most
    }

    /// A sample in brick b asks for padded voxels 8 b to 8 b + 9.
    fn asked_for(&self, grid: &Grid) -> Vec<bool> {
        let bricks_of = |voxel: usize, axis: usize| {
            let own = voxel / SIDE;
            let before = if voxel % SIDE <= 1 { own.saturating_sub(1) } else { own };
            before..(own + 1).min(self.count[axis])
        };
        let mut wanted = Vec::with_capacity(grid.len() / LANES);
        for z in 0..grid.padded[2] {
            for y in 0..grid.padded[1] {
                for piece in 0..grid.padded[0] / LANES {
                    wanted.push(bricks_of(z, 2).any(|k| {
                        bricks_of(y, 1).any(|j| {
                            (piece.saturating_sub(1)..(piece + 1).min(self.count[0]))
                                .any(|i| self.most[self.at([i, j, k])] > 0.0)
                        })
                    }));
                }
            }
        }
        wanted
    }
}

/// Distances to the nearest brick with dust, from neighbour to neighbour; 255 for that and all beyond.
fn distances(count: [usize; 3], most: &[f32]) -> Vec<u8> {
    let mut away: Vec<u8> = most.iter().map(|most| if *most > 0.0 { 0 } else { u8::MAX }).collect();
    let mut next: VecDeque<usize> = (0..most.len()).filter(|at| away[*at] == 0).collect();
    let near = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
    while let Some(at) = next.pop_front() {
        let (i, j, k) = (at % count[0], at / count[0] % count[1], at / (count[0] * count[1]));
        let further = away[at].saturating_add(1);
        for k in near(k, count[2]) {
            for j in near(j, count[1]) {
                for i in near(i, count[0]) {
                    let there = (k * count[1] + j) * count[0] + i;
                    if away[there] > further {
                        away[there] = further;
                        next.push_back(there);
                    }
                }
            }
        }
    }
    away
}
