//! Radiance of single directions, each under conditions of its own.

use std::sync::Arc;

use library::{Model, PointQuery, PolarisedPointQuery};

use crate::guard::{call, free};
use crate::model::WelkinModel;
use crate::plan::WelkinPlan;
use crate::raw::{array, give, put, shared, slice_mut};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{
    WelkinConditions, WelkinPolarisationFrame, WelkinStokes, conditions_of, frame_of, put_stokes,
};

/// A query that borrows the model beside it.
struct Borrowing<Q> {
    // Dropped before what it borrows.
    query: Q,
    _model: Arc<Model>,
}

/// The model for as long as a share of it lives.
fn forever(model: &Arc<Model>) -> &'static Model {
    // SAFETY: the model stays where it is while a share of it lives, and each user of this keeps one in the same
    // struct, which drops the borrower first and hands it out for no longer than a call.
    unsafe { &*Arc::as_ptr(model) }
}

/// Answers for any conditions of a plan and any direction, without preparing a sky: for queries that share nothing.
/// Nothing allocates. May be shared by threads.
pub struct WelkinPointQuery(Borrowing<PointQuery<'static>>);

/// The same with polarisation.
pub struct WelkinPolarisedPointQuery(Borrowing<PolarisedPointQuery<'static>>);

/// Prepares point queries within a plan of this model, and reads what it asks for. The new handle keeps what it needs
/// of the model alive.
///
/// Errors: WELKIN_STATUS_LIMIT for models that are too large; those of a damaged file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_point_query_new(
    model: *const WelkinModel,
    plan: *const WelkinPlan,
    query: *mut *mut WelkinPointQuery,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(query, || {
            let model = &shared(model, "model")?.0;
            let query = forever(model).point_query(&shared(plan, "plan")?.0)?;
            Ok(WelkinPointQuery(Borrowing {
                query,
                _model: Arc::clone(model),
            }))
        })?;
    })
}

/// Frees a query; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_point_query_free(query: *mut WelkinPointQuery) {
    free!(query)
}

/// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at the wavelengths of the model: `radiance[count]`.
///
/// Errors: WELKIN_STATUS_RANGE for the conditions; WELKIN_STATUS_MISSING for those outside of the plan;
/// WELKIN_STATUS_DIRECTION; WELKIN_STATUS_LENGTH.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_point_query_radiance(
    query: *const WelkinPointQuery,
    conditions: *const WelkinConditions,
    direction: *const f32,
    radiance: *mut f32,
    count: usize,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let query = &shared(query, "query")?.0.query;
        let direction = array(direction, "direction")?;
        query.radiance(
            &conditions_of(conditions)?,
            direction,
            slice_mut(radiance, count, "radiance")?,
        )?;
    })
}

/// The same at any wavelength (nm) within the range of the model. Errors also: WELKIN_STATUS_RANGE for the wavelength.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_point_query_radiance_at(
    query: *const WelkinPointQuery,
    conditions: *const WelkinConditions,
    direction: *const f32,
    wavelength: f64,
    radiance: *mut f32,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let query = &shared(query, "query")?.0.query;
        let direction = array(direction, "direction")?;
        put(
            radiance,
            query.radiance_at(&conditions_of(conditions)?, direction, wavelength)?,
            "radiance",
        )?;
    })
}

/// Prepares point queries with polarisation, within a plan for WELKIN_CHANNELS_STOKES. Otherwise as
/// welkin_point_query_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_point_query_new(
    model: *const WelkinModel,
    plan: *const WelkinPlan,
    query: *mut *mut WelkinPolarisedPointQuery,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(query, || {
            let model = &shared(model, "model")?.0;
            let query = forever(model).polarised_point_query(&shared(plan, "plan")?.0)?;
            Ok(WelkinPolarisedPointQuery(Borrowing {
                query,
                _model: Arc::clone(model),
            }))
        })?;
    })
}

/// Frees a query; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_point_query_free(query: *mut WelkinPolarisedPointQuery) {
    free!(query)
}

/// The Stokes vector at any wavelength (nm) within the range of the model, in a frame (null: the vertical one). Errors
/// as of welkin_point_query_radiance_at.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_polarised_point_query_stokes_at(
    query: *const WelkinPolarisedPointQuery,
    conditions: *const WelkinConditions,
    direction: *const f32,
    frame: *const WelkinPolarisationFrame,
    wavelength: f64,
    stokes: *mut WelkinStokes,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let query = &shared(query, "query")?.0.query;
        let (direction, frame) = (array(direction, "direction")?, frame_of(frame)?);
        put_stokes(
            stokes,
            query.stokes_at(&conditions_of(conditions)?, direction, frame, wavelength)?,
        )?;
    })
}
