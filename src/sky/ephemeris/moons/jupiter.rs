//! The Galilean moons: Lieske's theory E5 (1998, A&AS 129, 205) with the terms that Meeus prints (*Astronomical Algorithms*,
//! 2nd edition, chapter 44, "high accuracy"): within 0.4 arcsecond of L1.2 (Lainey et al. 2004) from 1990 to 2050.

use glam::{DMat3, DVec3};

/// The radius in which the distances are counted, kilometres: Lieske's semi-major axis of Io, 0.002819353 au, is 5.90569 of it.
const RADIUS_KM: f64 = 71_417.0;

/// From the centre of Jupiter to Io, Europa, Ganymede and Callisto in kilometres, catalogue axes; `jde` is a Julian date of TT.
#[must_use]
pub fn centres(jde: f64) -> [DVec3; 4] {
    let t = jde - 2_443_000.5;
    let linear = |start: f64, rate: f64| (start + rate * t).to_radians();
    // Mean longitudes, longitudes of perijoves and of nodes on Jupiter's equator.
    let l1 = linear(106.077_19, 203.488_955_79);
    let l2 = linear(175.731_61, 101.374_724_735);
    let l3 = linear(120.558_83, 50.317_609_207);
    let l4 = linear(84.444_59, 21.571_071_177);
    let p1 = linear(97.0881, 0.161_385_86);
    let p2 = linear(154.8663, 0.047_263_07);
    let p3 = linear(188.184, 0.007_127_34);
    let p4 = linear(335.2868, 0.001_84);
    let w1 = linear(312.3346, -0.132_793_86);
    let w2 = linear(100.4411, -0.032_630_64);
    let w3 = linear(119.1942, -0.007_177_03);
    let w4 = linear(322.6186, -0.001_759_34);
    // The great inequality, the free libration, the node of Jupiter's equator, the anomalies of Jupiter and Saturn, the
    // longitude of Jupiter's perihelion.
    let inequality = 0.330_33_f64.to_radians() * linear(163.679, 0.001_051_2).sin()
        + 0.034_39_f64.to_radians() * linear(34.486, -0.016_173_1).sin();
    let phi = linear(199.6766, 0.173_791_9);
    let psi = linear(316.5182, -0.000_002_08);
    let g = linear(30.237_56, 0.083_092_570_1) + inequality;
    let saturn = linear(31.978_53, 0.033_459_733_9);
    let perihelion = 13.469_942_f64.to_radians();

    let s1 = degrees(&[
        (0.47259, 2.0 * (l1 - l2)),
        (-0.03478, p3 - p4),
        (0.01081, l2 - 2.0 * l3 + p3),
        (0.00738, phi),
        (0.00713, l2 - 2.0 * l3 + p2),
        (-0.00674, p1 + p3 - 2.0 * perihelion - 2.0 * g),
        (0.00666, l2 - 2.0 * l3 + p4),
        (0.00445, l1 - p3),
        (-0.00354, l1 - l2),
        (-0.00317, 2.0 * psi - 2.0 * perihelion),
        (0.00265, l1 - p4),
        (-0.00186, g),
        (0.00162, p2 - p3),
        (0.00158, 4.0 * (l1 - l2)),
        (-0.00155, l1 - l3),
        (-0.00138, psi + w3 - 2.0 * perihelion - 2.0 * g),
        (-0.00115, 2.0 * (l1 - 2.0 * l2 + w2)),
        (0.00089, p2 - p4),
        (0.00085, l1 + p3 - 2.0 * perihelion - 2.0 * g),
        (0.00083, w2 - w3),
        (0.00053, psi - w2),
    ]);
    let s2 = degrees(&[
        (1.06476, 2.0 * (l2 - l3)),
        (0.04256, l1 - 2.0 * l2 + p3),
        (0.03581, l2 - p3),
        (0.02395, l1 - 2.0 * l2 + p4),
        (0.01984, l2 - p4),
        (-0.01778, phi),
        (0.01654, l2 - p2),
        (0.01334, l2 - 2.0 * l3 + p2),
        (0.01294, p3 - p4),
        (-0.01142, l2 - l3),
        (-0.01057, g),
        (-0.00775, 2.0 * (psi - perihelion)),
        (0.00524, 2.0 * (l1 - l2)),
        (-0.0046, l1 - l3),
        (0.00316, psi - 2.0 * g + w3 - 2.0 * perihelion),
        (-0.00203, p1 + p3 - 2.0 * perihelion - 2.0 * g),
        (0.00146, psi - w3),
        (-0.00145, 2.0 * g),
        (0.00125, psi - w4),
        (-0.00115, l1 - 2.0 * l3 + p3),
        (-0.00094, 2.0 * (l2 - w2)),
        (0.00086, 2.0 * (l1 - 2.0 * l2 + w2)),
        (-0.00086, 5.0 * saturn - 2.0 * g + 52.225_f64.to_radians()),
        (-0.00078, l2 - l4),
        (-0.00064, 3.0 * l3 - 7.0 * l4 + 4.0 * p4),
        (0.00064, p1 - p4),
        (-0.00063, l1 - 2.0 * l3 + p4),
        (0.00058, w3 - w4),
        (0.00056, 2.0 * (psi - perihelion - g)),
        (0.00056, 2.0 * (l2 - l4)),
        (0.00055, 2.0 * (l1 - l3)),
        (0.00052, 3.0 * l3 - 7.0 * l4 + p3 + 3.0 * p4),
        (-0.00043, l1 - p3),
        (0.00041, 5.0 * (l2 - l3)),
        (0.00041, p4 - perihelion),
        (0.00032, w2 - w3),
        (0.00032, 2.0 * (l3 - g - perihelion)),
    ]);
    let s3 = degrees(&[
        (0.1649, l3 - p3),
        (0.09081, l3 - p4),
        (-0.06907, l2 - l3),
        (0.03784, p3 - p4),
        (0.01846, 2.0 * (l3 - l4)),
        (-0.0134, g),
        (-0.01014, 2.0 * (psi - perihelion)),
        (0.00704, l2 - 2.0 * l3 + p3),
        (-0.0062, l2 - 2.0 * l3 + p2),
        (-0.00541, l3 - l4),
        (0.00381, l2 - 2.0 * l3 + p4),
        (0.00235, psi - w3),
        (0.00198, psi - w4),
        (0.00176, phi),
        (0.0013, 3.0 * (l3 - l4)),
        (0.00125, l1 - l3),
        (-0.00119, 5.0 * saturn - 2.0 * g + 52.225_f64.to_radians()),
        (0.00109, l1 - l2),
        (-0.001, 3.0 * l3 - 7.0 * l4 + 4.0 * p4),
        (0.00091, w3 - w4),
        (0.0008, 3.0 * l3 - 7.0 * l4 + p3 + 3.0 * p4),
        (-0.00075, 2.0 * l2 - 3.0 * l3 + p3),
        (0.00072, p1 + p3 - 2.0 * perihelion - 2.0 * g),
        (0.00069, p4 - perihelion),
        (-0.00058, 2.0 * l3 - 3.0 * l4 + p4),
        (-0.00057, l3 - 2.0 * l4 + p4),
        (0.00056, l3 + p3 - 2.0 * perihelion - 2.0 * g),
        (-0.00052, l2 - 2.0 * l3 + p1),
        (-0.00050, p2 - p3),
        (0.00048, l3 - 2.0 * l4 + p3),
        (-0.00045, 2.0 * l2 - 3.0 * l3 + p4),
        (-0.00041, p2 - p4),
        (-0.00038, 2.0 * g),
        (-0.00037, p3 - p4 + w3 - w4),
        (-0.00032, 3.0 * l3 - 7.0 * l4 + 2.0 * p3 + 2.0 * p4),
        (0.0003, 4.0 * (l3 - l4)),
        (0.00029, l3 + p4 - 2.0 * perihelion - 2.0 * g),
        (-0.00028, w3 + psi - 2.0 * perihelion - 2.0 * g),
        (0.00026, l3 - perihelion - g),
        (0.00024, l2 - 3.0 * l3 + 2.0 * l4),
        (0.00021, 2.0 * (l3 - perihelion - g)),
        (-0.00021, l3 - p2),
        (0.00017, 2.0 * (l3 - p3)),
    ]);
    let s4 = degrees(&[
        (0.84287, l4 - p4),
        (0.03431, p4 - p3),
        (-0.03305, 2.0 * (psi - perihelion)),
        (-0.03211, g),
        (-0.01862, l4 - p3),
        (0.01186, psi - w4),
        (0.00623, l4 + p4 - 2.0 * g - 2.0 * perihelion),
        (0.00387, 2.0 * (l4 - p4)),
        (-0.00284, 5.0 * saturn - 2.0 * g + 52.225_f64.to_radians()),
        (-0.00234, 2.0 * (psi - p4)),
        (-0.00223, l3 - l4),
        (-0.00208, l4 - perihelion),
        (0.00178, psi + w4 - 2.0 * p4),
        (0.00134, p4 - perihelion),
        (0.00125, 2.0 * (l4 - g - perihelion)),
        (-0.00117, 2.0 * g),
        (-0.00112, 2.0 * (l3 - l4)),
        (0.00107, 3.0 * l3 - 7.0 * l4 + 4.0 * p4),
        (0.00102, l4 - g - perihelion),
        (0.00096, 2.0 * l4 - psi - w4),
        (0.00087, 2.0 * (psi - w4)),
        (-0.00085, 3.0 * l3 - 7.0 * l4 + p3 + 3.0 * p4),
        (0.00085, l3 - 2.0 * l4 + p4),
        (-0.00081, 2.0 * (l4 - psi)),
        (0.00071, l4 + p4 - 2.0 * perihelion - 3.0 * g),
        (0.00061, l1 - l4),
        (-0.00056, psi - w3),
        (-0.00054, l3 - 2.0 * l4 + p3),
        (0.00051, l2 - l4),
        (0.00042, 2.0 * (psi - g - perihelion)),
        (0.00039, 2.0 * (p4 - w4)),
        (0.00036, psi + perihelion - p4 - w4),
        (0.00035, 2.0 * saturn - g + 188.37_f64.to_radians()),
        (-0.00035, l4 - p4 + 2.0 * perihelion - 2.0 * psi),
        (-0.00032, l4 + p4 - 2.0 * perihelion - g),
        (0.0003, 2.0 * saturn - 2.0 * g + 149.15_f64.to_radians()),
        (0.00029, 3.0 * l3 - 7.0 * l4 + 2.0 * p3 + 2.0 * p4),
        (0.00028, l4 - p4 + 2.0 * psi - 2.0 * perihelion),
        (-0.00028, 2.0 * (l4 - w4)),
        (-0.00027, p3 - p4 + w3 - w4),
        (-0.00026, 5.0 * saturn - 3.0 * g + 188.37_f64.to_radians()),
        (0.00025, w4 - w3),
        (-0.00025, l2 - 3.0 * l3 + 2.0 * l4),
        (-0.00023, 3.0 * (l3 - l4)),
        (0.00021, 2.0 * l4 - 2.0 * perihelion - 3.0 * g),
        (-0.00021, 2.0 * l3 - 3.0 * l4 + p4),
        (0.00019, l4 - p4 - g),
        (-0.00019, 2.0 * l4 - p3 - p4),
        (-0.00018, l4 - p4 + g),
        (-0.00016, l4 + p3 - 2.0 * perihelion - 2.0 * g),
    ]);
    let (u1, u2, u3, u4) = (l1 + s1, l2 + s2, l3 + s3, l4 + s4);
    let b1 = sines(&[
        (0.0006393, u1 - w1),
        (0.0001825, u1 - w2),
        (0.0000329, u1 - w3),
        (-0.0000311, u1 - psi),
        (0.0000093, u1 - w4),
        (0.0000075, 3.0 * u1 - 4.0 * l2 - 1.9927 * s1 + w2),
        (0.0000046, u1 + psi - 2.0 * perihelion - 2.0 * g),
    ]);
    let b2 = sines(&[
        (0.0081004, u2 - w2),
        (0.0004512, u2 - w3),
        (-0.0003284, u2 - psi),
        (0.0001160, u2 - w4),
        (0.0000272, l1 - 2.0 * l3 + 1.0146 * s2 + w2),
        (-0.0000144, u2 - w1),
        (0.0000143, u2 + psi - 2.0 * perihelion - 2.0 * g),
        (0.0000035, u2 - psi + g),
        (-0.0000028, l1 - 2.0 * l3 + 1.0146 * s2 + w3),
    ]);
    let b3 = sines(&[
        (0.0032402, u3 - w3),
        (-0.0016911, u3 - psi),
        (0.0006847, u3 - w4),
        (-0.0002797, u3 - w2),
        (0.0000321, u3 + psi - 2.0 * perihelion - 2.0 * g),
        (0.0000051, u3 - psi + g),
        (-0.0000045, u3 - psi - g),
        (-0.0000045, u3 + psi - 2.0 * perihelion),
        (0.0000037, u3 + psi - 2.0 * perihelion - 3.0 * g),
        (0.000003, 2.0 * l2 - 3.0 * u3 + 4.03 * s3 + w2),
        (-0.0000021, 2.0 * l2 - 3.0 * u3 + 4.03 * s3 + w3),
    ]);
    let b4 = sines(&[
        (-0.0076579, u4 - psi),
        (0.0044134, u4 - w4),
        (-0.0005112, u4 - w3),
        (0.0000773, u4 + psi - 2.0 * perihelion - 2.0 * g),
        (0.0000104, u4 - psi + g),
        (-0.0000102, u4 - psi - g),
        (0.0000088, u4 + psi - 2.0 * perihelion - 3.0 * g),
        (-0.0000038, u4 + psi - 2.0 * perihelion - g),
    ]);
    let r1 = 5.90569
        * (1.0
            + cosines(&[
                (-0.0041339, 2.0 * (l1 - l2)),
                (-0.0000387, l1 - p3),
                (-0.0000214, l1 - p4),
                (0.000017, l1 - l2),
                (-0.0000131, 4.0 * (l1 - l2)),
                (0.0000106, l1 - l3),
                (-0.0000066, l1 + p3 - 2.0 * perihelion - 2.0 * g),
            ]));
    let r2 = 9.39657
        * (1.0
            + cosines(&[
                (0.0093848, l1 - l2),
                (-0.0003116, l2 - p3),
                (-0.0001744, l2 - p4),
                (-0.0001442, l2 - p2),
                (0.0000553, l2 - l3),
                (0.0000523, l1 - l3),
                (-0.0000290, 2.0 * (l1 - l2)),
                (0.0000164, 2.0 * (l2 - w2)),
                (0.0000107, l1 - 2.0 * l3 + p3),
                (-0.0000102, l2 - p1),
                (-0.0000091, 2.0 * (l1 - l3)),
            ]));
    let r3 = 14.98832
        * (1.0
            + cosines(&[
                (-0.0014388, l3 - p3),
                (-0.0007917, l3 - p4),
                (0.0006342, l2 - l3),
                (-0.0001761, 2.0 * (l3 - l4)),
                (0.0000294, l3 - l4),
                (-0.0000156, 3.0 * (l3 - l4)),
                (0.0000156, l1 - l3),
                (-0.0000153, l1 - l2),
                (0.000007, 2.0 * l2 - 3.0 * l3 + p3),
                (-0.0000051, l3 + p3 - 2.0 * perihelion - 2.0 * g),
            ]));
    let r4 = 26.36273
        * (1.0
            + cosines(&[
                (-0.0073546, l4 - p4),
                (0.0001621, l4 - p3),
                (0.0000974, l3 - l4),
                (-0.0000543, l4 + p4 - 2.0 * perihelion - 2.0 * g),
                (-0.0000271, 2.0 * (l4 - p4)),
                (0.0000182, l4 - perihelion),
                (0.0000177, 2.0 * (l3 - l4)),
                (-0.0000167, 2.0 * l4 - psi - w4),
                (0.0000167, psi - w4),
                (-0.0000155, 2.0 * (l4 - perihelion - g)),
                (0.0000142, 2.0 * (l4 - psi)),
                (0.0000105, l1 - l4),
                (0.0000092, l2 - l4),
                (-0.0000089, l4 - perihelion - g),
                (-0.0000062, l4 + p4 - 2.0 * perihelion - 3.0 * g),
                (0.0000048, 2.0 * (l4 - w4)),
            ]));

    // From the ecliptic of 1950 to that of the date.
    let besselian = (jde - 2_433_282.423) / 36_525.0;
    let precession = ((1.396_662_6 + 0.000_308_8 * besselian) * besselian).to_radians();
    let (node, from_node) = (psi + precession, [u1, u2, u3, u4].map(|longitude| longitude - psi));
    let to_ecliptic = equator_to_ecliptic(jde, node);
    let to_catalogue = ecliptic_of_date_to_catalogue(jde);
    let at = |longitude: f64, tangent: f64, radius: f64| {
        let latitude = tangent.atan();
        let (sin, cos) = longitude.sin_cos();
        let equatorial = DVec3::new(cos * latitude.cos(), sin * latitude.cos(), latitude.sin());
        to_catalogue * (to_ecliptic * equatorial) * radius * RADIUS_KM
    };
    let [o1, o2, o3, o4] = from_node;
    [at(o1, b1, r1), at(o2, b2, r2), at(o3, b3, r3), at(o4, b4, r4)]
}

/// From Jupiter's equator, counted from its node on the orbit, to the ecliptic of date (Meeus, p. 311).
fn equator_to_ecliptic(jde: f64, node: f64) -> DMat3 {
    let since_1900 = (jde - 2_415_020.0) / 36_525.0;
    let t = (jde - 2_451_545.0) / 36_525.0;
    let equator_on_orbit = (3.120_262 + 0.0006 * since_1900).to_radians();
    // Jupiter's orbit on the ecliptic of date (Meeus, table 31.A).
    let orbit_node = (100.464_407 + (1.020_977_4 + (0.000_403_15 + 0.000_000_404 * t) * t) * t).to_radians();
    let inclination = (1.303_267 + (-0.005_496_5 + (0.000_004_66 - 0.000_000_002 * t) * t) * t).to_radians();
    DMat3::from_rotation_z(orbit_node)
        * DMat3::from_rotation_x(inclination)
        * DMat3::from_rotation_z(node - orbit_node)
        * DMat3::from_rotation_x(equator_on_orbit)
}

/// From the mean ecliptic and equinox of date to the catalogue's axes.
fn ecliptic_of_date_to_catalogue(jde: f64) -> DMat3 {
    let obliquity = sofars::pnp::obl06(jde, 0.0);
    let to_mean_of_date = DMat3::from_cols_array_2d(&sofars::pnp::pmat06(jde, 0.0)).transpose();
    to_mean_of_date.transpose() * DMat3::from_rotation_x(obliquity)
}

/// The sum of amplitude times sine, the amplitudes in degrees: radians.
fn degrees(terms: &[(f64, f64)]) -> f64 {
    sines(terms).to_radians()
}

fn sines(terms: &[(f64, f64)]) -> f64 {
    terms.iter().map(|(amplitude, argument)| amplitude * argument.sin()).sum()
}

fn cosines(terms: &[(f64, f64)]) -> f64 {
    terms.iter().map(|(amplitude, argument)| amplitude * argument.cos()).sum()
}
