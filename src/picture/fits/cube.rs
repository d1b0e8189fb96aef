//! Cubes: FITS images of three axes, read and written number by number, so that a large one is never in memory twice.

use std::io::{Read, Write};

use super::{BLOCK, Cards, MOST_CARDS, MOST_UNITS, cards, data_bytes, number, text};
use crate::picture::cube::{Cube, CubeError, Kind, checked, read_values, write_values};

/// Reads the first image of three axes (more, if those are 1 long) from a file of so many bytes.
///
/// Voxels need not be cubes: their sides are CDELT1 to CDELT3 without signs (or those of the diagonal CDi_i), if all three have one
/// unit. CUNIT of degrees beside km/s says nothing of lengths, and the spacing is left open.
///
/// # Errors
/// What is wrong with the file, and what to do.
pub fn read(from: &mut impl Read, length: u64) -> Result<Cube, CubeError> {
    let mut there = length;
    for unit in 0..MOST_UNITS {
        let Some((cards, header)) = header(from, unit == 0)? else { break };
        there = there.saturating_sub(header);
        let axes = number(&cards, "NAXIS").unwrap_or(0.0);
        let plain = !cards.contains_key("XTENSION") || text(&cards, "XTENSION") == Some("IMAGE");
        if plain && axes >= 3.0 {
            return cube(&cards, from, there);
        }
        let data = data_bytes(&cards).map_err(|error| CubeError::Header(error.to_string()))? as u64;
        if std::io::copy(&mut from.take(data), &mut std::io::sink())? < data {
            break;
        }
        there = there.saturating_sub(data);
    }
    Err(CubeError::Header(
        "it has no image of three axes (compressed ones are not read: run `funpack` on it first)".into(),
    ))
}

/// The next header, and its length; nothing at the end of the file.
fn header(from: &mut impl Read, first: bool) -> Result<Option<(Cards, u64)>, CubeError> {
    let mut bytes = Vec::new();
    while bytes.len() < MOST_CARDS * 80 {
        let before = bytes.len();
        from.take(BLOCK as u64).read_to_end(&mut bytes)?;
        if first && !bytes.starts_with(b"SIMPLE  =") {
            return Err(CubeError::Kind("FITS"));
        }
        if bytes.len() < before + BLOCK {
            return if bytes.is_empty() { Ok(None) } else { Err(broken()) };
        }
        if bytes[before..].chunks_exact(80).any(|card| card.starts_with(b"END     ")) {
            let (cards, length) = cards(&bytes).map_err(|_no_end| broken())?;
            return Ok(Some((cards, length as u64)));
        }
    }
    Err(broken())
}

fn broken() -> CubeError {
    CubeError::Header("it breaks off before its END card: fetch it again".into())
}

fn cube(cards: &Cards, from: &mut impl Read, there: u64) -> Result<Cube, CubeError> {
    let whole = |key: &str| number(cards, key).filter(|n| *n >= 0.0 && n.fract() == 0.0).map_or(0, |n| n as u64);
    let axes = whole("NAXIS").min(999);
    let sides: Vec<u64> = (1..=axes).map(|axis| whole(&format!("NAXIS{axis}"))).collect();
    let (three, rest) = sides.split_at(3.min(sides.len()));
    let &[x, y, z] = three else { return Err(CubeError::Shape(sides)) };
    if rest.iter().any(|side| *side != 1) {
        return Err(CubeError::Shape(sides));
    }
    let bitpix = number(cards, "BITPIX").unwrap_or(0.0);
    let kind = match bitpix as i64 {
        8 => Kind::U8,
        16 => Kind::I16,
        32 => Kind::I32,
        -32 => Kind::F32,
        -64 => Kind::F64,
        other => return Err(CubeError::Numbers(format!("BITPIX {other}"))),
    };
    let size = checked([x, y, z], kind, there)?;
    let scale = number(cards, "BSCALE").unwrap_or(1.0);
    let zero = number(cards, "BZERO").unwrap_or(0.0);
    let blank = number(cards, "BLANK").filter(|_| bitpix > 0.0);
    let make = |stored: f64| if Some(stored) == blank { f64::NAN } else { zero + scale * stored };
    let values = read_values(from, size.iter().product(), kind, true, make)?;
    Ok(Cube { size, spacing: spacing(cards), values })
}

fn spacing(cards: &Cards) -> Option<[f64; 3]> {
    let unit = |axis: usize| text(cards, &format!("CUNIT{axis}")).unwrap_or_default();
    if unit(1) != unit(2) || unit(2) != unit(3) {
        return None;
    }
    let step = |axis: usize| number(cards, &format!("CDELT{axis}")).or(number(cards, &format!("CD{axis}_{axis}")));
    let steps = [step(1)?, step(2)?, step(3)?].map(f64::abs);
    steps.iter().all(|step| *step > 0.0).then_some(steps)
}

/// Writes a cube, f32, with the sides of its voxels as CDELT1 to CDELT3.
///
/// The centre of the box is the reference point, at 0, 0, 0.
///
/// # Errors
/// The disk's.
pub fn write(to: &mut impl Write, size: [usize; 3], spacing: [f64; 3], values: &[f32]) -> Result<(), CubeError> {
    let mut header = String::new();
    let mut card = |text: String| header += &format!("{text:<80}");
    card("SIMPLE  =                    T".into());
    card(format!("{:<8}= {:>20}", "BITPIX", -32));
    card(format!("{:<8}= {:>20}", "NAXIS", 3));
    for (axis, side) in (1..).zip(size) {
        card(format!("{:<8}= {side:>20}", format!("NAXIS{axis}")));
    }
    for (axis, (step, side)) in (1..).zip(spacing.into_iter().zip(size)) {
        card(format!("{:<8}= {step:>20?}", format!("CDELT{axis}")));
        card(format!("{:<8}= {:>20?}", format!("CRPIX{axis}"), 0.5 * (side as f64 + 1.0)));
        card(format!("{:<8}= {:>20?}", format!("CRVAL{axis}"), 0.0));
    }
    card("END".into());
    header += &" ".repeat(header.len().next_multiple_of(BLOCK) - header.len());
    to.write_all(header.as_bytes())?;
    write_values(to, values, true)?;
    let bytes = values.len() * 4;
    to.write_all(&vec![0; bytes.next_multiple_of(BLOCK) - bytes])?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn file(cards: &[&str], data: &[u8]) -> Vec<u8> {
        let all = ["SIMPLE  = T"].iter().chain(cards).chain(&["END"]);
        let mut bytes: Vec<u8> = all.flat_map(|card| format!("{card:<80}").into_bytes()).collect();
        bytes.resize(bytes.len().next_multiple_of(BLOCK), b' ');
        bytes.extend_from_slice(data);
        bytes
    }

    fn read_all(bytes: &[u8]) -> Result<Cube, CubeError> {
        read(&mut &*bytes, bytes.len() as u64)
    }

    #[test]
    fn what_is_written_comes_back_with_voxels_that_are_not_cubes() {
        let values: Vec<f32> = (0..24u8).map(f32::from).collect();
        let mut bytes = Vec::new();
        write(&mut bytes, [4, 3, 2], [0.5, 0.25, 2.0], &values).unwrap();
        assert_eq!(bytes.len() % BLOCK, 0);
        assert_eq!(read_all(&bytes).unwrap(), Cube { size: [4, 3, 2], spacing: Some([0.5, 0.25, 2.0]), values });
    }

    #[test]
    fn blank_numbers_are_nan_and_scaled_ones_are_scaled() {
        let cards = ["BITPIX  = 16", "NAXIS   = 4", "NAXIS1  = 2", "NAXIS2  = 1", "NAXIS3  = 1", "NAXIS4  = 1"];
        let cards = [&cards[..], &["BSCALE  = 0.5", "BZERO   = 10.0", "BLANK   = -1"]].concat();
        let cube = read_all(&file(&cards, &[0, 3, 0xFF, 0xFF])).unwrap();
        assert!(cube.values[0] == 11.5 && cube.values[1].is_nan() && cube.spacing.is_none());
    }

    #[test]
    fn a_velocity_axis_is_no_length_and_missing_axes_or_numbers_are_told() {
        let cards = ["BITPIX  = -32", "NAXIS   = 3", "NAXIS1  = 1", "NAXIS2  = 1", "NAXIS3  = 1"];
        let steps = [
            "CDELT1  = -0.1",
            "CDELT2  = 0.1",
            "CDELT3  = 3.0",
            "CUNIT1  = 'deg'",
            "CUNIT2  = 'deg'",
            "CUNIT3  = 'km/s'",
        ];
        let cube = read_all(&file(&[&cards[..], &steps].concat(), &[0; 4])).unwrap();
        assert_eq!(cube.spacing, None);
        let flat = read_all(&file(&["BITPIX  = 8", "NAXIS   = 2", "NAXIS1  = 1", "NAXIS2  = 1"], &[0; BLOCK]));
        assert!(flat.unwrap_err().to_string().contains("three axes"));
        let short = read_all(&file(&cards, &[0; 2])).unwrap_err();
        assert_eq!(short, CubeError::Truncated { needed: 4, there: 2 });
        let spectra = ["BITPIX  = -32", "NAXIS   = 4", "NAXIS1  = 1", "NAXIS2  = 1", "NAXIS3  = 1", "NAXIS4  = 2"];
        assert_eq!(read_all(&file(&spectra, &[0; 8])).unwrap_err(), CubeError::Shape(vec![1, 1, 1, 2]));
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(damage in prop::collection::vec((0usize..3000, any::<u8>()), 1..30), keep in 0usize..3200) {
            let mut bytes = Vec::new();
            write(&mut bytes, [2, 3, 4], [1.0; 3], &[0.0; 24]).unwrap();
            for (at, value) in damage {
                bytes[at] = value;
            }
            bytes.truncate(keep);
            let _ = read_all(&bytes);
        }
    }
}
