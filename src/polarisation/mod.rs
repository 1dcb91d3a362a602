//! Polarised skies. Format specification, sections 6.6, 6.7 and 7.5.

mod frame;
mod polarised_point_query;
mod polarised_sky;
mod prepare_stokes;
mod stokes;
mod stokes_tables;

pub use frame::PolarisationFrame;
pub(crate) use frame::{PARALLEL, Plane, cross};
pub use polarised_point_query::PolarisedPointQuery;
pub(crate) use polarised_sky::PolarisedLight;
pub use polarised_sky::PolarisedSky;
pub(crate) use stokes::between;
pub use stokes::{Stokes, StokesSpectra};
pub(crate) use stokes_tables::limit;
