//! Lorenz-Mie scattering by a homogeneous sphere, after Bohren and Huffman 1983, chapter 4.

use nalgebra::Complex;

/// Coefficients of the scattered wave.
pub struct Sphere {
    size: f64,
    /// a_n and b_n from n = 1, times (2n + 1).
    waves: Vec<[Complex<f64>; 2]>,
}

impl Sphere {
    /// A sphere of size parameter `size` (circumference over wavelength) and refractive index n + i k relative to what
    /// is about it, k ≥ 0.
    pub fn new(size: f64, index: Complex<f64>) -> Self {
        let terms = (size + 4.05 * size.cbrt() + 2.0).ceil() as usize;
        let derivatives = logarithmic_derivatives(index * size, terms);
        let mut waves = Vec::with_capacity(terms);
        // ψ and χ of the orders n − 1 and n.
        let (mut psi, mut chi) = ([size.cos(), size.sin()], [-size.sin(), size.cos()]);
        for (n, &d) in derivatives.iter().enumerate().take(terms + 1).skip(1) {
            let rise = (2 * n - 1) as f64 / size;
            psi = [psi[1], rise * psi[1] - psi[0]];
            chi = [chi[1], rise * chi[1] - chi[0]];
            let xi = [0, 1].map(|k| Complex::new(psi[k], -chi[k]));
            let wave = |inside: Complex<f64>| {
                let inside = inside + n as f64 / size;
                (2 * n + 1) as f64 * (inside * psi[1] - psi[0]) / (inside * xi[1] - xi[0])
            };
            waves.push([wave(d / index), wave(d * index)]);
        }
        Self { size, waves }
    }

    /// Scattering and extinction cross sections over the geometric one.
    pub fn efficiencies(&self) -> [f64; 2] {
        let (mut scattering, mut extinction) = (0.0, 0.0);
        for (i, [a, b]) in self.waves.iter().enumerate() {
            scattering += (a.norm_sqr() + b.norm_sqr()) / (2 * i + 3) as f64;
            extinction += a.re + b.re;
        }
        [scattering, extinction].map(|sum| 2.0 / (self.size * self.size) * sum)
    }

    /// S11, S12 and S33 at the cosine of a scattering angle; Q is positive in the scattering plane.
    pub fn matrix(&self, cosine: f64) -> [f64; 3] {
        let [mut across, mut along] = [Complex::new(0.0, 0.0); 2];
        let (mut before, mut pi) = (0.0, 1.0);
        for (i, [a, b]) in self.waves.iter().enumerate() {
            let n = (i + 1) as f64;
            let tau = n * cosine * pi - (n + 1.0) * before;
            let share = 1.0 / (n * (n + 1.0));
            across += (a * pi + b * tau) * share;
            along += (a * tau + b * pi) * share;
            let next = ((2.0 * n + 1.0) * cosine * pi - (n + 1.0) * before) / n;
            (before, pi) = (pi, next);
        }
        let (s1, s2) = (across.norm_sqr(), along.norm_sqr());
        let s33 = across.re * along.re + across.im * along.im;
        [0.5 * (s1 + s2), 0.5 * (s2 - s1), s33]
    }
}

/// D_n(z) = ψ'_n(z) / ψ_n(z) for n = 0..=terms, downwards, which is stable.
fn logarithmic_derivatives(z: Complex<f64>, terms: usize) -> Vec<Complex<f64>> {
    let start = terms.max(z.norm().ceil() as usize) + 16;
    let mut out = vec![Complex::new(0.0, 0.0); terms + 1];
    let mut d = Complex::new(0.0, 0.0);
    for n in (1..=start).rev() {
        let ratio = Complex::new(n as f64, 0.0) / z;
        d = ratio - (d + ratio).inv();
        if n - 1 <= terms {
            out[n - 1] = d;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bohren and Huffman 1983, appendix A: index 1.55, radius 0.525 µm, 632.8 nm.
    #[test]
    fn a_sphere_is_the_published_one() {
        let size = 2.0 * std::f64::consts::PI * 0.525 / 0.6328;
        let sphere = Sphere::new(size, Complex::new(1.55, 0.0));
        let [scattering, extinction] = sphere.efficiencies();
        assert!((scattering - 3.10543).abs() < 1e-5, "{scattering}");
        assert!((extinction - 3.10543).abs() < 1e-5, "{extinction}");
        let forward = sphere.matrix(1.0)[0];
        let [s11, s12, s33] = sphere.matrix(9f64.to_radians().cos());
        let quarter_pi = std::f64::consts::FRAC_PI_4; // the published 0.785390, as it happens
        assert!(
            (s11 / forward - quarter_pi).abs() < 1e-5,
            "{}",
            s11 / forward
        );
        assert!((-s12 / s11 + 0.00459811).abs() < 1e-5, "{}", -s12 / s11);
        assert!((s33 / s11 - 0.999400).abs() < 1e-5, "{}", s33 / s11);
    }

    /// Small spheres scatter like dipoles: Q = 8/3 x⁴ |(m² − 1)/(m² + 2)|².
    #[test]
    fn small_spheres_are_dipoles() {
        let (x, m) = (0.01, Complex::new(1.5, 0.0));
        let sphere = Sphere::new(x, m);
        let square = m * m;
        let ratio = ((square - 1.0) / (square + 2.0)).norm_sqr();
        let [scattering, _] = sphere.efficiencies();
        assert!((scattering / (8.0 / 3.0 * x.powi(4) * ratio) - 1.0).abs() < 1e-3);
        let [s11, s12, _] = sphere.matrix(0.0);
        assert!((s12 / s11 + 1.0).abs() < 1e-3);
    }

    #[test]
    fn what_absorbs_takes_more_than_it_scatters() {
        let sphere = Sphere::new(20.0, Complex::new(1.5, 0.1));
        let [scattering, extinction] = sphere.efficiencies();
        assert!(extinction > 1.3 * scattering && scattering > 0.5);
    }
}
