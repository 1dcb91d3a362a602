//! Weights of nodes for bands.

use super::examples::examples;
use super::few_columns::{MOST, choose};
use super::least_squares::{Problem, Weights};
use super::projection::Made;
use super::residual::Residual;
use super::response::Response;
use super::spectral_axis::SpectralAxis;
use crate::error::{Error, Result};
use crate::model::Model;

/// p99 of the relative residual over the examples that weights of curves are to keep.
pub(super) const TOLERANCE: f64 = 5e-4;
/// What a sum for a single wavelength may be off (p99); otherwise the taps of the format give it, which are right by
/// definition.
const SINGLE: f64 = 1e-3;

/// What the bands are made of, with indices of the nodes of the model, and how far off.
pub(super) struct Fit {
    pub made: Vec<Made>,
    pub residuals: Vec<Residual>,
}

impl Fit {
    pub fn new(model: &Model, axis: &SpectralAxis, responses: &[Response]) -> Result<Self> {
        let examples = examples(model)?;
        let bands: Result<Vec<Band>> = responses
            .iter()
            .map(|response| Band::new(model, axis, response, &examples))
            .collect();
        let bands = bands?;
        let given = given(&bands);
        let (fitted, problems): (Vec<usize>, Vec<Problem>) = (bands.iter().enumerate())
            .filter_map(|(i, band)| Some((i, band.problem(&examples)?)))
            .unzip();
        let weights = choose(&problems, &given, TOLERANCE);
        let mut fit = Self {
            residuals: vec![Residual::default(); bands.len()],
            made: bands.into_iter().map(Band::into_taps).collect(),
        };
        for ((band, problem), weights) in fitted.into_iter().zip(problems).zip(weights) {
            let [median, p99] = problem.residuals(&weights, MOST);
            fit.residuals[band] = Residual { median, p99 };
            fit.made[band] = Made::Sum(weights);
        }
        Ok(fit)
    }
}

/// A band and what it is for each example.
struct Band {
    /// Irradiance and taps of a single wavelength that no sum of nodes gives.
    taps: Option<(f64, Weights)>,
    values: Vec<f64>,
}

impl Band {
    fn new(
        model: &Model,
        axis: &SpectralAxis,
        response: &Response,
        examples: &[Vec<f64>],
    ) -> Result<Self> {
        let head = model.head();
        let nodes = quadrature(model, axis, response)?;
        let mut values = vec![0.0; examples.len()];
        for &[wavelength, weight] in &nodes {
            let taps = axis.weights(wavelength);
            let share = weight * head.solar_irradiance_at(wavelength);
            for (value, logarithms) in values.iter_mut().zip(examples) {
                let logarithm: f64 = taps.iter().map(|&(n, w)| w * logarithms[n]).sum();
                *value += share * logarithm.exp();
            }
        }
        let mut band = Self { taps: None, values };
        if let Some(wavelength) = response.single() {
            let problem = band.problem(examples);
            let sum = |p: &Problem| p.residuals(&p.solve(&all(p)), MOST)[1];
            if problem.as_ref().is_none_or(|p| sum(p) > SINGLE) {
                let irradiance = head.solar_irradiance_at(wavelength);
                band.taps = Some((irradiance, axis.weights(wavelength)));
            }
        }
        Ok(band)
    }

    /// The least-squares problem of relative residuals; none where taps make the band, or there is no light to fit.
    fn problem(&self, examples: &[Vec<f64>]) -> Option<Problem> {
        if self.taps.is_some() {
            return None;
        }
        let rows: Vec<(&Vec<f64>, f64)> = (examples.iter().zip(&self.values))
            .filter(|(_, value)| value.is_finite() && **value > 0.0)
            .map(|(row, &value)| (row, value))
            .collect();
        let column = |n: usize| rows.iter().map(|(row, value)| row[n].exp() / value).collect();
        let columns = (0..rows.first()?.0.len()).map(column).collect();
        Some(Problem::new(columns, vec![1.0; rows.len()]))
    }

    fn into_taps(self) -> Made {
        match self.taps {
            Some((irradiance, taps)) => Made::Power(irradiance, taps),
            None => Made::Sum(Vec::new()),
        }
    }
}

/// Nodes that the taps of single wavelengths need anyway.
fn given(bands: &[Band]) -> Vec<usize> {
    let taps = bands.iter().filter_map(|band| band.taps.as_ref());
    let mut nodes: Vec<usize> = taps.flat_map(|(_, taps)| taps).map(|t| t.0).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Wavelengths and weights of a response within the range of a model.
pub(super) fn quadrature(
    model: &Model,
    axis: &SpectralAxis,
    response: &Response,
) -> Result<Vec<[f64; 2]>> {
    let [min, max] = axis.range();
    for value in response.range() {
        if !(min..=max).contains(&value) {
            return Err(Error::OutOfRange {
                parameter: "wavelength of a response",
                value,
                min,
                max,
                unit: "nm",
            });
        }
    }
    let head = model.head();
    let samples = 0..head.solar_irradiance.len();
    let mut kinks: Vec<f64> = samples
        .map(|i| head.solar_start + i as f64 * head.solar_step)
        .collect();
    kinks.extend(&axis.wavelengths);
    Ok(response.quadrature(&kinks))
}

fn all(problem: &Problem) -> Vec<usize> {
    (0..problem.len()).collect()
}
