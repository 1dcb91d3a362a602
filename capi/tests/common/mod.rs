//! What the tests share.
#![allow(dead_code)]

use std::ffi::CStr;
use std::ptr::null_mut;

use welkin::*;

/// Directions all around, some close to the horizon.
pub const DIRECTIONS: [[f32; 3]; 7] = [
    [0.0, 0.0, 1.0],
    [0.3, 0.1, 0.9],
    [-0.5, 0.7, 0.01],
    [0.5, -0.7, -0.01],
    [2.0, 0.0, 0.7],
    [0.0, 0.0, -1.0],
    [1e-3, -2e-3, 3e-3],
];

pub fn no_error() -> WelkinError {
    WelkinError {
        status: -1,
        text: [1; 256],
    }
}

/// The text of an error, which must end.
pub fn text(error: &WelkinError) -> String {
    let bytes: Vec<u8> = error.text.iter().map(|&c| c as u8).collect();
    CStr::from_bytes_until_nul(&bytes)
        .expect("terminated")
        .to_str()
        .expect("UTF-8")
        .to_owned()
}

/// Calls a function and expects success.
#[macro_export]
macro_rules! good {
    ($function:ident($($argument:expr),* $(,)?)) => {{
        let mut error = $crate::common::no_error();
        // SAFETY: the test hands over what the function asks for.
        let status = unsafe { welkin::$function($($argument,)* &mut error) };
        assert_eq!(status, WelkinStatus::Ok, "{}", $crate::common::text(&error));
        assert_eq!((error.status, error.text[0]), (0, 0));
    }};
}

/// Calls a function and expects this status, with a text.
#[macro_export]
macro_rules! bad {
    ($status:ident: $function:ident($($argument:expr),* $(,)?)) => {{
        let mut error = $crate::common::no_error();
        // SAFETY: the test hands over what the function asks for, or what it promises to notice.
        let status = unsafe { welkin::$function($($argument,)* &mut error) };
        let text = $crate::common::text(&error);
        assert_eq!(status, WelkinStatus::$status, "{text}");
        assert_eq!(error.status, status as i32);
        assert!(!text.is_empty());
        // Without room for the text the status is the same.
        // SAFETY: as above.
        assert_eq!(unsafe { welkin::$function($($argument,)* std::ptr::null_mut()) }, status);
        text
    }};
}

/// A new handle of a function.
#[macro_export]
macro_rules! make {
    ($function:ident($($argument:expr),* $(,)?)) => {{
        let mut handle = std::ptr::null_mut();
        $crate::good!($function($($argument,)* &mut handle));
        assert!(!handle.is_null());
        handle
    }};
}

pub fn default_model() -> *mut WelkinModel {
    let mut model = null_mut();
    good!(welkin_model_default(&mut model));
    model
}

/// Conditions of the interface and of the library.
pub fn conditions() -> (WelkinConditions, library::Conditions) {
    let own = library::Conditions {
        solar_elevation: 0.4,
        solar_azimuth: 1.1,
        visibility: 43e3,
        altitude: 350.0,
        albedo: 0.3,
    };
    let mut theirs = WelkinConditions {
        struct_size: 0,
        solar_elevation: 0.0,
        solar_azimuth: 0.0,
        visibility: 0.0,
        albedo: 0.0,
        altitude: 0.0,
    };
    good!(welkin_conditions_init(
        &mut theirs,
        size_of::<WelkinConditions>() as u64
    ));
    theirs.solar_elevation = own.solar_elevation;
    theirs.solar_azimuth = own.solar_azimuth;
    theirs.visibility = own.visibility;
    theirs.albedo = own.albedo;
    theirs.altitude = own.altitude;
    (theirs, own)
}
