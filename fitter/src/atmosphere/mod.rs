//! What the air is made of.

pub mod absorption_bands;
mod composition;
pub mod json;
pub mod matrix;
pub mod mie;
mod monochromatic;
mod real;
pub mod table;

pub use composition::{Atmosphere, Constituent, Phase, Scatterer};
pub use monochromatic::Monochromatic;
pub use real::{Particles, VISIBILITIES, real, real_at, real_with};
