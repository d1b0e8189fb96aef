//! How a nebula's light becomes a picture for people: white, gamma, and what is behind the dust.

use std::path::Path;
use std::str::FromStr;

use clap::Args;

use crate::cli::Failure;
use crate::numerics::hash::fnv;
use crate::overlay::photograph::read;
use crate::physics::dust::backdrop::{StarField, photograph};
use crate::physics::dust::camera::Camera;
use crate::physics::dust::develop::{Development, over, white_of};
use crate::picture::Picture;

/// Stars of a star field over the whole sky.
const STARS: usize = 40_000;
/// White in the background, in shares of white.
const BACKGROUND_LIGHT: f64 = 0.7;

/// What is asked of the development.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct DevelopArguments {
    /// Radiance that is shown as full, or auto: all but the brightest 0.5 % of the pixels with light are below it
    #[arg(long, value_name = "RADIANCE|auto", default_value = "auto", allow_negative_numbers = true)]
    white: White,
    /// Codes are light^(1/G); 1 shows light as it is [default: sRGB's own curve]
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    gamma: Option<f64>,
    /// What is behind the dust: a PNG or JPEG that covers the frame, or stars, or stars:SEED
    #[arg(long, value_name = "FILE|stars[:SEED]")]
    background: Option<Background>,
    /// How bright white in the background is, in shares of white
    #[arg(long, value_name = "SHARE", default_value_t = BACKGROUND_LIGHT, allow_negative_numbers = true)]
    background_light: f64,
}

/// What is shown as full.
#[derive(Debug, Clone, Copy, PartialEq)]
enum White {
    Fixed(f64),
    Found,
}

impl FromStr for White {
    type Err = String;

    fn from_str(text: &str) -> Result<White, String> {
        match text.parse() {
            _ if text == "auto" => Ok(White::Found),
            Ok(level) if f64::is_finite(level) && level > 0.0 => Ok(White::Fixed(level)),
            _ => Err(format!("'{text}': give auto, or a radiance above 0")),
        }
    }
}

/// What is behind the dust, as it is asked for.
#[derive(Debug, Clone, PartialEq)]
enum Background {
    Stars(u64),
    File(String),
}

impl FromStr for Background {
    type Err = String;

    fn from_str(text: &str) -> Result<Background, String> {
        match text.strip_prefix("stars") {
            Some("") => Ok(Background::Stars(1)),
            Some(rest) if rest.starts_with(':') => rest[1..]
                .parse()
                .map(Background::Stars)
                .map_err(|_no_seed| format!("'{text}': give a seed, such as stars:7")),
            _ => Ok(Background::File(text.to_owned())),
        }
    }
}

/// What is behind the dust.
#[derive(Debug, Clone)]
enum Behind {
    Nothing,
    /// With its seed.
    Stars(StarField, u64),
    /// With a hash of its file.
    Photograph(Picture, u64),
}

/// Where pictures are developed.
#[derive(Debug, Clone)]
pub struct Darkroom {
    white: White,
    gamma: Option<f64>,
    behind: Behind,
    background_light: f64,
}

/// A picture as the renderers give it: radiance in three colours, and the share of the light behind that comes through.
pub struct Negative<'a> {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The eye.
    pub camera: &'a Camera,
    /// Radiance, row by row from the top.
    pub light: &'a [[f32; 3]],
    /// Share of the light behind that comes through.
    pub through: &'a [[f32; 3]],
}

impl DevelopArguments {
    /// Whether nothing is asked for.
    #[must_use]
    pub fn is_usual(&self) -> bool {
        let usual =
            DevelopArguments { white: White::Found, gamma: None, background: None, background_light: BACKGROUND_LIGHT };
        *self == usual
    }

    /// Reads the photograph, and checks the numbers.
    ///
    /// # Errors
    /// A file that is no picture, or a number that cannot be.
    pub fn open(&self) -> Result<Darkroom, Failure> {
        let white = match self.white {
            White::Fixed(white) => white,
            White::Found => 1.0,
        };
        Development::new(white, self.gamma).map_err(Failure::asked)?;
        if !(0.0..=1000.0).contains(&self.background_light) {
            return Err(Failure::asked(format!("a background light of {}: give 0 to 1000", self.background_light)));
        }
        let behind = match &self.background {
            None => Behind::Nothing,
            Some(Background::Stars(seed)) => Behind::Stars(StarField::seeded(*seed, STARS), *seed),
            Some(Background::File(name)) => {
                let asked = |error: &dyn std::fmt::Display| Failure::asked(format!("{name}: {error}"));
                let length = std::fs::metadata(Path::new(name)).map_err(|error| asked(&error))?.len();
                if length > read::MOST_BYTES {
                    return Err(asked(&format!("{length} bytes: at most {} are read", read::MOST_BYTES)));
                }
                let bytes = std::fs::read(name).map_err(|error| asked(&error))?;
                Behind::Photograph(read::picture(&bytes).map_err(|error| asked(&error))?, fnv(&bytes))
            }
        };
        Ok(Darkroom { white: self.white, gamma: self.gamma, behind, background_light: self.background_light })
    }
}

impl Darkroom {
    /// All that it does to light, in one line; a photograph by a hash of its file.
    #[must_use]
    pub fn said(&self) -> String {
        let behind = match &self.behind {
            Behind::Nothing => "nothing".to_owned(),
            Behind::Stars(_, seed) => format!("stars of seed {seed}"),
            Behind::Photograph(_, hash) => format!("photograph {hash:016x}"),
        };
        format!("white {:?}, gamma {:?}, behind {behind} at {}", self.white, self.gamma, self.background_light)
    }

    /// The white that was asked for, if one was.
    #[must_use]
    pub fn fixed_white(&self) -> Option<f64> {
        match self.white {
            White::Fixed(white) => Some(white),
            White::Found => None,
        }
    }

    /// The white for a picture: the one asked for, or found.
    #[must_use]
    pub fn white(&self, light: &[[f32; 3]]) -> f64 {
        self.fixed_white().unwrap_or_else(|| white_of(light))
    }

    /// Codes, row by row from the top.
    ///
    /// # Errors
    /// A white that is none.
    pub fn develop(&self, negative: &Negative<'_>, white: f64) -> Result<Vec<[u8; 3]>, Failure> {
        let development = Development::new(white, self.gamma).map_err(Failure::asked)?;
        let Negative { width, height, camera, light, through } = *negative;
        let behind = match &self.behind {
            Behind::Nothing => return Ok(light.iter().map(|pixel| development.codes(*pixel)).collect()),
            Behind::Stars(field, _) => field.draw(camera, width, height),
            Behind::Photograph(picture, _) => photograph(picture, width, height),
        };
        let strength = (self.background_light * white) as f32;
        let composed = light.iter().zip(through).zip(behind).enumerate().map(|(i, ((light, through), behind))| {
            // A dome is black outside its circle.
            let (column, row) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let seen = camera.ray(column, row, width, height).is_some();
            development.codes(over(*light, *through, behind.map(|band| if seen { band * strength } else { 0.0 })))
        });
        Ok(composed.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_auto_or_a_radiance_and_a_background_stars_or_a_file() {
        assert_eq!("auto".parse(), Ok(White::Found));
        assert_eq!("0.5".parse(), Ok(White::Fixed(0.5)));
        assert!("0".parse::<White>().is_err() && "nan".parse::<White>().is_err() && "-1".parse::<White>().is_err());
        assert_eq!("stars".parse(), Ok(Background::Stars(1)));
        assert_eq!("stars:7".parse(), Ok(Background::Stars(7)));
        assert_eq!("starsky.png".parse(), Ok(Background::File("starsky.png".into())));
        assert!("stars:x".parse::<Background>().is_err());
    }
}
