//! `scotopic nebula gallery`: the thesis' figures of reflection nebulae, made again, and a page that shows each with its command lines.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, Parser};

use super::{Command, execute};
use crate::cli::sun::progress::Bar;
use crate::cli::{Failure, answer};

/// Where the gallery goes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Example:\n  scotopic nebula gallery --out docs/gallery/nebula")]
pub struct Arguments {
    /// Folder for the pictures and README.md; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// A command line, without `scotopic nebula`.
#[derive(Debug, Parser)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

/// A figure: its number, what it shows, and how it is made.
struct Figure {
    number: &'static str,
    what: &'static str,
    /// Command lines, in their order. `@name` is a file for the figure's own use, `=name` one of the gallery.
    lines: &'static [&'static str],
    /// The pictures of the gallery.
    pictures: &'static [&'static str],
}

/// The figures.
const FIGURES: &[Figure] = &[
    Figure {
        number: "5.3",
        what: "the light that a voxel scatters, by direction, for albedo 0.6 and g 0.6 at growing depths; forwards is to the right",
        lines: &["table --depths 101 --relative-error 0.03 --no-cache --quiet --figure =figure-5-3.svg"],
        pictures: &["figure-5-3.svg"],
    },
    Figure {
        number: "5.5",
        what: "one seed, five settings of the noise: broad, as usual, fine, clumps, a wide cavity",
        lines: &[
            "generate --seed 4 --size 64 --octaves 3 --frequency 1.5 --amplitude 1.5 --persistence 0.5 --quiet --out @broad.npy",
            "generate --seed 4 --size 64 --amplitude 1.8 --quiet --out @usual.npy",
            "generate --seed 4 --size 64 --frequency 5 --persistence 0.85 --amplitude 1.5 --level 0.1 --quiet --out @fine.npy",
            "generate --seed 4 --size 64 --amplitude 1.2 --clumps 60 --clump-radius 0.13 --clump-density 6 --quiet --out @clumps.npy",
            "generate --seed 4 --size 64 --amplitude 1.8 --cavity 0.4 --cavity-wall 0.15 --quiet --out @hollow.npy",
            "render @broad.npy --size 160 --tolerance 0.05 --flights 500000 --star 0,0,0,15000 --quiet --gamma 2.2 --out =5-5-broad.png",
            "render @usual.npy --size 160 --tolerance 0.05 --flights 500000 --star 0,0,0,15000 --quiet --gamma 2.2 --out =5-5-usual.png",
            "render @fine.npy --size 160 --tolerance 0.05 --flights 500000 --star 0,0,0,15000 --quiet --gamma 2.2 --out =5-5-fine.png",
            "render @clumps.npy --size 160 --tolerance 0.05 --flights 500000 --star 0,0,0,15000 --quiet --gamma 2.2 --out =5-5-clumps.png",
            "render @hollow.npy --size 160 --tolerance 0.05 --flights 500000 --star 0,0,0,15000 --quiet --gamma 2.2 --out =5-5-hollow.png",
        ],
        pictures: &["5-5-broad.png", "5-5-usual.png", "5-5-fine.png", "5-5-clumps.png", "5-5-hollow.png"],
    },
    Figure {
        number: "5.6",
        what: "four stars in a cloud before a field of stars, which it dims and reddens",
        lines: &[
            "generate --seed 12 --size 80 --amplitude 2 --persistence 0.6 --cavity 0.08 --cavity-wall 0.2 --star 0,0,0.1 --star=-0.3,0.2,0.2 \
             --star 0.3,-0.1,0.3 --star 0.1,-0.35,0 --quiet --out @cocoon.npy",
            "render @cocoon.npy --size 240x200 --width 2.2 --tolerance 0.05 --flights 500000 --extinction 4.5,6,7.9 --star 0,0,0.1,20000 --star=-0.3,0.2,0.2,15000 \
             --star 0.3,-0.1,0.3,12000 --star 0.1,-0.35,0,12000 --quiet --out @light.npy --through @through.npy",
            "develop @light.npy --through @through.npy --background stars:6 --gamma 2.2 --out =5-6.png",
        ],
        pictures: &["5-6.png"],
    },
    Figure {
        number: "5.7, around",
        what: "a nebula with five stars from outside: reddish, with dark dense dust",
        lines: &[
            "generate --seed 21 --size 80 --amplitude 2.2 --persistence 0.6 --cavity 0.06 --cavity-wall 0.15 --star 0,0,0 --star=-0.4,0.3,0.2 \
             --star 0.4,-0.2,0.3 --star 0.1,-0.4,-0.3 --star=-0.2,-0.3,-0.4 --quiet --out @five.npy",
            "render @five.npy --view perspective --eye 0,1,4 --fov-deg 34 --size 160 --tolerance 0.05 --flights 500000 --extinction 6,8,10.6 --star 0,0,0 \
             --star=-0.4,0.3,0.2 --star 0.4,-0.2,0.3 --star 0.1,-0.4,-0.3 --star=-0.2,-0.3,-0.4 --quiet --gamma 2.2 --out =5-7-around-1.png",
            "render @five.npy --view perspective --eye 4,1,0 --fov-deg 34 --size 160 --tolerance 0.05 --flights 500000 --extinction 6,8,10.6 --star 0,0,0 \
             --star=-0.4,0.3,0.2 --star 0.4,-0.2,0.3 --star 0.1,-0.4,-0.3 --star=-0.2,-0.3,-0.4 --quiet --gamma 2.2 --out =5-7-around-2.png",
            "render @five.npy --view perspective --eye 0,1,-4 --fov-deg 34 --size 160 --tolerance 0.05 --flights 500000 --extinction 6,8,10.6 --star 0,0,0 \
             --star=-0.4,0.3,0.2 --star 0.4,-0.2,0.3 --star 0.1,-0.4,-0.3 --star=-0.2,-0.3,-0.4 --quiet --gamma 2.2 --out =5-7-around-3.png",
        ],
        pictures: &["5-7-around-1.png", "5-7-around-2.png", "5-7-around-3.png"],
    },
    Figure {
        number: "5.7, through",
        what: "into a nebula with one star: from reddish outside to bluish within, where light comes back from thin dust; last as a domemaster",
        lines: &[
            "generate --seed 8 --size 80 --amplitude 1.6 --level 0.5 --cavity 0.25 --cavity-wall 0.3 --quiet --out @one.npy",
            "render @one.npy --view perspective --eye 0,0.6,3.6 --fov-deg 38 --size 160 --tolerance 0.05 --flights 500000 --quiet --gamma 2.2 --out =5-7-through-1.png",
            "render @one.npy --view perspective --eye 0,0.2,0.9 --fov-deg 70 --size 160 --tolerance 0.05 --flights 500000 --quiet --gamma 2.2 --out =5-7-through-2.png",
            "render @one.npy --view perspective --eye 0,0,0.05 --look-at 1,0.2,0.4 --fov-deg 90 --size 160 --tolerance 0.05 --flights 500000 --quiet --gamma 2.2 \
             --out =5-7-through-3.png",
            "render @one.npy --view domemaster --eye 0.2,-0.1,0.3 --look-at 0,1,0 --up 0,0,1 --size 200 --tolerance 0.05 --flights 500000 --quiet --gamma 2.2 \
             --out =5-7-dome.png",
        ],
        pictures: &["5-7-through-1.png", "5-7-through-2.png", "5-7-through-3.png", "5-7-dome.png"],
    },
];

/// The words of a line, with its files in two folders.
fn words(line: &str, own: &Path, out: &Path) -> Vec<std::ffi::OsString> {
    let word = |word: &str| match (word.strip_prefix('@'), word.strip_prefix('=')) {
        (Some(name), _) => own.join(name).into_os_string(),
        (_, Some(name)) => out.join(name).into_os_string(),
        _ => word.into(),
    };
    std::iter::once("nebula".into()).chain(line.split_whitespace().map(word)).collect()
}

/// A line as a person types it.
fn typed(line: &str) -> String {
    let word = |word: &str| word.trim_start_matches(['@', '=']).to_owned();
    format!("scotopic nebula {}", line.split_whitespace().map(word).collect::<Vec<_>>().join(" "))
}

/// Makes all pictures and the page.
///
/// # Errors
/// A file could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure::failed(format!("{}: {error}", arguments.out.display()));
    std::fs::create_dir_all(&arguments.out).map_err(failed)?;
    let own = std::env::temp_dir().join(format!("scotopic-gallery-{}", std::process::id()));
    std::fs::create_dir_all(&own).map_err(failed)?;
    let count: usize = FIGURES.iter().map(|figure| figure.lines.len()).sum();
    let mut bar = Bar::new("the gallery");
    let mut made = Ok(());
    for (done, line) in FIGURES.iter().flat_map(|figure| figure.lines).enumerate() {
        bar.show(done as f64 / count as f64);
        made = Line::try_parse_from(words(line, &own, &arguments.out))
            .map_err(Failure::failed)
            .and_then(|line| execute(&line.command))
            .map_err(|error| Failure::failed(format!("{}: {error}", typed(line))));
        if made.is_err() {
            break;
        }
    }
    bar.end();
    // Volumes of a few megabytes: a folder that cannot be removed is the system's to clear.
    let _ = std::fs::remove_dir_all(&own);
    made?;
    std::fs::write(arguments.out.join("README.md"), page()).map_err(failed)?;
    let pictures: usize = FIGURES.iter().map(|figure| figure.pictures.len()).sum();
    answer(&format!("{pictures} pictures and README.md in {}", arguments.out.display()))
}

/// The page that shows the pictures.
fn page() -> String {
    let mut text = String::from(
        "# Reflection nebulae\n\n\
         Made by `scotopic nebula gallery --out docs/gallery/nebula`; each figure by the lines under it. All pictures have light scattered any\n\
         number of times, are normalised each for itself, and have a gamma of 2.2. Stars with a temperature are black bodies, the others white.\n",
    );
    for figure in FIGURES {
        // Writing to a string does not fail.
        let _ = write!(text, "\n## Figure {}\n\nShows {}.\n\n", figure.number, figure.what);
        for name in figure.pictures {
            let _ = writeln!(text, "![{name}]({name})");
        }
        let _ = writeln!(text, "\n```sh");
        for line in figure.lines {
            let _ = writeln!(text, "{}", typed(line));
        }
        let _ = writeln!(text, "```");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_one_that_the_program_takes_and_the_page_in_the_documents_is_this_one() {
        for figure in FIGURES {
            for line in figure.lines {
                let parsed = Line::try_parse_from(words(line, Path::new("own"), Path::new("out")));
                assert!(parsed.is_ok(), "{line}: {parsed:?}");
            }
            for name in figure.pictures {
                let path = Path::new("docs/gallery/nebula").join(name);
                assert!(path.is_file(), "{name}: run `scotopic nebula gallery --out docs/gallery/nebula`");
                assert!(figure.lines.iter().any(|line| line.contains(&format!("={name}"))), "{name}");
            }
        }
        assert_eq!(std::fs::read_to_string("docs/gallery/nebula/README.md").unwrap(), page());
    }
}
