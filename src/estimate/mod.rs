//! What the air along a ray sends by single scattering of sunlight, and by scattering of a mean diffuse light: rough
//! estimates, to which the fields of a model are relative. Format specification, section 7.2.
//!
//! They know what is hard to fit: the edge of the Earth's shadow, the horizon, the thinning of the air. What a model has
//! to say beyond them is smooth.

#[cfg(feature = "std")]
mod around;
mod blocks;
mod path;
mod points;
#[cfg(feature = "std")]
mod prepared;
mod sightline;
mod sums;
mod walk;

#[cfg(feature = "std")]
pub(crate) use around::Around;
pub(crate) use blocks::{Blocks, MOST_BLOCKS, NOTHING, WIDTH};
#[cfg(feature = "std")]
pub use prepared::Estimates;
pub use sightline::Sightline;
pub(crate) use sums::Estimator;
