//! Bands as weighted means of exponentials.

/// Exponentials with the bands that they are part of.
#[derive(Clone, Debug)]
pub(super) struct Mixture {
    /// Band and weight of each exponential; those of a band add up to one.
    pub weights: Vec<(usize, f32)>,
    /// ∫ R E dλ of each band.
    pub sunlight: Vec<f32>,
}

impl Mixture {
    /// Exponentials of all bands.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.sunlight.len()
    }

    /// The mean in each band.
    pub fn means(&self, exponentials: &[f32], out: &mut [f32]) {
        out.fill(0.0);
        for (value, &(band, weight)) in exponentials.iter().zip(&self.weights) {
            out[band] += weight * value;
        }
    }

    /// The same of sunlight.
    pub fn light(&self, exponentials: &[f32], out: &mut [f32]) {
        self.means(exponentials, out);
        let pairs = out.iter_mut().zip(&self.sunlight);
        pairs.for_each(|(value, sunlight)| *value = (*value * sunlight).min(f32::MAX));
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.weights.as_slice()) + size_of_val(self.sunlight.as_slice())
    }
}
