//! The thesis' figure 5.3: how a voxel scatters, by direction, for growing depth.

use std::f64::consts::PI;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::plot::{COLOURS, PlotError};
use crate::physics::dust::table::Table;

/// Size of a panel, pixels.
const PANEL: u32 = 460;
/// Height of the title above the panels, pixels.
const TITLE: u32 = 56;
/// The shares of the table's last depth whose curves are drawn, for all and for the deep ones.
const PANELS: [(&str, &[f64]); 2] =
    [("all depths", &[0.01, 0.05, 0.1, 0.2, 0.5, 1.0]), ("the deep ones, magnified", &[0.3, 0.5, 0.7, 1.0])];
/// Directions of a curve.
const POINTS: usize = 361;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failed = Box<dyn std::error::Error>;

/// Draws a table as SVG: light per steradian as the distance from the middle, forwards to the right.
///
/// # Errors
/// The drawing library failed.
pub fn svg(table: &Table) -> Result<String, PlotError> {
    let mut text = String::new();
    draw(table, &mut text).map_err(|error| PlotError(error.to_string()))?;
    Ok(text)
}

fn draw(table: &Table, text: &mut String) -> Result<(), Failed> {
    let root = SVGBackend::with_string(text, (PANEL * PANELS.len() as u32, PANEL + TITLE)).into_drawing_area();
    root.fill(&WHITE)?;
    let (p, style) = (table.parameters(), ("sans-serif", 18));
    let title =
        format!("Light that leaves a voxel scattered, per steradian: albedo {}, g {}", p.albedo, p.phase.asymmetry());
    root.draw(&Text::new(title, (12, 8), style))?;
    root.draw(&Text::new(
        "forwards to the right; depth of extinction along the voxel's edge",
        (12, 32),
        ("sans-serif", 13),
    ))?;
    let (_, below) = root.split_vertically(TITLE);
    for (area, (caption, shares)) in below.split_evenly((1, PANELS.len())).iter().zip(PANELS) {
        panel(area, table, caption, shares)?;
    }
    root.present()?;
    Ok(())
}

fn panel(area: &Area<'_>, table: &Table, caption: &str, shares: &[f64]) -> Result<(), Failed> {
    let curve = |share: &f64| -> (f64, Vec<(f64, f64)>) {
        let depth = share * table.deepest();
        let point = |i: usize| {
            let (sine, cosine) = (2.0 * PI * i as f64 / (POINTS - 1) as f64).sin_cos();
            let light = table.per_steradian(depth, cosine);
            (light * cosine, light * sine)
        };
        (depth, (0..POINTS).map(point).collect())
    };
    let curves: Vec<_> = shares.iter().map(curve).collect();
    let all = curves.iter().flat_map(|(_, points)| points);
    // A table of black dust has no light: its axes are any.
    let reach = all.map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max).max(1e-300);
    let ring = 10f64.powf(reach.log10().floor());
    let ring = if reach / ring > 4.0 {
        2.0 * ring
    } else if reach / ring > 2.0 {
        ring
    } else {
        0.5 * ring
    };
    let side = 1.12 * reach;
    let mut chart = ChartBuilder::on(area).margin(4).build_cartesian_2d(-side..side, -side..side)?;

    // Rings with their radius, and the axes.
    let grey = RGBColor(200, 200, 200);
    let round = |radius: f64| {
        (0..=180).map(move |i| 2.0 * PI * f64::from(i) / 180.0).map(move |a| (radius * a.cos(), radius * a.sin()))
    };
    for i in 1..=((side / ring) as usize).min(12) {
        let radius = ring * i as f64;
        chart.draw_series(LineSeries::new(round(radius), grey))?;
        let label = format!("{radius:.3}").trim_end_matches('0').to_owned();
        chart.draw_series([Text::new(
            label,
            (0.0, -radius),
            ("sans-serif", 11).into_font().color(&RGBColor(90, 90, 90)),
        )])?;
    }
    chart.draw_series([
        PathElement::new([(-side, 0.0), (side, 0.0)], grey),
        PathElement::new([(0.0, -side), (0.0, side)], grey),
    ])?;
    chart.draw_series([Text::new(caption.to_owned(), (-side, 0.98 * side), ("sans-serif", 14))])?;

    // The curves, and beside them their depths.
    for (i, (depth, points)) in curves.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        chart.draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))?;
        let y = side * (0.88 - 0.07 * i as f64);
        chart.draw_series([PathElement::new([(-side, y), (-0.88 * side, y)], colour.stroke_width(3))])?;
        chart.draw_series([Text::new(
            format!("{depth:.3}").trim_end_matches('0').trim_end_matches('.').to_owned(),
            (-0.86 * side, y + 0.025 * side),
            ("sans-serif", 13),
        )])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::table::{Accuracy, Parameters, shared};

    #[test]
    fn every_depth_has_its_curve_and_black_dust_has_axes_too() {
        for albedo in [0.6, 0.0] {
            let parameters = Parameters { albedo, depths: 11, directions: 12, ..Parameters::thesis().unwrap() };
            let accuracy = Accuracy { relative: None, photons: Some(1000), most_events: 1 << 30 };
            let table = shared::make(&parameters, &accuracy, 1, &mut |_| {}).unwrap().table;
            let drawing = svg(&table).unwrap();
            for colour in COLOURS {
                assert!(drawing.contains(&format!("#{:02X}{:02X}{:02X}", colour.0, colour.1, colour.2)));
            }
            assert!(!drawing.contains("NaN") && drawing.ends_with("</svg>\n"), "{}", &drawing[drawing.len() - 40..]);
        }
    }
}
