//! Segments that end in the observer's sky.
//!
//! The source of a segment and the sky are two fits of the same light. The sky's is the better one, and what is farther
//! than the air should vanish in it without a seam: so where hardly any light can come from beyond a segment, the sky
//! takes over.

use super::local_scattering::UNPOLARISED;
use super::prepared::AerialPerspective;
use super::segment_integral::{Block, Integral};
use super::xyz_sum::XyzSum;
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::kernel::math::LANES;
use crate::kernel::simd::dispatch;
use crate::polarisation::Plane;
use crate::sky::ColourSpace;
use crate::sky::{MOST_WAVELENGTHS, Sky, check_length};

/// The share of light from beyond a segment below which the sky begins to take over.
const REST: f32 = 0.04;

/// The air between an observer and things before the observer's sky; see [`AerialPerspective::joined_to`].
///
/// The observer stands above the origin, as high as the conditions of the sky say. The light of segments becomes that
/// of [`Sky::radiance`] continuously as they come to the end of the air, or to where nothing is seen through the air,
/// be it before the sky or before the ground below the horizon. The sky takes over where less than 4 % of the light
/// could come from beyond; shorter segments, and those that end on ground that is seen, are those of the aerial
/// perspective. Points that the planet hides are not seen: from there on the way into the ground the light goes over
/// into that of the air before it, which a volume of such points does not want.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let model = Model::default_model()?;
/// let conditions = Conditions { altitude: 100.0, ..Conditions::default() };
/// let sky = model.sky(&conditions)?;
/// let aerial = model.aerial_perspective(&conditions)?;
/// let joined = aerial.joined_to(&sky)?;
/// // A mountain 20 km away is seen as its radiance times the factors, plus the light of the air before it.
/// let (_, factors) = joined.linear_srgb([0.0, 20e3, 1500.0])?;
/// assert!(factors[2] < factors[0]);
/// // What is beyond the air is seen through all of it: its light is that of the sky.
/// let (light, _) = joined.linear_srgb([0.0, 0.8e6, 0.6e6 + 100.0])?;
/// let beyond = sky.linear_srgb([0.0, 0.8, 0.6])?;
/// assert!((light[2] / beyond[2] - 1.0).abs() < 1e-4);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct JoinedAerialPerspective<'a> {
    aerial: &'a AerialPerspective,
    sky: &'a Sky,
}

impl AerialPerspective {
    /// What is seen before a sky of the same conditions, but for the altitude, which the sky says.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the sky has another sun, visibility or albedo, [`Error::Invalid`] if its ground is that
    /// of another [`Model::over`](crate::Model::over); [`Error::Length`] if it has other wavelengths.
    pub fn joined_to<'a>(&'a self, sky: &'a Sky) -> Result<JoinedAerialPerspective<'a>> {
        let (own, other) = (self.conditions(), sky.conditions());
        type Parameter = (&'static str, &'static str, fn(&Conditions) -> f64);
        const SAME: [Parameter; 4] = [
            ("solar_elevation", "rad", |c| c.solar_elevation),
            ("solar_azimuth", "rad", |c| c.solar_azimuth),
            ("visibility", "m", |c| c.visibility),
            ("albedo", "", |c| c.albedo),
        ];
        for (parameter, unit, get) in SAME {
            let (wanted, value) = (get(own), get(other));
            if value != wanted {
                return Err(Error::OutOfRange {
                    parameter,
                    value,
                    min: wanted,
                    max: wanted,
                    unit,
                });
            }
        }
        if self.ground() != sky.ground() {
            return Err(Error::invalid("sky", "is over another ground"));
        }
        let [own, other] = [self.wavelengths(), sky.wavelengths()];
        if own != other {
            return Err(Error::Length {
                what: "wavelengths of the sky",
                expected: own.len() as u64,
                got: other.len() as u64,
            });
        }
        Ok(JoinedAerialPerspective { aerial: self, sky })
    }
}

impl JoinedAerialPerspective<'_> {
    /// Where the observer is, m.
    pub fn camera(&self) -> [f64; 3] {
        [0.0, 0.0, self.sky.conditions().altitude]
    }

    /// As [`AerialPerspective::in_scattering`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`].
    pub fn in_scattering(
        &self,
        to: [f64; 3],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.in_scattering_batch(&[to], in_scattering, transmittance)
    }

    /// As [`AerialPerspective::in_scattering_batch`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`]. What precedes a bad point is written.
    pub fn in_scattering_batch(
        &self,
        points: &[[f64; 3]],
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) -> Result<()> {
        let n = self.aerial.wavelengths().len();
        for length in [in_scattering.len(), transmittance.len()] {
            check_length(length, points.len().saturating_mul(n))?;
        }
        let rows = in_scattering
            .chunks_exact_mut(n)
            .zip(transmittance.chunks_exact_mut(n));
        for (&point, (light, through)) in points.iter().zip(rows) {
            self.integrate(point, |block, result| {
                self.aerial.write(block, &result, light, through);
            })?;
        }
        Ok(())
    }

    /// As [`AerialPerspective::xyz`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn xyz(&self, to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        let own = JoinedAerialPerspective {
            aerial: self.aerial.coloured(),
            sky: self.sky.coloured(),
        };
        let mut colours = XyzSum::default();
        own.integrate(to, |block, result| {
            colours.add(&own.aerial.xyz[block], &result);
        })?;
        Ok(colours.finish(&own.aerial.white))
    }

    /// As [`AerialPerspective::linear_srgb`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn linear_srgb(&self, to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        self.rgb(to, ColourSpace::Srgb)
    }

    /// As [`AerialPerspective::rgb`] from the observer.
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn rgb(&self, to: [f64; 3], space: ColourSpace) -> Result<([f32; 3], [f32; 3])> {
        let (light, through) = self.xyz(to)?;
        Ok((space.from_xyz(light), self.aerial.factors(through, space)))
    }

    /// Hands what the segment does to `emit` block by block.
    fn integrate(&self, to: [f64; 3], mut emit: impl FnMut(usize, Block)) -> Result<()> {
        let segment = self.aerial.segment(self.camera(), to)?;
        let direction = segment.direction.map(|v| v as f32);
        let (mut whole, mut looked_up) = (None, Ok(()));
        dispatch(Integral::<UNPOLARISED, _> {
            aerial: self.aerial,
            segment: &segment,
            plane: Plane::default(),
            beyond: true,
            emit: |block, mut result: Block| {
                let weights = sky_weights(&result);
                if weights != [0.0; LANES] {
                    // Most segments end well inside and need no sky.
                    let whole = whole.get_or_insert_with(|| {
                        let mut out = [0.0; MOST_WAVELENGTHS];
                        let used = &mut out[..self.aerial.wavelengths().len()];
                        looked_up = self.sky.relative_radiance(direction, used);
                        out
                    });
                    let light = result.scattered.iter_mut().zip(&whole[block * LANES..]);
                    for ((light, whole), weight) in light.zip(weights) {
                        *light += weight * (whole - *light);
                    }
                }
                emit(block, result);
            },
        });
        looked_up
    }
}

/// How much the sky counts: all where no light can come from beyond, nothing from [`REST`] on.
#[inline(always)]
pub(super) fn sky_weights(result: &Block) -> [f32; LANES] {
    core::array::from_fn(|i| {
        let all = (result.scattered[i] + result.beyond[i]).max(f32::MIN_POSITIVE);
        let near = (1.0 - result.beyond[i] / all * (1.0 / REST)).max(0.0);
        near * near
    })
}
