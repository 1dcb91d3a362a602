//! Radiance between wavelengths where nothing is known but the nodes. Format specification, section 7.3.

use crate::error::{Error, Result};
use crate::kernel::axis::{hermite, linear};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// Most wavelengths that a file can have.
pub(crate) const MOST_WAVELENGTHS: usize = 256;

/// A spectrum at `wavelength` (nm), from its values at increasing `nodes`: smooth in the logarithm, linear beside zeros.
/// For what is smooth, so divide radiance by the irradiance of the sun first. Models without a spectrum chunk interpolate
/// like that; [`SpectralInterpolation`](crate::SpectralInterpolation) does as its model does.
///
/// # Errors
/// [`Error::OutOfRange`] for wavelengths beyond the nodes; [`Error::Length`] unless `values` has one element per node;
/// [`Error::Invalid`] for values that are not finite or nodes that do not increase.
pub fn between_wavelengths(nodes: &[f64], values: &[f32], wavelength: f64) -> Result<f32> {
    let ends = nodes.first().zip(nodes.last());
    let Some((&min, &max)) = ends.filter(|_| values.len() == nodes.len()) else {
        return Err(Error::Length {
            what: "values",
            expected: nodes.len().max(1) as u64,
            got: values.len() as u64,
        });
    };
    check(wavelength, [min, max])?;
    if !values.iter().all(|v| v.is_finite()) {
        return Err(Error::invalid("values", "must be finite"));
    }
    if !nodes.windows(2).all(|w| w[0] < w[1]) {
        return Err(Error::invalid("nodes", "must increase strictly"));
    }
    let value = between(nodes, values, wavelength);
    Ok(value.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32)
}

/// Refuses wavelengths outside the range of the nodes, nm.
pub(crate) fn check(wavelength: f64, [min, max]: [f64; 2]) -> Result<()> {
    match (min..=max).contains(&wavelength) {
        true => Ok(()),
        false => Err(Error::OutOfRange {
            parameter: "wavelength",
            value: wavelength,
            min,
            max,
            unit: "nm",
        }),
    }
}

/// Interpolates radiances at `nodes` (nm) to `wavelength`: smooth in the logarithm, linear where a value is zero.
pub(crate) fn between(nodes: &[f64], radiance: &[f32], wavelength: f64) -> f64 {
    let stencil = hermite(nodes, wavelength);
    if stencil.taps().all(|(i, _)| radiance[i] > 0.0) {
        let logarithm: f64 = stencil
            .taps()
            .map(|(i, w)| w * f64::from(radiance[i]).ln())
            .sum();
        return logarithm.exp();
    }
    linear(nodes, wavelength)
        .taps()
        .map(|(i, w)| w * f64::from(radiance[i]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn exact_at_nodes_and_linear_beside_zero() {
        let nodes = [400.0, 500.0, 600.0, 700.0];
        assert_eq!(between(&nodes, &[1.0, 2.0, 4.0, 8.0], 500.0) as f32, 2.0);
        let half = between(&nodes, &[1.0, 2.0, 4.0, 8.0], 550.0);
        assert!((half - 8f64.sqrt()).abs() < 1e-6);
        assert_eq!(between(&nodes, &[1.0, 2.0, 4.0, 0.0], 550.0), 3.0);
    }
}
