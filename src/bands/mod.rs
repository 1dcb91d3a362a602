//! Bands of a sensor: response curves and single wavelengths, projected once onto few nodes of a model.
//!
//! `response` holds curves, `spectral_axis` knows what light and air are between nodes, `examples` typical spectra.
//! `band_fit` finds weights of nodes for the light and `transmittance_fit` exponentials for the air, both with
//! `few_columns` and `least_squares`; `band_projection` (with `powers`) and `mixture` apply them.
//! `effective_albedo` finds what a ground by wavelength is to sums over nodes: to those of `colour_ground` (with
//! `colour_nodes` and `colour_matching`) and of `band_ground`. The rest are the public faces.

mod band_air;
mod band_fit;
mod band_ground;
mod band_integral;
mod band_projection;
mod band_set;
mod band_sky;
mod band_sun;
mod colour_ground;
mod colour_matching;
mod colour_nodes;
mod colour_sky;
mod effective_albedo;
mod examples;
mod few_columns;
mod least_squares;
mod mixture;
mod powers;
mod residual;
mod response;
mod spectral_axis;
mod transmittance_fit;

pub use band_air::BandTransmittance;
pub(crate) use band_projection::Projection;
pub use band_set::Bands;
pub use band_sky::{BandSky, PolarisedBandSky};
pub use band_sun::BandSolarDisc;
pub(crate) use colour_ground::coloured_over;
pub use colour_sky::ColourSky;
pub use residual::Residual;
pub use response::Response;
