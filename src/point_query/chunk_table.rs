//! Where the chunks of a file are: found in constant time, without allocation.

use super::head_view::HeadView;
use crate::error::{Error, Result};
use crate::format::{
    BasisView, ColumnView, ENCODING_RAW, FactorsView, KIND_COLUMN, KIND_RADIANCE,
    KIND_RADIANCE_BASIS,
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
            if entry.encoding.get() != ENCODING_RAW {
                let got = entry.encoding.get();
                return Err(Error::Encoding { chunk: i, got });
            }
            let range = usize::try_from(entry.offset.get()).ok();
            let start = range.and_then(|start| bytes.get(start..));
            let length = usize::try_from(entry.stored_length.get()).unwrap_or(usize::MAX);
            let payload = start.and_then(|rest| rest.get(..length));
            let payload = payload.ok_or_else(|| {
                Error::invalid("directory", "a chunk reaches beyond the end of the file")
            })?;
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

/// Refuses what is too large for the fixed arrays of this evaluator.
pub(super) fn limit(what: &'static str, got: usize, most: usize) -> Result<()> {
    match got <= most {
        true => Ok(()),
        false => Err(Error::Limit { what, most, got }),
    }
}
