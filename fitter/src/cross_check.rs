//! The successive-orders solver before the reference tracer: traced data against the unbiased Monte Carlo tracer at
//! held-out points.

use crate::atmosphere::Atmosphere;
use crate::dataset::Sample;
use crate::successive_orders::NW;
use crate::tracer::{Options, Query, Tracer};
use anyhow::Result;
use std::f64::consts::FRAC_PI_2;

/// Systematic error that is granted to both sides together, relative.
pub const SYSTEMATIC: f64 = 1e-3;

/// One sample at one wavelength.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Solar elevation, rad.
    pub solar_elevation: f64,
    /// (data − tracer) / tracer.
    pub relative: f64,
    /// Relative standard error of the reference tracer.
    pub standard_error: f64,
}

impl Difference {
    /// As numbers for a file.
    pub fn to_values(&self) -> [f32; 3] {
        [self.solar_elevation, self.relative, self.standard_error].map(|v| v as f32)
    }

    /// The inverse of [`Difference::to_values`] for a row of differences.
    pub fn from_values(values: &[f32]) -> Vec<Self> {
        let rows = values.as_chunks::<3>().0.iter();
        rows.map(|row| {
            let [solar_elevation, relative, standard_error] = row.map(f64::from);
            Self {
                solar_elevation,
                relative,
                standard_error,
            }
        })
        .collect()
    }

    /// Difference over its standard error, the systematic allowance included.
    pub fn z(&self) -> f64 {
        self.relative / self.standard_error.hypot(SYSTEMATIC)
    }
}

/// Traces every sample with the reference tracer to the relative standard error `target` and compares.
pub fn cross_check(
    atmosphere: &Atmosphere,
    samples: &[Sample],
    target: f64,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<Difference>> {
    let tracer = Tracer::new(atmosphere, Options::default())?;
    let mut out = vec![];
    for (i, sample) in samples.iter().enumerate() {
        if sample.radiance.iter().all(|&l| l == 0.0) {
            continue;
        }
        let query = Query {
            altitude: sample.altitude,
            view_zenith: FRAC_PI_2 - sample.view_elevation,
            view_azimuth: sample.view_azimuth,
            sun_elevation: sample.solar_elevation,
            distance: None,
        };
        let walks = tracer.samples_for(&query, target, sample.albedo, 2 * i as u64)?;
        let estimate = tracer.estimate(&query, walks, 2 * i as u64 + 1)?;
        for w in 0..NW {
            let traced = estimate.radiance(sample.albedo, w);
            if traced.stokes[0] > 0.0 {
                out.push(Difference {
                    solar_elevation: sample.solar_elevation,
                    relative: sample.radiance[w] / traced.stokes[0] - 1.0,
                    standard_error: traced.error[0] / traced.stokes[0],
                });
            }
        }
        progress();
    }
    Ok(out)
}

/// Bands of solar elevation (degrees) that are reported apart.
const BANDS: [(f64, f64); 7] = [
    (-12.0, -8.0),
    (-8.0, -4.2),
    (-4.2, -3.0),
    (-3.0, -1.0),
    (-1.0, 1.0),
    (1.0, 12.0),
    (12.0, 90.0),
];

/// Differences in a few numbers, all relative.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Summary {
    /// Number of values.
    pub values: usize,
    /// Mean difference, weighted with the precision of the reference tracer: the bias of the data.
    pub mean: f64,
    /// Standard error of the mean that follows from that precision.
    pub standard_error: f64,
    /// Root mean square of the differences.
    pub rms: f64,
    /// Root mean square of the reference tracer's own standard errors, the part of `rms` that is not due to the data.
    pub tracer_rms: f64,
    /// Mean of z².
    pub chi2: f64,
    /// Largest |z|.
    pub worst_z: f64,
}

impl Summary {
    /// `None` without differences.
    pub fn of<'a>(differences: impl IntoIterator<Item = &'a Difference>) -> Option<Self> {
        let all: Vec<&Difference> = differences.into_iter().collect();
        let n = all.len() as f64;
        let mean_of = |f: &dyn Fn(&Difference) -> f64| all.iter().map(|d| f(d)).sum::<f64>() / n;
        let weight = |d: &Difference| 1.0 / (d.standard_error.powi(2) + SYSTEMATIC.powi(2));
        let weights = mean_of(&weight);
        (!all.is_empty()).then(|| Self {
            values: all.len(),
            mean: mean_of(&|d| weight(d) * d.relative) / weights,
            // The wavelengths of a sample share their walks: count samples, not values.
            standard_error: (NW as f64 / (n * weights)).sqrt(),
            rms: mean_of(&|d| d.relative.powi(2)).sqrt(),
            tracer_rms: mean_of(&|d| d.standard_error.powi(2)).sqrt(),
            chi2: mean_of(&|d| d.z().powi(2)),
            worst_z: all.iter().map(|d| d.z().abs()).fold(0.0, f64::max),
        })
    }
}

/// One line per band: number, mean difference and its standard error, rms, χ²/n, largest |z|.
pub fn table(differences: &[Difference]) -> String {
    let mut out = format!(
        "{:>14} {:>7} {:>20} {:>8} {:>8} {:>9}\n",
        "sun", "values", "mean difference %", "rms %", "chi2/n", "worst z"
    );
    for (low, high) in BANDS {
        let band = |d: &&Difference| (low..high).contains(&d.solar_elevation.to_degrees());
        if let Some(s) = Summary::of(differences.iter().filter(band)) {
            out += &format!(
                "{low:>5}..{high:<4} deg {:>7} {:>+9.3} +- {:<7.3} {:>8.3} {:>8.2} {:>9.2}\n",
                s.values,
                100.0 * s.mean,
                100.0 * s.standard_error,
                100.0 * s.rms,
                s.chi2,
                s.worst_z,
            );
        }
    }
    out
}
