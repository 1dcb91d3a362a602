//! Optical depths of the air before the disc.

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::format::{AlphaAxis, Head, Kind};
use crate::geometry::{Planet, Side};
use crate::kernel::axis::Stencil;
use crate::kernel::axis::{Ends, alpha_coordinate, spline};
use crate::kernel::math::{LANES, exp};
use crate::model::Model;
use crate::sky::prepare::NodeWeights;
use crate::spectrum::SpectralInterpolation;
use crate::transmittance::{Amounts, Extinction, Layers, visibility_weights};

/// Elevations at which depths are kept, over the visible part of the disc.
pub(super) const NODES: usize = 129;
/// More lets nothing through, and its differences stay exact.
const OPAQUE: f32 = 1e4;

/// Optical depths to space over a narrow band of elevations.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    lowest: f64,
    nodes_per_radian: f64,
    wavelengths: usize,
    /// `[node][wavelength]`.
    depths: Vec<f32>,
    /// Columns to space, m, `[node]`; for models with a spectrum.
    columns: Vec<Amounts>,
    visibility: Stencil,
}

impl Depths {
    /// Of an observer at the wavelengths of `head`, between two elevations (rad) that are not below the geometric horizon.
    pub fn new(
        model: &Model,
        head: &Head,
        conditions: &Conditions,
        [low, high]: [f64; 2],
    ) -> Result<Self> {
        let wavelengths = head.wavelengths.len();
        let extinction = Extinction::new(head, conditions.visibility);
        let columns = Columns::new(model, conditions)?;
        let mut depths = Vec::with_capacity(NODES * wavelengths);
        let mut kept = Vec::new();
        for i in 0..NODES {
            let elevation = low + (high - low) * (i as f64 / (NODES - 1) as f64);
            let amounts = columns.to_space(elevation);
            if model.has_spectrum() {
                kept.push(amounts);
            }
            for first in (0..wavelengths).step_by(LANES) {
                let block = extinction.depth(&amounts, first / LANES);
                let bounded = block.map(|depth| if depth < OPAQUE { depth } else { OPAQUE });
                depths.extend(&bounded[..LANES.min(wavelengths - first)]);
            }
        }
        Ok(Self {
            lowest: low,
            nodes_per_radian: (NODES - 1) as f64 / (high - low).max(f64::MIN_POSITIVE),
            wavelengths,
            depths,
            columns: kept,
            visibility: visibility_weights(head, conditions.visibility),
        })
    }

    /// Transmittance at an elevation (rad): cubic in four depths.
    pub fn transmittance(&self, elevation: f64, out: &mut [f32]) {
        let (first, [a, b, c, d]) = self.around(elevation);
        let row = |i: usize| &self.depths[(first + i) * self.wavelengths..][..out.len()];
        let (p, q, r, s) = (row(0), row(1), row(2), row(3));
        for (w, out) in out.iter_mut().enumerate() {
            let depth = a * p[w] + b * q[w] + c * r[w] + d * s[w];
            *out = exp(-depth.max(0.0));
        }
    }

    /// Transmittance at an elevation (rad) and any wavelength (nm) in range, if the model has a spectrum: columns are
    /// cubic in four.
    pub fn transmittance_at(
        &self,
        interpolation: &SpectralInterpolation,
        elevation: f64,
        wavelength: f64,
    ) -> Option<f64> {
        let (first, weights) = self.around(elevation);
        let nodes = self.columns.get(first..first + weights.len())?;
        let column = |k: usize| -> f32 {
            let terms = weights.iter().zip(nodes);
            terms.map(|(w, node)| w * node.get(k)).sum::<f32>().max(0.0)
        };
        interpolation.transmittance(wavelength, &self.visibility, column)
    }

    /// Depths at all wavelengths, node by node.
    pub fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.depths.chunks_exact(self.wavelengths)
    }

    /// Elevation of the first node, rad, and nodes per radian.
    pub fn axis(&self) -> [f64; 2] {
        [self.lowest, self.nodes_per_radian]
    }

    /// The first of four nodes around an elevation, and their weights.
    fn around(&self, elevation: f64) -> (usize, [f32; 4]) {
        let last = (NODES - 1) as f64;
        let u = ((elevation - self.lowest) * self.nodes_per_radian).clamp(0.0, last);
        let first = (u as usize).clamp(1, NODES - 3) - 1;
        (first, cubic((u - first as f64) as f32))
    }
}

/// Weights of the nodes 0, 1, 2 and 3 at `u` (Lagrange).
fn cubic(u: f32) -> [f32; 4] {
    let [a, b, c, d] = [0.0, 1.0, 2.0, 3.0].map(|node| u - node);
    [
        b * c * d * (-1.0 / 6.0),
        a * c * d * 0.5,
        a * b * d * -0.5,
        a * b * c * (1.0 / 6.0),
    ]
}

/// Columns from an observer to space.
enum Columns {
    /// Those of [`Model::transmittance`].
    Transmittance { layers: Layers, altitude: f64 },
    /// Where a file has none: what the sky uses, far less exact near the horizon.
    Mean(MeanDensities),
}

impl Columns {
    fn new(model: &Model, conditions: &Conditions) -> Result<Self> {
        let (head, altitude) = (model.head(), conditions.altitude);
        if model.find(Kind::Transmittance, None, None).is_ok() {
            let layers = Layers::new(&model.density_chunk()?, head.planet, head.constituents);
            return Ok(Self::Transmittance { layers, altitude });
        }
        MeanDensities::new(model, conditions).map(Self::Mean)
    }

    fn to_space(&self, elevation: f64) -> Amounts {
        match self {
            Self::Transmittance { layers, altitude } => layers.to_space(*altitude, elevation.sin()),
            Self::Mean(densities) => densities.to_space(elevation),
        }
    }
}

/// Logarithms of mean densities along rays. Format specification, section 7.2.
struct MeanDensities {
    planet: Planet,
    altitude: f64,
    axis: AlphaAxis,
    constituents: usize,
    /// Spline coefficients, `[up][constituent]`.
    coefficients: Vec<f64>,
}

impl MeanDensities {
    fn new(model: &Model, conditions: &Conditions) -> Result<Self> {
        let head = model.head();
        let place = NodeWeights::new(head, conditions);
        let keys = place
            .altitudes
            .taps()
            .map(|(a, _)| (Kind::Column, Some(a), None));
        model.prefetch(keys)?;
        let mut coefficients = vec![0.0; head.shape().up * head.constituents];
        for (a, weight) in place.altitudes.taps() {
            let column = model.column_chunk(a)?;
            for (sum, value) in coefficients.iter_mut().zip(column.values) {
                *sum += weight * f64::from(value.get());
            }
        }
        if coefficients.iter().any(|c| !c.is_finite()) {
            return Err(Error::invalid("model", "its columns overflow"));
        }
        Ok(Self {
            planet: head.planet,
            altitude: conditions.altitude,
            axis: head.up,
            constituents: head.constituents,
            coefficients,
        })
    }

    fn to_space(&self, elevation: f64) -> Amounts {
        let angle = elevation + self.planet.dip(self.altitude);
        let ray = self
            .planet
            .ray_beside_horizon(self.altitude, Side::Up, angle);
        let AlphaAxis {
            intervals,
            exponent,
        } = self.axis;
        let u = alpha_coordinate(ray.angle, ray.range, intervals, exponent);
        let taps = spline(u, intervals, Ends::Free);
        let mut amounts = Amounts::default();
        for k in 0..self.constituents {
            let terms = taps.index.iter().zip(taps.weight);
            let at = |i: usize| self.coefficients[i * self.constituents + k];
            let logarithm: f64 = terms.map(|(&i, w)| f64::from(w) * at(i)).sum();
            amounts.0[k / LANES][k % LANES] = (ray.length * logarithm.exp()) as f32;
        }
        amounts
    }
}
