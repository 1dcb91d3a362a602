//! Transmittance of fitted densities against quadrature, and against the outside references.

use serde_json::Value;
use std::path::Path;
use welkin::format::{Chunk, Head, Payload, encode, parse};
use welkin::{Model, Transmittance};
use welkin_fitter::atmosphere::json::Case;
use welkin_fitter::atmosphere::{Atmosphere, Particles, VISIBILITIES, real_at};
use welkin_fitter::column::ColumnIntegrator;
use welkin_fitter::dataset::VISIBLE;
use welkin_fitter::finite::density;
use welkin_fitter::successive_orders::NW;

/// A file that holds the densities of one atmosphere and nothing else.
fn air_of(atmosphere: &Atmosphere) -> Transmittance {
    let mut atmosphere = atmosphere.clone();
    if atmosphere.wavelengths.len() == 1 {
        // A model has at least two wavelengths.
        for constituent in &mut atmosphere.constituents {
            constituent.extinction.push(constituent.extinction[0]);
        }
        atmosphere.wavelengths = vec![440.0, 450.0];
    }
    let table = density::fit(std::slice::from_ref(&atmosphere), density::TOLERANCE).unwrap();
    let chunk = Chunk::new(None, None, Payload::Transmittance(table));
    let file = encode(&head(&atmosphere), &[chunk]).unwrap();
    Model::from_bytes(file)
        .unwrap()
        .transmittance(VISIBILITIES[0])
        .unwrap()
}

fn head(air: &Atmosphere) -> Head {
    let mut head = parse(welkin::DEFAULT_MODEL).unwrap().head;
    let nw = air.wavelengths.len();
    head.planet = welkin_fitter::column::planet(air);
    head.visibilities = vec![VISIBILITIES[0]];
    head.wavelengths = air.wavelengths.clone();
    head.constituents = air.constituents.len();
    head.absorbers = 0;
    head.estimated = false;
    head.fields.iter_mut().for_each(|field| field.estimate = 0);
    head.extinction = air
        .constituents
        .iter()
        .flat_map(|c| c.extinction.clone())
        .collect();
    head.spherical_albedo = vec![0.0; nw];
    head.solar_start = air.wavelengths[0];
    head.solar_step = air.wavelengths[nw - 1] - air.wavelengths[0];
    head.solar_irradiance = vec![1.0; 2];
    head.xyz = vec![[0.0; 3]; nw];
    head.fields
        .iter_mut()
        .for_each(|field| field.parameter = vec![0.0; nw]);
    head
}

/// Largest error of a transmittance and 99th percentile of the relative error of an optical depth.
struct Errors {
    transmittance: f64,
    depths: Vec<f64>,
}

impl Errors {
    fn new() -> Self {
        Self {
            transmittance: 0.0,
            depths: vec![],
        }
    }

    fn add(&mut self, exact: f64, got: f64) {
        let error = ((-exact).exp() - (-got).exp()).abs();
        self.transmittance = self.transmittance.max(error);
        if exact > 0.0 {
            self.depths.push((got / exact - 1.0).abs());
        }
    }

    fn judge(&mut self, what: &str) {
        self.depths.sort_by(f64::total_cmp);
        let quantile = |p: f64| self.depths[(p * (self.depths.len() - 1) as f64) as usize];
        let [median, p99, max] = [0.5, 0.99, 1.0].map(quantile);
        println!(
            "{what}: |ΔT| ≤ {:.1e}; optical depth median {median:.1e} p99 {p99:.1e} max {max:.1e}",
            self.transmittance
        );
        assert!(self.transmittance <= 0.002 && p99 <= 0.01, "{what}");
    }
}

fn share(i: usize, step: f64) -> f64 {
    (i as f64 * step).fract()
}

/// From 1 m to the whole way, near the horizon, vertical and in all directions.
#[test]
fn transmittance_agrees_with_quadrature() {
    for visibility in [VISIBILITIES[0], VISIBILITIES[3], VISIBILITIES[5]] {
        let atmosphere = real_at(visibility, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
        let air = air_of(&atmosphere);
        let exact = ColumnIntegrator::new(&atmosphere);
        let mut errors = Errors::new();
        for i in 0..12_000 {
            let altitude = 15_000.0 * share(i, 0.754_877_666);
            let t = 2.0 * share(i, 0.618_033_989) - 1.0;
            let elevation = match i % 3 {
                0 => 0.1 * t.powi(3),
                1 => t.asin(),
                _ => std::f64::consts::FRAC_PI_2.copysign(t),
            };
            let whole = air.planet().ray(altitude, elevation).length;
            let length = 10f64.powf(6.5 * share(i, 0.569_840_291)).min(whole);
            let columns = exact.along(altitude, elevation.sin(), length);
            let direction = [elevation.cos(), 0.0, elevation.sin()];
            let start = [0.0, 0.0, altitude];
            let end = std::array::from_fn(|k| start[k] + length * direction[k]);
            let mut depths = [0.0; NW];
            air.optical_depth(start, end, &mut depths).unwrap();
            for (w, depth) in depths.iter().enumerate() {
                let parts = atmosphere.constituents.iter().zip(columns);
                let depth_of = parts.map(|(c, column)| c.extinction[w] * column).sum();
                errors.add(depth_of, f64::from(*depth));
            }
        }
        errors.judge(&format!("{} km", visibility / 1e3));
    }
}

#[test]
fn transmittance_agrees_with_the_outside_references() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference");
    let text = std::fs::read_to_string(folder.join("transmittance_open.json")).unwrap();
    let file: Value = serde_json::from_str(&text).unwrap();
    let mut errors = Errors::new();
    for case in file["cases"].as_array().unwrap() {
        let id = case["atm"].as_str().unwrap();
        let atmosphere = Case::read(&folder.join(format!("sky_{id}.json")))
            .unwrap()
            .atmosphere;
        let air = air_of(&atmosphere);
        let number = |name: &str| case[name].as_f64().unwrap();
        let zenith = number("view_zenith_deg").to_radians();
        let (start, length) = ([0.0, 0.0, number("alt_m")], number("distance_m"));
        let direction = [zenith.sin(), 0.0, zenith.cos()];
        let end = std::array::from_fn(|k| start[k] + length * direction[k]);
        let mut depths = vec![0.0; air.wavelengths().len()];
        air.optical_depth(start, end, &mut depths).unwrap();
        errors.add(number("tau"), f64::from(depths[0]));
    }
    errors.judge("references");
}

/// Relative errors by the angle of the sun above the geometric horizon (the upper end of each class, degrees).
struct Classes(Vec<(f64, [Vec<f64>; 3])>);

impl Classes {
    fn new() -> Self {
        let ends = [0.01, 0.1, 0.53, 2.0, 10.0, 180.0];
        Self(ends.map(|end| (end, Default::default())).into())
    }

    /// Of optical depth and transmittance of the air, and of the sun's disc.
    fn add(&mut self, degrees: f64, errors: [f64; 3]) {
        let class = self.0.iter_mut().find(|(end, _)| degrees <= *end).unwrap();
        for (list, error) in class.1.iter_mut().zip(errors) {
            list.push(error.abs());
        }
    }

    fn print(&mut self) {
        println!(
            "| above the horizon up to | quantity | median | p95 | p99 | max |\n| --- | --- | --- | --- | --- | --- |"
        );
        for (end, lists) in &mut self.0 {
            for (what, list) in ["optical depth", "transmittance", "sun"].iter().zip(lists) {
                list.sort_by(f64::total_cmp);
                let quantile = |p: f64| 100.0 * list[(p * (list.len() - 1) as f64) as usize];
                let [median, p95, p99, max] = [0.5, 0.95, 0.99, 1.0].map(quantile);
                println!(
                    "| {end}° | {what} | {median:.3} % | {p95:.3} % | {p99:.3} % | {max:.3} % |"
                );
            }
        }
    }

    fn largest(&self, quantity: usize) -> f64 {
        let lists = self.0.iter().flat_map(|(_, lists)| &lists[quantity]);
        lists.fold(0.0, |max: f64, error| max.max(*error))
    }
}

/// The air and the sun's disc of the embedded model against exact columns: observers at 0 to 15 km, suns from the
/// geometric horizon, which is below the horizontal for all but the lowest, to the zenith. Transmittances below 1e-9 do
/// not count. Run with --nocapture for the table.
#[test]
fn the_way_to_the_sun_agrees_with_exact_columns() {
    let model = Model::default_model().unwrap();
    assert_eq!(model.wavelengths(), VISIBLE.wavelengths());
    let mut classes = Classes::new();
    let mut outside = [0.0; NW];
    let mut bright: f64 = 0.0;
    for &visibility in &model.head().visibilities {
        let atmosphere = real_at(visibility, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
        let exact = ColumnIntegrator::new(&atmosphere);
        let air = model.transmittance(visibility).unwrap();
        for i in 0..1500 {
            let altitude = 15_000.0 * share(i, 0.754_877_666).powi(2);
            let degrees = match i {
                0 => 90.0,
                _ => 90.0 * share(i, 0.618_033_989).powi(5),
            };
            let planet = air.planet();
            let elevation = degrees.to_radians() - planet.dip(altitude);
            let conditions = welkin::Conditions {
                altitude,
                visibility,
                solar_elevation: elevation.max(model.solar_elevation_range()[0]),
                ..welkin::Conditions::default()
            };
            let sun = model.solar_disc(&conditions).unwrap();
            let direction = sun.direction().map(f64::from);
            let sine = direction[2] / direction.iter().map(|v| v * v).sum::<f64>().sqrt();
            if sine < -planet.dip(altitude).sin() {
                continue;
            }
            let whole = planet.ray(altitude, sine.asin()).length;
            let columns = exact.along(altitude, sine, whole);
            let start = [0.0, 0.0, altitude];
            let end = std::array::from_fn(|k| start[k] + whole * direction[k]);
            let [mut depths, mut light] = [[0.0; NW]; 2];
            air.optical_depth(start, end, &mut depths).unwrap();
            sun.radiance(sun.direction(), &mut light).unwrap();
            for w in 0..NW {
                let parts = atmosphere.constituents.iter().zip(columns);
                let depth: f64 = parts.map(|(c, column)| c.extinction[w] * column).sum();
                let light = f64::from(light[w]) * depth.exp();
                if outside[w] == 0.0 {
                    outside[w] = light;
                }
                if depth < 20.7 {
                    let got = f64::from(depths[w]);
                    let errors = [
                        got / depth - 1.0,
                        (depth - got).exp() - 1.0,
                        light / outside[w] - 1.0,
                    ];
                    classes.add(degrees, errors);
                    if depth < 100f64.ln() {
                        bright = bright.max(errors[2].abs());
                    }
                }
            }
        }
    }
    classes.print();
    let [depth, transmittance, sun] = [0, 1, 2].map(|i| classes.largest(i));
    println!(
        "largest: {depth:.5} {transmittance:.5} {sun:.5}; sun of which 1 % is left: {bright:.5}"
    );
    assert!(depth < 0.005 && bright < 0.01 && sun < 0.04);
}
