//! A plate from the places of a picture's corners on the sky.

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::{Photograph, PhotographError, Plate};
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::project::tangent_basis;
use crate::units::Angle;

/// A place in the picture in pixels and its place on the sky.
pub type Pair = (DVec2, Equatorial<J2000>);

impl Plate {
    /// The plate that fits pairs of places best, and the greatest distance by which it misses one of them.
    ///
    /// ```text
    /// sum |CD (p_i - p0) - (xi_i, eta_i)|^2 -> min
    /// ```
    ///
    /// Least squares in the tangent plane at the middle of the pairs: linear in the six numbers of CD and CD p0. Four corners
    /// leave two equations over, so a wrong corner shows in the distance.
    ///
    /// # Errors
    /// Fewer than three pairs, pairs that lie on a line, in the sky or in the picture, or spread over a half sphere; a scale that
    /// no picture has.
    pub fn of_pairs(pairs: &[Pair]) -> Result<(Plate, Angle), PhotographError> {
        let unusable = || PhotographError::Corners;
        let sum: DVec3 = pairs.iter().map(|(_, sky)| sky.direction()).sum();
        let centre = Equatorial::from_direction(sum.try_normalize().ok_or_else(unusable)?);
        let basis = tangent_basis(&centre);
        let onto = |sky: &Equatorial<J2000>| {
            let plane = basis * sky.direction();
            (plane.z > 0.1).then(|| DVec2::new(plane.x, plane.y) / plane.z)
        };
        let planes: Vec<DVec2> = pairs.iter().map(|(_, sky)| onto(sky)).collect::<Option<_>>().ok_or_else(unusable)?;

        // About the pixels' middle and in units of their spread, so that the normal equations are well conditioned.
        let count = pairs.len() as f64;
        let middle = pairs.iter().map(|(pixel, _)| *pixel).sum::<DVec2>() / count;
        let spread = pairs.iter().map(|(pixel, _)| pixel.distance(middle)).fold(0.0, f64::max);
        let (mut normal, mut right) = (DMat3::ZERO, [DVec3::ZERO; 2]);
        for ((pixel, _), plane) in pairs.iter().zip(&planes) {
            let row = ((*pixel - middle) / spread).extend(1.0);
            normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
            right[0] += row * plane.x;
            right[1] += row * plane.y;
        }
        if !(normal.determinant() / count.powi(3)).abs().gt(&1e-6) {
            return Err(unusable());
        }
        let [east, north] = right.map(|right| normal.inverse() * right);
        let matrix = DMat2::from_cols(DVec2::new(east.x, north.x), DVec2::new(east.y, north.y)) / spread;
        let area_arcsec2 = matrix.determinant().abs() * Angle::radians(1.0).to_arcseconds().powi(2);
        if !(1e-6..1e8).contains(&area_arcsec2) {
            return Err(PhotographError::Scale(area_arcsec2.sqrt()));
        }
        let plate = Plate { centre, reference: middle - matrix.inverse() * DVec2::new(east.z, north.z), matrix };
        let miss = |(pixel, sky): &Pair| plate.position(pixel.x, pixel.y).separation(sky);
        let worst = pairs.iter().map(miss).fold(Angle::ZERO, Angle::max);
        Ok((plate, worst))
    }

    /// Where a place on the sky is in the picture, in pixels; `None` when it is 90 degrees or more from the tangent point.
    #[must_use]
    pub fn pixel(&self, position: &Equatorial<J2000>) -> Option<DVec2> {
        let plane = tangent_basis(&self.centre) * position.direction();
        (plane.z > 1e-9).then(|| self.reference + self.matrix.inverse() * (DVec2::new(plane.x, plane.y) / plane.z))
    }

    /// The sky under one pixel's side: the square root of its area.
    #[must_use]
    pub fn scale(&self) -> Angle {
        Angle::radians(self.matrix.determinant().abs().sqrt())
    }
}

impl Photograph {
    /// Whether a place on the sky is in the picture.
    #[must_use]
    pub fn contains(&self, position: &Equatorial<J2000>) -> bool {
        let inside = |p: DVec2| {
            let (width, height) = self.size();
            p.x >= 0.0 && p.y >= 0.0 && p.x < width as f64 && p.y < height as f64
        };
        self.plate.pixel(position).is_some_and(inside)
    }

    /// The place of its middle on the sky.
    #[must_use]
    pub fn middle(&self) -> Equatorial<J2000> {
        let (width, height) = self.size();
        self.plate.position(width as f64 / 2.0, height as f64 / 2.0)
    }

    /// From the middle to the farthest corner.
    #[must_use]
    pub fn radius(&self) -> Angle {
        let (width, height) = self.size();
        let middle = self.middle();
        let corner = |x: usize, y: usize| self.plate.position(x as f64, y as f64).separation(&middle);
        [corner(0, 0), corner(width, 0), corner(0, height), corner(width, height)]
            .into_iter()
            .fold(Angle::ZERO, Angle::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(ra_deg: f64, dec_deg: f64) -> Equatorial<J2000> {
        Equatorial::new(Angle::degrees(ra_deg), Angle::degrees(dec_deg))
    }

    const SQUARE: [DVec2; 4] =
        [DVec2::new(0.0, 512.0), DVec2::new(512.0, 512.0), DVec2::new(512.0, 0.0), DVec2::new(0.0, 0.0)];

    fn pairs(corners: [(f64, f64); 4]) -> Vec<Pair> {
        SQUARE.into_iter().zip(corners.map(|(ra, dec)| at(ra, dec))).collect()
    }

    #[test]
    fn corners_across_right_ascension_zero_and_at_the_pole_give_their_middle() {
        let (plate, miss) = Plate::of_pairs(&pairs([(0.1, -0.1), (359.9, -0.1), (359.9, 0.1), (0.1, 0.1)])).unwrap();
        assert!(plate.position(256.0, 256.0).separation(&at(0.0, 0.0)).to_arcseconds() < 0.01);
        assert!((plate.scale().to_arcseconds() - 720.0 / 512.0).abs() < 1e-4 && miss.to_arcseconds() < 0.01);
        let (plate, _) = Plate::of_pairs(&pairs([(0.0, 89.9), (90.0, 89.9), (180.0, 89.9), (270.0, 89.9)])).unwrap();
        assert!(plate.position(256.0, 256.0).separation(&at(0.0, 90.0)).to_arcseconds() < 0.01);
    }

    #[test]
    fn a_corner_that_is_wrong_by_a_minute_shows_in_the_distance_and_impossible_ones_are_refused() {
        let (_, miss) =
            Plate::of_pairs(&pairs([(10.1, 0.0), (9.9, 0.0), (9.9, 0.2 + 1.0 / 60.0), (10.1, 0.2)])).unwrap();
        assert!((miss.to_arcseconds() - 15.0).abs() < 1.0, "a quarter of the error each: {}", miss.to_arcseconds());
        for corners in [
            [(10.0, 0.0); 4],
            [(1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 0.0)],
            [(0.0, 0.0), (90.0, 0.0), (180.0, 0.0), (270.0, 0.0)],
        ] {
            assert!(Plate::of_pairs(&pairs(corners)).is_err(), "{corners:?}");
        }
        assert!(Plate::of_pairs(&pairs([(f64::NAN, 0.0), (9.9, 0.0), (9.9, 0.2), (10.1, 0.2)])).is_err());
        assert!(Plate::of_pairs(&[]).is_err());
    }

    proptest! {
        #[test]
        fn the_plate_of_a_plates_own_corners_is_that_plate(
            ra in 0.0..360.0, dec in -89.0..89.0f64, turn in 0.0..6.2f64, scale_arcsec in 0.1..20.0f64, mirrored: bool,
        ) {
            let flip = DMat2::from_diagonal(DVec2::new(if mirrored { 1.0 } else { -1.0 }, 1.0));
            let matrix = DMat2::from_angle(turn) * flip * Angle::arcseconds(scale_arcsec).to_radians();
            let own = Plate { centre: at(ra, dec), reference: DVec2::splat(256.0), matrix };
            let pairs: Vec<Pair> = SQUARE.into_iter().map(|p| (p, own.position(p.x, p.y))).collect();
            let (plate, miss) = Plate::of_pairs(&pairs).unwrap();
            prop_assert!(miss.to_arcseconds() < 0.01);
            for (x, y) in [(100.0, 40.0), (500.0, 480.0)] {
                prop_assert!(plate.position(x, y).separation(&own.position(x, y)).to_arcseconds() < 0.01);
                let back = plate.pixel(&own.position(x, y)).unwrap();
                prop_assert!(back.distance(DVec2::new(x, y)) < 0.01);
            }
        }
    }
}
