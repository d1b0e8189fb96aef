//! Stellarium's photographs as the package `stellarium-data` lays them on disk, each in the overlay. Their corners were
//! measured by other people; the places of objects (OpenNGC) and stars (Tycho-2) by others still.
//!
//! Without the package the test says that it was skipped; with `SCOTOPIC_DEMAND_STELLARIUM=1` (continuous integration) it
//! fails.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use scotopic::overlay::photograph::stars::{self, agreement};
use scotopic::overlay::photograph::stellarium::{self, names};
use scotopic::overlay::{Composer, Eye, Mode, Photograph, Scene, Style};
use scotopic::picture::Picture;
use scotopic::sky::catalogue::{Catalogue, Found, Object};
use scotopic::sky::field::FieldOfView;
use scotopic::sky::optics::Instrument;
use scotopic::units::Angle;

const FOLDER: &str = "/usr/share/stellarium/nebulae/default";
/// About when most of the pictures were taken.
const YEAR: f64 = 2010.0;

/// How a picture was found to lie where the catalogue has what it shows.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Evidence {
    /// Its stars are where the catalogue's are, within 2 arcminutes.
    Stars,
    /// The catalogue's place of its object is drawn within 2 arcminutes of its middle.
    Middle,
    /// The brightest light about the object's place is drawn within 2 arcminutes of it.
    Light,
}

/// The overlay of one photograph through the 24 mm eyepiece, and the field; the object stands in the middle.
fn composed(composer: &mut Composer, photograph: &Photograph, object: Option<&Object>) -> (Picture, FieldOfView) {
    let centre = object.map_or(photograph.middle(), |object| object.astrometry.position);
    let field = FieldOfView::towards(&centre, Angle::ZERO, &Instrument::default().with_eyepiece(24.0));
    let style = Style {
        mode: Mode::Over,
        labels: false,
        information: false,
        uncertainty: false,
        field_circle: false,
        marks: 0.0,
        text: 0.0,
        ..Style::default()
    };
    let scene = Scene {
        found: &Found::default(),
        target: object,
        photographs: std::slice::from_ref(photograph),
        catalogue: Catalogue::embedded(),
        animation: None,
        menu: None,
    };
    (composer.compose(&scene, &field, &Eye::default(), &style), field)
}

/// Where the brightest light is about the middle of an overlay, averaged over 20 arcseconds, in arcminutes from the middle.
fn peak_arcmin(picture: &Picture, field: &FieldOfView) -> f64 {
    let side = (20.0 / field.projection.scale().to_arcseconds()) as usize;
    let mut best = (0.0, 0.0);
    for y in (40..picture.height() - side - 40).step_by(side / 2) {
        for x in (picture.width() / 2 - 330..picture.width() / 2 + 330).step_by(side / 2) {
            let rows = (y..y + side).map(|row| picture.row(row)[x..x + side].iter().flatten().sum::<f32>());
            let light = rows.sum::<f32>();
            if light > best.0 {
                let (dx, dy) = ((x + side / 2) as f64 - 512.0, (y + side / 2) as f64 - 384.0);
                best = (light, dx.hypot(dy) * field.projection.scale().to_arcminutes());
            }
        }
    }
    if best.0 > 0.0 { best.1 } else { f64::INFINITY }
}

/// How it is known that a photograph lies right, or why that cannot be told.
fn evidence(composer: &mut Composer, photograph: &Photograph, object: Option<&Object>) -> Result<Evidence, String> {
    let catalogue = Catalogue::embedded();
    let (picture, field) = composed(composer, photograph, object);
    if picture.is_black() && object.is_none_or(|object| photograph.contains(&object.astrometry.position)) {
        return Err("its overlay is black".into());
    }
    let mut why = String::from("fewer than five catalogued stars in it");
    for reach_arcsec in [30.0, 120.0] {
        if let Some(found) = agreement(photograph, catalogue, Angle::arcseconds(reach_arcsec), YEAR) {
            if found.beyond_chance() {
                return Ok(Evidence::Stars);
            }
            why = format!("{} of {} stars met, {:.1} by chance", found.met, found.stars, found.by_chance);
        }
    }
    let Some(object) = object else { return Err(format!("its object is in no catalogue of ours; {why}")) };
    let (x, y) = field.projection.pixel(&photograph.middle()).unwrap();
    let middle = (x - 512.0).hypot(y - 384.0) * field.projection.scale().to_arcminutes();
    if middle <= 2.0 {
        return Ok(Evidence::Middle);
    }
    let peak = peak_arcmin(&picture, &field);
    if photograph.contains(&object.astrometry.position) && peak <= 2.0 {
        return Ok(Evidence::Light);
    }
    Err(format!("{} is {middle:.1}' from its middle and {peak:.1}' from the brightest light; {why}", object.name))
}

#[test]
fn nine_tenths_of_stellariums_photographs_lie_where_the_catalogues_have_their_objects_and_stars() {
    let Ok(text) = std::fs::read_to_string(format!("{FOLDER}/textures.json")) else {
        if std::env::var_os("SCOTOPIC_DEMAND_STELLARIUM").is_some() {
            panic!("{FOLDER}/textures.json cannot be read: install stellarium-data");
        }
        println!("skipped: stellarium-data is not installed");
        return;
    };
    let catalogue = Catalogue::embedded();
    let (tiles, notes) = stellarium::index(&text).unwrap();
    assert!(tiles.len() > 500 && notes.is_empty(), "{} {notes:?}", tiles.len());

    let mut composer = Composer::default();
    let (mut placed, mut rest, mut rich) = (Vec::new(), Vec::new(), Vec::new());
    for tile in &tiles {
        let bytes = std::fs::read(Path::new(FOLDER).join(&tile.file)).unwrap();
        let photograph = match tile.photograph(&bytes) {
            Ok(photograph) => photograph,
            Err(why) => {
                rest.push(format!("{}: {why}", tile.stem()));
                continue;
            }
        };
        let object = names::subject(tile.stem(), &photograph.middle(), photograph.radius(), catalogue);
        match evidence(&mut composer, &photograph, object.as_ref()) {
            Ok(evidence) => placed.push(evidence),
            Err(why) => rest.push(format!("{}: {why}", tile.stem())),
        }
        // Rich in stars: at least 15 of the catalogue's, and as many spots. Half of all of them within 10 arcseconds.
        if let Some(found) = agreement(&photograph, catalogue, Angle::arcseconds(10.0), YEAR)
            && found.stars >= 15
            && stars::spots(&photograph).len() >= 15
        {
            rich.push((tile.stem(), found));
        }
    }
    let by = |evidence| placed.iter().filter(|placed| **placed == evidence).count();
    println!(
        "{} of {} placed: {} by their stars, {} by their middle, {} by their light",
        placed.len(),
        tiles.len(),
        by(Evidence::Stars),
        by(Evidence::Middle),
        by(Evidence::Light)
    );
    rest.iter().for_each(|line| println!("not shown to be placed: {line}"));
    let right: Vec<_> = rich.iter().filter(|(_, found)| found.holds()).collect();
    println!(
        "{} of {} photographs rich in stars have half of the catalogue's within 10 arcseconds:",
        right.len(),
        rich.len()
    );
    for (stem, found) in &rich {
        let median = found.median.to_arcseconds();
        println!("  {stem}: {} of {} ({:.1} by chance), median {median:.1}\"", found.met, found.stars, found.by_chance);
    }
    assert!(placed.len() * 10 >= tiles.len() * 9, "{} of {}", placed.len(), tiles.len());
    assert!(right.len() >= 20, "{}", right.len());
}
