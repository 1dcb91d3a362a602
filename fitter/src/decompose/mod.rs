//! From a traced tensor to the factors of the file: normalise, compress, decompose, turn node values into spline coefficients.

mod als;
mod collocation;
mod fit;
mod normalise;
mod tucker;
mod weights;

pub use als::Options;
pub use collocation::Collocation;
pub use fit::{Fit, fit};
pub use normalise::{ChunkGeometry, ElevationScale, chunk_geometry};
pub use weights::channel_weights;
