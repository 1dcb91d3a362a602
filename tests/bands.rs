//! Bands of sensors against fine sums over single wavelengths.

mod common;

use common::random::Random;
use welkin::format::{Chunk, Payload, Spectrum, extend};
use welkin::{
    BakedSky, Bands, Conditions, Directions, Error, Interpolation, Model, PointQuery,
    PolarisationFrame, Response, Stokes, StokesSpectra,
};

/// The embedded model with cells between its nodes, whose weights no curve through the nodes has.
fn with_spectrum() -> (Model, Spectrum) {
    let model = Model::default_model().unwrap();
    let head = model.head();
    let nodes = &head.wavelengths;
    let wavelength: Vec<f64> = (0..45).map(|c| 322.0 + 9.7 * f64::from(c)).collect();
    let (mut tap_node, mut tap_weight) = (Vec::new(), Vec::new());
    // Two terms per cell, of which the second is darker in one band of five.
    for (c, l) in wavelength.iter().enumerate() {
        let i = nodes.partition_point(|n| n <= l).clamp(1, nodes.len() - 2);
        let t = ((l - nodes[i - 1]) / (nodes[i] - nodes[i - 1])) as f32;
        let lean = 0.1 * (c as f32).sin();
        for lean in [lean, lean + if c % 5 == 0 { 0.2 } else { 0.0 }] {
            tap_node.extend([i - 1, i, i + 1].map(|n| n as u32));
            tap_weight.extend([1.0 - t - lean, t + 2.0 * lean, -lean]);
        }
    }
    let (cells, nk) = (wavelength.len(), head.constituents);
    let extinction = (0..head.visibilities.len() * nk * cells).map(|i| {
        let (v, k, c) = (i / cells / nk, i / cells % nk, i % cells);
        let near = nodes.partition_point(|n| *n < wavelength[c]);
        head.extinction[(v * nk + k) * nodes.len() + near.min(nodes.len() - 1)] as f32
    });
    let spectrum = Spectrum {
        taps: 3,
        first_term: (0..=cells as u32).map(|c| 2 * c).collect(),
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
    let term = |g: usize| {
        let taps = g * spectrum.taps..(g + 1) * spectrum.taps;
        let logarithm = |j: usize| f64::from(relative[spectrum.tap_node[j] as usize]).ln();
        let sum: f64 = taps
            .map(|j| f64::from(spectrum.tap_weight[j]) * logarithm(j))
            .sum();
        f64::from(spectrum.term_weight[g]) * sum.exp()
    };
    let cell = |c: usize| (term(2 * c) + term(2 * c + 1)).ln();
    ((1.0 - t) * cell(c) + t * cell(c + 1)).exp()
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
    common::direction(random.between(0.001, 1.57), random.between(0.0, 6.0))
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

/// Wavelengths of the default model: bytes 40 and 41 of a file.
const NODES: usize =
    u16::from_le_bytes([welkin::DEFAULT_MODEL[40], welkin::DEFAULT_MODEL[41]]) as usize;
/// Bells and boxes, wide and narrow.
const BELLS: [[f64; 2]; 5] = [
    [450.0, 20.0],
    [540.0, 30.0],
    [610.0, 25.0],
    [655.0, 2.0],
    [500.0, 8.0],
];

fn bells() -> Vec<Response> {
    responses(&BELLS)
}

fn responses(bells: &[[f64; 2]]) -> Vec<Response> {
    bells.iter().map(|&[c, w]| bell(c, w)).collect()
}

/// Errors of bands against sums in steps of 0.1 nm over `at`, which gives relative radiance of that at the nodes.
fn errors(
    (model, bands): (&Model, &Bands),
    bells: &[[f64; 2]],
    at: impl Fn(&[f32], f64) -> f64,
) -> Vec<Vec<f64>> {
    let mut random = Random(7);
    let mut errors = vec![Vec::new(); bells.len()];
    let mut nodes = vec![0.0; model.wavelengths().len()];
    for _ in 0..40 {
        let conditions = conditions(&mut random);
        let (sky, band_sky) = (
            model.sky(&conditions).unwrap(),
            model.band_sky(&conditions, bands).unwrap(),
        );
        for _ in 0..4 {
            let view = view(&mut random);
            let mut got = vec![0.0; bells.len()];
            band_sky.radiance(view, &mut got).unwrap();
            sky.relative_radiance(view, &mut nodes).unwrap();
            for (b, &[centre, width]) in bells.iter().enumerate() {
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
    let interpolation = model.spectral_interpolation().unwrap();
    let at = |light: &[f32], l| f64::from(interpolation.between(light, l).unwrap());
    check(&bands, &errors((&model, &bands), &BELLS, at));
}

/// Where light rises by a third within a nanometre, and where gases absorb.
#[test]
fn curves_of_the_ultraviolet_and_the_infrared_agree_with_fine_sums() {
    const FAR: [[f64; 2]; 4] = [[318.0, 5.0], [345.0, 10.0], [765.0, 12.0], [880.0, 30.0]];
    let model = Model::default_model().unwrap();
    let bands = model.bands(&responses(&FAR)).unwrap();
    let interpolation = model.spectral_interpolation().unwrap();
    let at = |light: &[f32], l| f64::from(interpolation.between(light, l).unwrap());
    let found = errors((&model, &bands), &FAR, at);
    for (residual, errors) in bands.residuals().iter().zip(&found) {
        let [median, p99] = [0.5, 0.99].map(|q| errors[(q * (errors.len() - 1) as f64) as usize]);
        println!("{residual:?}: {median:.5} {p99:.5}");
        assert!(median < 5e-4 && p99 < 3.1e-3, "{residual:?} {median} {p99}");
    }
}

#[test]
fn curves_agree_with_fine_sums_over_a_spectrum() {
    let (model, spectrum) = with_spectrum();
    let bands = model.bands(&bells()).unwrap();
    check(
        &bands,
        &errors((&model, &bands), &BELLS, |light, l| {
            by_cells(&spectrum, light, l)
        }),
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
    let three = [460.0, 540.0, 620.0];
    let bands = model.bands(&three.map(Response::wavelength)).unwrap();
    let share = bands.nodes().len() as f64 / model.wavelengths().len() as f64;
    println!("{:?}", bands.nodes());
    assert!(share < 0.6, "{:?}", bands.nodes());
    let mut random = Random(5);
    for _ in 0..10 {
        let (conditions, view) = (conditions(&mut random), view(&mut random));
        let sky = model.sky(&conditions).unwrap();
        let narrow = model.band_sky(&conditions, &bands).unwrap();
        assert!((narrow.bytes() as f64) < sky.bytes() as f64 * (share + 0.1));
        let mut got = [0.0; 3];
        narrow.radiance(view, &mut got).unwrap();
        for (got, wavelength) in got.into_iter().zip(three) {
            let want = sky.radiance_at(view, wavelength).unwrap();
            assert!((got / want - 1.0).abs() < 2e-5, "{got} {want}");
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
                assert!((nodes[0]..nodes[nodes.len() - 1]).contains(&l));
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
    assert_eq!(refused(Response::wavelength(299.0)), 299.0);
    assert!(refused(Response::wavelength(f64::NAN)).is_nan());
    let wide = Response::table(&[280.0, 400.0], &[1.0, 1.0]).unwrap();
    assert_eq!(refused(wide), 280.0);
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

/// Means and sums over the bells, of what `at` gives per unit of solar irradiance.
fn over_bells(model: &Model, at: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let sums = BELLS.iter().map(|&[centre, width]| {
        let (mut sum, mut whole) = (0.0, 0.0);
        let step = width / 40.0;
        for i in 0..240 {
            let l = centre - 3.0 * width + step * (f64::from(i) + 0.5);
            let weight = step * bell_at(l, centre, width) * model.head().solar_irradiance_at(l);
            sum += weight * at(l);
            whole += weight;
        }
        [sum / whole, sum]
    });
    sums.collect()
}

fn point(random: &mut Random, from: [f64; 3]) -> [f64; 3] {
    let way = 10f64.powf(random.between(2.5, 5.0));
    let to = common::unit(random.between(-0.02, 0.5), random.between(0.0, 6.0));
    std::array::from_fn(|c| from[c] + way * to[c])
}

#[test]
fn transmittance_is_the_mean_of_what_passes() {
    let model = Model::default_model().unwrap();
    let bands = model.bands(&bells()).unwrap();
    let mut random = Random(23);
    let mut errors = Vec::new();
    for _ in 0..150 {
        let visibility = random.between(20e3, 131.8e3);
        let air = model.transmittance(visibility).unwrap();
        let band_air = model.band_transmittance(visibility, &bands).unwrap();
        let from = [0.0, 0.0, 1e4 * random.share().powi(2)];
        let to = point(&mut random, from);
        let mut got = [0.0; BELLS.len()];
        band_air.transmittance(from, to, &mut got).unwrap();
        let at = |l| f64::from(air.transmittance_at(from, to, l).unwrap());
        for (got, [mean, _]) in got.iter().zip(over_bells(&model, at)) {
            errors.push((f64::from(*got) - mean).abs() / mean.max(0.02));
        }
        let mut none = [0.0; BELLS.len()];
        band_air.transmittance(from, from, &mut none).unwrap();
        assert!(none.iter().all(|t| (t - 1.0).abs() < 1e-6), "{none:?}");
    }
    errors.sort_by(f64::total_cmp);
    let [median, p99] = [0.5, 0.99].map(|q| errors[(q * errors.len() as f64) as usize]);
    println!("transmittance {median:.5} {p99:.5}");
    assert!(median < 5e-4 && p99 < 2e-3, "{median} {p99}");
}

#[test]
fn the_sun_in_bands_is_that_at_its_wavelengths() {
    let model = Model::default_model().unwrap();
    let bands = model.bands(&bells()).unwrap();
    let mut random = Random(29);
    for _ in 0..40 {
        let conditions = Conditions {
            solar_elevation: random.between(0.02, 1.5),
            ..conditions(&mut random)
        };
        let disc = model.solar_disc(&conditions).unwrap();
        let band_disc = model.band_solar_disc(&conditions, &bands).unwrap();
        let mut got = [0.0; BELLS.len()];
        let centre = |l| {
            let radiance = disc.radiance_at(disc.direction(), l).unwrap();
            f64::from(radiance) / model.head().solar_irradiance_at(l)
        };
        band_disc.radiance(disc.direction(), &mut got).unwrap();
        for (got, [_, sum]) in got.iter().zip(over_bells(&model, centre)) {
            let error = f64::from(*got) / sum - 1.0;
            assert!(error.abs() < 5e-3, "{conditions:?}: {error}");
        }
        // What the whole disc gives for the radiance of its centre is smooth between the nodes.
        let up = [0.0, 0.0, 1.0];
        let [mut whole, mut middle] = [[0.0; NODES]; 2];
        disc.irradiance(up, &mut whole).unwrap();
        disc.radiance(disc.direction(), &mut middle).unwrap();
        let ratio: Vec<f32> = whole.iter().zip(middle).map(|(w, m)| w / m).collect();
        let nodes = model.wavelengths();
        let irradiance =
            |l| centre(l) * f64::from(welkin::between_wavelengths(nodes, &ratio, l).unwrap());
        band_disc.irradiance(up, &mut got).unwrap();
        for (got, [_, sum]) in got.iter().zip(over_bells(&model, irradiance)) {
            let error = f64::from(*got) / sum - 1.0;
            assert!(error.abs() < 5e-3, "{conditions:?}: {error}");
        }
    }
}

#[test]
fn light_of_segments_in_bands_is_a_sum_over_wavelengths() {
    let model = Model::default_model().unwrap();
    let bands = model.bands(&bells()).unwrap();
    let interpolation = model.spectral_interpolation().unwrap();
    let mut random = Random(31);
    let mut errors = Vec::new();
    for _ in 0..25 {
        let conditions = conditions(&mut random);
        let aerial = model.aerial_perspective(&conditions).unwrap();
        let band_aerial = model.band_aerial_perspective(&conditions, &bands).unwrap();
        let from = [0.0, 0.0, 3e3 * random.share()];
        let to = point(&mut random, from);
        let [mut light, mut through] = [[0.0; NODES]; 2];
        let [mut got, mut band_through, mut air] = [[0.0; BELLS.len()]; 3];
        aerial
            .in_scattering(from, to, &mut light, &mut through)
            .unwrap();
        band_aerial
            .in_scattering(from, to, &mut got, &mut band_through)
            .unwrap();
        band_aerial
            .transmittance()
            .transmittance(from, to, &mut air)
            .unwrap();
        assert_eq!(band_through, air);
        for (value, &l) in light.iter_mut().zip(model.wavelengths()) {
            *value /= model.head().solar_irradiance_at(l) as f32;
        }
        let at = |l| f64::from(interpolation.between(&light, l).unwrap());
        for (got, [_, sum]) in got.iter().zip(over_bells(&model, at)) {
            errors.push((f64::from(*got) / sum - 1.0).abs());
        }
        let mut stokes = [Stokes::default(); BELLS.len()];
        let frame = PolarisationFrame::Vertical;
        let stokes_at = |l| aerial.relative_stokes_at(from, to, frame, l).unwrap();
        let asked = band_aerial.in_scattering_stokes(from, to, frame, &mut stokes, &mut air);
        asked.unwrap();
        for (b, &[centre, _]) in BELLS.iter().enumerate() {
            assert!((stokes[b].i / got[b] - 1.0).abs() < 1e-4);
            let near = stokes_at(centre);
            let degrees = [stokes[b].q / stokes[b].i - near.q / near.i];
            assert!(degrees[0].abs() < 0.02, "{degrees:?}");
        }
    }
    errors.sort_by(f64::total_cmp);
    let [median, p95] = [0.5, 0.95].map(|q| errors[(q * errors.len() as f64) as usize]);
    println!("segments {median:.5} {p95:.5}");
    assert!(median < 1e-3 && p95 < 5e-3, "{median} {p95}");
}

#[test]
fn baked_bands_keep_their_tolerance() {
    let model = Model::default_model().unwrap();
    let many: Vec<Response> = (0..17)
        .map(|i| Response::wavelength(400.0 + 17.3 * f64::from(i)))
        .collect();
    for responses in [bells(), many] {
        let bands = model.bands(&responses).unwrap();
        let n = bands.count();
        let conditions = Conditions::default();
        let sky = model.polarised_band_sky(&conditions, &bands).unwrap();
        let baked = sky.bake(BakedSky::TOLERANCE).unwrap();
        let plain = model.band_sky(&conditions, &bands).unwrap();
        let baked_plain = plain.bake(BakedSky::TOLERANCE).unwrap();
        let mut random = Random(37);
        let views: Vec<[f32; 3]> = (0..200).map(|_| view(&mut random)).collect();
        let component = |c: usize| views.iter().map(|v| v[c]).collect::<Vec<f32>>();
        let [x, y, z] = [0, 1, 2].map(component);
        let directions = Directions {
            x: &x,
            y: &y,
            z: &z,
        };
        let [mut i, mut q, mut u, mut exact, mut fast] = [(); 5].map(|_| vec![0.0; n * 200]);
        let light = StokesSpectra {
            i: &mut i,
            q: &mut q,
            u: &mut u,
        };
        baked
            .stokes_batch(&directions, PolarisationFrame::Vertical, light)
            .unwrap();
        plain.radiance_batch(&views, &mut exact).unwrap();
        baked_plain.radiance_batch(&directions, &mut fast).unwrap();
        let (mut off, mut degrees) = (Vec::new(), Vec::new());
        for (k, &view) in views.iter().enumerate() {
            let mut truth = vec![Stokes::default(); n];
            sky.stokes(view, PolarisationFrame::Vertical, &mut truth)
                .unwrap();
            for (b, part) in truth.iter().enumerate() {
                let at = k * n + b;
                off.push((fast[at] / exact[at] - 1.0).abs());
                off.push((i[at] / exact[at] - 1.0).abs());
                let [dq, du] = [(q[at], part.q), (u[at], part.u)]
                    .map(|(got, true_part)| got / i[at] - true_part / part.i);
                degrees.push(dq.hypot(du));
            }
        }
        for errors in [&mut off, &mut degrees] {
            errors.sort_by(f32::total_cmp);
            let p95 = errors[errors.len() * 95 / 100];
            assert!(
                f64::from(p95) < 1.2 * BakedSky::TOLERANCE,
                "{n} bands: {p95}"
            );
        }
        let mut one = vec![0.0; n];
        baked_plain.radiance(views[3], &mut one).unwrap();
        assert_eq!(one, fast[3 * n..4 * n]);
    }
}

#[test]
fn point_queries_are_projected_like_skies() {
    let model = Model::default_model().unwrap();
    let bands = model.bands(&bells()).unwrap();
    let query = PointQuery::new(welkin::DEFAULT_MODEL).unwrap();
    let query = query.with_interpolation(Interpolation::Full);
    let mut random = Random(41);
    for _ in 0..20 {
        let (conditions, view) = (conditions(&mut random), view(&mut random));
        let (mut relative, mut got, mut sky) =
            ([0.0; NODES], [0.0; BELLS.len()], [0.0; BELLS.len()]);
        query
            .relative_radiance(&conditions, view, &mut relative)
            .unwrap();
        bands.project(&relative, &mut got).unwrap();
        let band_sky = model.band_sky(&conditions, &bands).unwrap();
        band_sky.radiance(view, &mut sky).unwrap();
        for (got, sky) in got.iter().zip(sky) {
            assert!((got / sky - 1.0).abs() < 1e-4, "{got} {sky}");
        }
    }
    assert_eq!(
        bands
            .project(&[0.0; 11], &mut [0.0; 5])
            .unwrap_err()
            .class(),
        "length"
    );
    assert_eq!(
        bands
            .project(&[0.0; NODES], &mut [0.0; 4])
            .unwrap_err()
            .class(),
        "length"
    );
}

/// The observer's X, Y and Z as bands are the colours that the file stores.
#[test]
fn xyz_as_bands_are_the_colours_of_the_model() {
    let model = Model::default_model().unwrap();
    let table = include_str!("../fitter/data/cie1931_2deg_1nm.csv");
    let rows: Vec<[f64; 4]> = table
        .lines()
        .filter_map(|line| {
            let numbers: Option<Vec<f64>> =
                line.split(',').map(|n| n.trim().parse().ok()).collect();
            numbers?.try_into().ok()
        })
        .filter(|row: &[f64; 4]| row[0] <= 760.0)
        .collect();
    assert!(rows.len() > 390);
    let wavelengths: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let response = |c: usize| {
        let values: Vec<f64> = rows.iter().map(|row| 683.0 * row[c]).collect();
        Response::table(&wavelengths, &values).unwrap()
    };
    let bands = model.bands(&[1, 2, 3].map(response)).unwrap();
    println!("{:?}", bands.residuals());
    let mut random = Random(43);
    for _ in 0..40 {
        let (conditions, view) = (conditions(&mut random), view(&mut random));
        let mut got = [0.0; 3];
        let sky = model.band_sky(&conditions, &bands).unwrap();
        sky.radiance(view, &mut got).unwrap();
        let sky = model.sky(&conditions).unwrap();
        let xyz = sky.xyz(view).unwrap();
        for (got, xyz) in got.iter().zip(xyz) {
            assert!((got / xyz - 1.0).abs() < 0.01, "{got} {xyz}");
        }
        // Leaving out what eyes do not see changes nothing.
        let colours = model.colour_sky(&conditions).unwrap();
        for (a, b) in colours.xyz(view).unwrap().iter().zip(xyz) {
            assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
        }
    }
}

/// The air of a file with a spectrum passes what its lines leave.
#[test]
fn transmittance_is_the_mean_over_a_spectrum() {
    let (model, _) = with_spectrum();
    let bands = model.bands(&bells()).unwrap();
    let mut random = Random(47);
    let mut errors = Vec::new();
    for _ in 0..60 {
        let visibility = random.between(20e3, 131.8e3);
        let air = model.transmittance(visibility).unwrap();
        let band_air = model.band_transmittance(visibility, &bands).unwrap();
        let from = [0.0, 0.0, 1e4 * random.share().powi(2)];
        let to = point(&mut random, from);
        let mut got = [0.0; BELLS.len()];
        band_air.transmittance(from, to, &mut got).unwrap();
        for (b, &[centre, width]) in BELLS.iter().enumerate() {
            let (mut sum, mut whole) = (0.0, 0.0);
            for i in 0..120 {
                let l = centre - 3.0 * width + width / 20.0 * (f64::from(i) + 0.5);
                let weight = bell_at(l, centre, width) * model.head().solar_irradiance_at(l);
                sum += weight * f64::from(air.transmittance_at(from, to, l).unwrap());
                whole += weight;
            }
            let mean = sum / whole;
            errors.push((f64::from(got[b]) - mean).abs() / mean.max(0.02));
        }
    }
    errors.sort_by(f64::total_cmp);
    let [median, p99] = [0.5, 0.99].map(|q| errors[(q * errors.len() as f64) as usize]);
    println!("transmittance over a spectrum {median:.5} {p99:.5}");
    assert!(median < 5e-4 && p99 < 3e-3, "{median} {p99}");
}
