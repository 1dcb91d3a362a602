//! Units of a plan by name, so that any process can do any of them.

use super::plan::Plan;
use super::unit::{Kind, Unit};
use crate::cross_check::{Difference, cross_check};
use crate::dataset::Store;
use anyhow::{Context, Result};
use std::path::Path;

impl Plan {
    /// All units: light fields, then what a model needs of each visibility and altitude, then its judgement.
    pub fn units(&self) -> Vec<Unit> {
        let mut out = vec![];
        let lists: [(&[Kind], usize); 3] = [
            (&[Kind::Light], 1),
            (&[Kind::Tensor, Kind::Truth], self.grid.altitudes.len()),
            (&[Kind::Check], self.grid.altitudes.len()),
        ];
        for (kinds, altitudes) in lists {
            for &visibility in &self.grid.visibilities {
                for altitude in 0..altitudes {
                    out.extend(kinds.iter().map(|&kind| Unit {
                        kind,
                        visibility,
                        altitude: (kind != Kind::Light).then_some(altitude),
                    }));
                }
            }
        }
        out
    }

    /// Name of a unit, also that of its file.
    pub fn name(&self, unit: Unit) -> String {
        let altitude = unit.altitude.map(|a| self.grid.altitudes[a]);
        unit.kind.unit(unit.visibility, altitude)
    }

    /// The store that a unit is kept in.
    pub fn store_of(&self, work: &Path, kind: Kind) -> Result<Store> {
        let key = match kind {
            Kind::Light => self.light_key(),
            Kind::Tensor | Kind::Truth => self.key(),
            Kind::Check => format!("{} {:?}", self.key(), self.cross_check),
        };
        Store::open(work, key)
    }

    /// Does a unit, unless it is done. `progress` is told the share that is done of a light field.
    pub fn run(&self, work: &Path, unit: Unit, progress: &(dyn Fn(f64) + Sync)) -> Result<()> {
        if self.store_of(work, unit.kind)?.has(&self.name(unit))? {
            return Ok(());
        }
        let solved = self.solve(work, unit.visibility, progress)?;
        let Some(a) = unit.altitude else {
            return Ok(());
        };
        let store = self.store(work)?;
        if unit.kind == Kind::Tensor {
            self.tensor(&store, &solved, a)?;
            return Ok(());
        }
        let truth = self.held_out(&store, &solved, self.grid.altitudes[a])?;
        if unit.kind == Kind::Check {
            let lit: Vec<_> = truth
                .iter()
                .filter(|s| s.radiance.iter().any(|&l| l > 0.0))
                .collect();
            // Spread over the suns, and never the same direction twice in a row.
            let step = (lit.len() / self.cross_check.samples).max(1) + 1;
            let chosen = lit.iter().cycle().step_by(step);
            let chosen: Vec<_> = chosen.take(self.cross_check.samples).map(|s| **s).collect();
            let air = &solved.medium.atmosphere;
            self.store_of(work, Kind::Check)?
                .unit(&self.name(unit), || {
                    let differences =
                        cross_check(air, &chosen, self.cross_check.target_error, &|| ())?;
                    Ok(differences.iter().flat_map(Difference::to_values).collect())
                })?;
        }
        Ok(())
    }

    /// The unit that `which` names, or that is at this place among all units.
    pub fn find(&self, which: &str) -> Result<Unit> {
        let units = self.units();
        let place = which.parse().ok();
        let place = place.or_else(|| units.iter().position(|&u| self.name(u) == which));
        let unit = place.and_then(|i: usize| units.get(i));
        unit.copied()
            .with_context(|| format!("no unit {which} in this plan"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_found_by_its_name_and_its_place() {
        let plan = Plan::default();
        let units = plan.units();
        let (altitudes, visibilities) = (plan.grid.altitudes.len(), plan.grid.visibilities.len());
        assert_eq!(units.len(), visibilities * (1 + 3 * altitudes));
        for (place, &unit) in units.iter().enumerate() {
            assert_eq!(plan.find(&plan.name(unit)).unwrap(), unit);
            assert_eq!(plan.find(&place.to_string()).unwrap(), unit);
        }
        assert!(plan.find(&units.len().to_string()).is_err() && plan.find("light-1").is_err());
        assert!(units[..visibilities].iter().all(|u| u.kind == Kind::Light));
    }
}
