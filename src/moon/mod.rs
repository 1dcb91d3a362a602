//! Moonlight: how bright the moon is, and skies that it lights.

mod disc_reflectance;
mod model;
mod moon_light;
mod sky_sum;

pub use moon_light::Moon;
pub use sky_sum::SkySum;
