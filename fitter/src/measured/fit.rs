//! The sky of the model that is nearest to a scan: visibility, and if wanted albedo, one factor and the north of the
//! instrument, by least squares of the logarithm of radiance.

use super::least_squares::{Parameter, minimise};
use super::left_out::{LeftOut, is_light};
use super::model_sky::{between, direction, radiance};
use super::scan::Scan;
use super::site::Sun;
use anyhow::{Result, ensure};
use welkin::{Conditions, Model};

/// What is compared, and what is free.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Middles of the bands that are compared, nm.
    pub wavelengths: Vec<f64>,
    /// Their width, nm.
    pub step: f64,
    /// The albedo; fitted if none.
    pub albedo: Option<f64>,
    /// What to add to named azimuths, rad; fitted if none.
    pub north: Option<f64>,
    /// Whether one factor for all is fitted.
    pub scale: bool,
    /// Samples that are left out.
    pub without: Vec<usize>,
    /// As are those nearer to the sun, rad.
    pub around_sun: f64,
    /// Of the instrument above the ground, m.
    pub altitude: f64,
}

/// Measured over fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Which sample.
    pub sample: usize,
    /// Which wavelength of the choice.
    pub wavelength: usize,
    /// From the sun, rad.
    pub angle: f64,
    /// ln (measured / fitted).
    pub error: f64,
}

/// The nearest sky.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The conditions, with the sun where it stood.
    pub conditions: Conditions,
    /// Measured over model, for all.
    pub scale: f64,
    /// Added to named azimuths, rad.
    pub north: f64,
    /// All that was compared.
    pub residuals: Vec<Residual>,
    /// What could not be.
    pub left_out: LeftOut,
    /// Of all samples and wavelengths, with the factor.
    pub radiance: Vec<Vec<f64>>,
}

/// Most that the north is turned, rad.
const TURN: f64 = 0.6;

/// A scan in the bands of a choice.
struct Problem<'a> {
    model: &'a Model,
    choice: &'a Choice,
    sun: Sun,
    /// Named azimuth and elevation.
    places: Vec<[f64; 2]>,
    /// By wavelength and sample.
    measured: Vec<Vec<f64>>,
    /// The wavelengths that a band is the mean of: the sun has lines, and the model is averaged as the scan is.
    inside: Vec<Vec<f64>>,
}

/// A sky to be compared: ln of visibility (m), albedo, north (rad), ln of the factor.
type Point = [f64; 4];

/// Fits.
pub fn fit(model: &Model, scan: &Scan, sun: Sun, choice: &Choice) -> Result<Fitted> {
    let bands = || choice.wavelengths.iter();
    let inside: Vec<Vec<f64>> = bands().map(|&nm| scan.inside(nm, choice.step)).collect();
    ensure!(
        inside.iter().all(|band| !band.is_empty()),
        "the scan has no wavelengths in some band"
    );
    let problem = Problem {
        model,
        choice,
        sun,
        places: scan
            .samples
            .iter()
            .map(|s| [s.azimuth, s.elevation])
            .collect(),
        measured: bands().map(|&nm| scan.band(nm, choice.step)).collect(),
        inside,
    };
    let left_out = LeftOut::of(&problem.measured, &choice.without);
    left_out.check()?;
    let mut at = problem.start()?;
    // What is too near to the sun depends on the north.
    for _ in 0..3 {
        at = problem.nearest(at)?;
    }
    problem.fitted(at, left_out)
}

impl Problem<'_> {
    fn start(&self) -> Result<Point> {
        let [hazy, clear] = self.model.visibility_range();
        let middle = 0.5 * (hazy.ln() + clear.ln());
        let albedo = self.choice.albedo.unwrap_or(0.2);
        let norths: Vec<f64> = match self.choice.north {
            Some(north) => vec![north],
            None => (-4..=4).map(|i| 0.12 * f64::from(i)).collect(),
        };
        let mut best = None;
        for north in norths {
            let mut at = [middle, albedo, north, 0.0];
            let residuals = self.residuals(&at, &self.used(north))?;
            ensure!(!residuals.is_empty(), "nothing is left to be compared");
            let mean = residuals.iter().sum::<f64>() / residuals.len() as f64;
            let spread = residuals.iter().map(|r| (r - mean).powi(2)).sum::<f64>();
            let spread = spread / residuals.len() as f64;
            if self.choice.scale {
                at[3] = mean;
            }
            if best.is_none_or(|(least, _)| spread < least) {
                best = Some((spread, at));
            }
        }
        Ok(best.map_or([middle, albedo, 0.0, 0.0], |(_, at)| at))
    }

    fn nearest(&self, from: Point) -> Result<Point> {
        let used = self.used(from[2]);
        ensure!(!used.is_empty(), "nothing is left to be compared");
        let [hazy, clear] = self.model.visibility_range();
        let all = [
            (true, [hazy.ln(), clear.ln()], 0.02),
            (self.choice.albedo.is_none(), [0.0, 1.0], 0.02),
            (self.choice.north.is_none(), [-TURN, TURN], 0.01),
            (self.choice.scale, [-5.0, 5.0], 0.01),
        ];
        let free: Vec<usize> = (0..4).filter(|&i| all[i].0).collect();
        let parameters: Vec<Parameter> = free
            .iter()
            .map(|&i| Parameter {
                start: from[i],
                bounds: all[i].1,
                step: all[i].2,
            })
            .collect();
        let placed = |values: &[f64]| {
            let mut at = from;
            for (&i, &value) in free.iter().zip(values) {
                at[i] = value;
            }
            at
        };
        let found = minimise(&parameters, |values| self.residuals(&placed(values), &used))?;
        Ok(placed(&found))
    }

    fn sun_direction(&self) -> [f32; 3] {
        direction(self.sun.elevation, self.sun.azimuth)
    }

    fn directions(&self, north: f64) -> Vec<[f32; 3]> {
        let turned = self.places.iter();
        turned
            .map(|&[azimuth, elevation]| direction(elevation, azimuth + north))
            .collect()
    }

    /// Pairs of sample and wavelength that are compared.
    fn used(&self, north: f64) -> Vec<(usize, usize)> {
        let sun = self.sun_direction();
        let mut used = vec![];
        for (i, direction) in self.directions(north).into_iter().enumerate() {
            if self.choice.without.contains(&i) || between(direction, sun) < self.choice.around_sun
            {
                continue;
            }
            let lit = |&w: &usize| is_light(self.measured[w][i]);
            used.extend((0..self.measured.len()).filter(lit).map(|w| (i, w)));
        }
        used
    }

    fn conditions(&self, at: &Point) -> Conditions {
        let [hazy, clear] = self.model.visibility_range();
        Conditions {
            solar_elevation: self.sun.elevation,
            solar_azimuth: self.sun.azimuth,
            // The exponential of the logarithm may be a little more.
            visibility: at[0].exp().clamp(hazy, clear),
            albedo: at[1],
            altitude: self.choice.altitude,
        }
    }

    fn model_radiance(&self, at: &Point) -> Result<Vec<Vec<f64>>> {
        let every = self.inside.concat();
        let rows = radiance(
            self.model,
            &self.conditions(at),
            self.sun.intensity,
            &self.directions(at[2]),
            &every,
        )?;
        Ok(rows.iter().map(|row| self.bands(row)).collect())
    }

    /// Means over the bands.
    fn bands(&self, every: &[f64]) -> Vec<f64> {
        let mut rest = every;
        let mut mean = |band: &Vec<f64>| {
            let (now, later) = rest.split_at(band.len());
            rest = later;
            now.iter().sum::<f64>() / now.len() as f64
        };
        self.inside.iter().map(&mut mean).collect()
    }

    fn residuals(&self, at: &Point, used: &[(usize, usize)]) -> Result<Vec<f64>> {
        let model = self.model_radiance(at)?;
        let error = |&(i, w): &(usize, usize)| (self.measured[w][i] / model[i][w]).ln() - at[3];
        Ok(used.iter().map(error).collect())
    }

    fn fitted(&self, at: Point, left_out: LeftOut) -> Result<Fitted> {
        let used = self.used(at[2]);
        let errors = self.residuals(&at, &used)?;
        let sun = self.sun_direction();
        let directions = self.directions(at[2]);
        let residuals = used.iter().zip(errors);
        let scale = at[3].exp();
        let scaled = |row: Vec<f64>| row.into_iter().map(|v| v * scale).collect();
        Ok(Fitted {
            conditions: self.conditions(&at),
            scale,
            north: at[2],
            residuals: residuals
                .map(|(&(sample, wavelength), error)| Residual {
                    sample,
                    wavelength,
                    angle: between(directions[sample], sun),
                    error,
                })
                .collect(),
            left_out,
            radiance: self.model_radiance(&at)?.into_iter().map(scaled).collect(),
        })
    }
}
