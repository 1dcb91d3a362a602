//! The weights of all cells, those of neighbours side by side.

use super::node_weights::{SpectralWeights, locate};
use crate::format::SpectrumView;

/// For each interval between two cells the nodes that either is made of, and their weights at both ends.
#[derive(Clone, Debug)]
pub(crate) struct CellWeights {
    /// nm.
    cells: Vec<f64>,
    /// Nodes of an interval, those of the fewest padded with weights of zero.
    width: usize,
    /// `[interval][width]`.
    node: Vec<u16>,
    /// `[interval][width][end]`.
    weight: Vec<[f32; 2]>,
}

impl CellWeights {
    pub fn new(view: &SpectrumView) -> Self {
        let cells: Vec<f64> = view.wavelength.iter().map(|l| l.get()).collect();
        let ends = cells.iter().map(|&l| SpectralWeights::of_cells(view, l));
        let ends: Vec<_> = ends.collect();
        let intervals: Vec<_> = ends
            .windows(2)
            .map(|pair| merged(&pair[0], &pair[1]))
            .collect();
        let width = intervals.iter().map(Vec::len).max().unwrap_or(0);
        let padded = |taps: &Vec<(u16, [f32; 2])>| {
            let padding = std::iter::repeat_n((0, [0.0; 2]), width - taps.len());
            taps.iter().copied().chain(padding).collect::<Vec<_>>()
        };
        let (node, weight) = intervals.iter().flat_map(padded).unzip();
        Self {
            cells,
            width,
            node,
            weight,
        }
    }

    pub fn range(&self) -> [f64; 2] {
        [self.cells[0], self.cells[self.cells.len() - 1]]
    }

    /// The cell before a wavelength (nm), and how far that is on the way to the next, 0..=1.
    #[inline]
    pub fn locate(&self, wavelength: f64) -> (usize, f64) {
        locate(&self.cells, |l| *l, wavelength)
    }

    /// The weighted sum of values at the nodes, at a wavelength, nm.
    #[inline(always)]
    pub fn sum(&self, wavelength: f64, values: &[f32]) -> f32 {
        let (cell, t) = self.locate(wavelength);
        let (nodes, weights) = self.interval(cell);
        let t = t as f32;
        let terms = nodes.iter().zip(weights);
        terms
            .map(|(&n, [a, b])| ((1.0 - t) * a + t * b) * values[usize::from(n)])
            .sum()
    }

    /// Nodes between a cell and the next, each once, with their weights at either.
    #[inline(always)]
    pub fn interval(&self, cell: usize) -> (&[u16], &[[f32; 2]]) {
        let row = cell * self.width..(cell + 1) * self.width;
        (&self.node[row.clone()], &self.weight[row])
    }

    /// Nodes and weights at a wavelength, nm; each node once, but for those of no weight.
    pub fn taps(&self, wavelength: f64) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (cell, t) = self.locate(wavelength);
        let (nodes, weights) = self.interval(cell);
        let at = move |[a, b]: [f32; 2]| (1.0 - t) * f64::from(a) + t * f64::from(b);
        let taps = nodes.iter().zip(weights);
        taps.map(move |(&n, &ends)| (usize::from(n), at(ends)))
            .filter(|&(_, w)| w != 0.0)
    }
}

/// The nodes of two cells and the weights of each.
fn merged(first: &SpectralWeights, second: &SpectralWeights) -> Vec<(u16, [f32; 2])> {
    let mut taps: Vec<(u16, [f32; 2])> = Vec::new();
    for (end, weights) in [first, second].into_iter().enumerate() {
        for (node, weight) in weights.taps() {
            let known = taps.iter().position(|&(n, _)| usize::from(n) == node);
            let place = known.unwrap_or_else(|| {
                taps.push((node as u16, [0.0; 2]));
                taps.len() - 1
            });
            taps[place].1[end] = weight as f32;
        }
    }
    taps
}
