//! Directions drawn by luminance.

use crate::baked_colour_sky::WelkinBakedColourSky;
use crate::guard::{Failure, Outcome, ask, call, free};
use crate::raw::{apart, array, give, put, put_array, shared, slice, slice_mut, span};
use crate::solar_disc::WelkinSolarDisc;
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::WelkinSample;
use library::{BakedColourSky, SkySampler, SolarDisc};

/// How far the suns of a sky and a disc may be apart, rad: more than rounding, less than anybody sees.
const SAME_SUN: f64 = 1e-4;

/// Draws directions in proportion to the luminance of a sky, with or without the sun's disc. All directions are drawn,
/// also those below the horizon, where the light is that of the air before black ground: of the draws of the sky none on
/// the ground, 34 % at 1500 m (sun 8° high) and 73 % at 10 km. Where geometry is in the way they count as blocked.
pub struct WelkinSkySampler(pub(crate) SkySampler);

/// Prepares draws of a baked sky and, unless `disc` is null, of the sun's disc, as often as its share of the luminous
/// flux is. The new handle needs neither of them any more. Both must have been prepared for the same conditions:
/// altitudes and visibilities are not compared, as discs do not tell them.
///
/// Errors: WELKIN_STATUS_RANGE where the sun of `disc` stands more than 1e-4 rad from that of `baked`, as after turning
/// the sky.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_sampler(
    baked: *const WelkinBakedColourSky,
    disc: *const WelkinSolarDisc,
    sampler: *mut *mut WelkinSkySampler,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(sampler, || {
            let sky = &shared(baked, "baked")?.0;
            if disc.is_null() {
                return Ok(WelkinSkySampler(sky.sampler()));
            }
            let disc = &shared(disc, "disc")?.0;
            check_sun(sky, disc)?;
            Ok(WelkinSkySampler(sky.sampler().with_sun(disc)))
        })?;
    })
}

/// Whether a disc is that of the sun which lights a sky.
fn check_sun(sky: &BakedColourSky, disc: &SolarDisc) -> Outcome<()> {
    let [sun, centre] = [
        sky.conditions().sun_direction(),
        disc.direction().map(f64::from),
    ];
    let square: f64 = sun.iter().zip(centre).map(|(a, b)| (a - b) * (a - b)).sum();
    let angle = 2.0 * (0.5 * square.sqrt()).min(1.0).asin();
    match angle <= SAME_SUN {
        true => Ok(()),
        false => Err(Failure::Range(format!(
            "the disc is of a sun {angle:.2e} rad away from that of the sky: prepare it anew"
        ))),
    }
}

/// Whether a point can be in the unit square.
fn check_point(point: &[f32; 2]) -> Outcome<()> {
    match point.iter().any(|c| c.is_nan()) {
        true => Err(Failure::Range("random numbers must not be NaN".to_owned())),
        false => Ok(()),
    }
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
/// clamped. Errors: WELKIN_STATUS_RANGE for NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_sampler_sample(
    sampler: *const WelkinSkySampler,
    point: *const f32,
    sample: *mut WelkinSample,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let point = array(point, "point")?;
        check_point(&point)?;
        put(
            sample,
            shared(sampler, "sampler")?.0.sample(point).into(),
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
        points.iter().try_for_each(check_point)?;
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
