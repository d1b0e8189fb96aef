//! `scotopic report`: what the methods cost and what errors they make, measured here and now.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Subcommand};
use serde_json::json;

use super::{Failure, answer, answer_json};
use crate::physics::air::us76;
use crate::report::refraction::{agreement, airs, mediums, study};
use crate::report::{
    Measurement, Study, aerosol, colour, disc, eye, measure, nebula, plot, registration, scattering_table, skylight,
    stability, table,
};

/// Which report.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic report refraction                   the table\n  \
    scotopic report refraction --out report      and report/refraction.svg, report/refraction.json\n  \
    scotopic report colour                       the error of few wavelengths, and the times of the picture\n  \
    scotopic report nebula                       dust lit by a star, against pictures of another program\n  \
    scotopic report scattering-table             photons through dust, and the thesis' table\n  \
    scotopic report registration --seeds 20      the Moon's calibration, on photographs with a known answer\n  \
    scotopic report stability                    what held, under extreme air and rays")]
pub struct Arguments {
    #[command(subcommand)]
    report: Report,
}

#[derive(Debug, Clone, Subcommand)]
enum Report {
    /// Error against run time of every method that traces rays
    Refraction(Output),
    /// Error against run time of what particles take from light, and the published values beside ours
    Aerosol(Output),
    /// Error against run time of the light of the sky, with photons followed one by one as the reference
    Sky(Output),
    /// Error of colour against the number of wavelengths, and the times of the picture of the disc
    Colour {
        #[command(flatten)]
        output: Output,
        /// Trace the measured picture pixel by pixel in all its columns, not in four (takes many minutes)
        #[arg(long)]
        all_columns: bool,
    },
    /// The models of the eye against tables of independent implementations: the greatest differences
    Eye {
        /// Folder of the tables
        #[arg(long, value_name = "DIR", default_value = "fixtures/reference/eye")]
        tables: PathBuf,
        /// Answer as JSON
        #[arg(long)]
        json: bool,
    },
    /// Dust lit by a star: error against run time of the models, of photons, orders and cells, and of the steps along rays (takes minutes)
    Nebula(Output),
    /// Photons through dust against closed forms, the time of the scattering table, and error against run time
    ScatteringTable(Output),
    /// The Moon's calibration on made photographs: error against run time, and how often the interval holds the truth (minutes)
    Registration {
        /// Pairs of photographs of each scene
        #[arg(long, value_name = "COUNT", default_value_t = 100)]
        seeds: u64,
        /// Answer as JSON
        #[arg(long)]
        json: bool,
    },
    /// Extreme air, rays and scenes: what held
    Stability {
        /// Answer as JSON
        #[arg(long)]
        json: bool,
    },
}

/// Where a report goes.
#[derive(Debug, Clone, Args)]
struct Output {
    /// Folder for the plot (SVG) and the measurements (JSON); made if it is not there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Measures and prints.
///
/// # Errors
/// A file could not be written, or an extreme case did not hold.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.report {
        Report::Refraction(output) => refraction(output),
        Report::Aerosol(output) => particles(output),
        Report::Sky(output) => sky(output),
        Report::Colour { output, all_columns } => colours(output, *all_columns),
        Report::Eye { tables, json } => eyes(tables, *json),
        Report::Nebula(output) => dust(output),
        Report::ScatteringTable(output) => scattering(output),
        Report::Registration { seeds, json } => moons(*seeds, *json),
        Report::Stability { json } => extremes(*json),
    }
}

fn refraction(output: &Output) -> Result<(), Failure> {
    let agreement = agreement().map_err(Failure::failed)?;
    let airs = airs().map_err(Failure::failed)?;
    let mediums = mediums(&airs).map_err(Failure::failed)?;
    let study = study(&mediums).map_err(Failure::failed)?;
    let measurements = timed(&study);
    if let Some(folder) = &output.out {
        write(folder, "refraction", &study, &measurements)?;
    }
    if output.json {
        return answer_json(&json!({ "agreement": agreement, "measurements": measurements }));
    }
    answer(&format!(
        "{}\nThe exact method at 0.001\" against the tables of others:\n  \
         standard atmosphere   worst {:.6}\" of {} values\n  \
         mirages               worst {:.6}\" of {} values",
        table(&study, &measurements),
        agreement.standard_worst_arcsec,
        agreement.standard_values,
        agreement.mirage_worst_arcsec,
        agreement.mirage_values,
    ))
}

fn particles(output: &Output) -> Result<(), Failure> {
    let agreement = aerosol::agreement().map_err(Failure::failed)?;
    let study = aerosol::study().map_err(Failure::failed)?;
    let measurements = timed(&study);
    let begin = Instant::now();
    let costs = aerosol::costs(&|| begin.elapsed()).map_err(Failure::failed)?;
    if let Some(folder) = &output.out {
        write(folder, "aerosol", &study, &measurements)?;
    }
    if output.json {
        return answer_json(&json!({ "agreement": agreement, "costs": costs, "measurements": measurements }));
    }
    answer(&format!("{}\n{}", aerosol::tables(&agreement, &costs), table(&study, &measurements).trim_end()))
}

fn sky(output: &Output) -> Result<(), Failure> {
    let begin = Instant::now();
    let (air, particles) = (us76::profile(), skylight::particles().map_err(Failure::failed)?);
    let skies =
        skylight::skies(&air, &particles, &|| begin.elapsed(), |told| eprintln!("{told}")).map_err(Failure::failed)?;
    let study = skylight::study(&skies);
    let measurements = timed(&study);
    if let Some(folder) = &output.out {
        write(folder, "sky", &study, &measurements)?;
    }
    let ready_s: Vec<f64> = skies.iter().map(|sky| sky.ready_s).collect();
    if output.json {
        return answer_json(&json!({ "ready_s": ready_s, "measurements": measurements }));
    }
    let ready: Vec<String> = ready_s.iter().map(|s| format!("{s:.2} s")).collect();
    answer(&format!(
        "{}\nA sky is ready, for all directions at one wavelength, in {}.",
        table(&study, &measurements),
        ready.join(", ")
    ))
}

fn colours(output: &Output, all_columns: bool) -> Result<(), Failure> {
    let study = colour::study().map_err(Failure::failed)?;
    let measurements = timed(&study);
    let begin = Instant::now();
    let clock = || begin.elapsed();
    let costs = colour::costs(&clock).map_err(Failure::failed)?;
    let mut bar = super::sun::progress::Bar::new("the omega sunset, pixel by pixel");
    let disc_cost = disc::cost(&clock, all_columns, &mut |share| bar.show(share)).map_err(Failure::failed)?;
    bar.end();
    if let Some(folder) = &output.out {
        write(folder, "colour", &study, &measurements)?;
    }
    if output.json {
        return answer_json(&json!({ "disc": disc_cost, "pictures": costs, "measurements": measurements }));
    }
    answer(&format!(
        "{}\n{}\n{}",
        disc::lines(&disc_cost),
        colour::table(&costs),
        table(&study, &measurements).trim_end()
    ))
}

/// The error of the tables that stand for the truth.
const TRUTH: f64 = 0.003;

fn scattering(output: &Output) -> Result<(), Failure> {
    let begin = Instant::now();
    let clock = || begin.elapsed();
    let mut bar = super::sun::progress::Bar::new("photons through spheres");
    let agreement = scattering_table::agreement(&clock, |share| bar.show(share)).map_err(Failure::failed)?;
    bar.end();
    let mut bar = super::sun::progress::Bar::new("the thesis' table");
    let cost = scattering_table::cost(&clock, &mut |share| bar.show(share)).map_err(Failure::failed)?;
    bar.end();
    eprintln!("rows to {} % as the truth, and both methods against them", 100.0 * TRUTH);
    let truths = scattering_table::truths(TRUTH).map_err(Failure::failed)?;
    let study = scattering_table::study(&truths);
    let measurements = timed(&study);
    if let Some(folder) = &output.out {
        write(folder, "scattering-table", &study, &measurements)?;
    }
    if output.json {
        return answer_json(&json!({ "agreement": agreement, "cost": cost, "measurements": measurements }));
    }
    answer(&format!("{}\n{}", scattering_table::lines(&agreement, &cost), table(&study, &measurements).trim_end()))
}

fn timed(study: &Study<'_>) -> Vec<Measurement> {
    let begin = Instant::now();
    measure(study, &|| begin.elapsed())
}

/// Writes a study's plot and numbers into a folder.
fn write(folder: &Path, name: &str, study: &Study<'_>, measurements: &[Measurement]) -> Result<(), Failure> {
    let svg = plot::svg(study, measurements).map_err(Failure::failed)?;
    let numbers = serde_json::to_string_pretty(measurements).map_err(Failure::failed)?;
    std::fs::create_dir_all(folder).map_err(|error| Failure::failed(format!("{}: {error}", folder.display())))?;
    for (ending, text) in [("svg", svg), ("json", numbers)] {
        let path = folder.join(name).with_extension(ending);
        std::fs::write(&path, text).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))?;
        eprintln!("wrote {}", path.display());
    }
    Ok(())
}

fn eyes(tables: &Path, json: bool) -> Result<(), Failure> {
    let mut read = |name: &str| {
        let path = tables.join(name);
        std::fs::read_to_string(&path)
            .map_err(|error| format!("{} cannot be read ({error}): give the folder with --tables", path.display()))
    };
    let agreements = eye::agreements(&mut read).map_err(Failure::failed)?;
    if json {
        answer_json(&agreements)?;
    } else {
        answer("table                          numbers  worst     of what is asked")?;
        for one in &agreements {
            answer(&format!(
                "{:<30} {:>7}  {:.1e}  {:>5.0} %  {}",
                one.table,
                one.compared,
                one.worst,
                100.0 * one.share,
                one.what
            ))?;
        }
    }
    match agreements.iter().find(|one| one.share > 1.0) {
        None => Ok(()),
        Some(wrong) => {
            Err(Failure::failed(format!("{} differs by {:.1e}: more than is asked", wrong.table, wrong.worst)))
        }
    }
}

fn dust(output: &Output) -> Result<(), Failure> {
    let begin = Instant::now();
    let (clock, told) = (|| begin.elapsed(), |what: &str| eprintln!("{what}"));
    let clouds = nebula::known::all().map_err(Failure::failed)?;
    let table = nebula::small_table().map_err(Failure::failed)?;
    let pictures = nebula::pictures(&clouds, &table, &clock, &told).map_err(Failure::failed)?;
    let large = nebula::large::runs(&clock, &told).map_err(Failure::failed)?;
    let totals = nebula::grid::totals(&table).map_err(Failure::failed)?;
    let steps = match clouds.last() {
        Some(cloud) => nebula::steps(cloud, &clock).map_err(Failure::failed)?,
        None => Vec::new(),
    };
    if let Some(folder) = &output.out {
        let (study, measurements) = nebula::study(&pictures);
        write(folder, "nebula", &study, &measurements)?;
    }
    if output.json {
        return answer_json(&json!({ "pictures": pictures, "large": large, "grid": totals, "steps": steps }));
    }
    answer(&format!(
        "{}\n{}\n{}\n{}",
        nebula::table(&pictures),
        nebula::large::text(&large),
        nebula::grid::text(&totals),
        nebula::steps_text(&steps).trim_end()
    ))
}

fn moons(seeds: u64, json: bool) -> Result<(), Failure> {
    let begin = Instant::now();
    let seeds = super::overlay::within("--seeds", seeds as f64, 1.0, 10_000.0)? as u64;
    let rows = registration::rows(seeds, &|| begin.elapsed(), |scene| eprintln!("{seeds} pairs: {scene}"));
    let rows = rows.map_err(Failure::failed)?;
    if json { answer_json(&rows) } else { answer(registration::table(&rows).trim_end()) }
}

fn extremes(json: bool) -> Result<(), Failure> {
    let mut extremes = stability::run();
    extremes.extend(aerosol::extremes());
    extremes.extend(skylight::extremes());
    extremes.extend(disc::extremes());
    extremes.extend(nebula::extremes::extremes());
    extremes.extend(nebula::rendered::extremes());
    extremes.extend(nebula::flying::extremes());
    extremes.extend(eye::extremes());
    extremes.extend(registration::extremes());
    extremes.extend(scattering_table::extremes());
    if json {
        answer_json(&extremes)?;
    } else {
        answer(stability::table(&extremes).trim_end())?;
    }
    match extremes.iter().filter(|extreme| !extreme.held).count() {
        0 => Ok(()),
        failed => Err(Failure::failed(format!("{failed} of {} extreme cases did not hold", extremes.len()))),
    }
}
