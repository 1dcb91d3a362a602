//! What lies between the nodes: the weights of the nodes at every wavelength, learned from traced spectra.
//!
//! Data flow: [`cells`] → [`training`] → [`weights`] → [`learned`] → [`pack()`]; [`walk`] → [`judge`] → [`judgement_tables`].

pub mod cells;
pub mod colour;
pub mod draw;
pub mod g173;
pub mod judge;
pub mod judgement_tables;
pub mod learned;
mod of_default;
mod pack;
mod packed;
mod thinned;
pub mod training;
pub mod walk;
pub mod weights;

pub use learned::{Lesson, held_out_table, quantiles};
pub use pack::{lesson, pack};
pub use packed::Packed;
