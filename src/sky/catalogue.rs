//! The catalogues that are built into the program: Hipparcos, the faint stars to V 11, and OpenNGC.

use std::sync::OnceLock;

use super::coords::{Equatorial, J2000};
use crate::units::{Angle, Magnitude};

/// What sort of thing an object is.
pub mod kind;
/// What the catalogue says of an object.
pub mod object;

pub use kind::Kind;
pub use object::{Band, FieldObject, FieldStar, Found, Object, StarId};

/// All catalogues, ready to be asked.
#[derive(Debug)]
pub struct Catalogue {}

/// Why a search gave nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SearchError {
    /// No object has that name.
    #[error("'{text}' is not in the catalogue{}", offered(near))]
    NotFound {
        /// What was asked for, without control characters.
        text: String,
        /// Names that are spelt nearly so.
        near: Vec<String>,
    },
    /// Nothing was asked for.
    #[error("no name was given: type one such as M31, NGC 7662, Vega, alpha Cen, 61 Cyg or HIP 11767")]
    Empty,
}

/// The near misses as the end of a sentence.
fn offered(near: &[String]) -> String {
    if near.is_empty() {
        String::from("; try a number such as M31, NGC 7662 or HIP 11767, or give --ra and --dec")
    } else {
        format!("; did you mean {}?", near.join(", "))
    }
}

impl Catalogue {
    /// The catalogues built into the program.
    #[must_use]
    pub fn embedded() -> &'static Catalogue {
        static EMBEDDED: OnceLock<Catalogue> = OnceLock::new();
        EMBEDDED.get_or_init(|| Catalogue {})
    }

    /// The object that a person means by `text`.
    ///
    /// # Errors
    /// No such name, with names spelt nearly so.
    pub fn search(&self, text: &str) -> Result<Object, SearchError> {
        let text: String = text.chars().filter(|c| !c.is_control()).take(64).collect();
        Err(SearchError::NotFound { text, near: Vec::new() })
    }

    /// Up to `most` names that begin so, the best known first.
    #[must_use]
    pub fn complete(&self, _prefix: &str, _most: usize) -> Vec<String> {
        Vec::new()
    }

    /// What is within `radius` of `centre`. Stars and objects fainter than `faintest` are left out; objects of unknown
    /// magnitude are kept.
    #[must_use]
    pub fn within(&self, _centre: &Equatorial<J2000>, _radius: Angle, _faintest: Magnitude) -> Found {
        Found::default()
    }

    /// All that is known of a star found in a field.
    #[must_use]
    pub fn star(&self, _id: StarId) -> Option<Object> {
        None
    }

    /// All that is known of a deep-sky object found in a field.
    #[must_use]
    pub fn object(&self, _index: usize) -> Option<Object> {
        None
    }

    /// The proper name or Bayer or Flamsteed designation of a star that has one.
    #[must_use]
    pub fn star_name(&self, _id: StarId) -> Option<String> {
        None
    }
}
