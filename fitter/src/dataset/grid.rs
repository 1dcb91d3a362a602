//! Where the sky is sampled: the axes of the model and the points on them.

use anyhow::{Result, ensure};
use std::f64::consts::{FRAC_PI_2, PI};
use welkin::axis::{ElevationAxis, Ends, alpha_angle, coefficients};
use welkin::geometry::{Planet, Side};

/// Observer altitudes, m: densest about the inversion at 2 km and where the aerosol ends, at 12 km.
pub const ALTITUDES: [f64; 20] = [
    0.0, 120.0, 645.0, 1150.0, 1650.0, 2100.0, 2600.0, 3650.0, 5700.0, 8400.0, 11_500.0, 13_300.0,
    15_500.0, 18_500.0, 23_000.0, 30_000.0, 40_000.0, 55_000.0, 75_000.0, 99_000.0,
];

/// Visibilities, m: those of the paper's Table 2 and one more where the air changes fastest.
pub const VISIBILITIES: [f64; 7] = [
    20_000.0, 23_500.0, 27_600.0, 40_000.0, 59_400.0, 90_000.0, 131_800.0,
];

/// A spline axis with its sample sites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Number of intervals.
    pub intervals: usize,
    /// Behaviour at the ends.
    pub ends: Ends,
}

impl Axis {
    /// As many sites as coefficients: the knots, and for free ends the middle of the first and last interval.
    pub fn sites(&self) -> Vec<f64> {
        let knots = (0..=self.intervals).map(|i| i as f64);
        match self.ends {
            Ends::Mirrored => knots.collect(),
            Ends::Free => {
                let n = self.intervals as f64;
                let mut sites: Vec<f64> = knots.chain([0.5, n - 0.5]).collect();
                sites.sort_by(f64::total_cmp);
                sites
            }
        }
    }

    /// Number of coefficients and of sites.
    pub fn len(&self) -> usize {
        coefficients(self.intervals, self.ends)
    }

    /// Never: an axis has at least two coefficients.
    pub fn is_empty(&self) -> bool {
        false
    }
}

/// The grid of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Observer altitudes, m.
    pub altitudes: Vec<f64>,
    /// Visibilities, m.
    pub visibilities: Vec<f64>,
    /// Axis above the geometric horizon and its exponent.
    pub up: (Axis, f64),
    /// Axis below the geometric horizon and its exponent.
    pub down: (Axis, f64),
    /// Azimuth axis.
    pub phi: Axis,
    /// Solar elevation axis.
    pub elevation: ElevationAxis,
}

impl Default for Grid {
    /// The grid of the embedded default model.
    fn default() -> Self {
        let free = |intervals| Axis {
            intervals,
            ends: Ends::Free,
        };
        Self {
            altitudes: ALTITUDES.to_vec(),
            visibilities: VISIBILITIES.to_vec(),
            up: (free(40), 3.0),
            down: (free(24), 3.0),
            phi: Axis {
                intervals: 18,
                ends: Ends::Mirrored,
            },
            elevation: ElevationAxis {
                min: (-12f64).to_radians(),
                max: FRAC_PI_2,
                centre: (-1.0f64).to_radians(),
                width: 4f64.to_radians(),
                intervals: 52,
            },
        }
    }
}

/// Observers at the ground are traced from this height: looking down they would see nothing to normalise.
const LOWEST: f64 = 0.5;

impl Grid {
    /// Refuses nodes that no model can have.
    pub fn check(&self) -> Result<()> {
        let rising = |nodes: &[f64]| nodes.windows(2).all(|w| w[0] < w[1]) && !nodes.is_empty();
        ensure!(rising(&self.altitudes), "altitudes must increase");
        ensure!(rising(&self.visibilities), "visibilities must increase");
        ensure!(
            self.altitudes[0] >= 0.0 && self.altitudes.iter().all(|&h| h < 100_000.0),
            "altitudes must lie in 0..100 km"
        );
        Ok(())
    }

    /// Altitude at which chunk `a` is traced, m.
    pub fn traced_altitude(&self, a: usize) -> f64 {
        self.altitudes[a].max(LOWEST)
    }

    /// View directions of altitude `a`: side and elevation above the local horizontal (rad), up axis first.
    pub fn view_sites(&self, planet: Planet, a: usize) -> Vec<(Side, f64)> {
        let dip = planet.dip(self.traced_altitude(a));
        let branch = |(axis, exponent): (Axis, f64), range: f64, side: Side| {
            axis.sites().into_iter().map(move |u| {
                let angle = alpha_angle(u, range, axis.intervals, exponent);
                match side {
                    Side::Up => (side, angle - dip),
                    Side::Down => (side, -angle - dip),
                }
            })
        };
        branch(self.up, FRAC_PI_2 + dip, Side::Up)
            .chain(branch(self.down, FRAC_PI_2 - dip, Side::Down))
            .collect()
    }

    /// Azimuths relative to the sun, rad.
    pub fn phi_sites(&self) -> Vec<f64> {
        let n = self.phi.intervals as f64;
        self.phi.sites().into_iter().map(|u| u / n * PI).collect()
    }

    /// Lowest and highest solar elevation, rad.
    pub fn elevation_range(&self) -> [f64; 2] {
        [self.elevation.min, self.elevation.max]
    }

    /// The elevation axis as a spline axis.
    pub fn elevation_axis(&self) -> Axis {
        Axis {
            intervals: self.elevation.intervals,
            ends: Ends::Free,
        }
    }

    /// Solar elevations, rad.
    pub fn elevation_sites(&self) -> Vec<f64> {
        self.elevation_axis()
            .sites()
            .into_iter()
            .map(|u| self.elevation.elevation(u))
            .collect()
    }
}
