//! Two kinds of particles: the model stores singly scattered light of each without its phase function.
//!
//! An atmosphere may have any number of particles. Those of a kind count with the phase function of the one among them
//! that scatters most; what their own adds to it must be stored with the multiply scattered light, which is meant to be
//! smooth. So the kinds are chosen for small differences.

use super::lobes::Lobes;
use super::spectral_medium::{Aerosol, NW, Part, parts};
use crate::atmosphere::{Atmosphere, column};
use anyhow::Result;

/// Wavelength that decides, nm.
const GREEN: f64 = 550.0;

/// A phase function and how much light it scatters.
#[derive(Clone)]
struct Member {
    g: f64,
    /// Vertical optical depth of scattering.
    depth: f64,
    lobes: Lobes,
}

/// Two kinds of particles, and which belong to the second.
pub struct Kinds {
    /// Phase functions that they count with.
    pub main: [Lobes; 2],
    coarse: Vec<Lobes>,
}

impl Kinds {
    /// Those of the particles of all these airs together, which have the same wavelengths: a file has one phase function
    /// per kind.
    pub fn of<'a>(airs: impl IntoIterator<Item = &'a Atmosphere>) -> Result<Self> {
        let (mut members, mut green) = (vec![], 0);
        for air in airs {
            green = nearest_to_green(air);
            note_members(air, &parts(air)?.0, green, &mut members);
        }
        members.sort_by(|a, b| a.g.total_cmp(&b.g));
        let [fine, coarse] = split(&members, green);
        let none = || Lobes::one([0.0; NW]);
        let main = |kind| dominant(kind).map_or_else(none, |m| m.lobes.clone());
        Ok(Self {
            main: [&fine, &coarse].map(|kind| main(kind)),
            coarse: coarse.into_iter().map(|m| m.lobes).collect(),
        })
    }

    /// Assigns the particles of `parts`, which are among those that the kinds are of.
    pub fn assign(&self, parts: &mut [Part]) {
        for aerosol in parts.iter_mut().flat_map(|part| &mut part.aerosols) {
            aerosol.kind = usize::from(self.coarse.contains(&aerosol.lobes));
        }
    }
}

/// Adds to `members` what an air has of each phase function.
fn note_members(air: &Atmosphere, parts: &[Part], green: usize, members: &mut Vec<Member>) {
    for (part, constituent) in parts.iter().zip(&air.constituents) {
        let height = column(&air.altitudes, &constituent.profile);
        for Aerosol {
            scattering, lobes, ..
        } in &part.aerosols
        {
            let depth = height * f64::from(scattering[green]);
            match members.iter_mut().find(|m| m.lobes == *lobes) {
                Some(known) => known.depth += depth,
                None => members.push(Member {
                    g: lobes.asymmetry(green),
                    depth,
                    lobes: lobes.clone(),
                }),
            }
        }
    }
}

/// Index of the wavelength nearest to green.
fn nearest_to_green(air: &Atmosphere) -> usize {
    let distances = air.wavelengths.iter().map(|w| (w - GREEN).abs());
    let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or(0, |(w, _)| w)
}

/// The division that costs least; the second kind is that of the sharper peaks.
fn split(members: &[Member], green: usize) -> [Vec<Member>; 2] {
    let cost = |at: &usize| price(&members[..*at], green) + price(&members[*at..], green);
    let best = (1..members.len().max(2)).min_by(|a, b| cost(a).total_cmp(&cost(b)));
    let at = best.unwrap_or(0).min(members.len());
    [members[..at].to_vec(), members[at..].to_vec()]
}

fn dominant(kind: &[Member]) -> Option<&Member> {
    kind.iter().max_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// Squared differences of all phase functions to the dominant one, by what they scatter.
fn price(kind: &[Member], green: usize) -> f64 {
    let Some(best) = dominant(kind) else {
        return 0.0;
    };
    let squares = kind.iter();
    squares
        .map(|m| m.depth * m.lobes.difference(&best.lobes, green))
        .sum()
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
                let of = |k: usize| part.aerosols[k].lobes.clone();
                assert_eq!(medium.kinds, [of(0), of(1)]);
            }
        }
    }

    #[test]
    fn one_phase_function_is_the_first_kind() {
        let member = |g: f64, depth: f64| Member {
            g,
            depth,
            lobes: Lobes::one(spectrum(&[g; NW])),
        };
        let [fine, coarse] = split(&[member(0.7, 1.0)], 0);
        assert_eq!([fine.len(), coarse.len()], [1, 0]);
        let [fine, coarse] = split(&[], 0);
        assert!(fine.is_empty() && coarse.is_empty());
        let [fine, coarse] = split(&[member(0.3, 0.01), member(0.7, 1.0), member(0.9, 0.1)], 0);
        assert_eq!([fine.len(), coarse.len()], [2, 1]);
    }
}
