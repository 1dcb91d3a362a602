//! Other conditions in every row, broadcast against directions.

use numpy::Element;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use welkin::{BakedSky, Budget, Channels, Conditions, Model, PointQuery, Result, Stokes};

use super::PyModel;
use crate::arrays::{Array, Output};
use crate::bands::PyBands;
use crate::broadcast::{Operand, Values, common};
use crate::conditions::{Columns, Rows};
use crate::frame;
use crate::rows::{alone, block_rows, run};
use crate::spectrum::Spectrum;
use crate::threads::Threads;

#[pymethods]
impl PyModel {
    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at the nodes `wavelengths` under any conditions: (…, 3) → (…, W).
    ///
    /// Within absorption bands the nodes are not spectral radiance: see `wavelengths`, and ask `radiance_at`.
    /// Every condition may be an array: all are broadcast against each other and the leading shape of the directions.
    /// Nothing is prepared, so that conditions may differ from row to row; for one set of conditions `sky` is faster.
    #[pyo3(
        signature = (directions, conditions=None, *, threads=None, **keywords),
        text_signature = "($self, directions, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None, threads=None)"
    )]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        conditions: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let scene = Scene::read(py, directions, conditions, keywords)?;
        let rows = scene.rows()?;
        let query = alone(py, || point_query(&self.model, rows))?;
        let nodes = self.model.wavelengths();
        let own = self.moonlight(py, nodes)?;
        scene.fill(py, threads, &[nodes.len()], |conditions, direction, out| {
            let Some(irradiance) = &own else {
                return query.radiance(conditions, direction, out);
            };
            query.relative_radiance(conditions, direction, out)?;
            out.iter_mut().zip(irradiance).for_each(|(v, e)| *v *= e);
            Ok(())
        })
    }

    /// The same per unit of solar spectral irradiance, sr⁻¹: (…, 3) → (…, W).
    #[pyo3(
        signature = (directions, conditions=None, *, threads=None, **keywords),
        text_signature = "($self, directions, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None, threads=None)"
    )]
    fn relative_radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        conditions: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let scene = Scene::read(py, directions, conditions, keywords)?;
        let rows = scene.rows()?;
        let query = alone(py, || point_query(&self.model, rows))?;
        let width = self.model.wavelengths().len();
        scene.fill(py, threads, &[width], |conditions, direction, out| {
            query.relative_radiance(conditions, direction, out)
        })
    }

    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm, a number or (K,): (…, 3) → (…, K).
    ///
    /// The nodes are evaluated once for all of them. Conditions as of `radiance`.
    #[pyo3(
        signature = (directions, wavelengths, conditions=None, *, threads=None, **keywords),
        text_signature = "($self, directions, wavelengths, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None, threads=None)"
    )]
    fn radiance_at<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        wavelengths: &Bound<'py, PyAny>,
        conditions: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let rule = alone(py, || self.model.spectral_interpolation())?;
        let spectrum = Spectrum::read(rule, wavelengths, |l| rule.solar_irradiance(l))?;
        let scene = Scene::read(py, directions, conditions, keywords)?;
        let rows = scene.rows()?;
        let query = alone(py, || point_query(&self.model, rows))?;
        let (nodes, width) = (self.model.wavelengths().len(), spectrum.len());
        scene.fill(py, threads, &[width], |conditions, direction, out| {
            let mut values = vec![0.0; nodes];
            query.relative_radiance(conditions, direction, &mut values)?;
            spectrum.write(&values, out)
        })
    }

    /// Values of bands under any conditions, in the units of their `Response`s: (…, 3) → (…, B). Broadcasts as
    /// `radiance`.
    #[pyo3(
        signature = (directions, bands, conditions=None, *, threads=None, **keywords),
        text_signature = "($self, directions, bands, conditions=None, *, \
            solar_elevation=None, solar_azimuth=None, visibility=None, albedo=None, altitude=None, threads=None)"
    )]
    fn band_radiance<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        bands: &PyBands,
        conditions: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let scene = Scene::read(py, directions, conditions, keywords)?;
        let rows = scene.rows()?;
        let query = alone(py, || point_query(&self.model, rows))?;
        let nodes = self.model.wavelengths().len();
        let width = bands.bands.count();
        scene.fill(py, threads, &[width], |conditions, direction, out| {
            let mut values = vec![0.0; nodes];
            query.relative_radiance(conditions, direction, &mut values)?;
            bands.bands.project(&values, out)
        })
    }

    /// Stokes vectors I, Q, U, W m⁻² sr⁻¹ nm⁻¹, at the nodes under any conditions: (…, 3) → (…, 3, W). Broadcasts
    /// as `radiance`. Within absorption bands the nodes are not spectra: see `wavelengths`, and ask
    /// `PolarisedSky.stokes_at`.
    ///
    /// frame: as of `PolarisedSky.stokes`.
    #[pyo3(
        signature = (directions, conditions=None, *, frame=None, threads=None, **keywords),
        text_signature = "($self, directions, conditions=None, *, \
            frame=None, solar_elevation=None, solar_azimuth=None, \
             visibility=None, albedo=None, altitude=None, threads=None)"
    )]
    fn stokes<'py>(
        &self,
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        conditions: Option<&Bound<'py, PyAny>>,
        frame: Option<&Bound<'py, PyAny>>,
        threads: Option<Threads>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Array<'py>> {
        let frame = frame::read(frame)?;
        let scene = Scene::read(py, directions, conditions, keywords)?;
        let budget = budget(&self.model, scene.rows()?, Channels::Stokes);
        let query = alone(py, || {
            let plan = self.model.plan(&budget)?;
            self.model.polarised_point_query(&plan)
        })?;
        let nodes = self.model.wavelengths();
        let (own, width) = (self.moonlight(py, nodes)?, nodes.len());
        scene.fill(py, threads, &[3, width], |conditions, direction, out| {
            let mut stokes = vec![Stokes::default(); width];
            query.stokes(conditions, direction, frame, &mut stokes)?;
            if let Some(irradiance) = &own {
                let mut radiance = vec![0.0; width];
                let plain = query.point_query();
                plain.relative_radiance(conditions, direction, &mut radiance)?;
                radiance
                    .iter_mut()
                    .zip(irradiance)
                    .for_each(|(v, e)| *v *= e);
                in_other_light(&mut stokes, &radiance);
            }
            crate::polarised::part(&stokes, out);
            Ok(())
        })
    }
}

impl PyModel {
    /// Irradiance (W m⁻² nm⁻¹) by the moon at wavelengths, if the model is moonlit: point queries, which look at the
    /// file alone, know only that of the sun.
    fn moonlight(&self, py: Python<'_>, wavelengths: &[f64]) -> PyResult<Option<Vec<f32>>> {
        if !self.model.is_moonlit() {
            return Ok(None);
        }
        let rule = alone(py, || self.model.spectral_interpolation())?;
        let irradiance = wavelengths.iter().map(|&l| rule.solar_irradiance(l) as f32);
        Ok(Some(irradiance.collect()))
    }
}

/// The same polarisation of other radiances.
fn in_other_light(stokes: &mut [Stokes], radiance: &[f32]) {
    for (stokes, &radiance) in stokes.iter_mut().zip(radiance) {
        let share = if stokes.i > 0.0 {
            radiance / stokes.i
        } else {
            0.0
        };
        *stokes = Stokes {
            i: radiance,
            q: stokes.q * share,
            u: stokes.u * share,
        };
    }
}

/// Directions and the conditions of each.
struct Scene<'py> {
    directions: Operand<'py, f32, 3>,
    columns: Columns<'py>,
    lead: Vec<usize>,
}

impl<'py> Scene<'py> {
    fn read(
        py: Python<'py>,
        directions: &Bound<'py, PyAny>,
        conditions: Option<&Bound<'py, PyAny>>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let directions = Operand::vectors(directions, "directions")?;
        let columns = Columns::read(py, conditions, keywords)?;
        let shapes: Vec<_> = columns.shapes().chain([directions.named()]).collect();
        let lead = common(py, &shapes)?;
        Ok(Self {
            directions: directions.spread(&lead)?,
            columns: columns.spread(&lead)?,
            lead,
        })
    }

    fn rows(&self) -> PyResult<Rows<'_>> {
        self.columns.rows()
    }

    fn fill<T: Element>(
        &self,
        py: Python<'py>,
        threads: Option<Threads>,
        tail: &[usize],
        work: impl Fn(&Conditions, [f32; 3], &mut [T]) -> Result<()> + Sync,
    ) -> PyResult<Array<'py, T>> {
        let (directions, conditions): (Values<_, 3>, _) = (self.directions.values()?, self.rows()?);
        let mut output = Output::new(py, &self.lead, tail)?;
        let (width, rows) = (tail.iter().product::<usize>(), self.lead.iter().product());
        let size = block_rows(rows);
        run(py, threads, output.blocks(size)?, |block, out| {
            let rows = out.chunks_exact_mut(width.max(1)).enumerate();
            rows.map(|(i, out)| (block * size + i, out))
                .try_for_each(|(i, out)| work(&conditions.at(i), directions.at(i), out))
        })?;
        Ok(output.array)
    }
}

/// Point queries of no more chunks than the conditions need.
fn point_query<'a>(model: &'a Model, rows: Rows<'_>) -> Result<PointQuery<'a>> {
    let plan = model.plan(&budget(model, rows, Channels::Spectral))?;
    model.point_query(&plan)
}

/// The ranges of the rows as far as the model has them; rows outside are refused when they are asked.
fn budget(model: &Model, rows: Rows<'_>, channels: Channels) -> Budget {
    let within = |name, [min, max]: [f64; 2]| {
        let known = rows.of(name).iter().map(|[value]| value.clamp(min, max));
        let known = known.filter(|value| value.is_finite());
        let ends = known.fold([max, min], |[low, high], v| [low.min(v), high.max(v)]);
        [ends[0].min(ends[1]), ends[1]]
    };
    Budget {
        altitude: within("altitude", model.altitude_range()),
        visibility: within("visibility", model.visibility_range()),
        solar_elevation: model.solar_elevation_range(),
        tolerance: BakedSky::TOLERANCE,
        channels,
    }
}
