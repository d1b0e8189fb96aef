//! The two renderers behind one door: the one that flies, and the one for pictures.

use clap::ValueEnum;

use super::Arguments;
use crate::cli::Failure;
use crate::cli::nebula::render::deepest_voxel;
use crate::cli::nebula::table::for_pictures;
use crate::physics::dust::camera::Camera;
use crate::physics::dust::develop;
use crate::physics::dust::drawing::{Drawing, Light};
use crate::physics::dust::fast::{Flyer, Quality};
use crate::physics::dust::march::Emission;
use crate::physics::dust::multiple::{self, Field};
use crate::physics::dust::render::{View, Wish};
use crate::physics::dust::scene::Scene;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Literal;

/// Which light is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Model {
    /// Light scattered once
    Single,
    /// Light scattered any number of times
    Multiple,
    /// The thesis': each voxel by the scattering table
    Table,
}

/// A frame before it is developed.
pub(super) struct Painted {
    /// Radiance, row by row from the top.
    pub(super) light: Vec<[f32; 3]>,
    /// Share of the light behind that comes through.
    pub(super) through: Vec<[f32; 3]>,
    /// The worst relative error that the renderer believes in, if it looked for one.
    pub(super) error: Option<f64>,
}

/// A renderer that is ready.
pub(super) enum Painter<'a> {
    /// The one that flies, with the number of bands.
    Flying(Box<Flyer>, usize),
    /// The one for pictures.
    Drawing(Box<Drawing<'a>>, Wish),
}

impl<'a> Painter<'a> {
    /// Makes what does not depend on the eye; `first` is the camera of the first frame, for which columns to the stars are made.
    pub(super) fn new(
        volume: &'a Volume,
        scene: &'a Scene,
        emission: Option<Emission<'a>>,
        first: &Camera,
        arguments: &Arguments,
    ) -> Result<Painter<'a>, Failure> {
        let tolerance = arguments.tolerance;
        if !(1e-6..=0.5).contains(&tolerance) {
            return Err(Failure::asked(format!("a tolerance of {tolerance}: give a relative error from 1e-6 to 0.5")));
        }
        let gathered = || -> Result<Field, Failure> {
            let settings = multiple::Settings { seed: arguments.seed, ..multiple::Settings::fitting(volume) };
            multiple::gather(volume, scene, &settings).map_err(Failure::asked)
        };
        let field = match arguments.model {
            Model::Single | Model::Table => None,
            Model::Multiple => Some(gathered()?),
        };
        if arguments.preview && arguments.model == Model::Table {
            return Err(Failure::asked(
                "the renderer that flies has single and multiple scattering: leave out --preview, or give another --model than table",
            ));
        }
        if arguments.preview {
            if emission.is_some() {
                return Err(Failure::asked(
                    "the renderer that flies knows no light of the dust itself: leave out --emission or --preview",
                ));
            }
            let flyer = Flyer::new(volume, scene, field).map_err(Failure::asked)?;
            return Ok(Painter::Flying(Box::new(flyer), scene.bands()));
        }
        let wish = Wish { tolerance, step: None, everything: false, seed: arguments.seed };
        let light = match (field, arguments.model) {
            (Some(field), _) => Light::Multiple(Box::new(field)),
            (None, Model::Table) => {
                let (dust, deepest) = (scene.dust(), deepest_voxel(volume, scene));
                let table = for_pictures(dust.albedo, dust.phase, deepest, arguments.quiet)?;
                Light::Table(Box::new(table), Literal::default())
            }
            (None, _) => Light::Single,
        };
        let mut drawing = Drawing::new(volume, scene, light, emission);
        let view = View { camera: *first, width: arguments.size.width, height: arguments.size.height, near: 0.0 };
        drawing.prepare(&view, &wish, &mut |_| ());
        Ok(Painter::Drawing(Box::new(drawing), wish))
    }

    /// A frame.
    pub(super) fn paint(&mut self, camera: &Camera, width: usize, height: usize) -> Result<Painted, Failure> {
        match self {
            Painter::Flying(flyer, bands) => {
                let frame = flyer.frame(camera, width, height, &Quality::FULL).map_err(Failure::asked)?;
                let shown =
                    |pixels: Vec<[f32; 3]>| pixels.iter().map(|pixel| develop::colours(&pixel[..*bands])).collect();
                Ok(Painted { light: shown(frame.pixels), through: shown(frame.through), error: None })
            }
            Painter::Drawing(drawing, wish) => {
                let view = View { camera: *camera, width, height, near: 0.0 };
                let rendered = drawing.draw(&view, wish, &mut |_| ());
                Ok(Painted {
                    light: develop::pixels(&rendered.radiance),
                    through: develop::pixels(&rendered.through),
                    error: Some(rendered.explained.worst),
                })
            }
        }
    }
}
