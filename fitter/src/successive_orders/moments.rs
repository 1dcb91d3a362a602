//! Angular moments of the light field on a grid of altitudes and sun zeniths.

use super::spectra::{DEGREE, NW, Spectrum};
use welkin::axis::{Stencil, hermite};

/// Highest azimuthal order.
pub const ORDERS: usize = 8;
/// Components of the coherency tensor that symmetry leaves: xx, yy, zz, xz (x towards the sun, z up).
pub const TENSOR: usize = 4;
/// Harmonics `(l, m)` with m ≤ min(l, ORDERS).
pub const HARMONICS: usize =
    (DEGREE + 1) * (DEGREE + 2) / 2 - (DEGREE - ORDERS) * (DEGREE - ORDERS + 1) / 2;
/// Moments of one grid node.
pub const COUNT: usize = TENSOR + HARMONICS;

/// Altitudes of the grid, m: of air that thins out towards the last.
pub const ALTITUDES: [f64; 36] = [
    0.0, 60.0, 150.0, 300.0, 500.0, 750.0, 1000.0, 1250.0, 1500.0, 1700.0, 1850.0, 2000.0, 2150.0,
    2300.0, 2500.0, 2750.0, 3250.0, 4000.0, 5000.0, 6000.0, 7500.0, 9000.0, 10_500.0, 12_000.0,
    14_000.0, 16_500.0, 19_000.0, 22_000.0, 26_000.0, 31_000.0, 37_000.0, 44_000.0, 53_000.0,
    65_000.0, 80_000.0, 100_000.0,
];
/// Sun zeniths of the grid.
pub const SUNS: usize = 72;

const SUN_LOWEST: f64 = -0.31;
const SUN_WIDTH: f64 = 0.08;

/// Sun coordinate (0..SUNS−1) of the sine of the sun's local elevation.
pub fn sun_coordinate(mu: f64) -> f64 {
    const LOW: f64 = -2.063_941_109_327_662_7;
    const HIGH: f64 = 3.220_471_998_464_453;
    // asinh as a plain logarithm: accurate enough here and much faster.
    let x = mu.abs() / SUN_WIDTH;
    let g = (x + (x * x + 1.0).sqrt()).ln().copysign(mu);
    ((g - LOW) / (HIGH - LOW) * (SUNS - 1) as f64).clamp(0.0, (SUNS - 1) as f64)
}

/// Sine of the sun's elevation at grid node `j`.
pub fn sun_node(j: usize) -> f64 {
    let (low, high) = ((SUN_LOWEST / SUN_WIDTH).asinh(), (1.0 / SUN_WIDTH).asinh());
    let mu = SUN_WIDTH * (low + (high - low) * j as f64 / (SUNS - 1) as f64).sinh();
    mu.clamp(SUN_LOWEST, 1.0)
}

/// Four neighbouring sun nodes and their Catmull-Rom weights.
pub fn sun_taps(mu: f64) -> ([usize; 4], [f32; 4]) {
    let u = sun_coordinate(mu);
    let i = (u as usize).min(SUNS - 2);
    let t = (u - i as f64) as f32;
    let (t2, t3) = (t * t, t * t * t);
    let weight = [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ];
    (
        std::array::from_fn(|k| (i + k).saturating_sub(1).min(SUNS - 1)),
        weight,
    )
}

/// The last of them.
pub const HIGHEST: f64 = ALTITUDES[ALTITUDES.len() - 1];

/// [`ALTITUDES`], and more where the air reaches higher: they crowd towards its edge, where light changes like a root.
pub fn altitudes(top: f64) -> Vec<f64> {
    let mut nodes = ALTITUDES.to_vec();
    if top > HIGHEST {
        let approach = (1..BEYOND).map(|k| top - (top - HIGHEST) * 0.5f64.powi(k));
        nodes.extend(approach.chain([top]));
    }
    nodes
}

/// Nodes beyond [`ALTITUDES`].
const BEYOND: i32 = 7;

/// What the solar irradiance is in the units of moments: so large that products with little transmittance and few
/// particles stay normal numbers, without which processors are slow.
pub const SOLAR_UNITS: f32 = (1u64 << 40) as f32;
/// Moments below are put out.
const DARK: f32 = 1e-18 * SOLAR_UNITS;

/// Moments at every node: `[altitude][sun][moment]`, times [`SOLAR_UNITS`] per unit of solar irradiance.
#[derive(Clone)]
pub struct Moments {
    /// Cube roots of the altitudes.
    roots: Vec<f64>,
    values: Vec<[Spectrum; COUNT]>,
}

impl Moments {
    /// Joins the rows of all `altitudes`.
    pub fn from_rows(altitudes: &[f64], rows: Vec<Vec<[Spectrum; COUNT]>>) -> Self {
        Self {
            roots: altitudes.iter().map(|h| h.cbrt()).collect(),
            values: rows.into_iter().flatten().map(without_traces).collect(),
        }
    }

    /// From all values at [`ALTITUDES`] in a row.
    pub fn from_values(values: &[f32]) -> Self {
        let (spectra, _) = values.as_chunks::<NW>();
        let (nodes, _) = spectra.as_chunks::<COUNT>();
        Self {
            roots: ALTITUDES.map(f64::cbrt).to_vec(),
            values: nodes.to_vec(),
        }
    }

    /// Cubic stencil over the altitudes, in their cube roots.
    pub fn altitude_stencil(&self, altitude: f64) -> Stencil {
        hermite(&self.roots, altitude.max(0.0).cbrt())
    }

    /// The moments of altitude `i` and sun `j`.
    pub fn node(&self, i: usize, j: usize) -> &[Spectrum; COUNT] {
        &self.values[i * SUNS + j]
    }

    /// All nodes, altitude by altitude.
    pub fn nodes_mut(&mut self) -> &mut [[Spectrum; COUNT]] {
        &mut self.values
    }

    /// All nodes, altitude by altitude.
    pub fn nodes(&self) -> &[[Spectrum; COUNT]] {
        &self.values
    }
}

fn without_traces(node: [Spectrum; COUNT]) -> [Spectrum; COUNT] {
    node.map(|moment| moment.map(|v| if v.abs() < DARK { 0.0 } else { v }))
}

/// Index of the first harmonic of order `m` when harmonics are sorted by m, then l.
pub const fn order_start(m: usize) -> usize {
    let mut start = 0;
    let mut k = 0;
    while k < m {
        start += DEGREE + 1 - k;
        k += 1;
    }
    start
}

/// Degree l of each harmonic in the order of [`polar_harmonics`].
pub const DEGREES: [usize; HARMONICS] = {
    let mut out = [0; HARMONICS];
    let mut m = 0;
    while m <= ORDERS {
        let mut i = order_start(m);
        while i < order_start(m + 1) {
            out[i] = m + i - order_start(m);
            i += 1;
        }
        m += 1;
    }
    out
};

/// Orthonormal real harmonics without their azimuth factor: `N_lm P_lm(cos θ)`, √2 included for m > 0; sorted by m,
/// then l.
pub fn polar_harmonics(cosine: f64) -> [f32; HARMONICS] {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let mut out = [0.0; HARMONICS];
    let mut diagonal = (0.25 / std::f64::consts::PI).sqrt();
    for m in 0..=ORDERS {
        if m > 0 {
            diagonal *= sine * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        let scale = if m > 0 { std::f64::consts::SQRT_2 } else { 1.0 };
        let (mut previous, mut current) = (0.0, diagonal);
        for l in m..=DEGREE {
            out[order_start(m) + l - m] = (scale * current) as f32;
            let a = |l: usize| (((4 * l * l) as f64 - 1.0) / ((l * l - m * m) as f64)).sqrt();
            let next = a(l + 1) * (cosine * current - if l > m { previous / a(l) } else { 0.0 });
            (previous, current) = (current, next);
        }
    }
    out
}

/// cos(mφ) for m = 0..=ORDERS.
pub fn azimuth_harmonics(cos_phi: f32) -> [f32; ORDERS + 1] {
    let mut out = [1.0; ORDERS + 1];
    out[1] = cos_phi;
    for m in 2..=ORDERS {
        out[m] = 2.0 * cos_phi * out[m - 1] - out[m - 2];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_obey_the_addition_theorem() {
        let phi: f64 = 0.7;
        let (a, b): (f64, f64) = (0.3, -0.55);
        let (ya, yb) = (polar_harmonics(a), polar_harmonics(b));
        let c = a * b + ((1.0 - a * a) * (1.0 - b * b)).sqrt() * phi.cos();
        let (mut p0, mut p1) = (1.0, c);
        for l in 1..=ORDERS {
            let sum: f64 = (0..=l)
                .map(|m| {
                    let i = order_start(m) + l - m;
                    f64::from(ya[i]) * f64::from(yb[i]) * (m as f64 * phi).cos()
                })
                .sum();
            let expected = (2 * l + 1) as f64 / (4.0 * std::f64::consts::PI) * p1;
            assert!(
                (sum - expected).abs() < 1e-5,
                "degree {l}: {sum} {expected}"
            );
            let next = ((2 * l + 1) as f64 * c * p1 - l as f64 * p0) / (l + 1) as f64;
            (p0, p1) = (p1, next);
        }
    }

    #[test]
    fn the_grid_reaches_the_edge_of_the_air() {
        assert_eq!(altitudes(HIGHEST), ALTITUDES);
        let nodes = altitudes(120e3);
        assert!(nodes.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(nodes[nodes.len() - 1], 120e3);
        assert!(nodes[nodes.len() - 2] > 119_500.0);
    }

    #[test]
    fn the_sun_axis_inverts() {
        for j in 0..SUNS {
            assert!((sun_coordinate(sun_node(j)) - j as f64).abs() < 1e-6);
        }
    }
}
