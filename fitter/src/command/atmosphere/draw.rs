//! Panels of curves as SVG.

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use welkin::output::printable;

const SIZE: (u32, u32) = (1500, 560);
/// Colours that stay apart for colour-blind readers (Okabe and Ito).
const COLOURS: [RGBColor; 8] = [
    RGBColor(86, 180, 233),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(0, 114, 178),
    RGBColor(230, 159, 0),
    RGBColor(120, 120, 120),
];

/// A named curve; the place among the series of a panel is its colour.
pub struct Series {
    pub name: String,
    pub points: Vec<(f64, f64)>,
}

impl Series {
    pub fn new(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: printable(&name.replace('_', " ")),
            points,
        }
    }
}

/// Curves on common axes.
pub struct Panel {
    pub title: &'static str,
    pub below: &'static str,
    pub beside: &'static str,
    pub x: (f64, f64),
    pub y: (f64, f64),
    /// Which axes are logarithmic.
    pub log: (bool, bool),
    pub series: Vec<Series>,
}

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// The panels side by side under a title.
pub fn svg(title: &str, panels: &[Panel]) -> Result<String> {
    let mut out = String::new();
    {
        let root = SVGBackend::with_string(&mut out, SIZE).into_drawing_area();
        let failed = |e: &dyn std::fmt::Display| anyhow!("cannot draw the plot: {e}");
        root.fill(&WHITE).map_err(|e| failed(&e))?;
        let root = root
            .titled(&printable(title), ("sans-serif", 24))
            .map_err(|e| failed(&e))?;
        for (area, panel) in root.split_evenly((1, panels.len())).iter().zip(panels) {
            draw(area, panel).map_err(|e| failed(&e))?;
        }
        root.present().map_err(|e| failed(&e))?;
    }
    Ok(out)
}

fn draw<B: DrawingBackend>(area: &DrawingArea<B, Shift>, panel: &Panel) -> Drawn<B> {
    let (x, y) = (panel.x.0..panel.x.1, panel.y.0..panel.y.1);
    match panel.log {
        (true, false) => on(area, panel, x.log_scale(), y),
        (false, false) => on(area, panel, x, y),
        (true, true) => on(area, panel, x.log_scale(), y.log_scale()),
        (false, true) => on(area, panel, x, y.log_scale()),
    }
}

fn on<B, X, Y>(
    area: &DrawingArea<B, Shift>,
    panel: &Panel,
    x: impl AsRangedCoord<Value = f64, CoordDescType = X>,
    y: impl AsRangedCoord<Value = f64, CoordDescType = Y>,
) -> Drawn<B>
where
    B: DrawingBackend,
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .caption(panel.title, ("sans-serif", 17))
        .x_label_area_size(42)
        .y_label_area_size(62)
        .build_cartesian_2d(x, y)?;
    let short = |v: &f64| match v.abs() {
        0.0 | 0.01..1e5 => format!("{}", rounded(*v)),
        _ => format!("{:e}", rounded(*v)),
    };
    chart
        .configure_mesh()
        .x_desc(panel.below)
        .y_desc(panel.beside)
        .x_label_formatter(&short)
        .y_label_formatter(&short)
        .light_line_style(WHITE.mix(0.0))
        .draw()?;
    for (k, series) in panel.series.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let within = |p: &&(f64, f64)| {
            (panel.x.0..=panel.x.1).contains(&p.0) && (panel.y.0..=panel.y.1).contains(&p.1)
        };
        let points: Vec<(f64, f64)> = series.points.iter().filter(within).copied().collect();
        if points.is_empty() {
            continue;
        }
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
            .label(series.name.clone())
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 13))
        .draw()
}

/// To three digits: powers of ten are not quite what they are in binary.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
