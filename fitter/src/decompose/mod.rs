//! From traced tensors to the factors of the file: normalise, compress, decompose together, refine, turn node values
//! into splines.

mod chunk;
mod collocation;
mod coupled;
mod fit;
#[cfg(test)]
mod ill_conditioned;
mod normalise;
mod polarised;
mod refine;
mod row_major;
mod tucker;
mod weights;

pub use chunk::Chunk;
pub use collocation::Collocation;
pub use coupled::{Options, decompose};
pub use fit::{Fit, decompose_all, decompose_nested, refine_all, splines};
pub(crate) use fit::{SHARED, assemble};
pub use normalise::SiteEstimates;
pub use polarised::{POLARISED_CHANNELS, PolarisedChunk, polarise};
pub(crate) use refine::Normal;
pub use refine::{Basis, Own, relative_radiance, residual};
pub use row_major::row_major;
pub(crate) use tucker::principal_basis;
pub use tucker::{Dense, Tucker, compress_together};
