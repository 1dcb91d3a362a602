//! Numbers by blocks of wavelengths.

use crate::format::{MAX_ESTIMATE_WAVELENGTHS, MAX_ESTIMATES};
use crate::kernel::lanes::Lanes;

/// Wavelengths that are computed together.
pub(crate) const WIDTH: usize = 8;
/// Most blocks of wavelengths.
pub(crate) const MOST_BLOCKS: usize = MAX_ESTIMATE_WAVELENGTHS / WIDTH;

/// The estimates of a block of wavelengths, sr⁻¹.
pub(crate) type Block = [Lanes<WIDTH>; MAX_ESTIMATES];
/// The estimates of all wavelengths.
pub(crate) type Blocks = [Block; MOST_BLOCKS];
/// None yet.
pub(crate) const NOTHING: Blocks = [[Lanes([0.0; WIDTH]); MAX_ESTIMATES]; MOST_BLOCKS];
