//! On which chart of two printed atlases a place is.

use std::fmt;

use super::coords::{Equatorial, J2000};

/// A chart of an atlas in several volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chart {
    /// The volume, from 1.
    pub volume: u32,
    /// The chart; the numbers run on through the volumes.
    pub chart: u32,
}

impl fmt::Display for Chart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (vol. {})", self.chart, self.volume)
    }
}

/// A zone of Uranometria 2000.0 north of the equator.
struct Zone {
    /// Its southern edge in degrees.
    from_deg: f64,
    /// The number of its first chart, and of the first chart of the same zone in the south.
    first: [u32; 2],
    /// How many charts go round it.
    charts: u32,
}

/// The zones from the pole to the equator. The equator's own is one zone, of which each volume has one half.
const URANOMETRIA: [Zone; 9] = [
    Zone { from_deg: 84.5, first: [1, 220], charts: 1 },
    Zone { from_deg: 73.5, first: [2, 214], charts: 6 },
    Zone { from_deg: 62.0, first: [8, 204], charts: 10 },
    Zone { from_deg: 51.0, first: [18, 192], charts: 12 },
    Zone { from_deg: 40.0, first: [30, 177], charts: 15 },
    Zone { from_deg: 29.0, first: [45, 159], charts: 18 },
    Zone { from_deg: 17.0, first: [63, 141], charts: 18 },
    Zone { from_deg: 5.5, first: [81, 121], charts: 20 },
    Zone { from_deg: 0.0, first: [101, 101], charts: 20 },
];

/// The chart of Uranometria 2000.0, second edition (Tirion, Rappaport and Remaklus 2001).
///
/// In each zone the first chart has 0 h in its middle, and they are counted westwards. Checked against PyEphem's
/// `uranometria2000` on 1,000 random places: all equal.
#[must_use]
pub fn uranometria(position: &Equatorial<J2000>) -> Chart {
    let south = usize::from(position.dec().to_radians() < 0.0);
    let from_equator = position.dec().abs().to_degrees();
    let zone = URANOMETRIA.iter().find(|zone| from_equator >= zone.from_deg).unwrap_or(&URANOMETRIA[8]);
    let width_deg = 360.0 / f64::from(zone.charts);
    let west_deg = 360.0 - position.ra().wrapped().to_degrees();
    let place = ((west_deg + width_deg / 2.0) / width_deg).floor() as u32 % zone.charts;
    Chart { volume: south as u32 + 1, chart: zone.first[south] + place }
}

/// Charts in a third of each zone of the Millennium Star Atlas, from the north pole (above +87 degrees) in steps of 6 degrees.
const MILLENNIUM: [u32; 31] = [
    2, 4, 8, 10, 12, 14, 16, 20, 20, 22, 22, 24, 24, 24, 24, 24, 24, 24, 24, 24, 22, 22, 20, 20, 16, 14, 12, 10, 8, 4,
    2,
];

/// Charts in a volume.
const MILLENNIUM_VOLUME: u32 = 516;

/// The chart of the Millennium Star Atlas (Sinnott and Perryman 1997).
///
/// A volume holds eight hours of right ascension; in a zone the charts are counted westwards. Checked against PyEphem's
/// `millennium_atlas` on 1,000 random places: all equal.
#[must_use]
pub fn millennium(position: &Equatorial<J2000>) -> Chart {
    let third = position.ra().wrapped().to_degrees() / 120.0;
    let volume = (third.floor() as u32).min(2);
    let zone = (((93.0 - position.dec().to_degrees()) / 6.0).floor() as usize).min(MILLENNIUM.len() - 1);
    let through: u32 = MILLENNIUM[..=zone].iter().sum();
    let west = (((third - f64::from(volume)) * f64::from(MILLENNIUM[zone])) as u32).min(MILLENNIUM[zone] - 1);
    Chart { volume: volume + 1, chart: volume * MILLENNIUM_VOLUME + through - west }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Angle;

    #[test]
    fn a_thousand_random_places_are_on_the_charts_that_pyephem_names() {
        let text = include_str!("../../fixtures/reference/atlas_charts.csv");
        let mut compared = 0;
        for row in text.lines().skip(1) {
            let n: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            let place = Equatorial::new(Angle::degrees(n[0]), Angle::degrees(n[1]));
            let of = |volume: f64, chart: f64| Chart { volume: volume as u32, chart: chart as u32 };
            assert_eq!(uranometria(&place), of(n[2], n[3]), "{row}");
            assert_eq!(millennium(&place), of(n[4], n[5]), "{row}");
            compared += 1;
        }
        assert_eq!(compared, 1000);
    }

    #[test]
    fn poles_and_zero_hours_are_on_a_chart() {
        for dec in [-90.0, -1e-12, 0.0, 90.0] {
            for ra in [0.0, 119.999_999_999_999, 360.0] {
                let place = Equatorial::new(Angle::degrees(ra), Angle::degrees(dec));
                assert!((1..=220).contains(&uranometria(&place).chart));
                assert!((1..=1548).contains(&millennium(&place).chart));
            }
        }
    }
}
