//! Sections 6.9, 7.3, 7.5 and 7.6: what lies between the nodes.

use super::{Oracle, Query, hermite, piecewise};

/// Where the tables of a spectrum chunk stand, and how long they are.
pub(super) struct Spectrum {
    cells: usize,
    taps: usize,
    wavelength: usize,
    first_term: usize,
    term_weight: usize,
    term_extinction: usize,
    tap_node: usize,
    tap_weight: usize,
    extinction: usize,
}

impl Oracle<'_> {
    pub(super) fn spectrum(&self) -> Option<Spectrum> {
        let at = self.find(9, 65535, 65535)?.0;
        let [cells, taps, terms] = [0, 1, 2].map(|i| self.integer(at, i));
        let mut next = at + 16;
        let mut place = |bytes: usize| {
            next += bytes;
            next - bytes
        };
        Some(Spectrum {
            cells,
            taps,
            wavelength: place(8 * cells),
            first_term: place(4 * (cells + 1)),
            term_weight: place(4 * terms),
            term_extinction: place(4 * terms * self.n.k),
            tap_node: place(4 * terms * taps),
            tap_weight: place(4 * terms * taps),
            extinction: place(4 * self.n.v * self.n.k * cells),
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

    /// Weights of the nodes of a term, `W_g,n`.
    fn weights(&self, spectrum: &Spectrum, term: usize) -> Vec<f64> {
        let mut weights = vec![0.0; self.n.w];
        for tap in term * spectrum.taps..(term + 1) * spectrum.taps {
            let node = self.integer(spectrum.tap_node, tap);
            weights[node] += self.f32(spectrum.tap_weight, tap);
        }
        weights
    }

    /// The terms of a cell with `term_weight_g`.
    fn terms(&self, spectrum: &Spectrum, cell: usize) -> Vec<(usize, f64)> {
        let [first, end] = [cell, cell + 1].map(|c| self.integer(spectrum.first_term, c));
        let weight = |g| (g, self.f32(spectrum.term_weight, g));
        (first..end).map(weight).collect()
    }

    /// `L_g`, from radiance at the nodes that is not zero everywhere.
    fn term(&self, spectrum: &Spectrum, term: usize, values: &[f64]) -> f64 {
        let brightest = values.iter().copied().fold(0.0, f64::max);
        let weights = self.weights(spectrum, term).into_iter().zip(values);
        let logarithms = weights.map(|(w, l)| w * l.max(brightest * 2f64.powi(-27)).ln());
        logarithms.sum::<f64>().exp()
    }

    /// Radiance between the nodes, from that at the nodes.
    pub(super) fn mixed(&self, values: &[f64], wavelength: f64) -> f64 {
        let Some(spectrum) = self.spectrum() else {
            return self.curve(values, wavelength);
        };
        if values.iter().all(|l| *l == 0.0) {
            return 0.0;
        }
        let cell = |c| -> f64 {
            let terms = self.terms(&spectrum, c).into_iter();
            terms
                .map(|(g, share)| share * self.term(&spectrum, g, values))
                .sum()
        };
        let around = piecewise(&self.cells(), wavelength).into_iter();
        around.map(|(c, t)| t * cell(c).ln()).sum::<f64>().exp()
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
        if light == 0.0 {
            return [0.0; 3];
        }
        let [q, u] = [1, 2].map(|part| -> f64 {
            let ratio = |v: &[f64; 3]| if v[0] > 0.0 { v[part] / v[0] } else { 0.0 };
            let ratios: Vec<f64> = values.iter().map(ratio).collect();
            self.mixed_ratio(&ratios, &lights, wavelength)
        });
        let share = light / q.hypot(u).max(1.0);
        [light, share * q, share * u]
    }

    /// Q/L or U/L between the nodes.
    fn mixed_ratio(&self, ratios: &[f64], lights: &[f64], wavelength: f64) -> f64 {
        let Some(spectrum) = self.spectrum() else {
            let curve = hermite(&self.nodes(), wavelength).into_iter();
            return curve.map(|(i, w)| w * ratios[i]).sum();
        };
        let cell = |c| -> f64 {
            let (mut above, mut below) = (0.0, 0.0);
            for (g, share) in self.terms(&spectrum, c) {
                let light = share * self.term(&spectrum, g, lights);
                let weights = self.weights(&spectrum, g).into_iter().zip(ratios);
                above += light * weights.map(|(w, r)| w * r).sum::<f64>();
                below += light;
            }
            above / below
        };
        let around = piecewise(&self.cells(), wavelength).into_iter();
        around.map(|(c, t)| t * cell(c)).sum()
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
            let passed = |(g, share): (usize, f64)| {
                let along =
                    |k: usize| self.f32(spectrum.term_extinction, g * self.n.k + k) * columns[k];
                share * (-(0..self.n.k).map(along).sum::<f64>()).exp()
            };
            self.terms(&spectrum, cell).into_iter().map(passed).sum()
        };
        let mean = |of: &dyn Fn(usize) -> f64| -> f64 {
            cells.iter().map(|&(cell, share)| share * of(cell)).sum()
        };
        (-mean(&depth)).exp() * mean(&lines)
    }
}
