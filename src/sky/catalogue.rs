//! The catalogues that are built into the program: Hipparcos, the faint stars to V 11, and OpenNGC.
//!
//! The star files are read in place. The text files (names, OpenNGC) are cut into rows once.

use std::sync::OnceLock;

use super::coords::{Equatorial, J2000};
use crate::units::{Angle, Magnitude};

/// The constellation of a position.
pub mod constellation;
/// OpenNGC as the program holds it.
mod deep_sky;
/// How far objects are.
pub mod distance;
/// What sort of thing an object is.
pub mod kind;
/// What the catalogue says of an object.
pub mod object;
/// How the files are made.
pub mod pack;
/// The hand controller's own places.
pub mod places;
/// Finding what a person means.
mod search;
/// The stars' names.
mod star_names;
/// The two star files.
mod stars;
/// The sky cut into square degrees.
mod tiles;

#[cfg(test)]
mod tests;

pub use distance::Distance;
pub use kind::Kind;
pub use object::{Band, FieldObject, FieldStar, Found, Object, StarId};

use deep_sky::DeepSkyCatalogue;
use places::Placed;
use search::{Index, Target};
use star_names::StarNames;
use stars::{Form, StarFile};
use tiles::Tiles;

/// Made by `scotopic catalogue pack`.
static HIPPARCOS: &[u8] = include_bytes!("catalogue/data/hipparcos.bin");
/// Made by `scotopic catalogue pack`.
static FAINT_STARS: &[u8] = include_bytes!("catalogue/data/faint_stars.bin");
/// Made by `scotopic catalogue pack`.
static STAR_NAMES: &str = include_str!("catalogue/data/star_names.tsv");
/// Made by `scotopic catalogue pack`; CC-BY-SA-4.0, unlike the program.
static OPENNGC: &str = include_str!("catalogue/data/openngc.tsv");

/// The program's own, opened at its first use.
static EMBEDDED: OnceLock<Catalogue> = OnceLock::new();

/// All catalogues, ready to be asked.
#[derive(Debug)]
pub struct Catalogue {
    tiles: Tiles,
    /// Hipparcos and the faint stars; a file that is not whole is left out (a test holds that both are).
    hipparcos: Option<StarFile>,
    faint: Option<StarFile>,
    /// In the order of the HIP numbers.
    star_names: Vec<StarNames>,
    deep_sky: DeepSkyCatalogue,
    index: OnceLock<Index>,
}

/// Why a search gave nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SearchError {
    /// No object has that name.
    #[error("'{text}' is not in the catalogue{}", offered(near))]
    NotFound {
        /// What was asked for, without control characters.
        text: String,
        /// Names that are spelt nearly so.
        near: Vec<String>,
    },
    /// A body of the solar system.
    #[error(
        "'{text}' moves among the stars, and this program knows the way only of Sun, Moon, Mercury to Neptune and the moons of Mars, \
         Jupiter, Saturn and Uranus: take its place from an almanac and give --ra and --dec"
    )]
    Moving {
        /// What was asked for.
        text: String,
    },
    /// Nothing was asked for.
    #[error("no name was given: type one such as M31, NGC 7662, Vega, alpha Cen, 61 Cyg or HIP 11767")]
    Empty,
}

/// The near misses as the end of a sentence.
fn offered(near: &[String]) -> String {
    if near.is_empty() {
        String::from("; try a number such as M31, NGC 7662 or HIP 11767, or give --ra and --dec")
    } else {
        format!("; did you mean {}?", near.join(", "))
    }
}

impl Catalogue {
    /// The catalogues built into the program.
    #[must_use]
    pub fn embedded() -> &'static Catalogue {
        EMBEDDED.get_or_init(Catalogue::open)
    }

    /// The same with the hand controller's own places of some objects. To be called before anybody asks for
    /// [`Catalogue::embedded`], which is this one from then on; `None`, and the places are not taken, if somebody has.
    #[must_use]
    pub fn embed_with(places: &[Placed]) -> Option<&'static Catalogue> {
        EMBEDDED.set(Catalogue::open_with(places)).ok().map(|()| Catalogue::embedded())
    }

    /// Opens the catalogues anew; the program needs only [`Catalogue::embedded`], which does it once.
    #[must_use]
    pub fn open() -> Catalogue {
        Catalogue::open_with(&[])
    }

    /// Opens them with the hand controller's own places of some objects; names that the catalogue does not have are left out, and
    /// of stars the catalogue's own places stay ([`Catalogue::not_placed`] names both).
    #[must_use]
    pub fn open_with(places: &[Placed]) -> Catalogue {
        let tiles = Tiles::new();
        Catalogue {
            hipparcos: StarFile::open(HIPPARCOS, Form::Hipparcos, &tiles),
            faint: StarFile::open(FAINT_STARS, Form::Faint, &tiles),
            star_names: StarNames::read_all(STAR_NAMES),
            deep_sky: DeepSkyCatalogue::read(OPENNGC, places, &tiles),
            index: OnceLock::new(),
            tiles,
        }
    }

    /// Names of a list whose places are not taken: nothing in the catalogue is called so, or it is a star.
    #[must_use]
    pub fn not_placed<'a>(&self, places: &'a [Placed]) -> Vec<&'a str> {
        let taken = |placed: &&Placed| {
            self.deep_sky.place(&placed.name).is_some_and(|index| self.deep_sky.objects[index].placed)
        };
        places.iter().filter(|placed| !taken(placed)).map(|placed| placed.name.as_str()).collect()
    }

    /// How many stars of Hipparcos, fainter stars, and deep-sky objects there are.
    #[must_use]
    pub fn counts(&self) -> (usize, usize, usize) {
        let stars = |file: &Option<StarFile>| file.as_ref().map_or(0, StarFile::len);
        (stars(&self.hipparcos), stars(&self.faint), self.deep_sky.objects.len())
    }

    /// The object that a person means by `text`: a Messier, NGC, IC, Caldwell, HIP or HD number, a proper name, or Bayer's or
    /// Flamsteed's designation in full, abbreviated or Greek. Of several stars with one designation it is the brightest (of nearly equal ones the first), unless
    /// the component is named (`alpha Cen B`).
    ///
    /// # Errors
    /// No such name, with names spelt nearly so.
    pub fn search(&self, text: &str) -> Result<Object, SearchError> {
        let text = search::clean(text);
        if text.is_empty() {
            return Err(SearchError::Empty);
        }
        if search::moves(&text) {
            return Err(SearchError::Moving { text });
        }
        let v_mag = |hip| self.place_of(hip).map_or(f32::MAX, |(file, star)| file.v_mag(star));
        let target = self.index().find(&text, v_mag);
        let found = target.and_then(|target| match target {
            Target::Star(hip) => self.star(StarId::Hipparcos(hip)),
            Target::DeepSky(index) => self.object(index),
        });
        found.ok_or_else(|| SearchError::NotFound { near: self.index().near(&text), text })
    }

    /// Up to `most` names that begin so, the best known first.
    #[must_use]
    pub fn complete(&self, prefix: &str, most: usize) -> Vec<String> {
        self.index().complete(&search::clean(prefix), most)
    }

    fn index(&self) -> &Index {
        self.index.get_or_init(|| Index::new(&self.star_names, &self.deep_sky))
    }

    /// What is within `radius` of `centre`, by the places at epoch J2000. Stars and objects fainter than `faintest` are left out;
    /// objects of unknown magnitude are kept.
    #[must_use]
    pub fn within(&self, centre: &Equatorial<J2000>, radius: Angle, faintest: Magnitude) -> Found {
        let radius = radius.max(Angle::ZERO).min(Angle::degrees(180.0));
        let mut found = Found::default();
        // A quantised place on the very edge of a tile may round into the next.
        let reach = (radius + Angle::arcseconds(1.0)).to_radians();
        for run in self.tiles.covering(centre.ra().to_radians(), centre.dec().to_radians(), reach) {
            for file in [&self.hipparcos, &self.faint].into_iter().flatten() {
                for tile in run.clone() {
                    self.stars_in(file, tile, centre, radius, faintest, &mut found.stars);
                }
            }
            for index in self.deep_sky.in_tiles(run.clone()) {
                let object = &self.deep_sky.objects[index];
                let separation = centre.separation(&object.position);
                if separation <= radius {
                    found.objects.push(object.in_field(index, separation));
                }
            }
        }
        found.objects.retain(|object| object.magnitude.is_none_or(|magnitude| magnitude <= faintest));
        found.stars.sort_by(|a, b| a.separation.to_radians().total_cmp(&b.separation.to_radians()));
        found.objects.sort_by(|a, b| a.separation.to_radians().total_cmp(&b.separation.to_radians()));
        found.reaching_in = self.reaching_in(centre, radius);
        found
    }

    fn stars_in(
        &self,
        file: &StarFile,
        tile: usize,
        centre: &Equatorial<J2000>,
        radius: Angle,
        faintest: Magnitude,
        stars: &mut Vec<FieldStar>,
    ) {
        for place in file.in_tile(tile) {
            // In each tile the brightest come first.
            if f64::from(file.v_mag(place)) > faintest.0 {
                break;
            }
            let Some(star) = file.star(place, tile, &self.tiles) else { break };
            if (star.astrometry.position.dec() - centre.dec()).abs() > radius {
                continue;
            }
            let separation = centre.separation(&star.astrometry.position);
            if separation <= radius {
                stars.push(FieldStar { separation, ..star });
            }
        }
    }

    /// Large objects whose centre is outside a circle but whose outline, taken as a circle, reaches in; nearest first.
    fn reaching_in(&self, centre: &Equatorial<J2000>, radius: Angle) -> Vec<FieldObject> {
        let mut found: Vec<FieldObject> = Vec::new();
        for index in &self.deep_sky.large {
            let object = &self.deep_sky.objects[*index];
            let separation = centre.separation(&object.position);
            if separation > radius && separation <= radius + object.reach() {
                found.push(object.in_field(*index, separation));
            }
        }
        found.sort_by(|a, b| a.separation.to_radians().total_cmp(&b.separation.to_radians()));
        found
    }

    /// The file and place of a star by its HIP number.
    fn place_of(&self, hip: u32) -> Option<(&StarFile, usize)> {
        let file = self.hipparcos.as_ref()?;
        file.by_hip(hip).map(|star| (file, star))
    }

    fn names_of(&self, hip: u32) -> Option<&StarNames> {
        let place = self.star_names.binary_search_by_key(&hip, |names| names.hip).ok()?;
        self.star_names.get(place)
    }

    /// All that is known of a star found in a field.
    #[must_use]
    pub fn star(&self, id: StarId) -> Option<Object> {
        let (file, place) = match id {
            StarId::Hipparcos(hip) => self.place_of(hip)?,
            StarId::Faint(place) => (self.faint.as_ref()?, place as usize),
        };
        if place >= file.len() {
            return None;
        }
        let star = file.star(place, file.tile_of(place, &self.tiles), &self.tiles)?;
        let names = match id {
            StarId::Hipparcos(hip) => self.names_of(hip).map_or_else(|| vec![format!("HIP {hip}")], StarNames::all),
            StarId::Faint(_) => vec![designation(&star.astrometry.position)],
        };
        Some(Object {
            name: names.first().cloned().unwrap_or_default(),
            names,
            kind: Kind::Star,
            hubble: None,
            astrometry: star.astrometry,
            magnitude: Some(Magnitude((f64::from(star.v_mag) * 100.0).round() / 100.0)),
            band: Band::V,
            colour_bv: star.colour_bv,
            axes_arcmin: None,
            position_angle: None,
            surface_brightness: None,
            distance: Distance::of_parallax(star.astrometry.parallax_mas),
            hand_controllers_place: false,
            constellation: constellation::at(&star.astrometry.position),
        })
    }

    /// All that is known of a deep-sky object found in a field.
    #[must_use]
    pub fn object(&self, index: usize) -> Option<Object> {
        let mut object = self.deep_sky.objects.get(index)?.object();
        if object.constellation.is_empty() {
            object.constellation = constellation::at(&object.astrometry.position);
        }
        Some(object)
    }

    /// The proper name, or else Bayer's or Flamsteed's designation, of a star that has one.
    #[must_use]
    pub fn star_name(&self, id: StarId) -> Option<String> {
        let StarId::Hipparcos(hip) = id else { return None };
        self.names_of(hip)?.all().into_iter().next().filter(|name| !name.starts_with("HIP "))
    }

    /// The name to show for any star: its proper name or designation, its HIP number, or its place.
    #[must_use]
    pub fn star_label(&self, star: &FieldStar) -> String {
        self.star_name(star.id).unwrap_or_else(|| match star.id {
            StarId::Hipparcos(hip) => format!("HIP {hip}"),
            StarId::Faint(_) => designation(&star.astrometry.position),
        })
    }
}

/// A name from the place at J2000, as the IAU wants it for sources without another: `J004244.3+411609`.
fn designation(position: &Equatorial<J2000>) -> String {
    let tenths = (position.ra().to_hours() * 36_000.0).floor() as u64;
    let arcseconds = position.dec().abs().to_arcseconds().floor() as u64;
    let sign = if position.dec().to_radians() < 0.0 { '-' } else { '+' };
    format!(
        "J{:02}{:02}{:02}.{}{sign}{:02}{:02}{:02}",
        tenths / 36_000,
        tenths / 600 % 60,
        tenths / 10 % 60,
        tenths % 10,
        arcseconds / 3600,
        arcseconds / 60 % 60,
        arcseconds % 60
    )
}
