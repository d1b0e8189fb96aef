//! What one overlay costs: 50 labelled items at 1024 x 768 (aim: median under 8 ms, 99th percentile under 16 ms on 2 cores), a
//! photograph of 2048 pixels (aim: under 10 ms after the first), a frame of an animation (aim: 30 a second under a third of one
//! core, which is 11 ms each).

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DMat2, DVec2};
use scotopic::overlay::photograph::Plate;
use scotopic::overlay::{Composer, Eye, Mode, Photograph, Scene, Style};
use scotopic::picture::Picture;
use scotopic::sky::astrometry::Astrometry;
use scotopic::sky::catalogue::{Band, Catalogue, FieldObject, FieldStar, Found, Kind, StarId};
use scotopic::sky::coords::Equatorial;
use scotopic::sky::field::FieldOfView;
use scotopic::sky::optics::Instrument;
use scotopic::units::{Angle, Magnitude};

/// 25 objects and 25 stars with a number each, spread over the canvas.
fn crowded(field: &FieldOfView) -> Found {
    let at = |i: usize| field.projection.position(70.0 + (i % 10) as f64 * 97.0, 160.0 + (i / 10) as f64 * 110.0);
    let objects = (0..25).map(|i| FieldObject {
        name: "NGC 7331",
        kind: if i % 3 == 0 { Kind::OpenCluster } else { Kind::Galaxy },
        position: at(2 * i),
        magnitude: Some(Magnitude(8.0 + i as f64 / 5.0)),
        band: Band::V,
        axes_arcmin: Some((1.0 + i as f64 / 10.0, 0.6)),
        position_angle: Some(Angle::degrees(13.0 * i as f64)),
        separation: Angle::ZERO,
        index: i,
    });
    // The numbers in the Hipparcos catalogue of stars that have names, so that all are labelled.
    let named = [
        32349, 30438, 69673, 91262, 24608, 24436, 37279, 27989, 7588, 68702, 97649, 60718, 21421, 80763, 65474, 37826,
        113368, 62434, 102098, 71681, 49669, 33579, 36850, 61084, 85927,
    ];
    let stars = named.iter().enumerate().map(|(i, &id)| FieldStar {
        id: StarId::Hipparcos(id),
        astrometry: Astrometry::fixed(at(2 * i + 1)),
        v_mag: 3.0 + i as f32 / 4.0,
        colour_bv: Some(i as f32 / 15.0),
        separation: Angle::ZERO,
    });
    Found { stars: stars.collect(), objects: objects.collect(), reaching_in: Vec::new(), bodies: Vec::new() }
}

fn compose(c: &mut Criterion) {
    let instrument = Instrument::default().with_eyepiece(24.0);
    let centre = Equatorial::new(Angle::degrees(10.68), Angle::degrees(41.27));
    let field = FieldOfView::towards(&centre, Angle::ZERO, &instrument);
    let found = crowded(&field);
    let catalogue = Catalogue::embedded();
    let target = catalogue.search("M31").ok();
    let scene =
        Scene { found: &found, target: target.as_ref(), photographs: &[], catalogue, animation: None, menu: None };
    let (eye, style) = (Eye::default(), Style { mode: Mode::Over, ..Style::default() });

    let mut composer = Composer::default();
    c.bench_function("compose 50 labelled items at 1024 x 768", |b| {
        b.iter(|| black_box(composer.compose(&scene, &field, &eye, &style)));
    });
    let mut times: Vec<Duration> = (0..500)
        .map(|i| {
            // A field that drifts, as a tracked one does.
            let moved =
                FieldOfView { projection: field.projection.moved(f64::from(i) / 50.0, 0.0, 1.0), ..field.clone() };
            let start = Instant::now();
            let picture: Picture = black_box(composer.compose(&scene, &moved, &eye, &style));
            let took = start.elapsed();
            drop(picture);
            took
        })
        .collect();
    times.sort();
    println!(
        "drifting field: p50 {:.2?}, p99 {:.2?}, worst {:.2?} of {}",
        times[250],
        times[495],
        times[499],
        times.len()
    );
}

/// A photograph of 2048 pixels over a field that drifts, as before an alt-azimuth mount; and an animation's frames in its place.
fn photographs(_: &mut Criterion) {
    let instrument = Instrument::default().with_eyepiece(24.0);
    let catalogue = Catalogue::embedded();
    let Ok(target) = catalogue.search("M57") else { return };
    let field = FieldOfView::towards(&target.astrometry.position, Angle::ZERO, &instrument);
    let found = catalogue.within(&field.centre(), field.radius(), Magnitude(14.0));
    let photograph = |side: usize| {
        let mut picture = Picture::black(side, side);
        for (i, pixel) in picture.pixels_mut().iter_mut().enumerate() {
            *pixel = [(i % 97) as f32 / 97.0, (i % 89) as f32 / 89.0, (i % 83) as f32 / 83.0];
        }
        let scale = Angle::arcminutes(20.0).to_radians() / side as f64;
        let plate = Plate {
            centre: target.astrometry.position,
            reference: DVec2::splat(side as f64 / 2.0),
            matrix: DMat2::from_diagonal(DVec2::splat(-scale)),
        };
        Photograph::new("bench".into(), Some("nobody".into()), plate, picture)
    };
    let still = [photograph(2048)];
    let moving = photograph(512);
    let (eye, style) = (Eye::default(), Style::default());
    for (what, stills, animation, drifts) in [
        ("a photograph of 2048 pixels, drifting field", &still[..], None, true),
        ("the same, field at rest", &still[..], None, false),
        ("a frame of 512 pixels of an animation", &[], Some(&moving), false),
    ] {
        let scene =
            Scene { found: &found, target: Some(&target), photographs: stills, catalogue, animation, menu: None };
        let mut composer = Composer::default();
        let _ = black_box(composer.compose(&scene, &field, &eye, &style));
        let mut times: Vec<Duration> = (0..200)
            .map(|i| {
                let right = if drifts { f64::from(i) / 50.0 } else { 0.0 };
                let moved = FieldOfView { projection: field.projection.moved(right, 0.0, 1.0), ..field.clone() };
                let start = Instant::now();
                let picture = black_box(composer.compose(&scene, &moved, &eye, &style));
                let took = start.elapsed();
                drop(picture);
                took
            })
            .collect();
        times.sort();
        println!("{what}: p50 {:.2?}, p99 {:.2?} after the first", times[100], times[198]);
    }
}

criterion_group!(benches, compose, photographs);
criterion_main!(benches);
