//! Light and transmittance of segments.

use super::local_scattering::{UNPOLARISED, attenuated};
use super::prepared::AerialPerspective;
use super::segment_integral::{Block, Integral};
use super::xyz_sum::XyzSum;
use crate::error::{Error, Result};
use crate::kernel::math::{LANES, bound};
use crate::kernel::simd::dispatch;
use crate::polarisation::Plane;
use crate::sky::ColourSpace;
use crate::transmittance::Segment;

impl AerialPerspective {
    /// Light that the air between `from` and `to` scatters to `from` (W m⁻² sr⁻¹ nm⁻¹), and the transmittance between
    /// them, at each of [`AerialPerspective::wavelengths`].
    ///
    /// # Errors
    /// [`Error::Point`] for coordinates that are not finite or beyond 10⁹ m; [`Error::Reach`] for air beyond
    /// [`AerialPerspective::reach`]; [`Error::Length`] unless both outputs have one element per wavelength.
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
    /// [`Error::Point`] for coordinates that are not finite or beyond 10⁹ m; [`Error::Reach`] for air beyond
    /// [`AerialPerspective::reach`].
    pub fn xyz(&self, from: [f64; 3], to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        let own = self.coloured();
        let segment = own.segment(from, to)?;
        let mut colours = XyzSum::default();
        own.integrate(&segment, |block, result| {
            colours.add(&own.xyz[block], &result);
        });
        Ok(colours.finish(&own.white))
    }

    /// In-scattered light in linear sRGB (cd m⁻², not clipped), and the factors by which the air changes red, green and
    /// blue of white things in the colour of the sun.
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn linear_srgb(&self, from: [f64; 3], to: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        self.rgb(from, to, ColourSpace::Srgb)
    }

    /// As [`AerialPerspective::linear_srgb`], in any colour space.
    ///
    /// # Errors
    /// As [`AerialPerspective::xyz`].
    pub fn rgb(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        space: ColourSpace,
    ) -> Result<([f32; 3], [f32; 3])> {
        let (light, through) = self.xyz(from, to)?;
        Ok((space.from_xyz(light), self.factors(through, space)))
    }

    /// A segment within reach.
    #[inline(always)]
    pub(super) fn segment(&self, from: [f64; 3], to: [f64; 3]) -> Result<Segment> {
        let planet = self.air.planet();
        let segment = Segment::between(&planet, from, to)?;
        self.reach.check(&planet, &segment)?;
        Ok(segment)
    }

    /// Factors of the components of a colour space from those of X, Y and Z.
    pub(super) fn factors(&self, through: [f32; 3], space: ColourSpace) -> [f32; 3] {
        let seen = core::array::from_fn(|c| through[c] * self.white[c]);
        let [seen, white] = [seen, self.white].map(|xyz| space.from_xyz(xyz));
        core::array::from_fn(|c| bound(seen[c] / white[c], 0.0, 1.0))
    }

    pub(super) fn spectral(
        &self,
        segment: &Segment,
        in_scattering: &mut [f32],
        transmittance: &mut [f32],
    ) {
        self.integrate(segment, |block, result| {
            self.write(block, &result, in_scattering, transmittance);
        });
    }

    /// Writes a block of wavelengths, of which the last may be cut short.
    #[inline(always)]
    pub(super) fn write(
        &self,
        block: usize,
        result: &Block,
        in_scattering: &mut [f32],
        through: &mut [f32],
    ) {
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
    pub(super) fn integrate(&self, segment: &Segment, emit: impl FnMut(usize, Block)) {
        dispatch(Integral::<UNPOLARISED, _> {
            aerial: self,
            segment,
            plane: Plane::default(),
            beyond: false,
            emit,
        });
    }

    pub(super) fn check_outputs(&self, points: usize, a: &[f32], b: &[f32]) -> Result<()> {
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
