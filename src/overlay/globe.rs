//! Sun, Moon and planets as discs: phase, darkening towards the limb, flattening, Saturn's rings with the shadows, and a map
//! wrapped on where the observer has one.

use glam::{DVec3, Vec3A};

use super::canvas::Region;
use crate::picture::Picture;
use crate::sky::ephemeris::{Body, Globe, InView};
use crate::sky::project::Projection;
use crate::units::Angle;

/// Below this radius each pixel is the mean of nine points, above it only pixels at an edge are.
const SMALL_PX: f64 = 120.0;
/// Saturn's rings: inner and outer radius in Saturn's radii, and their light beside the globe's.
const RINGS: [(f64, f64, f32); 3] = [(1.239, 1.527, 0.12), (1.527, 1.951, 0.95), (2.027, 2.269, 0.65)];
/// The rings' light when the Sun is behind them.
const UNLIT: f32 = 0.12;

/// An equirectangular map of a body, north on top, longitude growing eastwards from -180 degrees at its left edge to +180.
/// The gas giants' longitudes are those of system III.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Whose map it is.
    pub body: Body,
    /// The map, then each time half as large.
    levels: Vec<Picture>,
}

impl Map {
    /// From a picture that is twice as wide as high (others are stretched).
    #[must_use]
    pub fn new(body: Body, picture: Picture) -> Map {
        let mut levels = vec![picture];
        while let Some(last) = levels.last().filter(|last| last.height() > 32) {
            levels.push(last.halved());
        }
        Map { body, levels }
    }

    /// The level whose pixels are about as large as those of a globe of a radius in pixels.
    fn level(&self, radius_px: f64) -> &Picture {
        // In the middle of the disc a pixel of the canvas spans 1 / radius radians, one of the map 2 pi / width.
        let wanted = std::f64::consts::TAU * radius_px.max(1.0);
        let fits = |level: &&Picture| level.width() as f64 <= 1.5 * wanted;
        self.levels.iter().find(fits).unwrap_or(&self.levels[self.levels.len() - 1])
    }
}

/// Adds a body's disc to the picture where it lies in the region; `colour` turns its light into the projector's.
pub fn draw(
    picture: &mut Picture,
    region: &Region,
    projection: &Projection,
    seen: &InView,
    maps: &[Map],
    colour: impl Fn(Vec3A) -> Vec3A,
) {
    let Some((x, y)) = projection.pixel(&seen.position) else { return };
    let radius_px = projection.pixels(seen.globe.radius);
    if radius_px.is_nan() || radius_px < 1e-3 {
        return;
    }
    let surface = Surface {
        globe: &seen.globe,
        body: seen.body,
        map: maps.iter().find(|map| map.body == seen.body).map(|map| map.level(radius_px)),
        stretch: 1.0 / (seen.globe.polar * seen.globe.polar) - 1.0,
    };
    // One radius east and north on the canvas.
    let (north, east) = (projection.direction_of(Angle::ZERO), projection.direction_of(Angle::degrees(90.0)));
    let at = |px: f64, py: f64| {
        let (dx, dy) = ((px - x) / radius_px, (py - y) / radius_px);
        (dx * east.0 + dy * east.1, dx * north.0 + dy * north.1)
    };
    let reach = radius_px * if seen.body == Body::Saturn { 2.28 } else { 1.0 } + 1.5;
    let (top, bottom) = ((y - reach).max(0.0) as usize, ((y + reach).max(0.0) as usize + 1).min(picture.height()));
    for j in top..bottom {
        let span = region.span(j);
        let (left, right) = ((x - reach).max(0.0) as usize, (x + reach).max(0.0) as usize + 1);
        let (left, right) = (left.max(span.start), right.min(span.end));
        for i in left..right.max(left) {
            let (px, py) = (i as f64 + 0.5, j as f64 + 0.5);
            let (e, n) = at(px, py);
            let edge = (e.hypot(n) - 1.0).abs() * radius_px < 2.0 + radius_px * (1.0 - seen.globe.polar);
            let light = if radius_px < SMALL_PX || edge {
                mean_of_nine(|dx, dy| {
                    let (e, n) = at(px + dx, py + dy);
                    surface.light(e, n)
                })
            } else {
                surface.light(e, n)
            };
            if light != [0.0; 3] {
                let sum = &mut picture.row_mut(j)[i];
                *sum = (Vec3A::from(*sum) + colour(light.into())).into();
            }
        }
    }
}

/// From this radius on a disc is kept from frame to frame; a smaller one is drawn anew as fast as it is copied.
const KEPT_PX: f64 = 20.0;
/// A change under this share of a pixel is not drawn anew.
const UNSEEN_PX: f64 = 0.05;

/// Discs drawn before, kept by all that they depend on.
#[derive(Debug, Clone, Default)]
pub struct Kept {
    discs: Vec<Disc>,
    /// How many were drawn, not copied.
    drawn: usize,
}

/// A disc drawn before.
#[derive(Debug, Clone)]
struct Disc {
    seen: InView,
    projection: Projection,
    region: Region,
    /// What of the light changes its colours: palette, share and exponent, as bits.
    light: [u32; 3],
    /// The first row with light, and the rows.
    top: usize,
    rows: Picture,
}

impl Kept {
    /// As [`draw`], but what did not change since it was drawn is copied. `light` stands for `colour`: a different one means
    /// different colours. The maps stay the same as long as this lives.
    #[expect(clippy::too_many_arguments, reason = "what is drawn, on what, and how: each is used once")]
    pub fn draw(
        &mut self,
        picture: &mut Picture,
        region: &Region,
        projection: &Projection,
        seen: &InView,
        maps: &[Map],
        light: [u32; 3],
        colour: impl Fn(Vec3A) -> Vec3A,
    ) {
        let radius_px = projection.pixels(seen.globe.radius);
        if radius_px.is_nan() || radius_px < KEPT_PX {
            draw(picture, region, projection, seen, maps, colour);
            return;
        }
        let place = self.discs.iter().position(|disc| disc.serves(seen, projection, region, light, picture, radius_px));
        let place = place.unwrap_or_else(|| {
            self.drawn += 1;
            let mut alone = Picture::black(picture.width(), picture.height());
            draw(&mut alone, region, projection, seen, maps, colour);
            let lit = |y: &usize| alone.row(*y).iter().any(|pixel| *pixel != [0.0; 3]);
            let top = (0..alone.height()).find(lit).unwrap_or(0);
            let bottom = (top..alone.height()).rfind(lit).map_or(top, |y| y + 1);
            let mut rows = Picture::black(alone.width(), bottom - top);
            (top..bottom).for_each(|y| rows.row_mut(y - top).copy_from_slice(alone.row(y)));
            self.discs.retain(|disc| disc.seen.body != seen.body);
            self.discs.push(Disc {
                seen: seen.clone(),
                projection: *projection,
                region: region.clone(),
                light,
                top,
                rows,
            });
            self.discs.len() - 1
        });
        let disc = &self.discs[place];
        for y in 0..disc.rows.height() {
            for (sum, light) in picture.row_mut(disc.top + y).iter_mut().zip(disc.rows.row(y)) {
                sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
            }
        }
    }

    /// How many discs were drawn rather than copied.
    #[must_use]
    pub fn drawn(&self) -> usize {
        self.drawn
    }
}

impl Disc {
    fn serves(
        &self,
        seen: &InView,
        projection: &Projection,
        region: &Region,
        light: [u32; 3],
        picture: &Picture,
        radius_px: f64,
    ) -> bool {
        let (was, is) = (&self.seen.globe, &seen.globe);
        let same_place = || {
            let (before, now) = (self.projection.pixel(&self.seen.position), projection.pixel(&seen.position));
            before.zip(now).is_some_and(|(a, b)| (a.0 - b.0).hypot(a.1 - b.1) < UNSEEN_PX)
        };
        let turned = |was: DVec3, is: DVec3| (was - is).length() * radius_px < UNSEEN_PX;
        let north = |projection: &Projection| {
            let (x, y) = projection.direction_of(Angle::ZERO);
            let (u, v) = projection.direction_of(Angle::degrees(90.0));
            [DVec3::new(x, y, 0.0), DVec3::new(u, v, 0.0)]
        };
        let stands = || north(&self.projection).into_iter().zip(north(projection)).all(|(was, is)| turned(was, is));
        self.seen.body == seen.body
            && self.light == light
            && self.region == *region
            && self.rows.width() == picture.width()
            && self.top + self.rows.height() <= picture.height()
            && (self.projection.pixels(was.radius) - radius_px).abs() < UNSEEN_PX
            && was.polar == is.polar
            && turned(was.sun, is.sun)
            && was.axes.iter().zip(is.axes).all(|(was, is)| turned(*was, is))
            && same_place()
            && stands()
    }
}

fn mean_of_nine(light: impl Fn(f64, f64) -> [f32; 3]) -> [f32; 3] {
    let mut sum = [0.0; 3];
    for dy in [-1.0, 0.0, 1.0] {
        for dx in [-1.0, 0.0, 1.0] {
            let here = light(dx / 3.0, dy / 3.0);
            sum.iter_mut().zip(here).for_each(|(sum, light)| *sum += light / 9.0);
        }
    }
    sum
}

/// What a ray through the disc meets.
struct Surface<'a> {
    globe: &'a Globe,
    body: Body,
    map: Option<&'a Picture>,
    /// (equatorial / polar)^2 - 1.
    stretch: f64,
}

impl Surface<'_> {
    /// The light at a place of the disc, east and north of its middle in equatorial radii.
    fn light(&self, east: f64, north: f64) -> [f32; 3] {
        let globe = self.meet(DVec3::new(east, north, 0.0), DVec3::Z);
        let ring = self.ring(east, north);
        match (globe, ring) {
            (Some(depth), Some((in_front, light))) if in_front > depth => light,
            (Some(depth), _) => self.ground(DVec3::new(east, north, depth)),
            (None, Some((_, light))) => light,
            (None, None) => [0.0; 3],
        }
    }

    /// How far along `line` from `start` the globe's far side in that direction is: the side that is seen along `line`.
    ///
    /// ```text
    /// |r|^2 + s (r.p)^2 = 1,   r = start + t line,   s = (a / b)^2 - 1,   p the pole
    /// ```
    fn meet(&self, start: DVec3, line: DVec3) -> Option<f64> {
        let pole = self.globe.axes[2];
        let (start_up, line_up) = (start.dot(pole), line.dot(pole));
        let a = 1.0 + self.stretch * line_up * line_up;
        let half_b = start.dot(line) + self.stretch * start_up * line_up;
        let c = start.length_squared() + self.stretch * start_up * start_up - 1.0;
        let root = half_b * half_b - a * c;
        (root >= 0.0).then(|| (root.sqrt() - half_b) / a)
    }

    /// The light of the ground (or the clouds) at a point of the globe.
    fn ground(&self, point: DVec3) -> [f32; 3] {
        let pole = self.globe.axes[2];
        let normal = (point + pole * (self.stretch * point.dot(pole))).normalize_or(DVec3::Z);
        let (to_sun, to_observer) = (normal.dot(self.globe.sun), normal.z.max(0.0));
        let mut light = law(self.body, to_sun, to_observer) as f32;
        if light > 0.0 && self.body == Body::Saturn && self.ring_towards_sun(point) {
            light *= 0.45;
        }
        let own = self.map.map_or(colour_of(self.body), |map| self.mapped(map, point));
        own.map(|channel| channel * light)
    }

    /// The map's colour at a point of the globe.
    fn mapped(&self, map: &Picture, point: DVec3) -> [f32; 3] {
        let [prime, east, pole] = self.globe.axes;
        let longitude = point.dot(east).atan2(point.dot(prime));
        let latitude = point.dot(pole).atan2(point.dot(prime).hypot(point.dot(east)));
        let u = (longitude / std::f64::consts::TAU + 0.5) * map.width() as f64;
        let v = (0.5 - latitude / std::f64::consts::PI) * map.height() as f64;
        map.sample(u as f32, v as f32)
    }

    /// The ring under a place of the disc: how far towards the observer, and its light.
    fn ring(&self, east: f64, north: f64) -> Option<(f64, [f32; 3])> {
        if self.body != Body::Saturn {
            return None;
        }
        let (pole, sun) = (self.globe.axes[2], self.globe.sun);
        if pole.z.abs() < 1e-6 {
            return None;
        }
        let depth = -(east * pole.x + north * pole.y) / pole.z;
        let point = DVec3::new(east, north, depth);
        let mut light = ring_light(point.length())?;
        if pole.z * pole.dot(sun) < 0.0 {
            light *= UNLIT;
        } else if self.meet(point, sun).is_some_and(|along| along > 0.0) {
            // The globe stands between the ring and the Sun.
            return Some((depth, [0.0; 3]));
        }
        Some((depth, [1.0, 0.88, 0.70].map(|channel: f32| channel * light)))
    }

    /// Whether a bright ring stands between a point of the globe and the Sun.
    fn ring_towards_sun(&self, point: DVec3) -> bool {
        let (pole, sun) = (self.globe.axes[2], self.globe.sun);
        let along = -point.dot(pole) / sun.dot(pole);
        along > 0.0 && ring_light((point + sun * along).length()).is_some_and(|light| light > 0.3)
    }
}

fn ring_light(radius: f64) -> Option<f32> {
    RINGS.iter().find(|(inner, outer, _)| (*inner..*outer).contains(&radius)).map(|ring| ring.2)
}

/// How light falls off over a disc, 1 where Sun and observer stand overhead; 0 at night.
///
/// ```text
/// Minnaert          mu0^k mu^(k-1)            k 0.95 for deep clouds, 0.7 for Mars
/// Lommel-Seeliger   2 mu0 / (mu0 + mu)        Moon, Mercury
/// Sun               0.30 + 0.93 mu - 0.23 mu^2   at 550 nm (Allen)
/// ```
fn law(body: Body, to_sun: f64, to_observer: f64) -> f64 {
    if body == Body::Sun {
        return 0.30 + 0.93 * to_observer - 0.23 * to_observer * to_observer;
    }
    if to_sun <= 0.0 {
        return 0.0;
    }
    let minnaert = |k: f64| to_sun.powf(k) * to_observer.max(0.02).powf(k - 1.0);
    match body {
        Body::Moon | Body::Mercury => 2.0 * to_sun / (to_sun + to_observer).max(1e-9),
        Body::Mars => minnaert(0.7),
        _ => minnaert(0.95),
    }
    .min(1.3)
}

/// A body's colour, linear, as its clouds or its ground have it on average.
fn colour_of(body: Body) -> [f32; 3] {
    match body {
        Body::Sun => [1.0, 0.93, 0.82],
        Body::Moon => [0.85, 0.80, 0.74],
        Body::Mercury => [0.80, 0.75, 0.70],
        Body::Venus => [1.0, 0.95, 0.82],
        Body::Mars => [1.0, 0.55, 0.30],
        Body::Jupiter => [1.0, 0.87, 0.70],
        Body::Saturn => [1.0, 0.84, 0.58],
        Body::Uranus => [0.70, 0.95, 1.0],
        Body::Neptune => [0.50, 0.68, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::ephemeris::Ephemeris;
    use crate::sky::time::{Moment, Utc};

    fn seen(body: Body, at: &str) -> InView {
        let ephemeris = Ephemeris::at(&Moment::at(Utc::from_rfc3339(at).unwrap())).unwrap();
        InView::of(&ephemeris, body, None)
    }

    /// The body in the middle of a canvas, north up and east to the left, its radius in pixels.
    fn drawn(seen: &InView, radius_px: f64, maps: &[Map]) -> Picture {
        let scale = seen.globe.radius / radius_px;
        let projection = Projection::new(&seen.position, Angle::ZERO, false, scale, (256.0, 256.0));
        let mut picture = Picture::black(512, 512);
        draw(&mut picture, &Region::new(512, 512, vec![]), &projection, seen, maps, |light| light);
        picture
    }

    fn lit(picture: &Picture) -> f64 {
        picture.pixels().iter().filter(|pixel| pixel[0] > 0.02).count() as f64
    }

    /// 2026 November 14: the Moon is lit to 25 % on its western side (Swiss Ephemeris and Meeus' chapter 48).
    #[test]
    fn the_moons_crescent_has_the_area_of_its_phase_on_the_side_of_the_sun() {
        let picture = drawn(&seen(Body::Moon, "2026-11-14T18:00:00Z"), 200.0, &[]);
        let share = lit(&picture) / (std::f64::consts::PI * 200.0 * 200.0);
        assert!((share - 0.2516).abs() < 0.01, "{share}");
        // West is to the right.
        assert!(picture.row(256)[450][0] > 0.3 && picture.row(256)[100][0] == 0.0);
    }

    #[test]
    fn jupiter_is_flattened_along_its_axis_by_a_fifteenth() {
        let jupiter = seen(Body::Jupiter, "2026-02-10T00:00:00Z");
        let picture = drawn(&jupiter, 200.0, &[]);
        let share = lit(&picture) / (std::f64::consts::PI * 200.0 * 200.0);
        assert!((share - 66_854.0 / 71_492.0).abs() < 0.01, "{share}");
    }

    #[test]
    fn saturns_rings_reach_twice_its_globe_and_show_cassinis_gap() {
        let saturn = seen(Body::Saturn, "2032-05-01T00:00:00Z");
        let pole = saturn.globe.axes[2];
        let picture = drawn(&saturn, 80.0, &[]);
        // Along the ring's major axis, across the pole's direction on the sky.
        let across = DVec3::new(-pole.y, pole.x, 0.0).normalize();
        let at = |radii: f64| {
            let (x, y) = (256.0 - across.x * 80.0 * radii, 256.0 - across.y * 80.0 * radii);
            picture.row(y as usize)[x as usize][0]
        };
        assert!(at(1.75) > 0.6 && at(2.15) > 0.4, "{} {}", at(1.75), at(2.15));
        assert!(at(1.99) < 0.5 * at(2.15) && at(2.4) == 0.0, "{} {}", at(1.99), at(2.4));
    }

    #[test]
    fn a_map_stands_with_its_central_meridian_in_the_middle() {
        let mars = seen(Body::Mars, "2027-02-19T00:00:00Z");
        // A bright meridian of 10 degrees at the middle of the disc, and dark elsewhere.
        let [prime, east, _] = mars.globe.axes;
        let longitude = f64::atan2(east.z, prime.z).to_degrees();
        let mut map = Picture::black(720, 360);
        for y in 0..360 {
            for x in 0..720 {
                let here = x as f64 / 2.0 - 180.0;
                if ((here - longitude + 540.0).rem_euclid(360.0) - 180.0).abs() < 5.0 {
                    map.row_mut(y)[x] = [1.0; 3];
                }
            }
        }
        let picture = drawn(&mars, 150.0, &[Map::new(Body::Mars, map)]);
        assert!(picture.row(256)[256][0] > 0.5 && picture.row(256)[300][0] < 0.1);
    }

    #[test]
    fn a_disc_that_did_not_change_is_copied_bit_for_bit_and_one_that_did_is_drawn_anew() {
        let saturn = seen(Body::Saturn, "2032-05-01T00:00:00Z");
        let projection = |x: f64, angle_deg: f64| {
            Projection::new(&saturn.position, Angle::degrees(angle_deg), false, saturn.globe.radius / 60.0, (x, 256.0))
        };
        let region = Region::new(512, 512, vec![]);
        let mut kept = Kept::default();
        let mut frame = |x: f64, angle_deg: f64, seen: &InView, light: [u32; 3]| {
            let mut picture = Picture::black(512, 512);
            kept.draw(&mut picture, &region, &projection(x, angle_deg), seen, &[], light, |light| light);
            let mut plain = Picture::black(512, 512);
            draw(&mut plain, &region, &projection(x, angle_deg), seen, &[], |light| light);
            assert_eq!(picture.pixels(), plain.pixels());
            kept.drawn()
        };
        let later = seen(Body::Saturn, "2032-05-01T00:20:00Z");
        let counts = [
            frame(256.0, 0.0, &saturn, [1; 3]),
            frame(256.0, 0.0, &saturn, [1; 3]),
            frame(257.0, 0.0, &saturn, [1; 3]),
            frame(257.0, 1.0, &saturn, [1; 3]),
            frame(257.0, 1.0, &saturn, [2; 3]),
            frame(257.0, 1.0, &later, [2; 3]),
        ];
        assert_eq!(counts, [1, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_globe_behind_the_observer_or_off_the_canvas_draws_nothing() {
        let mars = seen(Body::Mars, "2027-02-19T00:00:00Z");
        for middle in [(-5000.0, 100.0), (1e7, 1e7)] {
            let projection = Projection::new(&mars.position, Angle::ZERO, true, mars.globe.radius / 50.0, middle);
            let mut picture = Picture::black(64, 64);
            draw(&mut picture, &Region::new(64, 64, vec![]), &projection, &mars, &[], |light| light);
            assert!(picture.is_black());
        }
    }
}
