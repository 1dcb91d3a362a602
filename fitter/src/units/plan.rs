//! What is traced, and how finely.

use super::unit::Kind;
use crate::air::Air;
use crate::atmosphere::Atmosphere;
use crate::dataset::{
    CHANNELS, Coverage, Grid, Sample, Store, Tensor, VISIBLE, shadow_edge, trace_tensor, truth,
};
use crate::spectrum::training::Training;
use crate::successive_orders::{
    Gatherer, Kinds, LightField, Medium, SOLAR_ANGULAR_RADIUS, Settings, solve,
};
use anyhow::{Context, Result};
use std::path::Path;

/// What is traced, and how finely.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The grid.
    pub grid: Grid,
    /// The air.
    pub air: Air,
    /// The wavelengths.
    pub coverage: Coverage,
    /// Where what lies between them comes from.
    pub between: Between,
    /// Resolution of the solver.
    pub settings: Settings,
    /// Held-out view directions and suns per chunk.
    pub held_out: HeldOut,
    /// How the traced data are compared with the unbiased tracer.
    pub cross_check: CrossCheck,
}

/// How thoroughly a chunk is cross-checked.
#[derive(Clone, Copy, Debug)]
pub struct CrossCheck {
    /// Held-out samples per chunk.
    pub samples: usize,
    /// Relative standard error of the reference tracer.
    pub target_error: f64,
}

impl Default for CrossCheck {
    fn default() -> Self {
        Self {
            samples: 8,
            target_error: 0.01,
        }
    }
}

/// Where what lies between the nodes of the wavelengths comes from.
#[derive(Clone, Debug)]
pub enum Between {
    /// It is learned from spectra in the same air.
    Learned(Training),
    /// It is as in the default model, but for the extinction of the air.
    Default,
    /// Nothing lies there: no spectrum, no colours.
    Nothing,
}

/// How many held-out samples a chunk has.
#[derive(Clone, Copy, Debug)]
pub struct HeldOut {
    /// View directions.
    pub views: usize,
    /// Suns, the same for all view directions.
    pub suns: usize,
}

impl Default for HeldOut {
    fn default() -> Self {
        Self {
            views: 160,
            suns: 24,
        }
    }
}

/// Length of ray segments when view rays are gathered, relative to the finest.
const FINENESS: f64 = 1.0;
/// Change whenever the physics or the layout of light fields, or of other units, does.
const LIGHT_VERSION: u32 = 6;
const UNIT_VERSION: u32 = 8;

/// A visibility, solved.
pub struct Solved {
    /// Visibility, m.
    pub visibility: f64,
    /// Its air.
    pub medium: Medium,
    /// The light in it.
    pub light: LightField,
}

impl Solved {
    /// Gathers light along view rays at production fineness.
    pub fn gatherer(&self) -> Gatherer<'_> {
        Gatherer::new(&self.medium, &self.light, FINENESS)
    }
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            grid: Grid::default(),
            air: Air::Continental,
            coverage: VISIBLE,
            between: Between::Learned(Training::default()),
            settings: Settings::default(),
            held_out: HeldOut::default(),
            cross_check: CrossCheck::default(),
        }
    }
}

impl Plan {
    /// Coarse in everything but altitude and visibility.
    pub fn draft() -> Self {
        let mut grid = Grid::default();
        grid.up.0.intervals = 10;
        grid.down.0.intervals = 8;
        grid.phi.intervals = 6;
        grid.elevation.intervals = 12;
        Self {
            grid,
            air: Air::Continental,
            coverage: VISIBLE,
            between: Between::Learned(Training::draft()),
            settings: Settings::DRAFT,
            held_out: HeldOut { views: 24, suns: 6 },
            cross_check: CrossCheck::default(),
        }
    }

    /// The air of a visibility (m) for the nodes.
    pub fn atmosphere(&self, visibility: f64) -> Result<Atmosphere> {
        self.air.at(visibility, &self.coverage.nodes)
    }

    /// What the light fields depend on.
    pub(super) fn light_key(&self) -> String {
        format!(
            "{LIGHT_VERSION} {:?} {:?}{}",
            self.settings,
            self.coverage.nodes,
            self.air.key()
        )
    }

    /// What the traced tensors and samples depend on, besides altitude and visibility.
    pub(super) fn key(&self) -> String {
        let axes = Grid {
            altitudes: vec![],
            visibilities: vec![],
            ..self.grid.clone()
        };
        let held_out = [self.held_out.views, self.held_out.suns];
        format!("{} {UNIT_VERSION} {axes:?} {held_out:?}", self.light_key())
    }

    /// Units of tensors, samples and fits in the folder `work`.
    pub fn store(&self, work: &Path) -> Result<Store> {
        self.store_of(work, Kind::Tensor)
    }

    /// The air of a visibility (m), with the kinds of particles of all nodes.
    fn medium(&self, visibility: f64) -> Result<Medium> {
        let air = self.atmosphere(visibility)?;
        let nodes = self.air.visibilities();
        if nodes.len() < 2 {
            return Medium::new(air, SOLAR_ANGULAR_RADIUS);
        }
        let all: Vec<Atmosphere> = nodes
            .iter()
            .map(|&node| self.atmosphere(node))
            .collect::<Result<_>>()?;
        Medium::in_kinds(air, SOLAR_ANGULAR_RADIUS, &Kinds::of(&all)?)
    }

    /// The light field of a visibility (m). `progress` is told the share that is done.
    pub fn solve(
        &self,
        work: &Path,
        visibility: f64,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Solved> {
        let store = self.store_of(work, Kind::Light)?;
        let medium = self.medium(visibility)?;
        let values = store.unit(&Kind::Light.unit(visibility, None), || {
            Ok(solve(&medium, self.settings, progress).to_values())
        })?;
        let light = LightField::from_values(&values).context("a light field of another size")?;
        Ok(Solved {
            visibility,
            medium,
            light,
        })
    }

    /// The traced tensor of altitude `a` of the grid.
    pub fn tensor(&self, store: &Store, solved: &Solved, a: usize) -> Result<Tensor> {
        let altitude = self.grid.altitudes[a];
        let name = Kind::Tensor.unit(solved.visibility, Some(altitude));
        let values = store.unit(&name, || {
            Ok(trace_tensor(&solved.gatherer(), &self.grid, a).values)
        })?;
        let views = self.grid.up.0.len() + self.grid.down.0.len();
        let elevations = self.grid.elevation_axis().len();
        let shape = [views, self.grid.phi.len(), elevations, CHANNELS];
        Ok(Tensor { shape, values })
    }

    /// Held-out samples at any altitude (m).
    pub fn held_out(&self, store: &Store, solved: &Solved, altitude: f64) -> Result<Vec<Sample>> {
        let seed = (solved.visibility + altitude) as u64;
        let counts = [self.held_out.views, self.held_out.suns];
        let name = Kind::Truth.unit(solved.visibility, Some(altitude));
        let suns = self.grid.elevation_range();
        let values = store.unit(&name, || {
            let (gatherer, light) = (solved.gatherer(), &solved.light);
            let samples = truth(&gatherer, light, (altitude, suns), counts, seed);
            Ok(samples.iter().flat_map(Sample::to_values).collect())
        })?;
        Ok(Sample::from_values(&values))
    }

    /// Held-out samples about the edge of the Earth's shadow at any altitude (m).
    pub fn shadow_edge(
        &self,
        store: &Store,
        solved: &Solved,
        altitude: f64,
    ) -> Result<Vec<Sample>> {
        const COUNT: usize = 4000;
        let seed = (solved.visibility + altitude) as u64;
        let name = format!("edge-{}-{altitude}", solved.visibility);
        let values = store.unit(&name, || {
            let (gatherer, light) = (solved.gatherer(), &solved.light);
            let samples = shadow_edge(&gatherer, light, altitude, COUNT, seed);
            Ok(samples.iter().flat_map(Sample::to_values).collect())
        })?;
        Ok(Sample::from_values(&values))
    }

    /// The atmosphere of a visibility (m) and traced samples for the reference tracer: every direction has two suns of
    /// its own.
    pub fn cross_check_samples(
        &self,
        work: &Path,
        visibility: f64,
        altitudes: &[f64],
        directions: usize,
    ) -> Result<(Atmosphere, Vec<Sample>)> {
        let solved = self.solve(work, visibility, &|_| {})?;
        let gatherer = solved.gatherer();
        let suns = self.grid.elevation_range();
        let one = |altitude: f64, seed: u64| {
            truth(&gatherer, &solved.light, (altitude, suns), [1, 2], seed)
        };
        let samples = altitudes
            .iter()
            .flat_map(|&h| (0..directions as u64).flat_map(move |i| one(h, 1000 * i + h as u64)))
            .collect();
        Ok((self.atmosphere(visibility)?, samples))
    }
}
