//! What stands where.

use super::ground::Ground;
use super::mesh::{Mesh, Triangle};
use crate::tracer::solids::{Hit, Reflectance, Solids};
use anyhow::{Result, ensure};
use glam::DVec3;

/// How far towers and meshes may stand from the camera, m.
const FARTHEST: f64 = 1_000_000.0;

/// A place on the ground: distances along it ahead of the camera and to its left, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Ahead.
    pub ahead: f64,
    /// To the left.
    pub left: f64,
}

/// A box on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tower {
    /// Its middle.
    pub place: Place,
    /// Length of its sides, m.
    pub width: f64,
    /// Its height, m.
    pub height: f64,
}

/// Ground and solids.
pub struct Scene {
    radius: f64,
    ground: Ground,
    mesh: Mesh,
}

/// Gathers what stands on a planet of the given radius (m).
pub struct Builder {
    radius: f64,
    triangles: Vec<Triangle>,
}

impl Place {
    fn check(&self) -> Result<()> {
        for (name, value) in [("ahead", self.ahead), ("left", self.left)] {
            ensure!(
                value.abs() <= FARTHEST,
                "distance {name} {:?} km is outside -1000..1000",
                value / 1000.0
            );
        }
        Ok(())
    }

    /// Takes local coordinates (ahead, left, up) at this place to those of the camera's vertical.
    fn frame(&self, radius: f64) -> impl Fn(DVec3) -> DVec3 + use<> {
        let distance = self.ahead.hypot(self.left);
        let (sin, cos) = (distance / radius).sin_cos();
        let level = DVec3::new(self.ahead, self.left, 0.0) / distance.max(1e-9);
        let up = sin * level + cos * DVec3::Z;
        let ahead = (DVec3::X - up * up.x).normalize();
        let left = up.cross(ahead);
        // 1 − cos without its rounding error.
        let drop = 2.0 * (0.5 * distance / radius).sin().powi(2);
        let base = radius * (sin * level - drop * DVec3::Z);
        move |v| base + v.x * ahead + v.y * left + v.z * up
    }
}

impl Builder {
    /// Nothing, so far.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            triangles: vec![],
        }
    }

    /// Adds a tower.
    pub fn tower(&mut self, tower: &Tower, reflectance: Reflectance) -> Result<()> {
        tower.place.check()?;
        for (name, value) in [("width", tower.width), ("height", tower.height)] {
            ensure!(
                (1.0..=100_000.0).contains(&value),
                "tower {name} {:?} km is outside 0.001..100",
                value / 1000.0
            );
        }
        let to = tower.place.frame(self.radius);
        let half = 0.5 * tower.width;
        // The ground falls away from the middle.
        let bottom = -1.0 - half * half / self.radius;
        let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let at = |i: usize, z: f64| to(DVec3::new(half * ring[i % 4].0, half * ring[i % 4].1, z));
        let top = |i: usize| at(i, tower.height);
        let mut faces = vec![[top(0), top(1), top(2)], [top(0), top(2), top(3)]];
        for i in 0..4 {
            faces.push([at(i, bottom), at(i + 1, bottom), top(i + 1)]);
            faces.push([at(i, bottom), top(i + 1), top(i)]);
        }
        let new = |corners| Triangle::new(corners, reflectance);
        self.triangles.extend(faces.into_iter().filter_map(new));
        Ok(())
    }

    /// Adds a mesh whose y axis points up, in units of `scale` metres.
    pub fn mesh(&mut self, mesh: &[Triangle], place: Place, scale: f64) -> Result<()> {
        place.check()?;
        ensure!(
            scale.is_finite() && scale > 0.0,
            "mesh scale {scale} is not positive"
        );
        let to = place.frame(self.radius);
        let turned = |v: DVec3| to(scale * DVec3::new(-v.z, -v.x, v.y));
        let moved = mesh.iter().filter_map(|triangle| triangle.map(turned));
        self.triangles.extend(moved);
        Ok(())
    }

    /// The scene, on the given ground.
    pub fn build(self, ground: Ground) -> Result<Scene> {
        ensure!(
            (0.0..=1.0).contains(&ground.albedo),
            "ground albedo {:?} is outside 0..1",
            ground.albedo
        );
        ensure!(
            ground.cell.is_finite() && ground.cell >= 1.0,
            "ground cell {} km is less than 0.001",
            ground.cell / 1000.0
        );
        Ok(Scene {
            radius: self.radius,
            ground,
            mesh: Mesh::new(self.triangles),
        })
    }
}

impl Scene {
    fn local(&self, point: DVec3) -> DVec3 {
        DVec3::new(point.x, point.y, point.z - self.radius)
    }
}

impl Solids for Scene {
    fn hit(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<Hit> {
        self.mesh.hit(self.local(origin), direction, limit)
    }

    fn blocks(&self, origin: DVec3, direction: DVec3) -> bool {
        self.mesh.blocks(self.local(origin), direction)
    }

    fn ground(&self, point: DVec3) -> Reflectance {
        self.ground.at(point)
    }
}

#[cfg(test)]
mod tests {
    use super::super::ground::Pattern;
    use super::*;

    const RADIUS: f64 = 6_378_000.0;

    fn ground(albedo: f64) -> Ground {
        Ground {
            pattern: Pattern::Plain,
            albedo,
            cell: 1000.0,
        }
    }

    fn tower(ahead: f64, left: f64, height: f64) -> Tower {
        Tower {
            place: Place { ahead, left },
            width: 2000.0,
            height,
        }
    }

    #[test]
    fn towers_stand_on_the_curved_ground() {
        for (ahead, left) in [(0.0, 0.0), (50_000.0, 0.0), (-30_000.0, 90_000.0)] {
            let mut builder = Builder::new(RADIUS);
            let it = tower(ahead, left, 5000.0);
            builder.tower(&it, Reflectance::grey(0.5)).unwrap();
            let scene = builder.build(ground(0.3)).unwrap();
            let distance = f64::hypot(ahead, left);
            let (sin, cos) = (distance / RADIUS).sin_cos();
            let level = DVec3::new(ahead, left, 0.0) / distance.max(1e-9);
            let up = sin * level + cos * DVec3::Z;
            // Slightly aside: the diagonal of the roof lies in its middle.
            let start = up * (RADIUS + 9000.0) + up.any_orthonormal_vector() * 10.0;
            let hit = scene.hit(start, -up, 1e9).unwrap();
            assert!((hit.distance - 4000.0).abs() < 1e-3, "{}", hit.distance);
            assert!(hit.normal.dot(up) > 0.999_999);
            assert!(scene.blocks(start, -up) && !scene.blocks(start, up));
        }
    }

    #[test]
    fn meshes_stand_upright_ahead() {
        let corners = [DVec3::ZERO, DVec3::Y, DVec3::X];
        let mesh: Vec<_> = Triangle::new(corners, Reflectance::grey(0.5))
            .into_iter()
            .collect();
        let mut builder = Builder::new(RADIUS);
        let place = Place {
            ahead: 1000.0,
            left: 0.0,
        };
        builder.mesh(&mesh, place, 100.0).unwrap();
        let scene = builder.build(ground(0.3)).unwrap();
        let origin = DVec3::new(0.0, -10.0, RADIUS + 10.0);
        let hit = scene.hit(origin, DVec3::X, 1e9).unwrap();
        assert!((hit.distance - 1000.0).abs() < 0.1);
    }

    #[test]
    fn impossible_scenes_are_refused() {
        let mut builder = Builder::new(RADIUS);
        let grey = Reflectance::grey(0.5);
        assert!(builder.tower(&tower(0.0, f64::NAN, 10.0), grey).is_err());
        assert!(builder.tower(&tower(0.0, 0.0, -10.0), grey).is_err());
        let here = tower(0.0, 0.0, 1.0).place;
        assert!(builder.mesh(&[], here, 0.0).is_err());
        assert!(Builder::new(RADIUS).build(ground(1.5)).is_err());
    }
}
