//! Queries on up to N wavelengths at once.

use super::disc::Disc;
use super::estimate::Estimate;
use super::line_of_sight::Sight;
use super::medium::Medium;
use super::random::{Lattice, Stream};
use super::segment::{Scene, Segment};
use super::single_scattering;
use super::stokes::{Frame, Mueller};
use super::sun::SunGuide;
use super::tally::Tally;
use super::view::{Pixel, View};
use super::walk::{Light, Numbers, Path, Walker};
use super::{BATCHES, Options, Orders, Query, VisibleGround};
use crate::atmosphere::Atmosphere;
use anyhow::Result;
use glam::DVec3;
use rayon::prelude::*;

/// A group of wavelengths that share walks.
pub trait Engine: Send + Sync {
    /// Estimates one query, already checked.
    fn estimate(&self, query: &Query, samples: usize, seed: u64) -> Estimate;
    /// Optical depth of a line of sight per wavelength.
    fn optical_depth(&self, query: &Query) -> Vec<f64>;
    /// Estimates one pixel, already checked.
    fn pixel(
        &self,
        view: &View,
        direction: &dyn Fn(f64, f64) -> DVec3,
        samples: usize,
        counters: (u64, u64),
    ) -> Pixel;
}

/// N wavelength lanes.
pub struct Lanes<const N: usize> {
    pub(super) medium: Medium<N>,
    pub(super) guide: SunGuide,
    pub(super) options: Options,
    pub(super) light: Light,
}

impl<const N: usize> Lanes<N> {
    /// Prepares the wavelengths with the given indices.
    pub fn new(atmosphere: &Atmosphere, lanes: &[usize], options: Options) -> Result<Self> {
        let medium = Medium::new(atmosphere, lanes)?;
        Ok(Self {
            guide: SunGuide::new(&medium),
            medium,
            options,
            light: Light::Sun,
        })
    }

    fn sight(&self, query: &Query) -> Sight<N> {
        let origin = DVec3::new(0.0, 0.0, self.medium.radius + query.altitude);
        let frame = Frame::observer(query.view_zenith, query.view_azimuth);
        Sight::new(&self.medium, origin, frame, query.distance)
    }

    fn ground_seen(&self, sight: &Sight<N>) -> bool {
        sight.hits_ground && self.options.visible_ground == VisibleGround::Lit
    }

    /// What needs no walks, by ground bounces.
    fn exact(&self, sight: &Sight<N>, disc: &Disc) -> Vec<[[f64; N]; 3]> {
        let mut exact = vec![[[0.0; N]; 3]; self.options.bounces + 1];
        if self.light == Light::Furnace {
            exact[0][0] = if sight.hits_ground {
                [0.0; N]
            } else {
                sight.transmittance
            };
            return exact;
        }
        let directions = disc.directions();
        let weight = 1.0 / directions.len() as f64;
        for &sun in &directions {
            let once =
                single_scattering::scattered_once(&self.medium, sight, sun, self.options.aerosol);
            accumulate(&mut exact[0], &once, weight);
            if self.ground_seen(sight) && exact.len() > 1 {
                let ground = single_scattering::sunlit_ground(&self.medium, sight, sun);
                accumulate(&mut exact[1], &[ground, [0.0; N], [0.0; N]], weight);
            }
        }
        exact
    }

    /// Mean over `samples` walks, by ground bounces.
    fn batch(&self, sight: &Sight<N>, disc: &Disc, samples: usize, mut stream: Stream) -> Tally<N> {
        let mut tally = Tally {
            sums: vec![[[0.0; N]; 3]; self.options.bounces + 1],
        };
        let mut walker = Walker {
            scene: Scene::new(&self.medium, &self.guide, disc.middle()),
            aerosol: self.options.aerosol,
            gather: self.options.gather,
            light: self.light,
            segment: Segment::default(),
            solids: None,
        };
        let lattice = Lattice::new(&mut stream);
        let first_hero = (stream.uniform() * self.medium.active as f64) as usize;
        for i in 0..samples {
            let hero = (i + first_hero) % self.medium.active;
            if !disc.is_point() {
                walker.scene.sun = disc.direction(stream.uniform(), stream.uniform());
            }
            let mut numbers = Numbers {
                lattice: lattice.point(i),
                used: 0,
                stream: &mut stream,
            };
            self.walk_from_air(&mut walker, sight, hero, &mut numbers, &mut tally);
            if self.ground_seen(sight) {
                numbers.used = 1;
                self.walk_from_ground(&mut walker, sight, hero, &mut numbers, &mut tally);
            }
        }
        for sum in tally.sums.iter_mut().flatten().flatten() {
            *sum /= samples as f64;
        }
        tally
    }

    /// A walk whose first event is scattering on the line of sight.
    fn walk_from_air(
        &self,
        walker: &mut Walker<N>,
        sight: &Sight<N>,
        hero: usize,
        numbers: &mut Numbers,
        tally: &mut Tally<N>,
    ) {
        let Some((t, density)) = sight.sample(numbers.draw()) else {
            return;
        };
        let medium = &self.medium;
        let point = sight.line.at(t);
        let altitude = (sight.line.radius(sight.line.start + t) - medium.radius).max(0.0);
        let mut path = Path {
            point,
            frame: sight.frame,
            m: Mueller::identity(),
            pdf: [1.0; N],
            hero,
            bounces: 0,
            scatterings: 0,
        };
        let through = medium.transmittance(&sight.columns_to(medium, t));
        path.m.scale(&through.map(|x| x / density));
        if walker.scatter(&mut path, &medium.profile(altitude), numbers) {
            walker.follow(path, numbers, tally);
        }
    }

    /// A walk whose first event is the ground at the end of the line of sight.
    fn walk_from_ground(
        &self,
        walker: &mut Walker<N>,
        sight: &Sight<N>,
        hero: usize,
        numbers: &mut Numbers,
        tally: &mut Tally<N>,
    ) {
        let mut path = Path {
            point: sight.line.at(sight.end),
            frame: sight.frame,
            m: Mueller::identity(),
            pdf: [1.0; N],
            hero,
            bounces: 1,
            scatterings: 0,
        };
        if tally.sums.len() < 2 {
            return;
        }
        path.m.scale(&sight.transmittance);
        // The sun's own light on this ground is part of `exact`.
        walker.bounce(&mut path, numbers, tally, false);
        walker.follow(path, numbers, tally);
    }
}

fn accumulate<const N: usize>(sum: &mut [[f64; N]; 3], stokes: &[[f64; N]; 3], weight: f64) {
    for (s, x) in sum.iter_mut().flatten().zip(stokes.iter().flatten()) {
        *s += weight * x;
    }
}

impl<const N: usize> Engine for Lanes<N> {
    fn estimate(&self, query: &Query, samples: usize, seed: u64) -> Estimate {
        let sight = self.sight(query);
        let disc = Disc::new(query.sun_elevation, self.options.sun_radius);
        let exact = self.exact(&sight, &disc);
        let walks = self.options.orders == Orders::All && samples > 0;
        let batches: Vec<Tally<N>> = if walks {
            (0..BATCHES)
                .into_par_iter()
                .map(|b| self.batch(&sight, &disc, samples, Stream::new(seed, 0, b as u64)))
                .collect()
        } else {
            vec![]
        };
        let active = self.medium.active;
        Estimate::new(
            &sight.transmittance[..active],
            &exact,
            batches.iter().map(|tally| tally.sums.as_slice()),
        )
    }

    fn optical_depth(&self, query: &Query) -> Vec<f64> {
        let sight = self.sight(query);
        let columns = sight.columns_to(&self.medium, sight.end);
        self.medium.extinction_of(&columns)[..self.medium.active].to_vec()
    }

    fn pixel(
        &self,
        view: &View,
        direction: &dyn Fn(f64, f64) -> DVec3,
        samples: usize,
        (seed, index): (u64, u64),
    ) -> Pixel {
        Lanes::pixel(self, view, direction, samples, Stream::new(seed, index, 0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::phase::Aerosol;
    use super::super::test_atmosphere::{clear, conservative};
    use super::*;

    fn furnace(wavelengths: usize, altitude: f64, zenith: f64) -> Vec<(f64, f64)> {
        let atmosphere = conservative(wavelengths);
        let options = Options {
            visible_ground: VisibleGround::Lit,
            bounces: 200,
            ..Options::default()
        };
        let lanes: Vec<usize> = (0..wavelengths).collect();
        let mut engine = Lanes::<4>::new(&atmosphere, &lanes, options).unwrap();
        engine.light = Light::Furnace;
        let query = Query {
            altitude,
            view_zenith: zenith,
            view_azimuth: 1.0,
            sun_elevation: 0.5,
            distance: None,
        };
        let estimate = engine.estimate(&query, 600, 7);
        (0..wavelengths)
            .map(|w| estimate.radiance(1.0, w))
            .map(|r| (r.stokes[0], r.error[0]))
            .collect()
    }

    /// Nothing is absorbed, so a uniformly bright surrounding is seen everywhere as bright as it is.
    #[test]
    fn what_goes_in_comes_out() {
        for (altitude, zenith) in [(0.0, 0.3), (0.0, 1.5), (5000.0, 1.6), (20_000.0, 2.8)] {
            for (i, error) in furnace(3, altitude, zenith) {
                assert!((i - 1.0).abs() < 4.0 * error + 1e-6, "{i} ± {error}");
                assert!(error < 0.03, "{error}");
            }
        }
    }

    #[test]
    fn ozone_takes_some_away() {
        let mut engine = Lanes::<1>::new(&clear(), &[0], Options::default()).unwrap();
        engine.light = Light::Furnace;
        let query = Query {
            altitude: 0.0,
            view_zenith: 0.0,
            view_azimuth: 0.0,
            sun_elevation: 0.5,
            distance: None,
        };
        assert!(engine.estimate(&query, 100, 7).radiance(1.0, 0).stokes[0] < 0.999);
    }

    #[test]
    fn default_aerosols_depolarise() {
        assert_eq!(Options::default().aerosol, Aerosol::Depolarising);
    }
}
