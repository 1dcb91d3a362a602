//! What the air lets pass between the nodes. Format specification, section 7.6.

use crate::format::SpectrumView;
use crate::kernel::axis::Stencil;

/// Extinction coefficients of cells where a profile is 1, m⁻¹, and what absorption lines add in shares of each band.
#[derive(Clone, Debug)]
pub(super) struct BandExtinction {
    cells: usize,
    constituents: usize,
    terms: usize,
    /// `[visibility][constituent][cell]`.
    extinction: Vec<f32>,
    /// `[cell][term]`.
    term_weight: Vec<f32>,
    /// `[cell][term][constituent]`.
    term_extinction: Vec<f32>,
}

impl BandExtinction {
    pub fn new(view: &SpectrumView, constituents: usize) -> Self {
        let narrow = |values: &[zerocopy::little_endian::F32]| {
            values.iter().map(|v| v.get()).collect::<Vec<f32>>()
        };
        Self {
            cells: view.wavelength.len(),
            constituents,
            terms: view.terms,
            extinction: narrow(view.extinction),
            term_weight: narrow(view.term_weight),
            term_extinction: narrow(view.term_extinction),
        }
    }

    /// Transmittance of columns (m, one per constituent) at the share `t` of the way from a cell to the next, at a
    /// visibility between nodes.
    pub fn transmittance(
        &self,
        (cell, t): (usize, f64),
        visibility: &Stencil,
        columns: impl Fn(usize) -> f32,
    ) -> f64 {
        let columns = |k: usize| f64::from(columns(k));
        let coefficient = |k: usize| -> f64 {
            let at = |v: usize| {
                let row = &self.extinction[(v * self.constituents + k) * self.cells + cell..];
                (1.0 - t) * f64::from(row[0]) + t * f64::from(row[1])
            };
            visibility.taps().map(|(v, weight)| weight * at(v)).sum()
        };
        let depth: f64 = (0..self.constituents)
            .map(|k| coefficient(k) * columns(k))
            .sum();
        let lines = (1.0 - t) * self.lines(cell, &columns) + t * self.lines(cell + 1, &columns);
        // Shares add up to 1 only up to rounding.
        ((-depth).exp() * lines).min(1.0)
    }

    /// What the lines of a cell let pass.
    fn lines(&self, cell: usize, columns: &impl Fn(usize) -> f64) -> f64 {
        let terms = cell * self.terms..(cell + 1) * self.terms;
        let rows = self.term_extinction.chunks_exact(self.constituents);
        let shares = self.term_weight[terms.clone()]
            .iter()
            .zip(rows.skip(terms.start));
        shares
            .map(|(&share, row)| {
                let depths = row.iter().enumerate();
                let depth: f64 = depths.map(|(k, &e)| f64::from(e) * columns(k)).sum();
                f64::from(share) * (-depth).exp()
            })
            .sum()
    }
}
