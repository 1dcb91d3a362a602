//! The disc of the sun: limb darkening, the air before it and the planet's edge.

mod limb;

use core::f64::consts::FRAC_PI_2;

use crate::error::{Error, Result};
use crate::geometry::Side;
use crate::math::{bound, finite};
use crate::sky::{MOST_WAVELENGTHS, Sky, check_length};

/// Angular radius of the sun at its mean distance, rad: 959.63″ (Neckel & Labs 1994).
pub const SUN_RADIUS: f64 = 4.652_4e-3;

/// Angles from the horizon at which the transmittance is kept, over the visible part of the disc.
const HEIGHTS: usize = 17;
/// Rings and points per ring of the quadrature over the disc.
const RINGS: usize = 8;
const POINTS: usize = 16;
const QUADRATURE: f64 = (RINGS * POINTS) as f64;

/// The disc of the sun as an observer sees it through the air, at the wavelengths of the model.
///
/// The radiance at the centre follows from the solar irradiance of the model, limb darkening from Neckel & Labs 1994.
/// Light is not refracted. The part of the disc below the geometric horizon is black. Queries do not allocate.
#[derive(Clone, Debug)]
pub struct SunDisc {
    direction: [f64; 3],
    wavelengths: Vec<f64>,
    /// Radiance without air over the profile's value, W m⁻² sr⁻¹ nm⁻¹.
    mean: Vec<f32>,
    profile: Vec<[f32; 6]>,
    /// XYZ per unit of radiance.
    xyz: Vec<[f32; 3]>,
    /// Lowest visible elevation of the disc and the step between heights, rad.
    lowest: f64,
    step: f64,
    /// ln T, `[height][wavelength]`; empty where the sun has set.
    transmittance: Vec<f32>,
}

impl SunDisc {
    /// The disc of the sun of a sky.
    pub fn new(sky: &Sky) -> Self {
        let conditions = sky.conditions();
        let solid_angle = core::f64::consts::TAU * (1.0 - SUN_RADIUS.cos());
        let wavelengths = sky.wavelengths().to_vec();
        let mean = |irradiance: f32| (f64::from(irradiance) / solid_angle) as f32;
        let top = (conditions.solar_elevation + SUN_RADIUS).min(FRAC_PI_2);
        let lowest = (conditions.solar_elevation - SUN_RADIUS).max(-sky.dip());
        let mut disc = Self {
            direction: conditions.sun_direction(),
            xyz: sky.xyz_weights(),
            mean: sky.irradiance::<1>().map(|[e]| mean(e)).collect(),
            profile: wavelengths.iter().map(|&l| limb::profile(l)).collect(),
            lowest,
            step: (top - lowest) / (HEIGHTS - 1) as f64,
            transmittance: Vec::new(),
            wavelengths,
        };
        if top > lowest {
            disc.look_up(sky);
        }
        disc
    }

    fn look_up(&mut self, sky: &Sky) {
        let altitude = sky.conditions().altitude;
        for i in 0..HEIGHTS {
            let angle = self.lowest + self.step * i as f64 + sky.dip();
            let ray = sky.planet().ray_beside_horizon(altitude, Side::Up, angle);
            let depths = sky.tables().optical_depths(&ray);
            let depths = depths.flatten().take(self.wavelengths.len());
            self.transmittance
                .extend(depths.map(|depth| -bound(depth, 0.0, f32::MAX)));
        }
    }

    /// Wavelengths of the results, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// Unit vector towards the centre.
    pub fn direction(&self) -> [f32; 3] {
        self.direction.map(|v| v as f32)
    }

    /// Whether any of the disc is above the geometric horizon.
    pub fn is_visible(&self) -> bool {
        !self.transmittance.is_empty()
    }

    /// Spectral radiance in W m⁻² sr⁻¹ nm⁻¹ of the disc alone, zero beside it and below the horizon. Add that of the
    /// sky in front of it.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite; [`Error::Length`] unless `out` has one element
    /// per wavelength.
    pub fn radiance(&self, direction: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length(out.len(), self.wavelengths.len())?;
        let unit = unit(direction).ok_or(Error::Direction { got: direction })?;
        self.radiance_along(unit, out);
        Ok(())
    }

    fn radiance_along(&self, unit: [f64; 3], out: &mut [f32]) {
        let distance = self.distance(unit);
        let elevation = unit[2].clamp(-1.0, 1.0).asin();
        if distance > 1.0 || elevation < self.lowest || !self.is_visible() {
            return out.fill(0.0);
        }
        let mu = (1.0 - distance * distance).max(0.0).sqrt() as f32;
        let u = ((elevation - self.lowest) / self.step).clamp(0.0, (HEIGHTS - 1) as f64);
        let i = (u as usize).min(HEIGHTS - 2);
        let t = (u - i as f64) as f32;
        let n = self.wavelengths.len();
        let (low, high) = self.transmittance[i * n..(i + 2) * n].split_at(n);
        for (w, out) in out.iter_mut().enumerate() {
            let transmittance = (low[w] + t * (high[w] - low[w])).exp();
            let light = self.mean[w] * limb::evaluate(&self.profile[w], mu) * transmittance;
            *out = bound(light, 0.0, f32::MAX);
        }
    }

    /// CIE 1931 XYZ of the disc alone; Y is the luminance in cd m⁻².
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn xyz(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        let mut radiance = [0.0; MOST_WAVELENGTHS];
        let radiance = &mut radiance[..self.wavelengths.len()];
        self.radiance(direction, radiance)?;
        let component =
            |c: usize| finite(radiance.iter().zip(&self.xyz).map(|(l, w)| l * w[c]).sum());
        Ok(core::array::from_fn(component))
    }

    /// Luminance times solid angle, cd sr m⁻².
    pub(crate) fn flux(&self) -> f64 {
        let luminance = |(point, _): ([f64; 3], f64)| {
            let xyz = self.xyz(point.map(|v| v as f32));
            xyz.map_or(0.0, |xyz| f64::from(xyz[1].max(0.0)))
        };
        self.solid_angle() * quadrature().map(|p| luminance(self.point(p))).sum::<f64>()
            / QUADRATURE
    }

    /// Whether the disc, visible or not, is in this direction.
    pub(crate) fn covers(&self, direction: [f32; 3]) -> bool {
        let unit = unit(direction);
        unit.is_some_and(|unit| self.distance(unit) <= 1.0)
    }

    /// Distance from the centre over the radius: the chord is exact where the cosine is not.
    fn distance(&self, unit: [f64; 3]) -> f64 {
        let chord: f64 = (0..3).map(|i| (unit[i] - self.direction[i]).powi(2)).sum();
        chord.sqrt() / (2.0 * (0.5 * SUN_RADIUS).sin())
    }

    /// Spectral irradiance in W m⁻² nm⁻¹ that the disc gives a plane with this normal, by quadrature over the disc.
    ///
    /// # Errors
    /// As [`SunDisc::radiance`].
    pub fn irradiance(&self, normal: [f32; 3], out: &mut [f32]) -> Result<()> {
        check_length(out.len(), self.wavelengths.len())?;
        let normal = unit(normal).ok_or(Error::Direction { got: normal })?;
        out.fill(0.0);
        let mut radiance = [0.0; MOST_WAVELENGTHS];
        let radiance = &mut radiance[..out.len()];
        for place in quadrature() {
            let (point, weight) = self.point(place);
            let cosine: f64 = (0..3).map(|i| point[i] * normal[i]).sum();
            let weight = (weight / QUADRATURE * cosine.max(0.0)) as f32;
            self.radiance_along(point, radiance);
            let pairs = out.iter_mut().zip(radiance.iter());
            pairs.for_each(|(sum, l)| *sum = (*sum + weight * l).min(f32::MAX));
        }
        Ok(())
    }

    /// Solid angle of the whole disc, sr.
    pub fn solid_angle(&self) -> f64 {
        core::f64::consts::TAU * (1.0 - SUN_RADIUS.cos())
    }

    /// Maps the unit square to the whole disc, uniformly in solid angle: the point and the solid angle of the disc.
    pub(crate) fn point(&self, [a, b]: [f64; 2]) -> ([f64; 3], f64) {
        let versine = a * (1.0 - SUN_RADIUS.cos());
        let (cosine, sine) = (1.0 - versine, (versine * (2.0 - versine)).sqrt());
        let [x, y, z] = self.direction;
        // Two vectors across the direction (Duff et al. 2017).
        let sign = 1f64.copysign(z);
        let (p, q) = (-1.0 / (sign + z), x * y * (-1.0 / (sign + z)));
        let first = [1.0 + sign * x * x * p, sign * q, -sign * x];
        let second = [q, sign + y * y * p, -y];
        let (v, u) = (core::f64::consts::TAU * b).sin_cos();
        let point = core::array::from_fn(|i| {
            cosine * self.direction[i] + sine * (u * first[i] + v * second[i])
        });
        (point, self.solid_angle())
    }
}

/// Points of the unit square, even over the disc.
fn quadrature() -> impl Iterator<Item = [f64; 2]> {
    (0..RINGS * POINTS).map(|i| {
        let (ring, point) = (i / POINTS, i % POINTS);
        let turned = point as f64 + 0.5 * (ring % 2) as f64;
        [(ring as f64 + 0.5) / RINGS as f64, turned / POINTS as f64]
    })
}

fn unit(vector: [f32; 3]) -> Option<[f64; 3]> {
    let vector = vector.map(f64::from);
    let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    (length > 0.0 && length.is_finite()).then(|| vector.map(|v| v / length))
}
