//! Which chunks around a query count, and how much.

use super::chunk_table::limit;
use crate::error::Result;
use crate::kernel::axis::{Piece, Stencil, between, hermite, locate};

/// Most altitudes and most visibilities.
const MOST_NODES: usize = 64;

/// How a point query gets from chunks to the altitude and the visibility between them.
///
/// ```
/// use welkin::{Conditions, Interpolation, Model, PointQuery};
///
/// let conditions = Conditions { altitude: 700.0, ..Conditions::default() };
/// let direction = [0.3, 0.1, 0.9];
/// let model = Model::default_model()?;
/// let [mut lean, mut full, mut sky] = [(); 3].map(|()| vec![0.0; model.wavelengths().len()]);
/// PointQuery::new(welkin::DEFAULT_MODEL)?.radiance(&conditions, direction, &mut lean)?;
/// PointQuery::new(welkin::DEFAULT_MODEL)?
///     .with_interpolation(Interpolation::Full)
///     .radiance(&conditions, direction, &mut full)?;
/// model.sky(&conditions)?.radiance(direction, &mut sky)?;
/// assert!((full[4] / sky[4] - 1.0).abs() < 1e-4);
/// assert!((lean[4] / sky[4] - 1.0).abs() < 0.02);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Four chunks, linearly, with creases at the nodes: 0.06 / 0.62 / 1.3 % from `Full` (median, 95th, 99th
    /// percentile; default model).
    Linear,
    /// Six chunks: a line over altitude; over visibility a parabola through the ends of the
    /// interval and the nearer of their neighbours. The two outer chunks, which only bend the result, are read along
    /// chords of their splines. Slight creases at the nodes; 0.06 / 0.63 / 1.3 % from `Full`, near
    /// the ground less.
    #[default]
    Lean,
    /// Sixteen chunks, as the format specification (7.2) defines it and [`Sky`](crate::Sky) computes it.
    Full,
}

/// How to get from node to node along one axis.
#[derive(Clone, Copy)]
pub(super) enum Curve {
    Line,
    Parabola,
    Cubic,
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
    /// Whether all taps of its splines count, not only those along chords.
    pub whole: bool,
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
    pub fn around(&self, x: f64, curve: Curve) -> Nodes {
        let nodes = &self.nodes[..self.len];
        // Each stencil is made in its place: copying them costs a query 5 %.
        match locate(nodes, x) {
            None => Nodes {
                cubic: hermite(nodes, x),
                curve: hermite(nodes, x),
                line: hermite(nodes, x),
            },
            Some((i, t)) => Nodes {
                cubic: self.pieces[i].at(t),
                curve: match curve {
                    Curve::Line => between((i, t)),
                    Curve::Parabola => self.parabolas[i].at((i, t)),
                    Curve::Cubic => self.pieces[i].at(t),
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
    /// Nodes that count, their weights on the curve, and whether they are an end of the interval.
    #[inline(always)]
    pub fn taps(&self) -> impl Iterator<Item = (usize, f64, bool)> + '_ {
        let ends = self.line.first..self.line.first + self.line.len;
        let taps = self.curve.taps();
        taps.map(move |(node, weight)| (node, weight, ends.contains(&node)))
    }
}

impl Interpolation {
    /// Over altitude and over visibility.
    pub(super) fn curves(self) -> [Curve; 2] {
        match self {
            Self::Linear => [Curve::Line, Curve::Line],
            Self::Lean => [Curve::Line, Curve::Parabola],
            Self::Full => [Curve::Cubic, Curve::Cubic],
        }
    }
}
