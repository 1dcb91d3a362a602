//! Outside references: their files, and how the tracer and the data maker are judged against them.

pub mod case;
pub mod data_maker;
pub mod sky;
pub mod slab;
pub mod transmittance;
mod verdict;

pub use verdict::{Comparison, Limits, Verdict};
