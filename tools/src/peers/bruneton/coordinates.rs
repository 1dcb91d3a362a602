//! The four coordinates of the tables, with nodes dense at the horizon: Bruneton and Neyret 2008, section 4, as changed
//! in 2017.

use crate::peers::shell::Shell;

/// Nodes over altitude, zenith angle of the view (half of them below the horizon), of the sun, and the angle between.
pub const SIZE: [usize; 4] = [32, 128, 32, 8];
/// Of nodes over the zenith angle on either side of the horizon.
const HALF: usize = SIZE[1] / 2;
/// Cosine of 102°: under lower suns there is no light.
pub const LOWEST_SUN: f64 = -0.207_911_690_817_759_34;

/// The nodes around a place: the first of each pair and the share of the second.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub first: [usize; 4],
    pub share: [f32; 4],
}

fn split(x: f64, n: usize) -> (usize, f32) {
    crate::peers::transmittance::place(x, n)
}

/// `r` of a layer of nodes.
pub fn radius(shell: &Shell, i: usize) -> f64 {
    let rho = shell.horizon() * i as f64 / (SIZE[0] - 1) as f64;
    shell.radius_of_tangent(rho)
}

/// Cosine of the zenith angle of the view, and whether it ends on the ground.
pub fn view(shell: &Shell, r: f64, i: usize) -> (f64, bool) {
    let rho = shell.tangent(r);
    if i < HALF {
        // From the horizon down to the nadir.
        let x = (HALF - 1 - i) as f64 / (HALF - 1) as f64;
        let (shortest, longest) = (r - shell.bottom, rho);
        let d = shortest + x * (longest - shortest);
        let mu = match d > 0.0 {
            true => -(rho * rho + d * d) / (2.0 * r * d),
            false => -1.0,
        };
        return (mu.clamp(-1.0, 1.0), true);
    }
    let x = (i - HALF) as f64 / (HALF - 1) as f64;
    let (shortest, longest) = (shell.top - r, rho + shell.horizon());
    let d = shortest + x * (longest - shortest);
    let mu = match d > 0.0 {
        true => ((shell.top - r) * (shell.top + r) - d * d) / (2.0 * r * d),
        false => 1.0,
    };
    (mu.clamp(-1.0, 1.0), false)
}

/// The lowest sun of the table, in the coordinate of suns.
pub fn lowest(shell: &Shell) -> f64 {
    let shortest = shell.top - shell.bottom;
    (shell.to_top(shell.bottom, LOWEST_SUN) - shortest) / (shell.horizon() - shortest)
}

/// Cosine of the zenith angle of the sun.
pub fn sun(shell: &Shell, i: usize) -> f64 {
    let x = i as f64 / (SIZE[2] - 1) as f64;
    let lowest = lowest(shell);
    let a = (lowest - x * lowest) / (1.0 + x * lowest);
    let (shortest, longest) = (shell.top - shell.bottom, shell.horizon());
    let d = shortest + a.min(lowest) * (longest - shortest);
    ((longest * longest - d * d) / (2.0 * shell.bottom * d)).clamp(-1.0, 1.0)
}

/// Cosine of the angle between view and sun, as far as both allow.
pub fn between(i: usize, mu: f64, mu_sun: f64) -> f64 {
    let nu = 2.0 * i as f64 / (SIZE[3] - 1) as f64 - 1.0;
    let spread = ((1.0 - mu * mu) * (1.0 - mu_sun * mu_sun)).sqrt();
    nu.clamp(mu * mu_sun - spread, mu * mu_sun + spread)
}

/// Where a point and a view are among the nodes.
pub fn view_place(shell: &Shell, r: f64, mu: f64, ground: bool) -> [(usize, f32); 2] {
    let rho = shell.tangent(r);
    let altitude = split(rho / shell.horizon(), SIZE[0]);
    if ground {
        let (shortest, longest) = (r - shell.bottom, rho);
        let x = match longest > shortest {
            true => (shell.to_ground(r, mu) - shortest) / (longest - shortest),
            false => 0.0,
        };
        return [altitude, split(1.0 - x, HALF)];
    }
    let (shortest, longest) = (shell.top - r, rho + shell.horizon());
    let x = (shell.to_top(r, mu) - shortest) / (longest - shortest);
    let (j, share) = split(x, HALF);
    [altitude, (HALF + j, share)]
}

/// With a sun and its angle from the view; `lowest` is that of [`lowest`].
pub fn with_sun(
    shell: &Shell,
    lowest: f64,
    [altitude, view]: [(usize, f32); 2],
    mu_sun: f64,
    nu: f64,
) -> Place {
    let (shortest, longest) = (shell.top - shell.bottom, shell.horizon());
    let a = (shell.to_top(shell.bottom, mu_sun) - shortest) / (longest - shortest);
    let sun = split((1.0 - a / lowest).max(0.0) / (1.0 + a), SIZE[2]);
    let between = split(0.5 * (nu + 1.0), SIZE[3]);
    Place {
        first: [altitude.0, view.0, sun.0, between.0],
        share: [altitude.1, view.1, sun.1, between.1],
    }
}

/// Where a point, a view and a sun are among the nodes.
pub fn place(shell: &Shell, r: f64, mu: f64, mu_sun: f64, nu: f64, ground: bool) -> Place {
    let view = view_place(shell, r, mu, ground);
    with_sun(shell, lowest(shell), view, mu_sun, nu)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_where_they_are_looked_up() {
        let shell = Shell {
            bottom: 6.36e6,
            top: 6.42e6,
        };
        for i in [0, 1, 7, 31] {
            for j in [0, 1, 40, 62, 63, 64, 65, 100, 127] {
                for k in [0, 1, 15, 31] {
                    let r = radius(&shell, i);
                    let (mu, ground) = view(&shell, r, j);
                    let mu_sun = sun(&shell, k);
                    let place = place(&shell, r, mu, mu_sun, 0.0, ground);
                    let at = |axis: usize| place.first[axis] as f32 + place.share[axis];
                    assert!((at(0) - i as f32).abs() < 1e-3, "{i}: {place:?}");
                    // On the ground all rays that end there are one, in space all others nearly.
                    if i > 0 && i < 31 {
                        assert!((at(1) - j as f32).abs() < 1e-2, "{i} {j}: {place:?}");
                    }
                    assert!((at(2) - k as f32).abs() < 1e-3, "{k}: {place:?}");
                }
            }
        }
    }
}
