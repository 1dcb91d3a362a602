//! Wavelengths of a response among those of a model.

use super::response::Response;
use super::spectral_axis::SpectralAxis;
use crate::error::{Error, Result};
use crate::model::Model;

/// Wavelengths that a band may be made of.
const WAVELENGTHS: usize = 24;

/// Wavelengths and weights of a response within the range of a model.
pub(super) fn quadrature(
    model: &Model,
    axis: &SpectralAxis,
    response: &Response,
) -> Result<Vec<[f64; 2]>> {
    let [min, max] = axis.range();
    for value in response.range() {
        if !(min..=max).contains(&value) {
            return Err(Error::OutOfRange {
                parameter: "wavelength of a response",
                value,
                min,
                max,
                unit: "nm",
            });
        }
    }
    let head = model.head();
    let samples = 0..head.solar_irradiance.len();
    let mut kinks: Vec<f64> = samples
        .map(|i| head.solar_start + i as f64 * head.solar_step)
        .collect();
    kinks.extend(&axis.wavelengths);
    Ok(response.quadrature(&kinks))
}

/// Some wavelengths spread over a response, or its only one; cells among them where they are few.
pub(super) fn spread(axis: &SpectralAxis, response: &Response) -> Vec<f64> {
    let [first, last] = response.range();
    if first == last {
        return vec![first];
    }
    let within = |l: &&f64| (first..=last).contains(*l);
    let cells: Vec<f64> = axis.wavelengths.iter().filter(within).copied().collect();
    let even = |i: usize| first + (last - first) * (i as f64 + 0.5) / WAVELENGTHS as f64;
    let mut out: Vec<f64> = (0..WAVELENGTHS).map(even).collect();
    if cells.len() <= WAVELENGTHS {
        out.extend(cells);
    }
    out.sort_unstable_by(f64::total_cmp);
    out
}
