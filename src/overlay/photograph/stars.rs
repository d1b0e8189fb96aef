//! A photograph's stars against the catalogue's: whether it lies where it says.

use glam::DVec2;

use super::Photograph;
use super::light::opened;
use crate::overlay::stars::place;
use crate::sky::catalogue::{Catalogue, FieldStar, Object};
use crate::sky::coords::{Equatorial, J2000};
use crate::units::{Angle, Magnitude};

/// Most stars of either kind that are compared, the brightest.
const MOST: usize = 60;
/// A spot of more pixels is no star.
const LARGEST_SPOT: usize = 3000;

/// A spot of light in a photograph.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Its middle in pixels.
    pub pixel: DVec2,
    /// The sum of its light above its surroundings.
    pub light: f32,
}

/// The star-like spots of a photograph, the brightest first.
///
/// What is left of the picture after its opening ([`opened`]) stands in connected spots above a fifth of the brightest and six
/// times the spread of the faint half; a spot longer than twice its breadth, or at the edge, is none.
#[must_use]
pub fn spots(photograph: &Photograph) -> Vec<Spot> {
    let Some(picture) = photograph.picture() else { return Vec::new() };
    let (width, height) = (picture.width(), picture.height());
    let starless = opened(picture);
    let mut rest: Vec<f32> = picture
        .pixels()
        .iter()
        .zip(starless)
        .map(|(pixel, starless)| (pixel.iter().copied().fold(0.0, f32::max) - starless).max(0.0))
        .collect();
    let mut sorted: Vec<f32> = rest.iter().step_by((rest.len() / 65_536).max(1)).copied().collect();
    sorted.sort_by(f32::total_cmp);
    let spread = sorted.get(sorted.len() * 3 / 4).copied().unwrap_or(0.0);
    let threshold = (6.0 * spread).clamp(0.02, 0.3);

    let mut found = Vec::new();
    let mut open = Vec::new();
    for start in 0..rest.len() {
        if rest[start] < threshold {
            continue;
        }
        // Everything that hangs together, taken out as it is met.
        let (mut sum, mut first, mut second) = (0.0f64, DVec2::ZERO, [0.0f64; 3]);
        let (mut area, mut at_edge, mut light) = (0usize, false, 0.0);
        open.push(start);
        let origin = DVec2::new((start % width) as f64, (start / width) as f64);
        while let Some(place) = open.pop() {
            let value = std::mem::replace(&mut rest[place], 0.0);
            if value < threshold {
                continue;
            }
            let (x, y) = (place % width, place / width);
            let (weight, p) = (f64::from(value), DVec2::new(x as f64, y as f64) - origin);
            sum += weight;
            first += p * weight;
            second[0] += p.x * p.x * weight;
            second[1] += p.x * p.y * weight;
            second[2] += p.y * p.y * weight;
            light += value;
            area += 1;
            if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
                at_edge = true;
                continue;
            }
            open.extend([place - 1, place + 1, place - width, place + width]);
        }
        let mean = first / sum;
        let [xx, xy, yy] =
            [second[0] / sum - mean.x * mean.x, second[1] / sum - mean.x * mean.y, second[2] / sum - mean.y * mean.y];
        // The axes of the spot's moments.
        let (half, root) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
        let round = half + root < 4.0 * (half - root) + 0.5;
        if (3..=LARGEST_SPOT).contains(&area) && !at_edge && round {
            found.push(Spot { pixel: origin + mean + 0.5, light });
        }
    }
    found.sort_by(|a, b| b.light.total_cmp(&a.light));
    found
}

/// How a photograph's stars lie to the catalogue's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Stars of the catalogue in the photograph that were looked for: the brightest, at most 60.
    pub stars: usize,
    /// Of these, how many have a spot within reach of where the catalogue has them.
    pub met: usize,
    /// How many would be met by chance: the mean of the photograph shifted in eight directions.
    pub by_chance: f64,
    /// Half of the stars that are met are nearer to their spot than this.
    pub median: Angle,
}

impl Agreement {
    /// Whether so many are met that it is no chance: at least five, and four spreads more than by chance.
    #[must_use]
    pub fn beyond_chance(&self) -> bool {
        self.met >= 5 && self.met as f64 > self.by_chance + 4.0 * self.by_chance.max(1.0).sqrt()
    }

    /// Whether half of all that were looked for are met, and that is no chance.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.beyond_chance() && 2 * self.met >= self.stars
    }
}

/// Compares a photograph's stars with the catalogue's, each within `reach`; by their places in a year (the catalogue's own
/// motions bring them there). `None` when the catalogue has fewer than five stars there.
#[must_use]
pub fn agreement(photograph: &Photograph, catalogue: &Catalogue, reach: Angle, year: f64) -> Option<Agreement> {
    let middle = photograph.middle();
    let found = catalogue.within(&middle, photograph.radius(), Magnitude(99.0));
    let place = |star: &FieldStar| place(star, year - 2000.0);
    let mut stars: Vec<(f32, Equatorial<J2000>)> = found.stars.iter().map(|star| (star.v_mag, place(star))).collect();
    stars.retain(|(_, place)| photograph.contains(place));
    stars.sort_by(|a, b| a.0.total_cmp(&b.0));
    stars.truncate(MOST);
    if stars.len() < 5 {
        return None;
    }
    let places: Vec<DVec2> = stars.iter().filter_map(|(_, place)| photograph.plate.pixel(place)).collect();
    let mut spots = spots(photograph);
    // No more spots than the catalogue might know of, or any place is near to one.
    spots.truncate(2 * places.len());
    let scale = photograph.plate.scale().to_radians();
    let reach_px = reach.to_radians() / scale;
    let nearest = |shift: DVec2| -> Vec<f64> {
        let distance =
            |place: &DVec2| spots.iter().map(|spot| spot.pixel.distance(*place + shift)).fold(f64::INFINITY, f64::min);
        let mut distances: Vec<f64> = places.iter().map(distance).filter(|distance| *distance <= reach_px).collect();
        distances.sort_by(f64::total_cmp);
        distances
    };
    let met = nearest(DVec2::ZERO);
    let shifts =
        (0..8).map(|eighth| DVec2::from_angle(f64::from(eighth) * std::f64::consts::FRAC_PI_4) * 3.0 * reach_px);
    let by_chance = shifts.map(|shift| nearest(shift).len()).sum::<usize>() as f64 / 8.0;
    Some(Agreement {
        stars: places.len(),
        met: met.len(),
        by_chance,
        median: Angle::radians(met.get(met.len() / 2).copied().unwrap_or(0.0) * scale),
    })
}

impl Photograph {
    /// What is doubtful about its place, if anything: its object is not in it, or its stars are not where the catalogue's are.
    #[must_use]
    pub fn doubt(&self, object: Option<&Object>, stars: Option<&Agreement>) -> Option<String> {
        if let Some(object) = object.filter(|object| !self.contains(&object.astrometry.position)) {
            let away = object.astrometry.position.separation(&self.middle());
            // The parts of a mosaic need not hold the middle of what they are parts of.
            let extent = object.axes_arcmin.map_or(Angle::ZERO, |(major, _)| Angle::arcminutes(major / 2.0));
            if away > self.radius() + extent {
                return Some(format!(
                    "it is placed {:.1} degrees away from {}, whose name it has: it is drawn where it is placed; check its coordinates",
                    away.to_degrees(),
                    object.name
                ));
            }
        }
        let stars = stars.filter(|stars| stars.stars >= 15 && !stars.beyond_chance())?;
        Some(format!(
            "of {} stars that the catalogue has there it shows {} ({:.0} would be met by chance): it may be turned, mirrored or elsewhere; \
             check its coordinates",
            stars.stars, stars.met, stars.by_chance
        ))
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat2;

    use super::*;
    use crate::overlay::photograph::Plate;
    use crate::picture::Picture;

    /// A photograph of the Pleiades with stars of V 10 and brighter where the catalogue has them, turned by some angle about its middle.
    fn pleiades(turned: f64) -> Photograph {
        let centre = Equatorial::new(Angle::degrees(56.75), Angle::degrees(24.12));
        let scale = Angle::arcseconds(5.0).to_radians();
        let matrix = DMat2::from_diagonal(DVec2::new(-scale, -scale));
        let plate = Plate { centre, reference: DVec2::splat(300.0), matrix };
        let mut photograph = Photograph::new("m45".into(), None, plate, Picture::black(600, 600));
        let found = Catalogue::embedded().within(&centre, Angle::degrees(0.6), Magnitude(10.0));
        let stars: Vec<DVec2> = found.stars.iter().filter_map(|star| plate.pixel(&place(star, 0.0))).collect();
        assert!(stars.len() > 20, "{}", stars.len());
        let turn = DMat2::from_angle(turned);
        let mut picture = Picture::black(600, 600);
        for y in 0..600 {
            for (x, pixel) in picture.row_mut(y).iter_mut().enumerate() {
                let here = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let light = |star: &DVec2| {
                    let star = turn * (*star - DVec2::splat(300.0)) + DVec2::splat(300.0);
                    0.8 * (-here.distance_squared(star) / 4.5).exp()
                };
                *pixel = [stars.iter().map(light).sum::<f64>() as f32; 3];
            }
        }
        // A trail of a satellite is no star.
        for step in 0..60 {
            picture.row_mut(500)[200 + step] = [0.9; 3];
        }
        photograph = Photograph::new(photograph.name, None, plate, picture);
        photograph
    }

    #[test]
    fn stars_are_met_where_the_catalogue_has_them_and_no_trail_is_one() {
        let photograph = pleiades(0.0);
        let agreement = agreement(&photograph, Catalogue::embedded(), Angle::arcseconds(10.0), 2000.0).unwrap();
        assert!(agreement.holds() && agreement.median < Angle::arcseconds(2.0), "{agreement:?}");
        assert_eq!(photograph.doubt(None, Some(&agreement)), None);
        assert!(spots(&photograph).iter().all(|spot| (spot.pixel.y - 500.5).abs() > 2.0));
    }

    #[test]
    fn a_photograph_that_is_turned_or_of_elsewhere_is_doubted_in_words() {
        let agreement = agreement(&pleiades(1.0), Catalogue::embedded(), Angle::arcseconds(10.0), 2000.0).unwrap();
        assert!(!agreement.beyond_chance(), "{agreement:?}");
        assert!(pleiades(1.0).doubt(None, Some(&agreement)).unwrap().contains("turned, mirrored or elsewhere"));
        let ring = Catalogue::embedded().search("M57").unwrap();
        assert!(pleiades(0.0).doubt(Some(&ring), None).unwrap().contains("degrees away from"));
    }

    #[test]
    fn a_photograph_without_stars_or_of_one_pixel_has_none() {
        let plate = pleiades(0.0).plate;
        for side in [1, 300] {
            let grey = Photograph::new("grey".into(), None, plate, Picture::black(side, side));
            assert_eq!(spots(&grey), []);
        }
    }
}
