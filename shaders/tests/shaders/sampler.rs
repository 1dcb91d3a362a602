//! Draws on the device are those of the library, and as many as its density says.

use crate::common::gpu::{Binding, bytes, device};
use crate::common::{Errors, directions, horizon, scenes};
use welkin::{BakedSky, Conditions, DiscBuffers, Model, Part, SkySampler};

/// Numbers and a direction whose density is looked up.
type Request = ([f32; 2], [f32; 3]);

/// `[draw][2]`.
fn run(
    gpu: &crate::common::gpu::Gpu,
    sampler: &SkySampler,
    disc: &DiscBuffers,
    requests: &[Request],
) -> Vec<[f32; 4]> {
    let buffers = sampler.buffers();
    let input: Vec<_> = requests
        .iter()
        .flat_map(|&([a, b], [x, y, z])| [[a, b, 0.0, 0.0], [x, y, z, 0.0]])
        .collect();
    // Filled up to whole vectors, as after it others would begin.
    let mut table = buffers.table.clone();
    table.resize(table.len().next_multiple_of(4), 0.0);
    let table: Vec<u8> = table.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let bindings = [
        Binding::Uniform(buffers.header_bytes()),
        Binding::Uniform(disc.header_bytes()),
        Binding::Input(&bytes(&input)),
        Binding::Output(2 * requests.len()),
    ];
    let groups = [requests.len().div_ceil(64) as u32, 1];
    gpu.run("sampler_draws", &table, [0; 4], &bindings, groups)
        .remove(0)
}

/// Without the disc, with it, and the disc.
fn samplers(conditions: &Conditions) -> (SkySampler, SkySampler, DiscBuffers) {
    let model = Model::default_model().unwrap();
    let sky = model
        .colour_sky(conditions)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap();
    let disc = model.solar_disc(conditions).unwrap();
    let sampler = sky.sampler();
    (sampler.clone(), sampler.with_sun(&disc), disc.buffers())
}

fn numbers(n: u32) -> impl Iterator<Item = [f32; 2]> {
    // Additive recurrence: even in the square.
    (0..n).map(|i| {
        [0.754_877_666, 0.569_840_290].map(|a: f64| (0.5 + a * f64::from(i)).fract() as f32)
    })
}

#[test]
fn draws_and_densities() {
    let Some(gpu) = device() else { return };
    let [mut angles, mut densities] = [(); 2].map(|()| Errors::default());
    let (mut asked, mut misses) = (0, 0);
    for conditions in scenes() {
        let (_, sampler, disc) = samplers(&conditions);
        let looked_up = directions(disc.header.centre, horizon(&conditions));
        let requests: Vec<Request> = numbers(8000).zip(looked_up.into_iter().cycle()).collect();
        let got = run(&gpu, &sampler, &disc, &requests);
        for ((numbers, direction), got) in requests.iter().zip(got.chunks_exact(2)) {
            let expected = sampler.sample(*numbers);
            assert_eq!(expected.part == Part::Sun, got[1][1] == 1.0);
            let off = (0..3).map(|i| f64::from(got[0][i] - expected.direction[i]).powi(2));
            // In radians; a radian is the unit.
            angles.add(off.sum::<f64>().sqrt() as f32 + 1.0, 1.0, 1.0);
            asked += 2;
            // On the edges of cells rounding decides.
            for (got, at) in [(got[0][3], expected.direction), (got[1][0], *direction)] {
                let expected = sampler.pdf(at).unwrap();
                // 0 below the horizon of an observer on the ground.
                match (got - expected).abs() <= 1e-3 * expected {
                    true => densities.add(got, expected, 0.0),
                    false => misses += 1,
                }
            }
        }
    }
    let [p99, max] = angles.report("directions of draws (of a radian)");
    assert!(p99 < 1e-5 && max < 1e-3);
    let [p99, _] = densities.report("densities");
    println!("in another cell: {misses} of {asked}");
    assert!(p99 < 1e-4 && misses * 200 < asked);
}

/// Pearson's statistic of draws in bins of height and azimuth against the library's density, integrated there.
#[test]
fn draws_follow_the_density() {
    let Some(gpu) = device() else { return };
    const DRAWS: u32 = 400_000;
    for (elevation, altitude) in [(40.0, 0.0), (90.0, 0.0), (2.0, 3e3), (-4.0, 30e3)] {
        let conditions = Conditions {
            solar_elevation: f64::to_radians(elevation),
            solar_azimuth: 0.7,
            altitude,
            ..Conditions::default()
        };
        let (sky, sampler, disc) = samplers(&conditions);
        let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = || {
            // xorshift64*.
            seed ^= seed >> 12;
            seed ^= seed << 25;
            seed ^= seed >> 27;
            (seed.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 40) as f32 / (1 << 24) as f32
        };
        let requests: Vec<Request> = (0..DRAWS)
            .map(|_| ([random(), random()], [0.0, 0.0, 1.0]))
            .collect();
        let got = run(&gpu, &sampler, &disc, &requests);
        let share = f64::from(sampler.buffers().header.share);
        let suns = got.chunks_exact(2).filter(|draw| draw[1][1] == 1.0).count() as f64;
        let n = f64::from(DRAWS);
        let deviation = (suns - share * n) / (share * (1.0 - share) * n).sqrt().max(1.0);
        assert!(deviation.abs() < 4.0, "{suns} draws of the disc, {share}");

        let mut counts = vec![0.0; ROWS * COLUMNS];
        let skies = got.chunks_exact(2).filter(|draw| draw[1][1] == 0.0);
        skies.for_each(|draw| counts[bin(draw[0])] += 1.0);
        let expected = expected(&sky, n - suns);
        let (mut statistic, mut degrees) = (0.0, -1.0);
        // Bins of few are put together.
        let mut few = [0.0; 2];
        for (count, expected) in counts.iter().zip(&expected) {
            if *expected < 20.0 {
                few = [few[0] + count, few[1] + expected];
                continue;
            }
            statistic += (count - expected).powi(2) / expected;
            degrees += 1.0;
        }
        if few[1] > 5.0 {
            statistic += (few[0] - few[1]).powi(2) / few[1];
            degrees += 1.0;
        }
        // Wilson and Hilferty: normal with this mean and variance; 4 is one in 30000.
        let v = 2.0 / (9.0 * degrees);
        let z = ((statistic / degrees).cbrt() - (1.0 - v)) / v.sqrt();
        println!(
            "sun {elevation}°, {altitude} m: chi² {statistic:.0} of {degrees} degrees, z = {z:.2}"
        );
        assert!(z < 4.0 && degrees > 40.0);
    }
}

const ROWS: usize = 36;
const COLUMNS: usize = 24;

fn bin([x, y, z, _]: [f32; 4]) -> usize {
    let row = ((0.5 + 0.5 * f64::from(z)) * ROWS as f64) as usize;
    let turn = f64::from(y).atan2(f64::from(x)) / std::f64::consts::TAU + 0.5;
    row.min(ROWS - 1) * COLUMNS + ((turn * COLUMNS as f64) as usize).min(COLUMNS - 1)
}

/// Draws of the sky that bins should have: the density of a sampler without the disc, summed over a fine grid.
fn expected(sky: &SkySampler, draws: f64) -> Vec<f64> {
    // Rows of cells are narrow along the horizon.
    const FINE: [usize; 2] = [400, 16];
    let mut out = vec![0.0; ROWS * COLUMNS];
    for i in 0..ROWS * FINE[0] {
        let z = (i as f64 + 0.5) / (ROWS * FINE[0]) as f64 * 2.0 - 1.0;
        let flat = (1.0 - z * z).sqrt();
        for k in 0..COLUMNS * FINE[1] {
            let phi = ((k as f64 + 0.5) / (COLUMNS * FINE[1]) as f64 - 0.5) * std::f64::consts::TAU;
            let d = [flat * phi.cos(), flat * phi.sin(), z].map(|v| v as f32);
            out[(i / FINE[0]) * COLUMNS + k / FINE[1]] += f64::from(sky.pdf(d).unwrap());
        }
    }
    let sum: f64 = out.iter().sum();
    let solid = 4.0 * std::f64::consts::PI / (ROWS * COLUMNS * FINE[0] * FINE[1]) as f64;
    // It is a density.
    assert!((sum * solid - 1.0).abs() < 2e-3, "{}", sum * solid);
    out.iter().map(|v| v / sum * draws).collect()
}
