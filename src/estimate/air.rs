//! What is at the stops of a ray and between them: columns of air towards the observer and towards the sun, the visible
//! share of the sun's disc, and where to look up diffuse light.

use super::WIDTH;
use super::path::{MOST_STOPS, Stops};
use crate::format::{EstimateView, MAX_ESTIMATE_CONSTITUENTS as MOST_CONSTITUENTS};
use crate::geometry::Planet;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::{asin, bound, log2, sqrt};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;
use crate::visible_disc::{mean_share, visible_height};

/// Angular radius of the sun, rad.
const SUN: f32 = crate::geometry::SOLAR_ANGULAR_RADIUS as f32;
/// Over which the density of the air falls by e, m: what counts more within a panel where the sun rises.
const FALL: f32 = 8000.0;

/// One number per constituent.
type Row = Lanes<MOST_CONSTITUENTS>;

/// Numbers at the stops.
pub(super) struct Air {
    pub count: usize,
    /// Columns to the observer, m.
    pub to_observer: [Row; MOST_STOPS],
    /// Columns to the sun, m.
    pub to_sun: [Row; MOST_STOPS],
    /// First of four rows of diffuse light.
    pub light: [[usize; 4]; MOST_STOPS],
    /// Their weights.
    pub weight: [[f32; 4]; MOST_STOPS],
    /// Mean visible share of the sun's disc between this stop and the next.
    pub share: [f32; MOST_STOPS],
}

/// Where a point stands in the tables.
#[derive(Clone, Copy, Default)]
struct Point {
    altitude: f32,
    /// Elevation of the sun above the horizontal (sine) and above the geometric horizon (in radii of its disc).
    sine: f32,
    rise: f32,
    /// Dip of the horizon, rad.
    dip: f32,
}

impl Air {
    #[inline(always)]
    pub fn new(planet: &Planet, tables: &EstimateView, stops: &Stops) -> Self {
        let zero = Lanes::splat(0.0);
        let mut out = Self {
            count: stops.count,
            to_observer: [zero; MOST_STOPS],
            to_sun: [zero; MOST_STOPS],
            light: [[0; 4]; MOST_STOPS],
            weight: [[0.0; 4]; MOST_STOPS],
            share: [0.0; MOST_STOPS],
        };
        let tables = Lookup::new(planet, tables);
        let mut before = Point::default();
        let mut density = zero;
        let mut level = 0;
        for i in 0..stops.count {
            let point = Point::new(planet, stops, stops.distance[i]);
            level = tables.level(point.altitude, level);
            let here = tables.density(point.altitude);
            if i > 0 {
                let step = stops.distance[i] - stops.distance[i - 1];
                let middle = altitude(planet, stops, stops.distance[i - 1] + 0.5 * step);
                let sum = density + tables.density(middle) * 4.0 + here;
                out.to_observer[i] = out.to_observer[i - 1] + sum * (step as f32 * (1.0 / 6.0));
                let fall = (point.altitude - before.altitude) * (1.0 / FALL);
                out.share[i - 1] = mean_share(before.rise, point.rise, fall);
            }
            out.to_sun[i] = tables.to_sun(&point, level);
            (out.light[i], out.weight[i]) = tables.light(&point, level);
            (before, density) = (point, here);
        }
        out
    }
}

/// Altitude at a distance from the observer, m.
#[inline(always)]
fn altitude(planet: &Planet, stops: &Stops, distance: f64) -> f32 {
    let from_nearest = stops.start + distance;
    let w = stops.lowest + from_nearest * from_nearest / (2.0 * planet.radius);
    let root = (1.0 + 2.0 * w / planet.radius).max(1e-12).sqrt();
    (2.0 * w / (1.0 + root)).max(0.0) as f32
}

impl Point {
    #[inline(always)]
    fn new(planet: &Planet, stops: &Stops, distance: f64) -> Self {
        let altitude = altitude(planet, stops, distance);
        let [place, along] = stops.sunwards;
        let radius = planet.radius + f64::from(altitude);
        let sine = ((place + distance * along) / radius).clamp(-1.0, 1.0) as f32;
        let dip = dip(planet, altitude);
        let angle = asin(sine) + dip;
        Self {
            altitude,
            sine,

            rise: angle * (1.0 / SUN),
            dip,
        }
    }
}

/// Dip of the horizon, rad.
#[inline(always)]
fn dip(planet: &Planet, altitude: f32) -> f32 {
    let radius = planet.radius as f32;
    asin(sqrt(altitude * (2.0 * radius + altitude)) / (radius + altitude))
}

/// Tables with what their axes need.
struct Lookup<'a> {
    tables: &'a EstimateView<'a>,
    top: f32,
    /// Coordinates per arsinh, and of the lowest sun.
    suns: [f32; 2],
}

impl<'a> Lookup<'a> {
    #[inline(always)]
    fn new(planet: &Planet, tables: &'a EstimateView<'a>) -> Self {
        let [low, high] = [tables.sun_lowest, 1.0].map(|sine| arsinh(sine / tables.sun_width));
        Self {
            tables,
            top: planet.top as f32,
            suns: [(tables.suns - 1) as f32 / (high - low), low],
        }
    }

    /// The level below an altitude, looked for from another one.
    #[inline(always)]
    fn level(&self, altitude: f32, near: usize) -> usize {
        let level = |l: usize| self.tables.level[l].get();
        let mut l = near;
        while l > 0 && level(l) > altitude {
            l -= 1;
        }
        while l + 2 < self.tables.level.len() && level(l + 1) <= altitude {
            l += 1;
        }
        l
    }

    /// Profiles of the constituents.
    #[inline(always)]
    fn density(&self, altitude: f32) -> Row {
        let last = self.tables.densities - 1;
        let (i, t) = place(sqrt(altitude / self.top) * last as f32, last);
        let row = |i: usize| load(self.tables.density, i * MOST_CONSTITUENTS);
        mix(row(i), row(i + 1), t)
    }

    /// Columns to the visible part of the sun; to the horizon where it is hidden.
    #[inline(always)]
    fn to_sun(&self, point: &Point, level: usize) -> Row {
        let last = self.tables.angles - 1;
        let angle = visible_height(point.rise) * SUN;
        let range = core::f32::consts::FRAC_PI_2 + point.dip;
        let share = bound(angle / range, 0.0, 1.0);
        let (i, t) = place(sqrt(share) * last as f32, last);
        let row = |l: usize, i: usize| {
            let row = (l * self.tables.angles + i) * MOST_CONSTITUENTS;
            load(self.tables.column, row)
        };
        let at = |l: usize| mix(row(l, i), row(l, i + 1), t);
        mix(at(level), at(level + 1), self.between(point, level)).exp()
    }

    /// Rows of diffuse light and their weights.
    #[inline(always)]
    fn light(&self, point: &Point, level: usize) -> ([usize; 4], [f32; 4]) {
        let [scale, low] = self.suns;
        let last = self.tables.suns - 1;
        let (i, t) = place(
            (arsinh(point.sine / self.tables.sun_width) - low) * scale,
            last,
        );
        let u = self.between(point, level);
        let row = |l: usize, i: usize| (l * self.tables.suns + i) * self.tables.light_stride;
        (
            [
                row(level, i),
                row(level, i + 1),
                row(level + 1, i),
                row(level + 1, i + 1),
            ],
            [(1.0 - u) * (1.0 - t), (1.0 - u) * t, u * (1.0 - t), u * t],
        )
    }

    /// Where an altitude stands between a level and the next.
    #[inline(always)]
    fn between(&self, point: &Point, level: usize) -> f32 {
        let [low, high] = [level, level + 1].map(|l| self.tables.level[l].get());
        bound((point.altitude - low) / (high - low), 0.0, 1.0)
    }
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
pub(super) fn load(values: &[zerocopy::little_endian::F32], first: usize) -> Lanes<WIDTH> {
    let row = &values[first..][..WIDTH];
    Lanes(core::array::from_fn(|i| row[i].get()))
}

/// Inverse of the hyperbolic sine.
#[inline(always)]
fn arsinh(x: f32) -> f32 {
    let size = x.abs();
    (log2(size + sqrt(size * size + 1.0)) * core::f32::consts::LN_2).copysign(x)
}
