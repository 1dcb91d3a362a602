//! The shaders of welkin: which files make a program, and their translations. The shaders themselves stand in `wgsl/`
//! and need nothing of this crate, which composes, validates and translates them by naga.

mod cost;
mod program;
mod translate;

pub use cost::{Cost, cost};
pub use program::{PROGRAMS, Program, module};
pub use translate::{Translation, translations};
