//! Light and air between the wavelengths of a model with a spectrum chunk. Format specification, sections 7.3, 7.5, 7.6
//! and 7.8.

mod common;

use common::aerial;
use common::spectrum::{CELLS, TAPS, TERMS, spectrum, with_spectrum};
use proptest::prelude::*;
use welkin::format::{Chunk, Head, Payload, Spectrum, encode};
use welkin::{
    BakedSky, Budget, Channels, Conditions, Error, Interpolation, Model, PointQuery,
    PolarisationFrame, SpectralInterpolation, StokesSpectra,
};

const ZENITH: [f32; 3] = [0.1, -0.2, 0.9];

fn head() -> Head {
    common::head(&[0.0, 120.0], &[20e3, 59.4e3, 131.8e3])
}

/// Radiance, polarisation, air and sources.
fn chunks(head: &Head) -> Vec<Chunk> {
    let mut chunks = common::polarised_chunks(head, 0.02);
    chunks.extend(aerial::chunks(head, 0.2));
    chunks
}

fn model_with(spectrum: Spectrum) -> Model {
    let head = head();
    let mut chunks = chunks(&head);
    chunks.push(Chunk::new(None, None, Payload::Spectrum(spectrum)));
    Model::from_bytes(encode(&head, &chunks).unwrap()).unwrap()
}

fn model() -> Model {
    let head = head();
    Model::from_bytes(encode(&head, &with_spectrum(&head, chunks(&head))).unwrap()).unwrap()
}

fn conditions() -> Conditions {
    Conditions {
        altitude: 50.0,
        visibility: 45e3,
        albedo: 0.3,
        solar_elevation: 0.5,
        solar_azimuth: 1.0,
    }
}

/// A spectrum of unit vectors: each cell is a node.
fn selecting(head: &Head) -> Spectrum {
    let mut chosen = spectrum(head);
    for cell in 0..CELLS {
        for term in terms(&chosen, cell) {
            let row = term * TAPS..(term + 1) * TAPS;
            chosen.tap_node[row.clone()].copy_from_slice(&[0, node(cell), 0]);
            chosen.tap_weight[row].copy_from_slice(&[0.0, 1.0, 0.0]);
        }
    }
    chosen
}

/// The node that a cell is in [`selecting`].
fn node(cell: usize) -> u32 {
    [0, 1, 1, 2, 3, 3, 4, 4, 5][cell]
}

fn terms(spectrum: &Spectrum, cell: usize) -> std::ops::Range<usize> {
    spectrum.first_term[cell] as usize..spectrum.first_term[cell + 1] as usize
}

/// Q/I of a wavelength from I and Q/I at the nodes, in double precision.
fn ratio(spectrum: &Spectrum, light: &[f32], ratios: &[f32], wavelength: f64) -> f64 {
    let cells = &spectrum.wavelength;
    let c = cells.iter().filter(|l| **l <= wavelength).count();
    let c = c.clamp(1, cells.len() - 1) - 1;
    let t = (wavelength - cells[c]) / (cells[c + 1] - cells[c]);
    let dot = |term: usize, value: &dyn Fn(usize) -> f64| -> f64 {
        let row = term * TAPS..(term + 1) * TAPS;
        let taps = row.map(|j| (spectrum.tap_weight[j], spectrum.tap_node[j] as usize));
        taps.map(|(w, n)| f64::from(w) * value(n)).sum()
    };
    let of_cell = |cell| {
        let (mut above, mut below) = (0.0, 0.0);
        for term in terms(spectrum, cell) {
            let light = dot(term, &|n| f64::from(light[n]).ln()).exp();
            let light = light * f64::from(spectrum.term_weight[term]);
            above += light * dot(term, &|n| f64::from(ratios[n]));
            below += light;
        }
        above / below
    };
    (1.0 - t) * of_cell(c) + t * of_cell(c + 1)
}

fn close(got: f32, expected: f32, tolerance: f32) -> bool {
    (got - expected).abs() <= tolerance * expected.abs()
}

#[test]
fn unit_vectors_give_the_nodes_back() {
    let chosen = selecting(&head());
    let model = model_with(chosen.clone());
    let sky = model.polarised_sky(&conditions()).unwrap();
    let n = model.wavelengths().len();
    let mut radiance = vec![0.0; n];
    sky.sky().relative_radiance(ZENITH, &mut radiance).unwrap();
    let mut stokes = vec![welkin::Stokes::default(); n];
    let frame = PolarisationFrame::Vertical;
    sky.relative_stokes(ZENITH, frame, &mut stokes).unwrap();
    for (cell, &wavelength) in chosen.wavelength.iter().enumerate() {
        let node = node(cell) as usize;
        let got = sky.sky().relative_radiance_at(ZENITH, wavelength).unwrap();
        assert!(close(got, radiance[node], 1e-6), "{wavelength} nm");
        let light = sky.stokes_at(ZENITH, frame, wavelength).unwrap();
        let degree = [light.q / light.i, light.u / light.i];
        let expected = [stokes[node].q, stokes[node].u].map(|v| v / stokes[node].i);
        for (got, expected) in degree.into_iter().zip(expected) {
            assert!((got - expected).abs() < 1e-5, "{wavelength} nm");
        }
    }
}

/// What is not asked of cells stays as it is without them.
#[test]
fn nodes_are_those_of_the_model_without_a_spectrum() {
    let head = head();
    let plain = Model::from_bytes(encode(&head, &chunks(&head)).unwrap()).unwrap();
    let [with, without] = [&model(), &plain].map(|model| {
        let sky = model.sky(&conditions()).unwrap();
        (common::radiance(&sky, ZENITH), sky.xyz(ZENITH).unwrap())
    });
    assert_eq!(with, without);
}

#[test]
fn all_evaluators_agree() {
    let head = head();
    let file = encode(&head, &with_spectrum(&head, chunks(&head))).unwrap();
    let model = Model::from_bytes(file.clone()).unwrap();
    let in_place = PointQuery::new(&file).unwrap();
    let in_place = in_place.with_interpolation(Interpolation::Full);
    let budget = Budget {
        altitude: model.altitude_range(),
        visibility: model.visibility_range(),
        solar_elevation: model.solar_elevation_range(),
        tolerance: BakedSky::TOLERANCE,
        channels: Channels::Stokes,
    };
    let plan = model.plan(&budget).unwrap();
    let polarised = model.polarised_point_query(&plan).unwrap();
    let sky = model.polarised_sky(&conditions()).unwrap();
    let interpolation = model.spectral_interpolation().unwrap();
    assert_eq!(in_place.wavelength_range(), interpolation.range());
    let [first, last] = interpolation.range();
    let mut values = vec![0.0; head.wavelengths.len()];
    sky.sky().relative_radiance(ZENITH, &mut values).unwrap();
    for i in 0..=60 {
        let wavelength = (first + (last - first) * f64::from(i) / 60.0).min(last);
        let exact = sky.sky().radiance_at(ZENITH, wavelength).unwrap();
        let got = in_place.radiance_at(&conditions(), ZENITH, wavelength);
        assert!(close(got.unwrap(), exact, 1e-4), "{wavelength} nm");
        let relative = interpolation.between(&values, wavelength).unwrap();
        let spectral = f64::from(relative) * interpolation.solar_irradiance(wavelength);
        assert!(close(spectral as f32, exact, 1e-6));
        let frame = PolarisationFrame::SunAligned;
        let expected = sky.stokes_at(ZENITH, frame, wavelength).unwrap();
        let got = polarised.stokes_at(&conditions(), ZENITH, frame, wavelength);
        let got = got.unwrap();
        for (got, expected) in [
            (got.i, expected.i),
            (got.q, expected.q),
            (got.u, expected.u),
        ] {
            assert!((got - expected).abs() <= 1e-4 * exact, "{wavelength} nm");
        }
    }
}

#[test]
fn streams_read_a_spectrum_with_the_plan() {
    let head = head();
    let file = encode(&head, &with_spectrum(&head, chunks(&head))).unwrap();
    let model = Model::stream(file).unwrap();
    let budget = Budget {
        altitude: model.altitude_range(),
        visibility: model.visibility_range(),
        solar_elevation: model.solar_elevation_range(),
        tolerance: BakedSky::TOLERANCE,
        channels: Channels::Spectral,
    };
    model.load(&model.plan(&budget).unwrap()).unwrap();
    let loaded = model.traffic();
    let sky = model.sky(&conditions()).unwrap();
    sky.radiance_at(ZENITH, 500.0).unwrap();
    assert_eq!(model.traffic(), loaded);
}

#[test]
fn wavelengths_beyond_the_cells_are_refused() {
    let model = model();
    let [first, last] = model.wavelength_range().unwrap();
    let sky = model.polarised_sky(&conditions()).unwrap();
    let baked = sky.sky().bake(0.1).unwrap();
    let aerial = model.aerial_perspective(&conditions()).unwrap();
    let disc = model.solar_disc(&conditions()).unwrap();
    let (from, to) = ([0.0, 0.0, 10.0], [500.0, 0.0, 20.0]);
    let frame = PolarisationFrame::Vertical;
    for wavelength in [first - 0.1, last + 0.1, f64::NAN] {
        let ask: [Result<(), Error>; 7] = [
            sky.sky().radiance_at(ZENITH, wavelength).map(drop),
            sky.stokes_at(ZENITH, frame, wavelength).map(drop),
            baked.hero(ZENITH, [wavelength as f32; 4]).map(drop),
            aerial.in_scattering_at(from, to, wavelength).map(drop),
            aerial
                .relative_stokes_at(from, to, frame, wavelength)
                .map(drop),
            aerial
                .transmittance()
                .transmittance_at(from, to, wavelength)
                .map(drop),
            disc.radiance_at(disc.direction(), wavelength).map(drop),
        ];
        for (i, answer) in ask.into_iter().enumerate() {
            assert_eq!(answer.unwrap_err().class(), "range", "{i}: {wavelength} nm");
        }
    }
}

/// Darkness counts as 2⁻²⁷ of the brightest, and where all is dark there is nothing.
#[test]
fn darkness_at_a_node_is_no_logarithm() {
    let head = head();
    let mut dark = spectrum(&head);
    dark.tap_node[..3].copy_from_slice(&[0, 1, 2]);
    dark.tap_weight[..3].copy_from_slice(&[0.5, 1.5, -1.0]);
    let cell = dark.wavelength[0];
    let model = model_with(dark);
    let interpolation = model.spectral_interpolation().unwrap();
    let at = |values: &[f32]| interpolation.between(values, cell).unwrap();
    let expected = 2f32.powf(1.5) / 4.0;
    assert!(close(at(&[1.0, 2.0, 4.0, 0.0, 0.0, 0.0]), expected, 1e-6));
    let bright = 8.0;
    let floor = bright * 2f32.powi(-27);
    let expected = 2f32.powf(1.5) / floor;
    assert!(close(
        at(&[1.0, 2.0, 0.0, bright, 0.0, 0.0]),
        expected,
        1e-5
    ));
    let expected = floor.powf(0.5) * 2f32.powf(1.5) / 4.0;
    assert!(close(
        at(&[0.0, 2.0, 4.0, bright, 0.0, 0.0]),
        expected,
        1e-5
    ));
    assert_eq!(at(&[0.0; 6]), 0.0);
}

/// A band is the mean of its terms, not what the mean of the terms' weights makes.
#[test]
fn bands_are_means() {
    let head = head();
    let mut band = spectrum(&head);
    // The second cell has the terms 1 and 2.
    band.tap_node[3..9].copy_from_slice(&[0, 0, 0, 1, 1, 1]);
    band.tap_weight[3..9].copy_from_slice(&[1.0, 0.0, 0.0, 0.5, 0.5, 0.0]);
    band.term_weight[1..3].copy_from_slice(&[0.25, 0.75]);
    let cell = band.wavelength[1];
    let model = model_with(band);
    let interpolation = model.spectral_interpolation().unwrap();
    let values = [8.0, 1.0, 3.0, 3.0, 3.0, 3.0];
    assert!(close(
        interpolation.between(&values, cell).unwrap(),
        2.75,
        1e-6
    ));
}

#[test]
fn heroes_are_the_baked_nodes_with_the_weights_of_the_sky() {
    let model = model();
    let sky = model.polarised_sky(&conditions()).unwrap();
    let baked = sky.bake(0.01).unwrap();
    let cells = spectrum(model.head());
    let [first, last] = model.wavelength_range().unwrap().map(|l| l as f32);
    let interpolation = model.spectral_interpolation().unwrap();
    let n = model.wavelengths().len();
    for direction in [
        ZENITH,
        [0.8, 0.3, 0.02],
        [0.5, -0.5, -0.1],
        [0.1, 0.2, -0.9],
    ] {
        let frame = PolarisationFrame::Vertical;
        let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
        let spectra = StokesSpectra {
            i: &mut i,
            q: &mut q,
            u: &mut u,
        };
        baked.stokes(direction, frame, spectra).unwrap();
        let stokes: Vec<_> = (0..n).map(|k| [i[k], q[k], u[k]]).collect();
        let irradiance = model
            .wavelengths()
            .iter()
            .map(|&l| model.head().solar_irradiance_at(l));
        let relative: Vec<f32> = stokes
            .iter()
            .zip(irradiance)
            .map(|(light, sun)| (f64::from(light[0]) / sun) as f32)
            .collect();
        for i in 0..20 {
            let t = (0.05 * i as f32 + 0.01).fract();
            let four = [0.0, 0.25, 0.5, 0.75].map(|k| first + (last - first) * (t + k).fract());
            let got = baked.hero(direction, frame, four).unwrap();
            for (light, wavelength) in got.into_iter().zip(four.map(f64::from)) {
                let expected = interpolation.between(&relative, wavelength).unwrap();
                let expected = f64::from(expected) * interpolation.solar_irradiance(wavelength);
                assert!(
                    close(light.i, expected as f32, 2e-4),
                    "{direction:?} {wavelength}"
                );
                let light_of =
                    |part: usize| -> Vec<f32> { stokes.iter().map(|v| v[part] / v[0]).collect() };
                let [q, u] =
                    [1, 2].map(|part| ratio(&cells, &relative, &light_of(part), wavelength) as f32);
                let most = q.hypot(u).max(1.0);
                assert!((light.q / light.i - q / most).abs() < 1e-4);
                assert!((light.u / light.i - u / most).abs() < 1e-4);
            }
        }
    }
}

/// Radiance of the sun is irradiance times transmittance over the disc's solid angle, on average.
#[test]
fn the_sun_shines_through_the_air_of_segments() {
    let model = model();
    let disc = model.solar_disc(&conditions()).unwrap();
    let air = model.transmittance(conditions().visibility).unwrap();
    let (centre, from) = (disc.direction(), [0.0, 0.0, conditions().altitude]);
    let [first, last] = model.wavelength_range().unwrap();
    let interpolation = model.spectral_interpolation().unwrap();
    for i in 0..=40 {
        let wavelength = (first + (last - first) * f64::from(i) / 40.0).min(last);
        let through = air.transmittance_to_space_at(from, centre.map(f64::from), wavelength);
        let mean = f64::from(through.unwrap()) / disc.solid_angle()
            * interpolation.solar_irradiance(wavelength);
        let got = f64::from(disc.radiance_at(centre, wavelength).unwrap());
        // Limb darkening makes the centre brighter than the mean, more in blue light.
        assert!(
            (1.1..2.0).contains(&(got / mean)),
            "{wavelength} nm: {}",
            got / mean
        );
    }
    assert_eq!(disc.radiance_at([0.0, 0.0, 1.0], 500.0).unwrap(), 0.0);
}

/// Its limb darkening is that of the node where all terms are one and the cell is a node.
#[test]
fn the_sun_at_a_node_is_the_sun_of_that_node() {
    let head = head();
    let mut plain = selecting(&head);
    let (nk, nw) = (head.constituents, head.wavelengths.len());
    plain.wavelength = (0..CELLS).map(|c| 320.0 + 55.0 * c as f64).collect();
    plain.term_extinction.fill(0.0);
    // Cells 0 and 8 are the first and the last node.
    for (cell, node) in [(0, 0), (8, nw - 1)] {
        for row in 0..head.visibilities.len() * nk {
            plain.extinction[row * CELLS + cell] = head.extinction[row * nw + node] as f32;
        }
    }
    let disc = model_with(plain).solar_disc(&conditions()).unwrap();
    let mut nodes = vec![0.0; nw];
    disc.radiance(disc.direction(), &mut nodes).unwrap();
    for (node, wavelength) in [(0, 320.0), (nw - 1, 760.0)] {
        let got = disc.radiance_at(disc.direction(), wavelength).unwrap();
        assert!(
            close(got, nodes[node], 1e-4),
            "{wavelength} nm: {got} {}",
            nodes[node]
        );
    }
}

#[test]
fn a_query_of_any_conditions_scatters_as_the_prepared_does() {
    let model = model();
    let mut query = model.aerial_perspective_query().unwrap();
    let (from, to) = ([0.0, 0.0, 10.0], [8e3, 1e3, 900.0]);
    for visibility in [25e3, 70e3] {
        let conditions = Conditions {
            visibility,
            ..conditions()
        };
        let aerial = model.aerial_perspective(&conditions).unwrap();
        for wavelength in [330.0, 477.0, 640.5] {
            let expected = aerial.in_scattering_at(from, to, wavelength).unwrap();
            let got = query
                .in_scattering_at(&conditions, from, to, wavelength)
                .unwrap();
            assert!(close(got, expected, 1e-4));
            let light =
                aerial.relative_stokes_at(from, to, PolarisationFrame::Vertical, wavelength);
            let sun = model.head().solar_irradiance_at(wavelength) as f32;
            assert!(close(light.unwrap().i * sun, expected, 1e-5));
        }
    }
}

/// Of a model without a spectrum everything can be asked at a wavelength, too: by the curve through the nodes.
#[test]
fn without_a_spectrum_neighbours_count() {
    let head = head();
    let model = Model::from_bytes(encode(&head, &chunks(&head)).unwrap()).unwrap();
    assert!(!model.has_spectrum());
    let air = model.transmittance(45e3).unwrap();
    let (from, to) = ([0.0, 0.0, 10.0], [30e3, 0.0, 500.0]);
    let mut nodes = vec![0.0; head.wavelengths.len()];
    air.transmittance(from, to, &mut nodes).unwrap();
    for wavelength in [320.0, 333.0, 500.0, 760.0] {
        let got = air.transmittance_at(from, to, wavelength).unwrap();
        let expected = welkin::between_wavelengths(&head.wavelengths, &nodes, wavelength).unwrap();
        assert!(close(got, expected, 1e-6));
        let interpolation: &SpectralInterpolation = model.spectral_interpolation().unwrap();
        assert_eq!(interpolation.between(&nodes, wavelength).unwrap(), expected);
    }
}

/// Any sound spectrum of the synthetic head.
fn any_spectrum() -> impl Strategy<Value = Spectrum> {
    let weights = prop::collection::vec(-1.0..1.5f32, TERMS * TAPS);
    let nodes = prop::collection::vec(0u32..6, TERMS * TAPS);
    let shares = prop::collection::vec(0.0..1.0f32, CELLS);
    let lines = prop::collection::vec(prop_oneof![Just(0.0), 0.0..1e-3f32], 2 * TERMS);
    (weights, nodes, shares, lines).prop_map(|(weights, nodes, shares, lines)| {
        let mut spectrum = spectrum(&head());
        spectrum.tap_weight = weights;
        spectrum.tap_node = nodes;
        spectrum.term_extinction = lines;
        for (cell, share) in shares.into_iter().enumerate() {
            let terms = terms(&spectrum, cell);
            if terms.len() == 2 {
                spectrum.term_weight[terms].copy_from_slice(&[1.0 - share, share]);
            }
        }
        spectrum
    })
}

proptest! {
    #![proptest_config(common::cases(48))]

    /// Weights that add up to 1 keep the colour of light that has none, and what is brighter everywhere is as much
    /// brighter between.
    #[test]
    fn weights_that_add_up_to_one_keep_factors(mut any in any_spectrum(), factor in 1e-3..1e3f32, t in 0.0..1.0f64) {
        for row in any.tap_weight.chunks_mut(3) {
            row[2] = 1.0 - row[0] - row[1];
        }
        let model = model_with(any);
        let interpolation = model.spectral_interpolation().unwrap();
        let [first, last] = interpolation.range();
        let wavelength = first + t * (last - first);
        let grey = interpolation.between(&[factor; 6], wavelength).unwrap();
        prop_assert!(close(grey, factor, 1e-5), "{grey} {factor}");
        let values = [0.3, 0.7, 0.5, 0.2, 0.9, 0.4];
        let [one, more] = [1.0, factor].map(|f| interpolation.between(&values.map(|v| f * v), wavelength).unwrap());
        prop_assert!(close(more, factor * one, 1e-5), "{more} {one}");
    }

    /// Nothing jumps at a cell: neither radiance nor transmittance.
    #[test]
    fn values_are_continuous_across_cells(any in any_spectrum(), cell in 1..CELLS - 1) {
        let wavelength = any.wavelength[cell];
        let model = model_with(any);
        let sky = model.polarised_sky(&conditions()).unwrap();
        let air = model.transmittance(45e3).unwrap();
        let frame = PolarisationFrame::Vertical;
        let around = [wavelength - 1e-4, wavelength, wavelength + 1e-4];
        let light = around.map(|l| sky.stokes_at(ZENITH, frame, l).unwrap());
        let through = around.map(|l| air.transmittance_at([0.0; 3], [9e3, 0.0, 1e3], l).unwrap());
        let relative = around.map(|l| sky.sky().relative_radiance_at(ZENITH, l).unwrap());
        for i in [0, 2] {
            prop_assert!(close(relative[i], relative[1], 1e-4), "{relative:?}");
            prop_assert!((through[i] - through[1]).abs() < 1e-4, "{through:?}");
            prop_assert!((light[i].q - light[1].q).abs() < 1e-3 * light[1].i);
            prop_assert!((light[i].u - light[1].u).abs() < 1e-3 * light[1].i);
        }
    }

    /// In 0..=1, 1 over no distance, and less the farther.
    #[test]
    fn transmittance_falls_along_a_line(any in any_spectrum(), t in 0.0..1.0f64, elevation in -0.1..1.5f64) {
        let model = model_with(any);
        let [first, last] = model.wavelength_range().unwrap();
        let wavelength = first + t * (last - first);
        let air = model.transmittance(33e3).unwrap();
        let from = [0.0, 0.0, 100.0];
        let mut before = air.transmittance_at(from, from, wavelength).unwrap();
        prop_assert!((before - 1.0).abs() < 1e-5);
        for i in 0..24 {
            let distance = 10.0 * 2f64.powf(0.75 * f64::from(i));
            let to = [distance * elevation.cos(), 0.0, 100.0 + distance * elevation.sin()];
            let through = air.transmittance_at(from, to, wavelength).unwrap();
            let back = air.transmittance_at(to, from, wavelength).unwrap();
            prop_assert!(through >= 0.0 && through <= before * (1.0 + 1e-6), "{through} after {before}");
            prop_assert!(close(back, through, 1e-4) || through < 1e-9);
            before = through;
        }
    }
}
