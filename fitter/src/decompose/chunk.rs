//! The normalised fields of one (altitude, visibility) with what turns them into relative radiance.

use super::normalise::{RelativeEstimates, SiteEstimates, levels, normalise};
use crate::dataset::{Grid, Tensor};
use crate::successive_orders::scattered_source::Sun;
use crate::successive_orders::{FIELDS, Gatherer, Lobes, NW, Spectrum, rayleigh_phase};
use std::f64::consts::FRAC_PI_2;
use welkin::estimate::Estimates;
use welkin::geometry::Side;

/// A chunk as the fit sees it.
#[derive(Clone)]
pub struct Chunk {
    /// Lengths of the view, azimuth and elevation axes.
    pub sites: [usize; 3],
    /// Normalised fields `[view][phi][elevation][field][wavelength]`.
    values: Vec<f32>,
    /// What they are relative to, relative to the level of the sky.
    estimates: RelativeEstimates,
    /// Cosine of the angle to the sun, `[view][phi][elevation]`.
    cosine: Vec<f32>,
    /// Root weights of the views and of the solar elevations.
    weight: [Vec<f32>; 2],
    polarising: Spectrum,
    /// Phase functions of the kinds of particles.
    kinds: [Lobes; 2],
    spherical_albedo: Spectrum,
    importance: Spectrum,
    seed: u64,
}

/// The field of multiply scattered light.
const DIFFUSE: usize = 3;

/// Share of the weight that is spread evenly over the sites instead of over solid angle and solar elevation.
const EVEN: f64 = 0.4;
/// How much more sites within 15° of the sun count.
const AUREOLE: f32 = 5.0;

/// Root of the weight of nodes by their wavelengths, nm: ozone makes the shortest hardest to fit, and of the infrared
/// less is asked.
fn importance(wavelengths: &[f64]) -> Spectrum {
    std::array::from_fn(|w| match wavelengths[w] {
        ..320.0 => 1.8,
        ..745.0 => 1.0,
        _ => 0.55,
    })
}

impl Chunk {
    /// From the traced tensor of altitude `a`; `seed` tells chunks apart.
    pub fn new(
        tensor: &Tensor,
        (gatherer, estimates): (&Gatherer, &Estimates),
        grid: &Grid,
        a: usize,
        seed: u64,
    ) -> Self {
        let [views, phis, elevations, _] = tensor.shape;
        let medium = gatherer.medium();
        let estimates = SiteEstimates::new(estimates, gatherer.planet(), grid, a);
        let whole = |site, field, w| estimates.of_field(site, field, w);
        Self {
            sites: [views, phis, elevations],
            values: normalise(tensor, 0..FIELDS, whole),
            estimates: estimates.relative(&levels(tensor)),
            cosine: cosines(gatherer, grid, a),
            weight: [view_weights(gatherer, grid, a), elevation_weights(grid)],
            polarising: *gatherer.polarising(),
            kinds: [0, 1].map(|kind| gatherer.phase(kind).clone()),
            spherical_albedo: gatherer.light().spherical_albedo,
            importance: importance(&medium.atmosphere.wavelengths),
            seed,
        }
    }

    /// A chunk without light, phase functions or weights.
    #[cfg(test)]
    pub fn synthetic(sites: [usize; 3]) -> Self {
        let count = sites.iter().product::<usize>();
        Self {
            sites,
            values: vec![0.0; count * FIELDS * NW],
            estimates: RelativeEstimates::ones(count),
            cosine: vec![0.0; count],
            weight: [vec![1.0; sites[0]], vec![1.0; sites[2]]],
            polarising: [0.0; NW],
            kinds: [0, 1].map(|_| Lobes::one([0.0; NW])),
            spherical_albedo: [0.0; NW],
            importance: [1.0; NW],
            seed: 0,
        }
    }

    /// Tells chunks apart.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Index of a site.
    pub fn site(&self, view: usize, phi: usize, elevation: usize) -> usize {
        (view * self.sites[1] + phi) * self.sites[2] + elevation
    }

    /// A normalised field.
    pub fn value(&self, site: usize, field: usize, wavelength: usize) -> f32 {
        self.values[site * FIELDS * NW + field * NW + wavelength]
    }

    /// All normalised fields.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Factors that turn fields into radiance relative to the traced one.
    pub fn radiance_equation(&self, site: usize, w: usize, albedo: f32) -> (usize, [f32; FIELDS]) {
        let (share, total) = self.shares(site, w, albedo);
        (w, share.map(|s| s / total))
    }

    /// Normalised radiance at a site for a ground albedo.
    pub fn radiance(&self, site: usize, w: usize, albedo: f32) -> f32 {
        self.shares(site, w, albedo).1
    }

    /// What each field counts in the radiance, and the radiance.
    fn shares(&self, site: usize, w: usize, albedo: f32) -> ([f32; FIELDS], f32) {
        let c = self.cosine[site];
        let mut share = [
            rayleigh_phase(&[self.polarising[w]; NW], c)[0],
            self.kinds[0].at_one(w, c),
            self.kinds[1].at_one(w, c),
            1.0,
            self.interreflection(w, albedo),
        ];
        for (f, share) in share.iter_mut().enumerate() {
            *share *= self.estimates.of_field(site, f, w);
        }
        let total: f32 = (0..FIELDS).map(|f| share[f] * self.value(site, f, w)).sum();
        (share, total.max(1e-12))
    }

    /// A / (1 − A s): how much light a ground of albedo A sends up relative to a white one that is lit once.
    pub fn interreflection(&self, w: usize, albedo: f32) -> f32 {
        albedo / (1.0 - albedo * self.spherical_albedo[w])
    }

    /// Phase function of every field and wavelength at a cosine of the angle to the sun; 1 for fields that have none.
    pub fn phase_functions(&self, cosine: f32) -> [Spectrum; FIELDS] {
        [
            rayleigh_phase(&self.polarising, cosine),
            self.kinds[0].at(cosine),
            self.kinds[1].at(cosine),
            [1.0; NW],
            [1.0; NW],
        ]
    }

    /// The same chunk with other normalised fields.
    pub fn with_values(&self, values: Vec<f32>) -> Self {
        Self {
            values,
            ..self.clone()
        }
    }

    /// The diffuse estimate over the radiance.
    pub fn diffuse_share(&self, site: usize, w: usize, albedo: f32) -> f32 {
        // The share of multiply scattered light, whose phase function is 1.
        self.radiance_equation(site, w, albedo).1[DIFFUSE]
    }

    /// The radiance, relative to the level of the sky.
    pub fn brightness(&self, site: usize, w: usize, albedo: f32) -> f32 {
        self.shares(site, w, albedo).1
    }

    /// Whether a site is within 37° of the sun.
    pub fn is_near_sun(&self, site: usize) -> bool {
        self.cosine[site] > 0.8
    }

    /// Root of the weight of a node.
    pub fn importance(&self, wavelength: usize) -> f32 {
        self.importance[wavelength]
    }

    /// Root of the weight of a site.
    pub fn weight(&self, site: usize) -> f32 {
        let [_, phis, elevations] = self.sites;
        let (v, e) = (site / (phis * elevations), site % elevations);
        let near = if self.cosine[site] > 0.966 {
            AUREOLE.sqrt()
        } else {
            1.0
        };
        self.weight[0][v] * self.weight[1][e] * near
    }
}

fn cosines(gatherer: &Gatherer, grid: &Grid, a: usize) -> Vec<f32> {
    let (phi, elevation) = (grid.phi_sites(), grid.elevation_sites());
    let mut out = vec![];
    for (_, view) in grid.view_sites(gatherer.planet(), a) {
        for p in &phi {
            for e in &elevation {
                let sun = Sun {
                    elevation: (e.cos(), e.sin()),
                    azimuth: (p.cos(), p.sin()),
                };
                out.push(sun.cosine(view.sin()));
            }
        }
    }
    out
}

/// Mixes weights of mean 1 with even ones and takes the root.
fn blend(measure: Vec<f64>) -> Vec<f32> {
    let mean = measure.iter().sum::<f64>() / measure.len() as f64;
    measure
        .iter()
        .map(|m| ((1.0 - EVEN) * m / mean + EVEN).sqrt() as f32)
        .collect()
}

/// Solid angle per site of the view axes.
fn view_weights(gatherer: &Gatherer, grid: &Grid, a: usize) -> Vec<f32> {
    let dip = gatherer.planet().dip(grid.traced_altitude(a));
    let measure = grid.view_sites(gatherer.planet(), a).into_iter();
    let measure = measure.map(|(side, elevation)| {
        let ((axis, exponent), range) = match side {
            Side::Up => (grid.up, FRAC_PI_2 + dip),
            Side::Down => (grid.down, FRAC_PI_2 - dip),
        };
        let share = ((elevation + dip).abs() / range).max(1e-9);
        let step = range * exponent * share.powf(1.0 - 1.0 / exponent) / axis.intervals as f64;
        elevation.cos() * step
    });
    blend(measure.collect())
}

/// Half of the weight is spread evenly over all solar elevations, half over those below 12°.
fn elevation_weights(grid: &Grid) -> Vec<f32> {
    let axis = grid.elevation;
    let sites = grid.elevation_axis().sites();
    let measure = sites.into_iter().map(|u| {
        let step = axis.elevation(u + 0.5) - axis.elevation(u - 0.5);
        let low = 12f64.to_radians();
        let dense = if axis.elevation(u) < low {
            1.0 / (low - axis.min)
        } else {
            0.0
        };
        step * (1.0 / (axis.max - axis.min) + dense)
    });
    blend(measure.collect())
}
