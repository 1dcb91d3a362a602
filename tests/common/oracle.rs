//! The format specification, section 7, once more: slow, in f64, straight from the bytes of the file, and without a
//! line of the library.

mod aerial;
mod estimate;
mod spectrum;

use std::f64::consts::{FRAC_PI_2, PI};

pub struct Oracle<'a> {
    file: &'a [u8],
    n: Counts,
    at: Offsets,
}

struct Counts {
    chunks: usize,
    w: usize,
    a: usize,
    v: usize,
    f: usize,
    k: usize,
    u: usize,
    d: usize,
    p: usize,
    e: usize,
    s: usize,
}

struct Offsets {
    wavelength: usize,
    altitude: usize,
    visibility: usize,
    extinction: usize,
    spherical: usize,
    parameter: usize,
    xyz: usize,
    solar_axis: usize,
    solar: usize,
    field: usize,
    directory: usize,
}

pub struct Query {
    pub altitude: f64,
    pub visibility: f64,
    pub albedo: f64,
    pub solar_elevation: f64,
    pub direction: [f64; 3],
    pub solar_azimuth: f64,
}

impl<'a> Oracle<'a> {
    pub fn new(file: &'a [u8]) -> Self {
        let u16 = |at: usize| u16::from_le_bytes(file[at..at + 2].try_into().unwrap()) as usize;
        let u32 = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        let n = Counts {
            chunks: u32(36),
            w: u16(40),
            a: u16(42),
            v: u16(44),
            f: u16(46),
            k: u16(48),
            u: u16(50),
            d: u16(52),
            p: u16(54),
            e: u16(56),
            s: u16(58),
        };
        let mut next = 128;
        let mut place = |bytes: usize| {
            next += bytes;
            next - bytes
        };
        let at = Offsets {
            wavelength: place(8 * n.w),
            altitude: place(8 * n.a),
            visibility: place(8 * n.v),
            extinction: place(8 * n.v * n.k * n.w),
            spherical: place(8 * n.v * n.w),
            parameter: place(8 * n.f * n.w),
            xyz: place(24 * n.w),
            solar_axis: place(16),
            solar: place(4 * n.s),
            field: place(4 * n.f),
            directory: (place(u32(60)) + u32(60)).next_multiple_of(8),
        };
        Self { file, n, at }
    }

    fn f64(&self, at: usize, i: usize) -> f64 {
        f64::from_le_bytes(self.file[at + 8 * i..][..8].try_into().unwrap())
    }

    fn f32(&self, at: usize, i: usize) -> f64 {
        f32::from_le_bytes(self.file[at + 4 * i..][..4].try_into().unwrap()).into()
    }

    fn f16(&self, at: usize, i: usize) -> f64 {
        let bits = u16::from_le_bytes(self.file[at + 2 * i..][..2].try_into().unwrap());
        let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
        let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023) / 1024.0);
        sign * match exponent {
            0 => fraction * 2f64.powi(-14),
            _ => (1.0 + fraction) * 2f64.powi(exponent - 15),
        }
    }

    fn axis(&self, at: usize, n: usize, map: fn(f64) -> f64) -> Vec<f64> {
        (0..n).map(|i| map(self.f64(at, i))).collect()
    }

    /// Offset and rank of a chunk; 65535 stands for no index.
    fn chunk(&self, kind: u32, altitude: usize, visibility: usize) -> (usize, usize) {
        self.find(kind, altitude, visibility).unwrap()
    }

    /// The same, if it is there.
    fn find(&self, kind: u32, altitude: usize, visibility: usize) -> Option<(usize, usize)> {
        (0..self.n.chunks)
            .map(|i| &self.file[self.at.directory + 64 * i..][..64])
            .find(|e| {
                u32::from_le_bytes(e[0..4].try_into().unwrap()) == kind
                    && usize::from(u16::from_le_bytes(e[4..6].try_into().unwrap())) == altitude
                    && usize::from(u16::from_le_bytes(e[6..8].try_into().unwrap())) == visibility
            })
            .map(|e| {
                let offset = u64::from_le_bytes(e[8..16].try_into().unwrap());
                let rank = u32::from_le_bytes(e[40..44].try_into().unwrap());
                (offset as usize, rank as usize)
            })
    }

    /// Relative radiance at every wavelength.
    pub fn radiance(&self, q: &Query) -> Vec<f64> {
        self.light(q, false)
            .into_iter()
            .map(|[l, _, _]| l)
            .collect()
    }

    /// Transmittance over a distance from the observer, by brute force.
    pub fn transmittance(&self, q: &Query, distance: f64) -> Vec<f64> {
        let n = &self.n;
        let columns = self.columns(q, distance);
        let visibility = self.visibilities(q);
        let depth = |w: usize| -> f64 {
            (0..n.k)
                .map(|k| {
                    let row = |m: usize| (m * n.k + k) * n.w + w;
                    let extinction = visibility.iter();
                    let extinction =
                        extinction.map(|&(m, t)| t * self.f64(self.at.extinction, row(m)));
                    columns[k] * extinction.sum::<f64>()
                })
                .sum()
        };
        (0..n.w).map(|w| (-depth(w)).exp()).collect()
    }

    /// Weights of the visibilities, linear in 1/V.
    fn visibilities(&self, q: &Query) -> Vec<(usize, f64)> {
        let inverses = self.axis(self.at.visibility, self.n.v, f64::recip);
        piecewise(&inverses, 1.0 / q.visibility)
    }

    /// Columns of the constituents over a distance from the observer, by brute force.
    fn columns(&self, q: &Query, distance: f64) -> Vec<f64> {
        const STEPS: usize = 100_000;
        let n = &self.n;
        let radius = self.f64(64, 0);
        let length = q.direction.iter().map(|v| v * v).sum::<f64>().sqrt();
        let mu = q.direction[2] / length;
        let (at, _) = self.chunk(4, 65535, 65535);
        let step = distance / STEPS as f64;
        let mut columns = vec![0.0; n.k];
        for i in 0..STEPS {
            let s = (i as f64 + 0.5) * step;
            let r = radius + q.altitude;
            let altitude = (r * r + s * s + 2.0 * r * s * mu).sqrt() - radius;
            for (k, column) in columns.iter_mut().enumerate() {
                *column += step * self.density(at, altitude, k);
            }
        }
        columns
    }

    /// Profile of a constituent from the chunk of densities at `at`.
    fn density(&self, at: usize, altitude: f64, k: usize) -> f64 {
        let layers = u32::from_le_bytes(self.file[at..at + 4].try_into().unwrap()) as usize;
        let w = |h: f64| h + h * h / (2.0 * self.f64(64, 0));
        let edge = |i: usize| self.f64(at + 8, i);
        if altitude > edge(layers) {
            return 0.0;
        }
        let i = (0..layers)
            .rev()
            .find(|&i| edge(i) <= altitude)
            .unwrap_or(0);
        let (bottom, top) = (w(edge(i)), w(edge(i + 1)));
        let t = ((w(altitude) - bottom) / (top - bottom)).max(0.0);
        let d = |j: usize| self.f32(at + 8 + 8 * (layers + 1), (2 * i + j) * self.n.k + k);
        (1.0 - t).powi(2) * d(0) + 2.0 * t * (1.0 - t) * d(1) + t * t * d(2)
    }

    /// L, Q and U at every wavelength, in the vertical frame.
    pub fn stokes(&self, q: &Query) -> Vec<[f64; 3]> {
        self.light(q, true)
    }

    fn light(&self, q: &Query, polarised: bool) -> Vec<[f64; 3]> {
        let n = &self.n;
        let (radius, top) = (self.f64(64, 0), self.f64(72, 0));
        let r = radius + q.altitude;
        let [x, y, z] = q.direction;
        let length = (x * x + y * y + z * z).sqrt();
        let elevation = (z / length).asin();
        let dip = (radius / r).acos();
        let delta = elevation + dip;
        let up = delta >= 0.0;
        let u = if up {
            n.u as f64 * (delta / (FRAC_PI_2 + dip)).powf(1.0 / self.f64(80, 0))
        } else {
            n.d as f64 * (-delta / (FRAC_PI_2 - dip)).powf(1.0 / self.f64(88, 0))
        };
        let intervals = if up { n.u } else { n.d };
        let alpha = free(u, intervals);
        let phi = if x == 0.0 && y == 0.0 {
            0.0
        } else {
            y.atan2(x) - q.solar_azimuth
        };
        let fade = fade(q.solar_elevation.cos());
        let azimuth = faded(mirrored(n.p as f64 * phi.cos().acos() / PI, n.p), n.p, fade);
        let sun = [
            q.solar_elevation.cos() * q.solar_azimuth.cos(),
            q.solar_elevation.cos() * q.solar_azimuth.sin(),
            q.solar_elevation.sin(),
        ];
        let view = [x, y, z].map(|v| v / length);
        let cosine: f64 = view.iter().zip(sun).map(|(a, b)| a * b).sum();
        let [e1, e2] = vertical_frame(view, q.solar_azimuth);
        // Light that was scattered once is polarised along the normal of the scattering plane.
        let normal = cross(view, sun);
        let along = [dot(normal, e1), dot(normal, e2)];
        let g = |e: f64| ((e - self.f64(112, 0)) / self.f64(120, 0)).asinh();
        let (low, high) = (g(self.f64(96, 0)), g(self.f64(104, 0)));
        let e = free(
            n.e as f64 * (g(q.solar_elevation) - low) / (high - low),
            n.e,
        );

        let cube_roots = self.axis(self.at.altitude, n.a, f64::cbrt);
        let inverses = self.axis(self.at.visibility, n.v, f64::recip);
        let a = hermite(&cube_roots, q.altitude.cbrt());
        let b = hermite(&inverses, 1.0 / q.visibility);
        let bl = piecewise(&inverses, 1.0 / q.visibility);

        let mu = z / length;
        let d = if up {
            let c = (top - q.altitude) * (2.0 * radius + top + q.altitude);
            -r * mu + ((r * mu).powi(2) + c).sqrt()
        } else {
            let c = q.altitude * (2.0 * radius + q.altitude);
            -r * mu - ((r * mu).powi(2) - c).max(0.0).sqrt()
        };
        let row = if up { 0 } else { n.u + 3 };
        let estimates = self.estimates(q);
        let density: Vec<f64> = (0..n.k)
            .filter(|_| estimates.is_none())
            .map(|k| {
                let mut sum = 0.0;
                for &(j, aj) in &a {
                    let (at, _) = self.chunk(2, j, 65535);
                    for &(i, w) in &alpha {
                        sum += aj * w * self.f32(at, (row + i) * n.k + k);
                    }
                }
                sum.exp()
            })
            .collect();
        let at_visibility = |at: usize, stride: usize, i: usize| -> f64 {
            bl.iter()
                .map(|&(m, w)| w * self.f64(at, m * stride + i))
                .sum()
        };
        (0..n.w)
            .map(|w| {
                let constituents = 0..density.len();
                let depth: f64 = constituents
                    .clone()
                    .map(|k| density[k] * at_visibility(self.at.extinction, n.k * n.w, k * n.w + w))
                    .sum::<f64>()
                    * d;
                let absorbers = u32::from_le_bytes(self.file[12..16].try_into().unwrap()) >> 16;
                let scattering: f64 = constituents
                    .filter(|k| absorbers >> k & 1 == 0)
                    .map(|k| density[k] * at_visibility(self.at.extinction, n.k * n.w, k * n.w + w))
                    .sum::<f64>()
                    * d;
                let mut s = 0.0;
                for &(j, aj) in &a {
                    for &(m, bm) in &b {
                        if estimates.is_none() {
                            s += aj * bm * self.level(j, m, &e, w);
                        }
                    }
                }
                let spherical = at_visibility(self.at.spherical, n.w, w);
                let (mut total, mut dipole) = (0.0, 0.0);
                let ground = q.albedo / (1.0 - q.albedo * spherical);
                for f in 0..n.f {
                    let mut value = 0.0;
                    for &(j, aj) in &a {
                        for &(m, bm) in &b {
                            value +=
                                aj * bm * self.factors(j, m, up, &alpha, &azimuth, &e, f * n.w + w);
                        }
                    }
                    let code = u32::from_le_bytes(
                        self.file[self.at.field + 4 * f..][..4].try_into().unwrap(),
                    );
                    let parameter = self.f64(self.at.parameter, f * n.w + w);
                    if let Some(estimates) = &estimates {
                        value *= estimates[(code >> 24) as usize][w];
                    }
                    if code >> 16 & 1 == 1 {
                        value *= ground;
                    }
                    if code & 0xffff == 1 {
                        dipole += 0.75 * (1.0 - parameter) / (1.0 + parameter / 2.0) * value;
                    }
                    total += value * phase(code & 0xffff, parameter, cosine);
                }
                let (outside, diffuse) = match &estimates {
                    Some(estimates) => (1.0, estimates[estimates.len() - 1][w]),
                    None => {
                        let opacity = -(-depth).exp_m1() * scattering / depth.max(1e-300);
                        (opacity * s.exp(), 1.0)
                    }
                };
                let light = outside * total.max(0.0);
                if !polarised {
                    return [light, 0.0, 0.0];
                }
                let multiple = [0, 1, 2, 3].map(|part| {
                    let mut value = 0.0;
                    for &(j, aj) in &a {
                        for &(m, bm) in &b {
                            let taps = [&alpha, &azimuth, &e].map(|t| t.as_slice());
                            value += aj * bm * self.polarisation(j, m, up, taps, part * n.w + w);
                        }
                    }
                    value * diffuse
                });
                let q = dipole * (along[0].powi(2) - along[1].powi(2));
                let u = dipole * 2.0 * along[0] * along[1];
                let q = outside * (q + multiple[0] + ground * multiple[2]);
                let u = outside * (u + fade * phi.sin() * (multiple[1] + ground * multiple[3]));
                let share = (light / q.hypot(u)).min(1.0);
                [light, share * q, share * u]
            })
            .collect()
    }

    fn polarisation(
        &self,
        altitude: usize,
        visibility: usize,
        up: bool,
        [alpha, phi, e]: [&[(usize, f64)]; 3],
        channel: usize,
    ) -> f64 {
        let n = &self.n;
        let (at, rank) = self.chunk(6, altitude, visibility);
        let (basis, _) = self.chunk(7, 65535, 65535);
        let q = rank.div_ceil(16) * 16;
        let c = (4 * n.w).div_ceil(16) * 16;
        let up_at = at + 4 * q;
        let down_at = up_at + 2 * q * (n.u + 3);
        let e_at = down_at + 2 * q * (n.d + 3);
        let channel_at = basis + 2 * q * (n.p + 1);
        let along = |at: usize, taps: &[(usize, f64)], r: usize| -> f64 {
            taps.iter().map(|&(i, w)| w * self.f16(at, i * q + r)).sum()
        };
        (0..rank)
            .map(|r| {
                self.f32(at, r)
                    * along(if up { up_at } else { down_at }, alpha, r)
                    * along(basis, phi, r)
                    * along(e_at, e, r)
                    * self.f16(channel_at, r * c + channel)
            })
            .sum()
    }

    #[allow(clippy::too_many_arguments)]
    fn factors(
        &self,
        altitude: usize,
        visibility: usize,
        up: bool,
        alpha: &[(usize, f64)],
        phi: &[(usize, f64)],
        e: &[(usize, f64)],
        channel: usize,
    ) -> f64 {
        let n = &self.n;
        let (at, rank) = self.chunk(1, altitude, visibility);
        let (basis, basis_rank) = self.chunk(3, 65535, 65535);
        let pad = |n: usize| n.div_ceil(16) * 16;
        let (q, basis_q) = (pad(rank), pad(basis_rank));
        let up_at = at + 4 * q;
        let down_at = up_at + 2 * q * (n.u + 3);
        let e_at = down_at + 2 * q * (n.d + 3);
        let channel_at = basis + 2 * basis_q * (n.p + 1);
        let along = |at: usize, taps: &[(usize, f64)], q: usize, r: usize| -> f64 {
            taps.iter().map(|&(i, w)| w * self.f16(at, i * q + r)).sum()
        };
        (0..rank)
            .map(|r| {
                self.f32(at, r)
                    * along(if up { up_at } else { down_at }, alpha, q, r)
                    * along(basis, phi, basis_q, r)
                    * along(e_at, e, q, r)
                    * self.f16(channel_at, r * pad(n.f * n.w) + channel)
            })
            .sum()
    }

    /// ln S of a chunk.
    fn level(&self, altitude: usize, visibility: usize, e: &[(usize, f64)], w: usize) -> f64 {
        let n = &self.n;
        let (at, rank) = self.chunk(1, altitude, visibility);
        let q = rank.div_ceil(16) * 16;
        let at = at + 4 * q + 2 * q * (n.u + 3 + n.d + 3 + n.e + 3);
        let term = |&(i, t): &(usize, f64)| t * self.f16(at, i * n.w + w);
        e.iter().map(term).sum()
    }

    /// Relative radiance between wavelengths, and the solar irradiance there.
    pub fn radiance_at(&self, q: &Query, wavelength: f64) -> (f64, f64) {
        let relative = self.mixed(&self.radiance(q), wavelength);
        let x = (wavelength - self.f64(self.at.solar_axis, 0)) / self.f64(self.at.solar_axis, 1);
        let i = (x.floor() as usize).min(self.n.s - 2);
        let t = x - i as f64;
        let solar = (1.0 - t) * self.f32(self.at.solar, i) + t * self.f32(self.at.solar, i + 1);
        (relative, solar)
    }

    /// Relative L, Q and U between wavelengths.
    pub fn stokes_at(&self, q: &Query, wavelength: f64) -> [f64; 3] {
        self.mixed_stokes(&self.stokes(q), wavelength)
    }

    pub fn xyz(&self, q: &Query) -> [f64; 3] {
        let values = self.radiance(q);
        [0, 1, 2].map(|c| {
            values
                .iter()
                .enumerate()
                .map(|(w, v)| v * self.f64(self.at.xyz, 3 * w + c))
                .sum()
        })
    }
}

/// `e1` in the vertical plane, upwards, and `e2 = w × e1`.
pub fn vertical_frame(view: [f64; 3], solar_azimuth: f64) -> [[f64; 3]; 2] {
    let azimuth = if view[0] == 0.0 && view[1] == 0.0 {
        solar_azimuth
    } else {
        view[1].atan2(view[0])
    };
    let right = [azimuth.sin(), -azimuth.cos(), 0.0];
    [cross(right, view), right]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn phase(code: u32, p: f64, cosine: f64) -> f64 {
    match code {
        0 => 1.0,
        1 => {
            let delta = (1.0 - p) / (1.0 + p / 2.0);
            delta * 0.75 * (1.0 + cosine * cosine) + 1.0 - delta
        }
        _ => (1.0 - p * p) / (1.0 + p * p - 2.0 * p * cosine).powf(1.5),
    }
}

fn basis(u: f64, n: usize) -> (usize, [f64; 4]) {
    let u = u.clamp(0.0, n as f64);
    let i = (u.floor() as usize).min(n - 1);
    let t = u - i as f64;
    let w = [
        (1.0 - t).powi(3),
        3.0 * t.powi(3) - 6.0 * t * t + 4.0,
        -3.0 * t.powi(3) + 3.0 * t * t + 3.0 * t + 1.0,
        t.powi(3),
    ];
    (i, w.map(|w| w / 6.0))
}

fn free(u: f64, n: usize) -> Vec<(usize, f64)> {
    let (i, w) = basis(u, n);
    (0..4).map(|k| (i + k, w[k])).collect()
}

fn mirrored(u: f64, n: usize) -> Vec<(usize, f64)> {
    let (i, w) = basis(u, n);
    let reflect = |m: i64| match m {
        -1 => 1,
        m if m == n as i64 + 1 => n - 1,
        m => m as usize,
    };
    (0..4)
        .map(|k| (reflect((i + k) as i64 - 1), w[k]))
        .collect()
}

/// What the azimuth counts where the sun's zenith angle has this sine.
fn fade(sine: f64) -> f64 {
    let t = (20.0 * sine).min(1.0);
    t * (3.0 - t.powi(2)) / 2.0
}

/// The taps of a mirrored spline, and its mean as far as they fade.
fn faded(taps: Vec<(usize, f64)>, n: usize, fade: f64) -> Vec<(usize, f64)> {
    let mean =
        (0..2 * n as i64).map(|i| (n - (i - n as i64).unsigned_abs() as usize, 0.5 / n as f64));
    let fading = taps.into_iter().map(|(i, w)| (i, fade * w));
    let staying = mean.map(|(i, w)| (i, (1.0 - fade) * w));
    fading.chain(staying).collect()
}

fn interval(nodes: &[f64], x: f64) -> usize {
    let between = |i: &usize| (nodes[*i] - x) * (nodes[i + 1] - x) <= 0.0;
    (0..nodes.len() - 1).find(between).unwrap()
}

fn piecewise(nodes: &[f64], x: f64) -> Vec<(usize, f64)> {
    if nodes.len() == 1 {
        return vec![(0, 1.0)];
    }
    let i = interval(nodes, x);
    let t = (x - nodes[i]) / (nodes[i + 1] - nodes[i]);
    let mut weights = vec![(i, 1.0 - t), (i + 1, t)];
    weights.retain(|&(_, w)| w != 0.0);
    weights
}

/// Weights by feeding unit vectors through the textbook form of the Hermite interpolant.
fn hermite(nodes: &[f64], x: f64) -> Vec<(usize, f64)> {
    if nodes.len() <= 2 {
        return piecewise(nodes, x);
    }
    let i = interval(nodes, x);
    let step = nodes[i + 1] - nodes[i];
    let t = (x - nodes[i]) / step;
    let value = |y: &[f64]| {
        let (h00, h10) = (
            2.0 * t.powi(3) - 3.0 * t * t + 1.0,
            t.powi(3) - 2.0 * t * t + t,
        );
        let (h01, h11) = (3.0 * t * t - 2.0 * t.powi(3), t.powi(3) - t * t);
        h00 * y[i]
            + h10 * step * slope(nodes, y, i)
            + h01 * y[i + 1]
            + h11 * step * slope(nodes, y, i + 1)
    };
    let mut weights = Vec::new();
    for j in 0..nodes.len() {
        let mut unit = vec![0.0; nodes.len()];
        unit[j] = 1.0;
        let weight = value(&unit);
        if weight != 0.0 {
            weights.push((j, weight));
        }
    }
    weights
}

/// Derivative at node `k` of the Newton form of the parabola through three nodes.
fn slope(x: &[f64], y: &[f64], k: usize) -> f64 {
    let a = k.saturating_sub(1).min(x.len() - 3);
    let first = (y[a + 1] - y[a]) / (x[a + 1] - x[a]);
    let second = ((y[a + 2] - y[a + 1]) / (x[a + 2] - x[a + 1]) - first) / (x[a + 2] - x[a]);
    first + second * ((x[k] - x[a]) + (x[k] - x[a + 1]))
}
