//! What is lit and by what, as flags and scene files say it.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use glam::DVec3;

use super::triple::numbers;
use crate::cli::Failure;
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::scene::{Dust, RED_GREEN_BLUE, Scene, Star};
use crate::physics::dust::starlight::{self, RED_GREEN_BLUE_NM};

/// Scene files.
pub mod file;

pub use file::Document;

/// Extinction in V where nothing is said: a nebula of density 1 in a box from -1 to 1 is a few optical depths deep.
const USUAL_EXTINCTION: f64 = 4.0;

/// Dust and stars.
#[derive(Debug, Clone, Default, Args)]
pub struct SceneArguments {
    /// A scene in a TOML file; flags go before what it says
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// A star, again for more: place; temperature in kelvin, if its colour counts (0: none); radiant intensity [default: 0,0,0]
    #[arg(long = "star", value_name = "X,Y,Z[,KELVIN[,INTENSITY]]", allow_hyphen_values = true)]
    pub stars: Vec<StarFlag>,
    /// Extinction per unit of length at density 1, a number for each band [default: 4 in V, with R and B as the thesis has them]
    #[arg(long, value_name = "K[,K...]", value_delimiter = ',', allow_hyphen_values = true)]
    pub extinction: Option<Vec<f64>>,
    /// Share of the extinction that is scattering, 0 to 1 [default: 0.6]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub albedo: Option<f64>,
    /// Mean cosine g of the angle that grains turn light through, -1 to 1 [default: 0.6]
    #[arg(long, visible_alias = "g", value_name = "G", allow_negative_numbers = true)]
    pub asymmetry: Option<f64>,
    /// Wavelength of each band, for stars with a temperature, nanometres [default, for three bands: 641,545,436]
    #[arg(long, value_name = "NM[,NM...]", value_delimiter = ',', allow_hyphen_values = true)]
    pub wavelengths_nm: Option<Vec<f64>>,
}

/// A star as a flag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StarFlag {
    position: DVec3,
    kelvin: Option<f64>,
    intensity: f64,
}

impl FromStr for StarFlag {
    type Err = String;

    fn from_str(text: &str) -> Result<StarFlag, String> {
        let star = |x, y, z, kelvin: f64, intensity| StarFlag {
            position: DVec3::new(x, y, z),
            kelvin: (kelvin != 0.0).then_some(kelvin),
            intensity,
        };
        match *numbers(text)?.as_slice() {
            [x, y, z] => Ok(star(x, y, z, 0.0, 1.0)),
            [x, y, z, kelvin] => Ok(star(x, y, z, kelvin, 1.0)),
            [x, y, z, kelvin, intensity] => Ok(star(x, y, z, kelvin, intensity)),
            _ => {
                Err(format!("'{text}': give X,Y,Z, then perhaps the temperature in kelvin, then perhaps the intensity"))
            }
        }
    }
}

impl SceneArguments {
    /// Reads the scene file, if there is one.
    ///
    /// # Errors
    /// The file cannot be read, or says what cannot be.
    pub fn document(&self) -> Result<Document, Failure> {
        self.scene.as_deref().map_or(Ok(Document::default()), |path: &Path| file::open(path))
    }

    /// Puts flags and scene file together.
    ///
    /// # Errors
    /// What cannot be, with its value.
    pub fn scene(&self, said: &Document) -> Result<Scene, Failure> {
        let extinction = match self.extinction.clone().or_else(|| said.extinction()) {
            Some(extinction) => extinction,
            None => RED_GREEN_BLUE.map(|share| share * USUAL_EXTINCTION).to_vec(),
        };
        let asymmetry = self.asymmetry.or(said.asymmetry).unwrap_or(0.6);
        let phase = HenyeyGreenstein::new(asymmetry)
            .ok_or_else(|| Failure::asked(crate::physics::dust::scene::SceneError::Asymmetry(asymmetry)))?;
        let bands = extinction.len();
        let dust = Dust { extinction, albedo: self.albedo.or(said.albedo).unwrap_or(0.6), phase };
        let wavelengths = match self.wavelengths_nm.as_ref().or(said.wavelengths_nm.as_ref()) {
            Some(wavelengths) if wavelengths.len() != bands => {
                return Err(Failure::asked(format!(
                    "{} wavelengths for {bands} extinctions: give one for each band",
                    wavelengths.len()
                )));
            }
            Some(wavelengths) => Some(wavelengths.clone()),
            None => (bands == RED_GREEN_BLUE_NM.len()).then(|| RED_GREEN_BLUE_NM.to_vec()),
        };
        let star = |position, kelvin: Option<f64>, intensity: &[f64]| {
            let mut light = match *intensity {
                [] => vec![1.0; bands],
                [one] => vec![one; bands],
                _ => intensity.to_vec(),
            };
            if let Some(kelvin) = kelvin {
                let wavelengths = wavelengths.as_deref().ok_or_else(|| {
                    Failure::asked(format!(
                        "a star of {kelvin} K in {bands} bands: say which they are with --wavelengths-nm (three are R, V, B)"
                    ))
                })?;
                let colour = starlight::colour(kelvin, wavelengths).ok_or_else(|| {
                    Failure::asked(format!(
                        "a star of {kelvin} K at {wavelengths:?} nm: temperatures are 500 to 1000000 K, wavelengths 100 to 100000 nm"
                    ))
                })?;
                light.iter_mut().zip(colour).for_each(|(light, colour)| *light *= colour);
            }
            Ok(Star { position, intensity: light })
        };
        let flags = self.stars.iter().map(|flag| star(flag.position, flag.kelvin, &[flag.intensity]));
        let file = said.star.iter().map(|said| {
            star(DVec3::from_array(said.position), said.kelvin, said.intensity.as_ref().map_or(&[][..], |i| i.list()))
        });
        let stars: Result<Vec<Star>, Failure> = match (self.stars.is_empty(), said.star.is_empty()) {
            (false, _) => flags.collect(),
            (true, false) => file.collect(),
            (true, true) => Ok(vec![Star { position: DVec3::ZERO, intensity: vec![1.0; bands] }]),
        };
        Scene::new(dust, stars?).map_err(Failure::asked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_is_a_place_then_a_temperature_then_an_intensity() {
        let star: StarFlag = "-0.5,0,0.25,10000,3".parse().unwrap();
        assert_eq!((star.position.x, star.kelvin, star.intensity), (-0.5, Some(10_000.0), 3.0));
        assert_eq!("0,0,1".parse::<StarFlag>().unwrap().kelvin, None);
        for wrong in ["0,0", "a,b,c", "0,0,nan", "1,2,3,4,5,6"] {
            assert!(wrong.parse::<StarFlag>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn stars_are_white_without_a_temperature_and_blue_when_hot() {
        let arguments = SceneArguments {
            stars: vec!["0,0,0".parse().unwrap(), "0,0,0,20000,2".parse().unwrap()],
            ..SceneArguments::default()
        };
        let scene = arguments.scene(&Document::default()).unwrap();
        assert_eq!(scene.stars()[0].intensity, [1.0; 3]);
        let [red, green, blue] = scene.stars()[1].intensity[..] else { panic!("three bands") };
        assert!(red < green && (green - 2.0).abs() < 1e-12 && green < blue);
        let one_band = SceneArguments { extinction: Some(vec![4.0]), ..arguments };
        assert!(one_band.scene(&Document::default()).unwrap_err().to_string().contains("--wavelengths-nm"));
    }
}
