//! Views over the bytes of a chunk. Format specification, section 6.
//!
//! The element types have no alignment, so that any byte slice will do.

use zerocopy::FromBytes;
use zerocopy::little_endian::{F32, U16};

use super::layout::{Shape, ceil16};
use crate::error::{Error, Result};

/// Bits of half-precision numbers, little-endian in the file.
///
/// ```
/// use welkin::format::{BasisView, Kind, Payload16, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let mut directory = contents.directory.iter();
/// let entry = directory.find(|e| e.kind == Kind::RadianceBasis).expect("every model has one");
/// let bytes = &file[entry.offset..][..entry.length];
/// let basis = BasisView::radiance(bytes, &contents.head.shape(), entry.rank)?;
/// let phi: &Payload16 = basis.phi;
/// let first = half::f16::from_bits(phi[0].get());
/// assert!(first.is_finite());
/// # Ok::<(), welkin::Error>(())
/// ```
pub type Payload16 = [U16];

/// Factors of the radiance (kind 1) or of the polarisation (kind 6) at one altitude and visibility.
///
/// Matrices are row-major and `stride` wide, of which the first `rank` columns count, except `level`.
///
/// ```
/// use welkin::format::{FactorsView, Kind, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let mut directory = contents.directory.iter();
/// let entry = directory.find(|e| e.kind == Kind::Radiance).expect("every model has one");
/// let (bytes, shape) = (&file[entry.offset..][..entry.length], contents.head.shape());
/// let factors = FactorsView::radiance(bytes, &shape, entry.rank)?;
/// assert_eq!(factors.alpha_up.len(), shape.up * factors.stride);
/// assert!(factors.stride >= factors.rank && factors.is_finite());
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FactorsView<'a> {
    /// Number of components.
    pub rank: usize,
    /// `rank` rounded up to a multiple of 16.
    pub stride: usize,
    /// Weight of each component, `[stride]`.
    pub scale: &'a [F32],
    /// `[up][stride]`.
    pub alpha_up: &'a Payload16,
    /// `[down][stride]`.
    pub alpha_down: &'a Payload16,
    /// `[elevation][stride]`.
    pub elevation: &'a Payload16,
    /// Spline coefficients of ln S, `[elevation][wavelengths]`; empty for polarisation.
    pub level: &'a Payload16,
}

impl<'a> FactorsView<'a> {
    /// Divides the bytes of a raw radiance chunk into its tables.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the bytes are not as many as shape and rank say.
    pub fn radiance(bytes: &'a [u8], shape: &Shape, rank: usize) -> Result<Self> {
        check_length("radiance chunk", bytes, shape.radiance_bytes(rank))?;
        Self::divide(bytes, shape, rank, shape.levels * shape.wavelengths)
    }

    /// Divides the bytes of a raw polarisation chunk into its tables.
    ///
    /// # Errors
    /// As [`FactorsView::radiance`].
    pub fn polarisation(bytes: &'a [u8], shape: &Shape, rank: usize) -> Result<Self> {
        check_length("polarisation chunk", bytes, shape.polarisation_bytes(rank))?;
        Self::divide(bytes, shape, rank, 0)
    }

    /// Whether weights beyond the rank are other than zero; they do not count.
    #[inline(always)]
    pub(crate) fn is_padded(&self) -> bool {
        self.scale[self.rank..].iter().any(|s| s.get() != 0.0)
    }

    fn divide(bytes: &'a [u8], shape: &Shape, rank: usize, levels: usize) -> Result<Self> {
        let stride = ceil16(rank);
        let mut rest = bytes;
        Ok(Self {
            rank,
            stride,
            scale: take(&mut rest, stride)?,
            alpha_up: take(&mut rest, shape.up * stride)?,
            alpha_down: take(&mut rest, shape.down * stride)?,
            elevation: take(&mut rest, shape.elevation * stride)?,
            level: take(&mut rest, levels)?,
        })
    }

    /// Whether the payload holds neither NaN nor infinity.
    pub fn is_finite(&self) -> bool {
        let tables = [self.alpha_up, self.alpha_down, self.elevation, self.level];
        self.scale.iter().all(|s| s.get().is_finite()) && tables.iter().all(|t| half_is_finite(t))
    }
}

/// Factor matrices that all radiance chunks (kind 3) or all polarisation chunks (kind 7) share.
///
/// ```
/// use welkin::format::{BasisView, Kind, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let mut directory = contents.directory.iter();
/// let entry = directory.find(|e| e.kind == Kind::RadianceBasis).expect("every model has one");
/// let bytes = &file[entry.offset..][..entry.length];
/// let basis = BasisView::radiance(bytes, &contents.head.shape(), entry.rank)?;
/// assert_eq!(basis.channel.len(), basis.stride * basis.channel_stride);
/// assert!(basis.is_finite());
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BasisView<'a> {
    /// Number of components.
    pub rank: usize,
    /// `rank` rounded up to a multiple of 16: the width of `phi`.
    pub stride: usize,
    /// Number of channels: those of the radiance, or part · wavelengths + wavelength for the polarisation.
    pub channels: usize,
    /// `channels` rounded up to a multiple of 16: the width of `channel`.
    pub channel_stride: usize,
    /// `[phi][stride]`, of which the first `rank` columns count.
    pub phi: &'a Payload16,
    /// `[stride][channel_stride]`: component-major.
    pub channel: &'a Payload16,
}

impl<'a> BasisView<'a> {
    /// Divides the bytes of a raw radiance basis into its tables.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the bytes are not as many as shape and rank say.
    pub fn radiance(bytes: &'a [u8], shape: &Shape, rank: usize) -> Result<Self> {
        check_length("radiance basis", bytes, shape.basis_bytes(rank))?;
        Self::divide(bytes, shape.phi, shape.channels, rank)
    }

    /// Divides the bytes of a raw polarisation basis into its tables.
    ///
    /// # Errors
    /// As [`BasisView::radiance`].
    pub fn polarisation(bytes: &'a [u8], shape: &Shape, rank: usize) -> Result<Self> {
        let expected = shape.polarisation_basis_bytes(rank);
        check_length("polarisation basis", bytes, expected)?;
        Self::divide(bytes, shape.phi, shape.polarisation_channels(), rank)
    }

    fn divide(bytes: &'a [u8], phi: usize, channels: usize, rank: usize) -> Result<Self> {
        let (stride, channel_stride) = (ceil16(rank), ceil16(channels));
        let mut rest = bytes;
        Ok(Self {
            rank,
            stride,
            channels,
            channel_stride,
            phi: take(&mut rest, phi * stride)?,
            channel: take(&mut rest, stride * channel_stride)?,
        })
    }

    /// Whether the payload holds neither NaN nor infinity.
    pub fn is_finite(&self) -> bool {
        half_is_finite(self.phi) && half_is_finite(self.channel)
    }
}

/// Logarithms of mean densities along rays from one altitude.
///
/// ```
/// use welkin::format::{ColumnView, Kind, parse};
///
/// fn columns(file: &[u8]) -> welkin::Result<usize> {
///     let contents = parse(file)?;
///     let mut tables = 0;
///     for entry in contents.directory.iter().filter(|e| e.kind == Kind::Column) {
///         let view = ColumnView::new(&file[entry.offset..][..entry.length], &contents.head.shape())?;
///         assert!(view.is_finite());
///         tables += 1;
///     }
///     Ok(tables)
/// }
/// // Files with estimates have none.
/// assert_eq!(columns(welkin::DEFAULT_MODEL)?, 0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ColumnView<'a> {
    /// `[up + down][constituents]`.
    pub values: &'a [F32],
}

impl<'a> ColumnView<'a> {
    /// Views the bytes of a raw column chunk.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the bytes are not as many as the shape says.
    pub fn new(bytes: &'a [u8], shape: &Shape) -> Result<Self> {
        check_length("column chunk", bytes, shape.column_bytes())?;
        let mut rest = bytes;
        let values = take(&mut rest, bytes.len() / size_of::<F32>())?;
        Ok(Self { values })
    }

    /// Whether the payload holds neither NaN nor infinity.
    pub fn is_finite(&self) -> bool {
        self.values.iter().all(|v| v.get().is_finite())
    }
}

pub(super) fn check_length(what: &'static str, bytes: &[u8], expected: usize) -> Result<()> {
    if bytes.len() == expected {
        return Ok(());
    }
    Err(wrong_length(what, expected, bytes.len()))
}

fn wrong_length(what: &'static str, expected: usize, got: usize) -> Error {
    #[cfg(feature = "std")]
    let detail = format!("expected {expected} bytes, got {got}");
    #[cfg(not(feature = "std"))]
    let detail = {
        let _ = (expected, got);
        "has another length than its counts give"
    };
    Error::invalid(what, detail)
}

pub(super) fn take<'a, T>(rest: &mut &'a [u8], n: usize) -> Result<&'a [T]>
where
    T: FromBytes + zerocopy::Immutable + zerocopy::KnownLayout + zerocopy::Unaligned,
{
    let (taken, tail) = <[T]>::ref_from_prefix_with_elems(rest, n)
        .map_err(|_| wrong_length("chunk", n * size_of::<T>(), rest.len()))?;
    *rest = tail;
    Ok(taken)
}

pub(super) fn half_is_finite(table: &Payload16) -> bool {
    // Without leaving the loop early, so that it vectorises.
    let largest = table.iter().fold(0, |m, h| m.max(h.get() & 0x7c00));
    largest != 0x7c00
}
