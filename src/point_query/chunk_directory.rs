//! The directory, checked in place. Format specification, section 5.

use super::chunk_table::{MOST_ALTITUDES, MOST_CHUNKS};
use super::head_counts::require;
use super::head_view::{HeadView, Rest};
use crate::error::Result;
use crate::format::{
    CHUNK_ALIGNMENT, ENCODING_RAW, FEATURE_ESTIMATE, FEATURE_SPECTRUM, KIND_AXIS, KIND_COLUMN,
    KIND_ESTIMATE, KIND_POLARISATION, KIND_POLARISATION_BASIS, KIND_RADIANCE, KIND_RADIANCE_BASIS,
    KIND_SOURCE, KIND_SPECTRUM, MAX_RANK, MOST_EXPANSION, NO_INDEX, RawEntry,
};

const KINDS: usize = KIND_AXIS as usize + 1;

pub(super) fn check(head: &HeadView, rest: &Rest) -> Result<()> {
    let rule = |holds, detail| require(holds, "directory", detail);
    let mut seen = Seen::new(head);
    let mut ranks = [0; KINDS];
    let mut end = rest.head_length;
    for entry in head.directory {
        let (offset, stored) = (entry.offset.get(), entry.stored_length.get());
        let start = end.next_multiple_of(CHUNK_ALIGNMENT);
        rule(offset == start, "a chunk is out of its place")?;
        let next = offset.checked_add(stored);
        end = next
            .filter(|&end| end <= head.file_length)
            .unwrap_or(u64::MAX);
        rule(end <= head.file_length, "a chunk reaches beyond the file")?;
        if !is_known(entry) {
            continue;
        }
        rule(fits_axes(head, entry), "an index does not fit its kind")?;
        rule(has_rank(entry), "a rank is out of its range")?;
        rule(entry.tier.get() == 0, "expected tier 0")?;
        let errors = [entry.error_median, entry.error_p99];
        let sound = errors.iter().all(|e| (0.0..=f32::MAX).contains(&e.get()));
        rule(sound, "expected errors that are finite and not negative")?;
        rule(has_length(head, entry), "a chunk has a wrong length")?;
        rule(seen.is_new(entry), "a chunk appears twice")?;
        let most = &mut ranks[entry.kind.get() as usize];
        *most = entry.rank.get().max(*most);
    }
    for (basis, kind) in [
        (KIND_RADIANCE_BASIS, KIND_RADIANCE),
        (KIND_POLARISATION_BASIS, KIND_POLARISATION),
    ] {
        let [basis, most] = [basis, kind].map(|kind| ranks[kind as usize]);
        rule(
            basis == 0 || most <= basis,
            "a rank is above that of its basis",
        )?;
    }
    let kinds = head.directory.iter().map(|entry| entry.kind.get());
    for (feature, kind, detail) in [
        (
            FEATURE_SPECTRUM,
            KIND_SPECTRUM,
            "must have bit 0 where there is a spectrum chunk, and only there",
        ),
        (
            FEATURE_ESTIMATE,
            KIND_ESTIMATE,
            "must have bit 1 where there is an estimate chunk, and only there",
        ),
    ] {
        let declared = rest.required_features & feature != 0;
        let there = kinds.clone().any(|found| found == kind);
        require(declared == there, "required_features", detail)?;
    }
    rule(
        end == head.file_length,
        "the last chunk is not the end of the file",
    )
}

pub(super) fn is_known(entry: &RawEntry) -> bool {
    (KIND_RADIANCE..=KIND_AXIS).contains(&entry.kind.get())
}

fn fits_axes(head: &HeadView, entry: &RawEntry) -> bool {
    let fits = |index: u16, belongs: bool, count: usize| match belongs {
        true => usize::from(index) < count,
        false => index == NO_INDEX,
    };
    let [high, seen] = belongs(entry);
    fits(entry.altitude.get(), high, head.altitudes.len())
        && fits(entry.visibility.get(), seen, head.visibilities.len())
}

/// Whether chunks of the kind belong to an altitude, and to a visibility.
fn belongs(entry: &RawEntry) -> [bool; 2] {
    match entry.kind.get() {
        KIND_RADIANCE | KIND_POLARISATION => [true, true],
        KIND_COLUMN => [true, false],
        KIND_SOURCE => [false, true],
        _ => [false, false],
    }
}

fn has_rank(entry: &RawEntry) -> bool {
    let rank = entry.rank.get() as usize;
    match entry.kind.get() {
        KIND_RADIANCE | KIND_RADIANCE_BASIS | KIND_POLARISATION | KIND_POLARISATION_BASIS => {
            (1..=MAX_RANK).contains(&rank)
        }
        _ => rank == 0,
    }
}

/// The payload is as long as rank and counts say, where they do, and the stored bytes can hold it.
fn has_length(head: &HeadView, entry: &RawEntry) -> bool {
    let (shape, rank) = (&head.shape, entry.rank.get() as usize);
    let (stored, decoded) = (entry.stored_length.get(), entry.raw_length.get());
    let expected = match entry.kind.get() {
        KIND_RADIANCE => shape.radiance_bytes(rank) as u64,
        KIND_COLUMN => shape.column_bytes() as u64,
        KIND_RADIANCE_BASIS => shape.basis_bytes(rank) as u64,
        KIND_POLARISATION => shape.polarisation_bytes(rank) as u64,
        KIND_POLARISATION_BASIS => shape.polarisation_basis_bytes(rank) as u64,
        _ => decoded,
    };
    let possible = match entry.encoding.get() {
        ENCODING_RAW => stored == expected,
        _ => expected <= stored.saturating_mul(MOST_EXPANSION as u64),
    };
    decoded == expected && possible
}

/// The places of chunks that went by; for files that the evaluator has room for.
struct Seen {
    has_room: bool,
    visibilities: usize,
    places: [[u64; MOST_CHUNKS / 64]; KINDS],
}

impl Seen {
    fn new(head: &HeadView) -> Self {
        let (altitudes, visibilities) = (head.altitudes.len(), head.visibilities.len());
        Self {
            has_room: altitudes <= MOST_ALTITUDES && altitudes * visibilities <= MOST_CHUNKS,
            visibilities,
            places: [[0; MOST_CHUNKS / 64]; KINDS],
        }
    }

    /// Notes a chunk whose indices fit; false for the second of the same kind and place.
    fn is_new(&mut self, entry: &RawEntry) -> bool {
        if !self.has_room {
            return true;
        }
        let [altitude, visibility] =
            [entry.altitude, entry.visibility].map(|i| usize::from(i.get()));
        let place = match belongs(entry) {
            [true, true] => altitude * self.visibilities + visibility,
            [true, false] => altitude,
            [false, true] => visibility,
            [false, false] => 0,
        };
        let word = &mut self.places[entry.kind.get() as usize][place / 64];
        let bit = 1 << (place % 64);
        let new = *word & bit == 0;
        *word |= bit;
        new
    }
}
