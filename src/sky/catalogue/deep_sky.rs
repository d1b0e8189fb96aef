//! OpenNGC as the program holds it: the text file's rows with their numbers read, and a rough index by place.

use std::collections::HashMap;

use super::distance::Distance;
use super::kind::Kind;
use super::object::{Band, FieldObject, Object};
use super::places::Placed;
use super::tiles::Tiles;
use crate::sky::astrometry::Astrometry;
use crate::sky::coords::{Equatorial, J2000};
use crate::units::{Angle, Magnitude, SurfaceBrightness};

/// A row of the file; the text stays where it is in the program.
#[derive(Debug, Clone)]
pub(super) struct DeepSky {
    /// Names cut by semicolons, the one to show first.
    pub(super) names: &'static str,
    pub(super) herschel_400: bool,
    pub(super) kind: Kind,
    pub(super) position: Equatorial<J2000>,
    pub(super) constellation: &'static str,
    pub(super) axes_arcmin: Option<(f64, f64)>,
    pub(super) position_angle: Option<Angle>,
    pub(super) b: Option<f64>,
    pub(super) v: Option<f64>,
    pub(super) hubble: Option<&'static str>,
    /// Whether the position is the hand controller's.
    pub(super) placed: bool,
}

impl DeepSky {
    fn read(line: &'static str) -> Option<DeepSky> {
        let mut cells = line.split('\t');
        let (names, lists, kind) = (cells.next()?, cells.next()?, cells.next()?);
        let mut number = || cells.next().map(|cell| cell.parse::<f64>().ok());
        let (ra, dec) = (number()??, number()??);
        let constellation = cells.next()?;
        let mut number = || cells.next().map(|cell| cell.parse::<f64>().ok());
        let (major, minor, angle, b, v) = (number()?, number()?, number()?, number()?, number()?);
        let hubble = cells.next().filter(|text| !text.is_empty());
        Some(DeepSky {
            names,
            herschel_400: lists == "H400",
            kind: Kind::from_code(kind),
            position: Equatorial::new(Angle::degrees(ra), Angle::degrees(dec)),
            constellation,
            // OpenNGC leaves the minor axis of a round object empty.
            axes_arcmin: major.map(|major| (major, minor.unwrap_or(major))),
            position_angle: angle.map(Angle::degrees),
            b,
            v,
            hubble,
            placed: false,
        })
    }

    /// The name to show.
    pub(super) fn name(&self) -> &'static str {
        self.names.split(';').next().unwrap_or(self.names)
    }

    fn magnitude(&self) -> (Option<Magnitude>, Band) {
        let band = if self.v.is_none() && self.b.is_some() { Band::B } else { Band::V };
        (self.v.or(self.b).map(Magnitude), band)
    }

    /// Half the major axis.
    pub(super) fn reach(&self) -> Angle {
        self.axes_arcmin.map_or(Angle::ZERO, |(major, _)| Angle::arcminutes(major / 2.0))
    }

    pub(super) fn object(&self) -> Object {
        let (magnitude, band) = self.magnitude();
        let mut names: Vec<String> = self.names.split(';').map(str::to_owned).collect();
        if self.herschel_400 {
            names.push(String::from("Herschel 400"));
        }
        let surface_brightness = match (self.v, self.axes_arcmin) {
            (Some(v), Some((major, minor))) if major > 0.0 && minor > 0.0 => {
                Some(SurfaceBrightness::of_ellipse(Magnitude(v), major, minor))
            }
            _ => None,
        };
        Object {
            name: self.name().to_owned(),
            names,
            kind: self.kind,
            hubble: self.hubble,
            astrometry: Astrometry::fixed(self.position),
            magnitude,
            band,
            colour_bv: self.b.zip(self.v).map(|(b, v)| (b - v) as f32),
            axes_arcmin: self.axes_arcmin,
            position_angle: self.position_angle,
            surface_brightness,
            distance: Distance::listed(self.names.split(';')),
            hand_controllers_place: self.placed,
            constellation: self.constellation,
        }
    }

    pub(super) fn in_field(&self, index: usize, separation: Angle) -> FieldObject {
        let (magnitude, band) = self.magnitude();
        FieldObject {
            name: self.name(),
            kind: self.kind,
            position: self.position,
            magnitude,
            band,
            axes_arcmin: self.axes_arcmin,
            position_angle: self.position_angle,
            separation,
            index,
        }
    }
}

/// Lays the hand controller's places over the catalogue's.
fn lay_over(objects: &mut [DeepSky], places: &[Placed]) {
    if places.is_empty() {
        return;
    }
    let wanted: HashMap<String, &Placed> = places.iter().map(|placed| (plain(&placed.name), placed)).collect();
    for object in objects {
        if let Some(placed) = object.names.split(';').find_map(|own| wanted.get(&plain(own))) {
            (object.position, object.placed) = (placed.position, true);
        }
    }
}

/// A name without spaces, in small letters.
fn plain(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect()
}

/// All objects, in the order of the file, and their places by tile.
#[derive(Debug)]
pub(super) struct DeepSkyCatalogue {
    pub(super) objects: Vec<DeepSky>,
    /// Objects ordered by tile.
    by_tile: Vec<(usize, usize)>,
    /// Objects with a reach of more than [`LARGE`].
    pub(super) large: Vec<usize>,
}

/// Objects of a larger half axis are looked at one by one in every query.
pub(super) const LARGE: Angle = Angle::degrees(0.25);

impl DeepSkyCatalogue {
    pub(super) fn read(text: &'static str, places: &[Placed], tiles: &Tiles) -> DeepSkyCatalogue {
        let rows = text.lines().filter(|line| !line.starts_with('#'));
        let mut objects: Vec<DeepSky> = rows.filter_map(DeepSky::read).collect();
        lay_over(&mut objects, places);
        let tile = |object: &DeepSky| tiles.of(object.position.ra().to_degrees(), object.position.dec().to_degrees());
        let mut by_tile: Vec<(usize, usize)> =
            objects.iter().enumerate().map(|(index, object)| (tile(object), index)).collect();
        by_tile.sort_unstable();
        let large = (0..objects.len()).filter(|index| objects[*index].reach() > LARGE).collect();
        DeepSkyCatalogue { objects, by_tile, large }
    }

    /// The object of that name, whatever its spaces and case.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        let wanted = plain(name);
        self.objects.iter().position(|object| object.names.split(';').any(|own| plain(own) == wanted))
    }

    /// Objects whose centre is in a run of tiles.
    pub(super) fn in_tiles(&self, run: std::ops::Range<usize>) -> impl Iterator<Item = usize> + '_ {
        let start = self.by_tile.partition_point(|entry| entry.0 < run.start);
        self.by_tile[start..].iter().take_while(move |entry| entry.0 < run.end).map(|entry| entry.1)
    }
}
