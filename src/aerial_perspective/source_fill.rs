//! Fills nodes of the table of the source at one of its suns.

use super::source_expansion::{Expansion, Quad};
use super::source_table::{SourceTable, sun_coordinate};
use crate::kernel::axis::{Stencil, hermite};
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::kernel::simd::{Instructions, Kernel, dispatch};

/// Four wavelengths of one component, then of another.
type Pair = Lanes<8>;
/// From how many altitudes on it pays to take wavelengths before altitudes.
const MANY: usize = 16;

/// Room for what is on the way from the file to a node.
#[derive(Clone, Default)]
pub(super) struct Scratch {
    /// `[altitude component][moment][channel component]`.
    at_sun: Vec<f32>,
    /// `[moment][channel component]`.
    at_altitude: Vec<f32>,
    /// `[altitude component][block][pair of moments]`.
    expanded: Vec<Pair>,
    /// `[channel component][block]`, twice the same.
    channel: Vec<Pair>,
}

/// Fills nodes of a table at one of its suns.
pub(super) struct Fill<'b, 'a> {
    pub expansion: &'b Expansion<'a>,
    pub visibilities: &'b Stencil,
    /// What light from the ground is multiplied with at each wavelength.
    pub ground: &'b [f64],
    /// The sun node and its sine.
    pub sun: (usize, f64),
    /// Altitude nodes.
    pub altitudes: &'b [usize],
    pub table: &'b mut SourceTable,
    pub scratch: &'b mut Scratch,
}

impl Fill<'_, '_> {
    /// Returns whether all values are finite.
    pub fn run(self) -> bool {
        dispatch(self)
    }

    /// The core of a visibility at the sun.
    #[inline(always)]
    fn contract_sun(&mut self, v: usize, taps: &Stencil) {
        let [ra, _, rm, rc] = self.expansion.basis.ranks;
        let sums = &mut self.scratch.at_sun;
        sums.clear();
        sums.resize(ra * rm * rc, 0.0);
        for (i, weight) in taps.taps() {
            let (weight, row) = (weight as f32, self.expansion.row(v, i));
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += weight * value;
            }
        }
    }

    /// What both fields make of the channels at the sun, in terms of the sky's level and times the share of the
    /// visibility; adds to the level.
    #[inline(always)]
    fn light(&mut self, v: usize, taps: &Stencil, share: f64, level: &mut [f64]) {
        let expansion = self.expansion;
        let source = expansion.source(v);
        let blocks = self.ground.len().div_ceil(LANES);
        let scale = share * f64::from(source.scale);
        let out = &mut self.scratch.channel;
        out.clear();
        out.resize(expansion.basis.ranks[3] * blocks, Pair::splat(0.0));
        for block in 0..blocks {
            let mut ground = Quad::splat(0.0);
            let first = block * LANES;
            let rows = self.ground[first..].iter().zip(&mut level[first..]);
            for (i, (factor, level)) in rows.take(LANES).enumerate() {
                let of = |field| expansion.level(&source, field, taps, first + i);
                let (sky, reflected) = (of(0), of(1));
                *level += share * sky;
                ground.0[i] = (factor * (reflected - sky).exp()) as f32;
            }
            let [sky, reflected] = &expansion.channel;
            for c in (block..out.len()).step_by(blocks) {
                let light = (sky[c] + reflected[c] * ground) * scale as f32;
                out[c] = Pair::join(light.0, light.0);
            }
        }
    }

    /// Adds a visibility to the node at an altitude.
    #[inline(always)]
    fn add(&mut self, altitude: usize) {
        let [ra, _, rm, rc] = self.expansion.basis.ranks;
        let factors = &self.expansion.altitude[altitude * ra..][..ra];
        let moments = &mut self.scratch.at_altitude;
        moments.clear();
        moments.resize(rm * rc, 0.0);
        for (factor, row) in factors
            .iter()
            .zip(self.scratch.at_sun.chunks_exact(rm * rc))
        {
            for (sum, value) in moments.iter_mut().zip(row) {
                *sum += factor * value;
            }
        }
        let blocks = self.ground.len().div_ceil(LANES);
        let node = self.table.node(altitude, self.sun.0);
        add(blocks, (moments, rc), &self.scratch.channel, node);
    }

    /// Adds a visibility to the components of all altitudes.
    #[inline(always)]
    fn expand(&mut self) {
        let [ra, _, rm, rc] = self.expansion.basis.ranks;
        let blocks = self.ground.len().div_ceil(LANES);
        let n = blocks * rm.div_ceil(2);
        let Scratch {
            at_sun,
            channel,
            expanded,
            ..
        } = &mut *self.scratch;
        expanded.resize(ra * n, Pair::splat(0.0));
        let components = at_sun.chunks_exact(rm * rc);
        for (moments, row) in components.zip(expanded.chunks_exact_mut(n)) {
            add(blocks, (moments, rc), channel, row);
        }
    }

    /// The node at an altitude from the components of all.
    #[inline(always)]
    fn sum(&mut self, instructions: impl Instructions, altitude: usize) {
        let ra = self.expansion.basis.ranks[0];
        let factors = &self.expansion.altitude[altitude * ra..][..ra];
        let node = self.table.node(altitude, self.sun.0);
        let (expanded, n) = (&self.scratch.expanded, node.len());
        let (groups, rest) = node.as_chunks_mut::<8>();
        let first = 8 * groups.len();
        for (i, group) in groups.iter_mut().enumerate() {
            *group = weighted(instructions, factors, (&expanded[8 * i..], n));
        }
        for (i, value) in rest.iter_mut().enumerate() {
            [*value] = weighted(instructions, factors, (&expanded[first + i..], n));
        }
    }
}

/// Sums of `N` neighbours in rows of length `n`.
#[inline(always)]
fn weighted<const N: usize>(
    instructions: impl Instructions,
    factors: &[f32],
    (rows, n): (&[Pair], usize),
) -> [Pair; N] {
    let mut sums = [Pair::splat(0.0); N];
    for (factor, row) in factors.iter().zip(rows.chunks(n)) {
        let row = &row[..N];
        for (sum, value) in sums.iter_mut().zip(row) {
            *sum = instructions.add_product(*sum, *value, *factor);
        }
    }
    sums
}

/// Adds moments (`[moment][channel component]`) times channels to a node, `[block][pair of moments]`.
#[inline(always)]
fn add(blocks: usize, moments: (&[f32], usize), channel: &[Pair], node: &mut [Pair]) {
    let mut block = 0;
    while block + 3 <= blocks {
        add_blocks::<3>((block, blocks), moments, channel, node);
        block += 3;
    }
    while block < blocks {
        add_blocks::<1>((block, blocks), moments, channel, node);
        block += 1;
    }
}

/// [`add`] for `N` blocks.
#[inline(always)]
fn add_blocks<const N: usize>(
    (first, blocks): (usize, usize),
    (moments, rc): (&[f32], usize),
    channel: &[Pair],
    node: &mut [Pair],
) {
    let pairs = node.len() / blocks;
    for (pair, moments) in moments.chunks(2 * rc).enumerate() {
        let (even, odd) = moments.split_at(rc);
        let mut sums: [Pair; N] = core::array::from_fn(|i| node[(first + i) * pairs + pair]);
        for (c, row) in channel.chunks_exact(blocks).enumerate() {
            // The last of an odd number of moments stands alone.
            let value = Pair::pair(even[c], odd.get(c).copied().unwrap_or(0.0));
            let row = &row[first..][..N];
            for (sum, row) in sums.iter_mut().zip(row) {
                *sum = *sum + *row * value;
            }
        }
        for (i, sum) in sums.into_iter().enumerate() {
            node[(first + i) * pairs + pair] = sum;
        }
    }
}

impl Kernel for Fill<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<I: Instructions>(mut self, instructions: I) -> bool {
        let (sun, sine) = self.sun;
        let taps = hermite(&self.expansion.suns, sun_coordinate(sine));
        let many = self.altitudes.len() > MANY;
        if !many {
            for &altitude in self.altitudes {
                self.table.node(altitude, sun).fill(Lanes::splat(0.0));
            }
        }
        self.scratch.expanded.clear();
        let mut level = [0.0; crate::sky::MOST_WAVELENGTHS];
        for (v, share) in self.visibilities.taps() {
            self.contract_sun(v, &taps);
            self.light(v, &taps, share, &mut level);
            match many {
                true => self.expand(),
                false => self.altitudes.iter().for_each(|&a| self.add(a)),
            }
        }
        if many {
            self.altitudes
                .iter()
                .for_each(|&a| self.sum(instructions, a));
        }
        let mut finite = true;
        for (row, level) in self
            .table
            .level(sun)
            .iter_mut()
            .zip(level.chunks_exact(LANES))
        {
            *row = core::array::from_fn(|i| level[i] as f32);
            finite &= row.iter().all(|v| v.is_finite());
        }
        for &altitude in self.altitudes {
            let node = self.table.node(altitude, sun);
            finite &= node.iter().all(|v| v.0.iter().all(|v| v.is_finite()));
        }
        finite
    }
}
