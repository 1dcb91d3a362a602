//! In-scattered light where every segment has its own conditions: of the tables of a [`AerialPerspective`] only the
//! nodes that a segment needs are computed, by the same rules.

use std::sync::Arc;

use super::prepared::AerialPerspective;
use super::scatterers::Scatterers;
use super::source_expansion::Expansion;
use super::source_fill::{Fill, Scratch};
use super::source_table::{ground_factor, overflow, reach, sun_nodes};
use crate::conditions::Conditions;
use crate::error::Result;
use crate::format::visibility_node;
use crate::kernel::axis::{Stencil, hermite, linear};
use crate::kernel::simd::{Instructions, Kernel, dispatch};
use crate::model::Model;
use crate::polarisation::{PolarisationFrame, Stokes};
use crate::transmittance::Segment;

/// Transmittance and in-scattered light of segments that share no conditions, like the rows of a table.
///
/// It answers as the [`AerialPerspective`] of the conditions does, but for rounding, and takes some tens of
/// microseconds for a segment with new conditions where preparing an aerial perspective takes milliseconds; segments
/// that follow each other under the same sun, visibility and albedo share what they need. Holds the source of all
/// visibilities; clones, one per thread, share that.
///
/// Where the conditions change, a few small tables are allocated. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let model = Model::default_model()?;
/// let mut query = model.aerial_perspective_query()?;
/// let [mut light, mut transmittance] = [(); 2].map(|()| vec![0.0; model.wavelengths().len()]);
/// for visibility in [30e3, 60e3, 120e3] {
///     let conditions = Conditions { visibility, ..Conditions::default() };
///     let (from, to) = ([0.0, 0.0, 2.0], [5e3, 0.0, 300.0]);
///     let before = transmittance[6];
///     query.in_scattering(&conditions, from, to, &mut light, &mut transmittance)?;
///     assert!(transmittance[6] > before && light[6] > 0.0);
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone)]
pub struct AerialPerspectiveQuery<'a> {
    model: &'a Model,
    expansion: Arc<Expansion<'a>>,
    /// Right where the stamps say so.
    aerial: AerialPerspective,
    visibilities: Stencil,
    ground: Vec<f64>,
    /// Sines of the sun nodes of the source.
    suns: Vec<f64>,
    now: u32,
    /// When each node of the source, `[sun][altitude]`, was computed.
    source: Vec<u32>,
    scratch: Scratch,
}

impl Model {
    /// Prepares in-scattering for segments that share no conditions. Reads and verifies the sources of all
    /// visibilities.
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`], if any of the sources is missing or damaged;
    /// [`Error::Invalid`](crate::Error::Invalid) for a model with a ground of its own ([`Model::over`]): here every query
    /// says its albedo.
    pub fn aerial_perspective_query(&self) -> Result<AerialPerspectiveQuery<'_>> {
        self.refuse_ground()?;
        let nodes = self.nodes();
        let expansion = Arc::new(Expansion::new(
            self,
            nodes,
            0..nodes.head.visibilities.len(),
        )?);
        let [visibility, _] = self.visibility_range();
        let lowest = Conditions {
            visibility,
            altitude: self.altitude_range()[0],
            solar_elevation: self.solar_elevation_range()[1],
            albedo: 0.0,
            solar_azimuth: 0.0,
        };
        let black = vec![0.0; nodes.head.wavelengths.len()];
        let aerial = AerialPerspective::prepare(self, nodes, &lowest, &black)?;
        let mut query = AerialPerspectiveQuery {
            model: self,
            expansion,
            visibilities: hermite(&self.head().visibility_nodes(), visibility_node(visibility)),
            ground: Vec::new(),
            suns: Vec::new(),
            now: 0,
            source: Vec::new(),
            scratch: Scratch::default(),
            aerial,
        };
        let conditions = query.aerial.conditions;
        query.turn(&conditions);
        Ok(query)
    }
}

impl AerialPerspectiveQuery<'_> {
    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        self.aerial.wavelengths()
    }

    /// As [`AerialPerspective::in_scattering`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`] and [`AerialPerspective::in_scattering`].
    pub fn in_scattering(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        to: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.set(conditions)?;
        let segment = self.aerial.segment(from, to)?;
        self.fill(&segment)?;
        self.aerial
            .in_scattering(from, to, in_scattering, transmittance)
    }

    /// As [`AerialPerspective::to_end`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`] and [`AerialPerspective::to_end`].
    pub fn to_end(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        direction: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.set(conditions)?;
        let (segment, _) = Segment::to_end(&self.aerial.air.planet(), from, direction)?;
        self.fill(&segment)?;
        self.aerial
            .to_end(from, direction, in_scattering, transmittance)
    }

    /// As [`AerialPerspective::in_scattering_at`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`] and [`AerialPerspective::in_scattering_at`].
    pub fn in_scattering_at(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        to: [f64; 3],
        wavelength: f64,
    ) -> Result<f32> {
        self.set(conditions)?;
        let segment = self.aerial.segment(from, to)?;
        self.fill(&segment)?;
        self.aerial.in_scattering_at(from, to, wavelength)
    }

    /// As [`AerialPerspective::relative_stokes_at`], under these conditions.
    ///
    /// # Errors
    /// As [`Model::aerial_perspective`] and [`AerialPerspective::relative_stokes_at`].
    pub fn relative_stokes_at(
        &mut self,
        conditions: &Conditions,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
        wavelength: f64,
    ) -> Result<Stokes> {
        self.set(conditions)?;
        let segment = self.aerial.segment(from, to)?;
        self.fill(&segment)?;
        self.aerial.relative_stokes_at(from, to, frame, wavelength)
    }

    /// Goes over to other conditions.
    fn set(&mut self, conditions: &Conditions) -> Result<()> {
        let conditions = conditions.checked(self.model)?;
        let last = self.aerial.conditions;
        let shared = |c: &Conditions| [c.solar_elevation, c.visibility, c.albedo].map(f64::to_bits);
        if shared(&conditions) != shared(&last) {
            self.turn(&conditions);
        }
        if conditions.solar_elevation != last.solar_elevation
            || conditions.solar_azimuth != last.solar_azimuth
        {
            self.aerial.sun = conditions.sun_direction();
        }
        self.aerial.conditions = conditions;
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
        self.ground = ground_factor(head, visibility, core::iter::repeat(conditions.albedo));
        let around: Vec<_> = (linear(&nodes, x).taps())
            .map(|(v, weight)| (self.expansion.source(v), weight))
            .collect();
        let aerial = &mut self.aerial;
        aerial.species = Scatterers::new(head, around.into_iter());
        aerial.air.set_visibility(head, visibility);
        aerial.grey = aerial.air.grey();
        self.suns = sun_nodes(solar_elevation, reach(&head.planet));
        aerial.source.turn(&self.suns);
        let nodes = aerial.source.altitudes() * self.suns.len();
        // Near the zenith the sun has fewer nodes; room for more stays.
        self.source.resize(nodes.max(self.source.len()), 0);
        self.now = self.now.checked_add(1).unwrap_or_else(|| {
            self.source.fill(0);
            1
        });
    }

    /// Computes the nodes that a segment needs.
    fn fill(&mut self, segment: &Segment) -> Result<()> {
        dispatch(Needs {
            query: self,
            segment,
        })
    }

    /// Computes the source at two altitudes and a sun.
    fn fill_source(&mut self, altitude: usize, sun: usize) -> Result<()> {
        let (stamps, now) = (&mut self.source, self.now);
        let mut missing = [0; 2];
        let mut count = 0;
        for altitude in [altitude, altitude + 1] {
            let stamp = &mut stamps[sun * self.aerial.source.altitudes() + altitude];
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
            table: &mut self.aerial.source,
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
    query: &'b mut AerialPerspectiveQuery<'a>,
    segment: &'b Segment,
}

impl Kernel for Needs<'_, '_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Result<()> {
        let Self { query, segment } = self;
        let (panels, places, _) = query.aerial.panels(segment);
        let stations = panels.count + 1..panels.count + 1 + panels.stations.shares.len();
        for i in stations {
            let places = &places[i / super::path_points::BATCH];
            let lane = i % super::path_points::BATCH;
            let source = &query.aerial.source;
            let [altitude, sun] = source.cell(places.altitude.0[lane], places.sun.0[lane]);
            query.fill_source(altitude, sun)?;
            query.fill_source(altitude, sun + 1)?;
        }
        Ok(())
    }
}
