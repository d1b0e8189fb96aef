//! The light of the sky in front of and around the disc: few wavelengths and few directions, because it is smooth, and what lies
//! between by straight lines.

use super::render::Rendered;
use super::scene::{Scene, SceneError};
use super::wavelengths::samples;
use crate::physics::colour::Xyz;
use crate::physics::ozone::OzoneLayer;
use crate::physics::refraction::ray::Medium;
use crate::physics::skylight::{self, Skylight};
use crate::units::Angle;

/// Wavelengths of the sky: its spectrum has no edges, and each takes about a second.
pub const WAVELENGTHS: usize = 8;

/// Directions upwards (in each of ground and sky) and to one side. Upwards they lie denser at the horizon.
const UP: usize = 24;
const ASIDE: usize = 9;

/// By green light the horizon is told.
const GREEN_NM: f64 = 550.0;

/// To this fraction particles are computed: more than the sky is good for.
const PARTICLES_TOLERANCE: f64 = 0.01;

/// The sky's light at directions of a grid: altitudes from the horizon, up or down, and azimuths from the Sun's.
struct Grid {
    horizon: f64,
    /// Height of the grid, radians; negative downwards.
    reach: f64,
    width: f64,
    light: Vec<Xyz>,
}

impl Grid {
    fn new(horizon: f64, edge: f64, width: f64) -> Grid {
        Grid { horizon, reach: edge - horizon, width, light: vec![[0.0; 3]; UP * ASIDE] }
    }

    /// Altitude and azimuth of a direction. The first lies a hair from the horizon, on the grid's own side.
    fn direction(&self, up: usize, aside: usize) -> (f64, f64) {
        let share = up as f64 / (UP - 1) as f64;
        (self.horizon + self.reach * (share * share).max(1e-6), self.width * aside as f64 / (ASIDE - 1) as f64)
    }

    /// By straight lines between directions.
    fn at(&self, altitude: f64, azimuth: f64) -> Xyz {
        let share = ((altitude - self.horizon) / self.reach).clamp(0.0, 1.0).sqrt();
        let place = |share: f64, count: usize| {
            let place = share * (count - 1) as f64;
            let below = (place as usize).min(count - 2);
            (below, place - below as f64)
        };
        let (up, u) = place(share, UP);
        let (aside, a) = place((azimuth.abs() / self.width).min(1.0), ASIDE);
        let corner = |i: usize, j: usize| self.light[(up + i) * ASIDE + aside + j];
        std::array::from_fn(|k| {
            (1.0 - u) * ((1.0 - a) * corner(0, 0)[k] + a * corner(0, 1)[k])
                + u * ((1.0 - a) * corner(1, 0)[k] + a * corner(1, 1)[k])
        })
    }
}

/// Adds the light of the sky, and of the ground under it, to a picture of the disc. Particles take light by the plain law here,
/// whatever the disc's: forward scattering is followed. `done` hears what share is done.
///
/// # Errors
/// The Sun is too high or too low for the method, or the air cannot be.
pub fn add(
    scene: &Scene<'_>,
    ground_albedo: f64,
    rendered: &mut Rendered,
    done: &mut dyn FnMut(f64),
) -> Result<(), SceneError> {
    scene.check()?;
    let view = rendered.view;
    let (bottom, top, pixel) = (view.bottom.to_radians(), view.top().to_radians(), view.pixel.to_radians());
    let medium = Medium::new(scene.profile, GREEN_NM, scene.earth_radius_m, scene.top_m)?;
    let critical = medium.critical_altitudes(scene.observer_height_m);
    let horizon = critical.first().map_or(0.0, |altitude| altitude.to_radians());
    let widest = bottom.abs().max(top.abs()).cos().max(0.1);
    let width = 0.5 * view.width as f64 * pixel / widest;
    let mut above = (top > horizon).then(|| Grid::new(horizon, top, width));
    let mut below = (bottom < horizon).then(|| Grid::new(horizon, bottom, width));

    let chosen = samples(WAVELENGTHS, scene.spectrum);
    for (i, sample) in chosen.iter().enumerate() {
        done(i as f64 / chosen.len() as f64);
        let column = match scene.haze {
            None => None,
            Some(haze) => Some(haze.climate.column(haze.humidity, sample.nm, PARTICLES_TOLERANCE)?),
        };
        let ozone = match scene.ozone_du {
            0.0 => None,
            column_du => Some(OzoneLayer::new(column_du, sample.nm)?),
        };
        let sky = Skylight::new(&skylight::Scene {
            profile: scene.profile,
            aerosol: column.as_ref(),
            ozone: ozone.as_ref(),
            wavelength_nm: sample.nm,
            earth_radius_m: scene.earth_radius_m,
            observer_height_m: scene.observer_height_m,
            sun_true_altitude: scene.sun_altitude,
            ground_albedo,
        })?;
        for grid in [&mut above, &mut below].into_iter().flatten() {
            for up in 0..UP {
                for aside in 0..ASIDE {
                    let (altitude, azimuth) = grid.direction(up, aside);
                    let radiance = sky.radiance(Angle::radians(altitude), Angle::radians(azimuth)).total();
                    let sum = &mut grid.light[up * ASIDE + aside];
                    sum.iter_mut().zip(sample.light).for_each(|(sum, light)| *sum += light * radiance);
                }
            }
        }
    }
    done(1.0);

    for (y, row) in rendered.xyz.chunks_exact_mut(view.width).enumerate() {
        let low = top - (y + 1) as f64 * pixel;
        // A row that holds the horizon is the mean of both.
        let sky_share = ((low + pixel - horizon) / pixel).clamp(0.0, 1.0);
        let altitude = low + 0.5 * pixel;
        let parts = [
            (above.as_ref(), sky_share, altitude.max(horizon + 0.5 * sky_share * pixel)),
            (below.as_ref(), 1.0 - sky_share, altitude.min(horizon - 0.5 * (1.0 - sky_share) * pixel)),
        ];
        for (x, value) in row.iter_mut().enumerate() {
            let azimuth = (x as f64 + 0.5 - 0.5 * view.width as f64) * pixel / altitude.cos();
            for (grid, share, altitude) in parts {
                if let Some(grid) = grid.filter(|_| share > 0.0) {
                    let light = grid.at(altitude, azimuth);
                    value.iter_mut().zip(light).for_each(|(value, light)| *value += (share * light) as f32);
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_directions_light_is_that_of_straight_lines_and_the_same_on_both_sides() {
        for edge in [0.02, -0.01] {
            let mut grid = Grid::new(-0.002, edge, 0.01);
            for up in 0..UP {
                for aside in 0..ASIDE {
                    let (altitude, azimuth) = grid.direction(up, aside);
                    assert!((altitude - grid.horizon) * grid.reach > 0.0);
                    grid.light[up * ASIDE + aside] = [1.0 + azimuth, 2.0 + altitude, 3.0];
                }
            }
            for share in [0.0, 0.013, 0.3, 0.77, 1.0] {
                let altitude = grid.horizon + grid.reach * share;
                let light = grid.at(altitude, -0.0071);
                assert!(
                    (light[0] - 1.0071).abs() < 1e-12 && (light[1] - 2.0 - altitude).abs() < 3e-5,
                    "{share}: {light:?}"
                );
                assert_eq!(light, grid.at(altitude, 0.0071));
            }
        }
    }
}
