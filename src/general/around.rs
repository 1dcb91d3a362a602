//! Which chunks around a query count, and how much.

use super::chunks::limit;
use crate::axis::{Piece, Stencil, between, hermite, locate};
use crate::error::Result;

/// Most altitudes and most visibilities.
const MOST_NODES: usize = 64;

/// How a general query gets from chunks to the altitude and the visibility between them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Four chunks, linearly, with creases at the nodes: 0.08 / 0.55 / 1.1 % from `Full` (median, 95th, 99th
    /// percentile; default model).
    Linear,
    /// Eight chunks: along each axis a parabola through the ends of the interval and the nearer of their neighbours,
    /// while the other axis is linear; the four outer chunks, which only bend the result, are read along chords of
    /// their splines. Slight creases at the nodes; 0.03 / 0.24 / 0.6 % from `Full`.
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
    parabolas: [Parabola; MOST_NODES],
}

/// What a parabola through the two nodes of an interval and one next to them does between them.
#[derive(Clone, Copy)]
struct Parabola {
    /// Where the third node is, with the interval from 0 to 1.
    outer: f64,
    /// 1 / (outer · (outer − 1)), or zero where there is no third node.
    bend: f64,
}

/// Weights of the nodes of an axis around a place on it.
pub(super) struct Nodes {
    /// As the format specification defines it.
    pub cubic: Stencil,
    curve: Stencil,
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
        let mut parabolas = [Parabola::NONE; MOST_NODES];
        for (i, parabola) in parabolas[..len - 1].iter_mut().enumerate() {
            *parabola = Parabola::new(&nodes[..len], i);
        }
        Ok(Self {
            len,
            nodes,
            pieces,
            parabolas,
        })
    }

    #[inline]
    pub fn around(&self, x: f64, interpolation: Interpolation) -> Nodes {
        let nodes = &self.nodes[..self.len];
        match locate(nodes, x) {
            None => Nodes {
                cubic: hermite(nodes, x),
                curve: hermite(nodes, x),
                line: hermite(nodes, x),
            },
            Some((i, t)) => Nodes {
                cubic: self.pieces[i].at(t),
                curve: match interpolation {
                    Interpolation::Linear => between((i, t)),
                    Interpolation::Lean => self.parabolas[i].at((i, t)),
                    Interpolation::Full => self.pieces[i].at(t),
                },
                line: between((i, t)),
            },
        }
    }
}

impl Parabola {
    const NONE: Self = Self {
        outer: 2.0,
        bend: 0.0,
    };

    /// Between nodes `i` and `i + 1`, with the nearer of their neighbours.
    fn new(nodes: &[f64], i: usize) -> Self {
        let place = |k: usize| Some((nodes.get(k)? - nodes[i]) / (nodes[i + 1] - nodes[i]));
        let before = i.checked_sub(1).and_then(place);
        let outer = match (before, place(i + 2)) {
            (Some(before), Some(after)) if -before < after - 1.0 => before,
            (Some(before), None) => before,
            (_, Some(after)) => after,
            (None, None) => return Self::NONE,
        };
        Self {
            outer,
            bend: 1.0 / (outer * (outer - 1.0)),
        }
    }

    /// The weights at a place from [`locate`].
    #[inline]
    fn at(&self, (i, t): (usize, f64)) -> Stencil {
        let outer = self.bend * t * (t - 1.0);
        let [low, high] = [1.0 - t - outer * (1.0 - self.outer), t - outer * self.outer];
        match (outer != 0.0, self.outer < 0.0) {
            (false, _) => between((i, t)),
            (_, true) => Stencil {
                first: i - 1,
                len: 3,
                weight: [outer, low, high, 0.0],
            },
            (_, false) => Stencil {
                first: i,
                len: 3,
                weight: [low, high, outer, 0.0],
            },
        }
    }
}

impl Nodes {
    /// Nodes that count, with their weights on the curve and on the line.
    #[inline(always)]
    pub fn taps(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        let taps = (0..self.curve.len).map(|k| {
            let node = self.curve.first + k;
            let on_line = node.wrapping_sub(self.line.first);
            let linear = if on_line < self.line.len {
                self.line.weight[on_line]
            } else {
                0.0
            };
            (node, [self.curve.weight[k], linear])
        });
        taps.filter(|&(_, weights)| weights != [0.0; 2])
    }
}

impl Interpolation {
    /// The share of the chunk with these weights on the curve and on the line of altitudes and of visibilities, if it has one.
    #[inline(always)]
    pub(super) fn share(self, altitude: [f64; 2], visibility: [f64; 2]) -> Option<Share> {
        let [[curve_a, linear_a], [curve_v, linear_v]] = [altitude, visibility];
        let corner = linear_a * linear_v;
        let (weight, near) = match self {
            Self::Linear => (corner, true),
            // The sum of both corrections; what they leave out is their product.
            Self::Lean => (
                curve_a * linear_v + linear_a * curve_v - corner,
                corner != 0.0,
            ),
            Self::Full => (curve_a * curve_v, true),
        };
        (weight != 0.0).then_some(Share {
            weight: weight as f32,
            near,
        })
    }
}
