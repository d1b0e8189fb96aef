//! Lehn's parabolas: in each layer the index is linear, and ray and globe are parabolas.
//!
//! ```text
//! z(x) = z0 + x tan a + (1/r - c) x²/(2 K)       c = -(nmax - nmin)/(n̄ (Hmax - Hmin)) = K/κ       R = Σ c x
//! ```
//!
//! Lehn (1985), Applied Optics 24, "A simple parabolic model for optics of the atmospheric surface layer", as in Bruton
//! (1996) and the thesis, section 4.4.4. K is not printed in the thesis ("depends on the initial parameters"); a parabola
//! fits a ray at altitude a where K = cos² a, so K is taken at the eye for the thesis' layers, and anew in each layer for
//! those aligned with the knots.

use std::sync::OnceLock;

use super::medium::Medium;
use super::{Crossing, Depths, Launch, Method, Outcome, Ray, RayError, Tracer, admitted};
use crate::units::Angle;

/// Where the thesis lets the air end, metres.
const THESIS_TOP_M: f64 = 35_000.0;

/// How the layers are laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grid {
    /// Equal numbers of molecules in each, up to 35 km: the thesis'.
    EqualMolecules,
    /// Borders on the knots of the profile and between them graded by curvature, up to the top of the air.
    Knots,
}

/// Lehn's method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lehn {
    /// How the layers are laid.
    pub grid: Grid,
    /// How many; `None` for as many as the tolerance needs, up to 30,000.
    pub layers: Option<usize>,
}

impl Method for Lehn {
    fn name(&self) -> &'static str {
        match self.grid {
            Grid::EqualMolecules => "lehn",
            Grid::Knots => "lehn-knots",
        }
    }

    fn prepare<'a>(&self, medium: &'a Medium<'a>, tolerance: Angle) -> Result<Box<dyn Tracer + 'a>, RayError> {
        let ladder = match self.layers {
            Some(layers) if !(2..=1_000_000).contains(&layers) => return Err(RayError::Layers(layers)),
            Some(layers) => vec![layers / 2, layers],
            None => vec![150, 300, 1000, 3000, 10_000, 30_000],
        };
        let tables = ladder.iter().map(|_| OnceLock::new()).collect();
        let tracer = Prepared { medium, grid: self.grid, tolerance: admitted(tolerance)?, ladder, tables };
        // The tables that every ray needs are made now.
        tracer.table(0);
        tracer.table(1);
        Ok(Box::new(tracer))
    }
}

struct Prepared<'a> {
    medium: &'a Medium<'a>,
    grid: Grid,
    tolerance: f64,
    /// Numbers of layers, each finer than the one before.
    ladder: Vec<usize>,
    tables: Vec<OnceLock<Table>>,
}

/// One layer.
#[derive(Debug, Clone, Copy)]
struct Layer {
    low_m: f64,
    high_m: f64,
    /// -(dn/dz)/n, per metre.
    curvature: f64,
    /// Mean extinctions, per metre.
    extinction: Depths,
}

/// All layers, and the refractivity that is left above the last.
struct Table {
    layers: Vec<Layer>,
    left_over: f64,
}

impl Tracer for Prepared<'_> {
    fn trace(&self, launch: &Launch) -> Result<Ray, RayError> {
        self.medium.admit(launch)?;
        let mut before = self.follow(self.table(0), launch)?;
        // Climb the ladder until the number of layers makes no difference any more.
        for rung in 1..self.ladder.len() {
            let table = self.table(rung);
            let mut ray = self.follow(table, launch)?;
            let change = (ray.refraction - before.refraction).abs();
            ray.steps += before.steps;
            if change.to_radians() <= self.tolerance || rung + 1 == self.ladder.len() {
                ray.believed_error += change;
                return Ok(ray);
            }
            before = ray;
        }
        Ok(before)
    }
}

impl Prepared<'_> {
    fn table(&self, rung: usize) -> &Table {
        self.tables[rung].get_or_init(|| {
            let layers = self.ladder[rung].max(1);
            match self.grid {
                Grid::EqualMolecules => self.fill(&self.equal_molecules(layers)),
                Grid::Knots => self.fill(&self.on_knots(layers)),
            }
        })
    }

    /// Borders between which pressure falls by equal steps, that is, between which there are equal numbers of molecules.
    fn equal_molecules(&self, layers: usize) -> Vec<f64> {
        let profile = self.medium.profile();
        let top = self.medium.top_m.min(THESIS_TOP_M);
        let (bottom_pa, top_pa) = (profile.parcel(0.0).pressure_pa, profile.parcel(top).pressure_pa);
        (0..=layers)
            .map(|i| match i {
                0 => 0.0,
                i if i == layers => top,
                i => profile.height_of_pressure_m(bottom_pa + (top_pa - bottom_pa) * i as f64 / layers as f64),
            })
            .collect()
    }

    /// The profile's knots, and between them borders as dense as a layer of constant curvature needs.
    ///
    /// The error of a layer of thickness h grows as h³ times the change of curvature times the change of 1/tan a; equal
    /// errors are made with a density of layers of its cube root. Curvature falls with the air, and 1/tan a of a level ray
    /// as z^(-1/2):
    ///
    /// ```text
    /// density ~ |dn/dz|^(1/3) (z + 1 m)^(-1/2)
    /// ```
    fn on_knots(&self, layers: usize) -> Vec<f64> {
        const SAMPLES: usize = 32;
        let pieces = self.medium.pieces();
        // The density, summed up from the lower border of each piece over samples even in the root of height.
        let sums: Vec<Vec<(f64, f64)>> = pieces
            .iter()
            .map(|piece| {
                let root = |z: f64| (z + 1.0).sqrt();
                let (low, high) = (root(piece.low_m), root(piece.high_m));
                let mut sum = 0.0;
                let mut samples = vec![(piece.low_m, 0.0)];
                for i in 0..SAMPLES {
                    let at = |share: f64| (low + (high - low) * share).powi(2) - 1.0;
                    let middle = at((i as f64 + 0.5) / SAMPLES as f64);
                    let density = self.medium.at(piece.layer, middle).slope.abs().cbrt() + 1e-9;
                    sum += density * (high - low) / SAMPLES as f64;
                    samples.push((at((i + 1) as f64 / SAMPLES as f64), sum));
                }
                samples
            })
            .collect();
        let last = |samples: &[(f64, f64)]| samples.last().map_or(0.0, |sample| sample.1);
        let total: f64 = sums.iter().map(|samples| last(samples)).sum();
        let mut borders = vec![0.0];
        // Thin pieces are those that make mirages: each gets a few layers whatever its share.
        let few = (layers / (2 * pieces.len())).clamp(1, 16);
        let rest = layers.saturating_sub(few * pieces.len()) as f64;
        for (piece, samples) in pieces.iter().zip(&sums) {
            let parts = few + (rest * last(samples) / total).round() as usize;
            for part in 1..parts {
                let wanted = last(samples) * part as f64 / parts as f64;
                let above = samples.partition_point(|sample| sample.1 < wanted).clamp(1, SAMPLES);
                let ((z0, s0), (z1, s1)) = (samples[above - 1], samples[above]);
                borders.push(z0 + (z1 - z0) * (wanted - s0) / (s1 - s0));
            }
            borders.push(piece.high_m);
        }
        borders
    }

    /// What each layer between borders does to light.
    fn fill(&self, borders: &[f64]) -> Table {
        let profile = self.medium.profile();
        let top = borders.last().copied().unwrap_or_default();
        let layers = borders
            .windows(2)
            .map(|pair| {
                let (low_m, high_m) = (pair[0], pair[1]);
                let middle_m = 0.5 * (low_m + high_m);
                let [low, middle, high] = [low_m, middle_m, high_m].map(|z| self.medium.at(profile.layer_at(z), z));
                let curvature =
                    -(high.refractivity - low.refractivity) / (1.0 + middle.refractivity) / (high_m - low_m);
                // Simpson's mean of what the molecules do; haze and ozone as they are in the middle.
                let mut extinction = self.medium.extinctions(&middle, middle_m);
                extinction.rayleigh = (low.rayleigh_per_m + 4.0 * middle.rayleigh_per_m + high.rayleigh_per_m) / 6.0;
                Layer { low_m, high_m, curvature, extinction }
            })
            .collect();
        let left_over = if top < self.medium.top_m { self.medium.refractivity(top).0 } else { 0.0 };
        Table { layers, left_over }
    }

    /// Follows a ray from layer to layer.
    fn follow(&self, table: &Table, launch: &Launch) -> Result<Ray, RayError> {
        let layers = &table.layers;
        let top_m = layers.last().map_or(0.0, |layer| layer.high_m);
        if launch.height_m >= top_m {
            return Err(RayError::Height { height_m: launch.height_m, top_m });
        }
        let mut z = launch.height_m;
        let mut index = layers.partition_point(|layer| layer.low_m <= z).saturating_sub(1);
        let mut slope = launch.apparent_altitude.tan();
        let at_eye = 1.0 + slope * slope;
        let (mut refraction, mut path_length_m, mut depths) = (0.0, 0.0, Depths::default());
        let mut crossings = Vec::with_capacity(layers.len() - index);
        // A ray that is level on a border with a duct above and none below goes nowhere: its passages have no length.
        let (mut tangent_height_m, mut turns, mut idle) = (None, 0, 0);
        let outcome = loop {
            let layer = &layers[index];
            let per_k = if self.grid == Grid::EqualMolecules { at_eye } else { 1.0 + slope * slope };
            let bend = (1.0 / (self.medium.earth_radius_m + z) - layer.curvature) * per_k;
            let upwards = if slope == 0.0 { bend >= 0.0 } else { slope > 0.0 };
            let border = if upwards { layer.high_m } else { layer.low_m };
            let squared = slope * slope + 2.0 * bend * (border - z);
            // Path 1 reaches the border ahead; path 2 turns before it and comes back to the height it came from.
            let (x, end, slope_after) = if border == z {
                (0.0, border, slope)
            } else if squared >= 0.0 {
                let root = squared.sqrt().copysign(if upwards { 1.0 } else { -1.0 });
                (2.0 * (border - z) / (slope + root), border, root)
            } else {
                turns += 1;
                let turn = z - slope * slope / (2.0 * bend);
                if !upwards {
                    tangent_height_m = Some(turn);
                }
                (-2.0 * slope / bend, z, -slope)
            };
            let crossing = self.pass(layer, z, end, x, slope);
            refraction += crossing.refraction.to_radians();
            path_length_m += crossing.path_m;
            depths.rayleigh += crossing.depths.rayleigh;
            depths.aerosol += crossing.depths.aerosol;
            depths.ozone += crossing.depths.ozone;
            if x > 0.0 {
                crossings.push(crossing);
                idle = 0;
            } else {
                idle += 1;
            }
            let turned = squared < 0.0 && border != z;
            (z, slope) = (end, slope_after);
            if turns >= 2 || idle >= 4 {
                break Outcome::Trapped;
            }
            // Leave through the border ahead; after a turn, through the one behind if the ray stands on it.
            let up = if turned { !upwards } else { upwards };
            if up && z >= layer.high_m {
                index += 1;
                if index == layers.len() {
                    break Outcome::Escaped;
                }
            } else if !up && z <= layer.low_m {
                match index.checked_sub(1) {
                    Some(below) => index = below,
                    None => break Outcome::Ground,
                }
            }
        };
        // What the air above the last layer would still have bent is part of the error.
        let missed = if outcome == Outcome::Escaped { table.left_over / slope } else { 0.0 };
        let refraction = Angle::radians(refraction);
        Ok(Ray {
            outcome,
            refraction,
            true_altitude: launch.apparent_altitude - refraction,
            path_length_m,
            tangent_height_m,
            depths,
            steps: crossings.len(),
            crossings,
            evaluations: 0,
            believed_error: Angle::radians(missed.abs()),
        })
    }

    /// What one passage adds. The length is that of the arc (the thesis' eq. 4.1):
    ///
    /// ```text
    /// Δγ = 2 κ asin(d/(2 κ)),   d = √(Δx² + (Δz - Δx²/(2 R))²)
    /// ```
    fn pass(&self, layer: &Layer, from: f64, to: f64, x: f64, slope: f64) -> Crossing {
        let drop = x * x / (2.0 * (self.medium.earth_radius_m + from));
        let chord = x.hypot(to - from - drop);
        // The curvature of the ray itself: that of a level one times cos a.
        let half = 0.5 * chord * layer.curvature / (1.0 + slope * slope).sqrt();
        let path_m = if half.abs() < 1e-6 { chord } else { chord * half.clamp(-1.0, 1.0).asin() / half };
        let extinction = &layer.extinction;
        Crossing {
            low_m: from.min(to),
            high_m: from.max(to),
            path_m,
            refraction: Angle::radians(layer.curvature * x),
            depths: Depths {
                rayleigh: extinction.rayleigh * path_m,
                aerosol: extinction.aerosol * path_m,
                ozone: extinction.ozone * path_m,
            },
        }
    }
}
