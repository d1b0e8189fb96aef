//! A nebula made ready to be drawn, from any number of viewpoints: its model of scattering with what that has to know.

use super::light::lattice::Lattice;
use super::march::Emission;
use super::model::{Scattering, Together};
use super::multiple::Field;
use super::render::plan::lattice_for;
use super::render::{Rendered, Subject, View, Wish, render};
use super::scene::Scene;
use super::single::Single;
use super::table::Table;
use super::volume::Volume;
use super::voxelwise::{Literal, Voxelwise};

/// Models of scattering.
#[derive(Debug, Clone)]
pub enum Light {
    /// Exact single scattering.
    Single,
    /// Single scattering, and the light that has been scattered before.
    Multiple(Box<Field>),
    /// Only light that has been scattered more than once, as a field of one order holds it.
    Before(Box<Field>),
    /// The thesis': a table, voxel by voxel.
    Table(Box<Table>, Literal),
}

/// Columns to the stars that were computed beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prepared {
    /// Spacings of their lattice along the longest side.
    pub spacings: usize,
    /// Worst relative error that they make on the rays that were tried.
    pub error: f64,
    /// Bytes of memory.
    pub bytes: usize,
}

/// A nebula ready to be drawn.
pub struct Drawing<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    light: Light,
    emission: Option<Emission<'a>>,
    lattice: Option<(Lattice, Prepared)>,
}

impl<'a> Drawing<'a> {
    /// Dust, stars, and how light is scattered.
    #[must_use]
    pub fn new(volume: &'a Volume, scene: &'a Scene, light: Light, emission: Option<Emission<'a>>) -> Drawing<'a> {
        Drawing { volume, scene, light, emission, lattice: None }
    }

    /// Computes the columns to the stars, as fine as a picture of this view needs them, where that costs less than to do without. Pictures
    /// from other places may be drawn with them too: they say what error they have.
    pub fn prepare(&mut self, view: &View, wish: &Wish, told: &mut dyn FnMut(f64)) -> Option<Prepared> {
        let only_field = matches!(self.light, Light::Before(_));
        let chosen = if only_field { None } else { lattice_for(self.volume, self.scene, view, wish) };
        self.lattice = chosen.map(|(spacings, error)| {
            let lattice = Lattice::new(self.volume, self.scene.stars(), spacings, told);
            let bytes = lattice.bytes();
            (lattice, Prepared { spacings, error, bytes })
        });
        self.lattice.as_ref().map(|(_, prepared)| *prepared)
    }

    /// Draws a picture. The same for any number of threads.
    #[must_use]
    pub fn draw(&self, view: &View, wish: &Wish, told: &mut dyn FnMut(f64)) -> Rendered {
        let Drawing { volume, scene, emission, .. } = *self;
        let draw = |model: &dyn Scattering, exact: &dyn Scattering, told: &mut dyn FnMut(f64)| {
            render(&Subject { volume, scene, model, exact, emission }, view, wish, told)
        };
        let lattice = self.lattice.as_ref().map(|(lattice, _)| lattice);
        let exact = Single::exact(volume, scene);
        let quick = lattice.map_or(Single::exact(volume, scene), |lattice| Single::quick(volume, scene, lattice));
        match &self.light {
            Light::Single => draw(&quick, &exact, told),
            Light::Multiple(field) => {
                let seen = match view.camera.parallel() {
                    Some(forward) => field.along(-forward),
                    None => field.from(view.camera.eye()),
                };
                let quick = Together::new("multiple", vec![&quick, &seen]);
                let exact = Together::new("multiple", vec![&exact, field.as_ref()]);
                draw(&quick, &exact, told)
            }
            Light::Before(field) => draw(field.as_ref(), field.as_ref(), told),
            Light::Table(table, literal) => {
                let quick = Voxelwise::new(volume, scene, table, lattice).literal(*literal);
                let exact = Voxelwise::new(volume, scene, table, None).literal(*literal);
                let scene = &literal.seen(scene);
                render(&Subject { volume, scene, model: &quick, exact: &exact, emission }, view, wish, told)
            }
        }
    }

    /// The model's name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self.light {
            Light::Single => "single",
            Light::Multiple(_) => "multiple",
            Light::Before(_) => "scattered before",
            Light::Table(..) => "table",
        }
    }

    /// The believed relative error of the model's own light: noise of photons, what harmonics cannot hold. It is not in the error of a
    /// picture's rays and pixels.
    #[must_use]
    pub fn model_error(&self) -> f64 {
        match &self.light {
            Light::Single => 0.0,
            Light::Multiple(field) | Light::Before(field) => field.error(),
            Light::Table(table, _) => table.worst_error(),
        }
    }

    /// What the model does not have, whatever its error says.
    #[must_use]
    pub fn leaves_out(&self) -> Option<&'static str> {
        match self.light {
            Light::Single => Some("light scattered more than once is not in it: too faint and, in thick dust, too red"),
            Light::Table(..) => Some(
                "light that goes from voxel to voxel is not in it: too faint, by 40 to 50 % in the clouds of `scotopic report nebula`",
            ),
            Light::Multiple(_) | Light::Before(_) => None,
        }
    }
}
