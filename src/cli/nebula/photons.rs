//! `scotopic nebula photons`: photons through a sphere of even dust.

use clap::Args;
use serde_json::json;

use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer, answer_json, note};
use crate::physics::dust::sphere::photons::{Estimate, Order, Shares, shares};
use crate::physics::dust::sphere::walk::Rules;
use crate::physics::dust::sphere::{Source, Sphere};

/// The sphere, the light, and how many photons.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic nebula photons --tau-radius 1 --albedo 0.6 --g 0.6 --source beam --photons 1000000 --json\n  \
    scotopic nebula photons --tau-radius 2 --albedo 1 --g -0.5 --source centre\n\n\
    All shares are of the light that enters: unscattered + scattered + absorbed = 1. Errors are one standard deviation.\n\
    Scatterings are counted for each photon until it leaves or is given up, whatever weight it has left.")]
pub struct Arguments {
    /// Optical depth of extinction along a radius
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    tau_radius: f64,
    /// Share of the extinction that is scattering
    #[arg(long, value_name = "A", default_value_t = 0.6, allow_negative_numbers = true)]
    albedo: f64,
    /// Mean cosine of the angle turned through (Henyey and Greenstein)
    #[arg(long, alias = "asymmetry", value_name = "G", default_value_t = 0.6, allow_negative_numbers = true)]
    g: f64,
    /// Where the light comes from: beam (parallel, over the disc), pencil (along a diameter), centre or uniform (alike in all directions)
    #[arg(long, value_name = "NAME", default_value = "beam")]
    source: Source,
    /// Photons to follow
    #[arg(long, value_name = "N", default_value = "1000000", value_parser = count, allow_negative_numbers = true)]
    photons: u64,
    /// Seed of the random numbers; the answer does not depend on the number of threads
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Weight at which a photon is given up and counts as absorbed, at most 1e-10
    #[arg(long, value_name = "W", default_value_t = 1e-12, allow_negative_numbers = true)]
    threshold: f64,
    /// Scatterings after which a photon is given up and counts as unfinished
    #[arg(long, value_name = "N", default_value = "1e8", value_parser = count, allow_negative_numbers = true)]
    most_scatterings: u64,
    /// Scatterings of all photons together after which no more are begun
    #[arg(long, value_name = "N", default_value = "1e10", value_parser = count, allow_negative_numbers = true)]
    most_events: u64,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// A count, also as 1e6.
pub(super) fn count(text: &str) -> Result<u64, String> {
    let number: f64 =
        text.parse().map_err(|_no_number| format!("'{text}' is no count: give one such as 1000000 or 1e6"))?;
    if !(1.0..=1e15).contains(&number) || number.fract() != 0.0 {
        return Err(format!("{text} is out of range: give a whole number from 1 to 1e15"));
    }
    Ok(number as u64)
}

/// Follows and prints.
///
/// # Errors
/// The sphere or the threshold is none that can be.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let sphere =
        Sphere::new(arguments.tau_radius, arguments.albedo, arguments.g, arguments.source).map_err(Failure::asked)?;
    let order = Order {
        photons: arguments.photons,
        seed: arguments.seed,
        rules: Rules { threshold: arguments.threshold, most_scatterings: arguments.most_scatterings },
        most_events: arguments.most_events,
    };
    let mut bar = (!arguments.quiet).then(|| Bar::new("the photons"));
    let found = shares(&sphere, &order, &mut |share| {
        if let Some(bar) = &mut bar {
            bar.show(share);
        }
    })
    .map_err(Failure::asked)?;
    if let Some(bar) = bar {
        bar.end();
    }
    if found.photons < arguments.photons {
        note(&format!(
            "{} of {} photons were followed: they scattered {:.2e} times; --most-events sets the limit",
            found.photons, arguments.photons, found.events as f64
        ));
    }
    if found.unfinished > 0.0 {
        note(&format!(
            "{:.3e} of the light was still under way after {} scatterings; --most-scatterings sets the limit",
            found.unfinished, arguments.most_scatterings
        ));
    }
    if arguments.json { as_json(arguments, &sphere, &found) } else { answer(&in_words(&sphere, &found)) }
}

fn as_json(arguments: &Arguments, sphere: &Sphere, found: &Shares) -> Result<(), Failure> {
    answer_json(&json!({
        "tau_radius": sphere.depth,
        "albedo": sphere.albedo,
        "g": sphere.phase.asymmetry(),
        "source": sphere.source.name(),
        "seed": arguments.seed,
        "photons": found.photons,
        "photons_asked": arguments.photons,
        "events": found.events,
        "unscattered": found.unscattered.value,
        "unscattered_error": found.unscattered.error,
        "unscattered_closed_form": sphere.unscattered(),
        "scattered": found.scattered.value,
        "scattered_error": found.scattered.error,
        "absorbed": found.absorbed.value,
        "absorbed_error": found.absorbed.error,
        "unfinished": found.unfinished,
        "mean_scatterings": found.mean_scatterings.value,
        "mean_scatterings_error": found.mean_scatterings.error,
        "mean_cosine": found.mean_cosine.map(|cosine| cosine.value),
        "mean_cosine_error": found.mean_cosine.map(|cosine| cosine.error),
    }))
}

fn in_words(sphere: &Sphere, found: &Shares) -> String {
    let line = |name: &str, Estimate { value, error }: Estimate| format!("{name:<17} {value:>12.8} +- {error:.1e}");
    let mut lines = vec![
        format!("{} photons, {} scatterings", found.photons, found.events),
        format!("{}  (closed form {:.8})", line("unscattered", found.unscattered), sphere.unscattered()),
        line("scattered", found.scattered),
        line("absorbed", found.absorbed),
        line("mean scatterings", found.mean_scatterings),
    ];
    lines.push(
        found.mean_cosine.map_or("mean cosine       no light was scattered".to_owned(), |c| line("mean cosine", c)),
    );
    lines.join("\n")
}
