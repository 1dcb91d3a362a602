//! Independent parts of a large output: on all cores with the feature `rayon`, otherwise one after the other.

use crate::error::Result;

/// Calls `work` with each chunk and its number; the first error in their order counts.
#[cfg(not(feature = "rayon"))]
pub(crate) fn each_chunk<T: Send>(
    chunks: impl Iterator<Item = T>,
    work: impl Fn(usize, T) -> Result<()> + Sync,
) -> Result<()> {
    chunks.enumerate().try_for_each(|(i, chunk)| work(i, chunk))
}

/// Calls `work` with each chunk and its number; an error ends it early.
#[cfg(feature = "rayon")]
pub(crate) fn each_chunk<T: Send>(
    chunks: impl Iterator<Item = T>,
    work: impl Fn(usize, T) -> Result<()> + Sync,
) -> Result<()> {
    use rayon::prelude::*;
    let chunks: Vec<T> = chunks.collect();
    let chunks = chunks.into_par_iter().enumerate();
    chunks.try_for_each(|(i, chunk)| work(i, chunk))
}
