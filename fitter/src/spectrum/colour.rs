//! CIE XYZ from the nodes, fitted to integrals over 1 nm.

use super::weights::Taps;
use super::weights::value;
use crate::atmosphere::table::{Curve, Table};
use crate::non_negative::least_squares;
use anyhow::Result;

/// Luminous efficacy in the definition of XYZ, lm/W.
const EFFICACY: f64 = 683.0;
/// Wavelengths of the matching functions, nm.
const RANGE: std::ops::RangeInclusive<u32> = 360..=830;

/// Whether light of this wavelength (nm) makes a colour.
pub fn sees(wavelength: f64) -> bool {
    (f64::from(*RANGE.start())..=f64::from(*RANGE.end())).contains(&wavelength)
}

/// Solar irradiance times the CIE 1931 matching functions, at every nanometre.
pub struct Observer {
    sun: Curve,
    matching: [Curve; 3],
}

impl Observer {
    /// From the tables in `fitter/data`.
    pub fn new() -> Result<Self> {
        let solar = include_str!("../../data/solar_irradiance_1nm.csv");
        let matching = include_str!("../../data/cie1931_2deg_1nm.csv");
        let sun = Table::parse("solar_irradiance_1nm.csv", solar)?;
        let observer = Table::parse("cie1931_2deg_1nm.csv", matching)?;
        let curve = |name: &str| observer.curve("wavelength_nm", name);
        Ok(Self {
            sun: sun.curve("wavelength_nm", "g173")?,
            matching: [curve("xbar")?, curve("ybar")?, curve("zbar")?],
        })
    }

    /// XYZ of radiance per unit of solar irradiance.
    pub fn xyz(&self, relative: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut out = [0.0; 3];
        for nm in RANGE.map(f64::from) {
            let light = EFFICACY * self.sun.at(nm) * relative(nm);
            for (sum, curve) in out.iter_mut().zip(&self.matching) {
                *sum += light * curve.at(nm);
            }
        }
        out
    }
}

/// ln L at any wavelength between cells.
pub fn between(wavelengths: &[f64], logarithms: &[f64], nm: f64) -> f64 {
    let upper = wavelengths
        .partition_point(|&w| w <= nm)
        .clamp(1, wavelengths.len() - 1);
    let (a, b) = (wavelengths[upper - 1], wavelengths[upper]);
    let t = (nm - a) / (b - a);
    logarithms[upper - 1] + t * (logarithms[upper] - logarithms[upper - 1])
}

/// Weights `[node][X, Y, Z]` that make XYZ of relative radiance at the nodes, for skies of which ln L of the cells is
/// `cells[sky][cell]` and L of the nodes `nodes[sky][node]`. None is negative, so that no colour can be.
pub fn weights(
    observer: &Observer,
    wavelengths: &[f64],
    cells: &[Vec<f64>],
    nodes: &[Vec<f64>],
) -> Vec<[f64; 3]> {
    let xyz: Vec<[f64; 3]> = cells
        .iter()
        .map(|sky| observer.xyz(|nm| between(wavelengths, sky, nm).exp()))
        .collect();
    let mut out = vec![[0.0; 3]; nodes[0].len()];
    for c in 0..3 {
        let relative =
            |(row, xyz): (&Vec<f64>, &[f64; 3])| row.iter().map(|l| l / xyz[c]).collect();
        let rows: Vec<Vec<f64>> = nodes.iter().zip(&xyz).map(relative).collect();
        // In units of the largest entry, so that all columns weigh alike.
        let scale: Vec<f64> = (0..out.len())
            .map(|n| rows.iter().map(|r: &Vec<f64>| r[n]).fold(1e-300, f64::max))
            .collect();
        let scaled: Vec<Vec<f64>> = rows
            .iter()
            .map(|r| r.iter().zip(&scale).map(|(v, s)| v / s).collect())
            .collect();
        let found = least_squares(&scaled, &vec![1.0; rows.len()]);
        for ((out, found), scale) in out.iter_mut().zip(found).zip(&scale) {
            out[c] = found / scale;
        }
    }
    out
}

/// ln L of the cells that are made of `terms`: `(weight, taps)` per cell.
pub fn logarithms(terms: &[Vec<(f64, &Taps)>], nodes: &[f64]) -> Vec<f64> {
    let cell = |terms: &Vec<(f64, &Taps)>| {
        let light = terms.iter().map(|(w, taps)| w * value(taps, nodes).exp());
        light.sum::<f64>().ln()
    };
    terms.iter().map(cell).collect()
}
