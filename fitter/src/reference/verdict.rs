//! Statistics of many comparisons, and the limits that they must keep.

use std::fmt;

/// One number against its reference.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    /// The reference.
    pub reference: f64,
    /// Its uncertainty, systematic part included.
    pub uncertainty: f64,
    /// The tracer's result.
    pub ours: f64,
    /// Its standard error.
    pub error: f64,
    /// What differences are measured in: the reference's I.
    pub intensity: f64,
}

impl Comparison {
    /// Variance of the difference.
    fn variance(&self) -> f64 {
        self.uncertainty.powi(2) + self.error.powi(2)
    }

    /// Difference in standard deviations.
    pub fn z(&self) -> f64 {
        let difference = self.ours - self.reference;
        if difference == 0.0 {
            return 0.0;
        }
        difference / self.variance().sqrt()
    }
}

/// What a set of comparisons must keep to.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Largest |z|.
    pub z: f64,
    /// Largest χ²/n.
    pub chi2: f64,
    /// Largest mean difference relative to I.
    pub bias: f64,
}

/// The outcome for one quantity of one case.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Name of the case.
    pub case: String,
    /// Name of the quantity.
    pub quantity: String,
    /// All comparisons, in the order of the file's rows.
    pub comparisons: Vec<Comparison>,
    /// The limits.
    pub limits: Limits,
}

impl Verdict {
    /// χ²/n.
    pub fn chi2(&self) -> f64 {
        let sum: f64 = self.comparisons.iter().map(|c| c.z().powi(2)).sum();
        sum / self.comparisons.len() as f64
    }

    /// Mean of the differences relative to I, weighted with their precision, and its standard error.
    pub fn bias(&self) -> (f64, f64) {
        let (mut sum, mut weights) = (0.0, 0.0);
        for c in self.comparisons.iter().filter(|c| c.intensity > 0.0) {
            let weight = c.intensity.powi(2) / c.variance().max(1e-300);
            sum += weight * (c.ours - c.reference) / c.intensity;
            weights += weight;
        }
        if weights > 0.0 {
            (sum / weights, weights.sqrt().recip())
        } else {
            (0.0, 0.0)
        }
    }

    /// The z of the largest magnitude, and its row.
    pub fn worst(&self) -> (f64, usize) {
        let zs = self.comparisons.iter().map(Comparison::z).zip(0..);
        zs.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
            .unwrap_or((0.0, 0))
    }

    /// Quantile of |difference| relative to I.
    pub fn relative(&self, share: f64) -> f64 {
        let lit = self.comparisons.iter().filter(|c| c.intensity > 0.0);
        let mut all: Vec<f64> = lit
            .map(|c| (c.ours - c.reference).abs() / c.intensity)
            .collect();
        all.sort_by(f64::total_cmp);
        let last = all.len().saturating_sub(1) as f64;
        all.get((share * last).round() as usize)
            .copied()
            .unwrap_or(0.0)
    }

    /// Whether all limits are kept. The bias may exceed its limit by what chance alone explains (3 standard errors).
    pub fn passed(&self) -> bool {
        let (bias, error) = self.bias();
        !self.comparisons.is_empty()
            && self.comparisons.iter().all(|c| c.z().is_finite())
            && self.worst().0.abs() < self.limits.z
            && self.chi2() < self.limits.chi2
            && bias.abs() < self.limits.bias.max(3.0 * error)
    }

    /// Header for the lines that [`Display`](fmt::Display) writes.
    pub fn header() -> String {
        format!(
            "{:<22} {:<6} {:>4} {:>8} {:>9} {:>8} {:>7} {:>4} {:>7} {:>7}  {}",
            "case",
            "what",
            "n",
            "chi2/n",
            "bias %",
            "± %",
            "worst z",
            "row",
            "p95 %",
            "max %",
            "verdict"
        )
    }

    /// All comparisons, one a line.
    pub fn rows(&self) -> impl Iterator<Item = String> + '_ {
        self.comparisons.iter().enumerate().map(|(i, c)| {
            format!(
                "{} {} row {i}: reference {:.6e} ± {:.1e}, ours {:.6e} ± {:.1e}, z {:.2}",
                self.case,
                self.quantity,
                c.reference,
                c.uncertainty,
                c.ours,
                c.error,
                c.z()
            )
        })
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ((bias, error), (z, row)) = (self.bias(), self.worst());
        let [p95, max] = [0.95, 1.0].map(|share| self.relative(share));
        write!(
            f,
            "{:<22} {:<6} {:>4} {:>8.3} {:>9.4} {:>8.4} {:>7.2} {:>4} {:>7.3} {:>7.3}  {}",
            self.case,
            self.quantity,
            self.comparisons.len(),
            self.chi2(),
            100.0 * bias,
            100.0 * error,
            z,
            row,
            100.0 * p95,
            100.0 * max,
            if self.passed() { "ok" } else { "FAIL" }
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(ours: &[f64]) -> Verdict {
        let comparisons = ours.iter().map(|&ours| Comparison {
            reference: 1.0,
            uncertainty: 0.01,
            ours,
            error: 0.0,
            intensity: 1.0,
        });
        Verdict {
            case: String::new(),
            quantity: String::new(),
            comparisons: comparisons.collect(),
            limits: Limits {
                z: 4.5,
                chi2: 1.6,
                bias: 0.003,
            },
        }
    }

    #[test]
    fn limits_bite() {
        assert!(verdict(&[1.01, 0.99]).passed());
        assert!(!verdict(&[1.05, 0.95]).passed());
        assert!(!verdict(&[f64::NAN, 1.0]).passed());
        assert!(!verdict(&[]).passed());
        let many = vec![1.011; 1000];
        assert!(!verdict(&many).passed());
    }
}
