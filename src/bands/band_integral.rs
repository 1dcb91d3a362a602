//! Wavelengths of a response among those of a model.

use super::response::Response;
use crate::error::{Error, Result};

/// Wavelengths that a band may be made of.
const WAVELENGTHS: usize = 24;

/// Some wavelengths spread over a range, or its only one; kinks among them where they are few.
pub(super) fn spread(kinks: &[f64], [first, last]: [f64; 2]) -> Vec<f64> {
    if first == last {
        return vec![first];
    }
    let within = |l: &&f64| (first..=last).contains(*l);
    let kinks: Vec<f64> = kinks.iter().filter(within).copied().collect();
    let even = |i: usize| first + (last - first) * (i as f64 + 0.5) / WAVELENGTHS as f64;
    let mut out: Vec<f64> = (0..WAVELENGTHS).map(even).collect();
    if kinks.len() <= WAVELENGTHS {
        out.extend(kinks);
    }
    out.sort_unstable_by(f64::total_cmp);
    out
}

/// Wavelengths and weights of a response with kinks of what it is multiplied with.
pub(super) fn quadrature(
    [min, max]: [f64; 2],
    kinks: &[f64],
    response: &Response,
) -> Result<Vec<[f64; 2]>> {
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
    Ok(response.quadrature(kinks))
}
