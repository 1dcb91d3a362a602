//! What of the light came from the ground: L = black + A/(1 − A s) · ground.

use super::sample::Samples;

/// Shares of light over black ground and from the ground, by albedo.
#[derive(Clone, Debug)]
pub struct AlbedoLaw {
    /// Albedos of the file.
    albedos: Vec<f64>,
    /// Spherical albedo of each channel.
    pub spherical: Vec<f64>,
}

/// Largest spherical albedo that is tried: clear air stays far below.
const LARGEST: f64 = 0.9;
/// Every how many sites are looked at.
const STRIDE: usize = 11;

impl AlbedoLaw {
    /// The spherical albedos that explain how the radiance depends on the albedo.
    pub fn new(albedos: &[f64], samples: &[Samples]) -> Self {
        let channels = samples.first().map_or(0, |s| s.channels);
        let mut law = Self {
            albedos: albedos.to_vec(),
            spherical: vec![0.0; channels],
        };
        // Two albedos say nothing of the curvature.
        if albedos.len() > 2 {
            for channel in 0..channels {
                law.spherical[channel] = golden_section(|s| law.misfit(samples, channel, s));
            }
        }
        law
    }

    /// Whether the light of the ground can be told from the rest.
    pub fn tells_ground(&self) -> bool {
        self.albedos.len() > 1
    }

    /// A/(1 − A s).
    pub fn ground_share(&self, albedo: usize, channel: usize) -> f64 {
        share(self.albedos[albedo], self.spherical[channel])
    }

    /// Light over black ground and from the ground, for values by albedo.
    pub fn split(&self, values: &[f64], channel: usize) -> [f64; 2] {
        self.split_by(values, values, channel)
    }

    /// The same where errors count relative to `light`.
    pub fn split_by(&self, values: &[f64], light: &[f64], channel: usize) -> [f64; 2] {
        match self.tells_ground() {
            true => self.line(values, light, self.spherical[channel]),
            false => [values[0], 0.0],
        }
    }

    /// Least squares of relative errors.
    fn line(&self, values: &[f64], light: &[f64], s: f64) -> [f64; 2] {
        let (mut aa, mut ab, mut bb, mut a, mut b) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for ((albedo, value), light) in self.albedos.iter().zip(values).zip(light) {
            let x = share(*albedo, s);
            let weight = 1.0 / (light * light).max(1e-30);
            aa += weight;
            ab += weight * x;
            bb += weight * x * x;
            a += weight * value;
            b += weight * value * x;
        }
        let determinant = aa * bb - ab * ab;
        match determinant > 1e-12 * aa * bb {
            true => [
                (bb * a - ab * b) / determinant,
                (aa * b - ab * a) / determinant,
            ],
            false => [a / aa.max(1e-300), 0.0],
        }
    }

    fn misfit(&self, samples: &[Samples], channel: usize, s: f64) -> f64 {
        let mut sum = 0.0;
        for sample in samples {
            let sites = sample.values.len() / (sample.albedos * sample.channels);
            for site in (0..sites).step_by(STRIDE) {
                let values: Vec<f64> = (0..sample.albedos)
                    .map(|a| f64::from(sample.at(site, a, channel)))
                    .collect();
                if values.iter().any(|v| *v < 1e-12) {
                    continue;
                }
                let [black, ground] = self.line(&values, &values, s);
                for (albedo, value) in self.albedos.iter().zip(&values) {
                    sum += ((black + share(*albedo, s) * ground) / value - 1.0).powi(2);
                }
            }
        }
        sum
    }
}

fn share(albedo: f64, spherical: f64) -> f64 {
    albedo / (1.0 - albedo * spherical)
}

/// The minimum of a function with one minimum over 0..=LARGEST.
fn golden_section(f: impl Fn(f64) -> f64) -> f64 {
    let ratio = (5f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (0.0, LARGEST);
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut at = inner.map(&f);
    while high - low > 1e-4 {
        if at[0] <= at[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            at = [f(inner[0]), at[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            at = [at[1], f(inner[1])];
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_of_the_ground_is_told_apart() {
        let (albedos, s) = ([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0], 0.17);
        let light = |black: f64, ground: f64| albedos.map(|a| black + share(a, s) * ground);
        let skies = [light(0.02, 0.003), light(0.5, 0.02), light(0.004, 0.004)];
        let values = skies.iter().flatten().map(|v| *v as f32).collect();
        let samples = Samples {
            values,
            albedos: 4,
            channels: 1,
        };
        // Sites are looked at by strides: repeat them.
        let repeated = Samples {
            values: samples.values.repeat(STRIDE),
            ..samples
        };
        let law = AlbedoLaw::new(&albedos, &[repeated]);
        assert!((law.spherical[0] - s).abs() < 2e-3, "{:?}", law.spherical);
        let [black, ground] = law.split(&skies[1], 0);
        assert!((black - 0.5).abs() < 1e-4 && (ground - 0.02).abs() < 1e-4);
    }
}
