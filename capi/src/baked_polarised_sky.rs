//! The sky with its polarisation as tables.

use crate::guard::{ask, call, free};
use crate::polarised_sky::WelkinPolarisedSky;
use crate::raw;
use crate::raw::{
    apart, array, copy, directions, exclusive, give, in_blocks, put, put_array, shared, slice,
    slice_mut, span, spectra,
};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{
    WelkinBakeError, WelkinConditions, WelkinPolarisationFrame, WelkinStokes, frame_of,
    put_conditions,
};
use library::{BakedPolarisedSky, Stokes};

/// A sky with its polarisation as tables. Nothing allocates.
pub struct WelkinBakedPolarisedSky(pub(crate) BakedPolarisedSky);

/// As welkin_sky_bake; the tolerance holds for the radiance, and for (Q, U) relative to it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_sky_bake(
    sky: *const WelkinPolarisedSky,
    tolerance: f64,
    baked: *mut *mut WelkinBakedPolarisedSky,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(baked, || {
            Ok(WelkinBakedPolarisedSky(
                shared(sky, "sky")?.0.bake(tolerance)?,
            ))
        })?;
    })
}

/// Frees a baked sky; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_free(baked: *mut WelkinBakedPolarisedSky) {
    free!(baked)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_wavelength_count(
    baked: *const WelkinBakedPolarisedSky,
) -> usize {
    ask!(baked, |handle| handle.0.sky().wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of
/// welkin_baked_polarised_sky_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_wavelengths(
    baked: *const WelkinBakedPolarisedSky,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(baked, "baked")?;
        copy(handle.0.sky().wavelengths(), wavelengths, count)?;
    })
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_bytes(
    baked: *const WelkinBakedPolarisedSky,
) -> usize {
    ask!(baked, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_conditions(
    baked: *const WelkinBakedPolarisedSky,
    conditions: *mut WelkinConditions,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_conditions(conditions, shared(baked, "baked")?.0.sky().conditions())?;
    })
}

/// Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
/// uses the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_set_solar_azimuth(
    baked: *mut WelkinBakedPolarisedSky,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(baked, "baked")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// What baking added to the error of the sky.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_bake_error(
    baked: *const WelkinBakedPolarisedSky,
    bake_error: *mut WelkinBakeError,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            bake_error,
            shared(baked, "baked")?.0.sky().bake_error().into(),
            "bake_error",
        )?;
    })
}

/// What baking added to the error of (Q, U) over I, as a distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_polarisation_error(
    baked: *const WelkinBakedPolarisedSky,
    bake_error: *mut WelkinBakeError,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            bake_error,
            shared(baked, "baked")?.0.polarisation_error().into(),
            "bake_error",
        )?;
    })
}

/// The radiance alone, as welkin_baked_sky_radiance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_radiance(
    baked: *const WelkinBakedPolarisedSky,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(baked, "baked")?.0.sky().radiance(
            array(direction, "direction")?,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// Stokes vectors, W m⁻² sr⁻¹ nm⁻¹, as three arrays `i[count]`, `q[count]`, `u[count]` with an element per wavelength,
/// in a frame (null: the vertical one). Errors as of welkin_polarised_sky_stokes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_stokes(
    baked: *const WelkinBakedPolarisedSky,
    direction: *const f32,
    frame: *const WelkinPolarisationFrame,
    i: *mut f32,
    q: *mut f32,
    u: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (direction, frame) = (array(direction, "direction")?, frame_of(frame)?);
        shared(baked, "baked")?
            .0
            .stokes(direction, frame, spectra([i, q, u], count)?)?;
    })
}

/// The same for many directions as three arrays; the outputs are `[direction_count][wavelengths]`, of which `count` is
/// the number of floats of each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_stokes_soa(
    baked: *const WelkinBakedPolarisedSky,
    x: *const f32,
    y: *const f32,
    z: *const f32,
    direction_count: usize,
    frame: *const WelkinPolarisationFrame,
    i: *mut f32,
    q: *mut f32,
    u: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let frame = frame_of(frame)?;
        apart(
            [x, y, z].map(|c| span(c, direction_count)),
            [i, q, u].map(|c| span(c, count)),
        )?;
        let directions = directions([x, y, z], direction_count)?;
        shared(baked, "baked")?
            .0
            .stokes_batch(&directions, frame, spectra([i, q, u], count)?)?;
    })
}

/// Stokes vectors at four wavelengths (nm) of a path: `wavelengths[4]`, `stokes[4]`.
///
/// Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for a wavelength.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_hero(
    baked: *const WelkinBakedPolarisedSky,
    direction: *const f32,
    frame: *const WelkinPolarisationFrame,
    wavelengths: *const f32,
    stokes: *mut WelkinStokes,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (direction, frame) = (array(direction, "direction")?, frame_of(frame)?);
        let stokes_4 =
            shared(baked, "baked")?
                .0
                .hero(direction, frame, array(wavelengths, "wavelengths")?)?;
        put_array(stokes, stokes_4.map(WelkinStokes::from), "stokes")?;
    })
}

/// The same for many directions: `directions[count][3]`, `wavelengths[count][4]`, `stokes[count][4]`. What precedes a
/// bad one may or may not be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_baked_polarised_sky_hero_batch(
    baked: *const WelkinBakedPolarisedSky,
    directions: *const f32,
    frame: *const WelkinPolarisationFrame,
    wavelengths: *const f32,
    count: usize,
    stokes: *mut WelkinStokes,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let frame = frame_of(frame)?;
        let out = stokes.cast::<[WelkinStokes; 4]>();
        let inputs = [
            span(directions.cast::<[f32; 3]>(), count),
            span(wavelengths.cast::<[f32; 4]>(), count),
        ];
        apart(inputs, [span(out, count)])?;
        let directions = slice(directions.cast::<[f32; 3]>(), count, "directions")?;
        let wavelengths = slice(wavelengths.cast::<[f32; 4]>(), count, "wavelengths")?;
        let out = slice_mut(out, count, "stokes")?;
        let sky = &shared(baked, "baked")?.0;
        let mut values = [[Stokes::default(); 4]; raw::BLOCK];
        in_blocks(directions, |first, block| {
            let range = first..first + block.len();
            let values = &mut values[..block.len()];
            sky.hero_batch(block, frame, &wavelengths[range.clone()], values)?;
            for (out, value) in out[range].iter_mut().zip(values) {
                *out = value.map(WelkinStokes::from);
            }
            Ok(())
        })?;
    })
}
