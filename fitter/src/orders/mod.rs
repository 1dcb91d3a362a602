//! The data maker: the whole light field of an atmosphere by successive orders of scattering, without noise.
//!
//! Single scattering is integrated along each ray. Multiple scattering is smooth, so it is kept as angular moments of the light
//! field on a grid of altitudes and sun zeniths (`moments`), filled order by order ([`fn@solve`]) and gathered along each view ray
//! ([`gather`]). Rayleigh scattering is exact with polarisation, as the 3×3 coherency tensor of the incoming light; aerosols
//! scatter spherical harmonics of the intensity and depolarise. The Monte Carlo tracer is the judge of all this.

pub mod gather;
mod medium;
pub mod moments;
pub mod path;
pub mod single;
mod solve;
pub mod source;

/// The grid of the moments.
pub use self::moments as grid;
pub use gather::{FIELDS, Fields, Gatherer, POLARISED};
pub use medium::{DEGREE, Medium, NW, PER_SPHERE, SOLAR_ANGULAR_RADIUS, Spectrum, rayleigh_phase};
pub use moments::Moments;
pub use path::Path;
pub use solve::{LightField, Settings, solve};
