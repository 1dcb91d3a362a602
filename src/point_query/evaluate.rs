//! One point query after another: which chunks it needs, and what they add up to.

use zerocopy::little_endian::U16;

use super::capacity::{MOST_CONSTITUENTS, WAVELENGTH_BLOCKS};
use super::contraction::{self, MOST_CHANNELS, MOST_RANK, WIDTH};
use super::opened::PointQuery;
use super::query_coordinates::{QueryCoordinates, Question};
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::estimate::Blocks;
use crate::format::{ColumnView, FactorsView};
use crate::geometry::Side;
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel, dispatch};

/// Most chunks around a query, and most altitudes.
const MOST_AROUND: usize = 16;
const MOST_ALTITUDES: usize = 4;
/// Chunks between asking for one and using it.
const AHEAD: usize = 6;

/// A single query.
pub(super) struct One<'a, 'b> {
    pub model: &'b PointQuery<'a>,
    pub conditions: &'b Conditions,
    pub direction: [f32; 3],
    pub out: &'b mut [f32],
}

impl Kernel for One<'_, '_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<I: Instructions>(self, instructions: I) -> Result<()> {
        let model = self.model;
        let question = Question::new(&model.head, self.conditions, self.direction)?;
        let place = model.coordinates(&question);
        Query::around(model, &place)?.answer(instructions, self.out)
    }
}

/// Where a query stands, and the chunks around it.
pub(super) struct Query<'a, 'b> {
    model: &'b PointQuery<'a>,
    place: &'b QueryCoordinates,
    columns: [Option<(&'b ColumnView<'a>, f32)>; MOST_ALTITUDES],
    chunks: [Option<(&'b FactorsView<'a>, f32)>; MOST_AROUND],
}

impl<'a, 'b> Query<'a, 'b> {
    /// Finds the chunks around a place.
    #[inline(always)]
    pub fn around(model: &'b PointQuery<'a>, place: &'b QueryCoordinates) -> Result<Self> {
        let mut query = Query {
            model,
            place,
            columns: [None; MOST_ALTITUDES],
            chunks: [None; MOST_AROUND],
        };
        query.look_around()?;
        Ok(query)
    }

    #[inline(always)]
    fn look_around(&mut self) -> Result<()> {
        let Self { model, place, .. } = *self;
        let mut slots = self.chunks.iter_mut();
        let estimated = model.estimate.is_some();
        for (slot, (a, weight)) in self
            .columns
            .iter_mut()
            .zip(place.altitudes.cubic.taps().filter(|_| !estimated))
        {
            let column = model.chunks.column(a);
            let column = column.ok_or_else(|| model.missing("column", Some(a), None))?;
            *slot = Some((column, weight as f32));
        }
        for (a, over_altitude) in place.altitudes.taps() {
            for (v, over_visibility) in place.visibilities.taps() {
                let chunk = model.chunks.radiance(a, v);
                let chunk = chunk.ok_or_else(|| model.missing("radiance", Some(a), Some(v)))?;
                if let Some(slot) = slots.next() {
                    *slot = Some((chunk, (over_altitude * over_visibility) as f32));
                }
            }
        }
        Ok(())
    }

    /// Asks for the numbers of chunk `i`.
    #[inline(always)]
    fn fetch<I: Instructions>(&self, instructions: I, i: usize) {
        let Some((chunk, _)) = self.chunks.get(i).copied().flatten() else {
            return;
        };
        let (rows, n) = (self.heights(chunk), self.model.head.shape.wavelengths);
        contraction::fetch_chunk(instructions, chunk, rows, &self.place.curve);
        if !chunk.level.is_empty() {
            contraction::fetch_level(instructions, chunk, n, &self.place.curve[1]);
        }
    }

    #[inline(always)]
    fn answer<I: Instructions>(&self, instructions: I, out: &mut [f32]) -> Result<()> {
        let Self { model, place, .. } = self;
        let mut channels = [0.0; MOST_CHANNELS];
        let level = self.sum(instructions, &mut channels)?;
        let (densities, estimates) = (self.densities(), self.estimates(instructions));
        let relative = (&densities, estimates.as_ref());
        model.light.mix(place, &channels, &level, relative, out);
        Ok(())
    }

    /// Sums the chunks in each channel, asking for each a few ahead of its turn; returns ln S.
    #[inline(always)]
    pub fn sum<I: Instructions>(
        &self,
        instructions: I,
        channels: &mut contraction::Channels,
    ) -> Result<contraction::Spectrum> {
        let Self { model, place, .. } = self;
        let basis = model.chunks.basis();
        let basis = basis.ok_or_else(|| model.missing("radiance basis", None, None))?;
        let wavelengths = model.head.shape.wavelengths;
        let mut components = [Lanes::splat(0.0); MOST_RANK / WIDTH];
        let mut level = [Lanes::splat(0.0); 4 * WAVELENGTH_BLOCKS];
        for i in 0..AHEAD {
            self.fetch(instructions, i);
        }
        for i in 0..MOST_AROUND {
            self.fetch(instructions, i + AHEAD);
            let Some((chunk, weight)) = self.chunks[i] else {
                continue;
            };
            let rows = self.heights(chunk);
            let sum = &mut components;
            contraction::add_chunk(instructions, chunk, rows, &place.curve, weight, sum);
            let sun = &place.curve[1];
            if !chunk.level.is_empty() {
                contraction::add_level(instructions, chunk, wavelengths, sun, weight, &mut level);
            }
        }
        place.turn(instructions, basis, &mut components);
        contraction::project(instructions, basis, &components, channels);
        Ok(contraction::level(&level, wavelengths, &place.curve[1]))
    }

    /// The factor matrix on the ray's side of the horizon.
    #[inline(always)]
    fn heights(&self, chunk: &FactorsView<'a>) -> &'a [U16] {
        match self.place.ray.side {
            Side::Up => chunk.alpha_up,
            Side::Down => chunk.alpha_down,
        }
    }

    /// What the fields are relative to, if the file says.
    #[inline(always)]
    pub fn estimates<I: Instructions>(&self, instructions: I) -> Option<Blocks> {
        let Self { model, place, .. } = self;
        let tables = model.estimate.as_ref()?;
        Some(model.light.estimates(instructions, tables, place))
    }

    /// ln n̄ of each constituent.
    #[inline(always)]
    pub fn densities(&self) -> [f32; MOST_CONSTITUENTS] {
        let shape = &self.model.head.shape;
        let n = shape.constituents;
        let skipped = match self.place.ray.side {
            Side::Up => 0,
            Side::Down => shape.up,
        };
        let alpha = &self.place.curve[0];
        let mut rows = [0.0; 4 * MOST_CONSTITUENTS];
        for (column, weight) in self.columns.iter().flatten() {
            let values = &column.values[(skipped + alpha.index[0]) * n..][..4 * n];
            for (sum, value) in rows.iter_mut().zip(values) {
                *sum += weight * value.get();
            }
        }
        let mut densities = [0.0; MOST_CONSTITUENTS];
        for (row, tap) in rows.chunks_exact(n).zip(alpha.weight) {
            for (sum, value) in densities.iter_mut().zip(row) {
                *sum += tap * value;
            }
        }
        densities
    }
}

impl PointQuery<'_> {
    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ at each of [`PointQuery::wavelengths`]; frame and meaning as of
    /// [`Sky`](crate::Sky).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model, [`Error::Direction`] for a vector that is zero or not
    /// finite, [`Error::Length`] unless `out` has one element per wavelength, [`Error::MissingChunk`].
    pub fn radiance(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.relative_radiance(conditions, direction, out)?;
        for (out, irradiance) in out.iter_mut().zip(&self.irradiance) {
            *out = (*out * irradiance).min(f32::MAX);
        }
        Ok(())
    }

    /// Radiance per unit of solar spectral irradiance, sr⁻¹.
    ///
    /// # Errors
    /// As [`PointQuery::radiance`].
    pub fn relative_radiance(
        &self,
        conditions: &Conditions,
        direction: [f32; 3],
        out: &mut [f32],
    ) -> Result<()> {
        if out.len() != self.head.shape.wavelengths {
            return Err(Error::Length {
                what: "output",
                expected: self.head.shape.wavelengths as u64,
                got: out.len() as u64,
            });
        }
        dispatch(One {
            model: self,
            conditions,
            direction,
            out,
        })
    }

    #[cold]
    pub(super) fn missing(
        &self,
        kind: &'static str,
        altitude: Option<usize>,
        visibility: Option<usize>,
    ) -> Error {
        Error::MissingChunk {
            kind,
            altitude: altitude.map(|a| self.head.altitudes[a].get()),
            visibility: visibility.map(|v| self.head.visibilities[v].get()),
        }
    }
}
