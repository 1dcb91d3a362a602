//! Draws follow their densities, densities follow the luminance, and sums over the sphere come out.
#![cfg(feature = "default-model")]

mod common;

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use common::random::Random;
use welkin::{
    BakedSky, Conditions, Error, Model, SOLAR_ANGULAR_RADIUS, Sky, SkySampler, SolarDisc,
};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());

fn sky(elevation: f64, altitude: f64) -> Sky {
    let conditions = Conditions {
        solar_elevation: elevation.to_radians(),
        solar_azimuth: 2.3,
        altitude,
        ..Conditions::default()
    };
    MODEL.sky(&conditions).unwrap()
}

fn disc(sky: &Sky) -> SolarDisc {
    MODEL.solar_disc(sky.conditions()).unwrap()
}

fn samplers(sky: &Sky) -> [SkySampler; 2] {
    let without = sky.bake_colour(BakedSky::TOLERANCE).unwrap().sampler();
    let with = without.clone().with_sun(&disc(sky));
    [without, with]
}

/// Bins of equal solid angle.
const BANDS: usize = 12;
const SECTORS: usize = 24;

fn bin([x, y, z]: [f32; 3]) -> usize {
    let band = ((0.5 + 0.5 * z) * BANDS as f32) as usize;
    let turn = y.atan2(x) / std::f32::consts::TAU;
    let sector = ((turn - turn.floor()) * SECTORS as f32) as usize;
    band.min(BANDS - 1) * SECTORS + sector.min(SECTORS - 1)
}

#[test]
fn counts_of_draws_pass_a_chi_square_test() {
    for (elevation, altitude) in [(30.0, 0.0), (2.0, 700.0), (-3.0, 0.0), (90.0, 2000.0)] {
        for sampler in samplers(&sky(elevation, altitude)) {
            let draws = 200_000;
            let mut random = Random(7);
            let mut counts = [0.0f64; BANDS * SECTORS];
            for _ in 0..draws {
                counts[bin(sampler.sample([random.single(), random.single()]).direction)] += 1.0;
            }
            let expected = expected(&sampler, &sky(elevation, altitude));
            let (mut statistic, mut bins) = (0.0, 0.0f64);
            for (count, share) in counts.into_iter().zip(expected) {
                let mean = share * f64::from(draws);
                if mean >= 5.0 {
                    statistic += (count - mean).powi(2) / mean;
                    bins += 1.0;
                }
            }
            // Wilson and Hilferty: about normal; 4 standard deviations.
            let freedom = bins - 1.0;
            let spread = 2.0 / (9.0 * freedom);
            let deviation = ((statistic / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
            assert!(
                deviation < 4.0,
                "{elevation} {altitude}: {statistic} for {freedom}"
            );
        }
    }
}

/// Probability of each bin: the density summed over a fine grid, the disc by itself.
fn expected(sampler: &SkySampler, sky: &Sky) -> Vec<f64> {
    let (rows, columns) = (200 * BANDS, 60 * SECTORS);
    let mut shares = vec![0.0; BANDS * SECTORS];
    let cell = 4.0 * PI / (rows * columns) as f64;
    let sun = sky.sun_direction();
    let disc = f64::from(sampler.pdf(sun).unwrap());
    let mut sum = 0.0;
    for row in 0..rows {
        let z = 2.0 * (row as f64 + 0.5) / rows as f64 - 1.0;
        let r = (1.0 - z * z).sqrt();
        for column in 0..columns {
            let (y, x) = (TAU * (column as f64 + 0.5) / columns as f64).sin_cos();
            let direction = [r * x, r * y, z].map(|v| v as f32);
            let chord: f32 = (0..3).map(|i| (direction[i] - sun[i]).powi(2)).sum();
            if f64::from(chord.sqrt()) < 1.5 * SOLAR_ANGULAR_RADIUS {
                continue;
            }
            let share = f64::from(sampler.pdf(direction).unwrap()) * cell;
            shares[bin(direction)] += share;
            sum += share;
        }
    }
    assert!(sum < 1.002 && (disc > 100.0 || sum > 0.998), "{sum}");
    // What the grid leaves out is the disc and its rim.
    let mut random = Random(3);
    let points = 100_000;
    for _ in 0..points {
        shares[bin(in_disc(sun, &mut random))] += (1.0 - sum) / f64::from(points);
    }
    shares
}

/// A point that is uniform in the disc: one of the ball's middle, seen from far away.
fn in_disc(sun: [f32; 3], random: &mut Random) -> [f32; 3] {
    loop {
        let point: [f32; 3] = std::array::from_fn(|_| 2.0 * random.single() - 1.0);
        let along: f32 = (0..3).map(|i| point[i] * sun[i]).sum();
        let across: [f32; 3] = std::array::from_fn(|i| point[i] - along * sun[i]);
        if along.abs() < 0.2 && across.iter().map(|v| v * v).sum::<f32>() <= 1.0 {
            return std::array::from_fn(|i| sun[i] + across[i] * SOLAR_ANGULAR_RADIUS as f32);
        }
    }
}

#[test]
fn densities_are_those_of_the_draws() {
    for sampler in samplers(&sky(12.0, 300.0)) {
        let mut random = Random(1);
        for _ in 0..2000 {
            let sample = sampler.sample([random.single(), random.single()]);
            let length: f32 = sample.direction.iter().map(|v| v * v).sum();
            assert!(
                (length - 1.0).abs() < 1e-5 && sample.pdf > 0.0,
                "{sample:?}"
            );
            assert_eq!(sampler.pdf(sample.direction).unwrap(), sample.pdf);
        }
        for corner in [
            [0.0, 0.0],
            [1.0, 1.0],
            [f32::NAN, -1.0],
            [2.0, f32::INFINITY],
        ] {
            assert!(sampler.sample(corner).pdf > 0.0);
        }
        assert!(matches!(
            sampler.pdf([0.0; 3]),
            Err(Error::Direction { .. })
        ));
    }
}

#[test]
fn densities_follow_the_luminance() {
    let sky = sky(40.0, 0.0);
    let colour = sky.bake_colour(BakedSky::TOLERANCE).unwrap();
    let sampler = colour.sampler();
    let mut random = Random(5);
    let weights: Vec<f64> = (0..20_000)
        .map(|_| {
            let sample = sampler.sample([random.single(), random.single()]);
            f64::from(colour.xyz(sample.direction).unwrap()[1] / sample.pdf)
        })
        .collect();
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    let variance = weights
        .iter()
        .map(|w| (w / mean - 1.0).powi(2))
        .sum::<f64>()
        / weights.len() as f64;
    // Even directions have 200 %.
    assert!(variance.sqrt() < 0.08, "{}", variance.sqrt());
}

#[test]
fn irradiance_agrees_with_draws() {
    for elevation in [60.0, 5.0] {
        let sky = sky(elevation, 100.0);
        let baked = sky.bake(BakedSky::TOLERANCE).unwrap();
        let [sampler, _] = samplers(&sky);
        for normal in [[0.0f32, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, -1.0, 0.0]] {
            let mut quadrature = vec![0.0; baked.wavelengths().len()];
            baked.irradiance(normal, &mut quadrature).unwrap();
            let mut sum = vec![0.0; quadrature.len()];
            let mut spectrum = sum.clone();
            let mut random = Random(11);
            let draws = 40_000;
            for _ in 0..draws {
                let sample = sampler.sample([random.single(), random.single()]);
                let cosine: f32 = (0..3).map(|i| normal[i] * sample.direction[i]).sum();
                baked.radiance(sample.direction, &mut spectrum).unwrap();
                for (sum, l) in sum.iter_mut().zip(&spectrum) {
                    *sum += l * cosine.max(0.0) / sample.pdf / draws as f32;
                }
            }
            for (got, expected) in quadrature.iter().zip(&sum) {
                assert!(
                    (got / expected - 1.0).abs() < 0.02,
                    "{normal:?} {got} {expected}"
                );
            }
        }
    }
}

#[test]
fn the_sun_above_the_air_gives_its_irradiance() {
    let sky = sky(50.0, 2000.0);
    let sun = disc(&sky);
    let n = sun.wavelengths().len();
    let (mut direct, mut across) = (vec![0.0; n], vec![0.0; n]);
    sun.irradiance(sun.direction(), &mut direct).unwrap();
    sun.irradiance([0.0, 0.0, 1.0], &mut across).unwrap();
    let mut centre = vec![0.0; n];
    sun.radiance(sun.direction(), &mut centre).unwrap();
    for (w, &wavelength) in sun.wavelengths().iter().enumerate() {
        let above = MODEL.head().solar_irradiance_at(wavelength) as f32;
        let transmittance = direct[w] / above;
        let least = if wavelength < 320.0 { 1e-3 } else { 0.2 };
        assert!(
            (least..0.99).contains(&transmittance),
            "{wavelength}: {transmittance}"
        );
        assert!((across[w] / direct[w] - 50f32.to_radians().sin()).abs() < 1e-3);
        // Limb darkening makes the centre brighter than the mean.
        let mean = direct[w] / sun.solid_angle() as f32;
        assert!((1.1..1.5).contains(&(centre[w] / mean)), "{wavelength}");
    }
    let red = direct[n - 1] / across[0];
    assert!(red > direct[0] / across[0]);
}

#[test]
fn the_disc_ends_at_its_limb_and_at_the_horizon() {
    let sun = disc(&sky(0.0, 0.0));
    let mut out = vec![f32::NAN; sun.wavelengths().len()];
    let at = |elevation: f64, azimuth: f64| {
        let (z, r) = elevation.sin_cos();
        [r * azimuth.cos(), r * azimuth.sin(), z].map(|v| v as f32)
    };
    for (elevation, azimuth, bright) in [
        (0.5, 0.0, true),
        (1.01, 0.0, false),
        (-0.1, 0.0, false),
        (0.1, 0.98, true),
        (0.1, 1.01, false),
    ] {
        sun.radiance(
            at(
                elevation * SOLAR_ANGULAR_RADIUS,
                2.3 + azimuth * SOLAR_ANGULAR_RADIUS,
            ),
            &mut out,
        )
        .unwrap();
        assert_eq!(
            out.iter().all(|&l| l > 0.0),
            bright,
            "{elevation} {azimuth}"
        );
        assert_eq!(
            out.iter().any(|&l| l > 0.0),
            bright,
            "{elevation} {azimuth}"
        );
    }
    let set = disc(&sky(-4.0, 0.0));
    assert!(!set.is_visible());
    set.radiance(set.direction(), &mut out).unwrap();
    assert!(out.iter().all(|&l| l == 0.0));
    assert!(matches!(
        sun.radiance([0.0; 3], &mut out),
        Err(Error::Direction { .. })
    ));
    assert!(matches!(
        sun.irradiance([0.0; 3], &mut out),
        Err(Error::Direction { .. })
    ));
    assert!(sun.radiance([1.0; 3], &mut out[1..]).is_err());
}
