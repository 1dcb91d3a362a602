//! From pixels to directions.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::octahedral;

/// How the sphere of directions is laid onto the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Projection {
    /// Equidistant fish-eye that looks at the zenith; the view azimuth is at the top.
    Up,
    /// Equidistant fish-eye that looks at the horizon in the view azimuth.
    Side,
    /// Whole sphere, zenith in the top row, the view azimuth in the middle column.
    LatLong,
    /// Faces of a cube one below the other: +X, −X, +Y, −Y, +Z, −Z, of a left-handed frame with +Z in the view azimuth
    /// and +Y at the zenith.
    Cube,
    /// Whole sphere on a square by equal areas, for pbrt: zenith in the middle, the view azimuth at the right edge,
    /// azimuth 90° from it at the bottom edge.
    Octahedral,
}

impl Projection {
    /// As `--projection` has it.
    pub fn name(self) -> &'static str {
        match self {
            Projection::Up => "up",
            Projection::Side => "side",
            Projection::LatLong => "lat-long",
            Projection::Cube => "cube",
            Projection::Octahedral => "octahedral",
        }
    }

    /// Width and height in pixels of a picture, or of all faces of one, of the given height.
    pub fn dimensions(self, height: usize) -> [usize; 2] {
        match self {
            Projection::LatLong => [2 * height, height],
            Projection::Cube => [height, 6 * height],
            _ => [height, height],
        }
    }

    /// Unit vector at a place in the picture, in pixels from its upper left corner, in a frame with +x in the view
    /// azimuth; `None` outside the fish-eye.
    fn local(self, [column, row]: [f64; 2], [width, height]: [usize; 2]) -> Option<[f64; 3]> {
        let right = column / width as f64 * 2.0 - 1.0;
        let above = 1.0 - row / height as f64 * 2.0;
        match self {
            // Seen from below, the left hand of someone who faces the top edge is at the right edge.
            Projection::Up => fish_eye(right, above).map(|[a, b, c]| [b, a, c]),
            Projection::Side => fish_eye(right, above).map(|[a, b, c]| [c, -a, b]),
            Projection::LatLong => {
                let (z, horizontal) = (above * FRAC_PI_2).sin_cos();
                let (y, x) = (-right * PI).sin_cos();
                Some([horizontal * x, horizontal * y, z])
            }
            Projection::Cube => Some(cube([column, row], width)),
            Projection::Octahedral => Some(octahedral::direction([right, -above])),
        }
    }

    /// Up vector of the camera.
    pub fn up(self, azimuth: f64) -> [f32; 3] {
        match self {
            Projection::Up => [azimuth.cos() as f32, azimuth.sin() as f32, 0.0],
            _ => [0.0, 0.0, 1.0],
        }
    }

    /// Direction at a place in the picture, in pixels from its upper left corner; `azimuth` (rad) is the view azimuth.
    pub fn look(self, place: [f64; 2], size: [usize; 2], azimuth: f64) -> Option<[f64; 3]> {
        let [x, y, z] = self.local(place, size)?;
        let (sine, cosine) = (azimuth % TAU).sin_cos();
        Some([cosine * x - sine * y, sine * x + cosine * y, z])
    }

    /// Direction at the centre of a pixel.
    pub fn direction(self, pixel: [usize; 2], size: [usize; 2], azimuth: f64) -> Option<[f32; 3]> {
        let place = pixel.map(|p| p as f64 + 0.5);
        Some(self.look(place, size, azimuth)?.map(|v| v as f32))
    }
}

/// A place on a cube with edges of so many pixels.
fn cube([column, row]: [f64; 2], size: usize) -> [f64; 3] {
    let face = ((row / size as f64) as usize).min(5);
    let place = |pixels: f64| pixels / size as f64 * 2.0 - 1.0;
    let (s, t) = (place(column), place(row - (face * size) as f64));
    // The table of the OpenGL specification, 8.13.
    let [right, up, forward] = match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    };
    let shrink = 1.0 / (1.0 + s * s + t * t).sqrt();
    [forward * shrink, -right * shrink, up * shrink]
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

    /// Every pixel of a small lat-long picture.
    fn lat_long(azimuth: f64) -> impl Iterator<Item = ([f64; 2], [f64; 3])> {
        let size = [36, 18];
        let pixels =
            (0..size[0]).flat_map(move |column| (0..size[1]).map(move |row| [column, row]));
        pixels.map(move |pixel| {
            let direction = Projection::LatLong.direction(pixel, size, azimuth).unwrap();
            let place = std::array::from_fn(|i| (pixel[i] as f64 + 0.5) / size[i] as f64);
            (place, direction.map(f64::from))
        })
    }

    /// Where renderers look up a direction, from the left and from the top, against where this program puts it.
    fn assert_looked_up(look_up: impl Fn([f64; 3]) -> [f64; 2]) {
        for (place, direction) in lat_long(0.0) {
            let [u, v] = look_up(direction);
            let across = (u - place[0]).rem_euclid(1.0);
            assert!(
                across.min(1.0 - across) < 1e-6,
                "{direction:?} {u} {place:?}"
            );
            assert!((v - place[1]).abs() < 1e-6, "{direction:?} {v} {place:?}");
        }
    }

    #[test]
    fn blender_needs_no_rotation() {
        // `direction_to_equirectangular` of Cycles, whose v counts from below.
        assert_looked_up(|[x, y, z]| {
            let u = -y.atan2(x) / TAU + 0.5;
            let v = z.acos() / -PI + 1.0;
            [u, 1.0 - v]
        });
    }

    #[test]
    fn mitsuba_turns_by_a_quarter_about_x_and_then_about_z() {
        // `to_world` = rotate(z, 90°) · rotate(x, 90°), undone from left to right; then the look-up of `envmap`.
        assert_looked_up(|[x, y, z]| {
            let [x, y, z] = [y, -x, z];
            let [x, y, z] = [x, z, -y];
            [x.atan2(-z) / TAU, y.acos() / PI]
        });
    }

    #[test]
    fn lat_long_is_as_documented() {
        let azimuth = 0.7;
        for ([column, row], [x, y, z]) in lat_long(azimuth) {
            let u = (0.5 - (y.atan2(x) - azimuth) / TAU).rem_euclid(1.0);
            assert!((u - column).abs() < 1e-6 && (z.acos() / PI - row).abs() < 1e-6);
        }
    }

    #[test]
    fn cube_faces_look_where_they_should() {
        // Odd, so that faces have a middle.
        let n = 101;
        let size = Projection::Cube.dimensions(n);
        assert_eq!(size, [n, 6 * n]);
        let at = |face: usize, column: usize, row: usize| {
            let pixel = [column, face * n + row];
            Projection::Cube.direction(pixel, size, 0.0).unwrap()
        };
        let (middle, last) = (n / 2, n - 1);
        let forward = [1.0, 0.0, 0.0];
        let [left, up] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let minus = |v: [f32; 3]| v.map(|v| -v);
        // Middle, then what is at the right and at the top of each face.
        let faces = [
            [minus(left), minus(forward), up],
            [left, forward, up],
            [up, minus(left), minus(forward)],
            [minus(up), minus(left), forward],
            [forward, minus(left), up],
            [minus(forward), left, up],
        ];
        let dot = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f32>();
        for (face, [centre, right, top]) in faces.into_iter().enumerate() {
            assert!(dot(at(face, middle, middle), centre) > 0.999_99, "{face}");
            for (pixel, towards) in [(at(face, last, middle), right), (at(face, middle, 0), top)] {
                assert!((dot(pixel, centre) - 0.71).abs() < 0.01, "{face} {pixel:?}");
                assert!((dot(pixel, towards) - 0.7).abs() < 0.01, "{face} {pixel:?}");
            }
        }
        // Every pixel looks through the cell of the sphere that is its own: solid angles add up to all of it.
        let mut sum = 0.0;
        for row in 0..size[1] {
            for column in 0..n {
                let d = Projection::Cube
                    .direction([column, row], size, 0.4)
                    .unwrap();
                let longest = Projection::Cube
                    .local([column as f64 + 0.5, row as f64 + 0.5], size)
                    .unwrap();
                let longest = longest.into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                sum += longest.powi(3) * (2.0 / n as f64).powi(2);
                assert!((dot(d, d) - 1.0).abs() < 1e-5);
            }
        }
        assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-3, "{sum}");
    }
}
