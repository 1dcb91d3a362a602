//! Clear-sky radiance from a memory-mapped, factorised model.

pub mod axis;
pub mod geometry;
