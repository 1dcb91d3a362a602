//! The random walk from the observer towards the sun.
//!
//! Free flights by delta tracking with a majorant per shell. One *hero* wavelength decides; every wavelength is
//! weighted with the balance heuristic over all heroes: `m` holds f(λ) / p(hero), `pdf` holds p(λ) / p(hero), and light
//! is gathered as `m · n / Σ pdf`. Sunlight is sampled once per flight, at a point of its own along the ray (see
//! [`Segment`]); that point's density does not depend on the hero.

use super::guided_directions::Glow;
use super::medium::{Columns, Medium};
use super::phase::Aerosol;
use super::random::{LATTICE_DIMENSIONS, Stream};
use super::segment::{Scene, Segment};
use super::shell_crossings::Line;
use super::solids::{Hit, Reflectance, Solids};
use super::stokes::{Frame, Mueller, Scattering};
use super::tally::Tally;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Where sunlight is gathered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gather {
    /// Once per flight, at a sampled point that sunlight reaches.
    #[default]
    Flights,
    /// At the scattering points of the walk: slower, and so a check.
    Collisions,
}

/// What lights the planet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// The sun.
    Sun,
    /// Radiance 1 from every direction, which a planet that absorbs nothing must return everywhere.
    Furnace,
}

/// A walk under way.
pub struct Path<const N: usize> {
    /// Where it is.
    pub point: DVec3,
    /// Where it looks.
    pub frame: Frame,
    /// Weight to the observer.
    pub m: Mueller<N>,
    /// Densities relative to the hero's.
    pub pdf: [f64; N],
    /// The wavelength lane that decides.
    pub hero: usize,
    /// Ground bounces so far.
    pub bounces: usize,
    /// Scattering events so far.
    pub scatterings: usize,
}

/// Walks in one scene.
pub struct Walker<'a, const N: usize> {
    /// The scene.
    pub scene: Scene<'a, N>,
    /// Treatment of aerosols.
    pub aerosol: Aerosol,
    /// Where sunlight is gathered.
    pub gather: Gather,
    /// What lights the planet.
    pub light: Light,
    /// Scratch space.
    pub segment: Segment,
    /// What stands in the way. With solids, reflectance is part of the weights, and bounces are not told apart.
    pub solids: Option<&'a dyn Solids>,
}

/// How far from a surface walks go on, m: their own surface must not stop them.
const CLEARANCE: f64 = 1e-3;
/// Flights of a walk and tentative collisions of a flight after which it ends: more than any air has use for that light
/// gets through (some thousand optical depths), so that no walk is endless in air that has none.
const MOST_FLIGHTS: usize = 1 << 20;
const MOST_COLLISIONS: usize = 1 << 24;

enum Flight {
    Escape,
    Ground(f64),
    Solid(Hit),
    Collision(f64, Columns),
    /// No end within [`MOST_COLLISIONS`].
    Lost,
}

/// Numbers for one step: the lattice's while they last, then the stream's.
pub struct Numbers<'a> {
    /// Point of the lattice.
    pub lattice: [f64; LATTICE_DIMENSIONS],
    /// How many of its coordinates are used up.
    pub used: usize,
    /// Where the rest come from.
    pub stream: &'a mut Stream,
}

impl Numbers<'_> {
    /// The next uniform number.
    pub fn draw(&mut self) -> f64 {
        if self.used < LATTICE_DIMENSIONS {
            self.used += 1;
            self.lattice[self.used - 1]
        } else {
            self.stream.uniform()
        }
    }
}

impl<const N: usize> Walker<'_, N> {
    pub(super) fn medium(&self) -> &Medium<N> {
        self.scene.medium
    }

    /// Follows `path`, whose direction has just been chosen, to its end.
    pub fn follow(&mut self, mut path: Path<N>, numbers: &mut Numbers, tally: &mut Tally<N>) {
        let reference = path.m.strength() * self.normaliser(&path);
        for _ in 0..MOST_FLIGHTS {
            let line = Line::new(path.point, path.frame.w);
            let ground = line.ground_distance(self.medium().radius);
            let end = ground.unwrap_or_else(|| line.space_distance(self.medium().top));
            let hit = self
                .solids
                .and_then(|solids| solids.hit(path.point, path.frame.w, end));
            let end = hit.map_or(end, |hit| hit.distance);
            if self.gather == Gather::Flights && self.light == Light::Sun {
                self.gather_along(&path, &line, end, numbers.draw(), tally);
            }
            let flight = self.fly(&mut path, &line, ground, hit, numbers);
            if !self.arrive(&mut path, &line, flight, numbers, tally) {
                return;
            }
            let strength = path.m.strength() * self.normaliser(&path) / reference;
            if strength < 0.1 || strength.is_nan() {
                let survival = (strength / 0.1).max(0.05);
                if numbers.draw() >= survival {
                    return;
                }
                path.m.scale(&[1.0 / survival; N]);
            }
        }
    }

    /// What happens at the end of a flight; false if the walk ends there.
    fn arrive(
        &self,
        path: &mut Path<N>,
        line: &Line,
        flight: Flight,
        numbers: &mut Numbers,
        tally: &mut Tally<N>,
    ) -> bool {
        match flight {
            Flight::Lost => false,
            Flight::Escape => {
                if self.light == Light::Furnace {
                    self.gather_escape(path, tally);
                }
                false
            }
            Flight::Ground(t) => {
                path.point = line.at(t);
                if let Some(solids) = self.solids {
                    let up = path.point.normalize();
                    path.point = up * self.medium().radius;
                    return self.reflect(path, up, solids.ground(path.point), numbers, tally);
                }
                path.bounces += 1;
                if path.bounces >= tally.sums.len() {
                    return false;
                }
                self.bounce(path, numbers, tally, true);
                true
            }
            Flight::Solid(hit) => {
                path.point = line.at(hit.distance) + CLEARANCE * hit.normal;
                self.reflect(path, hit.normal, hit.reflectance, numbers, tally)
            }
            Flight::Collision(t, profile) => {
                path.point = line.at(t);
                if self.gather == Gather::Collisions && self.light == Light::Sun {
                    self.gather_at(path, &profile, tally);
                }
                self.scatter(path, &profile, numbers)
            }
        }
    }

    /// Leaves a surface whose reflectance is known; false if it reflects nothing.
    fn reflect(
        &self,
        path: &mut Path<N>,
        normal: DVec3,
        reflectance: Reflectance,
        numbers: &mut Numbers,
        tally: &mut Tally<N>,
    ) -> bool {
        let medium = self.medium();
        path.m
            .scale(&medium.wavelengths.map(|nm| reflectance.at(nm)));
        if path.m.strength() <= 0.0 {
            return false;
        }
        self.leave(path, normal, numbers, tally, true);
        true
    }

    /// n / Σ pdf: the balance heuristic's weight of what the hero found.
    pub(super) fn normaliser(&self, path: &Path<N>) -> f64 {
        let n = self.medium().active;
        n as f64 / path.pdf[..n].iter().sum::<f64>()
    }

    /// Chooses a new direction at a scattering point; false if the walk ends there.
    pub fn scatter(&self, path: &mut Path<N>, profile: &Columns, numbers: &mut Numbers) -> bool {
        let total = self.medium().scattering_of(profile);
        if total[path.hero] <= 0.0 {
            return false;
        }
        let glow = Glow::new(path.point, self.scene.sun, path.scatterings);
        path.scatterings += 1;
        let pick = numbers.draw();
        let (u, v) = (numbers.draw(), numbers.draw());
        let (cosine, angle) = if pick < glow.share {
            let direction = glow.sample(u, v);
            let cosine = path.frame.w.dot(direction).clamp(-1.0, 1.0);
            (cosine, path.frame.angle_to(direction))
        } else {
            let rest = (pick - glow.share) / (1.0 - glow.share);
            let cosine = self.sample_phase(path.hero, profile, rest * total[path.hero], u);
            (cosine, ((TAU * v).cos(), (TAU * v).sin()))
        };
        path.frame = path.frame.turned(angle).bent(cosine).orthonormalised();
        let f = self.scattering_at(profile, cosine);
        path.m.turn(angle);
        path.m.scatter(&f);
        let lobe = 4.0 * PI * glow.share * glow.density(path.frame.w);
        let density = |w: usize| (1.0 - glow.share) * f.f11[w] / total[w] + lobe;
        let hero = density(path.hero);
        path.m.scale(&[1.0 / hero; N]);
        if N > 1 {
            for w in 0..N {
                let here = if total[w] > 0.0 { density(w) } else { 0.0 };
                path.pdf[w] *= here / hero;
            }
        }
        true
    }

    /// A scattering cosine from the mixture of all lobes; `pick` is uniform up to the hero's scattering coefficient.
    fn sample_phase(&self, hero: usize, profile: &Columns, mut pick: f64, u: f64) -> f64 {
        let mut cosine = 0.0;
        for lobe in &self.medium().lobes {
            let share = profile[lobe.constituent] * lobe.scattering[hero];
            if share > 0.0 {
                cosine = lobe.sample(hero, u);
                if pick < share {
                    break;
                }
                pick -= share;
            }
        }
        cosine
    }

    pub(super) fn scattering_at(&self, profile: &Columns, cosine: f64) -> Scattering<N> {
        let mut f = Scattering::ZERO;
        for lobe in &self.medium().lobes {
            lobe.add(profile[lobe.constituent], cosine, self.aerosol, &mut f);
        }
        f
    }

    /// Leaves the ground at `path.point` in a cosine-distributed direction.
    pub fn bounce(
        &self,
        path: &mut Path<N>,
        numbers: &mut Numbers,
        tally: &mut Tally<N>,
        sunlit: bool,
    ) {
        let up = path.point.normalize();
        path.point = up * self.medium().radius;
        self.leave(path, up, numbers, tally, sunlit);
    }

    /// Leaves a Lambertian surface at `path.point` in a cosine-distributed direction.
    fn leave(
        &self,
        path: &mut Path<N>,
        normal: DVec3,
        numbers: &mut Numbers,
        tally: &mut Tally<N>,
        sunlit: bool,
    ) {
        path.m.depolarise();
        if sunlit && self.light == Light::Sun {
            self.gather_surface(path, normal, tally);
        }
        let (u, turn) = (numbers.draw(), TAU * numbers.draw());
        let frame = Frame::around(normal).turned((turn.cos(), turn.sin()));
        path.frame = frame.bent((1.0 - u).sqrt()).orthonormalised();
    }

    /// Delta tracking to the next real collision of the hero.
    fn fly(
        &self,
        path: &mut Path<N>,
        line: &Line,
        ground: Option<f64>,
        hit: Option<Hit>,
        numbers: &mut Numbers,
    ) -> Flight {
        let medium = self.medium();
        let limit = hit.map_or(f64::INFINITY, |hit| line.start + hit.distance);
        let mut shell = Medium::<N>::shell(&medium.shells, path.point.length());
        let mut s = line.start;
        let mut factor = [1.0; N];
        let mut depth = -(1.0 - numbers.stream.uniform()).ln();
        let mut tentative = 0;
        let flight = loop {
            let Some((exit, down)) = step(medium, line, shell, s) else {
                break Flight::Escape;
            };
            let majorant = medium.shells[shell].majorant;
            let thickness = majorant * (exit - s).max(0.0);
            if depth < thickness {
                tentative += 1;
                if tentative > MOST_COLLISIONS {
                    break Flight::Lost;
                }
                s += depth / majorant;
                if let Some(hit) = hit.filter(|_| s >= limit) {
                    break Flight::Solid(hit);
                }
                let profile = medium.profile((line.radius(s) - medium.radius).max(0.0));
                let extinction = medium.extinction_of(&profile);
                let real = extinction[path.hero] / majorant;
                if numbers.stream.uniform() < real {
                    collide(path, &extinction);
                    break Flight::Collision(s - line.start, profile);
                }
                if N > 1 {
                    for w in 0..N {
                        factor[w] *= (1.0 - extinction[w] / majorant) / (1.0 - real);
                    }
                }
                depth = -(1.0 - numbers.stream.uniform()).ln();
                continue;
            }
            depth -= thickness;
            s = exit;
            if let Some(hit) = hit.filter(|_| s >= limit) {
                break Flight::Solid(hit);
            }
            match (down, shell) {
                (true, 0) => break Flight::Ground(ground.unwrap_or(0.0)),
                (true, _) => shell -= 1,
                (false, i) if i + 1 == medium.shells.len() => break Flight::Escape,
                (false, _) => shell += 1,
            }
        };
        if N > 1 {
            path.m.scale(&factor);
            for w in 0..N {
                path.pdf[w] *= factor[w];
            }
        }
        flight
    }
}

/// Weights a real collision: density µ(λ), of which the hero's is divided out.
fn collide<const N: usize>(path: &mut Path<N>, extinction: &[f64; N]) {
    let hero = extinction[path.hero];
    path.m.scale(&[1.0 / hero; N]);
    if N > 1 {
        for w in 0..N {
            path.pdf[w] *= extinction[w] / hero;
        }
    }
}

/// `s` where the line leaves `shell` and whether it does so downwards; `None` beside the atmosphere.
fn step<const N: usize>(
    medium: &Medium<N>,
    line: &Line,
    shell: usize,
    s: f64,
) -> Option<(f64, bool)> {
    if s < 0.0
        && let Some(crossing) = line.crossing(medium.shells[shell].lower)
    {
        return Some((-crossing, true));
    }
    line.crossing(medium.shells[shell].upper)
        .map(|exit| (exit, false))
}
