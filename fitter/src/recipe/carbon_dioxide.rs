//! Rayleigh scattering of carbon dioxide, from its refractive index and King factor.

use crate::atmosphere::{Constituent, Monochromatic, Phase, Scatterer};
use std::f64::consts::PI;

/// Molecules per cm³ at 15 °C and 1013.25 hPa, for which the index holds.
const LOSCHMIDT: f64 = 2.546_899e19;

/// A constituent of `densities` molecules per cm³ at the nodes.
pub fn scattering(densities: Vec<f64>, lights: &[Monochromatic]) -> Constituent {
    let most = densities.iter().fold(0.0, |a: f64, &b| a.max(b));
    let coefficient = |l: &Monochromatic| cross_section(l.wavelength) * most * 100.0;
    let scattering: Vec<f64> = lights.iter().map(coefficient).collect();
    Constituent {
        name: "carbon dioxide".into(),
        profile: densities.iter().map(|n| n / most).collect(),
        extinction: scattering.clone(),
        scatterers: vec![Scatterer {
            name: "rayleigh".into(),
            phase: Phase::Rayleigh {
                depolarisation: lights
                    .iter()
                    .map(|l| depolarisation(l.wavelength))
                    .collect(),
            },
            extinction: scattering.clone(),
            scattering,
        }],
    }
}

/// Wavenumber, cm⁻¹.
fn wavenumber(wavelength: f64) -> f64 {
    1e7 / wavelength
}

/// Refractive index less 1: Bideau-Mehu et al. 1973, as Sneep and Ubachs 2005 give it.
fn refractivity(wavelength: f64) -> f64 {
    let square = wavenumber(wavelength).powi(2);
    let terms = [
        (5799.25, 128_908.9),
        (120.05, 89_223.8),
        (5.3334, 75_037.5),
        (4.3244, 67_837.7),
        (1.218_145e-5, 2418.136),
    ];
    let term = |(a, pole): (f64, f64)| a / (pole * pole - square);
    1.1427e3 * terms.into_iter().map(term).sum::<f64>()
}

/// Sneep and Ubachs 2005.
fn king_factor(wavelength: f64) -> f64 {
    1.1364 + 25.3e-12 * wavenumber(wavelength).powi(2)
}

/// cm².
fn cross_section(wavelength: f64) -> f64 {
    let square = (1.0 + refractivity(wavelength)).powi(2);
    let lorentz = (square - 1.0) / (square + 2.0);
    let centimetres = wavelength * 1e-7;
    24.0 * PI.powi(3) / (centimetres.powi(4) * LOSCHMIDT.powi(2))
        * lorentz.powi(2)
        * king_factor(wavelength)
}

/// From the King factor (6 + 3ρ)/(6 − 7ρ).
fn depolarisation(wavelength: f64) -> f64 {
    let king = king_factor(wavelength);
    6.0 * (king - 1.0) / (3.0 + 7.0 * king)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kaye and Laby: 449e-6 at 589.3 nm, 0 °C and one atmosphere.
    #[test]
    fn the_refractive_index_is_the_published_one() {
        let at_freezing = refractivity(589.3) * 288.15 / 273.15;
        assert!((at_freezing / 449e-6 - 1.0).abs() < 0.005, "{at_freezing}");
    }

    /// Bodhaine et al. 1999 take a King factor of 1.15; ρ of that is 0.081.
    #[test]
    fn molecules_are_as_long_as_is_known() {
        assert!((king_factor(550.0) - 1.15).abs() < 0.01);
        let rho = depolarisation(550.0);
        assert!(((6.0 + 3.0 * rho) / (6.0 - 7.0 * rho) - king_factor(550.0)).abs() < 1e-12);
    }

    /// Nearly as λ⁻⁴, a little steeper for the index and the King factor.
    #[test]
    fn scattering_is_rayleighs() {
        let slope = (cross_section(400.0) / cross_section(800.0)).log2();
        assert!((4.0..4.15).contains(&slope), "{slope}");
    }
}
