//! Arrays over the wavelengths, and the phase functions that have a formula.

/// Wavelengths that are treated together.
pub const NW: usize = 24;
/// One value per wavelength.
pub type Spectrum = [f32; NW];

/// Highest degree of the spherical harmonics of multiply scattered light.
pub const DEGREE: usize = 12;
/// Isotropic share of a phase function, per steradian.
pub const PER_SPHERE: f32 = 0.25 * std::f32::consts::FRAC_1_PI;

/// Narrows a per-wavelength vector.
pub fn spectrum(values: &[f64]) -> Spectrum {
    std::array::from_fn(|w| values[w] as f32)
}

/// Henyey-Greenstein phase function, mean 1, at the cosine `c` of the scattering angle.
pub fn henyey_greenstein(g: &Spectrum, c: f32) -> Spectrum {
    std::array::from_fn(|w| {
        let x = 1.0 + g[w] * g[w] - 2.0 * g[w] * c;
        (1.0 - g[w] * g[w]) / (x * x.sqrt())
    })
}

/// Rayleigh phase function, mean 1, for polarising shares `delta`.
pub fn rayleigh_phase(delta: &Spectrum, c: f32) -> Spectrum {
    delta.map(|d| 0.75 * d * (1.0 + c * c) + 1.0 - d)
}
