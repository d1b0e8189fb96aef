//! Numbered frames in a folder: made by any number of machines, begun again where they broke off.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::cli::Failure;
use crate::picture::apng::Apng;

/// A machine's part of a sequence: every N-th frame, from the I-th.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Counted from 1.
    number: usize,
    of: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { number: 1, of: 1 };

    /// Whether a frame, counted from 0, is in it.
    #[must_use]
    pub fn has(self, frame: usize) -> bool {
        frame % self.of == self.number - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let wrong = || format!("'{text}': give I/N, such as 2/5 for the second of five machines");
        let (number, of) = text.split_once('/').ok_or_else(wrong)?;
        let [number, of] = [number, of].map(|part| part.trim().parse::<usize>().ok());
        match (number, of) {
            (Some(number), Some(of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
            _ => Err(wrong()),
        }
    }
}

/// The folder of a sequence.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
    frames: usize,
}

/// The file that says what the frames of a folder show.
const SETTINGS: &str = "flight.txt";
/// So much of a line of it is told.
const LONGEST_SAID: usize = 200;

impl Folder {
    /// Makes the folder if it is not there.
    ///
    /// # Errors
    /// It cannot be made, or it has frames of another flight.
    pub fn open(path: &Path, frames: usize, settings: &str) -> Result<Folder, Failure> {
        let failed = |error: std::io::Error| Failure::failed(format!("{}: {error}", path.display()));
        std::fs::create_dir_all(path).map_err(failed)?;
        let folder = Folder { path: path.to_path_buf(), frames };
        match std::fs::read_to_string(path.join(SETTINGS)) {
            Ok(there) if there == settings => {}
            Ok(there) => {
                let pair = there.lines().zip(settings.lines()).find(|(there, here)| there != here);
                let (there, here) = pair.unwrap_or(("", ""));
                let [there, here] = [there, here].map(|line| line.chars().take(LONGEST_SAID).collect::<String>());
                return Err(Failure::asked(format!(
                    "{}: its frames are of another flight ({} there, {} now): give another folder, or empty this one",
                    path.display(),
                    crate::cli::printable(&there),
                    crate::cli::printable(&here)
                )));
            }
            Err(_not_there) => folder.save(SETTINGS, settings.as_bytes())?,
        }
        Ok(folder)
    }

    /// Where a frame is, with an ending.
    #[must_use]
    pub fn frame(&self, number: usize, ending: &str) -> PathBuf {
        self.path.join(format!("frame-{number:05}.{ending}"))
    }

    /// Whether a frame is there.
    #[must_use]
    pub fn has(&self, number: usize, ending: &str) -> bool {
        self.frame(number, ending).is_file()
    }

    /// How many frames are not there yet, of all machines.
    #[must_use]
    pub fn missing(&self, ending: &str) -> usize {
        (0..self.frames).filter(|number| !self.has(*number, ending)).count()
    }

    /// Writes a frame, or what belongs to one: `tail` stands behind its number.
    ///
    /// # Errors
    /// The disk's.
    pub fn save_frame(&self, number: usize, tail: &str, bytes: &[u8]) -> Result<(), Failure> {
        self.save(&format!("frame-{number:05}{tail}"), bytes)
    }

    /// Writes a file of the folder whole or not at all: under another name first, so that nobody takes half of it for a frame.
    ///
    /// # Errors
    /// The disk's.
    fn save(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.path.join(name);
        let part = self.path.join(format!(".{name}.{}.part", std::process::id()));
        let write = || {
            let mut file = File::create(&part)?;
            file.write_all(bytes)?;
            file.sync_all()?;
            std::fs::rename(&part, &path)
        };
        write().map_err(|error| {
            // What was begun is of no use to anybody.
            let _ = std::fs::remove_file(&part);
            Failure::failed(format!("{}: {error}", path.display()))
        })
    }

    /// All frames as one animated PNG.
    ///
    /// # Errors
    /// A frame is missing or broken, or the file could not be written.
    pub fn animate(&self, to: &Path, frame_ms: u16) -> Result<(), Failure> {
        let failed = |error: &dyn std::fmt::Display| Failure::failed(format!("{}: {error}", to.display()));
        let mut apng: Option<Apng<BufWriter<File>>> = None;
        for number in 0..self.frames {
            let path = self.frame(number, "png");
            let broken = |error: image::ImageError| Failure::failed(format!("{}: {error}", path.display()));
            let image = image::open(&path).map_err(broken)?.into_rgb8();
            let (width, height) = (image.width() as usize, image.height() as usize);
            let apng = match &mut apng {
                Some(apng) => apng,
                None => {
                    let file = BufWriter::new(File::create(to).map_err(|error| failed(&error))?);
                    let begun =
                        Apng::begin(file, width, height, self.frames, frame_ms).map_err(|error| failed(&error))?;
                    apng.insert(begun)
                }
            };
            let codes: Vec<[u8; 3]> = image.pixels().map(|pixel| pixel.0).collect();
            apng.frame(&codes).map_err(|error| failed(&error))?;
        }
        apng.map_or(Ok(()), |apng| apng.end().map_err(|error| failed(&error)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_out_every_frame_once() {
        let shards: Vec<Shard> = (1..=3).map(|i| format!("{i}/3").parse().unwrap()).collect();
        for frame in 0..20 {
            assert_eq!(shards.iter().filter(|shard| shard.has(frame)).count(), 1);
        }
        assert!((0..9).all(|frame| Shard::WHOLE.has(frame)));
        for wrong in ["0/3", "4/3", "1", "1/0", "-1/2", "a/b"] {
            assert!(wrong.parse::<Shard>().unwrap_err().contains(wrong), "{wrong}");
        }
    }
}
