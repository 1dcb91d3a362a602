//! The head of a file without skies.

use super::sites::PLANET;
use welkin::axis::ElevationAxis;
use welkin::format::{AlphaAxis, Field, Head, PhaseFunction};

/// The head of a file that knows nothing but the air: as many wavelengths as constituents.
pub fn bare_head(constituents: usize, extinction: Vec<f64>) -> Head {
    let axis = AlphaAxis {
        intervals: 1,
        exponent: 1.0,
    };
    let wavelengths: Vec<f64> = (0..constituents).map(|k| 500.0 + k as f64).collect();
    Head {
        planet: PLANET,
        up: axis,
        down: axis,
        phi_intervals: 1,
        elevation: ElevationAxis {
            min: 0.0,
            max: 1.0,
            centre: 0.0,
            width: 1.0,
            intervals: 1,
        },
        altitudes: vec![0.0],
        visibilities: vec![1e5],
        constituents,
        absorbers: 0,
        estimated: false,
        extinction,
        spherical_albedo: vec![0.0; constituents],
        xyz: vec![[0.0; 3]; constituents],
        solar_start: 500.0,
        solar_step: 1.0,
        solar_irradiance: vec![1.0; constituents],
        fields: vec![Field {
            phase: PhaseFunction::None,
            ground: false,
            estimate: 0,
            parameter: vec![0.0; constituents],
        }],
        metadata: "{}".into(),
        wavelengths,
    }
}
