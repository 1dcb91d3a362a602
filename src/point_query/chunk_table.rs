//! Where the chunks of a file are: found in constant time, without allocation.

use zerocopy::little_endian::U32;

use super::head_view::HeadView;
use crate::error::{Error, Result};
use crate::format::{
    BasisView, ColumnView, ENCODING_RAW, EstimateView, FIELD_ESTIMATE_SHIFT, FactorsView,
    KIND_COLUMN, KIND_ESTIMATE, KIND_RADIANCE, KIND_RADIANCE_BASIS, KIND_SPECTRUM, RawEntry,
    SpectrumView,
};

/// Most chunks of radiance, and most altitudes.
pub(super) const MOST_CHUNKS: usize = 256;
pub(super) const MOST_ALTITUDES: usize = 64;

/// Chunks by altitude and visibility.
pub(crate) struct Chunks<'a> {
    visibilities: usize,
    radiance: [Option<FactorsView<'a>>; MOST_CHUNKS],
    column: [Option<ColumnView<'a>>; MOST_ALTITUDES],
    basis: Option<BasisView<'a>>,
}

impl<'a> Chunks<'a> {
    /// None yet.
    pub fn new(head: &HeadView) -> Result<Self> {
        let (altitudes, visibilities) = (head.altitudes.len(), head.visibilities.len());
        limit("altitudes", altitudes, MOST_ALTITUDES)?;
        limit("radiance chunks", altitudes * visibilities, MOST_CHUNKS)?;
        Ok(Self {
            visibilities,
            radiance: [None; MOST_CHUNKS],
            column: [None; MOST_ALTITUDES],
            basis: None,
        })
    }

    /// All chunks of a file whose payload is raw. Their values are not looked at.
    pub fn of_file(head: &HeadView, bytes: &'a [u8]) -> Result<Self> {
        let mut chunks = Self::new(head)?;
        for (i, entry) in head.directory.iter().enumerate() {
            let kind = entry.kind.get();
            if ![KIND_RADIANCE, KIND_COLUMN, KIND_RADIANCE_BASIS].contains(&kind) {
                continue;
            }
            let payload = payload(i, entry, bytes)?;
            let place = [entry.altitude.get(), entry.visibility.get()].map(usize::from);
            chunks.insert(head, kind, place, entry.rank.get() as usize, payload)?;
        }
        Ok(chunks)
    }

    /// Adds a chunk that stands at an altitude and a visibility; where it has none, the index does not matter.
    pub fn insert(
        &mut self,
        head: &HeadView,
        kind: u32,
        [altitude, visibility]: [usize; 2],
        rank: usize,
        payload: &'a [u8],
    ) -> Result<()> {
        let outside = || Error::invalid("directory", "an index is beyond its axis");
        let shape = &head.shape;
        match kind {
            KIND_RADIANCE => {
                let known = altitude < head.altitudes.len() && visibility < self.visibilities;
                let place = altitude * self.visibilities + visibility;
                let slot = self.radiance.get_mut(place).filter(|_| known);
                *slot.ok_or_else(outside)? = Some(FactorsView::radiance(payload, shape, rank)?);
            }
            KIND_COLUMN => {
                let slot = self.column.get_mut(altitude).ok_or_else(outside)?;
                *slot = Some(ColumnView::new(payload, shape)?);
            }
            _ => self.basis = Some(BasisView::radiance(payload, shape, rank)?),
        }
        Ok(())
    }

    #[inline(always)]
    pub fn radiance(&self, altitude: usize, visibility: usize) -> Option<&FactorsView<'a>> {
        self.radiance[altitude * self.visibilities + visibility].as_ref()
    }

    #[inline(always)]
    pub fn column(&self, altitude: usize) -> Option<&ColumnView<'a>> {
        self.column[altitude].as_ref()
    }

    pub fn basis(&self) -> Option<&BasisView<'a>> {
        self.basis.as_ref()
    }
}

/// The raw bytes of chunk `i` of a file.
fn payload<'a>(i: usize, entry: &RawEntry, bytes: &'a [u8]) -> Result<&'a [u8]> {
    let got = entry.encoding.get();
    if got != ENCODING_RAW {
        return Err(Error::Encoding { chunk: i, got });
    }
    let start = usize::try_from(entry.offset.get()).ok();
    let start = start.and_then(|start| bytes.get(start..));
    let length = usize::try_from(entry.stored_length.get()).unwrap_or(usize::MAX);
    let payload = start.and_then(|rest| rest.get(..length));
    payload.ok_or_else(|| Error::invalid("directory", "a chunk reaches beyond the end of the file"))
}

/// The spectrum of a file, if it has one.
pub(super) fn spectrum_of_file<'a>(
    head: &HeadView,
    bytes: &'a [u8],
) -> Result<Option<SpectrumView<'a>>> {
    let mut entries = head.directory.iter().enumerate();
    let Some((i, entry)) = entries.find(|(_, entry)| entry.kind.get() == KIND_SPECTRUM) else {
        return Ok(None);
    };
    let payload = payload(i, entry, bytes)?;
    SpectrumView::new(
        payload,
        &head.shape,
        head.visibilities.len(),
        head.solar_range(),
    )
    .map(Some)
}

/// The estimates of a file, if it has them.
pub(super) fn estimate_of_file<'a>(
    head: &HeadView,
    bytes: &'a [u8],
) -> Result<Option<EstimateView<'a>>> {
    let mut entries = head.directory.iter().enumerate();
    let Some((i, entry)) = entries.find(|(_, entry)| entry.kind.get() == KIND_ESTIMATE) else {
        return Ok(None);
    };
    let payload = payload(i, entry, bytes)?;
    let (shape, top) = (&head.shape, head.planet.top);
    let view = EstimateView::new(payload, shape.constituents, shape.wavelengths, top)?;
    let count = view.scatters.len();
    let estimate = |code: &U32| (code.get() >> FIELD_ESTIMATE_SHIFT) as usize;
    match head.fields.iter().all(|code| estimate(code) < count) {
        true => Ok(Some(view)),
        false => Err(Error::invalid(
            "field",
            "is relative to an estimate that the file does not have",
        )),
    }
}

/// Refuses what is too large for the fixed arrays of this evaluator.
pub(super) fn limit(what: &'static str, got: usize, most: usize) -> Result<()> {
    match got <= most {
        true => Ok(()),
        false => Err(Error::Limit { what, most, got }),
    }
}
