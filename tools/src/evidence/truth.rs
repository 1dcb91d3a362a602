//! What the path tracer says.

use std::fs;
use std::path::Path;

use super::Result;
use super::cases::Case;
use super::directions::{Site, sites};
use crate::peers::WAVELENGTHS;
use crate::peers::colour::ToXyz;
use crate::peers::lanes::Lanes;

/// XYZ (cd m⁻²) of all sites, per sun.
pub struct Traced {
    /// `[sun][site]`.
    pub xyz: Vec<Vec<[f32; 3]>>,
    /// Median of the standard errors of single wavelengths, relative.
    pub noise: f64,
}

impl Traced {
    /// Reads what `welkin-fit trace` wrote for [`queries`](super::directions::queries).
    ///
    /// # Errors
    /// Where the file cannot be read or has other rows.
    pub fn read(path: &Path, case: &Case) -> Result<Self> {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Self::parse(&text, case).map_err(|e| format!("{}: {e}", path.display()).into())
    }

    fn parse(text: &str, case: &Case) -> Result<Self> {
        let mut rows = csv::Reader::from_reader(text.as_bytes());
        let names = rows.headers()?.clone();
        let find = |name: &str| {
            let at = names.iter().position(|n| n == name);
            at.ok_or_else(|| format!("no column {name}"))
        };
        let keys = [
            "view_zenith_deg",
            "view_azimuth_deg",
            "solar_elevation_deg",
            "wavelength_nm",
        ];
        let keys = keys.map(find);
        let (intensity, error) = (find("I")?, find("I_se")?);
        let mut records = rows.records();
        let mut errors = Vec::new();
        let mut next = |expected: [f64; 4]| -> Result<f32> {
            let record = records.next().ok_or("too few rows")??;
            let cell =
                |i: usize| -> Result<f64> { Ok(record.get(i).ok_or("a short row")?.parse()?) };
            for (key, expected) in keys.iter().zip(expected) {
                let got = cell(key.clone()?)?;
                if (got - expected).abs() > 1e-9 {
                    return Err(format!("{got} where {expected} is asked").into());
                }
            }
            errors.push(cell(error)? / cell(intensity)?);
            Ok(cell(intensity)? as f32)
        };
        let (sites, colour) = (sites(), ToXyz::spectral(WAVELENGTHS));
        let mut site = |sun: f64, site: &Site| -> Result<[f32; 3]> {
            let mut lanes = [0.0; 8];
            for (lane, nm) in lanes.iter_mut().zip(WAVELENGTHS) {
                *lane = next([site.zenith, site.azimuth, sun, nm])?;
            }
            Ok(colour.xyz(Lanes(lanes)))
        };
        let mut sky = |sun: f64| {
            sites
                .iter()
                .map(|s| site(sun, s))
                .collect::<Result<Vec<_>>>()
        };
        let xyz = case
            .suns
            .iter()
            .map(|&sun| sky(sun))
            .collect::<Result<_>>()?;
        errors.sort_by(f64::total_cmp);
        Ok(Self {
            xyz,
            noise: errors[errors.len() / 2],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_rows_are_refused() {
        let parse = |text: &str| Traced::parse(text, &super::super::cases::FIRST);
        let header = "altitude_m,view_zenith_deg,view_azimuth_deg,solar_elevation_deg,albedo,wavelength_nm,I,Q,U,I_se";
        assert!(parse(header).is_err());
        assert!(parse(&format!("{header}\n0,5,5,60,0.2,500,1,0,0,0.1\n")).is_err());
        assert!(parse("a,b\n1,2\n").is_err());
    }
}
