//! Arrays of NumPy (`.npy`, format versions 1 to 3): read with any plain numbers, written as f32, little-endian, C order.
//!
//! Source: numpy.lib.format, <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.

use std::io::{Read, Write};

use super::cube::{Cube, CubeError, Kind, checked, read_values, write_values};

/// How a file begins.
const MAGIC: &[u8] = b"\x93NUMPY";
/// A longer header is not believed.
const LONGEST_HEADER: usize = 1 << 16;

/// An array of up to three axes, the last running fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Numbers along each axis, slowest first: `[z, y, x]`, `[plane, row, column]` or `[row, column]`.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: Vec<f32>,
}

/// Reads an array of one to three axes from a file of so many bytes.
///
/// # Errors
/// What is wrong with the file, and what to do.
pub fn read(from: &mut impl Read, length: u64) -> Result<Array, CubeError> {
    let mut start = [0; 8];
    from.read_exact(&mut start).map_err(|_short| CubeError::Kind("NumPy's .npy"))?;
    if !start.starts_with(MAGIC) {
        return Err(CubeError::Kind("NumPy's .npy"));
    }
    let mut header_length = [0; 4];
    let width = if start[6] == 1 { 2 } else { 4 };
    from.read_exact(&mut header_length[..width])?;
    let header_length = u32::from_le_bytes(header_length) as usize;
    if header_length > LONGEST_HEADER {
        return Err(CubeError::Header(format!("it claims to be {header_length} bytes long")));
    }
    let mut header = vec![0; header_length];
    from.read_exact(&mut header)?;
    let header = String::from_utf8_lossy(&header);

    let (kind, big_endian) = numbers(text(&header, "descr")?)?;
    let shape = shape(&header)?;
    let mut sides = [1; 3];
    match shape.len() {
        1..=3 => sides[3 - shape.len()..].copy_from_slice(&shape),
        _ => return Err(CubeError::Shape(shape)),
    }
    let there = length.saturating_sub((8 + width + header_length) as u64);
    // Pictures may be larger than volumes: only the number of bytes bounds them.
    let needed = sides
        .iter()
        .try_fold(kind.bytes() as u64, |product, side| product.checked_mul(*side))
        .ok_or(CubeError::Shape(shape.clone()))?;
    if needed > there || needed == 0 {
        return Err(if needed == 0 { CubeError::Shape(shape) } else { CubeError::Truncated { needed, there } });
    }
    let sides = sides.map(|side| side as usize);
    let mut values = read_values(from, sides.iter().product(), kind, big_endian, |value| value)?;
    if value_of(&header, "fortran_order")?.starts_with("True") {
        values = transposed(&values, sides);
    }
    Ok(Array { shape: sides[3 - shape.len()..].to_vec(), values })
}

/// Reads a volume: an array of three axes `[z, y, x]`.
///
/// # Errors
/// What is wrong with the file, and what to do.
pub fn read_cube(from: &mut impl Read, length: u64) -> Result<Cube, CubeError> {
    let Array { shape, values } = read(from, length)?;
    let &[z, y, x] = shape.as_slice() else {
        return Err(CubeError::Shape(shape.iter().map(|side| *side as u64).collect()));
    };
    let size = checked([x as u64, y as u64, z as u64], Kind::U8, u64::MAX)?;
    Ok(Cube { size, spacing: None, values })
}

/// Writes an array, f32.
///
/// # Errors
/// The disk's.
pub fn write(to: &mut impl Write, shape: &[usize], values: &[f32]) -> Result<(), CubeError> {
    let mut sides = shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    if shape.len() == 1 {
        sides.push(',');
    }
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({sides}), }}");
    // Numbers begin at a multiple of 64 bytes; the header ends with a line end.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header.extend(std::iter::repeat_n(' ', length - 1 - header.len()));
    header.push('\n');
    to.write_all(MAGIC)?;
    to.write_all(&[1, 0, (length & 0xFF) as u8, (length >> 8) as u8])?;
    to.write_all(header.as_bytes())?;
    write_values(to, values, false)
}

/// What stands behind a key of the header, a Python dictionary.
fn value_of<'a>(header: &'a str, key: &'static str) -> Result<&'a str, CubeError> {
    let missing = || CubeError::Header(format!("it has no '{key}'"));
    let (_, rest) = header.split_once(&format!("'{key}'")).ok_or_else(missing)?;
    Ok(rest.split_once(':').ok_or_else(missing)?.1.trim_start())
}

fn text<'a>(header: &'a str, key: &'static str) -> Result<&'a str, CubeError> {
    let value = value_of(header, key)?;
    let quoted = value.strip_prefix('\'').and_then(|rest| rest.split_once('\''));
    quoted.map(|(text, _)| text).ok_or_else(|| CubeError::Numbers(value.chars().take(40).collect()))
}

fn numbers(descr: &str) -> Result<(Kind, bool), CubeError> {
    let unread = || CubeError::Numbers(descr.chars().take(40).collect());
    let (order, kind) = descr.split_at_checked(1).ok_or_else(unread)?;
    let kind = match kind {
        "u1" | "b1" => Kind::U8,
        "i1" => Kind::I8,
        "u2" => Kind::U16,
        "i2" => Kind::I16,
        "u4" => Kind::U32,
        "i4" => Kind::I32,
        "f4" => Kind::F32,
        "f8" => Kind::F64,
        _ => return Err(unread()),
    };
    match order {
        "<" | "|" | "=" => Ok((kind, false)),
        ">" => Ok((kind, true)),
        _ => Err(unread()),
    }
}

fn shape(header: &str) -> Result<Vec<u64>, CubeError> {
    let value = value_of(header, "shape")?;
    let inside = value.strip_prefix('(').and_then(|rest| rest.split_once(')')).map(|(inside, _)| inside);
    let broken = || CubeError::Header("its 'shape' is no tuple of numbers".into());
    let sides = inside.ok_or_else(broken)?.split(',').map(str::trim).filter(|side| !side.is_empty());
    sides.map(|side| side.parse().map_err(|_not_a_number| broken())).collect()
}

/// From the first axis fastest to the last axis fastest.
fn transposed(values: &[f32], [slow, middle, fast]: [usize; 3]) -> Vec<f32> {
    let mut turned = Vec::with_capacity(values.len());
    for i in 0..slow {
        for j in 0..middle {
            turned.extend((0..fast).map(|k| values[(k * middle + j) * slow + i]));
        }
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `io.BytesIO(); np.save(f, np.arange(6, dtype='>f8').reshape(1, 2, 3, order='F'))` of NumPy 2, header only.
    fn file(descr: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let mut header = format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}");
        header += &" ".repeat(117 - header.len());
        header.push('\n');
        [MAGIC, &[1, 0, 118, 0], header.as_bytes(), data].concat()
    }

    fn read_all(bytes: &[u8]) -> Result<Array, CubeError> {
        read(&mut &*bytes, bytes.len() as u64)
    }

    #[test]
    fn every_kind_of_number_and_both_orders_are_read() {
        for (descr, bytes) in [
            ("|u1", vec![7]),
            ("<i2", 7i16.to_le_bytes().to_vec()),
            (">i4", 7i32.to_be_bytes().to_vec()),
            ("<f4", 7f32.to_le_bytes().to_vec()),
            (">f8", 7f64.to_be_bytes().to_vec()),
        ] {
            let array = read_all(&file(descr, "False", "(1, 1, 1)", &bytes)).unwrap();
            assert_eq!((array.shape, array.values), (vec![1, 1, 1], vec![7.0]), "{descr}");
        }
    }

    #[test]
    fn an_array_stored_first_axis_fastest_is_turned() {
        // Stored 0..6 with the first axis fastest, shape (2, 3): rows are 0 2 4 and 1 3 5.
        let array = read_all(&file("|u1", "True", "(2, 3)", &[0, 1, 2, 3, 4, 5])).unwrap();
        assert_eq!(array.values, [0.0, 2.0, 4.0, 1.0, 3.0, 5.0]);
    }

    #[test]
    fn what_is_written_comes_back_and_the_numbers_begin_at_a_multiple_of_64() {
        let values: Vec<f32> = (0..24u8).map(f32::from).collect();
        let mut bytes = Vec::new();
        write(&mut bytes, &[2, 3, 4], &values).unwrap();
        assert_eq!((bytes.len() - 24 * 4) % 64, 0);
        let cube = read_cube(&mut &*bytes, bytes.len() as u64).unwrap();
        assert_eq!((cube.size, cube.values), ([4, 3, 2], values));
    }

    #[test]
    fn a_file_that_claims_more_than_it_has_is_refused_before_memory_is_asked_for() {
        let told = read_all(&file("<f8", "False", "(1000, 1000, 1000)", &[0; 8])).unwrap_err();
        assert_eq!(told, CubeError::Truncated { needed: 8_000_000_000, there: 8 });
        assert!(matches!(read_all(&file("<c8", "False", "(1,)", &[0; 8])), Err(CubeError::Numbers(_))));
        assert!(matches!(read_all(&file("<f4", "False", "(0, 4)", &[0; 8])), Err(CubeError::Shape(_))));
        assert_eq!(read_all(b"GIF89a..").unwrap_err(), CubeError::Kind("NumPy's .npy"));
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(damage in prop::collection::vec((0usize..140, any::<u8>()), 1..20), keep in 0usize..160) {
            let mut bytes = file("<f4", "False", "(2, 2, 2)", &[0; 32]);
            for (at, value) in damage {
                bytes[at] = value;
            }
            bytes.truncate(keep);
            let _ = read_all(&bytes);
        }
    }
}
