//! The file format: byte layout, validation, reading and writing. The contract is `format-spec/SPEC.md`.

#[cfg(feature = "std")]
mod assemble;
mod chunk;
#[cfg(feature = "std")]
mod crop;
#[cfg(feature = "std")]
mod density;
#[cfg(feature = "std")]
mod encoding;
#[cfg(feature = "std")]
mod head;
mod layout;
#[cfg(feature = "std")]
mod parse;
#[cfg(feature = "std")]
mod polarisation;
#[cfg(feature = "std")]
mod printable;
#[cfg(feature = "std")]
mod source;
#[cfg(feature = "std")]
mod validate;
#[cfg(feature = "std")]
mod verify;
#[cfg(feature = "std")]
mod write;

pub(crate) use chunk::widen;
#[cfg(feature = "std")]
pub(crate) use encoding::{check_chunk, decode};
#[cfg(feature = "std")]
pub(crate) use head::{altitude_node, visibility_node};
pub(crate) use layout::{CRC_RANGE, ENTRY_LENGTH, Header, RawEntry};
#[cfg(feature = "std")]
pub(crate) use parse::{Key, head_length, parse_head};
#[cfg(feature = "std")]
pub(crate) use source::phase_function;

#[cfg(feature = "std")]
pub use crate::output::replace_file;
#[cfg(feature = "std")]
pub use assemble::{extend, recode};
pub use chunk::{BasisView, ColumnView, FactorsView, Payload16};
#[cfg(feature = "std")]
pub use crop::{Selection, crop, unpack};
#[cfg(feature = "std")]
pub use density::{DensityTable, DensityView, MAX_LAYERS};
#[cfg(feature = "std")]
pub use head::{AlphaAxis, Entry, Field, Head, Kind, PhaseFunction};
pub use layout::{
    CHUNK_ALIGNMENT, ENCODING_RAW, ENCODING_ZSTD, FIELD_GROUND, KIND_COLUMN, KIND_POLARISATION,
    KIND_POLARISATION_BASIS, KIND_RADIANCE, KIND_RADIANCE_BASIS, KIND_SOURCE, KIND_SOURCE_BASIS,
    KIND_TRANSMITTANCE, MAGIC, MAX_RANK, MAX_TABLE, MOST_EXPANSION, NO_INDEX, POLARISATION_PARTS,
    Shape, VERSION_MAJOR, VERSION_MINOR, ceil16,
};
#[cfg(feature = "std")]
pub use parse::{Contents, parse};
#[cfg(feature = "std")]
pub use polarisation::{PolarisationBasis, PolarisationFactors};
#[cfg(feature = "std")]
pub use printable::{printable, printable_json};
#[cfg(feature = "std")]
pub use source::{
    MAX_MOMENTS, Ranks, SOURCE_FIELDS, SourceBasis, SourceBasisView, SourceCore, SourceView,
    TENSOR, harmonics,
};
#[cfg(feature = "std")]
pub use verify::{Problem, verify};
#[cfg(feature = "std")]
pub use write::{Chunk, ColumnTable, Payload, RadianceBasis, RadianceFactors, encode, write};
