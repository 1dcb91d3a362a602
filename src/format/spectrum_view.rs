//! What lies between the wavelength nodes (kind 9), in place. Format specification, section 6.9.

use zerocopy::little_endian::{F32, F64, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::layout::Shape;
use super::views::{check_length, take};
use crate::error::{Error, Result};

/// Most cells.
const MAX_CELLS: u32 = 4096;
/// Most taps of a cell.
pub const MAX_TAPS: usize = 16;
/// Most terms of a cell.
pub const MAX_TERMS: usize = 16;
/// Most example spectra.
const MAX_EXAMPLES: u32 = 1024;
/// Largest magnitude of a weight.
const HEAVIEST: f32 = 1e3;
/// Largest extinction coefficient, m⁻¹.
const DENSEST: f32 = 1e6;
/// Largest magnitude of a logarithm of radiance.
const BRIGHTEST: f32 = 100.0;

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(super) struct SpectrumCounts {
    pub cells: U32,
    pub taps: U32,
    pub terms: U32,
    pub examples: U32,
}

/// What lies between the wavelength nodes, and what absorption lines make of it.
///
/// A *cell* is a wavelength whose radiance is the exponential of a weighted sum of the logarithms at a few nodes, its
/// *taps*. Its *terms* are the shares of its band in which lines absorb more or less.
///
/// ```
/// use welkin::format::{Kind, SpectrumView, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let head = &contents.head;
/// if let Some(entry) = contents.directory.iter().find(|e| e.kind == Kind::Spectrum) {
///     let bytes = &file[entry.offset..][..entry.length];
///     let (shape, visibilities) = (head.shape(), head.visibilities.len());
///     let view = SpectrumView::new(bytes, &shape, visibilities, head.solar_range())?;
///     assert_eq!(view.tap_weight.len(), view.wavelength.len() * view.taps);
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SpectrumView<'a> {
    /// Taps per cell.
    pub taps: usize,
    /// Terms per cell.
    pub terms: usize,
    /// The cells, nm, strictly increasing.
    pub wavelength: &'a [F64],
    /// Nodes that a cell is made of, `[cells][taps]`.
    pub tap_node: &'a [U32],
    /// Their weights, `[cells][taps]`.
    pub tap_weight: &'a [F32],
    /// Extinction without absorption lines where the profile is 1, m⁻¹, `[visibilities][constituents][cells]`.
    pub extinction: &'a [F32],
    /// Shares of the band, `[cells][terms]`, of sum 1.
    pub term_weight: &'a [F32],
    /// Extinction by lines in each share where the profile is 1, m⁻¹, `[cells][terms][constituents]`.
    pub term_extinction: &'a [F32],
    /// ln L (sr⁻¹) of some skies of the model, `[examples][nodes]`.
    pub example: &'a [F32],
}

impl<'a> SpectrumView<'a> {
    /// Views the bytes of a raw chunk of a model with this shape, number of visibilities, and first and last sample of
    /// the solar spectrum (nm).
    ///
    /// # Errors
    /// [`Error::Invalid`] if they break the specification.
    pub fn new(
        bytes: &'a [u8],
        shape: &Shape,
        visibilities: usize,
        solar: [f64; 2],
    ) -> Result<Self> {
        let mut rest = bytes;
        let counts = take::<SpectrumCounts>(&mut rest, 1)?[0];
        let cells = within(counts.cells, 2, MAX_CELLS)?;
        let taps = within(counts.taps, 1, MAX_TAPS as u32)?;
        let terms = within(counts.terms, 1, MAX_TERMS as u32)?;
        let examples = within(counts.examples, 0, MAX_EXAMPLES)?;
        let (nodes, constituents) = (shape.wavelengths, shape.constituents);
        let extinctions = visibilities * constituents * cells;
        let term_extinctions = cells * terms * constituents;
        let singles =
            cells * (2 * taps + terms) + extinctions + term_extinctions + examples * nodes;
        let expected = size_of::<SpectrumCounts>() + 8 * cells + 4 * singles;
        check_length("spectrum chunk", bytes, expected)?;
        let view = Self {
            taps,
            terms,
            wavelength: take(&mut rest, cells)?,
            tap_node: take(&mut rest, cells * taps)?,
            tap_weight: take(&mut rest, cells * taps)?,
            extinction: take(&mut rest, extinctions)?,
            term_weight: take(&mut rest, cells * terms)?,
            term_extinction: take(&mut rest, term_extinctions)?,
            example: take(&mut rest, examples * nodes)?,
        };
        view.check(nodes, solar)?;
        Ok(view)
    }

    fn check(&self, nodes: usize, [start, end]: [f64; 2]) -> Result<()> {
        let (first, last) = (start.max(1.0), end.min(1e6));
        let mut cells = self.wavelength.iter().map(|l| l.get());
        let mut pairs = self.wavelength.windows(2);
        require(
            cells.all(|l| (first..=last).contains(&l))
                && pairs.all(|pair| pair[0].get() < pair[1].get()),
            "cells must increase strictly within the solar spectrum",
        )?;
        let mut taps = self.tap_node.iter();
        require(
            taps.all(|n| (n.get() as usize) < nodes),
            "a tap is no node of the file",
        )?;
        for (values, [low, high], detail) in [
            (
                self.tap_weight,
                [-HEAVIEST, HEAVIEST],
                "weights of taps must lie in -1e3..=1e3",
            ),
            (
                self.extinction,
                [0.0, DENSEST],
                "extinction must lie in 0..=1e6",
            ),
            (
                self.term_weight,
                [0.0, 1.0],
                "weights of terms must lie in 0..=1",
            ),
            (
                self.term_extinction,
                [0.0, DENSEST],
                "extinction of terms must lie in 0..=1e6",
            ),
            (
                self.example,
                [-BRIGHTEST, BRIGHTEST],
                "examples must lie in -100..=100",
            ),
        ] {
            let mut values = values.iter();
            require(values.all(|v| (low..=high).contains(&v.get())), detail)?;
        }
        let mut shares = self.term_weight.chunks_exact(self.terms);
        let sums_to_one = |row: &[F32]| {
            let sum: f64 = row.iter().map(|w| f64::from(w.get())).sum();
            (sum - 1.0).abs() <= 1e-5
        };
        require(
            shares.all(sums_to_one),
            "weights of the terms of a cell must add up to 1",
        )
    }
}

fn within(got: U32, least: u32, most: u32) -> Result<usize> {
    require(
        (least..=most).contains(&got.get()),
        "a count is out of its range",
    )?;
    Ok(got.get() as usize)
}

fn require(holds: bool, detail: &'static str) -> Result<()> {
    match holds {
        true => Ok(()),
        false => Err(Error::invalid("spectrum chunk", detail)),
    }
}
