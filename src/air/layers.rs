//! Densities along straight lines, in closed form. Format specification, section 7.6.
//!
//! With `w = h + h²/2R` the squared distance from the planet's centre is `R² + 2Rw`, so that along a line `w` is a parabola of the
//! distance from the tangent point. A density that is quadratic in `w` within a layer therefore has a mean over any
//! piece of a line that needs no quadrature, and columns add up, reverse and grow exactly as they should.

use crate::format::DensityView;
use crate::geometry::Planet;
use crate::lanes::Lanes;
use crate::math::LANES;

/// Vectors of constituents.
const QUADS: usize = 4;

/// One number per constituent: densities, or columns in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Amounts(pub [[f32; LANES]; QUADS]);

impl Amounts {
    /// Sum of products.
    fn dot(&self, other: &Amounts) -> f32 {
        let terms = self.0.as_flattened().iter().zip(other.0.as_flattened());
        terms.map(|(a, b)| a * b).sum()
    }

    /// Of constituent `k`.
    #[inline(always)]
    pub fn get(&self, k: usize) -> f32 {
        self.0[k / LANES][k % LANES]
    }
}

/// A line through the atmosphere: its closest approach to the planet's centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// `w` at the tangent point, m.
    pub lowest: f64,
}

/// What a line crosses of one layer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Distances of its ends from the tangent point, m.
    pub start: f64,
    pub end: f64,
    layer: usize,
    /// Mean of the share of the layer and of its square.
    mean: f32,
    square: f32,
}

impl Piece {
    #[inline(always)]
    fn length(&self) -> f32 {
        (self.end - self.start) as f32
    }

    /// Mean of the polynomial with these coefficients.
    #[inline(always)]
    pub fn mean(&self, [a, b, c]: [f32; 3]) -> f32 {
        // Rounding must not make a density negative.
        (a + b * self.mean + c * self.square).max(0.0)
    }
}

/// Density in one layer as a polynomial of the share `t` of the layer: `a + b·t + c·t²`.
#[derive(Clone, Copy, Debug)]
struct Layer {
    bottom: f64,
    /// 1 / thickness.
    rate: f64,
    /// The same over the diameter of the planet.
    bend: f64,
    polynomial: [Amounts; 3],
}

/// Piecewise quadratic densities of all constituents.
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    planet: Planet,
    /// Edges in `w`, m: −∞, that of the ground, …
    edges: Vec<f64>,
    /// The first lies below the ground.
    layers: Vec<Layer>,
    pub quads: usize,
    pub constituents: usize,
}

impl Layers {
    pub fn new(view: &DensityView, planet: Planet, constituents: usize) -> Self {
        let altitudes = view.edges.iter().map(|h| planet.squared_altitude(h.get()));
        let edges: Vec<f64> = core::iter::once(f64::NEG_INFINITY)
            .chain(altitudes)
            .collect();
        let row = |i: usize| &view.density[i * constituents..(i + 1) * constituents];
        let above = edges[1..].windows(2).enumerate().map(|(i, edge)| {
            let mut polynomial = [Amounts::default(); 3];
            for k in 0..constituents {
                let [a, b, c] = [row(2 * i)[k], row(2 * i + 1)[k], row(2 * i + 2)[k]]
                    .map(|v| f64::from(v.get()));
                let monomials = [a, 2.0 * (b - a), a - 2.0 * b + c];
                for (out, value) in polynomial.iter_mut().zip(monomials) {
                    out.0[k / LANES][k % LANES] = value as f32;
                }
            }
            Layer {
                bottom: edge[0],
                rate: 1.0 / (edge[1] - edge[0]),
                bend: 1.0 / (edge[1] - edge[0]) / (2.0 * planet.radius),
                polynomial,
            }
        });
        let mut layers = vec![Layer {
            bottom: 0.0,
            rate: 0.0,
            bend: 0.0,
            polynomial: [Amounts::default(); 3],
        }];
        layers.extend(above);
        // Below the ground the density stays what it is there.
        layers[0].polynomial[0] = layers[1].polynomial[0];
        Self {
            planet,
            edges,
            layers,
            quads: constituents.div_ceil(LANES),
            constituents,
        }
    }

    pub fn planet(&self) -> Planet {
        self.planet
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of_val(self.edges.as_slice()) + size_of_val(self.layers.as_slice())
    }

    /// Columns on `line` between the distances `from < to` from its tangent point (negative before it), m.
    #[inline(always)]
    pub fn columns(&self, line: Line, from: f64, to: f64) -> Amounts {
        match self.quads {
            // The usual case: the sums stay in a register.
            1 => self.sums::<1>(line, from, to),
            _ => self.sums::<QUADS>(line, from, to),
        }
    }

    #[inline(always)]
    fn sums<const N: usize>(&self, line: Line, from: f64, to: f64) -> Amounts {
        let mut sums = [Lanes::splat(0.0); N];
        self.walk(
            line,
            from,
            to,
            #[inline(always)]
            |piece| {
                let [a, b, c] = &self.layers[piece.layer].polynomial;
                let length = piece.length();
                for (q, sum) in sums.iter_mut().enumerate() {
                    let [a, b, c] = [a, b, c].map(|amounts| Lanes(amounts.0[q]));
                    let mean = a + b * piece.mean + c * piece.square;
                    // Rounding must not make a density negative.
                    *sum = *sum + mean.max(Lanes::splat(0.0)) * length;
                }
            },
        );
        let mut amounts = Amounts::default();
        for (out, sum) in amounts.0.iter_mut().zip(sums) {
            *out = sum.0;
        }
        amounts
    }

    /// Densities weighted by `weight` and summed: the polynomial of each layer.
    pub fn weighted(&self, weight: &Amounts) -> Vec<[f32; 3]> {
        let polynomial = |layer: &Layer| layer.polynomial.map(|amounts| amounts.dot(weight));
        self.layers.iter().map(polynomial).collect()
    }

    /// Column of a piece in terms of the densities that [`Layers::weighted`] gives.
    #[inline(always)]
    pub fn column_of(&self, weighted: &[[f32; 3]], piece: &Piece) -> f32 {
        piece.length() * piece.mean(weighted[piece.layer])
    }

    /// Visits what the line crosses of each layer between the distances `from < to`, in this order.
    #[inline(always)]
    pub fn walk(&self, line: Line, from: f64, to: f64, mut visit: impl FnMut(Piece)) {
        let diameter = 2.0 * self.planet.radius;
        // Square of the distance at which the line is at the edge.
        let reach = |edge: f64| (edge - line.lowest) * diameter;
        let mut s = from;
        let top = reach(self.edges[self.layers.len()]).max(0.0);
        if s < 0.0 && s * s > top {
            s = -top.sqrt();
        }
        let mut i = self.find(line.lowest + s * s / diameter);
        while s < to && i < self.layers.len() {
            let below = reach(self.edges[i]);
            // Inwards through the lower edge, or over the tangent point and outwards through the upper one.
            let inwards = s < 0.0 && below > 0.0;
            let stop = match inwards {
                true => -below.sqrt(),
                false => reach(self.edges[i + 1]).max(0.0).sqrt(),
            };
            // Beyond an edge only by rounding: nothing is crossed.
            let stop = stop.max(s).min(to);
            visit(self.piece(line, i, s, stop));
            s = stop;
            // The line that leaves the lowest layer inwards does not exist: it reaches down to −∞.
            i = if inwards { i - 1 } else { i + 1 };
        }
    }

    /// Part of a piece.
    #[inline(always)]
    pub fn part(&self, line: Line, of: &Piece, start: f64, end: f64) -> Piece {
        self.piece(line, of.layer, start, end)
    }

    #[inline(always)]
    fn piece(&self, line: Line, i: usize, start: f64, end: f64) -> Piece {
        let (middle, length) = (0.5 * (start + end), end - start);
        let (m2, d2) = (middle * middle, length * length);
        let layer = &self.layers[i];
        let bend = layer.bend;
        let mean = (line.lowest - layer.bottom) * layer.rate + (m2 + d2 * (1.0 / 12.0)) * bend;
        let variance = (m2 * (1.0 / 3.0) + d2 * (1.0 / 180.0)) * d2 * bend * bend;
        Piece {
            start,
            end,
            layer: i,
            mean: mean as f32,
            square: (mean * mean + variance) as f32,
        }
    }

    #[inline(always)]
    fn find(&self, w: f64) -> usize {
        let inner = &self.edges[1..self.layers.len()];
        inner.partition_point(|&edge| edge <= w)
    }
}
