//! Aerial perspective: the light that the air between two points scatters towards the first. Format specification,
//! section 7.7.

mod aerial_perspective_query;
mod angular_basis;
mod direct_sunlight;
mod joined;
mod joined_stokes;
mod light_estimate;
mod local_scattering;
mod path_points;
mod quadrature_limits;
mod quadrature_panels;
mod reach;
mod scatterers;
mod segment_integral;
mod sky_difference;
mod source_expansion;
mod source_nodes;
mod source_table;
mod spherical_harmonics;
mod stokes_integral;
mod sun_transmittance;
mod visible_disc;
mod xyz_sum;

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::{Head, Kind, visibility_node};
use crate::kernel::lanes::Lanes;
use crate::kernel::math::{LANES, bound};
use crate::kernel::simd::dispatch;
use crate::model::Model;
use crate::polarisation::Plane;
use crate::transmittance::{Segment, Transmittance};
pub use aerial_perspective_query::AerialPerspectiveQuery;
pub use joined::JoinedAerialPerspective;
pub use joined_stokes::JoinedPolarisedAerialPerspective;
use local_scattering::UNPOLARISED;
use reach::Reach;
use scatterers::Scatterers;
use segment_integral::{Block, Integral};
pub use sky_difference::SkyDifference;
use source_table::{SourceTable, blocks, ground_factor};
use sun_transmittance::Beam;
use xyz_sum::XyzSum;

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
    conditions: Conditions,
    air: Transmittance,
    sun: [f64; 3],
    species: Scatterers,
    source: SourceTable,
    beam: Beam,
    reach: Reach,
    /// Extinction at a typical wavelength, m⁻¹: a polynomial of each layer.
    grey: Vec<[f32; 3]>,
    irradiance: Vec<[f32; LANES]>,
    /// `[block][X, Y, Z]`.
    xyz: Vec<[[f32; LANES]; 3]>,
    /// XYZ of the unattenuated sun, for the transmittance of colours.
    white: [f32; 3],
}

impl Model {
    /// Prepares transmittance and in-scattering for a scene.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model; [`Error::MissingChunk`] if the file has no transmittance
    /// or no source; [`Error::Checksum`], [`Error::Encoding`], [`Error::Length`] or [`Error::Invalid`] if one is
    /// damaged.
    pub fn aerial_perspective(&self, conditions: &Conditions) -> Result<AerialPerspective> {
        let conditions = conditions.checked(self)?;
        let head = self.head();
        let nodes = head.visibility_nodes();
        let x = visibility_node(conditions.visibility);
        let cubic = crate::kernel::axis::hermite(&nodes, x);
        let sources = cubic.taps().map(|(v, _)| (Kind::Source, None, Some(v)));
        let shared = [Kind::Transmittance, Kind::SourceBasis].map(|kind| (kind, None, None));
        self.prefetch(sources.chain(shared))?;
        let air = self.transmittance(conditions.visibility)?;
        let linear = crate::kernel::axis::linear(&nodes, x);
        let around: Vec<_> = linear
            .taps()
            .map(|(v, weight)| Ok((self.source_chunk(v)?, weight)))
            .collect::<Result<_>>()?;
        let ground = ground_factor(head, conditions.visibility, conditions.albedo);
        let (elevation, azimuth) = (conditions.solar_elevation, conditions.solar_azimuth);
        Ok(AerialPerspective {
            source: SourceTable::new(self, conditions.visibility, elevation, &ground)?,
            species: Scatterers::new(head, around.into_iter()),
            sun: sun_direction(elevation, azimuth),
            beam: Beam::new(&air.layers, elevation),
            reach: Reach::new(&head.planet),
            grey: air.grey(),
            irradiance: blocks(&irradiance(head)).collect(),
            xyz: xyz(head),
            white: core::array::from_fn(|c| head.xyz.iter().map(|row| row[c] as f32).sum()),
            air,
            conditions,
        })
    }
}

impl AerialPerspective {
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
        self.air.bytes() + self.beam.bytes() + self.source.bytes() + self.species.bytes() + own
    }

    /// The same aerial perspective with the sun at another azimuth (rad). Costs no preparation.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        if !azimuth.is_finite() {
            return Err(Error::OutOfRange {
                parameter: "solar_azimuth",
                value: azimuth,
                min: f64::MIN,
                max: f64::MAX,
                unit: "rad",
            });
        }
        self.conditions.solar_azimuth = azimuth;
        self.sun = sun_direction(self.conditions.solar_elevation, azimuth);
        Ok(())
    }

    /// Light that the air between `from` and `to` scatters to `from` (W m⁻² sr⁻¹ nm⁻¹), and the transmittance between
    /// them, at each of [`AerialPerspective::wavelengths`].
    ///
    /// # Errors
    /// [`Error::Point`] for coordinates that are not finite or beyond 10⁹ m; [`Error::Reach`] for air beyond [`AerialPerspective::reach`];
    /// [`Error::Length`] unless both outputs have one element per wavelength.
    pub fn in_scattering(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.check_outputs(1, in_scattering, transmittance)?;
        let segment = self.segment(from, to)?;
        self.spectral(&segment, in_scattering, transmittance);
        Ok(())
    }

    /// As [`AerialPerspective::in_scattering`], from a point in a direction (need not be normalised) through all of the
    /// air, up to the ground where that is in the way. From a point on the ground or under it, rays that go down end at
    /// once: no light, transmittance 1.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`]; [`Error::Direction`] for a vector that is zero or not finite.
    pub fn to_end(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.check_outputs(1, in_scattering, transmittance)?;
        let planet = self.air.planet();
        let (segment, _) = Segment::to_end(&planet, from, direction)?;
        self.reach.check(&planet, &segment)?;
        self.spectral(&segment, in_scattering, transmittance);
        Ok(())
    }

    /// [`AerialPerspective::in_scattering`] from one camera to many points; the outputs are `[points][wavelengths]`.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`]. What precedes a bad point is written.
    pub fn in_scattering_batch(
        &self,
        camera: [f64; 3],
        points: &[[f64; 3]],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.check_outputs(points.len(), in_scattering, transmittance)?;
        let n = self.wavelengths().len();
        let rows = in_scattering
            .chunks_exact_mut(n)
            .zip(transmittance.chunks_exact_mut(n));
        for (&point, (light, through)) in points.iter().zip(rows) {
            let segment = self.segment(camera, point)?;
            self.spectral(&segment, light, through);
        }
        Ok(())
    }

    /// In-scattered light as CIE 1931 XYZ (Y in cd m⁻²), and the factors by which the air changes X, Y and Z of white
    /// things in the colour of the sun.
    ///
    /// # Errors
    /// [`Error::Point`] for coordinates that are not finite or beyond 10⁹ m; [`Error::Reach`] for air beyond [`AerialPerspective::reach`].
    pub fn xyz(&self, from: [f64; 3], to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        let segment = self.segment(from, to)?;
        let mut colours = XyzSum::default();
        self.integrate(&segment, |block, result| {
            colours.add(&self.xyz[block], &result);
        });
        Ok(colours.finish(&self.white))
    }

    /// In-scattered light in linear sRGB (cd m⁻², not clipped), and the factors by which the air changes red, green and
    /// blue of white things in the colour of the sun.
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn linear_srgb(&self, from: [f64; 3], to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        let (light, through) = self.xyz(from, to)?;
        let light = crate::sky::xyz_to_linear_srgb(light);
        Ok((light, self.srgb_factors(through)))
    }

    /// A segment within reach.
    #[inline(always)]
    fn segment(&self, from: [f64; 3], to: [f64; 3]) -> Result<Segment> {
        let planet = self.air.planet();
        let segment = Segment::between(&planet, from, to)?;
        self.reach.check(&planet, &segment)?;
        Ok(segment)
    }

    /// Factors of red, green and blue from those of X, Y and Z.
    fn srgb_factors(&self, through: [f32; 3]) -> [f32; 3] {
        let seen = core::array::from_fn(|c| through[c] * self.white[c]);
        let [seen, white] = [seen, self.white].map(crate::sky::xyz_to_linear_srgb);
        core::array::from_fn(|c| bound(seen[c] / white[c], 0.0, 1.0))
    }

    fn spectral(&self, segment: &Segment, in_scattering: &mut [f32], transmittance: &mut [f32]) {
        self.integrate(segment, |block, result| {
            self.write(block, &result, in_scattering, transmittance);
        });
    }

    /// Writes a block of wavelengths, of which the last may be cut short.
    #[inline(always)]
    fn write(&self, block: usize, result: &Block, in_scattering: &mut [f32], through: &mut [f32]) {
        let transmittance = attenuated(&result.depth);
        let sun = &self.irradiance[block];
        let rows = in_scattering[block * LANES..]
            .iter_mut()
            .zip(&mut through[block * LANES..]);
        for (i, (light, t)) in rows.take(LANES).enumerate() {
            *light = bound(result.scattered[i] * sun[i], 0.0, f32::MAX);
            *t = transmittance[i];
        }
    }

    /// Hands what the segment does to `emit` block by block.
    fn integrate(&self, segment: &Segment, emit: impl FnMut(usize, Block)) {
        dispatch(Integral::<UNPOLARISED, _> {
            aerial: self,
            segment,
            plane: Plane::default(),
            beyond: false,
            emit,
        });
    }

    fn check_outputs(&self, points: usize, a: &[f32], b: &[f32]) -> Result<()> {
        let expected = points.saturating_mul(self.wavelengths().len());
        for got in [a.len(), b.len()] {
            if got != expected {
                return Err(Error::Length {
                    what: "output",
                    expected: expected as u64,
                    got: got as u64,
                });
            }
        }
        Ok(())
    }
}

#[inline(always)]
fn attenuated(depth: &[f32; LANES]) -> [f32; LANES] {
    (-Lanes(*depth)).exp().0
}

fn sun_direction(elevation: f64, azimuth: f64) -> [f64; 3] {
    let ((se, ce), (sa, ca)) = (elevation.sin_cos(), azimuth.sin_cos());
    [ce * ca, ce * sa, se]
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
