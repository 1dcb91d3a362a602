//! The successive-orders solver before outside references: the light field of a reference's atmosphere, gathered along
//! its lines of sight.

use super::traced_lines::query;
use crate::atmosphere::json::Case;
use crate::atmosphere::{Atmosphere, Phase};
use crate::successive_orders::scattered_source::Sun;
use crate::successive_orders::{Gatherer, Medium, NW, Settings, solve};
use crate::tracer::Radiance;
use anyhow::{Context, Result, bail};
use std::f64::consts::FRAC_PI_2;
use welkin::geometry::Side;

/// Light that the air scatters, for each row of `case`; without standard errors, as it has no noise. Ground that is
/// seen is black.
pub fn gather(case: &Case, settings: Settings) -> Result<Vec<Radiance>> {
    let medium = Medium::new(repeated(&case.atmosphere)?, 0.0)?;
    let light = solve(&medium, settings, &|_| ());
    let gatherer = Gatherer::new(&medium, &light, 1.0);
    let row = |i: usize| {
        let query = query(case, i)?;
        let side = match case.value(i, "los_hits_ground")? {
            0.0 => Side::Up,
            _ => Side::Down,
        };
        let path = gatherer.path(query.altitude, FRAC_PI_2 - query.view_zenith, side);
        let sun = Sun {
            elevation: (query.sun_elevation.cos(), query.sun_elevation.sin()),
            azimuth: (query.view_azimuth.cos(), query.view_azimuth.sin()),
        };
        let albedo = case.albedo as f32;
        let stokes = gatherer.stokes(&path, query.view_zenith.cos(), &sun, albedo);
        Ok(Radiance {
            stokes: stokes.map(|part| f64::from(part[0])),
            error: [0.0; 3],
        })
    };
    (0..case.rows.len()).map(row).collect()
}

/// The one wavelength of `air` as often as the solver wants.
fn repeated(air: &Atmosphere) -> Result<Atmosphere> {
    let mut air = air.clone();
    let repeat = |v: &mut Vec<f64>| -> Result<()> {
        let first = *v.first().context("an atmosphere without wavelengths")?;
        *v = vec![first; NW];
        Ok(())
    };
    repeat(&mut air.wavelengths)?;
    for constituent in &mut air.constituents {
        repeat(&mut constituent.extinction)?;
        for scatterer in &mut constituent.scatterers {
            repeat(&mut scatterer.scattering)?;
            match &mut scatterer.phase {
                Phase::Rayleigh { depolarisation } => repeat(depolarisation)?,
                Phase::HenyeyGreenstein { g } => repeat(g)?,
                Phase::Tabulated(_) => {
                    bail!("the successive-orders solver knows no tabulated phase functions")
                }
            }
        }
    }
    Ok(air)
}
