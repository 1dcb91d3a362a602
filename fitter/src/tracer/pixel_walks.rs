//! Pixels: what a camera sees of air, ground and solids, by walks that start in the camera.

use super::disc::Disc;
use super::engine::Lanes;
use super::random::{Lattice, Stream};
use super::segment::{Scene, Segment};
use super::stokes::{Frame, Mueller};
use super::tally::Tally;
use super::view::{Pixel, View};
use super::walk::{Numbers, Path, Walker};
use glam::DVec3;

impl<const N: usize> Lanes<N> {
    /// The mean over `samples` walks in directions that `direction` makes of two numbers in 0..1.
    pub(super) fn pixel(
        &self,
        view: &View,
        direction: &dyn Fn(f64, f64) -> DVec3,
        samples: usize,
        mut stream: Stream,
    ) -> Pixel {
        let disc = Disc::towards(
            view.sun_elevation,
            view.sun_azimuth,
            self.options.sun_radius,
        );
        let mut walker = Walker {
            scene: Scene::new(&self.medium, &self.guide, disc.middle()),
            aerosol: self.options.aerosol,
            gather: self.options.gather,
            light: self.light,
            segment: Segment::default(),
            solids: Some(view.solids),
        };
        let lattice = Lattice::new(&mut stream);
        let first_hero = (stream.uniform() * self.medium.active as f64) as usize;
        let mut sums = [[0.0; N]; 2];
        for i in 0..samples {
            if !disc.is_point() {
                walker.scene.sun = disc.direction(stream.uniform(), stream.uniform());
            }
            let towards = direction(stream.uniform(), stream.uniform());
            let path = Path {
                point: DVec3::new(0.0, 0.0, self.medium.radius + view.altitude),
                frame: Frame::around(towards),
                m: Mueller::identity(),
                pdf: [1.0; N],
                hero: (i + first_hero) % self.medium.active,
                bounces: 0,
                scatterings: 0,
            };
            let mut numbers = Numbers {
                lattice: lattice.point(i),
                used: 0,
                stream: &mut stream,
            };
            let mut tally = Tally {
                sums: vec![[[0.0; N]; 3]],
            };
            walker.follow(path, &mut numbers, &mut tally);
            for (w, x) in tally.sums[0][0].into_iter().enumerate() {
                sums[0][w] += x;
                sums[1][w] += x * x;
            }
        }
        let n = samples as f64;
        let lanes = 0..self.medium.active;
        let variance = |w: usize| (sums[1][w] / n - (sums[0][w] / n).powi(2)).max(0.0);
        Pixel {
            radiance: lanes.clone().map(|w| sums[0][w] / n).collect(),
            error: lanes
                .map(|w| (variance(w) / (n - 1.0).max(1.0)).sqrt())
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::solids::Solids;
    use super::super::solids::{Hit, Reflectance};
    use super::super::test_atmosphere::conservative;
    use super::super::walk::Light;
    use super::super::{Options, Query, Tracer, VisibleGround};
    use super::*;

    /// A wall across x, `height` high, on a ground of the given albedo.
    struct Wall {
        x: f64,
        height: f64,
        albedo: f64,
    }

    const RADIUS: f64 = 6_371_000.0;

    impl Solids for Wall {
        fn hit(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<Hit> {
            let distance = (self.x - origin.x) / direction.x;
            let z = origin.z + distance * direction.z;
            let met = distance > 0.0 && distance < limit && z < RADIUS + self.height;
            met.then(|| Hit {
                distance,
                normal: DVec3::X * -direction.x.signum(),
                reflectance: Reflectance::grey(self.albedo),
            })
        }

        fn blocks(&self, origin: DVec3, direction: DVec3) -> bool {
            self.hit(origin, direction, f64::INFINITY).is_some()
        }

        fn ground(&self, _: DVec3) -> Reflectance {
            Reflectance::grey(self.albedo)
        }
    }

    fn pixel(lanes: &Lanes<4>, wall: &Wall, elevation: f64, samples: usize) -> Pixel {
        let view = View {
            altitude: 100.0,
            sun_elevation: 0.5,
            sun_azimuth: 0.0,
            solids: wall,
        };
        let (sin, cos) = elevation.sin_cos();
        let towards = DVec3::new(cos, 0.0, sin);
        lanes.pixel(&view, &|_, _| towards, samples, Stream::new(1, 2, 3))
    }

    /// White walls on white ground in air that absorbs nothing are as bright as what surrounds them.
    #[test]
    fn solids_lose_no_light() {
        let options = Options::default();
        let mut lanes = Lanes::<4>::new(&conservative(3), &[0, 1, 2], options).unwrap();
        lanes.light = Light::Furnace;
        let wall = Wall {
            x: 3000.0,
            height: 5000.0,
            albedo: 1.0,
        };
        for elevation in [-0.3, 0.2, 1.3] {
            let pixel = pixel(&lanes, &wall, elevation, 4000);
            for (i, error) in pixel.radiance.iter().zip(&pixel.error) {
                assert!((i - 1.0).abs() < 4.0 * error + 1e-6, "{i} ± {error}");
                assert!(*error < 0.05, "{error}");
            }
        }
    }

    /// Without solids in reach a pixel is what a query is.
    #[test]
    fn pixels_agree_with_queries() {
        let air = conservative(3);
        let options = Options {
            visible_ground: VisibleGround::Lit,
            ..Options::default()
        };
        let lanes = Lanes::<4>::new(&air, &[0, 1, 2], options).unwrap();
        let tracer = Tracer::new(&air, options).unwrap();
        let wall = Wall {
            x: 1e9,
            height: 0.0,
            albedo: 0.4,
        };
        for elevation in [-0.4_f64, 0.3] {
            let query = Query {
                altitude: 100.0,
                view_zenith: std::f64::consts::FRAC_PI_2 - elevation,
                view_azimuth: 0.0,
                sun_elevation: 0.5,
                distance: None,
            };
            let expected = tracer.estimate(&query, 300, 5).unwrap();
            let pixel = pixel(&lanes, &wall, elevation, 20_000);
            for w in 0..3 {
                let r = expected.radiance(0.4, w);
                let apart = (pixel.radiance[w] - r.stokes[0]).abs();
                let error = pixel.error[w].hypot(r.error[0]);
                assert!(apart < 4.0 * error, "{elevation} {w}: {apart} {error}");
                assert!(error < 0.03 * r.stokes[0], "{error}");
            }
        }
    }

    /// The shaded side of a wall towards the sun gets skylight only.
    #[test]
    fn solids_shade() {
        let lanes = Lanes::<4>::new(&conservative(3), &[2], Options::default()).unwrap();
        let wall = |x| Wall {
            x,
            height: 20_000.0,
            albedo: 0.5,
        };
        // The sun stands over +x: the wall in front shows its dark side, and its shadow lies on the way to it.
        let shaded = pixel(&lanes, &wall(2000.0), 0.2, 2000).radiance[0];
        let away = Wall {
            x: -2000.0,
            ..wall(0.0)
        };
        let view = View {
            altitude: 100.0,
            sun_elevation: 0.5,
            sun_azimuth: 0.0,
            solids: &away,
        };
        let towards = DVec3::new(-0.98, 0.0, 0.199);
        let lit = lanes.pixel(&view, &|_, _| towards, 2000, Stream::new(1, 2, 3));
        assert!(
            shaded < 0.3 * lit.radiance[0],
            "{shaded} {:?}",
            lit.radiance
        );
    }
}
