//! Traced radiance at random, held-out conditions, to judge a fit by.

use crate::successive_orders::scattered_source::Sun;
use crate::successive_orders::{Fields, Gatherer, LightField, NW, first_order, rayleigh_phase};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::PI;
use welkin::Conditions;
use welkin::geometry::Side;

/// One held-out direction under one sun.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Observer altitude, m.
    pub altitude: f64,
    /// Elevation of the view direction, rad.
    pub view_elevation: f64,
    /// Azimuth relative to the sun, rad.
    pub view_azimuth: f64,
    /// Solar elevation, rad.
    pub solar_elevation: f64,
    /// Ground albedo.
    pub albedo: f64,
    /// Traced radiance per unit of solar irradiance, sr⁻¹.
    pub radiance: [f64; NW],
    /// Its second and third Stokes components against (e1, e2): e1 in the vertical plane of the ray, e2 horizontal.
    pub polarisation: [[f64; NW]; 2],
}

/// Random samples at `altitude`: `views` directions, uniform over the sphere, each under the same `suns` random suns
/// and albedos.
///
/// A third of the solar elevations are uniform in all `range` (rad), a third in as much of −12..12° as that has, a third
/// of −6..0.5°, where the edge of the Earth's shadow is seen. Sun-major.
pub fn truth(
    gatherer: &Gatherer,
    light: &LightField,
    (altitude, range): (f64, [f64; 2]),
    counts: [usize; 2],
    seed: u64,
) -> Vec<Sample> {
    let [views, suns] = counts;
    let skies = skies(altitude, range, suns, seed);
    let rows: Vec<Vec<Sample>> = (0..views)
        .into_par_iter()
        .map(|i| {
            view(
                gatherer,
                light,
                &skies,
                seed.wrapping_add(7919 * (i as u64 + 1)),
            )
        })
        .collect();
    (0..suns)
        .flat_map(|k| rows.iter().map(move |row| row[k]))
        .collect()
}

/// Random samples at `altitude` about the edge of the Earth's shadow: suns uniform in −12..−0.5°, directions away from
/// them within 4° of where the shadow of the horizon would stand far away, or below.
pub fn shadow_edge(
    gatherer: &Gatherer,
    light: &LightField,
    altitude: f64,
    count: usize,
    seed: u64,
) -> Vec<Sample> {
    let lowest = -gatherer.planet().dip(altitude) - 1f64.to_radians();
    let one = |i: usize| {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_add(104_729 * (i as u64 + 1)));
        let solar_elevation = (-12.0 + 11.5 * uniform(&mut rng)).to_radians();
        let view_azimuth = PI * (0.5 + 0.5 * uniform(&mut rng));
        let edge = solar_elevation * view_azimuth.cos();
        let off = (8.0 * uniform(&mut rng) - 4.0).to_radians();
        let mut sample = [Sample {
            altitude,
            view_elevation: (edge + off).max(lowest),
            view_azimuth,
            solar_elevation,
            albedo: uniform(&mut rng),
            radiance: [0.0; NW],
            polarisation: [[0.0; NW]; 2],
        }];
        fill(gatherer, light, &mut sample);
        sample
    };
    (0..count).into_par_iter().flat_map_iter(one).collect()
}

fn uniform(rng: &mut Pcg64Mcg) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn skies(altitude: f64, range: [f64; 2], count: usize, seed: u64) -> Vec<Sample> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    (0..count)
        .map(|k| {
            let wanted: [f64; 2] = [[-12.0, 90.0], [-12.0, 12.0], [-6.0, 0.5]][k % 3];
            let inside = wanted.map(|e| e.to_radians().clamp(range[0], range[1]));
            let [lowest, highest] = if inside[0] < inside[1] { inside } else { range };
            Sample {
                altitude,
                view_elevation: 0.0,
                view_azimuth: 0.0,
                solar_elevation: lowest + uniform(&mut rng) * (highest - lowest),
                albedo: uniform(&mut rng),
                radiance: [0.0; NW],
                polarisation: [[0.0; NW]; 2],
            }
        })
        .collect()
}

fn view(gatherer: &Gatherer, light: &LightField, skies: &[Sample], seed: u64) -> Vec<Sample> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mu = 2.0 * uniform(&mut rng) - 1.0;
    let mut samples = skies.to_vec();
    for sample in &mut samples {
        sample.view_elevation = mu.asin();
        sample.view_azimuth = PI * uniform(&mut rng);
    }
    fill(gatherer, light, &mut samples);
    samples
}

/// Traces samples of one altitude and one elevation of the view.
fn fill(gatherer: &Gatherer, light: &LightField, samples: &mut [Sample]) {
    let Some(&Sample {
        altitude,
        view_elevation,
        ..
    }) = samples.first()
    else {
        return;
    };
    let mu = view_elevation.sin();
    let side = gatherer.planet().ray(altitude, view_elevation).side;
    if side == Side::Down && altitude == 0.0 {
        return;
    }
    let suns: Vec<Sun> = samples.iter().map(sun).collect();
    let path = gatherer.path(altitude, view_elevation, side);
    let fields = gatherer.fields(&path, mu, &suns);
    for ((sample, fields), sun) in samples.iter_mut().zip(&fields).zip(&suns) {
        let cosine = sun.cosine(mu);
        sample.radiance = total(gatherer, light, fields, cosine, sample.albedo);
        sample.polarisation = polarisation(gatherer, light, fields, (mu, sun), sample.albedo);
    }
}

fn sun(sample: &Sample) -> Sun {
    let (se, ce) = sample.solar_elevation.sin_cos();
    let (sa, ca) = sample.view_azimuth.sin_cos();
    Sun {
        elevation: (ce, se),
        azimuth: (ca, sa),
    }
}

/// Radiance from its fields, for a scattering cosine and a ground albedo.
pub fn total(
    gatherer: &Gatherer,
    light: &LightField,
    fields: &Fields,
    cosine: f32,
    albedo: f64,
) -> [f64; NW] {
    let rayleigh = rayleigh_phase(gatherer.polarising(), cosine);
    let fine = gatherer.phase(0).at(cosine);
    let coarse = gatherer.phase(1).at(cosine);
    std::array::from_fn(|w| {
        let ground = albedo / (1.0 - albedo * f64::from(light.spherical_albedo[w]));
        f64::from(
            fields.rayleigh[w] * rayleigh[w]
                + fields.fine[w] * fine[w]
                + fields.coarse[w] * coarse[w],
        ) + f64::from(fields.multiple[0][w])
            + ground * f64::from(fields.ground[0][w])
    })
}

/// Q and U from the fields, for the zenith cosine of the ray and a sun.
fn polarisation(
    gatherer: &Gatherer,
    light: &LightField,
    fields: &Fields,
    (mu, sun): (f64, &Sun),
    albedo: f64,
) -> [[f64; NW]; 2] {
    let single = first_order::polarisation(gatherer.polarising(), &fields.rayleigh, mu, sun);
    std::array::from_fn(|s| {
        std::array::from_fn(|w| {
            let ground = albedo / (1.0 - albedo * f64::from(light.spherical_albedo[w]));
            f64::from(single[s][w] + fields.multiple[s + 1][w])
                + ground * f64::from(fields.ground[s + 1][w])
        })
    })
}

/// Length of a sample in a file.
const SAMPLE: usize = 5 + 3 * NW;

impl Sample {
    /// As numbers for a file.
    pub fn to_values(&self) -> [f32; SAMPLE] {
        let head = [
            self.altitude,
            self.view_elevation,
            self.view_azimuth,
            self.solar_elevation,
            self.albedo,
        ];
        let polarisation = self.polarisation.into_iter().flatten();
        let mut values = head.into_iter().chain(self.radiance).chain(polarisation);
        std::array::from_fn(|_| values.next().unwrap_or(0.0) as f32)
    }

    /// The inverse of [`Sample::to_values`] for a row of samples.
    pub fn from_values(values: &[f32]) -> Vec<Self> {
        values
            .as_chunks::<SAMPLE>()
            .0
            .iter()
            .map(|v| Self::from_row(&v.map(f64::from)))
            .collect()
    }

    fn from_row(v: &[f64; SAMPLE]) -> Self {
        Self {
            altitude: v[0],
            view_elevation: v[1],
            view_azimuth: v[2],
            solar_elevation: v[3],
            albedo: v[4],
            radiance: std::array::from_fn(|w| v[5 + w]),
            polarisation: std::array::from_fn(|s| std::array::from_fn(|w| v[5 + (s + 1) * NW + w])),
        }
    }

    /// The conditions of the sample at a visibility (m), with the sun's azimuth along +x.
    pub fn conditions(&self, visibility: f64) -> Conditions {
        Conditions {
            solar_elevation: self.solar_elevation,
            solar_azimuth: 0.0,
            visibility,
            albedo: self.albedo,
            altitude: self.altitude,
        }
    }

    /// Angle to the sun, rad.
    pub fn to_sun(&self) -> f64 {
        let [along, across] = self.sun_across();
        let (sv, cv) = self.view_elevation.sin_cos();
        let (ss, cs) = self.solar_elevation.sin_cos();
        along
            .hypot(across)
            .atan2(cv * cs * self.view_azimuth.cos() + sv * ss)
    }

    /// Angle from the vertical e1 towards e2 to the normal of the plane of view and sun, rad.
    pub fn sun_aligned(&self) -> f64 {
        let [along, across] = self.sun_across();
        along.atan2(-across)
    }

    /// The sun's direction along e1 and e2.
    fn sun_across(&self) -> [f64; 2] {
        let (sv, cv) = self.view_elevation.sin_cos();
        let (ss, cs) = self.solar_elevation.sin_cos();
        let (sa, ca) = self.view_azimuth.sin_cos();
        [cv * ss - sv * cs * ca, cs * sa]
    }

    /// View direction in the frame whose +x points towards the sun.
    pub fn direction(&self) -> [f32; 3] {
        let (se, ce) = self.view_elevation.sin_cos();
        let (sa, ca) = self.view_azimuth.sin_cos();
        [(ce * ca) as f32, (ce * sa) as f32, se as f32]
    }
}
