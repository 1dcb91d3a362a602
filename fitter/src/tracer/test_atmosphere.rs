//! Small atmospheres for tests.

use crate::atmosphere::{Atmosphere, Constituent, Phase, Scatterer};

fn exponential(altitudes: &[f64], height: f64) -> Vec<f64> {
    altitudes.iter().map(|z| (-z / height).exp()).collect()
}

fn frame(wavelengths: usize) -> Atmosphere {
    Atmosphere {
        planet_radius: 6_371_000.0,
        altitudes: (0..=40).map(|i| f64::from(i) * 2000.0).collect(),
        wavelengths: (0..wavelengths).map(|w| 400.0 + 100.0 * w as f64).collect(),
        constituents: vec![],
    }
}

fn scattering(
    name: &str,
    profile: Vec<f64>,
    scattering: Vec<f64>,
    absorption: f64,
    phase: Phase,
) -> Constituent {
    let extinction: Vec<f64> = scattering.iter().map(|s| s + absorption).collect();
    Constituent {
        name: name.into(),
        profile,
        extinction: extinction.clone(),
        scatterers: vec![Scatterer {
            name: name.into(),
            phase,
            extinction,
            scattering,
        }],
    }
}

/// Air and aerosol that absorb nothing.
pub fn conservative(wavelengths: usize) -> Atmosphere {
    let mut atmosphere = frame(wavelengths);
    let w: Vec<f64> = (0..wavelengths).map(|w| w as f64).collect();
    atmosphere.constituents = vec![
        scattering(
            "air",
            exponential(&atmosphere.altitudes, 8000.0),
            w.iter().map(|w| 4e-5 / (1.0 + 0.8 * w).powi(2)).collect(),
            0.0,
            Phase::Rayleigh {
                depolarisation: w.iter().map(|w| 0.03 + 0.01 * w).collect(),
            },
        ),
        scattering(
            "haze",
            exponential(&atmosphere.altitudes, 2000.0),
            w.iter().map(|w| 1e-4 / (1.0 + 0.3 * w)).collect(),
            0.0,
            Phase::HenyeyGreenstein {
                g: w.iter().map(|w| 0.7 - 0.1 * w).collect(),
            },
        ),
    ];
    atmosphere
}

/// Air without depolarisation, and a little absorption, at one wavelength.
pub fn clear() -> Atmosphere {
    let mut atmosphere = frame(1);
    atmosphere.constituents = vec![scattering(
        "air",
        exponential(&atmosphere.altitudes, 8000.0),
        vec![1.2e-5],
        1e-6,
        Phase::Rayleigh {
            depolarisation: vec![0.0],
        },
    )];
    atmosphere
}
