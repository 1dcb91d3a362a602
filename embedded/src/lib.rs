//! Radiance from a model in memory for programs without standard library and heap.
#![no_std]
#![deny(unsafe_code)]

use core::panic::PanicInfo;
use core::slice;

use welkin::{Conditions, PointQuery};

/// Writes spectral radiance (W m⁻² sr⁻¹ nm⁻¹) at the wavelengths of a model to `out` and returns 0, or −1 where
/// something is wrong. `conditions`: solar elevation, solar azimuth (rad), visibility (m), albedo, altitude (m).
/// No name of `welkin.h` is the same, so that a program may link both.
///
/// # Safety
/// `model` points to `model_length` bytes, `conditions` to five, `direction` to three and `out` to `out_length`
/// numbers.
#[allow(unsafe_code, reason = "callers in C hand over pointers and look for the name")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_point_radiance(
    model: *const u8,
    model_length: usize,
    conditions: *const f64,
    direction: *const f32,
    out: *mut f32,
    out_length: usize,
) -> i32 {
    // SAFETY: the caller's part.
    let (model, conditions, direction, out) = unsafe {
        (
            slice::from_raw_parts(model, model_length),
            *conditions.cast::<[f64; 5]>(),
            *direction.cast::<[f32; 3]>(),
            slice::from_raw_parts_mut(out, out_length),
        )
    };
    let [solar_elevation, solar_azimuth, visibility, albedo, altitude] = conditions;
    let conditions = Conditions {
        solar_elevation,
        solar_azimuth,
        visibility,
        albedo,
        altitude,
    };
    let answer = PointQuery::new(model).and_then(|query| query.radiance(&conditions, direction, out));
    match answer {
        Ok(()) => 0,
        Err(_) => -1,
    }
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {}
}
