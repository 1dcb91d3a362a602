//! The transmittance of bands as sums of few exponentials.
//!
//! What a band sees through air is the mean of T, weighted by response and sunlight. That is Σ_j c_j exp(−Σ_k K_jk C_k)
//! over the columns C of a line, with c ≥ 0 of sum 1, fitted to lines of all kinds.

use std::cell::OnceCell;

use super::band_integral::spread;
use super::few_columns::choose;
use super::least_squares::Problem;
use super::mixture::Mixture;
use super::response::Response;
use super::spectral_axis::SpectralAxis;
use crate::error::Result;
use crate::format::{Head, Kind};
use crate::model::Model;
use crate::sky::MOST_WAVELENGTHS;
use crate::transmittance::{Layers, Segment};

/// Error that is to be kept (p99), relative to T where that is above [`DIM`].
const TOLERANCE: f64 = 1e-3;
const DIM: f64 = 0.02;
/// Most exponentials that a band is chosen from.
const MOST_CANDIDATES: usize = 160;
/// Lines through the air.
const LINES: u32 = 160;
/// What the rule that weights add up to one counts.
const WHOLE: f64 = 1e3;

/// The exponentials of all bands.
#[derive(Clone, Debug)]
pub(super) struct TransmittanceFit {
    /// One wavelength for each, with its extinction; per unit of sunlight.
    pub head: Head,
    pub mixture: Mixture,
}

/// An exponential, and what it comes from.
struct Candidate {
    wavelength: f64,
    /// `[visibility][constituent]`.
    extinction: Vec<Vec<f64>>,
}

/// Columns of a line at one of the visibilities.
struct Line {
    visibility: usize,
    columns: Vec<f64>,
}

impl TransmittanceFit {
    pub fn new(model: &Model, axis: &SpectralAxis, responses: &[Response]) -> Result<Self> {
        let lines = lines(model, axis)?;
        let passing = vec![OnceCell::new(); axis.wavelengths.len()];
        let mut kept: Vec<Candidate> = Vec::new();
        let mut weights = Vec::new();
        let mut sunlight = Vec::new();
        let most = MOST_WAVELENGTHS / responses.len();
        for (band, response) in responses.iter().enumerate() {
            let (means, whole) = means(model, axis, response, &lines, &passing)?;
            sunlight.push(whole as f32);
            let candidates = candidates(axis, response);
            let problem = problem(&candidates, &lines, &means);
            let found = choose(&[problem], &[], TOLERANCE, most).remove(0);
            let sum: f64 = found.iter().map(|w| w.1).sum();
            let mut candidates: Vec<Option<Candidate>> = candidates.into_iter().map(Some).collect();
            for (candidate, weight) in found {
                weights.push((band, (weight / sum) as f32));
                kept.extend(candidates[candidate].take());
            }
        }
        Ok(Self {
            head: head(model, axis, &kept),
            mixture: Mixture { weights, sunlight },
        })
    }
}

/// As if the model had these wavelengths.
fn head(model: &Model, axis: &SpectralAxis, kept: &[Candidate]) -> Head {
    let mut head = model
        .head()
        .at_wavelengths(&vec![0; kept.len()])
        .in_unit_sunlight();
    head.wavelengths = kept.iter().map(|c| c.wavelength).collect();
    head.extinction.clear();
    for v in 0..axis.visibilities() {
        for k in 0..axis.constituents() {
            head.extinction
                .extend(kept.iter().map(|c| c.extinction[v][k]));
        }
    }
    head
}

/// Exponentials that a band may be made of: at wavelengths spread over it, with and without lines.
fn candidates(axis: &SpectralAxis, response: &Response) -> Vec<Candidate> {
    let visibilities = 0..axis.visibilities();
    let extinction = |wavelength: f64, lines: &[f64]| -> Vec<Vec<f64>> {
        let add = |continuum: Vec<f64>| continuum.iter().zip(lines).map(|(a, b)| a + b).collect();
        let at = |v| add(axis.extinction(v, wavelength));
        visibilities.clone().map(at).collect()
    };
    let mut out = Vec::new();
    for wavelength in spread(&axis.wavelengths, response.range()) {
        for (_, lines) in axis.lines(wavelength) {
            let extinction = extinction(wavelength, &lines);
            out.push(Candidate {
                wavelength,
                extinction,
            });
        }
    }
    let step = out.len().div_ceil(MOST_CANDIDATES).max(1);
    out.into_iter().step_by(step).collect()
}

fn problem(candidates: &[Candidate], lines: &[Line], means: &[f64]) -> Problem {
    let scale = |mean: &f64| 1.0 / mean.max(DIM);
    let column = |candidate: &Candidate| {
        let values = lines.iter().zip(means);
        let values = values.map(|(line, mean)| scale(mean) * line.passes(&candidate.extinction));
        values.chain([WHOLE]).collect()
    };
    let right = means.iter().map(|mean| scale(mean) * mean).chain([WHOLE]);
    Problem::new(candidates.iter().map(column).collect(), right.collect())
}

impl Line {
    /// What passes, with the extinction at each visibility.
    fn passes(&self, extinction: &[Vec<f64>]) -> f64 {
        (-self.depth(&extinction[self.visibility])).exp()
    }

    fn depth(&self, extinction: &[f64]) -> f64 {
        extinction
            .iter()
            .zip(&self.columns)
            .map(|(k, c)| k * c)
            .sum()
    }
}

/// The mean of T over response and sunlight for each line, and the integral of these. What passes absorption lines at a
/// knot of the axis is computed once for all bands.
fn means(
    model: &Model,
    axis: &SpectralAxis,
    response: &Response,
    lines: &[Line],
    passing: &[OnceCell<Vec<f64>>],
) -> Result<(Vec<f64>, f64)> {
    /// Where the sun gives no light, its colour is that of the response.
    const DARKEST: f64 = 1e-12;
    let mut sums = vec![0.0; lines.len()];
    let (mut whole, mut sunlight) = (0.0, 0.0);
    for [wavelength, weight] in axis.quadrature(model.head(), response)? {
        let irradiance = model.head().solar_irradiance_at(wavelength);
        sunlight += weight * irradiance;
        let weight = weight * irradiance.max(DARKEST);
        whole += weight;
        let extinction: Vec<Vec<f64>> = (0..axis.visibilities())
            .map(|v| axis.extinction(v, wavelength))
            .collect();
        let mut shares = vec![0.0; lines.len()];
        for (knot, near) in axis.around(wavelength) {
            let passing = passing[knot].get_or_init(|| through_absorption(axis, knot, lines));
            let pairs = shares.iter_mut().zip(passing);
            pairs.for_each(|(share, passed)| *share += near * passed);
        }
        for ((sum, line), share) in sums.iter_mut().zip(lines).zip(shares) {
            *sum += weight * line.passes(&extinction) * share;
        }
    }
    Ok((sums.into_iter().map(|sum| sum / whole).collect(), sunlight))
}

/// What absorption lines let pass of light along each line through the air, at a knot of the axis.
fn through_absorption(axis: &SpectralAxis, knot: usize, lines: &[Line]) -> Vec<f64> {
    let absorbing = axis.lines_at(knot);
    let passed = |line: &Line| {
        let shares = absorbing.iter();
        shares.map(|(s, k)| s * (-line.depth(k)).exp()).sum()
    };
    lines.iter().map(passed).collect()
}

/// Lines of all lengths and heights: those of the model's air, or of any columns where it has none.
fn lines(model: &Model, axis: &SpectralAxis) -> Result<Vec<Line>> {
    let constituents = axis.constituents();
    let layers = match model.find(Kind::Transmittance, None, None) {
        Ok(_) => {
            let planet = model.head().planet;
            Some(Layers::new(&model.density_chunk()?, planet, constituents))
        }
        Err(_) => None,
    };
    let visibilities = [0, axis.visibilities() / 2, axis.visibilities() - 1];
    let mut out = Vec::new();
    for i in 0..LINES {
        // Evenly spread whatever the number of dimensions (Roberts' sequence).
        let at = |k: i32| (0.5 + f64::from(i) * 1.220_744_084_605_76f64.powi(-k)).fract();
        let columns = match &layers {
            Some(layers) => {
                let planet = layers.planet();
                let height = planet.top * at(1).powi(4);
                let way = 10f64.powf(2.0 + 4.0 * at(2));
                let sine = 1.1 * at(3).powi(2) - 0.1;
                let to = [way * (1.0 - sine * sine).sqrt(), 0.0, height + way * sine];
                let segment = Segment::between(&planet, [0.0, 0.0, height], to)?;
                let amounts = layers.columns(segment.line, segment.from, segment.to());
                (0..constituents)
                    .map(|k| f64::from(amounts.get(k)))
                    .collect()
            }
            None => (0..constituents as i32)
                .map(|k| 10f64.powf(1.0 + 5.0 * at(k + 1)))
                .collect(),
        };
        let visibility = visibilities[i as usize % visibilities.len()];
        out.push(Line {
            visibility,
            columns,
        });
    }
    Ok(out)
}
