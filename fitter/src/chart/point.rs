//! A scheme at one size.

use crate::assess::Quantiles;

/// A scheme at one size.
#[derive(Clone, Debug)]
pub struct Point {
    /// What scheme.
    pub scheme: String,
    /// Its rank, or its tiers.
    pub rank: String,
    /// Mean bytes of a chunk, with its part of what chunks share.
    pub bytes: f64,
    /// Nanoseconds per direction for all wavelengths; none if it was not measured.
    pub nanoseconds: Option<f64>,
    /// Relative errors of radiance at held-out samples.
    pub error: Quantiles,
}
