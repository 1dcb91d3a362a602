//! Light of cells in single precision, for many queries. As `cells`, in logarithms to the base 2.

use crate::format::SpectrumView;
use crate::kernel::math::{exp2, log2};

/// What is taken of a spectrum chunk.
#[derive(Clone, Debug)]
pub(crate) struct CellTable {
    /// nm.
    cells: Vec<f32>,
    first_term: Vec<u32>,
    term_weight: Vec<f32>,
    taps: usize,
    /// `[term][tap]`.
    node: Vec<u16>,
    /// `[term][tap]`.
    weight: Vec<f32>,
}

impl CellTable {
    pub fn new(view: &SpectrumView) -> Self {
        Self {
            cells: view.wavelength.iter().map(|l| l.get() as f32).collect(),
            first_term: view.first_term.iter().map(|g| g.get()).collect(),
            term_weight: view.term_weight.iter().map(|w| w.get()).collect(),
            taps: view.taps,
            node: view.tap_node.iter().map(|n| n.get() as u16).collect(),
            weight: view.tap_weight.iter().map(|w| w.get()).collect(),
        }
    }

    /// The logarithm of light at a wavelength (nm) from those at the nodes.
    #[inline(always)]
    pub fn logarithm(&self, wavelength: f32, logarithms: &[f32]) -> f32 {
        let (cell, t) = self.locate(wavelength);
        let [a, b] = [cell, cell + 1].map(|cell| self.cell(cell, logarithms));
        (1.0 - t) * a + t * b
    }

    /// Adds the shares that nodes have in light at a wavelength (nm).
    #[inline(always)]
    pub fn add_shares(&self, wavelength: f32, logarithms: &[f32], shares: &mut [f32]) {
        let (cell, t) = self.locate(wavelength);
        for (cell, near) in [(cell, 1.0 - t), (cell + 1, t)] {
            let terms = self.terms(cell);
            let whole = match terms.len() {
                1 => 0.0,
                _ => self.cell(cell, logarithms),
            };
            for term in terms.clone() {
                let share = match terms.len() {
                    1 => 1.0,
                    _ => self.term_weight[term] * exp2(self.term(term, logarithms) - whole),
                };
                let row = term * self.taps..(term + 1) * self.taps;
                for (&n, w) in self.node[row.clone()].iter().zip(&self.weight[row]) {
                    shares[usize::from(n)] += near * share * w;
                }
            }
        }
    }

    #[inline(always)]
    fn locate(&self, wavelength: f32) -> (usize, f32) {
        let before = self.cells.partition_point(|&cell| cell <= wavelength);
        let cell = before.clamp(1, self.cells.len() - 1) - 1;
        let [start, end] = [self.cells[cell], self.cells[cell + 1]];
        // Cells that are closer than single precision tells count as one.
        let step = (end - start).max(f32::MIN_POSITIVE);
        (cell, ((wavelength - start) / step).clamp(0.0, 1.0))
    }

    #[inline(always)]
    fn terms(&self, cell: usize) -> std::ops::Range<usize> {
        self.first_term[cell] as usize..self.first_term[cell + 1] as usize
    }

    #[inline(always)]
    fn cell(&self, cell: usize, logarithms: &[f32]) -> f32 {
        let terms = self.terms(cell);
        if terms.len() == 1 {
            return self.term(terms.start, logarithms);
        }
        // Relative to the brightest so far, so that nothing overflows.
        let (mut brightest, mut sum) = (f32::MIN, 0.0);
        for term in terms {
            let logarithm = self.term(term, logarithms);
            if logarithm > brightest {
                sum *= exp2(brightest - logarithm);
                brightest = logarithm;
            }
            sum += self.term_weight[term] * exp2(logarithm - brightest);
        }
        brightest + log2(sum.max(f32::MIN_POSITIVE))
    }

    #[inline(always)]
    fn term(&self, term: usize, logarithms: &[f32]) -> f32 {
        let row = term * self.taps..(term + 1) * self.taps;
        let taps = self.node[row.clone()].iter().zip(&self.weight[row]);
        taps.map(|(&n, w)| w * logarithms[usize::from(n)]).sum()
    }
}
