//! Every model of the sky on the same sky: what writes `docs/evidence`.
//!
//! `air` and `directions` say what is traced, `truth` reads that, `models` holds all that are compared; the others
//! each write a part of the page.

pub mod abilities;
pub mod air;
pub mod cases;
pub mod directions;
pub mod entry;
pub mod errors;
pub mod haze;
pub mod models;
pub mod official;
pub mod pictures;
pub mod profiles;
pub mod quantities;
pub mod table;
pub mod timing;
pub mod truth;

/// What any of them may fail with.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Solar elevations that are compared, degrees.
pub const SUNS: [f64; 5] = [60.0, 20.0, 5.0, 0.0, -4.0];
/// Visibility of the sky that all others are compared with, m.
pub const VISIBILITY: f64 = 59.4e3;
/// Albedo of its ground.
pub const ALBEDO: f32 = 0.2;
