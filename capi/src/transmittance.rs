//! The air alone.

use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{array, copy, give, put, shared, slice_mut};
use crate::status::{WelkinError, WelkinStatus};
use library::Transmittance;

/// The air at one visibility: transmittance along straight lines. Points are metres in a frame with its origin on the
/// ground and +z up there; the planet's centre is at (0, 0, −R). Nothing blocks the way.
pub struct WelkinTransmittance(pub(crate) Transmittance);

/// Prepares the air at a visibility (m).
///
/// Errors: WELKIN_STATUS_RANGE; WELKIN_STATUS_MISSING if the file has no transmittance; those of a damaged file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_new(
    model: *const WelkinModel,
    visibility: f64,
    air: *mut *mut WelkinTransmittance,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(air, || {
            Ok(WelkinTransmittance(
                shared(model, "model")?.0.transmittance(visibility)?,
            ))
        })?;
    })
}

/// Frees the air; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_free(air: *mut WelkinTransmittance) {
    free!(air)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_wavelength_count(
    air: *const WelkinTransmittance,
) -> usize {
    ask!(air, |handle| handle.0.wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_transmittance_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_wavelengths(
    air: *const WelkinTransmittance,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(air, "air")?;
        copy(handle.0.wavelengths(), wavelengths, count)?;
    })
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_bytes(air: *const WelkinTransmittance) -> usize {
    ask!(air, |handle| handle.0.bytes())
}

/// Transmittance between two points, `from[3]` and `to[3]`, at each of its wavelengths: `out[count]`, 0..=1.
///
/// Errors: WELKIN_STATUS_POINT for coordinates that are not finite or beyond 1e9 m; WELKIN_STATUS_LENGTH.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_between(
    air: *const WelkinTransmittance,
    from: *const f64,
    to: *const f64,
    out: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(air, "air")?.0.transmittance(
            array(from, "from")?,
            array(to, "to")?,
            slice_mut(out, count, "out")?,
        )?;
    })
}

/// The same at any wavelength (nm) within the range of the model. In an absorption band it is the mean over the band.
/// Errors also: WELKIN_STATUS_RANGE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_between_at(
    air: *const WelkinTransmittance,
    from: *const f64,
    to: *const f64,
    wavelength: f64,
    out: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            out,
            shared(air, "air")?.0.transmittance_at(
                array(from, "from")?,
                array(to, "to")?,
                wavelength,
            )?,
            "out",
        )?;
    })
}

/// Optical depth between two points; otherwise as welkin_transmittance_between.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_optical_depth(
    air: *const WelkinTransmittance,
    from: *const f64,
    to: *const f64,
    out: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(air, "air")?.0.optical_depth(
            array(from, "from")?,
            array(to, "to")?,
            slice_mut(out, count, "out")?,
        )?;
    })
}

/// Transmittance from a point to space in a `direction[3]`, which need not be normalised; zero where the ground is in
/// the way. Errors also: WELKIN_STATUS_DIRECTION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_to_space(
    air: *const WelkinTransmittance,
    from: *const f64,
    direction: *const f64,
    out: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(air, "air")?.0.transmittance_to_space(
            array(from, "from")?,
            array(direction, "direction")?,
            slice_mut(out, count, "out")?,
        )?;
    })
}

/// The same at any wavelength (nm) within the range of the model. In an absorption band it is the mean over the band.
/// Errors also: WELKIN_STATUS_RANGE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_to_space_at(
    air: *const WelkinTransmittance,
    from: *const f64,
    direction: *const f64,
    wavelength: f64,
    out: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            out,
            shared(air, "air")?.0.transmittance_to_space_at(
                array(from, "from")?,
                array(direction, "direction")?,
                wavelength,
            )?,
            "out",
        )?;
    })
}

/// Transmittance from a point in a direction through all of the air, up to the ground where that is in the way. Errors
/// as of welkin_transmittance_to_space.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_to_end(
    air: *const WelkinTransmittance,
    from: *const f64,
    direction: *const f64,
    out: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(air, "air")?.0.transmittance_to_end(
            array(from, "from")?,
            array(direction, "direction")?,
            slice_mut(out, count, "out")?,
        )?;
    })
}

/// The same at any wavelength (nm) within the range of the model. In an absorption band it is the mean over the band.
/// Errors also: WELKIN_STATUS_RANGE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_transmittance_to_end_at(
    air: *const WelkinTransmittance,
    from: *const f64,
    direction: *const f64,
    wavelength: f64,
    out: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            out,
            shared(air, "air")?.0.transmittance_to_end_at(
                array(from, "from")?,
                array(direction, "direction")?,
                wavelength,
            )?,
            "out",
        )?;
    })
}
