//! The file format: byte layout, validation, reading and writing. The contract is `format-spec/SPEC.md`.

mod assemble;
mod chunk;
mod crop;
mod density;
mod encoding;
mod head;
mod layout;
mod parse;
mod polarisation;
mod replace;
mod source;
mod validate;
mod verify;
mod write;

pub(crate) use chunk::widen;
pub(crate) use encoding::{check_chunk, decode};
pub(crate) use head::{altitude_node, visibility_node};
pub(crate) use parse::{head_length, parse_head};
pub(crate) use source::phase_function;

pub use assemble::{extend, recode};
pub use chunk::{ColumnView, Payload16, RadianceBasisView, RadianceView};
pub use crop::{Selection, crop, unpack};
pub use density::{DensityTable, DensityView, MAX_LAYERS};
pub use head::{AlphaAxis, Entry, Field, Head, Kind, PhaseFunction};
pub use layout::{
    CHUNK_ALIGNMENT, ENCODING_RAW, ENCODING_ZSTD, FIELD_GROUND, KIND_COLUMN, KIND_POLARISATION,
    KIND_POLARISATION_BASIS, KIND_RADIANCE, KIND_RADIANCE_BASIS, KIND_SOURCE, KIND_SOURCE_BASIS,
    KIND_TRANSMITTANCE, MAGIC, MAX_RANK, MAX_TABLE, MOST_EXPANSION, NO_INDEX, Shape, VERSION_MAJOR,
    VERSION_MINOR, ceil16,
};
pub use parse::{Contents, parse};
pub use polarisation::{
    POLARISATION_PARTS, PolarisationBasis, PolarisationBasisView, PolarisationFactors,
    PolarisationView,
};
pub use replace::replace_file;
pub use source::{
    Ranks, SOURCE_FIELDS, SourceBasis, SourceBasisView, SourceCore, SourceView, TENSOR, harmonics,
};
pub use verify::{Problem, verify};
pub use write::{Chunk, ColumnTable, Payload, RadianceBasis, RadianceFactors, encode, write};
