//! From radiances at the wavelengths of a picture to linear sRGB.

use crate::atmosphere::table::Table;
use anyhow::Result;
use welkin::xyz_to_linear_srgb;

/// Luminous efficacy in the definition of XYZ, lm/W.
const EFFICACY: f64 = 683.002;
/// Visible light, nm.
const VISIBLE: std::ops::RangeInclusive<usize> = 380..=780;

macro_rules! table {
    ($name:literal) => {
        Table::parse($name, include_str!(concat!("../../data/", $name)))
    };
}

/// Weights of the wavelengths in X, Y and Z (cd m⁻² per unit of radiance over irradiance).
pub struct Colour {
    weights: Vec<[f64; 3]>,
    irradiance: Vec<f64>,
}

impl Colour {
    /// For radiance that is linear between `wavelengths` (nm) and constant beyond.
    pub fn new(wavelengths: &[f64]) -> Result<Self> {
        let sun = table!("solar_irradiance_1nm.csv")?.curve("wavelength_nm", "g173")?;
        let observer = table!("cie1931_2deg_1nm.csv")?;
        let matching = [
            observer.curve("wavelength_nm", "xbar")?,
            observer.curve("wavelength_nm", "ybar")?,
            observer.curve("wavelength_nm", "zbar")?,
        ];
        let mut weights = vec![[0.0; 3]; wavelengths.len()];
        for nm in VISIBLE {
            let nm = nm as f64;
            let light = matching
                .each_ref()
                .map(|m| EFFICACY * sun.at(nm) * m.at(nm));
            for (i, share) in shares(wavelengths, nm) {
                for (weight, light) in weights[i].iter_mut().zip(light) {
                    *weight += share * light;
                }
            }
        }
        Ok(Self {
            weights,
            irradiance: wavelengths.iter().map(|&nm| sun.at(nm)).collect(),
        })
    }

    /// Solar irradiance at the wavelengths, W m⁻² nm⁻¹.
    pub fn irradiance(&self) -> &[f64] {
        &self.irradiance
    }

    /// Luminance, cd m⁻².
    pub fn luminance(&self, radiance: &[f64]) -> f64 {
        let terms = self.weights.iter().zip(radiance);
        terms.map(|(weight, r)| weight[1] * r).sum()
    }

    /// Linear sRGB, cd m⁻² at white.
    pub fn rgb(&self, radiance: &[f64]) -> [f32; 3] {
        let mut xyz = [0.0; 3];
        for (weight, r) in self.weights.iter().zip(radiance) {
            for (sum, w) in xyz.iter_mut().zip(weight) {
                *sum += w * r;
            }
        }
        xyz_to_linear_srgb(xyz.map(|v| v as f32))
    }
}

/// Solar irradiance at wavelengths (nm), W m⁻² nm⁻¹.
pub fn irradiance(wavelengths: &[f64]) -> Result<Vec<f64>> {
    Ok(Colour::new(wavelengths)?.irradiance)
}

/// The nodes between which `x` lies, with their shares of it.
fn shares(nodes: &[f64], x: f64) -> [(usize, f64); 2] {
    let last = nodes.len() - 1;
    let i = nodes.partition_point(|&n| n <= x);
    if i == 0 {
        return [(0, 1.0), (0, 0.0)];
    }
    if i > last {
        return [(last, 1.0), (last, 0.0)];
    }
    let t = (x - nodes[i - 1]) / (nodes[i] - nodes[i - 1]);
    [(i - 1, 1.0 - t), (i, t)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A white surface in sunlight outside the air: 1/π of about 133 klx, a little yellower than D65.
    #[test]
    fn sunlight_is_nearly_white() {
        let colour = Colour::new(&[400.0, 500.0, 600.0, 700.0]).unwrap();
        let [r, g, b] = colour.rgb(&[std::f64::consts::FRAC_1_PI; 4]);
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        assert!((40_000.0..45_000.0).contains(&luminance), "{luminance}");
        assert!(
            (1.0..1.25).contains(&(r / g)) && (0.8..1.05).contains(&(b / g)),
            "{r} {g} {b}"
        );
    }
}
