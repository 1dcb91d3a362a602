//! The sphere on a square by equal areas: the octahedral map of Clarberg, *Fast Equal-Area Mapping of the
//! (Hemi)Sphere using SIMD*, 2008.
//!
//! The inner diamond, of half the area, is the upper hemisphere: circles of equal height are diamonds around its middle,
//! so that 1 − z, which is as the area of a cap, goes with the square of their size. The four corners are the lower
//! hemisphere, folded out.

use std::f64::consts::FRAC_PI_4;

/// Unit vector at a place of the square, both coordinates from −1 to 1; +z is in the middle, −z in the corners.
pub fn direction([u, v]: [f64; 2]) -> [f64; 3] {
    let sum = u.abs() + v.abs();
    // Size of the diamond around the nearer pole.
    let (size, sign) = match sum <= 1.0 {
        true => (sum, 1.0),
        false => (2.0 - sum, -1.0),
    };
    if size <= 0.0 {
        return [0.0, 0.0, sign];
    }
    // Along an edge of the diamond from the first axis to the second.
    let azimuth = FRAC_PI_4 * (1.0 + (v.abs() - u.abs()) / size);
    let (sine, cosine) = azimuth.sin_cos();
    // √(1 − z²) with z = 1 − size².
    let level = size * (2.0 - size * size).sqrt();
    [
        (level * cosine).copysign(u),
        (level * sine).copysign(v),
        sign * (1.0 - size * size),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_2_PI, PI};

    /// The other way, as renderers look up a direction.
    fn place([x, y, z]: [f64; 3]) -> [f64; 2] {
        let size = (1.0 - z.abs()).max(0.0).sqrt();
        let share = y.abs().atan2(x.abs()) * FRAC_2_PI;
        let [u, v] = [size * (1.0 - share), size * share];
        let [u, v] = match z < 0.0 {
            true => [1.0 - v, 1.0 - u],
            false => [u, v],
        };
        [u.copysign(x), v.copysign(y)]
    }

    #[test]
    fn places_come_back() {
        const N: usize = 33;
        let along = |k: usize| (2 * k + 1) as f64 / N as f64 - 1.0;
        for k in 0..N * N {
            let at = [along(k % N), along(k / N)];
            let d = direction(at);
            let length: f64 = d.iter().map(|v| v * v).sum();
            assert!((length - 1.0).abs() < 1e-14, "{at:?} {d:?}");
            let back = place(d);
            let off = (0..2).map(|i| (back[i] - at[i]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-7, "{at:?} {back:?}");
        }
    }

    #[test]
    fn the_poles_and_the_axes_are_where_they_should_be() {
        for (at, expected) in [
            ([0.0, 0.0], [0.0, 0.0, 1.0]),
            ([1.0, 0.0], [1.0, 0.0, 0.0]),
            ([0.0, 1.0], [0.0, 1.0, 0.0]),
            ([-1.0, 0.0], [-1.0, 0.0, 0.0]),
            ([0.0, -1.0], [0.0, -1.0, 0.0]),
            ([1.0, -1.0], [0.0, 0.0, -1.0]),
        ] {
            let d = direction(at);
            assert!((0..3).all(|i| (d[i] - expected[i]).abs() < 1e-15), "{d:?}");
        }
    }

    /// Solid angle of a spherical triangle: Van Oosterom and Strackee 1983.
    fn triangle(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
        let dot = |p: [f64; 3], q: [f64; 3]| (0..3).map(|i| p[i] * q[i]).sum::<f64>();
        let cross: [f64; 3] = std::array::from_fn(|i| {
            b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]
        });
        2.0 * dot(a, cross)
            .abs()
            .atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a))
    }

    #[test]
    fn all_pixels_have_the_same_solid_angle() {
        const N: usize = 8;
        const PARTS: usize = 64;
        let corner = |column: usize, row: usize| {
            let at = [column, row].map(|k| 2.0 * k as f64 / (N * PARTS) as f64 - 1.0);
            direction(at)
        };
        let part = |column: usize, row: usize| {
            let [a, b, c, d] = [[0, 0], [1, 0], [1, 1], [0, 1]]
                .map(|[right, down]| corner(column + right, row + down));
            triangle(a, b, c) + triangle(a, c, d)
        };
        let expected = 4.0 * PI / (N * N) as f64;
        for pixel in 0..N * N {
            let [column, row] = [pixel % N, pixel / N].map(|k| k * PARTS);
            let parts = (0..PARTS * PARTS).map(|k| part(column + k % PARTS, row + k / PARTS));
            let sum: f64 = parts.sum();
            assert!(
                (sum / expected - 1.0).abs() < 1e-4,
                "{pixel}: {sum} {expected}"
            );
        }
    }
}
