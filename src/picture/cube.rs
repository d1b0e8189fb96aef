//! Numbers on a grid of three axes, as files of several kinds have them: what the kinds share.

use std::io::{Read, Write};

/// Longest side that is read.
pub const LONGEST_SIDE: usize = 1024;

/// Bytes read or written at a time; a whole number of the longest kind of number.
const CHUNK: usize = 1 << 18;

/// A grid of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Cube {
    /// Numbers along x, y, z.
    pub size: [usize; 3],
    /// From one number to the next along x, y, z, in the file's unit of length; nothing where the file does not say it.
    pub spacing: Option<[f64; 3]>,
    /// The numbers, x fastest, then y, then z. What a file marks as missing is NaN.
    pub values: Vec<f32>,
}

/// Why a grid was not read or written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CubeError {
    /// Another kind of file.
    #[error("it does not begin as {0} files do")]
    Kind(&'static str),
    /// A header that cannot be understood.
    #[error("its header cannot be used: {0}")]
    Header(String),
    /// Not three axes, or too long ones.
    #[error("its shape is {0:?}: a volume has three axes of 1 to 1024 numbers each")]
    Shape(Vec<u64>),
    /// Numbers of a kind that is not read.
    #[error("its numbers are '{0}': integers of 8 to 32 bits, f32 and f64 are read")]
    Numbers(String),
    /// Less data than the header claims.
    #[error(
        "it is truncated: its header claims {needed} bytes of numbers and at most {there} are there; fetch it again"
    )]
    Truncated {
        /// Bytes claimed.
        needed: u64,
        /// Bytes that can be there.
        there: u64,
    },
    /// The file or the disk.
    #[error("{0}")]
    Io(String),
}

impl From<std::io::Error> for CubeError {
    fn from(error: std::io::Error) -> CubeError {
        CubeError::Io(error.to_string())
    }
}

/// How one number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// 8 bits, unsigned.
    U8,
    /// 8 bits.
    I8,
    /// 16 bits, unsigned.
    U16,
    /// 16 bits.
    I16,
    /// 32 bits, unsigned.
    U32,
    /// 32 bits.
    I32,
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

impl Kind {
    /// Bytes of a number.
    pub(super) fn bytes(self) -> usize {
        match self {
            Kind::U8 | Kind::I8 => 1,
            Kind::U16 | Kind::I16 => 2,
            Kind::U32 | Kind::I32 | Kind::F32 => 4,
            Kind::F64 => 8,
        }
    }

    /// A number; least significant byte first.
    fn value(self, b: [u8; 8]) -> f64 {
        let [low, high, third, fourth, ..] = b;
        let (two, four) = ([low, high], [low, high, third, fourth]);
        match self {
            Kind::U8 => f64::from(low),
            Kind::I8 => f64::from(low as i8),
            Kind::U16 => f64::from(u16::from_le_bytes(two)),
            Kind::I16 => f64::from(i16::from_le_bytes(two)),
            Kind::U32 => f64::from(u32::from_le_bytes(four)),
            Kind::I32 => f64::from(i32::from_le_bytes(four)),
            Kind::F32 => f64::from(f32::from_le_bytes(four)),
            Kind::F64 => f64::from_le_bytes(b),
        }
    }
}

/// Checks what a header claims before memory is asked for: three axes, x first, and the bytes that can be there.
pub(super) fn checked(sides: [u64; 3], kind: Kind, there: u64) -> Result<[usize; 3], CubeError> {
    if sides.iter().any(|side| !(1..=LONGEST_SIDE as u64).contains(side)) {
        return Err(CubeError::Shape(sides.to_vec()));
    }
    let needed = sides.iter().product::<u64>() * kind.bytes() as u64;
    if needed > there { Err(CubeError::Truncated { needed, there }) } else { Ok(sides.map(|side| side as usize)) }
}

/// Reads so many numbers, each made of what is stored by a function.
pub(super) fn read_values(
    from: &mut impl Read,
    count: usize,
    kind: Kind,
    big_endian: bool,
    make: impl Fn(f64) -> f64,
) -> Result<Vec<f32>, CubeError> {
    let mut values = Vec::with_capacity(count);
    let mut buffer = vec![0; CHUNK];
    while values.len() < count {
        let here = (count - values.len()).min(CHUNK / kind.bytes());
        let bytes = &mut buffer[..here * kind.bytes()];
        from.read_exact(bytes).map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => {
                let of = |numbers: usize| (numbers * kind.bytes()) as u64;
                CubeError::Truncated { needed: of(count), there: of(values.len() + here) }
            }
            _ => error.into(),
        })?;
        if kind == Kind::F32 {
            // By far the most common, and the kind of the largest files.
            let (fours, _) = bytes.as_chunks::<4>();
            let value = |four: &[u8; 4]| if big_endian { f32::from_be_bytes(*four) } else { f32::from_le_bytes(*four) };
            values.extend(fours.iter().map(|four| make(f64::from(value(four))) as f32));
            continue;
        }
        values.extend(bytes.chunks_exact(kind.bytes()).map(|stored| {
            let mut number = [0; 8];
            number[..stored.len()].copy_from_slice(stored);
            if big_endian {
                number[..stored.len()].reverse();
            }
            make(kind.value(number)) as f32
        }));
    }
    Ok(values)
}

/// Writes numbers as f32.
pub(super) fn write_values(to: &mut impl Write, values: &[f32], big_endian: bool) -> Result<(), CubeError> {
    let mut buffer = Vec::with_capacity(CHUNK);
    for some in values.chunks(CHUNK / 4) {
        buffer.clear();
        for value in some {
            buffer.extend_from_slice(&if big_endian { value.to_be_bytes() } else { value.to_le_bytes() });
        }
        to.write_all(&buffer)?;
    }
    Ok(())
}
