//! Traced spectra: light of every term of every cell at the same random lines of sight.

use super::cells::Cell;
use crate::air::Air;
use crate::atmosphere::{Atmosphere, Monochromatic};
use crate::dataset::{Coverage, Sample, Store, truth};
use crate::successive_orders::{Gatherer, Medium, NW, SOLAR_ANGULAR_RADIUS, Settings, solve};
use anyhow::Result;

/// How spectra are traced.
#[derive(Clone, Debug)]
pub struct Training {
    /// Visibilities, m.
    pub visibilities: Vec<f64>,
    /// Altitudes of the observers, m.
    pub altitudes: Vec<f64>,
    /// View directions per altitude, and suns that they all have.
    pub counts: [usize; 2],
    /// Coarser than a model's: what is learned is how wavelengths depend on each other.
    pub settings: Settings,
    /// Length of segments of view rays relative to the finest.
    pub fineness: f64,
}

impl Default for Training {
    fn default() -> Self {
        Self {
            visibilities: vec![40_000.0, 131_800.0, 20_000.0],
            altitudes: vec![0.5, 800.0, 3000.0, 8000.0, 15_000.0, 45_000.0],
            counts: [48, 16],
            settings: Settings::COARSE,
            fineness: 2.0,
        }
    }
}

/// Solar elevations of lines of sight, rad.
pub const SUNS: [f64; 2] = [-12.0 * DEGREE, 90.0 * DEGREE];
const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// Changes whenever the physics or the layout of the units does.
const VERSION: u32 = 4;
/// Lights that are solved together, beside the guard.
pub const TOGETHER: usize = NW - 1;

/// A set of lights, filled up with the guard. How finely rays are divided goes by the light that air stops most: with that
/// in every set, no light depends on what it is solved with. (Without it, light at 343 nm is 0.9 % darker in this coarse
/// solution than among the nodes.)
pub fn guarded(part: &[Monochromatic], coverage: &Coverage) -> [Monochromatic; NW] {
    std::array::from_fn(|w| *part.get(w).unwrap_or(&coverage.nodes[coverage.guard]))
}

impl Training {
    /// Coarse, to try things with.
    pub fn draft() -> Self {
        Self {
            visibilities: vec![40_000.0],
            altitudes: vec![0.5, 8000.0],
            counts: [16, 9],
            settings: Settings::DRAFT,
            fineness: 4.0,
        }
    }

    /// What the units depend on.
    pub fn key(&self, cells: &[Cell], air: &Air) -> String {
        format!("{VERSION} {self:?} {:?}{}", lights(cells), air.key())
    }

    /// Samples of `lights` at a visibility, `[set of NW lights][sample]`.
    fn traced(&self, air: Atmosphere, visibility: f64) -> Result<Vec<Sample>> {
        let medium = Medium::new(air, SOLAR_ANGULAR_RADIUS)?;
        let light = solve(&medium, self.settings, &|_| {});
        let gatherer = Gatherer::new(&medium, &light, self.fineness);
        let one = |&h: &f64| {
            let seed = (h + visibility) as u64;
            truth(&gatherer, &light, (h, SUNS), self.counts, seed)
        };
        Ok(self.altitudes.iter().flat_map(one).collect())
    }

    /// The samples of a visibility for a set of lights in some air, under the name `name`.
    pub fn unit(
        &self,
        store: &Store,
        (air, visibility): (&Air, f64),
        lights: &[Monochromatic; NW],
        name: &str,
    ) -> Result<Vec<Sample>> {
        let values = store.unit(&format!("spectra-{visibility}-{name}"), || {
            let samples = self.traced(air.at(visibility, lights)?, visibility)?;
            Ok(samples.iter().flat_map(Sample::to_values).collect())
        })?;
        Ok(Sample::from_values(&values))
    }
}

/// All lights of the terms of `cells`, cell by cell.
pub fn lights(cells: &[Cell]) -> Vec<Monochromatic> {
    cells
        .iter()
        .flat_map(|c| c.terms.iter().map(|t| t.light))
        .collect()
}
