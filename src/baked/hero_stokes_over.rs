//! Stokes vectors at hero wavelengths over a ground whose albedo depends on wavelength. Format specification, section
//! 7.5.

use super::baked_polarised::BakedPolarisedSky;
use super::batch::Directions;
use super::over_ground::{OverGround, relative as relative_row};
use crate::error::Result;
use crate::polarisation::{PolarisationFrame, Stokes, StokesSpectra};
use crate::spectrum::MOST_WAVELENGTHS;

impl BakedPolarisedSky {
    /// Stokes vectors at wavelengths in range, four for each direction.
    pub(super) fn heroes_over(
        &self,
        (over, second): (&OverGround, &BakedPolarisedSky),
        directions: &Directions,
        frame: PolarisationFrame,
        wavelengths: &[[f32; 4]],
        out: &mut [[Stokes; 4]],
    ) -> Result<()> {
        let mut lights = [[Stokes::default(); MOST_WAVELENGTHS]; 2];
        let n = self.sky().wavelengths().len();
        for (i, (out, wavelengths)) in out.iter_mut().zip(wavelengths).enumerate() {
            let direction = [directions.x[i], directions.y[i], directions.z[i]];
            let [first, other] = &mut lights;
            self.relative(direction, frame, &mut first[..n])?;
            second.relative(direction, frame, &mut other[..n])?;
            *out = wavelengths.map(|l| over.stokes(l, [&first[..n], &other[..n]]));
        }
        Ok(())
    }

    /// Stokes vectors per unit of solar irradiance at the nodes.
    fn relative(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<()> {
        let [mut i, mut q, mut u] = [[0.0; MOST_WAVELENGTHS]; 3];
        let n = out.len();
        let spectra = StokesSpectra {
            i: &mut i[..n],
            q: &mut q[..n],
            u: &mut u[..n],
        };
        self.stokes(direction, frame, spectra)?;
        let mut relative = [0.0; MOST_WAVELENGTHS];
        let relative = &mut relative[..n];
        relative_row(&self.sky().baked, direction, relative)?;
        for (k, out) in out.iter_mut().enumerate() {
            let share = relative[k] / i[k].max(f32::MIN_POSITIVE);
            *out = Stokes {
                i: relative[k],
                q: share * q[k],
                u: share * u[k],
            };
        }
        Ok(())
    }
}
