//! Transmittance of the official model: a singular value decomposition of its square root over the end points of rays.

use super::angles::PLANET_RADIUS;
use super::between::Between;
use super::error::{OfficialError, Result, Section};
use super::layout::{Channels, MOST_BREAKS, MOST_NODES, MOST_RANK, check_axis, check_count};
use super::tables::check_finite;
use std::f64::consts::FRAC_PI_2;

/// Thickness of the atmosphere, m.
pub const TOP: f64 = 100_000.0;
/// Highest observer, m, whose rays the coordinate of the arc is made for.
const HIGHEST: f64 = 15_000.0;
/// From lower than this, rays are not taken as starting above the planet, m.
const ON_THE_GROUND: f64 = 0.3;

/// Lengths of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Nodes of the arc between the ends of a ray.
    pub arcs: usize,
    /// Nodes of the altitude of its far end.
    pub heights: usize,
    /// Visibilities.
    pub visibilities: usize,
    /// Altitudes of its near end.
    pub altitudes: usize,
    /// Components.
    pub rank: usize,
}

impl Shape {
    pub(super) fn check(&self) -> Result<()> {
        let counts = [
            ("nodes of the arc", self.arcs, MOST_BREAKS),
            ("nodes of the altitude", self.heights, MOST_BREAKS),
            ("visibilities", self.visibilities, MOST_NODES),
            ("altitudes", self.altitudes, MOST_NODES),
            ("rank", self.rank, MOST_RANK),
        ];
        for (what, count, most) in counts {
            check_count(Section::Transmittance, what, count as i64, most)?;
        }
        Ok(())
    }

    /// Numbers of all rays.
    pub(super) fn paths(&self) -> usize {
        self.altitudes * self.arcs * self.heights * self.rank
    }

    /// Numbers of all airs.
    pub(super) fn airs(&self, channels: usize) -> usize {
        self.visibilities * self.altitudes * channels * self.rank
    }

    /// Bytes behind the counts. Without overflow: what does not fit is longer than any file.
    pub(super) fn bytes(&self, channels: usize) -> u64 {
        let product = |parts: &[usize]| {
            let parts = parts.iter();
            parts.fold(4, |product: u64, &n| product.saturating_mul(n as u64))
        };
        [
            product(&[self.altitudes]),
            product(&[self.visibilities]),
            product(&[self.altitudes, self.arcs, self.heights, self.rank]),
            product(&[self.visibilities, self.altitudes, channels, self.rank]),
        ]
        .iter()
        .fold(0, |sum: u64, n| sum.saturating_add(*n))
    }
}

/// The whole transmittance.
#[derive(Clone, Debug, PartialEq)]
pub struct Transmittance {
    shape: Shape,
    channels: Channels,
    altitudes: Vec<f64>,
    visibilities: Vec<f64>,
    /// `[altitude][arc][height][rank]`.
    paths: Vec<f32>,
    /// `[visibility][altitude][channel][rank]`.
    airs: Vec<f32>,
}

/// The far end of a ray in the coordinates of the tables, each 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarEnd {
    /// Cube root of the altitude over that of the top.
    pub height: f64,
    /// Fourth root of the arc on the ground over the longest.
    pub arc: f64,
}

/// The longest distance to the top of the atmosphere from within the altitudes of the model, m.
pub fn longest() -> f64 {
    let horizon = |h: f64| (h * (2.0 * PLANET_RADIUS + h)).sqrt();
    horizon(HIGHEST) + horizon(TOP)
}

impl FarEnd {
    /// Of a ray from an altitude (m) with a zenith angle (rad) that goes on for a distance (m, may be infinite), at most
    /// to the planet or to the top.
    pub fn new(altitude: f64, theta: f64, distance: f64) -> Self {
        let (sine, cosine) = theta.sin_cos();
        let start = PLANET_RADIUS + altitude;
        let distance = reach(altitude, theta, sine, cosine).min(distance);
        let (x, y) = (sine * distance, start + cosine * distance);
        let height = (x.hypot(y) - PLANET_RADIUS).clamp(0.0, TOP);
        let arc = PLANET_RADIUS * x.abs().atan2(y);
        Self {
            height: (height / TOP).cbrt(),
            arc: (arc / longest()).sqrt().sqrt().min(1.0),
        }
    }
}

/// Distance to the planet or to the top, whichever is met first, m.
fn reach(altitude: f64, theta: f64, sine: f64, cosine: f64) -> f64 {
    let start = PLANET_RADIUS + altitude;
    // Of the line from the planet's centre.
    let nearest = start * sine;
    let along = -start * cosine;
    let half_chord = |radius: f64| {
        let square = (radius - nearest) * (radius + nearest);
        (square >= 0.0).then(|| square.sqrt())
    };
    let top = || half_chord(PLANET_RADIUS + TOP).map_or(0.0, |half| along + half);
    if altitude < ON_THE_GROUND {
        return if theta <= FRAC_PI_2 { top() } else { 0.0 };
    }
    match half_chord(PLANET_RADIUS) {
        Some(half) if along - half > 0.0 => along - half,
        _ => top(),
    }
}

/// Two nodes and how far between them.
struct Cell {
    index: usize,
    weight: f64,
}

impl Cell {
    /// Node i of `count` stands at i/count; within a cell weights are linear in the coordinate to the power `power`.
    fn new(coordinate: f64, count: usize, power: i32) -> Self {
        let index = ((coordinate * count as f64) as usize).min(count - 1);
        let at = |i: usize| (i as f64 / count as f64).powi(power);
        let weight = match index + 1 < count {
            true => (coordinate.powi(power) - at(index)) / (at(index + 1) - at(index)),
            false => 0.0,
        };
        Self {
            index,
            weight: weight.clamp(0.0, 1.0),
        }
    }

    fn corners(&self) -> impl Iterator<Item = (usize, f64)> {
        let both = [
            (self.index, 1.0 - self.weight),
            (self.index + 1, self.weight),
        ];
        both.into_iter().filter(|(_, weight)| *weight > 0.0)
    }
}

impl Transmittance {
    /// From axes (m and km) and factors of the lengths that `shape` says.
    ///
    /// # Errors
    /// [`OfficialError::Value`] for other lengths and for numbers that are not finite or do not increase.
    pub fn new(
        shape: Shape,
        channels: Channels,
        [altitudes, visibilities]: [Vec<f32>; 2],
        [paths, airs]: [Vec<f32>; 2],
    ) -> Result<Self> {
        shape.check()?;
        let got = [altitudes.len(), visibilities.len(), paths.len(), airs.len()];
        let expected = [
            shape.altitudes,
            shape.visibilities,
            shape.paths(),
            shape.airs(channels.count),
        ];
        let section = Section::Transmittance;
        if got != expected {
            let detail = format!("expected {expected:?}, got {got:?}");
            return Err(OfficialError::value(section, "lengths of tables", detail));
        }
        let [altitudes, visibilities]: [Vec<f64>; 2] =
            [altitudes, visibilities].map(|nodes| nodes.into_iter().map(f64::from).collect());
        check_axis(section, "altitudes", &altitudes, [0.0, 1e6])?;
        check_axis(section, "visibilities", &visibilities, [1e-3, 1e6])?;
        check_finite(section, "a factor of a ray", &paths)?;
        check_finite(section, "a factor of an air", &airs)?;
        Ok(Self {
            shape,
            channels,
            altitudes,
            visibilities,
            paths,
            airs,
        })
    }

    /// In some of its channels.
    pub(super) fn only(mut self, selected: std::ops::Range<usize>) -> Self {
        let channels = self.channels;
        let airs = self.airs.chunks_exact(channels.count * self.shape.rank);
        let part = selected.start * self.shape.rank..selected.end * self.shape.rank;
        self.airs = airs.flat_map(|row| row[part.clone()].to_vec()).collect();
        self.channels = Channels {
            count: selected.len(),
            start: channels.start + selected.start as f64 * channels.width,
            ..channels
        };
        self
    }

    /// Lengths of the tables.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Bins of wavelength.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// Altitudes of near ends, m.
    pub fn altitudes(&self) -> &[f64] {
        &self.altitudes
    }

    /// Visibilities, km.
    pub fn visibilities(&self) -> &[f64] {
        &self.visibilities
    }

    /// Factors `[altitude][arc][height][rank]` and `[visibility][altitude][channel][rank]`.
    pub fn factors(&self) -> [&[f32]; 2] {
        [&self.paths, &self.airs]
    }

    /// Transmittance in every channel from an altitude (m, raised as the official code does or not), for a zenith angle
    /// (rad), a distance (m) and a visibility (m).
    ///
    /// # Errors
    /// [`OfficialError::Condition`] for what is not a number, [`OfficialError::Negative`] for a distance below 0.
    pub fn at(
        &self,
        altitude: f64,
        theta: f64,
        distance: f64,
        visibility: f64,
    ) -> Result<Vec<f64>> {
        let conditions = [
            ("the altitude", altitude.is_finite()),
            ("the zenith angle", theta.is_finite()),
            ("the distance", !distance.is_nan()),
            ("the visibility", visibility.is_finite()),
        ];
        if let Some((what, _)) = conditions.iter().find(|(_, sound)| !sound) {
            return Err(OfficialError::Condition(what));
        }
        if distance < 0.0 {
            return Err(OfficialError::Negative("the distance"));
        }
        let end = FarEnd::new(altitude, theta, distance);
        let mut root = vec![0.0; self.channels.count];
        for (v, by_visibility) in Between::new(&self.visibilities, visibility / 1e3).corners() {
            for (h, by_altitude) in Between::new(&self.altitudes, altitude).corners() {
                for (channel, root) in root.iter_mut().enumerate() {
                    *root += by_visibility * by_altitude * self.root(end, [v, h, channel]);
                }
            }
        }
        Ok(root.into_iter().map(|r| r * r).collect())
    }

    /// Root of the transmittance from a stored altitude at a stored visibility.
    fn root(&self, end: FarEnd, [visibility, altitude, channel]: [usize; 3]) -> f64 {
        let Shape {
            arcs,
            heights,
            rank,
            ..
        } = self.shape;
        let row = (visibility * self.shape.altitudes + altitude) * self.channels.count + channel;
        let air = &self.airs[row * rank..][..rank];
        let node = |arc: usize, height: usize| -> f64 {
            let row = (altitude * arcs + arc) * heights + height;
            let path = &self.paths[row * rank..][..rank];
            path.iter()
                .zip(air)
                .map(|(p, a)| f64::from(*p) * f64::from(*a))
                .sum()
        };
        let (arc, height) = (
            Cell::new(end.arc, arcs, 4),
            Cell::new(end.height, heights, 3),
        );
        let along = |h: usize| -> f64 {
            let sum: f64 = arc.corners().map(|(a, w)| w * node(a, h)).sum();
            sum.max(0.0)
        };
        height.corners().map(|(h, w)| w * along(h)).sum()
    }
}
