//! Charts as SVG.

use super::g173::Band;
use anyhow::{Result, anyhow};
use plotters::prelude::*;
use std::ops::Range;

/// Colours that stay apart for colour-blind readers (Okabe and Ito).
const COLOURS: [RGBColor; 4] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
];

/// A name and its points.
pub type Line = (String, Vec<(f64, f64)>);

/// Lines in a panel.
struct Panel<'a> {
    title: &'a str,
    /// What stands on the axes.
    axes: [&'a str; 2],
    x: Range<f64>,
    y: Range<f64>,
    lines: &'a [Line],
}

/// Direct and global irradiance before the reference, one above the other.
pub fn g173(bands: &[Band]) -> Result<String> {
    let steps = |value: fn(&Band) -> f64| -> Vec<(f64, f64)> {
        let ends = bands
            .iter()
            .flat_map(|b| [b.from, b.from + 40.0].map(|x| (x, value(b))));
        ends.collect()
    };
    let direct = [
        ("ASTM G173, direct".to_owned(), steps(|b| b.direct[0])),
        ("welkin's air".to_owned(), steps(|b| b.direct[1])),
    ];
    let global = [
        (
            "ASTM G173, global on 37°".to_owned(),
            steps(|b| b.global[0]),
        ),
        ("welkin's air".to_owned(), steps(|b| b.global[1])),
    ];
    let panel = |lines| Panel {
        title: "means over 40 nm, W m⁻² nm⁻¹",
        axes: ["nm", ""],
        x: 300.0..2500.0,
        y: 0.0..1.8,
        lines,
    };
    draw((1000, 760), &[panel(&direct), panel(&global)])
}

/// Error (%) against the number of nodes, for ranges of wavelengths.
pub fn nodes(lines: &[Line]) -> Result<String> {
    let last = lines
        .iter()
        .flat_map(|l| &l.1)
        .map(|p| p.0)
        .fold(0.0, f64::max);
    let panel = Panel {
        title: "error of radiance between nodes by day, p95, %",
        axes: ["nodes", "%"],
        x: 9.0..last + 1.0,
        y: 0.0..8.0,
        lines,
    };
    draw((800, 480), &[panel])
}

fn draw(size: (u32, u32), panels: &[Panel]) -> Result<String> {
    let mut out = String::new();
    {
        let root = SVGBackend::with_string(&mut out, size).into_drawing_area();
        let failed = |e: &dyn std::fmt::Display| anyhow!("cannot draw the chart: {e}");
        root.fill(&WHITE).map_err(|e| failed(&e))?;
        for (area, panel) in root.split_evenly((panels.len(), 1)).iter().zip(panels) {
            one(area, panel).map_err(|e| failed(&e))?;
        }
        root.present().map_err(|e| failed(&e))?;
    }
    Ok(out)
}

fn one<B: DrawingBackend>(
    area: &DrawingArea<B, plotters::coord::Shift>,
    panel: &Panel,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(panel.title, ("sans-serif", 17))
        .x_label_area_size(38)
        .y_label_area_size(44)
        .build_cartesian_2d(panel.x.clone(), panel.y.clone())?;
    chart
        .configure_mesh()
        .x_desc(panel.axes[0])
        .y_desc(panel.axes[1])
        .draw()?;
    for ((name, points), colour) in panel.lines.iter().zip(COLOURS) {
        let style = colour.stroke_width(2);
        chart
            .draw_series(LineSeries::new(points.iter().copied(), style))?
            .label(name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE)
        .draw()
}
