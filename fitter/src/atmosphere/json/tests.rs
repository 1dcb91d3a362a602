//! Files that are read, refused, and written again.

use super::super::Phase;
use super::*;

const GOOD: &str = r#"{"id": "x", "wavelength_nm": 550, "planet_radius_m": 6371000.0, "toa_altitude_m": 2000.0,
    "ground_albedo": 0.3, "sun_elevation_deg": 20.0, "altitude_m": [0.0, 1000.0, 2000.0], "checks": {"any": 1},
    "species": [
      {"name": "air", "kind": "rayleigh", "extinction_per_m": [2e-5, 1e-5, 0.0], "single_scattering_albedo": 1.0, "depolarisation": 0.03},
      {"name": "soot", "kind": "henyey_greenstein", "extinction_per_m": [4e-5, 2e-5, 0.0], "single_scattering_albedo": 0.2, "g": 0.3},
      {"name": "o3", "kind": "absorber", "extinction_per_m": [0.0, 1e-6, 1e-6]}],
    "columns": ["obs_alt_m", "T"], "rows": [[0.0, null]]}"#;

#[test]
fn species_of_one_shape_share_a_constituent() {
    let case = Case::parse(GOOD).unwrap();
    assert_eq!(case.atmosphere.constituents.len(), 2);
    assert_eq!(case.atmosphere.constituents[0].scatterers.len(), 2);
    let there = case.atmosphere.extinction(500.0, 0);
    assert!((there - 4.55e-5).abs() < 1e-15, "{there}");
    assert_eq!(case.value(0, "obs_alt_m").unwrap(), 0.0);
}

#[test]
fn bad_files_are_refused_by_field() {
    for (from, to, names) in [
        ("\"wavelength_nm\": 550,", "", "wavelength_nm"),
        (
            "\"planet_radius_m\": 6371000.0",
            "\"planet_radius_m\": -1",
            "planet_radius_m",
        ),
        ("6371000.0", "NaN", "line 1"),
        (
            "\"ground_albedo\": 0.3",
            "\"ground_albedo\": 1.3",
            "ground_albedo",
        ),
        (
            "[0.0, 1000.0, 2000.0]",
            "[0.0, 1000.0, 900.0]",
            "altitude_m[2]",
        ),
        (
            "[0.0, 1000.0, 2000.0]",
            "[10.0, 1000.0, 2000.0]",
            "altitude_m[0]",
        ),
        (
            "\"toa_altitude_m\": 2000.0",
            "\"toa_altitude_m\": 3000.0",
            "toa_altitude_m",
        ),
        (
            "[2e-5, 1e-5, 0.0]",
            "[2e-5, -1e-5, 0.0]",
            "extinction_per_m[1]",
        ),
        ("[2e-5, 1e-5, 0.0]", "[2e-5, 1e-5]", "extinction_per_m"),
        (
            "[2e-5, 1e-5, 0.0]",
            "[2e300, 1e-5, 0.0]",
            "extinction_per_m[0]",
        ),
        ("\"g\": 0.3", "\"g\": 1.0", "g = 1"),
        (", \"g\": 0.3", "", "g is missing"),
        (
            "\"depolarisation\": 0.03",
            "\"depolarisation\": -0.1",
            "depolarisation",
        ),
        (
            "\"single_scattering_albedo\": 0.2",
            "\"single_scattering_albedo\": 2",
            "single_scattering_albedo",
        ),
        ("\"absorber\"", "\"mie\"", "mie"),
        (
            "\"absorber\", \"extinction_per_m\"",
            "\"absorber\", \"extinction_per_km\"",
            "extinction_per_km",
        ),
        ("[[0.0, null]]", "[[0.0]]", "rows[0]"),
    ] {
        let bad = GOOD.replace(from, to);
        assert_ne!(bad, GOOD, "{from}");
        let message = format!("{:#}", Case::parse(&bad).unwrap_err());
        assert!(message.contains(names), "{names}: {message}");
    }
}

/// Two wavelengths; soot has its own profile at the second.
const SPECTRAL: &str = r#"{"wavelength_nm": [440, 550], "planet_radius_m": 6371000.0, "toa_altitude_m": 2000.0,
    "ground_albedo": 0.3, "sun_elevation_deg": 20.0, "altitude_m": [0.0, 1000.0, 2000.0],
    "species": [
      {"name": "air", "kind": "rayleigh", "extinction_per_m": [[4e-5, 2e-5, 0.0], [2e-5, 1e-5, 0.0]], "single_scattering_albedo": 1.0, "depolarisation": [0.03, 0.02]},
      {"name": "soot", "kind": "henyey_greenstein", "extinction_per_m": [[4e-5, 2e-5, 0.0], [3e-5, 3e-5, 0.0]], "single_scattering_albedo": [0.2, 0.1], "g": 0.3},
      {"name": "o3", "kind": "absorber", "extinction_per_m": [[0.0, 0.0, 0.0], [0.0, 1e-6, 1e-6]]},
      {"name": "grey", "kind": "absorber", "extinction_per_m": [1e-6, 0.0, 0.0]}]}"#;

#[test]
fn species_may_depend_on_the_wavelength() {
    let air = Case::parse(SPECTRAL).unwrap().atmosphere;
    assert_eq!(air.wavelengths, [440.0, 550.0]);
    // Soot of the first wavelength has the shape of the air.
    assert_eq!(air.constituents.len(), 4);
    for (altitude, w, expected) in [
        (0.0, 0, 8.1e-5),
        (1000.0, 0, 4e-5),
        (0.0, 1, 5.1e-5),
        (1000.0, 1, 4.1e-5),
    ] {
        let there = air.extinction(altitude, w);
        assert!((there - expected).abs() < 1e-18, "{there} for {expected}");
    }
    let soot = |k: usize| air.constituents[k].scatterers.last().unwrap();
    assert_eq!(soot(0).scattering, [0.2 * 4e-5, 0.0]);
    assert_eq!(soot(1).scattering, [0.0, 0.1 * 3e-5]);
}

#[test]
fn what_is_written_is_read_back() {
    for text in [GOOD, SPECTRAL] {
        let case = Case::parse(text).unwrap();
        let again = Case::parse(&case.to_json().unwrap()).unwrap();
        assert_eq!(again.id, case.id);
        assert_eq!((again.columns, again.rows), (case.columns, case.rows));
        let (a, b) = (&again.atmosphere, &case.atmosphere);
        assert_eq!(
            (a.planet_radius, &a.altitudes),
            (b.planet_radius, &b.altitudes)
        );
        assert_eq!(a.wavelengths, b.wavelengths);
        for w in 0..a.wavelengths.len() {
            for z in [0.0, 250.0, 1000.0, 1500.0, 2000.0] {
                let (a, b) = (a.extinction(z, w), b.extinction(z, w));
                assert!((a - b).abs() <= 1e-14 * b, "{z} m: {a} for {b}");
            }
        }
    }
}

#[test]
fn an_atmosphere_that_is_no_file_is_an_error() {
    let good = Case::parse(SPECTRAL).unwrap();
    let refusal = |change: &dyn Fn(&mut Case)| {
        let mut bad = good.clone();
        change(&mut bad);
        format!("{:#}", bad.to_json().unwrap_err())
    };
    let mie = super::super::mie::matrix("waso", &good.atmosphere.wavelengths).unwrap();
    let phase = Phase::Tabulated(std::sync::Arc::new(mie));
    let message = refusal(&|c| c.atmosphere.constituents[0].scatterers[0].phase = phase.clone());
    assert!(
        message.contains("Henyey-Greenstein scattering only"),
        "{message}"
    );
    let message = refusal(&|c| c.atmosphere.constituents[1].extinction[1] = 0.0);
    assert!(message.contains("extinction_per_m"), "{message}");
    let message = refusal(&|c| c.albedo = f64::NAN);
    assert!(message.contains("ground_albedo = NaN"), "{message}");
    let message = refusal(&|c| c.atmosphere.wavelengths[1] = 440.0);
    assert!(message.contains("wavelength_nm[1]"), "{message}");
}

#[test]
fn lists_that_do_not_fit_the_wavelengths_are_refused_by_field() {
    for (from, to, names) in [
        ("[440, 550]", "[550, 440]", "wavelength_nm[1]"),
        ("[440, 550]", "[]", "wavelength_nm is empty"),
        (
            "[440, 550]",
            "[440, 550, 660]",
            "extinction_per_m has 2 entries for 3",
        ),
        ("[440, 550]", "440", "extinction_per_m has 2 entries for 1"),
        ("[440, 550]", "\"green\"", "a number for each wavelength"),
        (
            "[3e-5, 3e-5, 0.0]",
            "[3e-5, -3e-5, 0.0]",
            "extinction_per_m[1][1]",
        ),
        (
            "[3e-5, 3e-5, 0.0]",
            "[3e-5, 3e-5]",
            "extinction_per_m[1] has 2 values for 3",
        ),
        ("[0.2, 0.1]", "[0.2, 1.1]", "single_scattering_albedo[1]"),
        (
            "[0.03, 0.02]",
            "[0.03]",
            "depolarisation has 1 entries for 2",
        ),
        ("\"g\": 0.3", "\"g\": [0.3, 1.0]", "g[1] = 1"),
    ] {
        let bad = SPECTRAL.replace(from, to);
        assert_ne!(bad, SPECTRAL, "{from}");
        let message = format!("{:#}", Case::parse(&bad).unwrap_err());
        assert!(message.contains(names), "{names}: {message}");
    }
}
