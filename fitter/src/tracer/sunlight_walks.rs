//! What walks bring home: sunlight at sampled points, at collisions and on the ground.

use super::medium::Columns;
use super::shell_crossings::Line;
use super::tally::Tally;
use super::walk::{Path, Walker};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

impl<const N: usize> Walker<'_, N> {
    /// Sunlight scattered towards the walk from one sampled point of its flight.
    pub(super) fn gather_along(
        &mut self,
        path: &Path<N>,
        line: &Line,
        end: f64,
        u: f64,
        tally: &mut Tally<N>,
    ) {
        self.segment.build(&self.scene, line, end);
        let Some((t, density)) = self.segment.sample(u) else {
            return;
        };
        let medium = self.medium();
        let Some(light) = self.sunlight(line.at(t)) else {
            return;
        };
        let altitude = (line.radius(line.start + t) - medium.radius).max(0.0);
        let through = medium.transmittance(&medium.columns(line, 0.0, t));
        let common = self.normaliser(path) / (4.0 * PI * density);
        let factor = std::array::from_fn(|w| through[w] * light[w] * common);
        let stokes = self.sunlight_towards(path, &medium.profile(altitude));
        tally.add(path.bounces, &stokes, &factor);
    }

    /// Sunlight scattered at a collision.
    pub(super) fn gather_at(&self, path: &Path<N>, profile: &Columns, tally: &mut Tally<N>) {
        if let Some(light) = self.sunlight(path.point) {
            let common = self.normaliser(path) / (4.0 * PI);
            let factor = light.map(|l| l * common);
            tally.add(path.bounces, &self.sunlight_towards(path, profile), &factor);
        }
    }

    fn sunlight_towards(&self, path: &Path<N>, profile: &Columns) -> [[f64; N]; 3] {
        let cosine = path.frame.w.dot(self.scene.sun).clamp(-1.0, 1.0);
        let f = self.scattering_at(profile, cosine);
        path.m.natural(path.frame.angle_to(self.scene.sun), &f)
    }

    /// Transmittance from `point` to the sun; `None` in the shadow of the planet or of solids.
    fn sunlight(&self, point: DVec3) -> Option<[f64; N]> {
        let sun = self.scene.sun;
        let light = self.medium().sunlight(point, sun)?;
        let shaded = self.solids.is_some_and(|solids| solids.blocks(point, sun));
        (!shaded).then_some(light)
    }

    /// Sunlight on a surface with the given normal.
    pub(super) fn gather_surface(&self, path: &Path<N>, normal: DVec3, tally: &mut Tally<N>) {
        let cosine = normal.dot(self.scene.sun);
        if cosine <= 0.0 {
            return;
        }
        if let Some(light) = self.sunlight(path.point) {
            let common = self.normaliser(path) * cosine * FRAC_1_PI;
            let stokes = path.m.0.map(|row| row[0]);
            tally.add(path.bounces, &stokes, &light.map(|l| l * common));
        }
    }

    pub(super) fn gather_escape(&self, path: &Path<N>, tally: &mut Tally<N>) {
        let stokes = path.m.0.map(|row| row[0]);
        tally.add(path.bounces, &stokes, &[self.normaliser(path); N]);
    }
}
