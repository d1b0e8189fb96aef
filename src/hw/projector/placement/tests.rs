//! Where the canvas lies on the module: orientations pinned by an asymmetric picture, and laws that hold for every placement.

use proptest::prelude::*;

use super::*;

/// Letters in place of light, so that a placement can be read: `.` is black.
fn canvas(rows: &[&str]) -> Picture {
    let mut picture = Picture::black(rows[0].len(), rows.len());
    for (y, row) in rows.iter().enumerate() {
        for (x, letter) in row.bytes().enumerate() {
            picture.row_mut(y)[x] = [if letter == b'.' { 0.0 } else { f32::from(letter) }; 3];
        }
    }
    picture
}

fn letters(picture: &Picture) -> Vec<String> {
    let letter = |pixel: &[f32; 3]| if pixel[0] == 0.0 { '.' } else { char::from(pixel[0] as u8) };
    (0..picture.height()).map(|y| picture.row(y).iter().map(letter).collect()).collect()
}

const ROTATIONS: [Rotation; 4] = [Rotation::None, Rotation::Clockwise90, Rotation::Half, Rotation::Clockwise270];
const FLIPS: [Flip; 4] = [Flip::None, Flip::Horizontal, Flip::Vertical, Flip::Both];

#[test]
fn all_eight_ways_to_lay_a_picture_are_what_hands_do_with_a_sheet_of_paper() {
    // Written down by hand: AB over CD over EF, turned clockwise or seen from behind.
    let paper = canvas(&["AB", "CD", "EF"]);
    for (flip, rotation, expected) in [
        (Flip::None, Rotation::None, vec!["AB", "CD", "EF"]),
        (Flip::None, Rotation::Clockwise90, vec!["ECA", "FDB"]),
        (Flip::None, Rotation::Half, vec!["FE", "DC", "BA"]),
        (Flip::None, Rotation::Clockwise270, vec!["BDF", "ACE"]),
        (Flip::Horizontal, Rotation::None, vec!["BA", "DC", "FE"]),
        (Flip::Horizontal, Rotation::Clockwise90, vec!["FDB", "ECA"]),
        (Flip::Horizontal, Rotation::Half, vec!["EF", "CD", "AB"]),
        (Flip::Horizontal, Rotation::Clockwise270, vec!["ACE", "BDF"]),
        (Flip::Vertical, Rotation::None, vec!["EF", "CD", "AB"]),
        (Flip::Both, Rotation::None, vec!["FE", "DC", "BA"]),
    ] {
        let placement = Placement { flip, rotation, ..Placement::default() };
        let module = if rotation.quarters() % 2 == 1 { (3, 2) } else { (2, 3) };
        assert_eq!(letters(&placement.apply(&paper, module)), expected, "{flip:?} {rotation:?}");
    }
}

#[test]
fn pixel_for_pixel_it_lies_in_the_middle_moved_as_told_and_is_cut_at_the_rim() {
    let paper = canvas(&["AB", "CD"]);
    let one = Placement { scale: Scale::Times(1.0), ..Placement::default() };
    assert_eq!(letters(&one.apply(&paper, (6, 4))), ["......", "..AB..", "..CD..", "......"]);
    let moved = Placement { right_px: -3, down_px: 1, ..one };
    assert_eq!(letters(&moved.apply(&paper, (6, 4))), ["......", "......", "B.....", "D....."]);
    // On an odd module the corner is on a whole pixel, the upper left one of the two nearest.
    assert_eq!(letters(&one.apply(&paper, (3, 3))), ["AB.", "CD.", "..."]);
}

#[test]
fn fitted_on_the_modules_that_can_be_bought_it_has_the_published_scales() {
    // hardware.md of these modules: 1280 x 720 takes 1024 x 768 at 0.9375, 640 x 360 at 0.469, 1920 x 1080 at 1.406.
    let mut white = Picture::black(1024, 768);
    white.pixels_mut().fill([1.0; 3]);
    for (module, columns, rows) in [((1280, 720), 960, 720), ((640, 360), 480, 360), ((1920, 1080), 1440, 1080)] {
        let placed = Placement::default().apply(&white, module);
        assert_eq!((placed.width(), placed.height()), module);
        let lit = |pixel: &[f32; 3]| (pixel[0] - 1.0).abs() < 1e-5;
        assert_eq!(placed.row(module.1 / 2).iter().filter(|pixel| lit(pixel)).count(), columns);
        assert_eq!((0..module.1).filter(|&y| lit(&placed.row(y)[module.0 / 2])).count(), rows);
        let black = placed.pixels().iter().filter(|pixel| **pixel == [0.0; 3]).count();
        assert_eq!(black, module.0 * module.1 - columns * rows);
    }
}

#[test]
fn reduced_to_half_each_pixel_is_the_mean_of_four_and_a_thin_line_stays() {
    let mut picture = Picture::black(8, 8);
    picture.row_mut(3).fill([1.0; 3]);
    let half = Placement::default().apply(&picture, (4, 4));
    assert_eq!((half.row(1)[2], half.row(0)[2], half.row(2)[2]), ([0.5; 3], [0.0; 3], [0.0; 3]));
}

#[test]
fn what_no_module_can_show_is_refused_with_its_number() {
    let at = |scale, right_px| Placement { scale: Scale::Times(scale), right_px, ..Placement::default() };
    for scale in [0.0, -1.0, 0.049, 8.1, f64::NAN, f64::INFINITY] {
        let refused = at(scale, 0).checked().unwrap_err();
        assert!(matches!(refused, PlacementError::Scale(_)) && refused.to_string().contains("0.05 to 8"), "{scale}");
    }
    for value in [i32::MIN, -8193, 8193, i32::MAX] {
        assert_eq!(at(1.0, value).checked(), Err(PlacementError::Offset { key: "right_px", value }));
    }
    let beside = at(1.0, 1152).seen((1024, 768), (1280, 720)).unwrap_err();
    assert!(beside.to_string().contains("1280 x 720") && beside.to_string().contains("1280 to 2303"), "{beside}");
    assert!(at(1.0, 1151).seen((1024, 768), (1280, 720)).is_ok());
    for degrees in [45.0, -90.0, 360.0, f64::NAN] {
        assert!(Rotation::try_from(degrees).unwrap_err().contains("0, 90, 180 or 270"));
    }
}

#[test]
fn a_mirror_in_the_path_is_one_more_flip_of_left_and_right() {
    for (flip, mirrored) in [(Flip::None, Flip::Horizontal), (Flip::Both, Flip::Vertical)] {
        let placement = Placement { flip, ..Placement::default() };
        assert_eq!(placement.mirrored(true).flip, mirrored);
        assert_eq!(placement.mirrored(true).mirrored(true), placement);
    }
    assert_eq!(Placement::default().mirrored(false), Placement::default());
}

prop_compose! {
    fn any_placement()(
        scale in prop_oneof![Just(Scale::Fit), Just(Scale::Times(1.0)), (0.05..8.0).prop_map(Scale::Times)],
        right_px in -30..30i32, down_px in -30..30i32,
        rotation in prop::sample::select(&ROTATIONS[..]), flip in prop::sample::select(&FLIPS[..]),
    ) -> Placement {
        Placement { scale, right_px, down_px, rotation, flip }
    }
}

/// Where the middle of a canvas pixel comes to lie, by vectors from the middle: nothing of the placement's own code but its
/// documented rule of the corner.
fn mapped(
    placement: &Placement,
    canvas: (usize, usize),
    module: (usize, usize),
    x: usize,
    y: usize,
) -> (f64, f64, f64) {
    let (mut u, mut v) = (x as f64 + 0.5 - canvas.0 as f64 / 2.0, y as f64 + 0.5 - canvas.1 as f64 / 2.0);
    u = if placement.flip.horizontal() { -u } else { u };
    v = if placement.flip.vertical() { -v } else { v };
    let (mut width, mut height) = (canvas.0 as f64, canvas.1 as f64);
    for _ in 0..placement.rotation.quarters() {
        (u, v) = (-v, u);
        (width, height) = (height, width);
    }
    let scale = match placement.scale {
        Scale::Fit => (module.0 as f64 / width).min(module.1 as f64 / height),
        Scale::Times(times) => times,
    };
    let corner = |room: usize, side: f64| ((room as f64 - side * scale) / 2.0).floor();
    let middle_x = corner(module.0, width) + width * scale / 2.0 + f64::from(placement.right_px);
    let middle_y = corner(module.1, height) + height * scale / 2.0 + f64::from(placement.down_px);
    (middle_x + u * scale, middle_y + v * scale, scale)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn one_lit_pixel_lands_where_the_sheet_of_paper_has_it_and_nowhere_else(
        placement in any_placement(),
        canvas in (1..24usize, 1..24usize), module in (1..40usize, 1..40usize), seed in any::<(u16, u16)>(),
    ) {
        let (x, y) = (usize::from(seed.0) % canvas.0, usize::from(seed.1) % canvas.1);
        let mut picture = Picture::black(canvas.0, canvas.1);
        picture.row_mut(y)[x] = [1.0; 3];
        let placed = placement.apply(&picture, module);
        prop_assert_eq!((placed.width(), placed.height()), module);
        let (to_x, to_y, scale) = mapped(&placement, canvas, module, x, y);
        // Bilinear light reaches one canvas pixel further; at the canvas' own rim it is held out to the edge.
        let reach = scale.max(0.5) + 0.5 * scale.max(1.0) + 1e-6;
        let mut sum = 0.0;
        for j in 0..module.1 {
            for (i, pixel) in placed.row(j).iter().enumerate() {
                prop_assert!((0.0..=1.0 + 1e-5).contains(&pixel[0]));
                sum += f64::from(pixel[0]);
                let (right, down) = (i as f64 + 0.5 - to_x, j as f64 + 0.5 - to_y);
                prop_assert!(pixel[0] == 0.0 || (right.abs() <= reach && down.abs() <= reach), "{i} {j}: {right} {down}");
            }
        }
        // Reduced, light is neither lost nor made: a pixel's area on the module, if all of it lies there.
        let inside = |to: f64, side: usize| to - scale / 2.0 >= 0.0 && to + scale / 2.0 <= side as f64;
        if scale < 1.0 && inside(to_x, module.0) && inside(to_y, module.1) {
            prop_assert!((sum - scale * scale).abs() < 1e-4, "{sum} of {}", scale * scale);
        }
        if scale == 1.0 {
            let on = (0.0..module.0 as f64).contains(&to_x) && (0.0..module.1 as f64).contains(&to_y);
            prop_assert_eq!(sum, f64::from(u8::from(on)));
        }
    }

    #[test]
    fn pixel_for_pixel_no_canvas_pixel_comes_twice_and_each_module_pixel_is_one_canvas_pixel_or_black(
        placement in any_placement().prop_map(|placement| Placement { scale: Scale::Times(1.0), ..placement }),
        canvas in (1..24usize, 1..24usize), module in (1..40usize, 1..40usize),
    ) {
        let mut picture = Picture::black(canvas.0, canvas.1);
        picture.pixels_mut().iter_mut().enumerate().for_each(|(number, pixel)| *pixel = [number as f32 + 1.0; 3]);
        let placed = placement.apply(&picture, module);
        let mut seen = std::collections::BTreeSet::new();
        for pixel in placed.pixels().iter().filter(|pixel| **pixel != [0.0; 3]) {
            prop_assert!(pixel[0].fract() == 0.0 && pixel[0] <= (canvas.0 * canvas.1) as f32, "{pixel:?}");
            prop_assert!(seen.insert(pixel[0] as u32), "{pixel:?} twice");
        }
    }

    #[test]
    fn what_is_written_is_read_back(placement in any_placement()) {
        let text = toml::to_string(&placement).unwrap();
        prop_assert_eq!(toml::from_str::<Placement>(&text).unwrap(), placement);
    }
}
