//! The mean reflectance of the moon's disc: the model of the Robotic Lunar Observatory, H. H. Kieffer and T. C. Stone,
//! *The spectral irradiance of the Moon*, Astronomical Journal 129 (2005), equations 8 and 10 and table 4.
//!
//! Without libration, and the mean of a waxing and a waning moon: the terms of the coefficients b and c are not used.

#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// A band of the observatory: wavelength (nm), a₀..a₃ (powers of the phase angle in radians), d₁..d₃.
type Band = (f64, [f64; 4], [f64; 3]);

/// The 32 bands.
#[rustfmt::skip]
const BANDS: [Band; 32] = [
    (350.0, [-2.67511, -1.78539, 0.50612, -0.25578], [0.34185, 0.01441, -0.01602]),
    (355.1, [-2.71924, -1.74298, 0.44523, -0.23315], [0.33875, 0.01612, -0.00996]),
    (405.0, [-2.35754, -1.72134, 0.40337, -0.21105], [0.35235, -0.03818, -0.00006]),
    (412.3, [-2.34185, -1.74337, 0.42156, -0.21512], [0.36591, -0.05902, 0.00080]),
    (414.4, [-2.43367, -1.72184, 0.43600, -0.22675], [0.35558, -0.03247, -0.00503]),
    (441.6, [-2.31964, -1.72114, 0.37286, -0.19304], [0.37935, -0.09562, 0.00970]),
    (465.8, [-2.35085, -1.66538, 0.41802, -0.22541], [0.33450, -0.02546, -0.00484]),
    (475.0, [-2.28999, -1.63180, 0.36193, -0.20381], [0.33024, -0.03131, 0.00222]),
    (486.9, [-2.23351, -1.68573, 0.37632, -0.19877], [0.36590, -0.08945, 0.00678]),
    (544.0, [-2.13864, -1.60613, 0.27886, -0.16426], [0.37190, -0.10629, 0.01428]),
    (549.1, [-2.10782, -1.66736, 0.41697, -0.22026], [0.36814, -0.09815, 0.0]),
    (553.8, [-2.12504, -1.65970, 0.38409, -0.20655], [0.37206, -0.10745, 0.00347]),
    (665.1, [-1.88914, -1.58096, 0.30477, -0.17908], [0.37141, -0.13514, 0.01248]),
    (693.1, [-1.89410, -1.58509, 0.28080, -0.16427], [0.39109, -0.17048, 0.01754]),
    (703.6, [-1.92103, -1.60151, 0.36924, -0.20567], [0.37155, -0.13989, 0.00412]),
    (745.3, [-1.86896, -1.57522, 0.33712, -0.19415], [0.36888, -0.14828, 0.00958]),
    (763.7, [-1.85258, -1.47181, 0.14377, -0.11589], [0.39126, -0.16957, 0.03053]),
    (774.8, [-1.80271, -1.59357, 0.36351, -0.20326], [0.36908, -0.16182, 0.00830]),
    (865.3, [-1.74561, -1.58482, 0.35009, -0.19569], [0.39200, -0.18837, 0.00978]),
    (872.6, [-1.76779, -1.60345, 0.37974, -0.20625], [0.39354, -0.19360, 0.00568]),
    (882.0, [-1.73011, -1.61156, 0.36115, -0.19576], [0.40714, -0.21499, 0.01146]),
    (928.4, [-1.75981, -1.45395, 0.13780, -0.11254], [0.41900, -0.19963, 0.02940]),
    (939.3, [-1.76245, -1.49892, 0.07956, -0.07546], [0.47936, -0.29463, 0.04706]),
    (942.1, [-1.66473, -1.61875, 0.14630, -0.09216], [0.57275, -0.38204, 0.04902]),
    (1059.5, [-1.59323, -1.71358, 0.50599, -0.25178], [0.48160, -0.29486, 0.00116]),
    (1243.2, [-1.53594, -1.55214, 0.31479, -0.18178], [0.49040, -0.30970, 0.01237]),
    (1538.7, [-1.33802, -1.46208, 0.15784, -0.11712], [0.53831, -0.38432, 0.03473]),
    (1633.6, [-1.34567, -1.46057, 0.23813, -0.15494], [0.54393, -0.37182, 0.01845]),
    (1981.5, [-1.26203, -1.25138, -0.06569, -0.04005], [0.49099, -0.36092, 0.04707]),
    (2126.3, [-1.18946, -2.55069, 2.10026, -0.87285], [0.29239, -0.34784, -0.13444]),
    (2250.9, [-1.04232, -1.46809, 0.43817, -0.24632], [0.38154, -0.28937, -0.01110]),
    (2383.6, [-1.08403, -1.31032, 0.20323, -0.15863], [0.36134, -0.28408, 0.01010]),
];
/// p₁ and p₂, over which the brightness falls off near full moon, and p₃ and p₄, degrees.
const P: [f64; 4] = [4.06054, 12.8802, -30.5858, 16.7498];
/// Largest phase angle that the observatory saw, degrees.
const SEEN: f64 = 97.0;
/// Bands scatter by some per cent about this many terms in the logarithm of the wavelength.
const TERMS: usize = 4;

/// ln of the reflectance of the disc at one phase angle: a cubic in the logarithm of the wavelength through the bands,
/// by least squares. It is within 5 % (root mean square) of the bands.
#[derive(Clone, Copy, Debug)]
pub(super) struct DiscReflectance {
    /// Of the orthogonal polynomials.
    coefficient: [f64; TERMS],
    recurrence: [[f64; 2]; TERMS],
}

impl DiscReflectance {
    /// At a phase angle, rad.
    pub fn new(phase_angle: f64) -> Self {
        let degrees = phase_angle.to_degrees();
        let x = BANDS.map(|(wavelength, ..)| coordinate(wavelength));
        let values = BANDS.map(|band| logarithm(&band, degrees.min(SEEN)));
        let (mut before, mut here) = ([0.0; BANDS.len()], [1.0; BANDS.len()]);
        let (mut coefficient, mut recurrence) = ([0.0; TERMS], [[0.0; 2]; TERMS]);
        let mut size_before = 1.0;
        for k in 0..TERMS {
            let size = dot(&here, &here);
            coefficient[k] = dot(&here, &values) / size;
            let shifted = core::array::from_fn(|i| x[i] * here[i]);
            recurrence[k] = [dot(&here, &shifted) / size, size / size_before];
            let [middle, share] = recurrence[k];
            let next = core::array::from_fn(|i| (x[i] - middle) * here[i] - share * before[i]);
            (before, here, size_before) = (here, next, size);
        }
        coefficient[0] += visual(degrees) - visual(degrees.min(SEEN));
        Self {
            coefficient,
            recurrence,
        }
    }

    /// At a wavelength, nm.
    pub fn at(&self, wavelength: f64) -> f64 {
        let x = coordinate(wavelength);
        let (mut before, mut here, mut sum) = (0.0, 1.0, 0.0);
        for (coefficient, [middle, share]) in self.coefficient.iter().zip(&self.recurrence) {
            sum += coefficient * here;
            (before, here) = (here, (x - middle) * here - share * before);
        }
        sum.exp()
    }
}

fn coordinate(wavelength: f64) -> f64 {
    (wavelength * 1e-3).ln()
}

fn dot(a: &[f64; BANDS.len()], b: &[f64; BANDS.len()]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Equation 10.
fn logarithm((_, a, d): &Band, degrees: f64) -> f64 {
    let g = degrees.to_radians();
    let [p1, p2, p3, p4] = P;
    let powers = a[0] + g * (a[1] + g * (a[2] + g * a[3]));
    let surge = d[0] * (-degrees / p1).exp() + d[1] * (-degrees / p2).exp();
    powers + surge + d[2] * ((degrees - p3) / p4).cos()
}

/// ln of the visual brightness, for the crescents that the observatory did not see: K. Krisciunas and B. E. Schaefer,
/// *A model of the brightness of moonlight*, Publications of the Astronomical Society of the Pacific 103 (1991),
/// equation 9.
fn visual(degrees: f64) -> f64 {
    let magnitudes = 0.026 * degrees + 4e-9 * degrees.powi(4);
    -0.4 * core::f64::consts::LN_10 * magnitudes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cubic_follows_the_bands() {
        for degrees in [1.55f64, 7.0, 30.0, 60.0, 90.0, 97.0] {
            let smooth = DiscReflectance::new(degrees.to_radians());
            let off = |band: &Band| smooth.at(band.0).ln() - logarithm(band, degrees);
            let square = BANDS.iter().map(|b| off(b).powi(2)).sum::<f64>() / BANDS.len() as f64;
            assert!(square.sqrt() < 0.05, "{degrees}°: {}", square.sqrt());
            let most = BANDS.iter().map(|b| off(b).abs()).fold(0.0, f64::max);
            assert!(most < 0.13, "{degrees}°: {most}");
        }
    }

    /// The full moon reflects an eighth of the light, and the less, the narrower it is.
    #[test]
    fn brightness_falls_with_the_phase_angle() {
        let at = |degrees: f64| DiscReflectance::new(degrees.to_radians()).at(550.0);
        assert!((0.12..0.15).contains(&at(1.55)), "{}", at(1.55));
        // Half moon: a tenth to a twelfth of the full one (Kieffer and Stone, figure 8; Allen's law gives a twelfth).
        assert!((0.07..0.11).contains(&(at(90.0) / at(1.55))));
        let all: Vec<f64> = (0..=180).map(|d| at(f64::from(d))).collect();
        assert!(all.is_sorted_by(|a, b| a > b));
        // Redder than the sun.
        let moon = DiscReflectance::new(0.1);
        assert!(moon.at(700.0) > 1.4 * moon.at(400.0));
    }
}
