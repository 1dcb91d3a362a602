//! The lit ground under a sky: what fills the lower half of an environment map.
//!
//! Lambertian, of the albedo of the conditions, in the light of sun and sky at the place that is seen: there the sun
//! stands higher or lower than above the observer. The air before it takes some of that and adds its own, which the sky
//! has already.

use std::f64::consts::PI;

use welkin::geometry::{Planet, Side};
use welkin::{Conditions, Model, Transmittance};

use crate::failure::{Failure, Result};
use crate::irradiance::{Light, xyz};

/// Most degrees between the suns of the table.
const STEP: f64 = 0.5;

/// The ground that an observer sees.
pub struct Ground {
    air: Transmittance,
    planet: Planet,
    altitude: f64,
    sun: [f64; 3],
    /// Lowest solar elevation of the table and distance of its rows, rad.
    lowest: f64,
    step: f64,
    /// Logarithms of the radiance of the ground, `[sun][wavelength]`.
    radiance: Vec<Vec<f32>>,
    /// To linear sRGB from spectral radiance, `[wavelength]`.
    srgb: Vec<[f32; 3]>,
    /// Albedos where they depend on wavelength and are not in the radiance, `[wavelength]`.
    albedos: Option<Vec<f32>>,
}

impl Ground {
    /// For an observer under these conditions, or beyond the air.
    pub fn new(model: &Model, conditions: &Conditions) -> Result<Self> {
        let planet = model.head().planet;
        let altitude = conditions.altitude;
        let [_, ceiling] = model.altitude_range();
        let below = Conditions {
            altitude: altitude.min(ceiling),
            ..*conditions
        };
        let conditions = below.checked(model)?;
        // The farthest ground stands as far away, seen from the planet's centre, as the horizon dips.
        let altitude = altitude.max(conditions.altitude);
        let reach = planet.dip(altitude);
        let [min, max] = model.solar_elevation_range();
        let lowest = (conditions.solar_elevation - reach).clamp(min, max);
        let highest = (conditions.solar_elevation + reach).clamp(min, max);
        let intervals = ((highest - lowest).to_degrees() / STEP).ceil() as usize;
        let step = (highest - lowest) / intervals.max(1) as f64;
        let radiance = (0..=intervals).map(|i| {
            let there = Conditions {
                altitude: 0.0,
                solar_elevation: (lowest + step * i as f64).clamp(min, max),
                ..conditions
            };
            row(model, &there)
        });
        let in_colours = model.albedos_in_colours()?;
        let unit = |w: usize| {
            let mut spectrum = vec![0.0; model.wavelengths().len()];
            spectrum[w] = in_colours.as_ref().map_or(1.0, |albedos| albedos[w] as f32);
            welkin::xyz_to_linear_srgb(xyz(model, &spectrum))
        };
        Ok(Self {
            radiance: radiance.collect::<Result<_>>()?,
            air: model.transmittance(conditions.visibility)?,
            sun: conditions.sun_direction(),
            altitude,
            albedos: albedos(model),
            srgb: (0..model.wavelengths().len()).map(unit).collect(),
            planet,
            lowest,
            step,
        })
    }

    /// Adds its spectral radiance (W m⁻² sr⁻¹ nm⁻¹), seen through the air, to that of the sky; nothing above the
    /// horizon.
    pub fn add(&self, direction: [f32; 3], radiance: &mut [f32]) -> welkin::Result<()> {
        if let Some(ground) = self.seen(direction)? {
            let albedo = |w: usize| self.albedos.as_ref().map_or(1.0, |albedos| albedos[w]);
            let pairs = radiance.iter_mut().zip(ground).enumerate();
            pairs.for_each(|(w, (sum, l))| *sum += albedo(w) * l);
        }
        Ok(())
    }

    /// The same in linear sRGB, cd m⁻².
    pub fn add_srgb(&self, direction: [f32; 3], rgb: &mut [f32; 3]) -> welkin::Result<()> {
        if let Some(ground) = self.seen(direction)? {
            for (weights, l) in self.srgb.iter().zip(ground) {
                *rgb = std::array::from_fn(|c| rgb[c] + weights[c] * l);
            }
        }
        Ok(())
    }

    fn seen(&self, direction: [f32; 3]) -> welkin::Result<Option<Vec<f32>>> {
        let [x, y, z] = direction.map(f64::from);
        let level = x.hypot(y);
        let ray = self.planet.ray(self.altitude, z.atan2(level));
        if ray.side == Side::Up {
            return Ok(None);
        }
        let distance = ray.length / level.hypot(z);
        let from = [0.0, 0.0, self.altitude];
        let point = [x, y, z].map(|v| v * distance);
        let point = [point[0], point[1], point[2] + self.altitude];
        let mut ground = vec![0.0; self.srgb.len()];
        self.air.transmittance(from, point, &mut ground)?;
        let zenith = [point[0], point[1], point[2] + self.planet.radius];
        let radius = zenith.iter().map(|v| v * v).sum::<f64>().sqrt();
        let sine: f64 = (0..3).map(|k| zenith[k] * self.sun[k]).sum::<f64>() / radius;
        let elevation = sine.clamp(-1.0, 1.0).asin();
        let last = self.radiance.len() - 1;
        let u = match self.step > 0.0 {
            true => ((elevation - self.lowest) / self.step).clamp(0.0, last as f64),
            false => 0.0,
        };
        let i = (u as usize).min(last.saturating_sub(1));
        let t = (u - i as f64) as f32;
        let rows = self.radiance[i].iter().zip(&self.radiance[last.min(i + 1)]);
        for (l, (low, high)) in ground.iter_mut().zip(rows) {
            *l *= (low + t * (high - low)).exp();
        }
        Ok(Some(ground))
    }
}

/// At the wavelengths of the model, where its ground has one for each.
fn albedos(model: &Model) -> Option<Vec<f32>> {
    let ground = model.ground()?;
    let at = |&l: &f64| ground.at(l) as f32;
    Some(model.wavelengths().iter().map(at).collect())
}

/// Logarithms of the radiance of the ground at one place; of a white one, where the albedo depends on wavelength.
fn row(model: &Model, conditions: &Conditions) -> Result<Vec<f32>> {
    let light = Light::new(model, conditions).map_err(|failure| match failure {
        Failure::Message(text) => Failure::message(format!("the light on the ground: {text}")),
        other => other,
    })?;
    let albedo = model.ground().map_or(conditions.albedo, |_| 1.0);
    let reflected = (albedo / PI) as f32;
    let logarithm = |&e: &f32| (reflected * e).max(f32::MIN_POSITIVE).ln();
    Ok(light.global_horizontal.0.iter().map(logarithm).collect())
}
