//! What is in a folder of work units: where each comes from, what it cost, and how far it is from the unbiased tracer.

use crate::cross_check::{Difference, Summary};
use crate::units::{Kind, Plan, Unit};
use anyhow::Result;
use serde_json::{Value, json};
use std::path::Path;

/// The manifest of all units of a plan. Every file that is there is read and checked.
pub fn manifest(plan: &Plan, work: &Path) -> Result<Value> {
    let units = plan.units();
    let entries = units
        .iter()
        .map(|&unit| entry(plan, work, unit))
        .collect::<Result<Vec<_>>>()?;
    let seconds = |kind: Kind| -> f64 {
        let of_kind = units.iter().zip(&entries).filter(|(u, _)| u.kind == kind);
        of_kind
            .filter_map(|(_, e)| e["core_seconds"].as_f64())
            .fold(0.0, |sum, seconds| sum + seconds)
    };
    let totals = Kind::ALL.map(|kind| (kind.name().to_owned(), json!(seconds(kind))));
    Ok(json!({
        "generator": concat!("welkin-fit ", env!("CARGO_PKG_VERSION")),
        "plan": {
            "altitudes_m": plan.grid.altitudes,
            "visibilities_m": plan.grid.visibilities,
            "solver": format!("{:?}", plan.settings),
            "held_out": format!("{:?}", plan.held_out),
            "cross_check": format!("{:?}", plan.cross_check),
        },
        "core_seconds": serde_json::Map::from_iter(totals),
        "difference_to_tracer": differences(plan, work)?,
        "units": entries,
    }))
}

/// Of all units that are cross-checked: together, and by visibility (m).
fn differences(plan: &Plan, work: &Path) -> Result<Value> {
    let store = plan.store_of(work, Kind::Check)?;
    let (mut all, mut by_visibility) = (vec![], serde_json::Map::new());
    for &visibility in &plan.grid.visibilities {
        let units = plan.units().into_iter();
        let mut here = vec![];
        for unit in units.filter(|u| u.kind == Kind::Check && u.visibility == visibility) {
            let values = store.load(&plan.name(unit))?.unwrap_or_default();
            here.extend(Difference::from_values(&values));
        }
        by_visibility.insert(visibility.to_string(), json!(Summary::of(&here)));
        all.extend(here);
    }
    Ok(json!({ "all": Summary::of(&all), "by_visibility_m": by_visibility }))
}

fn entry(plan: &Plan, work: &Path, unit: Unit) -> Result<Value> {
    let (store, name) = (plan.store_of(work, unit.kind)?, plan.name(unit));
    let mut entry = json!({
        "name": name,
        "kind": unit.kind.name(),
        "visibility_m": unit.visibility,
        "altitude_m": unit.altitude.map(|a| plan.grid.altitudes[a]),
        "done": false,
    });
    let Some(values) = store.load(&name)? else {
        return Ok(entry);
    };
    entry["done"] = json!(true);
    entry["values"] = json!(values.len());
    let checksum = store.checksum(&name)?;
    entry["crc32"] = json!(checksum.map(|c| format!("{c:08x}")));
    entry["core_seconds"] = json!(store.cost(&name));
    if unit.kind == Kind::Check {
        entry["difference_to_tracer"] = json!(Summary::of(&Difference::from_values(&values)));
    }
    Ok(entry)
}
