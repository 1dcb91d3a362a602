//! Radiance of point queries at any wavelength. Format specification, section 7.3.

use super::capacity::WAVELENGTH_BLOCKS;
use super::contraction::WIDTH;
use super::opened::PointQuery;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::kernel::axis::hermite;
use crate::spectrum::{MOST_WAVELENGTHS, between, cells, check};

const MOST: usize = WAVELENGTH_BLOCKS * WIDTH;

impl PointQuery<'_> {
    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at any wavelength (nm) within the range of the model.
    ///
    /// A ground whose albedo depends on wavelength has that of the wavelength in the conditions:
    ///
    /// ```
    /// # #[cfg(feature = "std")] {
    /// use welkin::{Albedo, Conditions, Model, PointQuery};
    ///
    /// let grass = Albedo::table(&[450.0, 550.0, 670.0, 750.0], &[0.04, 0.10, 0.05, 0.45])?;
    /// let (zenith, wavelength) = ([0.0, 0.0, 1.0], 710.0);
    /// let conditions = Conditions { albedo: grass.at(wavelength), ..Conditions::default() };
    /// let query = PointQuery::new(welkin::DEFAULT_MODEL)?;
    /// let light = query.radiance_at(&conditions, zenith, wavelength)?;
    ///
    /// // As a sky over that ground has it.
    /// let sky = Model::default_model()?.over(&grass).sky(&conditions)?;
    /// assert!((light / sky.radiance_at(zenith, wavelength)? - 1.0).abs() < 1e-4);
    /// # }
    /// # Ok::<(), welkin::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`PointQuery::radiance`]; [`Error::OutOfRange`](crate::Error::OutOfRange) for the wavelength.
    pub fn radiance_at(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        wavelength: f64,
    ) -> Result<f32> {
        let relative = self.relative_at(conditions, direction, wavelength)?;
        let irradiance = f64::from(self.solar_irradiance(wavelength));
        Ok((relative * irradiance).min(f64::from(f32::MAX)) as f32)
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹, at any wavelength (nm) within the range of the model.
    ///
    /// # Errors
    /// As [`PointQuery::radiance_at`].
    pub fn relative_radiance_at(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        wavelength: f64,
    ) -> Result<f32> {
        let relative = self.relative_at(conditions, direction, wavelength)?;
        Ok(relative.min(f64::from(f32::MAX)) as f32)
    }

    /// Shortest and longest wavelength that can be asked for, nm.
    pub fn wavelength_range(&self) -> [f64; 2] {
        let axis = match &self.spectrum {
            Some(spectrum) => spectrum.wavelength,
            None => self.head.wavelengths,
        };
        [axis[0].get(), axis[axis.len() - 1].get()]
    }

    fn relative_at(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        wavelength: f64,
    ) -> Result<f64> {
        self.check_wavelength(wavelength)?;
        let mut values = [0.0; MOST];
        let values = &mut values[..self.head.shape.wavelengths];
        self.relative_radiance(conditions, direction, values)?;
        Ok(self.relative_between(values, wavelength))
    }

    pub(crate) fn check_wavelength(&self, wavelength: f64) -> Result<()> {
        check(wavelength, self.wavelength_range())
    }

    /// Relative radiance at a wavelength in range, from that at the nodes.
    pub(crate) fn relative_between(&self, values: &[f32], wavelength: f64) -> f64 {
        match &self.spectrum {
            Some(spectrum) => cells::radiance(spectrum, values, wavelength),
            None => {
                let (nodes, count) = self.nodes();
                between(&nodes[..count], values, wavelength)
            }
        }
    }

    /// The shares that nodes have in light at a wavelength in range, given its radiance at the nodes.
    pub(crate) fn shares(&self, values: &[f32], wavelength: f64) -> [f64; MOST_WAVELENGTHS] {
        if let Some(spectrum) = &self.spectrum {
            return cells::shares(spectrum, values, wavelength);
        }
        let mut shares = [0.0; MOST_WAVELENGTHS];
        let (nodes, count) = self.nodes();
        let stencil = hermite(&nodes[..count], wavelength);
        stencil.taps().for_each(|(n, w)| shares[n] = w);
        shares
    }

    fn nodes(&self) -> ([f64; MOST], usize) {
        let mut nodes = [0.0; MOST];
        let count = self.head.wavelengths.len();
        for (node, wavelength) in nodes.iter_mut().zip(self.head.wavelengths) {
            *node = wavelength.get();
        }
        (nodes, count)
    }
}
