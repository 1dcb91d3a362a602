//! Sun, air, ground and observer: the conditions of every command that shows a sky, as arguments.

use std::io::Write;

use welkin::{Albedo, Conditions, Model};

use crate::albedo::Ground;
use crate::failure::{Result, plain};
use crate::parameter;
use crate::space;
use crate::sun::Sun;
use crate::turbidity;

/// The sun at the nadir, rad.
const QUARTER: f64 = std::f64::consts::FRAC_PI_2 + 1e-9;
/// Highest camera in orbit, m.
const FARTHEST: f64 = 5e8;

/// What is absent is as in the default conditions of the library.
#[derive(clap::Args)]
pub struct Scene {
    #[command(flatten)]
    pub sun: Sun,
    /// Visibility (meteorological range) at the ground, km; 59.4 if absent.
    #[arg(long, value_name = "KM", conflicts_with = "turbidity")]
    visibility: Option<f64>,
    /// Turbidity instead of the visibility: the vertical optical thickness of molecules and particles over that of the
    /// molecules at 550 nm, without ozone (Preetham et al. 1999). 1.5 to 4.5 in the default model, where 59.4 km has
    /// 2.1.
    #[arg(long, value_name = "RATIO")]
    turbidity: Option<f64>,
    /// Value of the quantity that the model's file has in place of the visibility, in its unit: welkin info tells which.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true, conflicts_with_all = ["visibility", "turbidity"])]
    parameter: Option<f64>,
    /// Albedo of the ground, 0 to 1: a number; by wavelength (nm) a list such as 400:0.05,690:0.06,740:0.5, or a CSV table
    /// with the columns wavelength_nm and albedo. Linear between wavelengths and constant beyond.
    #[arg(long, default_value = "0.2", value_name = "SHARE|NM:SHARE,…|FILE", value_parser = Ground::parse)]
    albedo: Ground,
    /// Altitude of the observer above the ground, m; 0 if absent.
    #[arg(long, value_name = "M")]
    pub altitude: Option<f64>,
    /// Move conditions that the model does not reach to its nearest, and say which on standard error.
    #[arg(long)]
    clamp: bool,
}

impl Scene {
    /// The model over the ground of the scene, where that has an albedo for each wavelength.
    pub fn over_ground(&self, model: Model) -> Model {
        self.albedo.under(model)
    }

    /// The albedo of the ground, where that has one for each wavelength.
    pub fn ground(&self) -> Option<&Albedo> {
        self.albedo.by_wavelength()
    }

    /// Where the sun stands still.
    pub fn conditions(&self, model: &Model) -> Result<Conditions> {
        self.sun.still()?;
        Ok(self.course(model, 1)?[0])
    }

    /// As many conditions as there are steps in the course of the sun.
    pub fn course(&self, model: &Model, steps: usize) -> Result<Vec<Conditions>> {
        self.reached(model, self.wished(model, steps)?)
    }

    /// The same, within the model or not.
    fn wished(&self, model: &Model, steps: usize) -> Result<Vec<Conditions>> {
        let air = self.air(model)?;
        let positions = self.sun.positions(steps)?;
        let wished = positions.iter().map(|position| position.over(&air));
        Ok(wished.collect())
    }

    /// The same, but the observer may be above the range of the model; there, and where `has_moon`, the sun below it.
    pub fn course_beyond(
        &self,
        model: &Model,
        steps: usize,
        has_moon: bool,
    ) -> Result<Vec<Conditions>> {
        let wished = self.wished(model, steps)?;
        let [lowest, _] = model.solar_elevation_range();
        let [_, ceiling] = model.altitude_range();
        let has_space = !self.clamp && space::is_reached_by(model);
        let is_beyond =
            |c: &Conditions| has_space && c.altitude > ceiling && c.altitude <= FARTHEST;
        // Seen from high above, the sun may be below the camera's horizontal and yet above that of the air in view.
        let is_night = |c: &Conditions| {
            (has_moon || is_beyond(c)) && c.solar_elevation < lowest && c.solar_elevation > -QUARTER
        };
        let inside = wished.iter().map(|c| Conditions {
            solar_elevation: if is_night(c) {
                lowest
            } else {
                c.solar_elevation
            },
            altitude: if is_beyond(c) { ceiling } else { c.altitude },
            ..*c
        });
        let mut reached = self.reached(model, inside.collect())?;
        for (conditions, wished) in reached.iter_mut().zip(&wished) {
            if is_night(wished) {
                conditions.solar_elevation = wished.solar_elevation;
            }
            if is_beyond(wished) {
                conditions.altitude = wished.altitude;
            }
        }
        Ok(reached)
    }

    /// Everything but the sun.
    pub fn air(&self, model: &Model) -> Result<Conditions> {
        let standard = Conditions::default();
        let visibility = match (self.visibility, self.turbidity, self.parameter) {
            (Some(km), ..) => 1e3 * km,
            (None, Some(ratio), _) => turbidity::visibility(model, ratio, self.clamp)?,
            (None, None, Some(value)) => parameter::visibility(model, value, self.clamp)?,
            (None, None, None) => {
                let [hazy, clear] = model.visibility_range();
                standard.visibility.clamp(hazy, clear)
            }
        };
        Ok(Conditions {
            visibility,
            albedo: self.albedo.share(),
            altitude: self.altitude.unwrap_or(standard.altitude),
            ..standard
        })
    }

    /// Whether the air is described at all.
    pub fn has_visibility(&self) -> bool {
        self.visibility.is_some() || self.turbidity.is_some() || self.parameter.is_some()
    }

    /// With `--clamp` the nearest that the model reaches; says on standard error what it moved. Otherwise all must be
    /// in the model.
    pub fn reached(&self, model: &Model, mut all: Vec<Conditions>) -> Result<Vec<Conditions>> {
        if !self.clamp {
            for conditions in &all {
                let checked = conditions.checked(model);
                checked.map_err(|error| self.sun.failure(error))?;
            }
            return Ok(all);
        }
        move_into(model, &mut all)?;
        Ok(all)
    }
}

/// Moves all into the range of the model, and says on standard error, once, what it moved.
pub fn move_into(model: &Model, all: &mut [Conditions]) -> Result<()> {
    let mut said = Vec::new();
    for conditions in all {
        let reached = conditions.clamped(model)?;
        for line in moved(conditions, &reached) {
            if !said.contains(&line) {
                // Nobody is left to tell when standard error is closed.
                let _ = writeln!(std::io::stderr(), "welkin: {line}");
                said.push(line);
            }
        }
        *conditions = reached;
    }
    Ok(())
}

/// What differs between conditions, in the units of the command line.
fn moved(from: &Conditions, to: &Conditions) -> Vec<String> {
    let both = |of: fn(&Conditions) -> f64| [of(from), of(to)];
    let quantities = [
        (
            "sun elevation",
            both(|c| c.solar_elevation.to_degrees()),
            " degrees",
        ),
        ("visibility", both(|c| c.visibility / 1e3), " km"),
        ("albedo", both(|c| c.albedo), ""),
        ("altitude", both(|c| c.altitude), " m"),
    ];
    let round = |v: f64| (v * 1e9).round() / 1e9;
    let differing = quantities
        .into_iter()
        .filter(|(_, [from, to], _)| from != to);
    differing
        .map(|(name, values, unit)| {
            let [from, to] = values.map(|v| plain(round(v)));
            format!("{name} moved from {from} to {to}{unit}")
        })
        .collect()
}
