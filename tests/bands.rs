//! Bands of sensors against fine sums over single wavelengths.

mod common;

use common::random::Random;
use welkin::format::{Chunk, Payload, Spectrum, extend};
use welkin::{Bands, Conditions, Error, Model, PolarisationFrame, Response, Stokes};

/// The embedded model with cells between its nodes, whose weights no curve through the nodes has.
fn with_spectrum() -> (Model, Spectrum) {
    let model = Model::default_model().unwrap();
    let head = model.head();
    let nodes = &head.wavelengths;
    let wavelength: Vec<f64> = (0..45).map(|c| 322.0 + 9.7 * f64::from(c)).collect();
    let (mut tap_node, mut tap_weight) = (Vec::new(), Vec::new());
    for (c, l) in wavelength.iter().enumerate() {
        let i = nodes.partition_point(|n| n <= l).clamp(1, nodes.len() - 2);
        let t = ((l - nodes[i - 1]) / (nodes[i] - nodes[i - 1])) as f32;
        let lean = 0.1 * (c as f32).sin();
        tap_node.extend([i - 1, i, i + 1].map(|n| n as u32));
        tap_weight.extend([1.0 - t - lean, t + 2.0 * lean, -lean]);
    }
    let (cells, nk) = (wavelength.len(), head.constituents);
    let extinction = (0..head.visibilities.len() * nk * cells).map(|i| {
        let (v, k, c) = (i / cells / nk, i / cells % nk, i % cells);
        let near = nodes.partition_point(|n| *n < wavelength[c]);
        head.extinction[(v * nk + k) * nodes.len() + near.min(nodes.len() - 1)] as f32
    });
    let spectrum = Spectrum {
        taps: 3,
        terms: 2,
        tap_node,
        tap_weight,
        extinction: extinction.collect(),
        term_weight: [0.7, 0.3].repeat(cells),
        term_extinction: (0..cells * 2 * nk)
            .map(|i| match (i / nk % 2, i % nk) {
                (1, 0) if (i / nk / 2) % 5 == 0 => 2e-5,
                _ => 0.0,
            })
            .collect(),
        example: Vec::new(),
        wavelength,
    };
    let chunk = Chunk::new(None, None, Payload::Spectrum(spectrum.clone()));
    let file = extend(welkin::DEFAULT_MODEL, &[chunk]).unwrap();
    (Model::from_bytes(file).unwrap(), spectrum)
}

/// Relative radiance between nodes as SPEC.md 7.3 says, in a file with a spectrum.
fn by_cells(spectrum: &Spectrum, relative: &[f32], wavelength: f64) -> f64 {
    let after = spectrum.wavelength.partition_point(|l| *l <= wavelength);
    let c = after.clamp(1, spectrum.wavelength.len() - 1) - 1;
    let (l, m) = (spectrum.wavelength[c], spectrum.wavelength[c + 1]);
    let t = (wavelength - l) / (m - l);
    let mut logarithm = 0.0;
    for (cell, share) in [(c, 1.0 - t), (c + 1, t)] {
        for j in cell * spectrum.taps..(cell + 1) * spectrum.taps {
            let radiance = f64::from(relative[spectrum.tap_node[j] as usize]);
            logarithm += share * f64::from(spectrum.tap_weight[j]) * radiance.ln();
        }
    }
    logarithm.exp()
}

fn conditions(random: &mut Random) -> Conditions {
    Conditions {
        solar_elevation: random.between(-0.05, 1.5),
        solar_azimuth: random.between(0.0, 6.0),
        visibility: random.between(20e3, 131.8e3),
        albedo: random.share(),
        altitude: 10e3 * random.share().powi(3),
    }
}

fn view(random: &mut Random) -> [f32; 3] {
    common::direction(random.between(0.001, 1.57), random.between(0.0, 6.28))
}

fn bell(centre: f64, width: f64) -> Response {
    let at = |i: i32| centre + width * f64::from(i) / 10.0;
    let wavelengths: Vec<f64> = (-30..=30).map(at).collect();
    let value = |l: &f64| (-0.5 * ((l - centre) / width).powi(2)).exp();
    let values: Vec<f64> = wavelengths.iter().map(value).collect();
    Response::table(&wavelengths, &values).unwrap()
}

fn bell_at(wavelength: f64, centre: f64, width: f64) -> f64 {
    let i = (wavelength - centre) / width * 10.0;
    if i.abs() > 30.0 {
        return 0.0;
    }
    let at = |i: f64| (-0.5 * (i / 10.0).powi(2)).exp();
    at(i.floor()) + (i - i.floor()) * (at(i.floor() + 1.0) - at(i.floor()))
}

/// Bells and boxes, wide and narrow.
const BELLS: [[f64; 2]; 5] = [
    [450.0, 20.0],
    [540.0, 30.0],
    [610.0, 25.0],
    [655.0, 2.0],
    [500.0, 8.0],
];

fn bells() -> Vec<Response> {
    BELLS.iter().map(|&[c, w]| bell(c, w)).collect()
}

/// Errors of bands against sums in steps of 0.1 nm over `at`, which gives relative radiance of that at the nodes.
fn errors(model: &Model, bands: &Bands, at: impl Fn(&[f32], f64) -> f64) -> Vec<Vec<f64>> {
    let mut random = Random(7);
    let mut errors = vec![Vec::new(); BELLS.len()];
    let mut nodes = vec![0.0; model.wavelengths().len()];
    for _ in 0..40 {
        let conditions = conditions(&mut random);
        let (sky, band_sky) = (
            model.sky(&conditions).unwrap(),
            model.band_sky(&conditions, bands).unwrap(),
        );
        for _ in 0..4 {
            let view = view(&mut random);
            let mut got = [0.0; BELLS.len()];
            band_sky.radiance(view, &mut got).unwrap();
            sky.relative_radiance(view, &mut nodes).unwrap();
            for (b, &[centre, width]) in BELLS.iter().enumerate() {
                let (start, step) = (centre - 3.0 * width, 0.1);
                let steps = (6.0 * width / step).round() as i32;
                let sum: f64 = (0..steps)
                    .map(|i| {
                        let l = start + step * (f64::from(i) + 0.5);
                        let sun = model.head().solar_irradiance_at(l);
                        step * bell_at(l, centre, width) * sun * at(&nodes, l)
                    })
                    .sum();
                errors[b].push((f64::from(got[b]) / sum - 1.0).abs());
            }
        }
    }
    errors.iter_mut().for_each(|e| e.sort_by(f64::total_cmp));
    errors
}

fn check(bands: &Bands, errors: &[Vec<f64>]) {
    for (residual, errors) in bands.residuals().iter().zip(errors) {
        let [median, p99] = [0.5, 0.99].map(|q| errors[(q * (errors.len() - 1) as f64) as usize]);
        println!("{residual:?}: {median:.5} {p99:.5}");
        assert!(
            p99 <= 2.0 * residual.p99.max(Bands::TOLERANCE),
            "{residual:?} {p99}"
        );
        assert!(
            median <= residual.p99.max(Bands::TOLERANCE),
            "{residual:?} {median}"
        );
    }
}

#[test]
fn curves_agree_with_fine_sums() {
    let model = Model::default_model().unwrap();
    let bands = model.bands(&bells()).unwrap();
    let nodes = model.wavelengths().to_vec();
    let at = |light: &[f32], l| f64::from(welkin::between_wavelengths(&nodes, light, l).unwrap());
    check(&bands, &errors(&model, &bands, at));
}

#[test]
fn curves_agree_with_fine_sums_over_a_spectrum() {
    let (model, spectrum) = with_spectrum();
    let bands = model.bands(&bells()).unwrap();
    check(
        &bands,
        &errors(&model, &bands, |light, l| by_cells(&spectrum, light, l)),
    );
}

#[test]
fn single_wavelengths_are_the_radiance_there() {
    let (model, spectrum) = with_spectrum();
    let wavelengths = [331.0, 444.4, 560.0, 612.3, 733.0];
    let bands = model.bands(&wavelengths.map(Response::wavelength)).unwrap();
    let mut random = Random(3);
    let mut nodes = vec![0.0; model.wavelengths().len()];
    for _ in 0..20 {
        let (conditions, view) = (conditions(&mut random), view(&mut random));
        let mut got = [0.0; 5];
        let sky = model.band_sky(&conditions, &bands).unwrap();
        sky.radiance(view, &mut got).unwrap();
        let sky = model.sky(&conditions).unwrap();
        sky.relative_radiance(view, &mut nodes).unwrap();
        for ((&l, got), residual) in wavelengths.iter().zip(got).zip(bands.residuals()) {
            let truth = by_cells(&spectrum, &nodes, l) * model.head().solar_irradiance_at(l);
            let error = (f64::from(got) / truth - 1.0).abs();
            assert!(
                error <= 2.0 * residual.p99.max(1e-5),
                "{l}: {error} {residual:?}"
            );
        }
    }
}

/// What costs time and memory goes with the nodes that bands need, not with those of the file.
#[test]
fn few_nodes_are_a_small_sky() {
    let model = Model::default_model().unwrap();
    let four = [400.0, 440.0, 600.0, 720.0];
    let bands = model.bands(&four.map(Response::wavelength)).unwrap();
    assert_eq!(bands.nodes(), four);
    let mut random = Random(5);
    for _ in 0..10 {
        let (conditions, view) = (conditions(&mut random), view(&mut random));
        let sky = model.sky(&conditions).unwrap();
        let all = common::radiance(&sky, view);
        let narrow = model.band_sky(&conditions, &bands).unwrap();
        assert!(narrow.bytes() < sky.bytes() * 2 / 5);
        let mut got = [0.0; 4];
        narrow.radiance(view, &mut got).unwrap();
        for (got, node) in got.into_iter().zip([2, 3, 7, 10]) {
            assert!((got / all[node] - 1.0).abs() < 2e-6, "{got} {}", all[node]);
        }
    }
}

#[test]
fn polarised_bands_are_sums_of_polarised_light() {
    let model = Model::default_model().unwrap();
    let bands = model.bands(&bells()).unwrap();
    let mut random = Random(11);
    let nodes = model.wavelengths().to_vec();
    for _ in 0..12 {
        let (conditions, view) = (conditions(&mut random), view(&mut random));
        let frame = PolarisationFrame::Vertical;
        let mut got = [Stokes::default(); BELLS.len()];
        let sky = model.polarised_band_sky(&conditions, &bands).unwrap();
        sky.stokes(view, frame, &mut got).unwrap();
        let mut plain = [0.0; BELLS.len()];
        let band_sky = model.band_sky(&conditions, &bands).unwrap();
        band_sky.radiance(view, &mut plain).unwrap();
        let whole = model.polarised_sky(&conditions).unwrap();
        for (b, &[centre, width]) in BELLS.iter().enumerate() {
            let (mut i, mut q, mut u) = (0.0, 0.0, 0.0);
            let step = width / 20.0;
            for k in 0..120 {
                let l = centre - 3.0 * width + step * (f64::from(k) + 0.5);
                assert!((nodes[0]..nodes[11]).contains(&l));
                let light = whole.stokes_at(view, frame, l).unwrap();
                let weight = bell_at(l, centre, width) * step;
                i += weight * f64::from(light.i);
                q += weight * f64::from(light.q);
                u += weight * f64::from(light.u);
            }
            assert!((got[b].i / plain[b] - 1.0).abs() < 1e-5);
            let off = [(got[b].q, q), (got[b].u, u)].map(|(got, sum)| f64::from(got) - sum);
            let off = off[0].hypot(off[1]) / i;
            assert!(off < 0.01, "{centre}: {off}");
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let class = |wavelengths: &[f64], values: &[f64]| {
        Response::table(wavelengths, values).unwrap_err().class()
    };
    assert_eq!(class(&[], &[]), "value");
    assert_eq!(class(&[500.0], &[1.0]), "value");
    assert_eq!(class(&[500.0, 510.0], &[1.0]), "length");
    assert_eq!(class(&[510.0, 500.0], &[1.0, 1.0]), "value");
    assert_eq!(class(&[500.0, f64::NAN], &[1.0, 1.0]), "value");
    assert_eq!(class(&[500.0, 510.0], &[1.0, f64::INFINITY]), "value");
    assert_eq!(class(&[500.0, 510.0], &[1.0, -0.1]), "value");
    assert_eq!(class(&[500.0, 510.0], &[0.0, 0.0]), "value");

    let model = Model::default_model().unwrap();
    let refused = |response: Response| match model.bands(&[response]) {
        Err(Error::OutOfRange { value, .. }) => value,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(Response::wavelength(319.0)), 319.0);
    assert!(refused(Response::wavelength(f64::NAN)).is_nan());
    let wide = Response::table(&[300.0, 400.0], &[1.0, 1.0]).unwrap();
    assert_eq!(refused(wide), 300.0);
    assert_eq!(model.bands(&[]).unwrap_err().class(), "value");
    // Where a curve is zero it may reach beyond the model.
    let zeros = [100.0, 400.0, 420.0, 440.0, 2000.0];
    let zeros = Response::table(&zeros, &[0.0, 0.0, 1.0, 0.0, 0.0]).unwrap();
    let bands = model.bands(&[zeros]).unwrap();

    // Bands belong to the file that they were made for.
    let (other, _) = with_spectrum();
    let refused = other.band_sky(&Conditions::default(), &bands).unwrap_err();
    assert_eq!(refused.class(), "value");
    let sky = model.band_sky(&Conditions::default(), &bands).unwrap();
    assert_eq!(
        sky.radiance([0.0; 3], &mut [0.0]).unwrap_err().class(),
        "direction"
    );
    assert_eq!(
        sky.radiance([1.0; 3], &mut [0.0; 2]).unwrap_err().class(),
        "length"
    );
}
