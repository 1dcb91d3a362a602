//! A small model with smooth analytic factors, for tests that need a file but not real air.
#![allow(dead_code)]

pub mod aerial;
pub mod answer;
#[cfg(feature = "cli")]
pub mod command;
pub mod oracle;
pub mod random;
pub mod server;
pub mod spectrum;

use proptest::test_runner::{Config, RngSeed};
use welkin::axis::ElevationAxis;
use welkin::format::{
    AlphaAxis, Chunk, ColumnTable, DensityTable, Estimate, Field, Head, Payload, PhaseFunction,
    PolarisationBasis, PolarisationFactors, RadianceBasis, RadianceFactors, encode,
};
use welkin::geometry::Planet;
use welkin::{Model, Sky};

pub const RANK: usize = 5;

/// The same `cases` of a property test in every run: what has passed does not fail by chance where nothing has changed.
///
/// `WELKIN_CASES=N` takes N times as many from new seeds, `PROPTEST_CASES=N` just N. What fails is printed and becomes
/// a test of its own.
pub fn cases(cases: u32) -> Config {
    let factor = std::env::var("WELKIN_CASES").ok();
    let factor: Option<u32> = factor.map(|n| n.parse().expect("WELKIN_CASES is a number"));
    let default = Config::default();
    let cases = match std::env::var_os("PROPTEST_CASES") {
        Some(_) => default.cases,
        None => cases * factor.unwrap_or(1),
    };
    Config {
        cases,
        max_global_rejects: 4 * cases,
        rng_seed: factor.map_or(RngSeed::Fixed(0), |_| RngSeed::Random),
        failure_persistence: None,
        ..default
    }
}

/// Radiance at all wavelengths.
pub fn radiance(sky: &Sky, direction: [f32; 3]) -> Vec<f32> {
    let mut out = vec![f32::NAN; sky.wavelengths().len()];
    sky.radiance(direction, &mut out).unwrap();
    out
}

/// The wavelength (nm) that is nearest to `nm`, by number.
pub fn nearest(wavelengths: &[f64], nm: f64) -> usize {
    let off = |w: usize| (wavelengths[w] - nm).abs();
    (0..wavelengths.len())
        .min_by(|&a, &b| off(a).total_cmp(&off(b)))
        .expect("some wavelengths")
}

/// Four wavelengths in the range of the embedded model, nm.
#[cfg(feature = "default-model")]
pub fn wavelengths() -> impl proptest::strategy::Strategy<Value = [f32; 4]> {
    let model = Model::default_model().unwrap();
    let [shortest, longest] = model.wavelength_range().unwrap().map(|nm| nm as f32);
    proptest::array::uniform4(shortest..=longest)
}

/// Nodes of the model (nm) between those that ozone darkens most and those in near-infrared absorption, for which the
/// model is fitted less closely.
pub const CLEAR: std::ops::RangeInclusive<f64> = 330.0..=750.0;

/// By how much rounding counts more where there is hardly any light, as in the far ultraviolet: radiance is the
/// exponential of numbers that are as large then.
pub fn darkness(radiance: f32) -> f32 {
    (radiance.max(f32::MIN_POSITIVE).ln().abs() / 3.0).max(1.0)
}

/// By how much relative errors at the wavelengths of a model can grow in the light between them: the sum of
/// |∂ ln L(λ)/∂ ln L| over the wavelengths, for the relative radiance `values`.
pub fn growth(model: &Model, values: &[f32], wavelength: f64) -> f64 {
    const STEP: f32 = 1.0 / 1024.0;
    let interpolation = model.spectral_interpolation().unwrap();
    let log = |values: &[f32]| f64::from(interpolation.between(values, wavelength).unwrap()).ln();
    let slope = |n: usize| {
        let mut brighter = values.to_vec();
        brighter[n] *= 1.0 + STEP;
        (log(&brighter) - log(values)).abs() / f64::from(STEP).ln_1p()
    };
    (0..values.len()).map(slope).sum()
}

/// Unit vector at an elevation and an azimuth, rad.
pub fn unit(elevation: f64, azimuth: f64) -> [f64; 3] {
    let ((z, r), (y, x)) = (elevation.sin_cos(), azimuth.sin_cos());
    [r * x, r * y, z]
}

/// The same in single precision.
pub fn direction(elevation: f64, azimuth: f64) -> [f32; 3] {
    unit(elevation, azimuth).map(|v| v as f32)
}

/// A model with `altitudes` × `visibilities` radiance chunks.
pub fn head(altitudes: &[f64], visibilities: &[f64]) -> Head {
    head_with(altitudes, visibilities, 6)
}

/// The same with any number of wavelengths over 320..=760 nm.
pub fn head_with(altitudes: &[f64], visibilities: &[f64], wavelengths: usize) -> Head {
    let step = 440.0 / (wavelengths - 1) as f64;
    let wavelengths: Vec<f64> = (0..wavelengths).map(|i| 320.0 + step * i as f64).collect();
    let (nw, nv) = (wavelengths.len(), visibilities.len());
    let relative = |l: f64| 550.0 / l;
    let mut extinction = Vec::new();
    for v in visibilities {
        extinction.extend(wavelengths.iter().map(|&l| 1.2e-5 * relative(l).powi(4)));
        extinction.extend(wavelengths.iter().map(|&l| 3.0 / v * relative(l)));
    }
    let ne = 9;
    let field = |phase, ground, value| Field {
        phase,
        ground,
        estimate: 0,
        parameter: (0..nw).map(|w| value + 0.01 * w as f64).collect(),
    };
    Head {
        planet: Planet {
            radius: 6_378_000.0,
            top: 100_000.0,
        },
        up: AlphaAxis {
            intervals: 7,
            exponent: 3.0,
        },
        down: AlphaAxis {
            intervals: 5,
            exponent: 2.5,
        },
        phi_intervals: 4,
        elevation: ElevationAxis {
            min: (-4.2f64).to_radians(),
            max: 90f64.to_radians(),
            centre: -0.01,
            width: 0.06,
            intervals: ne,
        },
        altitudes: altitudes.to_vec(),
        visibilities: visibilities.to_vec(),
        constituents: 2,
        absorbers: 0,
        estimated: false,
        extinction,
        spherical_albedo: (0..nv * nw)
            .map(|i| 0.05 + 0.01 * (i % 40) as f64)
            .collect(),
        xyz: (0..nw)
            .map(|w| [40.0 + w as f64, 60.0 - w as f64, 30.0].map(|v| 1e3 * v))
            .collect(),
        solar_start: 300.0,
        solar_step: 2.0,
        solar_irradiance: (0..251)
            .map(|i| 1.0 + 0.5 * (0.1 * i as f32).sin())
            .collect(),
        fields: vec![
            field(PhaseFunction::None, false, 0.0),
            field(PhaseFunction::Rayleigh, false, 0.03),
            field(PhaseFunction::HenyeyGreenstein, false, 0.6),
            field(PhaseFunction::HenyeyGreenstein, false, 0.75),
            field(PhaseFunction::None, true, 0.0),
        ],
        wavelengths,
        metadata: r#"{"provenance":"synthetic model for tests: not a sky"}"#.to_owned(),
    }
}

/// The basis, then column and radiance chunks for every altitude and visibility of `head`.
pub fn chunks(head: &Head) -> Vec<Chunk> {
    let mut chunks = vec![Chunk {
        altitude: None,
        visibility: None,
        error_median: 0.0,
        error_p99: 0.0,
        payload: Payload::RadianceBasis(basis(head)),
    }];
    for a in 0..head.altitudes.len() {
        chunks.push(Chunk {
            altitude: Some(a),
            visibility: None,
            error_median: 0.0,
            error_p99: 0.0,
            payload: Payload::Column(column(head, a)),
        });
        for v in 0..head.visibilities.len() {
            chunks.push(Chunk {
                altitude: Some(a),
                visibility: Some(v),
                error_median: 0.001,
                error_p99: 0.01,
                payload: Payload::Radiance(factors(head, a, v)),
            });
        }
    }
    chunks
}

/// The same with polarisation, of the given strength.
pub fn polarised_chunks(head: &Head, strength: f32) -> Vec<Chunk> {
    let shape = head.shape();
    let wave = |rows: usize, columns: usize, speed: f32| -> Vec<f32> {
        (0..rows * columns)
            .map(|i| (speed * (i / columns) as f32 + 1.1 * (i % columns) as f32).sin())
            .collect()
    };
    let chunk = |altitude, visibility, payload| Chunk {
        altitude,
        visibility,
        error_median: 0.0,
        error_p99: 0.0,
        payload,
    };
    let mut chunks = chunks(head);
    let basis = PolarisationBasis {
        rank: RANK,
        phi: wave(shape.phi, RANK, 0.6),
        channel: wave(RANK, 4 * head.wavelengths.len(), 0.8),
    };
    chunks.push(chunk(None, None, Payload::PolarisationBasis(basis)));
    for a in 0..head.altitudes.len() {
        for v in 0..head.visibilities.len() {
            let speed = 0.3 + 0.02 * a as f32 + 0.03 * v as f32;
            let factors = PolarisationFactors {
                rank: RANK,
                scale: (0..RANK).map(|r| strength / (1.0 + r as f32)).collect(),
                alpha_up: wave(shape.up, RANK, speed),
                alpha_down: wave(shape.down, RANK, 0.1 + speed),
                elevation: wave(shape.elevation, RANK, 0.2 + speed),
            };
            chunks.push(chunk(Some(a), Some(v), Payload::Polarisation(factors)));
        }
    }
    chunks
}

/// The same head and chunks with fields that are relative to estimates: of sunlight in the molecules, in the particles,
/// and of diffuse light.
pub fn estimated(mut head: Head, mut chunks: Vec<Chunk>) -> (Head, Vec<Chunk>) {
    head.estimated = true;
    for (field, estimate) in head.fields.iter_mut().zip([2, 0, 1, 1, 2]) {
        field.estimate = estimate;
    }
    chunks.retain(|chunk| !matches!(chunk.payload, Payload::Column(_)));
    for chunk in &mut chunks {
        if let Payload::Radiance(factors) = &mut chunk.payload {
            factors.level.clear();
            factors.scale.iter_mut().for_each(|scale| *scale *= 40.0);
        }
    }
    chunks.push(Chunk::new(None, None, Payload::Estimate(estimate(&head))));
    (head, chunks)
}

/// Tables of estimates of two constituents.
fn estimate(head: &Head) -> Estimate {
    let nw = head.wavelengths.len();
    let stride = nw.next_multiple_of(8);
    let (angles, suns, densities) = (5, 7, 17);
    let level = vec![0.0, 1.5e3, 4e3, 9e3, 20e3, 100e3];
    let row = |values: [f64; 2]| {
        let mut row = [0.0; 8];
        (row[0], row[1]) = (values[0] as f32, values[1] as f32);
        row
    };
    let density = |i: usize| {
        let z = 100e3 * (i as f64 / (densities - 1) as f64).powi(2);
        row([(-z / 8e3).exp(), (-z / 1.5e3).exp()])
    };
    let column = |z: f32, i: usize| {
        let slant = 40.0 / (1.0 + 9.0 * i as f64);
        let z = f64::from(z);
        row([8e3, 1.5e3].map(|fall| (fall * slant).ln() - (z / fall).min(20.0)))
    };
    let light = |z: f32, j: usize| {
        let dusk = -1.2 * (6 - j) as f32;
        let at = move |w: usize| -2.5 + dusk - 0.02 * w as f32 - z / 3e4;
        (0..stride).map(move |w| if w < nw { at(w) } else { 0.0 })
    };
    let albedo = |i: usize| match i % stride < nw && i / stride != 1 && i / stride != 2 {
        true => 1.0 - 0.002 * (i % 97) as f32,
        false => 0.0,
    };
    let places = |n: usize| level.iter().flat_map(move |&z| (0..n).map(move |i| (z, i)));
    Estimate {
        angles,
        suns,
        sun_lowest: -0.3,
        sun_width: 0.08,
        ring: vec![0.0, 5e3],
        scatters: vec![1, 2, 3],
        albedo: (0..3 * 2 * stride).map(albedo).collect(),
        density: (0..densities).flat_map(density).collect(),
        column: places(angles).flat_map(|(z, i)| column(z, i)).collect(),
        light: places(suns).flat_map(|(z, j)| light(z, j)).collect(),
        level: level.clone(),
    }
}

/// Densities of two constituents that fall off with altitude, the second below 4 km only.
pub fn densities() -> DensityTable {
    let edges = vec![0.0, 4000.0, 20_000.0, 100_000.0];
    let density = vec![
        1.0, 1.0, 0.8, 0.3, 0.6, 0.0, 0.3, 0.0, 0.08, 0.0, 0.01, 0.0, 0.0, 0.0,
    ];
    DensityTable { edges, density }
}

fn column(head: &Head, a: usize) -> ColumnTable {
    let shape = head.shape();
    let rows = shape.up + shape.down;
    let value = |row: usize, k: usize| {
        let steep = if row < shape.up { row } else { rows - row } as f32;
        -1.0 - 0.1 * a as f32 - 0.2 * steep * (1.0 + k as f32)
    };
    let values = (0..rows * shape.constituents)
        .map(|i| value(i / shape.constituents, i % shape.constituents))
        .collect();
    ColumnTable { values }
}

fn wave(rows: usize, columns: usize, speed: f32, phase: f32) -> Vec<f32> {
    (0..rows * columns)
        .map(|i| {
            let (x, y) = ((i / columns) as f32, (i % columns) as f32);
            1.2 + (speed * x + 1.3 * y + phase).sin()
        })
        .collect()
}

fn basis(head: &Head) -> RadianceBasis {
    let shape = head.shape();
    RadianceBasis {
        rank: RANK,
        phi: wave(shape.phi, RANK, 0.5, 0.0),
        channel: wave(RANK, shape.channels, 0.7, 0.0),
    }
}

/// Smooth positive factors that differ between chunks; higher chunks have fewer components.
fn factors(head: &Head, a: usize, v: usize) -> RadianceFactors {
    let shape = head.shape();
    let rank = if a > 2 { RANK - 1 } else { RANK };
    let phase = 0.2 * a as f32 - 0.1 * v as f32;
    let nw = shape.wavelengths;
    RadianceFactors {
        rank,
        scale: (0..rank).map(|r| 0.02 / (1.0 + r as f32)).collect(),
        alpha_up: wave(shape.up, rank, 0.3, phase),
        alpha_down: wave(shape.down, rank, 0.4, phase),
        elevation: wave(shape.elevation, rank, 0.2, phase),
        level: (0..shape.elevation * nw)
            .map(|i| -3.0 + 0.25 * (i / nw) as f32 - 0.05 * (i % nw) as f32 + 0.3 * phase)
            .collect(),
    }
}

/// Four altitudes, three visibilities.
pub fn model_bytes() -> Vec<u8> {
    let head = head(&[0.0, 120.0, 1000.0, 2000.0], &[20e3, 59.4e3, 131.8e3]);
    encode(&head, &chunks(&head)).expect("the synthetic model is valid")
}

/// [`model_bytes`] with fields relative to estimates, and with polarisation.
pub fn estimated_bytes() -> Vec<u8> {
    let head = head(&[0.0, 120.0, 1000.0, 2000.0], &[20e3, 59.4e3, 131.8e3]);
    let chunks = polarised_chunks(&head, 0.1);
    let (head, chunks) = estimated(head, chunks);
    encode(&head, &chunks).expect("the synthetic model is valid")
}

/// [`model_bytes`] with polarisation.
pub fn polarised_bytes(strength: f32) -> Vec<u8> {
    let head = head(&[0.0, 120.0, 1000.0, 2000.0], &[20e3, 59.4e3, 131.8e3]);
    encode(&head, &polarised_chunks(&head, strength)).expect("the polarised model is valid")
}

/// [`wide_bytes`] with polarisation.
pub fn wide_polarised_bytes() -> Vec<u8> {
    let head = wide_head();
    encode(&head, &polarised_chunks(&head, 0.02)).expect("the wide polarised model is valid")
}

/// More wavelengths and fields, for the parts of the evaluator that small models do not reach.
pub fn wide_bytes() -> Vec<u8> {
    let head = wide_head();
    encode(&head, &chunks(&head)).expect("the wide model is valid")
}

fn wide_head() -> Head {
    let mut head = head_with(&[0.0, 2000.0], &[20e3, 59.4e3, 131.8e3], 14);
    for g in [0.5, 0.3, -0.2] {
        let mut field = head.fields[2].clone();
        field.parameter.fill(g);
        head.fields.push(field);
    }
    head
}

/// Enough wavelengths that blocks of them are gathered together.
pub fn long_bytes() -> Vec<u8> {
    let head = head_with(&[0.0, 2000.0], &[20e3, 131.8e3], 14);
    encode(&head, &chunks(&head)).expect("the long model is valid")
}

/// One altitude, one visibility, few nodes: for exhaustive damage.
pub fn tiny_bytes() -> Vec<u8> {
    let mut head = head(&[0.0], &[50e3]);
    head.solar_start = 300.0;
    head.solar_step = 100.0;
    head.solar_irradiance = vec![1.0, 1.5, 1.4, 1.2, 1.1, 1.0];
    head.up.intervals = 2;
    head.down.intervals = 1;
    head.phi_intervals = 1;
    head.elevation.intervals = 1;
    encode(&head, &polarised_chunks(&head, 0.02)).expect("the tiny model is valid")
}

/// The file with the stored bytes of a chunk replaced, and everything that depends on them made right.
pub fn with_chunk(file: &[u8], index: usize, stored: &[u8]) -> Vec<u8> {
    let contents = welkin::format::parse(file).unwrap();
    let directory = contents.head_length - 64 * contents.directory.len();
    let mut bytes = file[..contents.head_length].to_vec();
    for (i, entry) in contents.directory.iter().enumerate() {
        let payload = match i == index {
            true => stored,
            false => &file[entry.offset..entry.offset + entry.length],
        };
        bytes.resize(bytes.len().next_multiple_of(64), 0);
        let offset = bytes.len() as u64;
        bytes[directory + 64 * i + 8..][..8].copy_from_slice(&offset.to_le_bytes());
        let length = payload.len() as u64;
        bytes[directory + 64 * i + 16..][..8].copy_from_slice(&length.to_le_bytes());
        if entry.encoding == welkin::format::ENCODING_RAW {
            bytes[directory + 64 * i + 24..][..8].copy_from_slice(&length.to_le_bytes());
        }
        bytes.extend(payload);
    }
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    seal(&mut bytes, file);
    bytes
}

/// Makes the checksums of a file right; `original` tells where its chunks stand.
pub fn seal(bytes: &mut [u8], original: &[u8]) {
    let contents = welkin::format::parse(original).unwrap();
    let directory = contents.head_length - 64 * contents.directory.len();
    for i in 0..contents.directory.len() {
        let entry = directory + 64 * i;
        let place =
            |at: usize| u64::from_le_bytes(bytes[entry + at..][..8].try_into().unwrap()) as usize;
        let (offset, length) = (place(8), place(16));
        let end = offset.saturating_add(length).min(bytes.len());
        let crc = crc32fast::hash(&bytes[offset.min(end)..end]);
        bytes[entry + 36..][..4].copy_from_slice(&crc.to_le_bytes());
    }
    bytes[32..36].fill(0);
    let crc = crc32fast::hash(&bytes[..contents.head_length]);
    bytes[32..36].copy_from_slice(&crc.to_le_bytes());
}

/// The file with its last chunk twice, the copy's directory entry changed.
pub fn with_entry(file: &[u8], change: impl Fn(&mut [u8])) -> Vec<u8> {
    let contents = welkin::format::parse(file).unwrap();
    let (head_length, last) = (contents.head_length, contents.directory.last().unwrap());
    let mut entry = file[head_length - 64..head_length].to_vec();
    let mut bytes = [&file[..head_length], &entry].concat();
    let move_chunk = |bytes: &mut Vec<u8>, entry: usize, stored: &[u8]| {
        bytes.resize(bytes.len().next_multiple_of(64), 0);
        let offset = bytes.len() as u64;
        bytes[entry + 8..entry + 16].copy_from_slice(&offset.to_le_bytes());
        bytes.extend(stored);
    };
    let directory = head_length - 64 * contents.directory.len();
    for (i, entry) in contents.directory.iter().enumerate() {
        let stored = &file[entry.offset..entry.offset + entry.length];
        move_chunk(&mut bytes, directory + 64 * i, stored);
    }
    move_chunk(
        &mut bytes,
        head_length,
        &file[last.offset..last.offset + last.length],
    );
    entry.copy_from_slice(&bytes[head_length..head_length + 64]);
    change(&mut entry);
    bytes[head_length..head_length + 64].copy_from_slice(&entry);
    let (length, count) = (bytes.len() as u64, contents.directory.len() as u32 + 1);
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    bytes[24..32].copy_from_slice(&(head_length as u64 + 64).to_le_bytes());
    bytes[36..40].copy_from_slice(&count.to_le_bytes());
    bytes[32..36].fill(0);
    let crc = crc32fast::hash(&bytes[..head_length + 64]);
    bytes[32..36].copy_from_slice(&crc.to_le_bytes());
    bytes
}

/// Turns the sign of half of the components, so that sums below zero occur.
pub fn negate_components(chunks: &mut [Chunk]) {
    for chunk in chunks {
        if let Payload::Radiance(factors) = &mut chunk.payload {
            factors.scale.iter_mut().step_by(2).for_each(|s| *s = -*s);
        }
    }
}

/// A unit vector at a height and an azimuth.
pub fn on_sphere(z: f64, azimuth: f64) -> [f32; 3] {
    let r = (1.0 - z * z).max(0.0).sqrt();
    [r * azimuth.cos(), r * azimuth.sin(), z].map(|v| v as f32)
}
