//! Fewer altitude profiles: layers of one shape or of one kind of particles become one constituent.

use crate::atmosphere::{Constituent, Scatterer};

/// Two spectra are of one shape when their ratio is the same to this, relative.
const SAME: f64 = 1e-9;

/// Merges what can be one without any difference.
pub fn merged(layers: Vec<Constituent>) -> Vec<Constituent> {
    let mut out: Vec<Constituent> = vec![];
    for layer in layers.into_iter().filter(scatters) {
        if let Some(same) = out.iter_mut().find(|c| c.has_shape(&layer.profile)) {
            same.absorb(layer);
            continue;
        }
        let kin = out.iter_mut().find_map(|c| Some((ratio(c, &layer)?, c)));
        match kin {
            Some((ratio, same)) => add(same, &layer, ratio),
            None => out.push(layer),
        }
    }
    out
}

/// Whether there is any of it.
fn scatters(layer: &Constituent) -> bool {
    layer.extinction.iter().any(|&e| e > 0.0)
}

/// How much stronger `b` is than `a`, if all parts of it are by the same factor.
fn ratio(a: &Constituent, b: &Constituent) -> Option<f64> {
    if a.scatterers.len() != b.scatterers.len() {
        return None;
    }
    let strongest =
        (0..a.extinction.len()).max_by(|&i, &j| a.extinction[i].total_cmp(&a.extinction[j]))?;
    let ratio = b.extinction[strongest] / a.extinction[strongest];
    let like = |a: &[f64], b: &[f64]| {
        let most = b.iter().fold(0.0, |m: f64, &v| m.max(v));
        a.iter()
            .zip(b)
            .all(|(a, b)| (a * ratio - b).abs() <= SAME * most)
    };
    let alike = |(a, b): (&Scatterer, &Scatterer)| {
        a.phase == b.phase
            && like(&a.extinction, &b.extinction)
            && like(&a.scattering, &b.scattering)
    };
    a.scatterers
        .iter()
        .zip(&b.scatterers)
        .all(alike)
        .then_some(ratio)
}

/// Adds the profile of what is `ratio` times as strong.
fn add(to: &mut Constituent, layer: &Constituent, ratio: f64) {
    to.name = format!("{} + {}", to.name, layer.name);
    for (sum, value) in to.profile.iter_mut().zip(&layer.profile) {
        *sum += ratio * value;
    }
}
