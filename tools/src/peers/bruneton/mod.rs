//! Bruneton 2017, *A Qualitative and Quantitative Evaluation of 8 Clear Sky Models*, whose best-known part is the new
//! implementation of Bruneton and Neyret 2008, *Precomputed Atmospheric Scattering*: tables of transmittance and of
//! scattered light over altitude, zenith angles of view and sun and the angle between both, order by order.
//!
//! Sizes, steps and coordinates are those published. The light of the ground is kept for the ground only, since
//! nothing here stands above it.

mod coordinates;
mod first_order;
mod higher_orders;
mod table;

use super::lanes::Lanes;
use super::medium::{Medium, rayleigh_phase};
use super::sky::{LaneModel, LaneSky, Observer};
use super::transmittance::TransmittanceTable;
use table::ScatteringTable;

/// The tables of one air.
pub struct Bruneton<const K: usize> {
    medium: Medium<K>,
    transmittance: TransmittanceTable<K>,
    /// Of molecules once and of everything more often, over the phase function of molecules.
    scattering: ScatteringTable<K>,
    /// Of particles once, over their phase function.
    mie: ScatteringTable<K>,
}

impl<const K: usize> Bruneton<K> {
    /// Orders of scattering in the published program.
    pub const ORDERS: usize = 4;
    /// Steps of each integral along a line of sight there.
    const STEPS: usize = 50;

    /// Precomputes light that is scattered up to `orders` times.
    pub fn new(medium: &Medium<K>, orders: usize) -> Self {
        Self::in_steps(medium, orders, Self::STEPS)
    }

    /// As [`Bruneton::new`], integrals in other steps.
    pub fn in_steps(medium: &Medium<K>, orders: usize, steps: usize) -> Self {
        let transmittance = TransmittanceTable::new(medium);
        let [mut scattering, mie] = first_order::tables(medium, &transmittance, steps);
        let mut last = first_order::with_phase(medium, &scattering, &mie);
        let mut ground = higher_orders::direct_irradiance(medium, &transmittance);
        for _ in 1..orders {
            let source = higher_orders::source(medium, &transmittance, &last, &ground);
            ground = higher_orders::irradiance(medium, &last);
            last = higher_orders::gathered(medium, &transmittance, &source, steps);
            scattering.add_over_rayleigh_phase(&last);
        }
        Self {
            medium: *medium,
            transmittance,
            scattering,
            mie,
        }
    }

    /// Radiance per unit of solar irradiance towards a point.
    fn radiance(&self, r: f64, mu: f64, mu_sun: f64, nu: f64) -> Lanes<K> {
        let ground = self.medium.shell.meets_ground(r, mu);
        let place = coordinates::place(&self.medium.shell, r, mu, mu_sun, nu, ground);
        self.scattering.at(&place) * rayleigh_phase(nu as f32)
            + self.mie.at(&place) * self.medium.mie_phase(nu as f32)
    }
}

impl<const K: usize> LaneModel<K> for Bruneton<K> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<K> + '_>> {
        let (z, x) = observer.solar_elevation.sin_cos();
        if z < coordinates::LOWEST_SUN {
            return None;
        }
        Some(Box::new(BrunetonSky {
            model: self,
            r: self.medium.shell.bottom + observer.altitude,
            sun: [x, 0.0, z],
        }))
    }

    fn bytes(&self) -> usize {
        self.transmittance.bytes() + self.scattering.bytes() + self.mie.bytes()
    }
}

/// One observer under one sun: nothing is prepared for it.
struct BrunetonSky<'a, const K: usize> {
    model: &'a Bruneton<K>,
    r: f64,
    sun: [f64; 3],
}

impl<const K: usize> LaneSky<K> for BrunetonSky<'_, K> {
    fn relative_radiance(&self, direction: [f32; 3]) -> Option<Lanes<K>> {
        let (view, sun) = (direction.map(f64::from), self.sun);
        let nu = view[0] * sun[0] + view[1] * sun[1] + view[2] * sun[2];
        Some(self.model.radiance(self.r, view[2], sun[2], nu))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::published;

    fn sky_of<const K: usize>(model: &dyn LaneModel<K>, elevation: f64, d: [f32; 3]) -> Lanes<K> {
        let sky = model.sky(Observer::on_the_ground(elevation)).unwrap();
        sky.relative_radiance(d).unwrap()
    }

    /// Without absorption each order adds light, and less than the one before.
    #[test]
    #[cfg_attr(debug_assertions, ignore = "needs --release")]
    fn orders_add_light_and_fall_off() {
        let mut medium = published::bruneton([550.0]);
        medium.mie_extinction = medium.mie_scattering;
        medium.ozone = Lanes::default();
        medium.albedo = 0.0;
        let zenith = |orders| sky_of(&Bruneton::new(&medium, orders), 0.7, [0.0, 0.0, 1.0]).0[0];
        let [one, two, three] = [1, 2, 3].map(zenith);
        assert!(one < two && two < three);
        // A vertical optical depth of 0.1 sends on about as much of each order as of the one before.
        assert!(three - two < 0.35 * (two - one), "{one} {two} {three}");
        assert!((0.05..0.4).contains(&((two - one) / one)), "{one} {two}");
    }

    /// The sky is the same on both sides of the sun's meridian, and ground that reflects makes it brighter.
    #[test]
    #[cfg_attr(debug_assertions, ignore = "needs --release")]
    fn it_is_symmetric_and_sees_the_ground() {
        let mut medium = published::bruneton([550.0]);
        let dark = Bruneton::new(&medium, 2);
        let d = [0.48, 0.64, 0.6];
        let mirrored = [0.48, -0.64, 0.6];
        assert_eq!(sky_of(&dark, 0.4, d), sky_of(&dark, 0.4, mirrored));
        medium.albedo = 0.8;
        let bright = Bruneton::new(&medium, 2);
        assert!(sky_of(&bright, 0.8, d).0[0] > 1.02 * sky_of(&dark, 0.8, d).0[0]);
    }
}
