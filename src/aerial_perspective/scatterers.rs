//! Scattering coefficients and phase functions of what is in the air.

use crate::format::{Field, Head, PhaseFunction, SourceView, phase_function};
use crate::kernel::math::LANES;
use crate::phase_function::{PhaseTable, SunAngle};

use super::source_table::blocks;

/// Isotropic share of a phase function, per steradian.
const PER_SPHERE: f32 = 0.25 * core::f32::consts::FRAC_1_PI;

/// One phase function and where it counts.
#[derive(Clone, Debug)]
struct Scatterer {
    phase: PhaseTable,
    /// Constituents that it is part of.
    constituents: Vec<usize>,
    /// `[one of these][block]`, m⁻¹ where the profile is 1.
    scattering: Vec<[f32; LANES]>,
}

impl Scatterer {
    /// From `[constituent][block]`.
    fn new(phase: PhaseTable, all: &[[f32; LANES]], blocks: usize) -> Self {
        let rows = all.chunks(blocks).enumerate();
        let (constituents, rows): (Vec<_>, Vec<_>) = rows.filter(|(_, row)| scatters(row)).unzip();
        Self {
            phase,
            constituents,
            scattering: rows.concat(),
        }
    }

    /// Adds a block of wavelengths, scaled by what `phase` is there.
    #[inline(always)]
    fn add(&self, block: usize, blocks: usize, phase: [f32; LANES], out: &mut [[f32; LANES]]) {
        let rows = self.scattering.chunks_exact(blocks);
        for (&constituent, row) in self.constituents.iter().zip(rows) {
            let (sum, k) = (&mut out[constituent], &row[block]);
            *sum = core::array::from_fn(|i| sum[i] + PER_SPHERE * phase[i] * k[i]);
        }
    }
}

fn scatters(row: &[[f32; LANES]]) -> bool {
    row.as_flattened().iter().any(|&k| k != 0.0)
}

/// All scatterers at one visibility.
#[derive(Clone, Debug)]
pub(crate) struct Scatterers {
    blocks: usize,
    scatterers: Vec<Scatterer>,
    /// Sums over molecules and over particles, `[constituent][block]`.
    totals: [Vec<[f32; LANES]>; 2],
    /// Whether there are any in a constituent.
    present: [Vec<bool>; 2],
}

impl Scatterers {
    /// From the sources around a visibility with their weights (linear in 1/V).
    pub fn new<'a>(
        head: &Head,
        sources: impl Iterator<Item = (SourceView<'a>, f64)> + Clone,
    ) -> Self {
        let nw = head.wavelengths.len();
        let rows = head.constituents * nw;
        let count = sources
            .clone()
            .map(|(s, _)| s.phase.len())
            .min()
            .unwrap_or(0);
        let block_count = nw.div_ceil(LANES);
        let padded = head.constituents.next_multiple_of(LANES);
        let zero = || vec![[0.0; LANES]; padded * block_count];
        let mut totals = [zero(), zero()];
        let scatterers = (0..count)
            .map(|s| {
                let (mut parameter, mut scattering) = (vec![0.0; nw], vec![0.0; rows]);
                let mut phase = PhaseFunction::HenyeyGreenstein;
                for (source, weight) in sources.clone() {
                    phase = phase_function(source.phase[s].get()).unwrap_or(phase);
                    for (sum, p) in parameter.iter_mut().zip(&source.parameter[s * nw..]) {
                        *sum += weight * f64::from(p.get());
                    }
                    for (sum, k) in scattering.iter_mut().zip(&source.scattering[s * rows..]) {
                        *sum += weight * f64::from(k.get());
                    }
                }
                let scattering: Vec<_> = scattering.chunks(nw).flat_map(blocks).collect();
                let total = &mut totals[usize::from(phase != PhaseFunction::Rayleigh)];
                for (sum, k) in total.iter_mut().zip(&scattering) {
                    *sum = core::array::from_fn(|i| sum[i] + k[i]);
                }
                let field = Field {
                    phase,
                    ground: false,
                    estimate: 0,
                    parameter,
                };
                Scatterer::new(PhaseTable::new(&field), &scattering, block_count)
            })
            .collect();
        let rows = |total: &Vec<[f32; LANES]>| total.chunks(block_count).map(scatters).collect();
        Self {
            blocks: block_count,
            scatterers,
            present: totals.each_ref().map(rows),
            totals,
        }
    }

    pub fn bytes(&self) -> usize {
        let own = |s: &Scatterer| s.phase.bytes() + size_of_val(s.scattering.as_slice());
        let totals: usize = self.totals.iter().map(|t| size_of_val(t.as_slice())).sum();
        self.scatterers.iter().map(own).sum::<usize>() + totals
    }

    /// What sunlight at an angle makes of each constituent, per steradian and metre: `[constituent]` of a block.
    #[inline(always)]
    pub fn sunlit(&self, block: usize, angle: SunAngle, out: &mut [[f32; LANES]]) {
        out.fill([0.0; LANES]);
        for scatterer in &self.scatterers {
            let phase = scatterer.phase.evaluate(block, angle);
            scatterer.add(block, self.blocks, phase, out);
        }
    }

    /// What sunlight across a dipole makes of each constituent: as `sunlit`, polarised by the square of the sine.
    #[inline(always)]
    pub fn dipoles(&self, block: usize, out: &mut [[f32; LANES]]) {
        out.fill([0.0; LANES]);
        for scatterer in &self.scatterers {
            if let Some(strength) = scatterer.phase.polarising(block) {
                scatterer.add(block, self.blocks, strength, out);
            }
        }
    }

    /// Scattering coefficients of molecules and of particles in constituent `k`, a block of wavelengths; `None` where
    /// there are none.
    #[inline(always)]
    pub fn totals(&self, k: usize, block: usize) -> [Option<&[f32; LANES]>; 2] {
        let row = k * self.blocks + block;
        [0, 1].map(|i| self.present[i][k].then(|| &self.totals[i][row]))
    }
}
