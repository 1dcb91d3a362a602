//! A baked sky with all wavelengths.

use super::baked_tables::Baked;
use super::batch::{Directions, Group, Sink, alone, check_length};
use super::coordinates::LocalFrame;
use super::fill::Channels;
use super::grid_choice::{BakeError, PEAK, TAIL};
use super::hero_wavelengths::{Heroes, WavelengthAxis};
use super::over_ground::OverGround;
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::Head;
use crate::kernel::lanes::Lanes;
use crate::sky::Sky;

/// Wavelengths that are computed together.
pub(super) const LANES: usize = 16;

/// A sky as tables of about 50 kB per 16 wavelengths: many times faster than the [`Sky`] it was made from, with a
/// stated additional error. Radiance is continuous except at the geometric horizon.
///
/// Single queries, batches, wide and narrow vectors give the same bits. Nothing allocates. `Send + Sync`.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.sky(&Conditions::default())?;
/// let baked = sky.bake(BakedSky::TOLERANCE)?;
/// let direction = [0.3, 0.1, 0.9];
/// let [mut fast, mut exact] = [(); 2].map(|()| vec![0.0; sky.wavelengths().len()]);
/// baked.radiance(direction, &mut fast)?;
/// sky.radiance(direction, &mut exact)?;
/// assert!((fast[3] / exact[3] - 1.0).abs() < 0.01);
/// // Hero wavelengths: four of a path's own, nm.
/// let hero = baked.hero(direction, [400.0, 480.0, 550.0, 700.0])?;
/// assert!(hero[1] > hero[3]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BakedSky {
    pub(super) baked: Baked<LANES>,
    wavelengths: Vec<f64>,
    /// Solar irradiance at the wavelengths, padded.
    pub(super) irradiance: Vec<Lanes<LANES>>,
    pub(super) axis: WavelengthAxis,
    pub(super) over: Option<Box<OverGround>>,
}

struct Spectrum {
    wavelengths: usize,
}

impl Channels<LANES> for Spectrum {
    fn blocks(&self) -> usize {
        self.wavelengths.div_ceil(LANES)
    }

    fn count(&self) -> usize {
        self.wavelengths
    }

    #[inline(always)]
    fn project(&self, radiance: &[f32], mut emit: impl FnMut(usize, Lanes<LANES>)) {
        for (block, radiance) in radiance.chunks(LANES).enumerate() {
            let lane = |i: usize| radiance.get(i).copied().unwrap_or(1.0);
            emit(block, Lanes(core::array::from_fn(lane)));
        }
    }
}

/// Most bytes besides the tables.
pub(super) fn axis_bytes(head: &Head) -> usize {
    let n = head.wavelengths.len();
    let blocks = n.div_ceil(LANES) * LANES * size_of::<f32>();
    8 * n + 2 * blocks + n * size_of::<[f32; 20]>() + size_of_val(head.solar_irradiance.as_slice())
}

impl Sky {
    /// Bakes the sky into tables that add a relative error of at most `tolerance`, e.g. [`BakedSky::TOLERANCE`], at 95
    /// % of the directions and wavelengths above the horizon, and at 95 % below it; and of at most [`BakedSky::TAIL`]
    /// times as much at 99.9 %, and [`BakedSky::PEAK`] times as much where it is largest of some 660 compared
    /// directions. (The largest table keeps the first and may miss the other two: at dusk in the stratosphere.)
    ///
    /// What is baked is continuous in the conditions, as the sky is: sizes of tables go over into each other, and no
    /// small step of the sun or the observer makes a picture jump.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a tolerance below 3e-4, [`Error::Tolerance`] if the largest table misses it.
    pub fn bake(&self, tolerance: f64) -> Result<BakedSky> {
        let wavelengths = self.wavelengths().len();
        let bake = |sky: &Sky| Baked::new(sky, &Spectrum { wavelengths }, tolerance);
        Ok(BakedSky {
            baked: bake(self)?,
            wavelengths: self.wavelengths().to_vec(),
            irradiance: self.irradiance().map(Lanes).collect(),
            axis: WavelengthAxis::new(self),
            over: OverGround::new(self, bake)?.map(Box::new),
        })
    }
}

impl BakedSky {
    /// What `channels` make of a sky: its values are theirs, without sunlight and without wavelengths.
    pub(super) fn relative(
        sky: &Sky,
        channels: &impl Channels<LANES>,
        count: usize,
        tolerance: f64,
    ) -> Result<Self> {
        Ok(Self {
            baked: Baked::new(sky, channels, tolerance)?,
            wavelengths: vec![0.0; count],
            irradiance: vec![Lanes::splat(1.0); count.div_ceil(LANES)],
            axis: WavelengthAxis::none(),
            over: None,
        })
    }

    /// A tolerance that is small against the error of the model itself.
    pub const TOLERANCE: f64 = 2.5e-3;

    /// What the 99.9th percentile of the error that baking adds may be of the tolerance.
    pub const TAIL: f64 = TAIL;

    /// What the largest error at the compared directions may be of the tolerance.
    pub const PEAK: f64 = PEAK;

    /// The conditions that the sky was prepared for.
    pub fn conditions(&self) -> &Conditions {
        &self.baked.conditions
    }

    /// As [`Sky::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.baked.set_solar_azimuth(azimuth)?;
        match &mut self.over {
            Some(over) => over.set_solar_azimuth(azimuth),
            None => Ok(()),
        }
    }

    /// Wavelengths of [`BakedSky::radiance`], nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// What baking added to the error of the sky.
    pub fn bake_error(&self) -> BakeError {
        self.baked.error
    }

    pub(super) fn frame(&self) -> &LocalFrame {
        &self.baked.frame
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        self.baked.table.bytes()
            + size_of_val(self.wavelengths.as_slice())
            + size_of_val(self.irradiance.as_slice())
            + self.axis.bytes()
            + self.over.as_ref().map_or(0, |over| over.bytes())
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at each of [`BakedSky::wavelengths`].
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite; [`Error::Length`] unless `out` has one element
    /// per wavelength.
    #[inline]
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length("output", out.len(), self.wavelengths.len())?;
        self.baked.one(direction, Rows { sky: self, out })
    }

    /// [`BakedSky::radiance`] for many directions; `out` is `[directions][wavelengths]`.
    ///
    /// # Errors
    /// As [`BakedSky::radiance`]; [`Error::Length`] also for components of different lengths. What precedes a bad
    /// direction may or may not be written.
    pub fn radiance_batch(&self, directions: &Directions, out: &mut [f32]) -> Result<()> {
        directions.check()?;
        let n = self.wavelengths.len();
        check_length("output", out.len(), directions.len().saturating_mul(n))?;
        self.baked.each(directions, Rows { sky: self, out })
    }
}

impl BakedSky {
    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at four wavelengths (nm) within the range of the model, as
    /// [`Sky::radiance_at`].
    ///
    /// # Errors
    /// [`Error::Direction`], [`Error::OutOfRange`] for a wavelength.
    #[inline]
    pub fn hero(&self, direction: [f32; 3], wavelengths: [f32; 4]) -> Result<[f32; 4]> {
        self.check_wavelengths(&[wavelengths])?;
        let mut out = [[0.0; 4]];
        if let Some(over) = &self.over {
            over.heroes(&self.baked, &alone(&direction), &[wavelengths], &mut out)?;
            return Ok(out[0]);
        }
        self.baked.one(
            direction,
            Heroes {
                axis: &self.axis,
                wavelengths: &[wavelengths],
                out: &mut out,
            },
        )?;
        Ok(out[0])
    }

    /// [`BakedSky::hero`] for many directions with wavelengths of their own.
    ///
    /// # Errors
    /// As [`BakedSky::hero`]; [`Error::Length`] unless there are as many components, wavelengths and results.
    pub fn hero_batch(
        &self,
        directions: &Directions,
        wavelengths: &[[f32; 4]],
        out: &mut [[f32; 4]],
    ) -> Result<()> {
        self.check_heroes(directions, wavelengths, out.len())?;
        if let Some(over) = &self.over {
            return over.heroes(&self.baked, directions, wavelengths, out);
        }
        self.baked.each(
            directions,
            Heroes {
                axis: &self.axis,
                wavelengths,
                out,
            },
        )
    }

    /// Checks what batches of heroes take.
    pub(super) fn check_heroes(
        &self,
        directions: &Directions,
        wavelengths: &[[f32; 4]],
        results: usize,
    ) -> Result<()> {
        directions.check()?;
        check_length("wavelengths", wavelengths.len(), directions.len())?;
        check_length("output", results, directions.len())?;
        self.check_wavelengths(wavelengths)
    }

    pub(super) fn check_wavelengths(&self, wavelengths: &[[f32; 4]]) -> Result<()> {
        let [min, max] = self.axis.range();
        let outside = |l: &&f32| !(min..=max).contains(*l);
        match wavelengths.as_flattened().iter().find(outside) {
            None => Ok(()),
            Some(&value) => Err(Error::OutOfRange {
                parameter: "wavelength",
                value: f64::from(value),
                min: f64::from(min),
                max: f64::from(max),
                unit: "nm",
            }),
        }
    }

    /// Spectral radiance of a block for direction `i`.
    #[inline(always)]
    pub(super) fn light<const W: usize>(
        &self,
        group: &Group<LANES, W>,
        i: usize,
        block: usize,
    ) -> Lanes<LANES> {
        let value = group.table.value(group.spots, i, block) * self.irradiance[block];
        value.min(Lanes::splat(f32::MAX))
    }
}

/// Writes a block of wavelengths.
#[inline(always)]
pub(super) fn write(row: &mut [f32], block: usize, values: Lanes<LANES>) {
    // In quarters, so that the last block needs no copy of a variable length.
    let quarters = row[block * LANES..].chunks_mut(4);
    for (out, value) in quarters.zip(values.0.as_chunks::<4>().0) {
        match out.first_chunk_mut() {
            Some(whole) => *whole = *value,
            None => out.iter_mut().zip(value).for_each(|(out, v)| *out = *v),
        }
    }
}

/// Spectra one after another.
struct Rows<'a> {
    sky: &'a BakedSky,
    out: &'a mut [f32],
}

impl Sink<LANES> for Rows<'_> {
    #[inline(always)]
    fn put<const W: usize>(&mut self, group: &Group<LANES, W>) {
        let n = self.sky.wavelengths.len();
        for i in 0..group.count {
            let row = &mut self.out[(group.first + i) * n..][..n];
            for block in 0..self.sky.irradiance.len() {
                write(row, block, self.sky.light(group, i, block));
            }
        }
    }
}
