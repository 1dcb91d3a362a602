//! What a build tells: the errors of every chunk, and the provenance in the file.

use crate::assess::{self, Error, Quantiles};
use crate::fitting::Fitting;
use crate::polarimetry;
use crate::units::Plan;
use welkin::format::Head;

/// A chunk in the report.
pub struct Row<'a> {
    /// Visibility, m.
    pub visibility: f64,
    /// Altitude, m.
    pub altitude: f64,
    /// How much the components cancel.
    pub condition: f64,
    /// Errors at its held-out samples.
    pub errors: &'a [Error],
}

/// One line per chunk, errors in percent.
pub fn chunk_table(rows: &[Row]) -> String {
    let mut out = format!(
        "{:>10} {:>9} {:>10} {:>9} {:>9} {:>9} {:>9}\n",
        "visibility", "altitude", "condition", "median", "p95", "p99", "max"
    );
    for row in rows {
        if let Some(q) = Quantiles::of(row.errors.iter().map(|e| e.relative)) {
            out += &format!(
                "{:>7.1} km {:>7} m {:>10.1} {:>8.3}% {:>8.3}% {:>8.3}% {:>8.2}%\n",
                row.visibility / 1e3,
                row.altitude,
                row.condition,
                100.0 * q.median,
                100.0 * q.p95,
                100.0 * q.p99,
                100.0 * q.max
            );
        }
    }
    out
}

/// The metadata of the file.
pub fn metadata(
    plan: &Plan,
    fitting: Fitting,
    head: &Head,
    errors: &[Vec<Error>],
    polarimetry: &[polarimetry::Error],
) -> String {
    let all = errors.concat();
    let classes: serde_json::Map<String, serde_json::Value> = assess::CLASSES
        .iter()
        .filter_map(|(name, belongs)| {
            let q = Quantiles::of(all.iter().filter(|e| belongs(e)).map(|e| e.relative))?;
            Some(((*name).to_owned(), serde_json::to_value(q).ok()?))
        })
        .collect();
    let degree = Quantiles::of(polarimetry.iter().map(|e| e.degree));
    let angle = Quantiles::of(polarimetry.iter().filter_map(|e| e.angle));
    let options = fitting.options;
    let (title, mut atmosphere) = plan.air.provenance();
    atmosphere["planet_radius_m"] = head.planet.radius.into();
    serde_json::json!({
        "title": title,
        "generator": concat!("welkin-fit ", env!("CARGO_PKG_VERSION")),
        "atmosphere": atmosphere,
        "method": "single scattering by quadrature, multiple scattering by successive orders with polarised Rayleigh scattering",
        "solver": format!("{:?}", plan.settings),
        "fit": {
            "rank": options.rank,
            "sweeps": options.sweeps,
            "refinements": fitting.refinements,
            "seed": options.seed,
            "polarisation": {
                "rank": fitting.polarisation.rank,
                "sweeps": fitting.polarisation.sweeps,
                "seed": fitting.polarisation.seed,
            },
        },
        "relative_error_held_out": classes,
        "degree_of_polarisation_error_held_out": degree,
        "angle_of_polarisation_error_deg_held_out": angle,
    })
    .to_string()
}
