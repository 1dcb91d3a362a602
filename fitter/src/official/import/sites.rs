//! Where an imported sky is sampled: at the sites of welkin's axes, under the suns of the file.

use crate::dataset::{Axis, Grid};
use crate::official::OfficialData;
use crate::official::angles::PLANET_RADIUS;
use crate::official::transmittance::TOP;
use std::f64::consts::FRAC_PI_2;
use welkin::axis::{ElevationAxis, Ends, alpha_angle};
use welkin::geometry::{Planet, Side};

/// The planet of the official model.
pub const PLANET: Planet = Planet {
    radius: PLANET_RADIUS,
    top: TOP,
};

/// Intervals of the axes above and below the horizon, and over azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intervals {
    /// Above the geometric horizon.
    pub up: usize,
    /// Below it.
    pub down: usize,
    /// Over azimuth.
    pub azimuth: usize,
    /// Over solar elevation; none is half as many again as the file has elevations.
    pub elevation: Option<usize>,
}

/// Below the horizon of files that see no air there: the fewest whose sites differ.
const UNSEEN: usize = 2;

/// How much denser the axes are at the horizon.
const EXPONENT: f64 = 2.0;

/// The grid of the model that `data` becomes: its own altitudes and visibilities.
pub fn grid(data: &OfficialData, intervals: Intervals) -> Grid {
    let axes = &data.header().axes;
    let free = |intervals| Axis {
        intervals,
        ends: Ends::Free,
    };
    let elevations = elevations(data);
    let (first, last) = (elevations[0], elevations[elevations.len() - 1]);
    let down = match axes.altitudes.iter().any(|h| Sites::sees_down(*h)) {
        true => intervals.down,
        false => UNSEEN.min(intervals.down),
    };
    let by_count = (3 * elevations.len() / 2).max(4);
    // Of one sun only, a little around it.
    let room = if elevations.len() == 1 { 1e-3 } else { 0.0 };
    Grid {
        altitudes: axes.altitudes.clone(),
        visibilities: axes.visibilities.iter().map(|v| 1e3 * v).collect(),
        up: (free(intervals.up), EXPONENT),
        down: (free(down), EXPONENT),
        phi: Axis {
            intervals: intervals.azimuth,
            ends: Ends::Mirrored,
        },
        elevation: ElevationAxis {
            min: (first - room).max(-FRAC_PI_2),
            max: (last + room).min(FRAC_PI_2),
            centre: (-1f64).to_radians(),
            width: 4f64.to_radians(),
            intervals: intervals.elevation.unwrap_or(by_count),
        },
    }
}

/// Solar elevations of the file, rad.
pub fn elevations(data: &OfficialData) -> Vec<f64> {
    let degrees = data.header().axes.elevations.iter();
    degrees.map(|e| e.to_radians()).collect()
}

/// The sites of the skies at one altitude.
#[derive(Clone)]
pub struct Sites {
    /// Side and elevation (rad) of the views, those above the geometric horizon first.
    pub views: Vec<(Side, f64)>,
    /// Azimuths relative to the sun, rad.
    pub azimuths: Vec<f64>,
    /// Solar elevations, rad.
    pub suns: Vec<f64>,
    /// How many of the views are above the horizon.
    pub up: usize,
    /// How many of the views see air: on the ground only those.
    pub seen: usize,
    /// Solid angle that a view stands for, of mean 1 over those above and below the horizon together.
    pub measure: Vec<f64>,
}

impl Sites {
    /// At altitude `h` (m) of `grid`, for the suns of the file.
    pub fn new(grid: &Grid, h: f64, suns: Vec<f64>) -> Self {
        let dip = PLANET.dip(h);
        let side = |(axis, exponent): (Axis, f64), side: Side| {
            let range = match side {
                Side::Up => FRAC_PI_2 + dip,
                Side::Down => FRAC_PI_2 - dip,
            };
            let n = axis.intervals;
            let sites = axis.sites().into_iter();
            sites.map(move |u| {
                let angle = alpha_angle(u, range, n, exponent);
                let elevation = match side {
                    Side::Up => angle - dip,
                    Side::Down => -angle - dip,
                };
                let step = (u.max(0.25) / n as f64).powf(exponent - 1.0);
                ((side, elevation), elevation.cos() * step)
            })
        };
        let all = side(grid.up, Side::Up).chain(side(grid.down, Side::Down));
        let (views, measure): (Vec<_>, Vec<f64>) = all.unzip();
        let mean = measure.iter().sum::<f64>() / measure.len() as f64;
        Self {
            up: grid.up.0.len(),
            seen: match Self::sees_down(h) {
                true => views.len(),
                false => grid.up.0.len(),
            },
            views,
            azimuths: grid.phi_sites(),
            suns,
            measure: measure.into_iter().map(|m| m / mean).collect(),
        }
    }

    /// Numbers of views, azimuths and suns.
    pub fn shape(&self) -> [usize; 3] {
        [self.views.len(), self.azimuths.len(), self.suns.len()]
    }

    /// Index of a site.
    pub fn index(&self, view: usize, azimuth: usize, sun: usize) -> usize {
        (view * self.azimuths.len() + azimuth) * self.suns.len() + sun
    }

    /// View direction of a view and azimuth, with the sun at azimuth 0.
    pub fn direction(&self, view: usize, azimuth: usize) -> [f64; 3] {
        let ((se, ce), (sa, ca)) = (
            self.views[view].1.sin_cos(),
            self.azimuths[azimuth].sin_cos(),
        );
        [ce * ca, ce * sa, se]
    }

    /// Cosine of the angle between view and sun at every site.
    pub fn cosines(&self) -> Vec<f32> {
        let [views, azimuths, _] = self.shape();
        let mut out = vec![];
        for v in 0..views {
            for p in 0..azimuths {
                let [x, _, z] = self.direction(v, p);
                out.extend(self.suns.iter().map(|e| (x * e.cos() + z * e.sin()) as f32));
            }
        }
        out
    }

    /// Whether there is air to be seen below the horizon.
    pub fn sees_down(h: f64) -> bool {
        h > 0.0
    }
}
