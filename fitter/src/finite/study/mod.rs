//! How stable the ways to light of finite segments are: each against exact integrals.

mod case;
mod method;
mod polarisation;
mod report;
mod scan;
mod towers;

pub use case::{Case, cases};
pub use method::{Lights, METHODS, Method, Methods};
pub use polarisation::{PolarisedRow, polarised_rows, polarised_table};
pub use report::{Row, csv, rows, table};
pub use scan::{Scan, all, jumps, scans};
pub use towers::{View, Views, towers};
