//! The source at single nodes of its table: what queries need that share no conditions. Format specification, section
//! 7.7.
//!
//! The table of a scene contracts the core of each visibility at every sun and every altitude. Here the core is
//! contracted once at the sun nodes of the file, so that a node of a table is a short sum, whatever the conditions are.

use std::sync::OnceLock;

use super::source_table::{SourceTable, refine, sun_coordinate};
use crate::error::Result;
use crate::format::{SOURCE_FIELDS, SourceBasisView, SourceView, altitude_node};
use crate::kernel::axis::{Stencil, hermite};
use crate::kernel::half::widen;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::kernel::simd::{Instructions, Kernel, dispatch};
use crate::model::Model;

type Quad = Lanes<LANES>;

/// What all conditions share.
pub(super) struct Expansion<'a> {
    pub basis: SourceBasisView<'a>,
    /// Of all visibilities.
    pub sources: Vec<SourceView<'a>>,
    wavelengths: usize,
    /// Coordinates of the sun nodes of the file.
    suns: Vec<f64>,
    /// Factors of the altitudes of a table, `[altitude][component]`.
    altitude: Vec<f32>,
    /// Factors of the channels, `[component][block]`.
    channel: [Vec<Quad>; SOURCE_FIELDS],
    /// Cores at the sun nodes of the file, `[visibility][sun]` of `[altitude component][moment][channel]`; computed
    /// when they are first needed.
    rows: Vec<OnceLock<Box<[f32]>>>,
}

impl<'a> Expansion<'a> {
    pub fn new(model: &'a Model) -> Result<Self> {
        let head = model.head();
        let basis = model.source_basis_chunk()?;
        let sources = (0..head.visibilities.len())
            .map(|v| model.source_chunk(v))
            .collect::<Result<Vec<_>>>()?;
        for source in &sources {
            source.check_with(&basis, &sources[0])?;
        }
        let altitudes: Vec<f64> = (basis.altitude.iter())
            .map(|h| altitude_node(h.get()))
            .collect();
        let rank = basis.ranks[0];
        let factors = |&h: &f64| {
            let taps = hermite(&altitudes, altitude_node(h));
            let value = |r: usize| -> f64 {
                let factor = |i: usize| f64::from(basis.factors[0][i * rank + r].get());
                taps.taps().map(|(i, w)| w * factor(i)).sum()
            };
            (0..rank).map(|r| value(r) as f32).collect::<Vec<_>>()
        };
        let wavelengths = head.wavelengths.len();
        Ok(Self {
            altitude: refine(&basis).iter().flat_map(factors).collect(),
            suns: (basis.sun.iter())
                .map(|s| sun_coordinate(s.get()))
                .collect(),
            channel: core::array::from_fn(|field| channels(&basis, field, wavelengths)),
            rows: (0..sources.len() * basis.sun.len())
                .map(|_| OnceLock::new())
                .collect(),
            wavelengths,
            basis,
            sources,
        })
    }

    /// The core of a visibility at a sun node of the file.
    fn row(&self, v: usize, sun: usize) -> &[f32] {
        self.rows[v * self.suns.len() + sun].get_or_init(|| {
            let [ra, rs, rm, rc] = self.basis.ranks;
            let (core, n) = (self.sources[v].core, rm * rc);
            let factors = &self.basis.factors[1][sun * rs..][..rs];
            let mut sums = vec![0.0; ra * n];
            for (a, sums) in sums.chunks_exact_mut(n).enumerate() {
                for (s, factor) in factors.iter().enumerate() {
                    let values = &core[(a * rs + s) * n..][..n];
                    let factor = f64::from(factor.get());
                    for (sum, &value) in sums.iter_mut().zip(values) {
                        *sum += factor * f64::from(widen(value));
                    }
                }
            }
            sums.iter().map(|&sum: &f64| sum as f32).collect()
        })
    }

    /// Logarithm of the level of a field at these sun nodes of the file.
    fn level(&self, v: usize, field: usize, taps: &Stencil, wavelength: usize) -> f64 {
        let source = &self.sources[v];
        let table = &source.level[field * source.suns * self.wavelengths..];
        let value = |i: usize| f64::from(table[i * self.wavelengths + wavelength].get());
        taps.taps().map(|(i, w)| w * value(i)).sum()
    }
}

/// Factors of the channels of a field, `[component][block]`.
fn channels(basis: &SourceBasisView, field: usize, wavelengths: usize) -> Vec<Quad> {
    let rank = basis.ranks[3];
    let factor = |w: usize, c: usize| match w < wavelengths {
        true => basis.factors[3][(field * wavelengths + w) * rank + c].get(),
        false => 0.0,
    };
    let blocks = 0..wavelengths.div_ceil(LANES);
    let block = |c: usize, b: usize| Lanes(core::array::from_fn(|i| factor(b * LANES + i, c)));
    (0..rank)
        .flat_map(|c| blocks.clone().map(move |b| block(c, b)))
        .collect()
}

/// Room for what is on the way from the file to a node.
#[derive(Clone, Default)]
pub(super) struct Scratch {
    /// `[altitude component][moment][channel component]`.
    at_sun: Vec<f32>,
    /// `[moment][channel component]`.
    at_altitude: Vec<f32>,
    /// `[channel component][block]`.
    channel: Vec<Quad>,
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
        let blocks = self.ground.len().div_ceil(LANES);
        let scale = share * f64::from(expansion.sources[v].scale);
        let out = &mut self.scratch.channel;
        out.clear();
        out.resize(expansion.basis.ranks[3] * blocks, Quad::splat(0.0));
        for block in 0..blocks {
            let mut ground = Quad::splat(0.0);
            let first = block * LANES;
            let rows = self.ground[first..].iter().zip(&mut level[first..]);
            for (i, (factor, level)) in rows.take(LANES).enumerate() {
                let of = |field| expansion.level(v, field, taps, first + i);
                let (sky, reflected) = (of(0), of(1));
                *level += share * sky;
                ground.0[i] = (factor * (reflected - sky).exp()) as f32;
            }
            let [sky, reflected] = &expansion.channel;
            for c in (block..out.len()).step_by(blocks) {
                out[c] = (sky[c] + reflected[c] * ground) * scale as f32;
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
        let (blocks, pairs) = (self.ground.len().div_ceil(LANES), rm.div_ceil(2));
        let node = self.table.node(altitude, self.sun.0);
        for (m, channels) in moments.chunks_exact(rc).enumerate() {
            for block in 0..blocks {
                let mut sum = Quad::splat(0.0);
                for (value, row) in channels
                    .iter()
                    .zip(self.scratch.channel.chunks_exact(blocks))
                {
                    sum = sum + row[block] * *value;
                }
                let half = &mut node[block * pairs + m / 2].0[m % 2 * LANES..][..LANES];
                half.iter_mut().zip(sum.0).for_each(|(out, v)| *out += v);
            }
        }
    }
}

impl Kernel for Fill<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<I: Instructions>(mut self, _: I) -> bool {
        let (sun, sine) = self.sun;
        let taps = hermite(&self.expansion.suns, sun_coordinate(sine));
        for &altitude in self.altitudes {
            self.table.node(altitude, sun).fill(Lanes::splat(0.0));
        }
        let mut level = [0.0; crate::sky::MOST_WAVELENGTHS];
        for (v, share) in self.visibilities.taps() {
            self.contract_sun(v, &taps);
            self.light(v, &taps, share, &mut level);
            for &altitude in self.altitudes {
                self.add(altitude);
            }
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
