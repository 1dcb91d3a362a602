//! How polarised a baked sky is: bicubic B-splines of Q/I and U/(I sin φ) in the vertical frame, on the grid of the radiance.
//!
//! Both are smooth wherever the radiance is: at the neutral points, in the aureole and, as the azimuth is an axis of its
//! own, at the poles. U over the sine of the azimuth is even in it, as Q is.

use super::frame::{Frame, prepared};
use super::lattice::{Lattice, Nodes};
use super::quality::{Errors, LARGEST, directions};
use super::table::{Grid, Spots, Table};
use super::turn::{Axes, Turn};
use crate::error::Result;
use crate::geometry::{Ray, Side};
use crate::lanes::Lanes;
use crate::polarisation::{Frame as Against, PolarisedSky, Stokes};
use crate::simd::{Instructions, Kernel, dispatch};

/// Wavelengths that are computed together: those of the usual model.
pub(super) const LANES: usize = 12;
/// Q of them, then U.
pub(super) const PAIR: usize = 2 * LANES;

/// The tables.
#[derive(Clone, Debug)]
pub(super) struct Degrees {
    grid: Grid,
    /// Blocks of `LANES`.
    pub blocks: usize,
    /// `[block][up rows, then down rows][azimuth]`.
    cells: Vec<Lanes<PAIR>>,
}

/// Most bytes that they take, for `n` wavelengths.
pub(super) fn largest_table(n: usize) -> usize {
    n.div_ceil(LANES) * LARGEST.cells() * size_of::<Lanes<PAIR>>()
}

/// Makes them.
struct Bake<'a> {
    sky: &'a PolarisedSky,
    lattice: Lattice<'a>,
}

impl Kernel for Bake<'_> {
    type Output = Degrees;

    #[inline(always)]
    fn run<I: Instructions>(self, _: I) -> Degrees {
        let grid = self.lattice.grid;
        let mut cells = Vec::new();
        let [up, down] = [Side::Up, Side::Down].map(|side| self.nodes(side));
        for (up, down) in up.iter().zip(&down) {
            self.lattice.interpolate(up, &mut cells);
            self.lattice.interpolate(down, &mut cells);
        }
        Degrees {
            grid,
            blocks: up.len(),
            cells,
        }
    }
}

impl Bake<'_> {
    /// Values at the nodes, per block.
    #[inline(always)]
    fn nodes(&self, side: Side) -> Vec<Nodes<PAIR>> {
        let blocks = self.lattice.sky.wavelengths().len().div_ceil(LANES);
        let mut nodes: Vec<Nodes<PAIR>> = vec![Vec::new(); blocks];
        for ray in self.lattice.rays(side) {
            nodes.iter_mut().for_each(|rows| rows.push(Vec::new()));
            for phi in self.lattice.azimuths() {
                for (block, value) in self.at(&ray, phi, blocks).into_iter().enumerate() {
                    nodes[block].last_mut().expect("a row").push(value);
                }
            }
        }
        nodes
    }

    fn at(&self, ray: &Ray, phi: f64, blocks: usize) -> Vec<Lanes<PAIR>> {
        let mut out = vec![Lanes::splat(0.0); blocks];
        let angle = self.lattice.angle(ray, phi);
        self.sky.ratios(ray, phi, angle, |narrow, parts| {
            let first = narrow * parts[0].len();
            let pair = &mut out[first / LANES].0;
            for (part, values) in parts.iter().enumerate() {
                pair[part * LANES + first % LANES..][..values.len()].copy_from_slice(values);
            }
        });
        out
    }
}

impl Degrees {
    pub fn new(sky: &PolarisedSky, grid: Grid) -> Self {
        let lattice = Lattice {
            sky: sky.sky(),
            grid,
        };
        dispatch(Bake { sky, lattice })
    }

    /// Q/I and U/(I sin φ) of a block in the vertical frame for direction `i`.
    #[inline(always)]
    pub fn at<const W: usize>(&self, spots: &Spots<W>, i: usize, block: usize) -> Lanes<PAIR> {
        spots.surface(Lanes::splat(0.0), &self.grid, &self.cells, i, block)
    }

    /// Distances of (Q/I, U/I) from those of the sky that this was made from, at directions between the nodes.
    pub fn errors<const N: usize>(
        &self,
        sky: &PolarisedSky,
        table: &Table<N>,
        frame: &Frame,
    ) -> Result<Errors> {
        let wavelengths = sky.sky().wavelengths().len();
        let mut truth = vec![Stokes::default(); wavelengths];
        let mut errors = Errors::default();
        for (direction, part) in directions(sky.sky()) {
            sky.relative_stokes(direction, Against::Vertical, &mut truth)?;
            let vector = direction.map(|v| Lanes([v]));
            let Some(vector) = prepared(vector) else {
                continue;
            };
            let spots = table.spots(frame.locate(vector));
            let turn = Axes::Vertical.turn(frame, &vector);
            for (block, truth) in truth.chunks(LANES).enumerate() {
                let [q, u] = turned(&self.at(&spots, 0, block), &turn, 0);
                errors.add(truth.iter().zip(q.0.iter().zip(&u.0)).map(distance), part);
            }
        }
        Ok(errors.sorted())
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice())
    }
}

/// Where there is no light, its polarisation is of no account.
fn distance((truth, (&q, &u)): (&Stokes, (&f32, &f32))) -> f64 {
    if truth.i > 0.0 {
        f64::from((q - truth.q / truth.i).hypot(u - truth.u / truth.i))
    } else {
        0.0
    }
}

/// Q/I and U/I of a block in the frame of the caller, for direction `i`. Where a spline overshoots, the light can be more than
/// wholly polarised.
#[inline(always)]
pub(super) fn turned<const W: usize>(
    values: &Lanes<PAIR>,
    turn: &Turn<W>,
    i: usize,
) -> [Lanes<LANES>; 2] {
    let ([c, s], sine) = (turn.double.map(|d| d.0[i]), turn.sine.0[i]);
    let (mut q, mut u) = (Lanes::splat(0.0), Lanes::splat(0.0));
    q.0.copy_from_slice(&values.0[..LANES]);
    u.0.copy_from_slice(&values.0[LANES..]);
    [q * c + u * (s * sine), u * (c * sine) - q * s]
}
