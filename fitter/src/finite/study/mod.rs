//! How stable the ways to light of finite segments are: each against exact integrals.

mod method;
mod polarisation;
mod quantile_table;
mod scan;
mod segment_case;
mod towers;

pub use method::{Lights, METHODS, Method, Methods};
pub use polarisation::{PolarisedRow, polarised_rows, polarised_table};
pub use quantile_table::{Row, csv, rows, table};
pub use scan::{Scan, all, jumps, scans};
pub use segment_case::{Case, cases};
pub use towers::{View, Views, towers};
