//! Ways to the light of the air before a landscape, for comparison.

use welkin::{AerialPerspective, Conditions, Model, SkyDifference, xyz_to_linear_srgb};

use crate::failure::Result;

/// How the light of segments is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Method {
    /// Quadrature of the stored source function.
    #[default]
    Source,
    /// The paper's Eq. 2.
    Eq2,
    /// The same, averaged over ±0.25° of elevation near the horizon at low altitude.
    Blurred,
    /// Source and Eq. 2, weighted by the inverse of their expected variances.
    Blend,
}

type Point = [f64; 3];

/// Eq. 2 of Wilkie et al. 2021 in colour.
pub struct Difference<'a> {
    skies: SkyDifference<'a>,
    method: Method,
    xyz: &'a [[f64; 3]],
}

impl<'a> Difference<'a> {
    /// None where the method does without.
    pub fn new(model: &'a Model, conditions: &Conditions, method: Method) -> Result<Option<Self>> {
        if method == Method::Source {
            return Ok(None);
        }
        Ok(Some(Self {
            skies: model.sky_difference(conditions)?,
            method,
            xyz: &model.head().xyz,
        }))
    }

    /// Light that reaches `from`, linear sRGB, cd m⁻².
    pub fn light(&self, aerial: &AerialPerspective, from: Point, to: Point) -> Result<[f32; 3]> {
        let mut spectrum = vec![0.0; self.xyz.len()];
        match self.method {
            Method::Blurred => self.skies.blurred(from, to, &mut spectrum)?,
            Method::Blend => self.skies.blended(aerial, from, to, &mut spectrum)?,
            _ => self.skies.in_scattering(from, to, &mut spectrum)?,
        }
        let mut sum = [0.0; 3];
        for (weight, value) in self.xyz.iter().zip(spectrum) {
            sum = std::array::from_fn(|c| sum[c] + weight[c] * f64::from(value.max(0.0)));
        }
        Ok(xyz_to_linear_srgb(sum.map(|v| v as f32)))
    }
}
