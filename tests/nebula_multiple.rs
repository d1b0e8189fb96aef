//! Light scattered more than once against the numbers of others: slabs by adding and doubling, clouds by Mitsuba.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::TAU;

use glam::DVec3;
use scotopic::numerics::streams::Stream;
use scotopic::physics::dust::model::{Scattering, Together};
use scotopic::physics::dust::multiple::{Field, MultipleError, Settings, gather, gather_by_order, gather_slab};
use scotopic::physics::dust::phase::HenyeyGreenstein;
use scotopic::physics::dust::render::{Subject, Wish, render};
use scotopic::physics::dust::scene::{Dust, Scene, Star};
use scotopic::physics::dust::single::Single;
use scotopic::physics::dust::volume::Volume;
use scotopic::report::nebula::known;

fn dust(extinction: Vec<f64>, albedo: f64, g: f64) -> Dust {
    Dust { extinction, albedo, phase: HenyeyGreenstein::new(g).unwrap() }
}

fn even(size: usize, edge: f64) -> Volume {
    Volume::new([size; 3], DVec3::splat(edge), vec![1.0; size * size * size]).unwrap()
}

/// Uneven dust, the same in every run.
fn clumps(size: usize) -> Volume {
    let mut stream = Stream::seeded(5);
    let density = (0..size * size * size).map(|_| (4.0 * stream.uniform().powi(2)) as f32).collect();
    Volume::new([size; 3], DVec3::splat(2.0), density).unwrap()
}

fn settings(cells: usize, flights: u64) -> Settings {
    Settings { order: 4, cells, flights, noise: 0.0, longest_walk: 10_000, seed: 1 }
}

fn star(position: DVec3, intensity: Vec<f64>) -> Star {
    Star { position, intensity }
}

/// The source of one band.
fn source(field: &Field, band: usize, point: DVec3, towards: DVec3) -> f64 {
    let mut all = vec![0.0; field.bands()];
    field.source(point, towards, &mut all);
    all[band]
}

/// Shares of light reflected and transmitted by a slab lit from above: straight on and scattered once by quadrature, more than once by the field.
fn slab((cells, order): (usize, usize), depth: f64, albedo: f64, g: f64, flights: u64) -> (f64, f64) {
    let dust = dust(vec![depth], albedo, g);
    let field = gather_slab(&even(cells, 1.0), &dust, &Settings { order, ..settings(cells, flights) }).unwrap();
    let (levels, slopes, turns) = (8 * cells, 64, 2);
    let mut stream = Stream::seeded(9);
    let (mut up, mut down) = (0.0, (-depth).exp());
    for level in 0..levels {
        let z = (level as f64 + 0.5) / levels as f64 - 0.5;
        let (above, below) = (depth * (0.5 - z), depth * (0.5 + z));
        for slope in 0..slopes {
            // Close together where light leaves at a grazing angle, and where it goes straight on.
            let u = (slope as f64 + 0.5) / slopes as f64;
            let cosine = u * u * (3.0 - 2.0 * u);
            let share = 6.0 * u * (1.0 - u) / slopes as f64 * depth / levels as f64;
            for (sign, way, sum) in [(1.0, above, &mut up), (-1.0, below, &mut down)] {
                let once = albedo * dust.phase.per_steradian(-sign * cosine) * (-above).exp();
                let mut more = 0.0;
                for _ in 0..turns {
                    let angle = TAU * stream.uniform();
                    let across = (1.0 - cosine * cosine).sqrt();
                    let towards = DVec3::new(across * angle.cos(), across * angle.sin(), sign * cosine);
                    let point = DVec3::new(stream.uniform() - 0.5, stream.uniform() - 0.5, z);
                    more += source(&field, 0, point, towards) / f64::from(turns);
                }
                *sum += TAU * share * (once + more) * (-way / cosine).exp();
            }
        }
    }
    (up, down)
}

#[test]
fn a_slab_tends_to_adding_and_doubling_as_its_cells_are_made_finer() {
    // Adding and doubling with 48 nodes: depth, albedo, g, reflected, transmitted (light straight from above); how near ours must come. At depth
    // 10 a cell of the fine grid is as deep as 1.
    let reference = [
        (1.0, 0.6, 0.6, 0.039_207_377, 0.584_793_89, 0.003),
        (1.0, 1.0, 0.6, 0.137_362_17, 0.862_637_83, 0.003),
        (2.0, 0.9, 0.0, 0.361_648_87, 0.356_500_72, 0.003),
        (2.0, 0.9, 0.75, 0.097_394_638, 0.660_957_7, 0.003),
        (10.0, 0.9, 0.6, 0.238_171_58, 0.037_167_168, 0.013),
    ];
    for (depth, albedo, g, reflected, transmitted, near) in reference {
        let error = |fine, flights| {
            let (up, down) = slab(fine, depth, albedo, g, flights);
            (up - reflected).abs().max((down - transmitted).abs())
        };
        let (coarse, fine) = (error((2, 2), 20_000), error((10, 6), 60_000));
        assert!(fine < near && fine < coarse, "{depth} {albedo} {g}: {coarse} then {fine}");
    }
}

#[test]
fn pictures_are_as_near_to_mitsubas_as_asked_and_single_scattering_is_not() {
    for cloud in known::all().unwrap() {
        let (volume, scene) = (&cloud.volume, &cloud.scene);
        let wish = Wish { tolerance: 0.02, step: None, everything: false, seed: 1 };
        let draw = |model: &dyn Scattering| {
            let subject = Subject { volume, scene, model, exact: model, emission: None };
            render(&subject, &known::view(known::SIDE).unwrap(), &wish, &mut |_| {}).radiance.remove(0)
        };
        let single = Single::exact(volume, scene);
        let field = gather(volume, scene, &Settings { flights: 300_000, ..Settings::fitting(volume) }).unwrap();
        let seen = field.along(DVec3::Z);
        let compared = cloud.compare(&draw(&Together::new("multiple", vec![&single, &seen])));
        // Blocks within 3 % and three of the reference's errors, the total within 2 %.
        assert!(compared.blocks >= 16 && compared.over == 0, "{}: {compared:?}", cloud.name);
        assert!(compared.total.abs() < 0.02, "{}: {compared:?}", cloud.name);
        let once = draw(&single);
        assert!(cloud.median(&once) < 0.005, "{}: {}", cloud.name, cloud.median(&once));
        let short = cloud.compare(&once);
        assert!(short.total < -0.25 && short.over == short.blocks, "{}: {short:?}", cloud.name);
    }
}

#[test]
fn one_seed_gives_the_same_light_on_one_thread_and_on_many() {
    let scene =
        Scene::new(dust(vec![1.0, 2.0, 3.0, 4.0, 5.0], 0.6, 0.6), vec![star(DVec3::splat(0.1), vec![1.0; 5])]).unwrap();
    let volume = clumps(8);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| gather(&volume, &scene, &settings(8, 20_000)).unwrap())
    };
    let (one, many) = (on(1), on(3));
    assert_eq!(one.told(), many.told());
    for group in 0..2 {
        for slot in 0..one.told().cells {
            assert_eq!(one.coefficients(group, slot), many.coefficients(group, slot));
        }
    }
}

/// Light of a field: the mean source over all directions, over the box.
fn light(field: &Field, band: usize) -> f64 {
    let (group, lane) = (band / 4, band % 4);
    (0..field.told().cells).map(|slot| f64::from(field.coefficients(group, slot)[lane])).sum()
}

#[test]
fn two_stars_in_one_place_are_one_of_twice_the_light_and_two_apart_add_up() {
    let volume = clumps(6);
    let of = |stars: &[Star]| {
        let scene = Scene::new(dust(vec![1.0, 2.0], 0.6, 0.6), stars.to_vec()).unwrap();
        gather(&volume, &scene, &settings(6, 100_000)).unwrap()
    };
    let (here, there) =
        (star(DVec3::new(0.2, 0.3, -0.1), vec![1.0, 2.0]), star(DVec3::new(-0.7, 0.0, 1.6), vec![3.0, 0.5]));
    let (one, twice, other, both) = (
        of(std::slice::from_ref(&here)),
        of(&[here.clone(), here.clone()]),
        of(std::slice::from_ref(&there)),
        of(&[here, there]),
    );
    for band in 0..2 {
        assert!((light(&twice, band) / light(&one, band) - 2.0).abs() < 0.01);
        let sum = light(&one, band) + light(&other, band);
        assert!((light(&both, band) / sum - 1.0).abs() < 0.01, "{} and {sum}", light(&both, band));
    }
}

#[test]
fn what_cannot_scatter_twice_gives_nothing() {
    let lit = vec![star(DVec3::ZERO, vec![1.0])];
    let none = |volume: &Volume, extinction: f64, albedo: f64, stars: Vec<Star>| {
        let scene = Scene::new(dust(vec![extinction], albedo, 0.6), stars).unwrap();
        let field = gather(volume, &scene, &settings(4, 1000)).unwrap();
        source(&field, 0, DVec3::new(0.1, 0.2, 0.3), DVec3::X)
    };
    let empty = Volume::new([4; 3], DVec3::splat(2.0), vec![0.0; 64]).unwrap();
    assert_eq!(none(&empty, 1.0, 0.6, lit.clone()), 0.0);
    assert_eq!(none(&even(4, 2.0), 0.0, 0.6, lit.clone()), 0.0);
    assert_eq!(none(&even(4, 2.0), 1.0, 0.0, lit.clone()), 0.0);
    assert_eq!(none(&even(4, 2.0), 1.0, 0.6, Vec::new()), 0.0);
    assert!(none(&even(4, 2.0), 1.0, 0.6, lit) > 0.0);
}

#[test]
fn a_turned_scene_gives_turned_light() {
    // A quarter turn about z takes cells to cells, so that only the noise differs.
    let volume = clumps(6);
    let turned = |point: DVec3| DVec3::new(-point.y, point.x, point.z);
    let density = (0..216).map(|i| {
        let (x, y, z) = (i % 6, i / 6 % 6, i / 36);
        // The turned volume at (x, y) is the first at (y, 5 - x).
        volume.density()[(z * 6 + 5 - x) * 6 + y]
    });
    let second = Volume::new([6; 3], DVec3::splat(2.0), density.collect()).unwrap();
    let place = DVec3::new(0.5, 0.2, -0.3);
    let of = |volume: &Volume, place| {
        let scene = Scene::new(dust(vec![1.0], 0.8, 0.5), vec![star(place, vec![1.0])]).unwrap();
        gather(volume, &scene, &settings(6, 200_000)).unwrap()
    };
    let (a, b) = (of(&volume, place), of(&second, turned(place)));
    for (point, towards) in [
        (DVec3::new(0.5, 0.5, 0.1), DVec3::X),
        (DVec3::new(-0.4, 0.3, 0.2), DVec3::new(0.6, 0.0, 0.8)),
        (DVec3::new(0.1, -0.6, -0.5), -DVec3::Z),
    ] {
        let (first, second) = (source(&a, 0, point, towards), source(&b, 0, turned(point), turned(towards)));
        assert!((first / second - 1.0).abs() < 0.05, "{point}: {first} and {second}");
    }
}

#[test]
fn orders_of_scattering_add_up_and_grow_smaller() {
    let scene = Scene::new(dust(vec![1.0], 0.6, 0.6), vec![star(DVec3::splat(0.1), vec![1.0])]).unwrap();
    let volume = clumps(6);
    let all = gather(&volume, &scene, &settings(6, 50_000)).unwrap();
    let orders = gather_by_order(&volume, &scene, &settings(6, 50_000), 3).unwrap();
    let lights: Vec<f64> = orders.iter().map(|order| light(order, 0)).collect();
    assert!((lights.iter().sum::<f64>() / light(&all, 0) - 1.0).abs() < 1e-4, "the same photons, sorted: {lights:?}");
    assert!(lights[0] > lights[1] && lights[1] > lights[2] && lights[2] > 0.0, "{lights:?}");
}

#[test]
fn cells_coarser_than_the_dust_hold_the_same_light() {
    let scene = Scene::new(dust(vec![1.0], 0.6, 0.6), vec![star(DVec3::splat(0.1), vec![1.0])]).unwrap();
    let volume = clumps(12);
    let mean = |cells: usize| {
        let field = gather(&volume, &scene, &settings(cells, 100_000)).unwrap();
        light(&field, 0) / field.told().cells as f64
    };
    let (coarse, fine) = (mean(4), mean(12));
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} and {fine}");
}

#[test]
fn needles_of_scattering_and_dust_without_end_are_bounded_and_told() {
    let lit = |position| vec![star(position, vec![1.0])];
    for g in [0.999_999, -0.999_999, 1e-6, 0.0, 1.0, -1.0] {
        for extinction in [1e-6, 1.0, 1e3] {
            for position in [DVec3::ZERO, DVec3::splat(0.125), DVec3::X, DVec3::new(30.0, 2.0, 1.0)] {
                let scene = Scene::new(dust(vec![extinction], 1.0, g), lit(position)).unwrap();
                let asked = Settings { longest_walk: 200, ..settings(8, 2000) };
                let field = gather(&even(8, 2.0), &scene, &asked).unwrap();
                let told = field.told();
                assert!(told.flights < 2000 + 16 * 201, "{told:?}");
                assert!(told.most_scatterings <= 200 && (0.0..=1.0 + 1e-9).contains(&told.cut), "{told:?}");
                if extinction > 100.0 && g.abs() < 0.5 && position.length() < 1.0 {
                    assert!(told.cut > 0.1, "light that is still on its way is told: {told:?}");
                }
                for towards in [DVec3::X, -DVec3::Z] {
                    let here = source(&field, 0, DVec3::new(0.3, -0.2, 0.4), towards);
                    assert!(here.is_finite() && here >= 0.0, "g {g}, extinction {extinction}: {here}");
                }
            }
        }
    }
}

#[test]
fn thin_dust_scatters_twice_as_its_depth_squared() {
    let of = |extinction: f64| {
        let scene = Scene::new(dust(vec![extinction], 0.6, 0.6), vec![star(DVec3::ZERO, vec![1.0])]).unwrap();
        // The source is per unit of extinction: one power of the depth less than the light.
        light(&gather(&even(8, 2.0), &scene, &settings(8, 50_000)).unwrap(), 0)
    };
    let ratio = of(1e-6) / of(1e-3);
    assert!((ratio / 1e-3 - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn settings_that_cannot_be_are_refused_with_what_can() {
    let scene = Scene::new(dust(vec![1.0], 0.6, 0.6), vec![star(DVec3::ZERO, vec![1.0])]).unwrap();
    let refused = |asked: Settings| gather(&even(2, 2.0), &scene, &asked).unwrap_err();
    let sound = settings(4, 10);
    assert_eq!(refused(Settings { order: 9, ..sound }), MultipleError::Order(9));
    assert_eq!(refused(Settings { cells: 0, ..sound }), MultipleError::Cells(0));
    assert_eq!(refused(Settings { flights: 0, ..sound }), MultipleError::Flights(0));
    assert!(matches!(refused(Settings { noise: f64::NAN, ..sound }), MultipleError::Noise(_)));
    assert_eq!(refused(Settings { longest_walk: 0, ..sound }), MultipleError::Walk);
    let huge = gather(&even(2, 2.0), &scene, &Settings { cells: 256, order: 8, ..sound }).unwrap_err();
    assert!(huge.to_string().contains("fewer cells"), "{huge}");
}

#[test]
fn asked_for_a_noise_it_stops_when_that_is_reached() {
    let scene = Scene::new(dust(vec![1.0], 0.6, 0.6), vec![star(DVec3::ZERO, vec![1.0])]).unwrap();
    let asked = Settings { noise: 0.02, ..settings(8, 1_000_000) };
    let told = gather(&even(8, 2.0), &scene, &asked).unwrap().told();
    assert!(told.noise <= 0.02 && told.flights < 900_000, "{told:?}");
}

#[test]
fn a_field_seen_from_somewhere_is_the_field() {
    let scene =
        Scene::new(dust(vec![1.0, 2.0, 1.0, 1.0, 3.0], 0.6, 0.6), vec![star(DVec3::splat(0.1), vec![1.0; 5])]).unwrap();
    let field = gather(&clumps(8), &scene, &settings(16, 100_000)).unwrap();
    let eye = DVec3::new(3.0, 1.0, 2.0);
    let (along, from, within) = (field.along(DVec3::Z), field.from(eye), field.from(DVec3::splat(0.2)));
    let (mut a, mut b) = ([0.0; 5], [0.0; 5]);
    let mut stream = Stream::seeded(2);
    for _ in 0..200 {
        let point = DVec3::new(stream.uniform() - 0.5, stream.uniform() - 0.5, stream.uniform() - 0.5) * 1.8;
        field.source(point, DVec3::Z, &mut a);
        along.source(point, DVec3::Z, &mut b);
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5 * a.abs().max(1e-3)), "{a:?} {b:?}");
        for (seen, eye) in [(&from, eye), (&within, DVec3::splat(0.2))] {
            let towards = (eye - point).normalize();
            field.source(point, towards, &mut a);
            seen.source(point, towards, &mut b);
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.03 * a.abs() + 0.003), "{point} {a:?} {b:?}");
        }
        let mut ceiling = [0.0; 5];
        let ray = scotopic::physics::dust::camera::Ray { origin: eye, direction: -eye.normalize() };
        field.ceiling(&ray, 0.0, 10.0, &mut ceiling);
        assert!(a.iter().zip(ceiling).all(|(a, c)| *a <= c));
    }
}
