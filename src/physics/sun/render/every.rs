//! Pixel by pixel: every ray of every pixel at every wavelength is traced, and nothing is left out. Slow; what the quick way is
//! held against.

use super::{Frame, Rendered, gauss, levels, lights};
use crate::numerics::roots::bracketed;
use crate::physics::refraction::ray::{Launch, Outcome, Tracer};
use crate::physics::sun::air::{Matter, Path, molecule_m2};
use crate::physics::sun::render::Light;
use crate::physics::sun::scene::{Scene, SceneError};
use crate::units::Angle;

/// Wavelengths where none are asked for: the most that the quick way would choose.
const WAVELENGTHS: usize = 64;

/// Looks into each part of a pixel for the limb.
const LOOKS: usize = 4;

/// Rays are traced to this share of the tolerance.
const FINER: f64 = 1e-3;

/// Makes the picture pixel by pixel: all columns, or those named (the others stay black). `done` hears what share is done.
///
/// # Errors
/// The scene cannot be; the sentence says how it can.
pub fn everything(
    scene: &Scene<'_>,
    columns: Option<&[usize]>,
    done: &mut dyn FnMut(f64),
) -> Result<Rendered, SceneError> {
    scene.check()?;
    let matter = Matter::of(scene)?;
    let lights = lights(scene, scene.wavelengths.unwrap_or(WAVELENGTHS))?;
    let mut mediums = Vec::with_capacity(lights.len());
    for light in &lights {
        mediums.push(matter.medium(scene, light.sample.nm)?);
    }
    let lehn = scene.method.name().starts_with("lehn");
    let tolerance = if lehn { scene.tolerance } else { scene.tolerance * FINER };
    let mut rays = Vec::with_capacity(lights.len());
    for (light, medium) in lights.iter().zip(&mediums) {
        let altitudes = medium.critical_altitudes(scene.observer_height_m);
        rays.push(Rays {
            scene,
            matter: &matter,
            tracer: scene.method.prepare(medium, tolerance)?,
            molecule_m2: molecule_m2(scene, light.sample.nm),
            borders: altitudes.iter().map(|altitude| altitude.to_radians()).collect(),
        });
    }
    let frame = Frame::of(scene);
    let (width, height) = (scene.view.width, scene.view.height);
    let all: Vec<usize> = (0..width).collect();
    let mut xyz = vec![[0f32; 3]; width * height];
    for y in 0..height {
        for &x in columns.unwrap_or(&all) {
            let from = x as f64 - 0.5 * width as f64;
            let mut sum = [0.0; 3];
            for (light, rays) in lights.iter().zip(&rays) {
                let bright = rays.mean(light, &frame, y, [from, from + 1.0])?;
                sum.iter_mut().zip(light.centre).for_each(|(sum, centre)| *sum += bright * centre);
            }
            if let Some(pixel) = xyz.get_mut(y * width + x) {
                *pixel = sum.map(|part| part as f32);
            }
        }
        done((y + 1) as f64 / height as f64);
    }
    Ok(Rendered { view: scene.view, xyz })
}

/// Rays at one wavelength.
struct Rays<'a> {
    scene: &'a Scene<'a>,
    matter: &'a Matter,
    tracer: Box<dyn Tracer + 'a>,
    molecule_m2: f64,
    borders: Vec<f64>,
}

impl Rays<'_> {
    fn path(&self, altitude: f64) -> Result<Option<Path>, SceneError> {
        let launch = Launch { apparent_altitude: Angle::radians(altitude), height_m: self.scene.observer_height_m };
        let ray = self.tracer.trace(&launch)?;
        Ok((ray.outcome == Outcome::Escaped).then(|| self.matter.path(&ray, self.molecule_m2)))
    }

    /// Mean brightness of a pixel, relative to the disc's centre above the air.
    fn mean(&self, light: &Light, frame: &Frame, y: usize, across: [f64; 2]) -> Result<f64, SceneError> {
        let row = frame.row(y);
        let [low_limb, high_limb] = levels(self.scene);
        // Cut the pixel where a border of the air is met.
        let inside = self.borders.iter().copied().filter(|border| row[0] < *border && *border < row[1]);
        let cuts: Vec<f64> = std::iter::once(row[0]).chain(inside).chain([row[1]]).collect();
        let mut sum = 0.0;
        for part in cuts.windows(2) {
            // Look where the limb is met; the ends themselves may be on the ground.
            let hair = 1e-9 * (part[1] - part[0]);
            let truth = |altitude: f64| Ok::<_, SceneError>(self.path(altitude)?.map(|path| altitude - path[0]));
            let place = |i: usize| part[0] + hair + (part[1] - part[0] - 2.0 * hair) * i as f64 / LOOKS as f64;
            let mut borders = vec![part[0]];
            let mut before = truth(place(0))?;
            let mut dark = before.is_none();
            for i in 1..=LOOKS {
                let here = truth(place(i))?;
                dark |= here.is_none();
                if let (Some(a), Some(b)) = (before, here) {
                    let mut met: Vec<f64> = [low_limb, high_limb]
                        .iter()
                        .filter(|level| (a < **level) != (b < **level))
                        .map(|level| {
                            bracketed(place(i - 1), place(i), 1e-15, |altitude| match self.path(altitude) {
                                Ok(Some(path)) => altitude - path[0] - level,
                                _ => 0.0,
                            })
                        })
                        .collect();
                    met.sort_by(f64::total_cmp);
                    borders.extend(met);
                }
                before = here;
            }
            borders.push(part[1]);
            for stretch in borders.windows(2).filter(|pair| pair[0] < pair[1]) {
                // In one piece lies all of it inside the disc, or none.
                let middle = truth(0.5 * (stretch[0] + stretch[1]))?;
                if !dark && middle.is_none_or(|truth| truth <= low_limb || truth >= high_limb) {
                    continue;
                }
                for (altitude, weight) in gauss([stretch[0], stretch[1]], row) {
                    let Some(path) = self.path(altitude)? else { continue };
                    let chord = frame.chord(altitude, altitude - path[0]);
                    let covered =
                        chord.integral(&light.darkening, across[1]) - chord.integral(&light.darkening, across[0]);
                    sum += weight * covered * (-light.takes.depth(&path)).exp();
                }
            }
        }
        Ok(sum)
    }
}
