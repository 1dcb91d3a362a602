//! Baked skies evaluated from their buffers, by the formulae that the documentation of `SkyBuffers` gives and nothing
//! else, against the library.
#![cfg(feature = "default-model")]

use welkin::{
    BakedSky, BufferHeader, Conditions, Model, PolarisationFrame, Response, SkyBuffers, Stokes,
    StokesSpectra,
};

/// Four weights, and the first cell that they belong to.
fn taps(x: f64, intervals: u32) -> (usize, [f64; 4]) {
    let u = x * f64::from(intervals);
    let cell = u.floor().min(f64::from(intervals) - 1.0).max(0.0);
    let t = u - cell;
    let s = 1.0 - t;
    let inner = |t: f64| 3.0 * t.powi(3) - 6.0 * t * t + 4.0;
    let weights = [s.powi(3), inner(t), inner(s), t.powi(3)];
    (cell as usize, weights.map(|w| w / 6.0))
}

struct Place {
    rows: (usize, [f64; 4]),
    columns: (usize, [f64; 4]),
    envelope: (usize, [f64; 4]),
    stride: usize,
    opacity: f64,
    sine: f64,
}

fn locate(h: &BufferHeader, [x, y, z]: [f64; 3]) -> Place {
    let horizon = f64::from(h.horizon);
    let side = z - horizon;
    let k = usize::from(side < 0.0);
    let sign = 1.0 - 2.0 * k as f64;
    let (shrink, c) = (f64::from(h.shrink[k]), f64::from(h.crowding[k]));
    let sine = (side.abs() * shrink).min(1.0).sqrt();
    let cosine = ((1.0 - sign * z) * shrink).clamp(0.0, 1.0).sqrt();
    let row = sine * (1.0 + c) / (c * sine + 1.0 + f64::from(h.pole) * cosine);
    let [ca, sa] = h.azimuth.map(f64::from);
    let flat = x.hypot(y);
    let (cos, sin) = match flat > 0.0 {
        true => ((x * ca + y * sa) / flat, (y * ca - x * sa) / flat),
        false => (1.0, 0.0),
    };
    let [sx, sy, sz] = h.sun.map(f64::from);
    let chord = ((x - sx).powi(2) + (y - sy).powi(2) + (z - sz).powi(2)).sqrt();
    let root = ((z + horizon) * (z - horizon)).max(0.0).sqrt() + z.abs();
    let opaque = f64::from(h.opaque);
    let (mut rows, stride) = (taps(row, h.intervals[k]), h.intervals[2] as usize + 3);
    rows.0 += k * (h.intervals[0] as usize + 3);
    Place {
        rows,
        columns: taps(((1.0 - cos) / 2.0).clamp(0.0, 1.0).sqrt(), h.intervals[2]),
        envelope: taps((chord / 2.0).min(1.0), h.sun_intervals),
        stride,
        opacity: if k == 0 {
            1.0
        } else {
            opaque / (opaque + root)
        },
        sine: sin,
    }
}

fn surface(place: &Place, cells: &[[f32; 4]], lane: usize) -> f64 {
    let mut sum = 0.0;
    for (r, weight) in place.rows.1.iter().enumerate() {
        for (c, other) in place.columns.1.iter().enumerate() {
            let cell = (place.rows.0 + r) * place.stride + place.columns.0 + c;
            sum += weight * other * f64::from(cells[cell][lane]);
        }
    }
    sum
}

fn value(b: &SkyBuffers, place: &Place, channel: usize) -> f64 {
    let (group, lane) = (channel / 4, channel % 4);
    let envelope = &b.envelope[group * (b.header.sun_intervals as usize + 3)..][place.envelope.0..];
    let around: f64 = (envelope.iter().zip(place.envelope.1))
        .map(|(e, w)| w * f64::from(e[lane]))
        .sum();
    let cells = (b.header.intervals[0] + b.header.intervals[1] + 6) as usize * place.stride;
    let logarithm = around + surface(place, &b.cells[group * cells..][..cells], lane);
    logarithm.exp2() * place.opacity * f64::from(b.scale[group][lane])
}

fn degrees(b: &SkyBuffers, place: &Place, channel: usize) -> [f64; 2] {
    let (group, lane) = (channel / 4, channel % 4);
    let cells = (b.header.intervals[0] + b.header.intervals[1] + 6) as usize * place.stride;
    let part = |k: usize| {
        surface(
            place,
            &b.polarisation[(2 * group + k) * cells..][..cells],
            lane,
        )
    };
    [part(0), part(1) * place.sine]
}

fn directions() -> Vec<[f64; 3]> {
    let mut out = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for i in 0..400 {
        let (z, phi) = (f64::from(i) / 199.5 - 1.0, f64::from(i) * 2.399_963);
        // Every other one beside the horizon.
        let z = if i % 2 == 0 { z } else { z.powi(3) * 0.1 };
        let flat = (1.0 - z * z).max(0.0).sqrt();
        out.push([flat * phi.cos(), flat * phi.sin(), z]);
    }
    out
}

fn scenes() -> impl Iterator<Item = Conditions> {
    [(40.0, 0.0), (3.0, 800.0), (-5.0, 0.0), (89.9, 9000.0)]
        .into_iter()
        .map(|(elevation, altitude)| Conditions {
            solar_elevation: f64::to_radians(elevation),
            solar_azimuth: 0.7,
            altitude,
            ..Conditions::default()
        })
}

#[test]
fn colours_and_spectra_are_those_of_the_buffers() {
    let model = Model::default_model().unwrap();
    for conditions in scenes() {
        let sky = model.sky(&conditions).unwrap();
        let (spectral, colour) = (
            sky.bake(BakedSky::TOLERANCE).unwrap(),
            sky.bake_colour(BakedSky::TOLERANCE).unwrap(),
        );
        let (a, b) = (spectral.buffers(), colour.buffers());
        assert_eq!(a.header.channels as usize, spectral.wavelengths().len());
        let mut radiance = vec![0.0; spectral.wavelengths().len()];
        for direction in directions() {
            let single = direction.map(|v| v as f32);
            spectral.radiance(single, &mut radiance).unwrap();
            let place = locate(&a.header, single.map(f64::from));
            for (w, expected) in radiance.iter().enumerate() {
                let got = value(&a, &place, w);
                assert!(
                    (got - f64::from(*expected)).abs() <= 4e-4 * f64::from(*expected),
                    "{direction:?} {w}: {got} {expected}"
                );
            }
            let place = locate(&b.header, single.map(f64::from));
            for (c, expected) in colour.xyz(single).unwrap().iter().enumerate() {
                assert!(
                    (value(&b, &place, c) - f64::from(*expected)).abs()
                        <= 4e-4 * f64::from(*expected)
                );
            }
        }
    }
}

#[test]
fn polarisation_is_that_of_the_buffers() {
    let model = Model::default_model().unwrap();
    for conditions in scenes() {
        let baked = model
            .polarised_sky(&conditions)
            .unwrap()
            .bake(BakedSky::TOLERANCE)
            .unwrap();
        let buffers = baked.buffers();
        assert_eq!(buffers.header.polarised, 1);
        let n = buffers.header.channels as usize;
        let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
        for direction in directions() {
            let single = direction.map(|v| v as f32);
            let out = StokesSpectra {
                i: &mut i,
                q: &mut q,
                u: &mut u,
            };
            baked
                .stokes(single, PolarisationFrame::Vertical, out)
                .unwrap();
            let place = locate(&buffers.header, single.map(f64::from));
            for w in 0..n {
                let stokes = Stokes {
                    i: i[w],
                    q: q[w],
                    u: u[w],
                };
                if stokes.i == 0.0 {
                    continue;
                }
                let [dq, du] = degrees(&buffers, &place, w);
                // Beyond full polarisation the library scales both back.
                let shrink = 1.0 / dq.hypot(du).max(1.0);
                let off = (dq * shrink - f64::from(stokes.q / stokes.i))
                    .hypot(du * shrink - f64::from(stokes.u / stokes.i));
                assert!(off < 4e-4, "{direction:?} {w}: {dq} {du} {stokes:?}");
            }
        }
    }
}

#[test]
fn headers_are_laid_out_as_shaders_do() {
    let sky = Model::default_model()
        .unwrap()
        .colour_sky(&Conditions::default())
        .unwrap();
    let buffers = sky.bake(BakedSky::TOLERANCE).unwrap().buffers();
    let bytes = buffers.header_bytes();
    let word = |at: usize| u32::from_ne_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!(bytes.len(), 80);
    assert_eq!(f32::from_bits(word(12)), buffers.header.horizon);
    assert_eq!(f32::from_bits(word(40)), buffers.header.pole);
    assert_eq!(word(48), buffers.header.intervals[0]);
    assert_eq!(
        [word(60), word(64), word(68), word(76)],
        [32, 1, 3, SkyBuffers::LAYOUT]
    );
}

#[test]
fn bands_are_those_of_the_buffers() {
    let model = Model::default_model().unwrap();
    let responses: Vec<_> = (0..17)
        .map(|i| Response::wavelength(400.0 + 20.0 * f64::from(i)))
        .collect();
    let bands = model.bands(&responses).unwrap();
    for conditions in scenes() {
        let baked = model
            .band_sky(&conditions, &bands)
            .unwrap()
            .bake(BakedSky::TOLERANCE)
            .unwrap();
        let buffers = baked.buffers();
        let mut radiance = vec![0.0; responses.len()];
        for direction in directions().into_iter().filter(|d| d[2] > 0.01) {
            let single = direction.map(|v| v as f32);
            baked.radiance(single, &mut radiance).unwrap();
            let place = locate(&buffers.header, single.map(f64::from));
            for (band, expected) in radiance.iter().enumerate() {
                assert!((value(&buffers, &place, band) / f64::from(*expected) - 1.0).abs() < 4e-4);
            }
        }
    }
}
