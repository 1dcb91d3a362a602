//! Writes model files. Format specification, sections 3 to 6.

use std::path::Path;

use zerocopy::IntoBytes;
use zerocopy::little_endian::{F32, F64, U16, U32, U64};

use super::assemble::assemble;
use super::axis_table::AxisTable;
use super::density::DensityTable;
use super::estimate::Estimate;
use super::head::{Head, PhaseFunction};
use super::layout::*;
use super::payload_bytes::{check, check_rank, push_f32, push_half, push_halves, push_scale};
use super::polarisation_factors::{PolarisationBasis, PolarisationFactors};
use super::source_function::{SOURCE_FIELDS, SourceBasis, SourceCore};
use super::spectrum::Spectrum;
use crate::error::{Error, Result};
use crate::output::replace_file;

/// Factors of a radiance chunk, unpadded; [`encode`] rounds the matrices to half precision.
///
/// Matrices are row-major. Lengths as in [`Head::shape`].
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let shape = head.shape();
/// for chunk in &chunks {
///     if let Payload::Radiance(factors) = &chunk.payload {
///         assert_eq!(factors.alpha_up.len(), shape.up * factors.rank);
///         assert_eq!(factors.level.len(), shape.levels * shape.wavelengths);
///     }
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadianceFactors {
    /// Number of components.
    pub rank: usize,
    /// Weight of each component, `[rank]`; kept in single precision.
    pub scale: Vec<f32>,
    /// `[up][rank]`.
    pub alpha_up: Vec<f32>,
    /// `[down][rank]`.
    pub alpha_down: Vec<f32>,
    /// `[elevation][rank]`.
    pub elevation: Vec<f32>,
    /// Spline coefficients of ln S, `[elevation][wavelengths]`.
    pub level: Vec<f32>,
}

/// Factor matrices that all radiance chunks share, unpadded.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let basis = chunks.iter().find_map(|chunk| match &chunk.payload {
///     Payload::RadianceBasis(basis) => Some(basis),
///     _ => None,
/// });
/// let basis = basis.expect("every model has one");
/// assert_eq!(basis.channel.len(), basis.rank * head.shape().channels);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadianceBasis {
    /// Number of components.
    pub rank: usize,
    /// `[phi][rank]`.
    pub phi: Vec<f32>,
    /// `[rank][channels]`, channel = field · wavelengths + wavelength.
    pub channel: Vec<f32>,
}

/// Logarithms of mean densities, `[up + down][constituents]`.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let shape = head.shape();
/// let tables = chunks.iter().filter_map(|chunk| match &chunk.payload {
///     Payload::Column(table) => Some(table),
///     _ => None,
/// });
/// // One per altitude, but none in files with estimates.
/// assert_eq!(tables.clone().count(), if head.estimated { 0 } else { head.altitudes.len() });
/// for table in tables {
///     assert_eq!(table.values.len(), (shape.up + shape.down) * shape.constituents);
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnTable {
    /// Spline coefficients of ln n̄.
    pub values: Vec<f32>,
}

/// What a chunk to be written holds.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (_, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// // Each radiance chunk has as many components as the basis that all share.
/// let ranks = chunks.iter().filter_map(|chunk| match &chunk.payload {
///     Payload::Radiance(factors) => Some(factors.rank),
///     Payload::RadianceBasis(basis) => Some(basis.rank),
///     _ => None,
/// });
/// let ranks: Vec<usize> = ranks.collect();
/// assert!(ranks.iter().all(|rank| *rank == ranks[0]));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Payload {
    /// Factors of the radiance at one altitude and visibility.
    Radiance(RadianceFactors),
    /// Mean densities along rays from one altitude.
    Column(ColumnTable),
    /// Factors of the polarisation at one altitude and visibility.
    Polarisation(PolarisationFactors),
    /// What the polarisation of all altitudes and visibilities shares.
    PolarisationBasis(PolarisationBasis),
    /// Densities of the air over altitude.
    Transmittance(DensityTable),
    /// Source function of multiply scattered light at one visibility.
    Source(SourceCore),
    /// What the sources of all visibilities share.
    SourceBasis(SourceBasis),
    /// Factor matrices that all radiance chunks share.
    RadianceBasis(RadianceBasis),
    /// What lies between the wavelengths.
    Spectrum(Spectrum),
    /// Tables of the estimates that fields are relative to.
    Estimate(Estimate),
    /// What the visibilities stand for.
    Axis(AxisTable),
}

/// A chunk to be written.
///
/// ```
/// use welkin::format::{Chunk, ColumnTable, Payload};
///
/// let table = ColumnTable { values: vec![0.0; 96] };
/// let chunk = Chunk::new(Some(0), None, Payload::Column(table)); // of the lowest altitude
/// assert_eq!((chunk.error_median, chunk.error_p99), (0.0, 0.0)); // not measured
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chunk {
    /// Index into the altitudes of the head; `None` for what all altitudes share.
    pub altitude: Option<usize>,
    /// Index into the visibilities of the head; `None` for what all visibilities share.
    pub visibility: Option<usize>,
    /// Median error against the traced data, 0 if not measured: relative, or of the degree of polarisation.
    pub error_median: f32,
    /// 99th percentile of that error, 0 if not measured.
    pub error_p99: f32,
    /// The tables.
    pub payload: Payload,
}

impl Chunk {
    /// With errors that are not measured.
    pub fn new(altitude: Option<usize>, visibility: Option<usize>, payload: Payload) -> Self {
        Self {
            altitude,
            visibility,
            error_median: 0.0,
            error_p99: 0.0,
            payload,
        }
    }
}

/// Encodes a model and writes it to `path`, replacing a file there only when all bytes are on disk.
///
/// # Errors
/// As [`encode`]; [`Error::Io`] if the file cannot be written.
pub fn write(path: impl AsRef<Path>, head: &Head, chunks: &[Chunk]) -> Result<()> {
    replace_file(path, &encode(head, chunks)?)
}

/// Encodes a model as the bytes of a file.
///
/// # Errors
/// [`Error::Invalid`] or [`Error::Length`] if head or chunks break the specification, or if a factor
/// is not finite or too large for half precision.
pub fn encode(head: &Head, chunks: &[Chunk]) -> Result<Vec<u8>> {
    head.validate()?;
    check_together(chunks, head.wavelengths.len())?;
    let mut arrays = Vec::new();
    push_arrays(&mut arrays, head);
    let chunks = chunks.iter().map(|chunk| encode_chunk(head, chunk));
    assemble(header(head), &arrays, chunks.collect::<Result<Vec<_>>>()?)
}

/// Entry, without what depends on the layout of the file, and payload.
pub(super) fn encode_chunk(head: &Head, chunk: &Chunk) -> Result<(RawEntry, Vec<u8>)> {
    let payload = encode_payload(head, &chunk.payload)?;
    Ok((entry(chunk, &payload)?, payload))
}

/// What the specification says about all source chunks of a file: they fit their basis, and their species agree.
fn check_together(chunks: &[Chunk], wavelengths: usize) -> Result<()> {
    let basis = chunks.iter().find_map(|chunk| match &chunk.payload {
        Payload::SourceBasis(basis) => Some((basis.ranks, basis.sun.len())),
        _ => None,
    });
    let mut cores = chunks.iter().filter_map(|chunk| match &chunk.payload {
        Payload::Source(core) => Some(core),
        _ => None,
    });
    let Some(first) = cores.clone().next() else {
        return Ok(());
    };
    let shape = |core: &SourceCore| (core.ranks, core.level.len() / (SOURCE_FIELDS * wavelengths));
    let expected = basis.unwrap_or_else(|| shape(first));
    if cores.all(|core| shape(core) == expected && core.phase == first.phase) {
        return Ok(());
    }
    let detail = "all need the ranks and suns of the source basis, and the same species";
    Err(Error::invalid("source chunks", detail))
}

fn push_arrays(file: &mut Vec<u8>, head: &Head) {
    for values in [
        &head.wavelengths,
        &head.altitudes,
        &head.visibilities,
        &head.extinction,
        &head.spherical_albedo,
    ] {
        push_f64(file, values);
    }
    head.fields
        .iter()
        .for_each(|f| push_f64(file, &f.parameter));
    push_f64(file, head.xyz.as_flattened());
    push_f64(file, &[head.solar_start, head.solar_step]);
    push_f32(file, &head.solar_irradiance);
    for field in &head.fields {
        let phase = match field.phase {
            PhaseFunction::None => 0,
            PhaseFunction::Rayleigh => 1,
            PhaseFunction::HenyeyGreenstein => 2,
        };
        let ground = if field.ground { FIELD_GROUND } else { 0 };
        file.extend_from_slice(
            U32::new(phase | ground | (field.estimate as u32) << FIELD_ESTIMATE_SHIFT).as_bytes(),
        );
    }
    file.extend_from_slice(head.metadata.as_bytes());
    file.resize(file.len().next_multiple_of(8), 0);
}

fn push_f64(file: &mut Vec<u8>, values: &[f64]) {
    for &v in values {
        file.extend_from_slice(F64::new(v).as_bytes());
    }
}

/// The counts were validated, so they fit their fields.
fn header(head: &Head) -> Header {
    let n = |count: usize| U16::new(count as u16);
    Header {
        magic: MAGIC,
        version_major: U16::new(VERSION_MAJOR),
        version_minor: U16::ZERO,
        required_features: U32::new(
            u32::from(head.absorbers) << FEATURE_ABSORBERS_SHIFT
                | if head.estimated { FEATURE_ESTIMATE } else { 0 },
        ),
        file_length: U64::ZERO,
        head_length: U64::ZERO,
        head_crc32: U32::ZERO,
        chunk_count: U32::ZERO,
        wavelengths: n(head.wavelengths.len()),
        altitudes: n(head.altitudes.len()),
        visibilities: n(head.visibilities.len()),
        fields: n(head.fields.len()),
        constituents: n(head.constituents),
        alpha_up_intervals: n(head.up.intervals),
        alpha_down_intervals: n(head.down.intervals),
        phi_intervals: n(head.phi_intervals),
        elevation_intervals: n(head.elevation.intervals),
        solar_samples: n(head.solar_irradiance.len()),
        metadata_length: U32::new(head.metadata.len() as u32),
        planet_radius: F64::new(head.planet.radius),
        top_altitude: F64::new(head.planet.top),
        alpha_up_exponent: F64::new(head.up.exponent),
        alpha_down_exponent: F64::new(head.down.exponent),
        elevation_min: F64::new(head.elevation.min),
        elevation_max: F64::new(head.elevation.max),
        elevation_centre: F64::new(head.elevation.centre),
        elevation_width: F64::new(head.elevation.width),
    }
}

fn entry(chunk: &Chunk, payload: &[u8]) -> Result<RawEntry> {
    let (kind, rank) = match &chunk.payload {
        Payload::Radiance(factors) => (KIND_RADIANCE, factors.rank),
        Payload::Column(_) => (KIND_COLUMN, 0),
        Payload::Polarisation(factors) => (KIND_POLARISATION, factors.rank),
        Payload::PolarisationBasis(basis) => (KIND_POLARISATION_BASIS, basis.rank),
        Payload::Transmittance(_) => (KIND_TRANSMITTANCE, 0),
        Payload::Source(_) => (KIND_SOURCE, 0),
        Payload::SourceBasis(_) => (KIND_SOURCE_BASIS, 0),
        Payload::RadianceBasis(basis) => (KIND_RADIANCE_BASIS, basis.rank),
        Payload::Spectrum(_) => (KIND_SPECTRUM, 0),
        Payload::Estimate(_) => (KIND_ESTIMATE, 0),
        Payload::Axis(_) => (KIND_AXIS, 0),
    };
    let index = |i: Option<usize>| {
        let Some(i) = i else {
            return Ok(U16::new(NO_INDEX));
        };
        u16::try_from(i)
            .map(U16::new)
            .map_err(|_| Error::invalid("directory", format!("index {i} does not fit 16 bits")))
    };
    Ok(RawEntry {
        kind: U32::new(kind),
        altitude: index(chunk.altitude)?,
        visibility: index(chunk.visibility)?,
        offset: U64::ZERO,
        stored_length: U64::ZERO,
        raw_length: U64::new(payload.len() as u64),
        encoding: U32::ZERO,
        crc32: U32::ZERO,
        rank: U32::new(rank as u32),
        tier: U32::ZERO,
        error_median: F32::new(chunk.error_median),
        error_p99: F32::new(chunk.error_p99),
        reserved: U64::ZERO,
    })
}

fn encode_payload(head: &Head, payload: &Payload) -> Result<Vec<u8>> {
    let shape = &head.shape();
    let (constituents, wavelengths) = (head.constituents, head.wavelengths.len());
    match payload {
        Payload::Radiance(factors) => encode_radiance(shape, factors),
        Payload::Column(table) => encode_column(shape, table),
        Payload::Polarisation(factors) => factors.encode(shape),
        Payload::PolarisationBasis(basis) => basis.encode(shape),
        Payload::RadianceBasis(basis) => encode_basis(shape, basis),
        Payload::Transmittance(table) => table.encode(constituents, head.planet.top),
        Payload::Source(core) => core.encode(constituents, wavelengths),
        Payload::SourceBasis(basis) => basis.encode(wavelengths),
        Payload::Spectrum(spectrum) => spectrum.encode(head),
        Payload::Estimate(estimate) => estimate.encode(constituents, wavelengths, head.planet.top),
        Payload::Axis(table) => table.encode(head),
    }
}

fn encode_radiance(shape: &Shape, factors: &RadianceFactors) -> Result<Vec<u8>> {
    let r = factors.rank;
    check_rank(r)?;
    let mut bytes = Vec::with_capacity(shape.radiance_bytes(r));
    push_scale(&mut bytes, &factors.scale, r)?;
    push_half(&mut bytes, "alpha_up", &factors.alpha_up, shape.up, r)?;
    push_half(&mut bytes, "alpha_down", &factors.alpha_down, shape.down, r)?;
    let rows = shape.elevation;
    push_half(&mut bytes, "elevation", &factors.elevation, rows, r)?;
    check("level", &factors.level, shape.levels * shape.wavelengths)?;
    push_halves(&mut bytes, "level", &factors.level)?;
    Ok(bytes)
}

fn encode_basis(shape: &Shape, basis: &RadianceBasis) -> Result<Vec<u8>> {
    let r = basis.rank;
    check_rank(r)?;
    let mut bytes = Vec::with_capacity(shape.basis_bytes(r));
    push_half(&mut bytes, "phi", &basis.phi, shape.phi, r)?;
    push_half(&mut bytes, "channel", &basis.channel, r, shape.channels)?;
    bytes.resize(shape.basis_bytes(r), 0);
    Ok(bytes)
}

fn encode_column(shape: &Shape, table: &ColumnTable) -> Result<Vec<u8>> {
    let expected = (shape.up + shape.down) * shape.constituents;
    check("column", &table.values, expected)?;
    let mut bytes = Vec::with_capacity(shape.column_bytes());
    push_f32(&mut bytes, &table.values);
    Ok(bytes)
}
