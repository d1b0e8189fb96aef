//! Gas that glows: a volume of light in the same box as the dust, for nebulae that shine by themselves too (thesis, section 5.7).

use glam::DVec3;
use rayon::prelude::*;

use super::generate::{MOST_CLUMPS, RecipeError, rise};
use super::{Volume, VolumeError};

/// Gas that lies as the dust does, ionised in a ball around each star. Lengths are in halves of the box's longest edge, as in
/// [`Recipe`](super::generate::Recipe).
///
/// ```text
/// glow(p) = density(p)^2 * inside(d)          d: distance from the nearest star; inside falls from 1 to 0 over the rim before the radius
/// ```
///
/// Lines of recombination glow with the densities of ions and electrons, each as the gas where it is ionised, and end where the star's
/// light does that can ionise: Stromgren (1939), ApJ 89, 526; Osterbrock and Ferland (2006), chapters 2 and 4.
#[derive(Debug, Clone, PartialEq)]
pub struct Gas {
    /// Places of the stars.
    pub stars: Vec<DVec3>,
    /// How far their light reaches.
    pub radius: f64,
    /// Thickness of the rim in which the glow ends.
    pub rim: f64,
}

impl Gas {
    /// The glow of the gas in a cloud of dust. In parallel, the same for any number of threads.
    ///
    /// # Errors
    /// Numbers that make no glow, or one beyond what f32 holds, by index.
    pub fn around(&self, dust: &Volume) -> Result<Volume, RecipeError> {
        let number = |what, value: f64, good: bool, wanted| {
            if good { Ok(()) } else { Err(RecipeError::Number { what, value, wanted }) }
        };
        let Gas { stars, radius, rim } = self;
        number(
            "the radius of the glow",
            *radius,
            *radius > 0.0 && *radius <= 8.0,
            "give more than 0 and at most 8 half edges",
        )?;
        number("the glow's rim", *rim, (0.0..=*radius).contains(rim), "give 0 to the glow's radius")?;
        number("the number of stars", stars.len() as f64, stars.len() <= MOST_CLUMPS, "give 0 to 1000")?;
        let [width, height, _] = dust.size();
        let scale = 2.0 / dust.edges().max_element();
        let mut light = vec![0.0f32; dust.density().len()];
        let planes = light.par_chunks_mut(width * height).zip(dust.density().par_chunks(width * height));
        planes.enumerate().for_each(|(z, (light, dust_here))| {
            for (index, (light, density)) in light.iter_mut().zip(dust_here).enumerate().filter(|(_, (_, d))| **d > 0.0)
            {
                let place = dust.centre(index % width, index / width, z) * scale;
                let nearest = stars.iter().map(|star| star.distance(place)).fold(f64::INFINITY, f64::min);
                let inside = 1.0 - rise(radius - rim, *radius, nearest);
                // Written only where there is something, so that empty pages stay free.
                if inside > 0.0 {
                    *light = (f64::from(*density).powi(2) * inside) as f32;
                }
            }
        });
        Volume::new(dust.size(), dust.edges(), light).map_err(|error: VolumeError| error.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gas_glows_with_the_square_of_its_density_and_ends_where_the_stars_light_does() {
        let density = (0..16).map(|i| if i == 3 { 0.0 } else { 0.5 + i as f32 }).collect();
        let dust = Volume::new([16, 1, 1], DVec3::new(4.0, 0.25, 0.25), density).unwrap();
        let glow = Gas { stars: vec![DVec3::new(-0.5, 0.0, 0.0)], radius: 0.25, rim: 0.125 }.around(&dust).unwrap();
        assert_eq!((glow.size(), glow.edges()), (dust.size(), dust.edges()));
        for (i, (glow, dust)) in glow.density().iter().zip(dust.density()).enumerate() {
            // Centres are 1/16 of a half edge from the star and every 1/8 on: the rim is half way at 3/16.
            let away = (i as f64 - 3.5).abs() / 8.0;
            let inside = if away < 0.1 {
                1.0
            } else if away < 0.2 {
                0.5
            } else {
                0.0
            };
            assert!((f64::from(*glow) - inside * f64::from(*dust).powi(2)).abs() < 1e-6, "{i}: {glow}");
        }
    }

    #[test]
    fn what_cannot_glow_is_refused_and_without_stars_nothing_does() {
        let dust = Volume::new([2; 3], DVec3::splat(2.0), vec![1e30; 8]).unwrap();
        let gas = Gas { stars: vec![DVec3::ZERO], radius: 1.0, rim: 0.1 };
        let refused = |gas: &Gas| gas.around(&dust).unwrap_err().to_string();
        assert!(refused(&gas).contains("x 0, y 0, z 0"), "{}", refused(&gas));
        assert!(refused(&Gas { radius: -1.0, ..gas.clone() }).contains("-1"));
        assert!(refused(&Gas { rim: f64::NAN, ..gas.clone() }).contains("NaN"));
        assert!(Gas { stars: Vec::new(), ..gas }.around(&dust).unwrap().density().iter().all(|light| *light == 0.0));
    }
}
