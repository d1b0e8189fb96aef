//! A study as an SVG: a panel for each case, error against time, both logarithmic, one line for each method.

use plotters::prelude::*;

use super::{Measurement, Study};

/// Why there is no plot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the plot could not be drawn: {0}")]
pub struct PlotError(pub(super) String);

/// Size of a panel, pixels.
const PANEL: (u32, u32) = (360, 270);

/// Height of the title above the panels, pixels.
const TITLE: u32 = 60;

/// Errors below this are drawn here: they are those of the reference's last digits.
const LEAST_ERROR: f64 = 1e-9;

/// Colours that colour-blind readers tell apart. Source: Okabe & Ito (2008), "Color universal design".
pub(super) const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Draws the measurements: a row of panels for each group of cases.
///
/// # Errors
/// The drawing library failed.
pub fn svg(study: &Study<'_>, measurements: &[Measurement]) -> Result<String, PlotError> {
    let mut text = String::new();
    draw(study, measurements, &mut text).map_err(|error| PlotError(error.to_string()))?;
    Ok(text)
}

fn draw(study: &Study<'_>, measurements: &[Measurement], text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let mut groups: Vec<&str> = study.cases.iter().map(|case| case.group.as_str()).collect();
    groups.dedup();
    let columns = groups.iter().map(|g| study.cases.iter().filter(|c| c.group == *g).count()).max().unwrap_or(1);
    let mut methods: Vec<&str> = Vec::new();
    for contender in &study.contenders {
        if !methods.contains(&contender.method) {
            methods.push(contender.method);
        }
    }

    // The whole picture: white, a title, a legend.
    let size = (PANEL.0 * columns as u32, PANEL.1 * groups.len() as u32 + TITLE);
    let root = SVGBackend::with_string(text, size).into_drawing_area();
    root.fill(&WHITE)?;
    root.draw(&Text::new(study.title, (10, 8), ("sans-serif", 20)))?;
    for (i, method) in methods.iter().enumerate() {
        let x = 10 + 150 * i as i32;
        root.draw(&Circle::new((x + 5, 44), 4, COLOURS[i % COLOURS.len()].filled()))?;
        root.draw(&Text::new((*method).to_owned(), (x + 15, 37), ("sans-serif", 14)))?;
    }

    // One panel a case, all with the same axes.
    let (_, below) = root.split_vertically(TITLE);
    let panels = below.split_evenly((groups.len(), columns));
    let points: Vec<(f64, f64)> = measurements.iter().filter_map(point).collect();
    let bounds = |of: fn(&(f64, f64)) -> f64| {
        let (least, most) = points.iter().map(of).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        10f64.powf(least.log10().floor())..10f64.powf(most.log10().ceil())
    };
    let (x_range, y_range) = (bounds(|p| p.0), bounds(|p| p.1));
    for (row, group) in groups.iter().enumerate() {
        for (column, case) in study.cases.iter().filter(|case| case.group == *group).enumerate() {
            let mut chart = ChartBuilder::on(&panels[row * columns + column])
                .caption(format!("{group}, {}", case.name), ("sans-serif", 14))
                .margin(8)
                .x_label_area_size(34)
                .y_label_area_size(58)
                .build_cartesian_2d(x_range.clone().log_scale(), y_range.clone().log_scale())?;
            chart
                .configure_mesh()
                .light_line_style(TRANSPARENT)
                .x_desc("time for one answer, us")
                .y_desc(format!("error, {}", study.unit))
                .x_label_formatter(&|x| format!("{x}"))
                .y_label_formatter(&|y| format!("{y:.0e}"))
                .draw()?;
            for (i, method) in methods.iter().enumerate() {
                let colour = COLOURS[i % COLOURS.len()];
                let line: Vec<(f64, f64)> = measurements
                    .iter()
                    .filter(|m| m.group == *group && m.case == case.name && m.method == *method)
                    .filter_map(point)
                    .collect();
                chart.draw_series(LineSeries::new(line.clone(), colour.stroke_width(2)))?;
                chart.draw_series(line.into_iter().map(|at| Circle::new(at, 3, colour.filled())))?;
            }
        }
    }
    root.present()?;
    Ok(())
}

/// Time and size of the error.
fn point(measurement: &Measurement) -> Option<(f64, f64)> {
    measurement.error.map(|error| (measurement.time_us, error.abs().max(LEAST_ERROR)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Answer, Case, Contender};

    #[test]
    fn every_case_has_a_panel_and_every_method_a_line() {
        let case = |name: &str| Case { group: "air".to_owned(), name: name.to_owned(), reference: 1.0 };
        let contender = |method, setting: &str| Contender {
            method,
            setting: setting.to_owned(),
            answer: Box::new(|_| Some(Answer { value: 1.5, believed: 0.0, steps: 1 })),
        };
        let study = Study {
            title: "errors",
            unit: "arcsec",
            cases: vec![case("low"), case("high")],
            contenders: vec![contender("first", "a"), contender("first", "b"), contender("second", "a")],
        };
        let clock = std::cell::Cell::new(0u64);
        let measured = crate::report::measure(&study, &|| {
            clock.set(clock.get() + 1);
            std::time::Duration::from_millis(clock.get())
        });
        let svg = svg(&study, &measured).unwrap();
        for word in ["air, low", "air, high", "first", "second", "</svg>"] {
            assert!(svg.contains(word), "{word}");
        }
        // A dot for each of the 3 settings in 2 panels, and 2 in the legend.
        assert_eq!(svg.matches("<circle").count(), 8);
    }
}
