//! Diagrams: costs along a camera path, and functions.

use std::path::Path;

use plotters::prelude::*;

use crate::Outcome;

/// A way of drawing, and its milliseconds in each frame.
pub type Curve = (&'static str, Vec<f64>);

const COLORS: [RGBColor; 4] = [
    RGBColor(130, 130, 130),
    RGBColor(30, 110, 200),
    RGBColor(220, 120, 20),
    RGBColor(20, 150, 90),
];

/// A function as a line, and measured values as dots.
pub struct Function {
    pub name: String,
    pub line: Vec<(f64, f64)>,
    pub dots: Vec<(f64, f64)>,
}

/// Title and axes of a diagram.
struct Diagram<'a> {
    title: &'a str,
    legend: SeriesLabelPosition,
    axes: [&'a str; 2],
    /// Largest values of both axes, which begin at 0.
    most: [f64; 2],
    size: (u32, u32),
    colors: &'a [RGBColor],
}

/// Writes cost curves as one SVG diagram.
pub fn plot(title: &str, along: &str, curves: &[Curve], to: &Path) -> Outcome<()> {
    let most = curves.iter().flat_map(|(_, ms)| ms).copied().fold(0.0, f64::max);
    let last = curves.iter().map(|(_, ms)| ms.len()).max().unwrap_or(0).saturating_sub(1);
    let line = |(name, ms): &Curve| Function {
        name: (*name).to_owned(),
        line: ms.iter().enumerate().map(|(i, ms)| (i as f64, *ms)).collect(),
        dots: Vec::new(),
    };
    let diagram = Diagram {
        title,
        legend: SeriesLabelPosition::UpperLeft,
        axes: [along, "ms a frame"],
        most: [(last as f64).max(1.0), (1.1 * most).max(1.0e-3)],
        size: (720, 360),
        colors: &COLORS,
    };
    write(&diagram, &curves.iter().map(line).collect::<Vec<_>>(), to)
}

/// Writes functions as one SVG diagram from 0 on. `most` holds the largest values of both axes, and `axes` their names.
pub fn functions(
    (title, legend): (&str, SeriesLabelPosition),
    axes: [&str; 2],
    most: [f64; 2],
    all: &[Function],
    to: &Path,
) -> Outcome<()> {
    let (size, colors) = ((480, 320), &COLORS[1..]);
    write(&Diagram { title, legend, axes, most, size, colors }, all, to)
}

fn write(diagram: &Diagram<'_>, all: &[Function], to: &Path) -> Outcome<()> {
    draw(diagram, all, to).map_err(|error| format!("cannot write {}: {error}", to.display()))
}

fn draw(
    diagram: &Diagram<'_>,
    all: &[Function],
    to: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let Diagram { title, axes, most, .. } = diagram;
    let root = SVGBackend::new(to, diagram.size).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..most[0], 0.0..most[1])?;
    chart.configure_mesh().x_desc(axes[0]).y_desc(axes[1]).light_line_style(WHITE).draw()?;
    for (function, color) in all.iter().zip(diagram.colors.iter().copied()) {
        chart
            .draw_series(LineSeries::new(function.line.iter().copied(), color.stroke_width(2)))?
            .label(function.name.as_str())
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        let dots = function.dots.iter().filter(|(x, y)| *x <= most[0] && *y <= most[1]);
        chart.draw_series(dots.map(|dot| Circle::new(*dot, 3, color.filled())))?;
    }
    let legend = diagram.legend.clone();
    chart.configure_series_labels().position(legend).background_style(WHITE.mix(0.8)).draw()?;
    root.present()?;
    Ok(())
}
