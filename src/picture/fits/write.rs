//! Writing an image as FITS: f32 values in planes, so that linear light is kept to its last digit.

use super::BLOCK;

/// A card of the header.
#[derive(Debug, Clone, PartialEq)]
pub enum Value<'a> {
    /// A number.
    Number(f64),
    /// A text; quotes in it are doubled, and it is cut at 60 letters.
    Text(&'a str),
}

/// The bytes of a FITS file of three planes. Pixels come row by row from the top; FITS counts rows from the bottom, and so they are stored.
/// Keywords longer than eight letters, and what is not ASCII, are cut out.
#[must_use]
pub fn three_planes(width: usize, pixels: &[[f32; 3]], cards: &[(&str, Value<'_>)]) -> Vec<u8> {
    file(width, pixels.len(), 3, |plane, pixel| pixels[pixel][plane], cards)
}

/// The same for planes that lie one after the other, all of one size; any number of them.
#[must_use]
pub fn planes(width: usize, planes: &[Vec<f32>], cards: &[(&str, Value<'_>)]) -> Vec<u8> {
    let pixels = planes.iter().map(Vec::len).min().unwrap_or(0);
    file(width, pixels, planes.len(), |plane, pixel| planes[plane][pixel], cards)
}

fn file(
    width: usize,
    pixels: usize,
    planes: usize,
    value: impl Fn(usize, usize) -> f32,
    cards: &[(&str, Value<'_>)],
) -> Vec<u8> {
    let height = pixels.checked_div(width).unwrap_or(0);
    let mut file = Vec::with_capacity(2 * BLOCK + pixels * planes * 4);
    let mut card = |text: String| {
        let ascii: String = text.chars().filter(|c| c.is_ascii_graphic() || *c == ' ').take(80).collect();
        file.extend_from_slice(format!("{ascii:<80}").as_bytes());
    };
    card("SIMPLE  =                    T".to_owned());
    for (key, value) in
        [("BITPIX", -32), ("NAXIS", 3), ("NAXIS1", width as i64), ("NAXIS2", height as i64), ("NAXIS3", planes as i64)]
    {
        card(format!("{key:<8}= {value:>20}"));
    }
    for (key, value) in cards {
        let key: String = key.chars().take(8).collect();
        match value {
            Value::Number(number) => card(format!("{key:<8}= {number:>20?}")),
            Value::Text(text) => {
                let text: String = text.chars().take(60).collect();
                card(format!("{key:<8}= '{:<8}'", text.replace('\'', "''")));
            }
        }
    }
    card("END".to_owned());
    file.resize(file.len().next_multiple_of(BLOCK), b' ');
    for plane in 0..planes {
        for row in (0..height).rev() {
            for pixel in row * width..(row + 1) * width {
                file.extend_from_slice(&value(plane, pixel).to_be_bytes());
            }
        }
    }
    file.resize(file.len().next_multiple_of(BLOCK), 0);
    file
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::fits::Fits;

    #[test]
    fn the_reader_reads_what_is_written_with_the_top_row_last() {
        let pixels = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.5e-30], [10.0, 11.0, 12.0]];
        let cards =
            [("BUNIT", Value::Text("cd/m2")), ("CDELT1", Value::Number(-0.25)), ("OBJECT", Value::Text("the Sun's"))];
        let file = three_planes(2, &pixels, &cards);
        assert_eq!(file.len() % BLOCK, 0);
        let read = Fits::read(&file).unwrap();
        assert_eq!((read.width, read.height), (2, 2));
        assert_eq!(read.planes[0], [7.0, 10.0, 1.0, 4.0]);
        assert_eq!(read.planes[2], [9.5e-30, 12.0, 3.0, 6.0]);
        assert_eq!((read.number("CDELT1"), read.text("BUNIT")), (Some(-0.25), Some("cd/m2")));
    }
}
