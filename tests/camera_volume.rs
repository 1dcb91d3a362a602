//! Volumes of aerial perspective against their rays marched one by one.
#![cfg(feature = "default-model")]

mod common;

use proptest::prelude::*;
use welkin::{CameraVolume, ColourAerialPerspective, Conditions, Error, Model};

const SIZE: [usize; 2] = [80, 45];

/// A camera that looks towards +x, and the sun; angles in degrees.
struct View {
    altitude: f64,
    pitch: f64,
    roll: f64,
    sun: [f64; 2],
}

const VIEWS: [View; 10] = [
    view(2.0, 0.0, 0.0, [40.0, 90.0]),
    view(2.0, 5.0, 0.0, [20.0, 10.0]),
    view(2.0, 5.0, 0.0, [5.0, 0.0]),
    view(2.0, 5.0, 0.0, [-3.0, 0.0]),
    view(2.0, 60.0, 0.0, [-8.0, 0.0]),
    view(2.0, 80.0, 0.0, [89.0, 0.0]),
    view(9000.0, -5.0, 0.0, [2.0, 30.0]),
    view(10e3, -3.2, 20.0, [30.0, 20.0]),
    view(3000.0, -1.8, 10.0, [20.0, 20.0]),
    view(2.0, 0.0, 20.0, [1.0, 20.0]),
];

const fn view(altitude: f64, pitch: f64, roll: f64, sun: [f64; 2]) -> View {
    View {
        altitude,
        pitch,
        roll,
        sun,
    }
}

fn depths() -> Vec<f64> {
    (0..24)
        .map(|k| 50.0 * 2000f64.powf(f64::from(k) / 23.0))
        .collect()
}

fn camera<'a>(view: &View, size: [usize; 2], depths: &'a [f64]) -> CameraVolume<'a> {
    let (sin, cos) = view.pitch.to_radians().sin_cos();
    let (slant, level) = view.roll.to_radians().sin_cos();
    let tan = 0.6;
    let (right, up) = ([0.0, -1.0, 0.0], [-sin, 0.0, cos]);
    let turned = |a: [f64; 3], b: [f64; 3], scale: f64| {
        std::array::from_fn(|i| scale * (level * a[i] + slant * b[i]))
    };
    CameraVolume {
        from: [0.0, 0.0, view.altitude],
        axis: [cos, 0.0, sin],
        right: turned(right, up, tan * 16.0 / 9.0),
        up: turned(up, right.map(|v: f64| -v), tan),
        size,
        depths,
    }
}

fn aerial(view: &View) -> ColourAerialPerspective {
    let [elevation, azimuth] = view.sun.map(f64::to_radians);
    let conditions = Conditions {
        altitude: view.altitude,
        solar_elevation: elevation,
        solar_azimuth: azimuth,
        ..Conditions::default()
    };
    let model = Model::default_model().unwrap();
    model.colour_aerial_perspective(&conditions).unwrap()
}

type Volume = [Vec<[f32; 3]>; 2];

fn filled(aerial: &ColourAerialPerspective, volume: &CameraVolume) -> Volume {
    let n = volume.size[0] * volume.size[1] * volume.depths.len();
    let [mut light, mut factors] = [(); 2].map(|()| vec![[f32::NAN; 3]; n]);
    aerial
        .linear_srgb_volume(volume, &mut light, &mut factors)
        .unwrap();
    [light, factors]
}

fn marched(aerial: &ColourAerialPerspective, volume: &CameraVolume) -> Volume {
    let slices = volume.depths.len();
    let n = volume.size[0] * volume.size[1];
    let [mut light, mut factors] = [(); 2].map(|()| vec![[f32::NAN; 3]; n * slices]);
    let rays = light
        .chunks_mut(slices)
        .zip(factors.chunks_mut(slices))
        .enumerate();
    for (i, (light, factors)) in rays {
        let direction =
            volume.direction([i % volume.size[0], i / volume.size[0]].map(|n| n as f64));
        let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
        let distances: Vec<_> = volume.depths.iter().map(|d| d * length).collect();
        aerial
            .linear_srgb_along(volume.from, direction, &distances, light, factors)
            .unwrap();
    }
    [light, factors]
}

fn difference(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
}

/// 99th and 99.9th percentile and largest of the differences of light, and the largest of those of factors.
fn differences(view: &View) -> [f32; 4] {
    let depths = depths();
    let (aerial, volume) = (aerial(view), camera(view, SIZE, &depths));
    let [light, factors] = filled(&aerial, &volume);
    let [exact, exact_factors] = marched(&aerial, &volume);
    let pairs = light.iter().zip(&exact);
    let mut off: Vec<f32> = pairs
        .map(|(a, b)| difference(a, b) / b[1].max(1e-9))
        .collect();
    off.sort_by(f32::total_cmp);
    let at = |share: f64| off[((off.len() - 1) as f64 * share) as usize];
    let factor = |(a, b): (&[f32; 3], &[f32; 3])| {
        assert!(a.iter().all(|f| (0.0..=1.0).contains(f)));
        difference(a, b)
    };
    let factors = factors.iter().zip(&exact_factors).map(factor);
    [at(0.99), at(0.999), at(1.0), factors.fold(0.0, f32::max)]
}

#[test]
fn volumes_are_their_rays() {
    for view in &VIEWS {
        let [p99, p999, max, factor] = differences(view);
        println!(
            "sun {:?}° from {} m, roll {}°: p99 {p99:.1e}, p99.9 {p999:.1e}, max {max:.1e}, factors {factor:.1e}",
            view.sun, view.altitude, view.roll
        );
        assert!(p99 < 2.6e-3 && p999 < 5e-3 && max < 7e-3 && factor < 1.5e-3);
    }
}

proptest! {
    #![proptest_config(common::cases(12))]

    #[test]
    fn any_camera_sees_its_rays(
        altitude in prop_oneof![Just(2.0), 2.0..15e3f64],
        pitch in -60.0..85.0f64,
        roll in -90.0..90.0f64,
        elevation in prop_oneof![-10.0..10.0f64, 0.0..90.0f64],
        azimuth in -180.0..180.0f64,
    ) {
        let view = View { altitude, pitch, roll, sun: [elevation, azimuth] };
        let [p99, p999, max, factor] = differences(&view);
        prop_assert!(p99 < 3e-3 && p999 < 6e-3 && max < 2e-2 && factor < 4e-3, "{p99} {p999} {max} {factor}");
    }
}

#[test]
fn small_volumes_are_exactly_their_rays() {
    let depths = depths();
    for size in [[1, 1], [3, 7], [6, 6]] {
        let (aerial, volume) = (aerial(&VIEWS[1]), camera(&VIEWS[1], size, &depths));
        assert_eq!(filled(&aerial, &volume), marched(&aerial, &volume));
    }
    // Sizes that are no multiples of the lattice are filled to the last ray.
    for size in [[41, 30], [64, 27], [38, 39]] {
        let (aerial, volume) = (aerial(&VIEWS[1]), camera(&VIEWS[1], size, &depths));
        let [light, _] = filled(&aerial, &volume);
        let [exact, _] = marched(&aerial, &volume);
        let mut worst = 0.0f32;
        for (a, b) in light.iter().zip(&exact) {
            worst = worst.max(difference(a, b) / b[1]);
        }
        println!("{size:?}: at most {worst:.1e}");
        assert!(worst < 2e-2);
    }
}

#[test]
fn bad_volumes_are_refused() {
    let aerial = aerial(&VIEWS[0]);
    let ask = |volume: &CameraVolume, n: usize| {
        let [mut light, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; n]);
        aerial.linear_srgb_volume(volume, &mut light, &mut factors)
    };
    for size in [[4, 4], [64, 64]] {
        let good = camera(&VIEWS[0], size, &[10.0, 20.0]);
        let n = size[0] * size[1] * 2;
        ask(&good, n).unwrap();
        assert!(matches!(ask(&good, n - 1), Err(Error::Length { .. })));
        let falling = CameraVolume {
            depths: &[20.0, 10.0],
            ..good
        };
        assert!(matches!(ask(&falling, n), Err(Error::OutOfRange { .. })));
        let flat = CameraVolume {
            axis: [f64::NAN; 3],
            ..good
        };
        assert!(matches!(ask(&flat, n), Err(Error::Direction { .. })));
        let nowhere = CameraVolume {
            from: [0.0, f64::INFINITY, 0.0],
            ..good
        };
        assert!(matches!(ask(&nowhere, n), Err(Error::Point { .. })));
    }
    // Rays of the lattice beyond the edge of the picture may go where those of the picture do not.
    let wide = CameraVolume {
        depths: &[1860e3],
        right: [0.0, -0.36, 0.0],
        up: [0.12, 0.0, 0.34],
        ..camera(&view(2.0, -20.0, 0.0, [40.0, 90.0]), [16, 16], &[])
    };
    ask(&wide, 256).unwrap();
    let huge = CameraVolume {
        size: [usize::MAX, 3],
        ..camera(&VIEWS[0], [1, 1], &[1.0])
    };
    assert!(matches!(ask(&huge, 1), Err(Error::Length { .. })));
    ask(&camera(&VIEWS[0], [0, 5], &[1.0]), 0).unwrap();
}
