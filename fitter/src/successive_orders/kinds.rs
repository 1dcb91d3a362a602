//! Two kinds of particles: the model stores singly scattered light of each without its phase function.
//!
//! An atmosphere may have any number of particles. Those of a kind count with the phase function of the one among them
//! that scatters most; what their own adds to it must be stored with the multiply scattered light, which is meant to be
//! smooth. So the kinds are chosen for small differences.

use super::spectral_medium::{Aerosol, NW, Part, Spectrum, parts};
use crate::atmosphere::{Atmosphere, column};
use anyhow::Result;

/// Wavelength that decides, nm.
const GREEN: f64 = 550.0;

/// A phase function and how much light it scatters.
#[derive(Clone, Copy)]
struct Member {
    g: f64,
    /// Vertical optical depth of scattering.
    depth: f64,
    spectrum: Spectrum,
}

/// Two kinds of particles, and which belong to the second.
pub struct Kinds {
    /// Asymmetry parameters that they count with.
    pub main: [Spectrum; 2],
    coarse: Vec<Spectrum>,
}

impl Kinds {
    /// Those of the particles of all these airs together: a file has one phase function per kind.
    pub fn of<'a>(airs: impl IntoIterator<Item = &'a Atmosphere>) -> Result<Self> {
        let mut members = vec![];
        for air in airs {
            note_members(air, &parts(air)?.0, &mut members);
        }
        members.sort_by(|a, b| a.g.total_cmp(&b.g));
        let [fine, coarse] = split(&members);
        Ok(Self {
            main: [&fine, &coarse].map(|kind| dominant(kind).map_or([0.0; NW], |m| m.spectrum)),
            coarse: coarse.iter().map(|m| m.spectrum).collect(),
        })
    }

    /// Assigns the particles of `parts`, which are among those that the kinds are of.
    pub fn assign(&self, parts: &mut [Part]) {
        for aerosol in parts.iter_mut().flat_map(|part| &mut part.aerosols) {
            aerosol.kind = usize::from(self.coarse.contains(&aerosol.g));
        }
    }
}

/// Adds to `members` what an air has of each phase function.
fn note_members(atmosphere: &Atmosphere, parts: &[Part], members: &mut Vec<Member>) {
    let green = green(atmosphere);
    for (part, constituent) in parts.iter().zip(&atmosphere.constituents) {
        let height = column(&atmosphere.altitudes, &constituent.profile);
        for Aerosol { scattering, g, .. } in &part.aerosols {
            let depth = height * f64::from(scattering[green]);
            match members.iter_mut().find(|m| m.spectrum == *g) {
                Some(known) => known.depth += depth,
                None => members.push(Member {
                    g: f64::from(g[green]),
                    depth,
                    spectrum: *g,
                }),
            }
        }
    }
}

/// The wavelength nearest to green.
fn green(atmosphere: &Atmosphere) -> usize {
    let distances = atmosphere.wavelengths.iter().map(|w| (w - GREEN).abs());
    let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or(0, |(w, _)| w)
}

/// The division that costs least; the second kind is that of the sharper peaks.
fn split(members: &[Member]) -> [Vec<Member>; 2] {
    let cost = |at: &usize| price(&members[..*at]) + price(&members[*at..]);
    let best = (1..members.len().max(2)).min_by(|a, b| cost(a).total_cmp(&cost(b)));
    let at = best.unwrap_or(0).min(members.len());
    [members[..at].to_vec(), members[at..].to_vec()]
}

fn dominant(kind: &[Member]) -> Option<&Member> {
    kind.iter().max_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// Squared differences of all phase functions to the dominant one, by what they scatter.
fn price(kind: &[Member]) -> f64 {
    let Some(best) = dominant(kind) else {
        return 0.0;
    };
    kind.iter().map(|m| m.depth * difference(m.g, best.g)).sum()
}

/// Mean over the sphere of the squared difference of two Henyey-Greenstein functions: Σ (2l + 1)(gˡ − hˡ)².
fn difference(g: f64, h: f64) -> f64 {
    let product = |x: f64| (1.0 + x) / (1.0 - x).powi(2);
    product(g * g) + product(h * h) - 2.0 * product(g * h)
}

#[cfg(test)]
mod tests {
    use super::super::spectral_medium::{Medium, spectrum};
    use super::*;
    use crate::atmosphere::{Particles, VISIBILITIES, real_at};
    use crate::dataset::VISIBLE;

    #[test]
    fn soot_goes_with_the_water_soluble_particles() {
        for visibility in VISIBILITIES {
            let air = real_at(visibility, &VISIBLE.nodes, Particles::HenyeyGreenstein).unwrap();
            let layer = air
                .constituents
                .iter()
                .find(|c| c.name == "boundary layer aerosol");
            let names: Vec<_> = layer.unwrap().scatterers.iter().map(|s| &s.name).collect();
            assert_eq!(names, ["waso", "inso", "soot"]);
            let medium = Medium::new(air, 0.0).unwrap();
            for part in medium.parts.iter().filter(|p| !p.aerosols.is_empty()) {
                let kinds: Vec<usize> = part.aerosols.iter().map(|a| a.kind).collect();
                assert_eq!(kinds, [0, 1, 0]);
                assert_eq!(medium.kinds, [part.aerosols[0].g, part.aerosols[1].g]);
            }
        }
    }

    #[test]
    fn one_phase_function_is_the_first_kind() {
        let member = |g: f64, depth: f64| Member {
            g,
            depth,
            spectrum: spectrum(&[g; NW]),
        };
        let [fine, coarse] = split(&[member(0.7, 1.0)]);
        assert_eq!([fine.len(), coarse.len()], [1, 0]);
        let [fine, coarse] = split(&[]);
        assert!(fine.is_empty() && coarse.is_empty());
        let [fine, coarse] = split(&[member(0.3, 0.01), member(0.7, 1.0), member(0.9, 0.1)]);
        assert_eq!([fine.len(), coarse.len()], [2, 1]);
    }

    /// Against the sum itself.
    #[test]
    fn the_difference_of_phase_functions_is_their_series() {
        let term = |l: i32| f64::from(2 * l + 1) * (0.6f64.powi(l) - 0.8f64.powi(l)).powi(2);
        let series: f64 = (0..400).map(term).sum();
        assert!((difference(0.6, 0.8) / series - 1.0).abs() < 1e-12);
    }
}
