//! From a few wavelengths, or from red, green and blue, to CIE XYZ in cd m⁻².

use super::lanes::Lanes;
use super::spectra;

/// lm W⁻¹, as the library has it.
const EFFICACY: f64 = 683.002;
/// Wavelengths that are seen, nm.
const VISIBLE: std::ops::RangeInclusive<u32> = 360..=830;

/// What radiance per unit of solar irradiance is worth, per wavelength.
#[derive(Clone, Debug)]
pub struct ToXyz<const K: usize>([[f32; 3]; K]);

impl<const K: usize> ToXyz<K> {
    /// Of wavelengths (nm, increasing): between them radiance over irradiance is linear, beyond them constant, and the
    /// irradiance is that of the sun to the nanometre.
    pub fn spectral(wavelengths: [f64; K]) -> Self {
        let mut sums = [[0.0f64; 3]; K];
        for nm in VISIBLE.map(f64::from) {
            let light = EFFICACY * spectra::sun(nm);
            let next = wavelengths.partition_point(|&w| w <= nm).clamp(1, K - 1);
            let [a, b] = [wavelengths[next - 1], wavelengths[next]];
            let share = ((nm - a) / (b - a)).clamp(0.0, 1.0);
            let matching = spectra::matching(nm);
            for c in 0..3 {
                sums[next - 1][c] += (1.0 - share) * light * matching[c];
                sums[next][c] += share * light * matching[c];
            }
        }
        Self(sums.map(|row| row.map(|v| v as f32)))
    }

    /// XYZ of radiance per unit of solar irradiance (sr⁻¹).
    pub fn xyz(&self, ratio: Lanes<K>) -> [f32; 3] {
        let pairs = || self.0.iter().zip(ratio.0);
        std::array::from_fn(|c| pairs().map(|(row, v)| row[c] * v).sum())
    }
}

impl ToXyz<3> {
    /// As engines have it: red, green and blue are three channels of linear sRGB, and the sun has the colour that it
    /// has outside the air.
    pub fn rgb() -> Self {
        let whole: [f64; 3] = VISIBLE.map(f64::from).fold([0.0; 3], |sum, nm| {
            let (light, matching) = (EFFICACY * spectra::sun(nm), spectra::matching(nm));
            std::array::from_fn(|c| sum[c] + light * matching[c])
        });
        let sun = welkin::xyz_to_linear_srgb(whole.map(|v| v as f32));
        Self(std::array::from_fn(|k| {
            srgb_to_xyz(std::array::from_fn(|c| if c == k { sun[k] } else { 0.0 }))
        }))
    }
}

/// Linear sRGB to XYZ (IEC 61966-2-1).
pub fn srgb_to_xyz([r, g, b]: [f32; 3]) -> [f32; 3] {
    [
        0.412_390_8 * r + 0.357_584_3 * g + 0.180_480_8 * b,
        0.212_639 * r + 0.715_168_7 * g + 0.072_192_3 * b,
        0.019_330_8 * r + 0.119_194_8 * g + 0.950_532_2 * b,
    ]
}

/// Chromaticity x, y of the CIE 1931 observer.
pub fn chromaticity([x, y, z]: [f32; 3]) -> [f32; 2] {
    let sum = x + y + z;
    [x / sum, y / sum]
}

/// u′, v′ of CIE 1976, in which equal distances look more alike.
pub fn uniform_chromaticity([x, y, z]: [f32; 3]) -> [f32; 2] {
    let sum = x + 15.0 * y + 3.0 * z;
    [4.0 * x / sum, 9.0 * y / sum]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_see_the_same_sun() {
        let spectral = ToXyz::spectral([400.0, 500.0, 600.0, 700.0]).xyz(Lanes::splat(1.0));
        let rgb = ToXyz::rgb().xyz(Lanes::splat(1.0));
        for (a, b) in spectral.iter().zip(rgb) {
            assert!((a / b - 1.0).abs() < 1e-4, "{spectral:?} {rgb:?}");
        }
        // Illuminance of the sun outside the air, klx: 128 to 134 in the literature.
        assert!((128e3..136e3).contains(&spectral[1]), "{}", spectral[1]);
    }

    #[test]
    fn eight_wavelengths_see_what_all_see() {
        // A blue sky: Rayleigh scattering through ozone.
        let spectrum = |nm: f64| {
            (550.0 / nm).powi(4) * (-0.03 * spectra::ozone(nm) / spectra::ozone(550.0)).exp()
        };
        let exact = VISIBLE.map(f64::from).fold([0.0; 3], |sum, nm| {
            let light = EFFICACY * spectra::sun(nm) * spectrum(nm);
            let matching = spectra::matching(nm);
            std::array::from_fn(|c| sum[c] + light * matching[c])
        });
        let wavelengths = super::super::WAVELENGTHS;
        let got =
            ToXyz::spectral(wavelengths).xyz(Lanes(wavelengths.map(|nm| spectrum(nm) as f32)));
        for (got, exact) in got.iter().zip(exact) {
            assert!(
                (f64::from(*got) / exact - 1.0).abs() < 0.02,
                "{got} {exact}"
            );
        }
    }
}
