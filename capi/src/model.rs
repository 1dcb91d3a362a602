//! A model file.

use std::ffi::{CStr, c_char};
use std::path::PathBuf;
use std::sync::Arc;

use library::{Albedo, Model};

use crate::guard::{Outcome, ask, call, free};
use crate::raw::{copy, give, put, shared, slice};
use crate::status::{WelkinError, WelkinStatus};

/// A clear-sky model over a file. Opening reads the head of the file only. May be shared by threads.
pub struct WelkinModel(pub(crate) Arc<Model>);

impl WelkinModel {
    pub(crate) fn new(model: Model) -> Self {
        Self(Arc::new(model))
    }
}

#[cfg(unix)]
fn path(text: &CStr) -> Outcome<PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    Ok(std::ffi::OsStr::from_bytes(text.to_bytes()).into())
}

#[cfg(not(unix))]
fn path(text: &CStr) -> Outcome<PathBuf> {
    let text = text
        .to_str()
        .map_err(|_| crate::guard::Failure::Argument("UTF-8 text", 0))?;
    Ok(text.into())
}

/// Opens a file by mapping it, where the library was built so. It must not be changed in place while the model or
/// anything that still reads it lives; replacing it by renaming is fine. `path` is zero-terminated, UTF-8 on Windows.
///
/// Errors: WELKIN_STATUS_IO; WELKIN_STATUS_MAGIC, VERSION, FEATURE, LENGTH, CHECKSUM and VALUE for what is no sound
/// file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_open(
    path: *const c_char,
    model: *mut *mut WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(model, || {
            shared(path, "path")?;
            Ok(WelkinModel::new(Model::open(self::path(CStr::from_ptr(
                path,
            ))?)?))
        })?;
    })
}

/// Opens a file by copying it into memory. Otherwise as welkin_model_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_read(
    path: *const c_char,
    model: *mut *mut WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(model, || {
            shared(path, "path")?;
            Ok(WelkinModel::new(Model::read(self::path(CStr::from_ptr(
                path,
            ))?)?))
        })?;
    })
}

/// Opens a file that is in memory, `bytes[length]`, which is copied. Errors as of welkin_model_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_from_bytes(
    bytes: *const u8,
    length: usize,
    model: *mut *mut WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(model, || {
            Ok(WelkinModel::new(Model::from_bytes(slice(
                bytes, length, "bytes",
            )?)?))
        })?;
    })
}

/// Opens the model that is embedded in the library.
///
/// Errors: WELKIN_STATUS_UNSUPPORTED where it was built without.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_default(
    model: *mut *mut WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(model, default_model)?;
    })
}

#[cfg(feature = "default-model")]
fn default_model() -> Outcome<WelkinModel> {
    Ok(WelkinModel::new(Model::default_model()?))
}

#[cfg(not(feature = "default-model"))]
fn default_model() -> Outcome<WelkinModel> {
    Err(crate::guard::Failure::Unsupported("a default model"))
}

/// Frees a model; null is none. What was prepared of it lives on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_free(model: *mut WelkinModel) {
    free!(model)
}

/// Verifies all chunks at once instead of at their first touch.
///
/// Errors: WELKIN_STATUS_CHECKSUM, ENCODING or VALUE for the first damaged one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_verify(
    model: *const WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(model, "model")?.0.verify()?;
    })
}

/// How many wavelengths the model has; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_wavelength_count(model: *const WelkinModel) -> usize {
    ask!(model, |model| model.0.wavelengths().len())
}

/// Writes the wavelengths of the model, nm: `wavelengths[count]` with `count` of welkin_model_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_wavelengths(
    model: *const WelkinModel,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        copy(shared(model, "model")?.0.wavelengths(), wavelengths, count)?;
    })
}

/// What the model covers.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WelkinRanges {
    /// Lowest and highest solar elevation, rad.
    pub solar_elevation: [f64; 2],
    /// Lowest and highest visibility, m.
    pub visibility: [f64; 2],
    /// Lowest and highest altitude of the observer, m.
    pub altitude: [f64; 2],
    /// Shortest and longest wavelength that can be asked for, nm.
    pub wavelength: [f64; 2],
    /// Radius of the planet, m.
    pub planet_radius: f64,
    /// Altitude where the air ends, m.
    pub top: f64,
}

const _: () = assert!(size_of::<WelkinRanges>() == 80);

/// Writes what the model covers. Errors: those of a damaged file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_ranges(
    model: *const WelkinModel,
    ranges: *mut WelkinRanges,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let model = &shared(model, "model")?.0;
        let planet = model.head().planet;
        let got = WelkinRanges {
            solar_elevation: model.solar_elevation_range(),
            visibility: model.visibility_range(),
            altitude: model.altitude_range(),
            wavelength: model.wavelength_range()?,
            planet_radius: planet.radius,
            top: planet.top,
        };
        put(ranges, got, "ranges")?;
    })
}

/// The same model over a ground whose albedo depends on wavelength, as a new handle: whatever conditions say, all that is
/// prepared from it is in the light of that ground. `wavelengths[count]` (nm) increase, `albedos[count]` are within
/// 0..=1; linear between them and constant beyond. The conditions of what is prepared have the albedo at 550 nm.
///
/// What has conditions with each query says its albedo there: such queries refuse this model.
///
/// Errors: WELKIN_STATUS_VALUE for no wavelength and such as do not increase, WELKIN_STATUS_RANGE for an albedo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_over(
    model: *const WelkinModel,
    wavelengths: *const f64,
    albedos: *const f64,
    count: usize,
    over: *mut *mut WelkinModel,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(over, || {
            let model = shared(model, "model")?;
            let wavelengths = slice(wavelengths, count, "wavelengths")?;
            let albedo = Albedo::table(wavelengths, slice(albedos, count, "albedos")?)?;
            Ok(WelkinModel::new(model.0.over(&albedo)))
        })?;
    })
}

/// Whether the model has a ground of its own: see welkin_model_over. False for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_has_ground(model: *const WelkinModel) -> bool {
    ask!(model, |model| model.0.ground().is_some())
}

/// Whether the model has polarisation; false for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_is_polarised(model: *const WelkinModel) -> bool {
    ask!(model, |model| model.0.is_polarised())
}

/// Whether the light is that of the moon: see welkin_model_moonlit. False for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_is_moonlit(model: *const WelkinModel) -> bool {
    ask!(model, |model| model.0.is_moonlit())
}

/// Length of the file, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_file_bytes(model: *const WelkinModel) -> usize {
    ask!(model, |model| model.0.file_bytes())
}

/// Bytes of the file that were needed so far; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_touched_bytes(model: *const WelkinModel) -> usize {
    ask!(model, |model| model.0.touched_bytes())
}
