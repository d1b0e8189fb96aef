//! From a direction on the sky to a pixel of the canvas, and back: the gnomonic projection, which is what a telescope's flat
//! focal plane does, then a rotation and perhaps a mirror.

use glam::{DMat3, DVec2, DVec3};

use super::coords::{Equatorial, J2000};
use crate::units::Angle;

/// A tangent plane on the sky, and the canvas laid over it.
///
/// ```text
/// (xi, eta) = (v.e, v.n) / (v.c)                                      c centre, e east, n north: gnomonic
/// canvas    = middle + flip_y Rot(theta) diag(-1 or +1, 1) (xi, eta) / scale
/// ```
///
/// `diag(-1, 1)` is the plain view, north up and east left; `diag(+1, 1)` the mirrored one. Rot is counter-clockwise as the
/// observer sees it, so theta is where north stands. Canvas x runs right and y down; pixel (i, j) covers
/// `i..i+1, j..j+1`. The model is that of astrometric WCS (Calabretta and Greisen 2002, A&A 395, 1077, section 5.1.3);
/// astropy's WCS agrees to a milliarcsecond (`fixtures/reference/wcs_tan.csv`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Rows: unit vectors east, north and centre, in the equatorial frame.
    basis: DMat3,
    /// Where north stands, from the canvas' top counter-clockwise.
    north: Angle,
    mirrored: bool,
    pixels_per_radian: f64,
    /// Canvas position of the tangent point, in pixels.
    middle: DVec2,
}

impl Projection {
    /// A projection about `centre`, which falls on the canvas position `middle`. `north` is where north stands on the canvas,
    /// from its top counter-clockwise; `scale` is the sky under one pixel at the centre.
    #[must_use]
    pub fn new(
        centre: &Equatorial<J2000>,
        north: Angle,
        mirrored: bool,
        scale: Angle,
        middle: (f64, f64),
    ) -> Projection {
        Projection {
            basis: tangent_basis(centre),
            north,
            mirrored,
            pixels_per_radian: 1.0 / scale.to_radians(),
            middle: DVec2::new(middle.0, middle.1),
        }
    }

    /// The same view, moved over the canvas (pixels right and down) and made larger by `factor` about its middle.
    #[must_use]
    pub fn moved(&self, right_px: f64, down_px: f64, factor: f64) -> Projection {
        Projection {
            middle: self.middle + DVec2::new(right_px, down_px),
            pixels_per_radian: self.pixels_per_radian * factor,
            ..*self
        }
    }

    /// The sky position in the middle.
    #[must_use]
    pub fn centre(&self) -> Equatorial<J2000> {
        Equatorial::from_direction(self.basis.row(2))
    }

    /// Where the tangent point falls on the canvas, in pixels.
    #[must_use]
    pub fn middle(&self) -> (f64, f64) {
        (self.middle.x, self.middle.y)
    }

    /// Where north stands on the canvas, from its top counter-clockwise.
    #[must_use]
    pub fn north(&self) -> Angle {
        self.north
    }

    /// Whether the view is mirrored: east is clockwise from north.
    #[must_use]
    pub fn mirrored(&self) -> bool {
        self.mirrored
    }

    /// Sky under one pixel in the middle.
    #[must_use]
    pub fn scale(&self) -> Angle {
        Angle::radians(1.0 / self.pixels_per_radian)
    }

    /// Pixels to a sky angle near the middle.
    #[must_use]
    pub fn pixels(&self, angle: Angle) -> f64 {
        angle.to_radians() * self.pixels_per_radian
    }

    /// Where a position falls on the canvas; `None` when it is 90 degrees or more away.
    #[must_use]
    pub fn pixel(&self, position: &Equatorial<J2000>) -> Option<(f64, f64)> {
        self.pixel_of(position.direction())
    }

    /// Where a direction falls on the canvas; `None` when it is 90 degrees or more away.
    #[must_use]
    pub fn pixel_of(&self, direction: DVec3) -> Option<(f64, f64)> {
        let plane = self.basis * direction;
        if plane.z <= 1e-9 {
            return None;
        }
        let offset = self.on_canvas(DVec2::new(plane.x, plane.y) / plane.z) * self.pixels_per_radian;
        Some((self.middle.x + offset.x, self.middle.y + offset.y))
    }

    /// The position under a place on the canvas.
    #[must_use]
    pub fn position(&self, x: f64, y: f64) -> Equatorial<J2000> {
        Equatorial::from_direction(self.ray_map() * DVec3::new(x, y, 1.0))
    }

    /// The canvas' direction of a position angle (from north through east) in the middle: a unit vector, x right, y down.
    #[must_use]
    pub fn direction_of(&self, position_angle: Angle) -> (f64, f64) {
        let (sin, cos) = position_angle.sin_cos();
        let v = self.on_canvas(DVec2::new(sin, cos));
        (v.x, v.y)
    }

    /// The matrix that takes (x, y, 1) on the canvas to a direction on the sky, of any length.
    #[must_use]
    pub fn ray_map(&self) -> DMat3 {
        // Columns of the canvas-to-plane matrix: what one pixel right, one pixel down and the corner are in (xi, eta).
        let right = self.on_plane(DVec2::X) / self.pixels_per_radian;
        let down = self.on_plane(DVec2::Y) / self.pixels_per_radian;
        let corner = -(right * self.middle.x + down * self.middle.y);
        let plane = DMat3::from_cols(right.extend(0.0), down.extend(0.0), corner.extend(1.0));
        self.basis.transpose() * plane
    }

    /// Standard coordinates (east, north) to canvas (right, down).
    fn on_canvas(&self, plane: DVec2) -> DVec2 {
        let (sin, cos) = self.north.sin_cos();
        let x = if self.mirrored { plane.x } else { -plane.x };
        let y = plane.y;
        // Counter-clockwise rotation with y up, then y turned down.
        DVec2::new(x * cos - y * sin, -(x * sin + y * cos))
    }

    /// Canvas (right, down) to standard coordinates (east, north): the inverse of [`Projection::on_canvas`].
    fn on_plane(&self, canvas: DVec2) -> DVec2 {
        let (sin, cos) = self.north.sin_cos();
        let (x, y) = (canvas.x, -canvas.y);
        let east = x * cos + y * sin;
        DVec2::new(if self.mirrored { east } else { -east }, y * cos - x * sin)
    }
}

/// Rows east, north and centre of the tangent plane at a position. At a pole, east follows the stated right ascension.
#[must_use]
pub fn tangent_basis(centre: &Equatorial<J2000>) -> DMat3 {
    let (sin_ra, cos_ra) = centre.ra().sin_cos();
    let (sin_dec, cos_dec) = centre.dec().sin_cos();
    let east = DVec3::new(-sin_ra, cos_ra, 0.0);
    let north = DVec3::new(-sin_dec * cos_ra, -sin_dec * sin_ra, cos_dec);
    DMat3::from_cols(east, north, centre.direction()).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(ra_deg: f64, dec_deg: f64) -> Equatorial<J2000> {
        Equatorial::new(Angle::degrees(ra_deg), Angle::degrees(dec_deg))
    }

    fn plain(north_deg: f64, mirrored: bool) -> Projection {
        Projection::new(&at(30.0, 20.0), Angle::degrees(north_deg), mirrored, Angle::arcseconds(1.0), (512.0, 384.0))
    }

    /// Where a star one arcminute north, and one east, of the centre is drawn: (right, down) in whole pixels.
    fn north_and_east(projection: &Projection) -> [(i64, i64); 2] {
        let minute = 1.0 / 60.0;
        let stars = [at(30.0, 20.0 + minute), at(30.0 + minute / 20f64.to_radians().cos(), 20.0)];
        stars.map(|star| {
            let (x, y) = projection.pixel(&star).unwrap();
            ((x - 512.0).round() as i64, (y - 384.0).round() as i64)
        })
    }

    #[test]
    fn all_eight_orientations_put_north_and_east_where_they_belong() {
        let (up, down, left, right) = ((0, -60), (0, 60), (-60, 0), (60, 0));
        for (north_deg, mirrored, expected) in [
            (0.0, false, [up, left]),
            (90.0, false, [left, down]),
            (180.0, false, [down, right]),
            (270.0, false, [right, up]),
            (0.0, true, [up, right]),
            (90.0, true, [left, up]),
            (180.0, true, [down, left]),
            (270.0, true, [right, down]),
        ] {
            assert_eq!(
                north_and_east(&plain(north_deg, mirrored)),
                expected,
                "north at {north_deg}, mirrored {mirrored}"
            );
        }
    }

    #[test]
    fn position_angles_point_where_the_stars_are() {
        let projection = plain(37.0, true);
        for (position_angle, star) in [(0.0, at(30.0, 20.01)), (90.0, at(30.01, 20.0)), (180.0, at(30.0, 19.99))] {
            let (x, y) = projection.pixel(&star).unwrap();
            let length = (x - 512.0).hypot(y - 384.0);
            let (dx, dy) = projection.direction_of(Angle::degrees(position_angle));
            assert!(((x - 512.0) / length - dx).abs() < 1e-3 && ((y - 384.0) / length - dy).abs() < 1e-3);
        }
    }

    #[test]
    fn the_other_side_of_the_sky_has_no_pixel() {
        assert_eq!(plain(0.0, false).pixel(&at(210.0, -20.0)), None);
        assert_eq!(plain(0.0, false).pixel(&at(121.0, 0.0)), None);
    }

    proptest! {
        #[test]
        fn a_pixel_is_found_again(
            ra in 0.0..360.0, dec in -90.0..90.0, north in 0.0..360.0, mirrored: bool, x in 0.0..1024.0, y in 0.0..768.0
        ) {
            let projection = Projection::new(
                &at(ra, dec), Angle::degrees(north), mirrored, Angle::arcseconds(1.129), (512.0, 384.0));
            let (x2, y2) = projection.pixel(&projection.position(x, y)).unwrap();
            prop_assert!((x - x2).abs() < 1e-5 && (y - y2).abs() < 1e-5);
        }
    }
}
