//! Skies under a sun that moves.

use crate::baked_colour_sky::WelkinBakedColourSky;
use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{array, exclusive, give, put, put_array, shared};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{WelkinBakeError, WelkinConditions, conditions_of};
use library::SunCourse;

/// Baked skies in colour under every sun of a range, of one observer and one air: the sky of a frame costs
/// microseconds.
pub struct WelkinSunCourse(pub(crate) SunCourse);

/// Bakes skies for all solar elevations from `elevations[0]` to `elevations[1]` (rad); the sun of the conditions does
/// not count. By day that takes as long as baking some tens of skies (0..30° at 1500 m: 41 skies, 0.4 s, 0.9 MB);
/// through twilight, where skies change from one tenth of a degree to the next, seconds and some MB.
///
/// Errors as of welkin_sky_new and welkin_sky_bake.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    elevations: *const f64,
    tolerance: f64,
    course: *mut *mut WelkinSunCourse,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(course, || {
            let model = &shared(model, "model")?.0;
            Ok(WelkinSunCourse(model.sun_course(
                &conditions_of(conditions)?,
                array(elevations, "elevations")?,
                tolerance,
            )?))
        })?;
    })
}

/// Frees a course; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_free(course: *mut WelkinSunCourse) {
    free!(course)
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_bytes(course: *const WelkinSunCourse) -> usize {
    ask!(course, |handle| handle.0.bytes())
}

/// How many skies are baked; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_skies(course: *const WelkinSunCourse) -> usize {
    ask!(course, |handle| handle.0.skies())
}

/// Lowest and highest elevation, rad, as `elevations[2]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_elevations(
    course: *const WelkinSunCourse,
    elevations: *mut f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            elevations,
            shared(course, "course")?.0.elevations(),
            "elevations",
        )?;
    })
}

/// What interpolating between baked skies adds, the worst that was found between them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_interpolation_error(
    course: *const WelkinSunCourse,
    bake_error: *mut WelkinBakeError,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            bake_error,
            shared(course, "course")?.0.interpolation_error().into(),
            "bake_error",
        )?;
    })
}

/// The sky under a sun at an elevation of the range and any azimuth (rad), as a new handle.
///
/// Errors: WELKIN_STATUS_RANGE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_at(
    course: *const WelkinSunCourse,
    elevation: f64,
    azimuth: f64,
    baked: *mut *mut WelkinBakedColourSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(baked, || {
            Ok(WelkinBakedColourSky(
                shared(course, "course")?.0.at(elevation, azimuth)?,
            ))
        })?;
    })
}

/// The same into a sky that is there already, in its memory: for a sun that moves with every frame. Not while another
/// thread uses that sky. Its samplers keep the sky that they were made of, and discs are to be prepared anew. Takes
/// some microseconds, and up to a millisecond where the tables of the baked skies change size, as they do in twilight.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sun_course_write(
    course: *const WelkinSunCourse,
    elevation: f64,
    azimuth: f64,
    baked: *mut WelkinBakedColourSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(course, "course")?
            .0
            .write(elevation, azimuth, &mut exclusive(baked, "baked")?.0)?;
    })
}
