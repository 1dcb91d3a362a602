//! Traces real atmospheres and fits them into welkin model files.
//!
//! `atmosphere → tracer → dataset → decompose → file`, each in a module of its own.

pub mod atmosphere;
pub mod reference;
pub mod tracer;
