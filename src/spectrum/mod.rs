//! What lies between the wavelengths of a model. Format specification, sections 6.9, 7.3, 7.5 and 7.6.

mod between;
mod node_weights;

pub(crate) use between::{MOST_WAVELENGTHS, between, check};
pub(crate) use node_weights::{SpectralWeights, mixed};

cfg_if::cfg_if! {
    if #[cfg(feature = "std")] {
        mod band_extinction;
        mod cell_weights;
        mod interpolation;

        pub use between::between_wavelengths;
        pub use interpolation::SpectralInterpolation;
    }
}
