//! What is done to a photograph's light: its background taken away, its stars softened, its brightness told in that of the sky.

use super::{Photograph, Plate};
use crate::picture::Picture;
use crate::sky::catalogue::{Kind, Object};
use crate::units::SurfaceBrightness;

/// Cells a side in which the background is looked for.
const CELLS: usize = 16;

/// Share of the cells that are taken to show the sky: an object may fill the rest.
const SKY_SHARE: f64 = 0.2;

/// Takes the sky's own light away, in each channel.
///
/// The picture is cut into 16 x 16 cells; the median of a cell does not know its stars, and the 20th percentile of the medians
/// does not know the object, as long as that leaves a fifth of the picture free. In a picture that its object fills the
/// faintest fifth of it becomes black. What is no number is black.
pub fn without_background(picture: &mut Picture) {
    let sky = background(picture);
    for pixel in picture.pixels_mut() {
        for (light, sky) in pixel.iter_mut().zip(sky) {
            *light = if light.is_finite() { (*light - sky).max(0.0) } else { 0.0 };
        }
    }
}

/// The light of the sky in a picture, in each channel.
fn background(picture: &Picture) -> [f32; 3] {
    let (width, height) = (picture.width(), picture.height());
    let mut medians: [Vec<f32>; 3] = Default::default();
    let edge = |cell: usize, side: usize| cell * side / CELLS;
    for cell in 0..CELLS * CELLS {
        let (i, j) = (cell % CELLS, cell / CELLS);
        let mut values: [Vec<f32>; 3] = Default::default();
        for y in edge(j, height)..edge(j + 1, height) {
            for pixel in &picture.row(y)[edge(i, width)..edge(i + 1, width)] {
                values
                    .iter_mut()
                    .zip(pixel)
                    .filter(|(_, light)| light.is_finite())
                    .for_each(|(all, light)| all.push(*light));
            }
        }
        for (medians, values) in medians.iter_mut().zip(&mut values) {
            medians.extend(at_share(values, 0.5));
        }
    }
    medians.map(|mut medians| at_share(&mut medians, SKY_SHARE).unwrap_or(0.0))
}

/// The value below which a share of all lies.
fn at_share(values: &mut [f32], share: f64) -> Option<f32> {
    let place = ((values.len() as f64 * share) as usize).min(values.len().checked_sub(1)?);
    Some(*values.select_nth_unstable_by(place, f32::total_cmp).1)
}

/// Softens stars: so much of the light of what is narrower than a few pixels is taken away, 0 nothing, 1 all.
///
/// The light without stars is the opening by a square (the largest of the smallest neighbours), of which the side is a
/// hundredth of the picture's, 5 to 25 pixels. An edge of the object that is narrower is softened too.
pub fn soften_stars(picture: &mut Picture, share: f32) {
    let share = share.clamp(0.0, 1.0);
    if share == 0.0 || picture.pixels().is_empty() {
        return;
    }
    let starless = opened(picture);
    for (pixel, starless) in picture.pixels_mut().iter_mut().zip(starless) {
        let light = brightest(pixel);
        if light > 0.0 {
            // One factor for all channels keeps the colour.
            let kept = (starless + (light - starless) * (1.0 - share)) / light;
            pixel.iter_mut().for_each(|channel| *channel *= kept);
        }
    }
}

fn brightest(pixel: &[f32; 3]) -> f32 {
    pixel.iter().copied().fold(0.0, f32::max)
}

/// The brightest channel of each pixel without what is narrow.
pub(super) fn opened(picture: &Picture) -> Vec<f32> {
    let (width, height) = (picture.width(), picture.height());
    let reach = (width.min(height) / 200).clamp(2, 12);
    let light: Vec<f32> = picture.pixels().iter().map(brightest).collect();
    let eroded = extreme(&light, width, height, reach, f32::min);
    extreme(&eroded, width, height, reach, f32::max)
}

/// The least or greatest of all within `reach` rows and columns.
fn extreme(light: &[f32], width: usize, height: usize, reach: usize, pick: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let mut along = vec![0.0; light.len()];
    for y in 0..height {
        let row = &light[y * width..(y + 1) * width];
        for (x, out) in along[y * width..(y + 1) * width].iter_mut().enumerate() {
            let near = &row[x.saturating_sub(reach)..(x + reach + 1).min(width)];
            *out = near.iter().copied().fold(row[x], &pick);
        }
    }
    let mut both = along.clone();
    for y in 0..height {
        for other in y.saturating_sub(reach)..(y + reach + 1).min(height) {
            let (out, row) = (&mut both[y * width..(y + 1) * width], &along[other * width..(other + 1) * width]);
            out.iter_mut().zip(row).for_each(|(out, light)| *out = pick(*out, *light));
        }
    }
    both
}

/// The surface brightness that full light (1) in a photograph stands for, from the catalogue's mean over the object's ellipse.
///
/// ```text
/// SB(1) = SB(object) + 2.5 lg mean        mean: luminance over the ellipse, the sky's taken away
/// ```
///
/// `None` when the catalogue has no surface brightness or size, when more than half of the ellipse is outside of the
/// photograph, or when there is no light in it. Of all but clusters the stars before it are left out of the mean.
#[must_use]
pub fn full_light(plate: &Plate, picture: &Picture, object: &Object) -> Option<SurfaceBrightness> {
    let brightness = object.surface_brightness?;
    let (major, minor) = object.axes_arcmin?;
    let of_stars = matches!(object.kind, Kind::OpenCluster | Kind::GlobularCluster | Kind::Association);
    let starless = if of_stars { Vec::new() } else { opened(picture) };

    // In the object's own frame: along the axes, in shares of their halves.
    let to_halves = |arcmin: f64| 1.0 / (arcmin / 2.0 / 60.0).to_radians();
    let (sin, cos) = object.position_angle.unwrap_or_default().sin_cos();
    let basis = crate::sky::project::tangent_basis(&object.astrometry.position);
    let (mut sum, mut count) = (0.0, 0u32);
    let (width, height) = (picture.width(), picture.height());
    // As many places as make a good mean, however large the picture is.
    let step = (width.max(height) / 256).max(1);
    for y in (0..height).step_by(step) {
        for x in (0..width).step_by(step) {
            let plane = basis * plate.position(x as f64 + 0.5, y as f64 + 0.5).direction();
            if plane.z <= 0.0 {
                continue;
            }
            let (east, north) = (plane.x / plane.z, plane.y / plane.z);
            let along = (east * sin + north * cos) * to_halves(major);
            let across = (east * cos - north * sin) * to_halves(minor);
            if along.hypot(across) <= 1.0 {
                let pixel = picture.row(y)[x];
                let kept = starless.get(y * width + x).map_or(1.0, |starless| starless / brightest(&pixel).max(1e-9));
                sum += f64::from((0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]) * kept);
                count += 1;
            }
        }
    }
    let pixels_in_ellipse =
        std::f64::consts::PI / (to_halves(major) * to_halves(minor)) / plate.matrix.determinant().abs();
    let expected = pixels_in_ellipse / (step * step) as f64;
    let mean = sum / f64::from(count.max(1));
    let seen = f64::from(count) >= 0.5 * expected && count > 0;
    (seen && mean > 1e-5).then(|| SurfaceBrightness(brightness.0 + 2.5 * mean.log10()))
}

/// Full light of a drawn photograph is so many magnitudes brighter than the surface of the object that is looked at: its mean
/// then has a sixth of full light, which leaves room for a core.
pub const WHITE_OVER_OBJECT_MAG: f64 = 2.0;

impl Photograph {
    /// By which factor its light is drawn brighter, so that full light is [`WHITE_OVER_OBJECT_MAG`] brighter than the surface of
    /// the object that is looked at, and a neighbour's photograph as much fainter or brighter as the neighbour is.
    ///
    /// ```text
    /// gain = 10^(0.4 (SB(target) - 2 - SB(1)))      held between 1/20 and 20
    /// ```
    ///
    /// Without a surface brightness of the target the photograph's own object stands for it; a photograph of which nothing is
    /// known is drawn as it is.
    #[must_use]
    pub fn gain(&self, target: Option<SurfaceBrightness>) -> f32 {
        let Some((full, own)) = self.full_light.zip(target.or(self.surface_brightness)) else { return 1.0 };
        (10f64.powf(0.4 * (own.0 - WHITE_OVER_OBJECT_MAG - full.0)) as f32).clamp(0.05, 20.0)
    }

    /// The photograph with its sky taken away and so much of its stars' light (0 nothing, 1 all); where it is known of
    /// which object it is, it knows from now on how bright its light is.
    #[must_use]
    pub fn prepared(self, object: Option<&Object>, soften: f32) -> Photograph {
        let Some(mut picture) = self.picture().cloned() else { return self };
        without_background(&mut picture);
        let full = object.and_then(|object| full_light(&self.plate, &picture, object));
        soften_stars(&mut picture, soften);
        Photograph {
            object: object.map(|object| object.name.clone()),
            full_light: full,
            surface_brightness: object.and_then(|object| object.surface_brightness),
            levels: super::levels(picture),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat2, DVec2};

    use super::*;
    use crate::sky::catalogue::Catalogue;
    use crate::units::Angle;

    /// A sky of 0.1 with a little unevenness, and what is added to it.
    fn sky(side: usize, more: impl Fn(f32, f32) -> f32) -> Picture {
        let mut picture = Picture::black(side, side);
        for y in 0..side {
            for (x, pixel) in picture.row_mut(y).iter_mut().enumerate() {
                let uneven = 0.002 * (((x * 7919 + y * 104_729) % 101) as f32 / 50.0 - 1.0);
                *pixel = [0.1 + uneven + more(x as f32, y as f32); 3];
            }
        }
        picture
    }

    fn spot(x: f32, y: f32, at: (f32, f32), light: f32, width: f32) -> f32 {
        light * (-((x - at.0).powi(2) + (y - at.1).powi(2)) / (2.0 * width * width)).exp()
    }

    #[test]
    fn the_sky_goes_and_the_object_stays_and_what_is_no_number_is_black() {
        let object = |x: f32, y: f32| if (x - 128.0).hypot(y - 128.0) < 80.0 { 0.3 } else { 0.0 };
        let mut picture = sky(256, |x, y| object(x, y) + spot(x, y, (30.0, 40.0), 1.0, 2.0));
        picture.row_mut(5)[5] = [f32::NAN; 3];
        without_background(&mut picture);
        assert_eq!(picture.row(5)[5], [0.0; 3]);
        assert!((picture.row(128)[128][0] - 0.3).abs() < 0.006, "{:?}", picture.row(128)[128]);
        assert!(picture.row(230)[20][0] < 0.006, "{:?}", picture.row(230)[20]);
    }

    #[test]
    fn stars_soften_by_the_share_asked_for_and_a_nebula_does_not() {
        let nebula = |x: f32, y: f32| spot(x, y, (150.0, 150.0), 0.4, 60.0);
        let whole = sky(300, |x, y| nebula(x, y) + spot(x, y, (80.0, 80.0), 0.5, 0.8));
        for share in [0.0, 0.5, 1.0] {
            let mut picture = whole.clone();
            soften_stars(&mut picture, share);
            let star = picture.row(80)[80][0] - 0.1 - nebula(80.0, 80.0);
            assert!((star - 0.5 * (1.0 - share)).abs() < 0.02, "{share}: {star}");
            assert!((picture.row(150)[150][0] - whole.row(150)[150][0]).abs() < 0.01);
        }
    }

    #[test]
    fn a_picture_of_one_pixel_is_no_trouble() {
        let mut picture = Picture::black(1, 1);
        picture.row_mut(0)[0] = [0.5; 3];
        soften_stars(&mut picture, 1.0);
        without_background(&mut picture);
        assert!(picture.row(0)[0].iter().all(|light| light.is_finite()));
    }

    #[test]
    fn full_light_is_as_many_magnitudes_brighter_as_the_ellipse_is_darker_than_white() {
        // M57: V 8.8 over 1.4 x 1.0 arcminutes; here it has a tenth of full light, evenly.
        let object = Catalogue::embedded().search("M57").unwrap();
        let scale = Angle::arcseconds(1.0).to_radians();
        let plate = Plate {
            centre: object.astrometry.position,
            reference: DVec2::splat(150.0),
            matrix: DMat2::from_diagonal(DVec2::new(-scale, scale)),
        };
        let mut picture = Picture::black(300, 300);
        picture.pixels_mut().fill([0.1; 3]);
        let full = full_light(&plate, &picture, &object).unwrap();
        let brightness = object.surface_brightness.unwrap();
        assert!((full.0 - (brightness.0 - 2.5)).abs() < 0.01, "{} {}", full.0, brightness.0);
        // Drawn, full light is 2 magnitudes brighter than the object: 0.5 magnitudes below what it stood for.
        let photograph = Photograph { full_light: Some(full), ..Photograph::new("m57".into(), None, plate, picture) };
        let gain = photograph.gain(Some(brightness));
        assert!((gain - 10f32.powf(0.4 * 0.5)).abs() < 0.02, "{gain}");
        // Elsewhere there is none of it to be seen.
        let elsewhere =
            Plate { centre: crate::sky::coords::Equatorial::new(Angle::degrees(10.0), Angle::ZERO), ..plate };
        assert_eq!(full_light(&elsewhere, photograph.picture().unwrap(), &object), None);
    }
}
