//! Scattering as the thesis has it (equations 5.2 to 5.4): each voxel turns the light of the stars by the table of its depth.
//!
//! Light that goes from voxel to voxel is left out, and so the picture depends on the grid: no refinement makes it right.

use glam::DVec3;

use super::camera::Ray;
use super::light::column;
use super::light::lattice::Lattice;
use super::model::Scattering;
use super::scene::{Dust, Scene};
use super::table::Table;
use super::volume::Volume;

/// Which of the thesis' formulas are taken as they are printed. All false is the corrected form.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Literal {
    /// Equation 5.2: the light of the table is multiplied by the albedo once more, although each scattering in the table has taken it.
    pub albedo: bool,
    /// Equation 5.7: the depth of a voxel is that of scattering, and the ray of the eye is dimmed by depth / albedo; the way from the star
    /// keeps the depth itself, as 5.2 has it.
    pub depth: bool,
}

impl Literal {
    /// The dust as the ray of the eye meets it: with [`Literal::depth`] its extinction is that of before over the albedo. Dust that does not
    /// scatter has no such depth, and keeps its own.
    #[must_use]
    pub fn seen(self, scene: &Scene) -> Scene {
        let Dust { extinction, albedo, phase } = scene.dust().clone();
        let factor = if self.depth && albedo > 0.0 { 1.0 / albedo } else { 1.0 };
        let dust = Dust { extinction: extinction.iter().map(|k| k * factor).collect(), albedo, phase };
        Scene::new(dust, scene.stars().to_vec()).unwrap_or_else(|_beyond| scene.clone())
    }
}

/// Below this depth a voxel is as thin as the table can tell.
const THIN: f64 = 1e-9;

/// The model of the thesis.
///
/// ```text
/// S_b = P(t_b, cos) / (t_b c) * I_b / r^2 * exp(-kappa_b c*)       t_b: extinction depth of a voxel's edge
/// ```
///
/// P is the table's share per steradian, c the mean chord of its voxel. P holds what absorption takes, so that the albedo of the thesis'
/// equation 5.2 is not applied again. In thin dust this is single scattering.
pub struct Voxelwise<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    table: &'a Table,
    lattice: Option<&'a Lattice>,
    /// Edge of a cube of a voxel's volume.
    edge: f64,
    least: f64,
    /// No source is larger, per irradiance.
    most: f64,
    /// By what literal formulas have more or less of than the corrected one, for each unit of the eye's extinction.
    factor: f64,
}

impl<'a> Voxelwise<'a> {
    /// The model of a table made for this dust; with columns to the stars from a lattice, or computed for every point.
    #[must_use]
    pub fn new(volume: &'a Volume, scene: &'a Scene, table: &'a Table, lattice: Option<&'a Lattice>) -> Voxelwise<'a> {
        let voxel = volume.voxel();
        let solid_angles = table.parameters().solid_angles();
        // Rows are linear in depth: between two of them share over depth is not above the larger of both.
        let rows = table.parameters().depths;
        let depth = |row: usize| table.deepest() * row as f64 / (rows - 1) as f64;
        let row = |row: usize| {
            let bins = table.bins(row).iter().zip(&solid_angles).map(|(bin, angle)| bin / angle);
            bins.fold(0.0, f64::max) / (depth(row) * table.chord())
        };
        Voxelwise {
            volume,
            scene,
            table,
            lattice,
            edge: (voxel.x * voxel.y * voxel.z).cbrt(),
            least: 1e-6 * voxel.min_element(),
            most: (1..rows).map(row).fold(0.0, f64::max),
            factor: 1.0,
        }
    }

    /// The same with formulas as they are printed. The picture must be drawn with [`Literal::seen`] for its dust.
    #[must_use]
    pub fn literal(self, literal: Literal) -> Voxelwise<'a> {
        let albedo = self.scene.dust().albedo;
        // What a voxel sends out is the same however its depth is read: for each unit of a depth that is larger by 1/albedo, less by albedo.
        let depth = if literal.depth && albedo > 0.0 { albedo } else { 1.0 };
        Voxelwise { factor: depth * if literal.albedo { albedo } else { 1.0 }, ..self }
    }
}

impl Scattering for Voxelwise<'_> {
    fn name(&self) -> &'static str {
        "table"
    }

    fn source(&self, point: DVec3, towards: DVec3, out: &mut [f64]) {
        out.fill(0.0);
        let density = self.volume.at(point);
        for (index, star) in self.scene.stars().iter().enumerate() {
            let way = point - star.position;
            let distance = way.length().max(self.least);
            let column = match self.lattice {
                Some(lattice) => lattice.column(self.volume, index, point),
                None => column(self.volume, star.position, point),
            };
            let cosine = way.dot(towards) / distance;
            let bands = star.intensity.iter().zip(&self.scene.dust().extinction);
            for (sum, (intensity, extinction)) in out.iter_mut().zip(bands) {
                let depth = (extinction * density * self.edge).max(THIN);
                let turned = self.factor * self.table.per_steradian(depth, cosine) / (depth * self.table.chord());
                *sum += turned * intensity / (distance * distance) * (-extinction * column).exp();
            }
        }
    }

    fn ceiling(&self, ray: &Ray, from: f64, to: f64, out: &mut [f64]) {
        out.fill(0.0);
        for star in self.scene.stars() {
            let way = ray.origin - star.position;
            let nearest = (-way.dot(ray.direction)).clamp(from, to);
            let least = (way + ray.direction * nearest).length().max(self.least);
            for (sum, intensity) in out.iter_mut().zip(&star.intensity) {
                *sum += self.factor * self.most * intensity / (least * least);
            }
        }
    }

    /// The noise of the table. What the model leaves out is not in it: `scotopic report nebula` measures that.
    fn error(&self) -> f64 {
        self.table.worst_error()
    }
}
