//! In-scattered light where every segment has its own conditions: of the tables of a [`Haze`] only the nodes that a segment needs
//! are computed, by the same rules.

use std::sync::Arc;

use super::expansion::{Expansion, Fill, Scratch};
use super::source::{ground_factor, overflow, reach, sun_nodes};
use super::sunlight::NODES;
use super::{Haze, Species, sun_direction};
use crate::air::{Extinction, Segment};
use crate::axis::{Stencil, hermite, linear};
use crate::conditions::Conditions;
use crate::error::Result;
use crate::format::visibility_node;
use crate::model::Model;
use crate::polarisation::{Frame, Stokes};
use crate::simd::{Instructions, Kernel, dispatch};

/// Transmittance and in-scattered light of segments that share no conditions, like the rows of a table.
///
/// It answers as the [`Haze`] of the conditions does, but for rounding, and takes some tens of microseconds for a segment with new
/// conditions where preparing a haze takes milliseconds; segments that follow each other under the same sun, visibility and albedo
/// share what they need. Holds the source of all visibilities; clones, one per thread, share that.
///
/// Where the conditions change, a few small tables are allocated. `Send + Sync`.
#[derive(Clone)]
pub struct GeneralHaze<'a> {
    model: &'a Model,
    expansion: Arc<Expansion<'a>>,
    /// Right where the stamps say so.
    haze: Haze,
    visibilities: Stencil,
    ground: Vec<f64>,
    /// Sines of the sun nodes of the source.
    suns: Vec<f64>,
    now: u32,
    /// When each node of the beam and of the source, `[sun][altitude]`, was computed.
    beam: Vec<u32>,
    source: Vec<u32>,
    scratch: Scratch,
}

impl Model {
    /// Prepares in-scattering for segments that share no conditions. Reads and verifies the sources of all visibilities.
    ///
    /// # Errors
    /// As [`Model::haze`], if any of the sources is missing or damaged.
    pub fn general_haze(&self) -> Result<GeneralHaze<'_>> {
        let expansion = Arc::new(Expansion::new(self)?);
        let [visibility, _] = self.visibility_range();
        let haze = self.haze(&Conditions {
            visibility,
            altitude: self.altitude_range()[0],
            solar_elevation: self.solar_elevation_range()[1],
            albedo: 0.0,
            solar_azimuth: 0.0,
        })?;
        let mut general = GeneralHaze {
            model: self,
            expansion,
            visibilities: hermite(&self.head().visibility_nodes(), visibility_node(visibility)),
            ground: Vec::new(),
            suns: Vec::new(),
            now: 0,
            beam: vec![0; NODES],
            source: Vec::new(),
            scratch: Scratch::default(),
            haze,
        };
        let conditions = general.haze.conditions;
        general.turn(&conditions);
        Ok(general)
    }
}

impl GeneralHaze<'_> {
    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        self.haze.wavelengths()
    }

    /// As [`Haze::in_scatter`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::haze`] and [`Haze::in_scatter`].
    pub fn in_scatter(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        to: [f64; 3],
        in_scatter: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.set(conditions)?;
        let segment = self.haze.segment(from, to)?;
        self.fill(&segment)?;
        self.haze.in_scatter(from, to, in_scatter, transmittance)
    }

    /// As [`Haze::to_end`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::haze`] and [`Haze::to_end`].
    pub fn to_end(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        direction: [f64; 3],
        in_scatter: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.set(conditions)?;
        let (segment, _) = Segment::to_end(&self.haze.air.planet(), from, direction)?;
        self.fill(&segment)?;
        self.haze.to_end(from, direction, in_scatter, transmittance)
    }

    /// As [`Haze::relative_stokes_at`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::haze`] and [`Haze::relative_stokes_at`].
    pub fn relative_stokes_at(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        to: [f64; 3],
        frame: Frame,
        wavelength: f64,
    ) -> Result<Stokes> {
        self.set(conditions)?;
        let segment = self.haze.segment(from, to)?;
        self.fill(&segment)?;
        self.haze.relative_stokes_at(from, to, frame, wavelength)
    }

    /// Goes over to other conditions.
    fn set(&mut self, conditions: &Conditions) -> Result<()> {
        let conditions = conditions.checked(self.model)?;
        let last = self.haze.conditions;
        let shared = |c: &Conditions| [c.solar_elevation, c.visibility, c.albedo].map(f64::to_bits);
        if shared(&conditions) != shared(&last) {
            self.turn(&conditions);
        }
        if conditions.solar_elevation != last.solar_elevation
            || conditions.solar_azimuth != last.solar_azimuth
        {
            self.haze.sun = sun_direction(conditions.solar_elevation, conditions.solar_azimuth);
        }
        self.haze.conditions = conditions;
        Ok(())
    }

    /// Prepares what is small, and forgets the nodes.
    fn turn(&mut self, conditions: &Conditions) {
        let head = self.model.head();
        let Conditions {
            visibility,
            solar_elevation,
            ..
        } = *conditions;
        let (nodes, x) = (head.visibility_nodes(), visibility_node(visibility));
        self.visibilities = hermite(&nodes, x);
        self.ground = ground_factor(head, visibility, conditions.albedo);
        let sources = &self.expansion.sources;
        let around: Vec<_> = (linear(&nodes, x).taps())
            .map(|(v, weight)| (sources[v], weight))
            .collect();
        let haze = &mut self.haze;
        haze.species = Species::new(head, around.into_iter());
        haze.air.extinction = Extinction::new(head, visibility);
        haze.grey = haze.air.grey();
        haze.beam.turn(&haze.air.planet(), solar_elevation);
        self.suns = sun_nodes(solar_elevation, reach(&head.planet));
        haze.source.turn(&self.suns);
        let nodes = haze.source.altitudes() * self.suns.len();
        // Near the zenith the sun has fewer nodes; room for more stays.
        self.source.resize(nodes.max(self.source.len()), 0);
        self.now = self.now.checked_add(1).unwrap_or_else(|| {
            self.beam.fill(0);
            self.source.fill(0);
            1
        });
    }

    /// Computes the nodes that a segment needs.
    fn fill(&mut self, segment: &Segment) -> Result<()> {
        dispatch(Needs {
            general: self,
            segment,
        })
    }

    fn fill_beam(&mut self, nodes: &[usize]) {
        for &node in nodes {
            if self.beam[node] != self.now {
                self.beam[node] = self.now;
                self.haze.beam.fill(&self.haze.air.layers, node);
            }
        }
    }

    /// Computes the source at two altitudes and a sun.
    fn fill_source(&mut self, altitude: usize, sun: usize) -> Result<()> {
        let (stamps, now) = (&mut self.source, self.now);
        let mut missing = [0; 2];
        let mut count = 0;
        for altitude in [altitude, altitude + 1] {
            let stamp = &mut stamps[sun * self.haze.source.altitudes() + altitude];
            if *stamp != now {
                *stamp = now;
                missing[count] = altitude;
                count += 1;
            }
        }
        if count == 0 {
            return Ok(());
        }
        let fill = Fill {
            expansion: &self.expansion,
            visibilities: &self.visibilities,
            ground: &self.ground,
            sun: (sun, self.suns[sun]),
            altitudes: &missing[..count],
            table: &mut self.haze.source,
            scratch: &mut self.scratch,
        };
        match fill.run() {
            true => Ok(()),
            false => {
                // What is not finite must not be taken for computed.
                self.source.fill(0);
                Err(overflow())
            }
        }
    }
}

/// Computes the nodes that a segment needs.
struct Needs<'b, 'a> {
    general: &'b mut GeneralHaze<'a>,
    segment: &'b Segment,
}

impl Kernel for Needs<'_, '_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Result<()> {
        let Self { general, segment } = self;
        let (panels, places, _) = general.haze.panels(segment);
        let planet = general.haze.air.planet();
        let ends = 2 * (panels.count + 1).div_ceil(2);
        for (i, places) in places.iter().enumerate() {
            let nodes = general.haze.beam.nodes(&planet, places);
            let count = ends.saturating_sub(i * nodes.len()).min(nodes.len());
            for nodes in &nodes[..count] {
                general.fill_beam(nodes);
            }
        }
        let stations = panels.count + 1..panels.count + 1 + panels.stations.shares.len();
        for i in stations {
            let places = &places[i / super::places::BATCH];
            let lane = i % super::places::BATCH;
            let source = &general.haze.source;
            let [altitude, sun] = source.cell(places.altitude.0[lane], places.sun.0[lane]);
            general.fill_source(altitude, sun)?;
            general.fill_source(altitude, sun + 1)?;
        }
        Ok(())
    }
}
