//! Eight moons of Saturn: Dourneau (1987, thesis, Bordeaux), Harper and Taylor (1993), Sinclair (1977) and Taurman and others as
//! Meeus gathers them (*Astronomical Algorithms*, 2nd edition, chapter 46).

use glam::{DMat3, DVec3};

/// Inclination and node of the plane of the inner moons (Saturn's equator) on the ecliptic of B1950, degrees.
const PLANE: (f64, f64) = (28.0817, 168.8112);

/// A place on an orbit: true longitude, distance in Saturn's radii, inclination and node on the plane of the inner moons.
struct Orbit {
    longitude: f64,
    radius: f64,
    inclination: f64,
    node: f64,
}

/// From the centre of Saturn to Mimas, Enceladus, Tethys, Dione, Rhea, Titan, Hyperion and Iapetus in kilometres, catalogue
/// axes; `jde` is a Julian date of TT.
#[must_use]
pub fn centres(jde: f64) -> [DVec3; 8] {
    let at = Arguments::at(jde);
    let orbits =
        [at.mimas(), at.enceladus(), at.tethys(), at.dione(), at.rhea(), at.titan(), at.hyperion(), at.iapetus()];
    let (inclination, node) = (PLANE.0.to_radians(), PLANE.1.to_radians());
    let to_ecliptic = DMat3::from_rotation_z(node) * DMat3::from_rotation_x(inclination);
    let to_catalogue = super::b1950_to_catalogue() * DMat3::from_rotation_x(super::OBLIQUITY_B1950.to_radians());
    orbits.map(|orbit| {
        let along = DMat3::from_rotation_z(orbit.node - node)
            * DMat3::from_rotation_x(orbit.inclination)
            * DMat3::from_rotation_z(orbit.longitude - orbit.node)
            * DVec3::X;
        to_catalogue * (to_ecliptic * along) * orbit.radius * RADIUS_KM
    })
}

/// The radius in which the distances are counted, kilometres: 83.33 arcseconds at one astronomical unit.
const RADIUS_KM: f64 = 60_436.0;

/// Times and angles that several moons share. Days since an epoch, Julian years or centuries since it; W are angles in radians
/// (Meeus' names).
struct Arguments {
    t1: f64,
    t2: f64,
    t4: f64,
    t6: f64,
    t7: f64,
    t8: f64,
    t9: f64,
    t10: f64,
    t11: f64,
    w0: f64,
    w1: f64,
    w2: f64,
    w3: f64,
    w4: f64,
    w5: f64,
    w6: f64,
    w7: f64,
    w8: f64,
    e1: f64,
}

/// Degrees as radians.
fn rad(degrees: f64) -> f64 {
    degrees.to_radians()
}

impl Arguments {
    fn at(jde: f64) -> Arguments {
        let t1 = jde - 2_411_093.0;
        let t3 = (jde - 2_433_282.423) / 365.25 + 1950.0;
        let t4 = jde - 2_411_368.0;
        let t5 = t4 / 365.25;
        let t6 = jde - 2_415_020.0;
        let t7 = t6 / 36_525.0;
        let t10 = jde - 2_409_786.0;
        let t2 = t1 / 365.25;
        Arguments {
            t1,
            t2,
            t4,
            t6,
            t7,
            t8: t6 / 365.25,
            t9: (jde - 2_442_000.5) / 365.25,
            t10,
            t11: t10 / 36_525.0,
            w0: rad(5.095 * (t3 - 1866.39)),
            w1: rad(74.4 + 32.39 * t2),
            w2: rad(134.3 + 92.62 * t2),
            w3: rad(42.0 - 0.5118 * t5),
            w4: rad(276.59 + 0.5118 * t5),
            w5: rad(267.2635 + 1222.1136 * t7),
            w6: rad(175.4762 + 1221.5515 * t7),
            w7: rad(2.4891 + 0.002_435 * t7),
            w8: rad(113.35 - 0.2597 * t7),
            e1: 0.055_89 - 0.000_346 * t7,
        }
    }

    fn mimas(&self) -> Orbit {
        let w0 = self.w0;
        let mean = rad(127.64 + 381.994_497 * self.t1
            - 43.57 * w0.sin()
            - 0.72 * (3.0 * w0).sin()
            - 0.021_44 * (5.0 * w0).sin());
        let anomaly = mean - rad(106.1 + 365.549 * self.t2);
        let centre =
            rad(2.182_87 * anomaly.sin() + 0.025_988 * (2.0 * anomaly).sin() + 0.000_43 * (3.0 * anomaly).sin());
        Orbit {
            longitude: mean + centre,
            radius: 3.068_79 / (1.0 + 0.019_05 * (anomaly + centre).cos()),
            inclination: rad(1.563),
            node: rad(54.5 - 365.072 * self.t2),
        }
    }

    fn enceladus(&self) -> Orbit {
        let mean = rad(200.317 + 262.731_900_2 * self.t1 + 0.256_67 * self.w1.sin() + 0.208_83 * self.w2.sin());
        let anomaly = mean - rad(309.107 + 123.441_21 * self.t2);
        let centre = rad(0.555_77 * anomaly.sin() + 0.001_68 * (2.0 * anomaly).sin());
        Orbit {
            longitude: mean + centre,
            radius: 3.941_18 / (1.0 + 0.004_85 * (anomaly + centre).cos()),
            inclination: rad(0.0262),
            node: rad(348.0 - 151.95 * self.t2),
        }
    }

    fn tethys(&self) -> Orbit {
        let w0 = self.w0;
        Orbit {
            longitude: rad(285.306
                + 190.697_912_26 * self.t1
                + 2.063 * w0.sin()
                + 0.034_09 * (3.0 * w0).sin()
                + 0.001_015 * (5.0 * w0).sin()),
            radius: 4.880_998,
            inclination: rad(1.0976),
            node: rad(111.33 - 72.2441 * self.t2),
        }
    }

    fn dione(&self) -> Orbit {
        let mean = rad(254.712 + 131.534_931_93 * self.t1 - 0.0215 * self.w1.sin() - 0.017_33 * self.w2.sin());
        let anomaly = mean - rad(174.8 + 30.82 * self.t2);
        let centre = rad(0.247_17 * anomaly.sin() + 0.000_33 * (2.0 * anomaly).sin());
        Orbit {
            longitude: mean + centre,
            radius: 6.248_71 / (1.0 + 0.002_157 * (anomaly + centre).cos()),
            inclination: rad(0.0139),
            node: rad(232.0 - 30.27 * self.t2),
        }
    }

    fn rhea(&self) -> Orbit {
        let apse = rad(342.7 + 10.057 * self.t2);
        let h = 0.000_265 * apse.sin() + 0.001 * self.w4.sin();
        let k = 0.000_265 * apse.cos() + 0.001 * self.w4.cos();
        let n = rad(345.0 - 10.057 * self.t2);
        on_ecliptic(&Elements {
            mean: rad(359.244 + 79.690_047_2 * self.t1 + 0.086_754 * n.sin()),
            perisaturnium: h.atan2(k),
            eccentricity: h.hypot(k),
            axis: 8.725_924,
            node: rad(168.8034 + 0.736_936 * n.sin() + 0.041 * self.w3.sin()),
            inclination: rad(28.0362 + 0.346_898 * n.cos() + 0.0193 * self.w3.cos()),
        })
    }

    fn titan(&self) -> Orbit {
        let mean = rad(261.1582 + 22.576_978_55 * self.t4 + 0.074_025 * self.w3.sin());
        let inclination = rad(27.451_41 + 0.295_999 * self.w3.cos());
        let node = rad(168.669_25 + 0.628_808 * self.w3.sin());
        let (sin_w7, cos_w7) = self.w7.sin_cos();
        let (sin_i, cos_i) = inclination.sin_cos();
        let (sin_node, cos_node) = (node - self.w8).sin_cos();
        let (a1, a2) = (sin_w7 * sin_node, cos_w7 * sin_i - sin_w7 * cos_i * cos_node);
        let (psi, s) = (a1.atan2(a2), a1.hypot(a2));
        let g0 = rad(102.8623);
        let mut g = self.w4 - node - psi;
        let mut apse = self.w4;
        for _ in 0..3 {
            apse = self.w4 + rad(0.375_15) * ((2.0 * g).sin() - (2.0 * g0).sin());
            g = apse - node - psi;
        }
        let e = 0.029_092 + 0.000_190_48 * ((2.0 * g).cos() - (2.0 * g0).cos());
        let q = 2.0 * (self.w5 - apse);
        let theta = (sin_i * sin_node).atan2(cos_w7 * sin_i * cos_node - sin_w7 * cos_i) + self.w8;
        let u = 2.0 * self.w5 - 2.0 * theta + psi;
        let h = 0.9375 * e * e * q.sin() + 0.1875 * s * s * (2.0 * (self.w5 - theta)).sin();
        let sun = self.e1 * self.w6.sin() + 0.75 * self.e1 * self.e1 * (2.0 * self.w6).sin() + h;
        on_ecliptic(&Elements {
            mean: mean - rad(0.254_744) * sun,
            perisaturnium: apse + rad(0.159_215) * q.sin(),
            eccentricity: e + 0.002_778_797 * e * q.cos(),
            axis: 20.216_193,
            node: node + rad(0.031_843) * s * u.sin() / sin_i,
            inclination: inclination + rad(0.031_843) * s * u.cos(),
        })
    }

    fn hyperion(&self) -> Orbit {
        let eta = rad(92.39 + 0.562_107_1 * self.t6);
        let zeta = rad(148.19 - 19.18 * self.t8);
        let theta = rad(184.8 - 35.41 * self.t9);
        let a_s = rad(176.0 + 12.22 * self.t8);
        let b_s = rad(8.0 + 24.44 * self.t8);
        let c_s = b_s + rad(5.0);
        let apse = rad(69.898 - 18.670_88 * self.t8);
        let phi = 2.0 * (apse - self.w5);
        let chi = rad(94.9 - 2.292 * self.t8);
        let (plus, minus) = (zeta + eta, zeta - eta);
        on_ecliptic(&Elements {
            axis: 24.506_01 - 0.086_86 * eta.cos() - 0.001_66 * plus.cos() + 0.001_75 * minus.cos(),
            eccentricity: 0.103_458 - 0.004_099 * eta.cos() - 0.000_167 * plus.cos()
                + 0.000_235 * minus.cos()
                + 0.023_03 * zeta.cos()
                - 0.002_12 * (2.0 * zeta).cos()
                + 0.000_151 * (3.0 * zeta).cos()
                + 0.000_13 * phi.cos(),
            perisaturnium: apse
                + rad(0.156_48 * chi.sin()
                    - 0.4457 * eta.sin()
                    - 0.2657 * plus.sin()
                    - 0.3573 * minus.sin()
                    - 12.872 * zeta.sin()
                    + 1.668 * (2.0 * zeta).sin()
                    - 0.2419 * (3.0 * zeta).sin()
                    - 0.07 * phi.sin()),
            mean: rad(177.047
                + 16.919_938_29 * self.t6
                + 0.156_48 * chi.sin()
                + 9.142 * eta.sin()
                + 0.007 * (2.0 * eta).sin()
                - 0.014 * (3.0 * eta).sin()
                + 0.2275 * plus.sin()
                + 0.2112 * minus.sin()
                - 0.26 * zeta.sin()
                - 0.0098 * (2.0 * zeta).sin()
                - 0.013 * a_s.sin()
                + 0.017 * b_s.sin()
                - 0.0303 * phi.sin()),
            inclination: rad(
                27.3347 + 0.643_488_6 * chi.cos() + 0.315 * self.w3.cos() + 0.018 * theta.cos() - 0.018 * c_s.cos()
            ),
            node: rad(168.6812 + 1.401_36 * chi.cos() + 0.685_99 * self.w3.sin() - 0.0392 * c_s.sin()
                + 0.0366 * (theta - rad(7.5)).sin()),
        })
    }

    fn iapetus(&self) -> Orbit {
        let (t7, t) = (self.t7, self.t11);
        let titan = rad(261.1582 + 22.576_978_55 * self.t4);
        let sun_apse = rad(91.796 + 0.562 * t7);
        let psi = rad(4.367 - 0.195 * t7);
        let theta = rad(146.819 - 3.198 * t7);
        let phi = rad(60.47 + 1.521 * t7);
        let titan_node = rad(205.055 - 2.091 * t7);
        let e = 0.028_298 + 0.001_156 * t;
        let apse = rad(352.91 + 11.71 * t);
        let mean = rad(76.3852 + 4.537_951_25 * self.t10);
        let inclination = rad(18.4602 + (-0.9518 + (-0.072 + 0.0054 * t) * t) * t);
        let node = rad(143.198 + (-3.919 + (0.116 + 0.008 * t) * t) * t);
        let l = mean - apse;
        let g = apse - node - psi;
        let g1 = apse - node - phi;
        let ls = self.w5 - sun_apse;
        let gs = sun_apse - theta;
        let lt = titan - self.w4;
        let gt = self.w4 - titan_node;
        let u1 = 2.0 * (l + g - ls - gs);
        let u2 = l + g1 - lt - gt;
        let u3 = l + 2.0 * (g - ls - gs);
        let u4 = lt + gt - g1;
        let u5 = 2.0 * (ls + gs);
        let long = l + g1 + lt + gt + phi;
        let w = 0.080_77 * (g1 - gt).sin() + 0.021_39 * (u5 - 2.0 * g).sin() - 0.006_76 * u3.sin()
            + 0.0138 * l.sin()
            + 0.016_32 * (l + u2).sin()
            + 0.035_47 * u4.sin();
        let across = 0.042_04 * (u5 + psi).sin() + 0.002_35 * long.sin() + 0.003_58 * (u2 + phi).sin();
        on_ecliptic(&Elements {
            axis: 58.935_028 + 0.004_638 * u1.cos() + 0.058_222 * u2.cos(),
            eccentricity: e - 0.001_409_7 * (g1 - gt).cos()
                + 0.000_373_3 * (u5 - 2.0 * g).cos()
                + 0.000_118 * u3.cos()
                + 0.000_240_8 * l.cos()
                + 0.000_284_9 * (l + u2).cos()
                + 0.000_619 * u4.cos(),
            perisaturnium: apse + rad(w) / e,
            mean: mean
                + rad(-0.042_99 * u2.sin()
                    - 0.007_89 * u1.sin()
                    - 0.063_12 * ls.sin()
                    - 0.002_95 * (2.0 * ls).sin()
                    - 0.022_31 * u5.sin()
                    + 0.0065 * (u5 + psi).sin()),
            inclination: inclination
                + rad(0.042_04 * (u5 + psi).cos() + 0.002_35 * long.cos() + 0.0036 * (u2 + phi).cos()),
            node: node + rad(across) / inclination.sin(),
        })
    }
}

/// Elements of an orbit on the ecliptic of B1950, radians and Saturn's radii.
struct Elements {
    mean: f64,
    perisaturnium: f64,
    eccentricity: f64,
    axis: f64,
    node: f64,
    inclination: f64,
}

/// From the ecliptic to the plane of the inner moons, with the equation of the centre to the fifth power of the eccentricity.
fn on_ecliptic(orbit: &Elements) -> Orbit {
    let e = orbit.eccentricity;
    let (e2, anomaly) = (e * e, orbit.mean - orbit.perisaturnium);
    let (e3, e4, e5) = (e2 * e, e2 * e2, e2 * e2 * e);
    let centre = (2.0 * e - 0.25 * e3 + 0.052_083_333_3 * e5) * anomaly.sin()
        + (1.25 * e2 - 0.458_333_333 * e4) * (2.0 * anomaly).sin()
        + (1.083_333_333 * e3 - 0.671_875 * e5) * (3.0 * anomaly).sin()
        + 1.072_917 * e4 * (4.0 * anomaly).sin()
        + 1.142_708 * e5 * (5.0 * anomaly).sin();
    let (plane, plane_node) = (rad(PLANE.0), rad(PLANE.1));
    let g = orbit.node - plane_node;
    let (sin_i, cos_i) = orbit.inclination.sin_cos();
    let (sin_p, cos_p) = plane.sin_cos();
    let (a1, a2) = (sin_i * g.sin(), cos_p * sin_i * g.cos() - sin_p * cos_i);
    let u = a1.atan2(a2);
    let psi = (sin_p * g.sin()).atan2(cos_p * sin_i - sin_p * cos_i * g.cos());
    Orbit {
        longitude: orbit.mean + centre + u - g - psi,
        radius: orbit.axis * (1.0 - e2) / (1.0 + e * (anomaly + centre).cos()),
        inclination: a1.hypot(a2).min(1.0).asin(),
        node: plane_node + u,
    }
}
