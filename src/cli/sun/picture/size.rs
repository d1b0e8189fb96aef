//! Sides of a picture, as on the command line.

use std::str::FromStr;

use crate::physics::sun::scene::LONGEST_SIDE;

/// Columns and rows, each 1 to 8192.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Size, String> {
        let side = |text: &str| text.trim().parse().ok().filter(|side| (1..=LONGEST_SIDE).contains(side));
        let (width, height) = text.split_once(['x', 'X']).unwrap_or((text, text));
        match (side(width), side(height)) {
            (Some(width), Some(height)) => Ok(Size { width, height }),
            _ => Err(format!("'{text}': give one number or WIDTHxHEIGHT, each 1 to {LONGEST_SIDE}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_is_a_square_and_two_are_width_and_height() {
        assert_eq!("512".parse(), Ok(Size { width: 512, height: 512 }));
        assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
        for wrong in ["0", "8193", "12x", "-3", "x", "1x9000"] {
            assert!(wrong.parse::<Size>().unwrap_err().contains(wrong), "{wrong}");
        }
    }
}
