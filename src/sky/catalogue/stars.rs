//! The two star files, read in place: nothing is unpacked before it is asked for.
//!
//! Both files: 8 bytes of magic, u32 tiles, u32 stars, u32 first star of each tile and the number of stars, then the stars, tile
//! by tile and in each tile the brightest first. The Hipparcos file ends with the stars' places in the order of their HIP
//! numbers. All numbers are little-endian.

use super::object::{FieldStar, StarId};
use super::tiles::Tiles;
use crate::sky::astrometry::Astrometry;
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// First bytes of the Hipparcos file.
pub(super) const HIPPARCOS_MAGIC: &[u8; 8] = b"SCOTHIP1";
/// First bytes of the file of faint stars.
pub(super) const FAINT_MAGIC: &[u8; 8] = b"SCOTFNT1";
/// Bytes of a star in the Hipparcos file.
pub(super) const HIPPARCOS_BYTES: usize = 28;
/// Bytes of a star in the file of faint stars.
pub(super) const FAINT_BYTES: usize = 11;
/// A colour index that is not known, in the Hipparcos file (thousandths of a magnitude).
pub(super) const NO_COLOUR: i16 = i16::MIN;
/// A colour index that is not known, in the file of faint stars (steps of 0.02 magnitude above -0.5).
pub(super) const NO_FAINT_COLOUR: u8 = 255;

/// How the stars of a file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// u32 HIP, u32 right ascension and i32 declination in milliarcseconds, i32 motions east and north and i32 parallax in
    /// hundredths of a milliarcsecond, i16 V in hundredths, i16 B-V in thousandths.
    Hipparcos,
    /// u16 steps east and north in the tile (0.055 arcsecond), i16 V in hundredths, u8 B-V, i16 motions in milliarcseconds a
    /// year.
    Faint,
}

impl Form {
    fn bytes(self) -> usize {
        match self {
            Form::Hipparcos => HIPPARCOS_BYTES,
            Form::Faint => FAINT_BYTES,
        }
    }
}

/// One of the two files.
#[derive(Debug, Clone, Copy)]
pub(super) struct StarFile {
    bytes: &'static [u8],
    form: Form,
    stars: usize,
    /// Where the stars begin.
    start: usize,
}

impl StarFile {
    /// Opens a file; `None` if it is not whole.
    pub(super) fn open(bytes: &'static [u8], form: Form, tiles: &Tiles) -> Option<StarFile> {
        let magic = match form {
            Form::Hipparcos => HIPPARCOS_MAGIC,
            Form::Faint => FAINT_MAGIC,
        };
        let stars = u32_at(bytes, 12)? as usize;
        let start = 16 + 4 * (tiles.count() + 1);
        let order = if form == Form::Hipparcos { 4 * stars } else { 0 };
        let whole = bytes.starts_with(magic)
            && u32_at(bytes, 8)? as usize == tiles.count()
            && bytes.len() == start + stars * form.bytes() + order;
        whole.then_some(StarFile { bytes, form, stars, start })
    }

    pub(super) fn len(&self) -> usize {
        self.stars
    }

    /// The places of the stars of a tile.
    pub(super) fn in_tile(&self, tile: usize) -> std::ops::Range<usize> {
        let edge = |tile: usize| u32_at(self.bytes, 16 + 4 * tile).map_or(0, |star| star as usize).min(self.stars);
        edge(tile)..edge(tile + 1)
    }

    /// V magnitude of a star, alone: to leave out faint stars quickly.
    pub(super) fn v_mag(&self, star: usize) -> f32 {
        let at = self.start + star * self.form.bytes();
        let offset = if self.form == Form::Hipparcos { 24 } else { 4 };
        f32::from(i16_at(self.bytes, at + offset).unwrap_or(i16::MAX)) / 100.0
    }

    /// A star of this tile.
    pub(super) fn star(&self, star: usize, tile: usize, tiles: &Tiles) -> Option<FieldStar> {
        let record = self.bytes.get(self.start + star * self.form.bytes()..)?;
        let v_mag = self.v_mag(star);
        let (id, astrometry, colour_bv) = match self.form {
            Form::Hipparcos => {
                let milliarcseconds = |value: f64| Angle::arcseconds(value / 1000.0);
                let hundredths = |at: usize| i32_at(record, at).map(|value| f64::from(value) / 100.0);
                let position = Equatorial::new(
                    milliarcseconds(f64::from(u32_at(record, 4)?)),
                    milliarcseconds(f64::from(i32_at(record, 8)?)),
                );
                let colour = Some(i16_at(record, 26)?).filter(|bv| *bv != NO_COLOUR);
                let astrometry = Astrometry {
                    position,
                    pm_east_mas_yr: hundredths(12)?,
                    pm_north_mas_yr: hundredths(16)?,
                    parallax_mas: hundredths(20)?,
                };
                (StarId::Hipparcos(u32_at(record, 0)?), astrometry, colour.map(|bv| f32::from(bv) / 1000.0))
            }
            Form::Faint => {
                let edges = tiles.edges(tile);
                let part = |at: usize| i16_at(record, at).map(|raw| (f64::from(raw as u16) + 0.5) / 65_536.0);
                let position: Equatorial<J2000> = Equatorial::new(
                    Angle::degrees(edges.west_deg + part(0)? * edges.width_deg),
                    Angle::degrees(edges.south_deg + part(2)?),
                );
                let colour = Some(*record.get(6)?).filter(|bv| *bv != NO_FAINT_COLOUR);
                let astrometry = Astrometry {
                    position,
                    pm_east_mas_yr: f64::from(i16_at(record, 7)?),
                    pm_north_mas_yr: f64::from(i16_at(record, 9)?),
                    parallax_mas: 0.0,
                };
                (StarId::Faint(u32::try_from(star).ok()?), astrometry, colour.map(|bv| f32::from(bv) * 0.02 - 0.5))
            }
        };
        Some(FieldStar { id, astrometry, v_mag, colour_bv, separation: Angle::ZERO })
    }

    /// The tile of a star.
    pub(super) fn tile_of(&self, star: usize, tiles: &Tiles) -> usize {
        let (mut low, mut high) = (0, tiles.count());
        while high - low > 1 {
            let middle = (low + high) / 2;
            if self.in_tile(middle).start <= star { low = middle } else { high = middle }
        }
        low
    }

    /// The place of a star by its HIP number, in the Hipparcos file.
    pub(super) fn by_hip(&self, hip: u32) -> Option<usize> {
        let order = self.start + self.stars * HIPPARCOS_BYTES;
        let place = |nth: usize| u32_at(self.bytes, order + 4 * nth).map(|star| star as usize);
        let number = |star: usize| u32_at(self.bytes, self.start + star * HIPPARCOS_BYTES);
        let (mut low, mut high) = (0, self.stars);
        while low < high {
            let middle = (low + high) / 2;
            let star = place(middle)?;
            match number(star)?.cmp(&hip) {
                std::cmp::Ordering::Equal => return Some(star),
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Greater => high = middle,
            }
        }
        None
    }
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes)
}

fn i32_at(bytes: &[u8], at: usize) -> Option<i32> {
    bytes.get(at..at + 4)?.try_into().ok().map(i32::from_le_bytes)
}

fn i16_at(bytes: &[u8], at: usize) -> Option<i16> {
    bytes.get(at..at + 2)?.try_into().ok().map(i16::from_le_bytes)
}
