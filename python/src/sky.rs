//! `Sky` and `ColourSky`: one set of conditions, any directions.

use std::sync::Arc;

use pyo3::prelude::*;
use welkin::{BakedSky, ColourSky, ColourSpace, Result, Sky, SpectralInterpolation};

use crate::arrays::{Array, Directions, Output, fill, fill_each, list};
use crate::baked::colour::PyBakedColourSky;
use crate::baked::spectral::PyBakedSky;
use crate::conditions;
use crate::errors::raise;
use crate::rows::alone;
use crate::spectrum::Spectrum;
use crate::threads::Threads;

/// The clear sky of one scene. Made by `Model.sky`.
///
/// Directions are arrays (…, 3) that point away from the observer, of any length: +z zenith, azimuth counter-clockwise
/// from +x seen from above. Looking down gives the light of the air before black ground; the sun's disc is not
/// included. Spectra are what `radiance_at` gives: `radiance` gives the nodes of the model, which within absorption
/// bands are not the spectral radiance (see `wavelengths`). `threads`: 1 is the calling thread; None all cores, or as
/// many as RAYON_NUM_THREADS says.
#[pyclass(frozen, name = "Sky", module = "welkin_sky")]
pub struct PySky {
    pub sky: Arc<Sky>,
    interpolation: Arc<SpectralInterpolation>,
}

impl PySky {
    pub fn new(sky: Sky, interpolation: &SpectralInterpolation) -> Self {
        Self {
            sky: Arc::new(sky),
            interpolation: Arc::new(interpolation.clone()),
        }
    }
}

#[pymethods]
impl PySky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
    }

    /// Wavelengths of `radiance`, nm: (W,), the nodes of the model.
    ///
    /// At nodes within absorption bands (of the default model 580, 605, 740, 762, 763, 825, 939 and 941 nm) values are
    /// terms that spectra are made of and not the spectral quantity there, from which they differ by up to 40 %:
    /// `radiance_at` gives that at any wavelength, these among them.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        list(py, self.sky.wavelengths())
    }

    /// Unit vector towards the sun's centre.
    #[getter]
    fn sun_direction(&self) -> (f32, f32, f32) {
        self.sky.sun_direction().into()
    }

    /// Memory that the sky holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// The same sky, turned so that the sun has this azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut sky = Sky::clone(&self.sky);
        sky.set_solar_azimuth(azimuth).map_err(|e| raise(py, e))?;
        Ok(Self {
            sky: Arc::new(sky),
            interpolation: Arc::clone(&self.interpolation),
        })
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at the nodes `wavelengths`: (…, 3) → (…, W) float32.
    ///
    /// Within absorption bands the nodes are not spectral radiance: see `wavelengths`, and ask `radiance_at`.
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        let tail = [self.sky.wavelengths().len()];
        fill(py, threads, &directions, &tail, |directions, out| {
            self.sky.radiance_batch(directions, out)
        })
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹, at `wavelengths`: (…, 3) → (…, W).
    #[pyo3(signature = (directions, *, threads=None))]
    fn relative_radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        let tail = [self.sky.wavelengths().len()];
        fill_each(py, threads, &directions, &tail, |direction, out| {
            self.sky.relative_radiance(direction, out)
        })
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm, a number or (K,): (…, 3) → (…, K).
    ///
    /// The nodes are evaluated once for all of them; each wavelength then costs a tenth of that or so.
    #[pyo3(signature = (directions, wavelengths, *, threads=None))]
    fn radiance_at<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let solar = |l| self.interpolation.solar_irradiance(l);
        self.at_wavelengths(py, directions, wavelengths, threads, solar)
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹, at wavelengths in nm: (…, 3) → (…, K).
    #[pyo3(signature = (directions, wavelengths, *, threads=None))]
    fn relative_radiance_at<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        self.at_wavelengths(py, directions, wavelengths, threads, |_| 1.0)
    }

    /// CIE 1931 X, Y, Z, cd m⁻² (Y is luminance): (…, 3) → (…, 3).
    #[pyo3(signature = (directions, *, threads=None))]
    fn xyz<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill(py, threads, &directions, &[3], |directions, out| {
            self.sky.xyz_batch(directions, out.as_chunks_mut().0)
        })
    }

    /// Linear RGB, cd m⁻², not clipped: (…, 3) → (…, 3).
    ///
    /// space: "srgb", "rec2020", "acescg" or "xyz", in any case. White of 1 cd m⁻² is (1, 1, 1).
    #[pyo3(signature = (directions, space="srgb", *, threads=None))]
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        space: &str,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let space = self::space(py, space)?;
        let directions = Directions::directions(directions)?;
        fill(py, threads, &directions, &[3], |directions, out| {
            let out = out.as_chunks_mut().0;
            self.sky.xyz_batch(directions, out)?;
            to_space(out, space)
        })
    }

    /// Bakes the sky into tables that are asked many times faster.
    ///
    /// tolerance: relative error that this may add at 95 % of directions and wavelengths.
    #[pyo3(signature = (tolerance=BakedSky::TOLERANCE), text_signature = "($self, tolerance=0.0025)")]
    fn bake(&self, py: Python<'_>, tolerance: f64) -> PyResult<PyBakedSky> {
        Ok(alone(py, || self.sky.bake(tolerance))?.into())
    }

    /// The same for colour alone.
    #[pyo3(signature = (tolerance=BakedSky::TOLERANCE), text_signature = "($self, tolerance=0.0025)")]
    fn bake_colour(&self, py: Python<'_>, tolerance: f64) -> PyResult<PyBakedColourSky> {
        Ok(alone(py, || self.sky.bake_colour(tolerance))?.into())
    }
}

impl PySky {
    fn at_wavelengths<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        threads: Option<Threads>,
        unit: impl Fn(f64) -> f64,
    ) -> PyResult<Array<'py>> {
        let spectrum = Spectrum::read(&self.interpolation, wavelengths, unit)?;
        let directions = Directions::directions(directions)?;
        let (nodes, width) = (self.sky.wavelengths().len(), spectrum.len());
        fill(py, threads, &directions, &[width], |directions, out| {
            let mut values = vec![0.0; nodes];
            let rows = out.chunks_exact_mut(width.max(1));
            for (&direction, row) in directions.iter().zip(rows) {
                if self.sky.ground().is_some() {
                    // Over the ground of each wavelength nodes have other light than over their own.
                    let light = |l| self.sky.relative_radiance_at(direction, l);
                    spectrum.write_each(row, light)?;
                    continue;
                }
                self.sky.relative_radiance(direction, &mut values)?;
                spectrum.write(&values, row)?;
            }
            Ok(())
        })
    }
}

/// The sky of one scene for colour alone. Made by `Model.colour_sky`. Directions as of `Sky`.
#[pyclass(frozen, name = "ColourSky", module = "welkin_sky")]
pub struct PyColourSky {
    pub sky: ColourSky,
}

impl From<ColourSky> for PyColourSky {
    fn from(sky: ColourSky) -> Self {
        Self { sky }
    }
}

#[pymethods]
impl PyColourSky {
    /// What the sky was prepared for.
    #[getter]
    fn conditions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        conditions::shown(py, self.sky.conditions())
    }

    /// Unit vector towards the sun's centre.
    #[getter]
    fn sun_direction(&self) -> (f32, f32, f32) {
        self.sky.sun_direction().into()
    }

    /// Memory that the sky holds, bytes.
    #[getter]
    fn bytes(&self) -> usize {
        self.sky.bytes()
    }

    /// The same sky, turned so that the sun has this azimuth (rad). Costs no preparation.
    fn with_solar_azimuth(&self, py: Python<'_>, azimuth: f64) -> PyResult<Self> {
        let mut sky = self.sky.clone();
        sky.set_solar_azimuth(azimuth).map_err(|e| raise(py, e))?;
        Ok(sky.into())
    }

    /// CIE 1931 X, Y, Z, cd m⁻² (Y is luminance): (…, 3) → (…, 3).
    #[pyo3(signature = (directions, *, threads=None))]
    fn xyz<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let directions = Directions::directions(directions)?;
        fill(py, threads, &directions, &[3], |directions, out| {
            self.sky.xyz_batch(directions, out.as_chunks_mut().0)
        })
    }

    /// Linear RGB, cd m⁻², not clipped: (…, 3) → (…, 3). space: as of `Sky.rgb`.
    #[pyo3(signature = (directions, space="srgb", *, threads=None))]
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        space: &str,
        threads: Option<Threads>,
    ) -> PyResult<Array<'py>> {
        let space = self::space(py, space)?;
        let directions = Directions::directions(directions)?;
        fill(py, threads, &directions, &[3], |directions, out| {
            let out = out.as_chunks_mut().0;
            self.sky.xyz_batch(directions, out)?;
            to_space(out, space)
        })
    }

    /// Bakes the sky into tables that are asked many times faster. tolerance: as of `Sky.bake`.
    #[pyo3(signature = (tolerance=BakedSky::TOLERANCE), text_signature = "($self, tolerance=0.0025)")]
    fn bake(&self, py: Python<'_>, tolerance: f64) -> PyResult<PyBakedColourSky> {
        Ok(alone(py, || self.sky.bake(tolerance))?.into())
    }

    /// Bakes the sky into tables of the sizes of another one, of conditions nearby: the next frame, in half the time.
    fn bake_like(&self, py: Python<'_>, other: &PyBakedColourSky) -> PyBakedColourSky {
        py.detach(|| self.sky.bake_like(&other.sky)).into()
    }
}

/// The matrix (3, 3) float32 from CIE 1931 XYZ to a colour space by name, as of `Sky.rgb`.
#[pyfunction]
pub fn colour_space_matrix<'py>(py: Python<'py>, space: &str) -> PyResult<Array<'py>> {
    let matrix = self::space(py, space)?.matrix();
    let mut output = Output::new(py, &[3, 3], &[])?;
    output.all()?.copy_from_slice(matrix.as_flattened());
    Ok(output.array)
}

/// A colour space by name, whatever its case.
pub fn space(py: Python<'_>, name: &str) -> PyResult<ColourSpace> {
    let lower = name.to_ascii_lowercase();
    let space = lower.parse().or_else(|_| name.parse());
    space.map_err(|error| raise(py, error))
}

fn to_space(colours: &mut [[f32; 3]], space: ColourSpace) -> Result<()> {
    for colour in colours {
        *colour = space.from_xyz(*colour);
    }
    Ok(())
}
