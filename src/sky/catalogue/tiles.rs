//! The sky cut into about 41,000 tiles of a square degree: bands of declination, each cut evenly in right ascension. Stars lie
//! in the files tile by tile, so that a field's stars are found without a search.

use std::f64::consts::TAU;
use std::ops::Range;

/// Bands of one degree from the south pole to the north pole.
const BANDS: usize = 180;

/// The cut. Made once; the packer and the reader share it.
#[derive(Debug, Clone)]
pub(super) struct Tiles {
    /// Number of the first tile of each band, and after the last band the number of tiles.
    first: Vec<usize>,
}

/// The edges of a tile, in degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edges {
    pub(super) west_deg: f64,
    pub(super) width_deg: f64,
    pub(super) south_deg: f64,
}

impl Tiles {
    pub(super) fn new() -> Tiles {
        let mut first = vec![0];
        for band in 0..BANDS {
            let middle = (band as f64 + 0.5 - 90.0).to_radians();
            let tiles = (360.0 * middle.cos()).round().max(1.0) as usize;
            first.push(first[band] + tiles);
        }
        Tiles { first }
    }

    pub(super) fn count(&self) -> usize {
        self.first[BANDS]
    }

    fn tiles_in(&self, band: usize) -> usize {
        self.first[band + 1] - self.first[band]
    }

    fn band(dec_deg: f64) -> usize {
        ((dec_deg + 90.0).floor().max(0.0) as usize).min(BANDS - 1)
    }

    /// The tile of a direction.
    pub(super) fn of(&self, ra_deg: f64, dec_deg: f64) -> usize {
        let band = Tiles::band(dec_deg);
        let tiles = self.tiles_in(band);
        let part = (ra_deg.rem_euclid(360.0) / 360.0 * tiles as f64) as usize;
        self.first[band] + part.min(tiles - 1)
    }

    /// The edges of a tile.
    pub(super) fn edges(&self, tile: usize) -> Edges {
        let band = self.first.partition_point(|first| *first <= tile).saturating_sub(1).min(BANDS - 1);
        let width_deg = 360.0 / self.tiles_in(band) as f64;
        let west_deg = tile.saturating_sub(self.first[band]) as f64 * width_deg;
        Edges { west_deg, width_deg, south_deg: band as f64 - 90.0 }
    }

    /// Runs of neighbouring tiles that together hold all within `radius` of a direction (radians).
    ///
    /// ```text
    /// sin(half width in right ascension) = sin r / cos dec          where the circle does not reach a pole
    /// ```
    pub(super) fn covering(&self, ra: f64, dec: f64, radius: f64) -> Vec<Range<usize>> {
        let mut runs = Vec::new();
        let reaches_pole = dec.abs() + radius >= TAU / 4.0 - 1e-6;
        let half_width = if reaches_pole { TAU / 2.0 } else { (radius.sin() / dec.cos()).clamp(0.0, 1.0).asin() };
        let south = Tiles::band((dec - radius).to_degrees());
        let north = Tiles::band((dec + radius).to_degrees());
        for band in south..=north {
            let (first, tiles) = (self.first[band], self.tiles_in(band));
            let place = |angle: f64| (angle / TAU * tiles as f64).floor() as i64;
            let (from, to) = (place(ra - half_width), place(ra + half_width));
            if half_width * 2.0 >= TAU || to - from + 1 >= tiles as i64 {
                runs.push(first..first + tiles);
                continue;
            }
            let from = from.rem_euclid(tiles as i64) as usize;
            let to = to.rem_euclid(tiles as i64) as usize;
            if from <= to {
                runs.push(first + from..first + to + 1);
            } else {
                runs.push(first + from..first + tiles);
                runs.push(first..first + to + 1);
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_tiles_are_as_many_as_the_sky_has_square_degrees() {
        assert!((41_200..41_300).contains(&Tiles::new().count()), "{}", Tiles::new().count());
    }

    proptest! {
        #[test]
        fn a_point_within_the_radius_is_in_a_covering_tile(
            ra in 0.0..TAU, dec in -1.5706..1.5706f64, radius in 0.0001..0.3f64,
            bearing in 0.0..TAU, part in 0.0..0.999f64,
        ) {
            let tiles = Tiles::new();
            let distance = radius * part;
            let sin_dec = dec.sin() * distance.cos() + dec.cos() * distance.sin() * bearing.cos();
            let east = bearing.sin() * distance.sin() * dec.cos();
            let other_ra = ra + east.atan2(distance.cos() - dec.sin() * sin_dec);
            let tile = tiles.of(other_ra.to_degrees(), sin_dec.clamp(-1.0, 1.0).asin().to_degrees());
            prop_assert!(tiles.covering(ra, dec, radius).iter().any(|run| run.contains(&tile)));
        }

        #[test]
        fn a_tile_holds_the_directions_that_it_is_given(ra in 0.0..360.0, dec in -90.0..90.0f64) {
            let tiles = Tiles::new();
            let edges = tiles.edges(tiles.of(ra, dec));
            prop_assert!(ra >= edges.west_deg - 1e-9 && ra <= edges.west_deg + edges.width_deg + 1e-9);
            prop_assert!(dec >= edges.south_deg && dec <= edges.south_deg + 1.0);
        }
    }
}
