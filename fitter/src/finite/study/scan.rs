//! Columns of neighbouring pixels across the horizon: stripes show as jumps.

use super::method::{Lights, METHODS, Methods};
use super::segment_case::Case;
use crate::successive_orders::Spectrum;
use crate::units::Solved;
use anyhow::Result;
use rayon::prelude::*;

/// A column of pixels that see things at one distance.
#[derive(Clone, Debug)]
pub struct Scan {
    /// For tables.
    pub name: String,
    /// From below to above the horizontal.
    pub pixels: Vec<Case>,
    /// Exact light.
    pub truth: Vec<Spectrum>,
    /// Results of every method, in the order of [`METHODS`].
    pub light: Vec<Lights>,
}

/// Angle between pixels, rad.
const PIXEL: f64 = 0.02 * std::f64::consts::PI / 180.0;
/// Pixels on each side of the horizontal.
const HALF: i32 = 75;
/// Node whose jumps are told: 550 nm.
const GREEN: usize = 12;

/// Observers at 2 m, 300 m and as high as 8 km under two suns, things 15 km away.
pub fn scans(
    methods: &Methods,
    solved: &[Solved],
    visibility: usize,
    highest: f64,
) -> Result<Vec<Scan>> {
    let mut out = vec![];
    for altitude in [2.0, 300.0, highest.min(8000.0)] {
        for sun in [20.0, -2.0f64] {
            let pixel = |i: i32| Case {
                visibility,
                altitude,
                direction: [f64::from(i) * PIXEL, 1.0],
                length: 15_000.0,
                sun: sun.to_radians(),
                albedo: 0.2,
            };
            let planet = crate::column::planet(&solved[visibility].medium.atmosphere);
            let free = |c: &Case| planet.ray(c.altitude, c.direction[0]).length > c.length;
            let pixels: Vec<Case> = (-HALF..=HALF).map(pixel).filter(free).collect();
            let truth = pixels
                .par_iter()
                .map(|c| c.truth(&solved[visibility])[0])
                .collect();
            let light = all(methods, &pixels)?;
            let name = format!("{altitude} m, sun {sun}°");
            out.push(Scan {
                name,
                pixels,
                truth,
                light,
            });
        }
    }
    Ok(out)
}

/// Every method for every case.
pub fn all(methods: &Methods, cases: &[Case]) -> Result<Vec<Lights>> {
    let one = |case: &Case| {
        let mut out = [None; METHODS.len()];
        for (out, method) in out.iter_mut().zip(METHODS) {
            *out = methods.light(method, case)?;
        }
        Ok(out)
    };
    cases.par_iter().map(one).collect()
}

/// The largest change of a method's ratio to the truth from one pixel to the next, per scan and method.
pub fn jumps(scan: &Scan) -> [Option<f64>; METHODS.len()] {
    std::array::from_fn(|m| {
        let ratio = |i: usize| {
            let light = scan.light[i][m]?[GREEN].max(0.0);
            Some(f64::from(light / scan.truth[i][GREEN]))
        };
        let steps = (1..scan.pixels.len()).filter_map(|i| Some((ratio(i)? - ratio(i - 1)?).abs()));
        steps.reduce(f64::max)
    })
}
