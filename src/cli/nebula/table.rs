//! `scotopic nebula table`: the scattering table of the thesis.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::cache;
use super::photons::count;
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json, note};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::sphere::walk::Rules;
use crate::physics::dust::sphere::{Source, SphereError};
use crate::physics::dust::table::{Accuracy, Depth, Length, Made, Parameters, Spacing, Table, file, plain, shared};
use crate::picture::npy;
use crate::report::scattering_figure;

/// What the table is of, how good it is to be, and where it goes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula table --albedo 0.6 --g 0.6 --tau-max 10 --depths 1000 --directions 72 --relative-error 0.01 --out table.csv\n  \
    scotopic nebula table --spacing angle --source beam --length diameter --out beam.npy\n  \
    scotopic nebula table --method plain --counts printed --depths 20 --photons 1e6 --out as-printed.csv\n  \
    scotopic nebula table --figure figure-5-3.svg\n\n\
    A row holds the shares of the light entering a voxel that pass it untouched and that leave it into each bin of direction, each\n\
    with its standard error; what is left was absorbed. FILE.csv is text in full precision, with the parameters in comments. FILE.npy\n\
    is an array [2, depths, 1 + directions]: shares and errors, unscattered light first.\n\n\
    The voxel is a sphere of its volume. Depths are of extinction along the voxel's edge; --length diameter counts along the\n\
    sphere's diameter, --counts scattering gives rows of scattering depth, --counts printed also draws flights from it, as\n\
    appendix A prints it. The relative error is that of each bin that holds more than 1 % of its row's largest.")]
pub struct Arguments {
    /// Share of the extinction that is scattering
    #[arg(long, value_name = "A", default_value_t = 0.6, allow_negative_numbers = true)]
    albedo: f64,
    /// Mean cosine of the angle turned through (Henyey and Greenstein)
    #[arg(long, alias = "asymmetry", value_name = "G", default_value_t = 0.6, allow_negative_numbers = true)]
    g: f64,
    /// Depth of the last row; the first is 0
    #[arg(long, value_name = "T", default_value_t = 10.0, allow_negative_numbers = true)]
    tau_max: f64,
    /// Rows, evenly spaced
    #[arg(long, value_name = "N", default_value = "1000", value_parser = count, allow_negative_numbers = true)]
    depths: u64,
    /// Bins of direction
    #[arg(long, value_name = "M", default_value = "72", value_parser = count, allow_negative_numbers = true)]
    directions: u64,
    /// The standard error to reach in each bin, as a share of its light [default: 0.01, or none with --photons]
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    relative_error: Option<f64>,
    /// Photons for each row (plain) or each group of rows (shared), whatever the error; with --relative-error, at least so many
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    photons: Option<u64>,
    /// Bins equal in the cosine, or in the angle
    #[arg(long, value_name = "NAME", default_value = "cosine")]
    spacing: Spacing,
    /// Light that enters as a pencil towards the centre, or as a beam over the disc
    #[arg(long, value_name = "NAME", default_value = "pencil")]
    source: Source,
    /// Depths counted along an edge of the voxel, or along the diameter of its sphere
    #[arg(long, value_name = "NAME", default_value = "edge")]
    length: Length,
    /// What depths count: extinction, scattering, or printed (scattering, and flights drawn from it)
    #[arg(long, value_name = "NAME", default_value = "extinction")]
    counts: Depth,
    /// Paths shared between rows and seen from all directions, or the thesis' photons, row by row
    #[arg(long, value_name = "NAME", default_value = "shared")]
    method: Method,
    /// Seed of the random numbers; the answer does not depend on the number of threads
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Weight at which a photon of the plain method is given up, at most 1e-10
    #[arg(long, value_name = "W", default_value_t = 1e-12, allow_negative_numbers = true)]
    threshold: f64,
    /// Scatterings after which no more photons are begun, whatever the error
    #[arg(long, value_name = "N", default_value = "1e10", value_parser = count, allow_negative_numbers = true)]
    most_events: u64,
    /// Folder of the tables that were made before [default: scotopic/tables in the user's cache folder]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Make the table again, and keep it nowhere else
    #[arg(long, conflicts_with = "cache")]
    no_cache: bool,
    /// The file: .csv or .npy
    #[arg(long, value_name = "FILE", required_unless_present = "figure")]
    out: Option<PathBuf>,
    /// A drawing of the table as the thesis' figure 5.3: FILE.svg
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// How a table is made.
#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Method {
    /// Forced scattering, peel-off, paths shared between rows.
    Shared,
    /// As appendix A.
    Plain,
}

/// What a table is to be, and how it is made: all that its numbers depend on.
#[derive(Debug, Clone, Copy)]
struct Recipe {
    parameters: Parameters,
    method: Method,
    accuracy: Accuracy,
    threshold: f64,
    seed: u64,
}

/// A table, and where it came from.
struct Kept {
    made: Made,
    cached: bool,
}

impl Recipe {
    /// The table: from the folder of a cache if it is there, else made and put there.
    ///
    /// # Errors
    /// A table that cannot be. A cache that cannot be read or written is only noted.
    fn table(&self, folder: Option<&Path>, quiet: bool) -> Result<Kept, Failure> {
        let key = self.key();
        let path = folder.map(|folder| cache::path(folder, &key, "csv"));
        if let Some(made) = path.as_deref().and_then(|path| remembered(path, &key)) {
            return Ok(Kept { made, cached: true });
        }
        let mut bar = (!quiet).then(|| Bar::new("the scattering table"));
        let mut told = |share| {
            if let Some(bar) = &mut bar {
                bar.show(share);
            }
        };
        let made = match self.method {
            Method::Shared => shared::make(&self.parameters, &self.accuracy, self.seed, &mut told),
            Method::Plain => {
                let rules = Rules { threshold: self.threshold, most_scatterings: 100_000_000 };
                plain::make(&self.parameters, &self.accuracy, &rules, self.seed, &mut told)
            }
        }
        .map_err(Failure::asked)?;
        if let Some(bar) = bar {
            bar.end();
        }
        if let Some(path) = path {
            let text = format!(
                "{}# photons = {}\n# events = {}\n# key = {key}\n",
                file::write(&made.table),
                made.photons,
                made.events
            );
            if let Err(error) = cache::keep(&path, text.as_bytes()) {
                note(&format!("the table is not kept: {}: {error}", path.display()));
            }
        }
        Ok(Kept { made, cached: false })
    }

    /// All that its numbers depend on, in one line. The first word changes when the method does.
    fn key(&self) -> String {
        let Accuracy { relative, photons, most_events } = self.accuracy;
        let heading = file::heading(&self.parameters).replace(" = ", "=").replace('\n', ";");
        format!("1;{heading}{:?};{relative:?};{photons:?};{most_events};{};{}", self.method, self.threshold, self.seed)
    }
}

/// The table that a picture needs: the thesis', for this dust, to a depth of extinction along a voxel's edge; from the user's cache, or made and
/// put there.
///
/// # Errors
/// A table that cannot be.
pub fn for_pictures(albedo: f64, phase: HenyeyGreenstein, deepest: f64, quiet: bool) -> Result<Table, Failure> {
    let thesis = Parameters::thesis().ok_or_else(|| Failure::failed("the thesis' table is no table"))?;
    let parameters = Parameters { albedo, phase, deepest, ..thesis };
    let accuracy = Accuracy { relative: Some(0.01), photons: None, most_events: 10_000_000_000 };
    let recipe = Recipe { parameters, method: Method::Shared, accuracy, threshold: 1e-12, seed: 1 };
    Ok(recipe.table(cache::folder("tables").as_deref(), quiet)?.made.table)
}

/// A table that was kept under a key.
fn remembered(path: &Path, key: &str) -> Option<Made> {
    let length = std::fs::metadata(path).ok()?.len();
    let text = (length < file::LARGEST as u64).then(|| std::fs::read_to_string(path).ok())??;
    let find = |name: &str| text.lines().rev().take(3).find_map(|line| line.strip_prefix(name)?.strip_prefix(" = "));
    if find("# key")? != key {
        return None;
    }
    let (photons, events) = (find("# photons")?.parse().ok()?, find("# events")?.parse().ok()?);
    Some(Made { table: file::read(&text).ok()?, photons, events })
}

/// Makes the table, writes and prints.
///
/// # Errors
/// A table that cannot be, or a file that could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let recipe = recipe(arguments)?;
    let ending = |path: &Path| path.extension().map(|e| e.to_string_lossy().to_lowercase());
    if let Some(path) = &arguments.out
        && !matches!(ending(path).as_deref(), Some("csv" | "npy"))
    {
        return Err(Failure::asked(format!("{}: a table is written as .csv or .npy", path.display())));
    }
    if let Some(path) = &arguments.figure
        && ending(path).as_deref() != Some("svg")
    {
        return Err(Failure::asked(format!("{}: the figure is written as .svg", path.display())));
    }
    let begin = Instant::now();
    let folder = if arguments.no_cache { None } else { arguments.cache.clone().or_else(|| cache::folder("tables")) };
    let Kept { made: Made { table, photons, events }, cached } = recipe.table(folder.as_deref(), arguments.quiet)?;
    let seconds = begin.elapsed().as_secs_f64();

    let mut files = Vec::new();
    if let Some(path) = &arguments.out {
        let bytes =
            if ending(path).as_deref() == Some("npy") { array(&table)? } else { file::write(&table).into_bytes() };
        files.push((path, bytes));
    }
    if let Some(path) = &arguments.figure {
        files.push((path, scattering_figure::svg(&table).map_err(Failure::failed)?.into_bytes()));
    }
    for (path, bytes) in &files {
        std::fs::write(path, bytes).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))?;
    }

    let worst = table.worst_error();
    let reached = recipe.accuracy.relative.is_none_or(|wanted| worst <= wanted * 1.001);
    if !reached {
        note(&format!("the worst bin has an error of {:.2} %: --most-events ended the search", 100.0 * worst));
    }
    let names: Vec<String> = files.iter().map(|(path, _)| path.display().to_string()).collect();
    if arguments.json {
        return answer_json(&json!({
            "files": names, "depths": recipe.parameters.depths, "directions": recipe.parameters.directions, "photons": photons,
            "events": events, "worst_relative_error": worst, "reached": reached, "seconds": seconds, "cached": cached,
        }));
    }
    let from = if cached { "taken from the cache" } else { "made" };
    answer(&format!(
        "{} depths x {} directions {from} in {seconds:.2} s: {photons} photons, {events} scatterings, worst error of a bin {:.3} %\n{}",
        recipe.parameters.depths,
        recipe.parameters.directions,
        100.0 * worst,
        names.join("\n")
    ))
}

fn recipe(arguments: &Arguments) -> Result<Recipe, Failure> {
    let whole = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
    let parameters = Parameters {
        albedo: arguments.albedo,
        phase: HenyeyGreenstein::new(arguments.g).ok_or(SphereError::Asymmetry(arguments.g)).map_err(Failure::asked)?,
        deepest: arguments.tau_max,
        depths: whole(arguments.depths),
        directions: whole(arguments.directions),
        spacing: arguments.spacing,
        source: arguments.source,
        length: arguments.length,
        depth: arguments.counts,
    };
    parameters.checked().map_err(Failure::asked)?;
    if !(arguments.threshold > 0.0 && arguments.threshold <= 1e-10) {
        return Err(Failure::asked(SphereError::Threshold(arguments.threshold)));
    }
    let relative = arguments.relative_error.or(arguments.photons.is_none().then_some(0.01));
    let accuracy = Accuracy { relative, photons: arguments.photons, most_events: arguments.most_events };
    accuracy.checked().map_err(Failure::asked)?;
    Ok(Recipe { parameters, method: arguments.method, accuracy, threshold: arguments.threshold, seed: arguments.seed })
}

/// The table as a NumPy array: shares, then errors; unscattered light first in each row.
fn array(table: &Table) -> Result<Vec<u8>, Failure> {
    let (depths, directions) = (table.parameters().depths, table.parameters().directions);
    let mut values = Vec::with_capacity(2 * depths * (1 + directions));
    for plane in 0..2 {
        for row in 0..depths {
            values.push(table.unscattered(row)[plane] as f32);
            let bins = if plane == 0 { table.bins(row) } else { table.errors(row) };
            values.extend(bins.iter().map(|bin| *bin as f32));
        }
    }
    let mut bytes = Vec::new();
    npy::write(&mut bytes, &[2, depths, 1 + directions], &values).map_err(Failure::failed)?;
    Ok(bytes)
}
