//! From pixels to directions.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// How the sphere of directions is laid onto the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Projection {
    /// Equidistant fish-eye that looks at the zenith; the view azimuth is at the top.
    Up,
    /// Equidistant fish-eye that looks at the horizon in the view azimuth.
    Side,
    /// Whole sphere, zenith in the top row, the view azimuth in the middle column.
    LatLong,
}

impl Projection {
    /// Width and height in pixels of a picture of the given height.
    pub fn dimensions(self, height: usize) -> [usize; 2] {
        match self {
            Projection::LatLong => [2 * height, height],
            _ => [height, height],
        }
    }

    /// Unit vector at the centre of a pixel, in a frame with +x in the view azimuth; `None` outside the fish-eye.
    fn local(self, [column, row]: [usize; 2], [width, height]: [usize; 2]) -> Option<[f64; 3]> {
        let right = (column as f64 + 0.5) / width as f64 * 2.0 - 1.0;
        let above = 1.0 - (row as f64 + 0.5) / height as f64 * 2.0;
        match self {
            // Seen from below, the left hand of someone who faces the top edge is at the right edge.
            Projection::Up => fish_eye(right, above).map(|[a, b, c]| [b, a, c]),
            Projection::Side => fish_eye(right, above).map(|[a, b, c]| [c, -a, b]),
            Projection::LatLong => {
                let (z, horizontal) = (above * FRAC_PI_2).sin_cos();
                let (y, x) = (-right * PI).sin_cos();
                Some([horizontal * x, horizontal * y, z])
            }
        }
    }

    /// Up vector of the camera.
    pub fn up(self, azimuth: f64) -> [f32; 3] {
        match self {
            Projection::Up => [azimuth.cos() as f32, azimuth.sin() as f32, 0.0],
            _ => [0.0, 0.0, 1.0],
        }
    }

    /// Direction of a pixel; `azimuth` (rad) is the view azimuth.
    pub fn direction(self, pixel: [usize; 2], size: [usize; 2], azimuth: f64) -> Option<[f32; 3]> {
        let [x, y, z] = self.local(pixel, size)?;
        let (sine, cosine) = (azimuth % TAU).sin_cos();
        Some([cosine * x - sine * y, sine * x + cosine * y, z].map(|v| v as f32))
    }
}

/// Components to the right, upwards and forwards of a hemisphere, equidistant.
fn fish_eye(right: f64, above: f64) -> Option<[f64; 3]> {
    let radius = right.hypot(above);
    if radius >= 1.0 {
        return None;
    }
    let (sine, forward) = (radius * FRAC_PI_2).sin_cos();
    let scale = if radius > 0.0 { sine / radius } else { 0.0 };
    Some([right * scale, above * scale, forward])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middles_and_edges_look_where_they_should() {
        let close = |a: Option<[f32; 3]>, b: [f32; 3]| {
            let a = a.unwrap();
            assert!((0..3).all(|i| (a[i] - b[i]).abs() < 0.01), "{a:?} {b:?}");
        };
        let size = [1001, 1001];
        close(
            Projection::Up.direction([500, 500], size, 0.0),
            [0.0, 0.0, 1.0],
        );
        close(
            Projection::Up.direction([500, 0], size, 0.0),
            [1.0, 0.0, 0.0],
        );
        close(
            Projection::Up.direction([1000, 500], size, 0.0),
            [0.0, 1.0, 0.0],
        );
        close(
            Projection::Side.direction([500, 500], size, 0.0),
            [1.0, 0.0, 0.0],
        );
        close(
            Projection::Side.direction([0, 500], size, 0.0),
            [0.0, 1.0, 0.0],
        );
        close(
            Projection::Side.direction([500, 0], size, 0.0),
            [0.0, 0.0, 1.0],
        );
        close(
            Projection::Side.direction([500, 500], size, FRAC_PI_2),
            [0.0, 1.0, 0.0],
        );
        let size = [2002, 1001];
        close(
            Projection::LatLong.direction([1001, 500], size, 0.0),
            [1.0, 0.0, 0.0],
        );
        close(
            Projection::LatLong.direction([500, 500], size, 0.0),
            [0.0, 1.0, 0.0],
        );
        assert!(Projection::Up.direction([0, 0], [9, 9], 0.0).is_none());
    }
}
