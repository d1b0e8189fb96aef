//! Light that has been scattered before: radiance averaged over directions with the phase functions, at nodes of height,
//! of the Sun's zenith angle and of direction, found by successive orders of scattering.
//!
//! The scheme is that of Bruneton & Neyret (2008, Computer Graphics Forum 27, 1079) without its coordinates: gather the
//! radiance at each node along bent rays, average it with the phase function, and gather again until nothing changes.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::phase;
use super::shells::{Exit, Shell, Shells, Walk};
use super::sunlight::{Sunlight, lifted};

/// Nodes of height, metres.
const HEIGHTS_M: [f64; 11] = [0.0, 1e3, 2.5e3, 5e3, 8e3, 12e3, 18e3, 26e3, 38e3, 55e3, 1e5];
/// Nodes of the Sun's zenith angle: degrees from that at the eye.
const ZENITHS_DEG: [f64; 11] = [-20.0, -12.0, -7.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 9.0, 13.0];
/// Nodes of direction: altitudes in degrees ...
const ALTITUDES_DEG: [f64; 9] = [-90.0, -50.0, -25.0, -10.0, 0.0, 10.0, 25.0, 50.0, 90.0];
/// ... and azimuths from the Sun, in degrees.
const AZIMUTHS_DEG: [f64; 7] = [0.0, 15.0, 35.0, 60.0, 90.0, 130.0, 180.0];
/// Directions in which light is gathered: altitudes in each hemisphere, closest at the horizon, and azimuths over half a turn.
const GATHERED_ALTITUDES: usize = 8;
const GATHERED_AZIMUTHS: usize = 8;
/// Rounds of scattering at most, and the change at which they end.
const ROUNDS: usize = 40;
const SETTLED: f64 = 2e-3;
/// No light: its logarithm.
const DARK: f64 = -200.0;

const DIRECTIONS: usize = ALTITUDES_DEG.len() * AZIMUTHS_DEG.len();
const GATHERED: usize = 2 * GATHERED_ALTITUDES * GATHERED_AZIMUTHS;
const PLACES: usize = HEIGHTS_M.len() * ZENITHS_DEG.len();

/// Logs of the radiance averaged with the phase function of molecules and of haze.
type Averages = Vec<[f32; 2]>;

/// The light scattered before, around one position of the Sun.
#[derive(Debug)]
pub struct Field {
    /// Zenith angle of the Sun at the eye, radians.
    zenith: f64,
    /// [height][zenith][direction]
    averages: Averages,
    /// Log of the radiance of the ground at each zenith angle.
    ground: Vec<f64>,
    last_change: f64,
}

/// A direction in which light is gathered.
#[derive(Debug, Clone, Copy)]
struct Gathered {
    /// Zenith is z, the Sun over x.
    direction: DVec3,
    /// Solid angle, both sides of the Sun together.
    weight: f64,
}

impl Field {
    /// Gathers until nothing changes. The Sun's true zenith angle at the eye is in radians.
    #[must_use]
    pub fn new(shells: &Shells, zenith: f64, albedo: f64) -> Field {
        let sunlight = Sunlight::new(shells, zenith);
        let mut field = Field {
            zenith,
            averages: vec![[DARK as f32; 2]; PLACES * DIRECTIONS],
            ground: vec![DARK; ZENITHS_DEG.len()],
            last_change: 1.0,
        };
        let gathered = gathered();
        for _round in 0..ROUNDS {
            field.last_change = field.round(shells, &sunlight, &gathered, albedo);
            if field.last_change < SETTLED {
                break;
            }
        }
        field
    }

    /// By which share the last round changed the largest average.
    #[must_use]
    pub fn last_change(&self) -> f64 {
        self.last_change
    }

    /// Radiance scattered before, averaged with the phase functions of molecules and of haze about a direction of view, at a
    /// height where the Sun's true zenith angle is so much (radians).
    #[must_use]
    pub fn scattered_before(&self, height_m: f64, zenith: f64, up: DVec3, sun: DVec3, along: DVec3) -> [f64; 2] {
        let (altitude, azimuth) = about(up, sun, along);
        let (i, height) = between(&HEIGHTS_M, height_m);
        let (j, sunk) = self.zenith_place(zenith);
        let (k, raised) = between(&ALTITUDES_DEG, altitude.to_degrees());
        let (l, turn) = between(&AZIMUTHS_DEG, azimuth.to_degrees());
        let mut logs = [0.0; 2];
        for (di, wi) in [(0, 1.0 - height), (1, height)] {
            for (dj, wj) in [(0, 1.0 - sunk), (1, sunk)] {
                for (dk, wk) in [(0, 1.0 - raised), (1, raised)] {
                    let row = (((i + di) * ZENITHS_DEG.len() + j + dj) * ALTITUDES_DEG.len() + k + dk)
                        * AZIMUTHS_DEG.len()
                        + l;
                    for (average, wl) in self.averages[row..row + 2].iter().zip([1.0 - turn, turn]) {
                        let weight = wi * wj * wk * wl;
                        logs[0] += weight * f64::from(average[0]);
                        logs[1] += weight * f64::from(average[1]);
                    }
                }
            }
        }
        logs.map(f64::exp)
    }

    /// Radiance of the ground where the Sun's true zenith angle is so much, radians.
    #[must_use]
    pub fn ground_radiance(&self, zenith: f64) -> f64 {
        let (j, share) = self.zenith_place(zenith);
        (self.ground[j] + (self.ground[j + 1] - self.ground[j]) * share).exp()
    }

    fn zenith_place(&self, zenith: f64) -> (usize, f64) {
        between(&ZENITHS_DEG, (zenith - self.zenith).to_degrees())
    }

    /// One round: gather, average, keep. By which share the largest average changed.
    fn round(&mut self, shells: &Shells, sunlight: &Sunlight, gathered: &[Gathered], albedo: f64) -> f64 {
        let mut averages = Vec::with_capacity(self.averages.len());
        let mut ground = Vec::with_capacity(self.ground.len());
        let mut change = 0.0f64;
        for &height_m in &HEIGHTS_M {
            let shell = shells.shell(shells.index_at(height_m));
            let kernel = kernel(shell.asymmetry, gathered);
            for offset in &ZENITHS_DEG {
                let zenith = self.zenith + offset.to_radians();
                let radiances: Vec<f64> =
                    gathered.iter().map(|g| self.gather(shells, sunlight, height_m, zenith, g.direction)).collect();
                for rows in kernel.chunks_exact(gathered.len()) {
                    let mut sums = [0.0; 2];
                    for (weights, radiance) in rows.iter().zip(&radiances) {
                        sums[0] += weights[0] * radiance;
                        sums[1] += weights[1] * radiance;
                    }
                    averages.push(sums.map(|sum| sum.max(1e-80).ln() as f32));
                }
                if height_m == 0.0 {
                    let diffuse: f64 = gathered
                        .iter()
                        .zip(&radiances)
                        .map(|(g, radiance)| g.weight * g.direction.z.max(0.0) * radiance)
                        .sum();
                    let beam = sunlight.at(0.0, zenith);
                    let direct = beam.irradiance * (zenith - beam.bending).cos().max(0.0);
                    ground.push((albedo / PI * (diffuse + direct)).max(1e-80).ln());
                }
            }
        }
        // Deep in the shadow there is next to nothing, and the share of a change of nothing means nothing.
        let brightest = averages.iter().map(|a| a[0]).fold(f32::MIN, f32::max);
        for (new, old) in averages.iter().zip(&self.averages) {
            if new[0] > brightest - 7.0 {
                change = change.max(f64::from(1.0 - (old[0] - new[0]).exp()).abs());
            }
        }
        self.averages = averages;
        self.ground = ground;
        change
    }

    /// Radiance that comes to a node from a direction: scattered once and, as far as is known, more often.
    fn gather(&self, shells: &Shells, sunlight: &Sunlight, height_m: f64, zenith: f64, direction: DVec3) -> f64 {
        let sun = DVec3::new(zenith.sin(), 0.0, zenith.cos());
        let top = shells.borders_m()[shells.borders_m().len() - 1];
        let height_m = height_m.min(top - 1.0);
        let mut walk = Walk::new(shells, DVec3::new(0.0, 0.0, shells.ground_m() + height_m), direction);
        if height_m == 0.0 && direction.z < 0.0 {
            return self.ground_radiance(zenith);
        }
        let (mut light, mut clear) = (0.0, 1.0f64);
        loop {
            let (begin, along) = (walk.position, walk.direction);
            let shell = shells.shell(walk.shell);
            let (length, exit) = walk.step(shells);
            let pieces = (length / 40e3).max(shell.extinction() * length / 0.7).ceil().clamp(1.0, 64.0);
            let piece = length / pieces;
            let depth = shell.extinction() * piece;
            for k in 0..pieces as usize {
                let point = begin + along * ((k as f64 + 0.5) * piece);
                let reached = clear * -(-depth).exp_m1() / depth.max(1e-300) * piece;
                light += reached * self.sent(shells, sunlight, shell, point, sun, along);
                clear *= (-depth).exp();
            }
            match exit {
                Exit::Shell if clear > 1e-6 => {}
                Exit::Ground => {
                    let there = walk.position.normalize().dot(sun).clamp(-1.0, 1.0).acos();
                    return light + clear * self.ground_radiance(there);
                }
                Exit::Shell | Exit::Top => return light,
            }
        }
    }

    /// Light sent along a ray by a metre of air.
    fn sent(&self, shells: &Shells, sunlight: &Sunlight, shell: &Shell, point: DVec3, sun: DVec3, along: DVec3) -> f64 {
        let up = point.normalize();
        let height_m = shells.height_m(point);
        let zenith = up.dot(sun).clamp(-1.0, 1.0).acos();
        let [molecules, haze] = self.scattered_before(height_m, zenith, up, sun, along);
        let before = shell.rayleigh_per_m * molecules + shell.haze_per_m * haze;
        let beam = sunlight.at(height_m, zenith);
        if beam.irradiance <= 0.0 {
            return before;
        }
        let cos = along.dot(lifted(sun, up, beam.bending));
        before
            + beam.irradiance
                * (shell.rayleigh_per_m * phase::rayleigh(cos)
                    + shell.haze_per_m * phase::henyey_greenstein(cos, shell.asymmetry))
    }
}

/// The directions in which light is gathered: closest at the horizon (half of them within 15 degrees of it) and around the
/// Sun's azimuth, where the light is.
fn gathered() -> Vec<Gathered> {
    let mut all = Vec::with_capacity(GATHERED);
    for side in [-1.0, 1.0] {
        for k in 0..GATHERED_ALTITUDES {
            let edge = |k: usize| (k as f64 / GATHERED_ALTITUDES as f64).powi(2);
            let sine = 0.5 * (edge(k) + edge(k + 1));
            let (width, cosine) = (edge(k + 1) - edge(k), (1.0 - sine * sine).sqrt());
            for l in 0..GATHERED_AZIMUTHS {
                let limit = |l: usize| PI * (l as f64 / GATHERED_AZIMUTHS as f64).powf(1.6);
                let azimuth = 0.5 * (limit(l) + limit(l + 1));
                let direction = DVec3::new(cosine * azimuth.cos(), cosine * azimuth.sin(), side * sine);
                all.push(Gathered { direction, weight: width * 2.0 * (limit(l + 1) - limit(l)) });
            }
        }
    }
    all
}

/// The weight with which each gathered direction (and its mirror image beyond the Sun's vertical) counts for each node of
/// direction: phase functions times solid angles, normalised so that light that comes from everywhere stays what it is.
fn kernel(asymmetry: f64, gathered: &[Gathered]) -> Vec<[f64; 2]> {
    let mut kernel = Vec::with_capacity(DIRECTIONS * gathered.len());
    for altitude in ALTITUDES_DEG {
        for azimuth in AZIMUTHS_DEG {
            let ((sin_a, cos_a), (sin_z, cos_z)) = (altitude.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
            let view = DVec3::new(cos_a * cos_z, cos_a * sin_z, sin_a);
            let row: Vec<[f64; 2]> = gathered
                .iter()
                .map(|g| {
                    let mirrored = DVec3::new(g.direction.x, -g.direction.y, g.direction.z);
                    // The view looks along the ray towards where light comes from, and so does the gathered direction: the
                    // cosine of the scattering angle is that between them.
                    [g.direction, mirrored].iter().fold([0.0; 2], |sum, from| {
                        let cos = view.dot(*from);
                        [
                            sum[0] + 0.5 * g.weight * phase::rayleigh(cos),
                            sum[1] + 0.5 * g.weight * phase::henyey_greenstein(cos, asymmetry),
                        ]
                    })
                })
                .collect();
            let whole = row.iter().fold([0.0; 2], |sum, w| [sum[0] + w[0], sum[1] + w[1]]);
            kernel.extend(row.iter().map(|w| [w[0] / whole[0], w[1] / whole[1]]));
        }
    }
    kernel
}

/// Altitude of a direction at a point, and its azimuth from the Sun's, 0 to pi, radians.
fn about(up: DVec3, sun: DVec3, along: DVec3) -> (f64, f64) {
    let sine = up.dot(along).clamp(-1.0, 1.0);
    let (flat_sun, flat) = (sun - up * sun.dot(up), along - up * sine);
    let lengths = flat_sun.length() * flat.length();
    let cos = if lengths < 1e-12 { 1.0 } else { flat_sun.dot(flat) / lengths };
    (FRAC_PI_2 - sine.acos(), cos.clamp(-1.0, 1.0).acos())
}

/// The node below a value, and the share of the way to the next, held within the nodes.
fn between(nodes: &[f64], value: f64) -> (usize, f64) {
    let below = nodes.partition_point(|node| *node <= value).clamp(1, nodes.len() - 1) - 1;
    (below, ((value - nodes[below]) / (nodes[below + 1] - nodes[below])).clamp(0.0, 1.0))
}
