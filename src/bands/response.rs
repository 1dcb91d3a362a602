//! Responses of sensors over wavelength.

use crate::error::{Error, Result};

/// What a band of a sensor makes of light: its response over wavelength.
///
/// ```
/// use welkin::Response;
///
/// // Spectral radiance at one wavelength, W m⁻² sr⁻¹ nm⁻¹.
/// let line = Response::wavelength(550.0);
/// // ∫ R E L dλ: W m⁻² sr⁻¹ for a response without a unit, linear between samples and zero beyond them.
/// let filter = Response::table(&[500.0, 510.0, 590.0, 600.0], &[0.0, 1.0, 1.0, 0.0])?;
/// // The mean spectral radiance over the filter, W m⁻² sr⁻¹ nm⁻¹.
/// let mean = filter.clone().normalised();
/// assert!((filter.integral() - 90.0).abs() < 1e-9 && (mean.integral() - 1.0).abs() < 1e-12);
/// assert_eq!(filter.range(), [500.0, 600.0]);
/// # assert_eq!(line.integral(), 1.0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    curve: Curve,
}

#[derive(Clone, Debug, PartialEq)]
enum Curve {
    Wavelength(f64),
    /// Wavelengths, nm, and values.
    Table(Vec<[f64; 2]>),
}

impl Response {
    /// A single wavelength, nm: the value of the band is the spectral radiance there, W m⁻² sr⁻¹ nm⁻¹.
    pub fn wavelength(wavelength: f64) -> Self {
        let curve = Curve::Wavelength(wavelength);
        Self { curve }
    }

    /// A curve through samples at strictly increasing wavelengths (nm), linear between them and zero beyond. The value
    /// of the band is the integral of response times spectral radiance.
    ///
    /// # Errors
    /// [`Error::Length`] unless there are as many values as wavelengths; [`Error::Invalid`] for fewer than two,
    /// wavelengths that do not increase, values that are not finite, below zero, or all zero, and for an integral beyond
    /// single precision: a curve that is negative somewhere is the difference of two bands.
    pub fn table(wavelengths: &[f64], values: &[f64]) -> Result<Self> {
        if wavelengths.len() != values.len() {
            return Err(Error::Length {
                what: "values of a response",
                expected: wavelengths.len() as u64,
                got: values.len() as u64,
            });
        }
        let wrong = |detail: &str| Err(Error::invalid("response", detail));
        if wavelengths.len() < 2 {
            return wrong("needs at least two samples");
        }
        if !wavelengths.iter().all(|l| l.is_finite()) {
            return wrong("wavelengths must be finite");
        }
        if !wavelengths.windows(2).all(|pair| pair[0] < pair[1]) {
            return wrong("wavelengths must increase strictly");
        }
        if !values.iter().all(|v| v.is_finite() && *v >= 0.0) {
            return wrong("values must be finite and not negative");
        }
        if values.iter().all(|&v| v == 0.0) {
            return wrong("is zero everywhere");
        }
        let samples = wavelengths.iter().zip(values).map(|(&l, &v)| [l, v]);
        let curve = Curve::Table(trimmed(samples.collect()));
        let response = Self { curve };
        match (response.integral() as f32).is_normal() {
            true => Ok(response),
            false => wrong("its integral is too large or too small"),
        }
    }

    /// The same curve over its integral: its value is the mean spectral radiance, W m⁻² sr⁻¹ nm⁻¹. That of a single
    /// wavelength is one already.
    #[must_use]
    pub fn normalised(mut self) -> Self {
        let integral = self.integral();
        if let Curve::Table(samples) = &mut self.curve {
            samples.iter_mut().for_each(|sample| sample[1] /= integral);
        }
        self
    }

    /// ∫ R dλ; 1 for a single wavelength.
    pub fn integral(&self) -> f64 {
        match &self.curve {
            Curve::Wavelength(_) => 1.0,
            Curve::Table(samples) => {
                let pieces = samples.windows(2);
                pieces
                    .map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0]))
                    .sum()
            }
        }
    }

    /// First and last wavelength that count, nm: those of a model must reach them.
    pub fn range(&self) -> [f64; 2] {
        match &self.curve {
            Curve::Wavelength(wavelength) => [*wavelength; 2],
            Curve::Table(samples) => [samples[0][0], samples[samples.len() - 1][0]],
        }
    }

    /// Wavelengths with weights of a quadrature, which takes notice of the kinks of the curve and of those (increasing)
    /// of what it is multiplied with.
    pub(super) fn quadrature(&self, kinks: &[f64]) -> Vec<[f64; 2]> {
        // In the ultraviolet light rises by a third within a nanometre.
        const STEP: f64 = 0.25;
        const STEPS: f64 = 32.0;
        let Curve::Table(samples) = &self.curve else {
            return vec![[self.range()[0], 1.0]];
        };
        let [first, last] = self.range();
        let step = STEP.min((last - first) / STEPS);
        let mut edges: Vec<f64> = samples.iter().map(|s| s[0]).collect();
        edges.extend(kinks.iter().filter(|k| (first..=last).contains(*k)));
        edges.sort_unstable_by(f64::total_cmp);
        edges.dedup();
        let mut out = vec![[first, 0.0]];
        for pair in edges.windows(2) {
            let pieces = ((pair[1] - pair[0]) / step).ceil().max(1.0) as usize;
            let width = (pair[1] - pair[0]) / pieces as f64;
            for i in 1..=pieces {
                // Neighbours share what lies between them.
                if let Some(start) = out.last_mut() {
                    start[1] += 0.5 * width;
                }
                let end = if i == pieces {
                    pair[1]
                } else {
                    pair[0] + width * i as f64
                };
                out.push([end, 0.5 * width]);
            }
        }
        for [wavelength, weight] in &mut out {
            *weight *= self.at(samples, *wavelength);
        }
        out.retain(|node| node[1] > 0.0);
        out
    }

    fn at(&self, samples: &[[f64; 2]], wavelength: f64) -> f64 {
        let after = samples.partition_point(|s| s[0] <= wavelength);
        let i = after.clamp(1, samples.len() - 1) - 1;
        let ([l0, v0], [l1, v1]) = (samples[i], samples[i + 1]);
        let t = ((wavelength - l0) / (l1 - l0)).clamp(0.0, 1.0);
        v0 + t * (v1 - v0)
    }
}

/// Without zeros at the ends but for one.
fn trimmed(samples: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let counts = |s: &[f64; 2]| s[1] > 0.0;
    let first = samples.iter().position(counts).unwrap_or(0);
    let last = samples.iter().rposition(counts).unwrap_or(0);
    samples[first.saturating_sub(1)..(last + 2).min(samples.len())].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a curve times what is linear between kinks the trapezoids are exact, where the curve is constant.
    #[test]
    fn quadrature_takes_notice_of_kinks_and_asks_nothing_twice() {
        let boxed = Response::table(&[499.9, 500.0, 530.0, 530.1], &[0.0, 2.0, 2.0, 0.0]).unwrap();
        let kinks = [480.0, 503.3, 510.0, 529.5, 600.0];
        let nodes = boxed.quadrature(&kinks);
        assert!(
            nodes.windows(2).all(|pair| pair[0][0] < pair[1][0]),
            "{nodes:?}"
        );
        let inside = |k: &&f64| (500.0..=530.0).contains(*k);
        assert!(
            kinks
                .iter()
                .filter(inside)
                .all(|k| nodes.iter().any(|n| n[0] == *k))
        );
        let bent = |l: f64| 1.0 + (l - 503.3).abs();
        let sum: f64 = nodes.iter().map(|&[l, w]| w * bent(l)).sum();
        let square = |l: f64| l * l / 2.0;
        let exact = 2.0 * (30.0 + square(3.3) + square(26.7)) + 0.1 * (bent(500.0) + bent(530.0));
        assert!((sum / exact - 1.0).abs() < 1e-5, "{sum} {exact}");
    }
}
