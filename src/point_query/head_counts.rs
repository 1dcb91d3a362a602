//! Counts of a header, so that no product of them overflows. Format specification, section 3.

use crate::error::{Error, Result};
use crate::format::{Header, MAX_TABLE};

/// Refuses counts beyond their limits, so that no product of them overflows.
pub(super) fn check_counts(header: &Header) -> Result<()> {
    let limits = [
        (header.wavelengths, 2, 256),
        (header.altitudes, 1, 1024),
        (header.visibilities, 1, 1024),
        (header.fields, 1, 16),
        (header.constituents, 1, 16),
        (header.alpha_up_intervals, 1, 1024),
        (header.alpha_down_intervals, 1, 1024),
        (header.phi_intervals, 1, 1024),
        (header.elevation_intervals, 1, 1024),
        (header.solar_samples, 2, 16384),
    ];
    let kept = |&(count, least, most): &(zerocopy::little_endian::U16, u16, u16)| {
        (least..=most).contains(&count.get())
    };
    let n = |count: zerocopy::little_endian::U16| u64::from(count.get());
    let rows = n(header.alpha_up_intervals) + 3 + n(header.alpha_down_intervals) + 3;
    let channels = n(header.fields) * n(header.wavelengths);
    let table = rows * (n(header.phi_intervals) + 1) * channels;
    // At most 16 constituents have a bit.
    let last = (1u32 << header.constituents.get().min(16)) - 1;
    require(
        u32::from(header.absorbers()) < last,
        "absorbers",
        "no constituent scatters",
    )?;
    require(
        limits.iter().all(kept) && table <= MAX_TABLE as u64,
        "header",
        "a count is out of its range",
    )
}

pub(super) fn require(holds: bool, what: &'static str, detail: &'static str) -> Result<()> {
    match holds {
        true => Ok(()),
        false => Err(Error::invalid(what, detail)),
    }
}
