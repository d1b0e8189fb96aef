//! How long the sky takes: the catalogue's opening, a field, a search, the reduction of places.
//! `cargo bench --bench sky`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use scotopic::sky::astrometry::Reduction;
use scotopic::sky::catalogue::Catalogue;
use scotopic::sky::coords::Equatorial;
use scotopic::sky::ephemeris::{Almanac, Body, Ephemeris, InView};
use scotopic::sky::site::Site;
use scotopic::sky::time::{Moment, Utc};
use scotopic::units::{Angle, Magnitude};

fn catalogue(c: &mut Criterion) {
    // To be reached: under 50 ms.
    c.bench_function("catalogue ready, with its first search", |bench| {
        bench.iter(|| Catalogue::open().search(black_box("M31")).is_ok());
    });
    let catalogue = Catalogue::embedded();
    // To be reached: under 200 microseconds, each.
    for (place, ra, dec) in [("Orion", 83.82, -5.39), ("Milky Way in Cygnus", 305.0, 40.0), ("north pole", 0.0, 90.0)] {
        for (size, radius) in [("1 degree across", 0.5), ("1 degree radius", 1.0)] {
            c.bench_function(&format!("field of {size}, {place}"), |bench| {
                let centre = Equatorial::new(Angle::degrees(ra), Angle::degrees(dec));
                bench.iter(|| catalogue.within(black_box(&centre), Angle::degrees(radius), Magnitude(99.0)));
            });
        }
    }
    for name in ["M31", "alpha centauri", "61 Cyg", "andromeda galaxy", "polrais"] {
        c.bench_function(&format!("search for {name}"), |bench| {
            bench.iter(|| catalogue.search(black_box(name)).is_ok());
        });
    }
    c.bench_function("complete 'alp'", |bench| bench.iter(|| catalogue.complete(black_box("alp"), 8)));
}

/// To be reached: under a millisecond for a field with Jupiter, its moons and stars.
fn planets(c: &mut Criterion) {
    let catalogue = Catalogue::embedded();
    let site = Site::new(60.17, 24.94, 30.0).ok();
    let begin = Utc(1.8e9);
    let Ok(ephemeris) = Ephemeris::at(&Moment::at(begin)) else { return };
    for body in [Body::Jupiter, Body::Saturn, Body::Moon] {
        let centre = InView::of(&ephemeris, body, site.as_ref()).position;
        let mut almanac = Almanac::default();
        let mut frame = 0.0;
        c.bench_function(&format!("field with {body}, its moons and stars ready"), |bench| {
            bench.iter(|| {
                // Each frame is at another moment, a thirtieth of a second on.
                frame += 1.0;
                let moment = Moment::at(begin.plus_seconds(frame / 30.0));
                let bodies = almanac.within(&moment, site.as_ref(), &centre, Angle::degrees(0.31));
                let found = catalogue.within(black_box(&centre), Angle::degrees(0.31), Magnitude(14.0));
                assert!(!bodies.is_empty() || body == Body::Moon);
                black_box((bodies, found))
            });
        });
    }
}

fn places(c: &mut Criterion) {
    let moment = Moment::at(Utc(1.8e9));
    c.bench_function("reduction of a moment", |bench| bench.iter(|| Reduction::at(black_box(&moment))));
    let reduction = Reduction::at(&moment);
    let place = Equatorial::new(Angle::degrees(10.0), Angle::degrees(41.0));
    c.bench_function("place of date of one star", |bench| bench.iter(|| reduction.of_date(black_box(&place))));
}

criterion_group!(benches, catalogue, planets, places);
criterion_main!(benches);
