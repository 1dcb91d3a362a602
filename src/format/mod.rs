//! The file format: byte layout, validation, reading and writing. The contract is `format-spec/SPEC.md`.

mod chunk;
mod head;
mod layout;
mod parse;
mod validate;
mod write;

pub(crate) use chunk::widen;
pub(crate) use head::{altitude_node, visibility_node};

pub use chunk::{ColumnView, Payload16, RadianceView};
pub use head::{AlphaAxis, Entry, Field, Head, Kind, PhaseFunction};
pub use layout::{
    CHUNK_ALIGNMENT, FIELD_GROUND, KIND_COLUMN, KIND_RADIANCE, MAGIC, MAX_RANK, NO_INDEX, Shape,
    VERSION_MAJOR, VERSION_MINOR, ceil16,
};
pub use parse::{Contents, parse};
pub use write::{Chunk, ColumnTable, Payload, RadianceFactors, encode, replace_file, write};
