//! Outside references: their files, and how the tracer and the successive-orders solver are judged against them.

pub mod sky;
pub mod slab;
pub mod successive_orders;
pub mod traced_lines;
pub mod transmittance;
mod verdict;

pub use verdict::{Comparison, Limits, Verdict};
