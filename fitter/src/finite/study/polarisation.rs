//! How far the polarisation of in-scattered light is from exact integrals.

use super::method::Methods;
use super::quantile_table::CLASSES;
use super::segment_case::Case;
use crate::assess::Quantiles;
use crate::polarimetry::difference;
use crate::successive_orders::NW;
use crate::successive_orders::scattered_source::Stokes;
use anyhow::Result;
use rayon::prelude::*;
use std::fmt::Write;
use welkin::{PolarisationFrame, StokesSpectra};

/// Errors of the polarisation for one kind of segment, all wavelengths.
#[derive(Clone, Debug)]
pub struct PolarisedRow {
    /// Kind of segment.
    pub class: &'static str,
    /// Of the degree of linear polarisation.
    pub degree: Quantiles,
    /// Of the angle, degrees, where the light is more than 5 % polarised.
    pub angle: Option<Quantiles>,
    /// Median degree of the exact light.
    pub typical: f64,
}

/// Rows of all kinds of segments; `truth` holds the exact light of the cases.
pub fn polarised_rows(
    methods: &Methods,
    cases: &[Case],
    truth: &[Stokes],
) -> Result<Vec<PolarisedRow>> {
    let pairs = cases.par_iter().zip(truth);
    let errors = pairs
        .map(|(case, truth)| Ok(compare(&stokes(methods, case)?, truth)))
        .collect::<Result<Vec<_>>>()?;
    let mut out = vec![];
    for (class, belongs) in CLASSES {
        let class_errors = || {
            let pairs = cases.iter().zip(&errors);
            pairs.filter(|(case, _)| belongs(case)).flat_map(|(_, e)| e)
        };
        let degree = Quantiles::of(class_errors().map(|e| e.degree));
        let typical = Quantiles::of(class_errors().map(|e| e.exact));
        if let (Some(degree), Some(typical)) = (degree, typical) {
            out.push(PolarisedRow {
                class,
                degree,
                angle: Quantiles::of(class_errors().filter_map(|e| e.angle)),
                typical: typical.median,
            });
        }
    }
    Ok(out)
}

struct Error {
    degree: f64,
    angle: Option<f64>,
    exact: f64,
}

fn compare(got: &Stokes, truth: &Stokes) -> Vec<Error> {
    let at = |light: &Stokes, w: usize| [0, 1, 2].map(|part: usize| f64::from(light[part][w]));
    let lit = (0..NW).filter(|&w| truth[0][w] > 0.0);
    lit.map(|w| {
        let exact = at(truth, w);
        let (degree, angle) = difference(at(got, w), exact);
        Error {
            degree,
            angle,
            exact: exact[1].hypot(exact[2]) / exact[0],
        }
    })
    .collect()
}

fn stokes(methods: &Methods, case: &Case) -> Result<Stokes> {
    let [from, to] = case.ends();
    let [mut i, mut q, mut u, mut through] = [[0.0; NW]; 4];
    let out = StokesSpectra {
        i: &mut i,
        q: &mut q,
        u: &mut u,
    };
    let aerial = methods.aerial(case)?;
    aerial.in_scattering_stokes(from, to, PolarisationFrame::Vertical, out, &mut through)?;
    Ok([i, q, u])
}

/// As a table in Markdown.
pub fn polarised_table(rows: &[PolarisedRow]) -> String {
    let mut out = String::from(
        "| segments | degree (median) | its error: median | p95 | p99 | max | angle p95 | p99 |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for row in rows {
        let q = &row.degree;
        let [p95, p99] = row.angle.as_ref().map_or([f64::NAN; 2], |a| [a.p95, a.p99]);
        let _ = writeln!(
            out,
            "| {} | {:.2} | {:.4} | {:.4} | {:.4} | {:.3} | {p95:.2}° | {p99:.2}° |",
            row.class, row.typical, q.median, q.p95, q.p99, q.max
        );
    }
    out
}
