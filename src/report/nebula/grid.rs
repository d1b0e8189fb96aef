//! What the table of the thesis makes of one smooth cloud on grids of more and more voxels: it holds the light that scatters again within a voxel and
//! leaves out what goes from voxel to voxel, so that its picture depends on the grid.

use glam::DVec3;

use super::known::{StudyError, refused, scene};
use super::{WISH, draw};
use crate::physics::dust::model::Together;
use crate::physics::dust::multiple::{Settings, gather};
use crate::physics::dust::single::Single;
use crate::physics::dust::table::Table;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Voxelwise;

/// Extinction in the cloud's middle, per unit of length.
const EXTINCTION: f64 = 8.0;

/// Totals of pictures of the cloud on one grid.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Totals {
    /// Voxels along an edge.
    pub voxels: usize,
    /// Depth of the deepest voxel along its edge.
    pub depth: f64,
    /// Exact single scattering.
    pub single: f64,
    /// The table.
    pub table: f64,
    /// Multiple scattering.
    pub multiple: f64,
}

/// A ball whose density falls as exp(-(r/0.5)^2), with a hole of 0.2 about the star in its middle.
fn cloud(voxels: usize) -> Result<Volume, StudyError> {
    let at = |i: usize| (i as f64 + 0.5) / voxels as f64 * 2.0 - 1.0;
    let density = (0..voxels.pow(3)).map(|i| {
        let radius = DVec3::new(at(i % voxels), at(i / voxels % voxels), at(i / voxels / voxels)).length();
        ((-(radius / 0.5).powi(2)).exp() * ((radius - 0.2) / 0.2).clamp(0.0, 1.0)) as f32
    });
    Volume::new([voxels; 3], DVec3::splat(2.0), density.collect()).map_err(refused)
}

/// The cloud on grids of 8 to 64 voxels.
///
/// # Errors
/// Never.
pub fn totals(table: &Table) -> Result<Vec<Totals>, StudyError> {
    let scene = scene(vec![EXTINCTION], DVec3::ZERO)?;
    let mut all = Vec::new();
    for voxels in [8, 16, 32, 64] {
        let volume = cloud(voxels)?;
        let single = Single::exact(&volume, &scene);
        let voxelwise = Voxelwise::new(&volume, &scene, table, None);
        let field =
            gather(&volume, &scene, &Settings { flights: 300_000, ..Settings::fitting(&volume) }).map_err(refused)?;
        let seen = field.along(DVec3::Z);
        let together = Together::new("multiple", vec![&single, &seen]);
        let total = |model| -> Result<f64, StudyError> {
            let picture = draw(&volume, &scene, model, 48, &WISH)?;
            Ok(picture.radiance[0].iter().map(|value| f64::from(*value)).sum::<f64>() / 48.0 / 48.0)
        };
        let densest = volume.density().iter().copied().fold(0.0, f32::max);
        all.push(Totals {
            voxels,
            depth: EXTINCTION * f64::from(densest) * 2.0 / voxels as f64,
            single: total(&single)?,
            table: total(&voxelwise)?,
            multiple: total(&together)?,
        });
    }
    Ok(all)
}

/// The totals as a table for people.
#[must_use]
pub fn text(all: &[Totals]) -> String {
    let mut text = format!(
        "One cloud on finer and finer grids: mean radiance by each model\n  {:>7} {:>14} {:>9} {:>9} {:>9} {:>16}\n",
        "voxels", "depth of one", "single", "table", "multiple", "table/multiple"
    );
    for t in all {
        let share = t.table / t.multiple;
        text += &format!(
            "  {:>5}^3 {:>14.3} {:>9.5} {:>9.5} {:>9.5} {share:>16.3}\n",
            t.voxels, t.depth, t.single, t.table, t.multiple
        );
    }
    text
}
