//! Albedo over wavelength.

use std::sync::Arc;

use crate::error::{Error, Result};

/// The share of light that a Lambertian ground reflects, by wavelength: what a [`Model`](crate::Model) takes in place of
/// [`Conditions::albedo`](crate::Conditions::albedo), see [`Model::over`](crate::Model::over).
///
/// Cheap to clone. `Send + Sync`.
///
/// ```
/// use welkin::{Albedo, Conditions, Model};
///
/// // Grass: dark in blue and red, bright beyond the red edge.
/// let grass = Albedo::table(&[450.0, 550.0, 670.0, 750.0], &[0.04, 0.10, 0.05, 0.45])?;
/// assert!((grass.at(710.0) - 0.25).abs() < 1e-12); // linear between samples
/// assert_eq!(grass.at(2000.0), 0.45); // constant beyond them
///
/// let meadow = Model::default_model()?.over(&grass);
/// let sky = meadow.sky(&Conditions::default())?;
/// assert!(sky.radiance_at([0.0, 0.0, 1.0], 700.0)? > 0.0);
/// assert_eq!(Albedo::grey(1.5).unwrap_err().class(), "range");
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Albedo {
    /// Wavelengths, nm, and shares: at least one.
    samples: Arc<[[f64; 2]]>,
}

impl Albedo {
    /// The same share at all wavelengths.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is within 0..=1.
    pub fn grey(share: f64) -> Result<Self> {
        check(share)?;
        let samples = Arc::new([[0.0, share]]);
        Ok(Self { samples })
    }

    /// Shares at strictly increasing wavelengths (nm), linear between them and constant beyond. One sample, or samples
    /// that are all the same, are grey.
    ///
    /// # Errors
    /// [`Error::Length`] unless there are as many shares as wavelengths; [`Error::Invalid`] for none, for wavelengths
    /// that are not finite or not positive or do not increase; [`Error::OutOfRange`] for a share outside 0..=1.
    pub fn table(wavelengths: &[f64], shares: &[f64]) -> Result<Self> {
        if wavelengths.len() != shares.len() {
            return Err(Error::Length {
                what: "shares of an albedo",
                expected: wavelengths.len() as u64,
                got: shares.len() as u64,
            });
        }
        let wrong = |detail: &str| Err(Error::invalid("albedo", detail));
        let Some(&first) = shares.first() else {
            return wrong("needs at least one sample");
        };
        if !wavelengths.iter().all(|l| l.is_finite() && *l > 0.0) {
            return wrong("wavelengths must be finite and positive");
        }
        if !wavelengths.windows(2).all(|pair| pair[0] < pair[1]) {
            return wrong("wavelengths must increase strictly");
        }
        shares.iter().try_for_each(|&share| check(share))?;
        if shares.iter().all(|&share| share == first) {
            return Self::grey(first);
        }
        let samples = wavelengths
            .iter()
            .zip(shares)
            .map(|(&l, &share)| [l, share]);
        Ok(Self {
            samples: samples.collect(),
        })
    }

    /// The share at a wavelength, nm.
    pub fn at(&self, wavelength: f64) -> f64 {
        let samples = &self.samples;
        let after = samples.partition_point(|s| s[0] <= wavelength);
        if after == 0 || after == samples.len() {
            return samples[after.saturating_sub(1)][1];
        }
        let [[l0, a0], [l1, a1]] = [samples[after - 1], samples[after]];
        let t = (wavelength - l0) / (l1 - l0);
        // Of two shares within 0..=1 so is the mean, but for rounding.
        ((1.0 - t) * a0 + t * a1).clamp(0.0, 1.0)
    }

    /// The share, if it is the same at all wavelengths.
    pub fn as_grey(&self) -> Option<f64> {
        match *self.samples {
            [[_, share]] => Some(share),
            _ => None,
        }
    }
}

fn check(share: f64) -> Result<()> {
    if (0.0..=1.0).contains(&share) {
        return Ok(());
    }
    Err(Error::OutOfRange {
        parameter: "albedo",
        value: share,
        min: 0.0,
        max: 1.0,
        unit: "",
    })
}
