//! The baked sky on the device is that of the library.

use crate::common::gpu::{Binding, bytes, device, padded};
use crate::common::{Errors, directions, horizon, scenes};
use welkin::{BakedSky, Model, Moon, PolarisationFrame, Response, SkyBuffers, StokesSpectra};

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

/// What errors are gathered of.
#[derive(Default)]
struct Polarised {
    radiance: Errors,
    degrees: Errors,
}

impl Polarised {
    /// Compares a scene; `stokes` is what the library says of a direction.
    fn add(
        &mut self,
        gpu: &crate::common::gpu::Gpu,
        buffers: &SkyBuffers,
        horizon: f64,
        mut stokes: impl FnMut([f32; 3], StokesSpectra),
    ) {
        let n = buffers.header.channels as usize;
        let directions = directions(buffers.header.sun, horizon);
        let got = run(gpu, buffers, &directions);
        let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
        let rows = got.chunks_exact(3 * buffers.header.groups as usize);
        for (d, got) in directions.iter().zip(rows) {
            let out = StokesSpectra {
                i: &mut i,
                q: &mut q,
                u: &mut u,
            };
            stokes(*d, out);
            for w in 0..n {
                let at = |k: usize| got[3 * (w / 4) + k][w % 4];
                self.radiance.add(at(0), i[w], 0.0);
                if i[w] == 0.0 {
                    continue;
                }
                // Degrees as they are: they go through zero.
                self.degrees.add(at(1), q[w] / i[w], 1.0);
                self.degrees.add(at(2), u[w] / i[w], 1.0);
            }
        }
    }

    fn check(self, of: &str) {
        let [p99, max] = self.radiance.report(&format!("radiance {of}"));
        assert!(p99 < 1e-3 && max < 1e-2, "{of}");
        let [p99, max] = (self.degrees).report(&format!("Q/I and U/I {of} (differences)"));
        assert!(p99 < 1e-3 && max < 1e-2, "{of}");
    }
}

#[test]
fn spectra_and_stokes_vectors() {
    let Some(gpu) = device() else { return };
    let model = Model::default_model().unwrap();
    let mut errors = Polarised::default();
    for conditions in scenes() {
        let sky = model.polarised_sky(&conditions).unwrap();
        let sky = sky.bake(BakedSky::TOLERANCE).unwrap();
        errors.add(&gpu, &sky.buffers(), horizon(&conditions), |d, out| {
            sky.stokes(d, PolarisationFrame::Vertical, out).unwrap();
        });
    }
    errors.check("at all wavelengths");
}

/// Seven bands, so that the last group is not full: narrow ones, and wide ones that overlap.
fn responses() -> Vec<Response> {
    let mut out: Vec<Response> = [400.0, 500.0, 600.0].map(Response::wavelength).into();
    for centre in [420.0, 480.0, 550.0, 640.0] {
        let nodes = [-60.0, -20.0, 10.0, 70.0].map(|off: f64| centre + off);
        out.push(Response::table(&nodes, &[0.0, 0.9, 1.0, 0.0]).unwrap());
    }
    out
}

#[test]
fn bands() {
    let Some(gpu) = device() else { return };
    let model = Model::default_model().unwrap();
    let bands = model.bands(&responses()).unwrap();
    let mut errors = Errors::default();
    for conditions in scenes() {
        let sky = model.band_sky(&conditions, &bands).unwrap();
        let sky = sky.bake(BakedSky::TOLERANCE).unwrap();
        let buffers = sky.buffers();
        assert_eq!((buffers.header.channels, buffers.header.groups), (7, 2));
        let directions = directions(buffers.header.sun, horizon(&conditions));
        let got = run(&gpu, &buffers, &directions);
        let mut expected = [0.0; 7];
        for (d, got) in directions.iter().zip(got.chunks_exact(2)) {
            sky.radiance(*d, &mut expected).unwrap();
            for (got, expected) in got.as_flattened().iter().zip(expected) {
                errors.add(*got, expected, 0.0);
            }
        }
    }
    let [p99, max] = errors.report("radiance in bands");
    assert!(p99 < 1e-3 && max < 1e-2);
}

#[test]
fn bands_and_stokes_vectors() {
    let Some(gpu) = device() else { return };
    let model = Model::default_model().unwrap();
    let bands = model.bands(&responses()).unwrap();
    let mut errors = Polarised::default();
    for conditions in scenes() {
        let sky = model.polarised_band_sky(&conditions, &bands).unwrap();
        let sky = sky.bake(BakedSky::TOLERANCE).unwrap();
        errors.add(&gpu, &sky.buffers(), horizon(&conditions), |d, out| {
            sky.stokes(d, PolarisationFrame::Vertical, out).unwrap();
        });
    }
    errors.check("in bands, polarised");
}
