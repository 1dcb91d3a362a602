//! Clear-sky radiance from a memory-mapped, factorised model.
//!
//! A [`Model`] is a file: open it, prepare a [`Sky`] for the [`Conditions`] of a scene, and ask the sky for the
//! radiance of directions. Opening reads the head of the file, preparing touches only the parts that the conditions
//! need, and queries neither allocate nor call the system.
//!
//! ```
//! # #[cfg(feature = "default-model")]
//! # fn main() -> welkin::Result<()> {
//! use welkin::{Conditions, Model};
//!
//! let model = Model::default_model()?; // or Model::open("file.welkin")
//! let sky = model.sky(&Conditions {
//!     solar_elevation: 10f64.to_radians(),
//!     ..Conditions::default()
//! })?;
//! let zenith = [0.0, 0.0, 1.0];
//! let mut radiance = vec![0.0; sky.wavelengths().len()];
//! sky.radiance(zenith, &mut radiance)?; // W m⁻² sr⁻¹ nm⁻¹ at sky.wavelengths()
//! let luminance = sky.xyz(zenith)?[1]; // cd m⁻²
//! # assert!(radiance[0] > 0.0 && luminance > 0.0);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "default-model"))]
//! # fn main() {}
//! ```
//!
//! Units are SI, angles radians, wavelengths nanometres. Every input is checked: what cannot be answered is an
//! [`Error`] that names the parameter, its value and its range. The file format is specified in
//! `format-spec/SPEC.md` and implemented in [`mod@format`].
//!
//! Features: `mmap` maps files instead of reading them, `default-model` embeds a model (both are on by default), `cli`
//! builds the command `welkin`.

mod air;
pub mod axis;
mod baked;
mod colour;
mod conditions;
mod error;
pub mod format;
pub mod geometry;
mod haze;
mod lanes;
mod math;
mod model;
mod phase;
mod polarisation;
mod prepare;
mod sky;
mod source;
mod spectrum;
mod store;
mod sun;
mod tables;

pub use air::Air;
pub use baked::{BakeError, BakedColour, BakedSky, Directions, Sample, SkySampler};
pub use colour::xyz_to_linear_srgb;
pub use conditions::Conditions;
pub use error::{Error, Result};
pub use haze::Haze;
#[cfg(feature = "default-model")]
pub use model::DEFAULT_MODEL;
pub use model::Model;
pub use polarisation::{Frame, PolarisedSky, Stokes};
pub use sky::Sky;
pub use source::ReadAt;
pub use store::Traffic;
pub use sun::{SUN_RADIUS, SunDisc};
