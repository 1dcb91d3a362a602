//! Directions drawn by luminance.

use crate::baked_colour_sky::WelkinBakedColourSky;
use crate::guard::{ask, call, free};
use crate::raw::{apart, array, give, put, put_array, shared, slice, slice_mut, span};
use crate::solar_disc::WelkinSolarDisc;
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::WelkinSample;
use library::SkySampler;

/// Draws directions in proportion to the luminance of a sky, with or without the sun's disc.
pub struct WelkinSkySampler(pub(crate) SkySampler);

/// Prepares draws of a baked sky and, unless `disc` is null, of the sun's disc, as often as its share of the luminous
/// flux is. The new handle needs neither of them any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_sampler(
    baked: *const WelkinBakedColourSky,
    disc: *const WelkinSolarDisc,
    sampler: *mut *mut WelkinSkySampler,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(sampler, || {
            let sampler = shared(baked, "baked")?.0.sampler();
            Ok(WelkinSkySampler(match disc.is_null() {
                true => sampler,
                false => sampler.with_sun(&shared(disc, "disc")?.0),
            }))
        })?;
    })
}

/// Frees a sampler; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_free(sampler: *mut WelkinSkySampler) {
    free!(sampler)
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_bytes(sampler: *const WelkinSkySampler) -> usize {
    ask!(sampler, |handle| handle.0.bytes())
}

/// Maps a point of the unit square, `point[2]`, to a direction with its density and light. Numbers outside 0..1 are
/// clamped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_sample(
    sampler: *const WelkinSkySampler,
    point: *const f32,
    sample: *mut WelkinSample,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            sample,
            shared(sampler, "sampler")?
                .0
                .sample(array(point, "point")?)
                .into(),
            "sample",
        )?;
    })
}

/// The same for many points, `points[count][2]`; `samples[count]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_sample_batch(
    sampler: *const WelkinSkySampler,
    points: *const f32,
    count: usize,
    samples: *mut WelkinSample,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart(
            [span(points.cast::<[f32; 2]>(), count)],
            [span(samples, count)],
        )?;
        let sampler = &shared(sampler, "sampler")?.0;
        let points = slice(points.cast::<[f32; 2]>(), count, "points")?;
        for (sample, point) in slice_mut(samples, count, "samples")?.iter_mut().zip(points) {
            *sample = sampler.sample(*point).into();
        }
    })
}

/// The density of draws at any direction, sr⁻¹, the same as that of samples: to combine with other strategies.
///
/// Errors: WELKIN_STATUS_DIRECTION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_pdf(
    sampler: *const WelkinSkySampler,
    direction: *const f32,
    pdf: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            pdf,
            shared(sampler, "sampler")?
                .0
                .pdf(array(direction, "direction")?)?,
            "pdf",
        )?;
    })
}

/// CIE XYZ of what draws are in proportion to, `xyz[3]`: the sky and, if it is drawn, the sun's disc.
///
/// Errors: WELKIN_STATUS_DIRECTION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_xyz(
    sampler: *const WelkinSkySampler,
    direction: *const f32,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            xyz,
            shared(sampler, "sampler")?
                .0
                .xyz(array(direction, "direction")?)?,
            "xyz",
        )?;
    })
}
