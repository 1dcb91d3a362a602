//! Polarised skies. Format specification, sections 6.6, 6.7 and 7.5.

mod aspect;
mod general;
mod prepare;
mod sky;
mod stokes;
mod table;

pub use aspect::Frame;
pub(crate) use aspect::{PARALLEL, Plane, cross};
pub use general::PolarisedGeneral;
pub use sky::PolarisedSky;
pub(crate) use stokes::between;
pub use stokes::{Stokes, StokesSpectra};
pub(crate) use table::limit;
