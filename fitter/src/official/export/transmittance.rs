//! The transmittance of a model in the official form: its square root at the nodes of far ends, by a singular value
//! decomposition for each altitude.

use crate::decompose::principal_basis;
use crate::official::angles::PLANET_RADIUS;
use crate::official::layout::Channels;
use crate::official::transmittance::{Shape, TOP, Transmittance, longest};
use anyhow::Result;
use faer::Mat;
use rayon::prelude::*;
use welkin::{BandTransmittance, Bands, Model};

/// Nodes of the arc and of the height of far ends, and components, as published.
const PUBLISHED: [usize; 3] = [202, 172, 12];

/// The transmittance of `model` in `bands`, from altitudes (m), at visibilities (km). `progress` is told every altitude.
pub fn transmittance(
    model: &Model,
    (bands, channels): (&Bands, Channels),
    altitudes: &[f64],
    visibilities: &[f64],
    progress: &(dyn Fn() + Sync),
) -> Result<Transmittance> {
    let [arcs, heights, rank] = PUBLISHED;
    let columns = visibilities.len() * channels.count;
    let rank = rank.min(columns);
    let airs = visibilities
        .iter()
        .map(|v| Ok(model.band_transmittance(1e3 * v, bands)?))
        .collect::<Result<Vec<BandTransmittance>>>()?;
    let one = |h: &f64| -> Result<[Vec<f32>; 2]> {
        let roots = roots(&airs, channels.count, *h, [arcs, heights])?;
        let factors = decompose(&roots, columns, rank);
        progress();
        Ok(factors)
    };
    let parts: Vec<[Vec<f32>; 2]> = altitudes.par_iter().map(one).collect::<Result<_>>()?;
    let shape = Shape {
        arcs,
        heights,
        visibilities: visibilities.len(),
        altitudes: altitudes.len(),
        rank,
    };
    let paths = parts.iter().flat_map(|p| p[0].iter().copied()).collect();
    // Each altitude has `[visibility][channel][rank]`; the file has the visibility first.
    let row = channels.count * rank;
    let airs = (0..visibilities.len())
        .flat_map(|v| parts.iter().flat_map(move |p| &p[1][v * row..][..row]));
    let airs = airs.copied().collect();
    let single = |nodes: &[f64]| nodes.iter().map(|n| *n as f32).collect::<Vec<f32>>();
    let axes = [single(altitudes), single(visibilities)];
    Ok(Transmittance::new(shape, channels, axes, [paths, airs])?)
}

/// Square roots of the transmittance, `[arc][height][visibility][channel]`.
fn roots(
    airs: &[BandTransmittance],
    channels: usize,
    h: f64,
    [arcs, heights]: [usize; 2],
) -> Result<Vec<f32>> {
    let mut out = Vec::with_capacity(arcs * heights * airs.len() * channels);
    let mut through = vec![0.0; channels];
    for arc in 0..arcs {
        let angle = (arc as f64 / arcs as f64).powi(4) * longest() / PLANET_RADIUS;
        for height in 0..heights {
            let r = PLANET_RADIUS + TOP * (height as f64 / heights as f64).powi(3);
            // Without the cancellation of r cos − R.
            let half = (0.5 * angle).sin();
            let end = [
                r * angle.sin(),
                0.0,
                r - PLANET_RADIUS - 2.0 * r * half * half,
            ];
            for air in airs {
                air.transmittance([0.0, 0.0, h], end, &mut through)?;
                out.extend(through.iter().map(|t| t.max(0.0).sqrt()));
            }
        }
    }
    Ok(out)
}

/// Factors `[row][rank]` and `[column][rank]` of a matrix `[row][columns]`.
fn decompose(matrix: &[f32], columns: usize, rank: usize) -> [Vec<f32>; 2] {
    let mut gram = Mat::<f64>::zeros(columns, columns);
    for row in matrix.chunks_exact(columns) {
        for (i, a) in row.iter().enumerate() {
            for (j, b) in row[..=i].iter().enumerate() {
                gram[(i, j)] += f64::from(*a) * f64::from(*b);
            }
        }
    }
    for i in 0..columns {
        for j in 0..i {
            gram[(j, i)] = gram[(i, j)];
        }
    }
    let vectors = principal_basis(&gram, 0.0);
    let project = |row: &[f32]| -> Vec<f32> {
        let one = |r: usize| {
            let pairs = row.iter().enumerate();
            let sum: f64 = pairs.map(|(i, v)| f64::from(*v) * vectors[(i, r)]).sum();
            sum as f32
        };
        (0..rank).map(one).collect()
    };
    let rows = matrix.chunks_exact(columns).flat_map(project).collect();
    let airs = (0..columns).flat_map(|i| (0..rank).map(move |r| (i, r)));
    [rows, airs.map(|(i, r)| vectors[(i, r)] as f32).collect()]
}
