//! The C interface of welkin. Every file holds the functions of one handle; they check what they are handed, call the
//! library and turn its errors into codes with text. What holds for all of them stands at the head of
//! `include/welkin/capi.h`, which is made of these files (`tests/header.rs`).
//!
//! # Safety
//! Every function is unsafe for the same reason: pointers must be null or point to as many elements as the
//! documentation says, which nothing here can check.

mod guard;
mod raw;

// In the order of the header.
mod abi;
mod status;

mod model;

mod axis;

mod plan;

mod structs;

mod colour_space;

mod sky;

mod colour_sky;

mod polarised_sky;

mod baked_sky;

mod baked_colour_sky;

mod baked_polarised_sky;

mod sampler;

mod solar_disc;

mod sun_course;

mod moon;

mod point_query;

mod transmittance;

mod aerial_perspective;

mod colour_aerial_perspective;

pub use abi::*;
pub use aerial_perspective::*;
pub use axis::*;
pub use baked_colour_sky::*;
pub use baked_polarised_sky::*;
pub use baked_sky::*;
pub use colour_aerial_perspective::*;
pub use colour_sky::*;
pub use colour_space::*;
pub use model::*;
pub use moon::*;
pub use plan::*;
pub use point_query::*;
pub use polarised_sky::*;
pub use sampler::*;
pub use sky::*;
pub use solar_disc::*;
pub use status::*;
pub use structs::*;
pub use sun_course::*;
pub use transmittance::*;
