//! How stable the ways to light of finite segments are: each against exact integrals.

mod case;
mod method;
mod report;
mod scan;
mod towers;

pub use case::{Case, cases};
pub use method::{METHODS, Method, Methods};
pub use report::{Row, csv, rows, table};
pub use scan::{Scan, all, jumps, scans};
pub use towers::{View, Views, towers};
