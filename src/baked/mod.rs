//! Skies as small tables: a query costs little more than reading them.
//!
//! `coordinates` turns directions into places in tables, `spline` those into taps, `spline_table` sums. `fill` makes
//! the tables, a `hemisphere_spline` for each side of the horizon, and `grid_choice` their sizes, by the loops of
//! `refinement`, which compare at `comparison_sites`; `polarisation_table` and `frame_rotation` add polarisation.
//! `luminance_lattice` sums for samplers, `sun_course` blends baked skies under a sun that moves.
//! `over_ground` and `hero_stokes_over` give hero wavelengths over a ground by wavelength.
//! `batch` has the one loop over directions, and `baked_spectral`, `baked_colour`, `baked_polarised` and the two of
//! `hero` are the public faces.
#![allow(clippy::needless_range_loop)] // As in `lanes`.

mod baked_bands;
mod baked_colour;
mod baked_polarised;
mod baked_spectral;
mod baked_tables;
mod batch;
mod buffers;
mod comparison_sites;
mod coordinates;
mod fill;
mod frame_rotation;
mod grid_choice;
mod grid_nodes;
mod hemisphere_spline;
mod hero_stokes;
mod hero_stokes_over;
mod hero_wavelengths;
mod irradiance;
mod luminance_lattice;
mod over_ground;
mod polarisation_table;
mod refinement;
mod sampler;
mod spline;
mod spline_size;
mod spline_table;
mod sun_course;

pub use baked_bands::{BakedBandSky, BakedPolarisedBandSky};
pub use baked_colour::BakedColourSky;
pub use baked_polarised::BakedPolarisedSky;
pub use baked_spectral::BakedSky;
pub(crate) use baked_tables::check_tolerance;
pub use batch::Directions;
pub use buffers::{BufferHeader, SkyBuffers};
pub use grid_choice::BakeError;
pub use sampler::{Part, Sample, SkySampler};
pub use sun_course::SunCourse;

use crate::format::Head;

/// Most bytes that a baked sky with all wavelengths of a model holds on the heap.
pub(crate) fn largest_spectral(head: &Head) -> usize {
    grid_choice::largest_table(head.wavelengths.len(), 16) + baked_spectral::axis_bytes(head)
}

/// The same of a baked sky in colour.
pub(crate) fn largest_colour() -> usize {
    grid_choice::largest_table(3, 4)
}

/// The same of a baked sky with its polarisation.
pub(crate) fn largest_polarised(head: &Head) -> usize {
    largest_spectral(head) + polarisation_table::largest_table(head.wavelengths.len())
}
