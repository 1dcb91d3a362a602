//! Orders of scattering, one after the other, until what is left is a geometric tail.

use super::first_order::{self, LineIntegrals, Peaks};
use super::moments::{
    ALTITUDES, COUNT, HARMONICS, Moments, SOLAR_UNITS, SUNS, TENSOR, altitudes, azimuth_harmonics,
    order_start, polar_harmonics, sun_coordinate, sun_node,
};
use super::ray_points::{Path, trace};
use super::scattered_source::{DARK, SourceTable, Stokes, Sun};
use super::spectra::{NW, Spectrum};
use super::spectral_medium::Medium;
use crate::column::planet;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};
use welkin::geometry::{Planet, Side};

/// Resolution of the solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Zenith angles above the geometric horizon.
    pub up: usize,
    /// Zenith angles below it.
    pub down: usize,
    /// Azimuths over half a turn.
    pub azimuths: usize,
    /// How many times finer the angles are for light that was scattered once: it has the aureole.
    pub first: usize,
    /// Orders of scattering that are followed.
    pub orders: usize,
    /// Length of ray segments relative to the production value.
    pub fineness: f64,
}

impl Settings {
    /// Coarse enough for what compares wavelengths or integrates over directions; 1 % off in the ultraviolet.
    pub const COARSE: Self = Self {
        up: 8,
        down: 5,
        azimuths: 6,
        first: 2,
        orders: 5,
        fineness: 6.0,
    };
    /// To try things with.
    pub const DRAFT: Self = Self {
        up: 4,
        down: 3,
        azimuths: 4,
        first: 1,
        orders: 3,
        fineness: 12.0,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            up: 14,
            down: 9,
            azimuths: 10,
            first: 3,
            orders: 9,
            fineness: 1.5,
        }
    }
}

/// All multiply scattered light of an atmosphere.
pub struct LightField {
    /// Light that never touched the ground: moments of orders 1.. (the source of orders 2..).
    pub sky: Moments,
    /// Light that left a perfectly white ground once, under that sky.
    pub ground: Moments,
    /// Irradiance of the ground by the sky over a black ground, per sun node (direct sunlight excluded).
    pub diffuse: Vec<Spectrum>,
    /// Share of the light leaving the ground that comes back to it, per wavelength.
    pub spherical_albedo: Spectrum,
}

impl LightField {
    /// All numbers in a row, for a file.
    pub fn to_values(&self) -> Vec<f32> {
        let moments = [&self.sky, &self.ground]
            .into_iter()
            .flat_map(Moments::nodes);
        let moments = moments.flatten().flatten();
        let rest = self.diffuse.iter().flatten().chain(&self.spherical_albedo);
        moments.chain(rest).copied().collect()
    }

    /// The inverse of [`LightField::to_values`]; `None` for another number of values.
    pub fn from_values(values: &[f32]) -> Option<Self> {
        let nodes = ALTITUDES.len() * SUNS;
        let (sky, rest) = values.split_at_checked(nodes * COUNT * NW)?;
        let (ground, rest) = rest.split_at_checked(nodes * COUNT * NW)?;
        let (diffuse, albedo) = rest.split_at_checked(SUNS * NW)?;
        Some(Self {
            sky: Moments::from_values(sky),
            ground: Moments::from_values(ground),
            diffuse: diffuse.as_chunks().0.to_vec(),
            spherical_albedo: albedo.try_into().ok()?,
        })
    }
}

/// Where ground emission comes from in one application of the transport operator.
enum Source<'a> {
    Sun,
    Moments(&'a Moments),
    Ground(&'a [Spectrum]),
}

struct Direction {
    mu: f64,
    weight: f64,
    path: Path,
}

/// Directions of integration at every altitude of the grid.
struct Sphere {
    altitudes: Vec<f64>,
    /// Cosine and sine, over half a turn.
    azimuths: Vec<(f64, f64)>,
    /// Zenith angles per altitude.
    directions: Vec<Vec<Direction>>,
}

struct Solver<'a> {
    medium: &'a Medium,
    settings: Settings,
    sphere: Sphere,
}

/// Solves for the light field; `progress` is told the share that is done.
pub fn solve(medium: &Medium, settings: Settings, progress: &(dyn Fn(f64) + Sync)) -> LightField {
    let solver = Solver::new(medium, settings);
    let applications = (2 * settings.orders) as f64;
    let done = AtomicUsize::new(0);
    let tick = || progress(done.fetch_add(1, Ordering::Relaxed) as f64 / applications);
    let fine = Sphere::new(medium, settings, settings.first);
    let first = solver.apply(&fine, &Source::Sun);
    let sky = solver.all_orders(first, &tick);
    let mut diffuse = vec![[0.0; NW]; SUNS];
    solver.add_irradiance(&fine, &Source::Sun, &mut diffuse);
    solver.add_irradiance(&solver.sphere, &Source::Moments(&sky), &mut diffuse);
    let emitted: Vec<Spectrum> = (0..SUNS)
        .map(|j| {
            let direct = medium.sunlight(0.0, sun_node(j)).unwrap_or([0.0; NW]);
            let cosine = sun_node(j).max(0.0) as f32;
            std::array::from_fn(|w| (diffuse[j][w] + cosine * direct[w]) / PI as f32)
        })
        .collect();
    let lit = solver.apply(&solver.sphere, &Source::Ground(&emitted));
    let ground = solver.all_orders(lit, &tick);
    let mut returned = vec![[0.0; NW]; SUNS];
    solver.add_irradiance(&solver.sphere, &Source::Moments(&ground), &mut returned);
    let noon = sun_coordinate(0.5) as usize;
    let spherical_albedo = std::array::from_fn(|w| match emitted[noon][w] {
        // No sunlight comes through to the ground, nor would its light come back.
        0.0 => 0.0,
        lit => returned[noon][w] / (PI as f32 * lit),
    });
    LightField {
        sky,
        ground,
        diffuse,
        spherical_albedo,
    }
}

impl Sphere {
    /// With angles `finer` times as dense as `settings` says.
    fn new(medium: &Medium, settings: Settings, finer: usize) -> Self {
        let planet = planet(&medium.atmosphere);
        let count = settings.azimuths * finer;
        let azimuths = (0..count)
            .map(|k| ((k as f64 + 0.5) / count as f64 * PI).sin_cos())
            .map(|(s, c)| (c, s))
            .collect();
        let altitudes = altitudes(planet.top);
        let directions = altitudes
            .par_iter()
            .map(|&h| directions(medium, planet, h, settings, finer))
            .collect();
        Self {
            altitudes,
            azimuths,
            directions,
        }
    }

    /// Every sun node at every azimuth, sun-major.
    fn suns(&self) -> Vec<Sun> {
        (0..SUNS)
            .flat_map(|j| {
                let se = sun_node(j);
                let elevation = (((1.0 - se) * (1.0 + se)).max(0.0).sqrt(), se);
                let at = move |&azimuth| Sun { elevation, azimuth };
                self.azimuths.iter().map(at)
            })
            .collect()
    }
}

impl<'a> Solver<'a> {
    fn new(medium: &'a Medium, settings: Settings) -> Self {
        let sphere = Sphere::new(medium, settings, 1);
        Self {
            medium,
            settings,
            sphere,
        }
    }

    /// Sums `first` and all orders that follow from it.
    fn all_orders(&self, first: Moments, tick: &dyn Fn()) -> Moments {
        let mut total = first.clone();
        let mut previous = first;
        for order in 1..self.settings.orders {
            tick();
            let mut next = self.apply(&self.sphere, &Source::Moments(&previous));
            if order + 1 == self.settings.orders {
                add_tail(&mut next, &previous);
            }
            for (sum, node) in total.nodes_mut().iter_mut().zip(next.nodes()) {
                add_node(sum, node);
            }
            previous = next;
        }
        tick();
        total
    }

    /// Moments of the light that reaches every grid node from `source` without being scattered again.
    fn apply(&self, sphere: &Sphere, source: &Source) -> Moments {
        let suns = sphere.suns();
        let rows = sphere
            .directions
            .par_iter()
            .map(|directions| {
                let mut row = vec![[[0.0; NW]; COUNT]; SUNS];
                for direction in directions {
                    let light = self.radiance(direction, &suns, source);
                    project(direction, &sphere.azimuths, &light, &mut row);
                }
                row
            })
            .collect();
        Moments::from_rows(&sphere.altitudes, rows)
    }

    /// Radiance in `direction` for every sun node and azimuth.
    fn radiance(&self, direction: &Direction, suns: &[Sun], source: &Source) -> Vec<Stokes> {
        let mut light = vec![DARK; suns.len()];
        match source {
            Source::Sun => self.single(direction, suns, &mut light),
            Source::Moments(moments) => {
                for node in &direction.path.nodes {
                    let table = SourceTable::new(self.medium, moments, node);
                    for (sun, out) in suns.iter().zip(&mut light) {
                        table.add(self.medium, &sun.at(node), node, out);
                    }
                }
            }
            Source::Ground(emitted) => {
                if let Some(arc) = direction.path.ground {
                    for (sun, out) in suns.iter().zip(&mut light) {
                        let ((ce, se), (ca, _)) = (sun.elevation, sun.azimuth);
                        let seen = at_sun(emitted, arc.1 * ce * ca + arc.0 * se);
                        for w in 0..NW {
                            out[0][w] += seen[w] * direction.path.transmittance[w];
                        }
                    }
                }
            }
        }
        light
    }

    fn single(&self, direction: &Direction, suns: &[Sun], light: &mut [Stokes]) {
        let mut sums: Vec<_> = suns
            .iter()
            .map(|_| LineIntegrals::new(self.medium))
            .collect();
        for node in &direction.path.nodes {
            let profiles = self.medium.profiles(node.altitude);
            for (sun, sum) in suns.iter().zip(&mut sums) {
                if let Some(t) = self.medium.sunlight(node.altitude, sun.at(node).mu) {
                    sum.add(&profiles, &t, node);
                }
            }
        }
        for ((sun, sum), out) in suns.iter().zip(&sums).zip(light) {
            *out = first_order::stokes(self.medium, sum, (direction.mu, sun), Peaks::Resolved);
        }
    }

    /// Adds the irradiance of the ground per sun node by light from `source`.
    fn add_irradiance(&self, sphere: &Sphere, source: &Source, out: &mut [Spectrum]) {
        let (suns, count) = (sphere.suns(), sphere.azimuths.len());
        let above = sphere.directions[0].iter().filter(|d| d.mu > 0.0);
        for direction in above {
            let light = self.radiance(direction, &suns, source);
            let weight = (direction.weight * direction.mu * 2.0 * PI / count as f64) as f32;
            for (sum, light) in out.iter_mut().zip(light.chunks_exact(count)) {
                for stokes in light {
                    for w in 0..NW {
                        sum[w] += weight * stokes[0][w];
                    }
                }
            }
        }
    }
}

/// Adds the moments of the light from one zenith angle.
fn project(
    direction: &Direction,
    azimuths: &[(f64, f64)],
    light: &[Stokes],
    row: &mut [[Spectrum; COUNT]],
) {
    let polar = polar_harmonics(direction.mu);
    let sine = ((1.0 - direction.mu) * (1.0 + direction.mu))
        .max(0.0)
        .sqrt() as f32;
    let weight = SOLAR_UNITS * (direction.weight * 2.0 * PI / azimuths.len() as f64) as f32;
    for (j, moments) in row.iter_mut().enumerate() {
        for (k, &(cp, sp)) in azimuths.iter().enumerate() {
            let stokes = &light[j * azimuths.len() + k];
            let tensor = tensor_kernel(direction.mu as f32, sine, cp as f32, sp as f32);
            for (out, kernel) in moments.iter_mut().zip(&tensor) {
                for w in 0..NW {
                    out[w] += weight
                        * (kernel[0] * stokes[0][w]
                            + kernel[1] * stokes[1][w]
                            + kernel[2] * stokes[2][w]);
                }
            }
            let cosines = azimuth_harmonics(cp as f32);
            for (m, c) in cosines.into_iter().enumerate() {
                for i in order_start(m)..order_start(m + 1).min(HARMONICS) {
                    let y = weight * polar[i] * c;
                    for w in 0..NW {
                        moments[TENSOR + i][w] += y * stokes[0][w];
                    }
                }
            }
        }
    }
}

fn at_sun(values: &[Spectrum], mu: f64) -> Spectrum {
    let (index, weight) = super::moments::sun_taps(mu);
    let mut out = [0.0; NW];
    for (j, share) in index.into_iter().zip(weight) {
        for w in 0..NW {
            out[w] += share * values[j][w];
        }
    }
    out.map(|v| v.max(0.0))
}

/// Rows of the coherency tensor (xx, yy, zz, xz) as linear forms of I, Q, U.
fn tensor_kernel(ct: f32, st: f32, cp: f32, sp: f32) -> [[f32; 3]; TENSOR] {
    let form = |a: f32, b: f32, u: f32| [0.5 * (a + b), 0.5 * (a - b), 0.5 * u];
    [
        form(ct * ct * cp * cp, sp * sp, -2.0 * ct * cp * sp),
        form(ct * ct * sp * sp, cp * cp, 2.0 * ct * sp * cp),
        form(st * st, 0.0, 0.0),
        form(-ct * st * cp, 0.0, sp * st),
    ]
}

/// Gauss-Legendre zenith angles on both sides of the geometric horizon, crowded towards it.
fn directions(
    medium: &Medium,
    planet: Planet,
    altitude: f64,
    settings: Settings,
    finer: usize,
) -> Vec<Direction> {
    let horizon = -planet.dip(altitude).sin();
    let mut out = vec![];
    for (count, end) in [(settings.up, 1.0), (settings.down, -1.0)] {
        for (x, weight) in gauss_legendre(finer * count) {
            let t = 0.5 * (1.0 + x);
            let mu = horizon + (end - horizon) * t * t;
            let weight = weight * t * (end - horizon).abs();
            let ray = planet.ray(altitude, mu.asin());
            let ground = ray.side == Side::Down;
            let path = trace(medium, altitude, mu, ray.length, ground, settings.fineness);
            out.push(Direction { mu, weight, path });
        }
    }
    out
}

/// Nodes and weights on −1..1.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = -(PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut p0, mut p1) = (1.0, x);
                for k in 1..n {
                    (p0, p1) = (
                        p1,
                        ((2 * k + 1) as f64 * x * p1 - k as f64 * p0) / (k + 1) as f64,
                    );
                }
                slope = n as f64 * (x * p1 - p0) / (x * x - 1.0);
                x -= p1 / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Replaces the last order by itself and all that would follow at the present ratio.
fn add_tail(last: &mut Moments, before: &Moments) {
    for (node, previous) in last.nodes_mut().iter_mut().zip(before.nodes()) {
        let ratio: Spectrum = std::array::from_fn(|w| {
            let energy = |n: &[Spectrum; COUNT]| n[0][w] + n[1][w] + n[2][w];
            let (a, b) = (energy(node), energy(previous));
            if b > 0.0 {
                (a / b).clamp(0.0, 0.95)
            } else {
                0.0
            }
        });
        for moment in node.iter_mut() {
            for w in 0..NW {
                moment[w] /= 1.0 - ratio[w];
            }
        }
    }
}

fn add_node(sum: &mut [Spectrum; COUNT], term: &[Spectrum; COUNT]) {
    for (s, t) in sum.iter_mut().zip(term) {
        for w in 0..NW {
            s[w] += t[w];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_integrates_polynomials() {
        let integral: f64 = gauss_legendre(8).iter().map(|(x, w)| w * x.powi(14)).sum();
        assert!((integral - 2.0 / 15.0).abs() < 1e-12);
    }
}
