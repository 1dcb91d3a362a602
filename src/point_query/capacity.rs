//! What a point query has room for on the stack.

/// Most wavelengths, in vectors.
pub(super) const WAVELENGTH_BLOCKS: usize = 8;
/// Most constituents of the air.
pub(super) const MOST_CONSTITUENTS: usize = 16;
