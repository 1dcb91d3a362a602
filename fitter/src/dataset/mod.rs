//! The data that the model is fitted to: the grid, the work units that fill it, and their files.

mod checkpoint;
mod coverage;
mod grid;
mod tensor;
mod truth;

pub use checkpoint::{State, Store};
pub use coverage::{Coverage, SHORT_WAVE_INFRARED, VISIBLE};
pub use grid::{Axis, Grid};
pub use tensor::{CHANNELS, Tensor, trace_tensor};
pub use truth::{Sample, shadow_edge, truth};
