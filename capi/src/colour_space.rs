//! Linear colour spaces.

use std::ffi::{CStr, c_char};

use library::ColourSpace;

use crate::guard::{Failure, Outcome, call};
use crate::raw::{array, put, put_array};
use crate::status::{WelkinError, WelkinStatus};

/// Linear sRGB (primaries of ITU-R BT.709), white D65.
pub const WELKIN_SPACE_SRGB: i32 = 0;
/// Linear ITU-R BT.2020, white D65.
pub const WELKIN_SPACE_REC2020: i32 = 1;
/// ACEScg (primaries AP1), white of ACES, reached by Bradford's adaptation from D65.
pub const WELKIN_SPACE_ACESCG: i32 = 2;
/// CIE 1931 XYZ itself.
pub const WELKIN_SPACE_XYZ: i32 = 3;

const ALL: [(i32, ColourSpace); 4] = [
    (WELKIN_SPACE_SRGB, ColourSpace::Srgb),
    (WELKIN_SPACE_REC2020, ColourSpace::Rec2020),
    (WELKIN_SPACE_ACESCG, ColourSpace::AcesCg),
    (WELKIN_SPACE_XYZ, ColourSpace::Xyz),
];

/// The space of a constant.
pub fn space_of(space: i32) -> Outcome<ColourSpace> {
    let found = ALL.iter().find(|(known, _)| *known == space);
    found.map_or(
        Err(Failure::Argument("colour space", space.into())),
        |(_, space)| Ok(*space),
    )
}

/// Finds a space by its name: "srgb", "rec2020", "acescg" or "xyz".
///
/// Errors: WELKIN_STATUS_VALUE for another name; WELKIN_STATUS_ARGUMENT if it is not UTF-8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_space_by_name(
    name: *const c_char,
    space: *mut i32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        crate::raw::shared(name, "name")?;
        let name = CStr::from_ptr(name)
            .to_str()
            .map_err(|_| Failure::Argument("UTF-8 text", 0))?;
        let found: ColourSpace = name.parse()?;
        let (constant, _) = ALL
            .iter()
            .find(|(_, known)| *known == found)
            .ok_or(Failure::Unsupported("this space"))?;
        put(space, *constant, "space")?;
    })
}

/// Converts CIE 1931 XYZ, `xyz[3]`, to `rgb[3]`, which may be the same memory. Not clipped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_space_from_xyz(
    space: i32,
    xyz: *const f32,
    rgb: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(rgb, space_of(space)?.from_xyz(array(xyz, "xyz")?), "rgb")?;
    })
}

/// Writes the matrix of welkin_space_from_xyz, `matrix[3][3]`, a row for each component.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_space_matrix(
    space: i32,
    matrix: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_array(
            matrix.cast::<[f32; 3]>(),
            space_of(space)?.matrix(),
            "matrix",
        )?;
    })
}
