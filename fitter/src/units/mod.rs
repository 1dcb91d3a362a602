//! Work units: pure functions of (atmosphere, grid, settings) to one file each, found again after a kill.

mod plan;
mod run;
mod unit;

pub use plan::{Between, CrossCheck, HeldOut, Plan, Solved};
pub use unit::{Kind, Unit};
