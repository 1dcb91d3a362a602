//! Versions and sizes.

use std::ffi::{CStr, c_char};

use crate::colour_aerial_perspective::WelkinCameraVolume;
use crate::guard::{Failure, call};
use crate::model::WelkinRanges;
use crate::moon::WelkinMoon;
use crate::plan::{WelkinBudget, WelkinPlanSummary};
use crate::raw::shared;
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{
    WelkinBakeError, WelkinConditions, WelkinPolarisationFrame, WelkinSample, WelkinStokes,
};

/// Major version of this interface, which is in the name of the shared library: programs need the same.
pub const WELKIN_ABI_MAJOR: u32 = 1;
/// Minor version: it grows with new functions, and with new fields at the end of structs that have a struct_size.
/// Programs run with libraries of theirs or a greater one.
pub const WELKIN_ABI_MINOR: u32 = 0;
/// Both.
pub const WELKIN_ABI_VERSION: u32 = 65536;

const _: () = assert!(WELKIN_ABI_VERSION == WELKIN_ABI_MAJOR << 16 | WELKIN_ABI_MINOR);

const VERSION: &CStr =
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => panic!("a version is text"),
    };

/// The version and sizes that a program was compiled with: WELKIN_ABI fills it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinAbi {
    /// WELKIN_ABI_VERSION.
    pub version: u32,
    /// sizeof(void *).
    pub pointer: u32,
    /// sizeof(WelkinError).
    pub error: u32,
    /// sizeof(WelkinConditions).
    pub conditions: u32,
    /// sizeof(WelkinPolarisationFrame).
    pub polarisation_frame: u32,
    /// sizeof(WelkinStokes).
    pub stokes: u32,
    /// sizeof(WelkinBakeError).
    pub bake_error: u32,
    /// sizeof(WelkinSample).
    pub sample: u32,
    /// sizeof(WelkinRanges).
    pub ranges: u32,
    /// sizeof(WelkinMoon).
    pub moon: u32,
    /// sizeof(WelkinBudget).
    pub budget: u32,
    /// sizeof(WelkinPlanSummary).
    pub plan_summary: u32,
    /// sizeof(WelkinCameraVolume).
    pub camera_volume: u32,
    /// Zero.
    pub reserved: [u32; 3],
}

const _: () = assert!(size_of::<WelkinAbi>() == 64);
#[cfg(target_pointer_width = "64")]
const _: () = assert!(size_of::<WelkinCameraVolume>() == 136);

const fn size<T>() -> u32 {
    size_of::<T>() as u32
}

/// Of this library.
const OWN: WelkinAbi = WelkinAbi {
    version: WELKIN_ABI_VERSION,
    pointer: size::<*const ()>(),
    error: size::<WelkinError>(),
    conditions: size::<WelkinConditions>(),
    polarisation_frame: size::<WelkinPolarisationFrame>(),
    stokes: size::<WelkinStokes>(),
    bake_error: size::<WelkinBakeError>(),
    sample: size::<WelkinSample>(),
    ranges: size::<WelkinRanges>(),
    moon: size::<WelkinMoon>(),
    budget: size::<WelkinBudget>(),
    plan_summary: size::<WelkinPlanSummary>(),
    camera_volume: size::<WelkinCameraVolume>(),
    reserved: [0; 3],
};

impl WelkinAbi {
    /// What must be the same, with names.
    fn fixed(&self) -> [(&'static str, u32); 7] {
        [
            ("a pointer", self.pointer),
            ("WelkinError", self.error),
            ("WelkinPolarisationFrame", self.polarisation_frame),
            ("WelkinStokes", self.stokes),
            ("WelkinBakeError", self.bake_error),
            ("WelkinSample", self.sample),
            ("WelkinRanges", self.ranges),
        ]
    }

    /// What a program of the same or an older version has no more of.
    fn growing(&self) -> [(&'static str, u32); 5] {
        [
            ("WelkinConditions", self.conditions),
            ("WelkinMoon", self.moon),
            ("WelkinBudget", self.budget),
            ("WelkinPlanSummary", self.plan_summary),
            ("WelkinCameraVolume", self.camera_volume),
        ]
    }

    fn check(&self) -> Result<(), String> {
        let parts = |version: u32| (version >> 16, version & 0xffff);
        let ((major, minor), (own_major, own_minor)) = (parts(self.version), parts(OWN.version));
        if major != own_major || minor > own_minor {
            return Err(format!(
                "compiled with version {major}.{minor} of the interface, the library has {own_major}.{own_minor}"
            ));
        }
        let same = self
            .fixed()
            .into_iter()
            .zip(OWN.fixed())
            .map(|(got, own)| (got, own, got.1 == own.1));
        let less = self
            .growing()
            .into_iter()
            .zip(OWN.growing())
            .map(|(got, own)| (got, own, got.1 <= own.1));
        match same.chain(less).find(|(_, _, good)| !good) {
            None => Ok(()),
            Some(((name, got), (_, own), _)) => Err(format!(
                "the size of {name} is {got}, the library has {own}"
            )),
        }
    }
}

/// Major · 65536 + minor version of the interface of the library that runs.
#[unsafe(no_mangle)]
pub extern "C" fn welkin_abi_version() -> u32 {
    WELKIN_ABI_VERSION
}

/// Version of the library that runs, as "0.1.0". Static.
#[unsafe(no_mangle)]
pub extern "C" fn welkin_library_version() -> *const c_char {
    VERSION.as_ptr()
}

/// Checks that the header that a program was compiled with fits the library that it runs with: call it once with
/// WELKIN_ABI, before anything else.
///
/// Errors: WELKIN_STATUS_ABI, and the text says what differs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_check_abi(
    compiled: *const WelkinAbi,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(compiled, "compiled")?
            .check()
            .map_err(Failure::Abi)?;
    })
}
