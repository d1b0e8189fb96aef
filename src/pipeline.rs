//! The page to read: one frame of data from the mount to the eyepiece.
//!
//! ```text
//! pointing (mount) -> field of view (optics, site, time) -> what is in it (catalogue, almanac) -> picture (overlay) -> projector
//! ```

use crate::overlay::menu::Menu;
use crate::overlay::{Composer, Eye, Photograph, Scene, Style, reach};
use crate::picture::Picture;
use crate::sky::catalogue::{Catalogue, Found, Object};
use crate::sky::field::FieldOfView;
use crate::sky::optics::Instrument;
use crate::sky::pointing::Pointing;
use crate::sky::site::Site;
use crate::sky::time::Moment;
use crate::units::Magnitude;

/// The faint end of the star catalogue: asking for less would leave out stars that a large telescope shows.
const CATALOGUE_LIMIT: f64 = 11.0;

/// What does not change from frame to frame while the observer looks.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Telescope, eyepiece in use, projector.
    pub instrument: &'a Instrument,
    /// Where on Earth; without it the field's rotation on an alt-azimuth mount is unknown and north is up.
    pub site: Option<&'a Site>,
    /// All that may be in the field.
    pub catalogue: &'a Catalogue,
    /// The observer's photographs.
    pub photographs: &'a [Photograph],
    /// What the observer looks at, if it was chosen.
    pub target: Option<&'a Object>,
    /// The eye, and the sky's brightness.
    pub eye: &'a Eye,
    /// How the overlay looks.
    pub style: &'a Style,
    /// A frame of an animation, drawn in place of the photographs.
    pub animation: Option<&'a Photograph>,
    /// The menu over it all.
    pub menu: Option<&'a Menu>,
}

/// One frame, and what it was made of.
#[derive(Debug, Clone)]
pub struct Frame {
    /// What part of the sky is in the eyepiece, and which way up.
    pub field: FieldOfView,
    /// What is in it, nearest to the middle first.
    pub found: Found,
    /// What the projector shows: exactly black when nothing may be drawn.
    pub picture: Picture,
}

/// What the projector shows for where the mount points now. The composer keeps what did not change since the last frame.
#[must_use]
pub fn frame(pointing: &Pointing, moment: &Moment, view: &View, composer: &mut Composer) -> Frame {
    let field = FieldOfView::new(pointing, view.instrument, moment, view.site);
    let reach = reach(&field, view.style, view.target);
    let mut found = view.catalogue.within(&field.centre(), reach, faintest(view));
    found.bodies = composer.almanac().within(moment, view.site, &field.centre(), reach);
    let scene = Scene {
        found: &found,
        target: view.target,
        photographs: view.photographs,
        catalogue: view.catalogue,
        animation: view.animation,
        menu: view.menu,
    };
    let picture = composer.compose(&scene, &field, view.eye, view.style);
    Frame { field, found, picture }
}

/// The faintest star that this eye can see through this telescope, but never brighter than the catalogue reaches.
fn faintest(view: &View) -> Magnitude {
    let limit = view.instrument.limiting_magnitude(view.eye.pupil_mm, view.eye.sky);
    Magnitude(limit.0.max(CATALOGUE_LIMIT))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eye::tone::Method;
    use crate::overlay::tone::{Lights, Toning};
    use crate::sky::coords::{Equatorial, Horizontal, OfDate};
    use crate::sky::ephemeris::{Body, Ephemeris};
    use crate::sky::horizon::Horizon;
    use crate::sky::pointing::Motion;
    use crate::sky::time::Utc;
    use crate::units::{Angle, SurfaceBrightness};

    fn frame_of(motion: Motion, stale: bool) -> Frame {
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap());
        let catalogue = Catalogue::embedded();
        let m57 = catalogue.search("M57").unwrap();
        let position: Equatorial<OfDate> = crate::sky::astrometry::apparent(&m57.astrometry, &moment);
        let pointing = Pointing { position, uncertainty: Angle::arcminutes(2.0), motion, stale };
        let (instrument, eye, style) = (Instrument::default(), Eye::default(), Style::default());
        let site = Site::new(49.26, 7.04, 250.0).unwrap();
        let view = View {
            instrument: &instrument,
            site: Some(&site),
            catalogue,
            photographs: &[],
            target: Some(&m57),
            eye: &eye,
            style: &style,
            animation: None,
            menu: None,
        };
        frame(&pointing, &moment, &view, &mut Composer::default())
    }

    #[test]
    fn pointing_at_m57_finds_m57_in_the_middle_and_lights_the_picture() {
        let frame = frame_of(Motion::Tracking, false);
        let nearest = frame.found.objects.first().unwrap();
        assert_eq!(nearest.name, "M57");
        let (x, y) = frame.field.projection.pixel(&nearest.position).unwrap();
        assert!((x - 512.0).hypot(y - 384.0) < 1.0, "M57 stands at {x}, {y}");
        assert!(!frame.picture.is_black());
    }

    /// A frame towards a place of date, and where on the canvas that place is.
    fn towards(
        position: &Equatorial<OfDate>,
        moment: &Moment,
        sky: f64,
        method: Method,
    ) -> (Frame, Lights, (f64, f64)) {
        let pointing = Pointing {
            position: *position,
            uncertainty: Angle::arcminutes(2.0),
            motion: Motion::Tracking,
            stale: false,
        };
        let instrument = Instrument::default();
        let eye = Eye { sky: SurfaceBrightness(sky), ..Eye::default() };
        let tone = Toning { method, picture_over_object_mag: Some(4.0), captions_over_object_mag: Some(9.0) };
        let style = Style { tone, ..Style::default() };
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let view = View {
            instrument: &instrument,
            site: Some(&site),
            catalogue: Catalogue::embedded(),
            photographs: &[],
            target: None,
            eye: &eye,
            style: &style,
            animation: None,
            menu: None,
        };
        let mut composer = Composer::default();
        let frame = frame(&pointing, moment, &view, &mut composer);
        let place = frame.field.projection.pixel(&crate::sky::astrometry::j2000(position, moment)).unwrap();
        (frame, *composer.lights().unwrap(), place)
    }

    #[test]
    fn poles_zero_hours_zenith_and_what_is_below_the_horizon_are_drawn_under_every_sky_with_every_operator() {
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap());
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let horizon = Horizon::at(&moment, &site);
        let up =
            |altitude_deg: f64| horizon.of_date(&Horizontal::new(Angle::degrees(180.0), Angle::degrees(altitude_deg)));
        let at = |ra: f64, dec: f64| Equatorial::new(Angle::degrees(ra), Angle::degrees(dec));
        let places =
            [at(0.0, 90.0), at(123.0, -89.999), at(0.0, 0.0), at(359.999_99, 10.0), up(90.0), up(89.999), up(-30.0)];
        for (index, position) in places.iter().enumerate() {
            for sky in [16.0, 22.2] {
                let (frame, lights, (x, y)) = towards(position, &moment, sky, Method::ALL[index % 4]);
                assert!((x - 512.0).hypot(y - 384.0) < 1.0, "place {index} stands at {x}, {y}");
                assert!(frame.picture.pixels().iter().flatten().all(|light| (0.0..=1.0).contains(light)), "{index}");
                assert!(lights.text <= lights.picture && lights.own_cd_m2.is_finite() && lights.own_cd_m2 > 0.0);
                assert!(lights.picture_cd_m2().is_finite() && lights.exponent.is_finite(), "{lights:?}");
            }
        }
    }

    #[test]
    fn the_moon_a_degree_above_the_horizon_is_a_disc_in_the_middle_and_years_far_away_have_stars_only() {
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let begin = Utc::from_rfc3339("2026-11-24T12:00:00Z").unwrap();
        let seen = |minutes: f64| {
            let moment = Moment::at(begin.plus_seconds(60.0 * minutes));
            let ephemeris = Ephemeris::at(&moment).unwrap();
            let moon = ephemeris.place(Body::Moon).topocentric(ephemeris.reduction(), &site).apparent;
            (moment, moon, Horizon::at(&moment, &site).airless(&moon).altitude().to_degrees())
        };
        let rising =
            (0..1440).map(|minute| seen(f64::from(minute))).find(|(_, _, altitude)| (altitude - 1.0).abs() < 0.1);
        let (moment, moon, _) = rising.expect("the Moon rises within a day");
        let (frame, lights, _) = towards(&moon, &moment, 21.0, Method::Tr93);
        let body = frame.found.bodies.iter().find(|seen| seen.body == Body::Moon).unwrap();
        let (x, y) = frame.field.projection.pixel(&body.position).unwrap();
        assert!((x - 512.0).hypot(y - 384.0) < 2.0 && frame.picture.row(384)[512][0] > 0.0, "{x} {y}");
        assert!(lights.picture > 0.0);

        for date in ["1400-06-01T00:00:00Z", "2600-06-01T00:00:00Z"] {
            let far = Moment::at(Utc::from_rfc3339(date).unwrap());
            let (frame, ..) = towards(&moon, &far, 21.0, Method::Tr99);
            assert!(frame.found.bodies.is_empty() && !frame.picture.is_black(), "{date}");
        }
    }

    #[test]
    fn nothing_is_drawn_while_the_mount_slews_or_its_position_is_stale() {
        assert!(frame_of(Motion::Slewing, false).picture.is_black());
        assert!(frame_of(Motion::Tracking, true).picture.is_black());
    }
}
