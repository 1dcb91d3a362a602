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
//! with `libm`) what is left is [`PointQuery`], which needs neither the standard library nor an allocator.

#![deny(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(feature = "std"), no_std)]
// Without the standard library parts of the shared modules are not used.
#![cfg_attr(not(feature = "std"), allow(dead_code, unused_imports))]

mod azimuth_fade;
mod conditions;
mod error;
pub mod format;
pub mod geometry;
mod kernel;
mod phase_function;
mod place;
mod point_query;

pub use conditions::Conditions;
pub use error::{Error, Result};
pub use kernel::axis;
pub use place::Place;
pub use point_query::{Interpolation, PointQuery};

cfg_if::cfg_if! {
    if #[cfg(feature = "std")] {
        mod aerial_perspective;
        mod baked;
        mod budget;
        mod model;
        pub mod output;
        mod polarisation;
        mod sky;
        mod sun;
        mod transmittance;

        pub use aerial_perspective::{
            AerialPerspective, AerialPerspectiveQuery, JoinedAerialPerspective,
            JoinedPolarisedAerialPerspective,
        };
        pub use baked::{
            BakeError, BakedColourSky, BakedPolarisedSky, BakedSky, Directions, Part, Sample, SkySampler,
        };
        pub use budget::{Budget, Channels, Plan};
        #[cfg(feature = "default-model")]
        pub use model::DEFAULT_MODEL;
        pub use model::{Model, ReadAt, Traffic};
        pub use polarisation::{
            PolarisationFrame, PolarisedPointQuery, PolarisedSky, Stokes, StokesSpectra,
        };
        pub use sky::{Sky, between_wavelengths, xyz_to_linear_srgb};
        pub use sun::{SOLAR_ANGULAR_RADIUS, SolarDisc};
        pub use transmittance::Transmittance;
    }
}
