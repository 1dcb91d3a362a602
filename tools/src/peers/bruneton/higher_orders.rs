//! From the light of one order to that of the next.

use std::f64::consts::{PI, TAU};

use super::coordinates::{SIZE, between, lowest, place, radius, sun, view, view_place, with_sun};
use super::table::{RadianceTable, ScatteringTable};
use crate::peers::lanes::Lanes;
use crate::peers::medium::{Medium, rayleigh_phase};
use crate::peers::transmittance::{self, TransmittanceTable};

/// Directions of incoming light: zenith angles, and twice as many azimuths, as published.
const ZENITHS: usize = 16;
/// Suns for which the light on the ground is known.
const SUNS: usize = 64;

/// Irradiance of level ground, per unit of solar irradiance, over the cosine of the sun's zenith angle.
pub struct GroundLight<const K: usize>(Vec<Lanes<K>>);

impl<const K: usize> GroundLight<K> {
    fn new(light: impl Fn(f64) -> Lanes<K> + Sync) -> Self {
        let cosine = |i: usize| 2.0 * i as f64 / (SUNS - 1) as f64 - 1.0;
        Self((0..SUNS).map(|i| light(cosine(i))).collect())
    }

    fn at(&self, mu_sun: f64) -> Lanes<K> {
        let (i, share) = transmittance::place(0.5 * (mu_sun + 1.0), SUNS);
        self.0[i].mixed(self.0[i + 1], share)
    }
}

/// A direction of incoming light with its share of the sphere.
struct Incoming {
    direction: [f64; 3],
    solid_angle: f64,
}

fn sphere() -> impl Iterator<Item = Incoming> {
    let step = PI / ZENITHS as f64;
    (0..ZENITHS).flat_map(move |i| {
        let (sine, cosine) = ((i as f64 + 0.5) * step).sin_cos();
        (0..2 * ZENITHS).map(move |j| {
            let (y, x) = ((j as f64 + 0.5) * step).sin_cos();
            Incoming {
                direction: [sine * x, sine * y, cosine],
                solid_angle: step * step * sine,
            }
        })
    })
}

/// By the sun itself.
pub fn direct_irradiance<const K: usize>(
    medium: &Medium<K>,
    transmittance: &TransmittanceTable<K>,
) -> GroundLight<K> {
    let radius = medium.sun_radius;
    GroundLight::new(|mu_sun| {
        // The mean cosine of what is seen of the disc.
        let cosine = match mu_sun {
            m if m < -radius => 0.0,
            m if m >= radius => m,
            m => (m + radius).powi(2) / (4.0 * radius),
        };
        transmittance.to_top(medium.shell.bottom, mu_sun.max(0.0)) * cosine as f32
    })
}

/// By the sky of an order.
pub fn irradiance<const K: usize>(medium: &Medium<K>, sky: &RadianceTable<K>) -> GroundLight<K> {
    let r = medium.shell.bottom;
    GroundLight::new(|mu_sun| {
        let sine = (1.0 - mu_sun * mu_sun).sqrt();
        let mut sum = Lanes::default();
        for light in sphere().filter(|light| light.direction[2] > 0.0) {
            let mu = light.direction[2];
            let nu = light.direction[0] * sine + mu * mu_sun;
            let place = place(&medium.shell, r, mu, mu_sun, nu, false);
            sum += sky.table.at(&place) * (mu * light.solid_angle) as f32;
        }
        sum
    })
}

/// What every point scatters of the light of an order and of the ground, per metre.
pub fn source<const K: usize>(
    medium: &Medium<K>,
    transmittance: &TransmittanceTable<K>,
    last: &RadianceTable<K>,
    ground: &GroundLight<K>,
) -> ScatteringTable<K> {
    ScatteringTable::by_layers(|i| {
        let r = radius(&medium.shell, i);
        let [molecules, particles, _] = medium.densities(medium.altitude(r));
        let coefficients = [
            medium.rayleigh * molecules,
            medium.mie_scattering * particles,
        ];
        let mut values = vec![Lanes::default(); SIZE[1] * SIZE[2] * SIZE[3]];
        for k in 0..SIZE[2] {
            let mu_sun = sun(&medium.shell, k);
            let light = Light::new(medium, transmittance, last, ground, [r, mu_sun]);
            for j in 0..SIZE[1] {
                let (mu, _) = view(&medium.shell, r, j);
                for l in 0..SIZE[3] {
                    let out = outgoing(mu, mu_sun, between(l, mu, mu_sun));
                    values[(j * SIZE[2] + k) * SIZE[3] + l] =
                        light.scattered(out, medium, &coefficients);
                }
            }
        }
        values
    })
}

/// The unit vector of a view, where the sun is in the plane of x and z.
fn outgoing(mu: f64, mu_sun: f64, nu: f64) -> [f32; 3] {
    let sine = (1.0 - mu_sun * mu_sun).sqrt();
    let x = match sine > 0.0 {
        true => (nu - mu * mu_sun) / sine,
        false => (1.0 - mu * mu).sqrt(),
    };
    [x, (1.0 - x * x - mu * mu).max(0.0).sqrt(), mu].map(|v| v as f32)
}

/// Light from all directions at a point, times their solid angles.
struct Light<const K: usize>(Vec<([f32; 3], Lanes<K>)>);

impl<const K: usize> Light<K> {
    fn new(
        medium: &Medium<K>,
        transmittance: &TransmittanceTable<K>,
        last: &RadianceTable<K>,
        ground: &GroundLight<K>,
        [r, mu_sun]: [f64; 2],
    ) -> Self {
        let shell = medium.shell;
        let sine = (1.0 - mu_sun * mu_sun).sqrt();
        let from = |Incoming {
                        direction,
                        solid_angle,
                    }| {
            let [x, _, mu]: [f64; 3] = direction;
            let nu = x * sine + mu * mu_sun;
            let down = shell.meets_ground(r, mu);
            let place = place(&shell, r, mu, mu_sun, nu, down);
            let mut radiance = last.table.at(&place);
            if down && medium.albedo > 0.0 {
                let distance = shell.to_ground(r, mu);
                let sun_there = ((r * mu_sun + distance * nu) / shell.bottom).clamp(-1.0, 1.0);
                let reflected = ground.at(sun_there) * (medium.albedo / PI as f32);
                radiance += transmittance.between(r, mu, distance, true) * reflected;
            }
            let direction = direction.map(|v| v as f32);
            (direction, radiance * solid_angle as f32)
        };
        debug_assert!(
            (sphere().map(|d| d.solid_angle).sum::<f64>() / (2.0 * TAU) - 1.0).abs() < 0.01
        );
        Self(sphere().map(from).collect())
    }

    fn scattered(
        &self,
        out: [f32; 3],
        medium: &Medium<K>,
        [molecules, particles]: &[Lanes<K>; 2],
    ) -> Lanes<K> {
        let [mut rayleigh, mut mie] = [Lanes::default(); 2];
        for (direction, light) in &self.0 {
            let cosine = (0..3).map(|i| out[i] * direction[i]).sum::<f32>();
            rayleigh += *light * rayleigh_phase(cosine);
            mie += *light * medium.mie_phase(cosine);
        }
        rayleigh * *molecules + mie * *particles
    }
}

/// Radiance of an order: its source along every line of sight.
pub fn gathered<const K: usize>(
    medium: &Medium<K>,
    transmittance: &TransmittanceTable<K>,
    source: &ScatteringTable<K>,
    steps: usize,
) -> RadianceTable<K> {
    let shell = medium.shell;
    let lowest = lowest(&shell);
    let table = ScatteringTable::by_layers(|i| {
        let r = radius(&shell, i);
        let mut values = Vec::with_capacity(SIZE[1] * SIZE[2] * SIZE[3]);
        for j in 0..SIZE[1] {
            let (mu, ground) = view(&shell, r, j);
            let step = shell.to_end(r, mu, ground) / steps as f64;
            let stops: Vec<_> = (0..=steps)
                .map(|s| {
                    let distance = step * s as f64;
                    let weight = step * if s == 0 || s == steps { 0.5 } else { 1.0 };
                    let through = transmittance.between(r, mu, distance, ground);
                    let (there, mu_there) = shell.advanced(r, mu, distance);
                    let view = view_place(&shell, there, mu_there, ground);
                    (distance, there, view, through * weight as f32)
                })
                .collect();
            for k in 0..SIZE[2] {
                let mu_sun = sun(&shell, k);
                for l in 0..SIZE[3] {
                    let nu = between(l, mu, mu_sun);
                    let mut sum = Lanes::default();
                    for &(distance, there, view, through) in &stops {
                        let sun_there = ((r * mu_sun + distance * nu) / there).clamp(-1.0, 1.0);
                        let place = with_sun(&shell, lowest, view, sun_there, nu);
                        sum += source.at(&place) * through;
                    }
                    values.push(sum);
                }
            }
        }
        values
    });
    RadianceTable::new(medium, table)
}
