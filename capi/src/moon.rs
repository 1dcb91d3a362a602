//! Moonlight.

use library::{Moon, SkySum};

use crate::colour_space::space_of;
use crate::guard::{Outcome, call, free};
use crate::model::WelkinModel;
use crate::raw::{array, give, put, put_array, shared, slice_mut};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{Sized64, WelkinConditions, conditions_of, read, write};

/// The moon: where it stands and how much of it is lit. Initialise with welkin_moon_init, then set what differs.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinMoon {
    /// sizeof(WelkinMoon) of the program.
    pub struct_size: u64,
    /// Geometric elevation of its centre above the observer's horizontal plane, rad.
    pub elevation: f64,
    /// Azimuth, rad, counter-clockwise from +x seen from above.
    pub azimuth: f64,
    /// Phase angle, rad: 0 is full, π new.
    pub phase_angle: f64,
    /// Distance of its centre from the observer, m.
    pub distance: f64,
}

// SAFETY: five numbers of eight bytes.
unsafe impl Sized64 for WelkinMoon {
    const NAME: &'static str = "WelkinMoon";
    const LEAST: usize = 40;
}

const _: () = assert!(size_of::<WelkinMoon>() == WelkinMoon::LEAST);

unsafe fn moon_of(pointer: *const WelkinMoon) -> Outcome<Moon> {
    // SAFETY: the caller's part.
    let WelkinMoon {
        elevation,
        azimuth,
        phase_angle,
        distance,
        ..
    } = unsafe { read(pointer)? };
    Ok(Moon {
        elevation,
        azimuth,
        phase_angle,
        distance,
    })
}

/// Fills a moon: full as it can be without an eclipse, 45° high towards +x, at its mean distance. `struct_size` is
/// sizeof(WelkinMoon).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_moon_init(
    moon: *mut WelkinMoon,
    struct_size: u64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let Moon {
            elevation,
            azimuth,
            phase_angle,
            distance,
        } = Moon::default();
        write(
            moon,
            &WelkinMoon {
                struct_size,
                elevation,
                azimuth,
                phase_angle,
                distance,
            },
            struct_size,
        )?;
    })
}

/// The phase angle (rad) of a moon at mean distance in a direction `moon[3]`, with the sun in another, `sun[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_moon_phase_angle(
    moon: *const f64,
    sun: *const f64,
    phase_angle: *mut f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let angle = Moon::phase_angle_between(array(moon, "moon")?, array(sun, "sun")?);
        put(phase_angle, angle, "phase_angle")?;
    })
}

/// The same model with the moon in place of the sun, as a new handle: skies, discs and air are those that the moon
/// lights, where conditions say with `solar_elevation` and `solar_azimuth` where it stands. Radiances of both lights
/// add.
///
/// Errors: WELKIN_STATUS_RANGE for a phase angle outside 0..=π or a distance that the moon cannot have.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_moonlit(
    model: *const WelkinModel,
    moon: *const WelkinMoon,
    moonlit: *mut *mut WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(moonlit, || {
            Ok(WelkinModel::new(
                shared(model, "model")?.0.moonlit(&moon_of(moon)?)?,
            ))
        })?;
    })
}

/// The sky in the light of sun and moon together.
pub struct WelkinSkySum(SkySum);

/// Prepares the sky of sun and moon. One that is too far below the horizon adds nothing.
///
/// Errors as of welkin_sky_new and welkin_model_moonlit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sum_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    moon: *const WelkinMoon,
    sum: *mut *mut WelkinSkySum,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(sum, || {
            let model = &shared(model, "model")?.0;
            Ok(WelkinSkySum(model.sky_with_moon(
                &conditions_of(conditions)?,
                &moon_of(moon)?,
            )?))
        })?;
    })
}

/// Frees a sky; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sum_free(sum: *mut WelkinSkySum) {
    free!(sum)
}

/// As welkin_sky_radiance, at the wavelengths of the model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sum_radiance(
    sum: *const WelkinSkySum,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(sum, "sum")?.0.radiance(
            array(direction, "direction")?,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// As welkin_sky_xyz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sum_xyz(
    sum: *const WelkinSkySum,
    direction: *const f32,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            xyz,
            shared(sum, "sum")?.0.xyz(array(direction, "direction")?)?,
            "xyz",
        )?;
    })
}

/// As welkin_sky_rgb.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sum_rgb(
    sum: *const WelkinSkySum,
    direction: *const f32,
    space: i32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        put_array(
            rgb,
            space.from_xyz(shared(sum, "sum")?.0.xyz(array(direction, "direction")?)?),
            "rgb",
        )?;
    })
}
