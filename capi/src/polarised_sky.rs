//! The sky with its polarisation.

use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{array, check_count, copy, exclusive, give, put_array, shared, slice_mut};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{
    WelkinConditions, WelkinPolarisationFrame, WelkinStokes, conditions_of, frame_of,
    put_conditions, put_stokes,
};
use library::{PolarisedSky, Stokes};

/// A sky with its linear polarisation.
pub struct WelkinPolarisedSky(pub(crate) PolarisedSky);

/// Prepares a polarised sky. Errors as of welkin_sky_new; WELKIN_STATUS_MISSING if the model is not polarised.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    sky: *mut *mut WelkinPolarisedSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(sky, || {
            Ok(WelkinPolarisedSky(
                shared(model, "model")?
                    .0
                    .polarised_sky(&conditions_of(conditions)?)?,
            ))
        })?;
    })
}

/// Frees a sky; null is none. What was baked of it lives on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_free(sky: *mut WelkinPolarisedSky) {
    free!(sky)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_wavelength_count(
    sky: *const WelkinPolarisedSky,
) -> usize {
    ask!(sky, |handle| handle.0.sky().wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_polarised_sky_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_wavelengths(
    sky: *const WelkinPolarisedSky,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(sky, "sky")?;
        copy(handle.0.sky().wavelengths(), wavelengths, count)?;
    })
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_bytes(sky: *const WelkinPolarisedSky) -> usize {
    ask!(sky, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_conditions(
    sky: *const WelkinPolarisedSky,
    conditions: *mut WelkinConditions,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_conditions(conditions, shared(sky, "sky")?.0.sky().conditions())?;
    })
}

/// Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
/// uses the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_set_solar_azimuth(
    sky: *mut WelkinPolarisedSky,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(sky, "sky")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// Stokes vectors, W m⁻² sr⁻¹ nm⁻¹, at each of its wavelengths: `stokes[count]`, in a frame (null: the vertical one).
///
/// Errors: WELKIN_STATUS_DIRECTION for a direction or an axis that is zero or not finite; WELKIN_STATUS_LENGTH unless
/// `count` is that of the wavelengths; WELKIN_STATUS_ARGUMENT for an unknown kind of frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_stokes(
    sky: *const WelkinPolarisedSky,
    direction: *const f32,
    frame: *const WelkinPolarisationFrame,
    stokes: *mut WelkinStokes,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let sky = &shared(sky, "sky")?.0;
        let (direction, frame) = (array(direction, "direction")?, frame_of(frame)?);
        let out = slice_mut(stokes, count, "stokes")?;
        let mut values = [Stokes::default(); 256];
        check_count(count, sky.sky().wavelengths().len())?;
        let values = &mut values[..count];
        sky.stokes(direction, frame, values)?;
        for (out, value) in out.iter_mut().zip(values) {
            *out = (*value).into();
        }
    })
}

/// The Stokes vector at any wavelength (nm) within the range of the model.
///
/// Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for the wavelength.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_stokes_at(
    sky: *const WelkinPolarisedSky,
    direction: *const f32,
    frame: *const WelkinPolarisationFrame,
    wavelength: f64,
    stokes: *mut WelkinStokes,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (direction, frame) = (array(direction, "direction")?, frame_of(frame)?);
        put_stokes(
            stokes,
            shared(sky, "sky")?
                .0
                .stokes_at(direction, frame, wavelength)?,
        )?;
    })
}

/// Stokes vectors of X, Y and Z, `xyz[3]`; that of Y in cd m⁻².
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_xyz(
    sky: *const WelkinPolarisedSky,
    direction: *const f32,
    frame: *const WelkinPolarisationFrame,
    xyz: *mut WelkinStokes,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (direction, frame) = (array(direction, "direction")?, frame_of(frame)?);
        put_array(
            xyz,
            shared(sky, "sky")?
                .0
                .xyz(direction, frame)?
                .map(WelkinStokes::from),
            "xyz",
        )?;
    })
}
