//! The sky as spectral tables.

use crate::guard::{ask, call, free};
use crate::raw::{
    apart, array, check_count, copy, directions, exclusive, give, in_blocks, put, put_array,
    shared, slice, slice_mut, span,
};
use crate::sky::WelkinSky;
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{WelkinBakeError, WelkinConditions, put_conditions};
use library::BakedSky;

/// A sky as tables of some 50 kB per 16 wavelengths: many times faster than what it was made of, with a stated
/// additional error. Nothing allocates.
pub struct WelkinBakedSky(pub(crate) BakedSky);

/// A tolerance of baking that is small against the error of the model itself.
pub const WELKIN_BAKE_TOLERANCE: f64 = 0.0025;

const _: () = assert!(WELKIN_BAKE_TOLERANCE == BakedSky::TOLERANCE);

/// Bakes a sky into tables that add a relative error of at most `tolerance`, such as WELKIN_BAKE_TOLERANCE, at 95 % of
/// directions and wavelengths.
///
/// Errors: WELKIN_STATUS_RANGE for a tolerance below 3e-4; WELKIN_STATUS_TOLERANCE if the largest table misses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_bake(
    sky: *const WelkinSky,
    tolerance: f64,
    baked: *mut *mut WelkinBakedSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(baked, || {
            Ok(WelkinBakedSky(shared(sky, "sky")?.0.bake(tolerance)?))
        })?;
    })
}

/// Frees a baked sky; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_free(baked: *mut WelkinBakedSky) {
    free!(baked)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_wavelength_count(baked: *const WelkinBakedSky) -> usize {
    ask!(baked, |handle| handle.0.wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_baked_sky_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_wavelengths(
    baked: *const WelkinBakedSky,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(baked, "baked")?;
        copy(handle.0.wavelengths(), wavelengths, count)?;
    })
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_bytes(baked: *const WelkinBakedSky) -> usize {
    ask!(baked, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_conditions(
    baked: *const WelkinBakedSky,
    conditions: *mut WelkinConditions,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_conditions(conditions, shared(baked, "baked")?.0.conditions())?;
    })
}

/// Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
/// uses the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_set_solar_azimuth(
    baked: *mut WelkinBakedSky,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(baked, "baked")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// What baking added to the error of the sky.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_bake_error(
    baked: *const WelkinBakedSky,
    bake_error: *mut WelkinBakeError,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            bake_error,
            shared(baked, "baked")?.0.bake_error().into(),
            "bake_error",
        )?;
    })
}

/// As welkin_sky_radiance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_radiance(
    baked: *const WelkinBakedSky,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(baked, "baked")?.0.radiance(
            array(direction, "direction")?,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// As welkin_sky_radiance_batch. What precedes a bad direction may or may not be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_radiance_batch(
    baked: *const WelkinBakedSky,
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
        let out = slice_mut(radiance, count, "radiance")?;
        let sky = &shared(baked, "baked")?.0;
        let n = sky.wavelengths().len();
        check_count(count, direction_count.saturating_mul(n))?;
        in_blocks(directions, |first, block| {
            sky.radiance_batch(block, &mut out[first * n..][..block.len() * n])
        })?;
    })
}

/// The same with directions as three arrays, `x[direction_count]`, `y[…]`, `z[…]`: the fastest way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_radiance_soa(
    baked: *const WelkinBakedSky,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    direction_count: usize,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart(
            [x, y, z].map(|c| span(c, direction_count)),
            [span(radiance, count)],
        )?;
        let directions = directions([x, y, z], direction_count)?;
        shared(baked, "baked")?
            .0
            .radiance_batch(&directions, slice_mut(radiance, count, "radiance")?)?;
    })
}

/// Hero wavelengths: spectral radiance, W m⁻² sr⁻¹ nm⁻¹, `radiance[4]`, at four wavelengths (nm) of a path,
/// `wavelengths[4]`, within the range of the model.
///
/// Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for a wavelength.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_hero(
    baked: *const WelkinBakedSky,
    direction: *const f32,
    wavelengths: *const f32,
    radiance: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (direction, wavelengths) = (
            array(direction, "direction")?,
            array(wavelengths, "wavelengths")?,
        );
        put_array(
            radiance,
            shared(baked, "baked")?.0.hero(direction, wavelengths)?,
            "radiance",
        )?;
    })
}

/// welkin_baked_sky_hero for many directions, each with wavelengths of its own: `directions[count][3]`,
/// `wavelengths[count][4]`, `radiance[count][4]`. What precedes a bad one may or may not be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_hero_batch(
    baked: *const WelkinBakedSky,
    directions: *const f32,
    wavelengths: *const f32,
    count: usize,
    radiance: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let inputs = [
            span(directions.cast::<[f32; 3]>(), count),
            span(wavelengths.cast::<[f32; 4]>(), count),
        ];
        apart(inputs, [span(radiance.cast::<[f32; 4]>(), count)])?;
        let directions = slice(directions.cast::<[f32; 3]>(), count, "directions")?;
        let wavelengths = slice(wavelengths.cast::<[f32; 4]>(), count, "wavelengths")?;
        let out = slice_mut(radiance.cast::<[f32; 4]>(), count, "radiance")?;
        let sky = &shared(baked, "baked")?.0;
        in_blocks(directions, |first, block| {
            let range = first..first + block.len();
            sky.hero_batch(block, &wavelengths[range.clone()], &mut out[range])
        })?;
    })
}

/// The same with directions as three arrays: the fastest way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_hero_soa(
    baked: *const WelkinBakedSky,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    wavelengths: *const f32,
    count: usize,
    radiance: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let out = span(radiance.cast::<[f32; 4]>(), count);
        apart([x, y, z].map(|c| span(c, count)), [out])?;
        apart([span(wavelengths.cast::<[f32; 4]>(), count)], [out])?;
        let wavelengths = slice(wavelengths.cast::<[f32; 4]>(), count, "wavelengths")?;
        let out = slice_mut(radiance.cast::<[f32; 4]>(), count, "radiance")?;
        shared(baked, "baked")?
            .0
            .hero_batch(&directions([x, y, z], count)?, wavelengths, out)?;
    })
}

/// Spectral irradiance, W m⁻² nm⁻¹, `irradiance[count]`, that the sky without the sun's disc gives one side of a plane
/// with this `normal[3]`. Below the horizon the ground is black, but the air before it is included: what a plane that
/// looks down gets of the ground is missing, not what it gets of the air. Takes some thousand queries.
///
/// Errors as of welkin_baked_sky_radiance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_sky_irradiance(
    baked: *const WelkinBakedSky,
    normal: *const f32,
    irradiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(baked, "baked")?.0.irradiance(
            array(normal, "normal")?,
            slice_mut(irradiance, count, "irradiance")?,
        )?;
    })
}
