//! Transmittance and in-scattered light of finite segments, of a model with simple analytic tables.

mod common;

use common::densities;
use welkin::format::{
    Chunk, DensityTable, Head, Payload, PhaseFunction, SOURCE_FIELDS, SourceBasis, SourceCore,
    encode, extend, harmonics,
};
use welkin::geometry::Side;
use welkin::{AerialPerspective, Conditions, Error, Model};

const SUNS: usize = 5;
const NW: usize = 6;

fn chunk(visibility: Option<usize>, payload: Payload) -> Chunk {
    Chunk {
        altitude: None,
        visibility,
        error_median: 0.0,
        error_p99: 0.0,
        payload,
    }
}

/// Isotropic light that does not depend on anything but the field.
fn basis() -> SourceBasis {
    let moments = 4 + harmonics(2, 1);
    let mut moment = vec![0.0; moments];
    moment[..3].fill(0.5);
    // Y₀₀ = 1/√4π.
    moment[4] = (4.0 * std::f32::consts::PI).sqrt();
    SourceBasis {
        degree: 2,
        orders: 1,
        ranks: [1; 4],
        altitude: vec![0.0, 5000.0, 100_000.0],
        sun: vec![-0.3, -0.1, 0.0, 0.3, 1.0],
        factors: [vec![1.0; 3], vec![1.0; SUNS], moment, vec![1.0; 2 * NW]],
    }
}

fn source(head: &Head, level: f32) -> SourceCore {
    let scattering = |k: usize| -> Vec<f32> {
        let row = &head.extinction[k * NW..(k + 1) * NW];
        row.iter().map(|&v| 0.9 * v as f32).collect()
    };
    let none = vec![0.0; NW];
    SourceCore {
        ranks: [1; 4],
        phase: vec![PhaseFunction::Rayleigh, PhaseFunction::HenyeyGreenstein],
        parameter: [vec![0.03; NW], vec![0.7; NW]].concat(),
        scattering: [scattering(0), none.clone(), none, scattering(1)].concat(),
        level: vec![level; SOURCE_FIELDS * SUNS * NW],
        core: vec![1.0],
    }
}

fn model_with(level: f32) -> Model {
    let head = common::head(&[0.0], &[20e3]);
    let chunks = [
        chunk(None, Payload::Transmittance(densities())),
        chunk(None, Payload::SourceBasis(basis())),
        chunk(Some(0), Payload::Source(source(&head, level))),
    ];
    Model::from_bytes(encode(&head, &chunks).unwrap()).unwrap()
}

fn conditions(elevation: f64) -> Conditions {
    Conditions {
        solar_elevation: elevation.to_radians(),
        solar_azimuth: 0.4,
        visibility: 20e3,
        albedo: 0.3,
        altitude: 0.0,
    }
}

fn aerial(elevation: f64) -> AerialPerspective {
    model_with(-3.0)
        .aerial_perspective(&conditions(elevation))
        .unwrap()
}

fn seen(aerial: &AerialPerspective, from: [f64; 3], to: [f64; 3]) -> ([f32; NW], [f32; NW]) {
    let (mut light, mut through) = ([0.0; NW], [0.0; NW]);
    aerial
        .in_scattering(from, to, &mut light, &mut through)
        .unwrap();
    (light, through)
}

/// Grazing lines that dip, steep ones, level ones; from 1 m to beyond the air.
fn segments() -> Vec<([f64; 3], [f64; 3])> {
    let mut out = vec![];
    for i in 0..400 {
        let u = |step: f64| (f64::from(i) * step).fract();
        let elevation = match i % 2 {
            0 => 0.1 * (2.0 * u(0.618_034) - 1.0).powi(3),
            _ => std::f64::consts::PI * (u(0.618_034) - 0.5),
        };
        let length = 10f64.powf(6.2 * u(0.754_878));
        let azimuth = 6.3 * u(0.569_84);
        let from = [0.0, 0.0, 12_000.0 * u(0.430_16)];
        let direction = [
            elevation.cos() * azimuth.cos(),
            elevation.cos() * azimuth.sin(),
            elevation.sin(),
        ];
        out.push((
            from,
            std::array::from_fn(|k| from[k] + length * direction[k]),
        ));
    }
    out
}

fn between(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
}

#[test]
fn transmittance_is_consistent() {
    let aerial = aerial(20.0);
    let air = aerial.transmittance();
    let t = |a, b| {
        let mut out = [0.0; NW];
        air.transmittance(a, b, &mut out).unwrap();
        out
    };
    for (a, b) in segments() {
        assert_eq!(t(a, a), [1.0; NW]);
        let (whole, back) = (t(a, b), t(b, a));
        let middle = between(a, b, 0.37);
        let (near, far) = (t(a, middle), t(middle, b));
        let mut last = [1.0; NW];
        for step in 0..=50 {
            let now = t(a, between(a, b, f64::from(step) / 50.0));
            assert!(
                now.iter().zip(last).all(|(n, l)| *n <= l * (1.0 + 1e-6)),
                "{a:?} {b:?}"
            );
            last = now;
        }
        for w in 0..NW {
            assert!((0.0..=1.0).contains(&whole[w]));
            if whole[w] < 1e-30 {
                // Single precision ends here.
                continue;
            }
            let tolerance = 4e-6 * (1.0 - whole[w].ln());
            assert!((back[w] / whole[w] - 1.0).abs() < tolerance, "{a:?} {b:?}");
            assert!(
                (near[w] * far[w] / whole[w] - 1.0).abs() < tolerance,
                "{a:?} {b:?}"
            );
        }
    }
}

#[test]
fn space_is_reached_or_the_ground_is_in_the_way() {
    let aerial = aerial(20.0);
    let mut out = [0.5; NW];
    let air = aerial.transmittance();
    air.transmittance_to_space([0.0, 0.0, 1000.0], [0.1, 0.0, -1.0], &mut out)
        .unwrap();
    assert_eq!(out, [0.0; NW]);
    air.transmittance_to_space([0.0, 0.0, 1000.0], [0.0, 0.0, 3.0], &mut out)
        .unwrap();
    let (mut far, up) = ([0.0; NW], [0.0, 0.0, 200_000.0]);
    air.transmittance([0.0, 0.0, 1000.0], up, &mut far).unwrap();
    for w in 0..NW {
        assert!((out[w] / far[w] - 1.0).abs() < 1e-5);
    }
}

/// Light of isotropic particles in a thick medium under no sun saturates at the source over the extinction.
#[test]
fn a_uniform_source_saturates() {
    let model = model_with(-3.0);
    // Sun far below: no direct light, levels and factors are constant.
    let aerial = model.aerial_perspective(&conditions(-4.2)).unwrap();
    let head = model.head();
    let (light, through) = seen(&aerial, [0.0, 0.0, 10.0], [300_000.0, 0.0, -7000.0]);
    for w in 0..NW {
        let s = head.spherical_albedo[w];
        let level = (-3f64).exp() * (1.0 + 0.3 / (1.0 - 0.3 * s));
        let expected = 0.9 * level * head.solar_irradiance_at(head.wavelengths[w]);
        let opacity = 1.0 - f64::from(through[w]);
        let got = f64::from(light[w]) / opacity;
        assert!((got / expected - 1.0).abs() < 2e-3, "{w}: {got} {expected}");
    }
}

#[test]
fn in_scattering_is_linear_at_first_adds_up_and_is_never_negative() {
    for elevation in [-4.0, 0.0, 8.0, 60.0] {
        let aerial = aerial(elevation);
        let mut differences = vec![];
        for (a, b) in segments() {
            let (whole, through) = seen(&aerial, a, b);
            assert!(whole.iter().all(|l| *l >= 0.0 && l.is_finite()));
            assert_eq!(seen(&aerial, a, a).0, [0.0; NW]);
            let length = (0..3).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
            let [one, two] = [1.0, 2.0].map(|d| seen(&aerial, a, between(a, b, d / length)).0);
            let middle = between(a, b, 0.4);
            let (near, t) = seen(&aerial, a, middle);
            let (far, _) = seen(&aerial, middle, b);
            let mut transmittance = [0.0; NW];
            aerial
                .transmittance()
                .transmittance(a, b, &mut transmittance)
                .unwrap();
            for w in 0..NW {
                assert!((two[w] - 2.0 * one[w]).abs() <= 2e-3 * two[w]);
                assert!((through[w] - transmittance[w]).abs() <= 1e-6);
                let sum = near[w] + t[w] * far[w];
                differences.push(f64::from((sum / whole[w].max(1e-20) - 1.0).abs()));
            }
        }
        differences.sort_by(f64::total_cmp);
        let quantile = |share: f64| differences[(share * (differences.len() - 1) as f64) as usize];
        let [median, p99, max] = [0.5, 0.99, 1.0].map(quantile);
        println!(
            "sun {elevation}°: halves differ from the whole by {median:.4}, {p99:.4}, {max:.4}"
        );
        assert!(median < 1e-4, "sun {elevation}°: {median}");
        assert!(p99 < 0.009, "sun {elevation}°: {p99}");
        // A few grazing segments at sunset end their panels elsewhere when they are divided.
        assert!(max < 0.21, "sun {elevation}°: {max}");
    }
}

#[test]
fn beyond_the_air_nothing_changes() {
    let aerial = aerial(15.0);
    let (from, direction) = ([0.0, 0.0, 500.0], [0.9, 0.1, 0.2]);
    let at = |d: f64| {
        seen(
            &aerial,
            from,
            std::array::from_fn(|k| from[k] + d * direction[k]),
        )
        .0
    };
    let (mut end, mut t) = ([0.0; NW], [0.0; NW]);
    aerial.to_end(from, direction, &mut end, &mut t).unwrap();
    for (a, b) in [(at(2e6), at(9e6)), (at(2e6), end)] {
        assert!(
            a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-3),
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn turning_sun_and_segment_together_changes_nothing() {
    let mut aerial = aerial(10.0);
    let (from, to) = ([10.0, 20.0, 800.0], [9000.0, 3000.0, 2500.0]);
    let before = seen(&aerial, from, to).0;
    let turn = |[x, y, z]: [f64; 3]| [-y, x, z];
    aerial
        .set_solar_azimuth(0.4 + std::f64::consts::FRAC_PI_2)
        .unwrap();
    let after = seen(&aerial, turn(from), turn(to)).0;
    assert!(
        before
            .iter()
            .zip(after)
            .all(|(a, b)| (a / b - 1.0).abs() < 1e-5)
    );
}

#[test]
fn batches_and_colours_agree_with_single_queries() {
    let model = model_with(-3.0);
    let aerial = model.aerial_perspective(&conditions(10.0)).unwrap();
    let camera = [0.0, 0.0, 300.0];
    let points = [[5000.0, 0.0, 100.0], [0.0, 40_000.0, 6000.0]];
    let (mut light, mut through) = ([0.0; 2 * NW], [0.0; 2 * NW]);
    aerial
        .in_scattering_batch(camera, &points, &mut light, &mut through)
        .unwrap();
    for (i, point) in points.into_iter().enumerate() {
        let single = seen(&aerial, camera, point);
        assert_eq!(light[i * NW..][..NW], single.0);
        assert_eq!(through[i * NW..][..NW], single.1);
        let (xyz, factors) = aerial.xyz(camera, point).unwrap();
        let head = model.head();
        let mut expected = 0.0;
        for (w, l) in head.wavelengths.iter().enumerate() {
            expected += f64::from(single.0[w]) / head.solar_irradiance_at(*l) * head.xyz[w][1];
        }
        assert!((f64::from(xyz[1]) / expected - 1.0).abs() < 1e-5);
        assert!(factors.iter().all(|f| (0.0..=1.0).contains(f)));
    }
}

#[test]
#[cfg(feature = "default-model")]
fn along_a_ray_pieces_add_up_to_segments() {
    let model = Model::default_model().unwrap();
    let camera = [0.0, 0.0, 1500.0];
    let distances: Vec<f64> = (0..24).map(|i| 30.0 * 1.4f64.powi(i)).collect();
    for elevation in [0.6, 0.05, -0.06] {
        let conditions = conditions(elevation);
        let aerial = model.aerial_perspective(&conditions).unwrap();
        let colour = model.colour_aerial_perspective(&conditions).unwrap();
        let n = aerial.wavelengths().len();
        for direction in [[3.0, 0.0, 0.2], [-0.5, 0.8, -0.02], [0.0, 0.1, 2.0]] {
            let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
            let count = distances.len();
            let [mut light, mut through] = [(); 2].map(|()| vec![0.0; n * count]);
            aerial
                .in_scattering_along(camera, direction, &distances, &mut light, &mut through)
                .unwrap();
            let [mut rgb, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; count]);
            colour
                .linear_srgb_along(camera, direction, &distances, &mut rgb, &mut factors)
                .unwrap();
            for (k, distance) in distances.iter().enumerate() {
                let to = std::array::from_fn(|i| camera[i] + distance * direction[i] / length);
                let [mut whole, mut t] = [(); 2].map(|()| vec![0.0; n]);
                aerial
                    .in_scattering(camera, to, &mut whole, &mut t)
                    .unwrap();
                let brightest = whole.iter().fold(0f32, |a, &b| a.max(b));
                for w in 0..n {
                    let (got, expected) = (light[k * n + w], whole[w]);
                    assert!((got - expected).abs() <= 0.05 * expected + 1e-3 * brightest);
                    assert!((through[k * n + w] - t[w]).abs() < 1e-3);
                    if k > 0 {
                        assert!(got >= light[(k - 1) * n + w]);
                        assert!(through[k * n + w] <= through[(k - 1) * n + w]);
                    }
                }
                let (single, single_factors) = colour.linear_srgb(camera, to).unwrap();
                let (full, _) = aerial.linear_srgb(camera, to).unwrap();
                for c in 0..3 {
                    assert!((rgb[k][c] - single[c]).abs() <= 0.05 * single[1]);
                    assert!((factors[k][c] - single_factors[c]).abs() < 2e-3);
                    assert!(
                        (full[c] - single[c]).abs() <= 0.03 * full[1],
                        "{elevation} {direction:?} {distance} {full:?} {single:?}"
                    );
                }
            }
        }
        let [mut light, mut factors] = [[[0.0; 3]; 2]; 2];
        let mut ask = |direction, distances: &[f64]| {
            colour.linear_srgb_along(camera, direction, distances, &mut light, &mut factors)
        };
        let up = [0.0, 0.0, 1.0];
        assert!(matches!(
            ask([0.0; 3], &[1.0, 2.0]),
            Err(Error::Direction { .. })
        ));
        for bad in [[2.0, 1.0], [-1.0, 1.0], [1.0, f64::NAN], [1.0, 1e10]] {
            assert!(matches!(ask(up, &bad), Err(Error::OutOfRange { .. })));
        }
        assert!(matches!(ask(up, &[1.0]), Err(Error::Length { .. })));
    }
}

#[test]
fn bad_questions_are_refused() {
    let aerial = aerial(10.0);
    let (mut light, mut through) = ([0.0; NW], [0.0; NW]);
    let mut ask = |to: [f64; 3]| aerial.in_scattering([0.0; 3], to, &mut light, &mut through);
    for bad in [f64::NAN, f64::INFINITY, 2e9] {
        assert!(matches!(ask([0.0, bad, 0.0]), Err(Error::Point { .. })));
    }
    // Deep underground there is still an answer, beyond the planet's centre there is none.
    ask([0.0, 0.0, -6e6]).unwrap();
    let beyond = ask([0.0, 0.0, -9e8]).unwrap_err();
    assert!(matches!(beyond, Error::Reach { .. }) && beyond.class() == "point");
    assert!(through.iter().chain(&light).all(|v| v.is_finite()));
    let mut short = [0.0; 2];
    let wrong = aerial.in_scattering([0.0; 3], [1.0; 3], &mut short, &mut through);
    assert!(matches!(wrong, Err(Error::Length { .. })));
    let nowhere = aerial.to_end([0.0; 3], [0.0; 3], &mut light, &mut through);
    assert!(matches!(nowhere, Err(Error::Direction { .. })));
    let model = model_with(-3.0);
    assert!(matches!(
        model.transmittance(1.0),
        Err(Error::OutOfRange { .. })
    ));
    let plain = Model::from_bytes(common::model_bytes()).unwrap();
    let missing = plain.aerial_perspective(&Conditions {
        visibility: 40e3,
        ..Conditions::default()
    });
    assert!(matches!(
        missing,
        Err(Error::MissingChunk {
            kind: "transmittance",
            ..
        })
    ));
}

#[test]
fn hostile_payloads_are_typed_errors() {
    let head = common::head(&[0.0], &[20e3]);
    let refused = |payload| {
        let error = encode(&head, &[chunk(None, payload)]).unwrap_err();
        assert!(
            matches!(error, Error::Invalid { .. } | Error::Length { .. }),
            "{error}"
        );
    };
    let density = |change: &dyn Fn(&mut DensityTable)| {
        let mut table = densities();
        change(&mut table);
        refused(Payload::Transmittance(table));
    };
    density(&|t| t.edges[1] = f64::NAN);
    density(&|t| t.edges[1] = 30_000.0);
    density(&|t| t.edges[3] = 90_000.0);
    density(&|t| t.density[4] = -1e-3);
    density(&|t| t.density[4] = f32::NAN);
    density(&|t| t.density.truncate(5));
    density(&|t| *t = DensityTable::default());
    let shared = |change: &dyn Fn(&mut SourceBasis)| {
        let mut table = basis();
        change(&mut table);
        refused(Payload::SourceBasis(table));
    };
    shared(&|b| b.degree = 99);
    shared(&|b| b.orders = 3);
    shared(&|b| b.ranks[2] = 33);
    shared(&|b| b.sun[1] = 0.5);
    shared(&|b| b.altitude[2] = f64::INFINITY);
    shared(&|b| b.factors[3][2] = f32::NAN);
    let core = |change: &dyn Fn(&mut SourceCore)| {
        let mut table = source(&head, 0.0);
        change(&mut table);
        let error = encode(&head, &[chunk(Some(0), Payload::Source(table))]).unwrap_err();
        assert!(
            matches!(error, Error::Invalid { .. } | Error::Length { .. }),
            "{error}"
        );
    };
    core(&|c| c.phase[1] = PhaseFunction::None);
    core(&|c| c.parameter[NW] = 1.0);
    core(&|c| c.scattering[0] = -1.0);
    core(&|c| c.core = vec![f32::INFINITY]);
    core(&|c| c.level.truncate(7));
    // Bytes that change after writing: no panic, whatever they are.
    let good = [
        chunk(None, Payload::Transmittance(densities())),
        chunk(None, Payload::SourceBasis(basis())),
        chunk(Some(0), Payload::Source(source(&head, -3.0))),
    ];
    let file = encode(&head, &good).unwrap();
    let contents = welkin::format::parse(&file).unwrap();
    for (i, entry) in contents.directory.iter().enumerate() {
        for at in 0..entry.length {
            for value in [0x00, 0x7f, 0xff] {
                let mut payload = file[entry.offset..entry.offset + entry.length].to_vec();
                payload[at] = value;
                let Ok(model) = Model::from_bytes(common::with_chunk(&file, i, &payload)) else {
                    continue;
                };
                if let Ok(aerial) = model.aerial_perspective(&conditions(3.0)) {
                    let (light, through) = seen(&aerial, [0.0, 0.0, 100.0], [3e5, 0.0, 9e3]);
                    assert!(
                        light
                            .iter()
                            .chain(&through)
                            .all(|v| v.is_finite() && *v >= 0.0)
                    );
                }
            }
        }
    }
}

#[test]
fn sources_that_do_not_fit_their_basis_are_refused() {
    let head = common::head(&[0.0], &[20e3]);
    let mut other = source(&head, 0.0);
    other.ranks = [1, 1, 2, 1];
    other.core = vec![1.0; 2];
    let air = chunk(None, Payload::Transmittance(densities()));
    let shared = chunk(None, Payload::SourceBasis(basis()));
    let misfit = chunk(Some(0), Payload::Source(other));
    let all = [air.clone(), shared.clone(), misfit.clone()];
    let refused = |outcome| matches!(outcome, Err(Error::Invalid { .. }));
    assert!(refused(encode(&head, &all)));
    let file = encode(&head, &all[..2]).unwrap();
    assert!(refused(extend(&file, &all[2..])));
    let good = chunk(Some(0), Payload::Source(source(&head, 0.0)));
    let good = extend(&file, &[good]).unwrap();
    // A basis of other ranks does not fit the source that is there.
    let mut wider = basis();
    wider.ranks[2] = 2;
    wider.factors[2] = wider.factors[2].repeat(2);
    let wider = chunk(None, Payload::SourceBasis(wider));
    assert!(refused(extend(&good, std::slice::from_ref(&wider))));
    // Where no writer stood in the way, the reader does.
    let other = encode(&head, &[air, wider, misfit]).unwrap();
    let entry = &welkin::format::parse(&other).unwrap().directory[2];
    let stored = &other[entry.offset..entry.offset + entry.length];
    let model = Model::from_bytes(common::with_chunk(&good, 2, stored)).unwrap();
    let aerial = model.aerial_perspective(&conditions(10.0));
    assert!(matches!(aerial, Err(Error::Invalid { .. })));
}

#[test]
fn chunks_are_added_replaced_and_cropped() {
    let plain = common::model_bytes();
    let head = welkin::format::parse(&plain).unwrap().head;
    let (nw, nv) = (head.wavelengths.len(), head.visibilities.len());
    assert_eq!(nw, NW);
    let mut new = vec![
        chunk(None, Payload::Transmittance(densities())),
        chunk(None, Payload::SourceBasis(basis())),
    ];
    new.extend((0..nv).map(|v| chunk(Some(v), Payload::Source(source(&head, -3.0)))));
    let once = extend(&plain, &new).unwrap();
    assert_eq!(extend(&once, &new).unwrap(), once);
    let before = welkin::format::parse(&plain).unwrap().directory.len();
    let after = welkin::format::parse(&once).unwrap().directory.len();
    assert_eq!(after, before + new.len());
    let (mut head, mut chunks) = welkin::format::unpack(&once).unwrap();
    assert_eq!(encode(&head, &chunks).unwrap(), once);
    let mut selection = welkin::format::Selection::all(&head);
    selection.wavelengths = vec![1, 4];
    welkin::format::crop(&mut head, &mut chunks, &selection).unwrap();
    let small = Model::from_bytes(encode(&head, &chunks).unwrap()).unwrap();
    let whole = Model::from_bytes(once).unwrap();
    let place = Conditions {
        visibility: 40e3,
        ..Conditions::default()
    };
    let ask = |model: &Model, n: usize| {
        let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
        let aerial = model.aerial_perspective(&place).unwrap();
        aerial
            .in_scattering([0.0; 3], [9e3, 0.0, 2e3], &mut light, &mut through)
            .unwrap();
        (light, through)
    };
    let (cropped, all) = (ask(&small, 2), ask(&whole, NW));
    for (i, w) in selection.wavelengths.into_iter().enumerate() {
        assert!((cropped.0[i] / all.0[w] - 1.0).abs() < 0.01);
        assert!((cropped.1[i] / all.1[w] - 1.0).abs() < 1e-5);
    }
}

/// Rays through all of the air by the source and by the fitted sky: two ways to the same light, with errors of their
/// own.
#[test]
fn to_the_limb_the_light_of_the_air_is_the_sky() {
    let model = Model::default_model().unwrap();
    let n = model.wavelengths().len();
    let mut differences: [Vec<f64>; 4] = Default::default();
    for (i, (place, direction)) in views(400).enumerate() {
        let [night, steep] = [i % 2 == 1, i / 2 % 2 == 1];
        let [mut sky, mut aerial, mut through] = [(); 3].map(|()| vec![0.0; n]);
        let fitted = model.sky(&place).unwrap();
        fitted
            .radiance(direction.map(|v| v as f32), &mut sky)
            .unwrap();
        let from = [0.0, 0.0, place.altitude];
        let integrated = model.aerial_perspective(&place).unwrap();
        integrated
            .to_end(from, direction, &mut aerial, &mut through)
            .unwrap();
        let judged = |w: &usize| sky[*w] > 0.0 && common::CLEAR.contains(&model.wavelengths()[*w]);
        let apart = |w: usize| f64::from((aerial[w] / sky[w] - 1.0).abs());
        let relative = (0..n).filter(judged).map(apart);
        differences[2 * usize::from(night) + usize::from(steep)].extend(relative);
    }
    let names = [
        "day, near the horizon",
        "day, elsewhere",
        "twilight, near the horizon",
        "twilight, elsewhere",
    ];
    let limits = [[0.011, 0.045], [0.005, 0.019], [0.03, 0.27], [0.009, 0.05]];
    for ((name, mut all), limits) in names.into_iter().zip(differences).zip(limits) {
        all.sort_by(f64::total_cmp);
        let quantile = |share: f64| all[(share * (all.len() - 1) as f64) as usize];
        let [median, p95, p99] = [0.5, 0.95, 0.99].map(quantile);
        println!("{name}: segments and sky differ by {median:.4}, {p95:.4}, {p99:.4}");
        assert!(
            median < limits[0] && p95 < limits[1],
            "{name}: {median} {p95}"
        );
    }
}

/// Conditions and directions all over the model, half of them near the horizon, half of the suns below it.
fn views(count: usize) -> impl Iterator<Item = (Conditions, [f64; 3])> {
    (0..count).map(|i| {
        let u = |step: f64| ((i + 1) as f64 * step).fract();
        let sun = match i % 2 {
            0 => 60.0 * u(0.754_878).powi(2),
            _ => -4.2 * u(0.754_878).powf(1.5),
        };
        let place = Conditions {
            solar_elevation: sun.to_radians(),
            solar_azimuth: 0.0,
            visibility: 20e3 + 111.8e3 * u(0.569_84).powi(2),
            albedo: u(0.430_16),
            altitude: 15e3 * u(0.324_7).powi(2),
        };
        let t = 2.0 * u(0.618_034) - 1.0;
        let elevation = if i / 2 % 2 == 0 {
            0.035 * t.powi(3)
        } else {
            t.asin()
        };
        let ((z, r), (y, x)) = (
            elevation.sin_cos(),
            (std::f64::consts::PI * u(0.245_1)).sin_cos(),
        );
        (place, [r * x, r * y, z])
    })
}

#[test]
fn before_its_sky_every_way_ends_in_it_without_a_step() {
    let model = Model::default_model().unwrap();
    let n = model.wavelengths().len();
    let (mut worst_step, mut worst_end) = (0f32, 0f32);
    for (place, direction) in views(60) {
        let (aerial, sky) = (
            model.aerial_perspective(&place).unwrap(),
            model.sky(&place).unwrap(),
        );
        let front = aerial.joined_to(&sky).unwrap();
        let from = front.camera();
        let planet = aerial.transmittance().planet();
        let way = planet.ray(place.altitude, direction[2].asin());
        let (whole, open) = (way.length, way.side == Side::Up);
        let mut seen = vec![0.0; n];
        sky.radiance(direction.map(|v| v as f32), &mut seen)
            .unwrap();
        let mut before: Option<[Vec<f32>; 2]> = None;
        let away = (-100..=0).map(|step| 0.5 * 1.02f64.powi(step));
        let closer = (1..=350).map(|step| 1.0 - 0.5 * 0.96f64.powi(step));
        for share in away.chain(closer).chain([1.0]) {
            let distance = whole * share;
            let to = std::array::from_fn(|k| from[k] + distance * direction[k]);
            let [mut joined, mut own, mut through] = [(); 3].map(|()| vec![0.0; n]);
            front.in_scattering(to, &mut joined, &mut through).unwrap();
            aerial
                .in_scattering(from, to, &mut own, &mut through)
                .unwrap();
            assert!(joined.iter().all(|l| *l >= 0.0 && l.is_finite()));
            if let Some([joined_before, own_before]) = before {
                for w in (0..n).filter(|&w| common::CLEAR.contains(&model.wavelengths()[w])) {
                    let step = (joined[w] - joined_before[w]).abs();
                    let own_step = (own[w] - own_before[w]).abs();
                    let apart = (seen[w] - own[w]).abs().max(1e-3 * seen[w]);
                    worst_step = worst_step.max((step - own_step) / apart);
                }
            }
            if share == 1.0 && open {
                let ends = joined.iter().zip(&seen);
                worst_end = ends.fold(worst_end, |e, (a, b)| e.max((a / b - 1.0).abs()));
            }
            before = Some([joined, own]);
        }
    }
    // A step of 2 % of the way, or of 4 % of the rest, goes no farther than the aerial perspective does and a part of
    // what is left to the sky.
    println!("steps towards the sky: {worst_step}; the end from the sky: {worst_end}");
    assert!(worst_step < 0.18 && worst_end < 1e-5);
}

#[test]
fn well_inside_the_sky_adds_nothing() {
    let model = Model::default_model().unwrap();
    let n = model.wavelengths().len();
    let place = Conditions::default();
    let (aerial, sky) = (
        model.aerial_perspective(&place).unwrap(),
        model.sky(&place).unwrap(),
    );
    let front = aerial.joined_to(&sky).unwrap();
    let points = [
        [900.0, 20.0, 30.0],
        [7000.0, 3000.0, 2000.0],
        [0.0, -3000.0, 3000.0],
    ];
    let [mut joined, mut own, mut through] = [(); 3].map(|()| vec![0.0; points.len() * n]);
    front
        .in_scattering_batch(&points, &mut joined, &mut through)
        .unwrap();
    let same = through.clone();
    aerial
        .in_scattering_batch(front.camera(), &points, &mut own, &mut through)
        .unwrap();
    assert_eq!((joined, same), (own, through));
    for point in points {
        let [a, b] = [
            front.linear_srgb(point),
            aerial.linear_srgb(front.camera(), point),
        ];
        assert_eq!(a.unwrap(), b.unwrap());
    }
}

#[test]
fn only_a_sky_of_the_same_scene_is_taken() {
    let model = Model::default_model().unwrap();
    let place = Conditions::default();
    let aerial = model.aerial_perspective(&place).unwrap();
    let higher = Conditions {
        altitude: 3000.0,
        ..place
    };
    assert!(aerial.joined_to(&model.sky(&higher).unwrap()).is_ok());
    for other in [
        Conditions {
            solar_elevation: 0.1,
            ..place
        },
        Conditions {
            solar_azimuth: 0.1,
            ..place
        },
        Conditions {
            visibility: 30e3,
            ..place
        },
        Conditions {
            albedo: 0.7,
            ..place
        },
    ] {
        let sky = model.sky(&other).unwrap();
        let refused = aerial.joined_to(&sky);
        assert!(
            matches!(refused, Err(Error::OutOfRange { .. })),
            "{other:?}"
        );
    }
    let front_sky = model.sky(&place).unwrap();
    let front = aerial.joined_to(&front_sky).unwrap();
    let (mut short, mut through) = ([0.0; 2], [0.0; 2]);
    let wrong = front.in_scattering([1.0; 3], &mut short, &mut through);
    assert!(matches!(wrong, Err(Error::Length { .. })));
    assert!(matches!(front.xyz([f64::NAN; 3]), Err(Error::Point { .. })));
}

/// Eq. 2 of the paper, from skies that are prepared one by one.
#[cfg(feature = "default-model")]
#[test]
fn the_difference_of_skies_is_that_of_prepared_skies() {
    let model = Model::default_model().unwrap();
    let conditions = Conditions {
        solar_azimuth: 0.7,
        ..Conditions::default()
    };
    let difference = model.sky_difference(&conditions).unwrap();
    let n = model.head().wavelengths.len();
    let (from, to) = ([0.0, 0.0, 50.0], [0.0, 0.0, 9000.0]);
    let mut got = vec![0.0; n];
    difference.in_scattering(from, to, &mut got).unwrap();
    let [near, far] = [from, to].map(|point| {
        let altitude = point[2];
        let sky = model
            .sky(&Conditions {
                altitude,
                ..conditions
            })
            .unwrap();
        let mut out = vec![0.0; n];
        sky.relative_radiance([0.0, 0.0, 1.0], &mut out).unwrap();
        out
    });
    let mut through = vec![0.0; n];
    let air = model.transmittance(conditions.visibility).unwrap();
    air.transmittance(from, to, &mut through).unwrap();
    for w in 0..n {
        let expected = near[w] - through[w] * far[w];
        assert!(
            (got[w] - expected).abs() <= 1e-5 * near[w],
            "{w}: {} {expected}",
            got[w]
        );
    }
    let mut blurred = vec![0.0; n];
    let level = [20e3, 3e3, 50.0];
    difference.blurred(from, level, &mut blurred).unwrap();
    difference.in_scattering(from, level, &mut got).unwrap();
    assert!(blurred.iter().all(|&l| l >= 0.0) && blurred != got);
    let beyond = difference.in_scattering(from, [0.0, 0.0, 99.5e3], &mut got);
    assert!(
        matches!(beyond, Err(Error::OutOfRange { .. })),
        "{beyond:?}"
    );
    assert!(difference.in_scattering(from, to, &mut got[1..]).is_err());
}
