//! The observer's settings: one TOML file, written by a person and only read by the program. What the program itself
//! must remember (the turns of the cable, the nudge) is `state`'s.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use etcetera::BaseStrategy;
use serde::{Deserialize, Deserializer};

use crate::eye::viewing::DARK_PUPIL_MM;
use crate::hw::mount::address::MountAddress;
use crate::hw::projector::{Placement, PlacementError, ProjectorAddress};
use crate::overlay::facts::Choices;
use crate::overlay::tone::Toning;
use crate::safety::Rules;
use crate::safety::rules::RuleError;
use crate::sky::site::Site;
use disk::Disk;

/// How the picture lies on the sky, as it was measured.
pub mod calibration;
/// Files as the settings need them, and saving that loses nothing.
pub mod disk;
/// What is wrong in a TOML file, in words, with the nearest right key.
pub mod explain;
/// The hand controller.
pub mod handbox;
/// The projector's light.
pub mod light;
/// The nudges of the sessions.
pub mod nudges;
/// What the program remembers from session to session.
pub mod state;

/// Larger files are no settings.
const LARGEST_BYTES: u64 = 1 << 20;

/// What a session is opened with, unless the command line says otherwise.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Where the observer stands.
    #[serde(deserialize_with = "site")]
    pub site: Option<Site>,
    /// The mount.
    #[serde(deserialize_with = "parsed")]
    pub mount: Option<MountAddress>,
    /// The projector.
    #[serde(deserialize_with = "parsed")]
    pub projector: Option<ProjectorAddress>,
    /// The file of telescope and eyepieces.
    pub instrument: Option<PathBuf>,
    /// The folder of photographs.
    pub photographs: Option<PathBuf>,
    /// Stellarium's folder, whose photographs are drawn too, or "none"; where nothing is said an installed one is looked for.
    pub stellarium: Option<PathBuf>,
    /// How much of the light of stars in photographs is taken away: 0 nothing, 1 all.
    pub soften_stars: f32,
    /// The folder of maps of Sun, Moon and planets.
    pub maps: Option<PathBuf>,
    /// The hand controller's own places of objects.
    pub coordinates: Option<PathBuf>,
    /// Brightness of the sky's background at the zenith, V magnitudes per square arcsecond: 22 in the desert, 18 in a town.
    pub sky_brightness_mag_arcsec2: f64,
    /// Diameter of the observer's pupil in the dark, millimetres: 7 when young, 5.5 at seventy.
    pub pupil_mm: f64,
    /// The drive's periodic error from peak to peak, arcseconds: 25 before training, 5 after.
    pub periodic_error_arcsec: f64,
    /// Which facts are told of an object.
    pub facts: Choices,
    /// Which operator tones the overlay, and how bright it is beside the object's own light.
    pub tone: Toning,
    /// Where the picture lies on the projector's own pixels.
    pub placement: Placement,
    /// The projector's light.
    pub light: light::Light,
    /// The hand controller.
    pub handbox: handbox::Handbox,
    /// The safety rules.
    pub rules: Rules,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            site: None,
            mount: None,
            projector: None,
            instrument: None,
            photographs: None,
            stellarium: None,
            soften_stars: 0.0,
            maps: None,
            coordinates: None,
            sky_brightness_mag_arcsec2: 20.8,
            pupil_mm: DARK_PUPIL_MM,
            periodic_error_arcsec: 25.0,
            facts: Choices::default(),
            tone: Toning::default(),
            placement: Placement::default(),
            light: light::Light::default(),
            handbox: handbox::Handbox::default(),
            rules: Rules::default(),
        }
    }
}

/// Why settings (or the remembered state) cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// The file cannot be read.
    #[error("{} cannot be read ({why}): check the name and who may read it", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's words.
        why: String,
    },
    /// The file cannot be written. What stood there before stands there still.
    #[error("{} could not be saved ({why}); what was in it before is still there", path.display())]
    NotSaved {
        /// The file.
        path: PathBuf,
        /// The system's words.
        why: String,
    },
    /// Something in it is wrong.
    #[error("{}{}: {what}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// The line, if it can be told.
        line: Option<usize>,
        /// What is wrong, and what to do.
        what: String,
    },
}

impl SettingsError {
    /// Whether the fault is in what a person wrote (and not in the disk).
    #[must_use]
    pub fn is_asked_wrongly(&self) -> bool {
        matches!(self, SettingsError::Wrong { .. })
    }
}

impl From<SettingsError> for super::Failure {
    fn from(error: SettingsError) -> super::Failure {
        if error.is_asked_wrongly() { super::Failure::asked(error) } else { super::Failure::failed(error) }
    }
}

impl Settings {
    /// Reads the settings: from `config` if it is given, else from the user's configuration folder. A file that is not
    /// there gives the defaults.
    ///
    /// # Errors
    /// The file is there and cannot be read, or something in it is wrong: then nothing is guessed.
    pub fn load(config: Option<&Path>) -> Result<Settings, SettingsError> {
        match config.map(Path::to_owned).or_else(default_path) {
            Some(path) => Settings::read(&path, &mut disk::Files),
            None => Ok(Settings::default()),
        }
    }

    /// Reads one file from a disk.
    ///
    /// # Errors
    /// As [`Settings::load`].
    pub fn read(path: &Path, disk: &mut dyn Disk) -> Result<Settings, SettingsError> {
        let text = match disk.read(path, LARGEST_BYTES) {
            Ok(Some(bytes)) => String::from_utf8(bytes).map_err(|error| SettingsError::Wrong {
                path: path.into(),
                line: None,
                what: format!("it is not text ({error}): save it as UTF-8"),
            })?,
            Ok(None) => return Ok(Settings::default()),
            Err(error) => return Err(SettingsError::Unreadable { path: path.into(), why: error.to_string() }),
        };
        let mut settings = Settings::from_toml(&text).map_err(|wrong| SettingsError::Wrong {
            path: path.into(),
            line: wrong.line,
            what: wrong.what,
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        settings.instrument = settings.instrument.map(|file| folder.join(file));
        settings.photographs = settings.photographs.map(|file| folder.join(file));
        settings.stellarium = settings.stellarium.map(|file| folder.join(file));
        settings.maps = settings.maps.map(|file| folder.join(file));
        settings.coordinates = settings.coordinates.map(|file| folder.join(file));
        settings.handbox = settings.handbox.based_at(folder);
        settings.light = settings.light.based_at(folder);
        Ok(settings)
    }

    /// Reads settings from their text.
    ///
    /// # Errors
    /// The line, what is wrong there, and the nearest right key of a misspelt one.
    pub fn from_toml(text: &str) -> Result<Settings, explain::Wrong> {
        let settings: Settings = toml::from_str(text).map_err(|error| explain::wrong(&error, text))?;
        let out_of_range = |what: String| explain::Wrong { line: None, what };
        settings.rules.checked().map_err(|error: RuleError| out_of_range(error.to_string()))?;
        settings.placement.checked().map_err(|error: PlacementError| out_of_range(error.to_string()))?;
        settings.handbox.checked().map_err(out_of_range)?;
        settings.facts.checked().map_err(out_of_range)?;
        if !(0.0..=1.0).contains(&settings.soften_stars) {
            return Err(out_of_range(format!(
                "soften_stars = {} is out of range: give 0 (stars as they are) to 1 (none)",
                settings.soften_stars
            )));
        }
        settings.tone.checked().map_err(out_of_range)?;
        if !(settings.light.luminance_cd_m2 > 0.0 && settings.light.luminance_cd_m2 <= 1e4) {
            return Err(out_of_range(format!(
                "light.luminance_cd_m2 = {} is out of range: give more than 0, and at most 10000 cd/m2",
                settings.light.luminance_cd_m2
            )));
        }
        if !(2.0..=9.0).contains(&settings.pupil_mm) {
            return Err(out_of_range(format!(
                "pupil_mm = {} is out of range: give 5 (an old eye) to 8 (a young one)",
                settings.pupil_mm
            )));
        }
        if !(5.0..=25.0).contains(&settings.periodic_error_arcsec) {
            return Err(out_of_range(format!(
                "periodic_error_arcsec = {} is out of range: give 5 (a trained drive) to 25 (one that was never trained)",
                settings.periodic_error_arcsec
            )));
        }
        if !(10.0..=25.0).contains(&settings.sky_brightness_mag_arcsec2) {
            return Err(out_of_range(format!(
                "sky_brightness_mag_arcsec2 = {} is out of range: give 16 (a city) to 22.2 (the darkest sky)",
                settings.sky_brightness_mag_arcsec2
            )));
        }
        Ok(settings)
    }
}

/// `scotopic/settings.toml` in the user's configuration folder, if there is one.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    etcetera::choose_base_strategy().ok().map(|base| base.config_dir().join("scotopic").join("settings.toml"))
}

/// The table `[site]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SiteTable {
    latitude_deg: f64,
    longitude_deg: f64,
    #[serde(default)]
    elevation_m: f64,
}

fn site<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Site>, D::Error> {
    let table = SiteTable::deserialize(deserializer)?;
    Site::new(table.latitude_deg, table.longitude_deg, table.elevation_m).map(Some).map_err(serde::de::Error::custom)
}

/// A value written as the command line writes it.
fn parsed<'de, D: Deserializer<'de>, T: FromStr<Err: std::fmt::Display>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    String::deserialize(deserializer)?.parse().map(Some).map_err(serde::de::Error::custom)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_in_the_documents_is_read_and_says_the_defaults() {
        let text = include_str!("../../docs/settings.example.toml");
        let settings = Settings::from_toml(text).unwrap();
        assert_eq!(settings.site, Some(Site::new(60.17, 24.94, 30.0).unwrap()));
        assert_eq!(settings.rules, Rules::default());
        assert_eq!(settings.sky_brightness_mag_arcsec2, Settings::default().sky_brightness_mag_arcsec2);
        assert_eq!(settings.mount, Some(MountAddress::Sim));
        // Every line that is commented out must be right too, once the comment sign is taken away.
        let all: String = text
            .lines()
            .map(|line| line.strip_prefix("#! ").unwrap_or(line))
            .fold(String::new(), |all, line| all + line + "\n");
        assert_ne!(all, text);
        Settings::from_toml(&all).unwrap();
    }

    #[test]
    fn no_file_gives_the_defaults() {
        let settings = Settings::load(Some(Path::new("/nowhere/at/all.toml"))).unwrap();
        assert_eq!(settings, Settings::default());
    }

    #[test]
    fn a_misspelt_key_is_named_with_its_line_and_the_right_one() {
        for (text, line, words) in [
            ("\nlattitude_deg = 3\n", 2, "'lattitude_deg'"),
            ("[site]\nlattitude_deg = 60\nlongitude_deg = 25\n", 2, "did you mean 'latitude_deg'?"),
            ("[rules]\nsun_cone = 40\n", 2, "did you mean 'sun_cone_deg'?"),
            ("muont = \"sim\"\n", 1, "did you mean 'mount'?"),
        ] {
            let wrong = Settings::from_toml(text).unwrap_err();
            assert_eq!(wrong.line, Some(line), "{}", wrong.what);
            assert!(wrong.what.contains(words), "{}", wrong.what);
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused_in_words() {
        for (text, words) in [
            ("[site]\nlatitude_deg = 91\nlongitude_deg = 0", "latitude 91 is not on Earth"),
            ("[site]\nlatitude_deg = nan\nlongitude_deg = 0", "latitude NaN is not on Earth"),
            ("[site]\nlatitude_deg = 60", "longitude_deg"),
            ("mount = \"usb\"", "'usb' is not a mount"),
            ("projector = \"beamer\"", "'beamer' is no projector"),
            ("sky_brightness_mag_arcsec2 = 3", "16 (a city)"),
            ("[tone]\nmethod = \"reinhard\"", "`tr93`"),
            ("[tone]\npicture_over_object_mag = 99", "tone.picture_over_object_mag = 99"),
            ("[light]\nluminance_cd_m2 = nan", "light.luminance_cd_m2 = NaN"),
            ("pupil_mm = 70", "8 (a young one)"),
            ("[facts]\noff = [\"chart\"]", "`charts`"),
            ("[facts.types.planet]\noff = []", "planetary nebula"),
            ("[rules]\nsun_cone_deg = -1", "rule sun_cone_deg = -1 is out of range"),
            ("[placement]\nscale = 99", "scale = 99 is out of range"),
            ("[placement]\nscale = \"big\"", "scale = \"big\" is not understood"),
            ("[placement]\nscale = true", "scale is \"fit\" or a number"),
            ("[placement]\nrotation_deg = 45", "give 0, 90, 180 or 270"),
            ("[placement]\nflip = \"sideways\"", "`horizontal`"),
            ("[placement]\nright_px = 1000000", "right_px = 1000000 is out of range"),
            ("[placement]\nrigth_px = 1", "did you mean 'right_px'?"),
            ("mount = ", "line"),
            ("mount = 7", "string"),
            ("[handbox.keys]\n\"5\" = \"go-to\"", "it moves the telescope"),
            ("[handbox.keys]\n\"5\" = \"menue\"", "did you mean 'menu'?"),
            ("[handbox]\nsource = \"usb\"", "no source of keys"),
        ] {
            let wrong = Settings::from_toml(text).unwrap_err();
            let said = format!("line {:?}: {}", wrong.line, wrong.what);
            assert!(said.contains(words), "{text}: {said}");
        }
    }

    #[test]
    fn escapes_in_a_file_do_not_reach_the_terminal() {
        let wrong = Settings::from_toml("\"mount\\u001b[31m\" = 1").unwrap_err();
        assert!(!wrong.what.chars().any(char::is_control), "{:?}", wrong.what);
    }

    #[test]
    fn paths_are_counted_from_the_settings_file() {
        let mut disk = disk::Memory::default();
        let path = Path::new("/home/observer/.config/scotopic/settings.toml");
        disk.put(path, b"instrument = \"my.toml\"\nphotographs = \"/data/pictures\"\n");
        let settings = Settings::read(path, &mut disk).unwrap();
        assert_eq!(settings.instrument.as_deref(), Some(Path::new("/home/observer/.config/scotopic/my.toml")));
        assert_eq!(settings.photographs.as_deref(), Some(Path::new("/data/pictures")));
    }
}
