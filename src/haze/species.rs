//! Scattering coefficients and phase functions of what is in the air.

use crate::format::{Field, Head, PhaseFunction, SourceView, phase_function};
use crate::math::LANES;
use crate::phase::{PhaseTable, SunAngle};

use super::source::blocks;

/// Isotropic share of a phase function, per steradian.
const PER_SPHERE: f32 = 0.25 * core::f32::consts::FRAC_1_PI;

/// One phase function and where it counts.
#[derive(Clone, Debug)]
struct Scatterer {
    phase: PhaseTable,
    /// `[constituent][block]`, m⁻¹ where the profile is 1.
    scattering: Vec<[f32; LANES]>,
}

/// All scatterers at one visibility.
#[derive(Clone, Debug)]
pub(crate) struct Species {
    blocks: usize,
    scatterers: Vec<Scatterer>,
    /// Sums over molecules and over particles, `[constituent][block]`.
    totals: [Vec<[f32; LANES]>; 2],
}

impl Species {
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
        let zero = || vec![[0.0; LANES]; head.constituents * block_count];
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
                    parameter,
                };
                Scatterer {
                    phase: PhaseTable::new(&field),
                    scattering,
                }
            })
            .collect();
        Self {
            blocks: block_count,
            scatterers,
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
            let rows = scatterer.scattering.chunks_exact(self.blocks);
            for (sum, row) in out.iter_mut().zip(rows) {
                let k = &row[block];
                *sum = core::array::from_fn(|i| sum[i] + PER_SPHERE * phase[i] * k[i]);
            }
        }
    }

    /// What sunlight across a dipole makes of each constituent: as `sunlit`, polarised by the square of the sine.
    #[inline(always)]
    pub fn dipoles(&self, block: usize, out: &mut [[f32; LANES]]) {
        out.fill([0.0; LANES]);
        for scatterer in &self.scatterers {
            let Some(strength) = scatterer.phase.polarising(block) else {
                continue;
            };
            let rows = scatterer.scattering.chunks_exact(self.blocks);
            for (sum, row) in out.iter_mut().zip(rows) {
                let k = &row[block];
                *sum = core::array::from_fn(|i| sum[i] + PER_SPHERE * strength[i] * k[i]);
            }
        }
    }

    /// Scattering coefficients of molecules and of particles in constituent `k`, a block of wavelengths.
    #[inline(always)]
    pub fn totals(&self, k: usize, block: usize) -> [&[f32; LANES]; 2] {
        let row = k * self.blocks + block;
        [&self.totals[0][row], &self.totals[1][row]]
    }
}
