//! A baked sky with its polarisation.

use core::ops::Range;

use super::baked_spectral::{BakedSky, LANES, write};
use super::batch::{Directions, Group, Sink};
use super::frame_rotation::Axes;
use super::grid_choice::BakeError;
use super::over_ground::OverGround;
use super::polarisation_table::{self, PolarisationTable, turned};
use crate::bands::Projection;
use crate::error::Result;
use crate::kernel::lanes::Lanes;
use crate::polarisation::{PolarisationFrame, PolarisedSky, StokesSpectra};

/// A [`BakedSky`] with its polarisation: as fast a way to all Stokes vectors of a direction.
///
/// Single queries, batches, wide and narrow vectors give the same bits, and the radiance is that of
/// [`BakedPolarisedSky::sky`]. Q² + U² ≤ I². Nothing allocates. `Send + Sync`.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model, PolarisationFrame, StokesSpectra};
///
/// let sky = Model::default_model()?.polarised_sky(&Conditions::default())?;
/// let baked = sky.bake(BakedSky::TOLERANCE)?;
/// let n = sky.sky().wavelengths().len();
/// let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
/// let out = StokesSpectra { i: &mut i, q: &mut q, u: &mut u };
/// baked.stokes([-0.4, 0.0, 0.9], PolarisationFrame::SunAligned, out)?;
/// // Across from the sun light is polarised strongly, perpendicular to the plane of view and sun.
/// assert!(q[n / 2] > 0.3 * i[n / 2] && u[n / 2].abs() < 0.01 * i[n / 2]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BakedPolarisedSky {
    sky: BakedSky,
    pub(super) degrees: PolarisationTable,
    error: BakeError,
    /// Over the other ground, where the albedo depends on wavelength.
    second: Option<Box<BakedPolarisedSky>>,
}

impl PolarisedSky {
    /// Bakes the sky into tables whose errors are at most `tolerance` at 95 % of the directions and wavelengths, e.g.
    /// [`BakedSky::TOLERANCE`]: that of the radiance, relative to it, and that of (Q, U), relative to the radiance, too.
    ///
    /// # Errors
    /// As [`Sky::bake`](crate::Sky::bake).
    pub fn bake(&self, tolerance: f64) -> Result<BakedPolarisedSky> {
        let mut baked = BakedPolarisedSky::of(self.sky().bake(tolerance)?, self, None, tolerance)?;
        if let Some(second) = self.second() {
            baked.second = Some(Box::new(second.bake(tolerance)?));
        }
        Ok(baked)
    }
}

impl BakedPolarisedSky {
    /// From its radiance, which may be in bands.
    pub(super) fn of(
        mut radiance: BakedSky,
        sky: &PolarisedSky,
        bands: Option<&Projection>,
        tolerance: f64,
    ) -> Result<Self> {
        let (grid, frame) = (radiance.baked.table.grid, radiance.frame());
        let (degrees, error) = PolarisationTable::new(sky, bands, grid, frame, tolerance)?;
        radiance.baked.table.refine(degrees.grid());
        Ok(Self {
            sky: radiance,
            degrees,
            error,
            second: None,
        })
    }

    /// What light over the ground of a wavelength is made of, where the albedo depends on that.
    pub(super) fn over(&self) -> Option<(&OverGround, &Self)> {
        let over = self.sky.over.as_deref();
        over.zip(self.second.as_deref())
    }

    /// The sky without its polarisation.
    pub fn sky(&self) -> &BakedSky {
        &self.sky
    }

    /// As [`Sky::set_solar_azimuth`](crate::Sky::set_solar_azimuth).
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)?;
        match &mut self.second {
            Some(second) => second.set_solar_azimuth(azimuth),
            None => Ok(()),
        }
    }

    /// What baking added to the error of (Q, U) over I, as a distance: directions as in [`BakedSky::bake_error`], which
    /// is that of I.
    pub fn polarisation_error(&self) -> BakeError {
        self.error
    }

    /// Memory on the heap, bytes: less than three times that of [`BakedPolarisedSky::sky`].
    pub fn bytes(&self) -> usize {
        let second = self.second.as_ref().map_or(0, |second| second.bytes());
        self.sky.bytes() + self.degrees.bytes() + second
    }

    /// Stokes vectors at each of [`BakedSky::wavelengths`], as [`PolarisedSky::stokes`].
    ///
    /// # Errors
    /// [`crate::Error::Direction`] for a direction or an axis that is zero or not finite;
    /// [`crate::Error::Length`] unless the outputs have one element per wavelength.
    #[inline]
    pub fn stokes(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: StokesSpectra,
    ) -> Result<()> {
        let sink = self.sink(frame, out, 1)?;
        self.sky.baked.one(direction, sink)
    }

    /// [`BakedPolarisedSky::stokes`] for many directions.
    ///
    /// # Errors
    /// As [`BakedPolarisedSky::stokes`]; [`crate::Error::Length`] also for components of different lengths.
    /// What precedes a bad direction may or may not be written.
    pub fn stokes_batch(
        &self,
        directions: &Directions,
        frame: PolarisationFrame,
        out: StokesSpectra,
    ) -> Result<()> {
        directions.check()?;
        let sink = self.sink(frame, out, directions.len())?;
        self.sky.baked.each(directions, sink)
    }

    #[inline]
    fn sink<'a>(
        &'a self,
        frame: PolarisationFrame,
        out: StokesSpectra<'a>,
        directions: usize,
    ) -> Result<Rows<'a>> {
        out.check(directions.saturating_mul(self.sky.wavelengths().len()))?;
        let axes = Axes::new(frame)?;
        let sky = self;
        Ok(Rows { sky, axes, out })
    }
}

/// Stokes vectors one after another.
struct Rows<'a> {
    sky: &'a BakedPolarisedSky,
    axes: Axes,
    out: StokesSpectra<'a>,
}

impl Sink<LANES> for Rows<'_> {
    #[inline(always)]
    fn put<const W: usize>(&mut self, group: &Group<LANES, W>) {
        let BakedPolarisedSky { sky, degrees, .. } = self.sky;
        let (first, count, n) = (group.first, group.count, sky.wavelengths().len());
        let turn = self.axes.turn(sky.frame(), group.vectors);
        for i in 0..count {
            let row = &mut self.out.i[(first + i) * n..][..n];
            for block in 0..group.table.blocks() {
                write(row, block, sky.light(group, i, block));
            }
        }
        for block in 0..degrees.blocks {
            // All directions up to here before any is turned: otherwise the compiler makes half vectors of the sums,
            // too.
            let mut values = [Lanes::splat(0.0); W];
            for (i, values) in values[..count].iter_mut().enumerate() {
                *values = degrees.at(group.spots, i, block);
            }
            let mut most = Lanes::splat(0.0);
            for (i, values) in values[..count].iter().enumerate() {
                let row = (first + i) * n;
                let span = row + block * polarisation_table::LANES..row + n;
                let light = &self.out.i[span.clone()];
                let [q, u] = turned(values, &turn, i);
                most = (q * q + u * u).max(most);
                multiply(&mut self.out.q[span.clone()], light, &q);
                multiply(&mut self.out.u[span], light, &u);
            }
            if most.0.iter().any(|&square| square > ALMOST_WHOLE) {
                self.out.limit(first * n..(first + count) * n);
            }
        }
    }
}

/// Squared degree that may exceed 1 when rounding has had its share.
pub(super) const ALMOST_WHOLE: f32 = 1.0 - 16.0 * f32::EPSILON;

impl StokesSpectra<'_> {
    /// Where splines overshoot, back to the whole light. That is rare.
    #[cold]
    fn limit(&mut self, span: Range<usize>) {
        let parts = self.q[span.clone()]
            .iter_mut()
            .zip(&mut self.u[span.clone()]);
        for (&i, (q, u)) in self.i[span].iter().zip(parts) {
            // What is bounded does not overflow when it is squared in double precision.
            let [bounded_q, bounded_u] = [*q, *u].map(|v| f64::from(v.max(-i).min(i)));
            let most = f64::from(i) * f64::from(ALMOST_WHOLE);
            let share = (most / bounded_q.hypot(bounded_u).max(f64::MIN_POSITIVE)).min(1.0);
            *q = (bounded_q * share) as f32;
            *u = (bounded_u * share) as f32;
        }
    }
}

/// Writes a part of the light at up to a block of wavelengths.
#[inline(always)]
fn multiply(out: &mut [f32], light: &[f32], share: &Lanes<{ polarisation_table::LANES }>) {
    match (out.first_chunk_mut(), light.first_chunk()) {
        (Some(out), Some(light)) => *out = (Lanes(*light) * *share).0,
        _ => {
            let rest = out.iter_mut().zip(light.iter().zip(&share.0));
            rest.for_each(|(out, (light, share))| *out = light * share);
        }
    }
}
