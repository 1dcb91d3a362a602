//! What the air lets through to space, in a table over altitude and zenith angle: that of Bruneton and Neyret 2008,
//! which Hillaire 2020 took over.

use super::lanes::Lanes;
use super::medium::Medium;

/// Nodes over the zenith angle and over the altitude, as published.
const SIZE: [usize; 2] = [256, 64];
/// Steps of each integral, as published by Bruneton.
const STEPS: usize = 500;

/// The table and the air it was made for.
#[derive(Clone, Debug)]
pub struct TransmittanceTable<const K: usize> {
    medium: Medium<K>,
    nodes: Vec<Lanes<K>>,
}

impl<const K: usize> TransmittanceTable<K> {
    /// Integrates all nodes.
    pub fn new(medium: &Medium<K>) -> Self {
        let shell = medium.shell;
        let node = |i: usize| {
            let [x, y] = [
                (i % SIZE[0]) as f64 / (SIZE[0] - 1) as f64,
                (i / SIZE[0]) as f64 / (SIZE[1] - 1) as f64,
            ];
            let rho = shell.horizon() * y;
            let r = shell.radius_of_tangent(rho);
            let (shortest, longest) = (shell.top - r, rho + shell.horizon());
            let distance = shortest + x * (longest - shortest);
            let mu = match distance > 0.0 {
                true => {
                    let above = (shell.top - r) * (shell.top + r);
                    ((above - distance * distance) / (2.0 * r * distance)).clamp(-1.0, 1.0)
                }
                false => 1.0,
            };
            medium.optical_depth(r, mu, distance, STEPS).attenuated()
        };
        Self {
            medium: *medium,
            nodes: (0..SIZE[0] * SIZE[1]).map(node).collect(),
        }
    }

    /// Memory of the nodes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// To space, of a ray that does not meet the ground.
    pub fn to_top(&self, r: f64, mu: f64) -> Lanes<K> {
        let shell = self.medium.shell;
        let rho = shell.tangent(r);
        let (shortest, longest) = (shell.top - r, rho + shell.horizon());
        let x = (shell.to_top(r, mu) - shortest) / (longest - shortest);
        let (i, x_share) = place(x, SIZE[0]);
        let (j, y_share) = place(rho / shell.horizon(), SIZE[1]);
        let row = |j: usize| {
            let nodes = &self.nodes[j * SIZE[0] + i..][..2];
            nodes[0].mixed(nodes[1], x_share)
        };
        row(j).mixed(row(j + 1), y_share)
    }

    /// Between a point and another on its ray; `ground` says whether the ray ends there.
    pub fn between(&self, r: f64, mu: f64, distance: f64, ground: bool) -> Lanes<K> {
        let (there, mu_there) = self.medium.shell.advanced(r, mu, distance);
        let (whole, rest) = match ground {
            true => (self.to_top(there, -mu_there), self.to_top(r, -mu)),
            false => (self.to_top(r, mu), self.to_top(there, mu_there)),
        };
        whole.zip(rest, |a, b| if b > 0.0 { (a / b).min(1.0) } else { 0.0 })
    }

    /// To the sun, of which the ground hides a part when it is low.
    pub fn to_sun(&self, r: f64, mu: f64) -> Lanes<K> {
        let shell = self.medium.shell;
        let sine = (shell.bottom / r).min(1.0);
        let horizon = -(1.0 - sine * sine).sqrt();
        let half = sine * self.medium.sun_radius;
        let visible = match half > 0.0 {
            true => {
                let t = ((mu - horizon + half) / (2.0 * half)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            }
            false => f64::from(u8::from(!shell.meets_ground(r, mu))),
        };
        match visible > 0.0 {
            true => self.to_top(r, mu) * visible as f32,
            false => Lanes::default(),
        }
    }
}

/// The node before a place in 0..1 of `n` nodes, and how far it is to the next.
pub fn place(x: f64, n: usize) -> (usize, f32) {
    let at = x.clamp(0.0, 1.0) * (n - 1) as f64;
    let i = (at as usize).min(n - 2);
    (i, (at - i as f64) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::published;

    #[test]
    fn the_zenith_is_analytic() {
        let medium = published::hillaire();
        let table = TransmittanceTable::new(&medium);
        let [a, b, c] = medium.vertical();
        let expected = (a + b + c).attenuated();
        let got = table.to_top(medium.shell.bottom, 1.0);
        for (got, expected) in got.0.iter().zip(expected.0) {
            assert!((got / expected - 1.0).abs() < 2e-4, "{got} {expected}");
        }
    }

    #[test]
    fn between_nodes_it_is_the_integral() {
        let medium = published::bruneton([680.0, 550.0, 440.0]);
        let (table, shell) = (TransmittanceTable::new(&medium), medium.shell);
        for (altitude, mu) in [
            (0.0, 0.02),
            (120.0, 0.1),
            (2e3, 0.3),
            (9e3, -0.02),
            (3e4, 0.7),
        ] {
            let r = shell.bottom + altitude;
            let exact = medium
                .optical_depth(r, mu, shell.to_top(r, mu), 20_000)
                .attenuated();
            let got = table.to_top(r, mu);
            for (got, exact) in got.0.iter().zip(exact.0) {
                assert!((got - exact).abs() < 2e-3, "{altitude} {mu}: {got} {exact}");
            }
        }
    }

    #[test]
    fn parts_of_a_ray_multiply_to_the_whole() {
        let medium = published::bruneton([680.0, 550.0, 440.0]);
        let (table, r) = (TransmittanceTable::new(&medium), medium.shell.bottom + 4e3);
        for (mu, ground) in [(0.4, false), (-0.3, true)] {
            let end = medium.shell.to_end(r, mu, ground);
            let whole = table.between(r, mu, end, ground);
            let (there, mu_there) = medium.shell.advanced(r, mu, 0.4 * end);
            let parts = table.between(r, mu, 0.4 * end, ground)
                * table.between(there, mu_there, 0.6 * end, ground);
            for (a, b) in whole.0.iter().zip(parts.0) {
                assert!((a - b).abs() < 1e-3, "{mu}: {a} {b}");
            }
        }
    }

    #[test]
    fn half_of_the_sun_is_above_the_horizon_when_its_centre_is_on_it() {
        let medium = published::bruneton([680.0, 550.0, 440.0]);
        let (table, r) = (TransmittanceTable::new(&medium), medium.shell.bottom);
        let (half, whole) = (table.to_sun(r, 0.0), table.to_top(r, 0.0));
        assert!((half.0[0] / whole.0[0] - 0.5).abs() < 1e-6);
        assert_eq!(table.to_sun(r, -0.01), Lanes::default());
    }
}
