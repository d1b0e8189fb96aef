//! The astrometric cards of a FITS header: Calabretta and Greisen (2002), A&A 395, 1077, gnomonic only.

use glam::{DMat2, DVec2};

use super::Plate;
use super::read::PhotographError;
use crate::picture::fits::Fits;
use crate::sky::coords::Equatorial;
use crate::units::Angle;

/// Where a FITS image is on the sky, from CD, or PC and CDELT, or CDELT and CROTA2.
///
/// SIP distortion (`RA---TAN-SIP`) is left out: a fraction of a pixel of a good telescope. Frames other than ICRS and FK5
/// J2000 are refused. Checked against astropy's WCS: `fixtures/reference/wcs_tan.csv`.
pub(super) fn plate(fits: &Fits) -> Result<Plate, PhotographError> {
    let number = |key: &'static str| fits.number(key).ok_or(PhotographError::NoWcs(key));
    for (key, wanted) in [("CTYPE1", "RA---TAN"), ("CTYPE2", "DEC--TAN")] {
        let there = fits.text(key).ok_or(PhotographError::NoWcs(key))?;
        if there.trim_end_matches("-SIP") != wanted {
            return Err(PhotographError::Projection { key, there: there.into(), wanted });
        }
    }
    let pole = fits.number("LONPOLE").unwrap_or(180.0);
    if pole != 180.0 {
        return Err(PhotographError::Projection { key: "LONPOLE", there: pole.to_string(), wanted: "180" });
    }
    if let Some(frame) = fits.text("RADESYS").filter(|frame| !matches!(*frame, "ICRS" | "FK5")) {
        return Err(PhotographError::Projection { key: "RADESYS", there: frame.into(), wanted: "ICRS" });
    }
    for key in ["CUNIT1", "CUNIT2"] {
        if let Some(unit) = fits.text(key).filter(|unit| !unit.starts_with("deg")) {
            return Err(PhotographError::Projection { key, there: unit.into(), wanted: "deg" });
        }
    }

    let matrix_deg = matrix_deg(fits)?;
    let matrix = matrix_deg * 1f64.to_radians();
    let area_arcsec2 = matrix_deg.determinant().abs() * 3600f64.powi(2);
    if !(1e-6..1e8).contains(&area_arcsec2) {
        return Err(PhotographError::Scale(area_arcsec2.sqrt()));
    }
    Ok(Plate {
        centre: Equatorial::new(Angle::degrees(number("CRVAL1")?), Angle::degrees(number("CRVAL2")?)),
        reference: DVec2::new(number("CRPIX1")?, number("CRPIX2")?) - 0.5,
        matrix,
    })
}

/// Degrees east and north per pixel right and up.
fn matrix_deg(fits: &Fits) -> Result<DMat2, PhotographError> {
    let get = |key: &str, default: f64| fits.number(key).unwrap_or(default);
    let rows = |a: f64, b: f64, c: f64, d: f64| DMat2::from_cols(DVec2::new(a, c), DVec2::new(b, d));
    if fits.number("CD1_1").or(fits.number("CD1_2")).is_some() {
        return Ok(rows(get("CD1_1", 0.0), get("CD1_2", 0.0), get("CD2_1", 0.0), get("CD2_2", 0.0)));
    }
    let step = |key: &'static str| fits.number(key).ok_or(PhotographError::NoWcs(key));
    let (east, north) = (step("CDELT1")?, step("CDELT2")?);
    let pc = if let Some(turn_deg) = fits.number("CROTA2") {
        // The old convention: Calabretta and Greisen (2002), eq. 189.
        let (sin, cos) = turn_deg.to_radians().sin_cos();
        rows(cos, -sin * north / east, sin * east / north, cos)
    } else {
        rows(get("PC1_1", 1.0), get("PC1_2", 0.0), get("PC2_1", 0.0), get("PC2_2", 1.0))
    };
    Ok(DMat2::from_diagonal(DVec2::new(east, north)) * pc)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A FITS file of one pixel with these cards.
    fn file(cards: &[(&str, &str)]) -> Vec<u8> {
        let mut text = format!("{:<80}", "SIMPLE  =                    T");
        let fixed = [("BITPIX", "8"), ("NAXIS", "2"), ("NAXIS1", "1"), ("NAXIS2", "1")];
        for (key, value) in fixed.iter().chain(cards) {
            text += &format!("{:<80}", format!("{key:<8}= {value}"));
        }
        text += &format!("{:<80}", "END");
        let mut bytes = text.into_bytes();
        bytes.resize(bytes.len().div_ceil(2880) * 2880, b' ');
        bytes.push(0);
        bytes
    }

    const TAN: [(&str, &str); 2] = [("CTYPE1", "'RA---TAN'"), ("CTYPE2", "'DEC--TAN'")];

    #[test]
    fn pixels_are_on_the_sky_where_astropy_has_them_within_a_milliarcsecond() {
        let table = include_str!("../../../fixtures/reference/wcs_tan.csv");
        let rows: Vec<&str> =
            table.lines().filter(|line| !line.starts_with('#') && !line.starts_with("case")).collect();
        assert_eq!(rows.len(), 16);
        for row in rows {
            let columns: Vec<&str> = row.split(',').collect();
            let number = |i: usize| -> f64 { columns[i].parse().unwrap() };
            let cards: Vec<(&str, &str)> = columns[1].split(' ').map(|card| card.split_once('=').unwrap()).collect();
            let plate = plate(&Fits::read(&file(&[&TAN[..], &cards].concat())).unwrap()).unwrap();
            let here = plate.position(number(2) - 0.5, number(3) - 0.5);
            let astropys = Equatorial::new(Angle::degrees(number(4)), Angle::degrees(number(5)));
            assert!(here.separation(&astropys).to_arcseconds() < 1e-3, "{row}");
        }
    }

    #[test]
    fn headers_that_are_not_understood_are_refused_with_the_card() {
        let place = [("CRVAL1", "10.0"), ("CRVAL2", "41.0"), ("CRPIX1", "1.0"), ("CRPIX2", "1.0")];
        let scale = [("CDELT1", "-1e-4"), ("CDELT2", "1e-4")];
        let read = |cards: &[(&str, &str)]| plate(&Fits::read(&file(cards)).unwrap());
        assert!(read(&[&TAN[..], &place, &scale].concat()).is_ok());
        assert_eq!(read(&TAN), Err(PhotographError::NoWcs("CDELT1")));
        let sin = read(&[("CTYPE1", "'RA---SIN'"), ("CTYPE2", "'DEC--SIN'")]);
        assert!(sin.unwrap_err().to_string().contains("RA---SIN"));
        let flat = [("CDELT1", "0.0"), ("CDELT2", "1e-4")];
        assert_eq!(read(&[&TAN[..], &place, &flat].concat()), Err(PhotographError::Scale(0.0)));
    }
}
