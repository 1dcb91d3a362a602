//! Which chunks around a query count, and how much.

use super::chunks::limit;
use crate::axis::{Piece, Stencil, between, hermite, locate};
use crate::error::Result;

/// Most altitudes and most visibilities.
const MOST_NODES: usize = 64;

/// How a general query gets from chunks to the altitude and the visibility between them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Four chunks, linearly, with creases at the nodes: 0.08 / 0.6 / 1.1 % from `Full` (median, 95th, 99th
    /// percentile; default model).
    Linear,
    /// Twelve chunks: cubic along each axis while the other is linear; the eight outer chunks, which only bend the
    /// result, are read along chords of their splines. 0.005 / 0.05 / 0.11 % from `Full`.
    #[default]
    Lean,
    /// Sixteen chunks, as the format specification (7.2) defines it and [`Sky`](crate::Sky) computes it.
    Full,
}

/// An axis between chunks, with the work that all queries share done.
pub(super) struct Axis {
    len: usize,
    nodes: [f64; MOST_NODES],
    pieces: [Piece; MOST_NODES],
}

/// Weights of the nodes of an axis around a place on it.
pub(super) struct Nodes {
    pub cubic: Stencil,
    pub line: Stencil,
}

/// What a chunk counts.
#[derive(Clone, Copy)]
pub(super) struct Share {
    pub weight: f32,
    /// Whether it is one of the chunks on the corners of the query's cell, or counts as one.
    pub near: bool,
}

impl Axis {
    pub fn new(what: &'static str, values: impl ExactSizeIterator<Item = f64>) -> Result<Self> {
        let len = values.len();
        limit(what, len, MOST_NODES)?;
        let mut nodes = [0.0; MOST_NODES];
        nodes.iter_mut().zip(values).for_each(|(n, v)| *n = v);
        let mut pieces = [Piece::NONE; MOST_NODES];
        for (i, piece) in pieces[..len - 1].iter_mut().enumerate() {
            *piece = Piece::new(&nodes[..len], i);
        }
        Ok(Self { len, nodes, pieces })
    }

    #[inline]
    pub fn around(&self, x: f64) -> Nodes {
        let nodes = &self.nodes[..self.len];
        match locate(nodes, x) {
            None => Nodes {
                cubic: hermite(nodes, x),
                line: hermite(nodes, x),
            },
            Some((i, t)) => Nodes {
                cubic: self.pieces[i].at(t),
                line: between((i, t)),
            },
        }
    }
}

impl Nodes {
    /// Nodes with their cubic and linear weights.
    #[inline(always)]
    pub fn taps(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        (0..self.cubic.len).map(|k| {
            let node = self.cubic.first + k;
            let on_line = node.wrapping_sub(self.line.first);
            let linear = if on_line < self.line.len {
                self.line.weight[on_line]
            } else {
                0.0
            };
            (node, [self.cubic.weight[k], linear])
        })
    }
}

impl Interpolation {
    /// The share of the chunk with these cubic and linear weights among altitudes and visibilities, if it has one.
    #[inline(always)]
    pub(super) fn share(self, altitude: [f64; 2], visibility: [f64; 2]) -> Option<Share> {
        let [[cubic_a, linear_a], [cubic_v, linear_v]] = [altitude, visibility];
        let corner = linear_a * linear_v;
        let (weight, near) = match self {
            Self::Linear => (corner, true),
            // The sum of both corrections; what they leave out is their product.
            Self::Lean => (
                cubic_a * linear_v + linear_a * cubic_v - corner,
                corner != 0.0,
            ),
            Self::Full => (cubic_a * cubic_v, true),
        };
        (weight != 0.0).then_some(Share {
            weight: weight as f32,
            near,
        })
    }
}
