//! The source at the nodes of its table: all of them for a scene, single ones for queries that share no conditions.
//! Format specification, section 7.7.
//!
//! The core of a visibility is contracted once at each sun node of the file that is needed, so that a node of a table
//! is a short sum, whatever the conditions are.

use std::sync::OnceLock;

use super::source_table::{refine, sun_coordinate};
use crate::error::Result;
use crate::format::{Payload16, SOURCE_FIELDS, SourceBasisView, SourceView, altitude_node};
use crate::kernel::axis::{Stencil, hermite};
use crate::kernel::half::widen;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;
use crate::kernel::simd::{Instructions, Kernel, dispatch};
use crate::model::{Model, Nodes, SourceAtNodes};
use zerocopy::little_endian::F32;

pub(super) type Quad = Lanes<LANES>;

/// What all conditions share.
pub(super) struct Expansion<'a> {
    pub basis: SourceBasisView<'a>,
    /// By visibility, where it was asked for.
    sources: Vec<Option<SourceAtNodes<'a>>>,
    wavelengths: usize,
    /// Coordinates of the sun nodes of the file.
    pub suns: Vec<f64>,
    /// Factors of the altitudes of a table, `[altitude][component]`.
    pub altitude: Vec<f32>,
    /// Factors of the channels, `[component][block]`.
    pub channel: [Vec<Quad>; SOURCE_FIELDS],
    /// Cores at the sun nodes of the file, `[visibility][sun]` of `[altitude component][moment][channel]`; computed
    /// when they are first needed.
    rows: Vec<OnceLock<Box<[f32]>>>,
}

impl<'a> Expansion<'a> {
    /// Of the sources at some visibilities, which are read and verified.
    pub fn new(
        model: &'a Model,
        nodes: Nodes,
        visibilities: impl Iterator<Item = usize>,
    ) -> Result<Self> {
        let basis = model.source_basis_chunk()?;
        let mut sources: Vec<_> = nodes.head.visibilities.iter().map(|_| None).collect();
        let mut first = None;
        for v in visibilities {
            if sources[v].is_some() {
                continue;
            }
            let source = model.source_chunk(v)?;
            source.check_with(&basis, first.get_or_insert(source))?;
            sources[v] = Some(nodes.source(source));
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
        let wavelengths = nodes.head.wavelengths.len();
        let channel = nodes.source_channels(&basis);
        let channel = |w: usize, c: usize| channel[w * basis.ranks[3] + c].get();
        Ok(Self {
            altitude: refine(&basis).iter().flat_map(factors).collect(),
            suns: (basis.sun.iter())
                .map(|s| sun_coordinate(s.get()))
                .collect(),
            channel: core::array::from_fn(|field| {
                let factor = |w: usize, c: usize| channel(field * wavelengths + w, c);
                channels(factor, wavelengths, basis.ranks[3])
            }),
            rows: (0..sources.len() * basis.sun.len())
                .map(|_| OnceLock::new())
                .collect(),
            wavelengths,
            basis,
            sources,
        })
    }

    /// The source at a visibility that was asked for.
    pub fn source(&self, v: usize) -> SourceView<'_> {
        let source = self.sources[v].as_ref();
        source.expect("a visibility that was asked for").view()
    }

    /// The core of a visibility at a sun node of the file.
    pub fn row(&self, v: usize, sun: usize) -> &[f32] {
        self.rows[v * self.suns.len() + sun].get_or_init(|| {
            let [ra, rs, rm, rc] = self.basis.ranks;
            let mut sums = vec![0.0; ra * rm * rc];
            dispatch(AtSun {
                core: self.source(v).core,
                factors: &self.basis.factors[1][sun * rs..][..rs],
                sums: &mut sums,
                width: rm * rc,
            });
            sums.into()
        })
    }

    /// Logarithm of the level of a field at these sun nodes of the file.
    pub fn level(
        &self,
        source: &SourceView,
        field: usize,
        taps: &Stencil,
        wavelength: usize,
    ) -> f64 {
        let table = &source.level[field * source.suns * self.wavelengths..];
        let value = |i: usize| f64::from(table[i * self.wavelengths + wavelength].get());
        taps.taps().map(|(i, w)| w * value(i)).sum()
    }
}

/// Sums a core over its components of the sun.
struct AtSun<'a> {
    /// `[altitude component][sun component][width]`.
    core: &'a Payload16,
    factors: &'a [F32],
    /// `[altitude component][width]`.
    sums: &'a mut [f32],
    width: usize,
}

impl Kernel for AtSun<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, instructions: I) {
        let Self { core, factors, .. } = self;
        let suns = core.chunks_exact(self.width * factors.len());
        for (sums, suns) in self.sums.chunks_exact_mut(self.width).zip(suns) {
            let (groups, rest) = sums.as_chunks_mut::<8>();
            let first = 8 * groups.len();
            for (i, group) in groups.iter_mut().enumerate() {
                let mut sum = Lanes::splat(0.0);
                for (factor, row) in factors.iter().zip(suns.chunks_exact(self.width)) {
                    if let Some(values) = row[8 * i..].first_chunk() {
                        let values = instructions.widen(values);
                        sum = instructions.add_product(sum, values, factor.get());
                    }
                }
                *group = sum.0;
            }
            for (i, sum) in rest.iter_mut().enumerate() {
                let rows = factors.iter().zip(suns.chunks_exact(self.width));
                *sum = rows.map(|(f, row)| f.get() * widen(row[first + i])).sum();
            }
        }
    }
}

/// Factors of the channels of a field, `[component][block]`.
fn channels(
    factor: impl Fn(usize, usize) -> f32,
    wavelengths: usize,
    components: usize,
) -> Vec<Quad> {
    let factor = |w: usize, c: usize| match w < wavelengths {
        true => factor(w, c),
        false => 0.0,
    };
    let block = |c: usize, b: usize| Lanes(core::array::from_fn(|i| factor(b * LANES + i, c)));
    let blocks = 0..wavelengths.div_ceil(LANES);
    (0..components)
        .flat_map(|c| blocks.clone().map(move |b| (c, b)))
        .map(|(c, b)| block(c, b))
        .collect()
}
