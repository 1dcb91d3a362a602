//! Phase functions of particles as sums of Henyey-Greenstein functions, by wavelength.

use super::spectral_medium::{NW, Spectrum, henyey_greenstein};

/// One of the functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// Its share; those of a phase function add up to 1.
    pub weight: Spectrum,
    /// Asymmetry parameter.
    pub g: Spectrum,
}

/// A phase function of mean 1.
///
/// ```
/// use welkin_fitter::successive_orders::Lobes;
///
/// let lobes = Lobes::one([0.5; 24]);
/// assert!((lobes.at(1.0)[0] - 6.0).abs() < 1e-5);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lobes(Vec<Lobe>);

impl Lobes {
    /// A Henyey-Greenstein function.
    pub fn one(g: Spectrum) -> Self {
        let weight = [1.0; NW];
        Self(vec![Lobe { weight, g }])
    }

    /// From weights and asymmetry parameters, by wavelength the same number.
    pub fn new(wavelengths: &[Vec<[f64; 2]>]) -> Self {
        let count = wavelengths.first().map_or(0, Vec::len);
        let lobe = |k: usize| Lobe {
            weight: std::array::from_fn(|w| wavelengths[w][k][0] as f32),
            g: std::array::from_fn(|w| wavelengths[w][k][1] as f32),
        };
        Self((0..count).map(lobe).collect())
    }

    /// Its functions.
    pub fn iter(&self) -> impl Iterator<Item = &Lobe> {
        self.0.iter()
    }

    /// How many functions it is the sum of.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Value at the cosine of the scattering angle.
    pub fn at(&self, cosine: f32) -> Spectrum {
        let mut out = [0.0; NW];
        for Lobe { weight, g } in &self.0 {
            let value = henyey_greenstein(g, cosine);
            for w in 0..NW {
                out[w] += weight[w] * value[w];
            }
        }
        out
    }

    /// The same at one wavelength.
    pub fn at_one(&self, w: usize, cosine: f32) -> f32 {
        let value = |lobe: &Lobe| {
            let g = lobe.g[w];
            let x = 1.0 + g * g - 2.0 * g * cosine;
            lobe.weight[w] * ((1.0 - g * g) / (x * x.sqrt()))
        };
        self.0.iter().map(value).fold(0.0, |sum, v| sum + v)
    }

    /// Mean of the function times the Legendre polynomial of a degree.
    pub fn moment(&self, degree: usize) -> Spectrum {
        let mut out = [0.0; NW];
        for Lobe { weight, g } in &self.0 {
            for w in 0..NW {
                out[w] += weight[w] * g[w].powi(degree as i32);
            }
        }
        out
    }

    /// Mean cosine.
    pub fn asymmetry(&self, w: usize) -> f64 {
        let terms = self.0.iter();
        terms
            .map(|lobe| f64::from(lobe.weight[w]) * f64::from(lobe.g[w]))
            .sum()
    }

    /// Mean over the sphere of the squared difference to another, at one wavelength: of two functions,
    /// Σ (2l + 1)(gˡ − hˡ)².
    pub fn difference(&self, other: &Self, w: usize) -> f64 {
        self.product(self, w) + other.product(other, w) - 2.0 * self.product(other, w)
    }

    fn product(&self, other: &Self, w: usize) -> f64 {
        let pairs = self.iter().flat_map(|a| other.iter().map(move |b| (a, b)));
        let one = |(a, b): (&Lobe, &Lobe)| {
            let x = f64::from(a.g[w]) * f64::from(b.g[w]);
            let weight = f64::from(a.weight[w]) * f64::from(b.weight[w]);
            weight * ((1.0 + x) / (1.0 - x).powi(2))
        };
        pairs.map(one).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum itself.
    #[test]
    fn the_difference_of_phase_functions_is_their_series() {
        let term = |l: i32| f64::from(2 * l + 1) * (0.6f64.powi(l) - 0.8f64.powi(l)).powi(2);
        let series: f64 = (0..400).map(term).sum();
        let [a, b] = [0.6, 0.8].map(|g| Lobes::one([g; NW]));
        assert!((a.difference(&b, 0) / series - 1.0).abs() < 1e-5);
    }

    #[test]
    fn one_wavelength_is_like_all() {
        let lobes = Lobes::new(&vec![vec![[0.4, 0.9], [0.6, -0.2]]; NW]);
        for cosine in [-1.0, 0.3, 0.999] {
            assert_eq!(lobes.at(cosine)[3], lobes.at_one(3, cosine));
        }
        assert!((lobes.asymmetry(0) - 0.24).abs() < 1e-6);
    }
}
