//! Path-traced pictures of a planet with its air and simple things on the ground.
//!
//! The frame is that of the camera's vertical: z up, x ahead (the horizontal direction in which the camera looks), y to
//! the left, the origin on the ground under the camera.

pub mod camera;
mod colour;
pub mod ground;
pub mod image;
mod mesh;
mod render;
pub mod scene;

pub use colour::irradiance;
pub use mesh::{Triangle, load_obj};
pub use render::{Picture, Settings, render};
