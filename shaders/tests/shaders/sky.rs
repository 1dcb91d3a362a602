//! The baked sky on the device is that of the library.

use crate::common::gpu::{Binding, bytes, device, padded};
use crate::common::{Errors, directions, horizon, scenes};
use welkin::{BakedSky, Model, Moon, PolarisationFrame, SkyBuffers, StokesSpectra};

/// `[direction][group][1 or 3]`.
fn run(
    gpu: &crate::common::gpu::Gpu,
    buffers: &SkyBuffers,
    directions: &[[f32; 3]],
) -> Vec<[f32; 4]> {
    let h = buffers.header;
    let length = directions.len() * h.groups as usize * (1 + 2 * h.polarised as usize);
    // Something before the table, as where there are several.
    let table = [vec![[f32::NAN; 4]; 5], buffers.table()].concat();
    let bindings = [
        Binding::Uniform(buffers.header_bytes()),
        Binding::Input(&padded(directions)),
        Binding::Output(length),
    ];
    let groups = [directions.len().div_ceil(64) as u32, 1];
    let mut out = gpu.run(
        "sky_directions",
        &bytes(&table),
        [5, 0, 0, 0],
        &bindings,
        groups,
    );
    out.remove(0)
}

#[test]
fn colours() {
    let Some(gpu) = device() else { return };
    let model = Model::default_model().unwrap();
    let mut errors = Errors::default();
    for conditions in scenes() {
        let sky = model
            .colour_sky(&conditions)
            .unwrap()
            .bake(BakedSky::TOLERANCE)
            .unwrap();
        let buffers = sky.buffers();
        let directions = directions(buffers.header.sun, horizon(&conditions));
        let got = run(&gpu, &buffers, &directions);
        for (d, got) in directions.iter().zip(got) {
            let expected = sky.xyz(*d).unwrap();
            (0..3).for_each(|c| errors.add(got[c], expected[c], 0.0));
        }
    }
    let [p99, max] = errors.report("colours");
    assert!(p99 < 1e-3 && max < 1e-2);
}

#[test]
fn moonlit_colours() {
    let Some(gpu) = device() else { return };
    let moon = Moon {
        elevation: 0.4,
        azimuth: 2.0,
        ..Moon::default()
    };
    let conditions = moon.conditions(&welkin::Conditions::default());
    let model = Model::default_model().unwrap().moonlit(&moon).unwrap();
    let sky = model
        .colour_sky(&conditions)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap();
    let buffers = sky.buffers();
    let directions = directions(buffers.header.sun, horizon(&conditions));
    let mut errors = Errors::default();
    for (d, got) in directions.iter().zip(run(&gpu, &buffers, &directions)) {
        let expected = sky.xyz(*d).unwrap();
        (0..3).for_each(|c| errors.add(got[c], expected[c], 0.0));
    }
    let [p99, max] = errors.report("moonlit colours");
    assert!(p99 < 1e-3 && max < 1e-2);
}

#[test]
fn spectra_and_stokes_vectors() {
    let Some(gpu) = device() else { return };
    let model = Model::default_model().unwrap();
    let [mut radiance, mut degrees] = [(); 2].map(|()| Errors::default());
    for conditions in scenes() {
        let sky = model
            .polarised_sky(&conditions)
            .unwrap()
            .bake(BakedSky::TOLERANCE)
            .unwrap();
        let buffers = sky.buffers();
        let (n, groups) = (
            buffers.header.channels as usize,
            buffers.header.groups as usize,
        );
        let directions = directions(buffers.header.sun, horizon(&conditions));
        let got = run(&gpu, &buffers, &directions);
        let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
        for (d, got) in directions.iter().zip(got.chunks_exact(3 * groups)) {
            let out = StokesSpectra {
                i: &mut i,
                q: &mut q,
                u: &mut u,
            };
            sky.stokes(*d, PolarisationFrame::Vertical, out).unwrap();
            for w in 0..n {
                let at = |k: usize| got[3 * (w / 4) + k][w % 4];
                radiance.add(at(0), i[w], 0.0);
                if i[w] == 0.0 {
                    continue;
                }
                // Degrees as they are: they go through zero.
                degrees.add(at(1), q[w] / i[w], 1.0);
                degrees.add(at(2), u[w] / i[w], 1.0);
            }
        }
    }
    let [p99, max] = radiance.report("spectral radiance");
    assert!(p99 < 1e-3 && max < 1e-2);
    let [p99, max] = degrees.report("Q/I and U/I (differences)");
    assert!(p99 < 1e-3 && max < 1e-2);
}
