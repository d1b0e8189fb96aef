//! The same sky by chance: photons are followed backwards from the eye, and at each scattering look at the Sun. Nothing is
//! shared with the deterministic method but the shells, the phase functions and the direct beam.

use std::f64::consts::PI;

use glam::DVec3;

use super::shells::{Exit, Shells, Walk};
use super::sunlight::{Sunlight, lifted};
use super::{Radiance, Scene, SkyError, direction, phase};
use crate::numerics::streams::Stream;
use crate::units::Angle;

/// Photons lighter than this live on only by chance.
const LIGHT: f64 = 0.05;

/// A radiance and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub radiance: Radiance,
    /// Standard error of the total.
    pub standard_error: f64,
}

/// The sky of a scene, to be asked by chance.
#[derive(Debug)]
pub struct MonteCarlo {
    shells: Shells,
    sunlight: Sunlight,
    sun: DVec3,
    eye: DVec3,
    albedo: f64,
}

impl MonteCarlo {
    /// Gets ready for a scene.
    ///
    /// # Errors
    /// The scene is none that can be computed.
    pub fn new(scene: &Scene) -> Result<MonteCarlo, SkyError> {
        scene.checked()?;
        let shells = Shells::fine(scene)?;
        let zenith = PI / 2.0 - scene.sun_true_altitude.to_radians();
        let sunlight = Sunlight::new(&shells, zenith);
        Ok(MonteCarlo { shells, sunlight, sun: scene.sun(), eye: scene.eye(), albedo: scene.ground_albedo })
    }

    /// The radiance in a direction (apparent altitude; azimuth from the Sun's), from so many photons of a seed.
    #[must_use]
    pub fn radiance(&self, altitude: Angle, azimuth: Angle, photons: usize, seed: u64) -> Estimate {
        let mut stream = Stream::seeded(seed);
        let (mut sum, mut squares) = (Radiance::default(), 0.0);
        for _ in 0..photons {
            let one = self.photon(direction(altitude, azimuth), &mut stream);
            sum.single += one.single;
            sum.multiple += one.multiple;
            squares += one.total() * one.total();
        }
        let count = photons.max(1) as f64;
        let radiance = Radiance { single: sum.single / count, multiple: sum.multiple / count };
        let variance = (squares / count - radiance.total().powi(2)).max(0.0);
        Estimate { radiance, standard_error: (variance / count).sqrt() }
    }

    /// One photon's tale.
    fn photon(&self, view: DVec3, stream: &mut Stream) -> Radiance {
        let mut light = Radiance::default();
        let mut walk = Walk::new(&self.shells, self.eye, view);
        let mut weight = 1.0;
        for event in 0..1000 {
            // The first flight always ends in a scattering: what would pass through is taken off the weight.
            let depth = if event == 0 {
                let (whole, ground) = self.depth(walk);
                if ground && stream.uniform() < (-whole).exp() {
                    whole * (1.0 + 1e-9)
                } else if ground {
                    -(1.0 - stream.uniform() * -(-whole).exp_m1()).ln()
                } else {
                    weight *= -(-whole).exp_m1();
                    -(1.0 - stream.uniform() * -(-whole).exp_m1()).ln()
                }
            } else {
                -(1.0 - stream.uniform()).ln()
            };
            match self.fly(&mut walk, depth) {
                Exit::Top => return light,
                Exit::Ground => {
                    if self.albedo == 0.0 {
                        return light;
                    }
                    weight *= self.albedo;
                    let up = walk.position.normalize();
                    let zenith = up.dot(self.sun).clamp(-1.0, 1.0).acos();
                    let beam = self.sunlight.at(0.0, zenith);
                    light.multiple += weight * beam.irradiance * (zenith - beam.bending).cos().max(0.0) / PI;
                    let sine = stream.uniform().sqrt();
                    let next = phase::turned(up, (1.0 - sine * sine).sqrt(), 2.0 * PI * stream.uniform());
                    walk = Walk::new(&self.shells, walk.position, next);
                }
                Exit::Shell => {
                    let shell = *self.shells.shell(walk.shell);
                    let scattering = shell.rayleigh_per_m + shell.haze_per_m;
                    weight *= scattering / shell.extinction();
                    let molecules = shell.rayleigh_per_m / scattering;
                    let up = walk.position.normalize();
                    let zenith = up.dot(self.sun).clamp(-1.0, 1.0).acos();
                    let beam = self.sunlight.at(self.shells.height_m(walk.position), zenith);
                    if beam.irradiance > 0.0 {
                        let cos = walk.direction.dot(lifted(self.sun, up, beam.bending));
                        let spread = molecules * phase::rayleigh(cos)
                            + (1.0 - molecules) * phase::henyey_greenstein(cos, shell.asymmetry);
                        let sent = weight * beam.irradiance * spread;
                        *(if event == 0 { &mut light.single } else { &mut light.multiple }) += sent;
                    }
                    let cos = if stream.chance(molecules) {
                        phase::draw_rayleigh(stream.uniform())
                    } else {
                        phase::draw_henyey_greenstein(stream.uniform(), shell.asymmetry)
                    };
                    walk.direction = phase::turned(walk.direction, cos, 2.0 * PI * stream.uniform());
                }
            }
            if weight < LIGHT {
                if stream.chance(0.5) {
                    return light;
                }
                weight *= 2.0;
            }
        }
        light
    }

    /// Flies through an optical depth; `Shell` means that it ends inside the air.
    fn fly(&self, walk: &mut Walk, mut depth: f64) -> Exit {
        loop {
            let extinction = self.shells.shell(walk.shell).extinction();
            let (length, inwards) = walk.reach(&self.shells);
            if extinction * length >= depth {
                walk.go(depth / extinction);
                return Exit::Shell;
            }
            depth -= extinction * length;
            walk.go(length);
            match walk.cross(&self.shells, inwards) {
                Exit::Shell => {}
                end => return end,
            }
        }
    }

    /// The optical depth of the whole way, and whether it ends on the ground.
    fn depth(&self, mut walk: Walk) -> (f64, bool) {
        let mut depth = 0.0;
        loop {
            let extinction = self.shells.shell(walk.shell).extinction();
            let (length, exit) = walk.step(&self.shells);
            depth += extinction * length;
            match exit {
                Exit::Shell if depth < 600.0 => {}
                Exit::Shell => return (depth, true),
                end => return (depth, end == Exit::Ground),
            }
        }
    }
}
