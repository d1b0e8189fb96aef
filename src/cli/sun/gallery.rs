//! `scotopic sun gallery`: the thesis' figures of the Sun, made again, and a page that shows each with its command line.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, Parser};

use super::progress::Bar;
use super::render;
use crate::cli::{Failure, answer};

/// Where the gallery goes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Example:\n  scotopic sun gallery --out docs/gallery/sun")]
pub struct Arguments {
    /// Folder for the pictures and README.md; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// A picture's command line, without `scotopic sun`.
#[derive(Debug, Parser)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Render(Box<render::Arguments>),
}

/// A figure: its number, what it shows, and the arguments of its pictures.
struct Figure {
    number: &'static str,
    what: &'static str,
    /// Arguments that all its pictures have.
    common: &'static str,
    /// File name, and the arguments that each has for itself.
    pictures: &'static [(&'static str, &'static str)],
}

/// The figures. The climates' extinction is the thesis' (1 - g) law.
const FIGURES: &[Figure] = &[
    Figure {
        number: "Standard",
        what: "not in the thesis: clean standard air, the lower limb on the horizon, from the beach, from 60 m, and the first in colours \
               as a display would show them (`--tone srgb`)",
        common: "--size 240",
        pictures: &[
            ("standard-2m.png", ""),
            ("standard-60m.png", "--observer-height-m 60"),
            ("standard-srgb.png", "--tone srgb --white 3e8"),
        ],
    },
    Figure {
        number: "4.1",
        what: "polluted maritime climate, 80 % humidity, minutes before sunset",
        common: "--climate maritime-polluted --humidity 80 --less-forward --sky --white 2e4 --size 360x240 --field-arcmin 90",
        pictures: &[("4-1.png", "--sun-altitude-arcmin 0")],
    },
    Figure {
        number: "4.7",
        what: "polluted urban climate, 80 % humidity",
        common: "--climate urban --humidity 80 --less-forward --sky --white 2e4 --size 360x240 --field-arcmin 90",
        pictures: &[("4-7.png", "--sun-altitude-arcmin 60")],
    },
    Figure {
        number: "4.8",
        what: "continental climate, 70 % humidity; the thesis does not say which: the average one is taken",
        common: "--climate continental-average --humidity 70 --less-forward --sky --white 2e4 --size 360x240 --field-arcmin 90",
        pictures: &[("4-8.png", "--sun-altitude-arcmin 10")],
    },
    Figure {
        number: "4.9",
        what: "continental climate (average, as above), humidity 50, 80 and 95 %: it darkens",
        common: "--climate continental-average --less-forward --sun-altitude-arcmin 30 --size 240",
        pictures: &[("4-9-50.png", "--humidity 50"), ("4-9-80.png", "--humidity 80"), ("4-9-95.png", "--humidity 95")],
    },
    Figure {
        number: "4.10",
        what: "tropical maritime climate, humidity 80 and 90 %",
        common: "--climate maritime-tropical --less-forward --sun-altitude-arcmin 0 --size 240",
        pictures: &[("4-10-80.png", "--humidity 80"), ("4-10-90.png", "--humidity 90")],
    },
    Figure {
        number: "4.11",
        what: "an omega sunset: hot air at the ground",
        common: "--preset omega --bottom-arcmin -10 --size 200",
        pictures: &[
            ("4-11-a.png", "--sun-altitude-arcmin -18"),
            ("4-11-b.png", "--sun-altitude-arcmin -22"),
            ("4-11-c.png", "--sun-altitude-arcmin -26"),
            ("4-11-d.png", "--sun-altitude-arcmin -30"),
            ("4-11-e.png", "--sun-altitude-arcmin -38"),
        ],
    },
    Figure {
        number: "4.13",
        what: "the red flash below the Sun: a weak inversion 10 m below the eye at 45 m; from picture to picture the Sun is 0.4' lower",
        common: "--preset weak-inversion --bottom-arcmin -14 --size 240",
        pictures: &[
            ("4-13-a.png", "--sun-altitude-arcmin -32.0"),
            ("4-13-b.png", "--sun-altitude-arcmin -32.4"),
            ("4-13-c.png", "--sun-altitude-arcmin -32.8"),
        ],
    },
    Figure {
        number: "4.14",
        what: "the green flash of the same mirage, the Sun lower; 0.3' or less from picture to picture, magnified",
        common: "--preset weak-inversion --field-arcmin 10 --bottom-arcmin -13 --size 480x160 --white 3e8 --wavelengths 48",
        pictures: &[
            ("4-14-a.png", "--sun-altitude-arcmin -64.5"),
            ("4-14-b.png", "--sun-altitude-arcmin -64.8"),
            ("4-14-c.png", "--sun-altitude-arcmin -65.05"),
        ],
    },
    Figure {
        number: "More",
        what: "not in the thesis: Bruton's inversion, the desert's image below the Sun, the green flash over a warm sea (magnified)",
        common: "",
        pictures: &[
            ("bruton.png", "--preset bruton --size 240"),
            ("desert.png", "--preset desert --field-arcmin 56 --size 240"),
            (
                "green-flash.png",
                "--preset green-flash --field-arcmin 5 --bottom-arcmin -5.5 --size 480x160 --white 1e8 --wavelengths 48",
            ),
        ],
    },
];

impl Figure {
    /// The arguments of a picture, but for the file.
    fn arguments(&self, own: &str) -> String {
        format!("{} {own}", self.common).trim().to_owned()
    }
}

/// Makes all pictures and the page.
///
/// # Errors
/// A file could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure::failed(format!("{}: {error}", arguments.out.display()));
    std::fs::create_dir_all(&arguments.out).map_err(failed)?;
    let count: usize = FIGURES.iter().map(|figure| figure.pictures.len()).sum();
    let mut bar = Bar::new("pictures");
    let mut done = 0;
    for figure in FIGURES {
        for (name, own) in figure.pictures {
            bar.show(done as f64 / count as f64);
            let path = arguments.out.join(name);
            let words = figure.arguments(own);
            let words =
                ["sun", "render"].into_iter().chain(words.split_whitespace()).chain(["--no-fits", "--quiet", "--out"]);
            let line =
                Line::try_parse_from(words.map(Into::into).chain([path.into_os_string()])).map_err(Failure::failed)?;
            let Command::Render(picture) = line.command;
            render::answer_of(&picture)?;
            done += 1;
        }
    }
    bar.show(1.0);
    bar.end();
    std::fs::write(arguments.out.join("README.md"), page()).map_err(failed)?;
    answer(&format!("{count} pictures and README.md in {}", arguments.out.display()))
}

/// The page that shows the pictures.
fn page() -> String {
    let mut text = String::from(
        "# The low Sun\n\n\
         Made by `scotopic sun gallery --out docs/gallery/sun`; each picture alone by the line beside it. Altitudes are true ones, of\n\
         the Sun's centre. Only figures 4.1, 4.7 and 4.8 have a sky; the other discs stand before black. White is said where it is not the Sun's above the air; within a figure it is the same, so that pictures can be\n\
         compared.\n",
    );
    for figure in FIGURES {
        let number = if figure.number.starts_with('4') { "Figure " } else { "" };
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "\n## {number}{}\n\nShows {}.\n\n| picture | command |\n| --- | --- |\n",
            figure.number, figure.what
        );
        for (name, own) in figure.pictures {
            let words = figure.arguments(own);
            let space = if words.is_empty() { "" } else { " " };
            let _ = writeln!(text, "| ![{name}]({name}) | `scotopic sun render {words}{space}--out {name}` |");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_one_that_the_program_takes_and_the_page_in_the_documents_is_this_one() {
        for figure in FIGURES {
            for (name, own) in figure.pictures {
                let words = figure.arguments(own);
                let words = ["sun", "render"].into_iter().chain(words.split_whitespace()).chain(["--out", name]);
                assert!(Line::try_parse_from(words).is_ok(), "{name}");
                assert!(
                    std::path::Path::new("docs/gallery/sun").join(name).is_file(),
                    "{name}: run `scotopic sun gallery`"
                );
            }
        }
        assert_eq!(std::fs::read_to_string("docs/gallery/sun/README.md").unwrap(), page());
    }
}
