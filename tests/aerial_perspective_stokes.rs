//! Polarised light of finite segments: consistent with itself, with the unpolarised light and with the polarised sky.
#![cfg(feature = "default-model")]

mod common;

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use common::unit;
use welkin::{
    AerialPerspective, Conditions, Error, Model, PolarisationFrame, Stokes, StokesSpectra,
};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());

fn conditions(elevation: f64) -> Conditions {
    Conditions {
        solar_elevation: elevation.to_radians(),
        solar_azimuth: 0.4,
        visibility: 30e3,
        albedo: 0.3,
        altitude: 0.0,
    }
}

fn aerial(elevation: f64) -> AerialPerspective {
    MODEL.aerial_perspective(&conditions(elevation)).unwrap()
}

/// Stokes vectors and transmittance.
fn stokes(
    aerial: &AerialPerspective,
    [from, to]: [[f64; 3]; 2],
    frame: PolarisationFrame,
) -> Result<(Vec<Stokes>, Vec<f32>), Error> {
    let n = aerial.wavelengths().len();
    let [mut i, mut q, mut u, mut through] = [(); 4].map(|()| vec![f32::NAN; n]);
    let out = StokesSpectra {
        i: &mut i,
        q: &mut q,
        u: &mut u,
    };
    aerial.in_scattering_stokes(from, to, frame, out, &mut through)?;
    let parts = i.into_iter().zip(q.into_iter().zip(u));
    let light = parts.map(|(i, (q, u))| Stokes { i, q, u }).collect();
    Ok((light, through))
}

fn along(from: [f64; 3], direction: [f64; 3], length: f64) -> [[f64; 3]; 2] {
    [
        from,
        std::array::from_fn(|k| from[k] + length * direction[k]),
    ]
}

/// Level, rising, falling and vertical; some start away from the origin.
fn segments() -> Vec<[[f64; 3]; 2]> {
    let mut out = vec![];
    for k in 0..120 {
        let u = |step: f64| (f64::from(k) * step).fract();
        let elevation = match k % 4 {
            0 => 0.05 * (2.0 * u(0.618) - 1.0),
            1 => FRAC_PI_2,
            _ => PI * (u(0.618) - 0.5) * 0.99,
        };
        let start = [20e3 * u(0.31), -40e3 * u(0.77), 200.0 + 9e3 * u(0.43)];
        let length = 10f64.powf(1.0 + 4.2 * u(0.7549));
        let length = length.min(0.9 * start[2] / (-elevation.sin()).max(0.02));
        out.push(along(start, unit(elevation, 6.3 * u(0.57)), length));
    }
    out
}

#[test]
fn intensity_and_transmittance_are_those_without_polarisation() {
    for elevation in [-3.0, 1.0, 35.0] {
        let aerial = aerial(elevation);
        let n = aerial.wavelengths().len();
        let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
        for segment in segments() {
            let [from, to] = segment;
            aerial
                .in_scattering(from, to, &mut light, &mut through)
                .unwrap();
            let (stokes, same) = stokes(&aerial, segment, PolarisationFrame::SunAligned).unwrap();
            assert_eq!(through, same);
            for (s, &i) in stokes.iter().zip(&light) {
                assert_eq!(s.i, i);
                assert!(s.q.hypot(s.u) <= s.i, "{s:?}");
            }
        }
    }
}

/// To the end of the air: the polarised sky, which comes from other tables.
#[test]
fn the_whole_way_is_the_polarised_sky() {
    for elevation in [1.0, 10.0, 50.0] {
        let aerial = aerial(elevation);
        let sky = MODEL.polarised_sky(&conditions(elevation)).unwrap();
        let mut truth = vec![Stokes::default(); aerial.wavelengths().len()];
        let (mut errors, mut polarised) = (vec![], 0);
        for k in 0..60 {
            let direction = unit(0.02 + 0.025 * f64::from(k), 0.7 * f64::from(k));
            for frame in [
                PolarisationFrame::Vertical,
                PolarisationFrame::Axis([0.3, -0.2, 0.9]),
            ] {
                sky.stokes(direction.map(|v| v as f32), frame, &mut truth)
                    .unwrap();
                let segment = along([0.0; 3], direction, 300e3);
                let (light, _) = stokes(&aerial, segment, frame).unwrap();
                for ((got, want), &nm) in light.iter().zip(&truth).zip(aerial.wavelengths()) {
                    if !common::CLEAR.contains(&nm) {
                        continue;
                    }
                    let (q, u) = (want.q / want.i, want.u / want.i);
                    errors.push((got.q / got.i - q).hypot(got.u / got.i - u));
                    polarised += usize::from(want.degree() > 0.1);
                }
            }
        }
        errors.sort_by(f32::total_cmp);
        let [median, p95] = [0.5, 0.95].map(|q| errors[(q * errors.len() as f64) as usize]);
        println!("sun at {elevation}°: (Q, U)/I off by {median} (median), {p95} (p95)");
        // The sky itself errs by 0.002 and 0.015 (p99 0.030).
        assert!(
            median < 0.007 && p95 < 0.03 && polarised > 100,
            "{elevation}: {median} {p95}"
        );
    }
}

#[test]
fn before_its_sky_light_ends_in_it_polarised_as_it() {
    for elevation in [-2.0, 1.0, 10.0, 50.0] {
        let aerial = aerial(elevation);
        let n = aerial.wavelengths().len();
        let sky = MODEL.polarised_sky(&conditions(elevation)).unwrap();
        let front = aerial.joined_to_polarised(&sky).unwrap();
        let plain = aerial.joined_to(sky.sky()).unwrap();
        let mut truth = vec![Stokes::default(); n];
        for k in 0..40 {
            let direction = unit(0.001 + 0.035 * f64::from(k), 0.7 * f64::from(k));
            let frame = [
                PolarisationFrame::Vertical,
                PolarisationFrame::Axis([0.3, -0.2, 0.9]),
            ][k as usize % 2];
            sky.stokes(direction.map(|v| v as f32), frame, &mut truth)
                .unwrap();
            for length in [3e3, 3e4, 1e5, 2e5, 3e6] {
                let [_, to] = along(front.camera(), direction, length);
                let [mut i, mut q, mut u, mut through] = [(); 4].map(|()| vec![0.0; n]);
                let out = StokesSpectra {
                    i: &mut i,
                    q: &mut q,
                    u: &mut u,
                };
                front
                    .in_scattering_stokes_batch(&[to], frame, out, &mut through)
                    .unwrap();
                let mut alone = vec![0.0; n];
                plain.in_scattering(to, &mut alone, &mut through).unwrap();
                for w in 0..n {
                    assert!((i[w] - alone[w]).abs() <= 1e-5 * alone[w], "{length} {w}");
                    assert!(q[w].hypot(u[w]) <= i[w] * (1.0 + 1e-6));
                    if length > 1e6 {
                        let off = (q[w] - truth[w].q).hypot(u[w] - truth[w].u);
                        let light = (i[w] - truth[w].i).abs();
                        assert!(light.max(off) <= 1e-5 * truth[w].i, "{k} {w} {off}");
                    }
                }
            }
        }
    }
}

#[test]
fn parts_add_up() {
    let aerial = aerial(12.0);
    let frame = PolarisationFrame::Axis([0.1, 0.9, 0.4]);
    let mut worst = (0f32, f64::NAN);
    for [from, to] in segments() {
        let middle = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
        let (whole, _) = stokes(&aerial, [from, to], frame).unwrap();
        let (near, through) = stokes(&aerial, [from, middle], frame).unwrap();
        let (far, _) = stokes(&aerial, [middle, to], frame).unwrap();
        for w in (0..whole.len()).filter(|&w| common::CLEAR.contains(&aerial.wavelengths()[w])) {
            let sum = |part: fn(&Stokes) -> f32| part(&near[w]) + through[w] * part(&far[w]);
            for part in [|s: &Stokes| s.q, |s: &Stokes| s.u] {
                let off = (sum(part) - part(&whole[w])).abs() / whole[w].i;
                // The quadrature errs in all components alike.
                let light = (sum(|s| s.i) / whole[w].i - 1.0).abs();
                if off - light > worst.0 {
                    worst = (off - light, aerial.wavelengths()[w]);
                }
            }
        }
    }
    // Halves have more panels than the whole; wrong signs or axes would make tenths.
    let (worst, nm) = worst;
    assert!(worst < 0.01, "{worst} at {nm} nm");
}

#[test]
fn frames_turn_and_bad_input_is_refused() {
    let aerial = aerial(20.0);
    let segment = along([0.0, 0.0, 500.0], [1.0, 0.0, 0.0], 20e3);
    // Looking along +x, up is +z and the right −y.
    let turn = 0.3f32;
    let axis = PolarisationFrame::Axis([0.0, -turn.sin(), turn.cos()]);
    let (vertical, _) = stokes(&aerial, segment, PolarisationFrame::Vertical).unwrap();
    let (turned, _) = stokes(&aerial, segment, axis).unwrap();
    for (a, b) in vertical.iter().zip(&turned) {
        let a = a.turned(turn);
        assert!((a.q - b.q).abs() < 1e-5 * a.i && (a.u - b.u).abs() < 1e-5 * a.i);
    }
    let error = stokes(&aerial, segment, PolarisationFrame::Axis([0.0; 3]));
    assert!(matches!(error, Err(Error::Direction { .. })));
    let error = stokes(
        &aerial,
        [[0.0; 3], [f64::NAN; 3]],
        PolarisationFrame::Vertical,
    );
    assert!(matches!(error, Err(Error::Point { .. })));
    let (none, through) = stokes(&aerial, [[1.0; 3]; 2], PolarisationFrame::SunAligned).unwrap();
    assert!(none.iter().all(|s| *s == Stokes::default()) && through.iter().all(|&t| t == 1.0));
    let n = aerial.wavelengths().len();
    let [mut i, mut q, mut u, mut through] = [n, n, n - 1, n].map(|n| vec![0.0; n]);
    let short = StokesSpectra {
        i: &mut i,
        q: &mut q,
        u: &mut u,
    };
    let error = aerial.in_scattering_stokes(segment[0], segment[1], axis, short, &mut through);
    assert!(matches!(error, Err(Error::Length { got, .. }) if got == n as u64 - 1));
}

/// 90° from the sun a polariser across the plane of the sun takes most of the aerial perspective away, and turned by
/// 90° it keeps it; what is behind is dimmed alike.
#[test]
fn a_polariser_lifts_haze() {
    let conditions = Conditions {
        solar_elevation: 25f64.to_radians(),
        solar_azimuth: 0.0,
        visibility: 100e3,
        ..conditions(25.0)
    };
    let aerial = MODEL.aerial_perspective(&conditions).unwrap();
    let [from, to] = along([0.0, 0.0, 1500.0], unit(0.0, FRAC_PI_2), 30e3);
    let ([_, green, blue], through) = aerial
        .linear_srgb_stokes(from, to, PolarisationFrame::SunAligned)
        .unwrap();
    for colour in [green, blue] {
        let kept = colour.through_polariser(0.0);
        let lifted = colour.through_polariser(FRAC_PI_2 as f32);
        assert!(lifted < 0.6 * kept, "{lifted} {kept}");
        assert!((lifted + kept - colour.i).abs() < 1e-4 * colour.i);
    }
    let (same, factors) = aerial.linear_srgb(from, to).unwrap();
    for (a, b) in through.into_iter().zip(factors) {
        assert!((a - b).abs() <= 1e-5 * b, "{a} {b}");
    }
    assert!((same[1] - green.i).abs() <= 1e-5 * green.i);
}
