//! What is asked: a sky, directions, and how many of them at once.

use std::hint::black_box;
use std::ops::Range;

use welkin::{BakedColourSky, BakedSky, Conditions, Directions, Model, Result, Sky};
use welkin_tools::WAVELENGTHS;
use welkin_tools::paper::Cell;
use welkin_tools::random::{Sequence, p95, sphere};

pub const QUERIES: usize = 8192;
/// Queries of one round: of prepared skies, of the paper's scheme and what else takes microseconds.
pub const ROUND: usize = 2048;
pub const SLOW: usize = 64;

/// The queries of a round of `n`.
pub fn span(round: usize, n: usize) -> Range<usize> {
    let first = round * n % QUERIES;
    first..first + n
}

/// A sky between all nodes, and directions to look in.
pub struct Scene {
    pub model: Model,
    pub conditions: Conditions,
    pub sky: Sky,
    pub spectral: BakedSky,
    pub colour: BakedColourSky,
    pub directions: Vec<[f32; 3]>,
    pub components: [Vec<f32>; 3],
}

/// The cell of the paper's grid (Table 2) with the conditions of the scene.
pub fn cell() -> Cell {
    Cell {
        visibility: [27.6e3, 40e3],
        albedo: [0.0, 0.33],
        altitude: [405.0, 643.1],
        elevation: [18.04f64.to_radians(), 23.35f64.to_radians()],
    }
}

impl Scene {
    /// Reads the embedded model.
    pub fn new() -> Result<Self> {
        let model = Model::default_model()?;
        let conditions = cell().inside([0.5; 4]);
        let sky = model.sky(&conditions)?;
        let mut sequence = Sequence::<2>::default();
        let directions: Vec<_> = (0..QUERIES).map(|_| sphere(sequence.draw())).collect();
        Ok(Self {
            components: [0, 1, 2].map(|i| directions.iter().map(|d| d[i]).collect()),
            spectral: sky.bake(BakedSky::TOLERANCE)?,
            colour: sky.bake_colour(BakedSky::TOLERANCE)?,
            model,
            conditions,
            sky,
            directions,
        })
    }

    /// The directions of a round.
    pub fn part(&self, round: usize) -> Directions<'_> {
        let [x, y, z] = &self.components;
        let span = span(round, ROUND);
        black_box(Directions {
            x: &x[span.clone()],
            y: &y[span.clone()],
            z: &z[span],
        })
    }

    /// All directions, by whatever answers them.
    pub fn spectra(
        &self,
        mut ask: impl FnMut([f32; 3], &mut [f32]) -> Result<()>,
    ) -> Result<Vec<f32>> {
        let n = self.sky.wavelengths().len();
        let mut spectra = vec![0.0; n * QUERIES];
        for (&d, out) in self.directions.iter().zip(spectra.chunks_exact_mut(n)) {
            ask(d, out)?;
        }
        Ok(spectra)
    }

    /// Four wavelengths per direction: one at random and three that divide the range with it.
    pub fn heroes(&self) -> Vec<[f32; 4]> {
        let range = self.model.wavelength_range();
        let [low, high] = range.expect("a sound spectrum");
        let mut sequence = Sequence::<1>::default();
        let place = |t: f64, k: usize| low + (high - low) * (t + 0.25 * k as f64).fract();
        let four = |t: f64| std::array::from_fn(|k| place(t, k) as f32);
        (0..QUERIES).map(|_| four(sequence.draw()[0])).collect()
    }

    /// From skies that are prepared for each query.
    pub fn error_in(
        &self,
        conditions: &[Conditions],
        mut ask: impl FnMut(usize, [f32; 3], &mut [f32]) -> Result<()>,
    ) -> Result<f64> {
        let mut pairs = Vec::new();
        let [mut got, mut truth] = [[0.0; WAVELENGTHS]; 2];
        for i in (0..QUERIES).step_by(41) {
            let direction = self.directions[i];
            ask(i, direction, &mut got)?;
            let sky = self.model.sky(&conditions[i])?;
            sky.radiance(direction, &mut truth)?;
            pairs.extend(got.into_iter().zip(truth));
        }
        Ok(p95(pairs.into_iter()))
    }
}

/// Queries that are valid.
pub fn unwrapped(mut work: impl FnMut(usize) -> Result<()>) -> impl FnMut(usize) {
    move |round| work(round).expect("valid queries")
}
