//! Bands, and what is prepared for them.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::PyModel;
use crate::arrays::scalar;
use crate::bands::air::{PyBandAerialPerspective, PyBandTransmittance};
use crate::bands::sky::{PyBandSky, PyPolarisedBandSky};
use crate::bands::sun::PyBandSolarDisc;
use crate::bands::{PyBands, responses};
use crate::conditions;
use crate::rows::alone;

#[pymethods]
impl PyModel {
    /// The bands of a sensor, projected onto few wavelengths of the model. Takes some milliseconds, once.
    ///
    /// responses: a sequence of `Response` and of wavelengths (nm), each of which is the band of that wavelength alone.
    fn bands(&self, py: Python<'_>, responses: &Bound<'_, PyAny>) -> PyResult<PyBands> {
        let responses = self::responses(responses)?;
        Ok(alone(py, || self.model.bands(&responses))?.into())
    }

    /// A sky in bands. Conditions as of `sky`.
    #[pyo3(
        signature = (bands, conditions=None, **keywords),
        text_signature = "($self, bands, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn band_sky(
        &self,
        py: Python<'_>,
        bands: &PyBands,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyBandSky> {
        let conditions = conditions::read(conditions, keywords)?;
        Ok(alone(py, || self.model.band_sky(&conditions, &bands.bands))?.into())
    }

    /// A sky in bands with its polarisation. Conditions as of `sky`.
    #[pyo3(
        signature = (bands, conditions=None, **keywords),
        text_signature = "($self, bands, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn polarised_band_sky(
        &self,
        py: Python<'_>,
        bands: &PyBands,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyPolarisedBandSky> {
        let conditions = conditions::read(conditions, keywords)?;
        let made = || self.model.polarised_band_sky(&conditions, &bands.bands);
        Ok(alone(py, made)?.into())
    }

    /// The disc of the sun in bands. Conditions as of `sky`.
    #[pyo3(
        signature = (bands, conditions=None, **keywords),
        text_signature = "($self, bands, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn band_solar_disc(
        &self,
        py: Python<'_>,
        bands: &PyBands,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyBandSolarDisc> {
        let conditions = conditions::read(conditions, keywords)?;
        let made = || self.model.band_solar_disc(&conditions, &bands.bands);
        Ok(alone(py, made)?.into())
    }

    /// Transmittance and in-scattered light of segments in bands. Conditions as of `aerial_perspective`.
    #[pyo3(
        signature = (bands, conditions=None, **keywords),
        text_signature = "($self, bands, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn band_aerial_perspective(
        &self,
        py: Python<'_>,
        bands: &PyBands,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyBandAerialPerspective> {
        let conditions = conditions::read(conditions, keywords)?;
        let made = || {
            self.model
                .band_aerial_perspective(&conditions, &bands.bands)
        };
        Ok(alone(py, made)?.into())
    }

    /// The air at a visibility (m) in bands.
    fn band_transmittance(
        &self,
        py: Python<'_>,
        visibility: &Bound<'_, PyAny>,
        bands: &PyBands,
    ) -> PyResult<PyBandTransmittance> {
        let visibility = scalar(visibility, "visibility", "")?;
        let made = || self.model.band_transmittance(visibility, &bands.bands);
        Ok(alone(py, made)?.into())
    }
}
