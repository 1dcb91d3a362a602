//! Sky radiance in spherical atmospheres (`sky_*.json`).

use super::verdict::{Comparison, Limits, Verdict};
use crate::atmosphere::json::Case;
use crate::tracer::Radiance;
use anyhow::{Result, ensure};

/// Columns that hold a set of reference values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// All orders, visible ground lit, aerosols depolarise.
    Total,
    /// The same with visible ground black.
    Path,
    /// All orders, visible ground lit, aerosols keep polarisation.
    Preserving,
    /// One scattering event, ground black; deterministic.
    Single,
}

impl Columns {
    fn value(self, component: &str) -> String {
        match self {
            Self::Total => component.to_owned(),
            Self::Path => format!("{component}_path"),
            Self::Preserving => format!("hgscalar_{component}"),
            Self::Single => format!("{component}_ss"),
        }
    }

    fn sigma(self, component: &str) -> Option<String> {
        match self {
            Self::Total => Some(format!("sigma_{component}")),
            Self::Path => Some(format!("sigma_{component}_path")),
            Self::Preserving => Some(format!("hgscalar_sigma_{component}")),
            Self::Single => None,
        }
    }

    /// Systematic uncertainty relative to I.
    fn systematic(self) -> f64 {
        match self {
            Self::Total | Self::Path => 1e-3,
            Self::Preserving => 3e-3,
            Self::Single => 1e-4 / 4.5,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Total => "",
            Self::Path => " path",
            Self::Preserving => " preserving",
            Self::Single => " single",
        }
    }

    /// Whether `case` has these columns.
    pub fn exist(self, case: &Case) -> bool {
        case.column(&self.value("I")).is_some()
    }

    fn limits(self, case: &Case) -> Limits {
        let bias = match (self, case.sun_elevation_deg) {
            (Self::Single, _) => 1e-4,
            (_, e) if e >= 0.0 => 0.003,
            (_, e) if e > -3.5 => 0.006,
            _ => 0.015,
        };
        Limits {
            z: 4.5,
            chi2: 1.6,
            bias,
        }
    }
}

/// Judges `results`, one per row of `case`, against the reference's `columns`.
pub fn judge(case: &Case, results: &[Radiance], columns: Columns) -> Result<Vec<Verdict>> {
    ensure!(
        results.len() == case.rows.len(),
        "{} results for {} rows",
        results.len(),
        case.rows.len()
    );
    let components = ["I", "Q", "U"].into_iter().enumerate();
    components
        .map(|(c, component)| {
            let comparisons = results
                .iter()
                .enumerate()
                .map(|(i, r)| comparison(case, i, component, columns, (r.stokes[c], r.error[c])))
                .collect::<Result<_>>()?;
            Ok(Verdict {
                case: format!("{}{}", case.id, columns.label()),
                quantity: component.to_owned(),
                comparisons,
                limits: columns.limits(case),
            })
        })
        .collect()
}

fn comparison(
    case: &Case,
    row: usize,
    component: &str,
    columns: Columns,
    (ours, error): (f64, f64),
) -> Result<Comparison> {
    let intensity = case.value(row, &columns.value("I"))?;
    let sigma = match columns.sigma(component) {
        Some(name) => case.value(row, &name)?,
        None => 0.0,
    };
    // Where no light is expected, rounding is all that there may be.
    let systematic = columns.systematic() * intensity.max(1e-15);
    Ok(Comparison {
        reference: case.value(row, &columns.value(component))?,
        uncertainty: sigma.hypot(systematic),
        ours,
        error,
        intensity,
    })
}
