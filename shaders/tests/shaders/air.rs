//! Transmittance on the device is that of the library.

use crate::common::gpu::{Binding, bytes, device};
use crate::common::{Errors, unit};
use welkin::Model;

/// Short and long ones, up, down, level and through the air above the horizon, some from beyond the air.
fn segments() -> Vec<[[f32; 3]; 2]> {
    let mut out = Vec::new();
    for (i, altitude) in [0.0, 2.0, 300.0, 3e3, 30e3, 150e3].into_iter().enumerate() {
        for k in 0..500 {
            let share = (f64::from(k) + 0.5) / 250.0 - 1.0;
            let z = if k % 2 == 0 {
                share
            } else {
                share.powi(3) * 0.2
            };
            let flat = (1.0 - z * z).sqrt();
            let phi = f64::from(k) * 2.399_963;
            let length = 10f64.powf(1.0 + 5.0 * (f64::from(k) * 0.618_034).fract());
            let start = [1e3 * i as f64, -500.0, altitude];
            let d = [flat * phi.cos(), flat * phi.sin(), z];
            let end = std::array::from_fn(|c| start[c] + length * d[c]);
            out.push([start, end].map(|p| p.map(|v| v as f32)));
        }
    }
    out.push([[0.0, 0.0, 10.0]; 2]);
    out.push([[0.0, 0.0, 0.0], [0.0, 0.0, 1e5]]);
    out.push([[0.0, 0.0, 1e5], [0.0, 0.0, 0.0]]);
    out
}

#[test]
fn segments_and_ways_to_space() {
    let Some(gpu) = device() else { return };
    let [mut near, mut whole] = [(); 2].map(|()| Errors::default());
    let mut misses = 0;
    for visibility in [20e3, 60e3, 130e3] {
        let air = Model::default_model()
            .unwrap()
            .transmittance(visibility)
            .unwrap();
        let buffers = air.buffers();
        let (h, n, segments) = (buffers.header, air.wavelengths().len(), segments());
        let input: Vec<_> = segments
            .iter()
            .flatten()
            .map(|&[x, y, z]| [x, y, z, 0.0])
            .collect();
        let stride = 2 * h.groups as usize;
        let bindings = [
            Binding::Uniform(buffers.header_bytes()),
            Binding::Input(&bytes(&input)),
            Binding::Output(segments.len() * stride),
        ];
        let groups = [segments.len().div_ceil(64) as u32, 1];
        let table = [vec![[f32::NAN; 4]; 7], buffers.table.clone()].concat();
        let out = gpu.run(
            "air_segments",
            &bytes(&table),
            [7, 0, 0, 0],
            &bindings,
            groups,
        );
        let mut expected = vec![0.0; n];
        for ([a, b], got) in segments.iter().zip(out[0].chunks_exact(stride)) {
            let [a, b] = [a, b].map(|p| p.map(f64::from));
            let at = |k: usize, w: usize| got[k * h.groups as usize + w / 4][w % 4];
            air.transmittance(a, b, &mut expected).unwrap();
            // Less than a ten-thousandth counts as that.
            (0..n).for_each(|w| near.add(at(0, w), expected[w], 1e-4));
            if a == b {
                continue;
            }
            let way = unit(std::array::from_fn(|i| b[i] - a[i]));
            air.transmittance_to_space(a, way, &mut expected).unwrap();
            // A ray that grazes the ground may meet it for one alone.
            if (expected[n - 1] == 0.0) != (at(1, n - 1) == 0.0) {
                misses += 1;
                continue;
            }
            (0..n).for_each(|w| whole.add(at(1, w), expected[w], 1e-4));
        }
    }
    let [p99, max] = near.report("transmittance of segments");
    assert!(p99 < 1e-3 && max < 1e-2);
    let [p99, max] = whole.report("transmittance to space");
    assert!(p99 < 1e-3 && max < 1e-2 && misses < 10, "{misses}");
}
