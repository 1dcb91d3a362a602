//! Surfaces through the nodes of one side of the horizon, and how far they are off between them: the one loop for all
//! that is baked.

use super::comparison_sites::{Site, WIDTH};
use super::grid_choice::{Errors, Refinable};
use super::grid_nodes::Known;
use super::hemisphere_spline::Surface;
use super::spline_size::Size;
use super::spline_table::Spots;
use crate::kernel::lanes::Lanes;
use crate::kernel::simd::{Instructions, Kernel, dispatch};

/// What is baked on one side of the horizon. All methods that are asked in loops must be `#[inline(always)]`.
pub(super) trait Half<const N: usize> {
    /// Channels of a block.
    const CHANNELS: usize = N;

    /// Channels in all blocks that exist.
    fn channels(&self) -> usize;
    fn sites(&self) -> &[Site];
    /// What surfaces are compared with, `[site][direction][block]`.
    fn truth(&self) -> &[Lanes<N>];
    fn known(&mut self) -> &mut Known<N>;
    /// Values in the row at a height 0..=1: `[azimuth][block]`.
    fn row(&self, height: f64, azimuths: &[f64]) -> Vec<Lanes<N>>;
    /// What the surface is added to, for direction `i`.
    fn base<const W: usize>(&self, spots: &Spots<W>, i: usize, block: usize) -> Lanes<N>;
    /// Notes how far the first `count` channels are from the truth for direction `i` and a block.
    fn compare(
        &self,
        at: (&Site, &Spots<WIDTH>, usize, usize),
        sum: Lanes<N>,
        truth: &Lanes<N>,
        count: usize,
        errors: &mut Errors,
    );
}

impl<const N: usize, H: Half<N>> Refinable<N> for H {
    fn surface(&mut self, size: Size) -> Surface<N> {
        let blocks = self.channels().div_ceil(Self::CHANNELS);
        let mut known = core::mem::replace(self.known(), Known::new(blocks));
        let half = &*self;
        let surface = dispatch(Nodes {
            half,
            size,
            known: &mut known,
        });
        *self.known() = known;
        surface
    }

    fn errors(&self, surface: &Surface<N>) -> Errors {
        dispatch(Compare {
            half: self,
            surface,
        })
    }
}

/// Values at the nodes of a size.
struct Nodes<'a, H, const N: usize> {
    half: &'a H,
    size: Size,
    known: &'a mut Known<N>,
}

impl<const N: usize, H: Half<N>> Kernel for Nodes<'_, H, N> {
    type Output = Surface<N>;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Surface<N> {
        let row = |height: f64, azimuths: &[f64]| self.half.row(height, azimuths);
        self.known.surface(self.size, row)
    }
}

struct Compare<'a, H, const N: usize> {
    half: &'a H,
    surface: &'a Surface<N>,
}

impl<const N: usize, H: Half<N>> Kernel for Compare<'_, H, N> {
    type Output = Errors;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Errors {
        let (half, size) = (self.half, self.surface.size);
        let channels = half.channels();
        let blocks = channels.div_ceil(H::CHANNELS);
        let mut errors = Errors::with_capacity(half.sites().len() * WIDTH * channels);
        for (site, truth) in half.sites().iter().zip(half.truth().chunks(WIDTH * blocks)) {
            let spots = Spots::on_side(&site.points, size);
            for (i, truth) in truth.chunks(blocks).enumerate() {
                for (block, truth) in truth.iter().enumerate() {
                    let base = half.base(&spots, i, block);
                    let first = block * size.cells();
                    let sum = spots.bicubic(base, first, size.stride(), &self.surface.cells, i);
                    let count = channels.min((block + 1) * H::CHANNELS) - block * H::CHANNELS;
                    half.compare((site, &spots, i, block), sum, truth, count, &mut errors);
                }
            }
        }
        errors.sorted()
    }
}
