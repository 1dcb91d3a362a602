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
/// let [mut full, mut linear, mut sky] = [(); 3].map(|()| vec![0.0; model.wavelengths().len()]);
/// PointQuery::new(welkin::DEFAULT_MODEL)?.radiance(&conditions, direction, &mut full)?;
/// PointQuery::new(welkin::DEFAULT_MODEL)?
///     .with_interpolation(Interpolation::Linear)
///     .radiance(&conditions, direction, &mut linear)?;
/// model.sky(&conditions)?.radiance(direction, &mut sky)?;
/// assert!((full[4] / sky[4] - 1.0).abs() < 1e-4);
/// assert!((linear[4] / sky[4] - 1.0).abs() < 0.02);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Four chunks, linearly, with creases at the nodes: 0.06 / 0.75 / 1.3 % from `Full` (median, 95th, 99th
    /// percentile; default model).
    Linear,
    /// Sixteen chunks, as the format specification (7.2) defines it and [`Sky`](crate::Sky) computes it.
    #[default]
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
    /// As the format specification defines it.
    pub cubic: Stencil,
    curve: Stencil,
    pub line: Stencil,
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
    pub fn around(&self, x: f64, interpolation: Interpolation) -> Nodes {
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
                curve: match interpolation {
                    Interpolation::Linear => between((i, t)),
                    Interpolation::Full => self.pieces[i].at(t),
                },
                line: between((i, t)),
            },
        }
    }
}

impl Nodes {
    /// Nodes that count and their weights.
    #[inline(always)]
    pub fn taps(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.curve.taps()
    }
}
