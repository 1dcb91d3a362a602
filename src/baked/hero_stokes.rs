//! Stokes vectors at a few wavelengths that differ from query to query. Format specification, section 7.5: Q/I and U/I
//! are interpolated as the logarithm of I is.

use super::baked_polarised::{ALMOST_WHOLE, BakedPolarisedSky};
use super::baked_spectral::LANES;
use super::batch::{Directions, Group, Sink, alone};
use super::frame_rotation::{Axes, FrameRotation};
use super::polarisation_table::{self, turned};
use super::spline_table::Spots;
use crate::error::Result;
use crate::kernel::lanes::Lanes;
use crate::polarisation::{PolarisationFrame, Stokes};
use crate::spectrum::{CellTable, MOST_WAVELENGTHS};

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
        if let Some(over) = self.over() {
            self.heroes_over(over, &alone(&direction), frame, &[wavelengths], &mut out)?;
            return Ok(out[0]);
        }
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
        if let Some(over) = self.over() {
            return self.heroes_over(over, directions, frame, wavelengths, out);
        }
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
            self.out[group.first + i] = match sky.axis.cells() {
                Some(cells) => self.of_cells(cells, group, &turn, i, wavelengths),
                None => {
                    let light = sky.axis.radiance(group, i, wavelengths);
                    bounded(light, self.ratios(group.spots, &turn, i, wavelengths))
                }
            };
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
        let axis = &self.sky.sky().axis;
        if self.sky.degrees.blocks == 1 {
            let degrees = self.sky.degrees.at(spots, i, 0);
            return turned(&degrees, turn, i).map(|ratios| axis.mix(wavelengths, &ratios.0));
        }
        let ratios = self.at_nodes(spots, turn, i);
        ratios.map(|ratios| axis.mix(wavelengths, ratios.as_flattened()))
    }

    /// Q/I and U/I at the nodes.
    #[inline(always)]
    fn at_nodes<const W: usize>(
        &self,
        spots: &Spots<W>,
        turn: &FrameRotation<W>,
        i: usize,
    ) -> [[[f32; polarisation_table::LANES]; BLOCKS]; 2] {
        let degrees = &self.sky.degrees;
        let mut ratios = [[[0.0; polarisation_table::LANES]; BLOCKS]; 2];
        for block in 0..degrees.blocks {
            let [q, u] = turned(&degrees.at(spots, i, block), turn, i);
            (ratios[0][block], ratios[1][block]) = (q.0, u.0);
        }
        ratios
    }

    /// Stokes vectors of cells: nodes count by the light that they give.
    #[inline(always)]
    fn of_cells<const W: usize>(
        &self,
        cells: &CellTable,
        group: &Group<LANES, W>,
        turn: &FrameRotation<W>,
        i: usize,
        wavelengths: &[f32; 4],
    ) -> [Stokes; 4] {
        let axis = &self.sky.sky().axis;
        let logarithms = axis.logarithms(group, i);
        let opacity = group.spots.opacity.0[i];
        let light = axis.radiance_of_cells(cells, opacity, wavelengths, &logarithms);
        let ratios = self.at_nodes(group.spots, turn, i);
        let mut sums = [Lanes::splat(0.0); 2];
        for (lane, &wavelength) in wavelengths.iter().enumerate() {
            let mut shares = [0.0; MOST_WAVELENGTHS];
            cells.add_shares(wavelength, &logarithms, &mut shares);
            for (sum, ratios) in sums.iter_mut().zip(&ratios) {
                let terms = shares.iter().zip(ratios.as_flattened());
                sum.0[lane] = terms.map(|(share, ratio)| share * ratio).sum();
            }
        }
        bounded(light, sums)
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
