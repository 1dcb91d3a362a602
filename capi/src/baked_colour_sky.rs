//! The sky as tables of colours.

use crate::colour_sky::WelkinColourSky;
use crate::colour_space::space_of;
use crate::guard::{ask, call, free};
use crate::raw::{
    apart, array, directions, exclusive, give, in_blocks, put, put_array, shared, slice, slice_mut,
    span,
};
use crate::sky::WelkinSky;
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{WelkinBakeError, WelkinConditions, put_conditions};
use library::BakedColourSky;

/// A sky in colour as tables of some 12 kB, for very many directions. Nothing allocates.
pub struct WelkinBakedColourSky(pub(crate) BakedColourSky);

/// As welkin_sky_bake, for colours.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_sky_bake_colour(
    sky: *const WelkinSky,
    tolerance: f64,
    baked: *mut *mut WelkinBakedColourSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(baked, || {
            Ok(WelkinBakedColourSky(
                shared(sky, "sky")?.0.bake_colour(tolerance)?,
            ))
        })?;
    })
}

/// As welkin_sky_bake_colour.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_bake(
    sky: *const WelkinColourSky,
    tolerance: f64,
    baked: *mut *mut WelkinBakedColourSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(baked, || {
            Ok(WelkinBakedColourSky(shared(sky, "sky")?.0.bake(tolerance)?))
        })?;
    })
}

/// Bakes a sky into tables of the sizes of `other`, which holds that at conditions nearby: the next frame under a sun
/// that moves, in half the time. Nothing is measured: welkin_baked_colour_sky_bake_error then tells the error of
/// `other`, which holds for conditions close to its own. Bake afresh every degree or so; from 10 to −8° at 9 km the
/// 95th percentile grows to 0.8 %.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_sky_bake_like(
    sky: *const WelkinColourSky,
    other: *const WelkinBakedColourSky,
    baked: *mut *mut WelkinBakedColourSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(baked, || {
            Ok(WelkinBakedColourSky(
                shared(sky, "sky")?.0.bake_like(&shared(other, "other")?.0),
            ))
        })?;
    })
}

/// Frees a baked sky; null is none. Samplers of it live on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_free(baked: *mut WelkinBakedColourSky) {
    free!(baked)
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_bytes(
    baked: *const WelkinBakedColourSky,
) -> usize {
    ask!(baked, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_conditions(
    baked: *const WelkinBakedColourSky,
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
pub unsafe extern "C" fn welkin_baked_colour_sky_set_solar_azimuth(
    baked: *mut WelkinBakedColourSky,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(baked, "baked")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// What baking added to the error of the sky.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_bake_error(
    baked: *const WelkinBakedColourSky,
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

/// As welkin_sky_xyz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_xyz(
    baked: *const WelkinBakedColourSky,
    direction: *const f32,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            xyz,
            shared(baked, "baked")?
                .0
                .xyz(array(direction, "direction")?)?,
            "xyz",
        )?;
    })
}

/// As welkin_sky_rgb.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_rgb(
    baked: *const WelkinBakedColourSky,
    direction: *const f32,
    space: i32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        put_array(
            rgb,
            shared(baked, "baked")?
                .0
                .rgb(array(direction, "direction")?, space)?,
            "rgb",
        )?;
    })
}

/// welkin_baked_colour_sky_xyz for many directions, `directions[count][3]`; `xyz[count][3]`. What precedes a bad
/// direction may or may not be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_xyz_batch(
    baked: *const WelkinBakedColourSky,
    directions: *const f32,
    count: usize,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let sky = &shared(baked, "baked")?.0;
        let out = xyz.cast::<[f32; 3]>();
        apart(
            [span(directions.cast::<[f32; 3]>(), count)],
            [span(out, count)],
        )?;
        let directions = slice(directions.cast::<[f32; 3]>(), count, "directions")?;
        let out = slice_mut(out, count, "xyz")?;
        in_blocks(directions, |first, block| {
            sky.xyz_batch(block, &mut out[first..first + block.len()])
        })?;
    })
}

/// The same with directions as three arrays, `x[count]`, `y[count]`, `z[count]`: the fastest way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_xyz_soa(
    baked: *const WelkinBakedColourSky,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    count: usize,
    xyz: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let sky = &shared(baked, "baked")?.0;
        let out = xyz.cast::<[f32; 3]>();
        apart([x, y, z].map(|c| span(c, count)), [span(out, count)])?;
        sky.xyz_batch(
            &directions([x, y, z], count)?,
            slice_mut(out, count, "xyz")?,
        )?;
    })
}

/// welkin_baked_colour_sky_rgb for many directions, `directions[count][3]`; `rgb[count][3]`. What precedes a bad
/// direction may or may not be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_rgb_batch(
    baked: *const WelkinBakedColourSky,
    directions: *const f32,
    count: usize,
    space: i32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        let sky = &shared(baked, "baked")?.0;
        let out = rgb.cast::<[f32; 3]>();
        apart(
            [span(directions.cast::<[f32; 3]>(), count)],
            [span(out, count)],
        )?;
        let directions = slice(directions.cast::<[f32; 3]>(), count, "directions")?;
        let out = slice_mut(out, count, "rgb")?;
        in_blocks(directions, |first, block| {
            sky.rgb_batch(block, space, &mut out[first..first + block.len()])
        })?;
    })
}

/// The same with directions as three arrays, `x[count]`, `y[count]`, `z[count]`: the fastest way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_colour_sky_rgb_soa(
    baked: *const WelkinBakedColourSky,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    count: usize,
    space: i32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        let sky = &shared(baked, "baked")?.0;
        let out = rgb.cast::<[f32; 3]>();
        apart([x, y, z].map(|c| span(c, count)), [span(out, count)])?;
        sky.rgb_batch(
            &directions([x, y, z], count)?,
            space,
            slice_mut(out, count, "rgb")?,
        )?;
    })
}
