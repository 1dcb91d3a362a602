//! The sun.

use crate::colour_space::space_of;
use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{array, copy, give, put, put_array, shared, slice_mut};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{WelkinConditions, conditions_of};
use library::SolarDisc;

/// The sun's disc as an observer sees it through the air, with limb darkening, as far as it is above the horizon.
pub struct WelkinSolarDisc(pub(crate) SolarDisc);

/// Prepares the sun's disc. Errors as of welkin_sky_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    disc: *mut *mut WelkinSolarDisc,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(disc, || {
            Ok(WelkinSolarDisc(
                shared(model, "model")?
                    .0
                    .solar_disc(&conditions_of(conditions)?)?,
            ))
        })?;
    })
}

/// Frees a disc; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_free(disc: *mut WelkinSolarDisc) {
    free!(disc)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_wavelength_count(disc: *const WelkinSolarDisc) -> usize {
    ask!(disc, |handle| handle.0.wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_solar_disc_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_wavelengths(
    disc: *const WelkinSolarDisc,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(disc, "disc")?;
        copy(handle.0.wavelengths(), wavelengths, count)?;
    })
}

/// Whether any of it is above the horizon; false for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_is_visible(disc: *const WelkinSolarDisc) -> bool {
    ask!(disc, |handle| handle.0.is_visible())
}

/// Solid angle of what is visible of it, sr; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_solid_angle(disc: *const WelkinSolarDisc) -> f64 {
    ask!(disc, |handle| handle.0.solid_angle())
}

/// Unit vector towards its centre, as `direction[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_direction(
    disc: *const WelkinSolarDisc,
    direction: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(direction, shared(disc, "disc")?.0.direction(), "direction")?;
    })
}

/// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, `radiance[count]`; zero in directions that it does not cover. Add it to that of
/// the sky. Errors as of welkin_sky_radiance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_radiance(
    disc: *const WelkinSolarDisc,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(disc, "disc")?.0.radiance(
            array(direction, "direction")?,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// The same at any wavelength (nm) within the range of the model. Errors as of welkin_sky_radiance_at.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_radiance_at(
    disc: *const WelkinSolarDisc,
    direction: *const f32,
    wavelength: f64,
    radiance: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            radiance,
            shared(disc, "disc")?
                .0
                .radiance_at(array(direction, "direction")?, wavelength)?,
            "radiance",
        )?;
    })
}

/// CIE XYZ of its radiance, `xyz[3]`. Errors: WELKIN_STATUS_DIRECTION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_xyz(
    disc: *const WelkinSolarDisc,
    direction: *const f32,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            xyz,
            shared(disc, "disc")?
                .0
                .xyz(array(direction, "direction")?)?,
            "xyz",
        )?;
    })
}

/// The same in a colour space, as welkin_sky_rgb.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_rgb(
    disc: *const WelkinSolarDisc,
    direction: *const f32,
    space: i32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        put_array(
            rgb,
            space.from_xyz(
                shared(disc, "disc")?
                    .0
                    .xyz(array(direction, "direction")?)?,
            ),
            "rgb",
        )?;
    })
}

/// Spectral irradiance, W m⁻² nm⁻¹, `irradiance[count]`, that it gives one side of a plane with this `normal[3]`.
/// Errors as of welkin_sky_radiance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_solar_disc_irradiance(
    disc: *const WelkinSolarDisc,
    normal: *const f32,
    irradiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(disc, "disc")?.0.irradiance(
            array(normal, "normal")?,
            slice_mut(irradiance, count, "irradiance")?,
        )?;
    })
}
