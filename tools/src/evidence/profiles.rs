//! Luminance and chromaticity along the sun's meridian, as plots.

use std::fmt::Write as _;

use super::entry::Entry;
use super::{Result, SUNS, table};
use crate::peers::colour::chromaticity;
use crate::peers::sky::Observer;

/// Size of a panel and where the first one stands.
const PANEL: [f64; 2] = [236.0, 190.0];
const ORIGIN: [f64; 2] = [56.0, 46.0];
const SPACING: [f64; 2] = [300.0, 240.0];
/// Lines of the legend under the panels.
const LEGEND: usize = 3;

/// Colour and dashes of a line.
fn style(key: &str) -> (&'static str, &'static str) {
    let dashes = if key.ends_with("-published") || key.ends_with("-raised") {
        "5 3"
    } else {
        ""
    };
    let colour = match key.split('-').next() {
        Some("welkin") => "#000000",
        Some("preetham") => "#d95f02",
        Some("hosek") => "#e6ab02",
        Some("cie") => "#999999",
        Some("wilkie") => "#7a3fc4",
        Some("nishita") => "#c51b7d",
        Some("bruneton") => "#1b6ca8",
        _ => "#4d9221",
    };
    (colour, dashes)
}

/// What is plotted over the angle from the zenith.
struct Quantity {
    name: &'static str,
    /// Of luminances in an own scale per panel, their logarithm.
    value: fn([f32; 3]) -> f64,
    logarithmic: bool,
    needs_colour: bool,
}

/// A line: angle from the zenith (degrees, positive away from the sun) and value.
type Line = Vec<(f64, f64)>;

/// Writes both plots.
///
/// # Errors
/// Where one cannot be written.
pub fn write(models: &[Entry]) -> Result<()> {
    let luminance = Quantity {
        name: "luminance, cd m⁻²",
        value: |xyz| f64::from(xyz[1]),
        logarithmic: true,
        needs_colour: false,
    };
    let x = Quantity {
        name: "chromaticity x",
        value: |xyz| f64::from(chromaticity(xyz)[0]),
        logarithmic: false,
        needs_colour: true,
    };
    let y = Quantity {
        name: "chromaticity y",
        value: |xyz| f64::from(chromaticity(xyz)[1]),
        ..x
    };
    table::write("luminance.svg", plot(models, &[luminance]).as_bytes())?;
    table::write("chromaticity.svg", plot(models, &[x, y]).as_bytes())
}

/// Light along the meridian, from the horizon below the sun to that opposite.
fn meridian(entry: &Entry, sun: f64) -> Vec<(f64, [f32; 3])> {
    let Some(sky) = entry.model.sky(Observer::on_the_ground(sun.to_radians())) else {
        return Vec::new();
    };
    let at = |i: i32| {
        let angle = f64::from(i).clamp(-89.5, 89.5);
        let (x, z) = (-angle).to_radians().sin_cos();
        let xyz = sky.xyz([x as f32, 0.0, z as f32])?;
        (xyz[1] > 0.0).then_some((angle, xyz))
    };
    (-90..=90).step_by(2).filter_map(at).collect()
}

fn plot(models: &[Entry], quantities: &[Quantity]) -> String {
    let rows = quantities.len() as f64;
    let width = ORIGIN[0] + SUNS.len() as f64 * SPACING[0];
    let height = ORIGIN[1] + rows * SPACING[1] + 20.0 * LEGEND as f64 + 4.0;
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">
<rect width="{width}" height="{height}" fill="#fff"/>
"##
    );
    for (i, sun) in SUNS.into_iter().enumerate() {
        let lights: Vec<_> = models
            .iter()
            .map(|entry| (entry, meridian(entry, sun)))
            .collect();
        for (j, quantity) in quantities.iter().enumerate() {
            let corner = [
                ORIGIN[0] + i as f64 * SPACING[0],
                ORIGIN[1] + j as f64 * SPACING[1],
            ];
            let lines: Vec<_> = lights
                .iter()
                .filter(|(entry, _)| entry.own_light || !quantity.needs_colour)
                .map(|(entry, light)| (entry.key, line(light, quantity)))
                .collect();
            panel(&mut svg, corner, quantity, sun, &lines);
        }
    }
    legend(&mut svg, models, ORIGIN[1] + rows * SPACING[1]);
    svg + "</svg>\n"
}

fn line(light: &[(f64, [f32; 3])], quantity: &Quantity) -> Line {
    let value = |&(angle, xyz): &(f64, [f32; 3])| {
        let value = (quantity.value)(xyz);
        (
            angle,
            if quantity.logarithmic {
                value.log10()
            } else {
                value
            },
        )
    };
    light.iter().map(value).collect()
}

/// The span of the values of the first line, with room for others that are near.
fn span(lines: &[(&str, Line)], logarithmic: bool) -> [f64; 2] {
    let first = lines.first().map_or(&[][..], |(_, line)| line);
    let [low, high] = first
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v.1), high.max(v.1)]
        });
    let room = if logarithmic { 0.45 } else { 0.03 };
    [low - room, high + room]
}

fn panel(
    svg: &mut String,
    [left, top]: [f64; 2],
    quantity: &Quantity,
    sun: f64,
    lines: &[(&str, Line)],
) {
    let [low, high] = span(lines, quantity.logarithmic);
    let x = |angle: f64| left + PANEL[0] * (angle + 90.0) / 180.0;
    let y = |value: f64| top + PANEL[1] * (high - value) / (high - low);
    let bottom = top + PANEL[1];
    let sun = sun.to_string().replace('-', "−");
    let _ = writeln!(
        svg,
        r##"<text x="{left}" y="{:.1}" font-weight="bold">{}, sun {sun}°</text>
<clipPath id="p{left:.0}-{top:.0}"><rect x="{left}" y="{top}" width="{}" height="{}"/></clipPath>"##,
        top - 10.0,
        quantity.name,
        PANEL[0],
        PANEL[1],
    );
    for angle in [-90, -45, 0, 45, 90] {
        let (at, label) = (x(f64::from(angle)), angle.to_string().replace('-', "−"));
        let _ = writeln!(
            svg,
            r##"<path d="M{at:.1} {top}V{bottom}" stroke="#ddd"/><text x="{at:.1}" y="{:.1}" text-anchor="middle">{label}°</text>"##,
            bottom + 15.0
        );
    }
    for (value, label) in ticks([low, high], quantity.logarithmic) {
        let at = y(value);
        let _ = writeln!(
            svg,
            r##"<path d="M{left} {at:.1}h{}" stroke="#ddd"/><text x="{:.1}" y="{:.1}" text-anchor="end">{label}</text>"##,
            PANEL[0],
            left - 3.0,
            at + 4.0
        );
    }
    // The first last, so that it is seen.
    for (key, line) in lines.iter().rev() {
        let (colour, dashes) = style(key);
        let points: Vec<String> = line
            .iter()
            .map(|&(a, v)| format!("{:.1},{:.1}", x(a), y(v)))
            .collect();
        let _ = writeln!(
            svg,
            r##"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dashes}" clip-path="url(#p{left:.0}-{top:.0})"/>"##,
            points.join(" ")
        );
    }
}

/// Values of the lines of the grid and what is written at them.
fn ticks([low, high]: [f64; 2], logarithmic: bool) -> Vec<(f64, String)> {
    if !logarithmic {
        let hundredths = (100.0 * low).ceil() as i32..=(100.0 * high).floor() as i32;
        let step = if hundredths.clone().count() > 12 {
            5
        } else {
            2
        };
        return hundredths
            .filter(|h| h % step == 0)
            .map(|h| (f64::from(h) / 100.0, format!("{:.2}", f64::from(h) / 100.0)))
            .collect();
    }
    let decades = low.floor() as i32..=high.ceil() as i32;
    decades
        .flat_map(|decade| [1.0, 2.0, 5.0].map(|m: f64| m * 10f64.powi(decade)))
        .filter(|v| (low..=high).contains(&v.log10()))
        .map(|v| {
            let label = match v {
                v if v >= 1e4 => format!("{:.0}k", v / 1e3),
                v if v >= 1.0 => format!("{v:.0}"),
                v => format!("{v:.3}").trim_end_matches('0').to_owned(),
            };
            (v.log10(), label)
        })
        .collect()
}

fn legend(svg: &mut String, models: &[Entry], top: f64) {
    for (i, entry) in models.iter().enumerate() {
        let (colour, dashes) = style(entry.key);
        let note = if entry.was_run() { "" } else { " (not run)" };
        let (x, y) = (
            ORIGIN[0] + (i / LEGEND) as f64 * 330.0,
            top + 20.0 * (i % LEGEND) as f64,
        );
        let _ = writeln!(
            svg,
            r##"<path d="M{x} {y}h34" stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"/><text x="{}" y="{}">{}{note}</text>"##,
            x + 40.0,
            y + 4.0,
            entry.name
        );
    }
}
