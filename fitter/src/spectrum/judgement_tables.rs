//! Judgements as tables, all CSV.

use super::judge::{Colour, Difference, Judgement};
use crate::assess::Quantiles;
use std::fmt::Write;

/// A class of suns: its name, and which elevations (rad) belong to it.
pub type SunClass = (&'static str, fn(f64) -> bool);

/// Classes that are reported apart.
pub const SUNS: [SunClass; 3] = [
    ("sun above 12°", |e| e >= 0.209_44),
    ("sun at 0..12°", |e| (0.0..0.209_44).contains(&e)),
    ("twilight", |e| e < 0.0),
];

/// Width of the bands of a table, nm.
const BAND: f64 = 20.0;

/// CSV with quantiles by quantity, sun and 20 nm; `unit` 1e-2 gives percent.
pub fn csv(judgement: &Judgement) -> String {
    let mut out = String::from("quantity,sun,from_nm,to_nm,values,median,p95,p99,max\n");
    let quantities = [
        ("radiance", &judgement.radiance),
        ("degree of linear polarisation", &judgement.degree),
        ("in-scattering", &judgement.in_scattering),
        ("transmittance", &judgement.transmittance),
    ];
    for (name, all) in quantities {
        for (sun, belongs) in SUNS {
            let class: Vec<&Difference> = all.iter().filter(|d| belongs(d.sun)).collect();
            let last = class.iter().map(|d| d.wavelength).fold(0.0, f64::max);
            let first = class.iter().map(|d| d.wavelength).fold(f64::MAX, f64::min);
            let mut from = BAND * (first / BAND).floor();
            row(
                &mut out,
                (name, sun),
                [first, last],
                class.iter().map(|d| d.error),
            );
            while from <= last {
                let band = |d: &&&Difference| (from..from + BAND).contains(&d.wavelength);
                let errors = class.iter().filter(band).map(|d| d.error);
                row(&mut out, (name, sun), [from, from + BAND], errors);
                from += BAND;
            }
        }
    }
    for (sun, belongs) in SUNS {
        let class = judgement
            .colour
            .iter()
            .filter(|c| belongs(c.sun))
            .map(|c| c.difference);
        row(&mut out, ("colour (ΔE00)", sun), [360.0, 830.0], class);
    }
    out
}

fn row(
    out: &mut String,
    (name, sun): (&str, &str),
    [from, to]: [f64; 2],
    errors: impl Iterator<Item = f64>,
) {
    if let Some(q) = Quantiles::of(errors) {
        let Quantiles {
            count,
            median,
            p95,
            p99,
            max,
        } = q;
        let _ = writeln!(
            out,
            "{name},{sun},{from},{to},{count},{median:.6},{p95:.6},{p99:.6},{max:.6}"
        );
    }
}

/// Rows of a page: radiance by 20 nm, median and p95 per class of suns.
pub fn bands(judgement: &Judgement) -> String {
    let classes = SUNS
        .map(|(name, _)| format!("{name}: median,p95,p99"))
        .join(",");
    let mut out = format!("radiance at,{classes}\n");
    let wavelengths = || judgement.radiance.iter().map(|d| d.wavelength);
    let last = wavelengths().fold(0.0, f64::max);
    let mut from = BAND * (wavelengths().fold(f64::MAX, f64::min) / BAND).floor();
    while from <= last {
        let band = |d: &&Difference| (from..from + BAND).contains(&d.wavelength);
        let cells = SUNS.map(|(_, belongs)| {
            let class = judgement
                .radiance
                .iter()
                .filter(band)
                .filter(|d| belongs(d.sun));
            percentages(Quantiles::of(class.map(|d| d.error)))
        });
        out += &format!("{from}..{} nm,{}\n", from + BAND, cells.join(","));
        from += BAND;
    }
    out
}

fn percentages(q: Option<Quantiles>) -> String {
    let Some(q) = q else {
        return ",,".into();
    };
    [q.median, q.p95, q.p99]
        .map(|v| two_digits(100.0 * v, " %"))
        .join(",")
}

fn two_digits(value: f64, unit: &str) -> String {
    let decimals = (1.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0);
    format!("{value:.*}{unit}", decimals as usize)
}

/// Rows of a page: all quantities over visible light and over all, by day and in twilight.
pub fn summary(judgement: &Judgement) -> String {
    let mut out = String::from("held out between the nodes,median,p95,p99,max\n");
    let quantities = [
        ("radiance", &judgement.radiance, 100.0, " %"),
        ("degree of linear polarisation", &judgement.degree, 1.0, ""),
        (
            "in-scattering of segments",
            &judgement.in_scattering,
            100.0,
            " %",
        ),
        (
            "transmittance of segments",
            &judgement.transmittance,
            1.0,
            "",
        ),
    ];
    let days: [SunClass; 2] = [("day", |e| e >= 0.0), ("twilight", |e| e < 0.0)];
    for (name, all, scale, unit) in quantities {
        for (sun, belongs) in days {
            for (range, [from, to]) in [("300..760 nm", [300.0, 760.0]), ("beyond", [760.0, 9e9])] {
                let inside =
                    |d: &&Difference| belongs(d.sun) && (from..=to).contains(&d.wavelength);
                let errors = all.iter().filter(inside).map(|d| d.error);
                if let Some(q) = Quantiles::of(errors) {
                    let cells =
                        [q.median, q.p95, q.p99, q.max].map(|v| two_digits(scale * v, unit));
                    out += &format!("\"{name}, {range}, {sun}\",{}\n", cells.join(","));
                }
            }
        }
    }
    for (sun, belongs) in days {
        let colours = judgement
            .colour
            .iter()
            .filter(|c| belongs(c.sun))
            .map(|c| c.difference);
        if let Some(q) = Quantiles::of(colours) {
            let cells = [q.median, q.p95, q.p99, q.max].map(|v| two_digits(v, ""));
            out += &format!("\"ΔE00 of XYZ, {sun}\",{}\n", cells.join(","));
        }
    }
    out
}

/// Luminance of the night sky without sun and moon, cd/m²: what the sun adds is seen before it.
const NIGHT: f64 = 2e-4;
/// Bands of solar elevation of luminances, degrees.
const LUMINANCE_SUNS: [(f64, f64); 6] = [
    (12.0, 90.0),
    (0.0, 12.0),
    (-4.2, 0.0),
    (-6.0, -4.2),
    (-9.0, -6.0),
    (-12.0, -9.0),
];

/// Rows of a page: luminances and their errors, relative, absolute, and relative to them and a night sky together.
pub fn luminance(judgement: &Judgement) -> String {
    let mut out = String::from(
        "sun at,cd/m²: p5,median,p95,error: median,p95,max,in cd/m²: p95,max,with night: p95,max\n",
    );
    for (low, high) in LUMINANCE_SUNS {
        let inside = |c: &&Colour| (low..high).contains(&c.sun.to_degrees());
        let class: Vec<[f64; 2]> = judgement
            .colour
            .iter()
            .filter(inside)
            .map(|c| c.luminance)
            .collect();
        let errors = |by: &dyn Fn(f64) -> f64| {
            let errors = class
                .iter()
                .map(|[want, got]| (got - want).abs() / by(*want));
            Quantiles::of(errors)
        };
        let parts = (
            errors(&|want| want),
            errors(&|_| 1.0),
            errors(&|want| want + NIGHT),
        );
        let (Some(relative), Some(absolute), Some(seen)) = parts else {
            continue;
        };
        let mut bright: Vec<f64> = class.iter().map(|[want, _]| *want).collect();
        bright.sort_by(f64::total_cmp);
        let at = |q: f64| bright[(q * (bright.len() - 1) as f64).round() as usize];
        let cells = [0.05, 0.5, 0.95].map(|q| candela(at(q)));
        let percent =
            |q: &[f64]| -> Vec<String> { q.iter().map(|v| two_digits(100.0 * v, " %")).collect() };
        let cells: Vec<String> = cells
            .into_iter()
            .chain(percent(&[relative.median, relative.p95, relative.max]))
            .chain([absolute.p95, absolute.max].map(candela))
            .chain(percent(&[seen.p95, seen.max]))
            .collect();
        out += &format!("{low}..{high}°,{}\n", cells.join(","));
    }
    out
}

/// Two digits.
fn candela(value: f64) -> String {
    let power = value.abs().max(1e-30).log10().floor();
    if (-3.0..4.0).contains(&power) {
        return two_digits(value, "");
    }
    format!("{value:.1e}")
}
