//! The successive-orders solver: the whole light field of an atmosphere by successive orders of scattering, without
//! noise.
//!
//! Single scattering is integrated along each ray. Multiple scattering is smooth, so it is kept as angular moments of
//! the light field on a grid of altitudes and sun zeniths (`moments`), filled order by order ([`fn@solve`]) and
//! gathered along each view ray ([`view_rays`]). Rayleigh scattering is exact with polarisation, as the 3×3 coherency
//! tensor of the incoming light; aerosols scatter spherical harmonics of the intensity and depolarise, but for sunlight,
//! which they polarise as their scattering matrices say, where these are known. The Monte Carlo tracer is its reference.

pub mod first_order;
mod kinds;
pub mod lobes;
pub mod moments;
pub mod phase_table;
pub mod ray_points;
pub mod scattered_source;
mod solve;
pub mod spectral_medium;
mod unresolved;
pub mod view_rays;

/// The grid of the moments.
pub use self::moments as grid;
pub use kinds::Kinds;
pub use lobes::{Lobe, Lobes};
pub use moments::Moments;
pub use ray_points::Path;
pub use solve::{LightField, Settings, solve};
pub use spectral_medium::{
    DEGREE, Medium, NW, PER_SPHERE, SOLAR_ANGULAR_RADIUS, Spectrum, rayleigh_phase,
};
pub use view_rays::{FIELDS, Fields, Gatherer, POLARISED};
