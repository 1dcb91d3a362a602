//! Numbers only: vectors of lanes, instructions, half precision, elementary functions, splines and stencils.
//! Nothing here knows a sky.

pub mod axis;
pub(crate) mod half;
pub(crate) mod lanes;
pub(crate) mod math;
#[cfg(not(feature = "std"))]
pub(crate) mod real;
#[allow(unsafe_code, reason = "instructions that not every processor has")]
pub(crate) mod simd;
