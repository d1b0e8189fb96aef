//! Air at one wavelength around a globe: index, slope and scattering at each height, cut into pieces in which n r is monotone.

use super::{Depths, Launch, RayError};
use crate::numerics::roots::bracketed;
use crate::physics::air::ciddor::{AirError, Dispersion};
use crate::physics::air::profile::Profile;
use crate::physics::rayleigh;

/// What dims light on the way, apart from the molecules of the air: haze, ozone.
pub trait Absorber: Send + Sync {
    /// Extinction at a height, per metre.
    fn per_m(&self, height_m: f64) -> f64;

    /// Heights at which the extinction has a jump or a kink, metres.
    fn knots_m(&self) -> &[f64];
}

/// Why a medium cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MediumError {
    /// The air or the wavelength is outside what the index is known for.
    #[error(transparent)]
    Air(#[from] AirError),
    /// Nothing to trace around.
    #[error("radius of the Earth {0} m: give 1000 to 1e12")]
    Radius(f64),
    /// The top of the air.
    #[error("top of the air {top_m} m: give more than 0 and at most {highest_m:.0} m, where this profile ends")]
    Top {
        /// What was asked, metres.
        top_m: f64,
        /// The most, metres.
        highest_m: f64,
    },
}

/// What a ray needs to know of one height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Local {
    /// N = n - 1.
    pub(super) refractivity: f64,
    /// dN/dz, per metre.
    pub(super) slope: f64,
    /// Extinction by molecules, per metre.
    pub(super) rayleigh_per_m: f64,
}

/// A stretch of height with one formula and n r monotone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub(super) low_m: f64,
    pub(super) high_m: f64,
    /// The layer of the profile.
    pub(super) layer: usize,
    /// Refractivity at the two ends.
    pub(super) low_refractivity: f64,
    pub(super) high_refractivity: f64,
}

/// Air at one wavelength around a globe of a radius, up to a top. Refractivity and height are carried, never n and radius.
pub struct Medium<'a> {
    profile: &'a Profile,
    dispersion: Dispersion,
    molecule_m2: f64,
    vacuum: bool,
    aerosol: Option<&'a dyn Absorber>,
    ozone: Option<&'a dyn Absorber>,
    /// Radius of the globe, metres.
    pub earth_radius_m: f64,
    /// Where the air ends, metres.
    pub top_m: f64,
    pieces: Vec<Piece>,
}

impl<'a> Medium<'a> {
    /// The air of a profile at a wavelength in vacuum (nanometres), around a globe of a radius, up to a top (both metres).
    ///
    /// # Errors
    /// The wavelength lies outside 300 to 1700 nm, or radius or top are none.
    pub fn new(
        profile: &'a Profile,
        wavelength_nm: f64,
        earth_radius_m: f64,
        top_m: f64,
    ) -> Result<Medium<'a>, MediumError> {
        let dispersion = Dispersion::new(wavelength_nm, profile.co2_ppm)?;
        if !(1e3..=1e12).contains(&earth_radius_m) {
            return Err(MediumError::Radius(earth_radius_m));
        }
        let highest_m = profile.coldest_m().min(1e6);
        if !(top_m > 0.0 && top_m <= highest_m) {
            return Err(MediumError::Top { top_m, highest_m });
        }
        let molecule_m2 = rayleigh::cross_section_m2(wavelength_nm, profile.co2_ppm);
        let mut medium = Medium {
            profile,
            dispersion,
            molecule_m2,
            vacuum: false,
            aerosol: None,
            ozone: None,
            earth_radius_m,
            top_m,
            pieces: Vec::new(),
        };
        medium.pieces = medium.cut();
        Ok(medium)
    }

    /// The same globe without air: light goes straight.
    #[must_use]
    pub fn emptied(mut self) -> Medium<'a> {
        self.vacuum = true;
        self.pieces = self.cut();
        self
    }

    /// The same air with haze in it.
    #[must_use]
    pub fn with_aerosol(mut self, aerosol: &'a dyn Absorber) -> Medium<'a> {
        self.aerosol = Some(aerosol);
        self.pieces = self.cut();
        self
    }

    /// The same air with ozone in it.
    #[must_use]
    pub fn with_ozone(mut self, ozone: &'a dyn Absorber) -> Medium<'a> {
        self.ozone = Some(ozone);
        self.pieces = self.cut();
        self
    }

    /// Refractivity n - 1 at a height, and its change per metre (by the layer above, where the height is a base).
    #[must_use]
    pub fn refractivity(&self, height_m: f64) -> (f64, f64) {
        let local = self.at(self.profile.layer_at(height_m), height_m);
        (local.refractivity, local.slope)
    }

    /// How strongly a horizontal ray is bent at a height, as a share of the globe's own curvature: above 1 it is ducted.
    ///
    /// ```text
    /// k = -(dn/dz) r/n
    /// ```
    #[must_use]
    pub fn bending(&self, height_m: f64) -> f64 {
        let (refractivity, slope) = self.refractivity(height_m);
        -slope * (self.earth_radius_m + height_m) / (1.0 + refractivity)
    }

    /// The profile's formula of a layer at a height.
    #[inline]
    pub(super) fn at(&self, layer: usize, height_m: f64) -> Local {
        if self.vacuum {
            return Local { refractivity: 0.0, slope: 0.0, rayleigh_per_m: 0.0 };
        }
        let (parcel, change) = self.profile.parcel_with_slope(layer, height_m);
        let (refractivity, slope) = self.dispersion.with_slope(&parcel, &change);
        let molecules = rayleigh::molecules_per_m3(parcel.temperature_k, parcel.pressure_pa);
        Local { refractivity, slope, rayleigh_per_m: self.molecule_m2 * molecules }
    }

    /// Extinctions at a height, per metre.
    #[inline]
    pub(super) fn extinctions(&self, local: &Local, height_m: f64) -> Depths {
        let of = |absorber: Option<&dyn Absorber>| absorber.map_or(0.0, |absorber| absorber.per_m(height_m));
        Depths { rayleigh: local.rayleigh_per_m, aerosol: of(self.aerosol), ozone: of(self.ozone) }
    }

    /// The pieces from the ground up.
    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The piece in which a height lies; on a border, the upper one.
    pub(super) fn piece_at(&self, height_m: f64) -> usize {
        self.pieces.partition_point(|piece| piece.low_m <= height_m).saturating_sub(1)
    }

    /// The profile that the air has.
    pub(super) fn profile(&self) -> &Profile {
        self.profile
    }

    /// Whether a ray can start so.
    pub(super) fn admit(&self, launch: &Launch) -> Result<(), RayError> {
        let degrees = launch.apparent_altitude.to_degrees();
        // A hair above 90 for the rounding of degrees to radians and back.
        if degrees.is_nan() || degrees.abs() > 90.0 + 1e-12 {
            return Err(RayError::Altitude(degrees));
        }
        if !(launch.height_m >= 0.0 && launch.height_m < self.top_m) {
            return Err(RayError::Height { height_m: launch.height_m, top_m: self.top_m });
        }
        Ok(())
    }

    /// Cuts the air at the knots, and where n r is stationary (the borders of ducts).
    fn cut(&self) -> Vec<Piece> {
        let mut borders: Vec<f64> = (0..self.profile.layer_count()).map(|layer| self.profile.base_m(layer)).collect();
        for absorber in [self.aerosol, self.ozone].into_iter().flatten() {
            borders.extend(absorber.knots_m());
        }
        borders.extend([0.0, self.top_m]);
        borders.retain(|z| (0.0..=self.top_m).contains(z));
        borders.sort_by(f64::total_cmp);
        borders.dedup();
        let mut pieces = Vec::with_capacity(borders.len());
        for pair in borders.windows(2) {
            let (low_m, high_m) = (pair[0], pair[1]);
            let layer = self.profile.layer_at(0.5 * (low_m + high_m));
            let rise = |z: f64| {
                let local = self.at(layer, z);
                1.0 + local.refractivity + (self.earth_radius_m + z) * local.slope
            };
            let mut ends = vec![low_m, high_m];
            if (rise(low_m) < 0.0) != (rise(high_m) < 0.0) {
                let stationary = bracketed(low_m, high_m, 0.0, rise);
                if low_m < stationary && stationary < high_m {
                    ends.insert(1, stationary);
                }
            }
            pieces.extend(ends.windows(2).map(|end| Piece {
                low_m: end[0],
                high_m: end[1],
                layer,
                low_refractivity: self.at(layer, end[0]).refractivity,
                high_refractivity: self.at(layer, end[1]).refractivity,
            }));
        }
        pieces
    }
}
