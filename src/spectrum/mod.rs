//! What lies between the wavelengths of a model. Format specification, sections 6.9, 7.3, 7.5 and 7.6.

mod between;
pub(crate) mod cells;

pub(crate) use between::{MOST_WAVELENGTHS, between, check};

cfg_if::cfg_if! {
    if #[cfg(feature = "std")] {
        mod cell_table;
        mod interpolation;

        pub use between::between_wavelengths;
        pub(crate) use cell_table::CellTable;
        pub use interpolation::SpectralInterpolation;
    }
}
