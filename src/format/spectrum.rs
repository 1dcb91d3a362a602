//! What lies between the wavelength nodes (kind 9), to be written. Format specification, section 6.9.

use zerocopy::IntoBytes;
use zerocopy::little_endian::U32;

use super::head::Head;
use super::matrix::{columns, narrow, rows};
use super::payload_bytes::{check, push_f32};
use super::spectrum_view::{SpectrumCounts, SpectrumView};
use crate::error::{Error, Result};

/// What lies between the wavelength nodes, to be written: see [`SpectrumView`].
///
/// ```
/// use welkin::Model;
/// use welkin::format::{Chunk, Payload, Spectrum, extend, unpack};
///
/// let (head, _) = unpack(welkin::DEFAULT_MODEL)?;
/// let (cells, last) = (2, head.wavelengths.len() - 1);
/// let spectrum = Spectrum {
///     taps: 1,
///     terms: 1,
///     wavelength: vec![head.wavelengths[0], head.wavelengths[last]], // nm
///     tap_node: vec![0, last as u32],
///     tap_weight: vec![1.0; cells],
///     extinction: vec![1e-5; head.visibilities.len() * head.constituents * cells], // m⁻¹
///     term_weight: vec![1.0; cells],
///     term_extinction: vec![0.0; cells * head.constituents], // m⁻¹
///     example: vec![],
/// };
/// let chunk = Chunk::new(None, None, Payload::Spectrum(spectrum));
/// let model = Model::from_bytes(extend(welkin::DEFAULT_MODEL, &[chunk])?)?;
/// assert_eq!(model.wavelength_range()?, [head.wavelengths[0], head.wavelengths[last]]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Taps per cell, 1..=16.
    pub taps: usize,
    /// Terms per cell, 1..=16.
    pub terms: usize,
    /// The cells, nm, strictly increasing.
    pub wavelength: Vec<f64>,
    /// Nodes that a cell is made of, `[cells][taps]`.
    pub tap_node: Vec<u32>,
    /// Their weights, `[cells][taps]`; 0 for taps that are not used.
    pub tap_weight: Vec<f32>,
    /// Extinction without absorption lines where the profile is 1, m⁻¹, `[visibilities][constituents][cells]`.
    pub extinction: Vec<f32>,
    /// Shares of the band, `[cells][terms]`, of sum 1 in each cell.
    pub term_weight: Vec<f32>,
    /// Extinction by lines in each share where the profile is 1, m⁻¹, `[cells][terms][constituents]`.
    pub term_extinction: Vec<f32>,
    /// ln L (sr⁻¹) of some skies of the model, `[examples][nodes]`: what weights of sensors are fitted to.
    pub example: Vec<f32>,
}

impl From<&SpectrumView<'_>> for Spectrum {
    fn from(view: &SpectrumView) -> Self {
        Self {
            taps: view.taps,
            terms: view.terms,
            wavelength: view.wavelength.iter().map(|l| l.get()).collect(),
            tap_node: view.tap_node.iter().map(|n| n.get()).collect(),
            tap_weight: narrow(view.tap_weight),
            extinction: narrow(view.extinction),
            term_weight: narrow(view.term_weight),
            term_extinction: narrow(view.term_extinction),
            example: narrow(view.example),
        }
    }
}

impl Spectrum {
    /// Leaves out all but these visibilities and nodes of `head`; false where a node is missed that has a weight.
    pub(super) fn keep(&mut self, head: &Head, visibilities: &[usize], nodes: &[usize]) -> bool {
        for (node, &weight) in self.tap_node.iter_mut().zip(&self.tap_weight) {
            *node = match nodes.binary_search(&(*node as usize)) {
                Ok(place) => place as u32,
                Err(_) if weight == 0.0 => 0,
                Err(_) => return false,
            };
        }
        let width = head.constituents * self.wavelength.len();
        self.extinction = rows(&self.extinction, width, visibilities);
        self.example = columns(&self.example, head.wavelengths.len(), nodes);
        true
    }

    pub(super) fn encode(&self, head: &Head) -> Result<Vec<u8>> {
        self.check_lengths(head)?;
        let count = |n: usize| U32::new(n as u32);
        let counts = SpectrumCounts {
            cells: count(self.wavelength.len()),
            taps: count(self.taps),
            terms: count(self.terms),
            examples: count(self.example.len() / head.wavelengths.len()),
        };
        let mut bytes = counts.as_bytes().to_vec();
        bytes.extend(self.wavelength.iter().flat_map(|l| l.to_le_bytes()));
        bytes.extend(self.tap_node.iter().flat_map(|n| n.to_le_bytes()));
        for values in [
            &self.tap_weight,
            &self.extinction,
            &self.term_weight,
            &self.term_extinction,
            &self.example,
        ] {
            push_f32(&mut bytes, values);
        }
        view(head, &bytes)?;
        Ok(bytes)
    }

    /// Lengths that could make up for each other in the length of the payload.
    fn check_lengths(&self, head: &Head) -> Result<()> {
        let (cells, nk) = (self.wavelength.len(), head.constituents);
        if self.tap_node.len() != cells * self.taps {
            return Err(Error::Length {
                what: "tap_node",
                expected: (cells * self.taps) as u64,
                got: self.tap_node.len() as u64,
            });
        }
        check("tap_weight", &self.tap_weight, cells * self.taps)?;
        let extinctions = head.visibilities.len() * nk * cells;
        check("extinction of cells", &self.extinction, extinctions)?;
        check("term_weight", &self.term_weight, cells * self.terms)?;
        let term_extinctions = cells * self.terms * nk;
        check("term_extinction", &self.term_extinction, term_extinctions)?;
        let rows = self.example.len() / head.wavelengths.len();
        check("example", &self.example, rows * head.wavelengths.len())
    }
}

/// The payload of a spectrum chunk in a file with this head, checked.
pub(crate) fn view<'a>(head: &Head, bytes: &'a [u8]) -> Result<SpectrumView<'a>> {
    let (shape, visibilities) = (head.shape(), head.visibilities.len());
    SpectrumView::new(bytes, &shape, visibilities, head.solar_range())
}
