//! Other models of the sky, from their papers: what this one is compared with. No user of the library depends on them.

pub mod bruneton;
pub mod cie;
pub mod colour;
pub mod hillaire;
pub mod hosek;
pub mod lanes;
pub mod medium;
pub mod nishita;
mod parallel;
pub mod preetham;
pub mod published;
pub mod shell;
pub mod sky;
pub mod spectra;
#[cfg(test)]
mod traced;
pub mod transmittance;

/// Wavelengths at which the models of coefficients are compared, nm.
pub const WAVELENGTHS: [f64; 8] = [400.0, 440.0, 480.0, 520.0, 560.0, 600.0, 640.0, 680.0];
