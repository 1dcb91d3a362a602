//! View rays through a solved light field: the fields that the model stores.

use super::first_order::{self, LineIntegrals, Peaks};
use super::lobes::Lobes;
use super::ray_points::{Path, trace};
use super::scattered_source::{DARK, SourceTable, Stokes, Sun};
use super::solve::LightField;
use super::spectra::{NW, Spectrum};
use super::spectral_medium::Medium;
use super::unresolved::TwiceScattered;
use crate::column::planet;
use welkin::geometry::{Planet, Side};

/// Number of fields.
pub const FIELDS: usize = 5;
/// Number of fields of Q and U.
pub const POLARISED: usize = 4;

/// Light along a view ray, divided by what the evaluator multiplies back.
///
/// Singly scattered light is stored without its phase function; particles share that of their kind, and the small
/// difference goes to the multiply scattered light. So does the polarisation by particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    /// Single Rayleigh scattering, over its phase function.
    pub rayleigh: Spectrum,
    /// Single scattering by particles of the first kind, over its phase function.
    pub fine: Spectrum,
    /// Single scattering by particles of the second kind, over its phase function.
    pub coarse: Spectrum,
    /// Multiply scattered light over a black ground: I, Q, U.
    pub multiple: Stokes,
    /// Light that left a white ground once: I, Q, U.
    pub ground: Stokes,
}

impl Fields {
    /// The five intensities in the order of the file, then Q and U of the multiply scattered light and of the light
    /// from the ground.
    pub fn spectra(&self) -> [&Spectrum; FIELDS + POLARISED] {
        let ([i, q, u], [ground_i, ground_q, ground_u]) = (&self.multiple, &self.ground);
        let (rayleigh, fine, coarse) = (&self.rayleigh, &self.fine, &self.coarse);
        [
            rayleigh, fine, coarse, i, ground_i, q, u, ground_q, ground_u,
        ]
    }
}

/// Gathers along view rays.
pub struct Gatherer<'a> {
    medium: &'a Medium,
    light: &'a LightField,
    planet: Planet,
    fineness: f64,
}

impl<'a> Gatherer<'a> {
    /// With segments `fineness` times the production length.
    pub fn new(medium: &'a Medium, light: &'a LightField, fineness: f64) -> Self {
        Self {
            medium,
            light,
            planet: planet(&medium.atmosphere),
            fineness,
        }
    }

    /// The air.
    pub fn medium(&self) -> &Medium {
        self.medium
    }

    /// The light in it.
    pub fn light(&self) -> &LightField {
        self.light
    }

    /// The planet.
    pub fn planet(&self) -> Planet {
        self.planet
    }

    /// The ray from `altitude` (m) at `elevation` (rad) above the local horizontal; on the side of the horizon that
    /// `side` says.
    pub fn path(&self, altitude: f64, elevation: f64, side: Side) -> Path {
        let ray = self.planet.ray(altitude, elevation);
        let length = if ray.side == side {
            ray.length
        } else {
            self.tangent(altitude, side)
        };
        trace(
            self.medium,
            altitude,
            elevation.sin(),
            length,
            side == Side::Down,
            self.fineness,
        )
    }

    /// Length of the ray that touches the ground, counted to the ground or to the top of the atmosphere.
    fn tangent(&self, altitude: f64, side: Side) -> f64 {
        let reach = |h: f64| (h * (2.0 * self.planet.radius + h)).sqrt();
        match side {
            Side::Down => reach(altitude),
            Side::Up => reach(altitude) + reach(self.planet.top),
        }
    }

    /// Fields along `path`, whose zenith cosine is `mu`, for every sun.
    pub fn fields(&self, path: &Path, mu: f64, suns: &[Sun]) -> Vec<Fields> {
        let mut sunlit: Vec<_> = suns
            .iter()
            .map(|_| LineIntegrals::new(self.medium))
            .collect();
        let mut multiple = vec![[DARK; 2]; suns.len()];
        let mut twice: Vec<_> = suns
            .iter()
            .map(|_| TwiceScattered::new(self.medium))
            .collect();
        for node in &path.nodes {
            let profiles = self.medium.profiles(node.altitude);
            let sky = SourceTable::new(self.medium, &self.light.sky, node);
            let ground = SourceTable::new(self.medium, &self.light.ground, node);
            for (i, sun) in suns.iter().enumerate() {
                let local = sun.at(node);
                if let Some((t, columns)) = self.medium.sunlight_through(node.altitude, local.mu) {
                    sunlit[i].add(&profiles, &t, node);
                    twice[i].add(&profiles, &columns, &t, &node.weight);
                }
                sky.add(self.medium, &local, node, &mut multiple[i][0]);
                ground.add(self.medium, &local, node, &mut multiple[i][1]);
            }
        }
        let mut out = vec![];
        for (i, (sums, mut light)) in sunlit.iter().zip(multiple).enumerate() {
            let sun = &suns[i];
            twice[i].add_to(&mut light[0][0], mu, sun);
            out.push(self.assemble(sums, light, (mu, sun)));
        }
        out
    }

    /// All light along `path`, polarised, for one sun and ground albedo; for an atmosphere of any make.
    pub fn stokes(&self, path: &Path, mu: f64, sun: &Sun, albedo: f32) -> Stokes {
        let mut sums = LineIntegrals::new(self.medium);
        let mut light = [DARK; 2];
        let mut twice = TwiceScattered::new(self.medium);
        for node in &path.nodes {
            let local = sun.at(node);
            if let Some((t, columns)) = self.medium.sunlight_through(node.altitude, local.mu) {
                let profiles = self.medium.profiles(node.altitude);
                sums.add(&profiles, &t, node);
                twice.add(&profiles, &columns, &t, &node.weight);
            }
            for (moments, out) in [&self.light.sky, &self.light.ground]
                .into_iter()
                .zip(&mut light)
            {
                let table = SourceTable::new(self.medium, moments, node);
                table.add(self.medium, &local, node, out);
            }
        }
        twice.add_to(&mut light[0][0], mu, sun);
        let mut out = first_order::stokes(self.medium, &sums, (mu, sun), Peaks::Whole);
        for (s, total) in out.iter_mut().enumerate() {
            for w in 0..NW {
                let ground = albedo / (1.0 - albedo * self.light.spherical_albedo[w]);
                total[w] += light[0][s][w] + ground * light[1][s][w];
            }
        }
        out
    }

    fn assemble(
        &self,
        integrals: &LineIntegrals,
        light: [Stokes; 2],
        (mu, sun): (f64, &Sun),
    ) -> Fields {
        let [mut multiple, ground] = light;
        first_order::add_polarised_beside_rayleigh(
            self.medium,
            integrals,
            (mu, sun),
            &mut multiple,
        );
        let sums = integrals.all();
        let beside = first_order::beside_kinds(self.medium, sums, sun.cosine(mu));
        for w in 0..NW {
            multiple[0][w] += beside[w];
        }
        Fields {
            rayleigh: first_order::rayleigh(self.medium, sums),
            fine: first_order::particles(self.medium, 0, sums),
            coarse: first_order::particles(self.medium, 1, sums),
            multiple,
            ground,
        }
    }

    /// Polarising share of Rayleigh scattering.
    pub fn polarising(&self) -> &Spectrum {
        &self.medium.polarising
    }

    /// Phase function of a kind of particles; 1 where the atmosphere has none.
    pub fn phase(&self, kind: usize) -> &Lobes {
        &self.medium.kinds[kind]
    }
}
