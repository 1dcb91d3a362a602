//! Sums over the panels between stops, block by block of wavelengths.
//!
//! No closures in the loops: they would be compiled without the instructions of the kernel.
#![allow(clippy::needless_range_loop)]

use zerocopy::little_endian::F32;

use core::f32::consts::{LN_2, LOG2_E};

use super::blocks::{Block, Blocks, MOST_BLOCKS, NOTHING, WIDTH};
use super::path::{MOST_STOPS, Stops};
use super::points::{Axes, BATCH, Numbers, Points, SUN};
use super::sightline::Sightline;
use crate::format::{EstimateView, MAX_ESTIMATES, MAX_LEVELS};
use crate::geometry::Planet;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::bound;
use crate::kernel::simd::Instructions;
use crate::visible_disc::mean_share;

/// Of the diffuse estimate so much is added to those of sunlight, which can be nothing where it is not quite dark.
const REST: f32 = 1e-3;
/// Isotropic share of a phase function, per steradian.
const PER_SPHERE: f32 = 0.25 * core::f32::consts::FRAC_1_PI;
/// Over which the density of the air falls by e, m: what counts more within a panel where the sun rises.
const FALL: f32 = 8000.0;

/// Most levels.
const MOST_LEVELS: usize = MAX_LEVELS.next_multiple_of(BATCH);
/// Angles from the horizon are dense below this, rad.
const BEND: f32 = 0.1;

/// One number per constituent.
type Row = Lanes<WIDTH>;
type Spectrum = Lanes<WIDTH>;

/// Light that reaches the observer from a stop: its optical depth, in halvings, and what is left.
#[derive(Clone, Copy)]
struct Ray {
    depth: Spectrum,
    through: Spectrum,
}

impl Ray {
    const START: Self = Self {
        depth: Lanes([0.0; WIDTH]),
        through: Lanes([1.0; WIDTH]),
    };

    #[inline(always)]
    fn new(depth: Spectrum) -> Self {
        let through = (-depth).exp2();
        Self { depth, through }
    }

    /// Mean between two stops, between which the depth is linear.
    #[inline(always)]
    fn mean(self, next: Self) -> Spectrum {
        /// Differences of thinner panels lose their digits.
        const THIN: f32 = 0.1;
        let step = (next.depth - self.depth) * LN_2;
        let size = step.abs();
        let mean = (self.through - next.through).abs() / size.max(Lanes::splat(THIN));
        let series = step.map(|x| 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
        size.at_least(THIN, mean, self.through * series)
    }
}

/// What is at a stop.
struct Stop {
    /// Columns of air to the observer, m, and those since the stop before.
    to_observer: Row,
    panel: Row,
    /// Columns to the sun, m.
    to_sun: Row,
    /// Four rows of diffuse light, and their weights.
    light: [usize; 4],
    weight: [f32; 4],
    /// Mean visible share of the sun's disc since the stop before.
    share: f32,
}

/// Walks along the stops of a ray.
struct Walk<'a> {
    tables: &'a EstimateView<'a>,
    /// Dip of the horizon at the levels, rad.
    dips: [f32; MOST_LEVELS],
    columns: Row,
    density: Row,
    level: usize,
    distance: f64,
    altitude: f32,
    rise: f32,
}

/// A block of wavelengths on the way along a ray.
#[derive(Clone, Copy)]
struct Band {
    /// Extinction of the constituents where their profile is 1, halvings per metre.
    extinction: [Spectrum; WIDTH],
    /// Light from the last stop: of the sun, and diffuse.
    rays: [Ray; 2],
    /// Columns of the constituents in such light, m.
    lit: [[Spectrum; WIDTH]; 2],
}

impl Band {
    const NONE: Self = Self {
        extinction: [Lanes([0.0; WIDTH]); WIDTH],
        rays: [Ray::START; 2],
        lit: [[Lanes([0.0; WIDTH]); WIDTH]; 2],
    };

    /// Goes on to a stop through the panel before it.
    #[inline(always)]
    fn step<I: Instructions>(
        &mut self,
        instructions: I,
        stop: &Stop,
        light: Spectrum,
        scattering: usize,
    ) {
        let (mut view, mut sun) = (Lanes::splat(0.0), Lanes::splat(0.0));
        for k in 0..WIDTH {
            view = instructions.add_product(view, self.extinction[k], stop.to_observer.0[k]);
            sun = instructions.add_product(sun, self.extinction[k], stop.to_sun.0[k]);
        }
        let next = [Ray::new(view + sun), Ray::new(view - light)];
        let once = self.rays[0].mean(next[0]) * stop.share;
        let again = self.rays[1].mean(next[1]);
        for k in 0..scattering {
            let column = stop.panel.0[k];
            self.lit[0][k] = instructions.add_product(self.lit[0][k], once, column);
            self.lit[1][k] = instructions.add_product(self.lit[1][k], again, column);
        }
        self.rays = next;
    }

    /// What is scattered of it all.
    #[inline(always)]
    fn estimates(&self, tables: &EstimateView, block: usize) -> Block {
        let mut out = [Lanes::splat(0.0); MAX_ESTIMATES];
        let last = tables.scatters.len() - 1;
        for q in 0..(last + 1).min(MAX_ESTIMATES) {
            let scatters = tables.scatters[q].get();
            let lit = &self.lit[usize::from(q == last)];
            for k in 0..tables.constituents.min(WIDTH) {
                if scatters >> k & 1 == 1 {
                    let row = (q * tables.constituents + k) * tables.light_stride;
                    let albedo = load(tables.albedo, row + block * WIDTH);
                    out[q] = out[q] + self.extinction[k] * albedo * lit[k];
                }
            }
        }
        out[last] = out[last] * LN_2;
        let rest = out[last] * REST;
        for q in 0..last.min(MAX_ESTIMATES) {
            out[q] = out[q] * (LN_2 * PER_SPHERE) + rest;
        }
        out
    }
}

/// All that estimates depend on.
#[derive(Clone, Copy)]
pub(crate) struct Estimator<'a> {
    pub planet: Planet,
    pub tables: EstimateView<'a>,
    /// Extinction where the profile is 1, m⁻¹, `[constituent][block]`.
    pub extinction: &'a [[f32; WIDTH]],
}

impl Estimator<'_> {
    /// The estimates along a ray; fused where `instructions` are.
    #[inline(always)]
    pub fn along<I: Instructions>(&self, instructions: I, line: &Sightline) -> Blocks {
        let stops = Stops::new(&self.planet, &self.tables, line);
        let mut out = NOTHING;
        // Arrays as large as they must be: to clear more would take as long as a stop.
        match self.tables.light_stride / WIDTH {
            1 => along::<1, I>(instructions, self, &stops, &mut out),
            2 => along::<2, I>(instructions, self, &stops, &mut out),
            3 => along::<3, I>(instructions, self, &stops, &mut out),
            _ => along::<MOST_BLOCKS, I>(instructions, self, &stops, &mut out),
        }
        out
    }
}

#[inline(always)]
fn along<const N: usize, I: Instructions>(
    instructions: I,
    of: &Estimator,
    stops: &Stops,
    out: &mut Blocks,
) {
    let tables = &of.tables;
    let axes = Axes::new(&of.planet, tables);
    let blocks = (tables.light_stride / WIDTH).min(N);
    let mut bands = [Band::NONE; N];
    let bands = &mut bands[..blocks];
    for (block, band) in bands.iter_mut().enumerate() {
        for k in 0..tables.constituents.min(WIDTH) {
            band.extinction[k] = Lanes(of.extinction[k * blocks + block]) * LOG2_E;
        }
    }
    let scattering = (32 - tables.any_scatters().leading_zeros() as usize).min(WIDTH);
    let mut walk = Walk {
        tables,
        dips: dips(&axes, tables),
        columns: Lanes::splat(0.0),
        density: Lanes::splat(0.0),
        level: 0,
        distance: 0.0,
        altitude: 0.0,
        rise: 0.0,
    };
    let mut i = 0;
    while i < stops.count.min(MOST_STOPS) {
        let points = axes.points(stops, i);
        let mut k = 0;
        while k < BATCH && i < stops.count {
            let stop = walk.step(&points, k, stops.distance[i]);
            for (block, band) in bands.iter_mut().enumerate() {
                let mut light = Lanes::splat(0.0);
                for t in 0..4 {
                    let row = load(tables.light, stop.light[t] + block * WIDTH);
                    light = instructions.add_product(light, row, stop.weight[t]);
                }
                band.step(instructions, &stop, light * LOG2_E, scattering);
            }
            k += 1;
            i += 1;
        }
    }
    for (block, band) in bands.iter().enumerate() {
        out[block] = band.estimates(tables, block);
    }
}

#[inline(always)]
fn dips(axes: &Axes, tables: &EstimateView) -> [f32; MOST_LEVELS] {
    let mut out = [0.0; MOST_LEVELS];
    let (batches, _) = out.as_chunks_mut::<BATCH>();
    let levels = tables.level.chunks(BATCH);
    for (batch, levels) in batches.iter_mut().zip(levels) {
        let mut altitude = Numbers::splat(0.0);
        for i in 0..levels.len() {
            altitude.0[i] = levels[i].get();
        }
        *batch = axes.dip(altitude).0;
    }
    out
}

impl Walk<'_> {
    /// Goes on to stop `i` of a batch, at a distance from the observer.
    #[inline(always)]
    fn step(&mut self, points: &Points, i: usize, distance: f64) -> Stop {
        let tables = self.tables;
        let altitude = points.altitude.0[i];
        self.find_level(altitude);
        let here = density(tables, points.density.0[i]);
        let halfway = density(tables, points.halfway.0[i]);
        let step = (distance - self.distance) as f32;
        let panel = (self.density + halfway * 4.0 + here) * (step * (1.0 / 6.0));
        self.columns = self.columns + panel;
        let fall = (altitude - self.altitude) * (1.0 / FALL);
        let rise = points.rise.0[i];
        let share = match (self.rise.min(rise) >= 1.0, self.rise.max(rise) <= -1.0) {
            (true, _) => 1.0,
            (_, true) => 0.0,
            _ => mean_share(self.rise, rise, fall),
        };
        (self.density, self.distance, self.altitude) = (here, distance, altitude);
        self.rise = rise;
        let up = self.between(altitude);
        let (light, weight) = self.light(points.sun.0[i], up);
        Stop {
            to_observer: self.columns,
            panel,
            to_sun: self.to_sun(points.seen.0[i], points.dip.0[i], up),
            light,
            weight,
            share,
        }
    }

    /// The level below an altitude.
    #[inline(always)]
    fn find_level(&mut self, altitude: f32) {
        let levels = self.tables.level;
        while self.level > 0 && levels[self.level].get() > altitude {
            self.level -= 1;
        }
        while self.level + 2 < levels.len() && levels[self.level + 1].get() <= altitude {
            self.level += 1;
        }
    }

    /// Where an altitude stands between its level and the next.
    #[inline(always)]
    fn between(&self, altitude: f32) -> f32 {
        let levels = self.tables.level;
        let (low, high) = (levels[self.level].get(), levels[self.level + 1].get());
        bound((altitude - low) / (high - low), 0.0, 1.0)
    }

    /// Columns to what is seen of the sun, at a height in radii of its disc above a horizon with a dip.
    #[inline(always)]
    fn to_sun(&self, seen: f32, dip: f32, up: f32) -> Row {
        let low = self.column(self.level, seen, dip);
        mix(low, self.column(self.level + 1, seen, dip), up).exp()
    }

    /// The logarithms at a level: at the same elevation, but on the horizon where the sun is there.
    #[inline(always)]
    fn column(&self, level: usize, seen: f32, dip: f32) -> Row {
        let tables = self.tables;
        let own = self.dips[level];
        let angle = seen * SUN + (own - dip) * (seen / (seen + 1.0));
        let angle = if angle > 0.0 { angle } else { 0.0 };
        let range = core::f32::consts::FRAC_PI_2 + own;
        let share = angle * (range + BEND) / (range * (angle + BEND));
        let (i, t) = place(share * (tables.angles - 1) as f32, tables.angles - 1);
        let row = (level * tables.angles + i) * WIDTH;
        let low = load(tables.column, row);
        mix(low, load(tables.column, row + WIDTH), t)
    }

    /// Rows of diffuse light and their weights.
    #[inline(always)]
    fn light(&self, coordinate: f32, up: f32) -> ([usize; 4], [f32; 4]) {
        let (suns, stride) = (self.tables.suns, self.tables.light_stride);
        let (i, t) = place(coordinate, suns - 1);
        let low = (self.level * suns + i) * stride;
        let high = low + suns * stride;
        (
            [low, low + stride, high, high + stride],
            [
                (1.0 - up) * (1.0 - t),
                (1.0 - up) * t,
                up * (1.0 - t),
                up * t,
            ],
        )
    }
}

/// Profiles of the constituents.
#[inline(always)]
fn density(tables: &EstimateView, coordinate: f32) -> Row {
    let (i, t) = place(coordinate, tables.densities - 1);
    let low = load(tables.density, i * WIDTH);
    mix(low, load(tables.density, (i + 1) * WIDTH), t)
}

/// Index and rest of a coordinate of 0..=last.
#[inline(always)]
fn place(coordinate: f32, last: usize) -> (usize, f32) {
    let u = bound(coordinate, 0.0, last as f32);
    let i = (u as usize).min(last - 1);
    (i, u - i as f32)
}

#[inline(always)]
fn mix(a: Row, b: Row, t: f32) -> Row {
    a + (b - a) * t
}

#[inline(always)]
fn load(values: &[F32], first: usize) -> Row {
    let row = &values[first..first + WIDTH];
    let mut lanes = [0.0; WIDTH];
    for i in 0..WIDTH {
        lanes[i] = row[i].get();
    }
    Lanes(lanes)
}
