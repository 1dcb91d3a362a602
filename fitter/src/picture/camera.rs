//! From pixels to directions.

use anyhow::{Result, ensure};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// How directions are laid onto the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A flat picture with the given vertical field of view, radians.
    Perspective(f64),
    /// Equidistant fish-eye of the hemisphere around the middle.
    FishEye,
    /// Whole sphere, zenith in the top row, straight ahead in the middle.
    LatLong,
}

/// A camera that looks ahead (+x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Its projection.
    pub projection: Projection,
    /// Angle of its axis above the horizontal plane, radians. Whole spheres have none.
    pub pitch: f64,
    /// Width and height in pixels.
    pub size: [usize; 2],
}

impl Camera {
    /// Says which field is wrong.
    pub fn check(&self) -> Result<()> {
        let [width, height] = self.size;
        ensure!(
            (1..=16_384).contains(&width) && (1..=16_384).contains(&height),
            "size {width} x {height:?} is outside 1..16384"
        );
        ensure!(
            self.pitch.abs() <= FRAC_PI_2 + 1e-12,
            "pitch {:?} is outside -90..90 degrees",
            self.pitch.to_degrees()
        );
        if let Projection::Perspective(view) = self.projection {
            ensure!(
                (1e-3..=0.99 * PI).contains(&view),
                "field of view {:?} is outside 0.1..178 degrees",
                view.to_degrees()
            );
        }
        Ok(())
    }

    /// Whether anything is to be seen in a pixel: the corners of a fish-eye are empty.
    pub fn sees(&self, pixel: [usize; 2]) -> bool {
        let [x, y] = self.position(pixel, [0.5; 2]);
        self.projection != Projection::FishEye || x.hypot(y) < 1.0
    }

    /// Direction at a place in a pixel, both from 0 to 1 to the right and downwards.
    pub fn direction(&self, pixel: [usize; 2], within: [f64; 2]) -> DVec3 {
        let [right, above] = self.position(pixel, within);
        match self.projection {
            Projection::Perspective(view) => {
                let scale = (0.5 * view).tan();
                self.turn(DVec3::new(scale * right, scale * above, 1.0))
            }
            Projection::FishEye => {
                let radius = right.hypot(above);
                let (sine, ahead) = (radius * FRAC_PI_2).sin_cos();
                let scale = sine / radius.max(1e-12);
                self.turn(DVec3::new(scale * right, scale * above, ahead))
            }
            Projection::LatLong => {
                let (z, horizontal) = (above * FRAC_PI_2).sin_cos();
                let (y, x) = (-right * PI).sin_cos();
                DVec3::new(horizontal * x, horizontal * y, z)
            }
        }
    }

    /// To the right and upwards: −1..1 over the height; over the width, too, in whole spheres.
    fn position(&self, pixel: [usize; 2], within: [f64; 2]) -> [f64; 2] {
        let [width, height] = self.size.map(|n| n as f64);
        let right = (pixel[0] as f64 + within[0]) / width * 2.0 - 1.0;
        let above = 1.0 - (pixel[1] as f64 + within[1]) / height * 2.0;
        match self.projection {
            Projection::Perspective(_) => [right * width / height, above],
            Projection::FishEye => {
                let least = width.min(height);
                [right * width / least, above * height / least]
            }
            Projection::LatLong => [right, above],
        }
    }

    /// From components to the right, upwards and along the axis.
    fn turn(&self, v: DVec3) -> DVec3 {
        let (sin, cos) = self.pitch.sin_cos();
        DVec3::new(cos * v.z - sin * v.y, -v.x, sin * v.z + cos * v.y).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(projection: Projection, pitch: f64) -> Camera {
        Camera {
            projection,
            pitch,
            size: [200, 100],
        }
    }

    #[test]
    fn middles_and_edges_look_where_they_should() {
        let at = |camera: Camera, x, y| camera.direction([x, y], [0.0; 2]);
        let close = |a: DVec3, b: [f64; 3]| assert!((a - DVec3::from(b)).length() < 1e-9, "{a}");
        let half = 0.5_f64.sqrt();
        let flat = camera(Projection::Perspective(FRAC_PI_2), 0.0);
        close(at(flat, 100, 50), [1.0, 0.0, 0.0]);
        close(at(flat, 150, 50), [half, -half, 0.0]);
        close(at(flat, 100, 0), [half, 0.0, half]);
        let up = camera(Projection::FishEye, FRAC_PI_2);
        close(at(up, 100, 50), [0.0, 0.0, 1.0]);
        close(at(up, 100, 100), [1.0, 0.0, 0.0]);
        close(at(up, 50, 50), [0.0, 1.0, 0.0]);
        let all = camera(Projection::LatLong, 0.3);
        close(at(all, 100, 50), [1.0, 0.0, 0.0]);
        close(at(all, 50, 50), [0.0, 1.0, 0.0]);
        close(at(all, 100, 0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn fish_eyes_have_empty_corners() {
        let camera = camera(Projection::FishEye, 0.0);
        assert!(!camera.sees([0, 0]) && !camera.sees([199, 50]) && camera.sees([100, 50]));
    }

    #[test]
    fn impossible_cameras_are_refused() {
        assert!(camera(Projection::LatLong, f64::NAN).check().is_err());
        assert!(camera(Projection::Perspective(4.0), 0.0).check().is_err());
        let empty = Camera {
            size: [0, 5],
            ..camera(Projection::LatLong, 0.0)
        };
        assert!(empty.check().is_err());
    }
}
