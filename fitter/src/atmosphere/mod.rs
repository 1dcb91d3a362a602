//! What the air is made of.

mod composition;
pub mod json;
pub mod matrix;
pub mod mie;
mod real;
pub mod table;

pub use composition::{Atmosphere, Constituent, Phase, Scatterer};
pub use real::{Particles, VISIBILITIES, real, real_with};
