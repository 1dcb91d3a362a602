//! Hillaire 2020, *A Scalable and Production Ready Sky and Atmosphere Rendering Technique*: single scattering by ray
//! marching, all further orders as if they were isotropic and alike around each point, and a small picture of the sky
//! per sun. Sizes and steps are those published.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::lanes::Lanes;
use super::medium::{Medium, rayleigh_phase};
use super::sky::{LaneModel, LaneSky, Observer};
use super::transmittance::{TransmittanceTable, place};

/// Nodes of multiple scattering over the sun's zenith angle and over altitude.
const MULTIPLE: usize = 32;
/// Directions from which it is gathered: this many zenith angles and azimuths.
const DIRECTIONS: usize = 8;
/// Steps along each of them.
const MULTIPLE_STEPS: usize = 20;
/// Width and height of the picture of a sky.
const PICTURE: [usize; 2] = [192, 108];
/// Steps along each line of sight.
const STEPS: usize = 30;
/// Where in a step the light is looked up.
const WITHIN_STEP: f64 = 0.3;

/// The tables of one air.
pub struct Hillaire<const K: usize> {
    medium: Medium<K>,
    transmittance: TransmittanceTable<K>,
    multiple: Vec<Lanes<K>>,
}

/// A line of sight.
#[derive(Clone, Copy)]
struct Line {
    r: f64,
    mu: f64,
    mu_sun: f64,
    /// Cosine of the angle between view and sun.
    nu: f64,
}

/// What light is looked up along it.
#[derive(Clone, Copy, PartialEq)]
enum Lit {
    /// Sunlight scattered evenly in all directions, and sunlit ground.
    Isotropic,
    /// Sunlight scattered as it is, with the higher orders.
    All,
}

impl<const K: usize> Hillaire<K> {
    /// Prepares both tables.
    pub fn new(medium: &Medium<K>) -> Self {
        let mut model = Self {
            medium: *medium,
            transmittance: TransmittanceTable::new(medium),
            multiple: Vec::new(),
        };
        let nodes = 0..MULTIPLE * MULTIPLE;
        model.multiple = nodes.map(|i| model.multiple_node(i)).collect();
        model
    }

    /// Equations 5 to 10: light of the second order, and the series of what each order leaves to the next.
    fn multiple_node(&self, i: usize) -> Lanes<K> {
        let share = |i: usize| i as f64 / (MULTIPLE - 1) as f64;
        let shell = self.medium.shell;
        let mu_sun = 2.0 * share(i % MULTIPLE) - 1.0;
        let r = shell.bottom + share(i / MULTIPLE) * (shell.top - shell.bottom);
        let sine = (1.0 - mu_sun * mu_sun).sqrt();
        let [mut second, mut left] = [Lanes::default(); 2];
        for j in 0..DIRECTIONS * DIRECTIONS {
            let step = |i: usize| (i as f64 + 0.5) / DIRECTIONS as f64;
            let mu = 1.0 - 2.0 * step(j / DIRECTIONS);
            let x = (1.0 - mu * mu).sqrt() * (TAU * step(j % DIRECTIONS)).cos();
            let nu = x * sine + mu * mu_sun;
            let (light, scattered) =
                self.march(Line { r, mu, mu_sun, nu }, MULTIPLE_STEPS, Lit::Isotropic);
            second += light;
            left += scattered;
        }
        let mean = 1.0 / (DIRECTIONS * DIRECTIONS) as f32;
        (second * mean) / (Lanes::splat(1.0) - left * mean)
    }

    fn multiple_at(&self, r: f64, mu_sun: f64) -> Lanes<K> {
        let shell = self.medium.shell;
        let (i, x) = place(0.5 * (mu_sun + 1.0), MULTIPLE);
        let (j, y) = place((r - shell.bottom) / (shell.top - shell.bottom), MULTIPLE);
        let row = |j: usize| {
            let nodes = &self.multiple[j * MULTIPLE + i..][..2];
            nodes[0].mixed(nodes[1], x)
        };
        row(j).mixed(row(j + 1), y)
    }

    /// Light along a line, and what of light that is 1 everywhere is scattered towards its start.
    fn march(&self, line: Line, steps: usize, lit: Lit) -> (Lanes<K>, Lanes<K>) {
        let (medium, shell) = (&self.medium, self.medium.shell);
        let Line { r, mu, mu_sun, nu } = line;
        let ground = shell.meets_ground(r, mu);
        let length = shell.to_end(r, mu, ground);
        let phases = match lit {
            Lit::Isotropic => [(0.25 / PI) as f32; 2],
            Lit::All => [rayleigh_phase(nu as f32), medium.mie_phase(nu as f32)],
        };
        let [mut light, mut unit] = [Lanes::default(); 2];
        let mut through = Lanes::splat(1.0);
        // Short steps first, where the air is dense.
        let at = |i: f64| length * (i / steps as f64).powi(2);
        for i in 0..steps {
            let (start, end) = (at(i as f64), at(i as f64 + 1.0));
            let distance = start + WITHIN_STEP * (end - start);
            let (there, _) = shell.advanced(r, mu, distance);
            let densities = medium.densities(medium.altitude(there));
            let sun_there = ((r * mu_sun + distance * nu) / there).clamp(-1.0, 1.0);
            let sunlight = self.transmittance.to_sun(there, sun_there);
            let scattering = [
                medium.rayleigh * densities[0],
                medium.mie_scattering * densities[1],
            ];
            let mut source = (scattering[0] * phases[0] + scattering[1] * phases[1]) * sunlight;
            if lit == Lit::All {
                source += (scattering[0] + scattering[1]) * self.multiple_at(there, sun_there);
            }
            let extinction = medium.extinction(densities);
            let step = (extinction * (end - start) as f32).attenuated();
            // The integral over the step of what is alike in it.
            let weight = extinction.zip(step, |e, s| match e > 0.0 {
                true => (1.0 - s) / e,
                false => (end - start) as f32,
            });
            light += through * source * weight;
            unit += through * (scattering[0] + scattering[1]) * weight;
            through = through * step;
        }
        if ground && lit == Lit::Isotropic {
            let sun_there = ((r * mu_sun + length * nu) / shell.bottom).clamp(-1.0, 1.0);
            let sunlight = self.transmittance.to_sun(shell.bottom, sun_there);
            let reflected = medium.albedo * (sun_there.max(0.0) / PI) as f32;
            light += through * sunlight * reflected;
        }
        (light, unit)
    }
}

impl<const K: usize> LaneModel<K> for Hillaire<K> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<K> + '_>> {
        let r = self.medium.shell.bottom + observer.altitude;
        let (mu_sun, sine) = observer.solar_elevation.sin_cos();
        let pixel = |i: usize| {
            let [column, row] = [i % PICTURE[0], i / PICTURE[0]];
            let azimuth = TAU * column as f64 / PICTURE[0] as f64;
            let (mu, level) = latitude(row as f64 / (PICTURE[1] - 1) as f64).sin_cos();
            let nu = (level * azimuth.cos() * sine + mu * mu_sun).clamp(-1.0, 1.0);
            self.march(Line { r, mu, mu_sun, nu }, STEPS, Lit::All).0
        };
        let pixels = (0..PICTURE[0] * PICTURE[1]).map(pixel).collect();
        Some(Box::new(Picture(pixels)))
    }

    fn bytes(&self) -> usize {
        self.transmittance.bytes() + size_of_val(self.multiple.as_slice())
    }
}

/// The sky of one observer under one sun.
struct Picture<const K: usize>(Vec<Lanes<K>>);

/// Angle above the horizontal plane of a height in 0..1, dense about the horizon: Section 5.3.
fn latitude(v: f64) -> f64 {
    let t = 2.0 * v - 1.0;
    t.signum() * t * t * FRAC_PI_2
}

fn height(latitude: f64) -> f64 {
    0.5 + 0.5 * latitude.signum() * (latitude.abs() / FRAC_PI_2).sqrt()
}

impl<const K: usize> LaneSky<K> for Picture<K> {
    fn relative_radiance(&self, [x, y, z]: [f32; 3]) -> Option<Lanes<K>> {
        let azimuth = f64::from(y).atan2(f64::from(x)) / TAU;
        let column = (azimuth - azimuth.floor()) * PICTURE[0] as f64;
        let (i, share) = (
            (column as usize) % PICTURE[0],
            (column - column.floor()) as f32,
        );
        let next = (i + 1) % PICTURE[0];
        let (j, row_share) = place(height(f64::from(z.clamp(-1.0, 1.0)).asin()), PICTURE[1]);
        let row = |j: usize| {
            let row = &self.0[j * PICTURE[0]..][..PICTURE[0]];
            row[i].mixed(row[next], share)
        };
        Some(row(j).mixed(row(j + 1), row_share))
    }

    fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::nishita::Nishita;
    use crate::peers::published;

    #[test]
    fn heights_are_those_of_latitudes() {
        for v in [0.0, 0.2, 0.5, 0.7, 1.0] {
            assert!((height(latitude(v)) - v).abs() < 1e-9, "{v}");
        }
    }

    /// Where nothing is scattered twice it is single scattering by another program.
    #[test]
    fn thin_air_has_the_sky_of_single_scattering() {
        let mut medium = published::hillaire();
        medium.rayleigh = medium.rayleigh * 1e-3;
        medium.mie_scattering = medium.mie_scattering * 1e-3;
        medium.mie_extinction = medium.mie_extinction * 1e-3;
        medium.ozone = medium.ozone * 1e-3;
        medium.albedo = 0.0;
        let (ours, other) = (Hillaire::new(&medium), Nishita::in_steps(&medium, 1000));
        let observer = Observer::on_the_ground(0.6);
        let (ours, other) = (ours.sky(observer).unwrap(), other.sky(observer).unwrap());
        for d in [
            [0.0f32, 0.0, 1.0],
            [-0.6, 0.0, 0.8],
            [0.0, 0.8, 0.6],
            [0.0, -0.95, 0.312],
        ] {
            let a = ours.relative_radiance(d).unwrap().0;
            let b = other.relative_radiance(d).unwrap().0;
            for (a, b) in a.iter().zip(b) {
                assert!((a / b - 1.0).abs() < 0.05, "{d:?}: {a} {b}");
            }
        }
    }

    /// The series of all orders ends: no node passes on more than it gets.
    #[test]
    fn multiple_scattering_is_finite_and_falls_towards_night() {
        let model = Hillaire::new(&published::hillaire());
        let r = model.medium.shell.bottom;
        let [day, dusk, night] = [0.9, 0.0, -0.5].map(|mu| model.multiple_at(r, mu).0[1]);
        assert!(day.is_finite() && day < 1.0);
        assert!(day > dusk && dusk > night, "{day} {dusk} {night}");
    }
}
