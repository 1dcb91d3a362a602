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
//! builds the command `welkin`, `signals` lets no signal leave temporary files behind (`welkin::output`). Without `std` (and
//! with `libm`) what is left is [`General`], which needs neither the standard library nor an allocator.

#![deny(unsafe_code)]
#![cfg_attr(not(feature = "std"), no_std)]
// Without the standard library parts of the shared modules are not used.
#![cfg_attr(not(feature = "std"), allow(dead_code, unused_imports))]

#[cfg(feature = "std")]
mod air;
pub mod axis;
#[cfg(feature = "std")]
mod baked;
#[cfg(feature = "std")]
mod budget;
#[cfg(feature = "std")]
mod colour;
mod conditions;
mod error;
pub mod format;
mod general;
pub mod geometry;
#[cfg(feature = "std")]
mod haze;
mod lanes;
#[cfg(feature = "mmap")]
#[allow(
    unsafe_code,
    reason = "what is mapped is memory that others can change"
)]
mod map;
mod math;
#[cfg(feature = "std")]
mod model;
#[cfg(feature = "std")]
pub mod output;
mod phase;
#[cfg(feature = "std")]
mod polarisation;
#[cfg(feature = "std")]
mod prepare;
#[cfg(not(feature = "std"))]
mod real;
#[allow(unsafe_code, reason = "instructions that not every processor has")]
mod simd;
#[cfg(feature = "std")]
mod sky;
#[cfg(feature = "std")]
mod source;
#[cfg(feature = "std")]
mod spectrum;
#[cfg(feature = "std")]
mod store;
#[cfg(feature = "std")]
mod sun;
#[cfg(feature = "std")]
mod tables;

#[cfg(feature = "std")]
pub use air::Air;
#[cfg(feature = "std")]
pub use baked::{
    BakeError, BakedColour, BakedPolarisedSky, BakedSky, Directions, Part, Sample, SkySampler,
};
#[cfg(feature = "std")]
pub use budget::{Budget, Channels, Plan};
#[cfg(feature = "std")]
pub use colour::xyz_to_linear_srgb;
pub use conditions::Conditions;
pub use error::{Error, Result};
pub use general::{General, Interpolation};
#[cfg(feature = "std")]
pub use haze::{Foreground, GeneralHaze, Haze, PolarisedForeground};
#[cfg(feature = "default-model")]
pub use model::DEFAULT_MODEL;
#[cfg(feature = "std")]
pub use model::Model;
#[cfg(feature = "std")]
pub use polarisation::{Frame, PolarisedGeneral, PolarisedSky, Stokes, StokesSpectra};
#[cfg(feature = "std")]
pub use sky::Sky;
#[cfg(feature = "std")]
pub use source::ReadAt;
#[cfg(feature = "std")]
pub use spectrum::between_wavelengths;
#[cfg(feature = "std")]
pub use store::Traffic;
#[cfg(feature = "std")]
pub use sun::{SUN_RADIUS, SunDisc};
