//! Scattering by small spheres: one, many of different sizes, and what phase functions look like to a model file.

pub mod lobe_fit;
pub mod lognormal;
pub mod opac;
mod simplex;
pub mod sphere;
