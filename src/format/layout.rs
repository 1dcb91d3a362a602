//! The byte layout of the fixed parts. Format specification, sections 3 and 5.

use zerocopy::little_endian::{F32, F64, U16, U32, U64};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// First eight bytes of every file.
pub const MAGIC: [u8; 8] = *b"\x89WLK\r\n\x1a\n";
/// The major version that this crate reads and writes.
pub const VERSION_MAJOR: u16 = 1;
/// The newest minor version that this crate writes, where a file needs it; other files have 0.
pub const VERSION_MINOR: u16 = 3;
/// Bit of `required_features`: the file has a spectrum.
pub const FEATURE_SPECTRUM: u32 = 1;
/// Bit of `required_features`: fields are relative to estimates.
pub const FEATURE_ESTIMATE: u32 = 2;
/// From this bit of `required_features` on: which constituents absorb and do not scatter.
pub const FEATURE_ABSORBERS_SHIFT: u32 = 16;
/// Alignment of chunks in the file.
pub const CHUNK_ALIGNMENT: u64 = 64;
/// `kind` of a radiance chunk.
pub const KIND_RADIANCE: u32 = 1;
/// `kind` of a column chunk.
pub const KIND_COLUMN: u32 = 2;
/// `kind` of a polarisation chunk.
pub const KIND_POLARISATION: u32 = 6;
/// `kind` of the polarisation basis.
pub const KIND_POLARISATION_BASIS: u32 = 7;
/// `encoding` of a chunk that is stored as it is.
pub const ENCODING_RAW: u32 = 0;
/// `encoding` of a chunk that is stored as one zstd frame.
pub const ENCODING_ZSTD: u32 = 1;
/// `raw_length` may be at most this many times `stored_length`.
pub const MOST_EXPANSION: usize = 256;
/// `kind` of a transmittance chunk.
pub const KIND_TRANSMITTANCE: u32 = 4;
/// `kind` of a source chunk.
pub const KIND_SOURCE: u32 = 5;
/// `kind` of a source basis chunk.
pub const KIND_SOURCE_BASIS: u32 = 8;
/// `kind` of the basis that all radiance chunks share.
pub const KIND_RADIANCE_BASIS: u32 = 3;
/// `kind` of a spectrum chunk.
pub const KIND_SPECTRUM: u32 = 9;
/// `kind` of the estimate chunk.
pub const KIND_ESTIMATE: u32 = 10;
/// `kind` of the axis chunk.
pub const KIND_AXIS: u32 = 11;
/// Directory index that means "none".
pub const NO_INDEX: u16 = u16::MAX;
/// Largest rank of a chunk.
pub const MAX_RANK: usize = 4096;
/// Most coefficients of the radiance of one sky: (up + down) · azimuth · channels.
pub const MAX_TABLE: usize = 1 << 24;
/// Bit of a field code: light reflected by the ground.
pub const FIELD_GROUND: u32 = 1 << 16;
/// From this bit of a field code on: the estimate that the field is relative to.
pub const FIELD_ESTIMATE_SHIFT: u32 = 24;

pub(crate) const CRC_RANGE: core::ops::Range<usize> = 32..36;

/// Header, the first 128 bytes.
#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(crate) struct Header {
    pub magic: [u8; 8],
    pub version_major: U16,
    pub version_minor: U16,
    pub required_features: U32,
    pub file_length: U64,
    pub head_length: U64,
    pub head_crc32: U32,
    pub chunk_count: U32,
    pub wavelengths: U16,
    pub altitudes: U16,
    pub visibilities: U16,
    pub fields: U16,
    pub constituents: U16,
    pub alpha_up_intervals: U16,
    pub alpha_down_intervals: U16,
    pub phi_intervals: U16,
    pub elevation_intervals: U16,
    pub solar_samples: U16,
    pub metadata_length: U32,
    pub planet_radius: F64,
    pub top_altitude: F64,
    pub alpha_up_exponent: F64,
    pub alpha_down_exponent: F64,
    pub elevation_min: F64,
    pub elevation_max: F64,
    pub elevation_centre: F64,
    pub elevation_width: F64,
}

impl Header {
    /// Which constituents absorb and do not scatter: bit k is constituent k.
    pub(crate) fn absorbers(&self) -> u16 {
        (self.required_features.get() >> FEATURE_ABSORBERS_SHIFT) as u16
    }

    /// Bits of `required_features` that this version does not know.
    pub(crate) fn unknown_features(&self) -> u32 {
        let constituents = (1u32 << self.constituents.get().min(16)) - 1;
        self.required_features.get()
            & !(FEATURE_SPECTRUM | FEATURE_ESTIMATE | constituents << FEATURE_ABSORBERS_SHIFT)
    }

    /// Length of the head that follows from the counts; at most about 2^39, so it cannot overflow.
    pub(crate) fn counted_head_length(&self) -> u64 {
        let n = |count: U16| u64::from(count.get());
        let (nw, nv, nf) = (n(self.wavelengths), n(self.visibilities), n(self.fields));
        let f64s = nw
            + n(self.altitudes)
            + nv
            + nv * n(self.constituents) * nw
            + nv * nw
            + nf * nw
            + 3 * nw
            + 2;
        let u32s = n(self.solar_samples) + nf;
        let arrays = 8 * f64s + 4 * u32s + u64::from(self.metadata_length.get());
        HEADER_LENGTH as u64
            + arrays.next_multiple_of(8)
            + u64::from(self.chunk_count.get()) * ENTRY_LENGTH as u64
    }
}

/// One chunk in the directory, 64 bytes.
#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub(crate) struct RawEntry {
    pub kind: U32,
    pub altitude: U16,
    pub visibility: U16,
    pub offset: U64,
    pub stored_length: U64,
    pub raw_length: U64,
    pub encoding: U32,
    pub crc32: U32,
    pub rank: U32,
    pub tier: U32,
    pub error_median: F32,
    pub error_p99: F32,
    pub reserved: U64,
}

pub(crate) const HEADER_LENGTH: usize = size_of::<Header>();
pub(crate) const ENTRY_LENGTH: usize = size_of::<RawEntry>();

const _: () = assert!(HEADER_LENGTH == 128);
const _: () = assert!(ENTRY_LENGTH == 64);
const _: () = assert!(core::mem::offset_of!(Header, head_crc32) == CRC_RANGE.start);
const _: () = assert!(core::mem::offset_of!(Header, planet_radius) == 64);

/// Rounds up to a multiple of 16.
pub const fn ceil16(n: usize) -> usize {
    n.next_multiple_of(16)
}

/// Lengths along the axes of a chunk's tables, in coefficients.
///
/// ```
/// use welkin::Model;
///
/// let model = Model::default_model()?;
/// let shape = model.head().shape();
/// // Every interval of a spline is between coefficients, three more on free axes.
/// assert_eq!(shape.up, model.head().up.intervals + 3);
/// assert_eq!(shape.channels, model.head().fields.len() * shape.wavelengths);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Coefficients of the up axis.
    pub up: usize,
    /// Coefficients of the down axis.
    pub down: usize,
    /// Coefficients of the azimuth axis.
    pub phi: usize,
    /// Coefficients of the solar elevation axis.
    pub elevation: usize,
    /// Wavelengths.
    pub wavelengths: usize,
    /// Fields × wavelengths.
    pub channels: usize,
    /// Constituents of the air.
    pub constituents: usize,
    /// Rows of ln S in a radiance chunk: as many as the elevation axis has coefficients, or none where fields are relative
    /// to estimates.
    pub levels: usize,
}

/// Parts of the polarisation: Q and U/sin φ of light over black ground, Q and U/sin φ of light from the ground.
pub const POLARISATION_PARTS: usize = 4;

impl Shape {
    /// Raw bytes of a radiance chunk of the given rank.
    pub fn radiance_bytes(&self, rank: usize) -> usize {
        let rows = self.up + self.down + self.elevation;
        ceil16(rank) * (4 + 2 * rows) + 2 * self.levels * self.wavelengths
    }

    /// Raw bytes of a radiance basis of the given rank.
    pub fn basis_bytes(&self, rank: usize) -> usize {
        2 * ceil16(rank) * (self.phi + ceil16(self.channels))
    }

    /// Raw bytes of a polarisation chunk of the given rank.
    pub fn polarisation_bytes(&self, rank: usize) -> usize {
        ceil16(rank) * (4 + 2 * (self.up + self.down + self.elevation))
    }

    /// Raw bytes of a polarisation basis of the given rank.
    pub fn polarisation_basis_bytes(&self, rank: usize) -> usize {
        2 * ceil16(rank) * (self.phi + ceil16(self.polarisation_channels()))
    }

    /// Parts of the polarisation × wavelengths.
    pub fn polarisation_channels(&self) -> usize {
        POLARISATION_PARTS * self.wavelengths
    }

    /// Raw bytes of a column chunk.
    pub fn column_bytes(&self) -> usize {
        4 * (self.up + self.down) * self.constituents
    }
}
