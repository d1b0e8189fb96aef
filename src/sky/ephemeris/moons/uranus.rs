//! Five moons of Uranus: GUST86 (Laskar and Jacobson 1987, A&A 188, 212), every term.

use glam::{DMat3, DVec3};

use super::super::place::AU_KM;
use super::super::planets;

/// From the plane of GUST86 (Uranus' equator) to the ecliptic and equinox J2000 of VSOP87: rows. It follows from the theory's
/// pole (76.6067, 15.0322 degrees, B1950) and the frames' relation.
const TO_ECLIPTIC: [[f64; 3]; 3] = [
    [0.975_320_663_208_681_2, 0.061_944_256_680_014_73, 0.211_925_725_155_155_97],
    [-0.200_644_461_098_178_35, -0.151_932_851_664_084_94, 0.967_811_039_829_491_1],
    [0.092_148_815_232_751_9, -0.986_447_828_143_779_5, -0.135_754_477_648_512_7],
];

/// Uranus and the moon, au^3 a day^2: Miranda to Oberon.
const MU: [f64; 5] = [
    1.291_892_353_675_174e-8,
    1.291_910_570_526_396e-8,
    1.291_910_102_284_198e-8,
    1.291_942_656_265_575e-8,
    1.291_935_967_091_32e-8,
];

/// Proper frequencies and phases of longitudes (a day), of pericentres and of nodes (degrees a year).
const LONGITUDE: [(f64, f64); 5] = [
    (4.445_190_55, -0.238_051),
    (2.492_952_519, 3.098_046),
    (1.516_148_111, 2.285_402),
    (0.721_718_509, 0.856_359),
    (0.466_692_12, -0.915_592),
];
const PERICENTRE: [(f64, f64); 5] =
    [(20.082, 0.611_392), (6.217, 2.408_974), (2.865, 2.067_774), (2.078, 0.735_131), (0.386, 0.426_767)];
const NODE: [(f64, f64); 5] =
    [(-20.309, 5.702_313), (-6.288, 0.395_757), (-2.836, 0.589_326), (-1.843, 1.746_237), (-0.259, 4.206_896)];

/// Terms of amplitude and argument.
type Terms<'a> = &'a [(f64, f64)];

/// From the centre of Uranus to Miranda, Ariel, Umbriel, Titania and Oberon in kilometres, catalogue axes; `jde` is a Julian
/// date of TT.
#[must_use]
pub fn centres(jde: f64) -> [DVec3; 5] {
    let t = jde - 2_444_239.5;
    let slow = |(degrees_a_year, phase): (f64, f64)| (degrees_a_year / 365.25).to_radians() * t + phase;
    let n = LONGITUDE.map(|(rate, phase)| rate * t + phase);
    let e = PERICENTRE.map(slow);
    let i = NODE.map(slow);
    let to_ecliptic = DMat3::from_cols_array_2d(&TO_ECLIPTIC).transpose();
    let elements = [
        miranda(t, &n, &e, &i),
        ariel(t, &n, &e, &i),
        umbriel(t, &n, &e, &i),
        titania(t, &n, &e, &i),
        oberon(t, &n, &e, &i),
    ];
    let mut moon = 0;
    elements.map(|elements| {
        let on_equator = elements.place(MU[moon]);
        moon += 1;
        planets::from_ecliptic(to_ecliptic * on_equator) * AU_KM
    })
}

/// Osculating elements: mean motion (radians a day), mean longitude, e exp(i pericentre), sin(i/2) exp(i node).
struct Elements {
    motion: f64,
    longitude: f64,
    eccentricity: (f64, f64),
    inclination: (f64, f64),
}

impl Elements {
    /// The place in astronomical units on the plane of the theory.
    fn place(&self, mu: f64) -> DVec3 {
        let axis = (mu / (self.motion * self.motion)).cbrt();
        let (k, h) = self.eccentricity;
        let (q, p) = self.inclination;
        let pericentre = h.atan2(k);
        let node = p.atan2(q);
        let inclination = 2.0 * q.hypot(p).min(1.0).asin();
        let on_orbit = super::on_ellipse(axis, h.hypot(k), self.longitude - pericentre);
        DMat3::from_rotation_z(node)
            * DMat3::from_rotation_x(inclination)
            * DMat3::from_rotation_z(pericentre - node)
            * on_orbit
    }
}

fn cosines(terms: Terms<'_>) -> f64 {
    terms.iter().map(|(a, argument)| a * argument.cos()).sum()
}

fn sines(terms: Terms<'_>) -> f64 {
    terms.iter().map(|(a, argument)| a * argument.sin()).sum()
}

fn vector(terms: Terms<'_>) -> (f64, f64) {
    (cosines(terms), sines(terms))
}

/// The sum of amplitudes times the five slow angles.
fn slow(amplitudes: [f64; 5], angles: &[f64; 5]) -> (f64, f64) {
    let terms: [(f64, f64); 5] = std::array::from_fn(|k| (amplitudes[k], angles[k]));
    vector(&terms)
}

fn both(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 + b.0, a.1 + b.1)
}

fn miranda(t: f64, n: &[f64; 5], e: &[f64; 5], i: &[f64; 5]) -> Elements {
    let resonance = n[0] - 3.0 * n[1] + 2.0 * n[2];
    let synodic = n[0] - n[1];
    Elements {
        motion: 4.443_522_67
            + cosines(&[
                (-3.492e-5, resonance),
                (8.47e-6, 2.0 * resonance),
                (1.31e-6, 3.0 * resonance),
                (-5.228e-5, synodic),
                (-1.3665e-4, 2.0 * synodic),
            ]),
        longitude: sines(&[
            (0.025_472_17, resonance),
            (-0.003_088_31, 2.0 * resonance),
            (-3.181e-4, 3.0 * resonance),
            (-3.749e-5, 4.0 * resonance),
            (-5.785e-5, synodic),
            (-6.232e-5, 2.0 * synodic),
            (-2.795e-5, 3.0 * synodic),
        ]) + t * 4.445_190_55
            - 0.238_051_58,
        eccentricity: both(
            slow([0.001_312_38, 7.181e-5, 6.977e-5, 6.75e-6, 6.27e-6], e),
            vector(&[(1.941e-4, n[0]), (-1.2331e-4, -n[0] + 2.0 * n[1]), (3.952e-5, -2.0 * n[0] + 3.0 * n[1])]),
        ),
        inclination: slow([0.037_871_71, 2.701e-5, 3.076e-5, 1.218e-5, 5.37e-6], i),
    }
}

fn ariel(t: f64, n: &[f64; 5], e: &[f64; 5], i: &[f64; 5]) -> Elements {
    let resonance = n[0] - 3.0 * n[1] + 2.0 * n[2];
    let synodic = n[1] - n[2];
    Elements {
        motion: 2.492_542_57 + cosines(&[(2.55e-6, resonance), (-4.216e-5, synodic), (-1.0256e-4, 2.0 * synodic)]),
        longitude: sines(&[
            (-0.001_860_5, resonance),
            (2.1999e-4, 2.0 * resonance),
            (2.31e-5, 3.0 * resonance),
            (4.3e-6, 4.0 * resonance),
            (-9.011e-5, synodic),
            (-9.107e-5, 2.0 * synodic),
            (-4.275e-5, 3.0 * synodic),
            (-1.649e-5, 2.0 * n[1] - 2.0 * n[3]),
        ]) + t * 2.492_952_52
            + 3.098_046_41,
        eccentricity: both(
            slow([-3.35e-6, 0.001_187_63, 8.6159e-4, 7.15e-5, 5.559e-5], e),
            vector(&[
                (-8.46e-5, -n[1] + 2.0 * n[2]),
                (9.181e-5, -2.0 * n[1] + 3.0 * n[2]),
                (2.003e-5, -n[1] + 2.0 * n[3]),
                (8.977e-5, n[1]),
            ]),
        ),
        inclination: slow([-1.2175e-4, 3.5825e-4, 2.9008e-4, 9.778e-5, 3.397e-5], i),
    }
}

fn umbriel(t: f64, n: &[f64; 5], e: &[f64; 5], i: &[f64; 5]) -> Elements {
    let resonance = n[0] - 3.0 * n[1] + 2.0 * n[2];
    let (inner, outer, far) = (n[1] - n[2], n[2] - n[3], n[2] - n[4]);
    let apsidal = n[2] - 2.0 * n[3];
    Elements {
        motion: 1.515_954_9
            + cosines(&[
                (9.74e-6, apsidal + e[2]),
                (-1.06e-4, inner),
                (5.416e-5, 2.0 * inner),
                (-2.359e-5, outer),
                (-7.07e-5, 2.0 * outer),
                (-3.628e-5, 3.0 * outer),
            ]),
        longitude: sines(&[
            (6.6057e-4, resonance),
            (-7.651e-5, 2.0 * resonance),
            (-8.96e-6, 3.0 * resonance),
            (-2.53e-6, 4.0 * resonance),
            (-5.291e-5, n[2] - 4.0 * n[3] + 3.0 * n[4]),
            (-7.34e-6, apsidal + e[4]),
            (-1.83e-6, apsidal + e[3]),
            (1.4791e-4, apsidal + e[2]),
            (-7.77e-6, apsidal + e[1]),
            (9.776e-5, inner),
            (7.313e-5, 2.0 * inner),
            (3.471e-5, 3.0 * inner),
            (1.889e-5, 4.0 * inner),
            (-6.789e-5, outer),
            (-8.286e-5, 2.0 * outer),
            (-3.381e-5, 3.0 * outer),
            (-1.579e-5, 4.0 * outer),
            (-1.021e-5, far),
            (-1.708e-5, 2.0 * far),
        ]) + t * 1.516_148_11
            + 2.285_401_69,
        eccentricity: both(
            slow([-2.1e-7, -2.2795e-4, 0.003_904_69, 3.0917e-4, 2.2192e-4], e),
            vector(&[
                (2.934e-5, n[1]),
                (2.62e-5, n[2]),
                (5.119e-5, -n[1] + 2.0 * n[2]),
                (-1.0386e-4, -2.0 * n[1] + 3.0 * n[2]),
                (-2.716e-5, -3.0 * n[1] + 4.0 * n[2]),
                (-1.622e-5, n[3]),
                (5.4923e-4, -n[2] + 2.0 * n[3]),
                (3.47e-5, -2.0 * n[2] + 3.0 * n[3]),
                (1.281e-5, -3.0 * n[2] + 4.0 * n[3]),
                (2.181e-5, -n[2] + 2.0 * n[4]),
                (4.625e-5, n[2]),
            ]),
        ),
        inclination: slow([-1.086e-5, -8.151e-5, 0.001_113_36, 3.5014e-4, 1.065e-4], i),
    }
}

fn titania(t: f64, n: &[f64; 5], e: &[f64; 5], i: &[f64; 5]) -> Elements {
    let (outer, apsidal) = (n[3] - n[4], n[2] - 2.0 * n[3]);
    let second = 2.0 * n[3] - 3.0 * n[4];
    Elements {
        motion: 0.721_663_16
            + cosines(&[
                (-2.64e-6, apsidal + e[2]),
                (-2.16e-6, second + e[4]),
                (6.45e-6, second + e[3]),
                (-1.11e-6, second + e[2]),
                (-6.223e-5, n[1] - n[3]),
                (-5.613e-5, n[2] - n[3]),
                (-3.994e-5, outer),
                (-9.185e-5, 2.0 * outer),
                (-5.831e-5, 3.0 * outer),
                (-3.86e-5, 4.0 * outer),
                (-2.618e-5, 5.0 * outer),
                (-1.806e-5, 6.0 * outer),
            ]),
        longitude: sines(&[
            (2.061e-5, n[2] - 4.0 * n[3] + 3.0 * n[4]),
            (-2.07e-6, apsidal + e[4]),
            (-2.88e-6, apsidal + e[3]),
            (-4.079e-5, apsidal + e[2]),
            (2.11e-6, apsidal + e[1]),
            (-5.183e-5, second + e[4]),
            (1.5987e-4, second + e[3]),
            (-3.505e-5, second + e[2]),
            (-1.56e-6, 3.0 * n[3] - 4.0 * n[4] + e[4]),
            (4.054e-5, n[1] - n[3]),
            (4.617e-5, n[2] - n[3]),
            (-3.1776e-4, outer),
            (-3.0559e-4, 2.0 * outer),
            (-1.4836e-4, 3.0 * outer),
            (-8.292e-5, 4.0 * outer),
            (-4.998e-5, 5.0 * outer),
            (-3.156e-5, 6.0 * outer),
            (-2.056e-5, 7.0 * outer),
            (-1.369e-5, 8.0 * outer),
        ]) + t * 0.721_718_51
            + 0.856_358_79,
        eccentricity: both(
            slow([-2e-8, -1.29e-6, -3.2451e-4, 9.3281e-4, 0.001_120_89], e),
            vector(&[
                (3.386e-5, n[1]),
                (1.746e-5, n[3]),
                (1.658e-5, -n[1] + 2.0 * n[3]),
                (2.889e-5, n[2]),
                (-3.586e-5, -n[2] + 2.0 * n[3]),
                (-1.786e-5, n[3]),
                (-3.21e-5, n[4]),
                (-1.7783e-4, -n[3] + 2.0 * n[4]),
                (7.9343e-4, -2.0 * n[3] + 3.0 * n[4]),
                (9.948e-5, -3.0 * n[3] + 4.0 * n[4]),
                (4.483e-5, -4.0 * n[3] + 5.0 * n[4]),
                (2.513e-5, -5.0 * n[3] + 6.0 * n[4]),
                (1.543e-5, -6.0 * n[3] + 7.0 * n[4]),
            ]),
        ),
        inclination: slow([-1.43e-6, -1.06e-6, -1.4013e-4, 6.8572e-4, 3.7832e-4], i),
    }
}

fn oberon(t: f64, n: &[f64; 5], e: &[f64; 5], i: &[f64; 5]) -> Elements {
    let outer = n[3] - n[4];
    let second = 2.0 * n[3] - 3.0 * n[4];
    Elements {
        motion: 0.466_580_54
            + cosines(&[
                (2.08e-6, second + e[4]),
                (-6.22e-6, second + e[3]),
                (1.07e-6, second + e[2]),
                (-4.31e-5, n[1] - n[4]),
                (-3.894e-5, n[2] - n[4]),
                (-8.011e-5, outer),
                (5.906e-5, 2.0 * outer),
                (3.749e-5, 3.0 * outer),
                (2.482e-5, 4.0 * outer),
                (1.684e-5, 5.0 * outer),
            ]),
        longitude: sines(&[
            (-7.82e-6, n[2] - 4.0 * n[3] + 3.0 * n[4]),
            (5.129e-5, second + e[4]),
            (-1.5824e-4, second + e[3]),
            (3.451e-5, second + e[2]),
            (4.751e-5, n[1] - n[4]),
            (3.896e-5, n[2] - n[4]),
            (3.5973e-4, outer),
            (2.8278e-4, 2.0 * outer),
            (1.386e-4, 3.0 * outer),
            (7.803e-5, 4.0 * outer),
            (4.729e-5, 5.0 * outer),
            (3e-5, 6.0 * outer),
            (1.962e-5, 7.0 * outer),
            (1.311e-5, 8.0 * outer),
        ]) + t * 0.466_692_12
            - 0.915_591_8,
        eccentricity: both(
            slow([0.0, -3.5e-7, 7.453e-5, -7.5868e-4, 0.001_397_34], e),
            vector(&[
                (3.9e-5, n[1]),
                (1.766e-5, -n[1] + 2.0 * n[4]),
                (3.242e-5, n[2]),
                (7.975e-5, n[3]),
                (7.566e-5, n[4]),
                (1.3404e-4, -n[3] + 2.0 * n[4]),
                (-9.8726e-4, -2.0 * n[3] + 3.0 * n[4]),
                (-1.2609e-4, -3.0 * n[3] + 4.0 * n[4]),
                (-5.742e-5, -4.0 * n[3] + 5.0 * n[4]),
                (-3.241e-5, -5.0 * n[3] + 6.0 * n[4]),
                (-1.999e-5, -6.0 * n[3] + 7.0 * n[4]),
                (-1.294e-5, -7.0 * n[3] + 8.0 * n[4]),
            ]),
        ),
        inclination: slow([-4.4e-7, -3.1e-7, 3.689e-5, -5.9633e-4, 4.5169e-4], i),
    }
}
