//! Volumes as raw numbers with a header of words (NRRD): in one file (`.nrrd`), or the header in a file of its own (`.nhdr`).
//!
//! Source: Definition of NRRD File Format, versions 1 to 5, <https://teem.sourceforge.net/nrrd/format.html>.

use std::io::{BufRead, Read, Write};

use flate2::read::GzDecoder;

use super::cube::{Cube, CubeError, Kind, checked, read_values, write_values};

/// A longer header is not believed.
const LONGEST_HEADER: u64 = 1 << 16;
/// Most that deflate shrinks anything.
const MOST_DEFLATED: u64 = 1032;

/// What a header says.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    kind: Kind,
    big_endian: bool,
    gzip: bool,
    sides: [u64; 3],
    spacing: Option<[f64; 3]>,
    /// The file with the numbers, if they are not behind the header.
    pub data_file: Option<String>,
}

/// Reads a header; the numbers follow, or stand in the file that it names.
///
/// # Errors
/// What is wrong with it, and what to do.
pub fn read_header(from: &mut impl BufRead) -> Result<Header, CubeError> {
    let mut left = from.take(LONGEST_HEADER);
    let mut line = Vec::new();
    left.read_until(b'\n', &mut line)?;
    if !line.starts_with(b"NRRD000") {
        return Err(CubeError::Kind("NRRD"));
    }
    let (mut kind, mut sides, mut spacing, mut data_file) = (None, None, None, None);
    let (mut big_endian, mut gzip) = (None, false);
    loop {
        line.clear();
        left.read_until(b'\n', &mut line)?;
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        if text.is_empty() {
            break;
        }
        let Some((key, value)) = text.split_once(": ") else { continue };
        let value = value.trim();
        match key {
            "type" => kind = Some(kind_of(value)?),
            "dimension" if value != "3" => {
                return Err(CubeError::Header(format!("its dimension is {value}: a volume has 3")));
            }
            "sizes" => sides = numbers(value).ok().and_then(|sides: Vec<u64>| sides.try_into().ok()),
            "spacings" => spacing = numbers(value).ok().and_then(|steps: Vec<f64>| steps.try_into().ok()),
            "space directions" => spacing = Some(directions(value)?),
            "endian" => big_endian = Some(value == "big"),
            "encoding" => {
                gzip = match value {
                    "raw" => false,
                    "gzip" | "gz" => true,
                    other => {
                        return Err(CubeError::Header(format!("its encoding is '{other}': raw and gzip are read")));
                    }
                }
            }
            "data file" | "datafile" => data_file = Some(value.to_owned()),
            "byte skip" | "byteskip" | "line skip" | "lineskip" if value != "0" => {
                return Err(CubeError::Header(format!("its {key} is {value}: only 0 is read")));
            }
            _ => {}
        }
    }
    let lacks = |key: &str| CubeError::Header(format!("it has no usable '{key}'"));
    let kind = kind.ok_or_else(|| lacks("type"))?;
    if big_endian.is_none() && kind.bytes() > 1 {
        return Err(lacks("endian"));
    }
    let spacing =
        spacing.map(|steps: [f64; 3]| steps.map(f64::abs)).filter(|s| s.iter().all(|s| s.is_finite() && *s > 0.0));
    let sides = sides.ok_or_else(|| lacks("sizes"))?;
    Ok(Header { kind, big_endian: big_endian.unwrap_or(false), gzip, sides, spacing, data_file })
}

impl Header {
    /// Reads the numbers from what has so many bytes.
    ///
    /// # Errors
    /// Fewer numbers than the header claims, or a volume too large.
    pub fn read_values(&self, from: &mut impl Read, length: u64) -> Result<Cube, CubeError> {
        let there = if self.gzip { length.saturating_mul(MOST_DEFLATED) } else { length };
        let size = checked(self.sides, self.kind, there)?;
        let count = size.iter().product();
        let values = if self.gzip {
            read_values(&mut GzDecoder::new(from), count, self.kind, self.big_endian, |value| value)?
        } else {
            read_values(from, count, self.kind, self.big_endian, |value| value)?
        };
        Ok(Cube { size, spacing: self.spacing, values })
    }
}

fn kind_of(name: &str) -> Result<Kind, CubeError> {
    Ok(match name {
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Kind::U8,
        "signed char" | "int8" | "int8_t" => Kind::I8,
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => Kind::U16,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => Kind::I16,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Kind::U32,
        "int" | "signed int" | "int32" | "int32_t" => Kind::I32,
        "float" => Kind::F32,
        "double" => Kind::F64,
        other => return Err(CubeError::Numbers(other.chars().take(40).collect())),
    })
}

fn numbers<T: std::str::FromStr>(text: &str) -> Result<Vec<T>, T::Err> {
    text.split_whitespace().map(str::parse).collect()
}

/// The lengths of `(a,0,0) (0,b,0) (0,0,c)`; turned boxes are refused.
fn directions(text: &str) -> Result<[f64; 3], CubeError> {
    let refused =
        || CubeError::Header(format!("its space directions are '{text}': only (a,0,0) (0,b,0) (0,0,c) is read"));
    let flat: Vec<f64> = text
        .split(['(', ')', ',', ' '])
        .filter(|part| !part.is_empty())
        .map(str::parse)
        .collect::<Result<_, _>>()
        .map_err(|_not_a_number: std::num::ParseFloatError| refused())?;
    match flat.as_slice() {
        &[a, p, q, r, b, s, t, u, c] if [p, q, r, s, t, u].iter().all(|off| *off == 0.0) => Ok([a, b, c]),
        _ => Err(refused()),
    }
}

/// The header of f32 numbers, little-endian, in a file named or behind the header.
#[must_use]
pub fn header(size: [usize; 3], spacing: [f64; 3], data_file: Option<&str>) -> String {
    let [x, y, z] = size;
    let [dx, dy, dz] = spacing;
    let file = data_file.map_or(String::new(), |file| format!("data file: {file}\n"));
    format!(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: {x} {y} {z}\nspacings: {dx} {dy} {dz}\nendian: little\nencoding: raw\n{file}\n"
    )
}

/// Writes the numbers, as [`header`] says them.
///
/// # Errors
/// The disk's.
pub fn write_raw(to: &mut impl Write, values: &[f32]) -> Result<(), CubeError> {
    write_values(to, values, false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read_all(mut bytes: &[u8]) -> Result<Cube, CubeError> {
        let header = read_header(&mut bytes)?;
        let length = bytes.len() as u64;
        header.read_values(&mut bytes, length)
    }

    #[test]
    fn what_is_written_comes_back_with_voxels_that_are_not_cubes() {
        let values: Vec<f32> = (0..24u8).map(f32::from).collect();
        let mut bytes = header([4, 3, 2], [0.5, 0.1, 2.0], None).into_bytes();
        write_raw(&mut bytes, &values).unwrap();
        assert_eq!(read_all(&bytes).unwrap(), Cube { size: [4, 3, 2], spacing: Some([0.5, 0.1, 2.0]), values });
        let apart = header([1; 3], [1.0; 3], Some("v.raw"));
        assert_eq!(read_header(&mut apart.as_bytes()).unwrap().data_file.as_deref(), Some("v.raw"));
    }

    #[test]
    fn headers_of_other_programs_are_understood() {
        let words = "NRRD0005\n# of Slicer\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 1 1\n\
                     space directions: (-0.5,0,0) (0,1,0) (0,0,2)\nkinds: domain domain domain\nendian: big\nencoding: gzip\n\n";
        let mut packed = flate2::write::GzEncoder::new(words.as_bytes().to_vec(), flate2::Compression::fast());
        packed.write_all(&[0, 7, 0xFF, 0xFF]).unwrap();
        let cube = read_all(&packed.finish().unwrap()).unwrap();
        assert_eq!(cube, Cube { size: [2, 1, 1], spacing: Some([0.5, 1.0, 2.0]), values: vec![7.0, -1.0] });
    }

    #[test]
    fn what_is_not_read_is_told() {
        let with = |line: &str| {
            let text = format!("NRRD0004\n{line}\ntype: float\nsizes: 1 1 1\nendian: little\n\n");
            read_all(text.as_bytes()).unwrap_err().to_string()
        };
        assert!(with("dimension: 4").contains('4'));
        assert!(with("encoding: bzip2").contains("bzip2"));
        assert!(with("byte skip: -1").contains("-1"));
        assert!(with("space directions: (0,1,0) (1,0,0) (0,0,1)").contains("(0,1,0)"));
        assert!(with("encoding: raw").contains("truncated"));
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(damage in prop::collection::vec((0usize..150, any::<u8>()), 1..20), keep in 0usize..200) {
            let mut bytes = header([2, 2, 2], [1.0; 3], None).into_bytes();
            bytes.extend([0; 32]);
            for (at, value) in damage {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = value;
                }
            }
            bytes.truncate(keep);
            let _ = read_all(&bytes);
        }
    }
}
