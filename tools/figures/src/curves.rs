//! Curves: of cost over a camera's way, and of functions.

use std::path::Path;

use plotters::prelude::*;

use crate::Outcome;

/// A way to draw and its milliseconds, frame by frame.
pub type Curve = (&'static str, Vec<f64>);

const COLORS: [RGBColor; 4] = [
    RGBColor(130, 130, 130),
    RGBColor(30, 110, 200),
    RGBColor(220, 120, 20),
    RGBColor(20, 150, 90),
];

/// Curves in one diagram, as SVG.
pub fn plot(title: &str, along: &str, curves: &[Curve], to: &Path) -> Outcome<()> {
    let most = curves.iter().flat_map(|(_, ms)| ms).copied().fold(0.0, f64::max);
    let last = curves.iter().map(|(_, ms)| ms.len()).max().unwrap_or(0).saturating_sub(1);
    draw(title, along, curves, last as f64, 1.1 * most, to)
        .map_err(|error| format!("cannot write {}: {error}", to.display()))
}

fn draw(
    title: &str,
    along: &str,
    curves: &[Curve],
    last: f64,
    most: f64,
    to: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::new(to, (720, 360)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..last.max(1.0), 0.0..most.max(1.0e-3))?;
    chart.configure_mesh().x_desc(along).y_desc("ms a frame").light_line_style(WHITE).draw()?;
    for ((name, ms), color) in curves.iter().zip(COLORS) {
        let points = ms.iter().enumerate().map(|(i, ms)| (i as f64, *ms));
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .draw()?;
    root.present()?;
    Ok(())
}

/// A function as a line, and what was drawn by it as dots.
pub struct Function {
    pub name: String,
    pub line: Vec<(f64, f64)>,
    pub dots: Vec<(f64, f64)>,
}

/// Functions in one diagram from 0 on, as SVG; `most`: of both axes, whose names are `axes`.
pub fn functions(
    (title, legend): (&str, SeriesLabelPosition),
    axes: [&str; 2],
    most: [f64; 2],
    all: &[Function],
    to: &Path,
) -> Outcome<()> {
    draw_functions((title, legend), axes, most, all, to)
        .map_err(|error| format!("cannot write {}: {error}", to.display()))
}

fn draw_functions(
    (title, legend): (&str, SeriesLabelPosition),
    axes: [&str; 2],
    most: [f64; 2],
    all: &[Function],
    to: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::new(to, (480, 320)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..most[0], 0.0..most[1])?;
    chart.configure_mesh().x_desc(axes[0]).y_desc(axes[1]).light_line_style(WHITE).draw()?;
    for (function, color) in all.iter().zip(COLORS.into_iter().skip(1)) {
        chart
            .draw_series(LineSeries::new(function.line.iter().copied(), color.stroke_width(2)))?
            .label(function.name.as_str())
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        let dots = function.dots.iter().filter(|(x, y)| *x <= most[0] && *y <= most[1]);
        chart.draw_series(dots.map(|dot| Circle::new(*dot, 3, color.filled())))?;
    }
    chart.configure_series_labels().position(legend).background_style(WHITE.mix(0.8)).draw()?;
    root.present()?;
    Ok(())
}
