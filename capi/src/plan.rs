//! What a scene needs of a model.

use library::{Budget, Channels, Plan};

use crate::guard::{Failure, Outcome, call, free};
use crate::model::WelkinModel;
use crate::raw::{give, shared};
use crate::status::{WelkinError, WelkinStatus};
use crate::structs::{Sized64, read, size_in, write};

/// Radiance at the wavelengths of the model, or at any between them.
pub const WELKIN_CHANNELS_SPECTRAL: i32 = 0;
/// XYZ or RGB.
pub const WELKIN_CHANNELS_COLOUR: i32 = 1;
/// Stokes vectors.
pub const WELKIN_CHANNELS_STOKES: i32 = 2;

/// The conditions that a scene can meet, and what it tolerates. Albedo is free. Set all bytes to zero, then struct_size
/// and the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinBudget {
    /// sizeof(WelkinBudget) of the program.
    pub struct_size: u64,
    /// Lowest and highest altitude of observers, m.
    pub altitude: [f64; 2],
    /// Lowest and highest visibility, m.
    pub visibility: [f64; 2],
    /// Lowest and highest elevation of the sun, rad.
    pub solar_elevation: [f64; 2],
    /// Relative error that baking may add at 95 % of directions and channels.
    pub tolerance: f64,
    /// What skies are asked for: one of WELKIN_CHANNELS_SPECTRAL, WELKIN_CHANNELS_COLOUR and WELKIN_CHANNELS_STOKES.
    pub channels: i32,
    /// Zero.
    pub reserved: i32,
}

/// What a scene gets. Set struct_size.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct WelkinPlanSummary {
    /// sizeof(WelkinPlanSummary) of the program.
    pub struct_size: u64,
    /// Bytes of the file that are read, all in all.
    pub file_bytes: u64,
    /// Chunks that are read.
    pub chunk_count: u64,
    /// Most bytes that a baked sky of the scene holds.
    pub sky_bytes: u64,
    /// Largest median of the relative error of a chunk against its traced data.
    pub error_median: f64,
    /// Largest 99th percentile of it.
    pub error_p99: f64,
    /// Relative error that baking adds at most at 95 % of directions and channels.
    pub bake_p95: f64,
}

// SAFETY: numbers without padding.
unsafe impl Sized64 for WelkinBudget {
    const NAME: &'static str = "WelkinBudget";
    const LEAST: usize = 72;
}

// SAFETY: seven numbers of eight bytes.
unsafe impl Sized64 for WelkinPlanSummary {
    const NAME: &'static str = "WelkinPlanSummary";
    const LEAST: usize = 56;
}

const _: () = assert!(size_of::<WelkinBudget>() == WelkinBudget::LEAST);
const _: () = assert!(size_of::<WelkinPlanSummary>() == WelkinPlanSummary::LEAST);

/// A plan of a model: what to read for a scene.
pub struct WelkinPlan(pub(crate) Plan);

unsafe fn budget_of(pointer: *const WelkinBudget) -> Outcome<Budget> {
    // SAFETY: the caller's part.
    let got = unsafe { read(pointer)? };
    if got.reserved != 0 {
        return Err(Failure::UnknownField("WelkinBudget"));
    }
    Ok(Budget {
        altitude: got.altitude,
        visibility: got.visibility,
        solar_elevation: got.solar_elevation,
        tolerance: got.tolerance,
        channels: match got.channels {
            WELKIN_CHANNELS_SPECTRAL => Channels::Spectral,
            WELKIN_CHANNELS_COLOUR => Channels::Colour,
            WELKIN_CHANNELS_STOKES => Channels::Stokes,
            other => return Err(Failure::Argument("kind of channels", other.into())),
        },
    })
}

/// Plans a scene: reads nothing of the model but its head.
///
/// Errors: WELKIN_STATUS_RANGE for what the model does not cover; WELKIN_STATUS_MISSING if the file lacks a chunk.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_plan(
    model: *const WelkinModel,
    budget: *const WelkinBudget,
    plan: *mut *mut WelkinPlan,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        give(plan, || {
            Ok(WelkinPlan(
                shared(model, "model")?.0.plan(&budget_of(budget)?)?,
            ))
        })?;
    })
}

/// Frees a plan; null is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_plan_free(plan: *mut WelkinPlan) {
    free!(plan)
}

/// Writes what a plan costs and gets. The struct_size of `summary` must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_plan_summary(
    plan: *const WelkinPlan,
    summary: *mut WelkinPlanSummary,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        let plan = &shared(plan, "plan")?.0;
        let struct_size = size_in(summary)?;
        let got = WelkinPlanSummary {
            struct_size,
            file_bytes: plan.file_bytes as u64,
            chunk_count: plan.chunk_count as u64,
            sky_bytes: plan.sky_bytes as u64,
            error_median: plan.error_median.into(),
            error_p99: plan.error_p99.into(),
            bake_p95: plan.bake_p95,
        };
        write(summary, &got, struct_size)?;
    })
}

/// Reads and verifies what a plan of this model asks for, before the scene needs it. Errors: those of a damaged file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welkin_model_load(
    model: *const WelkinModel,
    plan: *const WelkinPlan,
    error: *mut WelkinError,
) -> WelkinStatus {
    call!(error, {
        shared(model, "model")?.0.load(&shared(plan, "plan")?.0)?;
    })
}
