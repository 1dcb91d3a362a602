//! The clear sky for any renderer: spectral radiance, polarisation, transmittance and aerial perspective for any
//! direction, observer altitude, visibility, solar elevation and ground albedo, from one small memory-mapped file.
//! After Wilkie et al. 2021, *A Fitted Radiance and Attenuation Model for Realistic Atmospheres*.
//!
//! # A sky
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
//! # Many directions, and draws of them
//!
//! A sky that is asked often is baked into tables of some kilobytes: [`BakedSky`] for spectra, [`BakedColourSky`] for
//! XYZ and linear sRGB, [`BakedPolarisedSky`] for Stokes vectors. A [`SkySampler`] draws directions by luminance, the
//! sun among them.
//!
//! ```
//! # #[cfg(feature = "default-model")]
//! # fn main() -> welkin::Result<()> {
//! use welkin::{BakedSky, Conditions, Model};
//!
//! let model = Model::default_model()?;
//! let conditions = Conditions::default();
//! let baked = model.sky(&conditions)?.bake_colour(BakedSky::TOLERANCE)?;
//! let rgb = baked.linear_srgb([0.3, 0.1, 0.9])?; // cd m⁻²
//!
//! let sampler = baked.sampler().with_sun(&model.solar_disc(&conditions)?);
//! let sample = sampler.sample([0.3, 0.7]);
//! let [x, y, z] = sample.xyz.map(|v| v / sample.pdf); // an estimate of the light of sky and sun together
//! # assert!(rgb[2] > 0.0 && y > 0.0 && x + z > 0.0);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "default-model"))]
//! # fn main() {}
//! ```
//!
//! # Things at a distance
//!
//! [`AerialPerspective`] gives the light that the air before a thing adds and what the air leaves of the thing's own
//! light; joined to the sky of the observer, what is far vanishes in that sky.
//!
//! ```
//! # #[cfg(feature = "default-model")]
//! # fn main() -> welkin::Result<()> {
//! use welkin::{Conditions, Model};
//!
//! let model = Model::default_model()?;
//! let conditions = Conditions::default();
//! let sky = model.sky(&conditions)?;
//! let aerial = model.aerial_perspective(&conditions)?;
//! let hill = [30e3, 4e3, 600.0]; // m, the origin on the ground, +z up there
//! let (in_scattering, transmittance) = aerial.joined_to(&sky)?.linear_srgb(hill)?;
//! let albedo_light = [900.0, 1100.0, 700.0]; // what the hill sends, cd m⁻²
//! let seen: [f32; 3] = std::array::from_fn(|c| in_scattering[c] + transmittance[c] * albedo_light[c]);
//! # assert!(seen.iter().all(|&c| c > 0.0));
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "default-model"))]
//! # fn main() {}
//! ```
//!
//! # Conventions
//!
//! Units are SI, angles radians, wavelengths nanometres. +z is the zenith, azimuths count counter-clockwise from +x
//! seen from above, directions point away from the observer and need not be normalised. Every input is checked: what
//! cannot be answered is an [`Error`] that names the parameter, its value and its range. The file format is specified
//! in `format-spec/SPEC.md` and implemented in [`mod@format`].
//!
//! # Features
//!
//! | feature | default | adds |
//! | --- | --- | --- |
//! | `std` | yes | everything but [`PointQuery`], which needs no allocator either; without it use `libm` |
//! | `mmap` | yes | [`Model::open`] maps the file instead of reading it |
//! | `default-model` | yes | [`Model::default_model`]: a model in the library |
//! | `zstd` | no | compressed chunks |
//! | `signals` | no | no signal leaves temporary files behind ([`output`]) |
//! | `cli` | no | the command `welkin` |

#![deny(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(feature = "std"), no_std)]
// Without the standard library parts of the shared modules are not used.
#![cfg_attr(not(feature = "std"), allow(dead_code, unused_imports))]

mod azimuth_fade;
mod conditions;
mod error;
pub mod estimate;
pub mod format;
pub mod geometry;
mod kernel;
mod phase_function;
mod place;
mod point_query;
mod spectrum;
mod visible_disc;

pub use conditions::Conditions;
pub use error::{Error, Result};
pub use kernel::axis;
pub use place::Place;
pub use point_query::{Interpolation, PointQuery};

cfg_if::cfg_if! {
    if #[cfg(feature = "std")] {
        mod aerial_perspective;
        mod baked;
        mod bands;
        mod budget;
        mod ground;
        mod model;
        mod over;
        mod moon;
        pub mod output;
        mod parallel;
        mod polarisation;
        mod sky;
        mod sun;
        mod transmittance;
        mod turbidity;

        pub use aerial_perspective::{
            AerialBuffers, AerialHeader, AerialPerspective, AerialPerspectiveQuery, BandAerialPerspective, CameraVolume,
            ColourAerialPerspective, JoinedAerialPerspective, JoinedBandAerialPerspective, JoinedPolarisedAerialPerspective, SkyDifference,
        };
        pub use baked::{
            BakeError, BufferHeader, BakedBandSky, BakedColourSky, BakedPolarisedBandSky, BakedPolarisedSky, BakedSky,
            Directions, Part, Sample, SamplerBuffers, SamplerHeader, SkyBuffers, SkySampler, SunCourse,
        };
        pub use bands::{
            BandSky, BandSolarDisc, BandTransmittance, Bands, ColourSky,
            PolarisedBandSky, Residual, Response,
        };
        pub use budget::{Budget, Channels, Plan};
        pub use ground::Albedo;
        #[cfg(feature = "default-model")]
        pub use model::DEFAULT_MODEL;
        pub use model::{Model, ModelAxis, ReadAt, Traffic};
        pub use moon::{Moon, SkySum};
        pub use polarisation::{
            PolarisationFrame, PolarisedPointQuery, PolarisedSky, Stokes, StokesSpectra,
        };
        pub use sky::{ColourSpace, Sky, xyz_to_linear_srgb};
        pub use spectrum::{SpectralInterpolation, between_wavelengths};
        pub use sun::buffers::{DiscBuffers, DiscHeader};
        pub use sun::{SOLAR_ANGULAR_RADIUS, SolarDisc};
        pub use transmittance::Transmittance;
        pub use transmittance::buffers::{AirBuffers, AirHeader};
    }
}
