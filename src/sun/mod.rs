//! The disc of the sun: limb darkening, the air before it and the planet's edge. Format specification, section 7.8.
//!
//! `cap` knows where the disc is and what of it is above the horizon, `depths` the air before it, `limb_darkening` how
//! bright it is without air; `quadrature` sums over it.

pub(crate) mod buffers;
mod cap;
mod depths;
mod limb_darkening;
mod quadrature;

use std::sync::Arc;

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::Head;
pub use crate::geometry::SOLAR_ANGULAR_RADIUS;
use crate::kernel::math::finite;
use crate::model::Model;
use crate::sky::{MOST_WAVELENGTHS, check_length};
use crate::spectrum::SpectralInterpolation;
use cap::Cap;
use depths::Depths;
use quadrature::each_line;

/// The disc of the sun as an observer sees it through the air, at the wavelengths of the model.
///
/// Its radiance is that outside the air, which follows from the solar irradiance of the model, with limb darkening from
/// Neckel & Labs 1994, times the transmittance to space, the same as that of [`Transmittance`](crate::Transmittance)
/// and [`AerialPerspective`](crate::AerialPerspective). Light is not refracted. The part of the disc below the
/// geometric horizon is black. Queries do not allocate. `Send + Sync`.
///
/// In a file without transmittance and without estimates the air before the disc is what the sky takes it for, which is
/// much less exact where the sun is low: 5 % too dark at 1°.
///
/// ```
/// use welkin::{Conditions, Model, SOLAR_ANGULAR_RADIUS};
///
/// let disc = Model::default_model()?.solar_disc(&Conditions::default())?;
/// let centre = disc.xyz(disc.direction())?[1]; // cd m⁻²
/// assert!(centre > 1e8);
/// let circle = std::f64::consts::PI * SOLAR_ANGULAR_RADIUS.powi(2);
/// assert!((disc.solid_angle() / circle - 1.0).abs() < 1e-4);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SolarDisc {
    cap: Cap,
    wavelengths: Vec<f64>,
    /// Outside the air, W m⁻² nm⁻¹.
    irradiance: Vec<f32>,
    /// Limb darkening at a wavelength, nm.
    profile_at: fn(f64) -> [f32; 6],
    profile: Vec<[f32; 6]>,
    /// XYZ per unit of relative radiance.
    xyz: Vec<[f32; 3]>,
    /// None where the sun has set.
    depths: Option<Depths>,
    interpolation: Arc<SpectralInterpolation>,
}

impl Model {
    /// The disc of the sun under some conditions, of which the albedo does not count. Needs no sky, and takes about as
    /// long as a few dozen queries of one.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model; [`Error::MissingChunk`] if the file has neither
    /// transmittance nor the columns of these altitudes; [`Error::Checksum`], [`Error::Encoding`], [`Error::Length`] or
    /// [`Error::Invalid`] if what is needed is damaged; [`Error::Read`].
    pub fn solar_disc(&self, conditions: &Conditions) -> Result<SolarDisc> {
        SolarDisc::prepare(self, self.head(), conditions)
    }
}

impl SolarDisc {
    /// At the wavelengths of `head`, which is that of the model or of some nodes.
    pub(crate) fn prepare(model: &Model, head: &Head, conditions: &Conditions) -> Result<Self> {
        let conditions = &conditions.checked(model)?;
        let cap = Cap::new(conditions, head.planet.dip(conditions.altitude));
        let depths = match cap.is_visible() {
            true => Some(Depths::new(model, head, conditions, cap.band())?),
            false => None,
        };
        let wavelengths = head.wavelengths.iter();
        let profile_at = match model.is_moonlit() {
            true => limb_darkening::none,
            false => limb_darkening::profile,
        };
        Ok(Self {
            profile_at,
            irradiance: wavelengths
                .clone()
                .map(|&l| head.solar_irradiance_at(l) as f32)
                .collect(),
            profile: wavelengths.map(|&l| profile_at(l)).collect(),
            xyz: head.xyz.iter().map(|xyz| xyz.map(|v| v as f32)).collect(),
            wavelengths: head.wavelengths.clone(),
            cap,
            depths,
            interpolation: model.shared_interpolation()?.clone(),
        })
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// Unit vector towards the centre.
    pub fn direction(&self) -> [f32; 3] {
        self.cap.centre().map(|v| v as f32)
    }

    /// Whether any of the disc is above the geometric horizon.
    pub fn is_visible(&self) -> bool {
        self.depths.is_some()
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ of the disc alone, zero beside it and below the horizon. Add that of the
    /// sky in front of it.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite; [`Error::Length`] unless `out` has one element
    /// per wavelength.
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length(out.len(), self.wavelengths.len())?;
        let Some(spot) = self.spot(direction)? else {
            out.fill(0.0);
            return Ok(());
        };
        self.relative_radiance(&spot, out);
        let pairs = out.iter_mut().zip(&self.irradiance);
        pairs.for_each(|(out, irradiance)| *out = (*out * irradiance).min(f32::MAX));
        Ok(())
    }

    /// [`SolarDisc::radiance`] at any wavelength (nm) within the range of the model. In a model without a spectrum it is
    /// interpolated as that of the sky is.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite; [`Error::OutOfRange`] for the wavelength.
    pub fn radiance_at(&self, direction: [f32; 3], wavelength: f64) -> Result<f32> {
        let interpolation = &self.interpolation;
        interpolation.check(wavelength)?;
        let Some(spot) = self.spot(direction)? else {
            return Ok(0.0);
        };
        let known = (spot.depths).transmittance_at(interpolation, spot.elevation, wavelength);
        let relative = match known {
            Some(transmittance) => {
                let profile = (self.profile_at)(wavelength);
                let disc = limb_darkening::evaluate(&profile, spot.mu);
                transmittance * f64::from(disc) / self.cap.solid_angle()
            }
            None => {
                let mut values = [0.0; MOST_WAVELENGTHS];
                let values = &mut values[..self.wavelengths.len()];
                self.relative_radiance(&spot, values);
                interpolation.radiance(values, wavelength)
            }
        };
        let radiance = relative * interpolation.solar_irradiance(wavelength);
        Ok(radiance.clamp(0.0, f64::from(f32::MAX)) as f32)
    }

    /// CIE 1931 XYZ of the disc alone; Y is the luminance in cd m⁻².
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        let Some(spot) = self.spot(direction)? else {
            return Ok([0.0; 3]);
        };
        let mut relative = [0.0; MOST_WAVELENGTHS];
        let relative = &mut relative[..self.wavelengths.len()];
        self.relative_radiance(&spot, relative);
        let mut sums = [0.0; 3];
        for (l, weights) in relative.iter().zip(&self.xyz) {
            sums = core::array::from_fn(|c| sums[c] + l * weights[c]);
        }
        Ok(sums.map(finite))
    }

    /// Where in the visible part of the disc a direction is, if it is.
    fn spot(&self, direction: [f32; 3]) -> Result<Option<Spot<'_>>> {
        let unit = unit(direction).ok_or(Error::Direction { got: direction })?;
        let square = self.cap.square(unit);
        let Some(depths) = self.depths.as_ref().filter(|_| square <= 1.0) else {
            return Ok(None);
        };
        let elevation = unit[2].clamp(-1.0, 1.0).asin();
        Ok((elevation >= self.cap.lowest()).then_some(Spot {
            depths,
            elevation,
            mu: (1.0 - square).sqrt() as f32,
        }))
    }

    /// Per unit of solar irradiance, sr⁻¹.
    fn relative_radiance(&self, spot: &Spot, out: &mut [f32]) {
        spot.depths.transmittance(spot.elevation, out);
        let mean = (1.0 / self.cap.solid_angle()) as f32;
        for (out, profile) in out.iter_mut().zip(&self.profile) {
            *out *= mean * limb_darkening::evaluate(profile, spot.mu);
        }
    }

    /// Spectral irradiance in W m⁻² nm⁻¹ that the visible part of the disc gives one side of a plane with this normal.
    ///
    /// # Errors
    /// As [`SolarDisc::radiance`].
    pub fn irradiance(&self, normal: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length(out.len(), self.wavelengths.len())?;
        let normal = unit(normal).ok_or(Error::Direction { got: normal })?;
        let sums = self.integrate(Some(normal));
        for (out, (sum, irradiance)) in out.iter_mut().zip(sums.iter().zip(&self.irradiance)) {
            *out = (sum * f64::from(*irradiance)).min(f64::from(f32::MAX)) as f32;
        }
        Ok(())
    }

    /// Luminance times solid angle, cd sr m⁻².
    pub(crate) fn flux(&self) -> f64 {
        let luminances = self.xyz.iter().map(|xyz| f64::from(xyz[1]));
        let sums = self.integrate(None);
        let flux: f64 = luminances.zip(sums).map(|(y, sum)| y * sum).sum();
        flux.max(0.0)
    }

    /// Light of the visible part, with a normal that on its plane, per unit of irradiance outside the air.
    fn integrate(&self, normal: Option<[f64; 3]>) -> [f64; MOST_WAVELENGTHS] {
        let mut sums = [0.0; MOST_WAVELENGTHS];
        let Some(depths) = &self.depths else {
            return sums;
        };
        let mut transmittance = [0.0; MOST_WAVELENGTHS];
        let transmittance = &mut transmittance[..self.wavelengths.len()];
        each_line(&self.cap, normal, |elevation, moments| {
            depths.transmittance(elevation, transmittance);
            let terms = transmittance.iter().zip(&self.profile);
            for (sum, (transmittance, profile)) in sums.iter_mut().zip(terms) {
                let products = profile.iter().zip(moments).map(|(&a, m)| f64::from(a) * m);
                *sum += f64::from(*transmittance) * products.sum::<f64>();
            }
        });
        sums
    }

    /// Solid angle of the whole disc, sr.
    pub fn solid_angle(&self) -> f64 {
        self.cap.solid_angle()
    }

    /// Maps the unit square to the visible part of the disc, uniformly in solid angle.
    pub(crate) fn draw(&self, place: [f64; 2]) -> [f32; 3] {
        self.cap.draw(place).map(|v| v as f32)
    }

    /// The density of [`SolarDisc::draw`], sr⁻¹. Reaches a little beyond the disc, so that rounding a direction never
    /// gives one that is bright and has the density of the sky.
    pub(crate) fn density(&self, direction: [f32; 3]) -> f32 {
        let covered = unit(direction).is_some_and(|unit| self.cap.covers(unit));
        match covered {
            true => (1.0 / self.cap.drawn_solid_angle()) as f32,
            false => 0.0,
        }
    }
}

/// A place in the visible part of the disc.
struct Spot<'a> {
    depths: &'a Depths,
    /// rad.
    elevation: f64,
    /// Cosine of the heliocentric angle.
    mu: f32,
}

fn unit(vector: [f32; 3]) -> Option<[f64; 3]> {
    let vector = vector.map(f64::from);
    let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    (length > 0.0 && length.is_finite()).then(|| vector.map(|v| v / length))
}
