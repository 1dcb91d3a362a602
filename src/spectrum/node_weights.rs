//! The nodes that light of one wavelength is made of.

use crate::format::{MAX_TAPS, SpectrumView};
use crate::kernel::axis::Stencil;
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// Nodes of two neighbouring cells.
const MOST: usize = 2 * MAX_TAPS;

/// Nodes and their weights at one wavelength, each node once.
#[derive(Clone, Copy)]
pub(crate) struct SpectralWeights {
    count: usize,
    taps: [(u16, f64); MOST],
}

impl SpectralWeights {
    const NONE: Self = Self {
        count: 0,
        taps: [(0, 0.0); MOST],
    };

    /// Those of a curve through nodes.
    pub fn of_nodes(stencil: &Stencil) -> Self {
        let mut weights = Self::NONE;
        stencil.taps().for_each(|(n, w)| weights.add(n, w));
        weights
    }

    /// Those of the cells around a wavelength (nm) within their range.
    pub fn of_cells(view: &SpectrumView, wavelength: f64) -> Self {
        let (cell, t) = locate(view.wavelength, |l| l.get(), wavelength);
        let mut weights = Self::NONE;
        for (cell, share) in [(cell, 1.0 - t), (cell + 1, t)] {
            let row = cell * view.taps..(cell + 1) * view.taps;
            let taps = view.tap_node[row.clone()].iter().zip(&view.tap_weight[row]);
            taps.for_each(|(n, w)| weights.add(n.get() as usize, share * f64::from(w.get())));
        }
        weights
    }

    /// Adds a weight to that of its node; there are as many nodes as two cells have taps at most.
    pub fn add(&mut self, node: usize, weight: f64) {
        let known = self.taps[..self.count].iter_mut();
        match known.into_iter().find(|(n, _)| usize::from(*n) == node) {
            Some((_, sum)) => *sum += weight,
            None => {
                self.taps[self.count] = (node as u16, weight);
                self.count += 1;
            }
        }
    }

    /// [`SpectralWeights::taps`] that own what they go over.
    pub fn into_taps(self) -> impl Iterator<Item = (usize, f64)> {
        let taps = self.taps.into_iter().take(self.count);
        taps.filter(|(_, w)| *w != 0.0)
            .map(|(n, w)| (usize::from(n), w))
    }

    /// The nodes with a weight other than zero.
    pub fn taps(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let taps = self.taps[..self.count].iter();
        taps.filter(|(_, w)| *w != 0.0)
            .map(|&(n, w)| (usize::from(n), w))
    }
}

impl FromIterator<(usize, f64)> for SpectralWeights {
    fn from_iter<I: IntoIterator<Item = (usize, f64)>>(taps: I) -> Self {
        let mut weights = Self::NONE;
        taps.into_iter().for_each(|(n, w)| weights.add(n, w));
        weights
    }
}

/// The cell before a wavelength, and how far that is on the way to the next, 0..=1.
pub(super) fn locate<T>(cells: &[T], get: impl Fn(&T) -> f64, wavelength: f64) -> (usize, f64) {
    let before = cells.partition_point(|cell| get(cell) <= wavelength);
    let cell = before.clamp(1, cells.len() - 1) - 1;
    let [start, end] = [cell, cell + 1].map(|c| get(&cells[c]));
    (cell, ((wavelength - start) / (end - start)).clamp(0.0, 1.0))
}

/// Radiance that is the exponential of a weighted sum of logarithms; where it is zero at a node with a weight, the mean
/// with the weights that are positive.
pub(crate) fn mixed<I: Iterator<Item = (usize, f64)>>(
    taps: impl Fn() -> I,
    radiance: &[f32],
) -> f64 {
    if taps().all(|(n, _)| radiance[n] > 0.0) {
        let logarithms = taps().map(|(n, w)| w * f64::from(radiance[n]).ln());
        return logarithms.sum::<f64>().exp();
    }
    let (mut sum, mut whole) = (0.0, 0.0);
    for (n, w) in taps().filter(|&(_, w)| w > 0.0) {
        sum += w * f64::from(radiance[n]);
        whole += w;
    }
    if whole > 0.0 { sum / whole } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{SpectralWeights, locate, mixed};

    #[test]
    fn cells_are_found_at_their_ends_too() {
        let cells = [400.0, 410.0, 440.0];
        let at = |l: f64| locate(&cells, |l| *l, l);
        assert_eq!(at(400.0), (0, 0.0));
        assert_eq!(at(405.0), (0, 0.5));
        assert_eq!(at(410.0), (1, 0.0));
        assert_eq!(at(440.0), (1, 1.0));
    }

    #[test]
    fn weights_of_a_node_add_up() {
        let weights: SpectralWeights = [(3, 0.5), (1, 0.25), (3, 0.5), (2, 0.0)]
            .into_iter()
            .collect();
        assert_eq!(weights.taps().collect::<Vec<_>>(), [(3, 1.0), (1, 0.25)]);
    }

    #[test]
    fn logarithms_are_summed_and_zeros_averaged() {
        let weights: SpectralWeights = [(0, 1.5), (1, -0.5)].into_iter().collect();
        let value = mixed(|| weights.taps(), &[4.0, 16.0]);
        assert!((value - 2.0).abs() < 1e-12);
        assert_eq!(mixed(|| weights.taps(), &[4.0, 0.0]), 4.0);
        let negative: SpectralWeights = [(1, -0.5)].into_iter().collect();
        assert_eq!(mixed(|| negative.taps(), &[4.0, 0.0]), 0.0);
    }
}
