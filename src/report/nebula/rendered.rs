//! The accurate renderer under extreme dust, grains, stars and eyes: against closed forms where there are some, else finite; too large is refused.

use std::f64::consts::PI;

use glam::DVec3;

use super::super::stability::Extreme;
use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::drawing::{Drawing, Light};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::render::{LONGEST_SIDE, MOST_BYTES, View, Wish};
use crate::physics::dust::scene::{Dust, MOST_BANDS, Scene, Star};
use crate::physics::dust::volume::Volume;

/// Where the far star stands above the dust, whose light is an irradiance of 1.
const FAR: f64 = 1e5;

/// What is asked of the pictures.
const TOLERANCE: f64 = 1e-2;

/// Tries something, and says what came of it, or why it did not hold.
type Case = fn() -> Result<String, String>;

/// Tries all.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let cases: [(&'static str, Case); 10] = [
        ("rendered: depth 1e-6 across a voxel and the cloud", thin),
        ("rendered: depth 1e3 across a voxel and the cloud", thick),
        ("rendered: albedo 0 and 1", albedos),
        ("rendered: g 0, 1e-6 and +-0.999999", needles),
        ("rendered: a star in a voxel's centre, on its face, outside", places),
        ("rendered: two stars in one place; one in dense dust ahead", stars),
        ("rendered: the eye on a star, in dense dust, along an axis", eyes),
        ("rendered: one voxel, one pixel; a volume of zeros", smallest),
        ("rendered: voxels that are no cubes", slabs),
        ("rendered: 8192 x 8192 pixels, and 64 bands of them", largest),
    ];
    let extreme = |(name, case): (&'static str, Case)| match case() {
        Ok(what) => Extreme { name, held: true, what },
        Err(what) => Extreme { name, held: false, what },
    };
    cases.into_iter().map(extreme).collect()
}

/// Dust of even density in a box from -1 to 1.
fn even(size: usize) -> Result<Volume, String> {
    Volume::new([size; 3], DVec3::splat(2.0), vec![1.0; size.pow(3)]).map_err(|error| error.to_string())
}

fn scene(extinction: f64, albedo: f64, g: f64, stars: &[(DVec3, f64)]) -> Result<Scene, String> {
    let phase = HenyeyGreenstein::new(g).ok_or("g")?;
    let stars = stars.iter().map(|(position, light)| Star { position: *position, intensity: vec![*light] }).collect();
    Scene::new(Dust { extinction: vec![extinction], albedo, phase }, stars).map_err(|error| error.to_string())
}

/// A star far behind the eye that looks down from above.
const BEHIND: [(DVec3, f64); 1] = [(DVec3::new(0.0, 0.0, FAR), FAR * FAR)];

/// Parallel rays downwards through the middle.
fn above(width: f64, pixels: usize) -> Result<View, String> {
    looking(DVec3::Z * 4.0, DVec3::ZERO, Lens::Orthographic { width }, pixels)
}

fn looking(eye: DVec3, at: DVec3, lens: Lens, pixels: usize) -> Result<View, String> {
    let up = if (at - eye).normalize_or_zero().y.abs() > 0.9 { DVec3::Z } else { DVec3::Y };
    let camera = Camera::looking(eye, at, up, lens).ok_or("no camera")?;
    Ok(View { camera, width: pixels, height: pixels, near: 0.0 })
}

/// The mean radiance and the mean share that comes through, if all numbers are numbers.
fn drawn(volume: &Volume, scene: &Scene, view: &View) -> Result<(f64, f64), String> {
    let wish = Wish { tolerance: TOLERANCE, step: None, everything: false, seed: 1 };
    let rendered = Drawing::new(volume, scene, Light::Single, None).draw(view, &wish, &mut |_| ());
    let mut means = [0.0; 2];
    for (mean, planes) in means.iter_mut().zip([&rendered.radiance, &rendered.through]) {
        for value in planes.iter().flatten() {
            if !(value.is_finite() && *value >= 0.0) {
                return Err(format!("a pixel is {value}"));
            }
            *mean += f64::from(*value);
        }
        *mean /= rendered.believed.len() as f64;
    }
    if !rendered.explained.worst.is_finite() {
        return Err(format!("a believed error of {}", rendered.explained.worst));
    }
    Ok((means[0], means[1]))
}

/// How far a number is from the truth; an error where that is too far.
fn near(what: &str, got: f64, truth: f64) -> Result<f64, String> {
    let off = (got / truth - 1.0).abs();
    if off <= TOLERANCE { Ok(off) } else { Err(format!("{what}: {got:e}, and {truth:e} is right")) }
}

/// Thin dust lit and seen from above: albedo p(180 degrees) depth.
fn thin() -> Result<String, String> {
    let mut worst = 0.0f64;
    for extinction in [5e-7, 2e-6] {
        let (light, _) = drawn(&even(4)?, &scene(extinction, 0.6, 0.0, &BEHIND)?, &above(1.0, 2)?)?;
        worst = worst.max(near("thin dust", light, 0.6 / (4.0 * PI) * 2.0 * extinction)?);
    }
    Ok(format!("within {:.2} % of albedo p depth", 100.0 * worst))
}

/// Dust without end, however it is laid: the integral of k exp(-2 k c) is a half, so that it shines with albedo p / 2.
fn thick() -> Result<String, String> {
    let mut voxel = vec![1e-9; 125];
    voxel[62] = 1.0;
    let alone = Volume::new([5; 3], DVec3::splat(2.0), voxel).map_err(|error| error.to_string())?;
    let mut worst = 0.0f64;
    for (what, volume, extinction) in
        [("cloud", &even(4)?, 500.0), ("voxels", &even(4)?, 2e3), ("one voxel", &alone, 2.5e3)]
    {
        let (light, through) = drawn(volume, &scene(extinction, 0.6, 0.0, &BEHIND)?, &above(0.02, 2)?)?;
        worst = worst.max(near(what, light, 0.6 / (4.0 * PI) / 2.0)?);
        if through > 1e-100 {
            return Err(format!("{what}: {through:e} comes through"));
        }
    }
    Ok(format!("within {:.2} % of albedo p / 2, nothing comes through", 100.0 * worst))
}

fn albedos() -> Result<String, String> {
    let of = |albedo| drawn(&even(4)?, &scene(2.0, albedo, 0.0, &BEHIND)?, &above(1.0, 2)?);
    let ((black, dark), (white, _)) = (of(0.0)?, of(1.0)?);
    near("what comes through", dark, (-4.0f64).exp())?;
    let off = near("white dust", white, (1.0 - (-8.0f64).exp()) / (8.0 * PI))?;
    if black == 0.0 {
        Ok(format!("black gives 0, white within {:.2} %", 100.0 * off))
    } else {
        Err(format!("black dust gives {black}"))
    }
}

fn needles() -> Result<String, String> {
    let of = |g| drawn(&even(4)?, &scene(2.0, 0.6, g, &[(DVec3::new(0.3, 0.2, -0.4), 1.0)])?, &above(2.0, 3)?);
    let off = near("g 1e-6", of(1e-6)?.0, of(0.0)?.0)?;
    let (forwards, backwards) = (of(0.999_999)?.0, of(-0.999_999)?.0);
    Ok(format!("1e-6 within {:.4} % of 0; needles finite, {forwards:.1e} and {backwards:.1e}", 100.0 * off))
}

fn places() -> Result<String, String> {
    let mut worst = 0.0f64;
    for place in [
        DVec3::splat(0.25),
        DVec3::new(0.5, 0.1, 0.2),
        DVec3::ZERO,
        DVec3::new(1.0, 0.2, 0.1),
        DVec3::new(0.0, 3.0, 0.0),
    ] {
        let of = |place| drawn(&even(4)?, &scene(2.0, 0.6, 0.6, &[(place, 1.0)])?, &above(2.0, 3)?);
        worst = worst.max(near("a hair beside", of(place + DVec3::splat(1e-9))?.0, of(place)?.0)?);
    }
    Ok(format!("moved by 1e-9, no picture changes by more than {:.4} %", 100.0 * worst))
}

fn stars() -> Result<String, String> {
    let place = DVec3::new(0.1, 0.2, 0.3);
    let of = |stars: &[(DVec3, f64)]| drawn(&even(4)?, &scene(2.0, 0.6, 0.6, stars)?, &above(2.0, 3)?);
    let off = near("two in one place", of(&[(place, 1.0); 2])?.0, 2.0 * of(&[(place, 1.0)])?.0)?;
    let (buried, _) = drawn(&even(4)?, &scene(1e3, 1.0, 0.6, &[(DVec3::ZERO, 1.0)])?, &above(2.0, 3)?)?;
    if buried > 1e-100 {
        return Err(format!("a star a thousand deep gives {buried:e}"));
    }
    Ok(format!("two are twice one within {:.4} %; a star a thousand deep gives {buried:.0e}", 100.0 * off))
}

fn eyes() -> Result<String, String> {
    let star = DVec3::new(0.25, 0.0, 0.0);
    let wide = Lens::Perspective { field: 1.5 };
    let mut most = 0.0f64;
    for extinction in [2.0, 2e3] {
        for (eye, at) in [
            (star, DVec3::X),
            (DVec3::new(0.3, 0.1, 0.4), star),
            (DVec3::Y * 3.0, DVec3::ZERO),
            (-DVec3::X * 3.0, star),
        ] {
            let scene = scene(extinction, 0.9, 0.6, &[(star, 1.0)])?;
            most = most.max(drawn(&even(4)?, &scene, &looking(eye, at, wide, 2)?)?.0);
        }
    }
    Ok(format!("finite, brightest picture {most:.1e}"))
}

fn smallest() -> Result<String, String> {
    let (light, through) = drawn(&even(1)?, &scene(2.0, 1.0, 0.0, &BEHIND)?, &above(1.0, 1)?)?;
    near("one voxel", light, (1.0 - (-8.0f64).exp()) / (8.0 * PI))?;
    near("through one voxel", through, (-4.0f64).exp())?;
    let zeros = Volume::new([4; 3], DVec3::splat(2.0), vec![0.0; 64]).map_err(|error| error.to_string())?;
    match drawn(&zeros, &scene(2.0, 1.0, 0.0, &BEHIND)?, &above(1.0, 3)?)? {
        (0.0, 1.0) => Ok("as the closed form; without dust exactly 0 and 1".to_owned()),
        other => Err(format!("without dust {other:?}")),
    }
}

fn slabs() -> Result<String, String> {
    let edges = DVec3::new(2.0, 1.0, 0.25);
    let volume = Volume::new([8, 2, 3], edges, vec![1.0; 48]).map_err(|error| error.to_string())?;
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let lit = [(axis * FAR, FAR * FAR)];
        let view = looking(axis * 4.0, DVec3::ZERO, Lens::Orthographic { width: 0.1 }, 2)?;
        let (light, through) = drawn(&volume, &scene(2.0, 0.6, 0.0, &lit)?, &view)?;
        let depth = 2.0 * edges.dot(axis);
        near("what comes through", through, (-depth).exp())?;
        near("light", light, 0.6 / (8.0 * PI) * (1.0 - (-2.0 * depth).exp()))?;
    }
    Ok("along each axis as the closed form".to_owned())
}

fn largest() -> Result<String, String> {
    let view = View { width: LONGEST_SIDE, height: LONGEST_SIDE, ..above(2.0, 1)? };
    let gib = |bands: usize| view.bytes(bands) as f64 / f64::from(1 << 30);
    if view.bytes(3) > MOST_BYTES || view.bytes(MOST_BANDS) <= MOST_BYTES {
        return Err(format!("{:.1} GiB in 3 bands, {:.1} in {MOST_BANDS}", gib(3), gib(MOST_BANDS)));
    }
    Ok(format!("{:.1} GiB in 3 bands; {:.0} GiB in {MOST_BANDS} are refused", gib(3), gib(MOST_BANDS)))
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_extreme_case_of_the_accurate_renderer_holds() {
        for extreme in super::extremes() {
            assert!(extreme.held, "{}: {}", extreme.name, extreme.what);
        }
    }
}
