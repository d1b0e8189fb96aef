//! Scene files: the flags of a picture as TOML, and the air in it, beside it or by name.

use std::path::Path;

use serde::Deserialize;

use super::{PictureArguments, White};
use crate::cli::settings::explain;
use crate::cli::sun::atmosphere;
use crate::cli::{Failure, printable};
use crate::physics::air::read::{Described, from_toml};
use crate::physics::refraction::ray::METHODS;

/// Larger files are no scenes.
const LARGEST_BYTES: u64 = 64 << 20;

/// A scene as TOML says it. Every key may be left out.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Document {
    name: String,
    source: String,
    /// A preset, or a profile in a file beside this one.
    atmosphere: Option<String>,
    /// Or the profile itself, as in a profile's file.
    profile: Option<toml::Table>,
    climate: Option<String>,
    humidity_percent: Option<f64>,
    less_forward: bool,
    ozone_du: Option<f64>,
    observer_height_m: Option<f64>,
    sun_altitude_arcmin: Option<f64>,
    sun_radius_arcmin: Option<f64>,
    size: Option<String>,
    field_arcmin: Option<f64>,
    bottom_arcmin: Option<f64>,
    wavelengths: Option<usize>,
    method: Option<String>,
    layers: Option<usize>,
    tolerance_arcsec: Option<f64>,
    spectrum: Option<String>,
    limb: Option<String>,
    white_cd_m2: Option<f64>,
    tone: Option<String>,
    sky: bool,
    ground_albedo: Option<f64>,
    earth_radius_m: Option<f64>,
    top_km: Option<f64>,
}

/// Reads a scene, or a profile alone (TOML with rows, or CSV).
pub(super) fn open(path: &Path) -> Result<(PictureArguments, Described), Failure> {
    let shown = path.display();
    let asked = |what: &dyn std::fmt::Display| Failure::asked(format!("{shown}: {what}"));
    let bytes = std::fs::metadata(path).map_err(|error| asked(&error))?.len();
    if bytes > LARGEST_BYTES {
        return Err(asked(&format!("{bytes} bytes are too many for a scene")));
    }
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        return Ok((PictureArguments::default(), atmosphere::open(&path.to_string_lossy())?));
    }
    let text = std::fs::read_to_string(path).map_err(|error| asked(&error))?;
    let profile_alone = text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("row"));
    if profile_alone {
        return Ok((PictureArguments::default(), atmosphere::open(&path.to_string_lossy())?));
    }
    let document: Document = toml::from_str(&text).map_err(|error| {
        let wrong = explain::wrong(&error, &text);
        let line = wrong.line.map_or(String::new(), |line| format!("line {line}: "));
        asked(&format!("{line}{}", wrong.what))
    })?;
    let mut air = match (&document.atmosphere, &document.profile) {
        (Some(_), Some(_)) => return Err(asked(&"both atmosphere and profile are given: leave one out")),
        (None, Some(table)) => {
            let text = toml::to_string(table).map_err(|error| asked(&error))?;
            from_toml(&text).map_err(|error| asked(&format!("profile: {error}")))?
        }
        (name, None) => {
            let name = name.as_deref().unwrap_or("us76");
            // A file is looked for beside the scene.
            let beside = path.parent().unwrap_or(Path::new("")).join(name);
            if beside.is_file() { atmosphere::open(&beside.to_string_lossy())? } else { atmosphere::open(name)? }
        }
    };
    if !document.name.is_empty() {
        air.name = printable(&document.name);
    }
    if !document.source.is_empty() {
        air.source = printable(&document.source);
    }
    fn parsed<T: std::str::FromStr<Err: std::fmt::Display>>(
        shown: &impl std::fmt::Display,
        key: &str,
        text: Option<&String>,
    ) -> Result<Option<T>, Failure> {
        let parse =
            |text: &String| text.parse().map_err(|error: T::Err| Failure::asked(format!("{shown}: {key}: {error}")));
        text.map(parse).transpose()
    }
    if let Some(method) = document.method.as_ref().filter(|method| !METHODS.contains(&method.as_str())) {
        return Err(asked(&format!("method: '{method}': there are {}", METHODS.join(", "))));
    }
    let said = PictureArguments {
        preset: None,
        scene: None,
        climate: parsed(&shown, "climate", document.climate.as_ref())?,
        humidity: document.humidity_percent,
        less_forward: document.less_forward,
        ozone_du: document.ozone_du,
        observer_height_m: document.observer_height_m,
        sun_altitude_arcmin: document.sun_altitude_arcmin,
        sun_radius_arcmin: document.sun_radius_arcmin,
        size: parsed(&shown, "size", document.size.as_ref())?,
        field_arcmin: document.field_arcmin,
        bottom_arcmin: document.bottom_arcmin,
        wavelengths: document.wavelengths,
        method: document.method,
        layers: document.layers,
        tolerance_arcsec: document.tolerance_arcsec,
        spectrum: parsed(&shown, "spectrum", document.spectrum.as_ref())?,
        limb: parsed(&shown, "limb", document.limb.as_ref())?,
        white: document
            .white_cd_m2
            .map(|level| level.to_string().parse::<White>())
            .transpose()
            .map_err(|e| asked(&format!("white_cd_m2: {e}")))?,
        sky: document.sky,
        ground_albedo: document.ground_albedo,
        tone: parsed(&shown, "tone", document.tone.as_ref())?,
        earth_radius_m: document.earth_radius_m,
        top_km: document.top_km,
    };
    Ok((said, air))
}
