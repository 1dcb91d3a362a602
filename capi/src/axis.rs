//! What the visibilities of a file stand for, where its maker chose another quantity.

use std::ffi::c_char;

use library::{Error, ModelAxis};

use crate::guard::{Outcome, call};
use crate::model::WelkinModel;
use crate::raw::{copy, put, shared};
use crate::status::{WelkinError, WelkinStatus};

/// A quantity that the visibilities of a model stand for. Name and unit are UTF-8 from whoever made the file,
/// zero-terminated: escape control characters before showing them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinAxis {
    /// Least and largest value.
    pub range: [f64; 2],
    /// How many nodes it has.
    pub nodes: u64,
    /// What it is called.
    pub name: [c_char; 72],
    /// What it is measured in; empty for a number without unit.
    pub unit: [c_char; 40],
}

const _: () = assert!(size_of::<WelkinAxis>() == 136);

unsafe fn axis(model: *const WelkinModel) -> Outcome<ModelAxis> {
    // SAFETY: as the caller promises.
    let model = &unsafe { shared(model, "model")? }.0;
    let absent = Error::MissingChunk {
        kind: "axis",
        altitude: None,
        visibility: None,
    };
    Ok(model.axis()?.ok_or(absent)?)
}

/// The text as far as it goes; a longer one is in no file.
fn characters<const N: usize>(text: &str) -> [c_char; N] {
    let mut out = [0; N];
    let bytes = text.bytes().take(N - 1);
    out.iter_mut()
        .zip(bytes)
        .for_each(|(c, byte)| *c = byte as c_char);
    out
}

/// Writes which quantity the visibilities of the model stand for.
///
/// Errors: WELKIN_STATUS_MISSING where they stand for themselves; those of a damaged file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_axis(
    model: *const WelkinModel,
    axis: *mut WelkinAxis,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let got = self::axis(model)?;
        let got = WelkinAxis {
            range: got.range(),
            nodes: got.values().len() as u64,
            name: characters(got.name()),
            unit: characters(got.unit()),
        };
        put(axis, got, "axis")?;
    })
}

/// Writes the values of that quantity at the nodes, which increase or decrease: `values[count]` with `count` of
/// welkin_model_axis. Errors as there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_axis_values(
    model: *const WelkinModel,
    values: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        copy(axis(model)?.values(), values, count)?;
    })
}

/// Writes the visibility (m) that stands for a value: what conditions take.
///
/// Errors: WELKIN_STATUS_RANGE beyond the values; those of welkin_model_axis.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_axis_visibility(
    model: *const WelkinModel,
    value: f64,
    visibility: *mut f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(visibility, axis(model)?.visibility(value)?, "visibility")?;
    })
}

/// Writes the value that a visibility (m) stands for. Errors as of welkin_model_axis_visibility.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_axis_value(
    model: *const WelkinModel,
    visibility: f64,
    value: *mut f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(value, axis(model)?.value(visibility)?, "value")?;
    })
}
