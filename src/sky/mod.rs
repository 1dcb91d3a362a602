//! A prepared sky: radiance for any direction without allocation or system call.

mod colour_space;
mod over_ground;
pub(crate) mod prepare;
pub(crate) mod tables;

use std::sync::Arc;

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::estimate::Sightline;
use crate::format::Head;
use crate::geometry::{Planet, Ray, Side};
use crate::ground::OverGround;
use crate::kernel::math::{LANES, finite};
use crate::phase_function::SunAngle;
pub(crate) use crate::spectrum::MOST_WAVELENGTHS;
use crate::spectrum::SpectralInterpolation;
pub use colour_space::{ColourSpace, xyz_to_linear_srgb};
use tables::{Lookup, Row, Tables, azimuth};

/// The clear sky at one set of conditions.
///
/// Directions point away from the observer, in the observer's local frame: +z is the zenith, the azimuth counts
/// counter-clockwise from +x seen from above. They need not be normalised. Ground that is seen is black: looking down
/// gives the light that the air before the ground scatters. The sun's disc is not included.
///
/// After [`Model::sky`](crate::Model::sky) returns, nothing here allocates, blocks or calls the system. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let sky = Model::default_model()?.sky(&Conditions::default())?;
/// let zenith = [0.0, 0.0, 1.0];
/// let mut radiance = vec![0.0; sky.wavelengths().len()];
/// sky.radiance(zenith, &mut radiance)?; // W m⁻² sr⁻¹ nm⁻¹
/// let rgb = sky.linear_srgb(zenith)?; // cd m⁻², not clipped
/// assert!(rgb[2] > rgb[0]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sky {
    conditions: Conditions,
    sun: [f64; 3],
    /// Sine and cosine of the sun's azimuth.
    azimuth: (f64, f64),
    planet: Planet,
    dip: f64,
    phi_intervals: usize,
    wavelengths: Vec<f64>,
    solar: Vec<f32>,
    solar_axis: [f64; 2],
    interpolation: Arc<SpectralInterpolation>,
    tables: Tables,
    over: Option<Box<OverGround<Sky>>>,
}

impl Sky {
    pub(crate) fn new(
        head: &Head,
        conditions: Conditions,
        tables: Tables,
        interpolation: Arc<SpectralInterpolation>,
    ) -> Self {
        Self {
            sun: conditions.sun_direction(),
            azimuth: conditions.solar_azimuth.sin_cos(),
            dip: head.planet.dip(conditions.altitude),
            planet: head.planet,
            phi_intervals: head.phi_intervals,
            wavelengths: head.wavelengths.clone(),
            solar: head.solar_irradiance.clone(),
            solar_axis: [head.solar_start, head.solar_step],
            conditions,
            interpolation,
            tables,
            over: None,
        }
    }

    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// The same sky, turned about the vertical so that the sun has this azimuth (rad). Costs no preparation.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.conditions = self.conditions.with_solar_azimuth(azimuth)?;
        self.azimuth = azimuth.sin_cos();
        self.sun = self.conditions.sun_direction();
        match &mut self.over {
            Some(over) => over.set_solar_azimuth(azimuth),
            None => Ok(()),
        }
    }

    /// Unit vector towards the sun's centre.
    pub fn sun_direction(&self) -> [f32; 3] {
        self.sun.map(|v| v as f32)
    }

    /// Wavelengths of [`Sky::radiance`], nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// Memory that the sky holds on the heap, bytes: 4 × (up + down coefficients) × azimuth coefficients × channels,
    /// with channels rounded up to whole vectors, plus a few kilobytes; about 2½ times as much over a ground whose
    /// albedo depends on wavelength.
    pub fn bytes(&self) -> usize {
        let axes = size_of_val(self.wavelengths.as_slice()) + size_of_val(self.solar.as_slice());
        let over = self.over.as_ref().map_or(0, |over| over.bytes());
        self.tables.bytes() + axes + over
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at each of [`Sky::wavelengths`].
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite; [`Error::Length`] unless `out` has one element
    /// per wavelength.
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.check_output(out, 1)?;
        let lookup = self.lookup(direction)?;
        self.spectral_into(&lookup, out);
        Ok(())
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹, at each of [`Sky::wavelengths`].
    ///
    /// # Errors
    /// As [`Sky::radiance`].
    pub fn relative_radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        self.check_output(out, 1)?;
        let lookup = self.lookup(direction)?;
        self.relative_into(&lookup, out);
        Ok(())
    }

    /// [`Sky::radiance`] for many directions; `out` is `[directions][wavelengths]`.
    ///
    /// # Errors
    /// As [`Sky::radiance`]. What precedes a bad direction is written.
    pub fn radiance_batch(&self, directions: &[[f32; 3]], out: &mut [f32]) -> Result<()> {
        self.check_output(out, directions.len())?;
        let rows = out.chunks_exact_mut(self.wavelengths.len());
        for (&direction, row) in directions.iter().zip(rows) {
            self.spectral_into(&self.lookup(direction)?, row);
        }
        Ok(())
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at any wavelength (nm) within the range of the model.
    ///
    /// # Errors
    /// [`Error::Direction`]; [`Error::OutOfRange`] for the wavelength.
    pub fn radiance_at(&self, direction: [f32; 3], wavelength: f64) -> Result<f32> {
        let relative = self.relative_at(direction, wavelength)?;
        Ok((relative * self.solar_irradiance(wavelength)).min(f64::from(f32::MAX)) as f32)
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹, at any wavelength (nm) within the range of the model.
    ///
    /// # Errors
    /// As [`Sky::radiance_at`].
    pub fn relative_radiance_at(&self, direction: [f32; 3], wavelength: f64) -> Result<f32> {
        let relative = self.relative_at(direction, wavelength)?;
        Ok(relative.min(f64::from(f32::MAX)) as f32)
    }

    /// CIE 1931 XYZ of the radiance; Y is the luminance in cd m⁻².
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        let sky = self.coloured();
        let lookup = sky.lookup(direction)?;
        let mut sums = [[0f32; LANES]; 3];
        sky.tables.radiance(&lookup, |block, radiance| {
            for (sum, weight) in sums.iter_mut().zip(&sky.tables.xyz[block]) {
                *sum = core::array::from_fn(|i| sum[i] + weight[i] * radiance[i]);
            }
        });
        Ok(sums.map(|lanes| finite(lanes.iter().sum())))
    }

    /// [`Sky::xyz`] for many directions.
    ///
    /// # Errors
    /// [`Error::Direction`]; [`Error::Length`] unless `out` has one element per direction.
    pub fn xyz_batch(&self, directions: &[[f32; 3]], out: &mut [[f32; 3]]) -> Result<()> {
        check_length(out.len(), directions.len())?;
        for (&direction, xyz) in directions.iter().zip(out) {
            *xyz = self.xyz(direction)?;
        }
        Ok(())
    }

    /// Linear sRGB of the radiance in cd m⁻²: a neutral sky of 1 cd m⁻² is (1, 1, 1). Not clipped, so components of
    /// colours outside the gamut are negative.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn linear_srgb(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        Ok(xyz_to_linear_srgb(self.xyz(direction)?))
    }

    /// Solar irradiance at the wavelengths, in blocks of `N`, W m⁻² nm⁻¹.
    pub(crate) fn irradiance<const N: usize>(&self) -> impl Iterator<Item = [f32; N]> {
        let value = |l: &f64| self.solar_irradiance(*l) as f32;
        let lane = move |block: &[f64], i: usize| block.get(i).map_or(0.0, value);
        let blocks = self.wavelengths.chunks(N);
        blocks.map(move |block| core::array::from_fn(|i| lane(block, i)))
    }

    /// What lies between the wavelengths.
    pub(crate) fn interpolation(&self) -> &Arc<SpectralInterpolation> {
        &self.interpolation
    }

    /// Solar irradiance, W m⁻² nm⁻¹, with the wavelength of the first sample and the step, nm.
    pub(crate) fn solar_spectrum(&self) -> (&[f32], [f64; 2]) {
        (&self.solar, self.solar_axis)
    }

    /// CIE XYZ of a spectrum of relative radiance.
    #[inline(always)]
    pub(crate) fn project_xyz(&self, radiance: &[f32]) -> [f32; 3] {
        let mut sums = [0.0; 3];
        for (block, radiance) in self.tables.xyz.iter().zip(radiance.chunks(LANES)) {
            for (sum, weight) in sums.iter_mut().zip(block) {
                *sum += radiance.iter().zip(weight).map(|(l, w)| l * w).sum::<f32>();
            }
        }
        sums.map(finite)
    }

    /// Angle of the geometric horizon below the horizontal, rad.
    pub(crate) fn dip(&self) -> f64 {
        self.dip
    }

    pub(crate) fn planet(&self) -> Planet {
        self.planet
    }

    pub(crate) fn phi_intervals(&self) -> usize {
        self.phi_intervals
    }

    /// Horizontal and vertical component of the unit vector along a ray.
    pub(crate) fn cylinder(&self, ray: &Ray) -> (f64, f64) {
        let elevation = match ray.side {
            Side::Up => ray.angle - self.dip,
            Side::Down => -ray.angle - self.dip,
        };
        (elevation.cos(), elevation.sin())
    }

    /// All azimuths at the angle of a ray from the horizon.
    pub(crate) fn row(&self, ray: &Ray) -> Row {
        self.tables.row(ray, self.sightline_at(ray, 0.0))
    }

    /// A ray at an azimuth from the sun.
    pub(crate) fn sightline_at(&self, ray: &Ray, phi: f64) -> Sightline {
        let (cosine, sine) = self.cylinder(ray);
        self.sightline(ray, [sine, cosine], phi.cos())
    }

    fn sightline(&self, ray: &Ray, direction: [f64; 2], azimuth: f64) -> Sightline {
        Sightline {
            altitude: self.conditions.altitude,
            ray: direction,
            side: ray.side,
            sun: [self.sun[2], self.sun[0].hypot(self.sun[1])],
            azimuth,
        }
    }

    /// Relative radiance in a row at the azimuth `phi` (0..=π from the sun), with the phase functions taken at `angle`.
    #[inline(always)]
    pub(crate) fn relative_in(&self, row: &Row, phi: f64, angle: SunAngle, out: &mut [f32]) {
        let taps = azimuth(phi, self.phi_intervals);
        let store = |block, radiance| store(out, block, radiance);
        self.tables
            .radiance_in(row, (&taps, phi.cos()), angle, store);
    }

    fn relative_at(&self, direction: [f32; 3], wavelength: f64) -> Result<f64> {
        let nodes = self.wavelengths.as_slice();
        self.interpolation.check(wavelength)?;
        let lookup = self.lookup(direction)?;
        let mut values = [0.0; MOST_WAVELENGTHS];
        let values = &mut values[..nodes.len()];
        self.relative_into(&lookup, values);
        if let Some(over) = &self.over {
            over.blend(direction, wavelength, values)?;
        }
        Ok(self.interpolation.radiance(values, wavelength))
    }

    fn solar_irradiance(&self, wavelength: f64) -> f64 {
        crate::kernel::axis::sample(&self.solar, self.solar_axis, wavelength)
    }

    fn relative_into(&self, lookup: &Lookup, out: &mut [f32]) {
        self.tables
            .radiance(lookup, |block, radiance| store(out, block, radiance));
    }

    fn spectral_into(&self, lookup: &Lookup, out: &mut [f32]) {
        self.tables.radiance(lookup, |block, radiance| {
            let irradiance = &self.tables.irradiance[block];
            let spectral = core::array::from_fn(|i| (radiance[i] * irradiance[i]).min(f32::MAX));
            store(out, block, spectral);
        });
    }

    #[inline(always)]
    pub(crate) fn lookup(&self, direction: [f32; 3]) -> Result<Lookup<'_>> {
        // In double precision the square of every single-precision number is normal.
        let [x, y, z] = direction.map(f64::from);
        let horizontal = x * x + y * y;
        let square = horizontal + z * z;
        if !(square > 0.0 && square.is_finite()) {
            return Err(Error::Direction { got: direction });
        }
        let length = square.sqrt();
        let shrink = 1.0 / length;
        let unit = [x * shrink, y * shrink, z * shrink];
        let elevation = z.atan2(horizontal.sqrt());
        let ray = self
            .planet
            .ray_with_dip(self.conditions.altitude, self.dip, elevation, unit[2]);
        let phi = self.azimuth_from_sun(x, y);
        let angle = SunAngle::between(unit, self.sun);
        let direction = [unit[2], horizontal.sqrt() * shrink];
        let line = self.sightline(&ray, direction, phi.cos());
        let place = (&ray, &line);
        Ok(self.tables.lookup(place, phi, self.phi_intervals, angle))
    }

    pub(crate) fn tables(&self) -> &Tables {
        &self.tables
    }

    /// Unit vector towards the sun; sine and cosine of its azimuth.
    pub(crate) fn sun(&self) -> ([f64; 3], (f64, f64)) {
        (self.sun, self.azimuth)
    }

    /// 0..=π; 0 where the direction is vertical.
    fn azimuth_from_sun(&self, x: f64, y: f64) -> f64 {
        let (sine, cosine) = self.azimuth;
        let along = x * cosine + y * sine;
        let across = x * sine - y * cosine;
        // The sum turns −0 into 0, of which the arc tangent is 0 and not π.
        across.abs().atan2(along + 0.0)
    }

    fn check_output(&self, out: &[f32], directions: usize) -> Result<()> {
        check_length(out.len(), directions.saturating_mul(self.wavelengths.len()))
    }
}

/// Writes a block of wavelengths, of which the last may be cut short.
#[inline(always)]
fn store(out: &mut [f32], block: usize, values: [f32; LANES]) {
    let out = &mut out[block * LANES..];
    match out.first_chunk_mut() {
        Some(whole) => *whole = values,
        None => out.copy_from_slice(&values[..out.len()]),
    }
}

pub(crate) fn check_length(got: usize, expected: usize) -> Result<()> {
    if got == expected {
        return Ok(());
    }
    Err(Error::Length {
        what: "output",
        expected: expected as u64,
        got: got as u64,
    })
}
