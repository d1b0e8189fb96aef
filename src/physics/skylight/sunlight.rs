//! The direct beam at every height: how much of it is left, and how far refraction has bent it.
//!
//! Light is followed from a point outwards. Rays of all apparent zenith angles up to the one that grazes the ground give the
//! true zenith angle, the optical depth, and by their spacing how much refraction spreads the beam:
//!
//! ```text
//! E = exp(-tau) (sin z' dz') / (sin z dz)        z' apparent, z true
//! ```
//!
//! The Sun is taken as a point: the half degree of its disc softens the edge of the Earth's shadow, which is left out.

use glam::DVec3;

use super::shells::{Exit, Shells, Walk};

/// Rays traced at each height.
const RAYS: usize = 72;
/// Places in the table at each height.
const PLACES: usize = 72;
/// The Sun's zenith angle at points that matter differs from that at the eye by no more than this, radians.
const AROUND: f64 = 0.44;

/// The direct beam at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beam {
    /// Irradiance across the beam, in units of that above the air.
    pub irradiance: f64,
    /// True less apparent zenith angle, radians.
    pub bending: f64,
}

/// What one ray tells.
#[derive(Debug, Clone, Copy)]
struct Told {
    zenith: f64,
    log_irradiance: f64,
    bending: f64,
}

/// The beam for all heights and zenith angles that matter for one Sun.
#[derive(Debug, Clone, PartialEq)]
pub struct Sunlight {
    heights_m: Vec<f64>,
    /// True zenith angle of the Sun that grazes the ground, at each height, radians.
    grazing: Vec<f64>,
    /// Zenith angles are counted from the grazing one; the last place is so far from it, radians.
    span: f64,
    /// Log of the irradiance, and bending: [height][place].
    table: Vec<[f64; 2]>,
}

impl Sunlight {
    /// The beam around a true zenith angle of the Sun, radians.
    #[must_use]
    pub fn new(shells: &Shells, zenith: f64) -> Sunlight {
        let heights_m = shells.borders_m().to_vec();
        let nearest = (zenith - AROUND).max(0.0);
        let told: Vec<Vec<Told>> = heights_m.iter().map(|&height_m| at_height(shells, height_m, nearest)).collect();
        let grazing: Vec<f64> = told.iter().map(|told| told[0].zenith).collect();
        let span = grazing.iter().fold(0.1, |span: f64, grazing| span.max(grazing - nearest));
        let mut table = Vec::with_capacity(heights_m.len() * PLACES);
        for (told, grazing) in told.iter().zip(&grazing) {
            table.extend((0..PLACES).map(|k| interpolated(told, grazing - span * place(k).powi(2))));
        }
        Sunlight { heights_m, grazing, span, table }
    }

    /// The beam at a height (metres) where the Sun's true zenith angle is so much (radians): none in the Earth's shadow.
    #[must_use]
    pub fn at(&self, height_m: f64, zenith: f64) -> Beam {
        let last = self.heights_m.len() - 1;
        let above = self.heights_m.partition_point(|z| *z <= height_m).clamp(1, last);
        let below = above - 1;
        let share = (height_m - self.heights_m[below]) / (self.heights_m[above] - self.heights_m[below]);
        let share = share.clamp(0.0, 1.0);
        let grazing = self.grazing[below] + (self.grazing[above] - self.grazing[below]) * share;
        if zenith > grazing {
            return Beam::default();
        }
        let x = ((grazing - zenith) / self.span).sqrt().min(1.0) * (PLACES - 1) as f64;
        let left = (x as usize).min(PLACES - 2);
        let over = x - left as f64;
        let value = |height: usize, what: usize| {
            let row = &self.table[height * PLACES + left..];
            row[0][what] + (row[1][what] - row[0][what]) * over
        };
        let both = |what: usize| value(below, what) + (value(above, what) - value(below, what)) * share;
        Beam { irradiance: both(0).exp(), bending: both(1) }
    }
}

/// The direction of the Sun as refraction lifts it at a point, from its true direction.
#[must_use]
pub fn lifted(sun: DVec3, up: DVec3, bending: f64) -> DVec3 {
    let across = sun - up * sun.dot(up);
    let length = across.length();
    if length < 1e-9 {
        return sun;
    }
    let zenith = sun.dot(up).clamp(-1.0, 1.0).acos() - bending;
    up * zenith.cos() + across * (zenith.sin() / length)
}

fn place(k: usize) -> f64 {
    k as f64 / (PLACES - 1) as f64
}

/// Rays from a height, the grazing one first.
fn at_height(shells: &Shells, height_m: f64, nearest: f64) -> Vec<Told> {
    let radius = shells.ground_m() + height_m;
    // Looking down from a border, the ray is in the shell below it.
    let here = shells.shell(shells.index_at((height_m - 1e-3).max(0.0)));
    let ground = shells.shell(0);
    let sine = (1.0 + ground.refractivity) / (1.0 + here.refractivity) * shells.ground_m() / radius;
    let grazing = std::f64::consts::PI - sine.min(1.0).asin();
    // A hair above the ground, so that rounding does not end the ray there.
    let grazing = grazing - 1e-7;
    let apparent = |k: usize| grazing - (grazing - nearest) * (k as f64 / (RAYS - 1) as f64).powi(2);
    let rays: Vec<(f64, f64, f64)> = (0..RAYS)
        .filter_map(|k| outwards(shells, radius, apparent(k)).map(|(zenith, depth)| (apparent(k), zenith, depth)))
        .collect();
    let spread = |k: usize| {
        let (a, b) = (rays[k.saturating_sub(1)], rays[(k + 1).min(rays.len() - 1)]);
        let slope = if b.1 == a.1 { 1.0 } else { (b.0 - a.0) / (b.1 - a.1) };
        let (apparent, zenith, _) = rays[k];
        if zenith.sin() < 1e-6 { slope * slope } else { slope * apparent.sin() / zenith.sin() }
    };
    let mut told: Vec<Told> = Vec::with_capacity(rays.len());
    for (k, &(apparent, zenith, depth)) in rays.iter().enumerate() {
        // Where images overlap (a mirage), the first of them stands for all.
        if told.last().is_none_or(|before| zenith < before.zenith) {
            let log_irradiance = spread(k).clamp(1e-3, 1e3).ln() - depth;
            told.push(Told { zenith, log_irradiance: log_irradiance.max(-690.0), bending: zenith - apparent });
        }
    }
    if told.is_empty() {
        // All rays are trapped or end on the ground: no Sun here.
        told.push(Told { zenith: 0.0, log_irradiance: -690.0, bending: 0.0 });
    }
    told
}

/// True zenith angle and optical depth of a ray from a radius, in a plane; `None` if it does not leave the air.
fn outwards(shells: &Shells, radius: f64, apparent: f64) -> Option<(f64, f64)> {
    let start = DVec3::new(0.0, 0.0, radius);
    let mut walk = Walk::new(shells, start, DVec3::new(apparent.sin(), 0.0, apparent.cos()));
    let mut depth = 0.0;
    if shells.height_m(start) >= shells.borders_m()[shells.borders_m().len() - 1] - 1e-6 && apparent.cos() >= 0.0 {
        return Some((apparent, 0.0));
    }
    for _ in 0..10_000 {
        let per_m = shells.shell(walk.shell).extinction();
        let (length, exit) = walk.step(shells);
        depth += per_m * length;
        match exit {
            Exit::Top => return Some((walk.direction.x.atan2(walk.direction.z), depth)),
            Exit::Ground => return None,
            Exit::Shell => {}
        }
    }
    None
}

/// Linear between rays; they are sorted from the largest zenith angle down.
fn interpolated(told: &[Told], zenith: f64) -> [f64; 2] {
    let after = told.partition_point(|told| told.zenith > zenith).min(told.len() - 1);
    let before = after.saturating_sub(1);
    let (a, b) = (told[before], told[after]);
    let share = if a.zenith == b.zenith { 0.0 } else { ((zenith - a.zenith) / (b.zenith - a.zenith)).clamp(0.0, 1.0) };
    [a.log_irradiance + (b.log_irradiance - a.log_irradiance) * share, a.bending + (b.bending - a.bending) * share]
}
