//! Stokes vectors, Mueller matrices and their frames. All conventions of polarisation are stated here and nowhere else.
//!
//! Light is *I, Q, U*: circular polarisation is not followed.
//!
//! A [`Frame`] belongs to a direction `w` in which one **looks** (the light travels along −`w`). It has a reference
//! axis `e1` ⟂ `w` and `e2 = w × e1`. A polariser turned by ψ from `e1` towards `e2` passes ½(I + Q cos 2ψ + U sin 2ψ):
//! Q is what passes along `e1` less what passes along `e2`; U what passes along the diagonal `e1 + e2` less that along
//! `e1 − e2`.
//!
//! At the **observer** `e1` lies in the vertical plane and points up, `e2` points to the right. Under a mirror about
//! the sun's vertical plane Q is even and U is odd.
//!
//! **Scattering** from the looked-at direction `w'` into `w` (as seen backwards) uses the scattering plane's normal `n
//! = w × w' / |w × w'|` as `e2` of both frames, so Q is parallel minus perpendicular to the scattering plane, and the
//! matrix is `F11 F12 0 / F12 F22 0 / 0 0 F33` with mean F11 over the sphere 1.
//!
//! Particles as large as the wavelength turn some U into V and back (F34). That takes two such scatterings of light
//! already polarised, so V is left out for them, too.
//!
//! The walk runs from the observer to the sun and so keeps the *product* of all Mueller matrices met so far
//! ([`Mueller`]), which maps Stokes vectors in the walk's present frame to Stokes vectors in the observer's frame.

use glam::DVec3;

/// A direction of view with its polarisation axes: an orthonormal triple with `e2 = w × e1`.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Direction of view.
    pub w: DVec3,
    /// Axis of positive Q.
    pub e1: DVec3,
    /// `w × e1`.
    pub e2: DVec3,
}

impl Frame {
    /// The observer's frame; z is up, the sun's azimuth is 0 along x.
    pub fn observer(zenith: f64, azimuth: f64) -> Self {
        let ((st, ct), (sa, ca)) = (zenith.sin_cos(), azimuth.sin_cos());
        let w = DVec3::new(st * ca, st * sa, ct);
        let e1 = DVec3::new(-ct * ca, -ct * sa, st);
        Self {
            w,
            e1,
            e2: w.cross(e1),
        }
    }

    /// Some frame around a unit vector.
    pub fn around(w: DVec3) -> Self {
        let e1 = w.any_orthonormal_vector();
        Self {
            w,
            e1,
            e2: w.cross(e1),
        }
    }

    /// The same direction with `e1` turned by α (as cosine and sine) towards `e2`.
    pub fn turned(&self, (cos, sin): (f64, f64)) -> Self {
        Self {
            w: self.w,
            e1: cos * self.e1 + sin * self.e2,
            e2: cos * self.e2 - sin * self.e1,
        }
    }

    /// The direction at angle θ from `w` in the plane of `w` and `e1`, with the axes carried along.
    pub fn bent(&self, cos: f64) -> Self {
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        Self {
            w: cos * self.w + sin * self.e1,
            e1: cos * self.e1 - sin * self.w,
            e2: self.e2,
        }
    }

    /// Cosine and sine of the angle that turns `e1` into the plane of `w` and `target`.
    pub fn angle_to(&self, target: DVec3) -> (f64, f64) {
        let (x, y) = (self.e1.dot(target), self.e2.dot(target));
        let length = x.hypot(y);
        if length < 1e-12 {
            (1.0, 0.0)
        } else {
            (x / length, y / length)
        }
    }

    /// Removes the rounding errors that many turns gather.
    pub fn orthonormalised(self) -> Self {
        let w = self.w.normalize();
        let e1 = (self.e1 - w * w.dot(self.e1)).normalize();
        Self {
            w,
            e1,
            e2: w.cross(e1),
        }
    }
}

/// The elements of a scattering matrix that act on I, Q, U, per wavelength.
#[derive(Clone, Copy, Debug)]
pub struct Scattering<const N: usize> {
    /// I to I.
    pub f11: [f64; N],
    /// I to Q and Q to I.
    pub f12: [f64; N],
    /// Q to Q.
    pub f22: [f64; N],
    /// U to U.
    pub f33: [f64; N],
}

impl<const N: usize> Scattering<N> {
    /// No scattering.
    pub const ZERO: Self = Self {
        f11: [0.0; N],
        f12: [0.0; N],
        f22: [0.0; N],
        f33: [0.0; N],
    };
}

/// A product of Mueller matrices per wavelength: `m[row][column][wavelength]`.
#[derive(Clone, Copy, Debug)]
pub struct Mueller<const N: usize>(pub [[[f64; N]; 3]; 3]);

impl<const N: usize> Mueller<N> {
    /// Identity.
    pub fn identity() -> Self {
        let mut m = [[[0.0; N]; 3]; 3];
        for (i, row) in m.iter_mut().enumerate() {
            row[i] = [1.0; N];
        }
        Self(m)
    }

    /// Everything times a factor per wavelength.
    pub fn scale(&mut self, factor: &[f64; N]) {
        for element in self.0.iter_mut().flatten() {
            for (e, f) in element.iter_mut().zip(factor) {
                *e *= f;
            }
        }
    }

    /// Changes the frame of the right side: afterwards it takes Stokes vectors whose `e1` is turned by α (cosine,
    /// sine).
    pub fn turn(&mut self, (cos, sin): (f64, f64)) {
        let (c2, s2) = (cos * cos - sin * sin, 2.0 * sin * cos);
        for row in &mut self.0 {
            for w in 0..N {
                let (q, u) = (row[1][w], row[2][w]);
                row[1][w] = c2 * q + s2 * u;
                row[2][w] = c2 * u - s2 * q;
            }
        }
    }

    /// Multiplies by a scattering matrix in the scattering plane.
    pub fn scatter(&mut self, f: &Scattering<N>) {
        for row in &mut self.0 {
            for w in 0..N {
                let (i, q) = (row[0][w], row[1][w]);
                row[0][w] = i * f.f11[w] + q * f.f12[w];
                row[1][w] = i * f.f12[w] + q * f.f22[w];
                row[2][w] *= f.f33[w];
            }
        }
    }

    /// Forgets polarisation, as a Lambertian ground does.
    pub fn depolarise(&mut self) {
        for row in &mut self.0 {
            row[1] = [0.0; N];
            row[2] = [0.0; N];
        }
    }

    /// Stokes vector at the observer of natural light that is scattered once more, in the plane at angle α (cosine,
    /// sine).
    pub fn natural(&self, (cos, sin): (f64, f64), f: &Scattering<N>) -> [[f64; N]; 3] {
        let (c2, s2) = (cos * cos - sin * sin, 2.0 * sin * cos);
        self.0.map(|row| {
            std::array::from_fn(|w| {
                row[0][w] * f.f11[w] + (c2 * row[1][w] + s2 * row[2][w]) * f.f12[w]
            })
        })
    }

    /// Largest response of I to natural light over the wavelengths.
    pub fn strength(&self) -> f64 {
        self.0[0][0].iter().fold(0.0, |a, b| a.max(b.abs()))
    }
}
