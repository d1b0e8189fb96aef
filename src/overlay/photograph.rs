//! The observer's photographs: read, and drawn at the right place, scale and angle.

use std::sync::Arc;

use glam::{DMat2, DMat3, DVec2, DVec3, Vec3A};

use super::canvas::Region;
use crate::picture::Picture;
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::project::{Projection, tangent_basis};
use crate::units::{Angle, SurfaceBrightness};

/// A plate from the places of a picture's corners.
pub mod corners;
/// A picture laid on the canvas where a homography puts it: the hot loop of every photograph and animation.
mod lay;
/// What is done to its light.
pub mod light;
/// Reading photographs from the bytes of files.
pub mod read;
/// JSON as people write it.
pub mod relaxed_json;
/// Its stars against the catalogue's.
pub mod stars;
/// Stellarium's set of pictures.
pub mod stellarium;
/// The astrometric cards of a FITS header.
mod wcs;

pub use read::{MOST_BYTES, PhotographError};

/// Where a photograph's pixels are on the sky: a tangent plane and a matrix.
///
/// ```text
/// (xi, eta) = CD (p - p0)        radians east and north; p in pixels, pixel (i, j) covers i..i+1, j..j+1 as stored
/// ```
///
/// Calabretta and Greisen (2002), A&A 395, 1077, the TAN projection. (FITS counts the first pixel's middle as 1, so its
/// CRPIX is 0.5 more.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// The tangent point.
    pub centre: Equatorial<J2000>,
    /// The tangent point's place in the picture.
    pub reference: DVec2,
    /// Radians a pixel.
    pub matrix: DMat2,
}

impl Plate {
    /// Canvas position to photograph position, as a homogeneous matrix: both are flat views of one sphere from its middle.
    fn canvas_map(&self, projection: &Projection) -> DMat3 {
        let inverse = self.matrix.inverse();
        let onto_plate =
            DMat3::from_cols(inverse.x_axis.extend(0.0), inverse.y_axis.extend(0.0), self.reference.extend(1.0));
        onto_plate * tangent_basis(&self.centre) * projection.ray_map()
    }

    /// The sky position of a place in the picture.
    #[must_use]
    pub fn position(&self, x: f64, y: f64) -> Equatorial<J2000> {
        let plane = self.matrix * (DVec2::new(x, y) - self.reference);
        Equatorial::from_direction(tangent_basis(&self.centre).transpose() * plane.extend(1.0))
    }
}

/// A photograph and where it belongs.
#[derive(Debug, Clone, PartialEq)]
pub struct Photograph {
    /// What it is called: the file's name without its ending.
    pub name: String,
    /// Who took it; shown with it.
    pub credit: Option<String>,
    /// Where it comes from.
    pub url: Option<String>,
    /// On which terms it may be used; shown with it.
    pub licence: Option<String>,
    /// Of which object it is, in the catalogue's name.
    pub object: Option<String>,
    /// Its object's mean surface brightness.
    pub surface_brightness: Option<SurfaceBrightness>,
    /// The surface brightness that its full light (1) stands for, where that is known.
    pub full_light: Option<SurfaceBrightness>,
    /// Where it is on the sky.
    pub plate: Plate,
    /// By how much the plate misses the places that it was made from, where there were more than it needs.
    pub miss: Option<Angle>,
    /// The picture, then each time half as large, down to a few pixels: so that shrinking averages instead of skipping.
    levels: Arc<[Picture]>,
}

/// A picture, then each time half as large, down to a few pixels.
fn levels(picture: Picture) -> Arc<[Picture]> {
    let mut levels = vec![picture];
    while let Some(last) = levels.last().filter(|last| last.width().min(last.height()) > 16) {
        levels.push(last.halved());
    }
    levels.into()
}

impl Photograph {
    /// From a picture of which the place is known.
    #[must_use]
    pub fn new(name: String, credit: Option<String>, plate: Plate, picture: Picture) -> Photograph {
        Photograph {
            name,
            credit,
            url: None,
            licence: None,
            object: None,
            surface_brightness: None,
            full_light: None,
            plate,
            miss: None,
            levels: levels(picture),
        }
    }

    /// Who took it and on which terms it is shown: `A. Observer (CC-BY-4.0)`.
    #[must_use]
    pub fn credit_line(&self) -> Option<String> {
        match (&self.credit, &self.licence) {
            (Some(credit), Some(licence)) => Some(format!("{credit} ({licence})")),
            (Some(one), None) | (None, Some(one)) => Some(one.clone()),
            (None, None) => None,
        }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        self.levels.first().map_or((0, 0), |picture| (picture.width(), picture.height()))
    }

    /// Its light, as drawn.
    #[must_use]
    pub fn picture(&self) -> Option<&Picture> {
        self.levels.first()
    }

    /// Draws the photograph into a picture where it lies in the region, over what is there; `colour` turns its light into the
    /// projector's. Towards its edges it fades into what is there. Whether anything was drawn.
    pub fn draw(
        &self,
        picture: &mut Picture,
        region: &Region,
        projection: &Projection,
        colour: impl Fn(Vec3A) -> Vec3A,
    ) -> bool {
        let map = self.plate.canvas_map(projection);
        let Some((level, source)) = self.level(&map, picture) else { return false };
        let shrink = 1.0 / f64::from(1u32 << level);
        let map = DMat3::from_diagonal(DVec3::new(shrink, shrink, 1.0)) * map;
        lay::lay(picture, region, source, &map, colour)
    }

    /// The level whose pixels are about as large as the canvas', and its number; `None` when it is behind the observer.
    fn level(&self, map: &DMat3, canvas: &Picture) -> Option<(usize, &Picture)> {
        let middle = DVec3::new(canvas.width() as f64 / 2.0, canvas.height() as f64 / 2.0, 1.0);
        let at = |v: DVec3| {
            let h = *map * v;
            (h.z > 0.0).then(|| DVec2::new(h.x, h.y) / h.z)
        };
        let here = at(middle)?;
        let step = (at(middle + DVec3::X)? - here).length().max((at(middle + DVec3::Y)? - here).length());
        let level = (step.max(1.0).log2().round() as usize).min(self.levels.len() - 1);
        Some((level, &self.levels[level]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ra_deg: f64, dec_deg: f64) -> Equatorial<J2000> {
        Equatorial::new(Angle::degrees(ra_deg), Angle::degrees(dec_deg))
    }

    /// A photograph, black but for single bright pixels, and the sky positions of their middles.
    fn dotted(plate: Plate, dots: &[(usize, usize)]) -> (Photograph, Vec<Equatorial<J2000>>) {
        let mut picture = Picture::black(400, 300);
        for &(x, y) in dots {
            picture.row_mut(y)[x] = [1.0; 3];
        }
        let positions = dots.iter().map(|&(x, y)| plate.position(x as f64 + 0.5, y as f64 + 0.5)).collect();
        (Photograph::new("dots".into(), None, plate, picture), positions)
    }

    /// The light-weighted middle of what is near a place.
    fn centroid(picture: &Picture, x: f64, y: f64) -> (f64, f64) {
        let (mut sum, mut sx, mut sy) = (0.0, 0.0, 0.0);
        for j in (y as usize - 8)..(y as usize + 8) {
            for i in (x as usize - 8)..(x as usize + 8) {
                let light = f64::from(picture.row(j)[i][0]);
                sum += light;
                sx += light * (i as f64 + 0.5);
                sy += light * (j as f64 + 0.5);
            }
        }
        (sx / sum, sy / sum)
    }

    #[test]
    fn bright_pixels_are_drawn_where_their_sky_is_within_a_third_of_a_pixel() {
        let arcsec = Angle::arcseconds(1.0).to_radians();
        for (north_deg, mirrored, pixel_arcsec) in [(0.0, false, 2.0), (123.0, true, 2.0), (300.0, false, 0.9)] {
            let turn = DMat2::from_angle(0.4) * DMat2::from_diagonal(DVec2::new(-1.0, 1.0)) * (pixel_arcsec * arcsec);
            let plate = Plate { centre: at(83.63, 22.01), reference: DVec2::new(180.0, 150.0), matrix: turn };
            let (photograph, positions) = dotted(plate, &[(200, 150), (120, 100), (260, 220)]);
            let projection = Projection::new(
                &at(83.64, 22.00),
                Angle::degrees(north_deg),
                mirrored,
                Angle::arcseconds(1.129),
                (512.0, 384.0),
            );
            let mut canvas = Picture::black(1024, 768);
            assert!(photograph.draw(&mut canvas, &Region::new(1024, 768, vec![]), &projection, |light| light));
            for position in positions {
                let (x, y) = projection.pixel(&position).unwrap();
                let (cx, cy) = centroid(&canvas, x, y);
                assert!((cx - x).hypot(cy - y) < 0.33, "north {north_deg}: {x} {y} drawn at {cx} {cy}");
            }
        }
    }

    #[test]
    fn shrinking_keeps_the_mean_light_of_a_chequered_photograph() {
        let mut picture = Picture::black(512, 512);
        for y in 0..512 {
            for x in 0..512 {
                if (x + y) % 2 == 0 {
                    picture.row_mut(y)[x] = [1.0; 3];
                }
            }
        }
        let scale = Angle::arcseconds(0.25).to_radians();
        let matrix = DMat2::from_diagonal(DVec2::new(-scale, -scale));
        let plate = Plate { centre: at(10.0, 0.0), reference: DVec2::splat(256.0), matrix };
        let photograph = Photograph::new("chequers".into(), None, plate, picture);
        let projection = Projection::new(&at(10.0, 0.0), Angle::ZERO, false, Angle::arcseconds(1.0), (100.0, 100.0));
        let mut canvas = Picture::black(200, 200);
        photograph.draw(&mut canvas, &Region::new(200, 200, vec![]), &projection, |light| light);
        for y in 60..140 {
            for pixel in &canvas.row(y)[60..140] {
                assert!((pixel[0] - 0.5).abs() < 0.01);
            }
        }
    }

    #[test]
    fn a_photograph_of_the_other_side_of_the_sky_is_not_drawn() {
        let matrix = DMat2::from_diagonal(DVec2::splat(1e-5));
        let plate = Plate { centre: at(190.0, 0.0), reference: DVec2::splat(200.0), matrix };
        let (photograph, _) = dotted(plate, &[(200, 200)]);
        let projection = Projection::new(&at(10.0, 0.0), Angle::ZERO, false, Angle::arcseconds(1.0), (100.0, 100.0));
        let mut canvas = Picture::black(200, 200);
        assert!(!photograph.draw(&mut canvas, &Region::new(200, 200, vec![]), &projection, |light| light));
        assert!(canvas.is_black());
    }
}
