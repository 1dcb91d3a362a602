//! What light and air are between the nodes of a model. Format specification, sections 7.3 and 7.6.

use zerocopy::little_endian::F32;

use super::band_integral::{quadrature, spread};
use super::response::Response;
use crate::error::Result;
use crate::format::{Head, SpectrumView};
use crate::kernel::axis::{hermite, linear};
use crate::model::Model;

/// Nodes with weights of their logarithms.
pub(super) type Taps = Vec<(usize, f64)>;

/// Most terms that a band may be made of.
const MOST_TERMS: usize = 128;

/// Radiance and extinction at any wavelength of a model.
pub(super) struct SpectralAxis {
    /// Where the rules between have their kinks: the cells of the spectrum, or the nodes. nm.
    pub wavelengths: Vec<f64>,
    /// `None` without a spectrum.
    cells: Option<Vec<Vec<Term>>>,
    visibilities: usize,
    constituents: usize,
    /// K where the profile is 1, m⁻¹, `[visibility][constituent][wavelength]`.
    extinction: Vec<f64>,
}

/// A share of a band with more or less absorption by lines.
#[derive(Clone)]
struct Term {
    share: f64,
    /// By lines, m⁻¹ where the profile of each constituent is 1.
    extinction: Vec<f64>,
    taps: Taps,
}

impl SpectralAxis {
    pub fn new(model: &Model) -> Result<Self> {
        let head = model.head();
        let axis = Self {
            wavelengths: head.wavelengths.clone(),
            cells: None,
            visibilities: head.visibilities.len(),
            constituents: head.constituents,
            extinction: head.extinction.clone(),
        };
        Ok(match model.spectrum_chunk()? {
            Some(spectrum) => axis.with(&spectrum),
            None => axis,
        })
    }

    fn with(self, spectrum: &SpectrumView) -> Self {
        let wide = |v: &F32| f64::from(v.get());
        let term = |g: usize| {
            let taps = g * spectrum.taps..(g + 1) * spectrum.taps;
            let nodes = spectrum.tap_node[taps.clone()].iter();
            let nodes = nodes.map(|n| n.get() as usize);
            let lines = &spectrum.term_extinction[g * self.constituents..];
            Term {
                share: wide(&spectrum.term_weight[g]),
                extinction: lines.iter().take(self.constituents).map(wide).collect(),
                taps: nodes
                    .zip(spectrum.tap_weight[taps].iter().map(wide))
                    .filter(|tap| tap.1 != 0.0)
                    .collect(),
            }
        };
        let cell = |c: usize| spectrum.terms(c).map(term).collect();
        Self {
            cells: Some((0..spectrum.wavelength.len()).map(cell).collect()),
            wavelengths: spectrum.wavelength.iter().map(|l| l.get()).collect(),
            extinction: spectrum.extinction.iter().map(wide).collect(),
            ..self
        }
    }

    /// First and last wavelength that can be asked for, nm.
    pub fn range(&self) -> [f64; 2] {
        [
            self.wavelengths[0],
            self.wavelengths[self.wavelengths.len() - 1],
        ]
    }

    /// Wavelengths and weights of a response within the range of the model with this head: weights times integrand,
    /// summed, are the integral.
    pub fn quadrature(&self, head: &Head, response: &Response) -> Result<Vec<[f64; 2]>> {
        let samples = 0..head.solar_irradiance.len();
        let sunlight = samples.map(|i| head.solar_start + i as f64 * head.solar_step);
        let kinks: Vec<f64> = sunlight.chain(self.wavelengths.iter().copied()).collect();
        quadrature(self.range(), &kinks, response)
    }

    /// Whether cells say what lies between the nodes.
    pub fn has_cells(&self) -> bool {
        self.cells.is_some()
    }

    /// What the logarithm of light at a wavelength is a sum of: cells, or nodes, with weights.
    pub fn knots(&self, wavelength: f64) -> Taps {
        match self.cells {
            Some(_) => self.around(wavelength),
            None => hermite(&self.wavelengths, wavelength).taps().collect(),
        }
    }

    /// The logarithm of light at one of these, where it has these logarithms at the nodes.
    pub fn at_knot(&self, knot: usize, logarithms: &[f64]) -> f64 {
        let Some(cells) = &self.cells else {
            return logarithms[knot];
        };
        let light = |term: &Term| term.share * power(&term.taps, logarithms);
        cells[knot].iter().map(light).sum::<f64>().ln()
    }

    /// What bands from one wavelength to another can be sums of: terms, or wavelengths between the nodes.
    pub fn pieces(&self, range: [f64; 2]) -> Vec<Taps> {
        let Some(cells) = &self.cells else {
            let taps = |&l: &f64| hermite(&self.wavelengths, l).taps().collect();
            return spread(&self.wavelengths, range).iter().map(taps).collect();
        };
        if let Some(taps) = self.smooth(range) {
            return vec![taps];
        }
        let last = self.wavelengths.len() - 1;
        let first = self.wavelengths.partition_point(|&l| l <= range[0]).max(1) - 1;
        let end = self
            .wavelengths
            .partition_point(|&l| l < range[1])
            .min(last);
        let terms = cells[first..=end].iter().flatten();
        let mut taps: Vec<&Taps> = terms.filter(|t| t.share > 0.0).map(|t| &t.taps).collect();
        taps.dedup();
        let step = taps.len().div_ceil(MOST_TERMS);
        taps.into_iter().step_by(step.max(1)).cloned().collect()
    }

    /// The taps of a single wavelength between cells without absorption lines: that is no sum.
    fn smooth(&self, [first, last]: [f64; 2]) -> Option<Taps> {
        let cells = self.cells.as_ref().filter(|_| first == last)?;
        let mut sum = Taps::new();
        for (cell, near) in self.around(first) {
            let [term] = cells[cell].as_slice() else {
                return None;
            };
            for &(node, weight) in &term.taps {
                match sum.iter_mut().find(|tap| tap.0 == node) {
                    Some(tap) => tap.1 += near * weight,
                    None => sum.push((node, near * weight)),
                }
            }
        }
        Some(sum)
    }

    /// Extinction without lines at a visibility node, `[constituent]`.
    pub fn extinction(&self, visibility: usize, wavelength: f64) -> Vec<f64> {
        let n = self.wavelengths.len();
        let stencil = match self.cells {
            Some(_) => linear(&self.wavelengths, wavelength),
            // Between nodes without a spectrum transmittance is what the rule for radiance makes of it.
            None => hermite(&self.wavelengths, wavelength),
        };
        let at = |k: usize| {
            let row = &self.extinction[(visibility * self.constituents + k) * n..][..n];
            stencil
                .taps()
                .map(|(i, w)| w * row[i])
                .sum::<f64>()
                .max(0.0)
        };
        (0..self.constituents).map(at).collect()
    }

    /// The cells, or nodes, beside a wavelength, with weights of absorption by lines.
    pub fn around(&self, wavelength: f64) -> Taps {
        linear(&self.wavelengths, wavelength).taps().collect()
    }

    /// What lines add to the extinction in the shares of a wavelength: share and extinction, `[constituent]`.
    pub fn lines(&self, wavelength: f64) -> Vec<(f64, Vec<f64>)> {
        let mut lines: Vec<(f64, Vec<f64>)> = Vec::new();
        for (knot, weight) in self.around(wavelength) {
            for (share, extinction) in self.lines_at(knot) {
                let share = weight * share;
                match lines.iter_mut().find(|(_, k)| *k == extinction) {
                    Some(same) => same.0 += share,
                    None => lines.push((share, extinction)),
                }
            }
        }
        lines
    }

    /// The same at a cell or a node.
    pub fn lines_at(&self, knot: usize) -> Vec<(f64, Vec<f64>)> {
        let Some(cells) = &self.cells else {
            return vec![(1.0, vec![0.0; self.constituents])];
        };
        let terms = cells[knot].iter().filter(|term| term.share > 0.0);
        terms
            .map(|term| (term.share, term.extinction.clone()))
            .collect()
    }

    pub fn visibilities(&self) -> usize {
        self.visibilities
    }

    pub fn constituents(&self) -> usize {
        self.constituents
    }
}

/// Radiance with these logarithms at the nodes.
pub(super) fn power(taps: &Taps, logarithms: &[f64]) -> f64 {
    let terms = taps.iter().map(|&(n, w)| w * logarithms[n]);
    terms.sum::<f64>().exp()
}
