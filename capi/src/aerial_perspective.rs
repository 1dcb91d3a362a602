//! The air between an observer and things.

use crate::colour_space::space_of;
use crate::guard::{ask, call, free};
use crate::model::WelkinModel;
use crate::polarised_sky::WelkinPolarisedSky;
use crate::raw::{
    apart, array, copy, exclusive, give, put, put_array, shared, slice, slice_mut, span, spectra,
};
use crate::sky::WelkinSky;
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{
    WelkinConditions, WelkinPolarisationFrame, WelkinStokes, conditions_of, frame_of,
    put_conditions,
};
use library::AerialPerspective;

/// Transmittance and in-scattered light of finite segments. Points are metres in the frame of WelkinTransmittance; a
/// thing is seen as its radiance times the transmittance plus the in-scattered light. Nothing allocates after it is
/// prepared.
pub struct WelkinAerialPerspective(pub(crate) AerialPerspective);

/// Prepares the air of a scene, of which the altitude of the conditions plays no part.
///
/// Errors as of welkin_sky_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_new(
    model: *const WelkinModel,
    conditions: *const WelkinConditions,
    aerial: *mut *mut WelkinAerialPerspective,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(aerial, || {
            Ok(WelkinAerialPerspective(
                shared(model, "model")?
                    .0
                    .aerial_perspective(&conditions_of(conditions)?)?,
            ))
        })?;
    })
}

/// Frees an aerial perspective; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_free(aerial: *mut WelkinAerialPerspective) {
    free!(aerial)
}

/// How many wavelengths results have; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_wavelength_count(
    aerial: *const WelkinAerialPerspective,
) -> usize {
    ask!(aerial, |handle| handle.0.wavelengths().len())
}

/// Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of
/// welkin_aerial_perspective_wavelength_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_wavelengths(
    aerial: *const WelkinAerialPerspective,
    wavelengths: *mut f64,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let handle = shared(aerial, "aerial")?;
        copy(handle.0.wavelengths(), wavelengths, count)?;
    })
}

/// Memory on the heap, bytes; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_bytes(
    aerial: *const WelkinAerialPerspective,
) -> usize {
    ask!(aerial, |handle| handle.0.bytes())
}

/// Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_conditions(
    aerial: *const WelkinAerialPerspective,
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
pub unsafe extern "C" fn welkin_aerial_perspective_set_solar_azimuth(
    aerial: *mut WelkinAerialPerspective,
    azimuth: f64,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        exclusive(aerial, "aerial")?.0.set_solar_azimuth(azimuth)?;
    })
}

/// How far the air of segments may be from the origin, as an angle at the planet's centre, rad; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_reach(
    aerial: *const WelkinAerialPerspective,
) -> f64 {
    ask!(aerial, |handle| handle.0.reach())
}

/// Of the segment from `from[3]`, where the observer is, to `to[3]`: `in_scattering[count]` in W m⁻² sr⁻¹ nm⁻¹ and
/// `transmittance[count]`, an element per wavelength.
///
/// Errors: WELKIN_STATUS_POINT for a point that is not finite, beyond 1e9 m or out of reach; WELKIN_STATUS_LENGTH.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_in_scattering(
    aerial: *const WelkinAerialPerspective,
    from: *const f64,
    to: *const f64,
    in_scattering: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart([], [span(in_scattering, count), span(transmittance, count)])?;
        shared(aerial, "aerial")?.0.in_scattering(
            array(from, "from")?,
            array(to, "to")?,
            slice_mut(in_scattering, count, "in_scattering")?,
            slice_mut(transmittance, count, "transmittance")?,
        )?;
    })
}

/// Of all of the air from a point in a `direction[3]`, up to the ground where that is in the way; otherwise as
/// welkin_aerial_perspective_in_scattering. Errors also: WELKIN_STATUS_DIRECTION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_to_end(
    aerial: *const WelkinAerialPerspective,
    from: *const f64,
    direction: *const f64,
    in_scattering: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart([], [span(in_scattering, count), span(transmittance, count)])?;
        shared(aerial, "aerial")?.0.to_end(
            array(from, "from")?,
            array(direction, "direction")?,
            slice_mut(in_scattering, count, "in_scattering")?,
            slice_mut(transmittance, count, "transmittance")?,
        )?;
    })
}

/// Of segments from a camera to many points, `points[point_count][3]`; the outputs are `[point_count][wavelengths]`, of
/// which `count` is the number of floats of each. What precedes a bad point is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_in_scattering_batch(
    aerial: *const WelkinAerialPerspective,
    camera: *const f64,
    points: *const f64,
    point_count: usize,
    in_scattering: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let points_span = span(points.cast::<[f64; 3]>(), point_count);
        apart(
            [points_span],
            [span(in_scattering, count), span(transmittance, count)],
        )?;
        let points = slice(points.cast::<[f64; 3]>(), point_count, "points")?;
        shared(aerial, "aerial")?.0.in_scattering_batch(
            array(camera, "camera")?,
            points,
            slice_mut(in_scattering, count, "in_scattering")?,
            slice_mut(transmittance, count, "transmittance")?,
        )?;
    })
}

/// Of segments from `from` to the points at growing `distances[distance_count]` (m) in a `direction[3]`: the slices of
/// a ray, each piece integrated once. The outputs are `[distance_count][wavelengths]`, of which `count` is the number
/// of floats.
///
/// Errors also: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for distances that are negative or do not grow.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_in_scattering_along(
    aerial: *const WelkinAerialPerspective,
    from: *const f64,
    direction: *const f64,
    distances: *const f64,
    distance_count: usize,
    in_scattering: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart(
            [span(distances, distance_count)],
            [span(in_scattering, count), span(transmittance, count)],
        )?;
        let distances = slice(distances, distance_count, "distances")?;
        shared(aerial, "aerial")?.0.in_scattering_along(
            array(from, "from")?,
            array(direction, "direction")?,
            distances,
            slice_mut(in_scattering, count, "in_scattering")?,
            slice_mut(transmittance, count, "transmittance")?,
        )?;
    })
}

/// The in-scattered light of a segment at any wavelength (nm) within the range of the model, W m⁻² sr⁻¹ nm⁻¹.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_in_scattering_at(
    aerial: *const WelkinAerialPerspective,
    from: *const f64,
    to: *const f64,
    wavelength: f64,
    in_scattering: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        put(
            in_scattering,
            shared(aerial, "aerial")?.0.in_scattering_at(
                array(from, "from")?,
                array(to, "to")?,
                wavelength,
            )?,
            "in_scattering",
        )?;
    })
}

/// CIE XYZ of the in-scattered light of a segment, `light[3]`, and what the air leaves of X, Y and Z of things lit by
/// the sun, `factors[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_xyz(
    aerial: *const WelkinAerialPerspective,
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

/// The same in a colour space (WELKIN_SPACE_SRGB …): light in cd m⁻². What is there is seen as `radiance · factors +
/// light`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_rgb(
    aerial: *const WelkinAerialPerspective,
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

/// The in-scattered light of a segment with its polarisation, as three arrays with an element per wavelength, in a
/// frame (null: the vertical one) at the start, and the transmittance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_in_scattering_stokes(
    aerial: *const WelkinAerialPerspective,
    from: *const f64,
    to: *const f64,
    frame: *const WelkinPolarisationFrame,
    i: *mut f32,
    q: *mut f32,
    u: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let frame = frame_of(frame)?;
        apart([], [i, q, u, transmittance].map(|out| span(out, count)))?;
        let transmittance = slice_mut(transmittance, count, "transmittance")?;
        shared(aerial, "aerial")?.0.in_scattering_stokes(
            array(from, "from")?,
            array(to, "to")?,
            frame,
            spectra([i, q, u], count)?,
            transmittance,
        )?;
    })
}

/// Stokes vectors of the in-scattered light of a segment in linear sRGB, `light[3]`, and the factors of things,
/// `factors[3]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_rgb_stokes(
    aerial: *const WelkinAerialPerspective,
    from: *const f64,
    to: *const f64,
    frame: *const WelkinPolarisationFrame,
    light: *mut WelkinStokes,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (light_3, factors_3) = shared(aerial, "aerial")?.0.linear_srgb_stokes(
            array(from, "from")?,
            array(to, "to")?,
            frame_of(frame)?,
        )?;
        put_array(light, light_3.map(WelkinStokes::from), "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}

/// As welkin_aerial_perspective_in_scattering from where the sky was prepared, (0, 0, altitude), but that the light
/// goes over into that of the sky where hardly any can come from beyond the segment: what is far vanishes in the sky
/// without a seam.
///
/// Errors also: WELKIN_STATUS_RANGE if the sky has another sun, visibility or albedo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_joined_in_scattering(
    aerial: *const WelkinAerialPerspective,
    sky: *const WelkinSky,
    to: *const f64,
    in_scattering: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        apart([], [span(in_scattering, count), span(transmittance, count)])?;
        let joined = shared(aerial, "aerial")?
            .0
            .joined_to(&shared(sky, "sky")?.0)?;
        joined.in_scattering(
            array(to, "to")?,
            slice_mut(in_scattering, count, "in_scattering")?,
            slice_mut(transmittance, count, "transmittance")?,
        )?;
    })
}

/// The same for many points, as welkin_aerial_perspective_in_scattering_batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_joined_batch(
    aerial: *const WelkinAerialPerspective,
    sky: *const WelkinSky,
    points: *const f64,
    point_count: usize,
    in_scattering: *mut f32,
    transmittance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let points_span = span(points.cast::<[f64; 3]>(), point_count);
        apart(
            [points_span],
            [span(in_scattering, count), span(transmittance, count)],
        )?;
        let points = slice(points.cast::<[f64; 3]>(), point_count, "points")?;
        let joined = shared(aerial, "aerial")?
            .0
            .joined_to(&shared(sky, "sky")?.0)?;
        joined.in_scattering_batch(
            points,
            slice_mut(in_scattering, count, "in_scattering")?,
            slice_mut(transmittance, count, "transmittance")?,
        )?;
    })
}

/// The same in CIE XYZ, as welkin_aerial_perspective_xyz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_joined_xyz(
    aerial: *const WelkinAerialPerspective,
    sky: *const WelkinSky,
    to: *const f64,
    light: *mut f32,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (light_3, factors_3) = shared(aerial, "aerial")?
            .0
            .joined_to(&shared(sky, "sky")?.0)?
            .xyz(array(to, "to")?)?;
        put_array(light, light_3, "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}

/// The same in a colour space (WELKIN_SPACE_SRGB …), as welkin_aerial_perspective_rgb.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_joined_rgb(
    aerial: *const WelkinAerialPerspective,
    sky: *const WelkinSky,
    to: *const f64,
    space: i32,
    light: *mut f32,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let space = space_of(space)?;
        let (light_3, factors_3) = shared(aerial, "aerial")?
            .0
            .joined_to(&shared(sky, "sky")?.0)?
            .rgb(array(to, "to")?, space)?;
        put_array(light, light_3, "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}

/// The same in linear sRGB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_joined_srgb(
    aerial: *const WelkinAerialPerspective,
    sky: *const WelkinSky,
    to: *const f64,
    light: *mut f32,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let (light_3, factors_3) = shared(aerial, "aerial")?
            .0
            .joined_to(&shared(sky, "sky")?.0)?
            .linear_srgb(array(to, "to")?)?;
        put_array(light, light_3, "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}

/// The same with polarisation, as welkin_aerial_perspective_rgb_stokes, before a polarised sky.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_aerial_perspective_joined_srgb_stokes(
    aerial: *const WelkinAerialPerspective,
    sky: *const WelkinPolarisedSky,
    to: *const f64,
    frame: *const WelkinPolarisationFrame,
    light: *mut WelkinStokes,
    factors: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let joined = shared(aerial, "aerial")?
            .0
            .joined_to_polarised(&shared(sky, "sky")?.0)?;
        let (light_3, factors_3) = joined.linear_srgb_stokes(array(to, "to")?, frame_of(frame)?)?;
        put_array(light, light_3.map(WelkinStokes::from), "light")?;
        put_array(factors, factors_3, "factors")?;
    })
}
