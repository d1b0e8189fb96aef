//! `scotopic sun render`: the picture of the low Sun.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::json;

use super::picture::{Picture, PictureArguments, White};
use super::progress::Bar;
use crate::cli::{Failure, answer};
use crate::physics::colour::Tone;
use crate::physics::sun::{Explained, Rendered, Scene, everything, render, sky};
use crate::picture::fits::write::{Value, three_planes};
use crate::picture::png;

/// The scene, and where its picture goes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic sun render --out sunset.png                             the lower limb on the horizon, clean standard air\n  \
    scotopic sun render --preset omega --out omega.png\n  \
    scotopic sun render --preset us76 --climate continental-average --humidity 80 --less-forward --out hazy.png\n  \
    scotopic sun render --scene my-scene.toml --explain --out mine.png\n\n\
    Beside the PNG lies the linear light, X, Y and Z in cd/m2, as FITS (--no-fits leaves it out). The picture has the\n\
    thesis' tone, Y^(1/2.5), with the same light as white in every picture, so that haze is seen to darken; --white auto\n\
    shows the brightest as white.")]
pub struct Arguments {
    #[command(flatten)]
    picture: PictureArguments,
    /// The PNG file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Leave out the FITS file of linear light
    #[arg(long)]
    no_fits: bool,
    /// Trace every ray of every pixel at every wavelength (slow), and say how far the quick picture is from it
    #[arg(long)]
    everything: bool,
    /// Say what was left out and why, the error reached, and the time of each part
    #[arg(long)]
    explain: bool,
    /// Print no notes
    #[arg(long, short)]
    quiet: bool,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Makes the picture.
///
/// # Errors
/// The scene cannot be, or a file could not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    answer_of(arguments).and_then(|text| answer(&text))
}

/// Makes the picture, and gives the answer.
pub(super) fn answer_of(arguments: &Arguments) -> Result<String, Failure> {
    let picture = arguments.picture.open()?;
    let (sun, _) = picture.altitudes()?;
    let scene = picture.scene(sun, picture.view([sun, sun])?);
    let begin = Instant::now();
    let (mut quick, explained) = render(&scene, &|| begin.elapsed()).map_err(Failure::asked)?;
    let quick_time = begin.elapsed();

    // Every ray, if that is wanted, and how far the quick picture is from it.
    let mut every = None;
    if arguments.everything {
        let mut bar = Bar::new("rows, pixel by pixel");
        let same = Scene { wavelengths: Some(explained.wavelengths), ..scene };
        let begin = Instant::now();
        let all = everything(&same, None, &mut |share| bar.show(share)).map_err(Failure::asked)?;
        bar.end();
        let worst = difference(&quick, &all, picture.tone, white(&picture, &quick));
        every = Some((begin.elapsed(), worst));
        quick = all;
    }
    let mut shown = quick;
    if let Some(albedo) = picture.sky {
        let mut bar = Bar::new("the sky");
        let quiet = arguments.quiet;
        let mut tell = |share: f64| {
            if !quiet {
                bar.show(share);
            }
        };
        sky::add(&scene, albedo, &mut shown, &mut tell).map_err(Failure::asked)?;
        bar.end();
    }
    let white = white(&picture, &shown);
    let files = write(&arguments.out, &shown, &scene, &picture, white, !arguments.no_fits)?;
    for file in files.iter().filter(|_| !arguments.quiet) {
        eprintln!("wrote {}", file.display());
    }
    if shown.brightest() < 1e-5 * white && !arguments.quiet {
        eprintln!(
            "the brightest pixel has {:.1e} cd/m2, white is {white:.1e}: --white auto would show it",
            shown.brightest()
        );
    }
    if arguments.json {
        return Ok(as_json(&scene, &shown, &explained, quick_time, white, &files, every).to_string());
    }
    let mut text = format!(
        "{}: the Sun's centre at {:.3}' (true altitude), {} x {} pixels of {:.3}', {} wavelengths, {:.0} ms",
        picture.air.name,
        scene.sun_altitude.to_arcminutes(),
        scene.view.width,
        scene.view.height,
        scene.view.pixel.to_arcminutes(),
        explained.wavelengths,
        quick_time.as_secs_f64() * 1e3,
    );
    if let Some((time, worst)) = every {
        text += &format!(
            "\npixel by pixel: {:.1} s, {:.0} times as long; the quick picture is within {worst}/255 of it",
            time.as_secs_f64(),
            time.as_secs_f64() / quick_time.as_secs_f64()
        );
    }
    if arguments.explain {
        text += &format!("\n\n{}", explanation(&scene, &explained, picture.sky.is_some()));
    }
    Ok(text)
}

/// The light that is shown as full.
pub(super) fn white(picture: &Picture, rendered: &Rendered) -> f64 {
    match picture.white {
        White::Fixed(level) => level,
        // A black picture is black in any light.
        White::Brightest => rendered.brightest().max(1e-12),
    }
}

/// The largest difference of codes.
fn difference(a: &Rendered, b: &Rendered, tone: Tone, white: f64) -> u8 {
    let (a, b) = (a.codes(tone, white), b.codes(tone, white));
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// Writes the PNG and, if wanted, the FITS beside it.
pub(super) fn write(
    out: &Path,
    rendered: &Rendered,
    scene: &Scene<'_>,
    picture: &Picture,
    white: f64,
    fits: bool,
) -> Result<Vec<PathBuf>, Failure> {
    let view = rendered.view;
    let bytes =
        png::encode_codes(view.width, view.height, &rendered.codes(picture.tone, white)).map_err(Failure::failed)?;
    let save = |path: &Path, bytes: &[u8]| {
        std::fs::write(path, bytes).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))
    };
    save(out, &bytes)?;
    let mut files = vec![out.to_path_buf()];
    if fits {
        let path = out.with_extension("fits");
        let arcmin = view.pixel.to_arcminutes();
        let cards = [
            ("BUNIT", Value::Text("cd/m2")),
            ("CTYPE3", Value::Text("CIE 1964 X, Y, Z")),
            ("CTYPE1", Value::Text("azimuth times cos altitude")),
            ("CUNIT1", Value::Text("arcmin")),
            ("CRPIX1", Value::Number(0.5 * (view.width as f64 + 1.0))),
            ("CRVAL1", Value::Number(0.0)),
            ("CDELT1", Value::Number(arcmin)),
            ("CTYPE2", Value::Text("apparent altitude")),
            ("CUNIT2", Value::Text("arcmin")),
            ("CRPIX2", Value::Number(0.5)),
            ("CRVAL2", Value::Number(view.bottom.to_arcminutes())),
            ("CDELT2", Value::Number(arcmin)),
            ("SUNALT", Value::Number(scene.sun_altitude.to_arcminutes())),
            ("EYE", Value::Number(scene.observer_height_m)),
            ("WHITE", Value::Number(white)),
            ("OBJECT", Value::Text(&picture.air.name)),
        ];
        save(&path, &three_planes(view.width, &rendered.xyz, &cards))?;
        files.push(path);
    }
    Ok(files)
}

fn explanation(scene: &Scene<'_>, e: &Explained, with_sky: bool) -> String {
    let view = &scene.view;
    let milliseconds = |time: &Duration| time.as_secs_f64() * 1e3;
    let pixels = view.width * view.height;
    let chosen = if e.asked {
        "as asked".to_owned()
    } else {
        format!(
            "so that neighbours are at most {:.2}\" apart where 8 to 64 allow it",
            (view.pixel.to_arcseconds() * 0.5).max(scene.tolerance.to_arcseconds())
        )
    };
    let mut text = format!(
        "What was left out, and why\n\
         \x20 wavelengths    {} ({chosen}); neighbouring pictures of the Sun are {:.2}\" apart\n\
         \x20 traced at      {} of them; between, a polynomial in refractivity: its last term is {:.1e}\"\n\
         \x20 rays           {} in place of {} (two for each pixel and wavelength): the sky is layered, so that a curve for each\n\
         \x20                wavelength is enough; along it the error is below {:.1e}\" and {:.1e} of depth\n\
         \x20 curves         {} of {} pieces of the curves not refined: what they span, half as much again on both sides, does\n\
         \x20                not meet the disc\n\
         \x20 rows           {} of {} show light\n\
         \x20 columns        {} of {} computed: the other half is their mirror, exactly\n\
         \x20 sky            {}\n",
        e.wavelengths,
        e.step.to_arcseconds(),
        e.traced_wavelengths,
        e.between.to_arcseconds(),
        e.rays,
        2 * pixels * e.wavelengths,
        e.along.to_arcseconds(),
        e.depth,
        e.unreached,
        e.panels,
        e.lit_rows,
        e.rows,
        view.width.div_ceil(2),
        view.width,
        match with_sky {
            false => "left out, because it was not asked for: light scattered into the view is not followed".to_owned(),
            true => format!("at {} wavelengths and a grid of directions, straight lines between", sky::WAVELENGTHS),
        },
    );
    if e.given_up > 0 {
        text += &format!(
            "\x20 given up       {} pieces would not become good enough (a duct's edge, or a method with steps): their error is not known\n",
            e.given_up
        );
    }
    text += &format!(
        "Error of place reached: {:.1e}\" (asked: {:.3}\"), of which {:.1e}\" are the rays' own\nTime, ms:",
        e.error().to_arcseconds(),
        scene.tolerance.to_arcseconds(),
        e.believed.to_arcseconds(),
    );
    for (part, time) in &e.times {
        text += &format!(" {part} {:.1},", milliseconds(time));
    }
    text.trim_end_matches(',').to_owned()
}

fn as_json(
    scene: &Scene<'_>,
    shown: &Rendered,
    e: &Explained,
    time: Duration,
    white: f64,
    files: &[PathBuf],
    compared: Option<(Duration, u8)>,
) -> serde_json::Value {
    let times: serde_json::Map<String, serde_json::Value> =
        e.times.iter().map(|(part, time)| ((*part).to_owned(), json!(time.as_secs_f64() * 1e3))).collect();
    json!({
        "files": files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
        "width": scene.view.width,
        "height": scene.view.height,
        "bottom_arcmin": scene.view.bottom.to_arcminutes(),
        "pixel_arcmin": scene.view.pixel.to_arcminutes(),
        "sun_altitude_arcmin": scene.sun_altitude.to_arcminutes(),
        "observer_height_m": scene.observer_height_m,
        "brightest_cd_m2": shown.brightest(),
        "white_cd_m2": white,
        "wavelengths": e.wavelengths,
        "wavelength_step_arcsec": e.step.to_arcseconds(),
        "traced_wavelengths": e.traced_wavelengths,
        "rays": e.rays,
        "lit_rows": e.lit_rows,
        "pieces": e.panels,
        "pieces_not_refined": e.unreached,
        "pieces_given_up": e.given_up,
        "believed_error_arcsec": e.error().to_arcseconds(),
        "believed_depth_error": e.depth,
        "time_ms": time.as_secs_f64() * 1e3,
        "times_ms": times,
        "everything_ms": compared.map(|(time, _)| time.as_secs_f64() * 1e3),
        "everything_worst_code": compared.map(|(_, worst)| worst),
    })
}
