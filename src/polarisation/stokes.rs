//! Stokes vectors of linearly polarised light.

use crate::error::Result;
use crate::kernel::math::finite;
use crate::sky::check_length;

/// Intensity and linear polarisation of light, against an axis `e1` across the view direction `w` and `e2 = w × e1`.
///
/// `w` points away from the observer, towards where the light comes from. Light of the sky has no circular
/// polarisation to speak of, so there is no fourth component.
///
/// Renderers whose frames are right-handed about the direction in which the light *travels* (x = `e1`, y = −`e2`) have
/// U of the other sign.
///
/// ```
/// use std::f32::consts::FRAC_PI_2;
/// use welkin::Stokes;
///
/// let light = Stokes { i: 2.0, q: 1.0, u: 0.0 };
/// assert_eq!((light.degree(), light.angle()), (0.5, 0.0));
/// // A polariser along `e1` passes three times as much as one across it.
/// assert_eq!(light.through_polariser(0.0), 1.5);
/// assert!((light.through_polariser(FRAC_PI_2) - 0.5).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stokes {
    /// Radiance.
    pub i: f32,
    /// What a polariser along `e1` passes less what one along `e2` passes.
    pub q: f32,
    /// What a polariser along the diagonal `e1 + e2` passes less what one along `e1 − e2` passes.
    pub u: f32,
}

/// Room for Stokes vectors as a structure of arrays of equal length, each `[directions or points][wavelengths]`, W m⁻²
/// sr⁻¹ nm⁻¹.
///
/// The components are those of [`Stokes`].
///
/// ```
/// use welkin::{Conditions, Model, PolarisationFrame, StokesSpectra};
///
/// let aerial = Model::default_model()?.aerial_perspective(&Conditions::default())?;
/// let [mut i, mut q, mut u, mut transmittance] = [(); 4].map(|()| vec![0.0; aerial.wavelengths().len()]);
/// let light = StokesSpectra { i: &mut i, q: &mut q, u: &mut u };
/// let (from, to) = ([0.0, 0.0, 2.0], [0.0, 10e3, 2.0]);
/// aerial.in_scattering_stokes(from, to, PolarisationFrame::Vertical, light, &mut transmittance)?;
/// assert!(q[6].hypot(u[6]) <= i[6]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Debug)]
pub struct StokesSpectra<'a> {
    /// Radiance.
    pub i: &'a mut [f32],
    /// Polarised along `e1` less `e2`.
    pub q: &'a mut [f32],
    /// Polarised along `e1 + e2` less `e1 − e2`.
    pub u: &'a mut [f32],
}

impl StokesSpectra<'_> {
    pub(crate) fn check(&self, expected: usize) -> Result<()> {
        let parts = [self.i.len(), self.q.len(), self.u.len()];
        parts
            .into_iter()
            .try_for_each(|got| check_length(got, expected))
    }
}

impl Stokes {
    /// Degree of linear polarisation, 0..=1; 0 without light.
    pub fn degree(&self) -> f32 {
        if self.i > 0.0 {
            ((self.q / self.i).hypot(self.u / self.i)).min(1.0)
        } else {
            0.0
        }
    }

    /// Q over I, −1..=1; 0 without light. In [`PolarisationFrame::SunAligned`](crate::PolarisationFrame::SunAligned) it
    /// is positive where the light is polarised across the plane of view and sun, as singly scattered light is, and
    /// changes its sign at the neutral points.
    pub fn signed_degree(&self) -> f32 {
        if self.i > 0.0 {
            (self.q / self.i).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    /// Angle of polarisation from `e1` towards `e2`, −π/2..=π/2 rad; 0 without polarisation.
    pub fn angle(&self) -> f32 {
        0.5 * self.u.atan2(self.q)
    }

    /// The same light against axes that are turned by `angle` (rad) from `e1` towards `e2`.
    #[must_use]
    pub fn turned(&self, angle: f32) -> Self {
        let (sine, cosine) = (2.0 * angle).sin_cos();
        Self {
            i: self.i,
            q: finite(cosine * self.q + sine * self.u),
            u: finite(cosine * self.u - sine * self.q),
        }
    }

    /// Light that is linear in something, of which `other` has a share, as far as there is light at all.
    #[inline(always)]
    pub(crate) fn towards(&self, other: &Self, share: f32) -> Self {
        let mix = |a: f32, b: f32| a + share * (b - a);
        Self {
            i: mix(self.i, other.i).max(0.0),
            q: mix(self.q, other.q),
            u: mix(self.u, other.u),
        }
    }

    /// Radiance behind an ideal polariser at `angle` (rad) from `e1` towards `e2`.
    pub fn through_polariser(&self, angle: f32) -> f32 {
        (0.5 * self.i + 0.5 * self.turned(angle).q).max(0.0)
    }
}

/// Light of the radiance `i` in which the nodes, where it is polarised as `values` are, have these shares. Format specification, section 7.5.
pub(crate) fn between(shares: &[f64], values: &[Stokes], i: f32) -> Stokes {
    let (mut q, mut u) = (0.0, 0.0);
    for (&weight, value) in shares.iter().zip(values) {
        // Nodes without light count 0.
        let share = weight as f32 / value.i.max(f32::MIN_POSITIVE);
        q += share * value.q;
        u += share * value.u;
    }
    // Weights of both signs can overshoot.
    let share = i / (q.hypot(u) * (1.0 + 4.0 * f32::EPSILON)).max(1.0);
    Stokes {
        i,
        q: q * share,
        u: u * share,
    }
}

#[cfg(test)]
mod tests {
    use super::Stokes;

    #[test]
    fn turning_changes_the_angle_and_nothing_else() {
        let light = Stokes {
            i: 2.0,
            q: 0.6,
            u: -0.8,
        };
        assert!((light.degree() - 0.5).abs() < 1e-6);
        for turn in [-0.7f32, 0.1, 0.3] {
            let turned = light.turned(turn);
            assert!((turned.degree() - 0.5).abs() < 1e-6);
            assert!((turned.angle() - (light.angle() - turn)).abs() < 1e-6);
        }
        let best = light.through_polariser(light.angle());
        assert!((best - 1.5).abs() < 1e-6);
        let worst = light.through_polariser(light.angle() + std::f32::consts::FRAC_PI_2);
        assert!((worst - 0.5).abs() < 1e-6);
    }

    #[test]
    fn darkness_is_unpolarised() {
        assert_eq!(Stokes::default().degree(), 0.0);
        assert_eq!(Stokes::default().angle(), 0.0);
    }
}
