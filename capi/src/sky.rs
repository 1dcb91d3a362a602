//! The sky as it was fitted.

use crate::colour_space::space_of;
use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{
    apart, array, copy, exclusive, give, put, put_array, shared, slice, slice_mut, span,
};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{WelkinConditions, conditions_of, put_conditions};
use library::Sky;

/// The clear sky at one set of conditions: radiance for any direction, exact. Nothing allocates after it is prepared.
/// The sun's disc is not included.
///
/// Below the horizon the ground itself is black, but the air before it is included, so the radiance there is not zero
/// above the ground. Renderers with a terrain take no sky there: they lay their geometry over it and add the air of
/// aerial perspective.
pub struct WelkinSky(pub(crate) Sky);

/// Prepares a sky. Reads only what the conditions need.
///
/// Errors: WELKIN_STATUS_RANGE for conditions outside of the model; WELKIN_STATUS_MISSING if the file has not what they
/// need; those of a damaged file. The new handle does not need the model any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    sky: *mut *mut WelkinSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(sky, || {
            Ok(WelkinSky(
                shared(model, "model")?.0.sky(&conditions_of(conditions)?)?,
            ))
        })?;
    })
}

/// Frees a sky; null is none. What was baked of it lives on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_free(sky: *mut WelkinSky) {
    free!(sky)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_wavelength_count(sky: *const WelkinSky) -> usize {
    ask!(sky, |handle| handle.0.wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_sky_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_wavelengths(
    sky: *const WelkinSky,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(sky, "sky")?;
        copy(handle.0.wavelengths(), wavelengths, count)?;
    })
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_bytes(sky: *const WelkinSky) -> usize {
    ask!(sky, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_conditions(
    sky: *const WelkinSky,
    conditions: *mut WelkinConditions,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_conditions(conditions, shared(sky, "sky")?.0.conditions())?;
    })
}

/// Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
/// uses the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_set_solar_azimuth(
    sky: *mut WelkinSky,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(sky, "sky")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// Unit vector towards the sun's centre, as `sun[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sun_direction(
    sky: *const WelkinSky,
    sun: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(sun, shared(sky, "sky")?.0.sun_direction(), "sun")?;
    })
}

/// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at each of its wavelengths: `radiance[count]`. `direction[3]` need not be
/// normalised.
///
/// Errors: WELKIN_STATUS_DIRECTION for one that is zero or not finite; WELKIN_STATUS_LENGTH unless `count` is that of
/// the wavelengths.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_radiance(
    sky: *const WelkinSky,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(sky, "sky")?.0.radiance(
            array(direction, "direction")?,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// Radiance per unit of solar spectral irradiance, sr⁻¹; otherwise as welkin_sky_radiance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_relative_radiance(
    sky: *const WelkinSky,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(sky, "sky")?.0.relative_radiance(
            array(direction, "direction")?,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// welkin_sky_radiance for many directions, `directions[direction_count][3]`; `radiance[direction_count][wavelengths]`,
/// of which `count` is the number of all floats. What precedes a bad direction is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_radiance_batch(
    sky: *const WelkinSky,
    directions: *const f32,
    direction_count: usize,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart(
            [span(directions.cast::<[f32; 3]>(), direction_count)],
            [span(radiance, count)],
        )?;
        let directions = slice(directions.cast::<[f32; 3]>(), direction_count, "directions")?;
        shared(sky, "sky")?
            .0
            .radiance_batch(directions, slice_mut(radiance, count, "radiance")?)?;
    })
}

/// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at any wavelength (nm) within the range of the model.
///
/// Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for the wavelength.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_radiance_at(
    sky: *const WelkinSky,
    direction: *const f32,
    wavelength: f64,
    radiance: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            radiance,
            shared(sky, "sky")?
                .0
                .radiance_at(array(direction, "direction")?, wavelength)?,
            "radiance",
        )?;
    })
}

/// CIE 1931 XYZ of the radiance, `xyz[3]`; Y is the luminance in cd m⁻².
///
/// Errors: WELKIN_STATUS_DIRECTION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_xyz(
    sky: *const WelkinSky,
    direction: *const f32,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            xyz,
            shared(sky, "sky")?.0.xyz(array(direction, "direction")?)?,
            "xyz",
        )?;
    })
}

/// The same in a colour space (WELKIN_SPACE_SRGB …), cd m⁻²: white of 1 cd m⁻² is (1, 1, 1). Not clipped, so components
/// of colours outside the gamut are negative.
///
/// Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_ARGUMENT for an unknown space.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_rgb(
    sky: *const WelkinSky,
    direction: *const f32,
    space: i32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        put_array(
            rgb,
            space.from_xyz(shared(sky, "sky")?.0.xyz(array(direction, "direction")?)?),
            "rgb",
        )?;
    })
}
