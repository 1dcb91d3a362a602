//! The file format: byte layout, validation, reading and writing. The contract is `format-spec/SPEC.md`.

mod estimate_view;
mod layout;
mod spectrum_view;
mod views;

pub(crate) use layout::{CRC_RANGE, ENTRY_LENGTH, Header, RawEntry};

pub use estimate_view::{
    EstimateView, MAX_ESTIMATE_CONSTITUENTS, MAX_ESTIMATE_WAVELENGTHS, MAX_ESTIMATES, MAX_LEVELS,
};
pub use layout::{
    CHUNK_ALIGNMENT, ENCODING_RAW, ENCODING_ZSTD, FEATURE_ESTIMATE, FEATURE_SPECTRUM,
    FIELD_ESTIMATE_SHIFT, FIELD_GROUND, KIND_AXIS, KIND_COLUMN, KIND_ESTIMATE, KIND_POLARISATION,
    KIND_POLARISATION_BASIS, KIND_RADIANCE, KIND_RADIANCE_BASIS, KIND_SOURCE, KIND_SOURCE_BASIS,
    KIND_SPECTRUM, KIND_TRANSMITTANCE, MAGIC, MAX_RANK, MAX_TABLE, MOST_EXPANSION, NO_INDEX,
    POLARISATION_PARTS, Shape, VERSION_MAJOR, VERSION_MINOR, ceil16,
};
pub use spectrum_view::{MAX_TAPS, SpectrumView};
pub use views::{BasisView, ColumnView, FactorsView, Payload16};

cfg_if::cfg_if! {
    if #[cfg(feature = "std")] {
        mod assemble;
        mod axis_table;
        mod matrix;
        mod payload_bytes;
        mod rewrite;
        mod crop;
        mod density;
        mod encoding;
        mod estimate;
        mod head;
        mod parse;
        mod polarisation_factors;
        mod source_function;
        mod spectrum;
        mod validate;
        mod verify;
        mod write;

        pub(crate) use encoding::{check_chunk, decode};
        pub(crate) use matrix::columns;
        pub(crate) use head::{altitude_node, visibility_node};
        pub(crate) use parse::{Key, head_length, parse_head};
        pub(crate) use source_function::phase_function;
        pub(crate) use spectrum::view as spectrum_view;

        pub use crate::output::replace_file;
        pub use axis_table::{AxisTable, MAX_AXIS_NAME, MAX_AXIS_UNIT};
        pub use rewrite::{extend, recode};
        pub use crop::{Selection, crop, unpack};
        pub use density::{DensityTable, DensityView, MAX_LAYERS};
        pub use head::{AlphaAxis, Entry, Field, Head, Kind, PhaseFunction};
        pub use parse::{Contents, parse};
        pub use polarisation_factors::{PolarisationBasis, PolarisationFactors};
        pub use source_function::{
            MAX_MOMENTS, Ranks, SOURCE_FIELDS, SourceBasis, SourceBasisView, SourceCore, SourceView,
            TENSOR, harmonics,
        };
        pub use estimate::Estimate;
        pub use spectrum::Spectrum;
        pub use verify::{Problem, verify};
        pub use write::{Chunk, ColumnTable, Payload, RadianceBasis, RadianceFactors, encode, write};
    }
}
