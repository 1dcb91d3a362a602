//! The air around a camera evaluated from its buffers, by the formulae that the documentation of `AerialBuffers` gives
//! and nothing else, against rays that the library marches in small steps.
#![cfg(feature = "default-model")]

use welkin::{AerialBuffers, AerialHeader, ColourSpace, Conditions, Model};

type Vector = [f64; 3];
/// The first of four neighbours, and their weights.
type Taps = (usize, [f64; 4]);

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn taps(x: f64, intervals: u32) -> Taps {
    let u = x * f64::from(intervals);
    let cell = u.floor().min(f64::from(intervals) - 1.0).max(0.0);
    let t = u - cell;
    let s = 1.0 - t;
    let inner = |t: f64| 3.0 * t.powi(3) - 6.0 * t * t + 4.0;
    let weights = [s.powi(3), inner(t), inner(s), t.powi(3)];
    (cell as usize, weights.map(|w| w / 6.0))
}

/// How far a ray counts, and the share of the nodes at a distance.
struct Way<'a> {
    h: &'a AerialHeader,
    rise: f64,
    end: f64,
}

impl<'a> Way<'a> {
    fn new(h: &'a AerialHeader, z: f64) -> Self {
        let [height, top, bend, steepness, horizon] =
            [h.height, h.top, h.bend, h.steepness, h.horizon].map(f64::from);
        let rise = z * steepness;
        let end = if z < horizon {
            let root = ((z - horizon) * (z + horizon)).max(0.0).sqrt();
            height / ((root - z) * steepness / 2.0)
        } else {
            ((rise * rise + 4.0 * bend * (top - height)).max(0.0).sqrt() - rise) / (2.0 * bend)
        };
        let end = end.max(0.0) + 20.0;
        Self { h, rise, end }
    }

    fn measure(&self, s: f64) -> f64 {
        let [height, haze, bend] = [self.h.height, self.h.haze, self.h.bend].map(f64::from);
        let q = (height + haze + s * (self.rise + s * bend))
            .max(haze / 2.0)
            .sqrt();
        let p = (height + haze).sqrt();
        let u = s / (p + q);
        u / (p * q * (1.0 - bend * u * u))
    }

    fn share(&self, t: f64) -> f64 {
        let part = f64::from(self.h.nearness) * self.measure(t) / self.measure(self.end);
        (1.0 + part).log2() * f64::from(self.h.per_stretch)
    }
}

/// Row, column and angle of a direction.
fn locate(h: &AerialHeader, d: Vector) -> (usize, [Taps; 3]) {
    let v = |v: [f32; 3]| v.map(f64::from);
    let (z, horizon) = (dot(d, v(h.up)).clamp(-1.0, 1.0), f64::from(h.horizon));
    let k = usize::from(z < horizon);
    let sign = 1.0 - 2.0 * k as f64;
    let (shrink, c) = (f64::from(h.shrink[k]), f64::from(h.crowding[k]));
    let sine = ((z - horizon).abs() * shrink).min(1.0).sqrt();
    let cosine = ((1.0 - sign * z) * shrink).clamp(0.0, 1.0).sqrt();
    let row = sine * (1.0 + c) / (c * sine + 1.0 + f64::from(h.pole) * cosine);
    let (x, y) = (dot(d, v(h.forward)), dot(d, v(h.left)));
    let cos = if x.hypot(y) > 0.0 {
        x / x.hypot(y)
    } else {
        1.0
    };
    let sun = v(h.sun);
    let chord: Vector = std::array::from_fn(|i| d[i] - sun[i]);
    let taps = [
        taps(row, h.intervals[k]),
        taps(((1.0 - cos) / 2.0).clamp(0.0, 1.0).sqrt(), h.intervals[2]),
        taps((dot(chord, chord).sqrt() / 2.0).min(1.0), h.sun_intervals),
    ];
    (k, taps)
}

/// Sum over the neighbours in distance, row and column.
fn volume(h: &AerialHeader, cells: &[[f32; 4]], k: usize, taps: [Taps; 3], lane: usize) -> f64 {
    let stride = h.intervals[2] as usize + 3;
    let slice = (h.intervals[0] + h.intervals[1] + 6) as usize * stride;
    let [node, row, column] = taps;
    let mut sum = 0.0;
    for i in 0..64 {
        let [n, r, c] = [i / 16, i / 4 % 4, i % 4];
        let line = row.0 + r + k * (h.intervals[0] as usize + 3);
        let cell = (node.0 + n) * slice + line * stride + column.0 + c;
        sum += node.1[n] * row.1[r] * column.1[c] * f64::from(cells[cell][lane]);
    }
    sum
}

/// X, Y, Z and their factors.
fn look(b: &AerialBuffers, d: Vector, s: f64) -> [Vector; 2] {
    let h = &b.header;
    let (k, [row, column, angle]) = locate(h, d);
    let way = Way::new(h, dot(d, h.up.map(f64::from)));
    let t = s.min(way.end);
    let node = taps(way.share(t), h.distances);
    let (envelope, cells) = b.table.split_at(h.sun_intervals as usize + 3);
    let (light, depth) = cells.split_at(cells.len() / 2);
    let taps = [node, row, column];
    let around = |lane: usize| -> f64 {
        let cells = envelope[angle.0..].iter().zip(angle.1);
        cells.map(|(e, w)| w * f64::from(e[lane])).sum()
    };
    let mut xyz = std::array::from_fn(|i| (around(i) + volume(h, light, k, taps, i)).exp2() * t);
    let mut factors = std::array::from_fn(|i| (-t * volume(h, depth, k, taps, i).max(0.0)).exp2());
    if k == 1 && s > way.end {
        let times = s / way.end;
        for (light, factor) in xyz.iter_mut().zip(&mut factors) {
            let more = factor.powf(times);
            *light *= if *factor < 1.0 - 1e-9 {
                (1.0 - more) / (1.0 - *factor)
            } else {
                times
            };
            *factor = more;
        }
    }
    [xyz, factors]
}

/// Differences, sorted.
fn sorted(mut values: Vec<f64>) -> impl Fn(f64) -> f64 {
    values.sort_by(f64::total_cmp);
    move |share| values[((values.len() - 1) as f64 * share) as usize]
}

const STEPS: usize = 160;

/// p99 of light over luminance and of factors, along rays up to the ground and out of the air.
fn errors(elevation: f64, altitude: f64) -> [f64; 2] {
    let conditions = Conditions {
        solar_elevation: f64::to_radians(elevation),
        solar_azimuth: 0.7,
        ..Conditions::default()
    };
    let model = Model::default_model().unwrap();
    let aerial = model.colour_aerial_perspective(&conditions).unwrap();
    let from = [150.0, -80.0, altitude];
    let buffers = aerial.buffers(from).unwrap();
    let [mut light, mut factors] = [const { Vec::new() }; 2];
    for i in 0..240 {
        let x = f64::from(i) / 119.5 - 1.0;
        let z = f64::from(buffers.header.horizon) + if i % 2 == 0 { x } else { 0.3 * x.powi(3) };
        if z.abs() > 1.0 {
            continue;
        }
        let (flat, phi) = ((1.0 - z * z).sqrt(), f64::from(i) * 2.399_963);
        let d = [flat * phi.cos(), flat * phi.sin(), z];
        let end = Way::new(&buffers.header, dot(d, buffers.header.up.map(f64::from))).end - 20.0;
        let end = end.min(400e3);
        let distances: Vec<f64> = (1..=STEPS)
            .map(|k| end * (k as f64 / STEPS as f64).powi(2))
            .collect();
        let [mut lights, mut through] = [[[0.0; 3]; STEPS]; 2];
        aerial
            .rgb_along(
                from,
                d,
                &distances,
                ColourSpace::Xyz,
                &mut lights,
                &mut through,
            )
            .unwrap();
        for k in (7..STEPS).step_by(8) {
            let [xyz, seen] = look(&buffers, d, distances[k]);
            for c in 0..3 {
                let scale = f64::from(lights[k][c].max(lights[k][1]));
                light.push((xyz[c] - f64::from(lights[k][c])).abs() / scale);
                factors.push((seen[c] - f64::from(through[k][c])).abs());
            }
        }
    }
    [("light", light), ("factors", factors)].map(|(what, values)| {
        let at = sorted(values);
        let figures = [0.5, 0.95, 0.99, 1.0].map(|share| format!("{:.3}", 100.0 * at(share)));
        println!(
            "{what}, {altitude} m, sun at {elevation}°: {} %",
            figures.join(" / ")
        );
        at(0.99)
    })
}

/// Half of the rays are beside the horizon, where the table leaves most out.
#[test]
fn rays_are_those_of_the_buffers() {
    // Half as much again as is measured: light by day and in twilight, factors.
    for (altitude, [day, twilight, through]) in [
        (0.0, [3.8e-3, 5.7e-3, 1.4e-4]),
        (3e3, [5.8e-3, 6.8e-3, 2.6e-3]),
        (30e3, [2.6e-3, 5.6e-3, 1.1e-3]),
    ] {
        for (elevation, limit) in [(90.0, day), (20.0, day), (2.0, day), (-4.0, twilight)] {
            let [light, factors] = errors(elevation, altitude);
            assert!(light < limit && factors < through, "{altitude} {elevation}");
        }
    }
}

#[test]
fn valleys_go_on_through_the_same_air() {
    let aerial = Model::default_model()
        .unwrap()
        .colour_aerial_perspective(&Conditions::default())
        .unwrap();
    let from = [0.0, 0.0, 2.0];
    let buffers = aerial.buffers(from).unwrap();
    // Down a slope that meets the sphere at 100 m, to 10 km and 200 m below it.
    let d = [0.6 * 0.9998, 0.8 * 0.9998, -0.02];
    let length = dot(d, d).sqrt();
    let d = d.map(|v| v / length);
    let [mut light, mut factors] = [[[0.0; 3]; 10]; 2];
    let distances: [f64; 10] = std::array::from_fn(|k| 1e3 * (k + 1) as f64);
    aerial
        .rgb_along(
            from,
            d,
            &distances,
            ColourSpace::Xyz,
            &mut light,
            &mut factors,
        )
        .unwrap();
    for k in 0..10 {
        let [xyz, seen] = look(&buffers, d, distances[k]);
        for c in 0..3 {
            let off = (xyz[c] / f64::from(light[k][c]) - 1.0).abs();
            assert!(off < 0.03, "{k} {c}: {xyz:?} {:?}", light[k]);
            assert!((seen[c] - f64::from(factors[k][c])).abs() < 0.01);
        }
    }
}

#[test]
fn headers_are_laid_out_as_shaders_do() {
    let aerial = Model::default_model()
        .unwrap()
        .colour_aerial_perspective(&Conditions::default())
        .unwrap();
    let buffers = aerial.buffers([0.0, 0.0, 2.0]).unwrap();
    let (bytes, h) = (buffers.header_bytes(), &buffers.header);
    let word = |at: usize| u32::from_ne_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!(bytes.len(), 144);
    assert_eq!(f32::from_bits(word(28)), h.height);
    assert_eq!(f32::from_bits(word(60)), h.bend);
    assert_eq!(f32::from_bits(word(116)), h.steepness);
    assert_eq!(f32::from_bits(word(128)), h.per_stretch);
    assert_eq!([word(112), word(140)], [h.distances, AerialBuffers::LAYOUT]);
}
