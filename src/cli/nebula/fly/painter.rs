//! The two renderers behind one door: the one that flies, and the one for pictures.

use std::path::Path;

use crate::cli::Failure;
use crate::cli::nebula::lighting::{self, Model};
use crate::physics::dust::camera::Camera;
use crate::physics::dust::drawing::{Drawing, Light};
use crate::physics::dust::fast::{Flyer, Quality};
use crate::physics::dust::march::Emission;
use crate::physics::dust::multiple::Settings;
use crate::physics::dust::render::{View, Wish};
use crate::physics::dust::scene::Scene;
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Literal;

/// What all frames show: on it the bits of every frame depend, and on nothing else.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) volume: &'a Volume,
    pub(super) scene: &'a Scene,
    pub(super) emission: Option<Emission<'a>>,
    pub(super) model: Model,
    pub(super) literal: Literal,
    pub(super) settings: &'a Settings,
    pub(super) wish: Wish,
    /// Drawn by the renderer that flies.
    pub(super) preview: bool,
}

/// A frame before it is developed: planes, one a band, row by row from the top.
pub(super) struct Painted {
    /// Radiance.
    pub(super) light: Vec<Vec<f32>>,
    /// Share of the light behind that comes through.
    pub(super) through: Vec<Vec<f32>>,
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

/// A renderer, and where its gathered light came from.
pub(super) struct Ready<'a> {
    pub(super) painter: Painter<'a>,
    /// The light that has scattered before was in the cache; nothing where there is none.
    pub(super) cached: Option<bool>,
}

impl<'a> Painter<'a> {
    /// Makes what does not depend on the eye; `first` is what the first frame sees, for which columns to the stars are made: each machine makes
    /// the same.
    pub(super) fn ready(
        subject: &Subject<'a>,
        first: &View,
        cache: Option<&Path>,
        quiet: bool,
    ) -> Result<Ready<'a>, Failure> {
        let Subject { volume, scene, emission, model, literal, settings, wish, preview } = *subject;
        if preview && model == Model::Table {
            return Err(Failure::asked(
                "the renderer that flies has single and multiple scattering: leave out --preview, or give another --model than table",
            ));
        }
        if preview && emission.is_some() {
            return Err(Failure::asked(
                "the renderer that flies knows no light of the dust itself: leave out --emission or --preview",
            ));
        }
        let gathered = match model {
            Model::Single | Model::Table => None,
            Model::Multiple => Some(lighting::gathered(volume, scene, settings, cache)?),
        };
        let cached = gathered.as_ref().map(|gathered| gathered.cached);
        let field = gathered.map(|gathered| gathered.field);
        if preview {
            let flyer = Flyer::new(volume, scene, field).map_err(Failure::asked)?;
            return Ok(Ready { painter: Painter::Flying(Box::new(flyer), scene.bands()), cached });
        }
        let light = match (field, model) {
            (Some(field), _) => Light::Multiple(Box::new(field)),
            (None, Model::Table) => lighting::table(volume, scene, literal, quiet)?,
            (None, _) => Light::Single,
        };
        let mut drawing = Drawing::new(volume, scene, light, emission);
        drawing.prepare(first, &wish, &mut |_| ());
        Ok(Ready { painter: Painter::Drawing(Box::new(drawing), wish), cached })
    }

    /// A frame.
    pub(super) fn paint(&mut self, camera: &Camera, width: usize, height: usize) -> Result<Painted, Failure> {
        match self {
            Painter::Flying(flyer, bands) => {
                let frame = flyer.frame(camera, width, height, &Quality::FULL).map_err(Failure::asked)?;
                let planes = |pixels: &[[f32; 3]]| {
                    (0..*bands).map(|band| pixels.iter().map(|pixel| pixel[band]).collect()).collect()
                };
                Ok(Painted { light: planes(&frame.pixels), through: planes(&frame.through), error: None })
            }
            Painter::Drawing(drawing, wish) => {
                let view = View { camera: *camera, width, height, near: 0.0 };
                let rendered = drawing.draw(&view, wish, &mut |_| ());
                let error = Some(rendered.explained.worst);
                Ok(Painted { light: rendered.radiance, through: rendered.through, error })
            }
        }
    }
}
