//! What the model says of measured directions and wavelengths.

use anyhow::Result;
use welkin::{Conditions, Model};

/// A unit vector.
pub fn direction(elevation: f64, azimuth: f64) -> [f32; 3] {
    let level = elevation.cos();
    [
        level * azimuth.cos(),
        level * azimuth.sin(),
        elevation.sin(),
    ]
    .map(|v| v as f32)
}

/// Angle between two directions, rad.
pub fn between(a: [f32; 3], b: [f32; 3]) -> f64 {
    let dot: f64 = (0..3).map(|i| f64::from(a[i]) * f64::from(b[i])).sum();
    dot.clamp(-1.0, 1.0).acos()
}

/// Radiance (W m⁻² sr⁻¹ nm⁻¹) by direction and wavelength (nm), under a sun of an intensity relative to that at 1 AU.
pub fn radiance(
    model: &Model,
    conditions: &Conditions,
    intensity: f64,
    directions: &[[f32; 3]],
    wavelengths: &[f64],
) -> Result<Vec<Vec<f64>>> {
    let sky = model.sky(conditions)?;
    let spectrum = model.spectral_interpolation()?;
    let mut nodes = vec![0.0; model.wavelengths().len()];
    let mut out = Vec::with_capacity(directions.len());
    for &direction in directions {
        sky.relative_radiance(direction, &mut nodes)?;
        let mut row = Vec::with_capacity(wavelengths.len());
        for &wavelength in wavelengths {
            let share = f64::from(spectrum.between(&nodes, wavelength)?);
            row.push(intensity * share * spectrum.solar_irradiance(wavelength));
        }
        out.push(row);
    }
    Ok(out)
}
