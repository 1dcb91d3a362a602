//! Densities along straight lines, in closed form. Format specification, section 7.6.
//!
//! With `w = h + h²/2R` the squared distance from the planet's centre is `R² + 2Rw`, so that along a line `w` is a parabola of the
//! distance from the tangent point. A density that is quadratic in `w` within a layer therefore has a mean over any
//! piece of a line that needs no quadrature, and columns add up, reverse and grow exactly as they should.

use crate::format::DensityView;
use crate::geometry::Planet;
use crate::math::LANES;

/// Vectors of constituents.
const QUADS: usize = 4;

/// One number per constituent: densities, or columns in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Amounts(pub [[f32; LANES]; QUADS]);

impl Amounts {
    #[inline(always)]
    pub fn add(&mut self, other: &Amounts, quads: usize) {
        for (sum, term) in self.0[..quads].iter_mut().zip(&other.0) {
            *sum = core::array::from_fn(|i| sum[i] + term[i]);
        }
    }

    /// Sum of products.
    #[inline(always)]
    pub fn dot(&self, other: &Amounts) -> f32 {
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

/// Density in one layer as a polynomial of the share `t` of the layer: `a + b·t + c·t²`.
#[derive(Clone, Copy, Debug)]
struct Layer {
    bottom: f64,
    /// 1 / thickness.
    rate: f64,
    polynomial: [Amounts; 3],
}

/// Piecewise quadratic densities of all constituents.
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    planet: Planet,
    /// Edges in `w`, m.
    edges: Vec<f64>,
    layers: Vec<Layer>,
    pub quads: usize,
    pub constituents: usize,
}

impl Layers {
    pub fn new(view: &DensityView, planet: Planet, constituents: usize) -> Self {
        let edges: Vec<f64> = view
            .edges
            .iter()
            .map(|h| planet.squared_altitude(h.get()))
            .collect();
        let row = |i: usize| &view.density[i * constituents..(i + 1) * constituents];
        let layers = edges
            .windows(2)
            .enumerate()
            .map(|(i, edge)| {
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
                    polynomial,
                }
            })
            .collect();
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
    #[inline]
    pub fn columns(&self, line: Line, from: f64, to: f64) -> Amounts {
        let mut sum = Amounts::default();
        self.pieces(line, from, to, |_, _, column| sum.add(&column, self.quads));
        sum
    }

    /// Hands every piece of the line that lies in one layer to `emit`: its ends, counted outwards, and its columns.
    #[inline(always)]
    pub fn pieces(&self, line: Line, from: f64, to: f64, mut emit: impl FnMut(f64, f64, Amounts)) {
        if from < 0.0 {
            self.outwards(line, (-to).max(0.0), -from, &mut emit);
        }
        if to > 0.0 {
            self.outwards(line, from.max(0.0), to, &mut emit);
        }
    }

    #[inline(always)]
    fn outwards(&self, line: Line, from: f64, to: f64, emit: &mut impl FnMut(f64, f64, Amounts)) {
        let diameter = 2.0 * self.planet.radius;
        let start = line.lowest + from * from / diameter;
        let mut s = from;
        if start < 0.0 {
            // Below the ground the density stays what it is there.
            let exit = (-line.lowest * diameter).max(0.0).sqrt().clamp(s, to);
            emit(s, exit, self.layers[0].over(0.0, 0.0, exit - s, self.quads));
            s = exit;
        }
        let mut i = self.find(start);
        while s < to && i < self.layers.len() {
            let top = (self.edges[i + 1] - line.lowest) * diameter;
            let end = if top >= to * to {
                to
            } else {
                top.max(s * s).sqrt()
            };
            let (middle, length) = (0.5 * (s + end), end - s);
            let (m2, d2) = (middle * middle, length * length);
            let layer = &self.layers[i];
            let scale = layer.rate / diameter;
            let mean = (line.lowest - layer.bottom) * layer.rate + (m2 + d2 / 12.0) * scale;
            let variance = (m2 / 3.0 + d2 / 180.0) * d2 * scale * scale;
            emit(s, end, layer.over(mean, variance, length, self.quads));
            s = end;
            i += 1;
        }
    }

    #[inline(always)]
    fn find(&self, w: f64) -> usize {
        let inner = &self.edges[1..self.layers.len()];
        inner.partition_point(|&edge| edge <= w)
    }
}

impl Layer {
    /// Mean density where the share `t` has this mean and mean square.
    #[inline(always)]
    fn mean(&self, t: f32, square: f32, quads: usize) -> Amounts {
        let mut out = Amounts::default();
        let [a, b, c] = &self.polynomial;
        for q in 0..quads {
            let value = |i: usize| a.0[q][i] + b.0[q][i] * t + c.0[q][i] * square;
            // Rounding must not make a density negative.
            out.0[q] = core::array::from_fn(|i| value(i).max(0.0));
        }
        out
    }

    #[inline(always)]
    fn over(&self, mean: f64, variance: f64, length: f64, quads: usize) -> Amounts {
        let mut out = self.mean(mean as f32, (mean * mean + variance) as f32, quads);
        for q in 0..quads {
            out.0[q] = core::array::from_fn(|i| out.0[q][i] * length as f32);
        }
        out
    }
}
