//! Frames of a nebula a second, and samples of the kernel a second. `cargo bench --bench nebula`
//!
//! To be reached on two cores at 512 x 512, three bands, full scattering, the eye moving, no frame used again: 128^3 with one star under
//! 67 ms, with five under 100 ms, 256^3 with one star under 133 ms. `every pixel` casts a ray for each pixel; `between rays` only
//! where the neighbours do not tell a pixel. Steps are as long as keeps each pixel within a 512th of the brightest, and pixels on average
//! within a 512th of their mean.
//!
//! The kernel: a sample is four loads of 16 bytes, five of weights and some twenty sums and products of eight numbers. With two loads a
//! cycle a core at 3 GHz could do 650 million samples a second; memory gives each cell once a frame (18 MB at 128^3, 142 MB at 256^3).

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use scotopic::physics::dust::camera::{Camera, Lens};
use scotopic::physics::dust::fast::{Flyer, Quality};
use scotopic::physics::dust::multiple::{Settings, gather};
use scotopic::physics::dust::phase::HenyeyGreenstein;
use scotopic::physics::dust::scene::{Dust, RED_GREEN_BLUE, Scene, Star};
use scotopic::physics::dust::volume::Volume;

/// A ball of dust with filaments: it fills a third of the voxels and covers two thirds of the pixels, 1 to 2 optical depths deep.
fn nebula(n: usize) -> Volume {
    let mut density = Vec::with_capacity(n * n * n);
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let p = (DVec3::new(x as f64, y as f64, z as f64) + 0.5) / n as f64 * 2.0 - 1.0;
                let shell = ((0.9 - p.length()) / 0.1).clamp(0.0, 1.0) * ((p.length() - 0.12) / 0.1).clamp(0.0, 1.0);
                let waves = |f: f64| {
                    (f * (p.x + 0.3 * p.y)).sin() * (f * (p.y - 0.4 * p.z)).sin() * (f * (p.z + 0.2 * p.x)).cos()
                };
                let noise = 0.5 + 0.5 * waves(5.0) + 0.3 * waves(11.0) + 0.2 * waves(23.0) + 0.1 * waves(47.0);
                density.push((shell * noise.max(0.0)) as f32);
            }
        }
    }
    Volume::new([n; 3], DVec3::splat(2.0), density).unwrap_or_else(|error| unreachable!("{error}"))
}

fn scene(stars: usize) -> Option<Scene> {
    let places = [[0.05, 0.02, -0.03], [0.5, 0.3, 0.2], [-0.4, 0.5, 0.1], [-0.3, -0.5, -0.4], [0.2, -0.4, 0.6]];
    let dust = Dust {
        extinction: RED_GREEN_BLUE.map(|share| share * 2.0).to_vec(),
        albedo: 0.6,
        phase: HenyeyGreenstein::new(0.6)?,
    };
    let star = |place: &[f64; 3]| Star { position: DVec3::from_array(*place), intensity: vec![0.8, 1.0, 1.3] };
    Scene::new(dust, places.iter().take(stars).map(star).collect()).ok()
}

fn frames(c: &mut Criterion) {
    let mut group = c.benchmark_group("frame of 512 x 512");
    group.sample_size(20);
    for (side, stars) in [(128, 1), (128, 5), (256, 1)] {
        let Some(scene) = scene(stars) else { continue };
        let volume = nebula(side);
        let settings = Settings { flights: 100_000, ..Settings::fitting(&volume) };
        let Ok(mut flyer) = Flyer::new(&volume, &scene, gather(&volume, &scene, &settings).ok()) else { continue };
        for (name, quality) in [("every pixel", Quality::FULL), ("between rays", Quality::FLYING)] {
            let mut turn = 0.0f64;
            let mut last = None;
            let camera = |turn: f64| {
                let eye = DVec3::new(turn.sin(), 0.3, turn.cos()) * 2.4;
                Camera::looking(eye, DVec3::ZERO, DVec3::Y, Lens::Perspective { field: 0.75 })
            };
            let step = camera(turn).and_then(|camera| flyer.longest_step(&camera, &quality, 1.0 / 512.0).ok());
            let quality = Quality { step: step.unwrap_or(quality.step), ..quality };
            group.bench_function(format!("{side}^3, {stars} stars, {name}"), |bench| {
                bench.iter(|| {
                    turn += 0.02;
                    last = camera(turn).and_then(|camera| flyer.frame(&camera, 512, 512, black_box(&quality)).ok());
                });
            });
            if let Some(frame) = last {
                let covered = frame.through.iter().filter(|through| through[1] < 0.98).count();
                let mut middle: Vec<f32> = (224 * 512..288 * 512)
                    .filter(|at| (224..288).contains(&(at % 512)))
                    .filter_map(|at| frame.through.get(at).map(|through| -through[1].ln()))
                    .collect();
                middle.sort_unstable_by(f32::total_cmp);
                let filled = volume.density().iter().filter(|density| **density > 0.0).count();
                println!(
                    "    {} rays, steps of {} voxels, {:.1} million samples; {:.0} % of the pixels covered, {:.0} % of the voxels filled, median depth {:.2}",
                    frame.work.rays,
                    quality.step,
                    frame.work.samples as f64 / 1e6,
                    covered as f64 / 5.12 / 512.0,
                    100.0 * filled as f64 / volume.density().len() as f64,
                    middle.get(middle.len() / 2).copied().unwrap_or(0.0)
                );
            }
        }
    }
    group.finish();
}

/// The same eye again: no shading, so that nearly all of the time is the kernel's.
fn kernel(c: &mut Criterion) {
    let mut group = c.benchmark_group("samples");
    group.sample_size(20);
    for side in [128, 256] {
        let (volume, Some(scene)) = (nebula(side), scene(0)) else { continue };
        let Ok(mut flyer) = Flyer::new(&volume, &scene, None) else { continue };
        let eye = DVec3::new(0.7, 0.3, 0.65) * 2.4;
        let Some(camera) = Camera::looking(eye, DVec3::ZERO, DVec3::Y, Lens::Perspective { field: 0.75 }) else {
            continue;
        };
        let Ok(frame) = flyer.frame(&camera, 512, 512, &Quality::FULL) else { continue };
        group.throughput(Throughput::Elements(frame.work.samples));
        group.bench_function(format!("{side}^3, all cores"), |bench| {
            bench.iter(|| flyer.frame(black_box(&camera), 512, 512, &Quality::FULL).is_ok());
        });
    }
    group.finish();
}

criterion_group!(benches, frames, kernel);
criterion_main!(benches);
