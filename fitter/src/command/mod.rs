//! The subcommands of `welkin-fit`.

pub mod assess;
pub mod atmosphere;
pub mod aureole;
pub mod bench;
pub mod build;
pub mod chart;
pub mod cross_check;
pub mod export;
pub mod finite;
pub mod import;
pub mod lobes;
pub mod make;
pub mod measure;
pub mod official;
pub mod picture;
mod plan;
pub mod rows;
pub mod spectrum;
pub mod trace;
pub mod units;
pub mod validate;
mod variation;
