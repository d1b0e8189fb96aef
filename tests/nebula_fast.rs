//! The renderer to fly with, held to closed forms, to a slow quadrature that shares nothing with it, and to extremes.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::DVec3;
use scotopic::physics::dust::camera::{Camera, Lens, Ray};
use scotopic::physics::dust::fast::{FastError, Flyer, Frame, Quality};
use scotopic::physics::dust::light::column;
use scotopic::physics::dust::model::Scattering;
use scotopic::physics::dust::multiple::{Field, Settings, gather};
use scotopic::physics::dust::phase::HenyeyGreenstein;
use scotopic::physics::dust::scene::{Dust, RED_GREEN_BLUE, Scene, Star};
use scotopic::physics::dust::volume::Volume;

/// A ball of uneven dust in a box from -1 to 1, empty in its corners and about its centre.
fn ball(n: usize) -> Volume {
    let mut density = Vec::new();
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let p = (DVec3::new(x as f64, y as f64, z as f64) + 0.5) / n as f64 * 2.0 - 1.0;
                let shell = ((0.85 - p.length()) / 0.2).clamp(0.0, 1.0) * ((p.length() - 0.2) / 0.2).clamp(0.0, 1.0);
                density.push((shell * (1.0 + 0.6 * (5.0 * p.x + 3.0 * p.y).sin() * (4.0 * p.z).cos())) as f32);
            }
        }
    }
    Volume::new([n; 3], DVec3::splat(2.0), density).unwrap()
}

fn scene(depth: f64, albedo: f64, g: f64, stars: &[DVec3]) -> Scene {
    let dust = Dust {
        extinction: RED_GREEN_BLUE.map(|share| share * depth).to_vec(),
        albedo,
        phase: HenyeyGreenstein::new(g).unwrap(),
    };
    let star = |position: &DVec3| Star { position: *position, intensity: vec![0.7, 1.0, 1.2] };
    Scene::new(dust, stars.iter().map(star).collect()).unwrap()
}

const STAR: DVec3 = DVec3::new(0.05, -0.03, 0.02);

fn window(eye: DVec3) -> Camera {
    Camera::looking(eye, DVec3::ZERO, DVec3::Y, Lens::Perspective { field: 0.8 }).unwrap()
}

fn see(volume: &Volume, scene: &Scene, camera: &Camera, quality: &Quality) -> Frame {
    Flyer::new(volume, scene, None).unwrap().frame(camera, 48, 48, quality).unwrap()
}

fn brightest(frame: &Frame) -> f32 {
    frame.pixels.iter().flatten().fold(0.0, |a, b| a.max(*b))
}

fn worst(a: &Frame, b: &Frame) -> f32 {
    a.pixels.iter().flatten().zip(b.pixels.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The radiance along a ray by 500 equal steps, f64, exact columns.
fn slow(volume: &Volume, scene: &Scene, field: Option<&Field>, ray: &Ray, band: usize) -> f64 {
    let (from, to, steps) = (0.8, 5.2, 500);
    let step = (to - from) / f64::from(steps);
    let (mut depth, mut light) = (0.0, 0.0);
    let k = scene.dust().extinction[band];
    for n in 0..steps {
        let place = ray.origin + ray.direction * (from + (f64::from(n) + 0.5) * step);
        let density = volume.at(place);
        if density == 0.0 {
            continue;
        }
        let mut source = 0.0;
        for star in scene.stars() {
            let way = place - star.position;
            let cosine = -way.normalize().dot(ray.direction);
            source += scene.dust().albedo * star.intensity[band] * scene.dust().phase.per_steradian(cosine)
                / way.length_squared()
                * (-k * column(volume, star.position, place)).exp();
        }
        if let Some(field) = field {
            let mut glow = [0.0; 3];
            field.source(place, -ray.direction, &mut glow);
            source += glow[band];
        }
        light += k * density * step * source * (-depth - 0.5 * k * density * step).exp();
        depth += k * density * step;
    }
    light
}

#[test]
fn even_dust_lets_through_what_its_depth_says_and_a_ray_beside_it_all() {
    let volume = Volume::new([9, 10, 11], DVec3::splat(2.0), vec![1.0; 990]).unwrap();
    let camera = Camera::looking(DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y, Lens::Orthographic { width: 3.0 }).unwrap();
    for depth in [1e-6, 0.3, 2.0, 30.0, 3000.0] {
        let frame = see(&volume, &scene(depth, 0.6, 0.6, &[STAR]), &camera, &Quality { opaque: 0.0, ..Quality::FULL });
        let through = frame.through[24 * 48 + 24];
        for (through, share) in through.iter().zip(RED_GREEN_BLUE) {
            let exact = (-2.0 * depth * share).exp();
            assert!((f64::from(*through) - exact).abs() < 1e-5 * exact.max(0.1), "{depth}: {through} {exact}");
        }
        assert_eq!(frame.through[0], [1.0; 3]);
        assert_eq!(frame.pixels[0], [0.0; 3]);
    }
}

#[test]
fn full_scattering_is_what_a_slow_quadrature_of_the_same_light_gives() {
    let volume = ball(40);
    let scene = scene(4.0, 0.6, 0.6, &[STAR, DVec3::new(0.6, 0.2, -0.3)]);
    let settings = Settings { flights: 20_000, cells: 16, ..Settings::fitting(&volume) };
    let field = gather(&volume, &scene, &settings).unwrap();
    for eye in [DVec3::new(1.0, 0.8, 2.6), DVec3::new(-2.0, 0.1, -1.5)] {
        let camera = window(eye);
        let mut flyer = Flyer::new(&volume, &scene, Some(field.clone())).unwrap();
        let frame = flyer.frame(&camera, 48, 48, &Quality { step: 0.5, ..Quality::FULL }).unwrap();
        let (mut error, mut light) = (0.0, 0.0);
        // Every 29th pixel; those within three pixels of a star are the mean of a peak, which one ray is not.
        for n in (0..48 * 48).step_by(29) {
            let (x, y) = (n % 48, n / 48);
            let ray = camera.ray(x as f64 + 0.5, y as f64 + 0.5, 48, 48).unwrap();
            let near = |star: &Star| {
                let to = star.position - ray.origin;
                (to - ray.direction * to.dot(ray.direction)).length() < 3.0 * to.length() * 0.8 / 48.0
            };
            if scene.stars().iter().any(near) {
                continue;
            }
            for band in [0, 2] {
                let exact = slow(&volume, &scene, Some(&field), &ray, band);
                error += (f64::from(frame.pixels[n][band]) - exact).abs();
                light += exact;
            }
        }
        assert!(light > 0.5 && error < 0.02 * light, "{error} of {light}");
    }
}

#[test]
fn light_close_to_a_star_is_neither_lost_nor_counted_twice() {
    // Even dust, isotropic: along a ray past the star L = albedo k I / (4 pi b) x angle, nearly, where it is thin.
    let volume = Volume::new([32; 3], DVec3::splat(2.0), vec![1.0; 32 * 32 * 32]).unwrap();
    let star = DVec3::new(0.01, 0.02, 0.0);
    let scene = scene(1e-3, 1.0, 0.0, &[star]);
    let camera = Camera::looking(DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y, Lens::Orthographic { width: 2.0 }).unwrap();
    let frame = Flyer::new(&volume, &scene, None).unwrap().frame(&camera, 128, 128, &Quality::FULL).unwrap();
    for (x, y) in [(66, 64), (70, 60), (64, 75), (40, 90), (10, 5)] {
        let ray = camera.ray(x as f64 + 0.5, y as f64 + 0.5, 128, 128).unwrap();
        let b = (star - ray.origin).truncate().length();
        let exact = 1e-3 / (4.0 * std::f64::consts::PI * b) * 2.0 * (1.0 / b).atan();
        let there = f64::from(frame.pixels[y * 128 + x][1]);
        assert!((there / exact - 1.0).abs() < 0.02, "{x} {y}: {there} {exact}");
    }
}

#[test]
fn what_is_left_out_does_not_show() {
    let volume = ball(32);
    for depth in [0.1, 5.0, 200.0] {
        let scene = scene(depth, 0.6, 0.6, &[STAR]);
        let camera = window(DVec3::new(1.0, 0.8, 2.6));
        let some = see(&volume, &scene, &camera, &Quality::FULL);
        let all = see(&volume, &scene, &camera, &Quality { step: Quality::FULL.step, ..Quality::EVERYTHING });
        let off = worst(&some, &all);
        assert!(off <= brightest(&all) / 512.0, "{depth}: {off} of {}", brightest(&all));
        assert!(off <= some.left_out + 1e-5 * brightest(&all), "{depth}: {off}, and {} was told", some.left_out);
        assert!(some.work.samples <= all.work.samples && (depth < 100.0 || some.work.ended > 0));
    }
}

#[test]
fn pixels_between_rays_are_what_rays_of_their_own_would_see() {
    let volume = ball(32);
    let scene = scene(4.0, 0.6, 0.6, &[STAR]);
    let camera = window(DVec3::new(1.0, 0.8, 2.6));
    let mut flyer = Flyer::new(&volume, &scene, None).unwrap();
    let full = flyer.frame(&camera, 129, 127, &Quality::FULL).unwrap();
    let between = flyer.frame(&camera, 129, 127, &Quality::FLYING).unwrap();
    assert!(worst(&full, &between) < brightest(&full) / 256.0, "{} of {}", worst(&full, &between), brightest(&full));
    assert!(between.work.rays * 3 < full.work.rays * 2, "{} of {}", between.work.rays, full.work.rays);
}

#[test]
fn steps_are_as_long_as_a_tolerance_allows() {
    let (volume, camera) = (ball(48), window(DVec3::new(0.4, 0.2, 0.9)));
    let mut before = 0.0;
    for tolerance in [1e-4, 1.0 / 512.0, 0.1] {
        let mut flyer = Flyer::new(&volume, &scene(2.0, 0.6, 0.6, &[STAR]), None).unwrap();
        let step = flyer.longest_step(&camera, &Quality::FULL, tolerance).unwrap();
        let mut seen = |step| flyer.frame(&camera, 160, 160, &Quality { step, ..Quality::FULL }).unwrap();
        let (fine, there) = (seen(0.5), seen(step));
        // 64 x 64 pixels were looked at, these are others: the worst was not seen.
        let allowed = if step > 0.5 { tolerance * brightest(&fine) } else { 0.0 };
        assert!(worst(&fine, &there) <= allowed, "{tolerance}: {step}, {}", worst(&fine, &there));
        assert!(step >= before, "{tolerance}: {step} {before}");
        before = step;
    }
    assert_eq!(before, 3.0);
}

#[test]
fn long_steps_miss_nothing_of_the_light_close_to_a_star() {
    // Even dust: what is steep is the light alone. Steps of three voxels there would be off by a 200th of the brightest pixel.
    let volume = Volume::new([48; 3], DVec3::splat(2.0), vec![1.0; 48 * 48 * 48]).unwrap();
    let mut flyer = Flyer::new(&volume, &scene(1.0, 0.6, 0.6, &[STAR, DVec3::new(0.5, 0.3, 0.2)]), None).unwrap();
    let camera = window(DVec3::new(1.0, 0.8, 2.6));
    let mut seen = |step| flyer.frame(&camera, 96, 96, &Quality { step, ..Quality::FULL }).unwrap();
    let (fine, long) = (seen(0.25), seen(3.0));
    assert!(worst(&fine, &long) < brightest(&fine) / 512.0, "{} of {}", worst(&fine, &long), brightest(&fine));
}

#[test]
fn two_stars_add_up_and_turning_scene_and_eye_together_changes_nothing() {
    let volume = ball(24);
    let camera = window(DVec3::new(1.0, 0.8, 2.6));
    let other = DVec3::new(0.5, 0.4, -0.2);
    let see_with = |stars: &[DVec3]| see(&volume, &scene(3.0, 0.6, 0.6, stars), &camera, &Quality::FULL);
    let (first, second, both) = (see_with(&[STAR]), see_with(&[other]), see_with(&[STAR, other]));
    for ((a, b), c) in first.pixels.iter().zip(&second.pixels).zip(&both.pixels) {
        assert!((a[1] + b[1] - c[1]).abs() <= 1e-4 * brightest(&both));
    }
    // A quarter turn about z: (x, y, z) to (-y, x, z).
    let turn = |p: DVec3| DVec3::new(-p.y, p.x, p.z);
    let mut density = vec![0.0; 24 * 24 * 24];
    for (at, value) in volume.density().iter().enumerate() {
        let (x, y, z) = (at % 24, at / 24 % 24, at / 576);
        density[(z * 24 + x) * 24 + 23 - y] = *value;
    }
    let turned = Volume::new([24; 3], DVec3::splat(2.0), density).unwrap();
    let eye =
        Camera::looking(turn(DVec3::new(1.0, 0.8, 2.6)), DVec3::ZERO, turn(DVec3::Y), Lens::Perspective { field: 0.8 });
    let there = see(&turned, &scene(3.0, 0.6, 0.6, &[turn(STAR)]), &eye.unwrap(), &Quality::FULL);
    assert!(worst(&first, &there) < 2e-4 * brightest(&first), "{}", worst(&first, &there));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let volume = ball(24);
    let scene = scene(3.0, 0.6, 0.6, &[STAR]);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| see(&volume, &scene, &window(DVec3::new(1.0, 0.8, 2.6)), &Quality::FLYING))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn extremes_give_finite_light_or_a_sentence() {
    let bright = |frame: &Frame| {
        let wrong = frame.pixels.iter().chain(&frame.through).flatten().find(|v| !(v.is_finite() && **v >= 0.0));
        assert_eq!(wrong, None);
        brightest(frame)
    };
    let far = window(DVec3::new(0.0, 0.0, 3.0));
    let nothing = Volume::new([4; 3], DVec3::splat(2.0), vec![0.0; 64]).unwrap();
    assert_eq!(bright(&see(&nothing, &scene(1.0, 0.6, 0.6, &[STAR]), &far, &Quality::FULL)), 0.0);
    let one = Volume::new([1; 3], DVec3::new(1.0, 2.0, 3.0), vec![2.0]).unwrap();
    let dome = |eye, at| Camera::looking(eye, at, DVec3::Y, Lens::Domemaster { field: std::f64::consts::TAU }).unwrap();
    for g in [0.0, 1e-6, 0.999_999, -0.999_999] {
        for depth in [1e-6, 1.0, 1e3] {
            for albedo in [0.0, 1.0] {
                let scene = scene(depth, albedo, g, &[STAR, STAR, DVec3::new(0.0, 0.0, 9.0)]);
                for camera in [far, dome(STAR, DVec3::X), dome(DVec3::new(0.3, 0.1, 0.0), DVec3::ZERO)] {
                    let light = bright(&see(&one, &scene, &camera, &Quality::FULL));
                    assert_eq!(light > 0.0, albedo > 0.0, "g {g}, depth {depth}, albedo {albedo}");
                }
            }
        }
    }
    let mut flyer = Flyer::new(&one, &scene(1.0, 0.6, 0.6, &[]), None).unwrap();
    assert_eq!(bright(&flyer.frame(&far, 1, 1, &Quality::FULL).unwrap()), 0.0);
    assert_eq!(flyer.frame(&far, 0, 5, &Quality::FULL).unwrap_err(), FastError::Size(0, 5));
    let wrong = Quality { step: f64::NAN, ..Quality::FULL };
    assert!(matches!(flyer.frame(&far, 5, 5, &wrong), Err(FastError::Step(_))));
}

#[test]
fn changing_the_dust_in_flight_is_making_the_flight_anew() {
    let volume = ball(24);
    let camera = window(DVec3::new(1.0, 0.8, 2.6));
    let mut flyer = Flyer::new(&volume, &scene(1.0, 0.9, 0.0, &[STAR]), None).unwrap();
    let before = flyer.frame(&camera, 48, 48, &Quality::FULL).unwrap();
    for stars in [STAR, DVec3::new(0.4, 0.1, 0.2)] {
        let new = scene(5.0, 0.5, 0.6, &[stars]);
        flyer.change(&volume, &new).unwrap();
        let changed = flyer.frame(&camera, 48, 48, &Quality::FULL).unwrap();
        assert!(worst(&changed, &before) > 0.0);
        assert!(worst(&changed, &see(&volume, &new, &camera, &Quality::FULL)) < 1e-6 * brightest(&changed));
    }
}
