//! The overlay on the sky: photographs of a Moon for which everything is known, and a camera behind the eyepiece that is made of
//! flips and turns of pixels and knows nothing of the transform that it proves.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use scotopic::cli::calibrate::moon::calibration_of;
use scotopic::hw::projector::{Placement, Scale};
use scotopic::picture::Picture;
use scotopic::registration::{Frame, Limb, MoonError, Pair, Shape};
use scotopic::report::registration::photograph::{Face, Photographed};
use scotopic::report::registration::{SCENES, extremes};
use scotopic::sky::coords::{Equatorial, J2000};
use scotopic::sky::field::FieldOfView;
use scotopic::sky::optics::{Calibration, Diagonal, Instrument, Telescope};
use scotopic::units::Angle;

/// Pixels a side of the camera and of the canvas; odd, so that the middle is a pixel.
const SIDE: usize = 301;

/// Stars: arcseconds east and north of the middle.
const STARS: [(f64, f64); 4] = [(0.0, 100.0), (60.0, 0.0), (-40.0, -80.0), (90.0, 70.0)];

/// Arcseconds a pixel.
const SCALE: f64 = 1.0;

fn centre() -> Equatorial<J2000> {
    Equatorial::new(Angle::degrees(80.0), Angle::ZERO)
}

/// A star on the sky; at the equator a tangent plane is nearly the sky itself.
fn star((east, north): (f64, f64)) -> Equatorial<J2000> {
    Equatorial::new(Angle::degrees(80.0) + Angle::arcseconds(east), Angle::arcseconds(north))
}

/// A picture of pixels that can only be flipped and turned.
type Pixels = Vec<Vec<bool>>;

fn dark() -> Pixels {
    vec![vec![false; SIDE]; SIDE]
}

fn left_right(pixels: Pixels) -> Pixels {
    pixels.into_iter().map(|row| row.into_iter().rev().collect()).collect()
}

fn upside_down(pixels: Pixels) -> Pixels {
    pixels.into_iter().rev().collect()
}

/// A quarter turn counter-clockwise: what was at the right is at the top.
fn quarter_left(pixels: &Pixels) -> Pixels {
    (0..SIDE).map(|row| (0..SIDE).map(|column| pixels[column][SIDE - 1 - row]).collect()).collect()
}

fn lit(pixels: &Pixels) -> Vec<(usize, usize)> {
    let all = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column)));
    all.filter(|(row, column)| pixels[*row][*column]).collect()
}

/// What a camera sees of the sky through the tube: the naked eye's view (north up, east left; the tube's upper side is north),
/// then what each piece of glass does to it.
fn seen(diagonal: Diagonal) -> Pixels {
    let mut sky = dark();
    for (east, north) in STARS {
        let (right, down) = ((-east / SCALE).round() as i64, (-north / SCALE).round() as i64);
        sky[(150 + down) as usize][(150 + right) as usize] = true;
    }
    // The objective turns it by half; a diagonal turns it upright again; an odd mirror exchanges left and right.
    let inverted = upside_down(left_right(sky));
    match diagonal {
        Diagonal::None => inverted,
        Diagonal::Mirror => left_right(upside_down(left_right(inverted))),
        Diagonal::Erecting => upside_down(left_right(inverted)),
    }
}

fn instrument(diagonal: Diagonal, angle_deg: f64, mirrors_itself: bool) -> Instrument {
    let mut instrument = Instrument::default();
    instrument.telescope = Telescope { diagonal, ..instrument.telescope };
    instrument.projector.width_px = SIDE as u32;
    instrument.projector.height_px = SIDE as u32;
    instrument.projector.angle_deg = angle_deg;
    instrument.projector.mirrors_itself = mirrors_itself;
    // One arcsecond a pixel.
    let bare = instrument.pixel_scale().to_arcseconds();
    instrument.projector.relay_magnification *= SCALE / bare;
    instrument
}

/// What a camera sees of the canvas: sent through the placement, flipped by the unit, by the splitter, and the unit turned.
fn projected(instrument: &Instrument, quarters: usize) -> Pixels {
    let field = FieldOfView::towards(&centre(), Angle::ZERO, instrument);
    let mut canvas = Picture::black(SIDE, SIDE);
    for place in STARS {
        let (x, y) = field.projection.pixel(&star(place)).unwrap();
        canvas.row_mut(y.floor() as usize)[x.floor() as usize] = [1.0; 3];
    }
    let placement = Placement { scale: Scale::Times(1.0), ..Placement::default() };
    let sent = placement.mirrored(instrument.projector.must_mirror()).apply(&canvas, (SIDE, SIDE)).into_owned();
    let mut pixels = dark();
    for (row, line) in pixels.iter_mut().enumerate() {
        line.iter_mut().zip(sent.row(row)).for_each(|(pixel, light)| *pixel = light[0] > 0.5);
    }
    if instrument.projector.mirrors_itself {
        pixels = left_right(pixels);
    }
    // The splitter.
    pixels = left_right(pixels);
    (0..quarters).fold(pixels, |pixels, _| quarter_left(&pixels))
}

#[test]
fn in_all_eight_parities_the_camera_sees_the_overlay_on_the_stars() {
    let mut parities = Vec::new();
    for diagonal in [Diagonal::None, Diagonal::Mirror, Diagonal::Erecting] {
        for quarters in 0..4 {
            for mirrors_itself in [true, false] {
                let instrument = instrument(diagonal, 90.0 * quarters as f64, mirrors_itself);
                assert_eq!(
                    lit(&projected(&instrument, quarters)),
                    lit(&seen(diagonal)),
                    "{diagonal:?}, unit turned by {quarters} quarters, mirrors itself {mirrors_itself}"
                );
                let lies = instrument.registration();
                parities.push((lies.mirrored, lies.upper_side.to_degrees().round() as i64 % 360));
            }
        }
    }
    parities.sort_unstable();
    parities.dedup();
    assert_eq!(parities.len(), 8, "all eight were tried: {parities:?}");
}

/// A registration that is not what the instrument's file says: the eyepiece's view is turned, mirrored, of another scale and beside
/// the canvas' middle. A place of the canvas where the file would draw something is to be drawn elsewhere.
#[derive(Clone, Copy, Debug)]
struct Wrong {
    scale: f64,
    turn_deg: f64,
    mirrored: bool,
    right: f64,
    down: f64,
}

impl Wrong {
    /// Turned back clockwise, mirrored, made smaller, moved.
    fn mended(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (dx, dy) = (x - 150.5, y - 150.5);
        let (sin, cos) = self.turn_deg.to_radians().sin_cos();
        // Clockwise as one looks at it, y downwards.
        let (dx, dy) = (dx * cos - dy * sin, dx * sin + dy * cos);
        let dx = if self.mirrored { -dx } else { dx };
        (150.5 + self.right + dx / self.scale, 150.5 + self.down + dy / self.scale)
    }

    fn calibration(&self) -> Calibration {
        Calibration {
            scale: self.scale,
            turn_deg: self.turn_deg,
            mirrored: self.mirrored,
            right_px: self.right,
            down_px: self.down,
            ..Calibration::default()
        }
    }
}

/// How far the stars are drawn from where they belong, pixels at most.
fn farthest(wrong: &Wrong, calibration: Calibration) -> f64 {
    let file = instrument(Diagonal::Mirror, 30.0, true);
    let mut calibrated = file.clone();
    calibrated.calibration = calibration;
    let upper_side = Angle::degrees(41.0);
    let before = FieldOfView::towards(&centre(), upper_side, &file);
    let after = FieldOfView::towards(&centre(), upper_side, &calibrated);
    let off = |place| {
        let (wanted_x, wanted_y) = wrong.mended(before.projection.pixel(&star(place)).unwrap());
        let (x, y) = after.projection.pixel(&star(place)).unwrap();
        (x - wanted_x).hypot(y - wanted_y)
    };
    STARS.into_iter().map(off).fold(0.0, f64::max)
}

#[test]
fn a_calibration_lays_the_overlay_on_the_sky_in_all_eight_parities() {
    for mirrored in [false, true] {
        for turn_deg in [7.0, 97.0, 187.0, 277.0] {
            let wrong = Wrong { scale: 0.6, turn_deg, mirrored, right: 12.0, down: -5.0 };
            let off = farthest(&wrong, wrong.calibration());
            assert!(off < 1e-3, "{wrong:?}: {off} pixels");
        }
    }
}

#[test]
fn two_photographs_of_the_moon_lay_the_overlay_on_the_sky() {
    /// Pixels of the camera in one of the canvas.
    const CAMERA: f64 = 1.3;
    let face = Face::of(11);
    for (mirrored, turn_deg) in [(false, 25.0), (true, 200.0)] {
        let wrong = Wrong { scale: 0.8, turn_deg, mirrored, right: 12.0, down: -5.0 };
        // The drawn Moon stands in the canvas' middle, upright in the camera; the seen one where it belongs.
        let drawn =
            Photographed { radius: 150.0, middle: (230.0, 230.0), relief_arcsec: 0.0, ..Photographed::default() };
        let seen = Photographed {
            radius: drawn.radius / wrong.scale,
            middle: (230.0 + CAMERA * wrong.right, 230.0 + CAMERA * wrong.down),
            turned_deg: if mirrored { -turn_deg } else { turn_deg },
            mirrored,
            relief_arcsec: 2.0,
            ..drawn
        };
        let frame = |moon: &Photographed, seed| Frame::new(460, 460, face.photographed(moon, 460, 460, seed)).unwrap();
        let pair = Pair::measured(&frame(&seen, 1), &frame(&drawn, 2), Shape::ROUND).unwrap();
        assert_eq!(pair.mirrored, Some(mirrored));
        let off = farthest(&wrong, calibration_of(&pair, CAMERA));
        assert!(off < 1.0, "{wrong:?}: {off} pixels; {pair:?}");
    }
}

#[test]
fn scale_and_stated_error_hold_on_photographs_of_every_phase_and_of_a_short_arc() {
    // A hundred seeds a scene: `scotopic report registration`.
    let (mut covered, mut all) = (0, 0);
    for scene in SCENES.into_iter().filter(|scene| scene.maria && (scene.cut || scene.phase_deg == 45.0)) {
        let (seen, drawn, truth) = scene.made(5).unwrap();
        let pair = Pair::measured(&seen.frame, &drawn.frame, Shape::ROUND).unwrap();
        let (off, error) = (pair.scale.value / truth - 1.0, pair.scale.error / truth);
        assert!(off.abs() < 0.003, "{}: off by {:.3} %", scene.name, 100.0 * off);
        assert!(2.0 * error < 0.003, "{}: two sigma are {:.3} %", scene.name, 200.0 * error);
        assert_eq!(pair.mirrored, Some(false), "{}", scene.name);
        covered += usize::from(off.abs() <= 2.0 * error);
        all += 1;
    }
    assert!(all == 4 && covered >= 3, "{covered} of {all} within two sigma");
}

#[test]
fn a_flattened_moon_is_measured_across_its_width() {
    let face = Face::of(2);
    let made = |flattening: f64, seed| {
        let moon = Photographed {
            radius: 180.0,
            middle: (230.0, 230.0),
            flattening,
            phase_deg: 60.0,
            ..Photographed::default()
        };
        Frame::new(460, 460, face.photographed(&moon, 460, 460, seed)).unwrap()
    };
    let flat = made(0.03, 1);
    let up = Shape { flattening: 0.03, up: Angle::degrees(-90.0) };
    let right = Limb::of(&flat, up).unwrap();
    assert!((right.radius / 180.0 - 1.0).abs() < 0.003, "{}", right.radius);
    // Of a gibbous Moon one side is seen: taken for a circle it is 3 % too small, ten times what is allowed.
    let ignored = Limb::of(&flat, Shape::ROUND).unwrap();
    assert!((-0.04..-0.02).contains(&(ignored.radius / 180.0 - 1.0)), "{}", ignored.radius);
}

#[test]
fn what_shows_no_moon_is_refused_with_what_to_do() {
    for extreme in extremes() {
        assert!(extreme.held && extreme.what.starts_with("refused"), "{}: {}", extreme.name, extreme.what);
    }
    let face = Face::of(1);
    let burnt = Photographed { exposure: 6.0, radius: 150.0, middle: (200.0, 200.0), ..Photographed::default() };
    let frame = Frame::new(400, 400, face.photographed(&burnt, 400, 400, 1)).unwrap();
    let error = Limb::of(&frame, Shape::ROUND).unwrap_err();
    assert!(matches!(error, MoonError::Saturated { .. }) && error.to_string().contains("shorter"), "{error}");
}
