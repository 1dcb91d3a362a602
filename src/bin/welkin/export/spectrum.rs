//! The spectrum of the sun as samples that renderers join by straight lines.

use welkin::{Conditions, Model, Response};

use crate::failure::Result;
use crate::irradiance::Light;

/// Wavelengths that renderers see, nm, and the distance of samples.
const SEEN: [f64; 2] = [360.0, 830.0];
const STEP: f64 = 5.0;

/// Wavelengths (nm) and irradiance (W m⁻² nm⁻¹) of a plane that faces the sun: the mean over a triangle of two steps
/// around each, so that lines narrower than a step take what they take.
pub fn samples(model: &Model, conditions: &Conditions) -> Result<Vec<(f64, f32)>> {
    if !model.has_spectrum() {
        let light = Light::new(model, conditions)?;
        let nodes = model.wavelengths().iter().copied();
        return Ok(nodes.zip(light.direct_normal.0).collect());
    }
    let [shortest, longest] = model.wavelength_range()?;
    let count = ((SEEN[1] - SEEN[0]) / STEP).round() as usize;
    let all = (0..=count).map(|k| SEEN[0] + STEP * k as f64);
    let wavelengths: Vec<f64> = all
        .filter(|nm| nm - STEP >= shortest && nm + STEP <= longest)
        .collect();
    let triangle = |&nm: &f64| {
        let response = Response::table(&[nm - STEP, nm, nm + STEP], &[0.0, 1.0, 0.0])?;
        Ok(response.normalised())
    };
    let responses = wavelengths.iter().map(triangle);
    let bands = model.bands(&responses.collect::<welkin::Result<Vec<_>>>()?)?;
    let disc = model.band_solar_disc(conditions, &bands)?;
    let mut values = vec![0.0; wavelengths.len()];
    disc.irradiance(disc.direction(), &mut values)?;
    Ok(wavelengths.into_iter().zip(values).collect())
}
