//! What segments of a scene share.

use std::sync::Arc;

use super::file_tables::FileTables;
use super::reach::Reach;
use super::scatterers::Scatterers;
use super::source_expansion::Expansion;
use super::source_fill::{Fill, Scratch};
use super::source_table::{SourceTable, blocks, ground_factor, overflow, reach, sun_nodes};
use super::sun_transmittance::Beam;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::format::{Head, Kind, visibility_node};
use crate::ground::OverGround;
use crate::kernel::axis::{Stencil, hermite, linear};
use crate::kernel::math::LANES;
use crate::model::{Model, Nodes};
use crate::transmittance::Transmittance;

/// Transmittance and in-scattered light of finite segments: aerial perspective.
///
/// Points are in metres in the frame of [`Transmittance`]: the origin on the ground, +z up there. The conditions hold
/// at the origin; the sun is so far away that its direction is the same everywhere, while its elevation above the local
/// horizon is not. The altitude of the conditions plays no part: one aerial perspective serves all observers. Nothing
/// blocks a segment. Points on the ground or under it, at any depth, are points like others: the air goes on down
/// there, and its light, as they are at the ground. A ray to its end ([`AerialPerspective::to_end`]) that goes down
/// from there ends at once.
///
/// It holds for air up to [`AerialPerspective::reach`] from the origin; segments of which air lies farther are refused.
/// Within that the sun may locally stand lower than in any conditions: light goes on to fall there, but long segments
/// through the edge of the planet's shadow err by 10 % (median) up to 40 % at the zenith, by more towards the sun.
///
/// The light is integrated along the segment: sunlight scattered once, with the sun's disc setting behind the planet,
/// and a stored source function of all other light. So it is never negative, vanishes with the length of the segment,
/// adds up along a ray, and stays what it is beyond the atmosphere.
///
/// After [`Model::aerial_perspective`] returns, nothing here allocates, blocks or calls the system. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let aerial = Model::default_model()?.aerial_perspective(&Conditions::default())?;
/// let camera = [0.0, 0.0, 2.0];
/// let (near, _) = aerial.linear_srgb(camera, [1e3, 0.0, 2.0])?; // cd m⁻²
/// let (far, factors) = aerial.linear_srgb(camera, [30e3, 0.0, 2.0])?;
/// assert!(far[1] > near[1]);
/// // What is 30 km away is seen as `radiance · factors + far`.
/// assert!(factors.iter().all(|factor| (0.0..1.0).contains(factor)));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct AerialPerspective {
    pub(super) conditions: Conditions,
    pub(super) air: Transmittance,
    pub(super) sun: [f64; 3],
    pub(super) species: Scatterers,
    pub(super) source: SourceTable,
    pub(super) beam: Arc<Beam>,
    pub(super) reach: Reach,
    /// Extinction at a typical wavelength, m⁻¹: a polynomial of each layer.
    pub(super) grey: Vec<[f32; 3]>,
    pub(super) irradiance: Vec<[f32; LANES]>,
    /// `[block][X, Y, Z]`.
    pub(super) xyz: Vec<[[f32; LANES]; 3]>,
    /// XYZ of the unattenuated sun, for the transmittance of colours.
    pub(super) white: [f32; 3],
    pub(super) over: Option<Box<OverGround<AerialPerspective>>>,
}

impl AerialPerspective {
    /// At some of the wavelength nodes of the file, or at all.
    /// `albedos` are those of the ground at the nodes.
    pub(crate) fn prepare(
        model: &Model,
        nodes: Nodes,
        conditions: &Conditions,
        albedos: &[f64],
    ) -> Result<Self> {
        let conditions = conditions.checked(model)?;
        let head = nodes.head;
        let visibilities = head.visibility_nodes();
        let x = visibility_node(conditions.visibility);
        let cubic = hermite(&visibilities, x);
        let sources = cubic.taps().map(|(v, _)| (Kind::Source, None, Some(v)));
        let shared = [Kind::Transmittance, Kind::SourceBasis].map(|kind| (kind, None, None));
        model.prefetch(sources.chain(shared).chain(nodes.spectrum()))?;
        let air = Transmittance::prepare(model, head, conditions.visibility)?;
        let linear = linear(&visibilities, x);
        let around = cubic.taps().chain(linear.taps()).map(|(v, _)| v);
        let expansion = Expansion::new(model, nodes, around)?;
        let around: Vec<_> = (linear.taps())
            .map(|(v, weight)| (expansion.source(v), weight))
            .collect();
        let suns = sun_nodes(conditions.solar_elevation, reach(&head.planet));
        let mut source = SourceTable::empty(model, nodes, &suns)?;
        let ground = ground_factor(head, conditions.visibility, albedos.iter().copied());
        fill(&mut source, &suns, &expansion, (&cubic, &ground))?;
        Ok(Self {
            source,
            species: Scatterers::new(head, around.into_iter()),
            sun: conditions.sun_direction(),
            beam: Arc::clone(&FileTables::of(model)?.beam),
            reach: Reach::new(&head.planet),
            grey: air.grey(),
            irradiance: blocks(&irradiance(head)).collect(),
            xyz: xyz(head),
            white: core::array::from_fn(|c| head.xyz.iter().map(|row| row[c] as f32).sum()),
            air,
            conditions,
            over: None,
        })
    }

    /// The conditions that the aerial perspective was prepared for.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// The air: transmittance alone.
    pub fn transmittance(&self) -> &Transmittance {
        &self.air
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        self.air.wavelengths()
    }

    /// Unit vector towards the sun's centre.
    pub fn sun_direction(&self) -> [f64; 3] {
        self.sun
    }

    /// Memory that the aerial perspective holds on the heap, bytes: mostly the source, 16 × altitudes × suns × blocks
    /// of four wavelengths × components.
    pub fn bytes(&self) -> usize {
        let own = size_of_val(self.irradiance.as_slice()) + size_of_val(self.xyz.as_slice());
        let over = self.over.as_ref().map_or(0, |over| over.bytes());
        self.air.bytes()
            + self.beam.bytes()
            + self.source.bytes()
            + self.species.bytes()
            + own
            + over
    }

    /// The same aerial perspective with the sun at another azimuth (rad). Costs no preparation.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.conditions = self.conditions.with_solar_azimuth(azimuth)?;
        self.sun = self.conditions.sun_direction();
        match &mut self.over {
            Some(over) => over.set_solar_azimuth(azimuth),
            None => Ok(()),
        }
    }

    /// How far the air of segments may be from the origin, as an angle at the planet's centre, rad: twice that of the
    /// horizon as seen from the top of the air, so all that is seen from within the air above the origin; 0.35 rad
    /// (20°, 2200 km) for the Earth. Beyond, segments are refused: prepare an aerial perspective nearer to them, see
    /// [`Place`](crate::Place). Transmittances ([`AerialPerspective::transmittance`]) hold everywhere.
    pub fn reach(&self) -> f64 {
        self.reach.angle
    }
}

/// Fills all nodes of a table.
fn fill(
    table: &mut SourceTable,
    suns: &[f64],
    expansion: &Expansion,
    (visibilities, ground): (&Stencil, &[f64]),
) -> Result<()> {
    let altitudes: Vec<usize> = (0..table.altitudes()).collect();
    let mut scratch = Scratch::default();
    for sun in suns.iter().copied().enumerate() {
        let fill = Fill {
            expansion,
            visibilities,
            ground,
            sun,
            altitudes: &altitudes,
            table,
            scratch: &mut scratch,
        };
        if !fill.run() {
            return Err(overflow());
        }
    }
    Ok(())
}

fn irradiance(head: &Head) -> Vec<f64> {
    head.wavelengths
        .iter()
        .map(|&l| head.solar_irradiance_at(l))
        .collect()
}

fn xyz(head: &Head) -> Vec<[[f32; LANES]; 3]> {
    let rows = head.xyz.chunks(LANES);
    let lane = |row: &[[f64; 3]], i: usize, c: usize| row.get(i).map_or(0.0, |xyz| xyz[c] as f32);
    rows.map(|row| core::array::from_fn(|c| core::array::from_fn(|i| lane(row, i, c))))
        .collect()
}
