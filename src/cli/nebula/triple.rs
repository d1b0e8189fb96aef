//! Three numbers with commas, as places, directions and sizes are given on the command line and in scene files.

use std::str::FromStr;

use glam::DVec3;

/// A place or a direction: `X,Y,Z`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place(pub DVec3);

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Place, String> {
        match numbers(text)?.as_slice() {
            &[x, y, z] => Ok(Place(DVec3::new(x, y, z))),
            _ => Err(format!("'{text}': give three numbers with commas, such as 0,0,0.5")),
        }
    }
}

/// Edges of a box: one length, the longest edge; or `X,Y,Z`, each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edges {
    /// The longest; the others follow from the voxels.
    Longest(f64),
    /// Each.
    Each(DVec3),
}

impl FromStr for Edges {
    type Err = String;

    fn from_str(text: &str) -> Result<Edges, String> {
        let wrong = || format!("'{text}': give the longest edge as one length above 0, or three as X,Y,Z");
        let numbers = numbers(text)?;
        if !numbers.iter().all(|edge| *edge > 0.0) {
            return Err(wrong());
        }
        match *numbers.as_slice() {
            [edge] => Ok(Edges::Longest(edge)),
            [x, y, z] => Ok(Edges::Each(DVec3::new(x, y, z))),
            _ => Err(wrong()),
        }
    }
}

/// Voxels along the edges: `N`, or `X,Y,Z` (an x between them is understood too).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Voxels(pub [usize; 3]);

impl FromStr for Voxels {
    type Err = String;

    fn from_str(text: &str) -> Result<Voxels, String> {
        let wrong = || format!("'{text}': give one number of voxels, or three as X,Y,Z");
        let sides: Result<Vec<usize>, _> = text.split([',', 'x', 'X']).map(|side| side.trim().parse()).collect();
        match *sides.map_err(|_not_a_number| wrong())?.as_slice() {
            [side] => Ok(Voxels([side; 3])),
            [x, y, z] => Ok(Voxels([x, y, z])),
            _ => Err(wrong()),
        }
    }
}

/// Finite numbers with commas.
///
/// # Errors
/// What is no number.
pub fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',')
        .map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite()))
        .collect::<Option<Vec<f64>>>()
        .ok_or_else(|| format!("'{text}': give numbers with commas between them"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_edges_and_sizes_are_read_and_nonsense_is_told() {
        assert_eq!("-1, 0,0.5".parse(), Ok(Place(DVec3::new(-1.0, 0.0, 0.5))));
        assert_eq!("2".parse(), Ok(Edges::Longest(2.0)));
        assert_eq!("2,1,1".parse(), Ok(Edges::Each(DVec3::new(2.0, 1.0, 1.0))));
        assert_eq!("64".parse(), Ok(Voxels([64; 3])));
        assert_eq!("64x32x16".parse(), Ok(Voxels([64, 32, 16])));
        for wrong in ["1,2", "nan,0,0", "", "1,2,3,4"] {
            assert!(wrong.parse::<Place>().is_err() && wrong.parse::<Edges>().is_err(), "{wrong}");
        }
        assert!(
            "-2".parse::<Edges>().is_err() && "0,1,1".parse::<Edges>().is_err() && "64,64".parse::<Voxels>().is_err()
        );
    }
}
