//! Delta T = TT - UT1: measured yearly values to today, then (and before 1962) the polynomials of Espenak and Meeus.

use super::time::Utc;

/// First year of [`MEASURED_S`].
const FIRST_YEAR: f64 = 1962.0;

/// TT - UT1 in seconds on 1 January, 0h UTC, of each year from 1962.
///
/// ```text
/// delta T = 32.184 + (TAI - UTC) - (UT1 - UTC)
/// ```
///
/// UT1 - UTC: IERS, Earth orientation series C04 to 2026, and Bulletin A of November 2026 for the last value
/// (1 January 2027, predicted two months ahead, good to some milliseconds). TAI - UTC: the leap seconds of IERS Bulletin C.
const MEASURED_S: [f64; 66] = [
    33.9972, 34.4735, 35.0307, 35.7424, 36.5444, 37.4320, 38.2952, 39.2049, 40.1806, 41.1695, // 1962
    42.2295, 43.3734, 44.4847, 45.4761, 46.4582, 47.5200, 48.5347, 49.5856, 50.5390, 51.3804, // 1972
    52.1665, 52.9566, 53.7864, 54.3431, 54.8704, 55.3221, 55.8197, 56.3001, 56.8552, 57.5653, // 1982
    58.3091, 59.1218, 59.9845, 60.7853, 61.6286, 62.2951, 62.9659, 63.4673, 63.8285, 64.0908, // 1992
    64.2998, 64.4734, 64.5736, 64.6876, 64.8452, 65.1464, 65.4573, 65.7768, 66.0699, 66.3245, // 2002
    66.6030, 66.9069, 67.2811, 67.6439, 68.1025, 68.5927, 68.9676, 69.2202, 69.3612, 69.3594, // 2012
    69.2945, 69.2038, 69.1752, 69.1377, 69.1099, 69.3076, // 2022
];

/// The year in which the polynomials take over fully from the last measured value.
const JOIN_YEAR: f64 = 2050.0;

/// Delta T in seconds to use where none is given: measured from 1962 to today, the polynomials elsewhere.
///
/// Espenak and Meeus (2006) foresaw 75 s for 2027 and 69.3 s came, so the difference is let fade in a straight line from
/// the last measured year to 2050: there is no jump, and from 2050 on the value is theirs.
#[must_use]
pub fn default_seconds(utc: Utc) -> f64 {
    let year = julian_year(utc);
    let last_year = FIRST_YEAR + (MEASURED_S.len() - 1) as f64;
    if year < FIRST_YEAR {
        return espenak_meeus(year);
    }
    if year < last_year {
        let since = year - FIRST_YEAR;
        let (before, part) = (since.floor() as usize, since.fract());
        return MEASURED_S[before] + part * (MEASURED_S[before + 1] - MEASURED_S[before]);
    }
    let surprise = MEASURED_S[MEASURED_S.len() - 1] - espenak_meeus(last_year);
    let left = ((JOIN_YEAR - year) / (JOIN_YEAR - last_year)).max(0.0);
    espenak_meeus(year) + surprise * left
}

/// The year with its fraction, in Julian years about J2000: within a day of the calendar's in the table's span.
fn julian_year(utc: Utc) -> f64 {
    2000.0 + (utc.0 - 946_728_000.0) / (365.25 * 86_400.0)
}

/// Delta T in seconds from the year (with its fraction), the polynomials printed by Espenak and Meeus.
///
/// Source: F. Espenak and J. Meeus, *Five Millennium Canon of Solar Eclipses*, NASA/TP-2006-214141 (2006), section 2.7.
/// The Canon's correction for another secular acceleration of the Moon is a matter of the Moon, and left out.
#[must_use]
pub fn espenak_meeus(year: f64) -> f64 {
    let parabola = |y: f64| -20.0 + 32.0 * ((y - 1820.0) / 100.0).powi(2);
    match year {
        y if y < -500.0 => parabola(y),
        y if y < 500.0 => {
            polynomial(y / 100.0, &[10583.6, -1014.41, 33.78311, -5.952053, -0.1798452, 0.022174192, 0.0090316521])
        }
        y if y < 1600.0 => polynomial(
            (y - 1000.0) / 100.0,
            &[1574.2, -556.01, 71.23472, 0.319781, -0.8503463, -0.005050998, 0.0083572073],
        ),
        y if y < 1700.0 => polynomial(y - 1600.0, &[120.0, -0.9808, -0.01532, 1.0 / 7129.0]),
        y if y < 1800.0 => polynomial(y - 1700.0, &[8.83, 0.1603, -0.0059285, 0.00013336, -1.0 / 1_174_000.0]),
        y if y < 1860.0 => polynomial(
            y - 1800.0,
            &[13.72, -0.332447, 0.0068612, 0.0041116, -0.00037436, 0.0000121272, -0.0000001699, 0.000000000875],
        ),
        y if y < 1900.0 => {
            polynomial(y - 1860.0, &[7.62, 0.5737, -0.251754, 0.01680668, -0.0004473624, 1.0 / 233_174.0])
        }
        y if y < 1920.0 => polynomial(y - 1900.0, &[-2.79, 1.494119, -0.0598939, 0.0061966, -0.000197]),
        y if y < 1941.0 => polynomial(y - 1920.0, &[21.20, 0.84493, -0.076100, 0.0020936]),
        y if y < 1961.0 => polynomial(y - 1950.0, &[29.07, 0.407, -1.0 / 233.0, 1.0 / 2547.0]),
        y if y < 1986.0 => polynomial(y - 1975.0, &[45.45, 1.067, -1.0 / 260.0, -1.0 / 718.0]),
        y if y < 2005.0 => polynomial(y - 2000.0, &[63.86, 0.3345, -0.060374, 0.0017275, 0.000651814, 0.00002373599]),
        y if y < 2050.0 => polynomial(y - 2000.0, &[62.92, 0.32217, 0.005589]),
        y if y < 2150.0 => parabola(y) - 0.5628 * (2150.0 - y),
        y => parabola(y),
    }
}

/// The polynomial with these coefficients, lowest power first, by Horner's rule.
fn polynomial(t: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(text: &str) -> f64 {
        default_seconds(Utc::from_rfc3339(text).unwrap())
    }

    /// Numbers of the Astronomical Almanac's table K8 / IERS, not of this program.
    #[test]
    fn measured_years_are_as_published() {
        for (date, published) in
            [("1977-01-01T00:00:00Z", 47.52), ("1990-01-01T00:00:00Z", 56.86), ("2000-01-01T00:00:00Z", 63.83)]
        {
            assert!((on(date) - published).abs() < 0.02, "{date}: {} is not {published}", on(date));
        }
    }

    /// NASA's own table of values from these polynomials (eclipse.gsfc.nasa.gov, "Delta T: historical values").
    #[test]
    fn the_polynomials_give_the_canons_own_table() {
        for (year, seconds, within) in [
            (-500.0, 17190.0, 25.0),
            (0.0, 10580.0, 10.0),
            (500.0, 5710.0, 10.0),
            (1000.0, 1570.0, 10.0),
            (1600.0, 120.0, 1.0),
            (1700.0, 9.0, 0.5),
            (1800.0, 14.0, 0.5),
            (1900.0, -3.0, 0.5),
            (1950.0, 29.0, 0.2),
            (2000.0, 63.9, 0.1),
            (2050.0, 93.0, 0.5),
            (2100.0, 202.74, 1.0),
        ] {
            assert!((espenak_meeus(year) - seconds).abs() <= within, "{year}: {}", espenak_meeus(year));
        }
    }

    #[test]
    fn there_is_no_jump_where_the_measured_years_end() {
        let (before, after) = (on("2026-12-31T00:00:00Z"), on("2027-01-03T00:00:00Z"));
        assert!((after - before).abs() < 0.05, "{before} to {after}");
        assert!((on("2050-01-02T00:00:00Z") - 93.0).abs() < 0.5);
    }
}
