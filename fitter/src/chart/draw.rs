//! The chart as CSV and as SVG.

use super::point::Point;
use anyhow::{Result, anyhow};
use plotters::prelude::*;
use std::collections::BTreeMap;

/// One row per point.
pub fn csv(points: &[Point]) -> Result<Vec<u8>> {
    let mut out = csv::Writer::from_writer(vec![]);
    out.write_record([
        "scheme",
        "rank",
        "bytes_per_chunk",
        "ns_per_direction",
        "error_median",
        "error_p95",
        "error_p99",
        "error_max",
    ])?;
    for p in points {
        out.write_record([
            p.scheme.clone(),
            p.rank.clone(),
            format!("{:.0}", p.bytes),
            p.nanoseconds.map_or(String::new(), |t| format!("{t:.0}")),
            format!("{:.6}", p.error.median),
            format!("{:.6}", p.error.p95),
            format!("{:.6}", p.error.p99),
            format!("{:.4}", p.error.max),
        ])?;
    }
    Ok(out.into_inner().map_err(|e| e.into_error())?)
}

const SIZE: (u32, u32) = (1080, 900);
/// Colours that stay apart for colour-blind readers (Okabe and Ito).
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(0, 114, 178),
    RGBColor(86, 180, 233),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(120, 120, 120),
];

/// Axes of a panel: a title, what stands on the horizontal and on the vertical axis.
type Panel = (
    &'static str,
    &'static str,
    fn(&Point) -> Option<f64>,
    fn(&Point) -> f64,
);

const PANELS: [Panel; 4] = [
    (
        "median error, %",
        "bytes per chunk",
        |p| Some(p.bytes),
        |p| 100.0 * p.error.median,
    ),
    (
        "99th percentile, %",
        "bytes per chunk",
        |p| Some(p.bytes),
        |p| 100.0 * p.error.p99,
    ),
    (
        "median error, %",
        "ns per direction",
        |p| p.nanoseconds,
        |p| 100.0 * p.error.median,
    ),
    (
        "99th percentile, %",
        "ns per direction",
        |p| p.nanoseconds,
        |p| 100.0 * p.error.p99,
    ),
];

/// Four panels: median and 99th percentile over bytes and over time.
pub fn svg(points: &[Point]) -> Result<String> {
    let mut out = String::new();
    {
        let root = SVGBackend::with_string(&mut out, SIZE).into_drawing_area();
        let failed = |e: &dyn std::fmt::Display| anyhow!("cannot draw the chart: {e}");
        root.fill(&WHITE).map_err(|e| failed(&e))?;
        for (area, panel) in root.split_evenly((2, 2)).iter().zip(&PANELS) {
            draw(area, panel, points).map_err(|e| failed(&e))?;
        }
        root.present().map_err(|e| failed(&e))?;
    }
    Ok(out)
}

fn draw<B: DrawingBackend>(
    area: &DrawingArea<B, plotters::coord::Shift>,
    (title, below, x, y): &Panel,
    points: &[Point],
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let shown: Vec<&Point> = points.iter().filter(|p| x(p).is_some()).collect();
    let range = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        (low / 1.4..high * 1.4).log_scale()
    };
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(*title, ("sans-serif", 17))
        .x_label_area_size(42)
        .y_label_area_size(52)
        .build_cartesian_2d(
            range(shown.iter().filter_map(|p| x(p)).collect()),
            range(shown.iter().map(|p| y(p)).collect()),
        )?;
    chart
        .configure_mesh()
        .x_desc(*below)
        .light_line_style(WHITE.mix(0.0))
        .draw()?;
    let mut schemes: BTreeMap<usize, Vec<&Point>> = BTreeMap::new();
    let names: Vec<&str> = unique(points);
    for point in shown {
        let k = names.iter().position(|n| *n == point.scheme).unwrap_or(0);
        schemes.entry(k).or_default().push(point);
    }
    for (k, points) in schemes {
        let colour = COLOURS[k % COLOURS.len()];
        let at: Vec<(f64, f64)> = points.iter().filter_map(|p| Some((x(p)?, y(p)))).collect();
        let series = chart.draw_series(LineSeries::new(at.iter().copied(), colour))?;
        series
            .label(names[k])
            .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        chart.draw_series(at.iter().zip(points).map(|(&place, p)| {
            EmptyElement::at(place)
                + Circle::new((0, 0), 4, colour.filled())
                + Text::new(p.rank.clone(), (6, -12), ("sans-serif", 11))
        }))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 11))
        .draw()?;
    Ok(())
}

fn unique(points: &[Point]) -> Vec<&str> {
    let mut names: Vec<&str> = vec![];
    for p in points {
        if !names.contains(&p.scheme.as_str()) {
            names.push(&p.scheme);
        }
    }
    names
}
