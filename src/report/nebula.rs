//! Pictures of dust lit by a star: error against run time of the models, of the photons, orders and cells of multiple scattering, and of the steps
//! along rays.

use std::time::Duration;

use super::{Answer, Case, Contender, Measurement, Study};
use crate::physics::dust::model::{Scattering, Together};
use crate::physics::dust::multiple::{self, Settings};
use crate::physics::dust::render::{Rendered, Subject, Wish, render};
use crate::physics::dust::scene::Scene;
use crate::physics::dust::single::Single;
use crate::physics::dust::table::{Accuracy, Parameters, Table, shared};
use crate::physics::dust::volume::Volume;
use crate::physics::dust::voxelwise::Voxelwise;

/// Clouds that no photon likes.
pub mod extremes;
/// Frames of the renderer to fly with.
pub mod flying;
/// What the table makes of one cloud on coarse and fine grids.
pub mod grid;
/// The references.
pub mod known;
/// A cloud as large as the thesis'.
pub mod large;
/// The accurate renderer under extreme scenes.
pub mod rendered;

use known::{Compared, Known, StudyError, refused, view};

/// One picture, held against its reference.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Picture {
    /// The cloud.
    pub cloud: &'static str,
    /// The method.
    pub method: &'static str,
    /// Its setting.
    pub setting: String,
    /// What was made before the picture: photons followed, and for flying what no frame changes; for the table nothing, as it is kept from one
    /// picture to the next.
    pub ready_s: f64,
    /// The picture itself.
    pub picture_s: f64,
    /// All orders against Mitsuba's.
    pub compared: Compared,
    /// The error that the method believes to have made in its own part of the light.
    pub believed: f64,
}

/// What is compared: the method, its setting, and what it is.
type Entry = (&'static str, String, What);

#[derive(Debug, Clone)]
enum What {
    Single,
    Table,
    Multiple(Settings),
}

fn entries(volume: &Volume) -> Vec<Entry> {
    let usual = Settings::fitting(volume);
    let mut all = vec![("single", String::new(), What::Single), ("table", String::new(), What::Table)];
    let mut add = |method, setting: String, settings: Settings| all.push((method, setting, What::Multiple(settings)));
    for flights in [10_000, 30_000, 100_000, 300_000, 1_000_000] {
        add("photons", format!("{flights} flights"), Settings { flights, ..usual });
    }
    for order in [1, 2, 3, 6] {
        add("orders", format!("order {order}"), Settings { order, ..usual });
    }
    for cells in [4, 8, 32] {
        add("cells", format!("{cells} cells"), Settings { cells, ..usual });
    }
    all
}

/// How pictures are drawn here: their own error far below that of the light in them.
const WISH: Wish = Wish { tolerance: 2e-3, step: None, everything: false, seed: 1 };

/// A picture of a model.
///
/// # Errors
/// Never.
fn draw(
    volume: &Volume,
    scene: &Scene,
    model: &dyn Scattering,
    side: usize,
    wish: &Wish,
) -> Result<Rendered, StudyError> {
    let subject = Subject { volume, scene, model, exact: model, emission: None };
    Ok(render(&subject, &view(side)?, wish, &mut |_| {}))
}

/// The thesis' table with fewer rows.
///
/// # Errors
/// Never.
pub fn small_table() -> Result<Table, StudyError> {
    let parameters = Parameters { depths: 101, ..Parameters::thesis().ok_or(StudyError::Damaged("table"))? };
    let accuracy = Accuracy { relative: Some(0.04), photons: None, most_events: 200_000_000 };
    Ok(shared::make(&parameters, &accuracy, 1, &mut |_| {}).map_err(refused)?.table)
}

/// Every method on every cloud.
///
/// # Errors
/// A reference is damaged.
pub fn pictures(
    clouds: &[Known],
    table: &Table,
    clock: &dyn Fn() -> Duration,
    told: &dyn Fn(&str),
) -> Result<Vec<Picture>, StudyError> {
    let mut all = Vec::new();
    for cloud in clouds {
        let (volume, scene) = (&cloud.volume, &cloud.scene);
        let single = Single::exact(volume, scene);
        for (method, setting, what) in entries(volume) {
            told(&format!("{}: {method} {setting}", cloud.name));
            let begin = clock();
            let (mut ready, mut believed) = (begin, 0.0);
            let picture = match what {
                What::Single => draw(volume, scene, &single, known::SIDE, &WISH)?,
                What::Table => draw(volume, scene, &Voxelwise::new(volume, scene, table, None), known::SIDE, &WISH)?,
                What::Multiple(settings) => {
                    let field = multiple::gather(volume, scene, &settings).map_err(refused)?;
                    (ready, believed) = (clock(), field.told().error());
                    let seen = field.along(glam::DVec3::Z);
                    draw(volume, scene, &Together::new("multiple", vec![&single, &seen]), known::SIDE, &WISH)?
                }
            };
            all.push(Picture {
                cloud: cloud.name,
                method,
                setting,
                ready_s: (ready - begin).as_secs_f64(),
                picture_s: (clock() - ready).as_secs_f64(),
                compared: cloud.compare(&picture.radiance[0]),
                believed,
            });
        }
        told(&format!("{}: flying", cloud.name));
        all.extend(flying::pictures(cloud, clock)?);
    }
    Ok(all)
}

/// A picture of light scattered once, at one setting of its rays.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Step {
    /// A fixed step or a tolerance.
    pub setting: String,
    /// Median relative difference of a pixel from the quadrature.
    pub median: f64,
    /// Seconds.
    pub picture_s: f64,
}

/// Steps along rays and tolerances on one cloud.
///
/// # Errors
/// Never.
pub fn steps(cloud: &Known, clock: &dyn Fn() -> Duration) -> Result<Vec<Step>, StudyError> {
    let single = Single::exact(&cloud.volume, &cloud.scene);
    let fixed = [8.0, 4.0, 2.0, 1.0, 0.5].map(|step| (format!("{step} voxels"), Wish { step: Some(step), ..WISH }));
    let planned = [0.1, 1e-2, 1e-3].map(|tolerance| (format!("to {tolerance:e}"), Wish { tolerance, ..WISH }));
    let mut all = Vec::new();
    for (setting, wish) in fixed.into_iter().chain(planned) {
        let begin = clock();
        let picture = draw(&cloud.volume, &cloud.scene, &single, known::SIDE, &wish)?;
        let median = cloud.median(&picture.radiance[0]);
        all.push(Step { setting, median, picture_s: (clock() - begin).as_secs_f64() });
    }
    Ok(all)
}

/// The steps as a table for people.
#[must_use]
pub fn steps_text(steps: &[Step]) -> String {
    let mut text = format!(
        "Clumps, light scattered once against a quadrature: steps along rays and tolerances\n  {:<12} {:>9} {:>10}\n",
        "setting", "median %", "picture s"
    );
    for step in steps {
        text += &format!("  {:<12} {:>9.3} {:>10.2}\n", step.setting, 100.0 * step.median, step.picture_s);
    }
    text
}

/// The pictures as a study, for its plot: the blocks' root mean square difference from Mitsuba's against all the time taken.
#[must_use]
pub fn study(pictures: &[Picture]) -> (Study<'_>, Vec<Measurement>) {
    let mut clouds: Vec<&'static str> = pictures.iter().map(|picture| picture.cloud).collect();
    clouds.dedup();
    let cases = clouds.iter().map(|cloud| Case {
        group: "multiple scattering".to_owned(),
        name: (*cloud).to_owned(),
        reference: 0.0,
    });
    let contender = |first: &Picture| {
        let (method, setting) = (first.method, first.setting.clone());
        let (clouds, wanted) = (clouds.clone(), setting.clone());
        let answer = move |index: usize| {
            let mut same = pictures.iter().filter(|p| p.method == method && p.setting == wanted);
            let picture = same.find(|p| Some(&p.cloud) == clouds.get(index))?;
            Some(Answer { value: picture.compared.rms, believed: picture.believed, steps: picture.compared.blocks })
        };
        Contender { method, setting, answer: Box::new(answer) as Box<dyn Fn(usize) -> Option<Answer> + '_> }
    };
    let contenders = pictures.iter().filter(|picture| Some(&picture.cloud) == clouds.first()).map(contender).collect();
    let measurement = |picture: &Picture| Measurement {
        group: "multiple scattering".to_owned(),
        case: picture.cloud.to_owned(),
        method: picture.method,
        setting: picture.setting.clone(),
        error: Some(picture.compared.rms),
        believed: Some(picture.believed),
        steps: picture.compared.blocks,
        time_us: 1e6 * (picture.ready_s + picture.picture_s),
    };
    let title = "Dust lit by a star: rms difference of 8 x 8 blocks from Mitsuba against run time";
    (Study { title, unit: "rel", cases: cases.collect(), contenders }, pictures.iter().map(measurement).collect())
}

/// The pictures as a table for people.
#[must_use]
pub fn table(pictures: &[Picture]) -> String {
    let mut text = "Pictures of 64 x 64 pixels against Mitsuba's: means of 8 x 8 blocks with more than 1 % of the light, 3 pixels round the star left out\n".to_owned();
    let mut last = "";
    for p in pictures {
        if last != p.cloud {
            last = p.cloud;
            text += &format!(
                "\n{}, {} blocks\n  {:<9} {:<15} {:>8} {:>8} {:>8} {:>6} {:>9} {:>9} {:>9}\n",
                p.cloud,
                p.compared.blocks,
                "method",
                "setting",
                "total %",
                "rms %",
                "worst %",
                "over",
                "believed",
                "ready s",
                "picture s"
            );
        }
        let c = p.compared;
        text += &format!(
            "  {:<9} {:<15} {:>+8.2} {:>8.2} {:>8.2} {:>6} {:>9.3} {:>9.2} {:>9.2}\n",
            p.method,
            p.setting,
            100.0 * c.total,
            100.0 * c.rms,
            100.0 * c.worst,
            c.over,
            p.believed,
            p.ready_s,
            p.picture_s
        );
    }
    text
}
