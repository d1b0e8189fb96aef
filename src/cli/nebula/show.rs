//! `scotopic nebula show`: what a volume holds, and its planes as pictures.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use serde_json::json;

use super::files::VolumeArguments;
use crate::cli::{Failure, answer, answer_json, note};
use crate::physics::dust::bricks::Bricks;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::volume::slice::{Axis, Plane, column, slice};
use crate::physics::dust::volume::statistics::Statistics;
use crate::picture::{png, srgb};

/// The volume, and the planes that are wanted.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula show V.fits\n  \
    scotopic nebula show V.fits --out planes/                     the middle slice and the column along each axis\n  \
    scotopic nebula show V.npy --slice z=40 --slice z=80 --column x --out planes/\n\n\
    Pictures are seen from the positive end of their axis: for z, +y is up and +x right. The most dust of each is white.\n\
    Densities are relative and columns are density times length: times --extinction they are optical depths.")]
pub struct Arguments {
    #[command(flatten)]
    volume: VolumeArguments,
    /// A plane of voxels: an axis for its middle, or axis=index; again for more
    #[arg(long = "slice", value_name = "AXIS[=INDEX]", requires = "out")]
    slices: Vec<Slice>,
    /// All planes along an axis added up; again for more
    #[arg(long = "column", value_name = "AXIS", requires = "out")]
    columns: Vec<Axis>,
    /// Folder for the pictures; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Extinction per unit of length at density 1: columns are told as optical depths
    #[arg(long, value_name = "K", default_value_t = 1.0, allow_negative_numbers = true)]
    extinction: f64,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// A slice that is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Slice {
    axis: Axis,
    index: Option<usize>,
}

impl FromStr for Slice {
    type Err = String;

    fn from_str(text: &str) -> Result<Slice, String> {
        let (axis, index) = text.split_once('=').map_or((text, None), |(axis, index)| (axis, Some(index)));
        let number = |index: &str| index.parse().map_err(|_no_index| format!("'{text}': give such as z or z=40"));
        Ok(Slice { axis: axis.parse()?, index: index.map(number).transpose()? })
    }
}

/// Answers it.
///
/// # Errors
/// The volume cannot be read, a plane is outside it, or a picture could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !(arguments.extinction.is_finite() && arguments.extinction >= 0.0) {
        return Err(Failure::asked(format!("an extinction of {}: give a number of 0 or more", arguments.extinction)));
    }
    let volume = arguments.volume.open()?;
    let mut pictures = Vec::new();
    if let Some(folder) = &arguments.out {
        std::fs::create_dir_all(folder).map_err(|error| Failure::failed(format!("{}: {error}", folder.display())))?;
        pictures = planes(arguments, &volume)?
            .into_iter()
            .map(|(name, plane)| save(&folder.join(name), &plane))
            .collect::<Result<_, _>>()?;
    }
    let numbers = volume.statistics();
    let empty = Bricks::of(&volume).empty_share();
    if numbers.most == 0.0 {
        note("this volume has no dust at all");
    }
    if arguments.json {
        return answer_json(&as_json(arguments, &volume, &numbers, empty, &pictures));
    }
    for picture in &pictures {
        eprintln!("wrote {}", picture.display());
    }
    answer(&as_text(arguments, &volume, &numbers, empty))
}

/// The planes that are wanted, with the names of their files.
fn planes(arguments: &Arguments, volume: &Volume) -> Result<Vec<(String, Plane)>, Failure> {
    let axes = [Axis::X, Axis::Y, Axis::Z];
    let (mut slices, mut columns) = (arguments.slices.clone(), arguments.columns.clone());
    if slices.is_empty() && columns.is_empty() {
        slices = axes.map(|axis| Slice { axis, index: None }).to_vec();
        columns = axes.to_vec();
    }
    let mut planes = Vec::new();
    for Slice { axis, index } in slices {
        let side = volume.size()[axis.index()];
        let index = index.unwrap_or(side / 2);
        let name = axis.name();
        let plane = slice(volume, axis, index)
            .ok_or_else(|| Failure::asked(format!("{name}={index}: the volume has {name} from 0 to {}", side - 1)))?;
        planes.push((format!("slice-{name}-{index:04}.png"), plane));
    }
    planes.extend(columns.into_iter().map(|axis| (format!("column-{}.png", axis.name()), column(volume, axis))));
    Ok(planes)
}

/// Writes a plane, grey, the most dust white.
fn save(path: &Path, plane: &Plane) -> Result<PathBuf, Failure> {
    let most = plane.values.iter().copied().fold(0.0, f32::max);
    let light = |value: &f32| if most > 0.0 { value / most } else { 0.0 };
    let codes: Vec<[u8; 3]> = plane.values.iter().map(|value| [srgb::to_byte(light(value)); 3]).collect();
    let bytes = png::encode_codes(plane.width, plane.height, &codes).map_err(Failure::failed)?;
    std::fs::write(path, bytes).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))?;
    Ok(path.to_path_buf())
}

fn as_text(arguments: &Arguments, volume: &Volume, numbers: &Statistics, empty: f64) -> String {
    let [x, y, z] = volume.size();
    let edges = volume.edges();
    let [faint, median, dense] = numbers.filled_quantiles;
    let centre = numbers.centre_of_mass.map_or("nowhere".to_owned(), |c| format!("{:.3}, {:.3}, {:.3}", c.x, c.y, c.z));
    let depths: Vec<String> = [Axis::X, Axis::Y, Axis::Z]
        .into_iter()
        .zip(numbers.columns)
        .map(|(axis, columns)| {
            let (central, most) = (columns.central * arguments.extinction, columns.most * arguments.extinction);
            format!("  along {}   median in the middle {central:.4}, most {most:.4}", axis.name())
        })
        .collect();
    format!(
        "{}: {x} x {y} x {z} voxels in a box of {} x {} x {}\n\
         density     {} to {}, mean {:.5}\n\
         dust in     {:.1} % of the voxels; of those 5 % are below {faint:.4}, half below {median:.4}, 95 % below {dense:.4}\n\
         bricks      {:.1} % of those of 8 x 8 x 8 voxels have none and cost nothing\n\
         centre of mass  {centre}\n\
         optical depth with an extinction of {}\n{}",
        arguments.volume.volume.display(),
        edges.x,
        edges.y,
        edges.z,
        numbers.least,
        numbers.most,
        numbers.mean,
        100.0 * numbers.filled,
        100.0 * empty,
        arguments.extinction,
        depths.join("\n"),
    )
}

fn as_json(
    arguments: &Arguments,
    volume: &Volume,
    numbers: &Statistics,
    empty: f64,
    pictures: &[PathBuf],
) -> serde_json::Value {
    json!({
        "size": volume.size(),
        "edges": volume.edges().to_array(),
        "least": numbers.least,
        "most": numbers.most,
        "mean": numbers.mean,
        "filled": numbers.filled,
        "filled_quantiles": {"0.05": numbers.filled_quantiles[0], "0.5": numbers.filled_quantiles[1], "0.95": numbers.filled_quantiles[2]},
        "empty_bricks": empty,
        "centre_of_mass": numbers.centre_of_mass.map(|centre| centre.to_array()),
        "extinction": arguments.extinction,
        "median_central_depth": numbers.columns.map(|columns| columns.central * arguments.extinction),
        "most_depth": numbers.columns.map(|columns| columns.most * arguments.extinction),
        "pictures": pictures.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_axes_with_or_without_an_index() {
        assert_eq!("z".parse(), Ok(Slice { axis: Axis::Z, index: None }));
        assert_eq!("x=40".parse(), Ok(Slice { axis: Axis::X, index: Some(40) }));
        for wrong in ["w", "z=", "z=-1", ""] {
            assert!(wrong.parse::<Slice>().is_err(), "{wrong}");
        }
    }
}
