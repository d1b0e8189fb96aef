//! Directions as the mount's own axes have them.

use super::Mounting;
use super::sunlight::Sunlight;
use super::sweep::AxisAngles;
use crate::sky::coords::{Equatorial, OfDate};
use crate::units::Angle;

impl Mounting {
    /// The axis angles at which a position is seen, some seconds from the moment of `light`.
    pub(super) fn axes(self, position: &Equatorial<OfDate>, light: &Sunlight, after_s: f64) -> AxisAngles {
        match self {
            Mounting::AltAzimuth => {
                let seen = light.seen(position, after_s);
                AxisAngles { turning: seen.azimuth(), tilting: seen.altitude() }
            }
            Mounting::Equatorial => {
                AxisAngles { turning: light.horizon(after_s).hour_angle(position), tilting: position.dec() }
            }
        }
    }

    /// The axis angles of the zenith.
    pub(super) fn zenith(self, light: &Sunlight) -> AxisAngles {
        match self {
            Mounting::AltAzimuth => AxisAngles { turning: Angle::ZERO, tilting: Angle::degrees(90.0) },
            Mounting::Equatorial => AxisAngles { turning: Angle::ZERO, tilting: light.latitude() },
        }
    }

    /// The axis angles of the point under the observer's feet.
    pub(super) fn nadir(self, light: &Sunlight) -> AxisAngles {
        let zenith = self.zenith(light);
        AxisAngles { turning: zenith.turning + Angle::degrees(180.0), tilting: -zenith.tilting }
    }
}
