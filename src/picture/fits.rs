//! A small bounded reader of FITS images (FITS Standard 4.0): the first image of a file, uncompressed, as numbers and cards.
//!
//! Own code, because a photograph comes from anywhere and everything in it must be bounded before memory is asked for.

/// Volumes: images of three axes.
pub mod cube;
/// Writing images of three planes.
pub mod write;

use std::collections::HashMap;

/// Longest side that is read.
pub const LONGEST_SIDE: usize = 8192;
/// Bytes of a FITS block.
const BLOCK: usize = 2880;
/// Header cards beyond which a file is not believed.
const MOST_CARDS: usize = 4096;
/// Header units looked through for an image.
const MOST_UNITS: usize = 64;

/// Why a FITS file was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitsError {
    /// The first card is not SIMPLE.
    #[error("it does not begin as FITS files do")]
    NotFits,
    /// The header has no end.
    #[error("its header breaks off before its END card: the file is truncated, fetch it again")]
    Header,
    /// A number that a header must have.
    #[error("its header has no usable {0}")]
    Card(&'static str),
    /// Not 8, 16, 32, -32 or -64.
    #[error("its BITPIX is {0}: only 8, 16, 32, -32 and -64 are read")]
    Bitpix(i64),
    /// A side of zero, or too long, or too many planes.
    #[error("it claims {width} x {height} pixels in {planes} planes: at most 8192 x 8192 in 1 or 3 planes are read")]
    Size {
        /// NAXIS1.
        width: i64,
        /// NAXIS2.
        height: i64,
        /// NAXIS3, or 1.
        planes: i64,
    },
    /// Less data than the header claims.
    #[error("it is truncated: its header claims {needed} bytes of pixels and {there} are there; fetch it again")]
    Truncated {
        /// Bytes claimed.
        needed: usize,
        /// Bytes there.
        there: usize,
    },
    /// Only tables, or compressed images.
    #[error("it has no plain image (compressed ones are not read: run `funpack` on it first)")]
    NoImage,
}

/// An image as the file has it: row 0 is the first in the file, which FITS viewers draw at the bottom.
#[derive(Debug, Clone, PartialEq)]
pub struct Fits {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 3 planes of values (BSCALE and BZERO applied); blank pixels are NaN. f32: what cameras deliver has 16 bits.
    pub planes: Vec<Vec<f32>>,
    cards: Cards,
}

/// Keyword to value, quotes and comments removed.
type Cards = HashMap<String, String>;

impl Fits {
    /// Reads the first image of a file.
    ///
    /// # Errors
    /// What is wrong with the file, with its numbers.
    pub fn read(bytes: &[u8]) -> Result<Fits, FitsError> {
        if !bytes.starts_with(b"SIMPLE  =") {
            return Err(FitsError::NotFits);
        }
        let mut rest = bytes;
        for _ in 0..MOST_UNITS {
            if rest.is_empty() {
                break;
            }
            let (cards, header) = cards(rest)?;
            let data = &rest[header.min(rest.len())..];
            let axes = number(&cards, "NAXIS").ok_or(FitsError::Card("NAXIS"))?;
            let plain = !cards.contains_key("XTENSION") || text(&cards, "XTENSION") == Some("IMAGE");
            if plain && (axes == 2.0 || axes == 3.0) {
                return image(cards, data);
            }
            rest = data.get(data_bytes(&cards)?..).unwrap_or_default();
        }
        Err(FitsError::NoImage)
    }

    /// A number of the header.
    #[must_use]
    pub fn number(&self, key: &str) -> Option<f64> {
        number(&self.cards, key)
    }

    /// A text of the header.
    #[must_use]
    pub fn text(&self, key: &str) -> Option<&str> {
        text(&self.cards, key)
    }
}

fn text<'a>(cards: &'a Cards, key: &str) -> Option<&'a str> {
    cards.get(key).map(String::as_str)
}

fn number(cards: &Cards, key: &str) -> Option<f64> {
    // FORTRAN writes exponents with a D.
    text(cards, key)?.replace(['D', 'd'], "E").parse().ok().filter(|value: &f64| value.is_finite())
}

/// The cards of the header that `bytes` begin with, and its length in whole blocks.
fn cards(bytes: &[u8]) -> Result<(Cards, usize), FitsError> {
    let mut cards = HashMap::new();
    for (index, card) in bytes.chunks_exact(80).take(MOST_CARDS).enumerate() {
        let card: String = card.iter().map(|&b| if b.is_ascii_graphic() { char::from(b) } else { ' ' }).collect();
        let (key, rest) = card.split_at(8);
        if key.trim() == "END" {
            return Ok((cards, (index * 80 / BLOCK + 1) * BLOCK));
        }
        if let Some(value) = rest.strip_prefix("= ") {
            let value = value.trim();
            let value = match value.strip_prefix('\'') {
                Some(quoted) => quoted.split('\'').next().unwrap_or_default().trim_end(),
                None => value.split('/').next().unwrap_or_default().trim(),
            };
            cards.entry(key.trim().to_owned()).or_insert_with(|| value.to_owned());
        }
    }
    Err(FitsError::Header)
}

/// Bytes of data behind a header, in whole blocks.
fn data_bytes(cards: &Cards) -> Result<usize, FitsError> {
    let axes = number(cards, "NAXIS").ok_or(FitsError::Card("NAXIS"))?;
    if axes == 0.0 {
        return Ok(0);
    }
    let whole = |key: &str, default: f64| number(cards, key).unwrap_or(default).max(0.0) as usize;
    let mut values = 1usize;
    for axis in 1..=(axes as usize).min(999) {
        values = values.saturating_mul(whole(&format!("NAXIS{axis}"), 0.0));
    }
    let bits = number(cards, "BITPIX").ok_or(FitsError::Card("BITPIX"))?.abs() as usize;
    let bytes =
        values.saturating_add(whole("PCOUNT", 0.0)).saturating_mul(whole("GCOUNT", 1.0)).saturating_mul(bits / 8);
    Ok(bytes.div_ceil(BLOCK).saturating_mul(BLOCK))
}

fn image(cards: Cards, data: &[u8]) -> Result<Fits, FitsError> {
    let whole = |key: &'static str| number(&cards, key).map(|value| value as i64).ok_or(FitsError::Card(key));
    let (width, height) = (whole("NAXIS1")?, whole("NAXIS2")?);
    let planes = if number(&cards, "NAXIS") == Some(3.0) { whole("NAXIS3")? } else { 1 };
    let side = 1..=LONGEST_SIDE as i64;
    if !side.contains(&width) || !side.contains(&height) || !matches!(planes, 1 | 3) {
        return Err(FitsError::Size { width, height, planes });
    }
    let bitpix = whole("BITPIX")?;
    let bytes_each = match bitpix {
        8 | 16 | 32 | -32 | -64 => bitpix.unsigned_abs() as usize / 8,
        other => return Err(FitsError::Bitpix(other)),
    };
    // At most 8192 * 8192 * 3 * 8: no overflow.
    let (width, height) = (width as usize, height as usize);
    let plane_bytes = width * height * bytes_each;
    let needed = plane_bytes * planes as usize;
    if data.len() < needed {
        return Err(FitsError::Truncated { needed, there: data.len() });
    }

    let scale = number(&cards, "BSCALE").unwrap_or(1.0);
    let zero = number(&cards, "BZERO").unwrap_or(0.0);
    let blank = number(&cards, "BLANK").filter(|_| bitpix > 0);
    let value = |raw: f64| if Some(raw) == blank { f32::NAN } else { (zero + scale * raw) as f32 };
    let planes = data[..needed]
        .chunks_exact(plane_bytes)
        .map(|plane| plane.chunks_exact(bytes_each).map(|pixel| value(raw(bitpix, pixel))).collect())
        .collect();
    Ok(Fits { width, height, planes, cards })
}

/// One stored number, most significant byte first.
fn raw(bitpix: i64, pixel: &[u8]) -> f64 {
    match (bitpix, pixel) {
        (8, [a]) => f64::from(*a),
        (16, [a, b]) => f64::from(i16::from_be_bytes([*a, *b])),
        (32, [a, b, c, d]) => f64::from(i32::from_be_bytes([*a, *b, *c, *d])),
        (-32, [a, b, c, d]) => f64::from(f32::from_be_bytes([*a, *b, *c, *d])),
        (-64, [a, b, c, d, e, f, g, h]) => f64::from_be_bytes([*a, *b, *c, *d, *e, *f, *g, *h]),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A FITS file from cards and data.
    fn file(cards: &[&str], data: &[u8]) -> Vec<u8> {
        let mut bytes: Vec<u8> =
            cards.iter().chain(&["END"]).flat_map(|card| format!("{card:<80}").into_bytes()).collect();
        bytes.resize(bytes.len().div_ceil(BLOCK) * BLOCK, b' ');
        bytes.extend_from_slice(data);
        bytes
    }

    fn header(bitpix: i64, width: i64, height: i64) -> Vec<String> {
        vec![
            "SIMPLE  =                    T / conforms".into(),
            format!("BITPIX  = {bitpix:>20}"),
            "NAXIS   =                    2".into(),
            format!("NAXIS1  = {width:>20}"),
            format!("NAXIS2  = {height:>20}"),
        ]
    }

    fn simple(bitpix: i64, width: i64, height: i64, data: &[u8]) -> Vec<u8> {
        let cards = header(bitpix, width, height);
        file(&cards.iter().map(String::as_str).collect::<Vec<_>>(), data)
    }

    #[test]
    fn every_kind_of_number_is_read() {
        for (bitpix, bytes) in [
            (8, vec![7]),
            (16, 7i16.to_be_bytes().to_vec()),
            (32, 7i32.to_be_bytes().to_vec()),
            (-32, 7f32.to_be_bytes().to_vec()),
            (-64, 7f64.to_be_bytes().to_vec()),
        ] {
            assert_eq!(Fits::read(&simple(bitpix, 1, 1, &bytes)).unwrap().planes, [[7.0]], "BITPIX {bitpix}");
        }
    }

    #[test]
    fn unsigned_cameras_blanks_and_quoted_text_are_understood() {
        let mut cards = header(16, 2, 1);
        cards.extend(
            ["BZERO   =              32768.0", "BLANK   = -32768", "OBJECT  = 'M 31    '  / it's"].map(String::from),
        );
        let cards: Vec<&str> = cards.iter().map(String::as_str).collect();
        let fits = Fits::read(&file(&cards, &[0x80, 0x00, 0x80, 0x01])).unwrap();
        assert!(fits.planes[0][0].is_nan());
        assert_eq!(fits.planes[0][1], 1.0);
        assert_eq!(fits.text("OBJECT"), Some("M 31"));
    }

    #[test]
    fn a_file_cut_short_or_a_hundred_thousand_pixels_wide_is_a_sentence() {
        let cut = Fits::read(&simple(16, 10, 10, &[0; 100]));
        assert_eq!(cut, Err(FitsError::Truncated { needed: 200, there: 100 }));
        let wide = Fits::read(&simple(8, 100_000, 100_000, &[0; 100]));
        assert_eq!(wide, Err(FitsError::Size { width: 100_000, height: 100_000, planes: 1 }));
        assert_eq!(Fits::read(b"GIF89a"), Err(FitsError::NotFits));
        assert_eq!(Fits::read(&simple(16, 10, 10, &[])[..400]), Err(FitsError::Header));
        assert_eq!(Fits::read(&simple(64, 1, 1, &[0; 8])), Err(FitsError::Bitpix(64)));
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(damage in prop::collection::vec((0usize..3000, any::<u8>()), 1..30), keep in 0usize..3200) {
            let mut bytes = simple(-32, 8, 8, &[0; 256]);
            for (at, value) in damage {
                bytes[at] = value;
            }
            bytes.truncate(keep);
            let _ = Fits::read(&bytes);
        }
    }
}
