//! Section 7.2: the estimates that fields are relative to.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Oracle, Query, cross, dot};

const SUN: f64 = 0.004654793;

/// Where the tables of an estimate chunk stand, and how long they are.
struct Tables {
    levels: usize,
    angles: usize,
    suns: usize,
    densities: usize,
    rings: usize,
    estimates: usize,
    axis: [f64; 2],
    level: usize,
    ring: usize,
    scatters: usize,
    albedo: usize,
    density: usize,
    column: usize,
    light: usize,
    stride: usize,
}

/// What is at a stop.
struct Stop {
    distance: f64,
    altitude: f64,
    rise: f64,
    to_sun: Vec<f64>,
    light: Vec<f64>,
}

impl Oracle<'_> {
    fn estimate_tables(&self) -> Option<Tables> {
        let at = self.find(10, 65535, 65535)?.0;
        let count = |i: usize| {
            u32::from_le_bytes(self.file[at + 4 * i..][..4].try_into().unwrap()) as usize
        };
        let [levels, angles, suns, densities, rings, estimates] = [0, 1, 2, 3, 4, 5].map(count);
        let stride = self.n.w.next_multiple_of(8);
        let mut next = at + 32;
        let mut place = |numbers: usize| {
            next += 4 * numbers;
            next - 4 * numbers
        };
        Some(Tables {
            levels,
            angles,
            suns,
            densities,
            rings,
            estimates,
            axis: [6, 7].map(|i| self.f32(at, i)),
            level: place(levels),
            ring: place(rings),
            scatters: place(estimates),
            albedo: place(estimates * self.n.k * stride),
            density: place(8 * densities),
            column: place(8 * levels * angles),
            light: place(levels * suns * stride),
            stride,
        })
    }

    /// The estimates in a direction, `[estimate][wavelength]`; none in a file without.
    pub fn estimates(&self, q: &Query) -> Option<Vec<Vec<f64>>> {
        let t = self.estimate_tables()?;
        let radius = self.f64(64, 0);
        let length = dot(q.direction, q.direction).sqrt();
        let view = q.direction.map(|v| v / length);
        let (se, ce) = q.solar_elevation.sin_cos();
        let (sa, ca) = q.solar_azimuth.sin_cos();
        let sun = [ce * ca, ce * sa, se];
        let stops = self.stops(&t, q.altitude, view, sun, radius);
        let columns = self.columns_between(&t, &stops, q.altitude, view[2], radius);
        let visibility = self.visibilities(q);
        let extinction = |k: usize, w: usize| -> f64 {
            let row = |m: usize| (m * self.n.k + k) * self.n.w + w;
            let parts = visibility.iter();
            parts
                .map(|&(m, s)| s * self.f64(self.at.extinction, row(m)))
                .sum()
        };
        let last = t.estimates - 1;
        let mut out = vec![vec![0.0; self.n.w]; t.estimates];
        for w in 0..self.n.w {
            let k: Vec<f64> = (0..self.n.k).map(|k| extinction(k, w)).collect();
            let mut so_far = vec![0.0; self.n.k];
            let depths = |so_far: &[f64], stop: &Stop| -> [f64; 2] {
                let view: f64 = k.iter().zip(so_far).map(|(k, c)| k * c).sum();
                let sun: f64 = k.iter().zip(&stop.to_sun).map(|(k, c)| k * c).sum();
                [view + sun, view - stop.light[w]]
            };
            let mut near = depths(&so_far, &stops[0]);
            for (pair, panel) in stops.windows(2).zip(&columns) {
                so_far.iter_mut().zip(panel).for_each(|(sum, c)| *sum += c);
                let far = depths(&so_far, &pair[1]);
                let fall = (pair[1].altitude - pair[0].altitude) / 8000.0;
                let once = visible_share(pair[0].rise, pair[1].rise, fall) * mean(near[0], far[0]);
                let again = mean(near[1], far[1]);
                for (e, row) in out.iter_mut().enumerate() {
                    let scatters = self.file[t.scatters + 4 * e];
                    let part = |c: usize| {
                        let albedo = self.f32(t.albedo, (e * self.n.k + c) * t.stride + w);
                        albedo * k[c] * panel[c]
                    };
                    let scattered: f64 = (0..self.n.k)
                        .filter(|c| scatters >> c & 1 == 1)
                        .map(part)
                        .sum();
                    row[w] += scattered * if e == last { again } else { once / (4.0 * PI) };
                }
                near = far;
            }
            for e in 0..last {
                out[e][w] += 1e-3 * out[last][w];
            }
        }
        Some(out)
    }

    fn stops(
        &self,
        t: &Tables,
        altitude: f64,
        view: [f64; 3],
        sun: [f64; 3],
        radius: f64,
    ) -> Vec<Stop> {
        let r = radius + altitude;
        let (mu, top) = (view[2], self.f64(72, 0));
        let dip = (radius / r).acos();
        let up = mu.asin() + dip >= 0.0;
        // Both distances at which the ray passes an altitude.
        let passes = |z: f64| {
            let square = (r * mu).powi(2) - (altitude - z) * (2.0 * radius + altitude + z);
            let root = square.sqrt();
            [-r * mu - root, -r * mu + root]
        };
        let end = match up {
            true => passes(top)[1],
            false if altitude == 0.0 => 0.0,
            false => passes(0.0)[0],
        };
        let mut at = vec![0.0, end];
        for l in 1..t.levels - 1 {
            at.extend(passes(self.f32(t.level, l)));
        }
        if up {
            at.push(-r * mu);
        }
        let (along, place) = (dot(view, sun), r * sun[2]);
        let across = cross(view, sun);
        let steep = dot(across, across);
        if steep >= 1e-9 && t.rings > 0 {
            let moved = |d: f64| {
                let d = d.min(end);
                let t = ((place + d * along) / 300e3).clamp(0.0, 1.0);
                d * (1.0 - t * t * (3.0 - 2.0 * t))
            };
            at.push(moved((place * along - r * mu) / steep));
            for i in 0..t.rings {
                let ring = radius + self.f32(t.ring, i);
                let slope = (r * mu - place * along) / steep;
                let root = (slope * slope - (r * r - place * place - ring * ring) / steep).sqrt();
                // Nowhere where there is no root.
                if root >= 0.0 {
                    at.extend([-slope - root, root - slope].map(moved));
                }
            }
        }
        at.retain(|d| (0.0..=end).contains(d));
        at.sort_by(f64::total_cmp);
        let stop = |&distance: &f64| {
            let r2 = (r * r + 2.0 * r * mu * distance + distance * distance).sqrt();
            let sine = ((place + distance * along) / r2).clamp(-1.0, 1.0);
            self.stop(t, distance, (r2 - radius).max(0.0), sine, radius)
        };
        at.iter().map(stop).collect()
    }

    fn stop(&self, t: &Tables, distance: f64, altitude: f64, sine: f64, radius: f64) -> Stop {
        let dip = (radius / (radius + altitude)).acos();
        let rise = (sine.asin() + dip) / SUN;
        let levels: Vec<f64> = (0..t.levels).map(|l| self.f32(t.level, l)).collect();
        let l = levels[1..t.levels - 1]
            .iter()
            .filter(|&&z| z <= altitude)
            .count();
        let up = ((altitude - levels[l]) / (levels[l + 1] - levels[l])).min(1.0);
        let seen = height(rise).max(0.0);
        let lerp =
            |row: &dyn Fn(usize) -> f64, (i, f): (usize, f64)| (1.0 - f) * row(i) + f * row(i + 1);
        let column = |k: usize| {
            let level = |l: usize| {
                let own = (radius / (radius + levels[l])).acos();
                let angle = seen * SUN + (own - dip) * seen / (seen + 1.0);
                let (angle, range) = (angle.max(0.0), FRAC_PI_2 + own);
                let share = angle * (range + 0.1) / (range * (angle + 0.1));
                let row = |i: usize| self.f32(t.column, (l * t.angles + i) * 8 + k);
                lerp(&row, place((t.angles - 1) as f64 * share, t.angles))
            };
            ((1.0 - up) * level(l) + up * level(l + 1)).exp()
        };
        let [lowest, width] = t.axis;
        let g = |m: f64| (m / width).asinh();
        let u = (t.suns - 1) as f64 * (g(sine) - g(lowest)) / (g(1.0) - g(lowest));
        let sun = place(u, t.suns);
        let light = |w: usize| {
            let level = |l: usize| {
                let row = |i: usize| self.f32(t.light, (l * t.suns + i) * t.stride + w);
                lerp(&row, sun)
            };
            (1.0 - up) * level(l) + up * level(l + 1)
        };
        Stop {
            distance,
            altitude,
            rise,
            to_sun: (0..self.n.k).map(column).collect(),
            light: (0..self.n.w).map(light).collect(),
        }
    }

    /// Columns of the constituents in each panel.
    fn columns_between(
        &self,
        t: &Tables,
        stops: &[Stop],
        altitude: f64,
        mu: f64,
        radius: f64,
    ) -> Vec<Vec<f64>> {
        let r = radius + altitude;
        let density = |z: f64, k: usize| {
            let last = (t.densities - 1) as f64;
            let (i, f) = place(last * (z / self.f64(72, 0)).sqrt(), t.densities);
            (1.0 - f) * self.f32(t.density, 8 * i + k) + f * self.f32(t.density, 8 * (i + 1) + k)
        };
        let panel = |pair: &[Stop]| {
            let middle = 0.5 * (pair[0].distance + pair[1].distance);
            let z = (r * r + 2.0 * r * mu * middle + middle * middle).sqrt() - radius;
            let step = pair[1].distance - pair[0].distance;
            let column = |k: usize| {
                let [a, b, c] =
                    [pair[0].altitude, z.max(0.0), pair[1].altitude].map(|z| density(z, k));
                step / 6.0 * (a + 4.0 * b + c)
            };
            (0..self.n.k).map(column).collect()
        };
        stops.windows(2).map(panel).collect()
    }
}

/// Index and rest of a coordinate on an axis of so many nodes.
fn place(coordinate: f64, nodes: usize) -> (usize, f64) {
    let u = coordinate.clamp(0.0, (nodes - 1) as f64);
    let i = (u.floor() as usize).min(nodes - 2);
    (i, u - i as f64)
}

fn mean(p: f64, q: f64) -> f64 {
    match (q - p).abs() < 1e-9 {
        true => (-p).exp(),
        false => ((-p).exp() - (-q).exp()) / (q - p),
    }
}

/// Visible share of the sun's disc.
fn share(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / PI
}

/// Height of what is seen of it.
fn height(x: f64) -> f64 {
    match x {
        x if x >= 1.0 => x,
        x if x <= -0.999 => 0.0,
        x => x + 2.0 / (3.0 * PI) * (1.0 - x * x).powf(1.5) / share(x),
    }
}

fn visible_share(a: f64, b: f64, fall: f64) -> f64 {
    if (b - a).abs() < 0.01 {
        return share(0.5 * (a + b));
    }
    let passed = |t: f64| {
        let steep = fall.abs().max(1e-3);
        let rising = |t: f64| (1.0 - (-steep * t).exp()) / (1.0 - (-steep).exp());
        if fall > 0.0 {
            rising(t)
        } else {
            1.0 - rising(1.0 - t)
        }
    };
    let sum = |x: f64| {
        let c = 1.0 - x * x;
        0.5 * x + (c.sqrt() - c.powf(1.5) / 3.0 + x * x.asin()) / PI
    };
    let [low, high] = [a, b].map(|x| x.clamp(-1.0, 1.0));
    let [p, q] = [low, high].map(|x| passed(((x - a) / (b - a)).clamp(0.0, 1.0)));
    let middle = match (high - low).abs() < 0.01 {
        true => share(0.5 * (low + high)),
        false => (sum(high) - sum(low)) / (high - low),
    };
    let start = if a >= 1.0 { p } else { 0.0 };
    let end = if b >= 1.0 { 1.0 - q } else { 0.0 };
    (start + (q - p) * middle + end).clamp(0.0, 1.0)
}
