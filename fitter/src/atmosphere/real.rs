//! The clear-sky atmosphere of Wilkie et al. 2021, section 4.2, from the tables in `fitter/data`.
//!
//! Gas: AFGL US standard profile, Rayleigh scattering after Bodhaine et al. 1999 for dry air (all of it; the paper
//! counts N2 and O2 only, 1 % less), ozone that absorbs as its temperature says (the paper: as at 223 K), water vapour
//! and mixed gases where they are asked for. Aerosol: OPAC water-soluble (50 % humidity), insoluble
//! and soot particles with Henyey-Greenstein phase functions, in two profiles that the inversion layer at 2 km
//! separates smoothly.

use super::aerosol::{Particles, aerosols};
use super::composition::{Atmosphere, Constituent};
use super::gases::{GasProfile, OZONE_TEMPERATURES};
use super::monochromatic::Monochromatic;
use super::variation::{AerosolProfile, Variation};
use anyhow::{Result, ensure};

/// Radius of the planet, m (the value of the published model).
pub const PLANET_RADIUS: f64 = 6_378_000.0;
/// Altitude above which there is nothing, m.
pub const TOP: f64 = 100_000.0;

/// The visibilities of the paper's Table 2, m.
pub const VISIBILITIES: [f64; 6] = [20_000.0, 27_600.0, 40_000.0, 59_400.0, 90_000.0, 131_800.0];

/// The real atmosphere with Henyey-Greenstein aerosols beside absorption lines; see [`real_with`].
pub fn real(visibility: f64, wavelengths: &[f64]) -> Result<Atmosphere> {
    real_with(visibility, wavelengths, Particles::HenyeyGreenstein)
}

/// The real atmosphere beside absorption lines with the given visibility (m, 20..131.8 km) at the given wavelengths
/// (nm, 300..2500).
pub fn real_with(visibility: f64, wavelengths: &[f64], particles: Particles) -> Result<Atmosphere> {
    real_varied(visibility, wavelengths, particles, Variation::default())
}

/// The atmosphere of [`real_with`] with something changed.
pub fn real_varied(
    visibility: f64,
    wavelengths: &[f64],
    particles: Particles,
    variation: Variation,
) -> Result<Atmosphere> {
    ensure!(
        wavelengths.windows(2).all(|w| w[0] < w[1]),
        "wavelengths must increase"
    );
    let lights: Vec<_> = wavelengths
        .iter()
        .map(|&w| Monochromatic::beside_lines(w))
        .collect();
    build(visibility, &lights, particles, variation)
}

/// The real atmosphere with the given visibility (m, 20..131.8 km) for lights of 300..2500 nm, in any order.
pub fn real_at(
    visibility: f64,
    lights: &[Monochromatic],
    particles: Particles,
) -> Result<Atmosphere> {
    build(visibility, lights, particles, Variation::default())
}

fn build(
    visibility: f64,
    lights: &[Monochromatic],
    particles: Particles,
    variation: Variation,
) -> Result<Atmosphere> {
    variation.check()?;
    let wavelengths: &[f64] = &lights.iter().map(|l| l.wavelength).collect::<Vec<_>>();
    ensure!(
        (VISIBILITIES[0]..=VISIBILITIES[5]).contains(&visibility),
        "visibility {:?} km is outside 20..131.8 km",
        visibility * 1e-3
    );
    ensure!(
        wavelengths.iter().all(|w| (300.0..=2500.0).contains(w)) && !wavelengths.is_empty(),
        "wavelengths must lie in 300..2500 nm"
    );
    let altitudes = altitude_nodes(variation.aerosol);
    let mut constituents = gases(&altitudes, lights, variation)?;
    let profile = variation.aerosol;
    constituents.extend(aerosols(
        visibility,
        &altitudes,
        wavelengths,
        particles,
        profile,
    )?);
    Ok(Atmosphere {
        planet_radius: PLANET_RADIUS,
        altitudes,
        wavelengths: wavelengths.to_vec(),
        constituents,
    })
}

/// Nodes dense where the profiles bend: the inversion layer (2 km) and the tropopause end of the aerosol (12 km).
/// Where the profile jumps there, two nodes stand 1 m apart.
pub(crate) fn altitude_nodes(profile: AerosolProfile) -> Vec<f64> {
    let parts: [(f64, f64, f64); 8] = [
        (0.0, 1400.0, 100.0),
        (1400.0, 2800.0, 50.0),
        (2800.0, 5000.0, 200.0),
        (5000.0, 10_000.0, 500.0),
        (10_000.0, 14_000.0, 200.0),
        (14_000.0, 26_000.0, 500.0),
        (26_000.0, 50_000.0, 1000.0),
        (50_000.0, TOP, 2500.0),
    ];
    let inner = parts.iter().flat_map(|&(from, to, step)| {
        let n = ((to - from) / step).round() as usize;
        (0..n).map(move |i| from + step * i as f64)
    });
    let jumps = |z: f64| profile == AerosolProfile::Sharp && AerosolProfile::EDGES.contains(&z);
    let nodes = inner.flat_map(|z| match jumps(z) {
        true => [Some(z - 0.5), Some(z + 0.5)],
        false => [Some(z), None],
    });
    nodes.flatten().chain([TOP]).collect()
}

fn gases(
    altitudes: &[f64],
    lights: &[Monochromatic],
    variation: Variation,
) -> Result<Vec<Constituent>> {
    let profile = GasProfile::us_standard()?;
    let mut out = vec![profile.air(altitudes, lights)?];
    out.extend(profile.ozone(altitudes, lights, variation.ozone, &OZONE_TEMPERATURES)?);
    out.extend(profile.water(altitudes, lights, None)?);
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::gases::DOBSON;
    use super::super::table::Table;
    use super::*;

    macro_rules! table {
        ($name:literal) => {
            Table::parse($name, include_str!(concat!("../../data/", $name)))
        };
    }

    /// Bodhaine et al. 1999, Table 3 (cm²), and the column of the US standard atmosphere at 1013.25 hPa (their Table
    /// 4).
    #[test]
    fn rayleigh_matches_the_published_values() {
        let table = table!("rayleigh_published_checks.csv").unwrap();
        let computed = table!("rayleigh_bodhaine1999.csv")
            .unwrap()
            .curve("wavelength_nm", "sigma_cm2")
            .unwrap();
        for (um, sigma) in table
            .column("wavelength_um")
            .unwrap()
            .iter()
            .zip(table.column("sigma_published_cm2").unwrap())
        {
            if *um >= 0.3 {
                assert!(
                    (computed.log_at(um * 1000.0) / sigma - 1.0).abs() < 1e-4,
                    "{um} um"
                );
            }
        }
        // Their equation 30: optical depth = σ · P · A / (m_a · g), from the surface pressure alone.
        let molecules_per_cm2 = 1_013_250.0 * 6.022_136_7e23 / (28.9595 * 980.616);
        let air = real(59_400.0, &[400.0, 550.0, 700.0]).unwrap();
        for (w, nm) in [400.0, 550.0, 700.0].into_iter().enumerate() {
            let published = computed.log_at(nm) * molecules_per_cm2;
            assert!(
                (air.vertical_optical_depth(0, w) / published - 1.0).abs() < 0.01,
                "{nm} nm"
            );
        }
    }

    #[test]
    fn ozone_column_is_the_us_standard_one() {
        let air = real(59_400.0, &[600.0]).unwrap();
        let sigma = |kelvin: &str| {
            let table = table!("o3_xsec_1nm.csv").unwrap();
            table.curve("wavelength_nm", kelvin).unwrap().at(600.0)
        };
        let molecules = |k: usize, kelvin: &str| air.vertical_optical_depth(k, 0) / sigma(kelvin);
        let all =
            molecules(1, "sigma_223K") + molecules(2, "sigma_243K") + molecules(3, "sigma_293K");
        let dobson = all / DOBSON;
        assert!((dobson - 345.0).abs() < 10.0, "{dobson} DU");
    }

    #[test]
    fn ozone_has_the_column_that_is_asked_for() {
        let depth = |ozone| {
            let variation = Variation {
                ozone,
                ..Variation::default()
            };
            let particles = Particles::HenyeyGreenstein;
            let air = real_varied(59_400.0, &[600.0], particles, variation).unwrap();
            (1..4)
                .map(|k| air.vertical_optical_depth(k, 0))
                .sum::<f64>()
        };
        assert_eq!(depth(Some(0.0)), 0.0);
        let (hole, twice) = (depth(Some(100.0)), depth(Some(200.0)));
        assert!((twice / hole - 2.0).abs() < 1e-9);
        let standard = 100.0 * depth(None) / hole;
        assert!((standard - 345.0).abs() < 10.0, "{standard} DU");
    }

    #[test]
    fn water_and_mixed_gases_have_their_columns() {
        let light = Monochromatic {
            wavelength: 940.0,
            water: 2.0,
            mixed: 0.7,
        };
        let air = real_at(59_400.0, &[light], Particles::HenyeyGreenstein).unwrap();
        let precipitable = air.vertical_optical_depth(4, 0) / 2.0;
        assert!((precipitable - 1.42).abs() < 0.02, "{precipitable} cm");
        let beside = real(59_400.0, &[940.0]).unwrap();
        let mixed = air.vertical_optical_depth(0, 0) - beside.vertical_optical_depth(0, 0);
        assert!((mixed - 0.7).abs() < 1e-9);
        assert_eq!(beside.vertical_optical_depth(4, 0), 0.0);
    }

    #[test]
    fn extinction_at_the_ground_gives_the_stated_visibility() {
        for v in [20_000.0, 25_000.0, 40_000.0, 59_400.0, 75_000.0, 131_800.0] {
            let air = real(v, &[550.0]).unwrap();
            let stated = 3.912 / (air.extinction(0.0, 0) - ozone_extinction(&air));
            assert!((stated / v - 1.0).abs() < 2e-3, "{v}: {stated}");
        }
    }

    fn ozone_extinction(air: &Atmosphere) -> f64 {
        (1..4)
            .map(|k| air.profile(k, 0.0) * air.constituents[k].extinction[0])
            .sum()
    }

    #[test]
    fn what_cannot_be_is_refused() {
        assert!(real(10_000.0, &[550.0]).is_err());
        assert!(real(f64::NAN, &[550.0]).is_err());
        assert!(real(40_000.0, &[200.0]).is_err());
        assert!(real_with(40_000.0, &[800.0], Particles::Mie).is_err());
        for dobson in [-1.0, 1e4, f64::NAN] {
            let variation = Variation {
                ozone: Some(dobson),
                ..Variation::default()
            };
            let air = real_varied(40_000.0, &[550.0], Particles::Mie, variation);
            assert!(air.unwrap_err().to_string().contains("ozone"));
        }
    }
}
