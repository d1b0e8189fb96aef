//! Packs the stars: Hipparcos whole, and of Tycho-2 what Hipparcos has not, no star twice.

use std::collections::HashMap;

use super::{PackError, Packed, Sources, Table};
use crate::sky::catalogue::stars::{FAINT_MAGIC, HIPPARCOS_MAGIC, NO_COLOUR, NO_FAINT_COLOUR};
use crate::sky::catalogue::tiles::Tiles;
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// A star as the tables have it.
#[derive(Debug, Clone)]
struct Star<'a> {
    row: usize,
    hip: u32,
    tycho: &'a str,
    ra_deg: f64,
    dec_deg: f64,
    east: f64,
    north: f64,
    parallax: f64,
    v: f64,
    bv: Option<f64>,
    /// The position is Hipparcos' own, not one borrowed because Hipparcos found none.
    measured: bool,
}

/// Two entries nearer than this are one star whatever their magnitudes say.
const SAME_PLACE_ARCSEC: f64 = 0.5;
/// Two entries nearer than this, and of nearly one magnitude, are one star.
const SAME_STAR_ARCSEC: f64 = 2.0;
/// What "nearly one magnitude" is.
const SAME_STAR_MAG: f64 = 0.3;
/// Within this distance a Hipparcos entry without a solution of its own is looked for in Tycho-2.
const BORROW_ARCSEC: f64 = 8.0;
/// And with no larger difference of magnitude.
const BORROW_MAG: f64 = 0.8;

/// An entry mended by hand.
struct Mended {
    hip: u32,
    ra_deg: f64,
    dec_deg: f64,
    east: f64,
    north: f64,
    parallax: f64,
    v: f64,
}

/// HIP 115125 is 94 Aquarii B, whose row has no motion, its place of 1991.25, and the V of A. V: Washington Double Star
/// Catalog (Mason et al. 2001, AJ 122, 3466). Motion and parallax: those of A, HIP 115126 (van Leeuwen 2007), with which it goes;
/// the place is brought to 2000.0 with them.
const BY_HAND: [Mended; 1] = [Mended {
    hip: 115_125,
    ra_deg: 349.777_168,
    dec_deg: -13.454_812,
    east: 267.23,
    north: -46.21,
    parallax: 47.35,
    v: 6.97,
}];

/// Packs both files.
pub(super) fn pack(sources: &Sources<'_>, tiles: &Tiles, packed: &mut Packed) -> Result<(), PackError> {
    let mut bright = hipparcos(sources.hipparcos)?;
    let (mut faint, of_hipparcos) = tycho(sources.bigsky)?;
    packed.notes.push(format!("{of_hipparcos} rows of bigsky_mag11.csv bear a HIP number and are left out"));
    borrow(&mut bright, &mut faint, packed);
    for by_hand in BY_HAND {
        for star in bright.iter_mut().filter(|star| star.hip == by_hand.hip) {
            (star.ra_deg, star.dec_deg, star.v) = (by_hand.ra_deg, by_hand.dec_deg, by_hand.v);
            (star.east, star.north, star.parallax) = (by_hand.east, by_hand.north, by_hand.parallax);
            packed.notes.push(format!("HIP {} is mended by hand", star.hip));
        }
    }
    drop_twins(&bright, &mut faint, packed);
    packed.notes.push(format!("{} stars of Hipparcos, {} fainter ones", bright.len(), faint.len()));

    let order = |a: &Star<'_>, b: &Star<'_>| {
        let tile = |star: &Star<'_>| tiles.of(star.ra_deg, star.dec_deg);
        (tile(a), a.hip, a.tycho).cmp(&(tile(b), b.hip, b.tycho))
    };
    let brighter = |a: &Star<'_>, b: &Star<'_>| {
        tiles.of(a.ra_deg, a.dec_deg).cmp(&tiles.of(b.ra_deg, b.dec_deg)).then(a.v.total_cmp(&b.v)).then(order(a, b))
    };
    bright.sort_by(brighter);
    faint.sort_by(brighter);
    packed.hipparcos = write_hipparcos(&bright, tiles)?;
    packed.faint = write_faint(&faint, tiles)?;
    Ok(())
}

fn hipparcos(text: &str) -> Result<Vec<Star<'_>>, PackError> {
    let table = Table::new("hipparcos_merged.csv", ',', text);
    let (hip, ra, dec) =
        (table.column("hip")?, table.column("ra_deg_icrs_j2000")?, table.column("dec_deg_icrs_j2000")?);
    let (east, north, parallax) =
        (table.column("pmra_cosdec_masyr")?, table.column("pmdec_masyr")?, table.column("plx_mas")?);
    let (v, bv, source) = (table.column("vmag")?, table.column("bv")?, table.column("src")?);
    let mut stars = Vec::new();
    for row in table {
        stars.push(Star {
            row: row.number,
            hip: row.required(hip)? as u32,
            tycho: "",
            ra_deg: row.required(ra)?,
            dec_deg: row.required(dec)?,
            east: row.number(east)?.unwrap_or(0.0),
            north: row.number(north)?.unwrap_or(0.0),
            parallax: row.number(parallax)?.unwrap_or(0.0),
            v: row.required(v)?,
            bv: row.number(bv)?,
            measured: row.text(source) == "H",
        });
    }
    Ok(stars)
}

/// The stars of Tycho-2 without a HIP number, and how many rows have one.
fn tycho(text: &str) -> Result<(Vec<Star<'_>>, usize), PackError> {
    let table = Table::new("bigsky_mag11.csv", ',', text);
    let (id, hip, v, bv) =
        (table.column("tyc_id")?, table.column("hip")?, table.column("magnitude")?, table.column("bv")?);
    let (ra, dec) = (table.column("ra_degrees")?, table.column("dec_degrees")?);
    let (east, north) = (table.column("ra_mas_per_year")?, table.column("dec_mas_per_year")?);
    let (mut stars, mut of_hipparcos) = (Vec::new(), 0);
    for row in table {
        if !row.text(hip).is_empty() {
            of_hipparcos += 1;
            continue;
        }
        stars.push(Star {
            row: row.number,
            hip: 0,
            tycho: row.text(id),
            ra_deg: row.required(ra)?,
            dec_deg: row.required(dec)?,
            east: row.number(east)?.unwrap_or(0.0),
            north: row.number(north)?.unwrap_or(0.0),
            parallax: 0.0,
            v: row.required(v)?,
            bv: row.number(bv)?,
            measured: true,
        });
    }
    Ok((stars, of_hipparcos))
}

/// Hipparcos has no solution for 262 entries (xi UMa, xi Sco...): their rows have a rough place, no motion, and for xi UMa
/// the light of two stars. Tycho-2 measured most of them: take its place, motion and magnitude, and drop its row.
fn borrow(bright: &mut [Star<'_>], faint: &mut Vec<Star<'_>>, packed: &mut Packed) {
    let near = Neighbours::of(faint);
    let mut taken = vec![false; faint.len()];
    let mut borrowed = 0;
    for star in bright.iter_mut().filter(|star| !star.measured) {
        let found = near
            .within(star, BORROW_ARCSEC)
            .into_iter()
            .filter(|other| !taken[*other] && (faint[*other].v - star.v).abs() < BORROW_MAG)
            .min_by(|a, b| faint[*a].v.total_cmp(&faint[*b].v));
        let Some(found) = found else { continue };
        let twin = &faint[found];
        (star.ra_deg, star.dec_deg, star.east, star.north) = (twin.ra_deg, twin.dec_deg, twin.east, twin.north);
        if star.v < 6.0 {
            packed
                .notes
                .push(format!("HIP {} is given the place, motion and V {} of TYC {}", star.hip, twin.v, twin.tycho));
        }
        (star.v, star.bv) = (twin.v, twin.bv.or(star.bv));
        taken[found] = true;
        borrowed += 1;
    }
    packed.notes.push(format!("{borrowed} entries without a Hipparcos solution are given Tycho-2's"));
    let mut keep = taken.into_iter().map(|taken| !taken);
    faint.retain(|_| keep.next().unwrap_or(true));
}

/// Drops from the faint stars those that are in Hipparcos already, or twice in Tycho-2. The components of one Tycho-2 entry
/// (same number but for the last digit) were resolved on purpose and stay.
fn drop_twins(bright: &[Star<'_>], faint: &mut Vec<Star<'_>>, packed: &mut Packed) {
    let same = |a: &Star<'_>, b: &Star<'_>| {
        let distance = arcseconds(a, b);
        distance < SAME_PLACE_ARCSEC || (distance < SAME_STAR_ARCSEC && (a.v - b.v).abs() < SAME_STAR_MAG)
    };
    let mut drop = vec![false; faint.len()];
    let in_hipparcos = Neighbours::of(bright);
    for (place, star) in faint.iter().enumerate() {
        drop[place] = in_hipparcos.within(star, SAME_STAR_ARCSEC).iter().any(|other| same(star, &bright[*other]));
    }
    let first = drop.iter().filter(|dropped| **dropped).count();
    let in_tycho = Neighbours::of(faint);
    for (place, star) in faint.iter().enumerate() {
        let entry = |star: &Star<'_>| star.tycho.rsplit_once('-').map(|(entry, _)| entry.to_owned());
        let twice = in_tycho.within(star, SAME_STAR_ARCSEC).into_iter().any(|other| {
            let twin = &faint[other];
            other != place
                && !drop[other]
                && (twin.v, other) < (star.v, place)
                && entry(twin) != entry(star)
                && same(star, twin)
        });
        drop[place] |= twice;
    }
    let all = drop.iter().filter(|dropped| **dropped).count();
    packed
        .notes
        .push(format!("{first} stars of Tycho-2 are in Hipparcos already, {} twice in Tycho-2: dropped", all - first));
    let mut keep = drop.into_iter().map(|dropped| !dropped);
    faint.retain(|_| keep.next().unwrap_or(true));
}

fn position(star: &Star<'_>) -> Equatorial<J2000> {
    Equatorial::new(Angle::degrees(star.ra_deg), Angle::degrees(star.dec_deg))
}

fn arcseconds(a: &Star<'_>, b: &Star<'_>) -> f64 {
    position(a).separation(&position(b)).to_arcseconds()
}

/// Stars by cubes of their direction, a hundredth of a degree or so wide.
struct Neighbours<'a, 'b> {
    stars: &'a [Star<'b>],
    cubes: HashMap<[i32; 3], Vec<usize>>,
}

impl<'a, 'b> Neighbours<'a, 'b> {
    const CUBES: f64 = 5000.0;

    fn cube(star: &Star<'_>) -> [i32; 3] {
        (position(star).direction() * Self::CUBES).to_array().map(|part| part.floor() as i32)
    }

    fn of(stars: &'a [Star<'b>]) -> Neighbours<'a, 'b> {
        let mut cubes: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
        for (place, star) in stars.iter().enumerate() {
            cubes.entry(Self::cube(star)).or_default().push(place);
        }
        Neighbours { stars, cubes }
    }

    /// The places of the stars within some arcseconds (fewer than a cube has: 41).
    fn within(&self, star: &Star<'_>, radius_arcsec: f64) -> Vec<usize> {
        let [x, y, z] = Self::cube(star);
        let mut found = Vec::new();
        for (dx, dy, dz) in (0..27).map(|n| (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)) {
            let Some(places) = self.cubes.get(&[x + dx, y + dy, z + dz]) else { continue };
            found.extend(places.iter().filter(|place| arcseconds(star, &self.stars[**place]) < radius_arcsec));
        }
        found.sort_unstable();
        found
    }
}

/// Magic, counts, and the first star of each tile.
fn head(magic: &[u8; 8], stars: &[Star<'_>], tiles: &Tiles) -> Vec<u8> {
    let mut bytes = magic.to_vec();
    bytes.extend((tiles.count() as u32).to_le_bytes());
    bytes.extend((stars.len() as u32).to_le_bytes());
    let mut star = 0;
    for tile in 0..=tiles.count() {
        while star < stars.len() && tiles.of(stars[star].ra_deg, stars[star].dec_deg) < tile {
            star += 1;
        }
        bytes.extend((star as u32).to_le_bytes());
    }
    bytes
}

fn write_hipparcos(stars: &[Star<'_>], tiles: &Tiles) -> Result<Vec<u8>, PackError> {
    let mut bytes = head(HIPPARCOS_MAGIC, stars, tiles);
    for star in stars {
        let fits = |what, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value.round()) {
                Ok(value.round())
            } else {
                Err(PackError::Range { table: "hipparcos_merged.csv", row: star.row, what, value })
            }
        };
        let long = |what, value: f64| fits(what, value, f64::from(i32::MIN), f64::from(i32::MAX)).map(|v| v as i32);
        let short = |what, value: f64| fits(what, value, -32_767.0, 32_767.0).map(|v| v as i16);
        bytes.extend(star.hip.to_le_bytes());
        bytes.extend((fits("ra", star.ra_deg * 3.6e6, 0.0, f64::from(u32::MAX))? as u32).to_le_bytes());
        bytes.extend(long("dec", star.dec_deg * 3.6e6)?.to_le_bytes());
        bytes.extend(long("pm east", star.east * 100.0)?.to_le_bytes());
        bytes.extend(long("pm north", star.north * 100.0)?.to_le_bytes());
        bytes.extend(long("parallax", star.parallax * 100.0)?.to_le_bytes());
        bytes.extend(short("V", star.v * 100.0)?.to_le_bytes());
        let bv = star.bv.map(|bv| short("B-V", bv * 1000.0)).transpose()?.unwrap_or(NO_COLOUR);
        bytes.extend(bv.to_le_bytes());
    }
    let mut order: Vec<u32> = (0..stars.len() as u32).collect();
    order.sort_by_key(|star| stars[*star as usize].hip);
    for star in order {
        bytes.extend(star.to_le_bytes());
    }
    Ok(bytes)
}

fn write_faint(stars: &[Star<'_>], tiles: &Tiles) -> Result<Vec<u8>, PackError> {
    let mut bytes = head(FAINT_MAGIC, stars, tiles);
    for star in stars {
        let edges = tiles.edges(tiles.of(star.ra_deg, star.dec_deg));
        let step = |part: f64| ((part * 65_536.0).floor().clamp(0.0, 65_535.0) as u16).to_le_bytes();
        let short = |what, value: f64| {
            if value.round().abs() <= 32_767.0 {
                Ok((value.round() as i16).to_le_bytes())
            } else {
                Err(PackError::Range { table: "bigsky_mag11.csv", row: star.row, what, value })
            }
        };
        bytes.extend(step((star.ra_deg.rem_euclid(360.0) - edges.west_deg) / edges.width_deg));
        bytes.extend(step(star.dec_deg - edges.south_deg));
        bytes.extend(short("V", star.v * 100.0)?);
        bytes.push(star.bv.map_or(NO_FAINT_COLOUR, |bv| ((bv + 0.5) / 0.02).round().clamp(0.0, 254.0) as u8));
        bytes.extend(short("pm east", star.east)?);
        bytes.extend(short("pm north", star.north)?);
    }
    Ok(bytes)
}
