//! Scene files: the flags of a nebula's picture as TOML.

use std::path::Path;

use serde::Deserialize;

use crate::cli::Failure;
use crate::cli::nebula::lighting::LiteralForm;
use crate::cli::settings::explain;

/// Larger files are no scenes.
const LARGEST_BYTES: u64 = 1 << 20;

/// A scene as TOML says it. Every key may be left out; what each means stands with the flag of its name.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Document {
    /// What it shows, for people.
    pub name: String,
    /// Stars.
    pub star: Vec<StarTable>,
    /// One number, or one for each band.
    pub extinction: Option<Numbers>,
    /// Share of the extinction that is scattering.
    pub albedo: Option<f64>,
    /// Mean cosine of the angle turned through.
    pub asymmetry: Option<f64>,
    /// Nanometres, one for each band.
    pub wavelengths_nm: Option<Vec<f64>>,
    /// Edge of the box: the longest.
    pub edge: Option<f64>,
    /// table, single or multiple.
    pub model: Option<String>,
    /// For the table: formulas of the thesis as they are printed, albedo and depth.
    pub literal: Vec<LiteralForm>,
    /// orthographic, perspective or domemaster.
    pub view: Option<String>,
    /// Place of the eye.
    pub eye: Option<[f64; 3]>,
    /// What it looks at.
    pub look_at: Option<[f64; 3]>,
    /// What is up.
    pub up: Option<[f64; 3]>,
    /// Full angle, degrees.
    pub fov_deg: Option<f64>,
    /// Width of an orthographic picture.
    pub width: Option<f64>,
    /// What is nearer is not seen.
    pub near: Option<f64>,
    /// WIDTHxHEIGHT.
    pub size: Option<String>,
    /// Relative error to stay below.
    pub tolerance: Option<f64>,
    /// Longest piece of a ray, voxels.
    pub step: Option<f64>,
    /// Seed of photons and of the rays on which errors are measured.
    pub seed: Option<u64>,
}

/// A star.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StarTable {
    /// Where.
    pub position: [f64; 3],
    /// Temperature, kelvin.
    pub kelvin: Option<f64>,
    /// Radiant intensity: one number, or one for each band.
    pub intensity: Option<Numbers>,
}

/// One number or some.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged, expecting = "a number or a list of numbers")]
pub enum Numbers {
    /// One.
    One(f64),
    /// Some.
    Some(Vec<f64>),
}

impl Numbers {
    /// As a list.
    #[must_use]
    pub fn list(&self) -> &[f64] {
        match self {
            Numbers::One(one) => std::slice::from_ref(one),
            Numbers::Some(some) => some,
        }
    }
}

impl Document {
    /// The extinction of each band.
    #[must_use]
    pub fn extinction(&self) -> Option<Vec<f64>> {
        self.extinction.as_ref().map(|numbers| numbers.list().to_vec())
    }
}

/// Reads a scene.
///
/// # Errors
/// The file's name, the line, and the nearest right key.
pub fn open(path: &Path) -> Result<Document, Failure> {
    let asked = |what: &dyn std::fmt::Display| Failure::asked(format!("{}: {what}", path.display()));
    let bytes = std::fs::metadata(path).map_err(|error| asked(&error))?.len();
    if bytes > LARGEST_BYTES {
        return Err(asked(&format!("{bytes} bytes are too many for a scene")));
    }
    let text = std::fs::read_to_string(path).map_err(|error| asked(&error))?;
    toml::from_str(&text).map_err(|error| {
        let wrong = explain::wrong(&error, &text);
        let line = wrong.line.map_or(String::new(), |line| format!("line {line}: "));
        asked(&format!("{line}{}", wrong.what))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_key_is_told_with_its_line_and_the_nearest_right_one() {
        let path = std::env::temp_dir().join(format!("scotopic-scene-{}.toml", std::process::id()));
        std::fs::write(&path, "albedo = 0.6\nasymetry = 0.5\n").unwrap();
        let told = open(&path).unwrap_err().to_string();
        std::fs::remove_file(&path).unwrap();
        assert!(told.contains("line 2") && told.contains("asymmetry"), "{told}");
    }

    #[test]
    fn numbers_may_stand_alone() {
        let scene: Document =
            toml::from_str("extinction = 4\n[[star]]\nposition = [0, 0, 0.5]\nintensity = [1, 2, 3]\n").unwrap();
        assert_eq!(scene.extinction(), Some(vec![4.0]));
        assert_eq!(scene.star[0].intensity.as_ref().map(Numbers::list), Some(&[1.0, 2.0, 3.0][..]));
    }
}
