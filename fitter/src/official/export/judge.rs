//! How far an exported file is from its model, read back and evaluated as the official code would.

use super::plan::Plan;
use crate::assess::Quantiles;
use crate::official::OfficialData;
use crate::official::angles::PLANET_RADIUS;
use crate::official::layout::Node;
use crate::official::ray::Ray;
use anyhow::Result;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::TAU;
use welkin::{Bands, Model, PolarisationFrame, Stokes};

/// Directions within this of the geometric horizon do not count, degrees: the tables ramp over the step there.
const HORIZON: f64 = 0.3;
/// Radiance below this share of the mean of its sky counts as that bright.
const DARK: f64 = 0.01;
/// Stored skies that are looked at, and directions in each.
const SKIES: usize = 48;
const DIRECTIONS: usize = 300;
/// Rays that the transmittance is looked at along.
const RAYS: usize = 4000;

#[derive(Clone, Copy)]
struct Error {
    size: f64,
    from_sun: f64,
    above_horizon: f64,
    solar_elevation: f64,
}

type Class = (&'static str, fn(&Error) -> bool);

const CLASSES: [Class; 6] = [
    ("all", |_| true),
    ("sky beyond 15° of the sun", |e| {
        e.above_horizon > 5.0 && e.from_sun > 15.0
    }),
    ("within 15° of the sun", |e| e.from_sun <= 15.0),
    ("0.3 to 5° above the horizon", |e| {
        (0.0..5.0).contains(&e.above_horizon)
    }),
    ("below the horizon", |e| e.above_horizon < 0.0),
    ("sun below the horizon", |e| e.solar_elevation < 0.0),
];

/// A table of errors at stored skies: radiance relative, degree of polarisation and transmittance absolute.
pub fn report(data: &OfficialData, model: &Model, bands: &Bands, plan: &Plan) -> Result<String> {
    let nodes: Vec<Node> = data.header().nodes().collect();
    let stride = nodes.len().div_ceil(SKIES);
    let chosen: Vec<Node> = nodes.into_iter().step_by(stride).collect();
    let skies: Vec<Vec<Error>> = chosen
        .par_iter()
        .map(|node| radiance(data, model, bands, plan, *node))
        .collect::<Result<_>>()?;
    let mut out = table("radiance, relative", &skies.concat());
    if data.polarisation().is_some() {
        let skies: Vec<Vec<Error>> = chosen
            .par_iter()
            .map(|node| polarisation(data, model, bands, plan, *node))
            .collect::<Result<_>>()?;
        out += &table("degree of polarisation", &skies.concat());
    }
    let errors = transmittance(data, model, bands)?;
    out += &row("transmittance along rays", &errors);
    Ok(out)
}

/// A direction with its angles, degrees.
struct Seen {
    direction: [f64; 3],
    place: Error,
}

fn seen(plan: &Plan, data: &OfficialData, node: Node) -> Vec<Seen> {
    let viewpoint = plan.viewpoint(data.header(), node);
    let seed = 104_729 * data.header().index(node, 0) + 17;
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let dip = (PLANET_RADIUS / (PLANET_RADIUS + viewpoint.altitude)).acos();
    let (se, ce) = viewpoint.solar_elevation.sin_cos();
    let mut out = vec![];
    while out.len() < DIRECTIONS {
        let (z, turn) = (2.0 * uniform(&mut rng) - 1.0, TAU * uniform(&mut rng));
        let above = (z.asin() + dip).to_degrees();
        if above.abs() < HORIZON || above < 0.0 && viewpoint.altitude <= 0.0 {
            continue;
        }
        let across = (1.0 - z * z).sqrt();
        let direction = [across * turn.cos(), across * turn.sin(), z];
        let cosine: f64 = direction[0] * ce + direction[2] * se;
        let place = Error {
            size: 0.0,
            from_sun: cosine.clamp(-1.0, 1.0).acos().to_degrees(),
            above_horizon: above,
            solar_elevation: viewpoint.solar_elevation,
        };
        out.push(Seen { direction, place });
    }
    out
}

fn uniform(rng: &mut Pcg64Mcg) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn radiance(
    data: &OfficialData,
    model: &Model,
    bands: &Bands,
    plan: &Plan,
    node: Node,
) -> Result<Vec<Error>> {
    let seen = seen(plan, data, node);
    let truth = model.band_sky(&plan.conditions(data.header(), node), bands)?;
    let theirs = plan.stored_sky(data, node)?;
    let count = bands.count();
    let mut pairs = vec![];
    let mut want = vec![0.0; count];
    for s in &seen {
        truth.radiance(s.direction.map(|v| v as f32), &mut want)?;
        pairs.push((want.clone(), theirs.radiance(s.direction)?));
    }
    let mut out = vec![];
    for c in 0..count {
        let mean = pairs.iter().map(|(w, _)| f64::from(w[c])).sum::<f64>() / pairs.len() as f64;
        for (s, (want, got)) in seen.iter().zip(&pairs) {
            let want = f64::from(want[c]);
            let against = want.max(DARK * mean);
            if against > 0.0 {
                out.push(Error {
                    size: (got[c] - want).abs() / against,
                    ..s.place
                });
            }
        }
    }
    Ok(out)
}

fn polarisation(
    data: &OfficialData,
    model: &Model,
    bands: &Bands,
    plan: &Plan,
    node: Node,
) -> Result<Vec<Error>> {
    let truth = model.polarised_band_sky(&plan.conditions(data.header(), node), bands)?;
    let theirs = data.stored_polarisation(node)?;
    let mut want = vec![Stokes::default(); bands.count()];
    let mut out = vec![];
    for s in seen(plan, data, node) {
        let direction = s.direction.map(|v| v as f32);
        truth.stokes(direction, PolarisationFrame::SunAligned, &mut want)?;
        let got = theirs.degree(s.direction)?;
        out.extend(want.iter().zip(got).map(|(want, got)| Error {
            size: (got - f64::from(want.signed_degree())).abs(),
            ..s.place
        }));
    }
    Ok(out)
}

/// Along random rays from the stored altitudes at the stored visibilities, to random ends or to that of the air.
fn transmittance(data: &OfficialData, model: &Model, bands: &Bands) -> Result<Vec<Error>> {
    let table = data.transmittance()?;
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut want = vec![0.0; bands.count()];
    let mut out = vec![];
    for v in table.visibilities() {
        let air = model.band_transmittance(1e3 * v, bands)?;
        for _ in 0..RAYS / table.visibilities().len() {
            let pick = (uniform(&mut rng) * table.altitudes().len() as f64) as usize;
            let h = table.altitudes()[pick.min(table.altitudes().len() - 1)];
            let dip = (PLANET_RADIUS / (PLANET_RADIUS + h)).acos();
            let signed = 2.0 * uniform(&mut rng) - 1.0;
            let elevation = (signed * signed * signed).asin() - dip;
            let above = elevation + dip;
            if above.to_degrees().abs() < HORIZON || above < 0.0 && h < 1.0 {
                continue;
            }
            let ray = Ray {
                altitude: h,
                theta: std::f64::consts::FRAC_PI_2 - elevation,
                length: match uniform(&mut rng) < 0.3 {
                    true => f64::INFINITY,
                    false => 10f64.powf(2.0 + 3.5 * uniform(&mut rng)),
                },
            };
            air.transmittance([0.0, 0.0, h], ray.end(), &mut want)?;
            let got = table.at(h, ray.theta, ray.length, 1e3 * v)?;
            out.extend(want.iter().zip(got).map(|(want, got)| Error {
                size: (got - f64::from(*want)).abs(),
                from_sun: 180.0,
                above_horizon: above.to_degrees(),
                solar_elevation: 0.0,
            }));
        }
    }
    Ok(out)
}

fn table(title: &str, errors: &[Error]) -> String {
    let mut out = format!(
        "{title:<30} {:>9} {:>9} {:>9} {:>9}\n",
        "median", "p95", "p99", "max"
    );
    for (name, belongs) in CLASSES {
        let class: Vec<Error> = errors.iter().filter(|e| belongs(e)).copied().collect();
        out += &row(name, &class);
    }
    out
}

fn row(name: &str, errors: &[Error]) -> String {
    let Some(q) = Quantiles::of(errors.iter().map(|e| e.size)) else {
        return String::new();
    };
    let [median, p95, p99, max] = [q.median, q.p95, q.p99, q.max].map(|v| 100.0 * v);
    format!("{name:<30} {median:>8.3}% {p95:>8.3}% {p99:>8.3}% {max:>8.2}%\n")
}
