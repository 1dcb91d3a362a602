//! Aerial perspective: the light that the air between two points scatters towards the first. Format specification,
//! section 7.7.

mod aerial_buffers;
mod aerial_perspective_query;
mod angular_basis;
mod band_segments;
mod camera_volume;
mod colour_segments;
mod direct_sunlight;
mod file_tables;
mod joined;
mod joined_stokes;
mod light_estimate;
mod local_scattering;
mod marching;
mod over_ground;
mod path_points;
mod prepared;
mod quadrature_limits;
mod quadrature_panels;
mod ray_lattice;
mod ray_nodes;
mod reach;
mod scatterers;
mod segment_integral;
mod segments;
mod sky_difference;
mod source_expansion;
mod source_fill;
mod source_nodes;
mod source_table;
mod spectral_light;
mod spherical_harmonics;
mod stokes_integral;
mod sun_transmittance;
mod xyz_sum;

pub use aerial_buffers::{AerialBuffers, AerialHeader};
pub use aerial_perspective_query::AerialPerspectiveQuery;
pub use band_segments::{BandAerialPerspective, JoinedBandAerialPerspective};
pub use camera_volume::CameraVolume;
pub use colour_segments::ColourAerialPerspective;
pub use joined::JoinedAerialPerspective;
pub use joined_stokes::JoinedPolarisedAerialPerspective;
pub use prepared::AerialPerspective;
pub use sky_difference::SkyDifference;
