//! Points on a ray, eight at a time: how high they are, how the sun stands there, and where that is in the tables.

#![allow(clippy::needless_range_loop)] // Chains of iterators over several arrays do not always vectorise.

use super::path::Stops;
use crate::format::EstimateView;
use crate::geometry::{Planet, SOLAR_ANGULAR_RADIUS};
use crate::kernel::lanes::Lanes;
use crate::kernel::math::log2;
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;
use crate::visible_disc::visible_rise;

/// Points that are computed together.
pub(super) const BATCH: usize = 8;
/// Angular radius of the sun, rad.
pub(super) const SUN: f32 = SOLAR_ANGULAR_RADIUS as f32;

pub(super) type Numbers = Lanes<BATCH>;

/// Stops of a ray, and what the tables are asked there.
pub(super) struct Points {
    /// m.
    pub altitude: Numbers,
    /// How high the sun stands above the geometric horizon, in radii of its disc.
    pub rise: Numbers,
    /// The same of what is seen of it.
    pub seen: Numbers,
    /// Dip of the horizon, rad.
    pub dip: Numbers,
    /// Coordinates on the axes of density, of density halfway from the stop before, and of suns.
    pub density: Numbers,
    pub halfway: Numbers,
    pub sun: Numbers,
}

/// What turns places into coordinates.
pub(super) struct Axes {
    planet: Planet,
    /// Half the inverse of the radius, 1/m.
    bend: f64,
    radius: f32,
    per_top: f32,
    last_density: f32,
    per_sun_width: f32,
    /// Coordinates per arsinh, and the lowest arsinh.
    suns: [f32; 2],
}

impl Axes {
    #[inline(always)]
    pub fn new(planet: &Planet, tables: &EstimateView) -> Self {
        let per_sun_width = 1.0 / tables.sun_width;
        let ends = [tables.sun_lowest, 1.0].map(|sine| arsinh(sine * per_sun_width));
        Self {
            planet: *planet,
            bend: 0.5 / planet.radius,
            radius: planet.radius as f32,
            per_top: 1.0 / planet.top as f32,
            last_density: (tables.densities - 1) as f32,
            per_sun_width,
            suns: [(tables.suns - 1) as f32 / (ends[1] - ends[0]), ends[0]],
        }
    }

    /// Of the stops from `first` on; beyond the last there is anything.
    #[inline(always)]
    pub fn points(&self, stops: &Stops, first: usize) -> Points {
        let [mut altitude, mut halfway, mut sine] = [Numbers::splat(0.0); 3];
        let [place, along] = stops.sunwards;
        let (mut distance, mut middle) = ([0.0; BATCH], [0.0; BATCH]);
        distance.copy_from_slice(&stops.distance[first..first + BATCH]);
        let mut before = stops.distance[first.max(1) - 1];
        for i in 0..BATCH {
            middle[i] = 0.5 * (before + distance[i]);
            before = distance[i];
        }
        for i in 0..BATCH {
            let height = self.altitude(stops, distance[i]);
            altitude.0[i] = height as f32;
            sine.0[i] = ((place + distance[i] * along) / (self.planet.radius + height)) as f32;
        }
        for i in 0..BATCH {
            halfway.0[i] = self.altitude(stops, middle[i]) as f32;
        }
        let [low, high] = [-1.0, 1.0].map(Numbers::splat);
        let sine = sine.max(low).min(high);
        let dip = self.dip(altitude);
        let rise = (sine.asin() + dip) * (1.0 / SUN);
        let [scale, lowest] = self.suns;
        let sun = (sine * self.per_sun_width).map(arsinh);
        Points {
            altitude,
            rise,
            seen: visible_rise(rise).max(Numbers::splat(0.0)),
            dip,
            density: (altitude * self.per_top).sqrt() * self.last_density,
            halfway: (halfway * self.per_top).sqrt() * self.last_density,
            sun: (sun - Numbers::splat(lowest)) * scale,
        }
    }

    /// Dip of the horizon, rad.
    #[inline(always)]
    pub fn dip(&self, altitude: Numbers) -> Numbers {
        let radius = Numbers::splat(self.radius);
        let sine = (altitude * (radius * 2.0 + altitude)).sqrt() / (radius + altitude);
        sine.asin()
    }

    /// Altitude at a distance from the observer, m.
    #[inline(always)]
    fn altitude(&self, stops: &Stops, distance: f64) -> f64 {
        let from_nearest = stops.start + distance;
        let w = stops.lowest + from_nearest * from_nearest * self.bend;
        let root = (1.0 + 4.0 * self.bend * w).max(1e-12).sqrt();
        (2.0 * w / (1.0 + root)).max(0.0)
    }
}

/// Inverse of the hyperbolic sine.
#[inline(always)]
fn arsinh(x: f32) -> f32 {
    let size = x.abs();
    let root = crate::kernel::math::sqrt(size * size + 1.0);
    (log2(size + root) * core::f32::consts::LN_2).copysign(x)
}
