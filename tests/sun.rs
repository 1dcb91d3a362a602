//! The sun's disc: one physics with transmittance and aerial perspective, light of what is visible, draws that survive
//! rounding.
#![cfg(feature = "default-model")]

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::LazyLock;

use common::random::Random;
use common::unit;
use welkin::format::{Payload, encode, unpack};
use welkin::{BakedSky, Conditions, Error, Model, Part, SOLAR_ANGULAR_RADIUS, SolarDisc};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());

/// Wavelengths of the embedded model: bytes 40 and 41 of a file.
const N: usize =
    u16::from_le_bytes([welkin::DEFAULT_MODEL[40], welkin::DEFAULT_MODEL[41]]) as usize;

fn dip(altitude: f64) -> f64 {
    MODEL.head().planet.dip(altitude)
}

fn narrow(vector: [f64; 3]) -> [f32; 3] {
    vector.map(|v| v as f32)
}

/// Radiance at the centre of the disc outside the air: what a very high sun leaves after its transmittance.
fn outside() -> [f64; N] {
    let conditions = Conditions {
        solar_elevation: FRAC_PI_2,
        altitude: 15_000.0,
        ..Conditions::default()
    };
    let (mut light, mut through) = ([0.0; N], [0.0; N]);
    let sun = MODEL.solar_disc(&conditions).unwrap();
    sun.radiance(sun.direction(), &mut light).unwrap();
    let air = MODEL.transmittance(conditions.visibility).unwrap();
    air.transmittance_to_space([0.0, 0.0, 15_000.0], [0.0, 0.0, 1.0], &mut through)
        .unwrap();
    std::array::from_fn(|w| f64::from(light[w]) / f64::from(through[w]))
}

/// Median, p95, p99 and maximum.
fn quantiles(errors: &mut [f64]) -> [f64; 4] {
    errors.sort_by(f64::total_cmp);
    [0.5, 0.95, 0.99, 1.0].map(|p| errors[(p * (errors.len() - 1) as f64) as usize])
}

fn row(what: &str, errors: &mut [f64]) -> f64 {
    let [median, p95, p99, max] = quantiles(errors).map(|e| 100.0 * e);
    println!("| {what} | {median:.4} % | {p95:.3} % | {p99:.3} % | {max:.2} % |");
    max / 100.0
}

/// Half of the suns are within 5° of the geometric horizon, a tenth within 0.1°.
fn random_conditions(random: &mut Random) -> Conditions {
    let altitude = 15_000.0 * random.share().powi(2);
    let above = match random.share() {
        x if x < 0.1 => random.between(0.0, 0.1),
        x if x < 0.5 => random.between(0.0, 5.0),
        _ => random.between(0.0, 90.0),
    };
    Conditions {
        solar_elevation: (above.to_radians() - dip(altitude))
            .clamp(MODEL.solar_elevation_range()[0], FRAC_PI_2),
        solar_azimuth: random.between(-PI, PI),
        visibility: random.between(20e3, 131.8e3),
        albedo: random.share(),
        altitude,
    }
}

/// Run with --nocapture for the table.
#[test]
fn sun_transmittance_and_aerial_perspective_are_one_physics() {
    let outside = outside();
    let mut random = Random(5);
    let [mut air_errors, mut aerial_errors] = [(); 2].map(|()| vec![]);
    for i in 0..1500 {
        let mut conditions = random_conditions(&mut random);
        if i >= 1000 {
            // Grazing rays cross the edges of layers.
            conditions.altitude = random.between(10e3, 15e3);
            let above = random.between(0.1, 0.6).to_radians();
            conditions.solar_elevation = above - dip(conditions.altitude);
        }
        let from = [0.0, 0.0, conditions.altitude];
        let sun = MODEL.solar_disc(&conditions).unwrap();
        let towards = sun.direction().map(f64::from);
        let [mut light, mut through, mut aerial_through] = [[0.0; N]; 3];
        sun.radiance(sun.direction(), &mut light).unwrap();
        let air = MODEL.transmittance(conditions.visibility).unwrap();
        air.transmittance_to_space(from, towards, &mut through)
            .unwrap();
        let off = |light: f32, w: usize| {
            (f64::from(light) / (outside[w] * f64::from(through[w])) - 1.0).abs()
        };
        if through.iter().all(|&t| t == 0.0) {
            // Rounding of the direction put the centre of the disc below the horizon.
            assert!(light.iter().all(|&l| l == 0.0), "{conditions:?}");
            continue;
        }
        let seen = (0..N).filter(|&w| through[w] > 1e-30);
        air_errors.extend(seen.clone().map(|w| off(light[w], w)));
        if i % 10 == 0 {
            let aerial = MODEL.aerial_perspective(&conditions).unwrap();
            let mut scattered = [0.0; N];
            aerial
                .to_end(from, towards, &mut scattered, &mut aerial_through)
                .unwrap();
            aerial_errors.extend(seen.map(|w| {
                (f64::from(light[w]) / (outside[w] * f64::from(aerial_through[w])) - 1.0).abs()
            }));
        }
    }
    println!("| sun's disc against | median | p95 | p99 | max |\n| --- | --- | --- | --- | --- |");
    let worst = row("transmittance", &mut air_errors);
    let worst = worst.max(row(
        "transmittance of aerial perspective",
        &mut aerial_errors,
    ));
    assert!(worst < 0.005, "{worst}");
}

/// All over the disc, not only at its centre: radiance follows the transmittance in that direction.
#[test]
fn the_disc_dims_downwards_as_the_air_says() {
    let mut random = Random(9);
    for _ in 0..200 {
        let mut conditions = random_conditions(&mut random);
        conditions.solar_elevation = conditions.solar_elevation.min(0.1);
        let sun = MODEL.solar_disc(&conditions).unwrap();
        let air = MODEL.transmittance(conditions.visibility).unwrap();
        // Mirrored about the centre: as far from it, so as bright without air.
        let turn = random.share() * TAU;
        let (y, x) = turn.sin_cos();
        let radius = 0.98 * SOLAR_ANGULAR_RADIUS * random.share().sqrt();
        let at = |sign: f64| {
            let elevation = conditions.solar_elevation + sign * radius * y;
            let across = sign * radius * x / conditions.solar_elevation.cos();
            narrow(unit(elevation, conditions.solar_azimuth + across))
        };
        let [mut low, mut high] = [[0.0; N]; 2];
        let [mut through_low, mut through_high] = [[0.0; N]; 2];
        let from = [0.0, 0.0, conditions.altitude];
        for (sign, light, through) in [
            (1.0, &mut high, &mut through_high),
            (-1.0, &mut low, &mut through_low),
        ] {
            sun.radiance(at(sign), light).unwrap();
            air.transmittance_to_space(from, at(sign).map(f64::from), through)
                .unwrap();
        }
        for w in 0..N {
            let [high, low] = [high[w], low[w]].map(f64::from);
            let [clear, dim] = [through_high[w], through_low[w]].map(f64::from);
            if clear > 1e-20 && dim > 1e-20 && low > 0.0 && high > 0.0 {
                let off = (high * dim) / (low * clear) - 1.0;
                assert!(off.abs() < 0.005, "{conditions:?} {w} {off}");
            }
        }
    }
}

#[test]
fn the_sun_one_degree_high() {
    let conditions = Conditions {
        solar_elevation: 1f64.to_radians(),
        ..Conditions::default()
    };
    let at = |model: &Model| {
        let sun = model.solar_disc(&conditions).unwrap();
        sun.radiance_at(sun.direction(), 560.0).unwrap()
    };
    // 32.11 for a disc with a radius of 959.63″ instead of 0.2667°.
    assert!((at(&MODEL) / 32.08 - 1.0).abs() < 2e-3, "{}", at(&MODEL));
}

#[test]
fn what_a_file_must_have_for_the_sun() {
    let (head, mut chunks) = unpack(welkin::DEFAULT_MODEL).unwrap();
    chunks.retain(|c| !matches!(c.payload, Payload::Transmittance(_) | Payload::Column(_)));
    let model = Model::from_bytes(encode(&head, &chunks).unwrap()).unwrap();
    let missing = model.solar_disc(&Conditions::default());
    assert!(matches!(missing, Err(Error::MissingChunk { .. })));
    let below = Conditions {
        solar_elevation: -0.05,
        ..Conditions::default()
    };
    assert!(!model.solar_disc(&below).unwrap().is_visible());
    let outside = Conditions {
        altitude: 101_000.0,
        ..below
    };
    assert!(matches!(
        MODEL.solar_disc(&outside),
        Err(Error::OutOfRange { .. })
    ));
}

/// Strips of equal elevation, in closed form on the sphere, with dense midpoints.
fn dense(sun: &SolarDisc, conditions: &Conditions, normal: [f64; 3]) -> [f64; N] {
    const STRIPS: usize = 3000;
    const ACROSS: usize = 64;
    let e = conditions.solar_elevation;
    let low = (e - SOLAR_ANGULAR_RADIUS).max(-dip(conditions.altitude));
    let high = e + SOLAR_ANGULAR_RADIUS;
    let mut sums = [0.0; N];
    let mut light = [0.0; N];
    for i in 0..STRIPS {
        let turn = PI * ((i as f64 + 0.5) / STRIPS as f64 - 0.5);
        let elevation = 0.5 * (low + high) + 0.5 * (high - low) * turn.sin();
        let height = 0.5 * (high - low) * turn.cos() * PI / STRIPS as f64;
        let square = |angle: f64| (0.5 * angle).sin().powi(2);
        let share =
            (square(SOLAR_ANGULAR_RADIUS) - square(elevation - e)) / (elevation.cos() * e.cos());
        let half = 2.0 * share.max(0.0).sqrt().asin();
        for j in 0..ACROSS {
            let turn = PI * ((j as f64 + 0.5) / ACROSS as f64 - 0.5);
            let azimuth = conditions.solar_azimuth + half * turn.sin();
            let width = half * turn.cos() * PI / ACROSS as f64;
            let point = unit(elevation, azimuth);
            let cosine: f64 = (0..3).map(|k| point[k] * normal[k]).sum();
            sun.radiance(narrow(point), &mut light).unwrap();
            let weight = cosine.max(0.0) * height * width * elevation.cos();
            for (sum, light) in sums.iter_mut().zip(light) {
                *sum += weight * f64::from(light);
            }
        }
    }
    sums
}

fn irradiance(sun: &SolarDisc, normal: [f64; 3]) -> [f64; N] {
    let mut out = [0.0; N];
    sun.irradiance(narrow(normal), &mut out).unwrap();
    out.map(f64::from)
}

/// Heights of the centre above the geometric horizon in radii; from −0.935 down less than 1 % of the disc is visible.
const RISES: [f64; 9] = [20.0, 3.0, 1.0, 0.999, 0.4, 0.0, -0.5, -0.8, -0.93];

#[test]
fn irradiance_is_that_of_the_visible_part() {
    let mut errors = vec![];
    for altitude in [0.0, 3.0, 1800.0, 15_000.0] {
        for visibility in [20e3, 59.4e3] {
            for rise in RISES {
                let conditions = Conditions {
                    solar_elevation: (rise * SOLAR_ANGULAR_RADIUS - dip(altitude)).max(-0.0733),
                    solar_azimuth: 2.3,
                    altitude,
                    visibility,
                    ..Conditions::default()
                };
                let sun = MODEL.solar_disc(&conditions).unwrap();
                for normal in [
                    conditions.sun_direction(),
                    [0.6, 0.0, 0.8],
                    [0.8, -0.6, 0.0],
                ] {
                    let (got, expected) =
                        (irradiance(&sun, normal), dense(&sun, &conditions, normal));
                    for (w, (got, expected)) in got.into_iter().zip(expected).enumerate() {
                        if expected > 1e-25 {
                            let error = (got / expected - 1.0).abs();
                            assert!(error < 5e-4, "{conditions:?} {normal:?} {w}: {error}");
                            errors.push(error);
                        }
                    }
                }
            }
        }
    }
    for degrees in [5.0f64, 17.0, 45.0, 59.9, 60.1, 75.0, 88.0] {
        let conditions = Conditions {
            solar_elevation: degrees.to_radians(),
            ..Conditions::default()
        };
        let sun = MODEL.solar_disc(&conditions).unwrap();
        let normal = [0.3, 0.4, 0.75f64.sqrt()];
        let expected = dense(&sun, &conditions, normal);
        for (got, expected) in irradiance(&sun, normal).into_iter().zip(expected) {
            let error = (got / expected - 1.0).abs();
            assert!(error < 5e-4, "{degrees}: {error}");
            errors.push(error);
        }
    }
    println!("| irradiance | median | p95 | p99 | max |\n| --- | --- | --- | --- | --- |");
    row("against dense quadrature", &mut errors);
}

/// Walls that the sun's rays graze: their plane cuts the disc.
#[test]
fn irradiance_of_planes_that_cut_the_disc() {
    for (degrees, altitude) in [(30.0f64, 0.0), (0.1, 0.0), (-2.0, 6000.0), (70.0, 0.0)] {
        let conditions = Conditions {
            solar_elevation: degrees.to_radians(),
            altitude,
            ..Conditions::default()
        };
        let sun = MODEL.solar_disc(&conditions).unwrap();
        let e = conditions.solar_elevation;
        let up = unit(e + FRAC_PI_2, 0.0);
        for turn in [0.0f64, 0.02, 1.0, 2.5, 3.1] {
            for rise in [-0.6, -0.05, 0.0, 0.3, 0.9] {
                let (y, x) = turn.sin_cos();
                let across = [x * up[0], y, x * up[2]];
                let centre = conditions.sun_direction();
                let lift = (rise * SOLAR_ANGULAR_RADIUS).sin();
                let normal: [f64; 3] = std::array::from_fn(|k| across[k] + lift * centre[k]);
                let whole = irradiance(&sun, centre);
                let length = normal.iter().map(|v| v * v).sum::<f64>().sqrt();
                let normal = narrow(normal.map(|v| v / length)).map(f64::from);
                let expected = dense(&sun, &conditions, normal);
                for (w, got) in irradiance(&sun, normal).into_iter().enumerate() {
                    let off = (got - expected[w]).abs();
                    assert!(
                        off <= 2e-3 * expected[w] + 1e-7 * whole[w],
                        "{degrees} {turn} {rise}: {got} {}",
                        expected[w]
                    );
                }
            }
        }
    }
    // At the zenith, on a wall: half of the disc, from the side.
    let conditions = Conditions {
        solar_elevation: FRAC_PI_2,
        ..Conditions::default()
    };
    let sun = MODEL.solar_disc(&conditions).unwrap();
    let walls = [0.0f64, 1.0, 2.0].map(|a| irradiance(&sun, [a.cos(), a.sin(), 0.0])[N / 2]);
    let flat = irradiance(&sun, [0.0, 0.0, 1.0])[N / 2];
    // Without limb darkening 4/(3π) · ½ of the radius.
    assert!((0.18..0.213).contains(&(walls[0] / flat / SOLAR_ANGULAR_RADIUS)));
    assert!(walls.iter().all(|w| (w / walls[0] - 1.0).abs() < 1e-4));
}

/// The light of a setting sun falls smoothly and without a last step.
#[test]
fn irradiance_goes_to_nothing_continuously() {
    for altitude in [0.0, 2000.0] {
        let at = |rise: f64| {
            let conditions = Conditions {
                solar_elevation: rise * SOLAR_ANGULAR_RADIUS - dip(altitude),
                altitude,
                ..Conditions::default()
            };
            let sun = MODEL.solar_disc(&conditions).unwrap();
            let red = sun.wavelengths().partition_point(|nm| *nm < 640.0);
            irradiance(&sun, conditions.sun_direction())[red]
        };
        let half = at(0.0);
        let mut last = at(1.3);
        let mut rise = 1.3;
        while rise > -1.01 {
            rise -= 1e-3;
            let now = at(rise);
            assert!(now <= last && last - now < 5e-3 * (last + half), "{rise}");
            last = now;
        }
        assert_eq!(last, 0.0);
        // A segment of height t has an area that goes with t^1.5, and the air before it is the same.
        let ratio = at(-0.9999) / at(-0.99999);
        assert!((ratio / 10f64.powf(1.5) - 1.0).abs() < 0.05, "{ratio}");
    }
}

/// A rotation in single precision.
fn rotation(random: &mut Random) -> [[f32; 3]; 3] {
    let q: [f64; 4] = loop {
        let q: [f64; 4] = std::array::from_fn(|_| random.between(-1.0, 1.0));
        let square: f64 = q.iter().map(|v| v * v).sum();
        if (0.1..1.0).contains(&square) {
            break q.map(|v| v / square.sqrt());
        }
    };
    let [w, x, y, z] = q;
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - z * w),
            2.0 * (x * z + y * w),
        ],
        [
            2.0 * (x * y + z * w),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - x * w),
        ],
        [
            2.0 * (x * z - y * w),
            2.0 * (y * z + x * w),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
    .map(narrow)
}

fn there_and_back(rotation: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    let world: [f32; 3] =
        std::array::from_fn(|i| (0..3).map(|k| rotation[i][k] * v[k]).sum::<f32>());
    std::array::from_fn(|i| (0..3).map(|k| rotation[k][i] * world[k]).sum::<f32>())
}

/// `WELKIN_DRAWS=10000000` draws more.
#[test]
fn draws_survive_a_rotation_in_single_precision() {
    let draws = std::env::var("WELKIN_DRAWS").map_or(1_000_000, |n| n.parse().unwrap());
    let suns = [60.0f64, 12.0, 0.05, -0.2, 90.0];
    for degrees in suns {
        let conditions = Conditions {
            solar_elevation: degrees.to_radians(),
            solar_azimuth: 2.3,
            ..Conditions::default()
        };
        let colour = MODEL.sky(&conditions).unwrap();
        let colour = colour.bake_colour(BakedSky::TOLERANCE).unwrap();
        let sun = MODEL.solar_disc(&conditions).unwrap();
        let sampler = colour.sampler().with_sun(&sun);
        let mut random = Random(degrees.to_bits());
        let (mut sum, mut worst, mut suns) = (0.0, 0.0f32, 0);
        let count = draws / 5;
        for _ in 0..count {
            let turned = rotation(&mut random);
            let u = [random.share() as f32, random.share() as f32];
            let sample = sampler.sample(u);
            let back = there_and_back(&turned, sample.direction);
            let (light, pdf) = (sampler.xyz(back).unwrap(), sampler.pdf(back).unwrap());
            // Whoever asks again, for the density, the light or both.
            for (y, pdf) in [
                (sample.xyz[1], sample.pdf),
                (light[1], sample.pdf),
                (light[1], pdf),
            ] {
                if y > 0.0 {
                    worst = worst.max(y / pdf);
                }
            }
            if sample.part == Part::Sun {
                suns += 1;
                assert!(
                    (pdf / sample.pdf - 1.0).abs() < 1e-3,
                    "{u:?} {sample:?} {pdf}"
                );
                assert!(degrees < 1.0 || light[1] > 0.1 * sun.xyz(sun.direction()).unwrap()[1]);
            }
            sum += f64::from(sample.xyz[1] / sample.pdf);
        }
        let mean = sum / f64::from(count);
        let largest = f64::from(worst) / mean;
        println!(
            "sun {degrees}°: {:.1} % drawn for it, largest weight {largest:.2} of the mean",
            100.0 * f64::from(suns) / f64::from(count)
        );
        assert!(largest < 20.0, "{degrees}: {largest}");
    }
}

#[test]
fn draws_at_the_rim_and_odd_numbers() {
    let at = |degrees: f64| {
        let conditions = Conditions {
            solar_elevation: degrees.to_radians(),
            ..Conditions::default()
        };
        let colour = MODEL.sky(&conditions).unwrap();
        let colour = colour.bake_colour(BakedSky::TOLERANCE).unwrap();
        let sun = MODEL.solar_disc(&conditions).unwrap();
        (colour.sampler().with_sun(&sun), sun)
    };
    let (sampler, sun) = at(60.0);
    for a in [0.5, 0.7, 0.733, 0.733_962_36] {
        // Once the rim, where the draw was for the disc and its density that of the sky.
        let sample = sampler.sample([a, 0.885_340_3]);
        let weight = sample.xyz[1] / sample.pdf;
        assert!(weight < 2.4e5, "{sample:?} {weight}");
        assert_eq!(sample.part == Part::Sun, sample.pdf > 1000.0);
    }
    let mut seen = [0; 2];
    for i in 0..=1000u16 {
        for j in [0.0, 1e-7, 0.25, 0.5, 0.999_999_9, 1.0, f32::NAN] {
            let sample = sampler.sample([f32::from(i) / 1000.0, j]);
            let is_sun = sample.part == Part::Sun;
            seen[usize::from(is_sun)] += 1;
            let centre = sun.xyz(sun.direction()).unwrap()[1];
            assert!(!is_sun || (sample.xyz[1] > 0.2 * centre && sample.pdf > 1000.0));
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0);
    for odd in [f32::NAN, -1.0, 2.0, f32::INFINITY, f32::NEG_INFINITY] {
        for u in [[odd, 0.3], [0.3, odd], [odd, odd]] {
            let sample = sampler.sample(u);
            assert!(sample.pdf > 0.0 && sample.xyz.iter().all(|v| v.is_finite()));
        }
    }
    // Where the sun has set, or all but: draws are those of the sky.
    for degrees in [-0.27, -3.0] {
        let (sampler, sun) = at(degrees);
        assert!(!sun.is_visible());
        let sample = sampler.sample([0.0, 0.5]);
        assert!(sample.part == Part::Sky && sample.pdf > 0.0);
    }
    let (sampler, _) = at(-0.2664);
    for i in 0..1000u16 {
        let sample = sampler.sample([f32::from(i) / 1000.0, 0.3]);
        assert!(sample.pdf > 0.0 && sample.pdf.is_finite() && sample.xyz[1].is_finite());
    }
}

/// No draw for the disc is wasted on what is below the horizon, and none of the visible part is left out.
#[test]
fn draws_cover_what_is_visible() {
    for (degrees, altitude) in [(0.1f64, 0.0), (-0.2, 0.0), (-2.0, 3800.0), (50.0, 0.0)] {
        let conditions = Conditions {
            solar_elevation: degrees.to_radians(),
            altitude,
            solar_azimuth: -1.0,
            ..Conditions::default()
        };
        let sky = MODEL.sky(&conditions).unwrap();
        let sun = MODEL.solar_disc(&conditions).unwrap();
        let baked = sky.bake_colour(BakedSky::TOLERANCE).unwrap();
        let sampler = baked.sampler().with_sun(&sun);
        // The mean radiance of draws, over the solid angle of a segment of a disc.
        let mut random = Random(21);
        let [mut sum, mut light] = [[0.0; N]; 2];
        let mut black = 0;
        let count = 50_000;
        // The share of the sun, so that it alone is drawn.
        let (mut share, mut rest) = (0.0f32, 1.0f32);
        for _ in 0..40 {
            let middle = 0.5 * (share + rest);
            match sampler.sample([middle, 0.5]).part {
                Part::Sun => share = middle,
                Part::Sky => rest = middle,
            }
        }
        for _ in 0..count {
            let u = [share * random.share() as f32, random.share() as f32];
            let sample = sampler.sample(u);
            sun.radiance(sample.direction, &mut light).unwrap();
            assert_eq!(sample.part, Part::Sun);
            black += usize::from(light[N / 2] == 0.0);
            for (sum, light) in sum.iter_mut().zip(light) {
                *sum += light / count as f32;
            }
        }
        assert!(share > 0.0 && black * 1000 <= count, "{black} of {count}");
        let rise = (conditions.solar_elevation + dip(altitude)) / SOLAR_ANGULAR_RADIUS;
        let theta = (-rise).clamp(-1.0, 1.0).acos();
        let visible = sun.solid_angle() * (theta - theta.sin() * theta.cos()) / PI;
        let expected = irradiance(&sun, conditions.sun_direction());
        for w in [N / 3, 2 * N / 3] {
            let off = f64::from(sum[w]) * visible / expected[w] - 1.0;
            assert!(off.abs() < 0.01, "{degrees} {w}: {off}");
        }
    }
}
