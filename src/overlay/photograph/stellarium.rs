//! Stellarium's set of pictures as it lies on disk: its index of files, corners and credits.

use glam::DVec2;

use super::corners::Pair;
use super::read::{clean, picture};
use super::relaxed_json::{self, JsonError, Value};
use super::{Photograph, PhotographError, Plate};
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// Where the pictures of a set are told under which terms they may be used.
pub mod credits;
/// From the names of files to those of objects.
pub mod names;

/// Largest index that is read: Stellarium's own has 200 KB.
pub const MOST_INDEX_BYTES: u64 = 4 << 20;
/// Most pictures of a set.
const MOST_TILES: usize = 4096;

/// One picture of the set, before its file is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// The file's name in the folder of the index; never a path.
    pub file: String,
    /// Who took it.
    pub credit: Option<String>,
    /// Where it comes from.
    pub url: Option<String>,
    /// Places in the picture, in shares of its width from the left and of its height from the bottom, and theirs on the sky.
    corners: [(DVec2, Equatorial<J2000>); 4],
}

impl Tile {
    /// The file's name without its ending.
    #[must_use]
    pub fn stem(&self) -> &str {
        self.file.rsplit_once('.').map_or(&self.file, |(stem, _)| stem)
    }

    /// The plate of a picture of so many pixels, and the greatest distance by which it misses a corner.
    ///
    /// # Errors
    /// Corners that no picture can have.
    pub fn plate(&self, width: usize, height: usize) -> Result<(Plate, Angle), PhotographError> {
        let (width, height) = (width as f64, height as f64);
        let pixel = |share: DVec2| DVec2::new(share.x * width, (1.0 - share.y) * height);
        Plate::of_pairs(&self.corners.map(|(share, sky)| -> Pair { (pixel(share), sky) }))
    }

    /// The middle on the sky and the distance to the farthest corner, as far as they can be told without the file.
    ///
    /// # Errors
    /// Corners that no picture can have.
    pub fn circle(&self) -> Result<(Equatorial<J2000>, Angle), PhotographError> {
        let (plate, _) = self.plate(1000, 1000)?;
        let middle = plate.position(500.0, 500.0);
        let radius = self.corners.iter().map(|(_, sky)| sky.separation(&middle)).fold(Angle::ZERO, Angle::max);
        Ok((middle, radius))
    }

    /// The photograph in the file's bytes.
    ///
    /// # Errors
    /// What is wrong with the file or its corners.
    pub fn photograph(&self, bytes: &[u8]) -> Result<Photograph, PhotographError> {
        let picture = picture(bytes)?;
        let (plate, miss) = self.plate(picture.width(), picture.height())?;
        let mut photograph = Photograph::new(self.stem().to_owned(), self.credit.clone(), plate, picture);
        photograph.url.clone_from(&self.url);
        photograph.miss = Some(miss);
        Ok(photograph)
    }
}

/// Why a set's index cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IndexError {
    /// It is no JSON, however loosely taken.
    #[error("the set's index cannot be read: {0}; install the package stellarium-data anew")]
    Json(#[from] JsonError),
    /// It is JSON of something else.
    #[error("the set's index has no list subTiles: give the folder in which Stellarium's textures.json lies")]
    NoTiles,
}

/// The pictures of an index, and a sentence for each that cannot be used. At most 4096 are taken.
///
/// # Errors
/// No index of Stellarium.
pub fn index(text: &str) -> Result<(Vec<Tile>, Vec<String>), IndexError> {
    let value = relaxed_json::read(text)?;
    let Some(Value::List(all)) = value.member("subTiles") else { return Err(IndexError::NoTiles) };
    let (mut tiles, mut notes) = (Vec::new(), Vec::new());
    for (place, value) in all.iter().take(MOST_TILES).enumerate() {
        match tile(value) {
            Ok(tile) => tiles.push(tile),
            Err(why) => notes.push(format!("picture {place} of the set is left out: {why}")),
        }
    }
    if all.len() > MOST_TILES {
        notes.push(format!("the set has {} pictures: the first {MOST_TILES} are taken", all.len()));
    }
    Ok((tiles, notes))
}

fn tile(value: &Value) -> Result<Tile, String> {
    let file = value.member("imageUrl").and_then(Value::text).ok_or("it has no imageUrl")?;
    let is_name = !file.is_empty() && !file.starts_with('.') && !file.contains(['/', '\\', ':', '\0']);
    if !is_name || clean(file) != file {
        return Err(format!("its imageUrl '{}' is no name of a file", clean(file)));
    }
    let four = |key: &str| -> Result<[DVec2; 4], String> {
        let wrong = || format!("{file} has no four pairs of numbers in {key}");
        let lists = value.member(key).map(Value::list).unwrap_or_default();
        let [polygon] = lists else { return Err(wrong()) };
        let pair = |value: &Value| match value.list() {
            [x, y] => Some(DVec2::new(x.number()?, y.number()?)),
            _ => None,
        };
        let pairs: Option<Vec<DVec2>> = polygon.list().iter().map(pair).collect();
        pairs.and_then(|pairs| <[DVec2; 4]>::try_from(pairs).ok()).ok_or_else(wrong)
    };
    let sky = four("worldCoords")?;
    if let Some(wrong) = sky.iter().find(|sky| sky.x.abs() > 720.0 || sky.y.abs() > 90.0) {
        return Err(format!("{file} has a corner at {} {} degrees", wrong.x, wrong.y));
    }
    let shares = four("textureCoords")?;
    if !shares.iter().all(|share| share.abs().max_element() <= 16.0) {
        return Err(format!("{file} has a corner outside of itself"));
    }
    let place = |sky: DVec2| Equatorial::new(Angle::degrees(sky.x), Angle::degrees(sky.y));
    let of_credits = |key: &str| {
        let text = value.member("imageCredits").and_then(|credits| credits.member(key)).and_then(Value::text);
        text.map(clean).filter(|text| !text.is_empty())
    };
    Ok(Tile {
        file: file.to_owned(),
        credit: of_credits("short"),
        url: of_credits("infoUrl"),
        corners: [0, 1, 2, 3].map(|i| (shares[i], place(sky[i]))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two entries as they stand in Stellarium 0.22.2's file: one with a number that strict JSON forbids.
    const TWO: &str = r#"{
        "subTiles" : [
        {   "imageCredits" : {"Short" : "Starhopper", "infoUrl": "https://commons.wikimedia.org/wiki/File:M002.jpg"},
            "imageUrl" : "m2.png",
            "worldCoords" : [[[323.4989,-.9794], [323.22,-.9794], [323.2201,-.6994], [323.499,-.6994]]],
            "textureCoords" : [[[0,0], [1,0], [1,1], [0,1]]],
            "maxBrightness" : 13.9
        },
        {   "imageUrl" : "../../etc/passwd", "worldCoords" : [[]], "textureCoords" : [[]] }]
    }"#;

    #[test]
    fn a_loosely_written_index_gives_its_pictures_with_corners_and_credit() {
        let (tiles, notes) = index(TWO).unwrap();
        assert_eq!(tiles.len(), 1);
        let tile = &tiles[0];
        assert_eq!((tile.stem(), tile.credit.as_deref()), ("m2", Some("Starhopper")));
        assert!(notes[0].contains("no name of a file"), "{notes:?}");
        let (plate, miss) = tile.plate(512, 512).unwrap();
        assert!(miss.to_arcseconds() < 1.0);
        // The picture's lower left corner is the first: south and, north being up, east.
        let first = Equatorial::new(Angle::degrees(323.4989), Angle::degrees(-0.9794));
        assert!(plate.position(0.0, 512.0).separation(&first).to_arcseconds() < 1.0);
        // M2 (SIMBAD: 21 33 27.02 -00 49 23.7) is near its middle.
        let m2 = Equatorial::new(Angle::degrees(323.36258), Angle::degrees(-0.82325));
        assert!(plate.position(256.0, 256.0).separation(&m2).to_arcminutes() < 1.5);
    }

    #[test]
    fn other_files_are_refused_with_a_sentence() {
        assert_eq!(index("{}"), Err(IndexError::NoTiles));
        assert!(index("{\"subTiles\": [").unwrap_err().to_string().contains("line 1"));
        let (tiles, notes) = index("{\"subTiles\": [1, {\"imageUrl\": \"a.png\"}, {\"imageUrl\": \"a.png\", \"worldCoords\": [[[1,100],[1,2],[1,2],[1,2]]]}]}").unwrap();
        assert_eq!((tiles.len(), notes.len()), (0, 3));
    }
}
