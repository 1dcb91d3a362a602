//! Stokes vectors of a sky where every query may have other conditions.

use super::frame::{Aspect, PolarisationFrame};
use super::stokes::{Stokes, between};
use super::stokes_tables::{Mix, limit};
use crate::conditions::Conditions;
use crate::error::Result;
use crate::kernel::math::LANES;
use crate::point_query::{Factors, Interpolation, Parts, PointQuery};
use crate::sky::check_length;

/// A model with its polarisation, evaluated where it stands: [`PointQuery`] with Stokes vectors, always with
/// [`Interpolation::Full`](Interpolation::Full).
///
/// It answers as [`PolarisedSky`](crate::PolarisedSky) does, but for rounding (some 1e-6 of the radiance), in a few
/// microseconds and without preparation. Made by [`Model::polarised_point_query`](crate::Model::polarised_point_query).
/// Queries allocate nothing. `Send + Sync`.
///
/// ```
/// use welkin::{BakedSky, Budget, Channels, Conditions, Model, PolarisationFrame};
///
/// let model = Model::default_model()?;
/// let plan = model.plan(&Budget {
///     altitude: [0.0, 100.0],
///     visibility: [50e3, 60e3],
///     solar_elevation: [0.1, 1.0],
///     tolerance: BakedSky::TOLERANCE,
///     channels: Channels::Stokes,
/// })?;
/// let query = model.polarised_point_query(&plan)?;
/// let conditions = Conditions { altitude: 40.0, ..Conditions::default() };
/// let light = query.stokes_at(&conditions, [0.0, 0.5, 0.9], PolarisationFrame::Vertical, 550.0)?;
/// assert!((0.1..1.0).contains(&light.degree()));
/// # Ok::<(), welkin::Error>(())
/// ```
pub struct PolarisedPointQuery<'a> {
    query: PointQuery<'a>,
    factors: Factors<'a>,
    wavelengths: Vec<f64>,
}

impl<'a> PolarisedPointQuery<'a> {
    pub(crate) fn new(query: PointQuery<'a>, factors: Factors<'a>) -> Self {
        let query = query.with_interpolation(Interpolation::Full);
        Self {
            wavelengths: query.wavelengths().collect(),
            query,
            factors,
        }
    }

    /// The same without polarisation.
    pub fn point_query(&self) -> &PointQuery<'a> {
        &self.query
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// As [`PolarisedSky::stokes`](crate::PolarisedSky::stokes), under these conditions.
    ///
    /// # Errors
    /// As [`PointQuery::radiance`]; [`Error::Direction`](crate::Error::Direction) for an axis that is zero or not
    /// finite.
    pub fn stokes(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<()> {
        check_length(out.len(), self.wavelengths.len())?;
        let parts = self.evaluate(conditions, direction, frame, out)?;
        for ((out, radiance), nm) in out.iter_mut().zip(parts.radiance).zip(&self.wavelengths) {
            let irradiance = self.query.solar_irradiance(*nm);
            let i = (radiance * irradiance).min(f32::MAX);
            *out = Stokes {
                i,
                q: i * out.q,
                u: i * out.u,
            };
        }
        Ok(())
    }

    /// As [`PolarisedSky::stokes_at`](crate::PolarisedSky::stokes_at), under these conditions.
    ///
    /// # Errors
    /// As [`PolarisedPointQuery::stokes`]; [`Error::OutOfRange`](crate::Error::OutOfRange) for the wavelength.
    pub fn stokes_at(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        frame: PolarisationFrame,
        wavelength: f64,
    ) -> Result<Stokes> {
        let mut values = [Stokes::default(); crate::sky::MOST_WAVELENGTHS];
        let values = &mut values[..self.wavelengths.len()];
        let parts = self.evaluate(conditions, direction, frame, values)?;
        self.query.check_wavelength(wavelength)?;
        let radiance = &parts.radiance[..self.wavelengths.len()];
        let relative = self.query.relative_between(radiance, wavelength);
        let irradiance = f64::from(self.query.solar_irradiance(wavelength));
        let i = (relative * irradiance).min(f64::from(f32::MAX)) as f32;
        let shares = self.query.shares(radiance, wavelength);
        Ok(between(&shares, values, i))
    }

    /// Writes Q and U over I beside an I of 1.
    fn evaluate(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<Parts> {
        let parts = self.query.parts(&self.factors, conditions, direction)?;
        let azimuth = conditions.solar_azimuth.sin_cos();
        let aspect = Aspect::new(direction, conditions.sun_direction(), azimuth);
        let mix = Mix::new(&aspect, frame)?;
        for (block, out) in out.chunks_mut(LANES).enumerate() {
            let load = |row: &[f32]| -> [f32; LANES] {
                core::array::from_fn(|i| row.get(block * LANES + i).copied().unwrap_or(0.0))
            };
            let [sum, dipole] = [&parts.sum, &parts.dipole].map(|row| load(row));
            let [q, u] = parts.scattered.each_ref().map(|row| load(row));
            let part = |s: usize| mix.part(s, &dipole, &q, &u);
            let [q, u] = limit(sum, part(0), part(1));
            for (i, out) in out.iter_mut().enumerate() {
                *out = Stokes {
                    i: 1.0,
                    q: q[i],
                    u: u[i],
                };
            }
        }
        Ok(parts)
    }
}
