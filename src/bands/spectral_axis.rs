//! What light and air are between the nodes of a model. Format specification, sections 7.3 and 7.6.

use zerocopy::little_endian::F32;

use crate::error::Result;
use crate::format::{Head, SpectrumView};
use crate::kernel::axis::{hermite, linear};
use crate::model::Model;

/// Weights of nodes, or shares of exponentials.
type Taps = Vec<(usize, f64)>;

/// Radiance and extinction at any wavelength of a model.
pub(super) struct SpectralAxis {
    /// Where the rules between have their kinks: the cells of the spectrum, or the nodes. nm.
    pub wavelengths: Vec<f64>,
    /// Weights of the nodes at each cell; `None` without a spectrum.
    cells: Option<Vec<Taps>>,
    visibilities: usize,
    constituents: usize,
    /// K where the profile is 1, m⁻¹, `[visibility][constituent][wavelength]`.
    extinction: Vec<f64>,
    /// What lines add, per wavelength; one of share 1 that is nothing without a spectrum.
    terms: Vec<Vec<Term>>,
}

/// A share of a band with its extinction by lines.
#[derive(Clone)]
pub(super) struct Term {
    pub share: f64,
    /// m⁻¹ where the profile of each constituent is 1.
    pub extinction: Vec<f64>,
}

impl Term {
    /// The whole of a band without lines.
    fn none(head: &Head) -> Self {
        Self {
            share: 1.0,
            extinction: vec![0.0; head.constituents],
        }
    }
}

impl SpectralAxis {
    pub fn new(model: &Model) -> Result<Self> {
        let head = model.head();
        let axis = Self {
            terms: head
                .wavelengths
                .iter()
                .map(|_| vec![Term::none(head)])
                .collect(),
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
        let nodes = spectrum.tap_node.iter().map(|n| n.get() as usize);
        let taps: Taps = nodes.zip(spectrum.tap_weight.iter().map(wide)).collect();
        let shares = spectrum.term_weight.iter();
        let terms = shares.zip(spectrum.term_extinction.chunks(self.constituents));
        let terms: Vec<Term> = terms
            .map(|(share, extinction)| Term {
                share: wide(share),
                extinction: extinction.iter().map(wide).collect(),
            })
            .collect();
        Self {
            wavelengths: spectrum.wavelength.iter().map(|l| l.get()).collect(),
            cells: Some(taps.chunks(spectrum.taps).map(<[_]>::to_vec).collect()),
            extinction: spectrum.extinction.iter().map(wide).collect(),
            terms: terms.chunks(spectrum.terms).map(<[_]>::to_vec).collect(),
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

    /// Weights with which the logarithms of the radiance at the nodes make that at a wavelength.
    pub fn weights(&self, wavelength: f64) -> Taps {
        let Some(cells) = &self.cells else {
            return hermite(&self.wavelengths, wavelength).taps().collect();
        };
        let mut out: Taps = Vec::new();
        for (cell, share) in linear(&self.wavelengths, wavelength).taps() {
            for &(node, weight) in &cells[cell] {
                match out.iter_mut().find(|known| known.0 == node) {
                    Some(known) => known.1 += share * weight,
                    None => out.push((node, share * weight)),
                }
            }
        }
        out.retain(|tap| tap.1 != 0.0);
        out
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

    /// The cells around a wavelength with their shares.
    pub fn cells(&self, wavelength: f64) -> impl Iterator<Item = (usize, f64)> {
        linear(&self.wavelengths, wavelength)
            .taps()
            .collect::<Taps>()
            .into_iter()
    }

    /// What lines add in a cell.
    pub fn terms(&self, cell: usize) -> &[Term] {
        &self.terms[cell]
    }

    pub fn visibilities(&self) -> usize {
        self.visibilities
    }

    pub fn constituents(&self) -> usize {
        self.constituents
    }
}
