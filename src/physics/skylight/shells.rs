//! The air as concentric shells of constant index and constant scattering, and walks through them: straight inside a shell,
//! bent at its borders by Snell's law.

use glam::DVec3;

use super::{Scene, SkyError};
use crate::physics::air::ciddor::Dispersion;
use crate::physics::rayleigh;
use crate::physics::refraction::ray::Absorber;

/// Above this there is no air, metres.
pub const TOP_M: f64 = 1e5;

/// Fine borders: (up to this height, thickness), metres.
const FINE: [(f64, f64); 7] =
    [(60.0, 6.0), (240.0, 30.0), (2e3, 110.0), (12e3, 250.0), (35e3, 1e3), (60e3, 2.5e3), (TOP_M, 5e3)];
/// Coarse borders, for light that is smooth anyway.
const COARSE: [(f64, f64); 4] = [(2e3, 500.0), (12e3, 1e3), (36e3, 4e3), (TOP_M, 16e3)];

/// One shell, at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shell {
    /// Refractivity n - 1.
    pub refractivity: f64,
    /// Scattering by molecules, per metre.
    pub rayleigh_per_m: f64,
    /// Scattering by haze, per metre.
    pub haze_per_m: f64,
    /// Mean cosine of the haze's scattering.
    pub asymmetry: f64,
    /// Absorption by haze and ozone, per metre.
    pub absorption_per_m: f64,
}

impl Shell {
    /// Extinction, per metre.
    #[must_use]
    pub fn extinction(&self) -> f64 {
        self.rayleigh_per_m + self.haze_per_m + self.absorption_per_m
    }
}

/// The shells, from the ground up.
#[derive(Debug, Clone, PartialEq)]
pub struct Shells {
    ground_m: f64,
    /// Heights of the borders: one more than shells.
    borders_m: Vec<f64>,
    shells: Vec<Shell>,
}

impl Shells {
    /// Shells as fine as the view ray needs them.
    ///
    /// # Errors
    /// The wavelength is outside what the index is known for.
    pub fn fine(scene: &Scene) -> Result<Shells, SkyError> {
        Shells::new(scene, &FINE)
    }

    /// Shells for light scattered before.
    ///
    /// # Errors
    /// As [`Shells::fine`].
    pub fn coarse(scene: &Scene) -> Result<Shells, SkyError> {
        Shells::new(scene, &COARSE)
    }

    fn new(scene: &Scene, steps: &[(f64, f64)]) -> Result<Shells, SkyError> {
        let mut borders_m = vec![0.0];
        for &(up_to_m, thickness_m) in steps {
            let low_m = borders_m[borders_m.len() - 1];
            let count = ((up_to_m - low_m) / thickness_m).round().max(1.0) as usize;
            borders_m.extend((1..=count).map(|k| low_m + (up_to_m - low_m) * k as f64 / count as f64));
        }
        if let Some(column) = scene.aerosol {
            borders_m.extend(column.knots_m().iter().filter(|z| (0.0..TOP_M).contains(*z)));
        }
        borders_m.sort_by(f64::total_cmp);
        borders_m.dedup_by(|a, b| (*a - *b).abs() < 1.0);
        let dispersion = Dispersion::new(scene.wavelength_nm, scene.profile.co2_ppm)?;
        let molecule_m2 = rayleigh::cross_section_m2(scene.wavelength_nm, scene.profile.co2_ppm);
        let shell = |low_m: f64, high_m: f64| {
            let middle_m = 0.5 * (low_m + high_m);
            // The mean of an exponential over a thick shell, by Simpson's rule.
            let mean = |f: &dyn Fn(f64) -> f64| (f(low_m) + 4.0 * f(middle_m) + f(high_m)) / 6.0;
            let parcel = |z: f64| scene.profile.parcel(z);
            let inside = |z: f64| z.clamp(low_m + 1e-3, high_m - 1e-3);
            let haze = |z: f64| scene.aerosol.map(|column| column.at(1e-3 * inside(z))).unwrap_or_default();
            let ozone = |z: f64| scene.ozone.map_or(0.0, |ozone| ozone.per_m(z));
            Shell {
                refractivity: mean(&|z| dispersion.refractivity(&parcel(z))),
                rayleigh_per_m: mean(&|z| {
                    let parcel = parcel(z);
                    molecule_m2 * rayleigh::molecules_per_m3(parcel.temperature_k, parcel.pressure_pa)
                }),
                haze_per_m: 1e-3 * mean(&|z| haze(z).scattering_per_km),
                asymmetry: haze(middle_m).asymmetry,
                absorption_per_m: 1e-3 * mean(&|z| haze(z).absorption_per_km) + mean(&ozone),
            }
        };
        let shells = borders_m.windows(2).map(|pair| shell(pair[0], pair[1])).collect();
        Ok(Shells { ground_m: scene.earth_radius_m, borders_m, shells })
    }

    /// A shell by its number from the ground.
    #[must_use]
    pub fn shell(&self, index: usize) -> &Shell {
        &self.shells[index.min(self.shells.len() - 1)]
    }

    /// The borders' heights, metres.
    #[must_use]
    pub fn borders_m(&self) -> &[f64] {
        &self.borders_m
    }

    /// Radius of the globe, metres.
    #[must_use]
    pub fn ground_m(&self) -> f64 {
        self.ground_m
    }

    /// The height of a point, metres.
    #[must_use]
    pub fn height_m(&self, point: DVec3) -> f64 {
        point.length() - self.ground_m
    }

    /// The shell in which a height lies; on a border the upper one.
    #[must_use]
    pub fn index_at(&self, height_m: f64) -> usize {
        self.borders_m.partition_point(|z| *z <= height_m).saturating_sub(1).min(self.shells.len() - 1)
    }
}

/// Where a step ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// At a border to another shell, or thrown back from it.
    Shell,
    /// At the top of the air.
    Top,
    /// On the ground.
    Ground,
}

/// Light on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    /// Where it is; the centre of the globe is the origin, metres.
    pub position: DVec3,
    /// Where it goes, of length one.
    pub direction: DVec3,
    /// The shell it is in.
    pub shell: usize,
}

impl Walk {
    /// Light that starts at a point in a direction.
    #[must_use]
    pub fn new(shells: &Shells, position: DVec3, direction: DVec3) -> Walk {
        let mut shell = shells.index_at(shells.height_m(position));
        // On a border and going down: the shell below.
        let on_border = (shells.height_m(position) - shells.borders_m[shell]).abs() < 1e-6;
        if on_border && position.dot(direction) < 0.0 && shell > 0 {
            shell -= 1;
        }
        Walk { position, direction, shell }
    }

    /// The length of the way to the border of this shell, metres, and whether that is the inner border.
    #[must_use]
    pub fn reach(&self, shells: &Shells) -> (f64, bool) {
        let along = self.position.dot(self.direction);
        let radius = self.position.length();
        // |p|^2 - r^2 as a product, which keeps the digits.
        let over = |border: f64| (radius - shells.ground_m - border) * (radius + shells.ground_m + border);
        let inner = along * along - over(shells.borders_m[self.shell]);
        if along < 0.0 && inner > 0.0 {
            return ((-along - inner.sqrt()).max(0.0), true);
        }
        let outer = along * along - over(shells.borders_m[self.shell + 1]);
        ((-along + outer.max(0.0).sqrt()).max(0.0), false)
    }

    /// Goes on inside this shell.
    pub fn go(&mut self, length_m: f64) {
        self.position += self.direction * length_m;
    }

    /// Goes to the border of this shell and over it: the length of the way, metres, and where it ended.
    pub fn step(&mut self, shells: &Shells) -> (f64, Exit) {
        let (length, inwards) = self.reach(shells);
        self.go(length);
        (length, self.cross(shells, inwards))
    }

    /// Goes over the border that it stands on.
    pub fn cross(&mut self, shells: &Shells, inwards: bool) -> Exit {
        let border = if inwards { self.shell } else { self.shell + 1 };
        let up = self.position.normalize();
        // Rounding must not leave it beside the border.
        self.position = up * (shells.ground_m + shells.borders_m[border]);
        if border == 0 {
            return Exit::Ground;
        }
        if border == shells.shells.len() {
            return Exit::Top;
        }
        let next = if inwards { self.shell - 1 } else { self.shell + 1 };
        let (from, to) = (shells.shells[self.shell].refractivity, shells.shells[next].refractivity);
        let ratio = 1.0 + (from - to) / (1.0 + to);
        let along = self.direction.dot(up);
        let square = 1.0 - ratio * ratio * (1.0 - along * along);
        if square <= 0.0 {
            // Total reflection: a duct.
            self.direction = (self.direction - up * (2.0 * along)).normalize();
            return Exit::Shell;
        }
        let normal = up * along.signum();
        self.direction = (self.direction * ratio + normal * (square.sqrt() - ratio * along.abs())).normalize();
        self.shell = next;
        Exit::Shell
    }
}
