//! Densities along straight lines, in closed form. Format specification, section 7.6.
//!
//! With `w = h + h²/2R` the squared distance from the planet's centre is `R² + 2Rw`, so that along a line `w` is a
//! parabola of the distance from the tangent point. A density that is quadratic in `w` within a layer therefore has a
//! mean over any piece of a line that needs no quadrature, and columns add up, reverse and grow exactly as they should.

use crate::format::DensityView;
use crate::geometry::Planet;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::LANES;

/// Vectors of constituents.
pub(crate) const QUADS: usize = 4;

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
        let mean = a + b * self.mean + c * self.square;
        // Rounding must not make a density negative.
        if mean > 0.0 { mean } else { 0.0 }
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

/// A layer as a graphics processor is told of it.
pub(super) struct LayerRow<'a> {
    /// `w` at the bottom and the top, m.
    pub edges: [f64; 2],
    pub rate: f64,
    pub bend: f64,
    pub polynomial: &'a [Amounts; 3],
}

/// Piecewise quadratic densities of all constituents.
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    planet: Planet,
    diameter: f64,
    per_diameter: f64,
    /// Edges in `w`, m: −∞, that of the ground, …
    edges: Vec<f64>,
    /// The first lies below the ground.
    layers: Vec<Layer>,
    /// The layer at the bottom of each of [`BINS`] bins of `w`, so that none is searched for.
    bins: Vec<u16>,
    bins_per_metre: f64,
    pub quads: usize,
}

/// A few hundred metres each.
const BINS: usize = 256;

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
        let (bottom, top) = (edges[1], edges[layers.len()]);
        let bin = |i: usize| {
            let w = bottom + (top - bottom) * (i as f64 / BINS as f64);
            edges[1..layers.len()].partition_point(|&edge| edge <= w) as u16
        };
        Self {
            planet,
            diameter: 2.0 * planet.radius,
            per_diameter: 0.5 / planet.radius,
            bins: (0..BINS).map(bin).collect(),
            bins_per_metre: BINS as f64 / (top - bottom),
            edges,
            layers,
            quads: constituents.div_ceil(LANES),
        }
    }

    /// From below the ground upwards.
    pub(super) fn rows(&self) -> impl Iterator<Item = LayerRow<'_>> {
        let layers = self.layers.iter().enumerate();
        layers.map(|(i, layer)| LayerRow {
            edges: [self.edges[i], self.edges[i + 1]],
            rate: layer.rate,
            bend: layer.bend,
            polynomial: &layer.polynomial,
        })
    }

    pub fn planet(&self) -> Planet {
        self.planet
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of_val(self.edges.as_slice())
            + size_of_val(self.layers.as_slice())
            + size_of_val(self.bins.as_slice())
    }

    /// Columns on `line` between the distances `from < to` from its tangent point (negative before it), m.
    #[inline(always)]
    pub fn columns(&self, line: Line, from: f64, to: f64) -> Amounts {
        let mut amounts = Amounts::default();
        self.enter(line, from).columns(to, &mut amounts);
        amounts
    }

    /// Columns from an altitude (m) to space in a direction with this sine of its elevation, m; the ground is no
    /// obstacle.
    pub fn to_space(&self, altitude: f64, sine: f64) -> Amounts {
        let from = (self.planet.radius + altitude) * sine;
        let line = Line {
            lowest: self.planet.squared_altitude(altitude) - from * from / self.diameter,
        };
        let to = self.reach(line, self.layers.len()).max(0.0).sqrt();
        self.columns(line, from, to.max(from))
    }

    /// Starts on `line` at the distance `from` from its tangent point (negative before it).
    #[inline(always)]
    pub fn enter(&self, line: Line, from: f64) -> Walker<'_> {
        let top = self.reach(line, self.layers.len());
        let s = match from < 0.0 && from * from > top {
            true => entry(top),
            false => from,
        };
        Walker {
            layers: self,
            line,
            s,
            layer: self.find(line.lowest + s * s * self.per_diameter),
        }
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

    /// Square of the distance from the tangent point at which the line is at an edge.
    #[inline(always)]
    fn reach(&self, line: Line, edge: usize) -> f64 {
        (self.edges[edge] - line.lowest) * self.diameter
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
        if w < self.edges[1] {
            return 0;
        }
        let bin = ((w - self.edges[1]) * self.bins_per_metre) as usize;
        let mut i = usize::from(self.bins[bin.min(BINS - 1)]);
        while i + 1 < self.layers.len() && self.edges[i + 1] <= w {
            i += 1;
        }
        i
    }
}

/// Where a line from beyond the air comes into it, by the square of that distance.
#[cold]
fn entry(top: f64) -> f64 {
    -top.max(0.0).sqrt()
}

/// One instruction where neither is NaN.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Somewhere on a line, on the way through the layers.
pub(crate) struct Walker<'a> {
    layers: &'a Layers,
    line: Line,
    /// Distance from the tangent point, m.
    s: f64,
    layer: usize,
}

impl Walker<'_> {
    /// From the tangent point, m.
    #[inline(always)]
    pub fn distance(&self) -> f64 {
        self.s
    }

    /// Goes on to the distance `to` from the tangent point and visits what is crossed of each layer.
    #[inline(always)]
    pub fn go(&mut self, to: f64, mut visit: impl FnMut(Piece)) {
        let (layers, line) = (self.layers, self.line);
        // Inwards through lower edges; that of the lowest layer lies at −∞, where no line comes.
        while self.s < 0.0 {
            let below = layers.reach(line, self.layer);
            let edge = -larger(below, 0.0).sqrt();
            if edge >= to || below <= 0.0 {
                break;
            }
            // Beyond an edge only by rounding: nothing is crossed.
            let stop = larger(edge, self.s);
            visit(layers.piece(line, self.layer, self.s, stop));
            (self.s, self.layer) = (stop, self.layer - 1);
        }
        // Over the tangent point and outwards through upper ones.
        while self.s < to && self.layer < layers.layers.len() {
            let edge = larger(layers.reach(line, self.layer + 1), 0.0).sqrt();
            let stop = larger(edge, self.s);
            let stop = if stop < to { stop } else { to };
            visit(layers.piece(line, self.layer, self.s, stop));
            self.s = stop;
            if edge > to {
                break;
            }
            self.layer += 1;
        }
    }

    /// Goes on to the distance `to` and hands the columns on the way, m.
    #[inline(always)]
    pub fn columns(&mut self, to: f64, out: &mut Amounts) {
        match self.layers.quads {
            // The usual case: the sums stay in a register.
            1 => self.sums::<1>(to, out),
            _ => self.sums::<QUADS>(to, out),
        }
    }

    #[inline(always)]
    fn sums<const N: usize>(&mut self, to: f64, out: &mut Amounts) {
        let layers = self.layers;
        let mut sums = [Lanes::splat(0.0); N];
        self.go(
            to,
            #[inline(always)]
            |piece| {
                let [a, b, c] = &layers.layers[piece.layer].polynomial;
                let length = piece.length();
                for (q, sum) in sums.iter_mut().enumerate() {
                    let [a, b, c] = [a, b, c].map(|amounts| Lanes(amounts.0[q]));
                    let mean = a + b * piece.mean + c * piece.square;
                    // Rounding must not make a density negative.
                    *sum = *sum + mean.max(Lanes::splat(0.0)) * length;
                }
            },
        );
        for (out, sum) in out.0.iter_mut().zip(sums) {
            *out = sum.0;
        }
    }
}
