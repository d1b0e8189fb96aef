//! Which way a body's axis points and how far it has turned: IAU working group on cartographic coordinates and rotational
//! elements, report of 2009 (Archinal et al. 2011) with the newer numbers of 2015 (Archinal et al. 2018) for Mercury, Neptune.
//!
//! Left out are the terms under 0.005 degree of Mercury's and Jupiter's axes.

use glam::DVec3;

use crate::sky::ephemeris::Body;
use crate::units::Angle;

/// The orientation of a body at a moment: axis, ascending node of its equator on the equator of the catalogue, and the angle W
/// from that node to its prime meridian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    /// Unit vector to the north pole, catalogue axes. North is the IAU's: on the north side of the ecliptic's invariable plane.
    pub pole: DVec3,
    node: DVec3,
    /// The prime meridian, growing eastwards along the equator from its node.
    pub prime_meridian: Angle,
}

/// A way of counting longitudes on a body: its name, W at J2000 in degrees, and its growth in degrees a day.
struct System(&'static str, f64, f64);

/// Longitudes of the gas giants beside the one in [`Rotation`]: Jupiter's equatorial belt (I) and the rest of its clouds (II),
/// Saturn's equator (I).
fn systems(body: Body) -> &'static [System] {
    match body {
        Body::Jupiter => &[System("I", 67.1, 877.9), System("II", 43.3, 870.27), System("III", 284.95, 870.536)],
        Body::Saturn => &[System("I", 227.2037, 844.3), System("III", 38.9, 810.793_902_4)],
        _ => &[],
    }
}

impl Rotation {
    /// The orientation at a Julian date of TDB (TT will do), that is when the light left the body.
    #[must_use]
    pub fn of(body: Body, jde: f64) -> Rotation {
        let d = jde - 2_451_545.0;
        let t = d / 36_525.0;
        let (ra, dec, w) = match body {
            Body::Sun => (286.13, 63.87, 84.176 + 14.1844 * d),
            Body::Moon => moon(d, t),
            Body::Mercury => (281.0103 - 0.0328 * t, 61.4155 - 0.0049 * t, mercury_meridian(d)),
            Body::Venus => (272.76, 67.16, 160.20 - 1.481_368_8 * d),
            Body::Mars => (317.681_43 - 0.1061 * t, 52.8865 - 0.0609 * t, 176.63 + 350.891_982_26 * d),
            Body::Jupiter => (268.056_595 - 0.006_499 * t, 64.495_303 + 0.002_413 * t, 284.95 + 870.536 * d),
            Body::Saturn => (40.589 - 0.036 * t, 83.537 - 0.004 * t, 38.9 + 810.793_902_4 * d),
            Body::Uranus => (257.311, -15.175, 203.81 - 501.160_092_8 * d),
            Body::Neptune => {
                let n = Angle::degrees(357.85 + 52.316 * t);
                let w = 249.978 + 541.139_775_7 * d - 0.48 * n.sin();
                (299.36 + 0.70 * n.sin(), 43.46 - 0.51 * n.cos(), w)
            }
        };
        let (sin_ra, cos_ra) = Angle::degrees(ra).sin_cos();
        let (sin_dec, cos_dec) = Angle::degrees(dec).sin_cos();
        Rotation {
            pole: DVec3::new(cos_dec * cos_ra, cos_dec * sin_ra, sin_dec),
            node: DVec3::new(-sin_ra, cos_ra, 0.0),
            prime_meridian: Angle::degrees(w).wrapped(),
        }
    }

    /// The point of the body under a direction from its centre: planetocentric longitude (growing eastwards, 0 to 360 degrees)
    /// and latitude.
    #[must_use]
    pub fn under(&self, direction: DVec3) -> (Angle, Angle) {
        let along = self.along_equator(direction);
        let latitude = Angle::asin(direction.normalize_or_zero().dot(self.pole));
        ((along - self.prime_meridian).wrapped(), latitude)
    }

    /// Unit vectors of the body's own axes: prime meridian, 90 degrees east, north pole.
    #[must_use]
    pub fn axes(&self) -> [DVec3; 3] {
        let (sin, cos) = self.prime_meridian.sin_cos();
        let ahead = self.pole.cross(self.node);
        [self.node * cos + ahead * sin, ahead * cos - self.node * sin, self.pole]
    }

    fn along_equator(&self, direction: DVec3) -> Angle {
        Angle::atan2(direction.dot(self.pole.cross(self.node)), direction.dot(self.node))
    }

    /// The longitudes, by system, of the meridian under a direction from the centre, as observers count them: against the
    /// rotation, so that they grow with time (planetographic); on the Sun and the Moon with it (Carrington, selenographic).
    #[must_use]
    pub fn central_meridians(&self, body: Body, jde: f64, direction: DVec3) -> Vec<(&'static str, Angle)> {
        let along = self.along_equator(direction);
        let counted = |w: Angle| match body {
            Body::Sun | Body::Moon | Body::Venus | Body::Uranus => (along - w).wrapped(),
            _ => (w - along).wrapped(),
        };
        let found: Vec<_> = systems(body)
            .iter()
            .map(|System(name, start, rate)| (*name, counted(Angle::degrees(start + rate * (jde - 2_451_545.0)))))
            .collect();
        if !found.is_empty() {
            return found;
        }
        let name = match body {
            Body::Sun => "Carrington",
            Body::Uranus | Body::Neptune => "III",
            _ => "surface",
        };
        vec![(name, counted(self.prime_meridian))]
    }
}

/// Mercury's libration in longitude has an amplitude of 0.01 degree.
fn mercury_meridian(d: f64) -> f64 {
    329.5988 + 6.138_510_8 * d + 0.010_67 * Angle::degrees(174.791 + 4.092_335 * d).sin()
        - 0.001_12 * Angle::degrees(349.582 + 8.184_67 * d).sin()
}

/// The Moon's mean Earth and polar axes, with its physical libration.
fn moon(d: f64, t: f64) -> (f64, f64, f64) {
    let e = [
        125.045 - 0.052_992_1 * d,
        250.089 - 0.105_984_2 * d,
        260.008 + 13.012_000_9 * d,
        176.625 + 13.340_715_4 * d,
        357.529 + 0.985_600_3 * d,
        311.589 + 26.405_708_4 * d,
        134.963 + 13.064_993 * d,
        276.617 + 0.328_714_6 * d,
        34.226 + 1.748_487_7 * d,
        15.134 - 0.158_976_3 * d,
        119.743 + 0.003_609_6 * d,
        239.961 + 0.164_357_3 * d,
        25.053 + 12.959_008_8 * d,
    ]
    .map(Angle::degrees);
    let sines = |terms: &[(usize, f64)]| terms.iter().map(|(n, a)| a * e[n - 1].sin()).sum::<f64>();
    let cosines = |terms: &[(usize, f64)]| terms.iter().map(|(n, a)| a * e[n - 1].cos()).sum::<f64>();
    let ra = [(1, -3.8787), (2, -0.1204), (3, 0.0700), (4, -0.0172), (6, 0.0072), (10, -0.0052), (13, 0.0043)];
    let dec =
        [(1, 1.5419), (2, 0.0239), (3, -0.0278), (4, 0.0068), (6, -0.0029), (7, 0.0009), (10, 0.0008), (13, -0.0009)];
    let w = [
        (1, 3.5610),
        (2, 0.1208),
        (3, -0.0642),
        (4, 0.0158),
        (5, 0.0252),
        (6, -0.0066),
        (7, -0.0047),
        (8, -0.0046),
        (9, 0.0028),
        (10, 0.0052),
        (11, 0.0040),
        (12, 0.0019),
        (13, -0.0044),
    ];
    (
        269.9949 + 0.0031 * t + sines(&ra),
        66.5392 + 0.0130 * t + cosines(&dec),
        38.3213 + 13.176_358_15 * d - 1.4e-12 * d * d + sines(&w),
    )
}
