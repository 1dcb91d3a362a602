//! What is traced: arguments that several commands share.

use super::make::find;
use anyhow::Result;
use std::path::PathBuf;
use welkin_fitter::air::Air;
use welkin_fitter::dataset::SHORT_WAVE_INFRARED;
use welkin_fitter::units::{Between, Plan};

/// The plan and the folder of its work units.
#[derive(clap::Args)]
pub struct PlanArgs {
    /// Folder for finished work units; whatever was interrupted goes on from them.
    #[arg(long, default_value = "work")]
    pub work: PathBuf,
    /// Air of a recipe instead of the default model's: a TOML file, or the name of one that comes along. What lies between
    /// the wavelengths is then taken from the default model.
    #[arg(long, conflicts_with_all = ["visibilities", "infrared"])]
    recipe: Option<PathBuf>,
    /// Only these altitudes, m.
    #[arg(long, value_delimiter = ',')]
    altitudes: Option<Vec<f64>>,
    /// Only these visibilities, km.
    #[arg(long, value_delimiter = ',')]
    visibilities: Option<Vec<f64>>,
    /// Coarse axes and a coarse solver: a poor model within a minute, to try things with.
    #[arg(long)]
    draft: bool,
    /// 1100..2500 nm instead of 300..1100 nm.
    #[arg(long)]
    infrared: bool,
}

impl PlanArgs {
    /// The plan, checked.
    pub fn plan(&self) -> Result<Plan> {
        let mut plan = if self.draft {
            Plan::draft()
        } else {
            Plan::default()
        };
        if let Some(altitudes) = &self.altitudes {
            plan.grid.altitudes = altitudes.clone();
        }
        if let Some(visibilities) = &self.visibilities {
            plan.grid.visibilities = visibilities.iter().map(|v| 1e3 * v).collect();
        }
        if self.infrared {
            plan.coverage = SHORT_WAVE_INFRARED;
        }
        if let Some(recipe) = &self.recipe {
            plan.air = Air::of(find(recipe)?)?;
            plan.grid.visibilities = plan.air.visibilities();
            plan.between = Between::Default;
        }
        plan.grid.check()?;
        Ok(plan)
    }
}
