//! What is prepared for one set of conditions.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::PyModel;
use crate::aerial_perspective::colour::PyColourAerialPerspective;
use crate::aerial_perspective::spectral::PyAerialPerspective;
use crate::arrays::{numbers, pair, scalar};
use crate::conditions;
use crate::moon::PySkySum;
use crate::polarised::PyPolarisedSky;
use crate::rows::alone;
use crate::sky::{PyColourSky, PySky};
use crate::solar_disc::PySolarDisc;
use crate::sun_course::PySunCourse;
use crate::transmittance::PyTransmittance;

#[pymethods]
impl PyModel {
    /// The sky of one scene. conditions: a `Conditions`; keywords take the place of its fields, or of the defaults.
    #[pyo3(
        signature = (conditions=None, **keywords),
        text_signature = "($self, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn sky(
        &self,
        py: Python<'_>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PySky> {
        let conditions = conditions::read(conditions, keywords)?;
        let made = || {
            Ok((
                self.model.sky(&conditions)?,
                self.model.spectral_interpolation()?,
            ))
        };
        let (sky, interpolation) = alone(py, made)?;
        Ok(PySky::new(sky, interpolation))
    }

    /// The sky of one scene with its polarisation. Conditions as of `sky`.
    #[pyo3(
        signature = (conditions=None, **keywords),
        text_signature = "($self, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn polarised_sky(
        &self,
        py: Python<'_>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyPolarisedSky> {
        let conditions = conditions::read(conditions, keywords)?;
        Ok(alone(py, || self.model.polarised_sky(&conditions))?.into())
    }

    /// The sky of one scene for colour alone, which is prepared and asked in less time. Conditions as of `sky`.
    #[pyo3(
        signature = (conditions=None, **keywords),
        text_signature = "($self, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn colour_sky(
        &self,
        py: Python<'_>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyColourSky> {
        let conditions = conditions::read(conditions, keywords)?;
        Ok(alone(py, || self.model.colour_sky(&conditions))?.into())
    }

    /// The disc of the sun as seen through the air. Conditions as of `sky`; the albedo does not count.
    #[pyo3(
        signature = (conditions=None, **keywords),
        text_signature = "($self, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn solar_disc(
        &self,
        py: Python<'_>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PySolarDisc> {
        let conditions = conditions::read(conditions, keywords)?;
        Ok(alone(py, || self.model.solar_disc(&conditions))?.into())
    }

    /// Transmittance and in-scattered light of segments in one scene. Conditions as of `sky`; they hold at the origin
    /// of the points.
    ///
    /// THE ALTITUDE DOES NOT COUNT: how high an observer is, the z of the points says.
    #[pyo3(
        signature = (conditions=None, **keywords),
        text_signature = "($self, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn aerial_perspective(
        &self,
        py: Python<'_>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyAerialPerspective> {
        let conditions = conditions::read(conditions, keywords)?;
        Ok(alone(py, || self.model.aerial_perspective(&conditions))?.into())
    }

    /// The same for colour alone, prepared and asked in half the time.
    #[pyo3(
        signature = (conditions=None, **keywords),
        text_signature = "($self, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn colour_aerial_perspective(
        &self,
        py: Python<'_>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyColourAerialPerspective> {
        let conditions = conditions::read(conditions, keywords)?;
        Ok(alone(py, || self.model.colour_aerial_perspective(&conditions))?.into())
    }

    /// The sky in the light of sun and moon together. moon: a `Moon`; conditions as of `sky`.
    #[pyo3(
        signature = (moon, conditions=None, **keywords),
        text_signature = "($self, moon, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn sky_with_moon(
        &self,
        py: Python<'_>,
        moon: &Bound<'_, PyAny>,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PySkySum> {
        let conditions = conditions::read(conditions, keywords)?;
        let moon = self.moon(moon)?;
        let sky = alone(py, || self.model.sky_with_moon(&conditions, &moon))?;
        Ok(PySkySum::new(sky, self.model.wavelengths().len()))
    }

    /// The same model with the moon in place of the sun: conditions say where the moon stands as `solar_elevation` and
    /// `solar_azimuth` (`Moon.conditions`). moon: a `Moon`.
    fn moonlit(&self, py: Python<'_>, moon: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.moonlit_by(py, &self.moon(moon)?)
    }

    /// The same model over a ground whose albedo depends on wavelength: albedos (K,) within 0..=1 at increasing
    /// wavelengths (K,) in nm, linear between them and constant beyond.
    ///
    /// Whatever conditions say, all that is prepared from it is in the light of that ground, at each wavelength exactly;
    /// colours and bands see it as sums over the spectrum. Conditions of what is prepared have the albedo at 550 nm.
    /// Queries with arrays of conditions (`Model.radiance` and its like) say their albedos and refuse it.
    fn over(
        &self,
        py: Python<'_>,
        wavelengths: &Bound<'_, PyAny>,
        albedos: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let read = |values, what| -> PyResult<Vec<f64>> {
            Ok(numbers::<f64>(values, what)?.as_slice()?.to_vec())
        };
        let ground = [read(wavelengths, "wavelengths")?, read(albedos, "albedos")?];
        self.over_ground(py, ground)
    }

    /// The air at a visibility (m).
    fn transmittance(
        &self,
        py: Python<'_>,
        visibility: &Bound<'_, PyAny>,
    ) -> PyResult<PyTransmittance> {
        let visibility = scalar(visibility, "visibility", "")?;
        Ok(alone(py, || self.model.transmittance(visibility))?.into())
    }

    /// Colour skies of all suns in a range, baked beforehand.
    ///
    /// elevations: lowest and highest elevation of the sun, rad. tolerance: as of `Sky.bake`. Conditions as of `sky`.
    ///
    /// THE SOLAR ELEVATION OF THE CONDITIONS DOES NOT COUNT: `elevations` takes its place.
    #[pyo3(
        signature = (elevations, tolerance=welkin::BakedSky::TOLERANCE, conditions=None, **keywords),
        text_signature = "($self, elevations, tolerance=0.0025, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None)"
    )]
    fn sun_course(
        &self,
        py: Python<'_>,
        elevations: &Bound<'_, PyAny>,
        tolerance: f64,
        conditions: Option<&Bound<'_, PyAny>>,
        keywords: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PySunCourse> {
        let conditions = conditions::read(conditions, keywords)?;
        let elevations = pair(
            elevations,
            "elevations",
            self.model.solar_elevation_range(),
            "rad",
        )?;
        let made = || self.model.sun_course(&conditions, elevations, tolerance);
        Ok(alone(py, made)?.into())
    }
}
