//! Radiance straight from the bytes of a file: nothing is prepared, nothing is allocated, everything may change from
//! query to query. Format specification, section 7. Works without the standard library.

mod capacity;
mod chunk_directory;
mod chunk_table;
mod contraction;
mod evaluate;
mod head_counts;
mod head_rules;
mod head_view;
mod locate;
mod neighbours;
mod opened;
mod optics;
mod query_coordinates;
mod spectral_query;
#[cfg(feature = "std")]
mod stokes_query;

pub(crate) use chunk_table::Chunks;
pub(crate) use head_rules::checked_head;
pub use neighbours::Interpolation;
pub use opened::PointQuery;
#[cfg(feature = "std")]
pub(crate) use stokes_query::{Factors, Parts};
