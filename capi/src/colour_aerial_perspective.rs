//! The air between an observer and things, in colour.

use crate::colour_space::space_of;
use crate::guard::{Failure, ask, call, free};
use crate::model::WelkinModel;
use crate::raw::{apart, array, exclusive, give, put_array, shared, slice, slice_mut, span};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{Sized64, WelkinConditions, conditions_of, put_conditions, read};
use library::{CameraVolume, ColourAerialPerspective};

/// A WelkinAerialPerspective for colour alone, in half the time and memory.
pub struct WelkinColourAerialPerspective(pub(crate) ColourAerialPerspective);

/// A camera-aligned volume ("froxels"). Row `r`, column `c`, slice `k` ends at `from + depths[k] · (axis + x·right +
/// y·up)` with `x = (2c + 1) / columns − 1` and `y = 1 − (2r + 1) / rows`: with `axis` a unit vector and the other two
/// across it, as long as the tangents of half the fields of view, slices are planes. Set all bytes to zero, then
/// struct_size and the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinCameraVolume {
    /// sizeof(WelkinCameraVolume) of the program.
    pub struct_size: u64,
    /// The camera, m.
    pub from: [f64; 3],
    /// The middle of the picture.
    pub axis: [f64; 3],
    /// From the middle to the right edge.
    pub right: [f64; 3],
    /// From the middle to the upper edge.
    pub up: [f64; 3],
    /// Columns of the volume.
    pub columns: u64,
    /// Rows of the volume.
    pub rows: u64,
    /// Slices of the volume.
    pub depth_count: u64,
    /// Where slices end, growing, in lengths of `axis`: `depths[depth_count]`.
    pub depths: *const f64,
}

// SAFETY: numbers without padding, and a pointer that is only read as one when it is used.
unsafe impl Sized64 for WelkinCameraVolume {
    const NAME: &'static str = "WelkinCameraVolume";
    const LEAST: usize = size_of::<Self>();
}

/// Prepares the air of a scene for colour alone. Errors as of welkin_aerial_perspective_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    aerial: *mut *mut WelkinColourAerialPerspective,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(aerial, || {
            Ok(WelkinColourAerialPerspective(
                shared(model, "model")?
                    .0
                    .colour_aerial_perspective(&conditions_of(conditions)?)?,
            ))
        })?;
    })
}

/// Frees an aerial perspective; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_free(
    aerial: *mut WelkinColourAerialPerspective,
) {
    free!(aerial)
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_bytes(
    aerial: *const WelkinColourAerialPerspective,
) -> usize {
    ask!(aerial, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_conditions(
    aerial: *const WelkinColourAerialPerspective,
    conditions: *mut WelkinConditions,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put_conditions(conditions, shared(aerial, "aerial")?.0.conditions())?;
    })
}

/// Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
/// uses the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_set_solar_azimuth(
    aerial: *mut WelkinColourAerialPerspective,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(aerial, "aerial")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// As welkin_aerial_perspective_xyz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_xyz(
    aerial: *const WelkinColourAerialPerspective,
    from: *const f64,
    to: *const f64,
    light: *mut f32,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (light_3, factors_3) = shared(aerial, "aerial")?
            .0
            .xyz(array(from, "from")?, array(to, "to")?)?;
        put_array(light, light_3, "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}

/// As welkin_aerial_perspective_rgb.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_rgb(
    aerial: *const WelkinColourAerialPerspective,
    from: *const f64,
    to: *const f64,
    space: i32,
    light: *mut f32,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        let (light_3, factors_3) =
            shared(aerial, "aerial")?
                .0
                .rgb(array(from, "from")?, array(to, "to")?, space)?;
        put_array(light, light_3, "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}

/// In linear sRGB, of segments from `from` to the points at growing `distances[distance_count]` (m) in a
/// `direction[3]`: `light[distance_count][3]` and `factors[distance_count][3]`. Errors as of
/// welkin_aerial_perspective_in_scattering_along.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_srgb_along(
    aerial: *const WelkinColourAerialPerspective,
    from: *const f64,
    direction: *const f64,
    distances: *const f64,
    distance_count: usize,
    light: *mut f32,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let outputs = [light, factors].map(|out| out.cast::<[f32; 3]>());
        apart(
            [span(distances, distance_count)],
            outputs.map(|out| span(out, distance_count)),
        )?;
        let [light, factors] = outputs;
        let distances = slice(distances, distance_count, "distances")?;
        let light = slice_mut(light, distance_count, "light")?;
        let factors = slice_mut(factors, distance_count, "factors")?;
        shared(aerial, "aerial")?.0.linear_srgb_along(
            array(from, "from")?,
            array(direction, "direction")?,
            distances,
            light,
            factors,
        )?;
    })
}

/// Fills a volume in linear sRGB: `light` and `factors` are `[rows][columns][depths][3]`, of which `count` is rows ×
/// columns × depths. On all cores where the library was built with rayon. Allocates.
///
/// Errors also: WELKIN_STATUS_LENGTH for another count; WELKIN_STATUS_RANGE for depths that do not grow.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_colour_aerial_perspective_srgb_volume(
    aerial: *const WelkinColourAerialPerspective,
    volume: *const WelkinCameraVolume,
    light: *mut f32,
    factors: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let volume = read(volume)?;
        let size = |n: u64| usize::try_from(n).map_err(|_| Failure::Length("volume", usize::MAX));
        let depth_count = size(volume.depth_count)?;
        let outputs = [light, factors].map(|out| out.cast::<[f32; 3]>());
        apart(
            [span(volume.depths, depth_count)],
            outputs.map(|out| span(out, count)),
        )?;
        let [light, factors] = outputs;
        let volume = CameraVolume {
            from: volume.from,
            axis: volume.axis,
            right: volume.right,
            up: volume.up,
            size: [size(volume.columns)?, size(volume.rows)?],
            depths: slice(volume.depths, depth_count, "depths")?,
        };
        let light = slice_mut(light, count, "light")?;
        let factors = slice_mut(factors, count, "factors")?;
        shared(aerial, "aerial")?
            .0
            .linear_srgb_volume(&volume, light, factors)?;
    })
}
