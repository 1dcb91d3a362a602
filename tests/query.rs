//! `welkin query` on many rows: the answers of prepared skies and aerial perspectives, row by row.
#![cfg(feature = "cli")]

mod common;

use std::path::Path;
use std::process::Output;
use std::sync::LazyLock;

use common::command::{QUANTITIES, run};
use common::random::Random;
use welkin::{Conditions, Model, PolarisationFrame, Stokes};

const HEADER: &str = "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,distance_m,wavelength_nm";

/// Of wavelengths of the embedded model, nm.
static RANGE: LazyLock<[f64; 2]> =
    LazyLock::new(|| Model::default_model().unwrap().wavelength_range().unwrap());

fn query(arguments: &[&str], table: String) -> Output {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    run(folder, &[&["query"], arguments].concat(), table)
}

/// Value and error of each row.
fn answers(output: &Output) -> Vec<(Option<f32>, String)> {
    assert!(output.status.success(), "{output:?}");
    let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
    let rows = reader.records().map(|row| row.unwrap());
    rows.map(|row| (row[9].parse().ok(), row[10].to_owned()))
        .collect()
}

/// A row, as numbers in the order of the columns.
#[derive(Clone, Debug)]
struct Row {
    quantity: &'static str,
    numbers: [f64; 8],
}

impl Row {
    fn random(quantity: &'static str, random: &mut Random) -> Self {
        let elevation = random.between(-12.0, 90.0);
        let beside = |random: &mut Random| random.between(-0.25, 0.25);
        let of_sun = quantity == "sun_radiance";
        let zenith = match of_sun {
            true => (90.0 - elevation + beside(random)).clamp(0.0, 180.0),
            false => random.between(-1.0, 1.0).acos().to_degrees(),
        };
        let azimuth = match of_sun {
            true => beside(random),
            false => random.between(-180.0, 180.0),
        };
        let radiance = quantity.contains("radiance");
        // An aerial perspective takes long to prepare.
        let endless = match quantity {
            "transmittance" | "in_scattering" => 0.3,
            _ => 0.95,
        };
        let distance = match radiance || random.share() < endless {
            true => f64::INFINITY,
            false => 10f64.powf(random.between(0.0, 5.5)),
        };
        let visibility = 1.0 / random.between(1.0 / 131.8, 1.0 / 20.0);
        let [shortest, longest] = *RANGE;
        let altitude = 15e3 * random.share().powi(3);
        let numbers = [
            visibility,
            random.share(),
            altitude,
            elevation,
            zenith,
            azimuth,
            distance,
            random.between(shortest, longest),
        ];
        Self { quantity, numbers }
    }

    /// Makes one of the numbers wrong; says what the error begins with.
    fn spoil(&mut self, random: &mut Random) -> &'static str {
        let (column, value, error) = [
            (0, 5.0, "visibility must be in"),
            (1, f64::NAN, "albedo must be in"),
            (2, -501.0, "altitude must be in"),
            (3, -12.1, "solar elevation must be in"),
            (4, 180.5, "view_zenith_deg must be in 0..=180"),
            (5, f64::INFINITY, "view_azimuth_deg must be finite"),
            (6, -1.0, "distance_m must"),
            (7, 2000.0, "wavelength must be in"),
        ][(random.share() * 8.0) as usize];
        self.numbers[column] = value;
        error
    }

    fn text(&self) -> String {
        let cells = self.numbers.map(|number| format!("{number:?}"));
        format!("{},{}\n", self.quantity, cells.join(","))
    }

    fn conditions(&self) -> Conditions {
        let [visibility, albedo, altitude, elevation, ..] = self.numbers;
        Conditions {
            solar_elevation: elevation.to_radians(),
            solar_azimuth: 0.0,
            visibility: 1e3 * visibility,
            albedo,
            altitude,
        }
    }

    /// What a sky or an aerial perspective that is prepared for this row alone says, and what an error of it is
    /// relative to.
    fn expected(&self, model: &Model) -> (f32, f32) {
        let [_, _, altitude, _, zenith, azimuth, distance, wavelength] = self.numbers;
        let (r, z) = zenith.to_radians().sin_cos();
        let (y, x) = azimuth.to_radians().sin_cos();
        let unit = [r * x, r * y, z];
        let (conditions, direction) = (self.conditions(), unit.map(|v| v as f32));
        let irradiance = model.head().solar_irradiance_at(wavelength) as f32;
        let nodes = model.wavelengths();
        let over_sun = |light: &mut [f32]| {
            for (light, &node) in light.iter_mut().zip(nodes) {
                *light /= model.head().solar_irradiance_at(node) as f32;
            }
            let interpolation = model.spectral_interpolation().unwrap();
            interpolation.between(light, wavelength).unwrap()
        };
        let own = |value: f32| (value, value.abs());
        match self.quantity {
            "radiance" => {
                let sky = model.sky(&conditions).unwrap();
                own(sky.radiance_at(direction, wavelength).unwrap())
            }
            "relative_radiance" => {
                let sky = model.sky(&conditions).unwrap();
                own(sky.relative_radiance_at(direction, wavelength).unwrap())
            }
            "sun_radiance" => {
                let disc = model.solar_disc(&conditions).unwrap();
                own(disc.radiance_at(direction, wavelength).unwrap())
            }
            "transmittance" => {
                let air = model.transmittance(conditions.visibility).unwrap();
                let from = [0.0, 0.0, altitude];
                let to = std::array::from_fn(|k| from[k] + distance * unit[k]);
                let through = match distance.is_finite() {
                    true => air.transmittance_at(from, to, wavelength),
                    false => air.transmittance_to_end_at(from, unit, wavelength),
                };
                own(through.unwrap())
            }
            "in_scattering" => {
                let aerial = model.aerial_perspective(&conditions).unwrap();
                let (mut light, mut through) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
                let from = [0.0, 0.0, altitude];
                let to = std::array::from_fn(|k| from[k] + distance * unit[k]);
                match distance.is_finite() {
                    true => aerial.in_scattering(from, to, &mut light, &mut through),
                    false => aerial.to_end(from, unit, &mut light, &mut through),
                }
                .unwrap();
                own(irradiance * over_sun(&mut light))
            }
            _ => {
                let frame = match self.quantity {
                    "polarisation" => PolarisationFrame::SunAligned,
                    _ => PolarisationFrame::Vertical,
                };
                let light: Stokes = if distance.is_finite() {
                    let from = [0.0, 0.0, altitude];
                    let to = std::array::from_fn(|k| from[k] + distance * unit[k]);
                    let aerial = model.aerial_perspective(&conditions).unwrap();
                    let light = aerial.relative_stokes_at(from, to, frame, wavelength);
                    let light = light.unwrap();
                    let [i, q, u] = [light.i, light.q, light.u].map(|v| irradiance * v);
                    Stokes { i, q, u }
                } else {
                    let sky = model.polarised_sky(&conditions).unwrap();
                    sky.stokes_at(direction, frame, wavelength).unwrap()
                };
                match self.quantity {
                    "polarisation" => (light.signed_degree(), 1.0),
                    "stokes_q" => (light.q, light.i),
                    _ => (light.u, light.i),
                }
            }
        }
    }
}

#[test]
fn random_rows_are_answered_as_by_what_is_prepared_for_them_alone() {
    let model = Model::default_model().unwrap();
    let mut random = Random(1);
    let mut rows = Vec::new();
    for quantity in QUANTITIES {
        // An aerial perspective takes twenty times as long to prepare as a sky.
        let count = match quantity {
            "transmittance" | "in_scattering" => 120,
            "polarisation" | "stokes_q" | "stokes_u" => 500,
            _ => 1500,
        };
        rows.extend((0..count).map(|_| (Row::random(quantity, &mut random), None)));
    }
    for row in rows.iter_mut().step_by(9) {
        row.1 = Some(row.0.spoil(&mut random));
    }
    // Rows of all quantities side by side.
    for i in (1..rows.len()).rev() {
        rows.swap(i, (random.share() * (i + 1) as f64) as usize);
    }
    let texts: String = rows.iter().map(|(row, _)| row.text()).collect();
    let output = query(&[], format!("{HEADER}\n{texts}"));
    let answers = answers(&output);
    assert_eq!(answers.len(), rows.len());
    for ((row, error), (value, text)) in rows.iter().zip(&answers) {
        match error {
            Some(error) => assert!(value.is_none() && text.starts_with(error), "{row:?} {text}"),
            None => {
                let (expected, size) = row.expected(&model);
                let got = value.unwrap_or(f32::NAN);
                // Dark transmittances lose digits in the exponential.
                let depth = -expected.abs().max(f32::MIN_POSITIVE).ln().min(0.0);
                let tolerance = match row.quantity {
                    "transmittance" => 1e-6 * depth.max(1.0),
                    _ => 1e-5,
                };
                assert!(
                    // A hair above the ground there is next to no air to look down through.
                    (got - expected).abs() <= tolerance * size + 1e-11,
                    "{row:?} {got} {expected} {text}"
                );
            }
        }
    }
    // Neither threads nor neighbours count: the first rows alone, by one thread.
    let few: String = rows[..300].iter().map(|(row, _)| row.text()).collect();
    let alone = query(&["--threads", "1"], format!("{HEADER}\n{few}"));
    assert!(output.stdout.starts_with(&alone.stdout));
}

#[test]
fn rows_that_differ_in_the_wavelength_only_share_no_answer() {
    let row = |quantity: &str, nm: f64| format!("{quantity},50,0.2,0,30,60,30,,{nm}\n");
    let mut table = format!("{HEADER}\n");
    for nm in [450.0, 650.0] {
        table += &row("radiance", nm);
        table += &row("relative_radiance", nm);
        table += &row("in_scattering", nm);
        table += &row("transmittance", nm);
    }
    let answers: Vec<f32> = answers(&query(&[], table))
        .iter()
        .map(|(value, _)| value.unwrap())
        .collect();
    for (blue, red) in answers[..4].iter().zip(&answers[4..]) {
        assert!((blue / red - 1.0).abs() > 0.01, "{answers:?}");
    }
    assert!((answers[0] / answers[2] - 1.0).abs() < 0.05, "{answers:?}");
}

#[test]
fn more_rows_than_a_block_stay_in_order() {
    const ROWS: usize = 70_000;
    let row = |i: usize| {
        let elevation = (i * 7919) % 90;
        format!("radiance,50,0.2,0,{elevation},60,30,,{}\n", 320 + i % 440)
    };
    let rows: String = (0..ROWS).map(row).collect();
    let output = query(&[], format!("{HEADER}\n{rows}"));
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), ROWS + 1);
    for (line, i) in text.lines().skip(1).zip(0..) {
        let asked = row(i);
        assert!(
            line.starts_with(asked.trim_end()) && line.ends_with(','),
            "{line}"
        );
    }
}

#[test]
fn foreign_separators_and_decimal_commas_get_a_hint() {
    let header = HEADER.replace(',', ";");
    let refused = |table: String| {
        let output = query(&[], table);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let text = refused(format!("{header}\nradiance;50;0,2;0;30;60;30;;550\n"));
    assert!(text.contains("separated by semicolons"), "{text}");
    let text = refused(HEADER.replace(',', "\t"));
    assert!(text.contains("separated by tabs"), "{text}");
    let text = refused(HEADER.replace("albedo", "reflectance"));
    assert!(
        text.contains("lacks the column \"albedo\"") && !text.contains("separated"),
        "{text}"
    );
    let table =
        format!("{HEADER}\nradiance,50,\"0,2\",0,30,60,30,,550\nradiance,50,0,2,0,30,60,30,,550\n");
    let answers = answers(&query(&[], table));
    assert!(
        answers[0]
            .1
            .contains("decimals are written with a point, 0.2")
    );
    assert!(answers[1].1.contains("expected 9 cells, got 10 (decimals"));
}

#[test]
fn a_broken_chunk_spoils_only_the_rows_that_need_it() {
    let model = Model::default_model().unwrap();
    let damaged = (model.directory().iter())
        .find(|e| e.kind == welkin::format::Kind::Radiance)
        .unwrap();
    let (altitude, visibility) = (damaged.altitude.unwrap(), damaged.visibility.unwrap());
    let mut bytes = welkin::DEFAULT_MODEL.to_vec();
    bytes[damaged.offset + damaged.length / 2] ^= 1;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("damaged.welkin");
    std::fs::write(&file, bytes).unwrap();
    let row = |a: usize, v: usize| {
        let (h, km) = (
            model.head().altitudes[a],
            1e-3 * model.head().visibilities[v],
        );
        format!("radiance,{km},0.2,{h},30,60,30,,550\n")
    };
    let far = (
        model.head().altitudes.len() - 1,
        model.head().visibilities.len() - 1,
    );
    let table = format!(
        "{HEADER}\n{}{}",
        row(altitude, visibility),
        row(far.0, far.1)
    );
    let answers = answers(&query(&["--model", file.to_str().unwrap()], table));
    assert!(answers[0].1.contains("damaged"), "{answers:?}");
    assert!(answers[1].0.is_some(), "{answers:?}");
}

/// The air is the same from 99 km and from beyond it; a sky is not asked there.
#[test]
fn air_is_asked_from_orbit() {
    let row = |quantity: &str, altitude: f64, distance: &str| {
        format!("{quantity},59.4,0.2,{altitude},20,180,0,{distance},550\n")
    };
    let mut table = format!("{HEADER}\n");
    for quantity in ["transmittance", "in_scattering"] {
        for altitude in [99e3, 4e5] {
            table += &row(quantity, altitude, "");
        }
    }
    table += &row("stokes_q", 99e3, "99000");
    table += &row("stokes_q", 4e5, "400000");
    table += &row("radiance", 4e5, "");
    for arguments in [&[][..], &["--wavelengths", "550"]] {
        // Bands have no wavelength of their own.
        let table = match arguments.is_empty() {
            true => table.clone(),
            false => table.replace(",wavelength_nm", "").replace(",550\n", "\n"),
        };
        let output = query(arguments, table);
        assert!(output.status.success(), "{output:?}");
        let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
        let rows: Vec<_> = reader.records().map(|row| row.unwrap()).collect();
        let value = |i: usize| -> f64 { rows[i][rows[i].len() - 2].parse().unwrap() };
        for pair in [[0, 1], [2, 3], [4, 5]] {
            let [below, beyond] = pair.map(value);
            assert!(
                (beyond - below).abs() <= 1e-4 * below.abs() + 1e-9,
                "{pair:?}"
            );
        }
        assert!(rows[6][rows[6].len() - 1].contains("altitude must be in"));
    }
}
