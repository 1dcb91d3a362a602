//! Sections 6.9, 7.3, 7.5 and 7.6: what lies between the nodes.

use super::{Oracle, Query, hermite, piecewise};

/// Where the tables of a spectrum chunk stand, and how long they are.
pub(super) struct Spectrum {
    cells: usize,
    taps: usize,
    terms: usize,
    wavelength: usize,
    tap_node: usize,
    tap_weight: usize,
    extinction: usize,
    term_weight: usize,
    term_extinction: usize,
}

impl Oracle<'_> {
    pub(super) fn spectrum(&self) -> Option<Spectrum> {
        let at = self.find(9, 65535, 65535)?.0;
        let [cells, taps, terms] = [0, 1, 2].map(|i| self.integer(at, i));
        let wavelength = at + 16;
        let tap_node = wavelength + 8 * cells;
        let tap_weight = tap_node + 4 * cells * taps;
        let extinction = tap_weight + 4 * cells * taps;
        let term_weight = extinction + 4 * self.n.v * self.n.k * cells;
        let term_extinction = term_weight + 4 * cells * terms;
        Some(Spectrum {
            cells,
            taps,
            terms,
            wavelength,
            tap_node,
            tap_weight,
            extinction,
            term_weight,
            term_extinction,
        })
    }

    fn integer(&self, at: usize, i: usize) -> usize {
        u32::from_le_bytes(self.file[at + 4 * i..][..4].try_into().unwrap()) as usize
    }

    /// The wavelengths of the file.
    pub fn nodes(&self) -> Vec<f64> {
        self.axis(self.at.wavelength, self.n.w, |l| l)
    }

    /// The wavelengths of the cells, none in a file without.
    pub fn cells(&self) -> Vec<f64> {
        let spectrum = self.spectrum();
        spectrum.map_or(Vec::new(), |s| self.axis(s.wavelength, s.cells, |l| l))
    }

    /// A weight for every node, `W_n`.
    fn weights(&self, spectrum: &Spectrum, wavelength: f64) -> Vec<f64> {
        let mut weights = vec![0.0; self.n.w];
        for (cell, share) in piecewise(&self.cells(), wavelength) {
            for tap in cell * spectrum.taps..(cell + 1) * spectrum.taps {
                let node = self.integer(spectrum.tap_node, tap);
                weights[node] += share * self.f32(spectrum.tap_weight, tap);
            }
        }
        weights
    }

    /// Radiance between the nodes, from that at the nodes.
    pub(super) fn mixed(&self, values: &[f64], wavelength: f64) -> f64 {
        let Some(spectrum) = self.spectrum() else {
            return self.curve(values, wavelength);
        };
        let weights = self.weights(&spectrum, wavelength);
        let pairs = || weights.iter().zip(values).filter(|(w, _)| **w != 0.0);
        if pairs().all(|(_, l)| *l > 0.0) {
            return pairs().map(|(w, l)| w * l.ln()).sum::<f64>().exp();
        }
        let above: f64 = pairs().map(|(w, l)| w.max(0.0) * l).sum();
        let below: f64 = pairs().map(|(w, _)| w.max(0.0)).sum();
        if below > 0.0 { above / below } else { 0.0 }
    }

    fn curve(&self, values: &[f64], wavelength: f64) -> f64 {
        let nodes = self.nodes();
        let smooth = hermite(&nodes, wavelength);
        match smooth.iter().all(|&(i, _)| values[i] > 0.0) {
            true => (smooth.iter().map(|&(i, w)| w * values[i].ln()))
                .sum::<f64>()
                .exp(),
            false => (piecewise(&nodes, wavelength).iter())
                .map(|&(i, w)| w * values[i])
                .sum(),
        }
    }

    /// L, Q and U between the nodes, from those at the nodes.
    pub fn mixed_stokes(&self, values: &[[f64; 3]], wavelength: f64) -> [f64; 3] {
        let lights: Vec<f64> = values.iter().map(|v| v[0]).collect();
        let light = self.mixed(&lights, wavelength);
        let weights = match self.spectrum() {
            Some(spectrum) => self.weights(&spectrum, wavelength),
            None => {
                let nodes = self.nodes();
                let mut weights = vec![0.0; self.n.w];
                for (i, w) in hermite(&nodes, wavelength) {
                    weights[i] = w;
                }
                weights
            }
        };
        let [q, u] = [1, 2].map(|part| -> f64 {
            let lit = weights.iter().zip(values).filter(|(_, v)| v[0] > 0.0);
            lit.map(|(w, v)| w * v[part] / v[0]).sum()
        });
        let share = light / q.hypot(u).max(1.0);
        [light, share * q, share * u]
    }

    /// Transmittance over a distance from the observer at a wavelength of the cells.
    pub fn transmittance_at(&self, q: &Query, distance: f64, wavelength: f64) -> f64 {
        let spectrum = self.spectrum().expect("a file with a spectrum");
        let columns = self.columns(q, distance);
        let cells = piecewise(&self.cells(), wavelength);
        let visibilities = self.visibilities(q);
        let depth = |cell: usize| -> f64 {
            let row = |m: usize, k: usize| (m * self.n.k + k) * spectrum.cells + cell;
            let coefficient = |k: usize| -> f64 {
                let terms = visibilities.iter();
                terms
                    .map(|&(m, t)| t * self.f32(spectrum.extinction, row(m, k)))
                    .sum()
            };
            (0..self.n.k).map(|k| coefficient(k) * columns[k]).sum()
        };
        let lines = |cell: usize| -> f64 {
            let terms = cell * spectrum.terms..(cell + 1) * spectrum.terms;
            terms
                .map(|g| {
                    let along = |k: usize| {
                        self.f32(spectrum.term_extinction, g * self.n.k + k) * columns[k]
                    };
                    let depth: f64 = (0..self.n.k).map(along).sum();
                    self.f32(spectrum.term_weight, g) * (-depth).exp()
                })
                .sum()
        };
        let mean = |of: &dyn Fn(usize) -> f64| -> f64 {
            cells.iter().map(|&(cell, share)| share * of(cell)).sum()
        };
        (-mean(&depth)).exp() * mean(&lines)
    }
}
