//! Patterns: their lines stand where they say, and each shows what it is for.

use super::*;

fn drawn(pattern: Pattern) -> Picture {
    draw(pattern, &Instrument::default(), Look::default())
}

#[test]
fn every_pattern_is_red_no_brighter_than_asked_and_not_black() {
    for pattern in Pattern::ALL {
        let picture = drawn(pattern);
        assert_eq!((picture.width(), picture.height()), (1024, 768));
        assert!(!picture.is_black(), "{pattern}");
        let red = |pixel: &[f32; 3]| pixel[0] <= 0.6 + 1e-6 && pixel[1] == 0.0 && pixel[2] == 0.0;
        assert!(picture.pixels().iter().all(red), "{pattern}");
        assert!(draw(pattern, &Instrument::default(), Look { light: 0.0, ..Look::default() }).pixels().iter().all(
            |pixel| {
                // The ramp of the greys has its own light.
                pattern == Pattern::Greys || *pixel == [0.0; 3]
            }
        ));
        assert_eq!(pattern.name().parse(), Ok(pattern));
    }
    assert!("gird".parse::<Pattern>().unwrap_err().contains("grid, cross"));
}

#[test]
fn the_grid_lights_all_outermost_pixels_and_its_lines_are_64_apart() {
    let picture = drawn(Pattern::Grid);
    let lit = |x: usize, y: usize| picture.row(y)[x][0] > 0.1;
    assert!((0..1024).all(|x| lit(x, 0) && lit(x, 767)) && (0..768).all(|y| lit(0, y) && lit(1023, y)));
    let lines: Vec<usize> = (1..1023).filter(|&x| lit(x, 700)).collect();
    let expected: Vec<usize> = (1..16).map(|i| i * 64).collect();
    assert!(expected.iter().all(|x| lines.contains(x)), "{lines:?}");
    assert!(lines.iter().all(|x| expected.iter().any(|own| own.abs_diff(*x) <= 2)), "{lines:?}");
}

#[test]
fn the_cross_is_open_in_the_middle_and_the_same_on_all_sides() {
    let picture = drawn(Pattern::Cross);
    let lit = |x: usize, y: usize| picture.row(y)[x][0] > 0.3;
    assert!(!lit(511, 383) && !lit(512, 384));
    assert!(lit(511 - 20, 383) && lit(512 + 20, 384) && lit(511, 383 - 20) && lit(512, 384 + 20));
    // Between the middle's two pixels: a half turn changes nothing but the two numbers.
    for (x, y) in [(512 + 64, 384 + 10), (512 + 16, 384 + 3), (512, 384 + 192)] {
        assert!(lit(x, y) && lit(1023 - x, 767 - y), "{x} {y}");
    }
}

#[test]
fn the_eyepieces_circles_have_the_radii_of_their_field_stops() {
    // 7 mm at 13.68 um are 511.7 pixels across; the 10 mm Ploessl's 9.076 mm are 663.4.
    let picture = drawn(Pattern::Eyepieces);
    let column = |x: usize| -> Vec<usize> { (0..384).filter(|&y| picture.row(y)[x][0] > 0.3).collect() };
    let rows = column(512);
    for radius in [255.85, 331.7] {
        let at = 384.0 - radius;
        assert!(rows.iter().any(|&y| (y as f64 + 0.5 - at).abs() <= 1.0), "{radius}: {rows:?}");
    }
    let mut whole = Instrument::default();
    whole.projector.relay_magnification = 1.927;
    // As figure 8.8 has it, the 27 mm stop of the 24 mm eyepiece is as wide as the picture.
    let wide = draw(Pattern::Eyepieces, &whole, Look::default());
    let reached = (0..6).any(|x| (300..468).any(|y| wide.row(y)[x][0] > 0.3));
    assert!(reached);
}

#[test]
fn no_two_ways_to_lay_the_orientation_picture_look_alike() {
    let picture = drawn(Pattern::Orientation);
    let mut square = Picture::black(768, 768);
    for y in 0..768 {
        square.row_mut(y).copy_from_slice(&picture.row(y)[128..896]);
    }
    let ways: Vec<Picture> = [false, true]
        .into_iter()
        .flat_map(|flip| (0..4).map(move |q| (flip, q)))
        .map(|(flip, q)| square.clone().flipped(flip, false).turned(q))
        .collect();
    for (i, one) in ways.iter().enumerate() {
        assert!(ways[i + 1..].iter().all(|other| one != other), "{i}");
    }
}

#[test]
fn in_the_finder_the_sign_that_is_undone_by_its_number_reads_rightly() {
    // What module and optics do to a picture, undone by the way of one number, leaves exactly one sign as it was written: the
    // one of that number.
    for mirror in [false, true] {
        let mut instrument = Instrument::default();
        instrument.projector.mirrors_itself = !mirror;
        assert_eq!(instrument.projector.must_mirror(), mirror);
        let finder = draw(Pattern::Finder, &instrument, Look::default());
        let sign_at = |number: u8| {
            let angle = f64::from(number - 1) * std::f64::consts::FRAC_PI_4;
            let (left, top) =
                ((512.0 + 280.0 * angle.sin()) as usize - 84, (384.0 - 280.0 * angle.cos()) as usize - 84);
            let mut sign = Picture::black(168, 168);
            (0..168).for_each(|y| sign.row_mut(y).copy_from_slice(&finder.row(top + y)[left..left + 168]));
            sign
        };
        let mut board = Board::new(1024, 768, Look::default()).unwrap();
        let signs: Vec<Picture> = (1..=8).map(|number| orientation::sign(&mut board, number)).collect();
        for number in 1..=8u8 {
            let (flip, quarters) = (number > 4, (number - 1) % 4);
            // The optics' work is the inverse: turned back, then flipped back, the session's own mirror too.
            let seen = |sign: Picture| sign.turned(4 - quarters).flipped(flip != mirror, false);
            let readable: Vec<u8> =
                (1..=8).filter(|&other| seen(sign_at(other)) == signs[usize::from(other) - 1]).collect();
            assert_eq!(readable, [number], "mirror {mirror}");
        }
    }
}

#[test]
fn each_grey_is_half_of_the_one_before_and_the_ramp_begins_black() {
    let picture = drawn(Pattern::Greys);
    let light = |step: usize| picture.row(384 - 272 + step / 4 * 116 + 20)[512 - 232 + step % 4 * 116 + 60][0];
    for step in 1..16 {
        assert!((light(step - 1) / light(step) - 2.0).abs() < 1e-3, "{step}");
    }
    let ramp = picture.row(384 - 272 + 464 + 20);
    assert!(ramp[280] == [0.0; 3] && ramp[700][0] > ramp[400][0] && ramp[740][0] < 0.001);
}

#[test]
fn between_the_ghosts_dots_all_is_black() {
    let picture = drawn(Pattern::Ghost);
    assert!(picture.row(384)[512][0] > 0.59);
    let black = picture.pixels().iter().filter(|pixel| **pixel == [0.0; 3]).count();
    assert!(black > 775_000, "{black}");
}
