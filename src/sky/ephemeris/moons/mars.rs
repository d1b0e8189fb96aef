//! Phobos and Deimos: Sinclair (1989, A&A 220, 321), precessing ellipses on their Laplace planes, Phobos falling inwards.

use glam::{DMat3, DVec3};

/// Elements at 1971 November 11.0 (JD 2441266.5) on the Laplace plane, itself on the equator of B1950; degrees, days, years.
struct Elements {
    axis_km: f64,
    eccentricity: f64,
    inclination: f64,
    longitude: [f64; 2],
    /// Degrees a Julian year squared.
    acceleration: f64,
    pericentre: [f64; 2],
    node: [f64; 2],
    plane_node: [f64; 2],
    plane_inclination: [f64; 2],
}

const PHOBOS: Elements = Elements {
    axis_km: 9379.40,
    eccentricity: 0.014_979,
    inclination: 1.1029,
    longitude: [232.412, 1_128.844_556_6],
    acceleration: 0.001_237,
    pericentre: [278.96, 0.435_258],
    node: [327.90, -0.435_330],
    plane_node: [47.386, -0.001_40],
    plane_inclination: [37.271, 0.000_80],
};

const DEIMOS: Elements = Elements {
    axis_km: 23_461.13,
    eccentricity: 0.000_391,
    inclination: 1.7901,
    longitude: [28.963, 285.161_887_5],
    acceleration: 0.0,
    pericentre: [111.7, 0.017_985],
    node: [240.38, -0.018_008],
    plane_node: [46.367, -0.001_38],
    plane_inclination: [36.623, 0.000_79],
};

/// From the centre of Mars to Phobos and Deimos in kilometres, catalogue axes; `jde` is a Julian date of TT.
#[must_use]
pub fn centres(jde: f64) -> [DVec3; 2] {
    let node = DEIMOS.node[0] + DEIMOS.node[1] * (jde - 2_441_266.5);
    let libration = -0.274 * (node - 43.83).to_radians().sin();
    [PHOBOS.at(jde, 0.0), DEIMOS.at(jde, libration)]
}

impl Elements {
    fn at(&self, jde: f64, added_longitude: f64) -> DVec3 {
        let days = jde - 2_441_266.5;
        let years = days / 365.25;
        let linear = |[start, rate]: [f64; 2], t: f64| (start + rate * t).to_radians();
        let squared = self.acceleration * years * years;
        let longitude = linear(self.longitude, days) + (squared + added_longitude).to_radians();
        let (pericentre, node) = (linear(self.pericentre, days), linear(self.node, days));
        let (plane_node, plane) = (linear(self.plane_node, years), linear(self.plane_inclination, years));
        let on_orbit = super::on_ellipse(self.axis_km, self.eccentricity, longitude - pericentre);
        let to_equator = DMat3::from_rotation_z(plane_node)
            * DMat3::from_rotation_x(plane)
            * DMat3::from_rotation_z(node)
            * DMat3::from_rotation_x(self.inclination.to_radians())
            * DMat3::from_rotation_z(pericentre - node - plane_node);
        super::b1950_to_catalogue() * (to_equator * on_orbit)
    }
}
