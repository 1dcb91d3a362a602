//! How far an imported model is from its file, at the skies that the file holds and in directions of its own.

use super::air::rays;
use super::sites::{PLANET, Sites};
use crate::assess::Quantiles;
use crate::official::OfficialData;
use crate::official::layout::Node;
use crate::official::transmittance::Transmittance;
use anyhow::Result;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::TAU;
use welkin::geometry::Side;
use welkin::{Conditions, Model, PolarisationFrame, Stokes};

/// Directions within this of the geometric horizon do not count: the tables ramp over a step there.
const HORIZON: f64 = 0.3;
/// Radiance below this share of the mean of its sky counts as that bright.
const DARK: f64 = 0.01;

/// The error of one direction and channel.
#[derive(Clone, Copy, Debug)]
pub struct Error {
    /// Relative.
    pub relative: f64,
    /// Angle to the sun, degrees.
    pub from_sun: f64,
    /// Angle above the geometric horizon, degrees.
    pub above_horizon: f64,
    /// Solar elevation, degrees.
    pub solar_elevation: f64,
    /// Wavelength, nm.
    pub wavelength: f64,
    /// Observer altitude, m.
    pub altitude: f64,
}

/// A class of errors and its name.
pub type Class = (&'static str, fn(&Error) -> bool);

/// What is reported.
pub const CLASSES: [Class; 9] = [
    ("all", |_| true),
    ("380 to 760 nm", |e| (380.0..760.0).contains(&e.wavelength)),
    ("on the ground, 380 to 760 nm", |e| {
        e.altitude == 0.0 && (380.0..760.0).contains(&e.wavelength)
    }),
    ("sun above the horizon", |e| e.solar_elevation >= 0.0),
    ("sun below the horizon", |e| e.solar_elevation < 0.0),
    ("sky beyond 15° of the sun", |e| {
        e.above_horizon > 0.0 && e.from_sun > 15.0
    }),
    ("within 15° of the sun", |e| e.from_sun <= 15.0),
    ("0.3 to 5° above the horizon", |e| {
        (0.0..5.0).contains(&e.above_horizon)
    }),
    ("below the horizon", |e| e.above_horizon < 0.0),
];

/// Errors at every stored sky of an altitude and visibility in `count` random directions each.
pub fn errors(
    data: &OfficialData,
    model: &Model,
    [altitude, visibility]: [usize; 2],
    count: usize,
) -> Result<Vec<Error>> {
    over_skies(data, [altitude, visibility], |node| {
        of_sky(data, model, node, count)
    })
}

/// Errors of all stored skies of an altitude and visibility, one after the other.
fn over_skies(
    data: &OfficialData,
    place: [usize; 2],
    of_sky: impl Fn(Node) -> Result<Vec<Error>> + Sync + Send,
) -> Result<Vec<Error>> {
    let skies: Vec<Vec<Error>> = nodes(data, place)
        .into_par_iter()
        .map(of_sky)
        .collect::<Result<_>>()?;
    Ok(skies.concat())
}

/// The stored skies of an altitude and visibility.
fn nodes(data: &OfficialData, [altitude, visibility]: [usize; 2]) -> Vec<Node> {
    let axes = &data.header().axes;
    let albedos = axes.albedos.len();
    let node = |i: usize| Node {
        visibility,
        albedo: i % albedos,
        altitude,
        elevation: i / albedos,
    };
    (0..albedos * axes.elevations.len()).map(node).collect()
}

fn conditions(data: &OfficialData, model: &Model, node: Node) -> Conditions {
    let axes = &data.header().axes;
    let [lowest, highest] = model.solar_elevation_range();
    Conditions {
        altitude: axes.altitudes[node.altitude],
        visibility: 1e3 * axes.visibilities[node.visibility],
        albedo: axes.albedos[node.albedo],
        solar_elevation: axes.elevations[node.elevation]
            .to_radians()
            .clamp(lowest, highest),
        solar_azimuth: 0.0,
    }
}

/// A direction, and its error but for the size and the wavelength.
struct Place {
    direction: [f64; 3],
    error: Error,
}

/// Random directions of a sky that count.
fn places(data: &OfficialData, node: Node, count: usize) -> Vec<Place> {
    let axes = &data.header().axes;
    let altitude = axes.altitudes[node.altitude];
    let elevation = axes.elevations[node.elevation].to_radians();
    let mut rng = Pcg64Mcg::seed_from_u64(7919 * data.header().index(node, 0) + 3);
    let mut uniform = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let dip = PLANET.dip(altitude);
    let mut out = vec![];
    while out.len() < count {
        let (z, turn) = (2.0 * uniform() - 1.0, TAU * uniform());
        let above_horizon = (z.asin() + dip).to_degrees();
        let unseen = above_horizon < 0.0 && !Sites::sees_down(altitude);
        if above_horizon.abs() < HORIZON || unseen {
            continue;
        }
        let across = (1.0 - z * z).sqrt();
        let direction = [across * turn.cos(), across * turn.sin(), z];
        let cosine: f64 = direction[0] * elevation.cos() + z * elevation.sin();
        let error = Error {
            relative: 0.0,
            from_sun: cosine.clamp(-1.0, 1.0).acos().to_degrees(),
            above_horizon,
            solar_elevation: axes.elevations[node.elevation],
            wavelength: 0.0,
            altitude,
        };
        out.push(Place { direction, error });
    }
    out
}

fn of_sky(data: &OfficialData, model: &Model, node: Node, count: usize) -> Result<Vec<Error>> {
    let ours = of_model(data, model, node)?;
    against_stored(data, node, count, |direction, _| ours(direction))
}

/// What the model has for a stored sky, in every channel.
pub fn of_model(
    data: &OfficialData,
    model: &Model,
    node: Node,
) -> Result<impl Fn([f64; 3]) -> Result<Vec<f64>>> {
    let sky = model.sky(&conditions(data, model, node))?;
    let channels = data.header().channels.count;
    Ok(move |direction: [f64; 3]| {
        let mut spectrum = vec![0.0; channels];
        sky.radiance(direction.map(|v| v as f32), &mut spectrum)?;
        Ok(spectrum.into_iter().map(f64::from).collect())
    })
}

/// Errors of what says the radiance of a direction on a side of the horizon, against a stored sky.
pub fn against_stored(
    data: &OfficialData,
    node: Node,
    count: usize,
    ours: impl Fn([f64; 3], Side) -> Result<Vec<f64>>,
) -> Result<Vec<Error>> {
    let theirs = data.stored_sky(node)?;
    let channels = data.header().channels;
    let mut pairs = vec![];
    for place in places(data, node, count) {
        let side = match place.error.above_horizon > 0.0 {
            true => Side::Up,
            false => Side::Down,
        };
        let truth = theirs.beside_horizon(place.direction, side)?;
        pairs.push((place.error, ours(place.direction, side)?, truth));
    }
    let mut out = vec![];
    for c in 0..channels.count {
        let mean = pairs.iter().map(|p| p.2[c]).sum::<f64>() / count as f64;
        for (error, ours, truth) in &pairs {
            let against = truth[c].max(DARK * mean);
            if against > 0.0 {
                out.push(Error {
                    relative: (ours[c] - truth[c]).abs() / against,
                    wavelength: channels.centre(c),
                    ..*error
                });
            }
        }
    }
    Ok(out)
}

/// Errors of the degree of polarisation at the same skies.
pub fn degrees(
    data: &OfficialData,
    model: &Model,
    [altitude, visibility]: [usize; 2],
    count: usize,
) -> Result<Vec<Error>> {
    over_skies(data, [altitude, visibility], |node| {
        degrees_of_sky(data, model, node, count)
    })
}

fn degrees_of_sky(
    data: &OfficialData,
    model: &Model,
    node: Node,
    count: usize,
) -> Result<Vec<Error>> {
    let ours = model.polarised_sky(&conditions(data, model, node))?;
    let theirs = data.stored_polarisation(node)?;
    let channels = data.header().channels;
    let mut light = vec![Stokes::default(); channels.count];
    let mut out = vec![];
    for place in places(data, node, count) {
        let direction = place.direction.map(|v| v as f32);
        ours.stokes(direction, PolarisationFrame::SunAligned, &mut light)?;
        let truth = theirs.degree(place.direction)?;
        for (c, (light, truth)) in light.iter().zip(truth).enumerate() {
            out.push(Error {
                relative: (f64::from(light.signed_degree()) - truth.clamp(-1.0, 1.0)).abs(),
                wavelength: channels.centre(c),
                ..place.error
            });
        }
    }
    Ok(out)
}

/// Errors of the transmittance along rays in all directions from all altitudes.
pub fn transmittance(table: &Transmittance, model: &Model, visibility: f64) -> Result<Vec<f64>> {
    let air = model.transmittance(visibility)?;
    let mut ours = vec![0.0; table.channels().count];
    let mut out = vec![];
    for ray in rays(table) {
        air.transmittance([0.0, 0.0, ray.altitude], ray.end(), &mut ours)?;
        let truth = table.at(ray.altitude, ray.theta, ray.length, visibility)?;
        out.extend(
            ours.iter()
                .zip(truth)
                .map(|(o, t)| (f64::from(*o) - t).abs()),
        );
    }
    Ok(out)
}

/// One line per class, in percent.
pub fn table(title: &str, errors: &[Error]) -> String {
    let mut out = format!(
        "{title:<30} {:>9} {:>9} {:>9} {:>9}\n",
        "median", "p95", "p99", "max"
    );
    for (name, belongs) in CLASSES {
        out += &row(
            name,
            errors.iter().filter(|e| belongs(e)).map(|e| e.relative),
        );
    }
    out
}

/// A line, in percent; none without errors.
pub fn row(name: &str, errors: impl Iterator<Item = f64>) -> String {
    let Some(q) = Quantiles::of(errors) else {
        return String::new();
    };
    let [median, p95, p99, max] = [q.median, q.p95, q.p99, q.max].map(|v| 100.0 * v);
    format!("{name:<30} {median:>8.3}% {p95:>8.3}% {p99:>8.3}% {max:>8.2}%\n")
}
