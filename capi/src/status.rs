//! Error codes and their text.

use std::ffi::{CStr, c_char};

/// What became of a call: WELKIN_STATUS_OK or a code of an error. Codes never change their meaning; a later library may
/// have more of them.
///
/// From WELKIN_STATUS_IO to WELKIN_STATUS_POINT they are the classes of errors of the format specification and of the
/// Rust library; from WELKIN_STATUS_NULL on they are about the call itself.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WelkinStatus {
    /// All went well.
    Ok = 0,
    /// The operating system refused to read a file.
    Io = 1,
    /// The bytes do not start like a welkin file.
    Magic = 2,
    /// The file has a major version that this library does not know.
    Version = 3,
    /// The file needs features that this library does not have.
    Feature = 4,
    /// A chunk is stored in an encoding that this library cannot decode.
    Encoding = 5,
    /// An array or a file has the wrong length.
    Length = 6,
    /// The file is damaged.
    Checksum = 7,
    /// A value in the file breaks the format specification.
    Value = 8,
    /// The file lacks a chunk that the conditions need.
    Missing = 9,
    /// A parameter is not finite or outside the range of the model.
    Range = 10,
    /// No table is large enough for the wanted tolerance.
    Tolerance = 11,
    /// The model is too large for point queries.
    Limit = 12,
    /// A direction has length zero or a component that is not finite.
    Direction = 13,
    /// A point has a coordinate that is not finite, or lies too far away.
    Point = 14,
    /// A pointer is null that must not be.
    Null = 64,
    /// A pointer is not aligned as its elements need.
    Alignment = 65,
    /// An output overlaps an input or another output.
    Overlap = 66,
    /// A struct_size is smaller than that of version 1.0, or a field is set that this library does not know.
    Struct = 67,
    /// A constant is none of those of its type, or text is not terminated or not UTF-8.
    Argument = 68,
    /// This library was built without what the call needs.
    Unsupported = 69,
    /// The program was compiled with a header that this library does not serve.
    Abi = 70,
    /// A defect of the library. Handles that the call was to change must only be freed.
    Panic = 71,
    /// An error of the library of a class that has no code yet.
    Other = 72,
}

const ALL: [(WelkinStatus, &CStr); 24] = [
    (WelkinStatus::Ok, c"ok"),
    (WelkinStatus::Io, c"io"),
    (WelkinStatus::Magic, c"magic"),
    (WelkinStatus::Version, c"version"),
    (WelkinStatus::Feature, c"feature"),
    (WelkinStatus::Encoding, c"encoding"),
    (WelkinStatus::Length, c"length"),
    (WelkinStatus::Checksum, c"checksum"),
    (WelkinStatus::Value, c"value"),
    (WelkinStatus::Missing, c"missing"),
    (WelkinStatus::Range, c"range"),
    (WelkinStatus::Tolerance, c"tolerance"),
    (WelkinStatus::Limit, c"limit"),
    (WelkinStatus::Direction, c"direction"),
    (WelkinStatus::Point, c"point"),
    (WelkinStatus::Null, c"null"),
    (WelkinStatus::Alignment, c"alignment"),
    (WelkinStatus::Overlap, c"overlap"),
    (WelkinStatus::Struct, c"struct"),
    (WelkinStatus::Argument, c"argument"),
    (WelkinStatus::Unsupported, c"unsupported"),
    (WelkinStatus::Abi, c"abi"),
    (WelkinStatus::Panic, c"panic"),
    (WelkinStatus::Other, c"other"),
];

impl WelkinStatus {
    /// Of a class of errors of the library.
    pub(crate) fn of_class(class: &str) -> Self {
        let known = ALL[1..].iter().filter(|(status, _)| (*status as i32) < 64);
        let found = known
            .into_iter()
            .find(|(_, name)| name.to_bytes() == class.as_bytes());
        found.map_or(WelkinStatus::Other, |(status, _)| *status)
    }
}

/// Room for what went wrong, in the caller's memory: no state of the library holds errors. This struct never changes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinError {
    /// What the call returned: a WelkinStatus.
    pub status: i32,
    /// What went wrong in English, UTF-8, zero-terminated, cut where it is longer; empty where nothing did.
    pub text: [c_char; 256],
}

impl WelkinError {
    /// Notes a failure.
    pub(crate) fn set(&mut self, status: WelkinStatus, text: &str) {
        self.status = status as i32;
        let mut end = text.len().min(self.text.len() - 1);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        for (to, from) in self.text.iter_mut().zip(text[..end].bytes()) {
            // A zero inside would end the text.
            *to = from.max(1) as c_char;
        }
        self.text[end] = 0;
    }
}

/// The name of a status: the class of an error as the format specification writes it, as "range"; "unknown" where the
/// number is no status of this library. Static, never null.
#[unsafe(no_mangle)]
pub extern "C" fn welkin_status_name(status: i32) -> *const c_char {
    let found = ALL.iter().find(|(known, _)| *known as i32 == status);
    found.map_or(c"unknown", |(_, name)| *name).as_ptr()
}
