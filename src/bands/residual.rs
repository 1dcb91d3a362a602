//! How good a fit is.

/// How far a band is from the integral over its response, relative, over typical skies of the model.
///
/// ```
/// use welkin::{Model, Response};
///
/// let model = Model::default_model()?;
/// let bands = model.bands(&[Response::wavelength(model.wavelengths()[3])])?;
/// let residual = bands.residuals()[0];
/// assert!(residual.median <= residual.p99 && residual.p99 < 1e-6); // a wavelength of the model itself
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub p99: f64,
}
