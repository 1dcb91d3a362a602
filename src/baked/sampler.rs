//! Directions drawn in proportion to luminance.

use core::f64::consts::TAU;

use super::baked_colour::BakedColourSky;
use super::coordinates::{LocalFrame, prepared};
use super::luminance_lattice::LuminanceLattice;
use crate::error::{Error, Result};
use crate::kernel::lanes::Lanes;
use crate::kernel::math::finite;
use crate::kernel::simd::dispatch;
use crate::sun::SolarDisc;

/// Rows of cells above and below the horizon, and columns from the sun's azimuth to the opposite one.
pub(super) const UP: usize = 48;
pub(super) const DOWN: usize = 24;
pub(super) const COLUMNS: usize = 48;
const ROWS: usize = UP + DOWN;

/// What a direction was drawn for. Its density counts both all the same.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model, Part};
///
/// let model = Model::default_model()?;
/// let conditions = Conditions::default();
/// let sky = model.sky(&conditions)?.bake_colour(BakedSky::TOLERANCE)?;
/// let sampler = sky.sampler().with_sun(&model.solar_disc(&conditions)?);
/// // Small first numbers are the sun's.
/// assert_eq!(sampler.sample([0.001, 0.5]).part, Part::Sun);
/// assert_eq!(sampler.sample([0.999, 0.5]).part, Part::Sky);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The sky without the sun's disc.
    Sky,
    /// The visible part of the sun's disc.
    Sun,
}

/// A direction, the density that it was drawn with and the light from there.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.sky(&Conditions::default())?;
/// let sampler = sky.bake_colour(BakedSky::TOLERANCE)?.sampler();
/// let sample = sampler.sample([0.25, 0.75]);
/// let weight = sample.xyz[1] / sample.pdf; // what a Monte Carlo estimate of the flux adds
/// assert!(weight > 0.0);
/// let length = sample.direction.iter().map(|c| c * c).sum::<f32>();
/// assert!((length - 1.0).abs() < 1e-5);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Unit vector.
    pub direction: [f32; 3],
    /// Density per solid angle, sr⁻¹.
    pub pdf: f32,
    /// CIE XYZ of sky and, if it is drawn, the sun's disc, as [`SkySampler::xyz`] gives it: Y in cd m⁻².
    pub xyz: [f32; 3],
    /// What it was drawn for.
    pub part: Part,
}

/// Draws directions with a density that is the luminance of the sky in cells of a few degrees, of constant density
/// each, with or without the sun's disc. Draws and densities do not allocate. `Send + Sync`.
///
/// Of the disc only what is above the geometric horizon is drawn, evenly in solid angle, upright with the first number
/// and across with the second. Draws keep 1.5e-4 of its radius (7e-7 rad) off the limb, and its density reaches as far
/// beyond, so that directions may be turned to another frame and back in single precision: what falls into the rim is
/// drawn on the rim's inner edge, which changes the light of the disc by less than 1e-4. Along the horizon rounding can
/// make draws black, which costs 2e-5 of the light of a whole disc.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let model = Model::default_model()?;
/// let conditions = Conditions::default();
/// let sky = model.sky(&conditions)?.bake_colour(BakedSky::TOLERANCE)?;
/// let sampler = sky.sampler().with_sun(&model.solar_disc(&conditions)?);
/// // Illuminance of level ground, lx, from a grid of draws.
/// let draws = 64;
/// let mut sum = 0.0;
/// for k in 0..draws * draws {
///     let point = [k % draws, k / draws].map(|i| (i as f32 + 0.5) / draws as f32);
///     let sample = sampler.sample(point);
///     sum += sample.xyz[1] * sample.direction[2].max(0.0) / sample.pdf;
/// }
/// let illuminance = sum / (draws * draws) as f32;
/// assert!((20e3..60e3).contains(&illuminance));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SkySampler {
    sky: BakedColourSky,
    pub(super) frame: LocalFrame,
    /// z at the edges of each row, from the horizon to the pole: above, then below.
    pub(super) heights: Vec<[f32; 2]>,
    /// Azimuths from the sun at the edges of the columns, 0..=π.
    pub(super) azimuths: Vec<f32>,
    /// Cumulative probability at the edges of the rows.
    pub(super) rows: Vec<f32>,
    /// Cumulative probability in a row at the edges of the columns, `[row][edge]`.
    pub(super) columns: Vec<f32>,
    /// Density, `[row][column]`.
    pub(super) density: Vec<f32>,
    /// Luminous flux through a sphere, cd sr m⁻².
    flux: f64,
    pub(super) sun: Option<(SolarDisc, f32)>,
}

impl BakedColourSky {
    /// Prepares drawing of directions in proportion to the luminance of the sky, without the sun's disc.
    pub fn sampler(&self) -> SkySampler {
        let frame = self.frame();
        let mut sampler = SkySampler {
            sky: self.clone(),
            heights: (0..ROWS)
                .map(|row| frame.row(row, UP, DOWN).map(|z| z as f32))
                .collect(),
            azimuths: (0..=COLUMNS)
                .map(|i| (2.0 * (i as f64 / COLUMNS as f64).asin()) as f32)
                .collect(),
            rows: Vec::new(),
            columns: Vec::new(),
            density: Vec::new(),
            flux: 0.0,
            sun: None,
            frame,
        };
        let cells = sampler.cells(self);
        sampler.fill(&cells);
        sampler
    }
}

impl SkySampler {
    /// Draws the sun's disc too, as often as its share of the luminous flux is.
    #[must_use]
    pub fn with_sun(mut self, sun: &SolarDisc) -> Self {
        let flux = sun.flux();
        let share = flux / (flux + self.flux);
        self.sun = (share > 0.0).then(|| (sun.clone(), share as f32));
        self
    }

    /// Maps the unit square to a direction and its density. Numbers outside 0..1 are clamped.
    pub fn sample(&self, [a, b]: [f32; 2]) -> Sample {
        let (mut a, b) = (into_unit(a), into_unit(b));
        if let Some((sun, share)) = &self.sun {
            if a < *share {
                let point = sun.draw([f64::from(a / share), f64::from(b)]);
                return self.finish(point, Part::Sun);
            }
            a = into_unit((a - share) / (1.0 - share));
        }
        let (row, a) = find(&self.rows, a);
        // Left and right of the sun are alike.
        let (side, b) = if b < 0.5 {
            (1.0, 2.0 * b)
        } else {
            (-1.0, 2.0 * b - 1.0)
        };
        let edges = &self.columns[row * (COLUMNS + 1)..][..COLUMNS + 1];
        let (column, b) = find(edges, into_unit(b));
        let [low, high] = self.heights[row];
        let z = low + a * (high - low);
        let azimuth = mix(&self.azimuths, column, b);
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sine, cosine) = azimuth.sin_cos();
        let [x, y] = [r * cosine, r * sine * side];
        let [cosine, sine] = self.frame.azimuth();
        let direction = [x * cosine - y * sine, x * sine + y * cosine, z];
        self.finish(direction, Part::Sky)
    }

    fn finish(&self, direction: [f32; 3], part: Part) -> Sample {
        Sample {
            direction,
            // What a caller gets who asks later.
            pdf: self.pdf(direction).unwrap_or(0.0),
            xyz: self.xyz(direction).unwrap_or([0.0; 3]),
            part,
        }
    }

    /// CIE XYZ of what draws are in proportion to: the sky and, if it is drawn, the sun's disc.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        let mut xyz = self.sky.xyz(direction)?;
        if let Some((sun, _)) = &self.sun {
            let disc = sun.xyz(direction)?;
            xyz = core::array::from_fn(|c| finite(xyz[c] + disc[c]));
        }
        Ok(xyz)
    }

    /// The density of [`SkySampler::sample`] at a direction, sr⁻¹.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn pdf(&self, direction: [f32; 3]) -> Result<f32> {
        let lanes = direction.map(|v| Lanes([v]));
        let prepared = prepared(lanes).ok_or(Error::Direction { got: direction })?;
        let point = self.frame.locate(prepared);
        let place = |x: f32, n: usize| ((x * n as f32) as usize).min(n - 1);
        let row = match point.side.0[0] >= 0.0 {
            true => place(point.height.0[0], UP),
            false => UP + place(point.height.0[0], DOWN),
        };
        let sky = self.density[row * COLUMNS + place(point.azimuth.0[0], COLUMNS)];
        Ok(match &self.sun {
            None => sky,
            Some((sun, share)) => (1.0 - share) * sky + share * sun.density(direction),
        })
    }

    /// Memory on the heap without the sun's disc, bytes.
    pub fn bytes(&self) -> usize {
        let tables = [&self.azimuths, &self.rows, &self.columns, &self.density];
        let tables: usize = tables.iter().map(|t| size_of_val(t.as_slice())).sum();
        tables + size_of_val(self.heights.as_slice()) + self.sky.bytes()
    }

    /// Mean luminance and solid angle of each cell, on both sides of the sun.
    fn cells(&self, sky: &BakedColourSky) -> Vec<[f64; 2]> {
        const PLACES: [f32; 2] = [0.25, 0.75];
        let heights: Vec<f32> = (self.heights.iter())
            .flat_map(|[low, high]| PLACES.map(|a| low + a * (high - low)))
            .collect();
        let azimuths: Vec<f32> = (0..COLUMNS)
            .flat_map(|column| PLACES.map(|b| mix(&self.azimuths, column, b)))
            .collect();
        let lattice = dispatch(LuminanceLattice {
            table: sky.table(),
            frame: &self.frame,
            heights: &heights,
            azimuths: &azimuths,
        });
        let cell = |i: usize| {
            let (row, column) = (i / COLUMNS, i % COLUMNS);
            let at = |k: usize| &lattice[(2 * row + k) * azimuths.len() + 2 * column..][..2];
            let luminance: f64 = (at(0).iter().chain(at(1))).map(|&y| f64::from(y)).sum();
            let width = f64::from(self.azimuths[column + 1] - self.azimuths[column]);
            let [low, high] = self.heights[row];
            [
                0.25 * luminance,
                2.0 * width * f64::from((high - low).abs()),
            ]
        };
        (0..ROWS * COLUMNS).map(cell).collect()
    }

    fn fill(&mut self, cells: &[[f64; 2]]) {
        self.flux = cells
            .iter()
            .map(|[luminance, angle]| luminance * angle)
            .sum();
        // A black sky is drawn evenly.
        let black = self.flux <= 0.0;
        let weight = |&[luminance, angle]: &[f64; 2]| if black { angle } else { luminance * angle };
        let share = 1.0 / if black { 2.0 * TAU } else { self.flux };
        let mut rows = Vec::new();
        for row in cells.chunks_exact(COLUMNS) {
            let weights: Vec<f64> = row.iter().map(weight).collect();
            rows.push(weights.iter().sum());
            self.columns.extend(cumulative(&weights));
            let density = |&[luminance, _]: &[f64; 2]| if black { 1.0 } else { luminance };
            let densities = row.iter().map(|cell| (density(cell) * share) as f32);
            self.density.extend(densities);
        }
        self.rows = cumulative(&rows);
    }
}

/// Running sums divided by the total, from 0 to 1; even where all weights are zero.
fn cumulative(weights: &[f64]) -> Vec<f32> {
    let total: f64 = weights.iter().sum();
    let even = total <= 0.0;
    let share = 1.0 / if even { weights.len() as f64 } else { total };
    let mut sum = 0.0;
    let mut edges = Vec::with_capacity(weights.len() + 1);
    edges.push(0.0);
    for weight in weights {
        sum += if even { 1.0 } else { *weight };
        edges.push((sum * share).min(1.0) as f32);
    }
    let last = edges.len() - 1;
    edges[last] = 1.0;
    edges
}

/// The interval of cumulative probabilities that holds `x` in 0..1, and the place in it.
fn find(edges: &[f32], x: f32) -> (usize, f32) {
    let i = edges
        .partition_point(|&edge| edge <= x)
        .clamp(1, edges.len() - 1)
        - 1;
    let width = edges[i + 1] - edges[i];
    (
        i,
        if width > 0.0 {
            (x - edges[i]) / width
        } else {
            0.5
        },
    )
}

fn mix(edges: &[f32], i: usize, t: f32) -> f32 {
    edges[i] + t * (edges[i + 1] - edges[i])
}

/// 0 ≤ x < 1; NaN becomes 0.
fn into_unit(x: f32) -> f32 {
    if x > 0.0 {
        x.min(1f32.next_down())
    } else {
        0.0
    }
}
