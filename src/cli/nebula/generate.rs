//! `scotopic nebula generate`: a volume of dust out of noise.

use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Instant;

use clap::Args;
use glam::DVec3;
use serde_json::json;

use super::files;
use super::triple::{Edges, Place, Voxels};
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::dust::volume::gas::Gas;
use crate::physics::dust::volume::generate::{Octave, Recipe, RecipeError, octaves};

/// The recipe, the grid, and where it goes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula generate --seed 7 --size 128 --out V.fits\n  \
    scotopic nebula generate --seed 3 --octaves 7 --frequency 4 --persistence 0.65 --cavity 0.2 --out wisps.npy\n  \
    scotopic nebula generate --seed 5 --frequencies 2,8,32 --amplitudes 1,0.4,0.2 --out three-layers.nrrd\n  \
    scotopic nebula generate --seed 9 --star=-0.3,0,0 --star 0.4,0.2,0 --clumps 40 --out two-stars.fits\n  \
    scotopic nebula generate --seed 7 --emission glow.fits --emission-radius 0.6 --out V.fits\n  \
    scotopic nebula render V.fits --emission glow.fits --emission-bands 3,0.2,0.6 --out both.png\n\n\
    Lengths are in half edges of the box: 1 is the middle of a face. The density at a place r from the centre is\n\
    (level + noise - decline (r/R)^2), where that is above 0, cleared in a cavity around each star. Densities are about 1;\n\
    what they mean is said by --extinction when the volume is rendered. A finer grid of one seed samples the same nebula.\n\
    --emission writes how brightly gas glows that lies as the dust does: with the square of the density, as lines of recombination\n\
    do, within a radius around each star. What 1 means is said by --emission-bands when it is rendered.")]
pub struct Arguments {
    /// Seed of everything that is random
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Voxels along each edge: one number, or three as X,Y,Z
    #[arg(long, value_name = "N|X,Y,Z", default_value = "128")]
    size: Voxels,
    /// Edge of the box (the longest), or all three as X,Y,Z
    #[arg(long, value_name = "LENGTH|X,Y,Z", default_value = "2", allow_hyphen_values = true)]
    edge: Edges,
    /// Layers of noise [default: 6]
    #[arg(long, value_name = "N", conflicts_with_all = ["frequencies", "amplitudes"])]
    octaves: Option<usize>,
    /// Features of the first layer across the box [default: 3]
    #[arg(long, value_name = "F", allow_negative_numbers = true, conflicts_with_all = ["frequencies", "amplitudes"])]
    frequency: Option<f64>,
    /// Each layer's frequency over that of the one before [default: 2]
    #[arg(long, value_name = "RATIO", allow_negative_numbers = true, conflicts_with_all = ["frequencies", "amplitudes"])]
    lacunarity: Option<f64>,
    /// Strength of the first layer [default: 1]
    #[arg(long, value_name = "A", allow_negative_numbers = true, conflicts_with_all = ["frequencies", "amplitudes"])]
    amplitude: Option<f64>,
    /// Each layer's strength over that of the one before [default: 0.55]
    #[arg(long, value_name = "RATIO", allow_negative_numbers = true, conflicts_with_all = ["frequencies", "amplitudes"])]
    persistence: Option<f64>,
    /// Frequencies of the layers one by one
    #[arg(long, value_name = "F,F,...", value_delimiter = ',', allow_hyphen_values = true, requires = "amplitudes")]
    frequencies: Option<Vec<f64>>,
    /// Strengths of the layers one by one
    #[arg(long, value_name = "A,A,...", value_delimiter = ',', allow_hyphen_values = true, requires = "frequencies")]
    amplitudes: Option<Vec<f64>>,
    /// Density of the smooth part [default: 0.35]
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    level: Option<f64>,
    /// How much less of it there is at the outer radius: the more, the more ragged is the outline [default: 0.5]
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    decline: Option<f64>,
    /// No dust beyond this distance from the centre [default: 0.95]
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    outer_radius: Option<f64>,
    /// A star that has swept a cavity, again for more [default: one in the centre]
    #[arg(long = "star", value_name = "X,Y,Z", allow_hyphen_values = true)]
    stars: Vec<Place>,
    /// Radius of the cavity around each star; 0 and --cavity-wall 0 for none [default: 0.12]
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    cavity: Option<f64>,
    /// Thickness of the cavity's wall, in which the dust becomes denser [default: 0.25]
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    cavity_wall: Option<f64>,
    /// Number of round dense clumps [default: 0]
    #[arg(long, value_name = "N")]
    clumps: Option<usize>,
    /// Radius of a clump [default: 0.1]
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    clump_radius: Option<f64>,
    /// Density in the middle of a clump [default: 4]
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    clump_density: Option<f64>,
    /// The file: .fits, .npy, .nrrd, or .nhdr with a .raw beside it
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// A second file in the same box: the glow of gas that the stars ionise, for `scotopic nebula render --emission`
    #[arg(long, value_name = "FILE")]
    emission: Option<PathBuf>,
    /// How far from a star gas glows [default: 0.5]
    #[arg(long, value_name = "R", allow_negative_numbers = true, requires = "emission")]
    emission_radius: Option<f64>,
    /// Thickness of the rim in which the glow ends [default: a quarter of the radius]
    #[arg(long, value_name = "D", allow_negative_numbers = true, requires = "emission")]
    emission_rim: Option<f64>,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    fn recipe(&self) -> Result<Recipe, Failure> {
        let usual = Recipe::default();
        let layers = match (&self.frequencies, &self.amplitudes) {
            (Some(frequencies), Some(amplitudes)) if frequencies.len() == amplitudes.len() => {
                let pair =
                    |(frequency, amplitude): (&f64, &f64)| Octave { frequency: *frequency, amplitude: *amplitude };
                frequencies.iter().zip(amplitudes).map(pair).collect()
            }
            (Some(frequencies), Some(amplitudes)) => {
                return Err(Failure::asked(format!(
                    "{} frequencies and {} amplitudes: give as many of one as of the other",
                    frequencies.len(),
                    amplitudes.len()
                )));
            }
            _ => {
                let count = self.octaves.unwrap_or(6);
                if count > 16 {
                    return Err(Failure::asked(format!("{count} octaves: give 0 to 16")));
                }
                octaves(
                    count,
                    self.frequency.unwrap_or(3.0),
                    self.lacunarity.unwrap_or(2.0),
                    self.amplitude.unwrap_or(1.0),
                    self.persistence.unwrap_or(0.55),
                )
            }
        };
        let swept = if self.stars.is_empty() { usual.swept } else { self.stars.iter().map(|star| star.0).collect() };
        Ok(Recipe {
            seed: self.seed,
            octaves: layers,
            level: self.level.unwrap_or(usual.level),
            decline: self.decline.unwrap_or(usual.decline),
            outer_radius: self.outer_radius.unwrap_or(usual.outer_radius),
            swept,
            cavity_radius: self.cavity.unwrap_or(usual.cavity_radius),
            cavity_wall: self.cavity_wall.unwrap_or(usual.cavity_wall),
            clumps: self.clumps.unwrap_or(usual.clumps),
            clump_radius: self.clump_radius.unwrap_or(usual.clump_radius),
            clump_density: self.clump_density.unwrap_or(usual.clump_density),
        })
    }
}

/// Makes the volume and writes it.
///
/// # Errors
/// A recipe that makes no nebula, or a file that could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    for path in std::iter::once(&arguments.out).chain(&arguments.emission) {
        files::check_ending(path)?;
    }
    let Voxels(size) = arguments.size;
    let sides = DVec3::new(size[0] as f64, size[1] as f64, size[2] as f64);
    let edges = match arguments.edge {
        Edges::Each(edges) => edges,
        Edges::Longest(edge) => sides * (edge / sides.max_element()),
    };
    let begin = Instant::now();
    let bar = Mutex::new(Bar::new("the volume"));
    let tell = |share: f64| {
        if let (false, Ok(mut bar)) = (arguments.quiet, bar.lock()) {
            bar.show(share);
        }
    };
    let recipe = arguments.recipe()?;
    let volume = recipe.generate(size, edges, &tell).map_err(|error: RecipeError| Failure::asked(error))?;
    if let Ok(bar) = bar.into_inner() {
        bar.end();
    }
    let mut files = files::save(&arguments.out, &volume)?;
    if let Some(path) = &arguments.emission {
        let radius = arguments.emission_radius.unwrap_or(0.5);
        let gas = Gas { stars: recipe.swept, radius, rim: arguments.emission_rim.unwrap_or(0.25 * radius) };
        files.extend(files::save(path, &gas.around(&volume).map_err(Failure::asked)?)?);
    }
    let filled =
        volume.density().iter().filter(|density| **density > 0.0).count() as f64 / volume.density().len() as f64;
    let seconds = begin.elapsed().as_secs_f64();
    if arguments.json {
        return answer_json(&json!({
            "files": files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
            "size": size,
            "edges": edges.to_array(),
            "filled": filled,
            "seconds": seconds,
        }));
    }
    answer(&format!(
        "{}: {} x {} x {} voxels, {:.0} % of them with dust, seed {}, {seconds:.1} s",
        files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", "),
        size[0],
        size[1],
        size[2],
        100.0 * filled,
        arguments.seed,
    ))
}
