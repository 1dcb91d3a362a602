//! Traces real atmospheres and fits them into welkin model files.
//!
//! `atmosphere → tracer → dataset → decompose → file`, each in a module of its own.

#![forbid(unsafe_code)]

pub mod air;
pub mod assess;
pub mod atmosphere;
pub mod aureole;
pub mod build;
pub mod chart;
pub mod column;
pub mod cross_check;
pub mod dataset;
pub mod decompose;
pub mod estimate;
pub mod finite;
pub mod fitting;
pub mod make;
pub mod manifest;
pub mod measured;
mod non_negative;
pub mod official;
pub mod pack;
pub mod particles;
pub mod picture;
pub mod polarimetry;
pub mod polarise;
pub mod progress;
pub mod recipe;
pub mod reference;
pub mod report;
pub mod round_trip;
pub mod spectrum;
pub mod successive_orders;
pub mod tracer;
pub mod units;
