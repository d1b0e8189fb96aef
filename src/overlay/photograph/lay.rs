//! A picture laid on the canvas where a homography puts it: the hot loop of every photograph and animation.

use std::ops::Range;

use glam::{DMat3, DVec2, DVec3, Vec3A, Vec4};

use crate::overlay::canvas::Region;
use crate::picture::Picture;

/// Share of a picture's shorter side over which its edge fades.
const EDGE: f64 = 0.03;

/// Columns between two exactly mapped ones; those between lie evenly. A row of a field of 5 degrees bends by less than 3e-4 of
/// a pixel over so few.
const BLOCK: usize = 16;

/// Lays a picture on the canvas where it lies in the region, over what is there; `map` brings a canvas position (pixels,
/// homogeneous) to one of the picture, `colour` its light to the projector's. Towards its edges it fades into what is there.
/// Whether anything was drawn.
pub(super) fn lay(
    canvas: &mut Picture,
    region: &Region,
    source: &Picture,
    map: &DMat3,
    colour: impl Fn(Vec3A) -> Vec3A,
) -> bool {
    let size = DVec2::new(source.width() as f64, source.height() as f64);
    let fading = EDGE * size.min_element();
    let mut drawn = false;
    for y in 0..canvas.height() {
        let span = region.span(y);
        let first = *map * DVec3::new(span.start as f64 + 0.5, y as f64 + 0.5, 1.0);
        let row = &mut canvas.row_mut(y)[span];
        let seen = columns(first, map.x_axis, size, 0.0, 0..row.len());
        // A pixel from its edges all four neighbours are there.
        let whole = columns(first, map.x_axis, size, fading.max(1.0), seen.clone());
        let place = |column: usize| {
            let place = first + map.x_axis * column as f64;
            (place.truncate() * (1.0 / place.z)).clamp(DVec2::ZERO, size)
        };
        for column in (seen.start..whole.start).chain(whole.end..seen.end) {
            let at = place(column);
            let light = colour(source.sample(at.x as f32, at.y as f32).into());
            let share = (at.min(size - at).min_element() / fading).min(1.0) as f32;
            let there = Vec3A::from(row[column]);
            row[column] = (there + (light - there) * share).into();
        }
        for start in whole.clone().step_by(BLOCK) {
            let block = start..(start + BLOCK).min(whole.end);
            let spots = spots(place(block.start), place(block.end - 1), block.len(), source.width());
            for (pixel, spot) in row[block].iter_mut().zip(spots) {
                *pixel = colour(between(source, spot)).into();
            }
        }
        drawn |= !seen.is_empty();
    }
    drawn
}

/// The columns among `among` whose places in the picture keep a margin from its edges, for places `first + column * step`
/// (homogeneous). Each edge is a line, and so is the row: what is inside is one range, found without trying each column.
fn columns(first: DVec3, step: DVec3, size: DVec2, margin: f64, among: Range<usize>) -> Range<usize> {
    let edges = [
        DVec3::new(1.0, 0.0, -margin),
        DVec3::new(-1.0, 0.0, size.x - margin),
        DVec3::new(0.0, 1.0, -margin),
        DVec3::new(0.0, -1.0, size.y - margin),
        DVec3::Z,
    ];
    let (mut from, mut to) = (among.start as f64, among.end as f64);
    for (here, slope) in edges.map(|edge| (edge.dot(first), edge.dot(step))) {
        if slope > 0.0 {
            from = from.max((-here / slope).ceil());
        } else if slope < 0.0 {
            to = to.min((-here / slope).floor() + 1.0);
        } else if here.is_nan() || here < 0.0 {
            to = from;
        }
    }
    if from < to { from as usize..to as usize } else { among.end..among.end }
}

/// A place between four pixels: the number of the upper left one, and the shares of the right and of the lower ones.
#[derive(Clone, Copy, Default)]
struct Spot {
    pixel: i32,
    right: f32,
    down: f32,
}

/// The spots of a block of so many columns, evenly from the first one's place to the last one's.
fn spots(first: DVec2, last: DVec2, columns: usize, width: usize) -> [Spot; BLOCK] {
    let step = ((last - first) / (columns.max(2) - 1) as f64).as_vec2();
    let from = (first - 0.5).as_vec2();
    std::array::from_fn(|i| {
        let (x, y) = (from.x + step.x * i as f32, from.y + step.y * i as f32);
        // 32 bits: turning floats into 64-bit numbers takes twice as many instructions.
        let (left, above) = (x as i32, y as i32);
        Spot { pixel: above * width as i32 + left, right: x - left as f32, down: y - above as f32 }
    })
}

/// The light between four pixels, bilinearly, four numbers at a time. Black where they are not all there.
#[inline]
fn between(source: &Picture, spot: Spot) -> Vec3A {
    let numbers = source.pixels().as_flattened();
    let (first, row) = (3 * spot.pixel as usize, 3 * source.width());
    let Some(about) = numbers.get(first..first + row + 7) else { return Vec3A::ZERO };
    let (above, below) = (&about[..7], &about[row..]);
    let across = |two: &[f32]| {
        let (left, right) = (Vec4::from_slice(two), Vec4::from_slice(&two[3..]));
        left + (right - left) * spot.right
    };
    let (above, below) = (across(above), across(below));
    Vec3A::from_vec4(above + (below - above) * spot.down)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn map(turn: f64, zoom: f64, shift: (f64, f64), bend: (f64, f64)) -> DMat3 {
        let (sin, cos) = turn.sin_cos();
        DMat3::from_cols(
            DVec3::new(zoom * cos, zoom * sin, bend.0),
            DVec3::new(-zoom * sin, zoom * cos, bend.1),
            DVec3::new(shift.0, shift.1, 1.0),
        )
    }

    proptest! {
        #[test]
        fn the_columns_of_a_row_are_those_that_lie_inside(
            turn in -3.2..3.2f64, zoom in 0.1..3.0f64, x in -200.0..200.0f64, y in -200.0..200.0f64,
            bend in (-1e-2..1e-2f64, -1e-2..1e-2f64), row in 0..100, margin in 0.0..20.0f64,
        ) {
            let (map, size) = (map(turn, zoom, (x, y), bend), DVec2::new(80.0, 60.0));
            let first = map * DVec3::new(0.5, f64::from(row) + 0.5, 1.0);
            let found = columns(first, map.x_axis, size, margin, 0..100);
            for column in 0..100 {
                let place = first + map.x_axis * f64::from(column);
                let at = place.truncate() / place.z;
                let inside = at.min(size - at).min_element() - margin;
                let inside = if place.z > 0.0 { inside } else { -1.0 };
                prop_assert!(inside.abs() < 1e-6 || (inside > 0.0) == found.contains(&(column as usize)), "{column} {found:?}");
            }
        }

        #[test]
        fn light_is_laid_where_each_pixel_mapped_alone_would_take_it(
            turn in -3.2..3.2f64, zoom in 0.3..2.0f64, bend in (-1e-6..1e-6f64, -1e-6..1e-6f64),
        ) {
            let mut source = Picture::black(90, 70);
            for y in 0..70 {
                for x in 0..90 {
                    source.row_mut(y)[x] = [x as f32 / 90.0, y as f32 / 70.0, ((x * y) % 7) as f32 / 7.0];
                }
            }
            let map = map(turn, zoom, (45.0, 35.0), bend) * DMat3::from_translation(DVec2::splat(-32.0));
            let mut canvas = Picture::black(64, 64);
            prop_assert!(lay(&mut canvas, &Region::new(64, 64, vec![]), &source, &map, |light| light));
            let size = DVec2::new(90.0, 70.0);
            for y in 0..64 {
                for x in 0..64 {
                    let place = map * DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 1.0);
                    let at = place.truncate() / place.z;
                    let within = at.min(size - at).min_element();
                    let share = (within / (EDGE * 70.0)).clamp(0.0, 1.0) as f32;
                    let expected = source.sample(at.x as f32, at.y as f32).map(|light| light * share);
                    for (light, expected) in canvas.row(y)[x].iter().zip(expected) {
                        prop_assert!((light - expected).abs() < 1e-3, "{x} {y}: {light} {expected}, {within} inside");
                    }
                }
            }
        }
    }

    #[test]
    fn a_picture_of_one_pixel_and_a_map_without_numbers_are_no_trouble() {
        for side in 1..4 {
            let mut source = Picture::black(side, side);
            source.pixels_mut().fill([1.0; 3]);
            let mut canvas = Picture::black(8, 8);
            let here = map(0.0, 0.25, (0.0, 0.0), (0.0, 0.0));
            assert!(lay(&mut canvas, &Region::new(8, 8, vec![]), &source, &here, |light| light));
            assert!(canvas.pixels().iter().flatten().all(|light| (0.0..=1.0).contains(light)));
        }
        let source = Picture::black(8, 8);
        for nowhere in [DMat3::from_cols_array(&[f64::NAN; 9]), DMat3::ZERO, DMat3::from_cols_array(&[1e300; 9])] {
            lay(&mut Picture::black(8, 8), &Region::new(8, 8, vec![]), &source, &nowhere, |light| light);
        }
    }
}
