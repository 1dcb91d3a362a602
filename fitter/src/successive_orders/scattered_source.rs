//! Light scattered towards the observer at one node of a ray, for many suns at once.

use super::moments::{
    COUNT, DEGREES, Moments, ORDERS, SOLAR_UNITS, SUNS, TENSOR, azimuth_harmonics, order_start,
    polar_harmonics, sun_taps,
};
use super::ray_points::Node;
use super::spectra::{NW, PER_SPHERE, Spectrum};
use super::spectral_medium::Medium;

/// Intensity and linear polarisation per wavelength, against (e1, e2): e1 in the vertical plane of the ray, e2
/// horizontal.
pub type Stokes = [Spectrum; 3];
/// No light.
pub const DARK: Stokes = [[0.0; NW]; 3];

/// A sun as the observer sees it; azimuths are the ray's minus the sun's.
#[derive(Clone, Copy)]
pub struct Sun {
    /// Cosine and sine of the elevation.
    pub elevation: (f64, f64),
    /// Cosine and sine of the ray's azimuth relative to the sun's.
    pub azimuth: (f64, f64),
}

/// The sun in the local frame of a point on the ray.
pub struct LocalSun {
    /// Sine of its elevation.
    pub mu: f64,
    cos_azimuth: f32,
    sin_azimuth: f32,
}

impl Sun {
    /// Cosine of the angle between the sun and a view ray of zenith cosine `mu`.
    pub fn cosine(&self, mu: f64) -> f32 {
        let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let cosine = sine * self.elevation.0 * self.azimuth.0 + mu * self.elevation.1;
        cosine.clamp(-1.0, 1.0) as f32
    }

    /// Seen from a node further along the ray.
    pub fn at(&self, node: &Node) -> LocalSun {
        let ((ce, se), (ca, sa)) = (self.elevation, self.azimuth);
        let (arc_cos, arc_sin) = node.arc;
        let ahead = arc_cos * ce * ca - arc_sin * se;
        let across = ce * sa;
        let length = (ahead * ahead + across * across).sqrt();
        let (cos, sin) = if length > 1e-9 {
            (ahead / length, across / length)
        } else {
            (1.0, 0.0)
        };
        LocalSun {
            mu: (arc_sin * ce * ca + arc_cos * se).clamp(-1.0, 1.0),
            cos_azimuth: cos as f32,
            sin_azimuth: sin as f32,
        }
    }
}

const AZIMUTHAL: usize = ORDERS + 1;
const ROW: usize = TENSOR + AZIMUTHAL;

/// What one sun node scatters towards the observer: tensor components, then azimuthal orders, each over wavelength;
/// flat, so that interpolation is one loop.
type Row = [f32; ROW * NW];

/// The source function of multiply scattered light at a node, contracted to what depends on the sun alone.
pub struct SourceTable {
    rows: Vec<Row>,
    cos_zenith: f32,
    sin_zenith: f32,
}

impl SourceTable {
    /// Contracts `moments` at `node` over degree and altitude.
    pub fn new(medium: &Medium, moments: &Moments, node: &Node) -> Self {
        let profiles = medium.profiles(node.altitude);
        let (rayleigh, legendre) = local_coefficients(medium, &profiles);
        let polar = polar_harmonics(node.cos_zenith);
        let mut kernel = [[0.0; NW]; COUNT];
        for (i, k) in kernel.iter_mut().enumerate() {
            *k = match i.checked_sub(TENSOR) {
                None => rayleigh,
                Some(i) => std::array::from_fn(|w| polar[i] * legendre[DEGREES[i]][w]),
            };
        }
        let mut rows = vec![[0.0; ROW * NW]; SUNS];
        for (i, share) in moments.altitude_stencil(node.altitude).taps() {
            let kernel = kernel.map(|k| k.map(|v| share as f32 * v));
            for (j, row) in rows.iter_mut().enumerate() {
                contract(moments.node(i, j), &kernel, row);
            }
        }
        let c = node.cos_zenith;
        Self {
            rows,
            cos_zenith: c as f32,
            sin_zenith: ((1.0 - c) * (1.0 + c)).max(0.0).sqrt() as f32,
        }
    }

    /// Adds what comes to the observer of the light that is scattered at `node`, of which the table is.
    pub fn add(&self, medium: &Medium, sun: &LocalSun, node: &Node, out: &mut Stokes) {
        let row = self.at_sun(sun.mu);
        let (ct, st) = (self.cos_zenith, self.sin_zenith);
        let (cp, sp) = (sun.cos_azimuth, sun.sin_azimuth);
        let along = [
            ct * ct * cp * cp,
            ct * ct * sp * sp,
            st * st,
            -2.0 * st * ct * cp,
        ];
        let across = [sp * sp, cp * cp, 0.0, 0.0];
        let mixed = [-2.0 * ct * sp * cp, 2.0 * ct * sp * cp, 0.0, 2.0 * st * sp];
        let cosines = azimuth_harmonics(cp);
        let spectrum = |i: usize| -> &Spectrum { row[i * NW..][..NW].try_into().expect("a row") };
        let (mut intensity, mut q, mut u, mut trace) = ([0.0; NW], [0.0; NW], [0.0; NW], [0.0; NW]);
        for t in 0..TENSOR {
            add_scaled(&mut intensity, along[t] + across[t], spectrum(t));
            add_scaled(&mut q, along[t] - across[t], spectrum(t));
            add_scaled(&mut u, mixed[t], spectrum(t));
            add_scaled(&mut trace, if t < 3 { 1.0 } else { 0.0 }, spectrum(t));
        }
        let mut aerosol = [0.0; NW];
        for (m, c) in cosines.into_iter().enumerate() {
            add_scaled(&mut aerosol, c, spectrum(TENSOR + m));
        }
        let weight = node.weight.map(|v| v * SOLAR_UNITS.recip());
        for w in 0..NW {
            let dipole = 1.5 * medium.polarising[w];
            let isotropic = (1.0 - medium.polarising[w]) * trace[w];
            out[0][w] += weight[w] * (dipole * intensity[w] + isotropic + aerosol[w]).max(0.0);
            let polarised = weight[w] * node.kept_polarised[w] * dipole;
            out[1][w] += polarised * q[w];
            out[2][w] += polarised * u[w];
        }
    }

    fn at_sun(&self, mu: f64) -> Row {
        let (index, weight) = sun_taps(mu);
        let [a, b, c, d] = index.map(|j| &self.rows[j]);
        let mut row = [0.0; ROW * NW];
        for i in 0..ROW * NW {
            row[i] = weight[0] * a[i] + weight[1] * b[i] + weight[2] * c[i] + weight[3] * d[i];
        }
        row
    }
}

/// Sums moments times kernel over degree, for each tensor component and azimuthal order.
fn contract(moments: &[Spectrum; COUNT], kernel: &[Spectrum; COUNT], row: &mut Row) {
    let mut rows = row.chunks_exact_mut(NW);
    let mut add = |terms: std::ops::Range<usize>| {
        let out = rows.next().expect("a row per component");
        let mut sum: Spectrum = [0.0; NW];
        for i in terms {
            multiply_add(&mut sum, &moments[i], &kernel[i]);
        }
        for (o, s) in out.iter_mut().zip(sum) {
            *o += s;
        }
    };
    for t in 0..TENSOR {
        add(t..t + 1);
    }
    for m in 0..AZIMUTHAL {
        add(TENSOR + order_start(m)..TENSOR + order_start(m + 1));
    }
}

#[inline(always)]
fn add_scaled(sum: &mut Spectrum, factor: f32, term: &Spectrum) {
    for w in 0..NW {
        sum[w] += factor * term[w];
    }
}

#[inline(always)]
fn multiply_add(sum: &mut Spectrum, a: &Spectrum, b: &Spectrum) {
    for w in 0..NW {
        sum[w] += a[w] * b[w];
    }
}

/// Rayleigh scattering coefficient per steradian, and Σ scattering·g^l for each degree.
fn local_coefficients(medium: &Medium, profiles: &[f32]) -> (Spectrum, Vec<Spectrum>) {
    let mut rayleigh = [0.0; NW];
    let mut legendre = vec![[0.0; NW]; super::spectra::DEGREE + 1];
    for (part, p) in medium.parts.iter().zip(profiles) {
        for (sum, scattering) in rayleigh.iter_mut().zip(&part.rayleigh) {
            *sum += p * scattering * PER_SPHERE;
        }
        for (sum, term) in legendre.iter_mut().zip(&part.legendre) {
            for w in 0..NW {
                sum[w] += p * term[w];
            }
        }
    }
    (rayleigh, legendre)
}
