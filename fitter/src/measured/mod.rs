//! Skies that were measured, beside those of the model: readers, fits and reports.

pub mod broadband;
pub mod capture_time;
pub mod error;
pub mod false_colour;
pub mod fisheye;
pub mod fit;
pub mod global_fit;
pub mod least_squares;
pub mod left_out;
pub mod model_sky;
pub mod near_infrared;
pub mod pattern;
pub mod pyranometer;
pub mod scan;
pub mod scan_report;
pub mod site;

pub use error::MeasuredError;
