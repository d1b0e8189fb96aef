//! Light scattered more than once under extreme dust, grains and stars: finite and bounded, or told.

use glam::DVec3;

use super::super::stability::Extreme;
use crate::physics::dust::model::Scattering;
use crate::physics::dust::multiple::{Settings, gather};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::scene::{Dust, Scene, Star};
use crate::physics::dust::volume::Volume;

/// Tries all.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let cases: [(&'static str, Result<String, String>); 5] = [
        ("scattered again: g 0, 1e-6 and +-0.999999", needles()),
        ("scattered again: depth 1e-6 to 1e3, albedo 0 and 1", depths()),
        ("scattered again: albedo 1 at depth 1e3", without_end()),
        ("scattered again: a star in, on, beside and far off a voxel", places()),
        ("scattered again: one voxel, and no dust", smallest()),
    ];
    let extreme = |(name, result): (&'static str, Result<String, String>)| Extreme {
        name,
        held: result.is_ok(),
        what: result.unwrap_or_else(|what| what),
    };
    cases.into_iter().map(extreme).collect()
}

/// The brightest source in some directions, and the share of light that was cut.
fn brightest(size: usize, density: f32, dust: Dust, position: DVec3) -> Result<(f64, f64), String> {
    let volume = Volume::new([size; 3], DVec3::splat(2.0), vec![density; size.pow(3)]).map_err(|e| e.to_string())?;
    let bands = dust.extinction.len();
    let scene = Scene::new(dust, vec![Star { position, intensity: vec![1.0; bands] }]).map_err(|e| e.to_string())?;
    let settings = Settings { cells: 8, flights: 20_000, longest_walk: 1000, ..Settings::fitting(&volume) };
    let field = gather(&volume, &scene, &settings).map_err(|e| e.to_string())?;
    let (mut most, mut out) = (0.0_f64, vec![0.0; bands]);
    for point in [DVec3::splat(0.1), DVec3::new(0.7, -0.5, 0.2), position] {
        for towards in [DVec3::X, -DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
            field.source(point, towards, &mut out);
            if let Some(wrong) = out.iter().find(|source| !source.is_finite() || **source < 0.0) {
                return Err(format!("a source of {wrong}"));
            }
            most = out.iter().copied().fold(most, f64::max);
        }
    }
    let told = field.told();
    if told.flights > 40_000 || !(0.0..=1.0 + 1e-9).contains(&told.cut) {
        return Err(format!("{} flights, {} cut", told.flights, told.cut));
    }
    Ok((most, told.cut))
}

fn dust(extinction: Vec<f64>, albedo: f64, g: f64) -> Result<Dust, String> {
    let phase = HenyeyGreenstein::new(g).ok_or("g")?;
    Ok(Dust { extinction, albedo, phase })
}

fn needles() -> Result<String, String> {
    let mut most = 0.0_f64;
    for g in [0.0, 1e-6, 0.999_999, -0.999_999] {
        most = most.max(brightest(8, 1.0, dust(vec![3.0], 0.6, g)?, DVec3::splat(0.3))?.0);
    }
    Ok(format!("finite, brightest source {most:.2}"))
}

fn depths() -> Result<String, String> {
    let mut most = 0.0_f64;
    for albedo in [0.0, 1.0] {
        // All in one scene: bands as far apart as can be.
        let (bright, _) = brightest(8, 1.0, dust(vec![5e-7, 0.5, 500.0], albedo, 0.6)?, DVec3::splat(0.3))?;
        if albedo == 0.0 && bright != 0.0 {
            return Err(format!("black dust scatters {bright}"));
        }
        most = most.max(bright);
    }
    Ok(format!("finite, brightest source {most:.2}; black dust none"))
}

fn without_end() -> Result<String, String> {
    let (most, cut) = brightest(8, 1.0, dust(vec![500.0], 1.0, 0.0)?, DVec3::splat(0.3))?;
    if cut < 0.1 {
        return Err(format!("only {cut:.3} of the light cut after 1000 scatterings"));
    }
    Ok(format!(
        "cut after 1000 scatterings with {:.0} % of the light on its way, told; brightest source {most:.2}",
        100.0 * cut
    ))
}

fn places() -> Result<String, String> {
    let mut most = 0.0_f64;
    for position in [DVec3::splat(0.125), DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1.5, 0.0), DVec3::new(1e9, 0.0, 1.0)] {
        most = most.max(brightest(8, 1.0, dust(vec![2.0], 0.6, 0.6)?, position)?.0);
    }
    Ok(format!("finite, brightest source {most:.2}"))
}

fn smallest() -> Result<String, String> {
    let (one, _) = brightest(1, 1.0, dust(vec![2.0], 0.6, 0.6)?, DVec3::ZERO)?;
    let (none, _) = brightest(4, 0.0, dust(vec![2.0], 0.6, 0.6)?, DVec3::ZERO)?;
    if none == 0.0 && one > 0.0 {
        Ok(format!("brightest source {one:.2}; without dust 0"))
    } else {
        Err(format!("{one}, {none}"))
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_extreme_case_of_light_scattered_again_holds() {
        for extreme in super::extremes() {
            assert!(extreme.held, "{}: {}", extreme.name, extreme.what);
        }
    }
}
