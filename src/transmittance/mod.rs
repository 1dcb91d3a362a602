//! The air alone: transmittance between any two points. Format specification, section 7.6.

pub(crate) mod buffers;
mod layers;
mod segment;
mod spectral_transmittance;

pub(crate) use layers::{Amounts, Layers, Line, Piece, QUADS};
pub(crate) use segment::{Segment, dot};

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::format::{Head, visibility_node};
use crate::geometry::Planet;
use crate::kernel::axis::{Stencil, linear};
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::kernel::simd::{Instructions, Kernel, dispatch};
use crate::model::Model;
use crate::model::checked_visibility;
use crate::spectrum::SpectralInterpolation;

/// The air at one visibility: transmittance along straight lines, without refraction.
///
/// Points are in metres in a world frame whose origin lies on the ground, with +z up there; the planet's centre is at
/// (0, 0, −R). Nothing blocks the way: the caller has seen what is at its end. Below the ground, at any depth, the air
/// is as dense as at the ground.
///
/// Whatever the file holds, transmittance is 1 over no distance, never grows with distance, is the same in both
/// directions and multiplies along a line, all but for rounding. Queries allocate nothing. `Send + Sync`.
///
/// ```
/// use welkin::Model;
///
/// let model = Model::default_model()?;
/// let air = model.transmittance(40e3)?; // visibility, m
/// let mut transmittance = vec![0.0; air.wavelengths().len()];
/// air.transmittance([0.0, 0.0, 100.0], [20e3, 0.0, 100.0], &mut transmittance)?;
/// // Air takes more of blue light (the first wavelength) than of red.
/// assert!(transmittance[0] < transmittance[11] && transmittance[11] < 1.0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Transmittance {
    pub(crate) layers: Layers,
    pub(crate) extinction: Extinction,
    wavelengths: Vec<f64>,
    /// Nodes of visibility, linear in 1/V.
    visibility: Stencil,
    interpolation: Arc<SpectralInterpolation>,
}

/// Extinction coefficients where a profile is 1, m⁻¹, `[constituent][block of wavelengths]`, with constituents of none
/// up to a full vector.
#[derive(Clone, Debug)]
pub(crate) struct Extinction {
    blocks: usize,
    table: Vec<[f32; LANES]>,
}

impl Extinction {
    pub fn new(head: &Head, visibility: f64) -> Self {
        let nw = head.wavelengths.len();
        let rows = head.constituents * nw;
        let mut row = vec![0.0; rows];
        for (v, weight) in visibility_weights(head, visibility).taps() {
            for (sum, k) in row.iter_mut().zip(&head.extinction[v * rows..]) {
                *sum += weight * k;
            }
        }
        let lane = |block: &[f64], i: usize| block.get(i).map_or(0.0, |&k| k as f32);
        let rows = row.chunks(nw).flat_map(|row| row.chunks(LANES));
        let rows = rows.map(|b| core::array::from_fn(|i| lane(b, i)));
        let blocks = nw.div_ceil(LANES);
        let mut table: Vec<_> = rows.collect();
        table.resize(
            head.constituents.next_multiple_of(LANES) * blocks,
            [0.0; LANES],
        );
        Self { blocks, table }
    }

    /// Extinction coefficients of constituent `k` in a block of wavelengths.
    #[inline(always)]
    pub fn row(&self, k: usize, block: usize) -> &[f32; LANES] {
        &self.table[k * self.blocks + block]
    }

    /// Optical depths of a block of wavelengths.
    #[inline(always)]
    pub fn depth(&self, columns: &Amounts, block: usize) -> [f32; LANES] {
        let mut depth = Lanes::splat(0.0);
        for (k, row) in self.table.chunks_exact(self.blocks).enumerate() {
            depth = depth + Lanes(row[block]) * columns.get(k);
        }
        depth.0
    }
}

/// Nodes of visibility and their weights, linear in 1/V.
pub(crate) fn visibility_weights(head: &Head, visibility: f64) -> Stencil {
    linear(&head.visibility_nodes(), visibility_node(visibility))
}

impl Model {
    /// Prepares the air at a visibility (m).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the visibility; [`Error::MissingChunk`] if the file has no transmittance;
    /// [`Error::Checksum`], [`Error::Encoding`], [`Error::Length`] or [`Error::Invalid`] if that is damaged.
    pub fn transmittance(&self, visibility: f64) -> Result<Transmittance> {
        Transmittance::prepare(self, self.head(), visibility)
    }
}

impl Transmittance {
    /// At the wavelengths of `head`, which is that of the model or of some nodes.
    pub(crate) fn prepare(model: &Model, head: &Head, visibility: f64) -> Result<Self> {
        let visibility = checked_visibility(visibility, model.visibility_range())?;
        Ok(Self {
            layers: Layers::new(&model.density_chunk()?, head.planet, head.constituents),
            extinction: Extinction::new(head, visibility),
            wavelengths: head.wavelengths.clone(),
            visibility: visibility_weights(head, visibility),
            interpolation: model.shared_interpolation()?.clone(),
        })
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// Goes over to another visibility (m) of the same model.
    pub(crate) fn set_visibility(&mut self, head: &Head, visibility: f64) {
        self.extinction = Extinction::new(head, visibility);
        self.visibility = visibility_weights(head, visibility);
    }

    /// What lies between the wavelengths.
    pub(crate) fn interpolation(&self) -> &SpectralInterpolation {
        &self.interpolation
    }

    /// Extinction at a typical wavelength, m⁻¹: the mean over the range, as a polynomial of each layer.
    pub(crate) fn grey(&self) -> Vec<[f32; 3]> {
        let mut out = Amounts::default();
        let shares = shares(&self.wavelengths);
        let rows = self.extinction.table.chunks_exact(self.extinction.blocks);
        for (k, row) in rows.enumerate() {
            let pairs = row.as_flattened().iter().zip(&shares);
            out.0[k / LANES][k % LANES] = pairs.map(|(k, share)| k * share).sum();
        }
        self.layers.weighted(&out)
    }

    /// The planet.
    pub fn planet(&self) -> Planet {
        self.layers.planet()
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        self.layers.bytes()
            + size_of_val(self.extinction.table.as_slice())
            + size_of_val(self.wavelengths.as_slice())
    }

    /// Transmittance between two points at each of [`Transmittance::wavelengths`].
    ///
    /// # Errors
    /// [`Error::Point`] for coordinates that are not finite or beyond 10⁹ m; [`Error::Length`] unless `out` has one
    /// element per wavelength.
    pub fn transmittance(&self, from: [f64; 3], to: [f64; 3], out: &mut [f32]) -> Result<()> {
        self.check_output(out)?;
        let segment = Segment::between(&self.planet(), from, to)?;
        dispatch(Depths::<true> {
            air: self,
            segment: &segment,
            out,
        });
        Ok(())
    }

    /// Optical depth between two points at each of [`Transmittance::wavelengths`].
    ///
    /// # Errors
    /// As [`Transmittance::transmittance`].
    pub fn optical_depth(&self, from: [f64; 3], to: [f64; 3], out: &mut [f32]) -> Result<()> {
        self.check_output(out)?;
        let segment = Segment::between(&self.planet(), from, to)?;
        dispatch(Depths::<false> {
            air: self,
            segment: &segment,
            out,
        });
        Ok(())
    }

    /// Transmittance from a point to space in a direction (need not be normalised); zero where the ground is in the
    /// way, which it is for whatever goes down from the ground or from under it.
    ///
    /// # Errors
    /// As [`Transmittance::transmittance`]; [`Error::Direction`] for a vector that is zero or not finite.
    pub fn transmittance_to_space(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.check_output(out)?;
        let (segment, ground) = Segment::to_end(&self.planet(), from, direction)?;
        if ground {
            out.fill(0.0);
            return Ok(());
        }
        dispatch(Depths::<true> {
            air: self,
            segment: &segment,
            out,
        });
        Ok(())
    }

    /// Transmittance from a point in a direction (need not be normalised) through all of the air, up to the ground
    /// where that is in the way.
    ///
    /// # Errors
    /// As [`Transmittance::transmittance_to_space`].
    pub fn transmittance_to_end(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        out: &mut [f32],
    ) -> Result<()> {
        self.check_output(out)?;
        let (segment, _) = Segment::to_end(&self.planet(), from, direction)?;
        dispatch(Depths::<true> {
            air: self,
            segment: &segment,
            out,
        });
        Ok(())
    }

    fn attenuate(&self, segment: &Segment, out: &mut [f32]) {
        dispatch(Depths::<true> {
            air: self,
            segment,
            out,
        });
    }

    /// Columns on a segment, m.
    #[inline(always)]
    fn columns(&self, segment: &Segment) -> Amounts {
        let (from, to) = (segment.from, segment.to());
        // The same both ways: outwards where it can be, so that branches are alike.
        let (from, to) = match from + to < 0.0 {
            true => (-to, -from),
            false => (from, to),
        };
        self.layers.columns(segment.line, from, to)
    }

    fn check_output(&self, out: &[f32]) -> Result<()> {
        if out.len() == self.wavelengths.len() {
            return Ok(());
        }
        Err(Error::Length {
            what: "output",
            expected: self.wavelengths.len() as u64,
            got: out.len() as u64,
        })
    }
}

/// Optical depths of a segment, or what they leave of light.
struct Depths<'a, const ATTENUATE: bool> {
    air: &'a Transmittance,
    segment: &'a Segment,
    out: &'a mut [f32],
}

impl<const ATTENUATE: bool> Depths<'_, ATTENUATE> {
    #[inline(always)]
    fn block(air: &Transmittance, columns: &Amounts, block: usize) -> [f32; LANES] {
        let depth = air.extinction.depth(columns, block);
        match ATTENUATE {
            true => (-Lanes(depth)).exp().0,
            false => depth,
        }
    }
}

impl<const ATTENUATE: bool> Kernel for Depths<'_, ATTENUATE> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) {
        let air = self.air;
        let columns = air.columns(self.segment);
        let (whole, rest) = self.out.as_chunks_mut();
        for (block, out) in whole.iter_mut().enumerate() {
            *out = Self::block(air, &columns, block);
        }
        if !rest.is_empty() {
            let last = Self::block(air, &columns, whole.len());
            rest.copy_from_slice(&last[..rest.len()]);
        }
    }
}

/// How much of the range each wavelength stands for: models have many where ozone absorbs.
fn shares(wavelengths: &[f64]) -> Vec<f32> {
    let last = wavelengths.len() - 1;
    let range = |from: usize, to: usize| wavelengths[to] - wavelengths[from];
    if range(0, last) == 0.0 {
        return vec![1.0 / wavelengths.len() as f32; wavelengths.len()];
    }
    let share = |i: usize| 0.5 * range(i.saturating_sub(1), (i + 1).min(last)) / range(0, last);
    (0..=last).map(|i| share(i) as f32).collect()
}
