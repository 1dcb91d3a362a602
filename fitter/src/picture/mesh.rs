//! Triangles and where rays meet them.

use crate::tracer::solids::{Hit, Reflectance};
use anyhow::{Context, Result, ensure};
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use bvh::ray::Ray;
use glam::DVec3;
use nalgebra::{Point3, Vector3};
use std::path::Path;

/// A two-sided triangle.
#[derive(Clone, Debug)]
pub struct Triangle {
    corners: [Point3<f64>; 3],
    normal: DVec3,
    reflectance: Reflectance,
    node: usize,
}

impl Triangle {
    /// The triangle with these corners; `None` if they lie on one line.
    pub fn new(corners: [DVec3; 3], reflectance: Reflectance) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        Some(Self {
            corners: corners.map(|v| Point3::new(v.x, v.y, v.z)),
            normal,
            reflectance,
            node: 0,
        })
    }

    /// Moved by `to`.
    pub fn map(&self, to: impl Fn(DVec3) -> DVec3) -> Option<Self> {
        let corners = self
            .corners
            .each_ref()
            .map(|p| to(DVec3::new(p.x, p.y, p.z)));
        Self::new(corners, self.reflectance)
    }

    /// Distance to where a ray meets either side.
    fn distance(&self, ray: &Ray<f64, 3>) -> Option<f64> {
        let [a, b, c] = &self.corners;
        let front = ray.intersects_triangle(a, b, c).distance;
        let distance = front.min(ray.intersects_triangle(a, c, b).distance);
        distance.is_finite().then_some(distance)
    }
}

impl Bounded<f64, 3> for Triangle {
    fn aabb(&self) -> Aabb<f64, 3> {
        let [a, b, c] = &self.corners;
        Aabb::empty().grow(a).grow(b).grow(c)
    }
}

impl BHShape<f64, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// Triangles that rays find quickly.
pub struct Mesh {
    triangles: Vec<Triangle>,
    tree: Option<Bvh<f64, 3>>,
}

impl Mesh {
    /// Sorts the triangles.
    pub fn new(mut triangles: Vec<Triangle>) -> Self {
        let tree = (!triangles.is_empty()).then(|| Bvh::build(&mut triangles));
        Self { triangles, tree }
    }

    /// The first triangle that a ray meets before `limit`.
    pub fn hit(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<Hit> {
        let ray = ray(origin, direction);
        let met = self.tree.as_ref()?.traverse_iterator(&ray, &self.triangles);
        let nearest = met
            .filter_map(|triangle| Some((triangle.distance(&ray)?, triangle)))
            .filter(|(distance, _)| *distance < limit)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(distance, triangle)| Hit {
            distance,
            normal: triangle.normal * -triangle.normal.dot(direction).signum(),
            reflectance: triangle.reflectance,
        })
    }

    /// Whether a ray meets any.
    pub fn blocks(&self, origin: DVec3, direction: DVec3) -> bool {
        let ray = ray(origin, direction);
        let tree = self.tree.as_ref();
        tree.is_some_and(|tree| {
            tree.traverse_iterator(&ray, &self.triangles)
                .any(|triangle| triangle.distance(&ray).is_some())
        })
    }
}

fn ray(origin: DVec3, direction: DVec3) -> Ray<f64, 3> {
    let [o, d] = [origin, direction];
    Ray::new(Point3::new(o.x, o.y, o.z), Vector3::new(d.x, d.y, d.z))
}

/// The triangles of a Wavefront OBJ file in its own coordinates; faces without a material get `reflectance`.
pub fn load_obj(path: &Path, reflectance: Reflectance) -> Result<Vec<Triangle>> {
    let name = path.display().to_string();
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..tobj::LoadOptions::default()
    };
    let (models, materials) = tobj::load_obj(path, &options).with_context(|| name.clone())?;
    let materials = materials.unwrap_or_default();
    let mut triangles = vec![];
    for model in &models {
        let mesh = &model.mesh;
        let (corners, _) = mesh.positions.as_chunks::<3>();
        ensure!(
            corners.iter().flatten().all(|v| v.is_finite()),
            "{name}, object {}: a vertex is not finite",
            model.name
        );
        let colour = mesh.material_id.and_then(|id| materials.get(id)?.diffuse);
        let colour = colour.map_or(reflectance, |rgb| {
            Reflectance(rgb.map(|v| v.clamp(0.0, 1.0)))
        });
        for face in mesh.indices.as_chunks::<3>().0 {
            let mut triangle = [DVec3::ZERO; 3];
            for (corner, index) in triangle.iter_mut().zip(face) {
                let at = corners.get(*index as usize);
                *corner = DVec3::from(*at.with_context(|| {
                    format!("{name}, object {}: there is no vertex {index}", model.name)
                })?);
            }
            triangles.extend(Triangle::new(triangle, colour));
        }
    }
    ensure!(!triangles.is_empty(), "{name} has no faces");
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64) -> Vec<Triangle> {
        let [a, b, c, d] =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(y, z)| DVec3::new(x, y, z));
        [[a, b, c], [a, c, d]]
            .into_iter()
            .filter_map(|corners| Triangle::new(corners, Reflectance::grey(x)))
            .collect()
    }

    #[test]
    fn the_nearest_side_is_met() {
        let mesh = Mesh::new([0.2, 0.5, 0.9].into_iter().flat_map(square).collect());
        let at =
            |x: f64, direction: DVec3, limit| mesh.hit(DVec3::new(x, 0.3, 0.6), direction, limit);
        let hit = at(0.4, DVec3::X, 9.0).unwrap();
        assert!((hit.distance - 0.1).abs() < 1e-12 && hit.normal == -DVec3::X);
        assert_eq!(hit.reflectance, Reflectance::grey(0.5));
        let back = at(0.4, -DVec3::X, 9.0).unwrap();
        assert!((back.distance - 0.2).abs() < 1e-12 && back.normal == DVec3::X);
        assert!(at(0.4, DVec3::X, 0.05).is_none());
        assert!(mesh.blocks(DVec3::new(-1.0, 0.5, 0.2), DVec3::X));
        assert!(!mesh.blocks(DVec3::new(-1.0, 1.5, 0.2), DVec3::X));
        assert!(Mesh::new(vec![]).hit(DVec3::ZERO, DVec3::X, 1.0).is_none());
    }

    #[test]
    fn objects_are_read_with_their_colours() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.obj");
        let write = |text: &str| std::fs::write(&path, text).unwrap();
        std::fs::write(folder.path().join("a.mtl"), "newmtl red\nKd 0.8 0.1 0.1\n").unwrap();
        write("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\n");
        let triangles = load_obj(&path, Reflectance::grey(0.5)).unwrap();
        assert_eq!(triangles.len(), 2);
        assert_eq!(triangles[0].reflectance, Reflectance([0.8, 0.1, 0.1]));
        for (text, what) in [
            ("v 0 0 0\n", "no faces"),
            ("v 0 0 0\nf 1 2 3\n", "a.obj"),
            ("v x\n", "a.obj"),
        ] {
            write(text);
            let message = format!("{:#}", load_obj(&path, Reflectance::grey(0.5)).unwrap_err());
            assert!(message.contains(what), "{message}");
        }
    }
}
