//! The reference tracer: unbiased, spectral, polarised Monte Carlo in a spherical atmosphere.
//!
//! Light that is scattered once comes from quadrature (`single`); all else from random walks (`walk`) that start on the
//! line of sight. Results are kept apart by the number of ground bounces, so that any ground albedo can be evaluated
//! afterwards, and by batch, so that standard errors are honest for any of them.

#![allow(
    clippy::needless_range_loop,
    reason = "loops over wavelength lanes index several arrays at once"
)]

mod columns;
mod disc;
mod engine;
mod estimate;
mod guided_directions;
mod line_of_sight;
mod linear_density;
mod medium;
mod phase;
mod pixel_walks;
mod random;
mod segment;
mod shell_crossings;
mod single_scattering;
pub mod solids;
pub mod stokes;
mod sun;
mod sunlight_walks;
mod tabulated;
mod tally;
#[cfg(test)]
mod test_atmosphere;
#[cfg(test)]
mod tests;
mod view;
mod walk;

pub use estimate::{Estimate, Radiance};
pub use phase::Aerosol;
pub use view::{Pixel, View};
pub use walk::Gather;

use crate::atmosphere::Atmosphere;
use anyhow::{Result, ensure};
use engine::{Engine, Lanes};
use glam::DVec3;
use rayon::prelude::*;

/// Batches per query; standard errors come from their spread.
pub const BATCHES: usize = 32;
/// Walks per batch of a pilot run.
pub const PILOT: usize = 24;

/// Which orders of scattering are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orders {
    /// One scattering event (and sunlit ground, where it is seen and lit).
    Single,
    /// All.
    #[default]
    All,
}

/// Whether ground at the end of the line of sight shines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VisibleGround {
    /// It is black where it is seen directly; its light still reaches the air.
    #[default]
    Black,
    /// It is seen.
    Lit,
}

/// What is computed, and how.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Orders of scattering.
    pub orders: Orders,
    /// Ground at the end of the line of sight.
    pub visible_ground: VisibleGround,
    /// What aerosols do to polarisation.
    pub aerosol: Aerosol,
    /// Where walks gather sunlight.
    pub gather: Gather,
    /// Ground bounces kept; walks end after that many.
    pub bounces: usize,
    /// Angular radius of the sun, radians; 0 for a parallel beam, as the outside references have it.
    pub sun_radius: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            orders: Orders::All,
            visible_ground: VisibleGround::Black,
            aerosol: Aerosol::Depolarising,
            gather: Gather::Flights,
            bounces: 15,
            sun_radius: 0.0,
        }
    }
}

/// A line of sight under a sun. Angles in radians, lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
    /// Observer's altitude.
    pub altitude: f64,
    /// Angle of the line of sight from the observer's zenith.
    pub view_zenith: f64,
    /// Azimuth of the line of sight, 0 towards the sun, counter-clockwise from above.
    pub view_azimuth: f64,
    /// Elevation of the sun above the observer's horizontal plane.
    pub sun_elevation: f64,
    /// Where the line of sight is cut; `None` follows it to the ground or to space.
    pub distance: Option<f64>,
}

impl Query {
    /// Says which field is wrong.
    pub fn check(&self, top: f64) -> Result<()> {
        let field = |name: &str, value: f64, low: f64, high: f64| {
            ensure!(
                value.is_finite() && (low..=high).contains(&value),
                "{name} {value:?} is outside {low}..{high}"
            );
            Ok(())
        };
        let (right, tolerance) = (std::f64::consts::FRAC_PI_2, 1e-12);
        field("altitude", self.altitude, 0.0, top)?;
        field(
            "view zenith",
            self.view_zenith,
            0.0,
            2.0 * right + tolerance,
        )?;
        field("view azimuth", self.view_azimuth, -1e3, 1e3)?;
        field(
            "sun elevation",
            self.sun_elevation,
            -right - tolerance,
            right + tolerance,
        )?;
        self.distance
            .map_or(Ok(()), |d| field("distance", d, 0.0, 1e12))
    }
}

/// Traces one atmosphere.
pub struct Tracer {
    groups: Vec<Box<dyn Engine>>,
    options: Options,
    top: f64,
}

impl Tracer {
    /// Prepares `atmosphere`.
    pub fn new(atmosphere: &Atmosphere, options: Options) -> Result<Self> {
        ensure!(
            !atmosphere.wavelengths.is_empty(),
            "the atmosphere has no wavelengths"
        );
        ensure!(
            (0.0..=0.1).contains(&options.sun_radius),
            "sun radius {:?} is outside 0..0.1 rad",
            options.sun_radius
        );
        let all: Vec<usize> = (0..atmosphere.wavelengths.len()).collect();
        let groups = all
            .chunks(12)
            .map(|lanes| engine(atmosphere, lanes, options))
            .collect::<Result<_>>()?;
        Ok(Self {
            groups,
            options,
            top: atmosphere.top(),
        })
    }

    /// Estimates one query with `samples` walks per batch in each of [`BATCHES`] batches, on rayon's threads. The
    /// result depends on the arguments only.
    pub fn estimate(&self, query: &Query, samples: usize, seed: u64) -> Result<Estimate> {
        query.check(self.top)?;
        Ok(Estimate::join(
            self.groups
                .iter()
                .map(|group| group.estimate(query, samples, seed)),
        ))
    }

    /// Optical depth along a query's line of sight, per wavelength.
    pub fn optical_depth(&self, query: &Query) -> Result<Vec<f64>> {
        query.check(self.top)?;
        Ok(self
            .groups
            .iter()
            .flat_map(|group| group.optical_depth(query))
            .collect())
    }

    /// Estimates many queries in parallel; query `i` uses the seed `seed + i`.
    pub fn estimate_all(
        &self,
        queries: &[Query],
        samples: usize,
        seed: u64,
    ) -> Result<Vec<Estimate>> {
        queries
            .par_iter()
            .enumerate()
            .map(|(i, query)| self.estimate(query, samples, seed.wrapping_add(i as u64)))
            .collect()
    }

    /// What a camera sees in one pixel: the mean over `samples` walks in directions that `direction` makes of two
    /// numbers in 0..1. The result depends on the arguments only. Ground and solids reflect what `view` says.
    pub fn pixel(
        &self,
        view: &View,
        direction: &dyn Fn(f64, f64) -> DVec3,
        samples: usize,
        (seed, index): (u64, u64),
    ) -> Result<Pixel> {
        ensure!(samples > 0, "a pixel needs at least one sample");
        ensure!(
            (0.0..=self.top).contains(&view.altitude),
            "altitude {:?} is outside 0..{}",
            view.altitude,
            self.top
        );
        let mut all = Pixel::default();
        for group in &self.groups {
            let part = group.pixel(view, direction, samples, (seed, index));
            all.radiance.extend(part.radiance);
            all.error.extend(part.error);
        }
        Ok(all)
    }

    /// Walks per batch that should bring the standard error of I to `target` times I at `albedo`, from a pilot run
    /// whose results are not used: stopping when the error looks small would bias the result.
    pub fn samples_for(&self, query: &Query, target: f64, albedo: f64, seed: u64) -> Result<usize> {
        if self.options.orders == Orders::Single {
            return Ok(0);
        }
        let pilot = self.estimate(query, PILOT, seed ^ 0x5851_f42d_4c95_7f2d)?;
        let worst = (0..pilot.wavelengths())
            .map(|w| pilot.radiance(albedo, w))
            .filter(|r| r.stokes[0] > 0.0)
            .map(|r| r.error[0] / r.stokes[0])
            .fold(0.0, f64::max);
        let needed = PILOT as f64 * (worst / target).powi(2) * 1.1;
        Ok((needed.ceil() as usize).clamp(PILOT, 1 << 26))
    }
}

fn engine(atmosphere: &Atmosphere, lanes: &[usize], options: Options) -> Result<Box<dyn Engine>> {
    Ok(match lanes.len() {
        1 => Box::new(Lanes::<1>::new(atmosphere, lanes, options)?),
        2..=4 => Box::new(Lanes::<4>::new(atmosphere, lanes, options)?),
        _ => Box::new(Lanes::<12>::new(atmosphere, lanes, options)?),
    })
}
