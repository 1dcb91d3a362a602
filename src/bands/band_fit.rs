//! Weights of nodes for bands.

use std::cell::OnceCell;

use super::band_projection::Made;
use super::examples::examples;
use super::few_columns::{MOST, choose};
use super::least_squares::{Problem, Weights};
use super::powers::Power;
use super::residual::Residual;
use super::response::Response;
use super::spectral_axis::{SpectralAxis, Taps, power};
use crate::error::Result;
use crate::model::Model;

/// p99 of the relative residual over the examples that weights are to keep.
pub(super) const TOLERANCE: f64 = 5e-4;
/// Sums of nodes cost least: what they may be off (p99) before a band is made of wavelengths between the nodes.
const SUM_TOLERANCE: f64 = 3e-3;

/// What the bands are made of, with indices of the nodes of the model, and how far off.
pub(super) struct Fit {
    pub made: Vec<Made>,
    pub residuals: Vec<Residual>,
}

impl Fit {
    pub fn new(model: &Model, axis: &SpectralAxis, responses: &[Response]) -> Result<Self> {
        let examples = Examples::new(model, axis)?;
        let mut fit = Self {
            made: Vec::new(),
            residuals: Vec::new(),
        };
        let (mut sums, mut problems) = (Vec::new(), Vec::new());
        for (band, response) in responses.iter().enumerate() {
            let values = examples.integrals(response)?;
            let problem = examples.over_nodes(&values);
            let (made, residual) = match sum_is_enough(&problem) {
                true => {
                    sums.push(band);
                    problems.push(problem);
                    (Made::default(), Residual::default())
                }
                false => examples.between_nodes(response, &values),
            };
            fit.made.push(made);
            fit.residuals.push(residual);
        }
        let weights = choose(&problems, &fit.nodes(), TOLERANCE, usize::MAX);
        for ((band, problem), weights) in sums.into_iter().zip(problems).zip(weights) {
            fit.residuals[band] = residual(&problem, &weights);
            fit.made[band].sum = weights;
        }
        Ok(fit)
    }

    /// Nodes that are needed whatever else is.
    fn nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = self.made.iter().flat_map(Made::nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

fn sum_is_enough(problem: &Problem) -> bool {
    let all: Vec<usize> = (0..problem.len()).collect();
    problem.residuals(&problem.solve(&all), MOST)[1] <= SUM_TOLERANCE
}

fn residual(problem: &Problem, weights: &Weights) -> Residual {
    let [median, p99] = problem.residuals(weights, MOST);
    Residual { median, p99 }
}

/// Typical spectra.
struct Examples<'a> {
    model: &'a Model,
    axis: &'a SpectralAxis,
    /// ln L at the nodes.
    logarithms: Vec<Vec<f64>>,
    /// ln L of each example at the knots between which it is interpolated, as far as asked for.
    knots: Vec<OnceCell<Vec<f64>>>,
}

impl<'a> Examples<'a> {
    fn new(model: &'a Model, axis: &'a SpectralAxis) -> Result<Self> {
        Ok(Self {
            model,
            axis,
            logarithms: examples(model)?,
            knots: vec![OnceCell::new(); axis.wavelengths.len()],
        })
    }

    /// Relative radiance at a wavelength.
    fn at(&self, wavelength: f64) -> Vec<f64> {
        let mut logarithms = vec![0.0; self.logarithms.len()];
        for (knot, weight) in self.axis.knots(wavelength) {
            let pairs = logarithms.iter_mut().zip(self.at_knot(knot));
            pairs.for_each(|(sum, l)| *sum += weight * l);
        }
        logarithms.into_iter().map(f64::exp).collect()
    }

    fn at_knot(&self, knot: usize) -> &[f64] {
        self.knots[knot].get_or_init(|| {
            let rows = self.logarithms.iter();
            rows.map(|row| self.axis.at_knot(knot, row)).collect()
        })
    }

    /// What a response sees of each.
    fn integrals(&self, response: &Response) -> Result<Vec<f64>> {
        let mut sums = vec![0.0; self.logarithms.len()];
        for [wavelength, weight] in self.axis.quadrature(self.model.head(), response)? {
            let share = weight * self.model.head().solar_irradiance_at(wavelength);
            let light = self.at(wavelength);
            sums.iter_mut()
                .zip(light)
                .for_each(|(sum, l)| *sum += share * l);
        }
        Ok(sums)
    }

    /// Values as sums over nodes, in terms of relative residuals.
    fn over_nodes(&self, values: &[f64]) -> Problem {
        let nodes = 0..self.model.head().wavelengths.len();
        let column = |n: usize| self.logarithms.iter().map(|row| row[n].exp()).collect();
        relative(nodes.map(column).collect(), values)
    }

    /// A band of a few wavelengths between the nodes, or terms of its cells.
    fn between_nodes(&self, response: &Response, values: &[f64]) -> (Made, Residual) {
        let pieces = self.axis.pieces(response.range());
        let of = |taps: &Taps| {
            let rows = self.logarithms.iter();
            rows.map(|row| power(taps, row)).collect()
        };
        let columns = pieces.iter().map(of).collect();
        let problem = relative(columns, values);
        let weights = choose(std::slice::from_ref(&problem), &[], TOLERANCE, usize::MAX).remove(0);
        let power = |&(i, factor): &(usize, f64)| Power {
            factor,
            taps: pieces[i].clone(),
        };
        let made = Made {
            sum: Vec::new(),
            powers: weights.iter().map(power).collect(),
        };
        (made, residual(&problem, &weights))
    }
}

/// Rows over their values; those without light say nothing.
fn relative(columns: Vec<Vec<f64>>, values: &[f64]) -> Problem {
    let lit: Vec<usize> = (0..values.len())
        .filter(|&i| values[i].is_finite() && values[i] > 0.0)
        .collect();
    let over = |column: Vec<f64>| lit.iter().map(|&i| column[i] / values[i]).collect();
    let columns = columns.into_iter().map(over).collect();
    Problem::new(columns, vec![1.0; lit.len()])
}
