//! Model files: mapped, in memory or read in pieces.

#[cfg(feature = "mmap")]
#[allow(
    unsafe_code,
    reason = "what is mapped is memory that others can change"
)]
mod memory_map;
mod model_axis;
mod node_subset;
mod opened;
mod ranges;
mod read_at;
mod store;

pub(crate) use crate::format::Key;
pub use model_axis::ModelAxis;
pub(crate) use node_subset::{NodeSubset, Nodes, SourceAtNodes};
#[cfg(feature = "default-model")]
pub use opened::DEFAULT_MODEL;
pub use opened::Model;
pub(crate) use opened::SPECTRUM;
pub(crate) use ranges::checked_visibility;
pub use read_at::ReadAt;
pub use store::Traffic;
