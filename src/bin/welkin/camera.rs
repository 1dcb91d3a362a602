//! A perspective camera.

use std::f64::consts::FRAC_PI_2;

use crate::about::About;
use crate::failure::{Failure, Result};

/// Where a picture looks.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Heading {
    /// Azimuth that is looked to, degrees, counter-clockwise from +x: in the middle of the picture, or at the top of
    /// the up fish-eye; 0 if absent.
    #[arg(long, value_name = "DEG")]
    view_azimuth: Option<f64>,
}

impl Heading {
    /// rad, as `absent` is.
    pub fn azimuth(&self, absent: f64) -> Result<f64> {
        let Some(degrees) = self.view_azimuth else {
            return Ok(absent);
        };
        if !degrees.is_finite() {
            let text = format!("view azimuth must be finite, got {degrees}");
            return Err(Failure::message(text));
        }
        Ok(degrees.to_radians())
    }
}

/// Where a perspective camera looks.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Lens {
    /// Angle of the axis above the horizontal in perspective, degrees; 0 if absent.
    #[arg(long, value_name = "DEG")]
    pitch: Option<f64>,
    /// Vertical field of view in perspective, degrees.
    #[arg(long, default_value_t = 40.0, value_name = "DEG")]
    field_of_view: f64,
}

/// Axes of a camera in the world frame, +z up.
pub struct Camera {
    right: [f64; 3],
    above: [f64; 3],
    ahead: [f64; 3],
    /// Width and height of what is seen at distance 1, halved.
    half: [f64; 2],
}

impl Lens {
    /// The same, tilted so far (rad) if nothing is said about it.
    pub fn tilted(&self, pitch: f64) -> Self {
        Self {
            pitch: self.pitch.or(Some(pitch.to_degrees())),
            ..*self
        }
    }

    /// A camera that looks towards `azimuth` (rad); `aspect` is width over height.
    pub fn camera(&self, azimuth: f64, aspect: f64) -> Result<Camera> {
        let (pitch, field) = (self.pitch().to_radians(), self.field_of_view.to_radians());
        if !azimuth.is_finite() || pitch.is_nan() || pitch.abs() > FRAC_PI_2 {
            return Err(Failure::message(
                "the view azimuth must be finite, the pitch within -90..90°",
            ));
        }
        if !(1e-3..=3.1).contains(&field) {
            return Err(Failure::message("the field of view must be in 0.1..=177°"));
        }
        let ((sp, cp), (sa, ca)) = (pitch.sin_cos(), azimuth.sin_cos());
        let half = (0.5 * field).tan();
        Ok(Camera {
            right: [sa, -ca, 0.0],
            above: [-sp * ca, -sp * sa, cp],
            ahead: [cp * ca, cp * sa, sp],
            half: [half * aspect, half],
        })
    }

    /// What a picture says about it.
    pub fn describe(&self, about: &mut About) {
        about.text("projection", "perspective");
        about.number("pitchDeg", self.pitch());
        about.number("fieldOfViewDeg", self.field_of_view);
    }

    /// Vertical field of view, rad.
    pub fn field(&self) -> f64 {
        self.field_of_view.to_radians()
    }

    fn pitch(&self) -> f64 {
        self.pitch.unwrap_or(0.0)
    }
}

impl Camera {
    /// Unit vector at a place in the picture, both coordinates from 0 to 1 to the right and downwards.
    pub fn direction(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let right = (2.0 * u - 1.0) * self.half[0];
        let above = (1.0 - 2.0 * v) * self.half[1];
        let length = (1.0 + right * right + above * above).sqrt();
        std::array::from_fn(|k| {
            (self.ahead[k] + right * self.right[k] + above * self.above[k]) / length
        })
    }

    /// Unit vector towards the top of the picture.
    pub fn up(&self) -> [f32; 3] {
        self.above.map(|v| v as f32)
    }

    /// Cosine of the angle between a unit vector and the axis.
    pub fn depth(&self, direction: [f64; 3]) -> f64 {
        (0..3).map(|k| self.ahead[k] * direction[k]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_looks_ahead_and_the_left_is_left() {
        let lens = Lens {
            pitch: Some(10.0),
            field_of_view: 90.0,
        };
        let camera = lens.camera(FRAC_PI_2, 1.0).unwrap();
        let [x, y, z] = camera.direction([0.5, 0.5]);
        assert!(x.abs() < 1e-9 && y > 0.9 && (z - 10f64.to_radians().sin()).abs() < 1e-9);
        // Facing +y, +x is to the right.
        assert!(camera.direction([1.0, 0.5])[0] > 0.5 && camera.direction([0.5, 0.0])[2] > z);
        assert!(
            Lens {
                pitch: Some(f64::NAN),
                ..lens
            }
            .camera(0.0, 1.0)
            .is_err()
        );
        assert!(
            Lens {
                field_of_view: 0.0,
                ..lens
            }
            .camera(0.0, 1.0)
            .is_err()
        );
    }
}
