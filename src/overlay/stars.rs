//! Stars as soft points: larger and brighter with their magnitude, in their colour.

use super::canvas::Region;
use super::colour;
use super::style::Palette;
use crate::picture::Picture;
use crate::sky::catalogue::FieldStar;
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// Where a star stands some years after J2000.0: its proper motion added in the tangent plane.
///
/// Good to a milliarcsecond for a century of the fastest star; radial motion is left out.
#[must_use]
pub fn place(star: &FieldStar, years: f64) -> Equatorial<J2000> {
    let entry = &star.astrometry;
    let moved = |mas_yr: f64| Angle::arcseconds(mas_yr / 1000.0 * years);
    let (east, north) = (moved(entry.pm_east_mas_yr), moved(entry.pm_north_mas_yr));
    let cos_dec = entry.position.dec().cos().max(1e-9);
    Equatorial::new(entry.position.ra() + east / cos_dec, entry.position.dec() + north)
}

/// Width (one sigma, pixels) of a star's point: 1.1 at magnitude 11, 2.9 at magnitude 0.
#[must_use]
pub fn sigma_px(v_mag: f32) -> f32 {
    (0.95 + 0.165 * (12.0 - v_mag)).clamp(0.95, 3.2)
}

/// Light in the middle of a star's point: half of full at magnitude 11, full at magnitude 4. The eye has the true star for
/// its true brightness; the point is there to be matched with it.
#[must_use]
pub fn peak(v_mag: f32) -> f32 {
    (0.40 + 0.075 * (12.0 - v_mag)).clamp(0.35, 1.0)
}

/// How stars are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Starlight {
    /// In which colours.
    pub palette: Palette,
    /// How bright beside [`peak`]: as much as photographs are beside their usual share.
    pub share: f32,
}

/// Adds a star's light around a point.
pub fn draw(picture: &mut Picture, region: &Region, x: f64, y: f64, star: &FieldStar, ink: Starlight) {
    point(picture, region, x, y, star.v_mag, star.colour_bv, ink);
}

/// Adds the light of a point of a magnitude and colour.
pub fn point(
    picture: &mut Picture,
    region: &Region,
    x: f64,
    y: f64,
    v_mag: f32,
    colour_bv: Option<f32>,
    ink: Starlight,
) {
    let sigma = sigma_px(v_mag);
    let reach = f64::from(sigma * 3.0).ceil();
    let light =
        (colour::in_palette(ink.palette, colour::of_star(colour_bv).into()) * (peak(v_mag) * ink.share)).to_array();
    let (top, bottom) = ((y - reach).max(0.0) as usize, ((y + reach).max(0.0) as usize).min(picture.height()));
    for j in top..bottom {
        let span = region.span(j);
        let (left, right) = ((x - reach).max(0.0) as usize, (x + reach).max(0.0) as usize);
        let (left, right) = (left.max(span.start), right.min(span.end));
        for i in left..right.max(left) {
            let (dx, dy) = (i as f64 + 0.5 - x, j as f64 + 0.5 - y);
            let share = (-(dx * dx + dy * dy) as f32 / (2.0 * sigma * sigma)).exp();
            let pixel = &mut picture.row_mut(j)[i];
            pixel.iter_mut().zip(light).for_each(|(sum, light)| *sum += light * share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::astrometry::Astrometry;
    use crate::sky::catalogue::StarId;

    fn star(v_mag: f32) -> FieldStar {
        let position = Equatorial::new(Angle::degrees(316.7249), Angle::degrees(38.7494));
        FieldStar {
            id: StarId::Faint(1),
            astrometry: Astrometry { pm_east_mas_yr: 4168.0, pm_north_mas_yr: 3269.0, ..Astrometry::fixed(position) },
            v_mag,
            colour_bv: None,
            separation: Angle::ZERO,
        }
    }

    #[test]
    fn a_star_is_drawn_with_its_middle_where_it_stands() {
        let region = Region::new(40, 40, vec![]);
        let mut picture = Picture::black(40, 40);
        draw(&mut picture, &region, 20.3, 17.8, &star(8.0), Starlight { palette: Palette::Natural, share: 1.0 });
        let (mut sum, mut x, mut y) = (0.0, 0.0, 0.0);
        for (index, pixel) in picture.pixels().iter().enumerate() {
            sum += pixel[0];
            x += pixel[0] * ((index % 40) as f32 + 0.5);
            y += pixel[0] * ((index / 40) as f32 + 0.5);
        }
        assert!((x / sum - 20.3).abs() < 0.05 && (y / sum - 17.8).abs() < 0.05, "{} {}", x / sum, y / sum);
    }

    #[test]
    fn brighter_stars_are_larger_and_brighter_and_the_edge_is_no_trap() {
        assert!(sigma_px(0.0) > sigma_px(5.0) && sigma_px(5.0) > sigma_px(11.0));
        assert!(peak(5.0) > peak(9.0) && peak(9.0) > peak(12.0));
        let mut picture = Picture::black(40, 40);
        for (x, y) in [(-3.0, -3.0), (39.9, 39.9), (-500.0, 20.0), (20.0, 1e6)] {
            draw(
                &mut picture,
                &Region::new(40, 40, vec![]),
                x,
                y,
                &star(0.0),
                Starlight { palette: Palette::Red, share: 1.0 },
            );
        }
        assert!(picture.pixels().iter().all(|pixel| pixel[1] == 0.0 && pixel[2] == 0.0));
    }

    #[test]
    fn sixty_one_cygni_moves_two_arcminutes_in_a_quarter_century() {
        // 5.3 arcseconds a year (Hipparcos): 26.9 years are 142 arcseconds.
        let moved = place(&star(5.2), 26.9).separation(&star(5.2).astrometry.position);
        assert!((moved.to_arcseconds() - 142.5).abs() < 1.0, "{}", moved.to_arcseconds());
    }
}
