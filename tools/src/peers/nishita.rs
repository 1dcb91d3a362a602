//! Nishita et al. 1993, *Display of the Earth Taking into Account Atmospheric Scattering*: light that is scattered
//! once, along each line of sight in steps, with tables of what reaches a point from the sun. The single-scattering
//! sky of Blender 2.90 to 4.5 is this with ozone.

use super::lanes::Lanes;
use super::medium::{Medium, rayleigh_phase};
use super::sky::{LaneModel, LaneSky, Observer};
use super::transmittance::TransmittanceTable;

/// Segments of a line of sight, as Blender has it.
const STEPS: usize = 32;

/// The air, with its table.
pub struct Nishita<const K: usize> {
    medium: Medium<K>,
    transmittance: TransmittanceTable<K>,
    steps: usize,
}

impl<const K: usize> Nishita<K> {
    /// Prepares the table.
    pub fn new(medium: &Medium<K>) -> Self {
        Self::in_steps(medium, STEPS)
    }

    /// As [`Nishita::new`], lines of sight in other steps.
    pub fn in_steps(medium: &Medium<K>, steps: usize) -> Self {
        Self {
            steps,
            medium: *medium,
            transmittance: TransmittanceTable::new(medium),
        }
    }
}

impl<const K: usize> LaneModel<K> for Nishita<K> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<K> + '_>> {
        let r = self.medium.shell.bottom + observer.altitude;
        let (z, x) = observer.solar_elevation.sin_cos();
        let sun = [x, 0.0, z];
        Some(Box::new(NishitaSky {
            model: self,
            r,
            sun,
        }))
    }

    fn bytes(&self) -> usize {
        self.transmittance.bytes()
    }
}

/// One observer under one sun.
struct NishitaSky<'a, const K: usize> {
    model: &'a Nishita<K>,
    r: f64,
    sun: [f64; 3],
}

impl<const K: usize> LaneSky<K> for NishitaSky<'_, K> {
    fn relative_radiance(&self, direction: [f32; 3]) -> Option<Lanes<K>> {
        let view = direction.map(f64::from);
        let (mu, sun) = (view[2], self.sun);
        let medium = &self.model.medium;
        let ground = medium.shell.meets_ground(self.r, mu);
        let nu = view[0] * sun[0] + view[1] * sun[1] + mu * sun[2];
        let step = medium.shell.to_end(self.r, mu, ground) / self.model.steps as f64;
        let phases = [rayleigh_phase(nu as f32), medium.mie_phase(nu as f32)];
        let (mut depth, mut sum) = (Lanes::default(), Lanes::default());
        for i in 0..self.model.steps {
            let distance = (i as f64 + 0.5) * step;
            let (there, _) = medium.shell.advanced(self.r, mu, distance);
            let densities = medium.densities(medium.altitude(there));
            depth += medium.extinction(densities) * step as f32;
            let mu_sun = (self.r * sun[2] + distance * nu) / there;
            let sunlight = self.model.transmittance.to_sun(there, mu_sun);
            let scattered = medium.rayleigh * (densities[0] * phases[0])
                + medium.mie_scattering * (densities[1] * phases[1]);
            sum += scattered * sunlight * depth.attenuated() * step as f32;
        }
        Some(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::published;

    /// Thin air scatters in proportion to the path through it.
    #[test]
    fn thin_air_is_analytic() {
        let mut medium = published::bruneton([680.0, 550.0, 440.0]);
        medium.rayleigh = medium.rayleigh * 1e-3;
        medium.mie_scattering = Lanes::default();
        medium.mie_extinction = Lanes::default();
        medium.ozone = Lanes::default();
        let model = Nishita::new(&medium);
        let sky = model.sky(Observer::on_the_ground(1.0)).unwrap();
        let got = sky.relative_radiance([0.0, 0.0, 1.0]).unwrap();
        let expected = medium.vertical()[0] * rayleigh_phase(1f32.sin());
        for (got, expected) in got.0.iter().zip(expected.0) {
            assert!((got / expected - 1.0).abs() < 5e-3, "{got} {expected}");
        }
    }
}
