//! The field of view: what part of the sky is in the eyepiece, which way up, and where it falls on the projector's canvas.

use glam::DVec3;

use super::astrometry::Reduction;
use super::coords::{Equatorial, J2000, OfDate};
use super::horizon::Horizon;
use super::optics::{Instrument, Mounting};
use super::pointing::Pointing;
use super::project::{Projection, tangent_basis};
use super::site::Site;
use super::time::Moment;
use crate::units::Angle;

/// What is in the eyepiece at one pointing and one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldOfView {
    /// From the sky (J2000) to the canvas.
    pub projection: Projection,
    /// Columns of the canvas.
    pub width_px: usize,
    /// Rows of the canvas.
    pub height_px: usize,
    /// Diameter of the sky in the eyepiece.
    pub true_field: Angle,
    /// One standard deviation of the position.
    pub uncertainty: Angle,
    /// Whether a picture may be drawn at all.
    pub may_draw: bool,
    /// Julian years since J2000.0: stars have moved by their proper motion.
    pub years: f64,
    /// Telescope, eyepiece in use and projector.
    pub instrument: Instrument,
}

impl FieldOfView {
    /// The field at a pointing. Without a site an alt-azimuth mounting's field rotation is unknown, so north is taken as up.
    #[must_use]
    pub fn new(pointing: &Pointing, instrument: &Instrument, moment: &Moment, site: Option<&Site>) -> FieldOfView {
        let reduction = Reduction::at(moment);
        let centre = reduction.j2000(&pointing.position);
        let upper_side = match (instrument.telescope.mounting, site) {
            (Mounting::AltAz, Some(site)) => Horizon::new(&reduction, site).parallactic_angle(&pointing.position),
            _ => Angle::ZERO,
        };
        // The angle is from the pole of date; the chart's north is that of J2000. A point a little way up tells both.
        let above = offset(&pointing.position, upper_side.sin() * 1e-3, upper_side.cos() * 1e-3);
        let upper_side = centre.position_angle(&reduction.j2000(&above));

        let (tt_day, tt_fraction) = moment.tt();
        FieldOfView {
            years: (tt_day - 2_451_545.0 + tt_fraction) / 365.25,
            uncertainty: pointing.uncertainty,
            may_draw: pointing.may_draw(),
            ..FieldOfView::towards(&centre, upper_side, instrument)
        }
    }

    /// The field about a J2000 position when the position angle on the sky of the tube's upper side is given: exact pointing, at
    /// the epoch J2000.
    #[must_use]
    pub fn towards(centre: &Equatorial<J2000>, upper_side: Angle, instrument: &Instrument) -> FieldOfView {
        let projector = &instrument.projector;
        let lies = instrument.registration();
        // In the plain view position angles grow counter-clockwise, in the mirrored one clockwise.
        let from_upper_side = if lies.mirrored { upper_side } else { -upper_side };
        let north = (lies.upper_side + from_upper_side).wrapped();
        FieldOfView {
            projection: Projection::new(centre, north, lies.mirrored, lies.scale, lies.middle),
            width_px: projector.width_px as usize,
            height_px: projector.height_px as usize,
            true_field: instrument.true_field(),
            uncertainty: Angle::ZERO,
            may_draw: true,
            years: 0.0,
            instrument: instrument.clone(),
        }
    }

    /// The position in the middle.
    #[must_use]
    pub fn centre(&self) -> Equatorial<J2000> {
        self.projection.centre()
    }

    /// Radius of the eyepiece's circle on the canvas, in pixels.
    #[must_use]
    pub fn circle_px(&self) -> f64 {
        self.projection.pixels(self.true_field) / 2.0
    }

    /// How far from the middle something can be and still be seen on the canvas: what a catalogue must be asked for.
    #[must_use]
    pub fn radius(&self) -> Angle {
        let (x, y) = self.projection.middle();
        let half_diagonal = x.max(self.width_px as f64 - x).hypot(y.max(self.height_px as f64 - y));
        Angle::radians((half_diagonal.min(self.circle_px()) * self.projection.scale().to_radians()).atan())
    }

    /// The nudge that moves the picture by pixels to the right and down.
    #[must_use]
    pub fn nudge(&self, right_px: f64, down_px: f64) -> Nudge {
        let (x, y) = self.projection.middle();
        let (x, y) = (x - right_px, y - down_px);
        let plane = tangent_basis(&self.centre()) * self.projection.position(x, y).direction();
        Nudge { east: Angle::radians(plane.x / plane.z), north: Angle::radians(plane.y / plane.z) }
    }
}

/// The observer's correction of the pointing: how far the true middle of the field is from where the mount says. It is
/// kept until the next sync.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Nudge {
    /// Eastwards on the sky.
    pub east: Angle,
    /// Northwards on the sky.
    pub north: Angle,
}

impl Nudge {
    /// Both corrections together.
    #[must_use]
    pub fn plus(&self, other: Nudge) -> Nudge {
        Nudge { east: self.east + other.east, north: self.north + other.north }
    }

    /// A position with the correction added.
    #[must_use]
    pub fn applied(&self, position: &Equatorial<OfDate>) -> Equatorial<OfDate> {
        offset(position, self.east.tan(), self.north.tan())
    }
}

/// A position moved in its tangent plane, by tangents of the angles east and north.
fn offset<F>(position: &Equatorial<F>, xi: f64, eta: f64) -> Equatorial<F> {
    let basis = tangent_basis(&Equatorial::new(position.ra(), position.dec()));
    Equatorial::from_direction(basis.transpose() * DVec3::new(xi, eta, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::optics::{Diagonal, Telescope};
    use crate::sky::pointing::Motion;
    use crate::sky::time::Utc;

    fn at(ra_deg: f64, dec_deg: f64) -> Equatorial<J2000> {
        Equatorial::new(Angle::degrees(ra_deg), Angle::degrees(dec_deg))
    }

    fn with(diagonal: Diagonal) -> Instrument {
        let mut instrument = Instrument::default();
        instrument.telescope = Telescope { diagonal, ..instrument.telescope };
        instrument
    }

    /// The side of the canvas where something in a position angle stands, with the tube's upper side at 0.
    fn side(diagonal: Diagonal, position_angle_deg: f64) -> &'static str {
        let field = FieldOfView::towards(&at(10.0, 41.0), Angle::ZERO, &with(diagonal));
        match field.projection.direction_of(Angle::degrees(position_angle_deg)) {
            (x, y) if y.abs() > x.abs() => {
                if y < 0.0 {
                    "top"
                } else {
                    "bottom"
                }
            }
            (x, _) => {
                if x < 0.0 {
                    "left"
                } else {
                    "right"
                }
            }
        }
    }

    #[test]
    fn each_train_shows_what_an_observer_knows_of_it() {
        // With the tube's upper side to the north: N, E.
        assert_eq!((side(Diagonal::None, 0.0), side(Diagonal::None, 90.0)), ("bottom", "right"));
        assert_eq!((side(Diagonal::Mirror, 0.0), side(Diagonal::Mirror, 90.0)), ("top", "right"));
        assert_eq!((side(Diagonal::Erecting, 0.0), side(Diagonal::Erecting, 90.0)), ("top", "left"));
    }

    #[test]
    fn turning_the_unit_turns_the_sky_back_on_its_canvas() {
        let mut instrument = with(Diagonal::Erecting);
        instrument.projector.angle_deg = 90.0;
        let field = FieldOfView::towards(&at(10.0, 41.0), Angle::ZERO, &instrument);
        // The canvas was turned counter-clockwise, so north went from its top clockwise to its right.
        assert_eq!(field.projection.north().to_degrees(), 270.0);
    }

    fn pointing(position: Equatorial<OfDate>) -> Pointing {
        Pointing { position, uncertainty: Angle::arcminutes(2.0), motion: Motion::Tracking, stale: false }
    }

    #[test]
    fn the_field_of_a_fork_turns_11_6_degrees_an_hour_in_the_southern_meridian_at_helsinki() {
        // Declination +20 at 60.17 north: 11.60 degrees an hour, from an independent computation.
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let instrument = with(Diagonal::Erecting);
        let north_at = |minutes: f64| {
            let start = Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap();
            let moment = |s| Moment { utc: start.plus_seconds(s), delta_t_s: 69.2 };
            let meridian = moment(0.0).sidereal_time(site.longitude);
            let position = Equatorial::new(meridian, Angle::degrees(20.0));
            FieldOfView::new(&pointing(position), &instrument, &moment(minutes * 60.0), Some(&site)).projection.north()
        };
        let rate = (north_at(5.0) - north_at(-5.0)).wrapped_signed().to_degrees() * 6.0;
        // q grows in the meridian, so north turns clockwise in the plain view.
        assert!((rate + 11.60).abs() < 0.05, "{rate}");
    }

    #[test]
    fn an_equatorial_field_stands_still_and_needs_no_site() {
        let mut instrument = with(Diagonal::Erecting);
        instrument.telescope.mounting = Mounting::Equatorial;
        let moment = Moment { utc: Utc::from_rfc3339("2000-01-01T12:00:00Z").unwrap(), delta_t_s: 64.0 };
        let position = Equatorial::new(Angle::degrees(100.0), Angle::degrees(20.0));
        let field = FieldOfView::new(&pointing(position), &instrument, &moment, None);
        assert!(field.projection.north().wrapped_signed().to_degrees().abs() < 0.01);
    }

    #[test]
    fn two_arcminutes_are_a_hundred_pixels() {
        let field = FieldOfView::towards(&at(10.0, 41.0), Angle::ZERO, &Instrument::default());
        assert_eq!(field.projection.pixels(Angle::arcminutes(2.0)).round(), 106.0);
        assert_eq!((field.width_px, field.height_px), (1024, 768));
    }

    #[test]
    fn a_nudge_to_the_right_moves_the_picture_to_the_right() {
        let moment = Moment { utc: Utc(1.8e9), delta_t_s: 70.0 };
        let site = Site::new(-24.6, -70.4, 2635.0).unwrap();
        for diagonal in [Diagonal::None, Diagonal::Mirror, Diagonal::Erecting] {
            let position = Equatorial::new(Angle::degrees(80.0), Angle::degrees(-5.4));
            let before = FieldOfView::new(&pointing(position), &with(diagonal), &moment, Some(&site));
            let star = before.projection.position(500.0, 400.0);
            let nudged = before.nudge(30.0, -20.0).applied(&position);
            let after = FieldOfView::new(&pointing(nudged), &with(diagonal), &moment, Some(&site));
            let (x, y) = after.projection.pixel(&star).unwrap();
            assert!((x - 530.0).abs() < 0.2 && (y - 380.0).abs() < 0.2, "{diagonal:?}: {x} {y}");
        }
    }

    #[test]
    fn while_it_slews_nothing_may_be_drawn() {
        let moment = Moment { utc: Utc(1.8e9), delta_t_s: 70.0 };
        let position = Equatorial::new(Angle::degrees(80.0), Angle::degrees(-5.4));
        let slewing = Pointing { motion: Motion::Slewing, ..pointing(position) };
        let stale = Pointing { stale: true, ..pointing(position) };
        for refused in [slewing, stale] {
            assert!(!FieldOfView::new(&refused, &Instrument::default(), &moment, None).may_draw);
        }
    }
}
