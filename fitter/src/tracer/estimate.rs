//! What a query gives: Stokes vectors by ground bounce, with standard errors from batches.

/// A Stokes vector per unit solar irradiance (sr⁻¹) and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radiance {
    /// I, Q, U.
    pub stokes: [f64; 3],
    /// One standard error of each.
    pub error: [f64; 3],
}

/// The result of a query at all wavelengths. `L = Σ albedo^k L_k` over the ground bounces k.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    transmittance: Vec<f64>,
    /// By wavelength and bounce.
    exact: Vec<Vec<[f64; 3]>>,
    /// By wavelength, batch and bounce.
    batches: Vec<Vec<Vec<[f64; 3]>>>,
}

impl Estimate {
    /// Collects what a group of wavelength lanes found.
    pub(super) fn new<'a, const N: usize>(
        transmittance: &[f64],
        exact: &[[[f64; N]; 3]],
        batches: impl Iterator<Item = &'a [[[f64; N]; 3]]> + Clone,
    ) -> Self {
        let lane = |sums: &[[[f64; N]; 3]], w: usize| -> Vec<[f64; 3]> {
            sums.iter().map(|s| [s[0][w], s[1][w], s[2][w]]).collect()
        };
        let lanes = 0..transmittance.len();
        Self {
            transmittance: transmittance.to_vec(),
            exact: lanes.clone().map(|w| lane(exact, w)).collect(),
            batches: lanes
                .map(|w| batches.clone().map(|sums| lane(sums, w)).collect())
                .collect(),
        }
    }

    /// Puts groups of wavelengths one after the other.
    pub(super) fn join(groups: impl Iterator<Item = Estimate>) -> Self {
        let mut all = Self {
            transmittance: vec![],
            exact: vec![],
            batches: vec![],
        };
        for group in groups {
            all.transmittance.extend(group.transmittance);
            all.exact.extend(group.exact);
            all.batches.extend(group.batches);
        }
        all
    }

    /// Number of wavelengths.
    pub fn wavelengths(&self) -> usize {
        self.transmittance.len()
    }

    /// Number of ground bounces kept.
    pub fn bounces(&self) -> usize {
        self.exact.first().map_or(0, |b| b.len() - 1)
    }

    /// Transmittance of the line of sight at wavelength index `w`.
    pub fn transmittance(&self, w: usize) -> f64 {
        self.transmittance[w]
    }

    /// Light over a ground of the given albedo at wavelength index `w`.
    pub fn radiance(&self, albedo: f64, w: usize) -> Radiance {
        self.combine(w, |k| albedo.powi(k as i32))
    }

    /// Light that touched the ground `k` times, for albedo 1, at wavelength index `w`.
    pub fn bounce(&self, k: usize, w: usize) -> Radiance {
        self.combine(w, |i| f64::from(u8::from(i == k)))
    }

    fn combine(&self, w: usize, factor: impl Fn(usize) -> f64) -> Radiance {
        let sum = |bounces: &[[f64; 3]]| {
            let mut total = [0.0; 3];
            for (k, stokes) in bounces.iter().enumerate() {
                for (t, s) in total.iter_mut().zip(stokes) {
                    *t += factor(k) * s;
                }
            }
            total
        };
        let exact = sum(&self.exact[w]);
        let batches: Vec<[f64; 3]> = self.batches[w].iter().map(|b| sum(b)).collect();
        let mut radiance = Radiance {
            stokes: exact,
            error: [0.0; 3],
        };
        if batches.len() > 1 {
            for c in 0..3 {
                let (mean, error) = mean_and_error(batches.iter().map(|b| b[c]));
                radiance.stokes[c] += mean;
                radiance.error[c] = error;
            }
        }
        radiance
    }
}

fn mean_and_error(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let variance = values.map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}
