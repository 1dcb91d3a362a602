//! Hero wavelengths over a ground whose albedo depends on wavelength: light at the nodes as it is over the ground of
//! each wavelength, then what lies between them. Format specification, section 7.3.

use std::sync::Arc;

use super::baked_tables::Baked;
use super::batch::{Directions, Group, Sink};
use crate::error::Result;
use crate::ground::BetweenGrounds;
use crate::kernel::lanes::Lanes;
use crate::polarisation::{Stokes, between};
use crate::sky::Sky;
use crate::spectrum::{MOST_WAVELENGTHS, SpectralInterpolation};

/// Wavelengths that are computed together.
const LANES: usize = 16;

/// What a baked sky needs besides.
#[derive(Clone, Debug)]
pub(super) struct OverGround {
    pub grounds: BetweenGrounds,
    /// The sky over the other ground.
    pub second: Baked<LANES>,
    pub interpolation: Arc<SpectralInterpolation>,
}

impl OverGround {
    /// Of a sky, where it has such a ground; `bake` makes tables of the one over the other ground.
    pub fn new(sky: &Sky, bake: impl FnOnce(&Sky) -> Result<Baked<LANES>>) -> Result<Option<Self>> {
        let Some(over) = sky.over_ground() else {
            return Ok(None);
        };
        Ok(Some(Self {
            grounds: over.grounds.clone(),
            second: bake(&over.second)?,
            interpolation: Arc::clone(sky.interpolation()),
        }))
    }

    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.second.set_solar_azimuth(azimuth)
    }

    /// Spectral radiance at wavelengths in range, four for each direction. `first` is the sky over the first ground.
    pub fn heroes(
        &self,
        first: &Baked<LANES>,
        directions: &Directions,
        wavelengths: &[[f32; 4]],
        out: &mut [[f32; 4]],
    ) -> Result<()> {
        let mut rows = [[0.0; MOST_WAVELENGTHS]; 2];
        let [one, other] = rows.each_mut().map(|row| &mut row[..self.grounds.nodes()]);
        for (i, (out, wavelengths)) in out.iter_mut().zip(wavelengths).enumerate() {
            let direction = [directions.x[i], directions.y[i], directions.z[i]];
            relative(first, direction, one)?;
            relative(&self.second, direction, other)?;
            *out = wavelengths.map(|wavelength| self.radiance(wavelength, [one, other]));
        }
        Ok(())
    }

    pub fn bytes(&self) -> usize {
        self.grounds.bytes() + self.second.table.bytes()
    }

    /// Spectral radiance at a wavelength from relative radiance over both grounds.
    fn radiance(&self, wavelength: f32, [first, second]: [&[f32]; 2]) -> f32 {
        let mut room = [0.0; MOST_WAVELENGTHS];
        let light = &mut room[..first.len()];
        light.copy_from_slice(first);
        let wavelength = f64::from(wavelength);
        self.grounds.blend(wavelength, light, second);
        let relative = self.interpolation.radiance(light, wavelength);
        let spectral = relative * self.interpolation.solar_irradiance(wavelength);
        spectral.min(f64::from(f32::MAX)) as f32
    }

    /// The Stokes vector at a wavelength from relative ones over both grounds.
    pub fn stokes(&self, wavelength: f32, [first, second]: [&[Stokes]; 2]) -> Stokes {
        let (mut lights, mut relative) = (
            [Stokes::default(); MOST_WAVELENGTHS],
            [0.0; MOST_WAVELENGTHS],
        );
        let n = first.len();
        let wavelength = f64::from(wavelength);
        let pairs = first
            .iter()
            .zip(second)
            .zip(self.grounds.shares(wavelength));
        for (i, ((first, second), share)) in pairs.enumerate() {
            lights[i] = first.towards(second, share);
            relative[i] = lights[i].i;
        }
        let (lights, relative) = (&lights[..n], &relative[..n]);
        let total = self.interpolation.radiance(relative, wavelength);
        let total = total * self.interpolation.solar_irradiance(wavelength);
        let shares = self.interpolation.shares(relative, wavelength);
        between(&shares, lights, total.min(f64::from(f32::MAX)) as f32)
    }
}

/// Relative radiance at the nodes in one direction.
pub(super) fn relative(sky: &Baked<LANES>, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
    sky.one(direction, Row(out))
}

/// What a table holds.
struct Row<'a>(&'a mut [f32]);

impl Sink<LANES> for Row<'_> {
    #[inline(always)]
    fn put<const W: usize>(&mut self, group: &Group<LANES, W>) {
        for i in 0..group.count {
            for (block, out) in self.0.chunks_mut(LANES).enumerate() {
                let value = group.table.value(group.spots, i, block);
                let value = value.min(Lanes::splat(f32::MAX));
                out.copy_from_slice(&value.0[..out.len()]);
            }
        }
    }
}
