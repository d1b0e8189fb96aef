//! The observer's own photographs and Stellarium's set, of which a file is read when its part of the sky is looked at.

use std::ffi::OsStr;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::cli::Failure;
use crate::overlay::Photograph;
use crate::overlay::photograph::stellarium::credits::Credits;
use crate::overlay::photograph::stellarium::{MOST_INDEX_BYTES, Tile, index, names};
use crate::sky::catalogue::Catalogue;
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// Pixels of read photographs that are kept: some 300 MB of them.
const MOST_KEPT_PIXELS: usize = 20 << 20;
/// Most photographs of the set in one field.
const MOST_IN_FIELD: usize = 12;
/// A photograph of which a pixel is a larger share of the field's radius is left out.
const COARSEST: f64 = 1.0 / 30.0;

/// Which photographs there are.
#[derive(Debug, Default)]
pub struct Album {
    own: Vec<Photograph>,
    set: Vec<Member>,
    folder: PathBuf,
    soften_stars: f32,
    /// Read members by their places in the set, the one used last at the end.
    kept: Vec<(usize, Photograph)>,
    /// A sentence for each file that could not be used.
    pub notes: Vec<String>,
}

/// A picture of the set, perhaps not yet read.
#[derive(Debug)]
struct Member {
    tile: Tile,
    middle: Equatorial<J2000>,
    radius: Angle,
    licence: String,
    broken: bool,
}

/// Where an album is found.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sources<'a> {
    /// The folder of the observer's own.
    pub folder: Option<&'a Path>,
    /// Stellarium's folder, or `none`; where nothing is said it is looked for.
    pub stellarium: Option<&'a Path>,
    /// How much of the stars' light is taken away, 0 to 1.
    pub soften_stars: f32,
}

impl Album {
    /// Opens an album: the own photographs are read, of the set only its index.
    ///
    /// # Errors
    /// A folder that was named cannot be read.
    pub fn open(sources: Sources) -> Result<Album, Failure> {
        let mut album = Album { soften_stars: sources.soften_stars, ..Album::default() };
        if let Some(folder) = sources.folder {
            let (own, notes) = super::read_folder(folder)?;
            album.notes.extend(notes);
            for photograph in own {
                let photograph = album.own_prepared(photograph);
                album.own.push(photograph);
            }
        }
        let index_file = match sources.stellarium {
            Some(none) if none.file_name() == Some(OsStr::new("none")) => None,
            Some(named) => Some(in_folder(named).ok_or_else(|| {
                Failure::Failed(format!(
                    "there is no textures.json in {}, nor in nebulae/default below it: give Stellarium's folder, or none",
                    named.display()
                ))
            })?),
            None => installed(),
        };
        if let Some(file) = index_file {
            album.open_set(&file)?;
        }
        Ok(album)
    }

    fn own_prepared(&mut self, photograph: Photograph) -> Photograph {
        let catalogue = Catalogue::embedded();
        let object = match &photograph.object {
            Some(name) => catalogue
                .search(name)
                .map_err(|error| self.notes.push(format!("the photograph {}: {error}", photograph.name)))
                .ok(),
            None => names::foremost(&photograph.middle(), photograph.radius(), catalogue),
        };
        photograph.prepared(object.as_ref(), self.soften_stars)
    }

    fn open_set(&mut self, file: &Path) -> Result<(), Failure> {
        let unreadable = |why: &dyn std::fmt::Display| Failure::Failed(format!("{}: {why}", file.display()));
        let bytes = bounded(fs::File::open(file).map_err(|error| unreadable(&error))?);
        let text = bytes.map_err(|error| unreadable(&error))?;
        let (tiles, notes) = index(&text).map_err(|error| unreadable(&error))?;
        self.notes.extend(notes);
        self.folder = file.parent().unwrap_or(Path::new("")).to_owned();
        let credits = credits_near(&self.folder);
        for tile in tiles {
            match tile.circle() {
                Ok((middle, radius)) => {
                    let licence = credits.licence(tile.stem(), tile.credit.as_deref()).to_owned();
                    self.set.push(Member { tile, middle, radius, licence, broken: false });
                }
                Err(why) => self.notes.push(format!("the photograph {} is not drawn: {why}", tile.file)),
            }
        }
        Ok(())
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.own.is_empty() && self.set.is_empty()
    }

    /// The photographs that reach into a circle on the sky: the observer's own, and of the set those that are fine enough for a
    /// circle of that size. Files are read when they are met first; one that cannot be read leaves a note.
    pub fn reaching(&mut self, centre: &Equatorial<J2000>, radius: Angle) -> Vec<Photograph> {
        let reaches = |middle: &Equatorial<J2000>, reach: Angle| middle.separation(centre) <= radius + reach;
        let mut found: Vec<Photograph> =
            self.own.iter().filter(|own| reaches(&own.middle(), own.radius())).cloned().collect();
        let mut met: Vec<usize> = (0..self.set.len())
            .filter(|&place| !self.set[place].broken && reaches(&self.set[place].middle, self.set[place].radius))
            .collect();
        // The smallest are the finest.
        met.sort_by(|a, b| self.set[*a].radius.to_radians().total_cmp(&self.set[*b].radius.to_radians()));
        for place in met.into_iter().take(MOST_IN_FIELD) {
            let fine =
                |photograph: &Photograph| photograph.plate.scale().to_radians() <= COARSEST * radius.to_radians();
            found.extend(self.member(place).filter(fine));
        }
        found
    }

    /// A picture of the set by its place, read if it was not.
    fn member(&mut self, place: usize) -> Option<Photograph> {
        if let Some(kept) = self.kept.iter().position(|(kept, _)| *kept == place) {
            let used = self.kept.remove(kept);
            self.kept.push(used);
            return self.kept.last().map(|(_, photograph)| photograph.clone());
        }
        match self.read(place) {
            Ok(photograph) => {
                self.kept.push((place, photograph.clone()));
                let pixels = |kept: &[(usize, Photograph)]| -> usize {
                    kept.iter().map(|(_, photograph)| photograph.size().0 * photograph.size().1).sum()
                };
                while self.kept.len() > 1 && pixels(&self.kept) > MOST_KEPT_PIXELS {
                    self.kept.remove(0);
                }
                Some(photograph)
            }
            Err(note) => {
                self.set[place].broken = true;
                self.notes.push(note);
                None
            }
        }
    }

    fn read(&self, place: usize) -> Result<Photograph, String> {
        let member = &self.set[place];
        let path = self.folder.join(&member.tile.file);
        let not_drawn = |why: &dyn std::fmt::Display| format!("the photograph {} is not drawn: {why}", path.display());
        let bytes = super::bounded(&path).map_err(|why| not_drawn(&why))?;
        let mut photograph = member.tile.photograph(&bytes).map_err(|why| not_drawn(&why))?;
        photograph.licence = Some(member.licence.clone());
        let object = names::subject(member.tile.stem(), &member.middle, member.radius, Catalogue::embedded());
        Ok(photograph.prepared(object.as_ref(), self.soften_stars))
    }

    /// All photographs, one after another, those of the set read as they come.
    pub(super) fn each(&self) -> impl Iterator<Item = Result<Photograph, String>> + '_ {
        let own = self.own.iter().cloned().map(Ok);
        own.chain((0..self.set.len()).map(|place| self.read(place)))
    }
}

/// The index of Stellarium's set in a folder: its own, or the root of Stellarium's data.
fn in_folder(folder: &Path) -> Option<PathBuf> {
    [folder.join("textures.json"), folder.join("nebulae/default/textures.json")].into_iter().find(|file| file.is_file())
}

/// The index of an installed Stellarium, among the system's data (`XDG_DATA_DIRS`).
fn installed() -> Option<PathBuf> {
    let folders = std::env::var_os("XDG_DATA_DIRS").filter(|folders| !folders.is_empty());
    let folders = folders.unwrap_or_else(|| "/usr/local/share:/usr/share".into());
    std::env::split_paths(&folders).find_map(|folder| in_folder(&folder.join("stellarium")))
}

/// The credits that lie where a package puts them: `share/doc` beside `share/stellarium`, or among the pictures.
fn credits_near(folder: &Path) -> Credits {
    let documents = folder.ancestors().nth(3).map(|share| share.join("doc"));
    let candidates = documents.iter().flat_map(|documents| {
        ["stellarium-data", "stellarium"]
            .into_iter()
            .flat_map(|package| ["CREDITS.md.gz", "CREDITS.md"].map(|file| documents.join(package).join(file)))
    });
    for file in std::iter::once(folder.join("CREDITS.md")).chain(candidates) {
        let Ok(opened) = fs::File::open(&file) else { continue };
        let packed = file.extension() == Some(OsStr::new("gz"));
        let text = if packed { bounded(flate2::read::GzDecoder::new(opened)) } else { bounded(opened) };
        if let Ok(text) = text {
            return Credits::read(&text);
        }
    }
    Credits::default()
}

/// Text that is not too large.
fn bounded(from: impl Read) -> std::io::Result<String> {
    let mut text = String::new();
    let read = from.take(MOST_INDEX_BYTES + 1).read_to_string(&mut text)?;
    if read as u64 > MOST_INDEX_BYTES {
        return Err(std::io::Error::other(format!("it has more than {MOST_INDEX_BYTES} bytes")));
    }
    Ok(text)
}
