//! What lies between the wavelength nodes (kind 9), in place. Format specification, section 6.9.

use core::ops::Range;

use zerocopy::little_endian::{F32, F64, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::layout::Shape;
use super::views::{check_length, take};
use crate::error::{Error, Result};

/// Most cells.
const MAX_CELLS: u32 = 4096;
/// Most taps of a term.
pub const MAX_TAPS: usize = 16;
/// Most terms of all cells, and of one.
const MAX_TERMS: u32 = 65_536;
const MAX_TERMS_OF_CELL: u32 = 64;
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
/// A *cell* is a wavelength. Its *terms* are the shares of its band in which lines absorb more or less; the radiance of
/// each is the exponential of a weighted sum of the logarithms at a few nodes, its *taps*.
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
///     assert_eq!(view.terms(0).start, 0);
///     assert_eq!(view.tap_weight.len(), view.term_weight.len() * view.taps);
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SpectrumView<'a> {
    /// Taps per term.
    pub taps: usize,
    /// The cells, nm, strictly increasing.
    pub wavelength: &'a [F64],
    /// First term of each cell, `[cells + 1]`, the last their number.
    pub first_term: &'a [U32],
    /// Shares of the band, `[terms]`, of sum 1 in each cell.
    pub term_weight: &'a [F32],
    /// Extinction by lines in each share where the profile is 1, m⁻¹, `[terms][constituents]`.
    pub term_extinction: &'a [F32],
    /// Nodes that a term is made of, `[terms][taps]`.
    pub tap_node: &'a [U32],
    /// Their weights, `[terms][taps]`.
    pub tap_weight: &'a [F32],
    /// Extinction without absorption lines where the profile is 1, m⁻¹, `[visibilities][constituents][cells]`.
    pub extinction: &'a [F32],
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
        let view = Self::divide(bytes, shape, visibilities)?;
        view.check_cells(solar)?;
        view.check_numbers(shape.wavelengths)?;
        Ok(view)
    }

    /// The same without a look at the numbers.
    pub(crate) fn divide(bytes: &'a [u8], shape: &Shape, visibilities: usize) -> Result<Self> {
        let mut rest = bytes;
        let counts = take::<SpectrumCounts>(&mut rest, 1)?[0];
        let cells = within(counts.cells, 2, MAX_CELLS)?;
        let taps = within(counts.taps, 1, MAX_TAPS as u32)?;
        let terms = within(counts.terms, cells as u32, MAX_TERMS)?;
        let examples = within(counts.examples, 0, MAX_EXAMPLES)?;
        let (nodes, constituents) = (shape.wavelengths, shape.constituents);
        let extinctions = visibilities * constituents * cells;
        let of_terms = terms * (1 + constituents + 2 * taps);
        let singles = (cells + 1) + of_terms + extinctions + examples * nodes;
        let expected = size_of::<SpectrumCounts>() + 8 * cells + 4 * singles;
        check_length("spectrum chunk", bytes, expected)?;
        Ok(Self {
            taps,
            wavelength: take(&mut rest, cells)?,
            first_term: take(&mut rest, cells + 1)?,
            term_weight: take(&mut rest, terms)?,
            term_extinction: take(&mut rest, terms * constituents)?,
            tap_node: take(&mut rest, terms * taps)?,
            tap_weight: take(&mut rest, terms * taps)?,
            extinction: take(&mut rest, extinctions)?,
            example: take(&mut rest, examples * nodes)?,
        })
    }

    /// The terms of a cell.
    pub fn terms(&self, cell: usize) -> Range<usize> {
        let [first, end] = [cell, cell + 1].map(|c| self.first_term[c].get() as usize);
        first..end
    }

    fn check_cells(&self, [start, end]: [f64; 2]) -> Result<()> {
        let (first, last) = (start.max(1.0), end.min(1e6));
        let mut cells = self.wavelength.iter().map(|l| l.get());
        let mut pairs = self.wavelength.windows(2);
        require(
            cells.all(|l| (first..=last).contains(&l))
                && pairs.all(|pair| pair[0].get() < pair[1].get()),
            "cells must increase strictly within the solar spectrum",
        )?;
        let bounds = self.first_term;
        let mut pairs = bounds.windows(2);
        let has_few = |pair: &[U32]| {
            let count = pair[1].get().checked_sub(pair[0].get());
            count.is_some_and(|count| (1..=MAX_TERMS_OF_CELL).contains(&count))
        };
        let ends = [0, bounds.len() - 1].map(|i| bounds[i].get() as usize);
        require(
            ends == [0, self.term_weight.len()] && pairs.all(has_few),
            "cells must share the terms, 1 to 64 each",
        )?;
        let mut cells = 0..self.wavelength.len();
        let sums_to_one = |cell| {
            let shares = self.term_weight[self.terms(cell)].iter();
            let sum: f64 = shares.map(|w| f64::from(w.get())).sum();
            (sum - 1.0).abs() <= 1e-5
        };
        require(
            cells.all(sums_to_one),
            "weights of the terms of a cell must add up to 1",
        )
    }

    fn check_numbers(&self, nodes: usize) -> Result<()> {
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
        Ok(())
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
