//! The data maker before its judge: traced data against the unbiased Monte Carlo tracer at held-out points.

use crate::atmosphere::Atmosphere;
use crate::dataset::Sample;
use crate::orders::NW;
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
    /// (data − judge) / judge.
    pub relative: f64,
    /// Relative standard error of the judge.
    pub standard_error: f64,
}

impl Difference {
    /// Difference over its standard error, the systematic allowance included.
    pub fn z(&self) -> f64 {
        self.relative / self.standard_error.hypot(SYSTEMATIC)
    }
}

/// Traces every sample with the judge to the relative standard error `target` and compares.
pub fn judge(
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
            let judged = estimate.radiance(sample.albedo, w);
            if judged.stokes[0] > 0.0 {
                out.push(Difference {
                    solar_elevation: sample.solar_elevation,
                    relative: sample.radiance[w] / judged.stokes[0] - 1.0,
                    standard_error: judged.error[0] / judged.stokes[0],
                });
            }
        }
        progress();
    }
    Ok(out)
}

/// Bands of solar elevation (degrees) that are reported apart.
const BANDS: [(f64, f64); 5] = [
    (-4.2, -3.0),
    (-3.0, -1.0),
    (-1.0, 1.0),
    (1.0, 12.0),
    (12.0, 90.0),
];

/// One line per band: number, mean difference and its standard error, rms, χ²/n, largest |z|.
pub fn table(differences: &[Difference]) -> String {
    let mut out = format!(
        "{:>14} {:>7} {:>20} {:>8} {:>8} {:>9}\n",
        "sun", "values", "mean difference %", "rms %", "chi2/n", "worst z"
    );
    for (low, high) in BANDS {
        let band: Vec<&Difference> = differences
            .iter()
            .filter(|d| (low..high).contains(&d.solar_elevation.to_degrees()))
            .collect();
        if band.is_empty() {
            continue;
        }
        let n = band.len() as f64;
        let mean = band.iter().map(|d| d.relative).sum::<f64>() / n;
        let square = band.iter().map(|d| d.relative * d.relative).sum::<f64>() / n;
        // The wavelengths of a sample share their walks: count samples, not values.
        let spread = ((square - mean * mean) / (n / NW as f64)).sqrt();
        out += &format!(
            "{low:>5}..{high:<4} deg {:>7} {:>+9.3} +- {:<7.3} {:>8.3} {:>8.2} {:>9.2}\n",
            band.len(),
            100.0 * mean,
            100.0 * spread,
            100.0 * square.sqrt(),
            band.iter().map(|d| d.z().powi(2)).sum::<f64>() / n,
            band.iter().map(|d| d.z().abs()).fold(0.0, f64::max),
        );
    }
    out
}
