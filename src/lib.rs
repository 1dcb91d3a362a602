//! Clear-sky radiance from a memory-mapped, factorised model.

pub mod axis;
pub mod error;
pub mod format;
pub mod geometry;

pub use error::{Error, Result};
