//! The renderer to fly with among the others: the same clouds, its own settings, and what it believes of itself.

use std::time::Duration;

use glam::DVec3;

use super::super::stability::Extreme;
use super::Picture;
use super::known::{Known, SIDE, StudyError, refused, view};
use crate::physics::dust::camera::{Camera, Lens};
use crate::physics::dust::fast::{Flyer, Frame, Quality};
use crate::physics::dust::multiple::{Settings, gather};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::scene::{Dust, Scene, Star};
use crate::physics::dust::volume::Volume;

/// Rays across a pixel of the reference, which is an average.
const RAYS: usize = 4;

/// Pixels in which a frame looks for its error.
const PROBES: usize = 200;

/// Frames of one cloud: a ray for each pixel in shorter and shorter steps, then the qualities for moving.
///
/// # Errors
/// Never.
pub fn pictures(cloud: &Known, clock: &dyn Fn() -> Duration) -> Result<Vec<Picture>, StudyError> {
    let begin = clock();
    let field = gather(&cloud.volume, &cloud.scene, &Settings::fitting(&cloud.volume)).map_err(refused)?;
    let mut flyer = Flyer::new(&cloud.volume, &cloud.scene, Some(field)).map_err(refused)?;
    let ready_s = (clock() - begin).as_secs_f64();
    let steps = [2.0, 1.0, 0.5].map(|step| (format!("{step} voxels"), Quality { step, ..Quality::FULL }));
    let others = [("between rays", Quality::FLYING), ("moving", Quality::MOVING), ("draft", Quality::DRAFT)];
    let camera = view(SIDE)?.camera;
    let mut all = Vec::new();
    for (setting, quality) in steps.into_iter().chain(others.map(|(name, quality)| (name.to_owned(), quality))) {
        // The eye has moved: its light on each voxel is part of the frame's time.
        let aside =
            Camera::looking(DVec3::new(0.5, 0.0, 4.0), DVec3::ZERO, DVec3::Y, Lens::Orthographic { width: 2.0 });
        flyer.frame(&aside.ok_or(StudyError::Damaged("camera"))?, 8, 8, &quality).map_err(refused)?;
        let begin = clock();
        let frame = flyer.frame(&camera, RAYS * SIDE, RAYS * SIDE, &quality).map_err(refused)?;
        let picture_s = (clock() - begin).as_secs_f64();
        let probed = flyer.frame(&camera, RAYS * SIDE, RAYS * SIDE, &Quality { probes: PROBES, ..quality });
        let believed = probed.map_err(refused)?.believed.map_or(f64::NAN, |believed| f64::from(believed.mean));
        let compared = cloud.compare(&averaged(&frame));
        all.push(Picture { cloud: cloud.name, method: "flying", setting, ready_s, picture_s, compared, believed });
    }
    Ok(all)
}

/// The reference's pixels, each the mean of its rays, in the first band.
fn averaged(frame: &Frame) -> Vec<f32> {
    let pixel = |at: usize| {
        let (x, y) = (at % SIDE * RAYS, at / SIDE * RAYS);
        let rays = (0..RAYS * RAYS).map(|n| (y + n / RAYS) * frame.width + x + n % RAYS);
        rays.filter_map(|at| frame.pixels.get(at)).map(|pixel| pixel[0]).sum::<f32>() / (RAYS * RAYS) as f32
    };
    (0..SIDE * SIDE).map(pixel).collect()
}

/// Flights through dust, grains and eyes as no night has them.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let tried = |name: &'static str, flights: Vec<(Option<Dust>, DVec3, usize)>| {
        let result =
            flights.into_iter().map(|(dust, eye, size)| brightest(dust, eye, size)).collect::<Result<Vec<_>, _>>();
        Extreme {
            name,
            held: result.is_ok(),
            what: match result {
                Ok(all) => format!("finite, brightest pixel {:.3e}", all.into_iter().fold(0.0, f32::max)),
                Err(what) => what,
            },
        }
    };
    let dust = |depth: f64, albedo: f64, g: f64| {
        let phase = HenyeyGreenstein::new(g)?;
        Some(Dust { extinction: vec![depth, 0.7 * depth, 1.3 * depth], albedo, phase })
    };
    let (far, star, inside) = (DVec3::new(0.0, 0.3, 4.0), DVec3::splat(0.3), DVec3::new(0.1, 0.2, -0.3));
    vec![
        tried(
            "flying: depth 1e-6 and 1e3 across a voxel",
            [1e-6, 1e3].map(|k| (dust(4.0 * k, 0.6, 0.6), far, 8)).into(),
        ),
        tried(
            "flying: g 0, 1e-6 and +-0.999999",
            [0.0, 1e-6, 0.999_999, -0.999_999].map(|g| (dust(2.0, 1.0, g), far, 8)).into(),
        ),
        tried(
            "flying: the eye on the star, and in dense dust",
            vec![(dust(2.0, 0.6, 0.6), star, 8), (dust(500.0, 0.6, 0.6), inside, 8)],
        ),
        tried("flying: one voxel", vec![(dust(2.0, 0.6, 0.6), far, 1), (dust(2.0, 0.6, 0.6), DVec3::ZERO, 1)]),
    ]
}

/// The brightest pixel of three small frames.
fn brightest(dust: Option<Dust>, eye: DVec3, size: usize) -> Result<f32, String> {
    let volume = Volume::new([size; 3], DVec3::splat(2.0), vec![1.0; size.pow(3)]).map_err(|e| e.to_string())?;
    let star = Star { position: DVec3::splat(0.3), intensity: vec![1.0; 3] };
    let scene = Scene::new(dust.ok_or("no such grains")?, vec![star]).map_err(|e| e.to_string())?;
    let mut flyer = Flyer::new(&volume, &scene, None).map_err(|e| e.to_string())?;
    let mut most = 0.0f32;
    for lens in [
        Lens::Perspective { field: 1.0 },
        Lens::Orthographic { width: 2.0 },
        Lens::Domemaster { field: std::f64::consts::PI },
    ] {
        let camera = Camera::looking(eye, DVec3::new(-0.2, 0.1, 0.0), DVec3::Y, lens).ok_or("no camera")?;
        let frame = flyer.frame(&camera, 33, 31, &Quality::FLYING).map_err(|e| e.to_string())?;
        if let Some(wrong) = frame.pixels.iter().flatten().find(|light| !light.is_finite() || **light < 0.0) {
            return Err(format!("a pixel of {wrong}"));
        }
        most = frame.pixels.iter().flatten().fold(most, |a, b| a.max(*b));
    }
    if most > 0.0 { Ok(most) } else { Err("nothing seen".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extreme_flight_holds() {
        for extreme in extremes() {
            assert!(extreme.held, "{}: {}", extreme.name, extreme.what);
        }
    }

    #[test]
    fn frames_are_within_the_bounds_of_the_slow_pictures_and_believe_it() {
        let clouds = super::super::known::all().unwrap();
        for cloud in &clouds {
            let all = pictures(cloud, &|| Duration::ZERO).unwrap();
            let full = all.iter().find(|picture| picture.setting == "1 voxels").unwrap();
            let compared = full.compared;
            assert!(compared.over == 0 && compared.total.abs() < 0.02, "{}: {compared:?}", cloud.name);
            assert!(full.believed < 0.02, "{}: {}", cloud.name, full.believed);
        }
    }
}
