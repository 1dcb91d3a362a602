//! Densities of the air over altitude (kind 4). Format specification, section 6.4.

use core::mem::offset_of;
use core::ops::Range;

use zerocopy::little_endian::{F32, F64, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::matrix::narrow;
use super::payload_bytes::check;
use super::views::{check_length, take};
use crate::error::{Error, Number, Result};

/// Most layers that a chunk can have.
pub const MAX_LAYERS: usize = 1024;
/// Largest density (a density is 1 where a profile is 1).
const DENSEST: f32 = 1e6;

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct Counts {
    layers: U32,
    reserved: U32,
}

/// Bytes of `reserved` in the payload.
pub(super) const RESERVED: Range<usize> =
    offset_of!(Counts, reserved)..offset_of!(Counts, reserved) + size_of::<U32>();

/// Piecewise quadratic densities.
///
/// ```
/// use welkin::format::{DensityView, Kind, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let mut directory = contents.directory.iter();
/// let entry = directory.find(|e| e.kind == Kind::Transmittance).expect("the default model has one");
/// let bytes = &file[entry.offset..][..entry.length];
/// let head = &contents.head;
/// let view = DensityView::new(bytes, head.constituents, head.planet.top)?;
/// let layers = view.edges.len() - 1;
/// assert_eq!(view.density.len(), (2 * layers + 1) * head.constituents);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DensityView<'a> {
    /// Edges of the layers, m above the ground, `[layers + 1]`.
    pub edges: &'a [F64],
    /// Bernstein coefficients, `[2 · layers + 1][constituents]`.
    pub density: &'a [F32],
}

impl<'a> DensityView<'a> {
    /// Views the bytes of a raw chunk of an atmosphere with the given top (m).
    ///
    /// # Errors
    /// [`Error::Invalid`] if they break the specification.
    pub fn new(bytes: &'a [u8], constituents: usize, top: f64) -> Result<Self> {
        let mut rest = bytes;
        let counts = take::<Counts>(&mut rest, 1)?[0];
        let layers = counts.layers.get() as usize;
        if !(1..=MAX_LAYERS).contains(&layers) {
            let detail = format!("expected 1..={MAX_LAYERS} layers, got {layers}");
            return Err(Error::invalid("transmittance chunk", detail));
        }
        let rows = 2 * layers + 1;
        let expected = size_of::<Counts>() + 8 * (layers + 1) + 4 * rows * constituents;
        check_length("transmittance chunk", bytes, expected)?;
        let view = Self {
            edges: take(&mut rest, layers + 1)?,
            density: take(&mut rest, rows * constituents)?,
        };
        view.check(top)?;
        Ok(view)
    }

    fn check(&self, top: f64) -> Result<()> {
        let broken = |detail: String| Err(Error::invalid("transmittance chunk", detail));
        let [first, last] = [self.edges[0].get(), self.edges[self.edges.len() - 1].get()];
        if first != 0.0 || last != top {
            return broken(format!(
                "layers must reach from 0 to {} m, not {} to {}",
                Number(top),
                Number(first),
                Number(last)
            ));
        }
        // A millimetre, so that no layer is too thin for the arithmetic of a reader.
        if let Some(pair) = self
            .edges
            .windows(2)
            .find(|e| e[1].get() - e[0].get() < 1e-3 || e[1].get().is_nan())
        {
            let [below, above] = [pair[0], pair[1]].map(|edge| Number(edge.get()));
            return broken(format!("edge {above} must lie above {below}"));
        }
        match self
            .density
            .iter()
            .find(|d| !(0.0..=DENSEST).contains(&d.get()))
        {
            None => Ok(()),
            Some(d) => {
                let got = Number(d.get().into());
                broken(format!("densities must lie in 0..={DENSEST}, got {got}"))
            }
        }
    }
}

/// Piecewise quadratic densities to be written.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let table = chunks.iter().find_map(|chunk| match &chunk.payload {
///     Payload::Transmittance(table) => Some(table),
///     _ => None,
/// });
/// let table = table.expect("the default model has one");
/// assert_eq!(table.edges.last(), Some(&head.planet.top));
/// assert_eq!(table.density.len(), (2 * table.edges.len() - 1) * head.constituents);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DensityTable {
    /// Edges of the layers, m above the ground: 0 first, the top of the atmosphere last.
    pub edges: Vec<f64>,
    /// Bernstein coefficients, `[2 · layers + 1][constituents]`.
    pub density: Vec<f32>,
}

impl DensityTable {
    pub(super) fn encode(&self, constituents: usize, top: f64) -> Result<Vec<u8>> {
        let layers = self.edges.len().saturating_sub(1);
        check("density", &self.density, (2 * layers + 1) * constituents)?;
        let counts = Counts {
            layers: U32::new(layers as u32),
            reserved: U32::ZERO,
        };
        let mut bytes = counts.as_bytes().to_vec();
        bytes.extend(self.edges.iter().flat_map(|e| e.to_le_bytes()));
        bytes.extend(self.density.iter().flat_map(|d| d.to_le_bytes()));
        DensityView::new(&bytes, constituents, top)?;
        Ok(bytes)
    }
}

impl From<&DensityView<'_>> for DensityTable {
    fn from(view: &DensityView) -> Self {
        Self {
            edges: view.edges.iter().map(|e| e.get()).collect(),
            density: narrow(view.density),
        }
    }
}
