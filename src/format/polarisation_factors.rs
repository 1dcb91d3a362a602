//! Factors of the polarisation (kinds 6 and 7). Format specification, sections 6.6 and 6.7.

use super::layout::Shape;
use super::payload_bytes::{check_rank, push_half, push_scale};
use crate::error::Result;

/// Factors of the polarisation at one altitude and visibility, to be written; unpadded and row-major.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let factors = chunks.iter().find_map(|chunk| match &chunk.payload {
///     Payload::Polarisation(factors) => Some(factors),
///     _ => None,
/// });
/// let factors = factors.expect("the default model is polarised");
/// assert_eq!(factors.elevation.len(), head.shape().elevation * factors.rank);
/// # Ok::<(), welkin::Error>(())
/// ```
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
        let mut bytes = Vec::with_capacity(shape.polarisation_bytes(r));
        push_scale(&mut bytes, &self.scale, r)?;
        push_half(&mut bytes, "alpha_up", &self.alpha_up, shape.up, r)?;
        push_half(&mut bytes, "alpha_down", &self.alpha_down, shape.down, r)?;
        push_half(&mut bytes, "elevation", &self.elevation, shape.elevation, r)?;
        Ok(bytes)
    }
}

/// What all polarisation chunks share, to be written; unpadded and row-major.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let basis = chunks.iter().find_map(|chunk| match &chunk.payload {
///     Payload::PolarisationBasis(basis) => Some(basis),
///     _ => None,
/// });
/// let basis = basis.expect("the default model is polarised");
/// assert_eq!(basis.channel.len(), basis.rank * head.shape().polarisation_channels());
/// # Ok::<(), welkin::Error>(())
/// ```
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
    pub(super) fn encode(&self, shape: &Shape) -> Result<Vec<u8>> {
        let r = self.rank;
        check_rank(r)?;
        let length = shape.polarisation_basis_bytes(r);
        let channels = shape.polarisation_channels();
        let mut bytes = Vec::with_capacity(length);
        push_half(&mut bytes, "phi", &self.phi, shape.phi, r)?;
        push_half(&mut bytes, "channel", &self.channel, r, channels)?;
        bytes.resize(length, 0);
        Ok(bytes)
    }
}
