//! What the catalogue says of one object, and the smaller forms in which a field's contents come.

use super::distance::Distance;
use super::kind::Kind;
use crate::eye::Patch;
use crate::sky::astrometry::Astrometry;
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::ephemeris::{Body, InView};
use crate::units::{Angle, Magnitude, SurfaceBrightness};

/// The band in which a magnitude was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Band {
    /// Visual, 550 nm.
    V,
    /// Blue, 440 nm: used where no V is known.
    B,
}

/// All that the catalogues say of one object.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// The name to show: `M31`, `Vega`, `HIP 12345`.
    pub name: String,
    /// Every name, the one to show first.
    pub names: Vec<String>,
    /// What it is.
    pub kind: Kind,
    /// Hubble's type of a galaxy, as catalogued: `Sb`, `E2`.
    pub hubble: Option<&'static str>,
    /// Where it is and how it moves.
    pub astrometry: Astrometry,
    /// Total magnitude, in [`Object::band`].
    pub magnitude: Option<Magnitude>,
    /// The band of [`Object::magnitude`].
    pub band: Band,
    /// Colour index B-V.
    pub colour_bv: Option<f32>,
    /// Full major and minor axes in arcminutes; a round object has two equal ones.
    pub axes_arcmin: Option<(f64, f64)>,
    /// Position angle of the major axis, from north through east.
    pub position_angle: Option<Angle>,
    /// Mean surface brightness in V out to the catalogued axes: the core is far brighter.
    pub surface_brightness: Option<SurfaceBrightness>,
    /// How far it is, where that is known.
    pub distance: Option<Distance>,
    /// Whether its place is the hand controller's own, from the observer's list.
    pub hand_controllers_place: bool,
    /// The constellation's IAU abbreviation: `And`.
    pub constellation: &'static str,
}

impl Object {
    /// The magnitude, if it is one in V.
    #[must_use]
    pub fn v_magnitude(&self) -> Option<Magnitude> {
        self.magnitude.filter(|_| self.band == Band::V)
    }

    /// V magnitude where only B is known: B less the mean colour of what it is.
    ///
    /// ```text
    /// B - V   elliptical, lenticular 0.90   Sa 0.78   Sb 0.65   Sc 0.52   later and irregular 0.42   galaxy of unknown type 0.7
    ///         globular cluster 0.75
    /// ```
    ///
    /// Medians by type after Roberts and Haynes (1994), ARA&A 32, 115, table 1, rounded (from memory); single galaxies differ by
    /// 0.15. Of other kinds no V is guessed.
    #[must_use]
    pub fn estimated_v_magnitude(&self) -> Option<Magnitude> {
        let blue = self.magnitude.filter(|_| self.band == Band::B)?;
        let colour = match self.kind {
            Kind::Galaxy => self.hubble.map_or(0.7, colour_of_galaxy),
            Kind::GlobularCluster => 0.75,
            _ => return None,
        };
        Some(Magnitude(blue.0 - colour))
    }

    /// Magnitude at 10 parsecs, where V and the distance are known; what dust takes on the way is not made good.
    #[must_use]
    pub fn absolute_magnitude(&self) -> Option<f64> {
        Some(self.v_magnitude()?.0 - self.distance?.modulus())
    }

    /// The object as the models of the eye take it, where its V magnitude and its size are known.
    #[must_use]
    pub fn patch(&self) -> Option<Patch> {
        let (major_arcmin, minor_arcmin) = self.axes_arcmin.filter(|axes| axes.0 > 0.0 && axes.1 > 0.0)?;
        Some(Patch { v_mag: self.v_magnitude()?.0, major_arcmin, minor_arcmin })
    }

    /// The part of the object that is seen first, as an even patch: a galaxy's or globular cluster's inner half of the light,
    /// any other object whole.
    ///
    /// An exponential disc of Freeman's (1970) central 21.65 mag/arcsec2 holds half of its light within 1.678/3.085 = 0.54 of
    /// its isophote of 25; a globular cluster's half-light radius is about 0.2 of its catalogued one (our own estimate).
    #[must_use]
    pub fn heart(&self) -> Option<Patch> {
        let whole = self.patch()?;
        let inner = match self.kind {
            Kind::Galaxy => 0.54,
            Kind::GlobularCluster => 0.2,
            _ => return Some(whole),
        };
        let half_light = 2.5 * 2f64.log10();
        Some(Patch {
            v_mag: whole.v_mag + half_light,
            major_arcmin: whole.major_arcmin * inner,
            minor_arcmin: whole.minor_arcmin * inner,
        })
    }

    /// What it is in plain words, finer than [`Kind::words`] where Hubble's type tells more: "spiral galaxy".
    #[must_use]
    pub fn type_words(&self) -> &'static str {
        match (self.kind, self.hubble) {
            (Kind::Galaxy, Some(hubble)) => galaxy_words(hubble),
            (Kind::SolarSystem, _) => Body::from_name(&self.name).map_or(self.kind.words(), Body::type_words),
            (kind, _) => kind.words(),
        }
    }
}

/// Mean B-V of a galaxy of Hubble's type; see [`Object::estimated_v_magnitude`].
fn colour_of_galaxy(hubble: &str) -> f64 {
    let plain: String = hubble.chars().filter(|c| c.is_ascii_alphanumeric() && *c != 'R').collect();
    let spiral =
        plain.strip_prefix("SAB").or(plain.strip_prefix("SB")).or(plain.strip_prefix("SA")).or(plain.strip_prefix('S'));
    // SA and SB are families before a stage, and stages by themselves: Sa, Sb are written small.
    match spiral.and_then(|stage| stage.chars().next()) {
        _ if plain.starts_with('E') => 0.90,
        _ if plain.starts_with('I') => 0.42,
        Some('0') => 0.90,
        Some('a') => 0.78,
        Some('b') => 0.65,
        Some('c') => 0.52,
        Some('d' | 'm') => 0.42,
        _ => 0.7,
    }
}

/// Hubble's sequence in words.
pub(super) fn galaxy_words(hubble: &str) -> &'static str {
    let mut letters = hubble.trim_start_matches(['(', 'R', ')', '\'', '?', ' ']).chars();
    match (letters.next(), letters.next()) {
        (Some('S'), Some('0')) => "lenticular galaxy",
        (Some('S'), Some('B')) => "barred spiral galaxy",
        (Some('S'), _) => "spiral galaxy",
        (Some('E'), _) => "elliptical galaxy",
        (Some('I'), _) => "irregular galaxy",
        _ => Kind::Galaxy.words(),
    }
}

/// Which star of the catalogues this is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StarId {
    /// The number in the Hipparcos catalogue.
    Hipparcos(u32),
    /// The place in the packed catalogue of faint stars (it changes when the catalogue is made anew).
    Faint(u32),
}

/// A star in a field: small, because there are hundreds. Ask the catalogue for its names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldStar {
    /// Which star.
    pub id: StarId,
    /// Where it is and how it moves.
    pub astrometry: Astrometry,
    /// V magnitude.
    pub v_mag: f32,
    /// Colour index B-V, where known.
    pub colour_bv: Option<f32>,
    /// Distance from the centre that was asked for.
    pub separation: Angle,
}

/// A deep-sky object in a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldObject {
    /// The name to show: `M31`.
    pub name: &'static str,
    /// What it is.
    pub kind: Kind,
    /// Direction at J2000.
    pub position: Equatorial<J2000>,
    /// Total magnitude, in [`FieldObject::band`].
    pub magnitude: Option<Magnitude>,
    /// The band of [`FieldObject::magnitude`].
    pub band: Band,
    /// Full major and minor axes in arcminutes.
    pub axes_arcmin: Option<(f64, f64)>,
    /// Position angle of the major axis, from north through east.
    pub position_angle: Option<Angle>,
    /// Distance of its centre from the centre that was asked for.
    pub separation: Angle,
    /// The object's place in the catalogue, for [`super::Catalogue::object`].
    pub index: usize,
}

/// What is in a field, each list nearest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// Stars inside.
    pub stars: Vec<FieldStar>,
    /// Deep-sky objects whose centre is inside.
    pub objects: Vec<FieldObject>,
    /// Large deep-sky objects whose centre is outside but whose outline may reach in.
    pub reaching_in: Vec<FieldObject>,
    /// What of the solar system is inside. A catalogue does not know it: an [`Almanac`](crate::sky::ephemeris::Almanac) does.
    pub bodies: Vec<InView>,
}
