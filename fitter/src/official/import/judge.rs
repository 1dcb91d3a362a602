//! How far an imported model is from its file, at the skies that the file holds and in directions of its own.

use super::sites::{PLANET, Sites};
use crate::assess::Quantiles;
use crate::official::OfficialData;
use crate::official::layout::Node;
use anyhow::Result;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use welkin::geometry::Side;
use welkin::{Conditions, Model};

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
    let axes = &data.header().axes;
    let nodes: Vec<Node> = (0..axes.albedos.len() * axes.elevations.len())
        .map(|i| Node {
            visibility,
            albedo: i % axes.albedos.len(),
            altitude,
            elevation: i / axes.albedos.len(),
        })
        .collect();
    let skies: Vec<Vec<Error>> = nodes
        .into_par_iter()
        .map(|node| of_sky(data, model, node, count))
        .collect::<Result<_>>()?;
    Ok(skies.concat())
}

fn of_sky(data: &OfficialData, model: &Model, node: Node, count: usize) -> Result<Vec<Error>> {
    let axes = &data.header().axes;
    let altitude = axes.altitudes[node.altitude];
    let [lowest, highest] = model.solar_elevation_range();
    let elevation = axes.elevations[node.elevation].to_radians();
    let ours = model.sky(&Conditions {
        altitude,
        visibility: 1e3 * axes.visibilities[node.visibility],
        albedo: axes.albedos[node.albedo],
        solar_elevation: elevation.clamp(lowest, highest),
        solar_azimuth: 0.0,
    })?;
    let theirs = data.stored_sky(node)?;
    let seed = 7919 * (node.elevation as u64 + 1000 * node.visibility as u64) + node.albedo as u64;
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ (node.altitude as u64) << 32);
    let mut uniform = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let dip = PLANET.dip(altitude);
    let (mut pairs, mut spectrum) = (vec![], vec![0.0; model.wavelengths().len()]);
    while pairs.len() < count {
        let (z, turn) = (2.0 * uniform() - 1.0, std::f64::consts::TAU * uniform());
        let above = (z.asin() + dip).to_degrees();
        if above.abs() < HORIZON || above < 0.0 && !Sites::sees_down(altitude) {
            continue;
        }
        let across = (1.0 - z * z).sqrt();
        let direction = [across * turn.cos(), across * turn.sin(), z];
        ours.radiance(direction.map(|v| v as f32), &mut spectrum)?;
        let side = if above > 0.0 { Side::Up } else { Side::Down };
        let truth = theirs.beside_horizon(direction, side)?;
        let cosine = direction[0] * elevation.cos() + direction[2] * elevation.sin();
        pairs.push((
            truth,
            spectrum.clone(),
            cosine.clamp(-1.0, 1.0).acos(),
            above,
        ));
    }
    let channels = data.header().channels;
    let mut out = vec![];
    for c in 0..channels.count {
        let mean = pairs.iter().map(|p| p.0[c]).sum::<f64>() / count as f64;
        for (truth, ours, from_sun, above) in &pairs {
            let against = truth[c].max(DARK * mean);
            if against > 0.0 {
                out.push(Error {
                    relative: (f64::from(ours[c]) - truth[c]).abs() / against,
                    from_sun: from_sun.to_degrees(),
                    above_horizon: *above,
                    solar_elevation: axes.elevations[node.elevation],
                    wavelength: channels.centre(c),
                    altitude,
                });
            }
        }
    }
    Ok(out)
}

/// One line per class, in percent.
pub fn table(errors: &[Error]) -> String {
    let mut out = format!(
        "{:<30} {:>9} {:>9} {:>9} {:>9}\n",
        "relative error", "median", "p95", "p99", "max"
    );
    for (name, belongs) in CLASSES {
        let class = errors.iter().filter(|e| belongs(e)).map(|e| e.relative);
        if let Some(q) = Quantiles::of(class) {
            let [median, p95, p99, max] = [q.median, q.p95, q.p99, q.max].map(|v| 100.0 * v);
            out += &format!("{name:<30} {median:>8.3}% {p95:>8.3}% {p99:>8.3}% {max:>8.2}%\n");
        }
    }
    out
}
