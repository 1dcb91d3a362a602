//! Stokes vectors of in-scattered light. Format specification, sections 7.5 and 7.7.
//!
//! All points of a straight segment share its vertical plane, and with it the axes of polarisation: Q and U add up
//! along it. Molecules polarise sunlight and, by the coherency tensor of the source, all other light; particles do not.

use super::joined::sky_weights;
use super::local_scattering::{POLARISED, attenuated};
use super::prepared::AerialPerspective;
use super::segment_integral::{Block, Integral};
use crate::error::Result;
use crate::kernel::math::{LANES, bound, finite};
use crate::kernel::simd::dispatch;
use crate::polarisation::{
    Plane, PolarisationFrame, PolarisedLight, PolarisedSky, Stokes, StokesSpectra, between, limit,
};
use crate::sky::{ColourSpace, xyz_to_linear_srgb};
use crate::sky::{MOST_WAVELENGTHS, check_length};

impl AerialPerspective {
    /// Stokes vectors of the light that the air between `from` and `to` scatters to `from`, and the transmittance
    /// between them, at each of [`AerialPerspective::wavelengths`]; the frame is that of the view from `from` to `to`.
    /// Q² + U² ≤ I².
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering`]; [`Error::Direction`](crate::Error::Direction) for an axis that is zero
    /// or not finite.
    pub fn in_scattering_stokes(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
        in_scattering: StokesSpectra,
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.in_scattering_stokes_batch(from, &[to], frame, in_scattering, transmittance)
    }

    /// [`AerialPerspective::in_scattering_stokes`] from one camera to many points; the outputs are
    /// `[points][wavelengths]`.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_stokes`]. What precedes a bad point is written.
    pub fn in_scattering_stokes_batch(
        &self,
        camera: [f64; 3],
        points: &[[f64; 3]],
        frame: PolarisationFrame,
        in_scattering: StokesSpectra,
        transmittance: &mut [f32],
    ) -> Result<()> {
        self.spectra(None, camera, points, frame, in_scattering, transmittance)
    }

    /// [`AerialPerspective::in_scattering_stokes_batch`], before a sky if there is one.
    pub(super) fn spectra(
        &self,
        sky: Option<&PolarisedSky>,
        camera: [f64; 3],
        points: &[[f64; 3]],
        frame: PolarisationFrame,
        in_scattering: StokesSpectra,
        transmittance: &mut [f32],
    ) -> Result<()> {
        let n = self.wavelengths().len();
        in_scattering.check(points.len().saturating_mul(n))?;
        check_length(transmittance.len(), points.len().saturating_mul(n))?;
        for (k, &point) in points.iter().enumerate() {
            let sky = sky.map(PolarisedSky::light);
            self.stokes(sky, camera, point, frame, |block, light, through| {
                let first = k * n + block * LANES;
                let sun = &self.irradiance[block];
                for i in 0..LANES.min(n - block * LANES) {
                    let total = bound(light[0][i] * sun[i], 0.0, f32::MAX);
                    in_scattering.i[first + i] = total;
                    in_scattering.q[first + i] = total * light[1][i];
                    in_scattering.u[first + i] = total * light[2][i];
                    transmittance[first + i] = through[i];
                }
            })?;
        }
        Ok(())
    }

    /// [`AerialPerspective::in_scattering_stokes`] at any wavelength (nm) within the range of the model, per unit of
    /// solar spectral irradiance, sr⁻¹.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_stokes`]; [`Error::OutOfRange`](crate::Error::OutOfRange) for the
    /// wavelength.
    pub fn relative_stokes_at(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
        wavelength: f64,
    ) -> Result<Stokes> {
        self.air.interpolation().check(wavelength)?;
        let mut lights = [Stokes::default(); MOST_WAVELENGTHS];
        let mut relative = [0.0; MOST_WAVELENGTHS];
        let nodes = self.wavelengths().len();
        let (lights, relative) = (&mut lights[..nodes], &mut relative[..nodes]);
        self.stokes_at_nodes(from, to, frame, lights)?;
        if let Some(over) = &self.over {
            let mut second = [Stokes::default(); MOST_WAVELENGTHS];
            let second = &mut second[..nodes];
            over.second.stokes_at_nodes(from, to, frame, second)?;
            let shares = over.grounds.shares(wavelength);
            let pairs = lights.iter_mut().zip(&*second);
            pairs.zip(shares).for_each(|((first, second), share)| {
                *first = first.towards(second, share);
            });
        }
        let pairs = relative.iter_mut().zip(&*lights);
        pairs.for_each(|(relative, light)| *relative = light.i);
        let total = self.relative_at(relative, wavelength);
        let shares = self.air.interpolation().shares(relative, wavelength);
        Ok(between(&shares, lights, total))
    }

    fn stokes_at_nodes(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
        lights: &mut [Stokes],
    ) -> Result<()> {
        self.stokes(None, from, to, frame, |block, [i, q, u], _| {
            for lane in 0..LANES.min(lights.len() - block * LANES) {
                let i = bound(i[lane], 0.0, f32::MAX);
                let (q, u) = (i * q[lane], i * u[lane]);
                lights[block * LANES + lane] = Stokes { i, q, u };
            }
        })
    }

    /// As [`AerialPerspective::xyz`], with Stokes vectors of X, Y and Z: what a polariser leaves of the aerial
    /// perspective is
    /// [`Stokes::through_polariser`].
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_stokes`].
    pub fn xyz_stokes(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
    ) -> Result<([Stokes; 3], [f32; 3])> {
        self.polarised_xyz(None, from, to, frame)
    }

    fn polarised_xyz(
        &self,
        sky: Option<&PolarisedSky>,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
    ) -> Result<([Stokes; 3], [f32; 3])> {
        let mut light = [[0f32; 3]; 3];
        let mut seen = [0f32; 3];
        let own = self.coloured();
        let sky = sky.map(PolarisedSky::colour_light);
        own.stokes(sky, from, to, frame, |block, parts, through| {
            for (c, weight) in own.xyz[block].iter().enumerate() {
                for i in 0..LANES {
                    let total = weight[i] * parts[0][i];
                    light[c][0] += total;
                    light[c][1] += total * parts[1][i];
                    light[c][2] += total * parts[2][i];
                    seen[c] += weight[i] * through[i];
                }
            }
        })?;
        let stokes = light.map(|parts| {
            let [i, q, u] = parts.map(finite);
            Stokes { i, q, u }
        });
        let factor = |c: usize| bound(seen[c] / own.white[c], 0.0, 1.0);
        Ok((stokes, core::array::from_fn(factor)))
    }

    /// As [`AerialPerspective::linear_srgb`], with Stokes vectors of red, green and blue.
    ///
    /// # Errors
    /// As [`AerialPerspective::in_scattering_stokes`].
    pub fn linear_srgb_stokes(
        &self,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
    ) -> Result<([Stokes; 3], [f32; 3])> {
        self.polarised_srgb(None, from, to, frame)
    }

    /// [`AerialPerspective::linear_srgb_stokes`], before a sky if there is one.
    pub(super) fn polarised_srgb(
        &self,
        sky: Option<&PolarisedSky>,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
    ) -> Result<([Stokes; 3], [f32; 3])> {
        let (light, through) = self.polarised_xyz(sky, from, to, frame)?;
        let part = |of: fn(&Stokes) -> f32| xyz_to_linear_srgb(light.each_ref().map(of));
        let [i, q, u] = [part(|s| s.i), part(|s| s.q), part(|s| s.u)];
        let stokes = |c: usize| Stokes {
            i: i[c],
            q: q[c],
            u: u[c],
        };
        Ok((
            core::array::from_fn(stokes),
            self.factors(through, ColourSpace::Srgb),
        ))
    }

    /// Hands blocks of light per unit of solar irradiance, of Q and U over it in the frame of the caller, and of
    /// transmittance to `emit`; before a sky if there is one.
    fn stokes(
        &self,
        sky: Option<PolarisedLight>,
        from: [f64; 3],
        to: [f64; 3],
        frame: PolarisationFrame,
        mut emit: impl FnMut(usize, [[f32; LANES]; 3], [f32; LANES]),
    ) -> Result<()> {
        let segment = self.segment(from, to)?;
        let plane = Plane::new(segment.direction, segment.zenith(), self.sun);
        let (c, s) = plane.turn(frame)?;
        let (c, s) = (c as f32, s as f32);
        let (mut whole, mut looked_up) = (None, Ok(()));
        dispatch(Integral::<POLARISED, _> {
            aerial: self,
            segment: &segment,
            plane,
            beyond: sky.is_some(),
            emit: |block, result: Block| {
                let [q, u] = result.linear;
                let mut light = [
                    result.scattered,
                    core::array::from_fn(|i| c * q[i] + s * u[i]),
                    core::array::from_fn(|i| c * u[i] - s * q[i]),
                ];
                let weights = sky.as_ref().map_or([0.0; LANES], |_| sky_weights(&result));
                if let Some(sky) = sky.as_ref().filter(|_| weights != [0.0; LANES]) {
                    let whole = whole.get_or_insert_with(|| {
                        let mut out = [Stokes::default(); MOST_WAVELENGTHS];
                        let used = &mut out[..self.wavelengths().len()];
                        let direction = segment.direction.map(|v| v as f32);
                        looked_up = sky.relative_stokes(direction, frame, used);
                        out
                    });
                    for (i, whole) in whole[block * LANES..][..LANES].iter().enumerate() {
                        for (part, whole) in light.iter_mut().zip([whole.i, whole.q, whole.u]) {
                            part[i] += weights[i] * (whole - part[i]);
                        }
                    }
                }
                let [total, q, u] = light;
                let [q, u] = limit(total, q, u);
                emit(block, [total, q, u], attenuated(&result.depth));
            },
        });
        looked_up
    }
}
