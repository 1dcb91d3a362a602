//! Reads and checks the head and the directory of untrusted bytes. Format specification, sections 3, 4, 5 and 8.

use std::collections::HashMap;

use zerocopy::FromBytes;
use zerocopy::little_endian::{F32, F64, U32};

use super::head::{AlphaAxis, Entry, Field, Head, Kind, PhaseFunction};
use super::layout::*;
use crate::error::{Error, Result};
use crate::geometry::Planet;
use crate::kernel::axis::ElevationAxis;

/// Kind, altitude and visibility of a chunk.
pub(crate) type Key = (Kind, Option<usize>, Option<usize>);

/// What the first `head_length` bytes of a file say.
///
/// ```
/// use welkin::format::{Kind, parse};
///
/// let contents = parse(welkin::DEFAULT_MODEL)?;
/// let place = contents.index[&(Kind::Radiance, Some(0), Some(1))];
/// let entry = &contents.directory[place];
/// assert_eq!((entry.altitude, entry.visibility), (Some(0), Some(1)));
/// assert!(entry.offset >= contents.head_length);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Axes, tables and provenance.
    pub head: Head,
    /// The chunks in the order of the file.
    pub directory: Vec<Entry>,
    /// Where a chunk of a known kind stands in the directory.
    pub index: HashMap<Key, usize>,
    /// Length of header, head arrays and directory, bytes.
    pub head_length: usize,
    /// Length of the file, bytes.
    pub file_length: usize,
}

/// Parses the head of a complete file; chunk payloads are not touched.
///
/// Allocates no more than a small multiple of `bytes.len()`.
///
/// # Errors
/// A typed error for everything that section 8 of the specification tells a reader to reject at open.
pub fn parse(bytes: &[u8]) -> Result<Contents> {
    let declared = header(bytes)?.file_length.get();
    if declared != bytes.len() as u64 {
        return Err(truncated(declared, bytes.len()));
    }
    parse_head(bytes)
}

/// Length of the head of a file that starts with `bytes`, compared with its counts.
pub(crate) fn head_length(bytes: &[u8]) -> Result<u64> {
    declared_head_length(&header(bytes)?)
}

/// Parses the head of a file of which `bytes` has at least the head.
pub(crate) fn parse_head(bytes: &[u8]) -> Result<Contents> {
    let header = header(bytes)?;
    let file_length = fits(header.file_length.get())?;
    let head_length = fits(declared_head_length(&header)?)?;
    if head_length > bytes.len().min(file_length) {
        return Err(truncated(head_length as u64, bytes.len().min(file_length)));
    }
    check_crc(&header, &bytes[..head_length])?;
    let mut cursor = Cursor(&bytes[HEADER_LENGTH..head_length]);
    let head = head(&header, &mut cursor)?;
    head.validate()?;
    let padding = (head_length - HEADER_LENGTH - cursor.0.len()).next_multiple_of(8);
    let used = head_length - HEADER_LENGTH - cursor.0.len();
    if cursor.take(padding - used)?.iter().any(|&b| b != 0) {
        return Err(Error::invalid("padding", "expected zeros after metadata"));
    }
    let entries = cursor.take(header.chunk_count.get() as usize * ENTRY_LENGTH)?;
    let (directory, index) = directory(&head, entries, head_length, file_length)?;
    let declared = header.required_features.get() & FEATURE_SPECTRUM != 0;
    if declared != index.contains_key(&(Kind::Spectrum, None, None)) {
        let detail = "must have bit 0 where there is a spectrum chunk, and only there";
        return Err(Error::invalid("required_features", detail));
    }
    if head.estimated != index.contains_key(&(Kind::Estimate, None, None)) {
        let detail = "must have bit 1 where there is an estimate chunk, and only there";
        return Err(Error::invalid("required_features", detail));
    }
    Ok(Contents {
        head,
        directory,
        index,
        head_length,
        file_length,
    })
}

/// A length as this machine counts bytes.
fn fits(length: u64) -> Result<usize> {
    usize::try_from(length).map_err(|_| truncated(length, usize::MAX))
}

fn truncated(expected: u64, got: usize) -> Error {
    Error::Length {
        what: "file (is it truncated?)",
        expected,
        got: got as u64,
    }
}

fn header(bytes: &[u8]) -> Result<Header> {
    let known = bytes.len().min(MAGIC.len());
    if bytes.is_empty() || bytes[..known] != MAGIC[..known] {
        return Err(Error::NotWelkin);
    }
    let (header, _) = Header::read_from_prefix(bytes)
        .map_err(|_| truncated(HEADER_LENGTH as u64, bytes.len()))?;
    let got = header.version_major.get();
    if got != VERSION_MAJOR {
        let expected = VERSION_MAJOR;
        return Err(Error::Version { expected, got });
    }
    match header.unknown_features() {
        0 => Ok(header),
        bits => Err(Error::Feature { bits }),
    }
}

/// Length of the head, after comparing it with the counts.
fn declared_head_length(header: &Header) -> Result<u64> {
    let expected = header.counted_head_length();
    let got = header.head_length.get();
    if got == expected {
        return Ok(got);
    }
    Err(Error::Length {
        what: "head_length",
        expected,
        got,
    })
}

fn check_crc(header: &Header, head: &[u8]) -> Result<()> {
    let got = head_crc(head);
    let expected = header.head_crc32.get();
    if got == expected {
        return Ok(());
    }
    Err(Error::Checksum {
        chunk: None,
        expected,
        got,
    })
}

/// CRC-32 of a head with its own field taken as zero. `head` is at least a header long.
pub(super) fn head_crc(head: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&head[..CRC_RANGE.start]);
    hasher.update(&[0; 4]);
    hasher.update(&head[CRC_RANGE.end..]);
    hasher.finalize()
}

/// Takes arrays off the front of a byte slice.
struct Cursor<'a>(&'a [u8]);

impl<'a> Cursor<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(length).ok_or(Error::Length {
            what: "head",
            expected: length as u64,
            got: self.0.len() as u64,
        })?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<T: FromBytes + Copy, U>(&mut self, n: usize, get: impl Fn(T) -> U) -> Result<Vec<U>> {
        let size = size_of::<T>();
        let bytes = self.take(n * size)?;
        let read = |b| T::read_from_bytes(b).ok().map(&get);
        Ok(bytes.chunks_exact(size).filter_map(read).collect())
    }

    fn f64s(&mut self, n: usize) -> Result<Vec<f64>> {
        self.array(n, F64::get)
    }

    fn f32s(&mut self, n: usize) -> Result<Vec<f32>> {
        self.array(n, F32::get)
    }
}

fn head(header: &Header, cursor: &mut Cursor) -> Result<Head> {
    let nw = usize::from(header.wavelengths.get());
    let nv = usize::from(header.visibilities.get());
    let nf = usize::from(header.fields.get());
    let nk = usize::from(header.constituents.get());
    let ne = usize::from(header.elevation_intervals.get());
    let wavelengths = cursor.f64s(nw)?;
    let altitudes = cursor.f64s(header.altitudes.get().into())?;
    let visibilities = cursor.f64s(nv)?;
    let extinction = cursor.f64s(nv * nk * nw)?;
    let spherical_albedo = cursor.f64s(nv * nw)?;
    let parameters = cursor.f64s(nf * nw)?;
    let xyz = cursor.f64s(3 * nw)?;
    let solar = cursor.f64s(2)?;
    let solar_irradiance = cursor.f32s(header.solar_samples.get().into())?;
    let codes = cursor.array(nf, U32::get)?;
    let metadata = cursor.take(header.metadata_length.get() as usize)?;
    let metadata = core::str::from_utf8(metadata)
        .map_err(|error| Error::invalid("metadata", format!("expected UTF-8: {error}")))?;
    Ok(Head {
        planet: Planet {
            radius: header.planet_radius.get(),
            top: header.top_altitude.get(),
        },
        up: AlphaAxis {
            intervals: header.alpha_up_intervals.get().into(),
            exponent: header.alpha_up_exponent.get(),
        },
        down: AlphaAxis {
            intervals: header.alpha_down_intervals.get().into(),
            exponent: header.alpha_down_exponent.get(),
        },
        phi_intervals: header.phi_intervals.get().into(),
        elevation: ElevationAxis {
            min: header.elevation_min.get(),
            max: header.elevation_max.get(),
            centre: header.elevation_centre.get(),
            width: header.elevation_width.get(),
            intervals: ne,
        },
        wavelengths,
        altitudes,
        visibilities,
        constituents: nk,
        absorbers: header.absorbers(),
        estimated: header.required_features.get() & FEATURE_ESTIMATE != 0,
        extinction,
        spherical_albedo,
        xyz: xyz.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        solar_start: solar[0],
        solar_step: solar[1],
        solar_irradiance,
        fields: fields(&codes, &parameters, nw)?,
        metadata: metadata.to_owned(),
    })
}

fn fields(codes: &[u32], parameters: &[f64], nw: usize) -> Result<Vec<Field>> {
    let field = |(f, &code): (usize, &u32)| {
        let estimate = (code >> FIELD_ESTIMATE_SHIFT) as usize;
        let phase = match code & !FIELD_GROUND & ((1 << FIELD_ESTIMATE_SHIFT) - 1) {
            0 => PhaseFunction::None,
            1 => PhaseFunction::Rayleigh,
            2 => PhaseFunction::HenyeyGreenstein,
            _ => {
                let detail = format!("field {f} has unknown code {code:#x}: use a newer welkin");
                return Err(Error::invalid("field", detail));
            }
        };
        Ok(Field {
            phase,
            ground: code & FIELD_GROUND != 0,
            estimate,
            parameter: parameters[f * nw..(f + 1) * nw].to_vec(),
        })
    };
    codes.iter().enumerate().map(field).collect()
}

type Directory = (Vec<Entry>, HashMap<Key, usize>);

fn directory(head: &Head, bytes: &[u8], head_length: usize, file: usize) -> Result<Directory> {
    let mut entries = Vec::with_capacity(bytes.len() / ENTRY_LENGTH);
    let mut places = HashMap::with_capacity(entries.capacity());
    let mut end = head_length as u64;
    for (index, chunk) in bytes.chunks_exact(ENTRY_LENGTH).enumerate() {
        let broken =
            |detail: String| Error::invalid("directory", format!("chunk {index}: {detail}"));
        let raw = RawEntry::read_from_bytes(chunk).map_err(|e| broken(e.to_string()))?;
        end = check_place(&raw, end, file as u64).map_err(broken)?;
        let entry = entry(&raw);
        check_entry(head, &raw, &entry).map_err(broken)?;
        let key = (entry.kind, entry.altitude, entry.visibility);
        if !matches!(entry.kind, Kind::Unknown(_)) && places.insert(key, index).is_some() {
            return Err(broken("appears twice".to_owned()));
        }
        entries.push(entry);
    }
    check_ranks(&entries)?;
    if end == file as u64 {
        return Ok((entries, places));
    }
    let detail = format!("the last chunk ends at {end}, the file at {file}");
    Err(Error::invalid("directory", detail))
}

/// No radiance chunk has more components than the basis.
fn check_ranks(entries: &[Entry]) -> Result<()> {
    let rank_of = |kind| {
        entries
            .iter()
            .filter(move |e| e.kind == kind)
            .map(|e| e.rank)
            .max()
    };
    for (basis, kind) in [
        (Kind::RadianceBasis, Kind::Radiance),
        (Kind::PolarisationBasis, Kind::Polarisation),
    ] {
        if let (Some(most), Some(rank)) = (rank_of(basis), rank_of(kind))
            && rank > most
        {
            let name = kind.name();
            let detail = format!("a {name} chunk of rank {rank} with a basis of rank {most}");
            return Err(Error::invalid("directory", detail));
        }
    }
    Ok(())
}

/// Checks that the chunk follows its predecessor without hole or overlap; returns its end.
fn check_place(raw: &RawEntry, previous_end: u64, file: u64) -> core::result::Result<u64, String> {
    let (offset, length) = (raw.offset.get(), raw.stored_length.get());
    let expected = previous_end.next_multiple_of(CHUNK_ALIGNMENT);
    if offset != expected {
        return Err(format!("expected offset {expected}, got {offset}"));
    }
    match offset.checked_add(length).filter(|&end| end <= file) {
        Some(end) => Ok(end),
        None => Err(format!(
            "{length} bytes at {offset} reach beyond the end of the file, {file}"
        )),
    }
}

/// `offset` and `stored_length` were checked against the length of the file, so they fit.
fn entry(raw: &RawEntry) -> Entry {
    let index = |i: u16| (i != NO_INDEX).then_some(usize::from(i));
    Entry {
        kind: Kind::from_code(raw.kind.get()),
        altitude: index(raw.altitude.get()),
        visibility: index(raw.visibility.get()),
        offset: raw.offset.get() as usize,
        length: raw.stored_length.get() as usize,
        raw_length: usize::try_from(raw.raw_length.get()).unwrap_or(usize::MAX),
        encoding: raw.encoding.get(),
        crc32: raw.crc32.get(),
        rank: raw.rank.get() as usize,
        error_median: raw.error_median.get(),
        error_p99: raw.error_p99.get(),
    }
}

fn check_entry(head: &Head, raw: &RawEntry, entry: &Entry) -> core::result::Result<(), String> {
    let indices = match entry.kind {
        Kind::Unknown(_) => return Ok(()),
        Kind::Radiance | Kind::Polarisation => {
            entry.altitude.is_some() && entry.visibility.is_some()
        }
        Kind::Column => entry.altitude.is_some() && entry.visibility.is_none(),
        Kind::Source => entry.altitude.is_none() && entry.visibility.is_some(),
        Kind::RadianceBasis
        | Kind::PolarisationBasis
        | Kind::Transmittance
        | Kind::SourceBasis
        | Kind::Spectrum
        | Kind::Estimate
        | Kind::Axis => entry.altitude.is_none() && entry.visibility.is_none(),
    };
    let known = entry.altitude.is_none_or(|i| i < head.altitudes.len())
        && entry.visibility.is_none_or(|i| i < head.visibilities.len());
    if !indices || !known {
        return Err(format!(
            "indices of altitude {} and visibility {} do not fit its kind or the axes",
            raw.altitude, raw.visibility
        ));
    }
    let ranks = match entry.kind {
        Kind::Radiance | Kind::RadianceBasis | Kind::Polarisation | Kind::PolarisationBasis => {
            1..=MAX_RANK
        }
        _ => 0..=0,
    };
    if !ranks.contains(&entry.rank) {
        return Err(format!("expected rank {ranks:?}, got {}", entry.rank));
    }
    if raw.tier.get() != 0 {
        return Err(format!("expected tier 0, got {}", raw.tier));
    }
    let error = |e: f32| e.is_finite() && e >= 0.0;
    if !error(entry.error_median) || !error(entry.error_p99) {
        return Err("expected errors that are finite and not negative".to_owned());
    }
    check_chunk_length(head, raw, entry)
}

/// The payload has as many bytes as rank and counts give, and the stored bytes can hold that.
fn check_chunk_length(
    head: &Head,
    raw: &RawEntry,
    entry: &Entry,
) -> core::result::Result<(), String> {
    let (stored, decoded) = (raw.stored_length.get(), raw.raw_length.get());
    let expected = match entry.kind {
        Kind::Radiance => head.shape().radiance_bytes(entry.rank) as u64,
        Kind::RadianceBasis => head.shape().basis_bytes(entry.rank) as u64,
        Kind::Column => head.shape().column_bytes() as u64,
        Kind::Polarisation => head.shape().polarisation_bytes(entry.rank) as u64,
        Kind::PolarisationBasis => head.shape().polarisation_basis_bytes(entry.rank) as u64,
        // The payload itself says how long it must be; that is checked at its first touch.
        _ => decoded,
    };
    let possible = match entry.encoding {
        ENCODING_RAW => stored == expected,
        _ => expected <= stored.saturating_mul(MOST_EXPANSION as u64),
    };
    if decoded == expected && possible {
        return Ok(());
    }
    Err(format!(
        "expected {expected} bytes, got stored_length {stored} and raw_length {decoded}"
    ))
}
