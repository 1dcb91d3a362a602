//! Light of cells: nodes make terms, terms a cell, and two cells what is between them. Format specification, sections
//! 7.3 and 7.5.

use super::between::MOST_WAVELENGTHS;
use crate::format::SpectrumView;
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// Light at a node counts as at least this share of the brightest.
const DARKEST: f64 = 1.0 / (1u32 << 27) as f64;
/// Logarithms beyond which light is bounded, so that no sum is infinite or zero.
const BOUND: f64 = 600.0;

/// The cell before a wavelength, and how far that is on the way to the next, 0..=1.
pub(super) fn locate(view: &SpectrumView, wavelength: f64) -> (usize, f64) {
    let cells = view.wavelength;
    let before = cells.partition_point(|cell| cell.get() <= wavelength);
    let cell = before.clamp(1, cells.len() - 1) - 1;
    let [start, end] = [cell, cell + 1].map(|c| cells[c].get());
    (cell, ((wavelength - start) / (end - start)).clamp(0.0, 1.0))
}

/// The logarithms of light at the nodes of a file.
struct Logarithms([f64; MOST_WAVELENGTHS]);

impl Logarithms {
    /// None where there is no light at all.
    fn new(radiance: &[f32]) -> Option<Self> {
        let brightest = radiance.iter().copied().fold(0.0, f32::max);
        let brightest = f64::from(brightest.min(f32::MAX));
        if brightest == 0.0 {
            return None;
        }
        let mut logarithms = Self([0.0; MOST_WAVELENGTHS]);
        for (logarithm, &l) in logarithms.0.iter_mut().zip(radiance) {
            *logarithm = f64::from(l).clamp(DARKEST * brightest, brightest).ln();
        }
        Some(logarithms)
    }

    /// Light of a term times its share of the cell.
    fn term(&self, view: &SpectrumView, term: usize) -> f64 {
        let terms = taps(view, term).map(|(n, w)| w * self.0[n]);
        let logarithm = terms.sum::<f64>().clamp(-BOUND, BOUND);
        f64::from(view.term_weight[term].get()) * logarithm.exp()
    }

    /// Light of a cell.
    fn cell(&self, view: &SpectrumView, cell: usize) -> f64 {
        view.terms(cell).map(|term| self.term(view, term)).sum()
    }
}

/// Nodes and weights of a term.
fn taps<'a>(view: &SpectrumView<'a>, term: usize) -> impl Iterator<Item = (usize, f64)> + use<'a> {
    let row = term * view.taps..(term + 1) * view.taps;
    let taps = view.tap_node[row.clone()].iter().zip(&view.tap_weight[row]);
    taps.map(|(n, w)| (n.get() as usize, f64::from(w.get())))
}

/// Radiance at a wavelength within the cells, from that at the nodes.
pub(crate) fn radiance(view: &SpectrumView, values: &[f32], wavelength: f64) -> f64 {
    let Some(logarithms) = Logarithms::new(values) else {
        return 0.0;
    };
    let (cell, t) = locate(view, wavelength);
    let [a, b] = [cell, cell + 1].map(|cell| logarithms.cell(view, cell).ln());
    ((1.0 - t) * a + t * b).exp()
}

/// The shares that nodes have in light at a wavelength within the cells, given its radiance at the nodes: with these what
/// is polarised of the nodes is summed.
pub(crate) fn shares(
    view: &SpectrumView,
    values: &[f32],
    wavelength: f64,
) -> [f64; MOST_WAVELENGTHS] {
    let mut shares = [0.0; MOST_WAVELENGTHS];
    let Some(logarithms) = Logarithms::new(values) else {
        return shares;
    };
    let (cell, t) = locate(view, wavelength);
    for (cell, near) in [(cell, 1.0 - t), (cell + 1, t)] {
        let whole = logarithms.cell(view, cell);
        for term in view.terms(cell) {
            let share = near * logarithms.term(view, term) / whole;
            taps(view, term).for_each(|(n, w)| shares[n] += share * w);
        }
    }
    shares
}

/// Transmittance of columns (m, one per constituent) at a wavelength within the cells, given the two visibilities around
/// and their weights. Format specification, section 7.6.
#[cfg(feature = "std")]
pub(super) fn transmittance(
    view: &SpectrumView,
    wavelength: f64,
    visibility: &crate::kernel::axis::Stencil,
    columns: &[f32],
) -> f64 {
    let (cells, (cell, t)) = (view.wavelength.len(), locate(view, wavelength));
    let along = |values: &dyn Fn(usize) -> f64| -> f64 {
        let columns = columns.iter().enumerate();
        columns.map(|(k, &c)| values(k) * f64::from(c)).sum()
    };
    let extinction = |k: usize| -> f64 {
        let at = |v: usize| {
            let row = &view.extinction[(v * columns.len() + k) * cells + cell..];
            (1.0 - t) * f64::from(row[0].get()) + t * f64::from(row[1].get())
        };
        visibility.taps().map(|(v, weight)| weight * at(v)).sum()
    };
    let lines = |cell: usize| -> f64 {
        let passed = |term: usize| {
            let row = &view.term_extinction[term * columns.len()..];
            let depth = along(&|k| f64::from(row[k].get()));
            f64::from(view.term_weight[term].get()) * (-depth).exp()
        };
        view.terms(cell).map(passed).sum()
    };
    let mean = (1.0 - t) * lines(cell) + t * lines(cell + 1);
    // Shares add up to 1 only up to rounding.
    ((-along(&extinction)).exp() * mean).min(1.0)
}
