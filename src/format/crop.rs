//! Takes files apart and keeps a part of their nodes. Format specification, sections 4 to 6.

use zerocopy::little_endian::U16;

use super::axis_table::AxisTable;
use super::density::{DensityTable, DensityView};
use super::encoding::{check_chunk, decode};
use super::estimate::{Estimate, view as estimate_view};
use super::head::{Head, Kind};
use super::layout::POLARISATION_PARTS;
use super::matrix::{columns, narrow, pick, rows};
use super::parse::parse;
use super::polarisation_factors::{PolarisationBasis, PolarisationFactors};
use super::source_function::{SourceBasis, SourceBasisView, SourceCore, SourceView};
use super::spectrum::{Spectrum, view as spectrum_view};
use super::views::{BasisView, ColumnView, FactorsView};
use super::write::{Chunk, ColumnTable, Payload, RadianceBasis, RadianceFactors};
use crate::error::{Error, Result};
use crate::kernel::half::widen;

/// Indices of the nodes that [`crop`] keeps, each strictly increasing.
///
/// ```
/// use welkin::Model;
/// use welkin::format::{Selection, crop, encode, unpack};
///
/// let (mut head, mut chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let lowest = Selection { altitudes: vec![0, 1], ..Selection::all(&head) };
/// crop(&mut head, &mut chunks, &lowest)?;
/// let small = Model::from_bytes(encode(&head, &chunks)?)?;
/// assert_eq!(small.head().altitudes.len(), 2);
/// assert!(small.file_bytes() < welkin::DEFAULT_MODEL.len() / 2);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// Into the altitudes.
    pub altitudes: Vec<usize>,
    /// Into the visibilities.
    pub visibilities: Vec<usize>,
    /// Into the wavelengths, at least two.
    pub wavelengths: Vec<usize>,
}

impl Selection {
    /// Everything that `head` has.
    pub fn all(head: &Head) -> Self {
        Self {
            altitudes: (0..head.altitudes.len()).collect(),
            visibilities: (0..head.visibilities.len()).collect(),
            wavelengths: (0..head.wavelengths.len()).collect(),
        }
    }
}

/// Reads a whole file into what [`encode`](super::encode) writes. Chunks of unknown kinds are left out.
///
/// # Errors
/// As a reader that touches every chunk.
pub fn unpack(file: &[u8]) -> Result<(Head, Vec<Chunk>)> {
    let contents = parse(file)?;
    let shape = contents.head.shape();
    let (nk, nw) = (contents.head.constituents, contents.head.wavelengths.len());
    let mut chunks = Vec::new();
    for (i, entry) in contents.directory.iter().enumerate() {
        let stored = &file[entry.offset..entry.offset + entry.length];
        let payload = decode(i, entry, stored)?;
        check_chunk(&contents.head, i, entry, &payload)?;
        let payload = match entry.kind {
            Kind::Unknown(_) => continue,
            Kind::Radiance => {
                let view = FactorsView::radiance(&payload, &shape, entry.rank)?;
                Payload::Radiance(radiance(&view))
            }
            Kind::RadianceBasis => {
                let view = BasisView::radiance(&payload, &shape, entry.rank)?;
                Payload::RadianceBasis(radiance_basis(&view))
            }
            Kind::Column => Payload::Column(ColumnTable {
                values: narrow(ColumnView::new(&payload, &shape)?.values),
            }),
            Kind::Polarisation => {
                let view = FactorsView::polarisation(&payload, &shape, entry.rank)?;
                Payload::Polarisation(polarisation(&view))
            }
            Kind::PolarisationBasis => {
                let view = BasisView::polarisation(&payload, &shape, entry.rank)?;
                Payload::PolarisationBasis(polarisation_basis(&view))
            }
            Kind::Transmittance => {
                let view = DensityView::new(&payload, nk, contents.head.planet.top)?;
                Payload::Transmittance(DensityTable::from(&view))
            }
            Kind::Source => Payload::Source(SourceCore::from(&SourceView::new(&payload, nk, nw)?)),
            Kind::Spectrum => {
                Payload::Spectrum(Spectrum::from(&spectrum_view(&contents.head, &payload)?))
            }
            Kind::Estimate => {
                Payload::Estimate(Estimate::from(&estimate_view(&contents.head, &payload)?))
            }
            Kind::Axis => Payload::Axis(AxisTable::read(&contents.head, &payload)?),
            Kind::SourceBasis => {
                Payload::SourceBasis(SourceBasis::from(&SourceBasisView::new(&payload, nw)?))
            }
        };
        chunks.push(Chunk {
            altitude: entry.altitude,
            visibility: entry.visibility,
            error_median: entry.error_median,
            error_p99: entry.error_p99,
            payload,
        });
    }
    Ok((contents.head, chunks))
}

/// Keeps the nodes of `selection` and the chunks that stand at them.
///
/// The colour weights of the remaining wavelengths stay as they are; they no longer add up to the colour of the whole
/// spectrum, so set [`Head::xyz`] where wavelengths are left out. A spectrum chunk stays only if all wavelengths with a
/// weight in it do; without it the model ends at its first and last wavelength, and interpolates between neighbours.
///
/// An axis chunk keeps the values of the visibilities that stay. Where its values are no affine function of 1/V, leaving
/// out nodes between others moves the visibilities that values between those are answered for.
///
/// # Errors
/// [`Error::Invalid`] for indices that do not increase or that the head does not have.
pub fn crop(head: &mut Head, chunks: &mut Vec<Chunk>, selection: &Selection) -> Result<()> {
    check("altitudes", &selection.altitudes, head.altitudes.len())?;
    check(
        "visibilities",
        &selection.visibilities,
        head.visibilities.len(),
    )?;
    check(
        "wavelengths",
        &selection.wavelengths,
        head.wavelengths.len(),
    )?;
    let (nw, nf) = (head.wavelengths.len(), head.fields.len());
    let kept = |channel: &[f32], parts: usize| {
        let part = |f: usize| selection.wavelengths.iter().map(move |w| f * nw + w);
        let channels: Vec<usize> = (0..parts).flat_map(part).collect();
        columns(channel, parts * nw, &channels)
    };
    chunks.retain_mut(|chunk| {
        let altitude = position(&selection.altitudes, chunk.altitude);
        let visibility = position(&selection.visibilities, chunk.visibility);
        let (Ok(altitude), Ok(visibility)) = (altitude, visibility) else {
            return false;
        };
        (chunk.altitude, chunk.visibility) = (altitude, visibility);
        match &mut chunk.payload {
            Payload::Radiance(factors) => {
                if !head.estimated {
                    factors.level = columns(&factors.level, nw, &selection.wavelengths);
                }
            }
            Payload::RadianceBasis(basis) => basis.channel = kept(&basis.channel, nf),
            Payload::PolarisationBasis(basis) => {
                basis.channel = kept(&basis.channel, POLARISATION_PARTS);
            }
            Payload::Estimate(estimate) => estimate.keep(nw, &selection.wavelengths),
            Payload::Axis(table) => table.values = pick(&table.values, &selection.visibilities),
            Payload::Source(core) => core.keep(nw, &selection.wavelengths),
            Payload::SourceBasis(basis) => basis.keep(nw, &selection.wavelengths),
            Payload::Spectrum(spectrum) => {
                return spectrum.keep(head, &selection.visibilities, &selection.wavelengths);
            }
            Payload::Column(_) | Payload::Polarisation(_) | Payload::Transmittance(_) => {}
        }
        true
    });
    crop_head(head, selection);
    Ok(())
}

/// Where a node stands among those that are kept; an error if it is not one of them.
fn position(kept: &[usize], node: Option<usize>) -> core::result::Result<Option<usize>, usize> {
    node.map(|i| kept.binary_search(&i)).transpose()
}

fn crop_head(head: &mut Head, selection: &Selection) {
    let Selection {
        altitudes,
        visibilities,
        wavelengths,
    } = selection;
    *head = head.at_wavelengths(wavelengths);
    let nw = head.wavelengths.len();
    let rows = |table: &[f64], width| rows(table, width, visibilities);
    head.extinction = rows(&head.extinction, head.constituents * nw);
    head.spherical_albedo = rows(&head.spherical_albedo, nw);
    head.altitudes = pick(&head.altitudes, altitudes);
    head.visibilities = pick(&head.visibilities, visibilities);
}

fn check(what: &'static str, indices: &[usize], count: usize) -> Result<()> {
    let increasing = indices.windows(2).all(|w| w[0] < w[1]);
    if increasing && indices.last().is_some_and(|&i| i < count) {
        return Ok(());
    }
    let detail = format!("expected increasing indices below {count}, got {indices:?}");
    Err(Error::invalid(what, detail))
}

fn radiance(view: &FactorsView) -> RadianceFactors {
    let rank = view.rank;
    let rows = |table: &[U16]| unpadded(table, view.stride, rank);
    RadianceFactors {
        rank,
        scale: narrow(&view.scale[..rank]),
        alpha_up: rows(view.alpha_up),
        alpha_down: rows(view.alpha_down),
        elevation: rows(view.elevation),
        level: view.level.iter().map(|&h| widen(h)).collect(),
    }
}

fn polarisation(view: &FactorsView) -> PolarisationFactors {
    let rows = |table: &[U16]| unpadded(table, view.stride, view.rank);
    PolarisationFactors {
        rank: view.rank,
        scale: narrow(&view.scale[..view.rank]),
        alpha_up: rows(view.alpha_up),
        alpha_down: rows(view.alpha_down),
        elevation: rows(view.elevation),
    }
}

fn radiance_basis(view: &BasisView) -> RadianceBasis {
    let (phi, channel) = matrices(view);
    RadianceBasis {
        rank: view.rank,
        phi,
        channel,
    }
}

fn polarisation_basis(view: &BasisView) -> PolarisationBasis {
    let (phi, channel) = matrices(view);
    PolarisationBasis {
        rank: view.rank,
        phi,
        channel,
    }
}

fn matrices(view: &BasisView) -> (Vec<f32>, Vec<f32>) {
    let channel = &view.channel[..view.rank * view.channel_stride];
    (
        unpadded(view.phi, view.stride, view.rank),
        unpadded(channel, view.channel_stride, view.channels),
    )
}

fn unpadded(table: &[U16], stride: usize, width: usize) -> Vec<f32> {
    let rows = table.chunks_exact(stride);
    rows.flat_map(|row| row[..width].iter().map(|&h| widen(h)))
        .collect()
}
