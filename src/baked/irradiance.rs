//! Light from the whole sky on a plane.

use core::f64::consts::TAU;

use super::baked_spectral::BakedSky;
use crate::error::{Error, Result};
use crate::sky::{MOST_WAVELENGTHS, check_length};

/// Cells of the quadrature: above and below the horizon, around it.
const UP: usize = 32;
const DOWN: usize = 16;
const AROUND: usize = 96;

impl BakedSky {
    /// Spectral irradiance in W m⁻² nm⁻¹ that the sky without the sun's disc gives one side of a plane with this
    /// normal. Ground below the horizon is black, as everywhere. Takes some thousand queries.
    ///
    /// # Errors
    /// [`Error::Direction`] for a normal that is zero or not finite; [`Error::Length`] unless `out` has one element per
    /// wavelength.
    pub fn irradiance(&self, normal: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length(out.len(), self.wavelengths().len())?;
        let [nx, ny, nz] = normal.map(f64::from);
        let length = (nx * nx + ny * ny + nz * nz).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::Direction { got: normal });
        }
        let mut spectrum = [0.0; MOST_WAVELENGTHS];
        let spectrum = &mut spectrum[..out.len()];
        out.fill(0.0);
        for row in 0..UP + DOWN {
            let [low, high] = self.frame().row(row, UP, DOWN);
            let z = 0.5 * (low + high);
            let r = (1.0 - z * z).max(0.0).sqrt();
            let solid_angle = (high - low).abs() * TAU / AROUND as f64;
            for i in 0..AROUND {
                let azimuth = (i as f64 + 0.5) * TAU / AROUND as f64;
                let (y, x) = azimuth.sin_cos();
                let cosine = (r * x * nx + r * y * ny + z * nz) / length;
                if cosine > 0.0 {
                    self.radiance([r * x, r * y, z].map(|v| v as f32), spectrum)?;
                    let weight = (cosine * solid_angle) as f32;
                    let pairs = out.iter_mut().zip(spectrum.iter());
                    pairs.for_each(|(sum, l)| *sum = (*sum + weight * l).min(f32::MAX));
                }
            }
        }
        Ok(())
    }
}
