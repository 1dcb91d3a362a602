//! Clear-sky radiance from a memory-mapped, factorised model.

pub mod axis;
mod colour;
mod conditions;
mod error;
pub mod format;
pub mod geometry;
mod math;
mod model;
mod phase;
mod prepare;
mod sky;
mod spectrum;
mod tables;

pub use colour::xyz_to_linear_srgb;
pub use conditions::Conditions;
pub use error::{Error, Result};
pub use model::Model;
pub use sky::Sky;
