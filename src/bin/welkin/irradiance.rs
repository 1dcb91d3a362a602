//! What sun and sky give a level plane.

use std::f64::consts::{FRAC_PI_2, PI};

use welkin::{Conditions, Model, Sky, xyz_to_linear_srgb};

use crate::failure::Result;

/// Irradiance (W m⁻² nm⁻¹) or radiance (W m⁻² sr⁻¹ nm⁻¹) at the wavelengths of the model.
#[derive(Clone, Debug)]
pub struct Spectrum(pub Vec<f32>);

impl Spectrum {
    /// CIE 1931 XYZ; Y in lx or cd m⁻².
    fn xyz(&self, model: &Model) -> [f32; 3] {
        xyz(model, &self.0)
    }

    /// Illuminance, lx, or luminance, cd m⁻².
    pub fn luminous(&self, model: &Model) -> f32 {
        self.xyz(model)[1]
    }

    /// Components in lx or cd m⁻²: those of a neutral colour are its illuminance or luminance.
    pub fn linear_srgb(&self, model: &Model) -> [f32; 3] {
        xyz_to_linear_srgb(self.xyz(model))
    }
}

/// CIE 1931 XYZ of a spectrum; Y in lx or cd m⁻².
pub fn xyz(model: &Model, spectrum: &[f32]) -> [f32; 3] {
    let head = model.head();
    let mut sum = [0.0; 3];
    for ((value, weights), &nm) in spectrum.iter().zip(&head.xyz).zip(&head.wavelengths) {
        // The weights are per unit of relative radiance.
        let irradiance = head.solar_irradiance_at(nm);
        if irradiance > 0.0 {
            let relative = f64::from(*value) / irradiance;
            sum = std::array::from_fn(|c| sum[c] + weights[c] * relative);
        }
    }
    // Absurd files overflow; the result stays a number.
    sum.map(|v| v.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32)
}

/// Sun and sky at one place.
pub struct Light {
    pub conditions: Conditions,
    /// Of the whole disc, sr.
    pub solid_angle: f64,
    /// On a plane that faces the sun's centre.
    pub direct_normal: Spectrum,
    pub direct_horizontal: Spectrum,
    pub diffuse_horizontal: Spectrum,
    pub global_horizontal: Spectrum,
    /// Radiance of a uniform disc that gives the direct irradiance; what is below the horizon counts as black.
    pub disc_mean: Spectrum,
    pub disc_centre: Spectrum,
}

impl Light {
    pub fn new(model: &Model, conditions: &Conditions) -> Result<Self> {
        let sky = model.sky(conditions)?;
        let disc = model.solar_disc(sky.conditions())?;
        let zeros = || vec![0.0; model.wavelengths().len()];
        let [mut normal, mut level, mut centre] = [zeros(), zeros(), zeros()];
        disc.irradiance(disc.direction(), &mut normal)?;
        disc.irradiance([0.0, 0.0, 1.0], &mut level)?;
        disc.radiance(disc.direction(), &mut centre)?;
        let diffuse = skylight(&sky)?;
        let both = level.iter().zip(&diffuse).map(|(a, b)| a + b).collect();
        let solid_angle = disc.solid_angle();
        let mean = normal.iter().map(|&e| (f64::from(e) / solid_angle) as f32);
        Ok(Self {
            conditions: *sky.conditions(),
            solid_angle,
            disc_mean: Spectrum(mean.collect()),
            direct_normal: Spectrum(normal),
            direct_horizontal: Spectrum(level),
            diffuse_horizontal: Spectrum(diffuse),
            global_horizontal: Spectrum(both),
            disc_centre: Spectrum(centre),
        })
    }
}

/// Rings of the quadrature over the upper hemisphere, and points of half a ring.
const RINGS: usize = 180;
const SPOKES: usize = 96;

/// Irradiance of a level plane by the sky alone.
pub fn skylight(sky: &Sky) -> Result<Vec<f32>> {
    let sun = sky.conditions().solar_azimuth;
    let mut radiance = vec![0.0; sky.wavelengths().len()];
    let mut sums = vec![0.0f64; radiance.len()];
    // Even in elevation: where the sun is low, much of the light comes from near the horizon.
    let elevation = |ring: f64| FRAC_PI_2 * ring / RINGS as f64;
    for ring in 0..RINGS {
        let (z, level) = elevation(ring as f64 + 0.5).sin_cos();
        let [low, high] = [0, 1].map(|end| elevation((ring + end) as f64).sin());
        // Solid angle times cosine, of all of the ring.
        let of_ring = PI * (high * high - low * low);
        for spoke in 0..SPOKES {
            // Both halves are alike. Denser towards the sun: u ↦ φ with dφ = 2u du.
            let u = (spoke as f64 + 0.5) / SPOKES as f64;
            let (y, x) = (sun + PI * u * u).sin_cos();
            let weight = of_ring * 2.0 * u / SPOKES as f64;
            sky.radiance([level * x, level * y, z].map(|v| v as f32), &mut radiance)?;
            for (sum, value) in sums.iter_mut().zip(&radiance) {
                *sum += weight * f64::from(*value);
            }
        }
    }
    Ok(sums.iter().map(|&sum| sum as f32).collect())
}
