//! Queries do not allocate.
#![allow(unsafe_code, reason = "an allocator that counts cannot do without")]

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

#[cfg(feature = "default-model")]
use welkin::{BakedSky, Directions, StokesSpectra};
use welkin::{Conditions, Model, PolarisationFrame, Stokes};

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn queries_do_not_allocate() {
    let model = Model::from_bytes(common::polarised_bytes(0.02)).unwrap();
    let mut sky = model.sky(&Conditions::default()).unwrap();
    assert!(COUNT.get() > 0, "the counter counts");
    let mut polarised = model.polarised_sky(&Conditions::default()).unwrap();
    let mut out = vec![0.0; sky.wavelengths().len()];
    let mut stokes = vec![Stokes::default(); out.len()];
    let directions = [
        [0.1, 0.2, 0.3],
        [0.0, 0.0, 1.0],
        [0.5, -0.2, -0.1],
        [0.0; 3],
    ];
    let mut batch = vec![0.0; 3 * out.len()];
    let mut xyz = [[0.0; 3]; 3];
    let before = COUNT.get();
    for direction in directions {
        let _ = sky.radiance(direction, &mut out);
        let _ = sky.relative_radiance(direction, &mut out);
        let _ = sky.radiance_at(direction, 500.0);
        let _ = sky.radiance_at(direction, f64::NAN);
        let _ = sky.xyz(direction);
        let _ = sky.linear_srgb(direction);
        let _ = polarised.stokes(direction, PolarisationFrame::SunAligned, &mut stokes);
        let _ = polarised.relative_stokes(
            direction,
            PolarisationFrame::Axis([1.0, 0.0, 0.0]),
            &mut stokes,
        );
        let _ = polarised.stokes_at(direction, PolarisationFrame::Vertical, 500.0);
        let _ = polarised.xyz(direction, PolarisationFrame::Vertical);
    }
    let _ = sky.radiance_batch(&directions[..3], &mut batch);
    let _ = sky.xyz_batch(&directions[..3], &mut xyz);
    let _ = sky.set_solar_azimuth(2.0);
    let _ = polarised.set_solar_azimuth(2.0);
    assert_eq!(COUNT.get(), before);
}

#[test]
#[cfg(feature = "default-model")]
fn baked_queries_do_not_allocate() {
    let model = Model::default_model().unwrap();
    let sky = model.sky(&Conditions::default()).unwrap();
    let mut baked = sky.bake(BakedSky::TOLERANCE).unwrap();
    let mut colour = sky.bake_colour(BakedSky::TOLERANCE).unwrap();
    let polarised = model.polarised_sky(&Conditions::default()).unwrap();
    let polarised = polarised.bake(BakedSky::TOLERANCE).unwrap();
    let n = baked.wavelengths().len();
    let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; 19 * n]);
    let mut out = vec![0.0; 19 * n];
    let mut rgb = [[0.0; 3]; 19];
    let mut heroes = [[0.0; 4]; 19];
    let mut stokes = [[Stokes::default(); 4]; 19];
    let sun = model.solar_disc(&Conditions::default()).unwrap();
    let sampler = colour.sampler().with_sun(&sun);
    let component: Vec<f32> = (0..19).map(|i| (i as f32).sin()).collect();
    let directions = Directions {
        x: &component,
        y: &component,
        z: &component,
    };
    let before = COUNT.get();
    let _ = baked.radiance_batch(&directions, &mut out);
    let spectra = StokesSpectra {
        i: &mut i,
        q: &mut q,
        u: &mut u,
    };
    let _ = polarised.stokes_batch(&directions, PolarisationFrame::SunAligned, spectra);
    let _ = colour.linear_srgb_batch(&directions, &mut rgb);
    let _ = colour.xyz_batch(&directions, &mut rgb);
    for direction in [
        [0.1, 0.2, 0.3],
        [0.0, 0.0, -1.0],
        [1e-40, 0.0, 0.0],
        [0.0; 3],
    ] {
        let _ = baked.radiance(direction, &mut out[..n]);
        let _ = colour.linear_srgb(direction);
        let _ = colour.xyz(direction);
    }
    let _ = baked.hero_batch(
        &directions,
        &[[400.0, 500.0, 600.0, 700.0]; 19],
        &mut heroes,
    );
    let _ = polarised.hero_batch(
        &directions,
        PolarisationFrame::Vertical,
        &[[400.0, 500.0, 600.0, 700.0]; 19],
        &mut stokes,
    );
    let _ = baked.irradiance([0.0, 0.0, 1.0], &mut out[..n]);
    let _ = sun.radiance(sun.direction(), &mut out[..n]);
    let _ = sun.irradiance([0.0, 0.0, 1.0], &mut out[..n]);
    for i in 0..20 {
        let sample = sampler.sample([0.05 * i as f32, 0.5]);
        let _ = sampler.pdf(sample.direction);
    }
    let _ = baked.set_solar_azimuth(2.0);
    let _ = colour.set_solar_azimuth(2.0);
    assert_eq!(COUNT.get(), before);
}

#[cfg(feature = "default-model")]
#[test]
fn finite_segments_do_not_allocate() {
    let model = Model::default_model().unwrap();
    for elevation in [-3.0f64, 0.5, 30.0] {
        let conditions = Conditions {
            solar_elevation: elevation.to_radians(),
            ..Conditions::default()
        };
        let mut aerial = model.aerial_perspective(&conditions).unwrap();
        let n = aerial.wavelengths().len();
        let (mut light, mut through) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
        let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; 2 * n]);
        let camera = [0.0, 0.0, 1500.0];
        let points = [[30_000.0, 900.0, 2500.0], [10.0, 0.0, 1490.0]];
        let before = COUNT.get();
        let _ = aerial.set_solar_azimuth(0.3);
        let _ = aerial.in_scattering_batch(camera, &points, &mut light, &mut through);
        let _ = aerial.linear_srgb(camera, points[0]);
        let spectra = StokesSpectra {
            i: &mut i,
            q: &mut q,
            u: &mut u,
        };
        let frame = PolarisationFrame::Axis([0.0, 0.1, 1.0]);
        let _ = aerial.in_scattering_stokes_batch(camera, &points, frame, spectra, &mut through);
        let _ = aerial.linear_srgb_stokes(camera, points[0], PolarisationFrame::SunAligned);
        let _ = aerial.to_end(camera, [1.0, 0.0, 0.1], &mut light[..n], &mut through[..n]);
        let air = aerial.transmittance();
        let _ = air.transmittance(camera, points[1], &mut through[..n]);
        let _ = air.transmittance_to_space(camera, [0.0, 0.0, 1.0], &mut through[..n]);
        assert_eq!(COUNT.get(), before);
    }
}
