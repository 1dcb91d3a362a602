//! The sky in colour.

use crate::colour_space::space_of;
use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{array, exclusive, give, put_array, shared};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{WelkinConditions, conditions_of, put_conditions};
use library::ColourSky;

/// A sky for colour alone: only the wavelengths that X, Y and Z are made of are prepared, in half the time.
pub struct WelkinColourSky(pub(crate) ColourSky);

/// Prepares a sky for colour alone. Errors as of welkin_sky_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    sky: *mut *mut WelkinColourSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(sky, || {
            Ok(WelkinColourSky(
                shared(model, "model")?
                    .0
                    .colour_sky(&conditions_of(conditions)?)?,
            ))
        })?;
    })
}

/// Frees a sky; null is none. What was baked of it lives on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_free(sky: *mut WelkinColourSky) {
    free!(sky)
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_bytes(sky: *const WelkinColourSky) -> usize {
    ask!(sky, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_conditions(
    sky: *const WelkinColourSky,
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
pub unsafe extern "C" fn welkin_colour_sky_set_solar_azimuth(
    sky: *mut WelkinColourSky,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(sky, "sky")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// Unit vector towards the sun's centre, as `sun[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_sun_direction(
    sky: *const WelkinColourSky,
    sun: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(sun, shared(sky, "sky")?.0.sun_direction(), "sun")?;
    })
}

/// As welkin_sky_xyz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_xyz(
    sky: *const WelkinColourSky,
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

/// As welkin_sky_rgb.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_rgb(
    sky: *const WelkinColourSky,
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
