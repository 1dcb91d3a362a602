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
/// use welkin::format::{Chunk, Payload, Spectrum, encode, unpack};
///
/// let (head, mut chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// chunks.retain(|chunk| !matches!(chunk.payload, Payload::Spectrum(_)));
/// let (cells, last) = (2, head.wavelengths.len() - 1);
/// let spectrum = Spectrum {
///     taps: 1,
///     wavelength: vec![head.wavelengths[0], head.wavelengths[last]], // nm
///     first_term: vec![0, 1, 2],
///     term_weight: vec![1.0; cells],
///     term_extinction: vec![0.0; cells * head.constituents], // m⁻¹
///     tap_node: vec![0, last as u32],
///     tap_weight: vec![1.0; cells],
///     extinction: vec![1e-5; head.visibilities.len() * head.constituents * cells], // m⁻¹
///     example: vec![],
/// };
/// chunks.push(Chunk::new(None, None, Payload::Spectrum(spectrum)));
/// let model = Model::from_bytes(encode(&head, &chunks)?)?;
/// assert_eq!(model.wavelength_range()?, [head.wavelengths[0], head.wavelengths[last]]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Taps per term, 1..=16.
    pub taps: usize,
    /// The cells, nm, strictly increasing.
    pub wavelength: Vec<f64>,
    /// First term of each cell, `[cells + 1]`: 0 first, the number of terms last, 1 to 64 terms per cell.
    pub first_term: Vec<u32>,
    /// Shares of the band, `[terms]`, of sum 1 in each cell.
    pub term_weight: Vec<f32>,
    /// Extinction by lines in each share where the profile is 1, m⁻¹, `[terms][constituents]`.
    pub term_extinction: Vec<f32>,
    /// Nodes that a term is made of, `[terms][taps]`.
    pub tap_node: Vec<u32>,
    /// Their weights, `[terms][taps]`; 0 for taps that are not used.
    pub tap_weight: Vec<f32>,
    /// Extinction without absorption lines where the profile is 1, m⁻¹, `[visibilities][constituents][cells]`.
    pub extinction: Vec<f32>,
    /// ln L (sr⁻¹) of some skies of the model, `[examples][nodes]`: what weights of sensors are fitted to.
    pub example: Vec<f32>,
}

impl From<&SpectrumView<'_>> for Spectrum {
    fn from(view: &SpectrumView) -> Self {
        Self {
            taps: view.taps,
            wavelength: view.wavelength.iter().map(|l| l.get()).collect(),
            first_term: view.first_term.iter().map(|g| g.get()).collect(),
            term_weight: narrow(view.term_weight),
            term_extinction: narrow(view.term_extinction),
            tap_node: view.tap_node.iter().map(|n| n.get()).collect(),
            tap_weight: narrow(view.tap_weight),
            extinction: narrow(view.extinction),
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
            terms: count(self.term_weight.len()),
            examples: count(self.example.len() / head.wavelengths.len()),
        };
        let mut bytes = counts.as_bytes().to_vec();
        bytes.extend(self.wavelength.iter().flat_map(|l| l.to_le_bytes()));
        bytes.extend(self.first_term.iter().flat_map(|g| g.to_le_bytes()));
        push_f32(&mut bytes, &self.term_weight);
        push_f32(&mut bytes, &self.term_extinction);
        bytes.extend(self.tap_node.iter().flat_map(|n| n.to_le_bytes()));
        push_f32(&mut bytes, &self.tap_weight);
        push_f32(&mut bytes, &self.extinction);
        push_f32(&mut bytes, &self.example);
        view(head, &bytes)?;
        Ok(bytes)
    }

    /// Lengths that could make up for each other in the length of the payload.
    fn check_lengths(&self, head: &Head) -> Result<()> {
        let (cells, terms, nk) = (
            self.wavelength.len(),
            self.term_weight.len(),
            head.constituents,
        );
        for (what, got, expected) in [
            ("first_term", self.first_term.len(), cells + 1),
            ("tap_node", self.tap_node.len(), terms * self.taps),
        ] {
            if got != expected {
                return Err(Error::Length {
                    what,
                    expected: expected as u64,
                    got: got as u64,
                });
            }
        }
        check("term_weight", &self.term_weight, terms)?;
        check("term_extinction", &self.term_extinction, terms * nk)?;
        check("tap_weight", &self.tap_weight, terms * self.taps)?;
        let extinctions = head.visibilities.len() * nk * cells;
        check("extinction of cells", &self.extinction, extinctions)?;
        let rows = self.example.len() / head.wavelengths.len();
        check("example", &self.example, rows * head.wavelengths.len())
    }
}

/// The payload of a spectrum chunk in a file with this head, checked.
pub(crate) fn view<'a>(head: &Head, bytes: &'a [u8]) -> Result<SpectrumView<'a>> {
    let (shape, visibilities) = (head.shape(), head.visibilities.len());
    SpectrumView::new(bytes, &shape, visibilities, head.solar_range())
}
