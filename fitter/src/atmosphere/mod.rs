//! What the air is made of.

pub mod absorption_bands;
mod aerosol;
mod composition;
pub(crate) mod gases;
pub mod json;
pub mod matrix;
pub mod mie;
mod monochromatic;
pub(crate) mod real;
pub mod table;
mod variation;

pub use aerosol::Particles;
pub(crate) use composition::column;
pub use composition::{Atmosphere, Constituent, Phase, Scatterer};
pub use monochromatic::Monochromatic;
pub use real::{VISIBILITIES, real, real_at, real_varied, real_with};
pub use variation::{AerosolProfile, Variation};
