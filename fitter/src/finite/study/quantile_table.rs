//! Quantiles of the errors of each method, by kind of segment.

use super::method::{Lights, METHODS, Method};
use super::segment_case::Case;
use crate::assess::Quantiles;
use crate::successive_orders::scattered_source::Stokes;
use std::fmt::Write;

/// Errors of one method for one kind of segment.
#[derive(Clone, Debug)]
pub struct Row {
    /// The method.
    pub method: Method,
    /// Kind of segment.
    pub class: &'static str,
    /// Segments.
    pub segments: usize,
    /// Of the relative error, all wavelengths.
    pub quantiles: Quantiles,
    /// Share of values below zero before they are cut off.
    pub negative: f64,
}

type Belongs = fn(&Case) -> bool;

/// Kinds of segments.
pub(super) const CLASSES: [(&str, Belongs); 4] = [
    ("day, near the horizon", |c| {
        c.sun >= 0.0 && c.near_horizon()
    }),
    ("day, elsewhere", |c| c.sun >= 0.0 && !c.near_horizon()),
    ("twilight, near the horizon", |c| {
        c.sun < 0.0 && c.near_horizon()
    }),
    ("twilight, elsewhere", |c| c.sun < 0.0 && !c.near_horizon()),
];

/// Rows of all methods. `light` holds the results of every method per case, in the order of [`METHODS`].
pub fn rows(cases: &[Case], truth: &[Stokes], light: &[Lights]) -> Vec<Row> {
    let mut out = vec![];
    for (class, belongs) in CLASSES {
        for (m, method) in METHODS.into_iter().enumerate() {
            let mut errors = vec![];
            let (mut segments, mut negative) = (0, 0);
            for ((case, truth), light) in cases.iter().zip(truth).zip(light) {
                let Some(light) = light[m].filter(|_| belongs(case)) else {
                    continue;
                };
                segments += 1;
                for (got, exact) in light.iter().zip(&truth[0]) {
                    negative += usize::from(*got < 0.0);
                    errors.push(f64::from((got.max(0.0) / exact - 1.0).abs()));
                }
            }
            let share = negative as f64 / errors.len().max(1) as f64;
            if let Some(quantiles) = Quantiles::of(errors.into_iter()) {
                out.push(Row {
                    method,
                    class,
                    segments,
                    quantiles,
                    negative: share,
                });
            }
        }
    }
    out
}

/// As a table in Markdown, per cent.
pub fn table(rows: &[Row]) -> String {
    let mut out = String::from(
        "| segments | method | number | median | p95 | p99 | max | negative |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for row in rows {
        let q = &row.quantiles;
        let [median, p95, p99, max] = [q.median, q.p95, q.p99, q.max].map(|v| 100.0 * v);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {median:.2} % | {p95:.2} % | {p99:.2} % | {max:.1} % | {:.2} % |",
            row.class,
            row.method.name(),
            row.segments,
            100.0 * row.negative
        );
    }
    out
}

/// As comma-separated values, shares.
pub fn csv(rows: &[Row]) -> String {
    let mut out = String::from("class,method,segments,median,p95,p99,max,negative\n");
    for row in rows {
        let q = &row.quantiles;
        let _ = writeln!(
            out,
            "\"{}\",\"{}\",{},{},{},{},{},{}",
            row.class,
            row.method.name(),
            row.segments,
            q.median,
            q.p95,
            q.p99,
            q.max,
            row.negative
        );
    }
    out
}
