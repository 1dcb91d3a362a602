//! Questions to the valid files, with the answers of the f64 oracle.

use serde_json::{Value, json};
use welkin::format::parse;
use welkin::{Conditions, Model};

use crate::axis;
use crate::common::oracle::{Oracle, Query};
use crate::files::Case;

/// Relative tolerance of a value.
pub const RELATIVE: f64 = 1e-4;
/// Absolute tolerance in units of the zenith radiance.
const OF_ZENITH: f64 = 1e-7;
/// Absolute tolerance of Q and U in units of L.
const OF_LIGHT: f64 = 2e-4;
/// Relative tolerance of light that segments up to 100 m scatter.
const OF_SHORT: f64 = 0.02;
/// Relative tolerance of light that longer segments scatter.
const OF_LONG: f64 = 0.05;
/// Pieces of the oracle's integral, m.
const LONGEST_PIECE: f64 = 250.0;
/// Spread queries per file, besides the special ones.
const SPREAD: usize = 14;

/// The same of files with a spectrum, which are asked for several wavelengths each.
const SPECTRAL: usize = 9;

/// The same of files that show nothing new about evaluation.
const BRIEF: usize = 2;

/// All queries of a file.
pub fn of(case: &Case) -> Vec<Value> {
    // What is between nodes does not depend on where they are special.
    let spectral = !Oracle::new(&case.raw).cells().is_empty();
    let spread_queries = match (case.brief, spectral) {
        (true, _) => BRIEF,
        (_, true) => SPECTRAL,
        _ => SPREAD,
    };
    let mut all: Vec<Query> = (0..spread_queries)
        .map(|i| spread(&case.bytes, i))
        .collect();
    if !case.brief && !spectral {
        all.extend(special(&case.bytes));
    }
    if let Some(&("transmittance" | "aerial-perspective")) = case.needs.first() {
        all.retain(|query| query.direction != [0.0; 3]);
        // Rounding beyond the last visibility is no error.
        let visibility = ranges(&case.bytes).visibility[1] * (1.0 + 1e-12);
        all.push(Query {
            visibility,
            ..spread(&case.bytes, 0)
        });
        let asked = all.iter().enumerate();
        let mut queries: Vec<Value> = asked
            .flat_map(|(i, query)| segment(case, query, i))
            .collect();
        queries.extend(segment_refusals(case, &all[0]));
        return queries;
    }
    if case.name == "minimal" {
        all.extend(lengths(&case.bytes));
        all.extend(zeniths(&case.bytes));
    }
    let mut queries: Vec<Value> = all.iter().flat_map(|query| asked(case, query)).collect();
    if !case.brief {
        queries.extend(refusals(&case.bytes));
    }
    if case.needs.contains(&"axis") {
        queries.extend(axis::queries(case));
    }
    queries
}

/// The query of a file that must be refused.
pub fn refused(quantity: &str, class: &str) -> Value {
    let query = plain(50e3);
    let asked = match quantity {
        "relative_radiance" | "relative_radiance_at" => value(quantity, &query, 500.0),
        _ => over(quantity, &query, 1000.0),
    };
    with_error(asked, class)
}

/// A value of the axis, which stands where visibilities do.
pub fn of_axis(quantity: &str, axis: f64, answer: Result<f64, &str>) -> Value {
    let asked = value(quantity, &plain(axis), 500.0);
    match answer {
        Ok(visibility) => with_values(asked, &[visibility], &[0.0]),
        Err(class) => with_error(asked, class),
    }
}

/// The zenith by day.
fn plain(visibility: f64) -> Query {
    Query {
        altitude: 0.0,
        visibility,
        albedo: 0.2,
        solar_elevation: 0.5,
        solar_azimuth: 0.0,
        direction: [0.0, 0.0, 1.0],
    }
}

struct Ranges {
    altitude: [f64; 2],
    visibility: [f64; 2],
    elevation: [f64; 2],
}

fn ranges(file: &[u8]) -> Ranges {
    let model = Model::from_bytes(file).expect("a valid model");
    Ranges {
        altitude: model.altitude_range(),
        visibility: model.visibility_range(),
        elevation: model.solar_elevation_range(),
    }
}

/// The `i`-th of queries that fill the ranges of a file evenly (additive recurrence).
fn spread(file: &[u8], i: usize) -> Query {
    const STEPS: [f64; 7] = [
        0.8566749, 0.7338919, 0.6287067, 0.5385973, 0.4614027, 0.3952718, 0.3386191,
    ];
    let t: [f64; 7] = STEPS.map(|step| (0.5 + step * (i + 1) as f64).fract());
    let ranges = ranges(file);
    let within = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
    let z = 2.0 * t[4] - 1.0;
    let (y, x) = (std::f64::consts::TAU * t[5]).sin_cos();
    let horizontal = (1.0 - z * z).sqrt();
    Query {
        altitude: within(ranges.altitude, t[0] * t[0]),
        visibility: within(ranges.visibility, t[1]),
        albedo: t[2],
        solar_elevation: within(ranges.elevation, t[3] * t[3]),
        solar_azimuth: 6.0 * t[6] - 3.0,
        direction: [horizontal * x, horizontal * y, z].map(|v| f64::from(v as f32)),
    }
}

/// Ends of ranges, poles, the sun's direction, and both sides of the horizon.
fn special(file: &[u8]) -> Vec<Query> {
    let ranges = ranges(file);
    let [low, high] = ranges.altitude;
    let at = |altitude: f64, elevation: f64, direction: [f64; 3]| Query {
        altitude,
        visibility: ranges.visibility[1],
        albedo: 1.0,
        solar_elevation: elevation,
        solar_azimuth: 0.25,
        direction: direction.map(|v| f64::from(v as f32)),
    };
    let [dusk, noon] = ranges.elevation;
    let head = parse(file).expect("a valid file").head;
    let dip = |h: f64| head.planet.dip(h);
    let sloped = |h: f64, above: f64| {
        let (z, horizontal) = (above - dip(h)).sin_cos();
        [horizontal * 0.8, horizontal * -0.6, z]
    };
    let (sine, cosine) = 0.3f64.sin_cos();
    vec![
        at(low, dusk, [0.0, 0.0, 2.0]),
        at(high, noon, [0.0, 0.0, -0.5]),
        at(
            high,
            0.3,
            [cosine * 0.25f64.cos(), cosine * 0.25f64.sin(), sine],
        ),
        at(low, 0.3, [3.0, -4.0, 0.001]),
        at(high, 0.0, sloped(high, 1e-5)),
        at(high, 0.0, sloped(high, -1e-5)),
        at(low, 0.1, [-1.0, 0.1, -0.2]),
        // Rounding beyond the ends is no error.
        at(high * (1.0 + 1e-12), noon + 1e-12, [0.2, 0.1, 0.3]),
        at(low, 0.5, [0.0; 3]),
        // Azimuths fade, for observers in a depression and on a ground that is rounded under the sphere.
        at(-430.0, noon - 1e-4, [0.8, 0.3, 0.6]),
        at(-1e-9, noon - 0.02, [-0.2, 0.9, 0.1]),
    ]
}

/// The zenith under suns of every quadrant.
fn zeniths(file: &[u8]) -> Vec<Query> {
    let azimuths = [-2.5, -1.0, 1.0, 2.5].into_iter();
    let query = |solar_azimuth| Query {
        solar_azimuth,
        direction: [0.0, 0.0, 1.0],
        ..spread(file, 0)
    };
    azimuths.map(query).collect()
}

/// Directions of all lengths that readers take.
fn lengths(file: &[u8]) -> Vec<Query> {
    let queries = [1e-30, 1e-20, 1e20, 1e30].into_iter().enumerate();
    let scaled = queries.map(|(i, length)| {
        let query = spread(file, i);
        let direction = query.direction.map(|v| f64::from((v * length) as f32));
        Query { direction, ..query }
    });
    scaled.collect()
}

/// What is asked about one direction: everything, each with its tolerances.
fn asked(case: &Case, query: &Query) -> Vec<Value> {
    let model = Model::from_bytes(case.bytes.as_slice()).expect("a valid model");
    let conditions = Conditions {
        altitude: query.altitude,
        visibility: query.visibility,
        albedo: query.albedo,
        solar_elevation: query.solar_elevation,
        solar_azimuth: query.solar_azimuth,
    };
    let [first, last] = model.wavelength_range().expect("a sound spectrum");
    let wavelength = (first + (last - first) * (0.3 + 0.4 * query.albedo)).round();
    let ask = |quantity| value(quantity, query, wavelength);
    // Only the oracle makes numbers; the library says whether the chunks are there.
    if let Err(error) = model.sky(&conditions) {
        return vec![with_error(ask("relative_radiance"), error.class())];
    }
    if query.direction == [0.0; 3] {
        return vec![with_error(ask("relative_radiance"), "direction")];
    }
    let oracle = Oracle::new(&case.raw);
    let asking = query;
    let query = &clamped(query, &ranges(&case.bytes));
    let ask = |quantity| value(quantity, asking, wavelength);
    let zenith = Query {
        direction: [0.0, 0.0, 1.0],
        ..*query
    };
    let floor: Vec<f64> = oracle
        .radiance(&zenith)
        .iter()
        .map(|l| l * OF_ZENITH)
        .collect();
    let lowest = floor.iter().copied().fold(f64::INFINITY, f64::min);
    let relative = oracle.radiance(query);
    let (at, solar) = oracle.radiance_at(query, wavelength);
    let outside = value("radiance_at", query, last + 1.0);
    let mut queries = vec![
        with_error(outside, "range"),
        with_values(ask("relative_radiance"), &relative, &floor),
        with_values(
            ask("xyz"),
            &oracle.xyz(query),
            &oracle.xyz(&zenith).map(|c| c * OF_ZENITH),
        ),
    ];
    if case.needs.contains(&"polarisation") {
        queries.push(stokes(ask("stokes"), &oracle, query, &floor));
    }
    // The logarithm of almost nothing is no test of a reader.
    let firm = |(l, floor): (&f64, &f64)| *l == 0.0 || *l > 1e3 * floor;
    if relative.iter().zip(&floor).all(firm) {
        for wavelength in cells(&oracle, query.albedo) {
            let (at, _) = oracle.radiance_at(query, wavelength);
            let asked = value("relative_radiance_at", asking, wavelength);
            queries.push(with_values(asked, &[at], &[lowest]));
        }
        queries.push(with_values(ask("relative_radiance_at"), &[at], &[lowest]));
        if case.needs.contains(&"polarisation") {
            for wavelength in cells(&oracle, query.albedo).into_iter().chain([wavelength]) {
                let expected = oracle.stokes_at(query, wavelength);
                let wide = lowest.max(OF_LIGHT * expected[0]);
                let absolute = [lowest, wide, wide];
                let asked = value("stokes_at", asking, wavelength);
                queries.push(with_values(asked, &expected, &absolute));
            }
        }
        queries.push(with_values(
            ask("radiance_at"),
            &[at * solar],
            &[lowest * solar],
        ));
    }
    queries
}

/// Wavelengths that only files with a spectrum are asked for: a cell, ends among them, one between cells, and a node.
fn cells(oracle: &Oracle, place: f64) -> Vec<f64> {
    let cells = oracle.cells();
    let Some(last) = cells.len().checked_sub(1) else {
        return Vec::new();
    };
    let cell = (place * last as f64).round() as usize;
    let before = cell.min(last - 1);
    let between = cells[before] + 0.382 * (cells[before + 1] - cells[before]);
    let nodes = oracle.nodes().into_iter();
    let node = nodes.filter(|node| (cells[0]..=cells[last]).contains(node));
    [cells[cell], between]
        .into_iter()
        .chain(node.skip(1).take(1))
        .collect()
}

/// What is asked about a segment.
fn segment(case: &Case, query: &Query, i: usize) -> Vec<Value> {
    match case.needs.contains(&"aerial-perspective") {
        true => into(case, query, i),
        false => through(case, query, i),
    }
}

/// Transmittance from the observer over some distance, from a metre to beyond the air.
fn through(case: &Case, query: &Query, i: usize) -> Vec<Value> {
    let distance = 10f64.powf(6.2 * (0.618_034 * i as f64).fract()).round();
    let within = Query {
        altitude: query.altitude,
        ..clamped(query, &ranges(&case.bytes))
    };
    let oracle = Oracle::new(&case.raw);
    let expected = oracle.transmittance(&within, distance);
    let absolute = vec![1e-9; expected.len()];
    let asked = over("transmittance", query, distance);
    let mut queries = vec![with_values(asked, &expected, &absolute)];
    for wavelength in cells(&oracle, query.albedo) {
        let expected = oracle.transmittance_at(&within, distance, wavelength);
        let asked = over_at("transmittance_at", query, distance, wavelength);
        queries.push(with_values(asked, &[expected], &[1e-9]));
    }
    queries
}

/// Light that is scattered towards the observer, without and with its polarisation, over the same distances and, every
/// third time, over one metre.
fn into(case: &Case, query: &Query, i: usize) -> Vec<Value> {
    let farthest = if case.name == "aerial-perspective-negative" {
        2.0
    } else {
        6.2
    };
    let distance = match i % 3 {
        0 => 1.0,
        _ => 10f64
            .powf(farthest * (0.618_034 * i as f64).fract())
            .round(),
    };
    let asked = ["in_scattering", "in_scattering_stokes"].map(|name| over(name, query, distance));
    let asking = query;
    let query = &Query {
        altitude: query.altitude,
        ..clamped(query, &ranges(&case.bytes))
    };
    let model = Model::from_bytes(case.bytes.as_slice()).expect("a valid model");
    // Only the oracle makes numbers; the library says whether the chunks are there.
    if let Err(error) = model.aerial_perspective(&Conditions {
        visibility: query.visibility,
        altitude: ranges(&case.bytes).altitude[0],
        ..Conditions::default()
    }) {
        return asked.map(|asked| with_error(asked, error.class())).into();
    }
    let oracle = Oracle::new(&case.raw);
    let light = oracle.in_scattering(query, distance, LONGEST_PIECE);
    let part = |i: usize| -> Vec<f64> { light.iter().map(|light| light[i]).collect() };
    let tolerance = if distance <= 100.0 { OF_SHORT } else { OF_LONG };
    let [l, q, u] = [0, 1, 2].map(part);
    let absolute: Vec<f64> = l.iter().map(|l| tolerance * l).collect();
    let [plain, stokes] = asked;
    let mut queries = vec![
        with_values(plain, &l, &absolute),
        with_values(stokes, &[l, q, u].concat(), &absolute.repeat(3)),
    ];
    for wavelength in cells(&oracle, query.albedo) {
        let light = oracle.mixed_stokes(&light, wavelength);
        let absolute = [tolerance * light[0]; 3];
        let ask = |quantity| over_at(quantity, asking, distance, wavelength);
        let plain = ask("in_scattering_at");
        queries.push(with_values(plain, &light[..1], &absolute[..1]));
        queries.push(with_values(
            ask("in_scattering_stokes_at"),
            &light,
            &absolute,
        ));
    }
    queries
}

fn over(quantity: &str, query: &Query, distance: f64) -> Value {
    over_at(quantity, query, distance, 500.0)
}

fn over_at(quantity: &str, query: &Query, distance: f64, wavelength: f64) -> Value {
    let mut asked = value(quantity, query, wavelength);
    asked["distance"] = json!(distance);
    asked
}

/// Conditions outside the model.
fn segment_refusals(case: &Case, query: &Query) -> Vec<Value> {
    let aerial = case.needs.contains(&"aerial-perspective");
    let ask = |quantity: &str, change: &dyn Fn(&mut Query)| {
        let mut query = Query { ..*query };
        change(&mut query);
        with_error(over(quantity, &query, 100.0), "range")
    };
    let ranges = ranges(&case.bytes);
    let far = |q: &mut Query| q.visibility = ranges.visibility[1] * 1.1;
    let quantity = if aerial {
        "in_scattering_at"
    } else {
        "transmittance_at"
    };
    let cells = Oracle::new(&case.raw).cells();
    let beyond = cells.first().zip(cells.last());
    let beyond = beyond.map_or(Vec::new(), |(first, last)| vec![first - 0.1, last + 0.1]);
    let beyond = beyond.into_iter().map(|wavelength| {
        let near = clamped(query, &ranges);
        with_error(over_at(quantity, &near, 100.0, wavelength), "range")
    });
    if !aerial {
        return beyond.chain([ask("transmittance", &far)]).collect();
    }
    let refusals = vec![
        ask("in_scattering", &far),
        ask("in_scattering", &|q| q.albedo = 1.1),
        ask("in_scattering", &|q| {
            q.solar_elevation = ranges.elevation[0] - 0.01
        }),
        ask("in_scattering_stokes", &far),
    ];
    beyond.chain(refusals).collect()
}

/// What a query means whose conditions lie outside by no more than rounding.
fn clamped(query: &Query, ranges: &Ranges) -> Query {
    let within = |value: f64, [low, high]: [f64; 2]| value.clamp(low, high);
    Query {
        altitude: within(query.altitude, ranges.altitude),
        visibility: within(query.visibility, ranges.visibility),
        solar_elevation: within(query.solar_elevation, ranges.elevation),
        ..*query
    }
}

/// L, then Q, then U, each at all wavelengths.
fn stokes(asked: Value, oracle: &Oracle, query: &Query, floor: &[f64]) -> Value {
    let light = oracle.stokes(query);
    let part = |i: usize| light.iter().map(move |stokes| stokes[i]);
    let expected: Vec<f64> = part(0).chain(part(1)).chain(part(2)).collect();
    let wide = |(l, floor): (f64, &f64)| floor.max(OF_LIGHT * l);
    let polarised: Vec<f64> = part(0).zip(floor).map(wide).collect();
    with_values(asked, &expected, &[floor, &polarised, &polarised].concat())
}

/// Queries outside the model or without a meaning.
fn refusals(file: &[u8]) -> Vec<Value> {
    let ranges = ranges(file);
    let good = || Query {
        altitude: ranges.altitude[0],
        visibility: ranges.visibility[0],
        albedo: 0.5,
        solar_elevation: 0.5,
        solar_azimuth: 0.0,
        direction: [0.0, 0.6, 0.8],
    };
    let ask = |change: &dyn Fn(&mut Query)| {
        let mut query = good();
        change(&mut query);
        with_error(value("relative_radiance", &query, 500.0), "range")
    };
    let mut refusals = vec![
        ask(&|q| q.altitude = ranges.altitude[1] + 1.0),
        ask(&|q| q.altitude = -500.1),
        ask(&|q| q.visibility = ranges.visibility[0] * 0.9),
        ask(&|q| q.albedo = -0.1),
        ask(&|q| q.albedo = 1.1),
        ask(&|q| q.solar_elevation = ranges.elevation[0] - 0.01),
        ask(&|q| q.solar_elevation = ranges.elevation[1] + 0.01),
    ];
    if has_sky(file, &good()) {
        let beyond = value("radiance_at", &good(), rounded_up(file));
        refusals.push(with_error(beyond, "range"));
    }
    refusals
}

/// Whether the chunks that the query needs are there.
fn has_sky(file: &[u8], query: &Query) -> bool {
    let model = Model::from_bytes(file).expect("a valid model");
    let conditions = Conditions {
        altitude: query.altitude,
        visibility: query.visibility,
        albedo: query.albedo,
        solar_elevation: query.solar_elevation,
        solar_azimuth: query.solar_azimuth,
    };
    model.sky(&conditions).is_ok()
}

/// A wavelength beyond the last by no more than rounding.
fn rounded_up(file: &[u8]) -> f64 {
    let model = Model::from_bytes(file).expect("a valid model");
    let [_, last] = model.wavelength_range().expect("a sound spectrum");
    last * (1.0 + 1e-12)
}

fn value(quantity: &str, query: &Query, wavelength: f64) -> Value {
    json!({
        "quantity": quantity,
        "altitude": query.altitude,
        "visibility": query.visibility,
        "albedo": query.albedo,
        "solar_elevation": query.solar_elevation,
        "solar_azimuth": query.solar_azimuth,
        "direction": query.direction,
        "wavelength": wavelength,
        "distance": 0.0,
    })
}

fn with_error(mut query: Value, class: &str) -> Value {
    query["error"] = json!(class);
    query
}

fn with_values(mut query: Value, expected: &[f64], absolute: &[f64]) -> Value {
    let short = |v: &f64| format!("{v:.3e}").parse::<f64>().unwrap();
    let long = |v: &f64| format!("{v:.12e}").parse::<f64>().unwrap();
    query["expected"] = json!(expected.iter().map(long).collect::<Vec<_>>());
    query["absolute"] = json!(absolute.iter().map(short).collect::<Vec<_>>());
    query
}

/// The conditions and the direction of a query.
pub fn scene(query: &Value) -> (Conditions, [f32; 3]) {
    let number = |value: &Value| value.as_f64().expect("a number");
    let conditions = Conditions {
        altitude: number(&query["altitude"]),
        visibility: number(&query["visibility"]),
        albedo: number(&query["albedo"]),
        solar_elevation: number(&query["solar_elevation"]),
        solar_azimuth: number(&query["solar_azimuth"]),
    };
    let direction = [0, 1, 2].map(|i| number(&query["direction"][i]) as f32);
    (conditions, direction)
}

/// A query as readers get it.
pub fn line(query: &Value) -> String {
    let direction = query["direction"].as_array().unwrap();
    let conditions = [
        "altitude",
        "visibility",
        "albedo",
        "solar_elevation",
        "solar_azimuth",
    ];
    let cells = conditions.iter().map(|name| query[*name].to_string());
    let direction = direction.iter().map(Value::to_string);
    let numbers: Vec<String> = cells
        .chain(direction)
        .chain(["wavelength", "distance"].map(|name| query[name].to_string()))
        .collect();
    format!(
        "{}\t{}",
        query["quantity"].as_str().unwrap(),
        numbers.join("\t")
    )
}

/// Compares an answer with what the suite expects.
pub fn check(query: &Value, answer: Result<Vec<f32>, &'static str>, name: &str) {
    let values = match (answer, query["error"].as_str()) {
        (Err(class), Some(expected)) => return assert_eq!(class, expected, "{name}: {query}"),
        (Ok(values), None) => values,
        (answer, _) => panic!("{name}: {query}: {answer:?}"),
    };
    let numbers = |key: &str| -> Vec<f64> {
        let array = query[key].as_array().unwrap();
        array.iter().map(|v| v.as_f64().unwrap()).collect()
    };
    let (expected, absolute) = (numbers("expected"), numbers("absolute"));
    assert_eq!(values.len(), expected.len());
    for ((got, expected), absolute) in values.iter().zip(expected).zip(absolute) {
        let tolerance = (RELATIVE * expected.abs()).max(absolute);
        let off = (f64::from(*got) - expected).abs();
        assert!(off <= tolerance, "{name}: {query}: {got} is not {expected}");
    }
}
