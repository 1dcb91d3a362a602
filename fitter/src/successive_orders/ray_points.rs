//! The points along a view ray at which the source function is sampled.

use super::moments::HIGHEST;
use super::spectra::{NW, Spectrum};
use super::spectral_medium::Medium;
use crate::column::ColumnIntegrator;

/// A quadrature node on a ray.
pub struct Node {
    /// Altitude, m.
    pub altitude: f64,
    /// Cosine and sine of the angle at the planet's centre between the observer and this point.
    pub arc: (f64, f64),
    /// Cosine of the local zenith angle of the view direction.
    pub cos_zenith: f64,
    /// Transmittance to the observer times the quadrature weight, m.
    pub weight: Spectrum,
    /// By how much more polarised light comes through.
    pub kept_polarised: Spectrum,
}

impl Node {
    /// The weight of Q and U.
    pub fn polarised_weight(&self) -> Spectrum {
        std::array::from_fn(|w| self.weight[w] * self.kept_polarised[w])
    }
}

/// A ray from an observer, in the vertical plane that holds it.
pub struct Path {
    /// Quadrature nodes, outwards.
    pub nodes: Vec<Node>,
    /// Transmittance of the whole ray.
    pub transmittance: Spectrum,
    /// Where it ends on the ground: cosine and sine of the arc.
    pub ground: Option<(f64, f64)>,
}

/// Two-point Gauss-Legendre on 0..1.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Longest segment, m: over it the sun's elevation changes by a quarter of a degree.
const LONGEST: f64 = 25_000.0;
/// Segments of a ray: they get longer where there would be more.
const MOST_SEGMENTS: f64 = 1e5;

/// Divides the ray from `altitude` with zenith cosine `mu` and `length` into segments; `fineness` 1 is for production.
pub fn trace(
    medium: &Medium,
    altitude: f64,
    mu: f64,
    length: f64,
    ground: bool,
    fineness: f64,
) -> Path {
    let radius = medium.atmosphere.planet_radius;
    let integrator = ColumnIntegrator::new(&medium.atmosphere);
    let r0 = radius + altitude;
    let at = |s: f64| {
        let r = (r0 * r0 + 2.0 * r0 * mu * s + s * s).sqrt();
        (r - radius, (s + r0 * mu) / r)
    };
    let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    let arc = |s: f64| {
        let (x, z) = (s * sine, r0 + s * mu);
        let r = x.hypot(z);
        (z / r, x / r)
    };
    let columns = |s: f64| integrator.along(altitude, mu, s);
    let transmittance = |s: f64| medium.transmittance(&columns(s));
    let keeps = medium.keeps_polarisation();
    let mut nodes = vec![];
    let mut s = 0.0;
    let mut behind = columns(0.0);
    let mut passed: Spectrum = [1.0; NW];
    while s < length {
        let (h, c) = at(s);
        let ds = segment(medium, h, c, &passed, fineness).max(length / MOST_SEGMENTS);
        let ds = ds.min(length - s);
        let first = nodes.len();
        let mut taken = [0.0; NW];
        for x in GAUSS {
            let d = s + x * ds;
            let (h, c) = at(d);
            let before = columns(d);
            let weight = medium.transmittance(&before).map(|t| t * 0.5 * ds as f32);
            let extinction = medium.sum(&medium.profiles(h.max(0.0)));
            for w in 0..NW {
                taken[w] += extinction[w] * weight[w];
            }
            nodes.push(Node {
                altitude: h.max(0.0),
                arc: arc(d),
                cos_zenith: c.clamp(-1.0, 1.0),
                weight,
                kept_polarised: match keeps {
                    true => medium.kept_polarised(&before, c),
                    false => [1.0; NW],
                },
            });
        }
        s += ds;
        let here = columns(s);
        let depth = medium.sum(&std::array::from_fn(|k| (here[k] - behind[k]) as f32));
        take_exactly(&mut nodes[first..], &taken, &passed, &depth);
        behind = here;
        passed = medium.transmittance(&here);
        if passed.iter().all(|&t| t < 1e-6) {
            return Path {
                nodes,
                transmittance: [0.0; NW],
                ground: None,
            };
        }
    }
    Path {
        nodes,
        transmittance: transmittance(length),
        ground: ground.then(|| arc(length)),
    }
}

/// Weights the nodes of a segment of optical depth `depth`, to which `passed` comes, so that it takes away exactly what
/// its transmittance says; so far it would be `taken`.
fn take_exactly(nodes: &mut [Node], taken: &Spectrum, passed: &Spectrum, depth: &Spectrum) {
    for node in nodes {
        for w in 0..NW {
            if taken[w] > f32::MIN_POSITIVE {
                node.weight[w] *= passed[w] * -(-depth[w]).exp_m1() / taken[w];
            }
        }
    }
}

/// Segment length at altitude `h` where the ray rises with `cosine`: bounded in the optical depth of the lights that
/// have `passed` so far, in height and in arc.
fn segment(medium: &Medium, h: f64, cosine: f64, passed: &Spectrum, fineness: f64) -> f64 {
    let profiles = medium.profiles(h);
    let mut extinction = [0f32; NW];
    for (part, p) in medium.parts.iter().zip(profiles) {
        for (sum, coefficient) in extinction.iter_mut().zip(&part.extinction) {
            *sum += p * coefficient;
        }
    }
    let seen = extinction.iter().zip(passed).map(|(e, t)| e * t.sqrt());
    let extinction = seen.fold(0.0, f32::max);
    let climb = fineness * height_step(h, medium.atmosphere.top());
    let r = medium.atmosphere.planet_radius + h;
    // |cosine·ds + ds²/2r| = climb, the curvature of the planet included.
    let slope = cosine.abs();
    let by_height = 2.0 * climb / (slope + (slope * slope + 2.0 * climb / r).sqrt());
    by_height
        .min(fineness / f64::from(extinction).max(1e-12))
        .min(fineness * LONGEST)
}

/// How far one may climb before the profiles change: finest across the inversion at 2 km, and ever finer towards the
/// edge of air that does not end where the grid of the light field does.
fn height_step(h: f64, top: f64) -> f64 {
    match h {
        h if h < 1300.0 => 400.0,
        h if h < 2700.0 => 150.0,
        h if h < 10_500.0 => 600.0,
        h if h < 14_000.0 => 350.0,
        h if h < 40_000.0 => 1000.0,
        h if h < 60_000.0 => 2000.0,
        h if h < HIGHEST || top <= HIGHEST => 5000.0,
        h => (0.1 * (top - h)).clamp(100.0, 5000.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::{Particles, real_at};
    use crate::dataset::VISIBLE;
    use crate::successive_orders::SOLAR_ANGULAR_RADIUS;

    #[test]
    fn what_does_not_pass_is_taken_by_the_segments() {
        let air = real_at(20e3, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
        let medium = Medium::new(air, SOLAR_ANGULAR_RADIUS).unwrap();
        for mu in [0.02, 0.3, 1.0] {
            let path = trace(&medium, 0.0, mu, 80e3, false, 3.0);
            let mut taken = [0.0; NW];
            for node in &path.nodes {
                let extinction = medium.sum(&medium.profiles(node.altitude));
                for w in 0..NW {
                    taken[w] += extinction[w] * node.weight[w];
                }
            }
            for (taken, passed) in taken.iter().zip(&path.transmittance) {
                assert!(
                    (taken + passed - 1.0).abs() < 2e-5,
                    "{mu}: {taken} {passed}"
                );
            }
        }
    }
}
