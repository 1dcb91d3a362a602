//! The native part of the Python package `welkin_sky`: arrays in, arrays out, around the library `welkin`.
//!
//! Every evaluation runs without the interpreter's lock, on rows of contiguous arrays, see [`rows`].

mod aerial_perspective;
mod arrays;
mod baked;
mod bands;
mod broadcast;
mod buffers;
mod conditions;
mod errors;
mod frame;
mod model;
mod moon;
mod polarised;
mod rows;
mod sampler;
mod sky;
mod solar_disc;
mod source;
mod spectrum;
mod sun_course;
mod threads;
mod transmittance;
mod volume;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::aerial_perspective::{
        colour::PyColourAerialPerspective, joined::PyJoinedAerialPerspective,
        spectral::PyAerialPerspective,
    };
    #[pymodule_export]
    use crate::baked::{
        colour::PyBakedColourSky, polarised::PyBakedPolarisedSky, spectral::PyBakedSky,
    };
    #[pymodule_export]
    use crate::bands::{
        PyBands, PyResponse, air::PyBandAerialPerspective, air::PyBandTransmittance,
        sky::PyBakedBandSky, sky::PyBandSky, sky::PyPolarisedBandSky, sun::PyBandSolarDisc,
    };
    #[pymodule_export]
    use crate::model::opening::{default_model, from_bytes, open, stream};
    #[pymodule_export]
    use crate::model::{PyModel, axis::PyModelAxis, budget::PyPlan};
    #[pymodule_export]
    use crate::moon::{PySkySum, phase_angle_between};
    #[pymodule_export]
    use crate::polarised::PyPolarisedSky;
    #[pymodule_export]
    use crate::sampler::PySkySampler;
    #[pymodule_export]
    use crate::sky::{PyColourSky, PySky, colour_space_matrix};
    #[pymodule_export]
    use crate::solar_disc::PySolarDisc;
    #[pymodule_export]
    use crate::sun_course::PySunCourse;
    #[pymodule_export]
    use crate::transmittance::PyTransmittance;
}
