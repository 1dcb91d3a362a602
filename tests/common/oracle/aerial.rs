//! Section 7.7: light that the air of a segment scatters, by brute force.

use std::f64::consts::PI;

use super::{Oracle, Query, cross, dot, fade, hermite, phase, piecewise, vertical_frame};

const SOLAR_RADIUS: f64 = 0.004_654_793;
/// Nodes and weights of a Gauss-Legendre rule on −1..1, exact for the fifth degree.
const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

type Vector = [f64; 3];
/// L, Q and U in the vertical frame.
type Light = [f64; 3];

/// What holds everywhere on a segment.
struct Scene {
    sun: Vector,
    view: Vector,
    /// Axes of the vertical frame.
    frame: [Vector; 2],
    /// Extinction, `[constituent][wavelength]`.
    extinction: Vec<f64>,
    /// `B(λ)`.
    ground: Vec<f64>,
    species: Vec<Species>,
    source: Source,
}

struct Species {
    code: u32,
    parameter: Vec<f64>,
    scattering: Vec<f64>,
}

/// Where the source basis stands, its axes, and the weights of the visibilities.
struct Source {
    altitudes: Vec<f64>,
    suns: Vec<f64>,
    ranks: [usize; 4],
    degree: usize,
    orders: usize,
    factor: [usize; 4],
    /// Offset of the payload, weight.
    visibilities: Vec<(usize, f64)>,
}

impl Oracle<'_> {
    /// In-scattered light at every wavelength, towards the observer over a distance; the integral is cut into pieces
    /// that are not longer than `step`, m.
    pub fn in_scattering(&self, q: &Query, distance: f64, step: f64) -> Vec<Light> {
        let scene = self.scene(q);
        let start = [0.0, 0.0, self.radius() + q.altitude];
        let mut cuts = self.crossings(start, scene.view, distance);
        cuts.push((-dot(start, scene.view)).clamp(0.0, distance));
        cuts.sort_by(f64::total_cmp);
        let mut sum = vec![[0.0; 3]; self.n.w];
        for pair in cuts.windows(2) {
            let pieces = ((pair[1] - pair[0]) / step).ceil().max(8.0) as usize;
            let length = (pair[1] - pair[0]) / pieces as f64;
            for i in 0..pieces {
                for (node, weight) in GAUSS {
                    let s = pair[0] + length * (i as f64 + 0.5 + 0.5 * node);
                    let light = self.scattered_at(&scene, start, s);
                    for (sum, light) in sum.as_flattened_mut().iter_mut().zip(light.as_flattened())
                    {
                        *sum += 0.5 * length * weight * light;
                    }
                }
            }
        }
        for [l, q, u] in &mut sum {
            let share = (*l / q.hypot(*u)).min(1.0);
            (*q, *u) = (share * *q, share * *u);
        }
        sum
    }

    fn radius(&self) -> f64 {
        self.f64(64, 0)
    }

    fn u32(&self, at: usize, i: usize) -> usize {
        u32::from_le_bytes(self.file[at + 4 * i..][..4].try_into().unwrap()) as usize
    }

    fn scene(&self, q: &Query) -> Scene {
        let n = &self.n;
        let inverses = self.axis(self.at.visibility, n.v, f64::recip);
        let linear = piecewise(&inverses, 1.0 / q.visibility);
        let head = |at: usize, stride: usize, i: usize| -> f64 {
            let terms = linear.iter();
            terms.map(|&(m, t)| t * self.f64(at, m * stride + i)).sum()
        };
        let ground = (0..n.w).map(|w| {
            let spherical = head(self.at.spherical, n.w, w);
            q.albedo / (1.0 - q.albedo * spherical)
        });
        let (sine, cosine) = q.solar_elevation.sin_cos();
        let length = dot(q.direction, q.direction).sqrt();
        let view = q.direction.map(|v| v / length);
        Scene {
            sun: [
                cosine * q.solar_azimuth.cos(),
                cosine * q.solar_azimuth.sin(),
                sine,
            ],
            view,
            frame: vertical_frame(view, q.solar_azimuth),
            extinction: (0..n.k * n.w)
                .map(|i| head(self.at.extinction, n.k * n.w, i))
                .collect(),
            ground: ground.collect(),
            species: self.species(&linear),
            source: self.source(&hermite(&inverses, 1.0 / q.visibility)),
        }
    }

    fn species(&self, visibilities: &[(usize, f64)]) -> Vec<Species> {
        let n = &self.n;
        let at = |m: usize| self.chunk(5, 65535, m).0;
        let count = self.u32(at(visibilities[0].0), 0);
        let mixed = |place: usize| -> f64 {
            let terms = visibilities.iter();
            terms.map(|&(m, t)| t * self.f32(at(m) + 32, place)).sum()
        };
        let (parameter, scattering) = (count, count + count * n.w);
        let one = |p: usize| Species {
            code: self.u32(at(visibilities[0].0) + 32, p) as u32,
            parameter: (0..n.w).map(|w| mixed(parameter + p * n.w + w)).collect(),
            scattering: (0..n.k * n.w)
                .map(|i| mixed(scattering + p * n.k * n.w + i))
                .collect(),
        };
        (0..count).map(one).collect()
    }

    fn source(&self, visibilities: &[(usize, f64)]) -> Source {
        let (at, _) = self.chunk(8, 65535, 65535);
        let [altitudes, suns, degree, orders] = [0, 1, 2, 3].map(|i| self.u32(at, i));
        let ranks = [4, 5, 6, 7].map(|i| self.u32(at, i));
        let harmonics = (0..=orders).map(|m| degree + 1 - m).sum::<usize>();
        let rows = [altitudes, suns, 4 + harmonics];
        let mut factor = [at + 32 + 8 * (altitudes + suns); 4];
        for mode in 0..3 {
            factor[mode + 1] = factor[mode] + 4 * rows[mode] * ranks[mode];
        }
        Source {
            altitudes: self.axis(at + 32, altitudes, f64::cbrt),
            suns: self.axis(at + 32 + 8 * altitudes, suns, |s| (12.5 * s).asinh()),
            ranks,
            degree,
            orders,
            factor,
            visibilities: visibilities
                .iter()
                .map(|&(m, t)| (self.chunk(5, 65535, m).0, t))
                .collect(),
        }
    }

    /// Distances at which a ray crosses the edges of the layers, from 0 to its length.
    fn crossings(&self, from: Vector, direction: Vector, length: f64) -> Vec<f64> {
        let (at, _) = self.chunk(4, 65535, 65535);
        let closest = -dot(from, direction);
        let squared = dot(from, from) - closest * closest;
        let mut cuts = vec![0.0, length];
        for i in 0..=self.u32(at, 0) {
            let chord = (self.radius() + self.f64(at + 8, i)).powi(2) - squared;
            if chord > 0.0 {
                let both = [closest - chord.sqrt(), closest + chord.sqrt()];
                cuts.extend(both.map(|s| s.clamp(0.0, length)));
            }
        }
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// Optical depth at every wavelength: the profiles are polynomials between crossings.
    fn depth(&self, scene: &Scene, from: Vector, direction: Vector, length: f64) -> Vec<f64> {
        let (at, _) = self.chunk(4, 65535, 65535);
        let mut columns = vec![0.0; self.n.k];
        for pair in self.crossings(from, direction, length).windows(2) {
            let half = 0.5 * (pair[1] - pair[0]);
            for (node, weight) in GAUSS {
                let point = along(from, direction, pair[0] + half * (1.0 + node));
                let altitude = dot(point, point).sqrt() - self.radius();
                for (k, column) in columns.iter_mut().enumerate() {
                    *column += half * weight * self.density(at, altitude, k);
                }
            }
        }
        let row = |w: usize| (0..self.n.k).map(move |k| (k, k * self.n.w + w));
        (0..self.n.w)
            .map(|w| row(w).map(|(k, i)| columns[k] * scene.extinction[i]).sum())
            .collect()
    }

    /// The integrand at a distance from the start.
    fn scattered_at(&self, scene: &Scene, start: Vector, s: f64) -> Vec<Light> {
        let point = along(start, scene.view, s);
        let distance = dot(point, point).sqrt();
        let altitude = distance - self.radius();
        let (at, _) = self.chunk(4, 65535, 65535);
        let air: Vec<f64> = (0..self.n.k)
            .map(|k| self.density(at, altitude, k))
            .collect();
        let depth = self.depth(scene, start, scene.view, s);
        let sunlight = self.sunlight(scene, point);
        let sources = self.sources(scene, point);
        let cosine = dot(scene.view, scene.sun);
        // Light that was scattered once is polarised along the normal of the scattering plane.
        let [n1, n2] = scene.frame.map(|e| dot(cross(scene.view, scene.sun), e));
        (0..self.n.w)
            .map(|w| {
                let [molecules, q, u, particles] = sources[w];
                let mut light = [0.0; 3];
                for species in &scene.species {
                    let coefficient: f64 = (0..self.n.k)
                        .map(|k| species.scattering[k * self.n.w + w] * air[k])
                        .sum();
                    let parameter = species.parameter[w];
                    let once = sunlight[w] / (4.0 * PI);
                    let dipole = once * 0.75 * (1.0 - parameter) / (1.0 + parameter / 2.0);
                    let scattered = match species.code {
                        1 => [
                            molecules,
                            q + dipole * (n1 * n1 - n2 * n2),
                            u + dipole * 2.0 * n1 * n2,
                        ],
                        _ => [particles, 0.0, 0.0],
                    };
                    light[0] += coefficient * once * phase(species.code, parameter, cosine);
                    for (light, scattered) in light.iter_mut().zip(scattered) {
                        *light += coefficient * scattered;
                    }
                }
                light.map(|part| (-depth[w]).exp() * part)
            })
            .collect()
    }

    /// D; below the ground it is that at the ground.
    fn sunlight(&self, scene: &Scene, point: Vector) -> Vec<f64> {
        let lift = (self.radius() / dot(point, point).sqrt()).max(1.0);
        let point = point.map(|v| v * lift);
        let distance = dot(point, point).sqrt();
        let elevation = (dot(point, scene.sun) / distance).asin();
        let above = elevation + (self.radius() / distance).min(1.0).acos();
        // The visible part of the disc from its segment: half the angle of the hidden arc.
        let hidden = (above / SOLAR_RADIUS).clamp(-1.0, 1.0).acos();
        let area = PI - hidden + hidden.sin() * hidden.cos();
        if area <= 0.0 {
            return vec![0.0; self.n.w];
        }
        let centroid = elevation + SOLAR_RADIUS * 2.0 / 3.0 * hidden.sin().powi(3) / area;
        let up = point.map(|v| v / distance);
        let lift = dot(up, scene.sun);
        let level: Vector = std::array::from_fn(|i| scene.sun[i] - lift * up[i]);
        let length = dot(level, level).sqrt().max(f64::MIN_POSITIVE);
        let towards: Vector =
            std::array::from_fn(|i| centroid.sin() * up[i] + centroid.cos() * level[i] / length);
        let reach = 2.0 * (distance + self.f64(72, 0));
        let depth = self.depth(scene, point, towards, reach);
        depth.iter().map(|d| area / PI * (-d).exp()).collect()
    }

    /// S_R, Q_R, U_R and S_A at every wavelength.
    fn sources(&self, scene: &Scene, point: Vector) -> Vec<[f64; 4]> {
        let source = &scene.source;
        let distance = dot(point, point).sqrt();
        let up = point.map(|v| v / distance);
        let (lift, sine) = (dot(up, scene.view), dot(up, scene.sun));
        let at = |nodes: &[f64], x: f64| hermite(nodes, x.clamp(nodes[0], nodes[nodes.len() - 1]));
        let altitude = (distance - self.radius()).max(0.0);
        let a = at(&source.altitudes, altitude.cbrt());
        let s = at(&source.suns, (12.5 * sine).asinh());
        let level = |v: Vector, l: f64| -> Vector { std::array::from_fn(|i| v[i] - l * up[i]) };
        let (view, sun) = (level(scene.view, lift), level(scene.sun, sine));
        let both = (dot(view, view) * dot(sun, sun)).sqrt();
        let phi = match both > 1e-12 {
            true => (dot(view, sun) / both).clamp(-1.0, 1.0).acos(),
            false => 0.0,
        };
        let length = dot(sun, sun).sqrt();
        // Around a vertical sun all axes are alike.
        let x = match length > 0.0 {
            true => sun.map(|v| v / length),
            false => scene.frame[1],
        };
        let axes = [x, cross(up, x), up];
        let frame = scene.frame.map(|e| axes.map(|axis| dot(e, axis)));
        let theta = lift.clamp(-1.0, 1.0).acos();
        let moments = self.moments(source, [theta, phi, fade(length)], frame);
        (0..self.n.w)
            .map(|w| {
                let mut sum = [0.0; 4];
                for (b, moments) in moments.iter().enumerate() {
                    let brightness = self.brightness(source, [&a, &s], b, w, scene.ground[w]);
                    for (sum, moment) in sum.iter_mut().zip(moments) {
                        *sum += moment * brightness;
                    }
                }
                let [molecules, q, u, particles] = sum;
                [molecules.max(0.0), q, u, particles.max(0.0)]
            })
            .collect()
    }

    /// G_b.
    fn brightness(
        &self,
        source: &Source,
        [a, s]: [&[(usize, f64)]; 2],
        b: usize,
        w: usize,
        ground: f64,
    ) -> f64 {
        let (mut logarithm, mut sum) = (0.0, 0.0);
        for &(at, weight) in &source.visibilities {
            let level = [0, 1].map(|f| self.level_of_field(source, at, s, f, w));
            let x = [0, 1].map(|f| self.component(source, at, [a, s], b, f * self.n.w + w));
            logarithm += weight * level[0];
            sum += weight * (x[0] + ground * (level[1] - level[0]).exp() * x[1]);
        }
        logarithm.exp() * sum
    }

    fn level_of_field(
        &self,
        source: &Source,
        at: usize,
        s: &[(usize, f64)],
        f: usize,
        w: usize,
    ) -> f64 {
        let species = self.u32(at, 0);
        let level = species * (1 + self.n.w + self.n.k * self.n.w);
        let row = |i: usize| level + (f * source.suns.len() + i) * self.n.w + w;
        s.iter().map(|&(i, t)| t * self.f32(at + 32, row(i))).sum()
    }

    /// X_f,b.
    fn component(
        &self,
        source: &Source,
        at: usize,
        [a, s]: [&[(usize, f64)]; 2],
        b: usize,
        channel: usize,
    ) -> f64 {
        let [ra, rs, rm, rc] = source.ranks;
        let species = self.u32(at, 0);
        let singles =
            species * (1 + self.n.w + self.n.k * self.n.w) + 2 * source.suns.len() * self.n.w;
        let core = at + 32 + 4 * singles;
        let factor = |mode: usize, taps: &[(usize, f64)], i: usize| -> f64 {
            let (from, rank) = (source.factor[mode], source.ranks[mode]);
            taps.iter()
                .map(|&(row, t)| t * self.f32(from, row * rank + i))
                .sum()
        };
        let mut sum = 0.0;
        for i in 0..ra {
            for j in 0..rs {
                for c in 0..rc {
                    let weight = self.f32(source.factor[3], channel * rc + c);
                    let entry = self.f16(core, ((i * rs + j) * rm + b) * rc + c);
                    sum += factor(0, a, i) * factor(1, s, j) * weight * entry;
                }
            }
        }
        sum * self.f32(at, 6)
    }

    /// What a component of the moments looks like through polarisers along the axes `e1` and `e2`, in the local frame:
    /// to molecules in L, Q and U, and to particles.
    fn moments(
        &self,
        source: &Source,
        [theta, phi, fade]: [f64; 3],
        [e1, e2]: [Vector; 2],
    ) -> Vec<[f64; 4]> {
        let rank = source.ranks[2];
        let factor = |row: usize, b: usize| -> f64 { self.f32(source.factor[2], row * rank + b) };
        let mut harmonics = Vec::new();
        for m in 0..=source.orders {
            for l in m..=source.degree {
                let azimuthal = fade.powi(m as i32) * (m as f64 * phi).cos();
                harmonics.push(harmonic(l, m, theta.cos()) * azimuthal);
            }
        }
        (0..rank)
            .map(|b| {
                let [xx, yy, zz, xz] = [0, 1, 2, 3].map(|row| factor(row, b));
                let (mean, half) = (0.5 * (xx + yy), 0.5 * fade * fade * (xx - yy));
                let (xx, yy, xz) = (mean + half, mean - half, fade * xz);
                let tensor = |v: Vector| [xx * v[0] + xz * v[2], yy * v[1], xz * v[0] + zz * v[2]];
                let (along, across) = (dot(e1, tensor(e1)), dot(e2, tensor(e2)));
                let rows = harmonics.iter().enumerate();
                let particles = rows.map(|(i, v)| v * factor(4 + i, b)).sum();
                let mixed = 2.0 * dot(e1, tensor(e2));
                [along + across, along - across, mixed, particles]
            })
            .collect()
    }
}

fn along(from: Vector, direction: Vector, s: f64) -> Vector {
    std::array::from_fn(|i| from[i] + s * direction[i])
}

/// N_lm P_lm(x), with √2 for m > 0: from the sum of powers that the derivatives of (x² − 1)^l have.
fn harmonic(l: usize, m: usize, x: f64) -> f64 {
    let factorial = |n: usize| (1..=n).map(|i| i as f64).product::<f64>();
    let polynomial: f64 = (0..=(l - m) / 2)
        .map(|k| {
            let power = l - m - 2 * k;
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            sign * factorial(2 * l - 2 * k) * x.powi(power as i32)
                / (factorial(k) * factorial(l - k) * factorial(power))
        })
        .sum();
    let legendre = (1.0 - x * x).max(0.0).powf(m as f64 / 2.0) * polynomial / 2f64.powi(l as i32);
    let both = if m > 0 { 2.0 } else { 1.0 };
    let share = (2 * l + 1) as f64 / (4.0 * PI) * factorial(l - m) / factorial(l + m);
    (both * share).sqrt() * legendre
}
