//! The structs that callers fill.

use std::mem::{MaybeUninit, offset_of};

use library::{BakeError, Conditions, PolarisationFrame, Sample, Stokes};

use crate::guard::{Failure, Outcome, call};
use crate::raw::put;
use crate::status::{WelkinError, WelkinStatus};

/// The conditions of a sky. Initialise with welkin_conditions_init, then set what differs.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinConditions {
    /// sizeof(WelkinConditions) of the program.
    pub struct_size: u64,
    /// Geometric elevation of the sun's centre above the observer's horizontal plane, rad.
    pub solar_elevation: f64,
    /// Azimuth of the sun, rad, counter-clockwise from +x seen from above. Any finite angle.
    pub solar_azimuth: f64,
    /// Horizontal meteorological range at the ground, m.
    pub visibility: f64,
    /// Albedo of the ground, 0..=1, the same at all wavelengths.
    pub albedo: f64,
    /// Altitude of the observer above the ground, m; from -500 up to 0 it counts as 0.
    pub altitude: f64,
}

/// The axis e1 of positive Q across the view direction w; e2 = w × e1. A null pointer means the vertical frame.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinPolarisationFrame {
    /// One of WELKIN_FRAME_VERTICAL, WELKIN_FRAME_SUN_ALIGNED and WELKIN_FRAME_AXIS.
    pub kind: i32,
    /// For WELKIN_FRAME_AXIS: e1 is the part of this vector that is perpendicular to the view direction, such as the
    /// up vector of a camera.
    pub axis: [f32; 3],
}

/// e1 lies in the vertical plane and points up, so e2 points to the right.
pub const WELKIN_FRAME_VERTICAL: i32 = 0;
/// e1 is perpendicular to the plane of view direction and sun: light that air scattered once has Q > 0 and U = 0.
pub const WELKIN_FRAME_SUN_ALIGNED: i32 = 1;
/// e1 is given by a vector.
pub const WELKIN_FRAME_AXIS: i32 = 2;

/// Intensity and linear polarisation of light: what a polariser along e1 passes less what one along e2 passes is q, and
/// u the same of the diagonals e1 + e2 and e1 − e2.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WelkinStokes {
    /// Radiance.
    pub i: f32,
    /// Polarised along e1 less e2.
    pub q: f32,
    /// Polarised along e1 + e2 less e1 − e2.
    pub u: f32,
}

impl From<Stokes> for WelkinStokes {
    fn from(Stokes { i, q, u }: Stokes) -> Self {
        Self { i, q, u }
    }
}

/// What baking, or interpolating between baked skies, added to the relative error: percentiles over directions and
/// channels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WelkinBakeError {
    /// Median.
    pub median: f64,
    /// 95th percentile: at most the tolerance.
    pub p95: f64,
    /// 99th percentile.
    pub p99: f64,
    /// 99.9th percentile.
    pub p999: f64,
    /// Largest of the compared directions.
    pub max: f64,
}

impl From<BakeError> for WelkinBakeError {
    fn from(error: BakeError) -> Self {
        let BakeError {
            median,
            p95,
            p99,
            p999,
            max,
        } = error;
        Self {
            median,
            p95,
            p99,
            p999,
            max,
        }
    }
}

/// A direction, the density that it was drawn with and the light from there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WelkinSample {
    /// Unit vector.
    pub direction: [f32; 3],
    /// Density per solid angle, sr⁻¹.
    pub pdf: f32,
    /// CIE XYZ of sky and, if it is drawn, the sun's disc; Y in cd m⁻².
    pub xyz: [f32; 3],
    /// What it was drawn for: WELKIN_PART_SKY or WELKIN_PART_SUN. Its density counts both all the same.
    pub part: i32,
}

/// The sky without the sun's disc.
pub const WELKIN_PART_SKY: i32 = 0;
/// The visible part of the sun's disc.
pub const WELKIN_PART_SUN: i32 = 1;

impl From<Sample> for WelkinSample {
    fn from(sample: Sample) -> Self {
        Self {
            direction: sample.direction,
            pdf: sample.pdf,
            xyz: sample.xyz,
            part: match sample.part {
                library::Part::Sky => WELKIN_PART_SKY,
                library::Part::Sun => WELKIN_PART_SUN,
            },
        }
    }
}

/// A struct of which later versions may have more fields: its first is `struct_size`, an u64.
///
/// # Safety
/// `repr(C)`, without padding, of numbers for which every pattern of bits is a value.
pub unsafe trait Sized64: Copy {
    /// Name in the header.
    const NAME: &'static str;
    /// Size in version 1.0 of the interface.
    const LEAST: usize;
}

// SAFETY: six numbers of eight bytes.
unsafe impl Sized64 for WelkinConditions {
    const NAME: &'static str = "WelkinConditions";
    const LEAST: usize = 48;
}

/// More than any struct will ever have.
const MOST: u64 = 4096;

/// Reads the struct of a program that may be older or newer than this library: fields that it does not have are zero,
/// which means what their absence means, and those that this library does not know must be.
pub unsafe fn read<T: Sized64>(pointer: *const T) -> Outcome<T> {
    if pointer.is_null() {
        return Err(Failure::Null(T::NAME));
    }
    if !pointer.is_aligned() {
        return Err(Failure::Alignment(T::NAME));
    }
    // SAFETY: a struct of the program is at least as long as its first field.
    let got = unsafe { *pointer.cast::<u64>() };
    check_size::<T>(got)?;
    let bytes = pointer.cast::<u8>();
    let known = size_of::<T>().min(got as usize);
    // SAFETY: it is as long as its first field says.
    let rest = unsafe { std::slice::from_raw_parts(bytes.add(known), got as usize - known) };
    if rest.iter().any(|&byte| byte != 0) {
        return Err(Failure::UnknownField(T::NAME));
    }
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: no more is copied than either has, and every pattern of bits is a value.
    unsafe {
        std::ptr::copy_nonoverlapping(bytes, value.as_mut_ptr().cast(), known);
        Ok(value.assume_init())
    }
}

/// Writes as much of a struct as the program has room for, but not its size.
pub unsafe fn write<T: Sized64>(pointer: *mut T, value: &T, struct_size: u64) -> Outcome<()> {
    if pointer.is_null() {
        return Err(Failure::Null(T::NAME));
    }
    if !pointer.is_aligned() {
        return Err(Failure::Alignment(T::NAME));
    }
    check_size::<T>(struct_size)?;
    let known = size_of::<T>().min(struct_size as usize);
    let bytes = pointer.cast::<u8>();
    // SAFETY: it is as long as the caller says, and no more is copied than either has.
    unsafe {
        std::ptr::copy_nonoverlapping((&raw const *value).cast(), bytes, known);
        std::ptr::write_bytes(bytes.add(known), 0, struct_size as usize - known);
        pointer.cast::<u64>().write(struct_size);
    }
    Ok(())
}

/// The size that a struct says it has.
pub unsafe fn size_in<T: Sized64>(pointer: *const T) -> Outcome<u64> {
    // SAFETY: a struct of the program is at least as long as its first field.
    unsafe { crate::raw::shared(pointer.cast::<u64>(), T::NAME).copied() }
}

fn check_size<T: Sized64>(got: u64) -> Outcome<()> {
    match (T::LEAST as u64..=MOST).contains(&got) {
        true => Ok(()),
        false => Err(Failure::StructSize {
            what: T::NAME,
            got,
            least: T::LEAST,
        }),
    }
}

impl WelkinConditions {
    pub(crate) fn new(conditions: &Conditions) -> Self {
        Self {
            struct_size: size_of::<Self>() as u64,
            solar_elevation: conditions.solar_elevation,
            solar_azimuth: conditions.solar_azimuth,
            visibility: conditions.visibility,
            albedo: conditions.albedo,
            altitude: conditions.altitude,
        }
    }
}

/// Conditions of the caller.
pub unsafe fn conditions_of(pointer: *const WelkinConditions) -> Outcome<Conditions> {
    // SAFETY: the caller's part.
    let got = unsafe { read(pointer)? };
    Ok(Conditions {
        solar_elevation: got.solar_elevation,
        solar_azimuth: got.solar_azimuth,
        visibility: got.visibility,
        albedo: got.albedo,
        altitude: got.altitude,
    })
}

/// Writes conditions to a struct whose struct_size the caller has set.
pub unsafe fn put_conditions(out: *mut WelkinConditions, conditions: &Conditions) -> Outcome<()> {
    // SAFETY: the caller's part.
    unsafe { write(out, &WelkinConditions::new(conditions), size_in(out)?) }
}

/// A frame of the caller; null is the vertical one.
pub unsafe fn frame_of(pointer: *const WelkinPolarisationFrame) -> Outcome<PolarisationFrame> {
    if pointer.is_null() {
        return Ok(PolarisationFrame::Vertical);
    }
    // SAFETY: the caller's part.
    let frame = unsafe { crate::raw::shared(pointer, "the frame")? };
    match frame.kind {
        WELKIN_FRAME_VERTICAL => Ok(PolarisationFrame::Vertical),
        WELKIN_FRAME_SUN_ALIGNED => Ok(PolarisationFrame::SunAligned),
        WELKIN_FRAME_AXIS => Ok(PolarisationFrame::Axis(frame.axis)),
        other => Err(Failure::Argument("kind of frame", i64::from(other))),
    }
}

/// Fills conditions: the sun 20° high towards +x, visibility 59.4 km, albedo 0.2, the observer on the ground.
/// `struct_size` is sizeof(WelkinConditions).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_conditions_init(
    conditions: *mut WelkinConditions,
    struct_size: u64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        write(
            conditions,
            &WelkinConditions::new(&Conditions::default()),
            struct_size,
        )?;
    })
}

/// Unit vector towards the sun's centre, as `sun[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_conditions_sun_direction(
    conditions: *const WelkinConditions,
    sun: *mut f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let conditions = conditions_of(conditions)?;
        crate::raw::put_array(sun, conditions.sun_direction(), "sun")?;
    })
}

/// Degree of linear polarisation, 0..=1; 0 without light or for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_stokes_degree(stokes: *const WelkinStokes) -> f32 {
    crate::guard::ask!(stokes, |s| Stokes {
        i: s.i,
        q: s.q,
        u: s.u
    }
    .degree())
}

/// Angle of polarisation from e1 towards e2, −π/2..=π/2 rad; 0 without polarisation or for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_stokes_angle(stokes: *const WelkinStokes) -> f32 {
    crate::guard::ask!(stokes, |s| Stokes {
        i: s.i,
        q: s.q,
        u: s.u
    }
    .angle())
}

/// Radiance behind an ideal polariser at `angle` (rad) from e1 towards e2; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_stokes_through_polariser(
    stokes: *const WelkinStokes,
    angle: f32,
) -> f32 {
    crate::guard::ask!(stokes, |s| Stokes {
        i: s.i,
        q: s.q,
        u: s.u
    }
    .through_polariser(angle))
}

/// Writes a Stokes vector.
pub unsafe fn put_stokes(out: *mut WelkinStokes, stokes: Stokes) -> Outcome<()> {
    // SAFETY: the caller's part.
    unsafe { put(out, stokes.into(), "stokes") }
}

// The header asserts the same in C.
const _: () = {
    assert!(size_of::<WelkinConditions>() == WelkinConditions::LEAST);
    assert!(offset_of!(WelkinConditions, solar_elevation) == 8);
    assert!(offset_of!(WelkinConditions, altitude) == 40);
    assert!(size_of::<WelkinPolarisationFrame>() == 16);
    assert!(size_of::<WelkinStokes>() == 12);
    assert!(size_of::<WelkinBakeError>() == 40);
    assert!(size_of::<WelkinSample>() == 32);
    assert!(offset_of!(WelkinSample, xyz) == 16);
    assert!(size_of::<WelkinError>() == 260);
};
