//! Camera paths in TOML files.

use std::path::Path as FilePath;

use glam::DVec3;
use serde::Deserialize;

use crate::cli::Failure;
use crate::cli::settings::explain;
use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::path::{Curve, Key, Orbit, Path, PathError, Stand};

/// Larger files are no paths.
const LARGEST_BYTES: u64 = 4 << 20;

/// How directions are laid on a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum View {
    #[default]
    Perspective,
    Orthographic,
    Domemaster,
}

/// A path as TOML says it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    view: View,
    /// Full angle of the view, for keys that do not say their own; of a picture with parallel rays its width.
    fov_deg: Option<f64>,
    width: Option<f64>,
    #[serde(default)]
    straight: bool,
    #[serde(default)]
    key: Vec<KeyDocument>,
    orbit: Option<OrbitDocument>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyDocument {
    time: f64,
    eye: [f64; 3],
    #[serde(default)]
    look_at: [f64; 3],
    #[serde(default = "upright")]
    up: [f64; 3],
    fov_deg: Option<f64>,
    width: Option<f64>,
}

fn upright() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OrbitDocument {
    radius: f64,
    #[serde(default)]
    centre: [f64; 3],
    #[serde(default)]
    elevation_deg: f64,
    #[serde(default)]
    from_deg: f64,
    #[serde(default = "one_turn")]
    turns: f64,
}

fn one_turn() -> f64 {
    1.0
}

/// A path with the lens that looks along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    path: Path,
    view: View,
}

impl Way {
    /// Reads a file.
    ///
    /// # Errors
    /// The file's name, the line, and what is wrong.
    pub fn open(file: &FilePath) -> Result<Way, Failure> {
        let asked = |what: &dyn std::fmt::Display| Failure::asked(format!("{}: {what}", file.display()));
        let bytes = std::fs::metadata(file).map_err(|error| asked(&error))?.len();
        if bytes > LARGEST_BYTES {
            return Err(asked(&format!("{bytes} bytes are too many for a path")));
        }
        let text = std::fs::read_to_string(file).map_err(|error| asked(&error))?;
        Way::read(&text).map_err(|what| asked(&what))
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// The line, and what is wrong.
    pub fn read(text: &str) -> Result<Way, String> {
        let document: Document = toml::from_str(text).map_err(|error| {
            let wrong = explain::wrong(&error, text);
            wrong.line.map_or(String::new(), |line| format!("line {line}: ")) + &wrong.what
        })?;
        let view = document.view;
        let field = |fov_deg: Option<f64>, width: Option<f64>| match view {
            View::Orthographic if fov_deg.is_some() => Err("an orthographic view has a width, no fov_deg".to_owned()),
            View::Orthographic => Ok(width),
            _ if width.is_some() => Err("width belongs to an orthographic view: give fov_deg".to_owned()),
            _ => Ok(fov_deg.map(f64::to_radians)),
        };
        let usual = field(document.fov_deg, document.width)?.unwrap_or(match view {
            View::Perspective => 40f64.to_radians(),
            View::Orthographic => 2.0,
            View::Domemaster => 180f64.to_radians(),
        });
        let path = match document.orbit {
            Some(_) if !document.key.is_empty() => return Err("both keys and an orbit are given: leave one out".into()),
            Some(orbit) => Path::around(Orbit {
                centre: DVec3::from_array(orbit.centre),
                radius: orbit.radius,
                elevation: orbit.elevation_deg.to_radians(),
                from: orbit.from_deg.to_radians(),
                turns: orbit.turns,
                field: usual,
            }),
            None => {
                let key = |key: KeyDocument| {
                    let stand = Stand {
                        eye: DVec3::from_array(key.eye),
                        look_at: DVec3::from_array(key.look_at),
                        up: DVec3::from_array(key.up),
                        field: field(key.fov_deg, key.width)?.unwrap_or(usual),
                    };
                    Ok(Key { time: key.time, stand })
                };
                let keys = document.key.into_iter().map(key).collect::<Result<_, String>>()?;
                Path::through(keys, if document.straight { Curve::Straight } else { Curve::Smooth })
            }
        };
        let way = Way { path: path.map_err(|error: PathError| error.to_string())?, view };
        // Angles that no lens has are told now, not at a frame in the middle of the night.
        way.camera(0, 1).map(|_| way)
    }

    /// The camera of a frame.
    ///
    /// # Errors
    /// The eye is where it looks to, or no lens has the angle.
    pub fn camera(&self, number: usize, frames: usize) -> Result<Camera, String> {
        let stand = self.path.frame(number, frames);
        let lens = match self.view {
            View::Perspective => Lens::Perspective { field: stand.field },
            View::Orthographic => Lens::Orthographic { width: stand.field },
            View::Domemaster => Lens::Domemaster { field: stand.field },
        };
        Camera::looking(stand.eye, stand.look_at, stand.up, lens).ok_or_else(|| {
            format!(
                "frame {number}: the eye at {} cannot look to {} with a view of {:.3}: move one, or give a perspective less than 180 \
                 degrees and a dome at most 360",
                stand.eye,
                stand.look_at,
                if self.view == View::Orthographic { stand.field } else { stand.field.to_degrees() }
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_an_orbit_are_read() {
        let keys =
            "fov_deg = 50\n[[key]]\ntime = 0\neye = [0, 0, 4]\n[[key]]\ntime = 2.5\neye = [1, 0, 0]\nfov_deg = 90";
        let way = Way::read(keys).unwrap();
        assert_eq!(way.camera(4, 5).unwrap().eye(), DVec3::X);
        let dome = Way::read("view = 'domemaster'\nfov_deg = 210\n[orbit]\nradius = 3\nelevation_deg = 20").unwrap();
        assert!((dome.camera(2, 7).unwrap().eye().length() - 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line_or_key() {
        let told = |text: &str| Way::read(text).unwrap_err();
        assert!(
            told("[[key]]\ntime = 0\neie = [0, 0, 4]").contains("line 3") && told("[[key]]\neie = 1").contains("'eye'")
        );
        assert!(told("").contains("0 key frames"));
        assert!(told("[orbit]\nradius = -1").contains("radius is -1"));
        assert!(told("[orbit]\nradius = 1\n[[key]]\ntime = 0\neye = [1, 1, 1]").contains("leave one out"));
        assert!(told("fov_deg = 180\n[orbit]\nradius = 3").contains("180"));
        assert!(told("width = 1\n[orbit]\nradius = 3").contains("fov_deg"));
    }
}
