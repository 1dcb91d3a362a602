//! The ground under a sky: how much of the light it reflects at each wavelength.

mod albedo;
mod between_grounds;
mod over_ground;

pub use albedo::Albedo;
pub(crate) use between_grounds::{BetweenGrounds, reflected};
pub(crate) use over_ground::OverGround;

/// The ground of a model.
#[derive(Debug)]
pub(crate) struct Ground {
    pub albedo: Albedo,
    /// What it has in colours, at the nodes that these are made of: found out once.
    pub in_colours: std::sync::OnceLock<Vec<f64>>,
}

impl Ground {
    pub fn new(albedo: Albedo) -> Self {
        Self {
            albedo,
            in_colours: std::sync::OnceLock::new(),
        }
    }
}
