//! The tables of one sky in all channels.

use super::directions::directions;
use super::factorise::{Factors, Point};
use crate::official::angles::{Angles, Frame};
use crate::official::error::{OfficialError, Result};
use crate::official::layout::RadianceBreaks;
use crate::official::tables::{Place, RadianceTables};
use half::f16;
use std::f64::consts::FRAC_PI_2;

/// Directions per sky.
const DIRECTIONS: usize = 12_000;
/// Sweeps for the first channel, and for those that start from their neighbour.
const SWEEPS: [usize; 2] = [16, 5];
/// Radiance below this share of the mean counts less.
const DARK: f64 = 0.01;
/// Least emphasis of air below the horizon.
const LEAST_EMPHASIS: f64 = 1e-3;

/// Whence a sky is seen, and under which sun.
pub struct Viewpoint {
    /// Altitude, m.
    pub altitude: f64,
    /// Solar elevation, rad.
    pub solar_elevation: f64,
}

/// What the directions of a sky are to the tables.
pub struct Look {
    /// The directions.
    pub directions: Vec<[f64; 3]>,
    angles: Vec<Angles>,
    alpha: Vec<f64>,
    ground: bool,
}

impl Look {
    /// Of a sky.
    ///
    /// # Errors
    /// [`OfficialError::Direction`].
    pub fn new(viewpoint: &Viewpoint, frame: &Frame) -> Result<Self> {
        let directions = directions(viewpoint.altitude, viewpoint.solar_elevation, DIRECTIONS);
        let angles = directions.iter().map(|d| frame.angles(*d));
        let angles: Vec<Angles> = angles.collect::<Result<_>>()?;
        let alpha = angles.iter().map(|a| a.alpha(viewpoint.solar_elevation));
        Ok(Self {
            alpha: alpha.collect(),
            directions,
            angles,
            ground: viewpoint.altitude <= 0.0,
        })
    }

    /// Tables of every channel from radiance `[direction][channel]`, W m⁻² sr⁻¹ nm⁻¹.
    ///
    /// # Errors
    /// [`OfficialError::Value`] for radiance that is not finite.
    pub fn tables(
        &self,
        breaks: &RadianceBreaks,
        radiance: &[f32],
        channels: usize,
    ) -> Result<Vec<RadianceTables>> {
        if let Some(bad) = radiance.iter().find(|l| !l.is_finite()) {
            return Err(OfficialError::value(
                crate::official::Section::Radiance,
                "a radiance",
                format!("got {bad}"),
            ));
        }
        let mut factors = Factors::start(breaks.rank, &breaks.sun, breaks.zenith.len());
        let mut out = vec![];
        for c in 0..channels {
            let light = |i: usize| f64::from(radiance[i * channels + c]);
            let emphasis = self.emphasis(breaks, light);
            let points = self.points(breaks, &emphasis, light);
            factors.improve(&points, SWEEPS[usize::from(c > 0)]);
            out.push(tables(&factors, &points, breaks, emphasis));
        }
        Ok(out)
    }

    /// 1 above the horizon; below, what the air there is darker than that above, and nothing on the ground.
    fn emphasis(&self, breaks: &RadianceBreaks, light: impl Fn(usize) -> f64) -> Vec<f32> {
        let mut sums = [[0.0, 0.0]; 2];
        let near = 3f64.to_radians();
        for (i, angles) in self.angles.iter().enumerate() {
            let below = angles.zero - FRAC_PI_2;
            if below.abs() < near {
                let [sum, count] = &mut sums[usize::from(below > 0.0)];
                *sum += light(i);
                *count += 1.0;
            }
        }
        let mean = |[sum, count]: [f64; 2]| sum / f64::max(count, 1.0);
        let ratio = mean(sums[1]) / mean(sums[0]).max(1e-300);
        let below = match self.ground {
            true => 0.0,
            false => f64::from(f16::from_f64(ratio.clamp(LEAST_EMPHASIS, 1.0))),
        };
        let at = |angle: &f64| {
            if *angle <= FRAC_PI_2 + 1e-9 {
                1.0
            } else {
                below as f32
            }
        };
        breaks.emphasis.iter().map(at).collect()
    }

    fn points(
        &self,
        breaks: &RadianceBreaks,
        emphasis: &[f32],
        light: impl Fn(usize) -> f64,
    ) -> Vec<Point> {
        let count = self.angles.len();
        let mean = (0..count).map(&light).sum::<f64>() / count as f64;
        let dark = (DARK * mean).max(1e-30);
        let point = |(i, (angles, alpha)): (usize, (&Angles, &f64))| Point {
            sun: Place::new(&breaks.sun, angles.gamma),
            zenith: Place::new(&breaks.zenith, *alpha),
            factor: Place::new(&breaks.emphasis, angles.zero).of(emphasis),
            value: light(i),
            weight: 1.0 / light(i).max(dark),
        };
        self.angles
            .iter()
            .zip(&self.alpha)
            .enumerate()
            .map(point)
            .collect()
    }
}

/// Rounds what stands for the sun first, and then finds the rest for that.
fn tables(
    factors: &Factors,
    points: &[Point],
    breaks: &RadianceBreaks,
    emphasis: Vec<f32>,
) -> RadianceTables {
    let mut rounded = factors.clone();
    for v in &mut rounded.sun {
        *v = f16::from_f64(*v).to_f64();
    }
    rounded.solve_zenith(points);
    RadianceTables {
        sun: by_component(&rounded.sun, breaks.rank),
        zenith: by_component(&rounded.zenith, breaks.rank),
        emphasis,
    }
}

/// `[break][rank]` to `[rank][break]`.
pub fn by_component(matrix: &[f64], rank: usize) -> Vec<f32> {
    let column = |r: usize| matrix.iter().skip(r).step_by(rank).map(|v| *v as f32);
    (0..rank).flat_map(column).collect()
}
