//! What must hold of the embedded catalogues as a whole.

use super::deep_sky::DeepSky;
use super::*;
use crate::sky::coords::Equatorial;

#[test]
fn the_files_are_whole_and_as_large_as_promised() {
    let (hipparcos, faint, deep_sky) = Catalogue::embedded().counts();
    assert!(hipparcos >= 117_000, "{hipparcos}");
    assert!(hipparcos + faint >= 978_000, "{faint}");
    assert_eq!(deep_sky, 13_371);
    assert!(FAINT_STARS.len() <= 10_000_000, "{}", FAINT_STARS.len());
}

#[test]
fn a_file_that_was_cut_short_is_not_opened() {
    let tiles = Tiles::new();
    assert!(StarFile::open(&HIPPARCOS[..HIPPARCOS.len() - 1], Form::Hipparcos, &tiles).is_none());
    assert!(StarFile::open(&FAINT_STARS[..100], Form::Faint, &tiles).is_none());
    assert!(StarFile::open(FAINT_STARS, Form::Hipparcos, &tiles).is_none());
    assert!(StarFile::open(&[], Form::Faint, &tiles).is_none());
}

#[test]
fn every_hip_number_leads_to_its_own_star() {
    let catalogue = Catalogue::embedded();
    let file = catalogue.hipparcos.unwrap();
    let mut stars = 0;
    for tile in 0..catalogue.tiles.count() {
        for place in file.in_tile(tile) {
            let star = file.star(place, tile, &catalogue.tiles).unwrap();
            let StarId::Hipparcos(hip) = star.id else { panic!("a star of Hipparcos") };
            assert_eq!(file.by_hip(hip), Some(place));
            assert_eq!(file.tile_of(place, &catalogue.tiles), tile);
            stars += 1;
        }
    }
    assert_eq!(stars, file.len());
    assert_eq!(file.by_hip(0), None);
    assert_eq!(file.by_hip(u32::MAX), None);
}

#[test]
fn in_each_tile_the_brightest_stars_come_first() {
    let catalogue = Catalogue::embedded();
    for file in [catalogue.hipparcos.unwrap(), catalogue.faint.unwrap()] {
        for tile in 0..catalogue.tiles.count() {
            let magnitudes: Vec<f32> = file.in_tile(tile).map(|place| file.v_mag(place)).collect();
            assert!(magnitudes.is_sorted(), "tile {tile}");
        }
    }
}

/// No faint star within 2 arcseconds and 0.3 magnitudes of a star of Hipparcos. The places of the faint file are rounded by
/// the source to 0.36 arcsecond, hence 1.9.
#[test]
fn no_star_is_there_twice() {
    let catalogue = Catalogue::embedded();
    let (hipparcos, faint) = (catalogue.hipparcos.unwrap(), catalogue.faint.unwrap());
    let tiles = &catalogue.tiles;
    let radius = Angle::arcseconds(1.9);
    let mut twins = Vec::new();
    for tile in 0..tiles.count() {
        for place in hipparcos.in_tile(tile) {
            let star = hipparcos.star(place, tile, tiles).unwrap();
            let at = star.astrometry.position;
            let mut near = Vec::new();
            for run in tiles.covering(at.ra().to_radians(), at.dec().to_radians(), radius.to_radians()) {
                for tile in run {
                    catalogue.stars_in(&faint, tile, &at, radius, Magnitude(99.0), &mut near);
                }
            }
            twins.extend(
                near.iter().filter(|twin| (twin.v_mag - star.v_mag).abs() < 0.29).map(|twin| (star.id, twin.id)),
            );
        }
    }
    assert!(twins.is_empty(), "{twins:?}");
}

#[test]
fn every_entry_of_the_observing_lists_is_found_by_its_number() {
    let catalogue = Catalogue::embedded();
    for (letter, last) in [("M", 110), ("C", 109)] {
        for number in 1..=last {
            let name = format!("{letter}{number}");
            let object = catalogue.search(&name).unwrap();
            assert!(object.names.contains(&name), "{name}: {:?}", object.names);
        }
    }
    let numbers = include_str!("../../../fixtures/reference/herschel_400.txt");
    assert_eq!(numbers.lines().count(), 400);
    for number in numbers.lines() {
        let object = catalogue.search(&format!("NGC {number}")).unwrap();
        assert!(object.names.iter().any(|name| name == "Herschel 400"), "NGC {number}: {:?}", object.names);
    }
}

#[test]
fn every_name_finds_an_object_that_bears_it() {
    let catalogue = Catalogue::embedded();
    for object in catalogue.deep_sky.objects.iter().filter(|object| !object.name().contains("NED")) {
        let found = catalogue.search(object.name()).unwrap();
        assert!(found.names.iter().any(|name| name == object.name()), "{}: {:?}", object.name(), found.names);
    }
    for names in &catalogue.star_names {
        for name in names.proper.split(';').filter(|name| !name.is_empty()) {
            let found = catalogue.search(name).unwrap();
            assert!(found.names.iter().any(|known| known == name), "{name}: {:?}", found.names);
        }
    }
}

/// OpenNGC's own column, made by others from the same boundaries, over 13,000 objects; some lie on an edge.
#[test]
fn constellations_agree_with_openngcs_column() {
    let objects = &Catalogue::embedded().deep_sky.objects;
    let wrong: Vec<&str> = objects
        .iter()
        .filter(|object| {
            !object.constellation.is_empty() && object.constellation != constellation::at(&object.position)
        })
        .map(DeepSky::name)
        .collect();
    assert!(wrong.len() < objects.len() / 1000, "{} {wrong:?}", wrong.len());
}

/// A star bears the name of the constellation in which it lies; a dozen or so have been moved over a boundary since.
#[test]
fn constellations_agree_with_the_stars_designations() {
    let catalogue = Catalogue::embedded();
    let (mut stars, mut wrong) = (0, 0);
    for names in catalogue.star_names.iter().filter(|names| !names.bayer.is_empty() && !names.constellation.is_empty())
    {
        let star = catalogue.star(StarId::Hipparcos(names.hip)).unwrap();
        stars += 1;
        wrong += usize::from(star.constellation != names.constellation);
    }
    assert!(stars > 1900 && wrong < 20, "{wrong} of {stars}");
}

#[test]
fn a_field_is_the_same_as_asking_every_star() {
    let catalogue = Catalogue::embedded();
    for (ra, dec, radius_deg, faintest) in
        [(83.8, -5.4, 1.0, 99.0), (0.001, 0.0, 0.7, 9.0), (120.0, 89.7, 0.8, 99.0), (10.0, -90.0, 0.5, 10.5)]
    {
        let centre = Equatorial::new(Angle::degrees(ra), Angle::degrees(dec));
        let radius = Angle::degrees(radius_deg);
        let mut all = Vec::new();
        for file in [catalogue.hipparcos.unwrap(), catalogue.faint.unwrap()] {
            for tile in 0..catalogue.tiles.count() {
                catalogue.stars_in(&file, tile, &centre, radius, Magnitude(faintest), &mut all);
            }
        }
        let found = catalogue.within(&centre, radius, Magnitude(faintest));
        assert_eq!(found.stars.len(), all.len());
        assert!(!found.stars.is_empty());
        assert!(found.stars.windows(2).all(|pair| pair[0].separation <= pair[1].separation));
    }
}

#[test]
fn half_a_degree_anywhere_is_not_empty() {
    let catalogue = Catalogue::embedded();
    let mut empty = 0;
    for step in 0..2000 {
        // Evenly over the sphere along a spiral.
        let sine: f64 = 1.0 - (f64::from(step) + 0.5) / 1000.0;
        let centre = Equatorial::new(Angle::degrees(f64::from(step) * 137.508), Angle::asin(sine));
        empty += usize::from(catalogue.within(&centre, Angle::degrees(0.25), Magnitude(99.0)).stars.is_empty());
    }
    assert!(empty < 100, "{empty} of 2000");
}

#[test]
fn a_large_object_reaches_into_a_field_beside_its_centre() {
    let catalogue = Catalogue::embedded();
    let beside = Equatorial::new(Angle::degrees(11.4), Angle::degrees(41.9));
    let found = catalogue.within(&beside, Angle::degrees(0.25), Magnitude(99.0));
    assert!(found.objects.iter().all(|object| object.name != "M31"));
    assert!(found.reaching_in.iter().any(|object| object.name == "M31"));
}

/// Xi Ursae Majoris by Tycho-2: component A has V 4.27, and the pair moves by -453.7, -591.4 mas a year.
#[test]
fn the_known_faults_of_the_tables_are_mended() {
    let catalogue = Catalogue::embedded();
    let alula = catalogue.search("xi UMa").unwrap();
    assert_eq!((alula.astrometry.pm_east_mas_yr, alula.astrometry.pm_north_mas_yr), (-453.7, -591.4));
    assert!((alula.magnitude.unwrap().0 - 4.27).abs() < 0.005);
    let graffias = catalogue.search("xi Sco").unwrap();
    assert!(graffias.names.contains(&String::from("HIP 78727")));
    assert!(graffias.astrometry.pm_east_mas_yr < -50.0);
    assert_eq!(catalogue.search("HIP 115125").unwrap().magnitude, Some(Magnitude(6.97)));
}

#[test]
fn text_from_the_files_cannot_move_a_cursor() {
    for text in [STAR_NAMES, OPENNGC] {
        assert!(text.chars().all(|c| c == '\n' || c == '\t' || !c.is_control()));
    }
}
