//! Volumes in files, by the ending of their names: `.fits`, `.npy`, `.nrrd`, `.nhdr` with a file of raw numbers beside it.

use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;

use super::triple::Edges;
use crate::cli::Failure;
use crate::physics::dust::volume::Volume;
use crate::picture::cube::{Cube, CubeError};
use crate::picture::{fits, npy, nrrd};

/// The longest edge of a box where neither file nor flag says it: from -1 to 1.
pub const USUAL_EDGE: f64 = 2.0;

/// A volume to be read.
#[derive(Debug, Clone, Args)]
pub struct VolumeArguments {
    /// The dust: .fits, .npy ([z, y, x]), .nrrd or .nhdr
    #[arg(value_name = "VOLUME")]
    pub volume: PathBuf,
    /// Edge of its box (the longest, the others by the voxels), or all three [default: what the file says, else 2]
    #[arg(long, value_name = "LENGTH|X,Y,Z", allow_hyphen_values = true)]
    pub edge: Option<Edges>,
}

impl VolumeArguments {
    /// Reads it.
    ///
    /// # Errors
    /// As [`open`].
    pub fn open(&self) -> Result<Volume, Failure> {
        open(&self.volume, self.edge)
    }
}

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Fits,
    Npy,
    Nrrd,
    /// The header alone; the numbers in a file beside it.
    Nhdr,
}

impl Format {
    fn of(path: &Path) -> Result<Format, Failure> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "fits" | "fit" | "fts" => Ok(Format::Fits),
            "npy" => Ok(Format::Npy),
            "nrrd" => Ok(Format::Nrrd),
            "nhdr" => Ok(Format::Nhdr),
            _ => Err(Failure::asked(format!(
                "{}: volumes are read and written as .fits, .npy, .nrrd and .nhdr: give it one of these endings",
                path.display()
            ))),
        }
    }
}

/// Reads a volume of dust, and checks every number of it.
///
/// # Errors
/// The file's name, and what is wrong with it; dust that cannot be, with its index.
pub fn open(path: &Path, edges: Option<Edges>) -> Result<Volume, Failure> {
    let told = |error: &dyn std::fmt::Display| Failure::asked(format!("{}: {error}", path.display()));
    let Cube { size, spacing, values } = read(path).map_err(|error| match error {
        Wrong::Asked(failure) => failure,
        Wrong::Cube(error) => told(&error),
    })?;
    let sides = DVec3::new(size[0] as f64, size[1] as f64, size[2] as f64);
    // The box by the file's voxels, or by cubes of any size.
    let shape = sides * spacing.map_or(DVec3::ONE, DVec3::from_array);
    let edges = match edges {
        Some(Edges::Each(edges)) => edges,
        Some(Edges::Longest(edge)) => shape * (edge / shape.max_element()),
        None if spacing.is_some() => shape,
        None => shape * (USUAL_EDGE / shape.max_element()),
    };
    Volume::new(size, edges, values).map_err(|error| told(&error))
}

/// What went wrong with a file.
enum Wrong {
    Asked(Failure),
    Cube(CubeError),
}

impl<E: Into<CubeError>> From<E> for Wrong {
    fn from(error: E) -> Wrong {
        Wrong::Cube(error.into())
    }
}

fn read(path: &Path) -> Result<Cube, Wrong> {
    let format = Format::of(path).map_err(Wrong::Asked)?;
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut file = BufReader::new(file);
    let cube = match format {
        Format::Fits => fits::cube::read(&mut file, length)?,
        Format::Npy => npy::read_cube(&mut file, length)?,
        Format::Nrrd | Format::Nhdr => {
            let header = nrrd::read_header(&mut file)?;
            match &header.data_file {
                None => header.read_values(&mut file, length)?,
                Some(name) => {
                    let beside = path.parent().unwrap_or(Path::new("")).join(name);
                    let failed = |error: std::io::Error| {
                        Wrong::Cube(CubeError::Io(format!("its numbers, {}: {error}", crate::cli::printable(name))))
                    };
                    let data = File::open(&beside).map_err(failed)?;
                    let length = data.metadata().map_err(failed)?.len();
                    header.read_values(&mut BufReader::new(data), length)?
                }
            }
        }
    };
    Ok(cube)
}

/// Writes a volume, f32; the files it made. The edges of the box go into every kind of file but `.npy`.
///
/// # Errors
/// An unknown ending, or the disk's error with the file's name.
pub fn save(path: &Path, volume: &Volume) -> Result<Vec<PathBuf>, Failure> {
    let size = volume.size();
    let [x, y, z] = size;
    let spacing = (volume.edges() / DVec3::new(x as f64, y as f64, z as f64)).to_array();
    let values = volume.density();
    let write = |path: &Path, fill: &dyn Fn(&mut dyn Write) -> Result<(), CubeError>| {
        let failed = |error: CubeError| Failure::failed(format!("{}: {error}", path.display()));
        let mut file = BufWriter::new(File::create(path).map_err(|error| failed(error.into()))?);
        fill(&mut file).map_err(failed)?;
        file.flush().map_err(|error| failed(error.into()))
    };
    let mut files = vec![path.to_path_buf()];
    match Format::of(path)? {
        Format::Fits => write(path, &|mut to| fits::cube::write(&mut to, size, spacing, values))?,
        Format::Npy => write(path, &|mut to| npy::write(&mut to, &[z, y, x], values))?,
        Format::Nrrd => write(path, &|mut to| {
            to.write_all(nrrd::header(size, spacing, None).as_bytes())?;
            nrrd::write_raw(&mut to, values)
        })?,
        Format::Nhdr => {
            let raw = path.with_extension("raw");
            let name = raw.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            write(&raw, &|mut to| nrrd::write_raw(&mut to, values))?;
            write(path, &|to| Ok(to.write_all(nrrd::header(size, spacing, Some(&name)).as_bytes())?))?;
            files.push(raw);
        }
    }
    Ok(files)
}

/// Checks the ending of a file that will be written, before time is spent on what goes into it.
///
/// # Errors
/// An ending that no kind of file has.
pub fn check_ending(path: &Path) -> Result<(), Failure> {
    Format::of(path).map(drop)
}
