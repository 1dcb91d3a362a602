//! The paper's way to the light of finite segments: the difference of two skies.

use super::prepared::AerialPerspective;
use crate::budget::{Budget, Channels};
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::place::Place;
use crate::point_query::{Interpolation, PointQuery};
use crate::sky::MOST_WAVELENGTHS;
use crate::transmittance::Transmittance;

/// In-scattered light of segments as Wilkie et al. 2021 compute it (Eq. 2): the sky that is seen from the start of a
/// segment less the sky that is seen from its end, attenuated by the way between. For comparison with
/// [`AerialPerspective`], whose frame and conditions it has: where both terms are nearly the same (short segments,
/// horizon) what is left is mostly their errors.
///
/// Values are radiances per unit of solar irradiance at the wavelengths of the model, sr⁻¹, and can be negative.
/// Nothing is allocated. `Send + Sync`.
///
/// ```
/// # #[cfg(feature = "default-model")]
/// # fn main() -> welkin::Result<()> {
/// use welkin::{Conditions, Model};
///
/// let model = Model::default_model()?;
/// let difference = model.sky_difference(&Conditions::default())?;
/// let mut light = vec![0.0; model.head().wavelengths.len()];
/// difference.in_scattering([0.0, 0.0, 10.0], [20e3, 0.0, 500.0], &mut light)?;
/// assert!(light.iter().all(|l| l.is_finite()));
/// # Ok(())
/// # }
/// # #[cfg(not(feature = "default-model"))]
/// # fn main() {}
/// ```
pub struct SkyDifference<'a> {
    conditions: Conditions,
    sun: [f64; 3],
    transmittance: Transmittance,
    skies: PointQuery<'a>,
    suns: [f64; 2],
    irradiance: Vec<f32>,
}

/// Expected relative errors of the radiance of the sky and of in-scattered light.
const EXPECTED: [f32; 2] = [0.003, 0.006];
/// The paper's renderer blurs up to this altitude (m) …
const BLUR_ALTITUDE: f64 = 300.0;
/// … this close to the horizon (rad) …
const BLUR_ANGLE: f64 = 0.052_36;
/// … by this many tilts up and down …
const TILTS: i32 = 3;
/// … of up to this much (rad).
const BLUR_TILT: f64 = 0.004_363;

impl Model {
    /// Prepares Eq. 2 of Wilkie et al. 2021 for a scene, with the same conditions and frame as
    /// [`Model::aerial_perspective`].
    ///
    /// # Errors
    /// As [`Model::transmittance`], [`Model::plan`] and [`Model::point_query`]; [`Error::OutOfRange`].
    pub fn sky_difference(&self, conditions: &Conditions) -> Result<SkyDifference<'_>> {
        self.refuse_ground()?;
        let conditions = conditions.checked(self)?;
        let plan = self.plan(&Budget {
            altitude: self.altitude_range(),
            visibility: [conditions.visibility; 2],
            solar_elevation: self.solar_elevation_range(),
            tolerance: 1.0,
            channels: Channels::Spectral,
        })?;
        let head = self.head();
        let wavelengths = head.wavelengths.iter();
        Ok(SkyDifference {
            conditions,
            sun: conditions.sun_direction(),
            transmittance: self.transmittance(conditions.visibility)?,
            skies: self
                .point_query(&plan)?
                .with_interpolation(Interpolation::Full),
            suns: self.solar_elevation_range(),
            irradiance: wavelengths
                .map(|&l| head.solar_irradiance_at(l) as f32)
                .collect(),
        })
    }
}

impl SkyDifference<'_> {
    /// The difference from `from` to `to`, m.
    ///
    /// # Errors
    /// [`Error::Length`] unless `out` has one element per wavelength; [`Error::OutOfRange`] for a point above the
    /// altitudes of the model and below the end of the air; [`Error::Point`], [`Error::Direction`].
    pub fn in_scattering(&self, from: [f64; 3], to: [f64; 3], out: &mut [f32]) -> Result<()> {
        let mut far = [0.0; MOST_WAVELENGTHS];
        self.terms(from, to, out, &mut far)?;
        out.iter_mut().zip(far).for_each(|(near, far)| *near -= far);
        Ok(())
    }

    /// The same as the paper's renderer shows it: up to 300 m, within 3° of the horizon, the mean of seven directions
    /// within ±0.25° of elevation, each not below zero.
    ///
    /// # Errors
    /// As [`SkyDifference::in_scattering`].
    pub fn blurred(&self, from: [f64; 3], to: [f64; 3], out: &mut [f32]) -> Result<()> {
        let way: [f64; 3] = core::array::from_fn(|k| to[k] - from[k]);
        let level = way[0].hypot(way[1]);
        let (elevation, length) = (way[2].atan2(level), level.hypot(way[2]));
        let low = self.place(from)?.altitude() <= BLUR_ALTITUDE;
        if !low || elevation.abs() > BLUR_ANGLE || level == 0.0 {
            return self.in_scattering(from, to, out);
        }
        self.check(out)?;
        let (mut one, n) = ([0.0; MOST_WAVELENGTHS], out.len());
        out.fill(0.0);
        for i in -TILTS..=TILTS {
            let tilt = BLUR_TILT * f64::from(i) / f64::from(TILTS);
            let (z, r) = (elevation + tilt).sin_cos();
            let to = [
                from[0] + length * r * way[0] / level,
                from[1] + length * r * way[1] / level,
                from[2] + length * z,
            ];
            self.in_scattering(from, to, &mut one[..n])?;
            for (sum, value) in out.iter_mut().zip(one) {
                *sum += value.max(0.0) / (2 * TILTS + 1) as f32;
            }
        }
        Ok(())
    }

    /// The difference and [`AerialPerspective::in_scattering`], weighted by the inverse of their expected variances.
    ///
    /// # Errors
    /// As [`SkyDifference::in_scattering`] and [`AerialPerspective::in_scattering`].
    pub fn blended(
        &self,
        aerial: &AerialPerspective,
        from: [f64; 3],
        to: [f64; 3],
        out: &mut [f32],
    ) -> Result<()> {
        let [mut far, mut source, mut through] = [[0.0; MOST_WAVELENGTHS]; 3];
        self.terms(from, to, out, &mut far)?;
        let n = out.len();
        aerial.in_scattering(from, to, &mut source[..n], &mut through[..n])?;
        for (w, near) in out.iter_mut().enumerate() {
            let (source, far) = (source[w] / self.irradiance[w], far[w]);
            let of_difference = EXPECTED[0].powi(2) * (*near * *near + far * far);
            let of_source = (EXPECTED[1] * source).powi(2);
            let share = of_source / (of_source + of_difference).max(f32::MIN_POSITIVE);
            *near = source + share * (*near - far - source);
        }
        Ok(())
    }

    /// Both terms of Eq. 2.
    fn terms(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        near: &mut [f32],
        far: &mut [f32; MOST_WAVELENGTHS],
    ) -> Result<()> {
        self.check(near)?;
        let n = near.len();
        let mut through = [0.0; MOST_WAVELENGTHS];
        self.transmittance
            .transmittance(from, to, &mut through[..n])?;
        let way: [f64; 3] = core::array::from_fn(|k| to[k] - from[k]);
        let largest = way.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        // A segment without length has no light.
        if largest == 0.0 {
            near.fill(0.0);
            return Ok(());
        }
        let way = way.map(|v| v / largest);
        self.sky(from, way, near)?;
        self.sky(to, way, &mut far[..n])?;
        far.iter_mut().zip(through).for_each(|(far, t)| *far *= t);
        Ok(())
    }

    /// The sky that an observer at a point sees in a direction.
    fn sky(&self, point: [f64; 3], direction: [f64; 3], out: &mut [f32]) -> Result<()> {
        let place = self.place(point)?;
        // Rounding must not ask for a sky from beyond the air.
        if place.altitude() >= 0.999 * self.transmittance.planet().top {
            out.fill(0.0);
            return Ok(());
        }
        let here = place.conditions(self.sun, &self.conditions)?;
        let conditions = Conditions {
            solar_elevation: here.solar_elevation.clamp(self.suns[0], self.suns[1]),
            ..here
        };
        self.skies
            .relative_radiance(&conditions, place.direction(direction), out)
    }

    fn place(&self, point: [f64; 3]) -> Result<Place> {
        let planet = self.transmittance.planet();
        Place::new(&planet, [0.0, 0.0, -planet.radius], point)
    }

    fn check(&self, out: &[f32]) -> Result<()> {
        match out.len() == self.irradiance.len() {
            true => Ok(()),
            false => Err(Error::Length {
                what: "output",
                expected: self.irradiance.len() as u64,
                got: out.len() as u64,
            }),
        }
    }
}
