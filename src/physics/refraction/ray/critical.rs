//! The directions in which the path of a ray changes its kind: where it just touches a border of the air, the ground, or the
//! edge of a duct. Between them refraction is a smooth function of altitude.

use super::Medium;
use crate::units::Angle;

impl Medium<'_> {
    /// The altitudes at which a ray from a height just touches a border between layers, ascending. Below the first of them
    /// rays end on the ground, unless an edge of a duct lies there.
    ///
    /// ```text
    /// 2 sin²(a/2) = 1 - n r/(n0 r0) at the border
    /// ```
    ///
    /// Only borders that a ray can reach level count: going away from the eye, n r must be less there than anywhere before.
    /// Borders above the eye do so under an inversion that bends rays more than the globe is bent; then they count twice,
    /// for rays that begin upwards and for those that come up after turning.
    #[must_use]
    pub fn critical_altitudes(&self, height_m: f64) -> Vec<Angle> {
        let start = self.piece_at(height_m);
        let pieces = self.pieces();
        let Some(eye) = pieces.get(start) else { return Vec::new() };
        let n0 = self.at(eye.layer, height_m).refractivity;
        let r0 = self.earth_radius_m + height_m;
        // How far n r lies below its value at the eye, as a share of it.
        let lack = |z: f64, refractivity: f64| {
            -((1.0 + refractivity) * (z - height_m) + (refractivity - n0) * r0) / ((1.0 + n0) * r0)
        };
        let altitude = |lack: f64| Angle::radians(2.0 * (0.5 * lack).sqrt().min(1.0).asin());
        let mut altitudes = Vec::new();
        let mut most = -f64::EPSILON;
        for piece in pieces[..=start].iter().rev() {
            let lack = lack(piece.low_m, piece.low_refractivity);
            if lack > most {
                altitudes.push(-altitude(lack.max(0.0)));
                most = lack;
            }
        }
        let mut most = 0.0;
        for piece in &pieces[start..] {
            let lack = lack(piece.high_m, piece.high_refractivity);
            if lack > most {
                altitudes.extend([altitude(lack), -altitude(lack)]);
                most = lack;
            }
        }
        altitudes.sort_by(|a, b| a.to_radians().total_cmp(&b.to_radians()));
        altitudes.dedup();
        altitudes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::air::presets;
    use crate::physics::air::profile::{Profile, Row};
    use crate::physics::refraction::ray::{Launch, Method, Outcome, exact::Exact};

    fn outcome(medium: &Medium<'_>, height_m: f64, arcmin: f64) -> Outcome {
        let tracer = Exact.prepare(medium, Angle::arcseconds(0.01)).unwrap();
        tracer.trace(&Launch { apparent_altitude: Angle::arcminutes(arcmin), height_m }).unwrap().outcome
    }

    /// The horizons that another program found: `fixtures/reference/mirage_transfer.csv` ends at -7.25' and -12.14'.
    #[test]
    fn the_lowest_is_the_horizon() {
        for (name, height_m, horizon) in [("omega", 9.28, -7.2527), ("mock-mirage", 54.0, -12.1381)] {
            let air = presets::named(name).unwrap().unwrap();
            let medium = Medium::new(&air.profile, 550.0, 6_371_000.0, 1e5).unwrap();
            let lowest = medium.critical_altitudes(height_m)[0].to_arcminutes();
            assert!((lowest - horizon).abs() < 1e-4, "{name}: {lowest}");
            assert_eq!(outcome(&medium, height_m, lowest + 1e-6), Outcome::Escaped);
            assert_eq!(outcome(&medium, height_m, lowest - 1e-6), Outcome::Ground);
        }
    }

    #[test]
    fn around_a_duct_rays_begin_and_cease_to_escape_only_there() {
        let row = |height_m, temperature_k| Row { height_m, temperature_k, humidity_percent: 0.0 };
        let rows = [row(0.0, 283.0), row(60.0, 283.0), row(70.0, 293.0), row(11e3, 222.0)];
        let duct = Profile::new(&rows, 101_325.0).unwrap();
        let medium = Medium::new(&duct, 550.0, 6_371_000.0, 1e5).unwrap();
        for height_m in [65.0, 72.0, 100.0] {
            let critical = medium.critical_altitudes(height_m);
            let escapes = |arcmin: f64| outcome(&medium, height_m, arcmin) == Outcome::Escaped;
            let mut changes = 0;
            for i in -299..300 {
                let (before, here) = (f64::from(i - 1) / 10.0, f64::from(i) / 10.0);
                if escapes(before) != escapes(here) {
                    changes += 1;
                    let between = |a: &Angle| (before..=here).contains(&a.to_arcminutes());
                    assert!(critical.iter().any(between), "{height_m} m, {here}': {critical:?}");
                }
            }
            assert!(changes >= 1, "{height_m}");
        }
    }
}
