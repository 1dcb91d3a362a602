//! Column densities along straight lines: the integral of each constituent's profile over distance, in metres.
//!
//! Times the extinction coefficients they give optical depths at every wavelength.

use crate::atmosphere::Atmosphere;

/// Largest number of constituents.
pub const MAX_CONSTITUENTS: usize = 8;

/// One column per constituent, m.
pub type Columns = [f64; MAX_CONSTITUENTS];

/// Three-point Gauss-Legendre on −1..1.
const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

/// Integrates the profiles of an atmosphere shell by shell.
#[derive(Clone, Debug)]
pub struct ColumnIntegrator<'a> {
    atmosphere: &'a Atmosphere,
    constituents: usize,
}

impl<'a> ColumnIntegrator<'a> {
    /// For an atmosphere of at most [`MAX_CONSTITUENTS`] constituents.
    pub fn new(atmosphere: &'a Atmosphere) -> Self {
        let constituents = atmosphere.constituents.len();
        assert!(constituents <= MAX_CONSTITUENTS, "too many constituents");
        Self {
            atmosphere,
            constituents,
        }
    }

    /// Columns from `altitude` (m) over `length` (m) in a direction with zenith cosine `mu`.
    pub fn along(&self, altitude: f64, mu: f64, length: f64) -> Columns {
        let r = self.atmosphere.planet_radius + altitude;
        let (start, end) = (r * mu, r * mu + length);
        let p2 = r * r * (1.0 - mu) * (1.0 + mu);
        let mut sum = [0.0; MAX_CONSTITUENTS];
        // Signed distances from the tangent point: both halves are integrated outwards.
        if start < 0.0 && end > 0.0 {
            self.add(p2, 0.0, -start, &mut sum);
            self.add(p2, 0.0, end, &mut sum);
        } else {
            self.add(
                p2,
                start.abs().min(end.abs()),
                start.abs().max(end.abs()),
                &mut sum,
            );
        }
        sum
    }

    /// Adds the columns between distances `from < to` from the tangent point of a line with squared impact parameter
    /// `p2`.
    fn add(&self, p2: f64, from: f64, to: f64, sum: &mut Columns) {
        let radius = self.atmosphere.planet_radius;
        let nodes = &self.atmosphere.altitudes;
        let low = (p2 + from * from).sqrt() - radius;
        let mut i = nodes.partition_point(|&z| z <= low).max(1) - 1;
        let mut s0 = from;
        while s0 < to && i + 1 < nodes.len() {
            let shell = radius + nodes[i + 1];
            let s1 = (shell * shell - p2).max(0.0).sqrt().clamp(s0, to);
            self.add_shell(i, p2, s0, s1, sum);
            s0 = s1;
            i += 1;
        }
    }

    fn add_shell(&self, i: usize, p2: f64, s0: f64, s1: f64, sum: &mut Columns) {
        let (z, half) = (&self.atmosphere.altitudes, 0.5 * (s1 - s0));
        for (x, weight) in GAUSS {
            let s = s0 + half * (1.0 + x);
            let altitude = (p2 + s * s).sqrt() - self.atmosphere.planet_radius;
            let t = ((altitude - z[i]) / (z[i + 1] - z[i])).clamp(0.0, 1.0);
            for (k, total) in sum.iter_mut().enumerate().take(self.constituents) {
                let profile = &self.atmosphere.constituents[k].profile;
                *total += half * weight * (profile[i] + t * (profile[i + 1] - profile[i]));
            }
        }
    }
}

/// Columns from any point to the sun, tabulated over altitude and angle above the geometric horizon.
pub struct SunColumns {
    planet: welkin::geometry::Planet,
    altitudes: Vec<f64>,
    values: Vec<[f32; MAX_CONSTITUENTS]>,
}

const ANGLES: usize = 640;
const ANGLE_EXPONENT: f64 = 3.0;

impl SunColumns {
    /// Tabulates `atmosphere`.
    pub fn new(atmosphere: &Atmosphere) -> Self {
        use rayon::prelude::*;
        let planet = planet(atmosphere);
        let integrator = ColumnIntegrator::new(atmosphere);
        let altitudes = table_altitudes(atmosphere.top());
        let values = altitudes
            .par_iter()
            .flat_map_iter(|&h| {
                let integrator = &integrator;
                (0..=ANGLES).map(move |i| {
                    let dip = planet.dip(h);
                    let range = std::f64::consts::FRAC_PI_2 + dip;
                    let angle = range * (i as f64 / ANGLES as f64).powf(ANGLE_EXPONENT);
                    let ray = planet.ray(h, (angle - dip).max(-dip + 1e-12));
                    let c = integrator.along(h, (angle - dip).sin(), ray.length);
                    c.map(|v| v as f32)
                })
            })
            .collect();
        Self {
            planet,
            altitudes,
            values,
        }
    }

    /// Columns from `altitude` (m) towards a point `angle` (rad, ≥ 0) above the geometric horizon.
    pub fn at(&self, altitude: f64, angle: f64, dip: f64) -> [f32; MAX_CONSTITUENTS] {
        let range = std::f64::consts::FRAC_PI_2 + dip;
        let v = ((angle / range).clamp(0.0, 1.0).cbrt() * ANGLES as f64).min(ANGLES as f64 - 1e-6);
        let i = v as usize;
        let weight = catmull_rom((v - i as f64) as f32);
        let j = self
            .altitudes
            .partition_point(|&z| z <= altitude)
            .clamp(1, self.altitudes.len() - 1);
        let t = (altitude - self.altitudes[j - 1]) / (self.altitudes[j] - self.altitudes[j - 1]);
        let t = t.clamp(0.0, 1.0) as f32;
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (row, share) in [(j - 1, 1.0 - t), (j, t)] {
            for (tap, w) in weight.into_iter().enumerate() {
                let column = (i + tap).saturating_sub(1).min(ANGLES);
                let node = &self.values[row * (ANGLES + 1) + column];
                for (o, n) in out.iter_mut().zip(node) {
                    *o += share * w * n;
                }
            }
        }
        out.map(|c| c.max(0.0))
    }

    /// The planet and its atmosphere's top.
    pub fn planet(&self) -> welkin::geometry::Planet {
        self.planet
    }
}

/// Planet of an atmosphere, as the library's geometry sees it.
pub fn planet(atmosphere: &Atmosphere) -> welkin::geometry::Planet {
    welkin::geometry::Planet {
        radius: atmosphere.planet_radius,
        top: atmosphere.top(),
    }
}

fn catmull_rom(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ]
}

/// Dense where aerosol ends, sparser with height.
fn table_altitudes(top: f64) -> Vec<f64> {
    let mut nodes = vec![0.0];
    let mut z: f64 = 0.0;
    while z < top {
        let step: f64 = match z {
            z if z < 3000.0 => 25.0,
            z if z < 14_000.0 => 100.0,
            z if z < 50_000.0 => 250.0,
            _ => 500.0,
        };
        // Air that is thousands of kilometres high gets no more nodes.
        z += step.max(top / 8192.0);
        nodes.push(z.min(top));
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::real;

    #[test]
    fn vertical_columns_match_the_trapezoid() {
        let air = real(59_400.0, &[550.0]).unwrap();
        let columns = ColumnIntegrator::new(&air).along(0.0, 1.0, air.top());
        for (k, c) in air.constituents.iter().enumerate() {
            let tau = columns[k] * c.extinction[0];
            assert!((tau - air.vertical_optical_depth(k, 0)).abs() < 1e-12);
        }
    }

    #[test]
    fn columns_add_up_along_a_grazing_line() {
        let air = real(20_000.0, &[550.0]).unwrap();
        let integrator = ColumnIntegrator::new(&air);
        let (h, mu) = (9000.0, -0.04);
        let whole = integrator.along(h, mu, 800_000.0);
        let first = integrator.along(h, mu, 300_000.0);
        let r = air.planet_radius + h;
        let r2 = (r * r + 2.0 * r * mu * 3e5 + 9e10).sqrt();
        let rest = integrator.along(r2 - air.planet_radius, (r * mu + 3e5) / r2, 500_000.0);
        for k in 0..air.constituents.len() {
            assert!(
                (first[k] + rest[k] - whole[k]).abs() <= 1e-7 * whole[k] + 1e-9,
                "{k}"
            );
        }
    }

    #[test]
    fn the_sun_table_is_close_to_the_integral() {
        let air = real(59_400.0, &[440.0]).unwrap();
        let table = SunColumns::new(&air);
        let integrator = ColumnIntegrator::new(&air);
        let mut worst = 0.0f64;
        for i in 0..4000 {
            let u = |n: f64| (i as f64 * n).fract();
            let h = 60_000.0 * u(0.618_033_988).powi(3);
            let dip = table.planet.dip(h);
            let angle = (std::f64::consts::FRAC_PI_2 + dip) * u(0.754_877_666).powi(3);
            let length = table.planet.ray(h, angle - dip + 1e-13).length;
            let exact = integrator.along(h, (angle - dip).sin(), length);
            let tabled = table.at(h, angle, dip);
            let tau = |c: &dyn Fn(usize) -> f64| {
                (0..air.constituents.len())
                    .map(|k| c(k) * air.constituents[k].extinction[0])
                    .sum::<f64>()
            };
            let (a, b) = (tau(&|k| exact[k]), tau(&|k| f64::from(tabled[k])));
            worst = worst.max(((-a).exp() - (-b).exp()).abs());
        }
        println!("largest error of a transmittance: {worst:.1e}");
        assert!(worst < 1e-3, "transmittance off by {worst}");
    }
}
