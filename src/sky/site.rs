//! Where on Earth the observer stands.

use crate::units::Angle;

/// An observing site: geodetic latitude, longitude positive EAST, height above the ellipsoid.
///
/// The mount counts longitude westwards; only the mount's protocol code knows that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Geodetic latitude, north positive.
    pub latitude: Angle,
    /// Longitude, east positive, -180 to 180 degrees.
    pub longitude: Angle,
    /// Height above sea level in metres.
    pub elevation_m: f64,
}

/// Why a site was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SiteError {
    /// Not three numbers.
    #[error(
        "a site is LATITUDE,LONGITUDE,ELEVATION in degrees (north and east positive) and metres, like 60.17,24.94,30; this is '{0}'"
    )]
    Form(String),
    /// Latitude beyond a pole.
    #[error("latitude {0} is not on Earth: give -90 (south pole) to 90 (north pole) degrees")]
    Latitude(f64),
    /// Longitude beyond a turn.
    #[error("longitude {0} is out of range: give -180 to 360 degrees, east positive")]
    Longitude(f64),
    /// Elevation no telescope stands at.
    #[error("elevation {0} m is out of range: give -500 to 9000 metres")]
    Elevation(f64),
}

impl Site {
    /// A site from degrees (north and east positive) and metres.
    ///
    /// # Errors
    /// A number that is not on Earth, named with its value.
    pub fn new(latitude_deg: f64, longitude_deg: f64, elevation_m: f64) -> Result<Site, SiteError> {
        if !(-90.0..=90.0).contains(&latitude_deg) {
            return Err(SiteError::Latitude(latitude_deg));
        }
        if !(-180.0..=360.0).contains(&longitude_deg) {
            return Err(SiteError::Longitude(longitude_deg));
        }
        if !(-500.0..=9000.0).contains(&elevation_m) {
            return Err(SiteError::Elevation(elevation_m));
        }
        Ok(Site {
            latitude: Angle::degrees(latitude_deg),
            longitude: Angle::degrees(longitude_deg).wrapped_signed(),
            elevation_m,
        })
    }
}

impl std::str::FromStr for Site {
    type Err = SiteError;

    /// Reads `LAT,LON,ELEV`; the elevation may be left out.
    fn from_str(text: &str) -> Result<Site, SiteError> {
        let form = || SiteError::Form(text.chars().filter(|c| !c.is_control()).take(80).collect());
        let numbers: Vec<f64> = text
            .split(',')
            .map(|part| part.trim().parse())
            .collect::<Result<_, _>>()
            .map_err(|_not_a_number| form())?;
        match numbers[..] {
            [latitude, longitude] => Site::new(latitude, longitude, 0.0),
            [latitude, longitude, elevation] => Site::new(latitude, longitude, elevation),
            _ => Err(form()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latitude_91_is_refused_with_its_value() {
        assert_eq!("91,0,0".parse::<Site>(), Err(SiteError::Latitude(91.0)));
    }

    #[test]
    fn not_a_number_is_refused() {
        assert!(matches!("NaN,0,0".parse::<Site>(), Err(SiteError::Latitude(_))));
        assert!(matches!("here".parse::<Site>(), Err(SiteError::Form(_))));
    }
}
