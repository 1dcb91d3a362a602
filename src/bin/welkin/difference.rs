//! Other ways to the light of a finite segment, for comparison: Eq. 2 of Wilkie et al. 2021, the sky from its start less the
//! attenuated sky from its end, plain, blurred as their renderer does near the horizon, or blended with what `AerialPerspective` does.

use welkin::{
    AerialPerspective, Budget, Channels, Conditions, Interpolation, Model, PointQuery,
    xyz_to_linear_srgb,
};

use crate::failure::Result;
use crate::terrain::altitude;

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

/// Expected relative errors of the radiance of the sky and of the source.
const EXPECTED: [f32; 2] = [0.003, 0.006];
/// The paper's renderer blurs up to this altitude (m) …
const BLUR_ALTITUDE: f64 = 300.0;
/// … this close to the horizon (rad) …
const BLUR_ANGLE: f64 = 0.052_36;
/// … by tilts of up to ± this much (rad).
const BLUR_TILT: f64 = 0.004_363;

type Point = [f64; 3];

/// Skies wherever segments end.
pub struct Difference<'a> {
    general: PointQuery<'a>,
    method: Method,
    conditions: Conditions,
    altitudes: [f64; 2],
    suns: [f64; 2],
    radius: f64,
    sun: Point,
    irradiance: Vec<f32>,
    xyz: Vec<[f64; 3]>,
}

impl<'a> Difference<'a> {
    /// None where the method does without.
    pub fn new(
        model: &'a Model,
        aerial: &AerialPerspective,
        method: Method,
    ) -> Result<Option<Self>> {
        if method == Method::Source {
            return Ok(None);
        }
        let conditions = *aerial.conditions();
        let plan = model.plan(&Budget {
            altitude: model.altitude_range(),
            visibility: [conditions.visibility; 2],
            solar_elevation: model.solar_elevation_range(),
            tolerance: 1.0,
            channels: Channels::Spectral,
        })?;
        let head = model.head();
        let irradiance = head.wavelengths.iter();
        Ok(Some(Self {
            general: model
                .point_query(&plan)?
                .with_interpolation(Interpolation::Full),
            method,
            conditions,
            altitudes: model.altitude_range(),
            suns: model.solar_elevation_range(),
            radius: aerial.transmittance().planet().radius,
            sun: aerial.sun_direction(),
            irradiance: irradiance
                .map(|&l| head.solar_irradiance_at(l) as f32)
                .collect(),
            xyz: head.xyz.clone(),
        }))
    }

    /// Light that reaches `from`, linear sRGB, cd m⁻².
    pub fn light(&self, aerial: &AerialPerspective, from: Point, to: Point) -> Result<[f32; 3]> {
        let spectrum = match self.method {
            Method::Blurred => self.blurred(aerial, from, to)?,
            Method::Blend => self.blend(aerial, from, to)?,
            _ => self.plain(aerial, from, to)?,
        };
        let mut sum = [0.0; 3];
        for (weight, value) in self.xyz.iter().zip(spectrum) {
            sum = std::array::from_fn(|c| sum[c] + weight[c] * f64::from(value.max(0.0)));
        }
        Ok(xyz_to_linear_srgb(sum.map(|v| v as f32)))
    }

    fn plain(&self, aerial: &AerialPerspective, from: Point, to: Point) -> Result<Vec<f32>> {
        let [near, far] = self.terms(aerial, from, to)?;
        Ok(near.iter().zip(far).map(|(near, far)| near - far).collect())
    }

    fn blurred(&self, aerial: &AerialPerspective, from: Point, to: Point) -> Result<Vec<f32>> {
        let way: Point = std::array::from_fn(|k| to[k] - from[k]);
        let level = way[0].hypot(way[1]);
        let (elevation, length) = (way[2].atan2(level), level.hypot(way[2]));
        let low = altitude(self.radius, from) <= BLUR_ALTITUDE;
        if !low || elevation.abs() > BLUR_ANGLE || level == 0.0 {
            return self.plain(aerial, from, to);
        }
        const TILTS: i32 = 3;
        let mut sum = vec![0.0; self.xyz.len()];
        for i in -TILTS..=TILTS {
            let tilt = BLUR_TILT * f64::from(i) / f64::from(TILTS);
            let (z, r) = (elevation + tilt).sin_cos();
            let to = [
                from[0] + length * r * way[0] / level,
                from[1] + length * r * way[1] / level,
                from[2] + length * z,
            ];
            for (sum, value) in sum.iter_mut().zip(self.plain(aerial, from, to)?) {
                *sum += value.max(0.0) / (2 * TILTS + 1) as f32;
            }
        }
        Ok(sum)
    }

    fn blend(&self, aerial: &AerialPerspective, from: Point, to: Point) -> Result<Vec<f32>> {
        let [near, far] = self.terms(aerial, from, to)?;
        let (mut source, mut through) = (vec![0.0; near.len()], vec![0.0; near.len()]);
        aerial.in_scattering(from, to, &mut source, &mut through)?;
        let mix = |w: usize| {
            let (source, near, far) = (source[w] / self.irradiance[w], near[w], far[w]);
            let of_difference = EXPECTED[0].powi(2) * (near * near + far * far);
            let of_source = (EXPECTED[1] * source).powi(2);
            let share = of_source / (of_source + of_difference).max(f32::MIN_POSITIVE);
            source + share * (near - far - source)
        };
        Ok((0..near.len()).map(mix).collect())
    }

    /// Both terms of Eq. 2, per unit of solar irradiance.
    fn terms(&self, aerial: &AerialPerspective, from: Point, to: Point) -> Result<[Vec<f32>; 2]> {
        let way: Point = std::array::from_fn(|k| to[k] - from[k]);
        let near = self.sky(from, way)?;
        let mut far = self.sky(to, way)?;
        let mut through = vec![0.0; near.len()];
        aerial
            .transmittance()
            .transmittance(from, to, &mut through)?;
        for (far, through) in far.iter_mut().zip(through) {
            *far *= through;
        }
        Ok([near, far])
    }

    /// What an observer at `place` sees in a direction, both in the frame of the scene.
    fn sky(&self, place: Point, direction: Point) -> Result<Vec<f32>> {
        let from_centre = [place[0], place[1], place[2] + self.radius];
        let dot = |a: Point, b: Point| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let up = from_centre.map(|v| v / dot(from_centre, from_centre).sqrt());
        let sine = dot(self.sun, up).clamp(-1.0, 1.0);
        let level: Point = std::array::from_fn(|k| self.sun[k] - sine * up[k]);
        // Under a sun at the zenith any azimuth will do.
        let level = match dot(level, level) > 1e-20 {
            true => level,
            false => [up[2], 0.0, -up[0]],
        };
        let ahead = level.map(|v| v / dot(level, level).sqrt());
        let left = [
            up[1] * ahead[2] - up[2] * ahead[1],
            up[2] * ahead[0] - up[0] * ahead[2],
            up[0] * ahead[1] - up[1] * ahead[0],
        ];
        let conditions = Conditions {
            solar_elevation: sine.asin().clamp(self.suns[0], self.suns[1]),
            solar_azimuth: 0.0,
            altitude: altitude(self.radius, place).clamp(self.altitudes[0], self.altitudes[1]),
            ..self.conditions
        };
        let local = [ahead, left, up].map(|axis| dot(direction, axis) as f32);
        let mut out = vec![0.0; self.xyz.len()];
        self.general
            .relative_radiance(&conditions, local, &mut out)?;
        Ok(out)
    }
}
