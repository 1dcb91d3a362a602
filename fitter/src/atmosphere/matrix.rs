//! Tabulated scattering matrices: for particles that no closed form describes.

use anyhow::{Result, ensure};

/// Steps of 0.1° up to this angle (degrees), where the forward peaks of large particles are; of 0.25° beyond.
const FINE_UNTIL: f64 = 10.0;
const FINE: usize = 100;
const COARSE: usize = 680;
/// Number of angles at which a [`Matrix`] is held.
pub const NODES: usize = FINE + COARSE + 1;

/// Scattering angle of node `i`, radians.
pub fn angle(i: usize) -> f64 {
    let degrees = if i <= FINE {
        FINE_UNTIL * i as f64 / FINE as f64
    } else {
        FINE_UNTIL + (180.0 - FINE_UNTIL) * (i - FINE) as f64 / COARSE as f64
    };
    degrees.to_radians()
}

/// Index of the interval between nodes that holds a scattering angle (radians).
pub fn interval(angle: f64) -> usize {
    let degrees = angle.to_degrees();
    let position = if degrees < FINE_UNTIL {
        degrees * (FINE as f64 / FINE_UNTIL)
    } else {
        FINE as f64 + (degrees - FINE_UNTIL) * (COARSE as f64 / (180.0 - FINE_UNTIL))
    };
    (position as usize).min(NODES - 2)
}

/// F11, F12 and F33 at one node.
pub type Elements = [f64; 3];

/// F11, F12 and F33 of spheres (for which F22 = F11) at the nodes of one grid of angles, per wavelength. Between nodes
/// they are linear in the cosine, and so F11 has mean 1 exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// By wavelength and node.
    values: Vec<Vec<Elements>>,
}

impl Matrix {
    /// Resamples one set of rows (scattering angle in degrees from 0 to 180; ln F11, F12/F11, F33/F11) per wavelength.
    pub fn resample(angles: &[f64], wavelengths: &[Vec<Elements>]) -> Result<Self> {
        ensure!(
            angles.first() == Some(&0.0) && angles.last() == Some(&180.0),
            "scattering angles must run from 0 to 180 degrees"
        );
        ensure!(
            angles.windows(2).all(|a| a[0] < a[1]) && angles.len() > 2,
            "scattering angles must increase"
        );
        let lane = |rows: &Vec<Elements>| {
            ensure!(
                rows.len() == angles.len() && rows.iter().flatten().all(|v| v.is_finite()),
                "a scattering matrix needs finite values at every angle"
            );
            let at = |i: usize| absolute(hermite(angles, rows, angle(i).to_degrees()));
            Ok(normalised((0..NODES).map(at).collect()))
        };
        Ok(Self {
            values: wavelengths.iter().map(lane).collect::<Result<_>>()?,
        })
    }

    /// Number of wavelengths.
    pub fn wavelengths(&self) -> usize {
        self.values.len()
    }

    /// Elements at node `i` for wavelength index `w`.
    pub fn at(&self, w: usize, i: usize) -> Elements {
        self.values[w][i]
    }
}

/// From ln F11, F12/F11 and F33/F11.
fn absolute([log, r12, r33]: Elements) -> Elements {
    let f11 = log.exp();
    [f11, f11 * r12.clamp(-1.0, 1.0), f11 * r33.clamp(-1.0, 1.0)]
}

fn normalised(mut values: Vec<Elements>) -> Vec<Elements> {
    let pieces = values.windows(2).enumerate().map(|(i, pair)| {
        let width = angle(i).cos() - angle(i + 1).cos();
        0.25 * width * (pair[0][0] + pair[1][0])
    });
    let mean: f64 = pieces.sum();
    for value in values.iter_mut().flatten() {
        *value /= mean;
    }
    values
}

/// Cubic interpolation with the slopes of parabolas through three nodes.
fn hermite(x: &[f64], y: &[Elements], at: f64) -> Elements {
    let i = x.partition_point(|&a| a <= at).clamp(1, x.len() - 1) - 1;
    let h = x[i + 1] - x[i];
    let t = ((at - x[i]) / h).clamp(0.0, 1.0);
    let basis = [
        (1.0 + 2.0 * t) * (1.0 - t).powi(2),
        h * t * (1.0 - t).powi(2),
        t * t * (3.0 - 2.0 * t),
        h * t * t * (t - 1.0),
    ];
    std::array::from_fn(|e| {
        let (a, b) = (slope(x, y, i, e), slope(x, y, i + 1, e));
        basis[0] * y[i][e] + basis[1] * a + basis[2] * y[i + 1][e] + basis[3] * b
    })
}

/// All elements are even functions of the angle about 0 and 180 degrees: their slopes vanish there.
fn slope(x: &[f64], y: &[Elements], i: usize, e: usize) -> f64 {
    if i == 0 || i + 1 == x.len() {
        return 0.0;
    }
    let (before, after) = (x[i] - x[i - 1], x[i + 1] - x[i]);
    let rise = |a: usize, b: usize| (y[b][e] - y[a][e]) / (x[b] - x[a]);
    (rise(i - 1, i) * after + rise(i, i + 1) * before) / (before + after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_hold_their_angles() {
        for i in 0..NODES - 1 {
            assert_eq!(interval(0.5 * (angle(i) + angle(i + 1))), i);
        }
        assert_eq!(interval(0.0), 0);
        assert_eq!(interval(std::f64::consts::PI), NODES - 2);
    }

    #[test]
    fn rayleigh_scattering_survives_resampling() {
        let angles: Vec<f64> = (0..=180).map(f64::from).collect();
        let row = |a: &f64| {
            let c = a.to_radians().cos();
            let f11 = 0.75 * (1.0 + c * c);
            [f11.ln(), (c * c - 1.0) / (1.0 + c * c), 1.5 * c / f11]
        };
        let rows = angles.iter().map(row).collect();
        let matrix = Matrix::resample(&angles, &[rows]).unwrap();
        for i in 0..NODES {
            let c = angle(i).cos();
            let expected = [0.75 * (1.0 + c * c), 0.75 * (c * c - 1.0), 1.5 * c];
            for (a, b) in matrix.at(0, i).iter().zip(expected) {
                assert!((a - b).abs() < 2e-5, "node {i}: {a} {b}");
            }
        }
    }

    #[test]
    fn bad_tables_are_refused() {
        let rows = |n: usize| vec![vec![[0.0; 3]; n]];
        assert!(Matrix::resample(&[0.0, 90.0, 170.0], &rows(3)).is_err());
        assert!(Matrix::resample(&[0.0, 90.0, 180.0], &rows(2)).is_err());
        assert!(Matrix::resample(&[0.0, 90.0, 90.0, 180.0], &rows(4)).is_err());
        assert!(Matrix::resample(&[0.0, 90.0, 180.0], &[vec![[f64::NAN; 3]; 3]]).is_err());
    }
}
