//! Files of the official model of Wilkie et al. 2021: read, evaluated exactly, written, turned into welkin's form and
//! made from it.
//!
//! The published implementation and its ports read a binary without magic, version or checksum. `docs/official-data.md`
//! describes it.

pub mod angles;
mod between;
mod cursor;
pub mod error;
pub mod evaluate;
pub mod export;
pub mod import;
pub mod layout;
pub mod ray;
pub mod read;
pub mod selection;
pub mod tables;
pub mod transmittance;
pub mod write;

pub use angles::{Observer, SAFETY_ALTITUDE};
pub use error::{OfficialError, Section};
pub use read::{Note, OfficialData};
pub use selection::Selection;
pub use write::Writer;
