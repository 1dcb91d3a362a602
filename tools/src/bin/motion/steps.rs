//! What a small step of the sun or the observer does to pixels of baked skies, beyond what it does to the sky.

use welkin::{
    BakedColourSky, BakedPolarisedSky, BakedSky, Conditions, Model, PolarisationFrame,
    PolarisedSky, Result, Sky, StokesSpectra,
};

/// Of the embedded model: bytes 40 and 41 of a file.
const WAVELENGTHS: usize =
    u16::from_le_bytes([welkin::DEFAULT_MODEL[40], welkin::DEFAULT_MODEL[41]]) as usize;
/// Wavelengths of a path, between those of the model.
const HERO: [f32; 4] = [333.0, 450.0, 555.5, 741.0];

/// What changes along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Altitude, m.
    Climb,
    /// Solar elevation, degrees.
    Sun,
    /// Visibility, m.
    Visibility,
}

impl Axis {
    /// The step that no viewer may see: 0.1 m, 0.001°, and 1 m of visibility.
    pub fn step(self) -> f64 {
        match self {
            Self::Climb => 0.1,
            Self::Sun => 1e-3,
            Self::Visibility => 1.0,
        }
    }

    /// The conditions at a place on the path.
    pub fn at(self, base: &Conditions, value: f64) -> Conditions {
        let mut conditions = *base;
        match self {
            Self::Climb => conditions.altitude = value,
            Self::Sun => conditions.solar_elevation = value.to_radians(),
            Self::Visibility => conditions.visibility = value,
        }
        conditions
    }
}

/// Largest error of a baked sky that no table fails to hold.
const HELD: f64 = BakedSky::PEAK * BakedSky::TOLERANCE;

/// What is baked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Spectral,
    Hero,
    Colour,
    Polarised,
}

pub const KINDS: [Kind; 4] = [Kind::Spectral, Kind::Hero, Kind::Colour, Kind::Polarised];

/// A sky and what is baked of it.
pub enum View {
    Spectral(Sky, BakedSky),
    Hero(Sky, BakedSky),
    Colour(Sky, BakedColourSky),
    Polarised(Box<PolarisedSky>, Box<BakedPolarisedSky>),
}

impl View {
    pub fn new(model: &Model, kind: Kind, conditions: &Conditions, tolerance: f64) -> Result<Self> {
        if kind == Kind::Polarised {
            let sky = model.polarised_sky(conditions)?;
            let baked = sky.bake(tolerance)?;
            return Ok(Self::Polarised(Box::new(sky), Box::new(baked)));
        }
        let sky = model.sky(conditions)?;
        Ok(match kind {
            Kind::Colour => {
                let baked = sky.bake_colour(tolerance)?;
                Self::Colour(sky, baked)
            }
            Kind::Hero => {
                let baked = sky.bake(tolerance)?;
                Self::Hero(sky, baked)
            }
            _ => {
                let baked = sky.bake(tolerance)?;
                Self::Spectral(sky, baked)
            }
        })
    }

    fn conditions(&self) -> &Conditions {
        match self {
            Self::Spectral(_, baked) | Self::Hero(_, baked) => baked.conditions(),
            Self::Colour(_, baked) => baked.conditions(),
            Self::Polarised(_, baked) => baked.sky().conditions(),
        }
    }

    /// Whether the largest error is what a baked sky promises: not where the fit of a sky falls through zero at dusk.
    fn held(&self) -> bool {
        let error = match self {
            Self::Spectral(_, baked) | Self::Hero(_, baked) => baked.bake_error().max,
            Self::Colour(_, baked) => baked.bake_error().max,
            Self::Polarised(_, baked) => {
                let polarisation = baked.polarisation_error().max;
                polarisation.max(baked.sky().bake_error().max)
            }
        };
        error <= HELD
    }

    /// Where this changes, the size of the tables does.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Spectral(_, baked) | Self::Hero(_, baked) => baked.bytes(),
            Self::Colour(_, baked) => baked.bytes(),
            Self::Polarised(_, baked) => baked.bytes(),
        }
    }

    /// A pixel of the sky and of what is baked: logarithms of radiances; of a polarised sky Q/I and U/I.
    fn pixel(&self, direction: [f32; 3]) -> Result<[Vec<f64>; 2]> {
        let log = |values: &[f32]| values.iter().map(|&v| f64::from(v).ln()).collect();
        Ok(match self {
            Self::Spectral(sky, baked) => {
                let [mut truth, mut got] = [[0.0; WAVELENGTHS]; 2];
                sky.radiance(direction, &mut truth)?;
                baked.radiance(direction, &mut got)?;
                [log(&truth), log(&got)]
            }
            Self::Hero(sky, baked) => {
                let at = |l: f32| sky.radiance_at(direction, f64::from(l));
                let truth = HERO.into_iter().map(at).collect::<Result<Vec<_>>>()?;
                [log(&truth), log(&baked.hero(direction, HERO)?)]
            }
            Self::Colour(sky, baked) => [log(&sky.xyz(direction)?), log(&baked.xyz(direction)?)],
            Self::Polarised(sky, baked) => {
                let mut truth = [Default::default(); WAVELENGTHS];
                sky.stokes(direction, PolarisationFrame::Vertical, &mut truth)?;
                let truth = truth.iter().flat_map(|s| [s.q / s.i, s.u / s.i]);
                let [mut i, mut q, mut u] = [[0.0; WAVELENGTHS]; 3];
                let out = StokesSpectra {
                    i: &mut i,
                    q: &mut q,
                    u: &mut u,
                };
                baked.stokes(direction, PolarisationFrame::Vertical, out)?;
                let got = (0..WAVELENGTHS).flat_map(|k| [q[k] / i[k], u[k] / i[k]]);
                [truth.map(f64::from).collect(), got.map(f64::from).collect()]
            }
        })
    }
}

/// Directions that a step does not carry over the horizon or away from it: where it moves by more than a tenth of their
/// distance from it, as it does within 0.1° of it for the first 0.1 m above the ground and within 0.015° at 1 m, they
/// see something else afterwards.
fn stays(direction: [f32; 3], from: &Conditions, to: &Conditions) -> bool {
    let [before, after] =
        [from, to].map(|c| f64::from(direction[2]).asin().to_degrees() - horizon(c.altitude));
    (after - before).abs() < 0.1 * before.abs().min(after.abs()) && before * after > 0.0
}

/// Largest changes of pixels beyond the sky's own between two views, relative (of polarisation absolute).
#[derive(Clone, Copy, Debug, Default)]
pub struct Jump {
    pub largest: f64,
    /// Where it is.
    pub direction: [f32; 3],
    /// That of pixels that are wrong by more than a baked sky may be: where the fit of a sky falls through zero at dusk
    /// no table follows.
    pub lost: f64,
    /// Whether both skies keep the promised largest error.
    pub held: bool,
}

/// Compares two views.
pub fn jump(from: &View, to: &View) -> Result<Jump> {
    let mut worst = Jump {
        held: from.held() && to.held(),
        ..Jump::default()
    };
    for direction in directions(from.conditions()) {
        if !stays(direction, from.conditions(), to.conditions()) {
            continue;
        }
        let ([sky, baked], [next_sky, next_baked]) = (from.pixel(direction)?, to.pixel(direction)?);
        for k in 0..sky.len() {
            // Nothing is nothing: on the ground the lower half is black.
            let change = |a: f64, b: f64| if a == b { 0.0 } else { (a - b).abs() };
            let beyond = change(baked[k], next_baked[k]) - change(sky[k], next_sky[k]);
            let held = change(sky[k], baked[k]).max(change(next_sky[k], next_baked[k])) <= HELD;
            if !held {
                worst.lost = worst.lost.max(beyond);
            } else if beyond > worst.largest {
                (worst.largest, worst.direction) = (beyond, direction);
            }
        }
    }
    Ok(worst)
}

/// Directions that crowd at the horizon, where the boundary layer ends (seen from above), and at the sun, and some
/// anywhere.
pub fn directions(conditions: &Conditions) -> Vec<[f32; 3]> {
    let Conditions {
        altitude,
        solar_elevation,
        ..
    } = *conditions;
    let sun = solar_elevation.to_degrees();
    let mut out = Vec::new();
    for azimuth in [0.0, 0.14, 0.7, 3.0, 12.0, 45.0, 90.0, 135.0, 180.0] {
        for offset in [0.001, 0.01, 0.05, 0.13, 0.3, 0.7, 1.5, 4.0] {
            for elevation in [horizon(altitude) + offset, horizon(altitude) - offset] {
                out.push(unit(elevation, azimuth));
            }
        }
        for offset in [-0.2, -0.05, 0.0, 0.05, 0.2] {
            out.push(unit(horizon(altitude - 2e3) + offset, azimuth));
        }
        for offset in [-5.0, -1.5, -0.5, -0.1, 0.1, 0.5, 1.5, 5.0] {
            out.push(unit(sun + offset, azimuth));
        }
    }
    let spiral = (0..120).map(|i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 120.0;
        unit(z.asin().to_degrees(), 137.507_764 * f64::from(i))
    });
    out.extend(spiral);
    out
}

/// Elevation of the horizon, degrees.
fn horizon(altitude: f64) -> f64 {
    let radius = 6_378e3;
    -(radius / (radius + altitude.max(0.0))).acos().to_degrees()
}

/// A unit vector, from degrees.
pub fn unit(elevation: f64, azimuth: f64) -> [f32; 3] {
    let (z, r) = elevation.to_radians().sin_cos();
    let (y, x) = azimuth.to_radians().sin_cos();
    [r * x, r * y, z].map(|v| v as f32)
}

/// The place between two others where the size of the tables changes, to within a step: the values on both sides.
pub fn bisect(
    view: impl Fn(f64) -> Result<View>,
    [mut low, mut high]: [f64; 2],
    step: f64,
) -> Result<[f64; 2]> {
    let bytes = view(low)?.bytes();
    while high - low > step {
        let middle = 0.5 * (low + high);
        match view(middle)?.bytes() == bytes {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok([low, high])
}
