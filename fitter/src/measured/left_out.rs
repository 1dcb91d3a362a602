//! Values of a scan that have no logarithm: how many there are, and when there are too many.

use super::error::MeasuredError;

/// Most of the values that may be left out of a fit: with more it is no longer the scan that is fitted.
pub const MOST: f64 = 0.05;

/// What is left out because it is no radiance above 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeftOut {
    /// Samples, and how many of their bands.
    pub samples: Vec<(usize, usize)>,
    /// Values that could have been compared.
    pub of: usize,
}

impl LeftOut {
    /// Of radiance by band and sample, but for the samples `without`, which nobody wants.
    pub fn of(measured: &[Vec<f64>], without: &[usize]) -> Self {
        let count = measured.first().map_or(0, Vec::len);
        let mut found = Self::default();
        for sample in (0..count).filter(|sample| !without.contains(sample)) {
            let dark = measured.iter().filter(|band| !is_light(band[sample]));
            match dark.count() {
                0 => {}
                dark => found.samples.push((sample, dark)),
            }
            found.of += measured.len();
        }
        found
    }

    /// How many values.
    pub fn count(&self) -> usize {
        self.samples.iter().map(|(_, count)| count).sum()
    }

    /// Refuses a scan of which more than [`MOST`] would be left out.
    ///
    /// # Errors
    /// [`MeasuredError::Dark`].
    pub fn check(&self) -> Result<(), MeasuredError> {
        match self.count() as f64 > MOST * self.of as f64 {
            true => Err(MeasuredError::Dark {
                detail: format!("{self}; more than {} % is no scan", 100.0 * MOST),
            }),
            false => Ok(()),
        }
    }
}

impl std::fmt::Display for LeftOut {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let name = |(sample, count): &(usize, usize)| format!("{sample} ({count})");
        let samples: Vec<String> = self.samples.iter().map(name).collect();
        write!(
            f,
            "{} of {} values are not above 0, at samples (bands): {}",
            self.count(),
            self.of,
            samples.join(", ")
        )
    }
}

/// Whether a radiance has a logarithm.
pub fn is_light(radiance: f64) -> bool {
    radiance > 0.0 && radiance.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_logarithm_is_counted_by_sample() {
        let measured = [
            vec![-1.0, 0.1, 0.0, 0.1, 0.1],
            vec![0.1, 0.1, f64::NAN, 0.1, -0.1],
        ];
        let found = LeftOut::of(&measured, &[0]);
        assert_eq!(found.samples, [(2, 2), (4, 1)]);
        assert_eq!((found.count(), found.of), (3, 8));
        assert!(found.check().is_err());
        assert!(found.to_string().ends_with("2 (2), 4 (1)"), "{found}");
    }

    #[test]
    fn a_share_of_one_in_twenty_is_taken() {
        let scan = |dark: usize| {
            let band: Vec<f64> = (0..40).map(|i| if i < dark { 0.0 } else { 0.1 }).collect();
            LeftOut::of(&[band], &[]).check()
        };
        assert!(scan(0).is_ok() && scan(2).is_ok());
        assert!(matches!(scan(3), Err(MeasuredError::Dark { .. })));
    }
}
