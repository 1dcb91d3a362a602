//! Factors of the polarisation (kinds 6 and 7). Format specification, sections 6.6 and 6.7.

use zerocopy::little_endian::F32;

use super::chunk::{Payload16, check_length, half_is_finite, take};
use super::layout::{Shape, ceil16};
use super::write::{check_rank, push_half, push_scale};
use crate::error::Result;

/// Parts of the polarisation: Q and U/sin φ of light over black ground, Q and U/sin φ of light from the ground.
pub const POLARISATION_PARTS: usize = 4;

/// Raw bytes of a polarisation chunk of the given rank.
pub(super) fn polarisation_bytes(shape: &Shape, rank: usize) -> usize {
    ceil16(rank) * (4 + 2 * (shape.up + shape.down + shape.elevation))
}

/// Raw bytes of a polarisation basis of the given rank.
pub(super) fn polarisation_basis_bytes(shape: &Shape, wavelengths: usize, rank: usize) -> usize {
    ceil16(rank) * 2 * (shape.phi + ceil16(POLARISATION_PARTS * wavelengths))
}

/// Factors of the polarisation at one altitude and visibility.
///
/// Matrices are row-major and `stride` wide, of which the first `rank` columns count.
#[derive(Clone, Copy, Debug)]
pub struct PolarisationView<'a> {
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
}

impl<'a> PolarisationView<'a> {
    /// Divides the bytes of a raw polarisation chunk into its tables.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the bytes are not as many as shape and rank say.
    pub fn new(bytes: &'a [u8], shape: &Shape, rank: usize) -> Result<Self> {
        check_length("polarisation chunk", bytes, polarisation_bytes(shape, rank))?;
        let stride = ceil16(rank);
        let mut rest = bytes;
        Ok(Self {
            rank,
            stride,
            scale: take(&mut rest, stride)?,
            alpha_up: take(&mut rest, shape.up * stride)?,
            alpha_down: take(&mut rest, shape.down * stride)?,
            elevation: take(&mut rest, shape.elevation * stride)?,
        })
    }

    /// Whether the payload holds neither NaN nor infinity.
    pub fn is_finite(&self) -> bool {
        let tables = [self.alpha_up, self.alpha_down, self.elevation];
        self.scale.iter().all(|s| s.get().is_finite()) && tables.iter().all(|t| half_is_finite(t))
    }
}

/// Factors that all polarisation chunks of a file share.
#[derive(Clone, Copy, Debug)]
pub struct PolarisationBasisView<'a> {
    /// Number of components.
    pub rank: usize,
    /// `rank` rounded up to a multiple of 16: the width of `phi`.
    pub stride: usize,
    /// Channels rounded up to a multiple of 16: the width of `channel`.
    pub channel_stride: usize,
    /// `[phi][stride]`.
    pub phi: &'a Payload16,
    /// `[stride][channel_stride]`, channel = part · wavelengths + wavelength.
    pub channel: &'a Payload16,
}

impl<'a> PolarisationBasisView<'a> {
    /// Divides the bytes of a raw polarisation basis of a model with `wavelengths` wavelengths into its tables.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the bytes are not as many as the arguments say.
    pub fn new(bytes: &'a [u8], shape: &Shape, wavelengths: usize, rank: usize) -> Result<Self> {
        let expected = polarisation_basis_bytes(shape, wavelengths, rank);
        check_length("polarisation basis", bytes, expected)?;
        let stride = ceil16(rank);
        let channel_stride = ceil16(POLARISATION_PARTS * wavelengths);
        let mut rest = bytes;
        Ok(Self {
            rank,
            stride,
            channel_stride,
            phi: take(&mut rest, shape.phi * stride)?,
            channel: take(&mut rest, stride * channel_stride)?,
        })
    }

    /// Whether the payload holds neither NaN nor infinity.
    pub fn is_finite(&self) -> bool {
        half_is_finite(self.phi) && half_is_finite(self.channel)
    }
}

/// Factors of the polarisation at one altitude and visibility, to be written; unpadded and row-major.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolarisationFactors {
    /// Number of components, as in the basis.
    pub rank: usize,
    /// Weight of each component, `[rank]`; kept in single precision.
    pub scale: Vec<f32>,
    /// `[up][rank]`.
    pub alpha_up: Vec<f32>,
    /// `[down][rank]`.
    pub alpha_down: Vec<f32>,
    /// `[elevation][rank]`.
    pub elevation: Vec<f32>,
}

impl PolarisationFactors {
    pub(super) fn encode(&self, shape: &Shape) -> Result<Vec<u8>> {
        let r = self.rank;
        check_rank(r)?;
        let mut bytes = Vec::with_capacity(polarisation_bytes(shape, r));
        push_scale(&mut bytes, &self.scale, r)?;
        push_half(&mut bytes, "alpha_up", &self.alpha_up, shape.up, r)?;
        push_half(&mut bytes, "alpha_down", &self.alpha_down, shape.down, r)?;
        push_half(&mut bytes, "elevation", &self.elevation, shape.elevation, r)?;
        Ok(bytes)
    }
}

/// What all polarisation chunks share, to be written; unpadded and row-major.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolarisationBasis {
    /// Number of components.
    pub rank: usize,
    /// `[phi][rank]`.
    pub phi: Vec<f32>,
    /// `[rank][channels]`, channel = part · wavelengths + wavelength.
    pub channel: Vec<f32>,
}

impl PolarisationBasis {
    pub(super) fn encode(&self, shape: &Shape, wavelengths: usize) -> Result<Vec<u8>> {
        let r = self.rank;
        check_rank(r)?;
        let length = polarisation_basis_bytes(shape, wavelengths, r);
        let channels = POLARISATION_PARTS * wavelengths;
        let mut bytes = Vec::with_capacity(length);
        push_half(&mut bytes, "phi", &self.phi, shape.phi, r)?;
        push_half(&mut bytes, "channel", &self.channel, r, channels)?;
        bytes.resize(length, 0);
        Ok(bytes)
    }
}
