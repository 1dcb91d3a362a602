//! Outside references: their files, and how the tracer is judged against them.

pub mod case;
pub mod sky;
pub mod slab;
pub mod transmittance;
mod verdict;

pub use verdict::{Comparison, Limits, Verdict};
