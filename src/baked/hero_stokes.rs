//! Stokes vectors at a few wavelengths that differ from query to query. Format specification, section 7.5: Q/I and U/I
//! are interpolated as the logarithm of I is.

use super::baked_polarised::{ALMOST_WHOLE, BakedPolarisedSky};
use super::baked_spectral::LANES;
use super::batch::{Directions, Group, Sink};
use super::frame_rotation::{Axes, FrameRotation};
use super::polarisation_table::{self, turned};
use super::spline_table::Spots;
use crate::error::Result;
use crate::kernel::lanes::Lanes;
use crate::polarisation::{PolarisationFrame, Stokes};

/// Most blocks of wavelengths.
const BLOCKS: usize = 256usize.div_ceil(polarisation_table::LANES);

impl BakedPolarisedSky {
    /// Stokes vectors at four wavelengths (nm) within the range of the model, as [`PolarisedSky::stokes_at`]. The
    /// radiance is that of [`BakedSky::hero`].
    ///
    /// # Errors
    /// [`Error::Direction`] for a direction or an axis that is zero or not finite, [`Error::OutOfRange`] for a
    /// wavelength.
    ///
    /// [`PolarisedSky::stokes_at`]: crate::PolarisedSky::stokes_at
    /// [`BakedSky::hero`]: crate::BakedSky::hero
    /// [`Error::Direction`]: crate::Error::Direction
    /// [`Error::OutOfRange`]: crate::Error::OutOfRange
    #[inline]
    pub fn hero(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        wavelengths: [f32; 4],
    ) -> Result<[Stokes; 4]> {
        self.sky().check_wavelengths(&[wavelengths])?;
        let mut out = [[Stokes::default(); 4]];
        self.sky().baked.one(
            direction,
            Heroes {
                sky: self,
                axes: Axes::new(frame)?,
                wavelengths: &[wavelengths],
                out: &mut out,
            },
        )?;
        Ok(out[0])
    }

    /// [`BakedPolarisedSky::hero`] for many directions with wavelengths of their own.
    ///
    /// # Errors
    /// As [`BakedPolarisedSky::hero`]; [`Error::Length`](crate::Error::Length) unless there are as many components,
    /// wavelengths and results. What precedes a bad direction may or may not be written.
    pub fn hero_batch(
        &self,
        directions: &Directions,
        frame: PolarisationFrame,
        wavelengths: &[[f32; 4]],
        out: &mut [[Stokes; 4]],
    ) -> Result<()> {
        self.sky()
            .check_heroes(directions, wavelengths, out.len())?;
        let axes = Axes::new(frame)?;
        self.sky().baked.each(
            directions,
            Heroes {
                sky: self,
                axes,
                wavelengths,
                out,
            },
        )
    }
}

/// Stokes vectors at four wavelengths of each direction's own.
struct Heroes<'a> {
    sky: &'a BakedPolarisedSky,
    axes: Axes,
    wavelengths: &'a [[f32; 4]],
    out: &'a mut [[Stokes; 4]],
}

impl Sink<LANES> for Heroes<'_> {
    #[inline(always)]
    fn put<const W: usize>(&mut self, group: &Group<LANES, W>) {
        let sky = self.sky.sky();
        let turn = self.axes.turn(sky.frame(), group.vectors);
        for i in 0..group.count {
            let wavelengths = &self.wavelengths[group.first + i];
            let light = sky.axis.radiance(group, i, wavelengths);
            let ratios = self.ratios(group.spots, &turn, i, wavelengths);
            self.out[group.first + i] = bounded(light, ratios);
        }
    }
}

impl Heroes<'_> {
    /// Q/I and U/I for direction `i`.
    #[inline(always)]
    fn ratios<const W: usize>(
        &self,
        spots: &Spots<W>,
        turn: &FrameRotation<W>,
        i: usize,
        wavelengths: &[f32; 4],
    ) -> [Lanes<4>; 2] {
        let degrees = &self.sky.degrees;
        let axis = &self.sky.sky().axis;
        let at = |block: usize| turned(&degrees.at(spots, i, block), turn, i);
        if degrees.blocks == 1 {
            return at(0).map(|ratios| axis.mix(wavelengths, &ratios.0));
        }
        let mut ratios = [[[0.0; polarisation_table::LANES]; BLOCKS]; 2];
        for block in 0..degrees.blocks {
            let [q, u] = at(block);
            (ratios[0][block], ratios[1][block]) = (q.0, u.0);
        }
        ratios.map(|ratios| axis.mix(wavelengths, ratios.as_flattened()))
    }
}

/// Where splines overshoot, no more than the whole light.
#[inline(always)]
fn bounded(light: Lanes<4>, [q, u]: [Lanes<4>; 2]) -> [Stokes; 4] {
    let share = Lanes::splat(ALMOST_WHOLE) / (q * q + u * u).max(Lanes::splat(ALMOST_WHOLE));
    let polarised = light * share.sqrt();
    let (q, u) = (q * polarised, u * polarised);
    core::array::from_fn(|lane| Stokes {
        i: light.0[lane],
        q: q.0[lane],
        u: u.0[lane],
    })
}
