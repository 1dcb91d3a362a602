//! The command: exit codes, messages, tables in and out.
#![cfg(feature = "cli")]

mod common;

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use common::command::run;
use welkin::{Conditions, Model, PolarisationFrame};

struct Bench {
    folder: tempfile::TempDir,
    model: PathBuf,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let model = folder.path().join("model.welkin");
        std::fs::write(&model, common::polarised_bytes(0.02)).unwrap();
        Self { folder, model }
    }

    fn run(&self, arguments: &[&str], input: &str) -> Output {
        run(self.folder.path(), arguments, input)
    }

    fn on_model(&self, arguments: &[&str], input: &str) -> Output {
        let model = ["--model", self.model.to_str().unwrap()];
        self.run(&[arguments, &model].concat(), input)
    }

    /// The one line that a refused call prints.
    fn refusal(&self, arguments: &[&str], input: &str) -> String {
        let output = self.run(arguments, input);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(
            text.starts_with("welkin: ") && !text.contains("panicked"),
            "{text}"
        );
        text
    }
}

const HEADER: &str = "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,distance_m,wavelength_nm";

#[test]
fn query_answers_what_the_library_answers() {
    let bench = Bench::new();
    let table = format!(
        "{HEADER}\nradiance,59.4,0.2,120,20,60,30,,550\nrelative_radiance,59.4,0.2,120,20,60,30,,550\n"
    );
    let output = bench.on_model(&["query"], &table);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], format!("{HEADER},value,error"));
    let model = Model::open(&bench.model).unwrap();
    let sky = model
        .sky(&Conditions {
            altitude: 120.0,
            ..Conditions::default()
        })
        .unwrap();
    let (z, r) = 30f64.to_radians().sin_cos();
    let (y, x) = 30f64.to_radians().sin_cos();
    let direction = [r * x, r * y, z].map(|v| v as f32);
    for (line, expected) in lines[1..].iter().zip([
        sky.radiance_at(direction, 550.0).unwrap(),
        sky.relative_radiance_at(direction, 550.0).unwrap(),
    ]) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells[..3], line.split(',').take(3).collect::<Vec<_>>()[..]);
        let value: f32 = cells[9].parse().unwrap();
        assert!((value / expected - 1.0).abs() < 1e-6);
        assert_eq!(cells[10], "");
    }
}

#[test]
fn columns_come_in_any_order_and_others_are_echoed() {
    let bench = Bench::new();
    let table = "note,wavelength_nm,view_azimuth_deg,view_zenith_deg,solar_elevation_deg,altitude_m,albedo,visibility_km,quantity\n\"a, b\",550,0,10,20,0,0.2,59.4,radiance\n";
    let output = bench.on_model(&["query"], table);
    let text = String::from_utf8(output.stdout).unwrap();
    let row = text.lines().nth(1).unwrap();
    assert!(
        row.starts_with("\"a, b\",550,0,10,20,0,0.2,59.4,radiance,0."),
        "{row}"
    );
}

#[test]
fn bad_rows_get_an_error_and_good_ones_a_value() {
    let bench = Bench::new();
    let rows = [
        ("radiance,59.4,0.2,0,20,60,30,,550", ""),
        (
            "radiance,5,0.2,0,20,60,30,,550",
            "visibility must be in 20..=131.8 km, got 5",
        ),
        (
            "radiance,59.4,nan,0,20,60,30,,550",
            "albedo must be in 0..=1, got NaN",
        ),
        (
            "radiance,59.4,0.2,0,-12.1,60,30,,550",
            "solar elevation must be in -4.2..=90 degrees, got -12.1",
        ),
        (
            "radiance,59.4,0.2,0,20,181,30,,550",
            "view_zenith_deg must be in 0..=180, got 181",
        ),
        (
            "radiance,59.4,0.2,0,20,60,inf,,550",
            "view_azimuth_deg must be finite, got inf",
        ),
        (
            "radiance,59.4,0.2,0,20,60,30,,1550",
            "wavelength must be in 320..=760 nm, got 1550",
        ),
        ("radiance,59.4,0.2,,20,60,30,,550", "altitude_m is empty"),
        (
            "radiance,59.4,0.2,1 m,20,60,30,,550",
            "altitude_m must be a number",
        ),
        (
            "radiance,59.4,0.2,0,20,60,30,100,550",
            "distance_m must be empty",
        ),
        (
            "transmittance,59.4,0.2,0,20,60,30,,550",
            "the file has no transmittance",
        ),
        ("brightness,59.4,0.2,0,20,60,30,,550", "unknown quantity"),
        ("radiance,59.4", "expected 9 cells, got 2"),
        ("radiance,59.4,0.2,0,-4.2,0,0,inf,320", ""),
        ("radiance,131.8,1,2000,90,180,0,,760", ""),
    ];
    let lines: Vec<&str> = rows.iter().map(|(row, _)| *row).collect();
    let table = format!("{HEADER}\n{}\n", lines.join("\n"));
    let output = bench.on_model(&["query"], &table);
    assert!(output.status.success());
    let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
    let answers: Vec<csv::StringRecord> = reader.records().map(|r| r.unwrap()).collect();
    assert_eq!(answers.len(), rows.len());
    for ((row, error), answer) in rows.iter().zip(&answers) {
        assert!(answer[10].starts_with(error), "{row}: {}", &answer[10]);
        assert_eq!(
            answer[10].is_empty(),
            error.is_empty(),
            "{row}: {}",
            &answer[10]
        );
        assert_eq!(answer[9].parse::<f32>().is_ok(), error.is_empty(), "{row}");
    }
    let model = bench.model.to_str().unwrap();
    let text = bench.refusal(&["query", "--strict", "--model", model], &table);
    assert!(text.contains("12 of 15 rows failed"), "{text}");
    let clamped = bench.on_model(&["query", "--clamp"], &format!("{HEADER}\n{}\n", rows[1].0));
    assert!(
        String::from_utf8(clamped.stdout)
            .unwrap()
            .trim_end()
            .ends_with(',')
    );
}

#[test]
fn info_describes_the_file() {
    let bench = Bench::new();
    let output = bench.on_model(&["info", "--json"], "");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["file_bytes"], common::polarised_bytes(0.02).len());
    assert_eq!(json["altitudes_m"][1], 120.0);
    assert_eq!(json["chunks"].as_array().unwrap().len(), 30);
    assert_eq!(
        json["metadata"]["provenance"],
        "synthetic model for tests: not a sky"
    );
    let human = bench.run(&["info"], "");
    assert!(human.status.success());
    assert!(
        String::from_utf8(human.stdout)
            .unwrap()
            .contains("file_bytes")
    );
}

#[test]
fn render_writes_pictures_and_says_what_they_show() {
    let bench = Bench::new();
    for projection in ["up", "side", "lat-long"] {
        let out = format!("picture-{projection}");
        let output = bench.on_model(
            &[
                "render",
                "--size",
                "16",
                "--projection",
                projection,
                "--out",
                &out,
            ],
            "",
        );
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let text = String::from_utf8(output.stdout).unwrap();
        for word in ["sun", "visibility", "cd/m²", "time", "touched"] {
            assert!(text.contains(word), "{text}");
        }
        let png = std::fs::read(bench.folder.path().join(format!("{out}.png"))).unwrap();
        assert_eq!(&png[1..4], b"PNG");
        let exr = exr::prelude::read_first_rgba_layer_from_file(
            bench.folder.path().join(format!("{out}.exr")),
            |size, _| vec![[0f32; 4]; size.width() * size.height()],
            |pixels, at, pixel: (f32, f32, f32, f32)| pixels[at.x() + 16 * at.y()] = pixel.into(),
        );
        assert!(projection == "lat-long" || exr.is_ok());
    }
    let output = bench.on_model(
        &["render", "--size", "8", "--spectral", "--out", "only.exr"],
        "",
    );
    assert!(output.status.success());
    assert!(!bench.folder.path().join("only.png").exists());
    let image = exr::prelude::read_first_flat_layer_from_file(bench.folder.path().join("only.exr"))
        .unwrap();
    let names: Vec<String> = image
        .layer_data
        .channel_data
        .list
        .iter()
        .map(|c| c.name.to_string())
        .collect();
    assert_eq!(names[0], "S0.320nm");
    assert_eq!(names.len(), 6);
}

#[test]
fn refusals_are_one_line_and_code_2() {
    let bench = Bench::new();
    let model = bench.model.to_str().unwrap().to_owned();
    let calls: &[(&[&str], &str)] = &[
        (&[], "command is missing"),
        (&["paint"], "paint"),
        (&["render", "--size", "0"], "size"),
        (&["render", "--size", "many"], "size"),
        (
            &["render", "--model", &model, "--sun-elevation", "nan"],
            "solar elevation",
        ),
        (
            &["render", "--model", &model, "--sun-azimuth", "inf"],
            "solar azimuth",
        ),
        (
            &["render", "--model", &model, "--visibility", "-1"],
            "visibility",
        ),
        (&["render", "--model", &model, "--albedo", "1.5"], "albedo"),
        (
            &["render", "--model", &model, "--altitude", "1e9"],
            "altitude",
        ),
        (
            &["render", "--model", &model, "--view-azimuth", "nan"],
            "view azimuth",
        ),
        (
            &["render", "--model", &model, "--exposure", "nan"],
            "exposure",
        ),
        (
            &[
                "render",
                "--model",
                &model,
                "--size",
                "4",
                "--out",
                "missing/sky",
            ],
            "missing/sky",
        ),
        (&["render", "--model", "missing.welkin"], "missing.welkin"),
        (&["info", "missing.welkin"], "missing.welkin"),
        (&["info", "."], "directory"),
        (&["query", "--model", &model, "missing.csv"], "missing.csv"),
        (&["query", "--model", &model], "lacks the column"),
    ];
    for (arguments, word) in calls {
        let text = bench.refusal(arguments, "");
        assert!(text.contains(word), "{arguments:?}: {text}");
    }
    let twice = format!("{HEADER},albedo\n");
    assert!(
        bench
            .refusal(&["query", "--model", &model], &twice)
            .contains("two columns")
    );
    std::fs::write(
        bench.folder.path().join("bad.welkin"),
        &common::model_bytes()[..5000],
    )
    .unwrap();
    assert!(
        bench
            .refusal(&["info", "bad.welkin"], "")
            .contains("truncated")
    );
}

#[test]
fn a_damaged_chunk_is_noticed_when_it_is_needed() {
    let bench = Bench::new();
    let mut bytes = common::model_bytes();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&bench.model, bytes).unwrap();
    assert!(bench.on_model(&["info"], "").status.success());
    assert!(
        bench
            .on_model(&["render", "--size", "4"], "")
            .status
            .success()
    );
    let model = bench.model.to_str().unwrap();
    // The last chunk: highest altitude and visibility; the last byte is padding, which the checksum covers too.
    let far = [
        "render",
        "--size",
        "4",
        "--altitude",
        "2000",
        "--visibility",
        "131.8",
        "--model",
        model,
    ];
    assert!(bench.refusal(&far, "").contains("damaged"));
    let verdict = bench.run(&["verify", model], "");
    assert_eq!(verdict.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&verdict.stdout).contains("damaged"));
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let bench = Bench::new();
    let row = "radiance,59.4,0.2,0,20,60,30,,550\n";
    let mut child = Command::new(env!("CARGO_BIN_EXE_welkin"))
        .args(["query", "--model", bench.model.to_str().unwrap()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut input = child.stdin.take().unwrap();
    let _ = input.write_all(HEADER.as_bytes());
    let _ = input.write_all(b"\n");
    for _ in 0..5000 {
        let _ = input.write_all(row.as_bytes());
    }
    drop(input);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(output.stderr.is_empty());
}

#[test]
fn query_answers_polarisation() {
    let bench = Bench::new();
    let quantities = ["radiance", "polarisation", "stokes_q", "stokes_u"];
    let rows = quantities.map(|q| format!("{q},59.4,0.2,500,20,60,30,,543\n"));
    let output = bench.on_model(
        &["query", "--strict"],
        &format!("{HEADER}\n{}", rows.concat()),
    );
    assert!(output.status.success());
    let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
    let values = reader
        .records()
        .map(|row| row.unwrap()[9].parse::<f32>().unwrap());
    let got: Vec<f32> = values.collect();
    let model = Model::open(&bench.model).unwrap();
    let conditions = Conditions {
        altitude: 500.0,
        ..Conditions::default()
    };
    let sky = model.polarised_sky(&conditions).unwrap();
    let (z, r) = 30f64.to_radians().sin_cos();
    let (y, x) = 30f64.to_radians().sin_cos();
    let direction = [r * x, r * y, z].map(|v| v as f32);
    let aligned = sky
        .stokes_at(direction, PolarisationFrame::SunAligned, 543.0)
        .unwrap();
    let vertical = sky
        .stokes_at(direction, PolarisationFrame::Vertical, 543.0)
        .unwrap();
    let expected = [aligned.i, aligned.q / aligned.i, vertical.q, vertical.u];
    for (got, expected) in got.into_iter().zip(expected) {
        assert!(
            (got - expected).abs() <= 1e-5 * expected.abs(),
            "{got} {expected}"
        );
    }
}

#[test]
fn a_file_without_polarisation_answers_the_rest() {
    let bench = Bench::new();
    std::fs::write(&bench.model, common::model_bytes()).unwrap();
    let table = format!(
        "{HEADER}\npolarisation,59.4,0.2,0,20,60,30,,550\nradiance,59.4,0.2,0,20,60,30,,550\n"
    );
    let output = bench.on_model(&["query"], &table);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("has no polarisation basis chunk"), "{text}");
    assert!(text.lines().nth(2).unwrap().ends_with(','), "{text}");
    let output = bench.on_model(&["render", "--quantity", "dolp", "--size", "8"], "");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn render_shows_polarisation() {
    use exr::prelude::read_all_flat_layers_from_file;
    let bench = Bench::new();
    let render = |arguments: &[&str]| {
        let output = bench.on_model(
            &[&["render", "--size", "8", "--out", "p"], arguments].concat(),
            "",
        );
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{text}");
        let image = read_all_flat_layers_from_file(bench.folder.path().join("p.exr")).unwrap();
        let channels = image.layer_data[0].channel_data.list.iter();
        channels
            .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
            .collect::<Vec<(String, Vec<f32>)>>()
    };
    for (quantity, most) in [
        ("dolp", 1.0),
        ("overlay", 1.0),
        ("aolp", 90.0),
        ("q", 1.0),
        ("u", 1.0),
    ] {
        let planes = render(&["--quantity", quantity]);
        assert_eq!(planes.len(), 1);
        let largest = planes[0].1.iter().fold(0f32, |m, v| m.max(v.abs()));
        assert!(largest > 1e-3 && largest <= most, "{quantity} {largest}");
    }
    for (arguments, first) in [
        (&["--stokes"][..], 15),
        (&["--stokes", "--spectral"][..], 24),
    ] {
        let planes = render(arguments);
        assert_eq!(planes.len(), first);
        let plane = |name: &str| &planes.iter().find(|(n, _)| n == name).unwrap().1;
        let suffix = if first == 15 { "G" } else { "408nm" };
        let [i, q, u, v] = [0, 1, 2, 3].map(|s| plane(&format!("S{s}.{suffix}")));
        assert!(v.iter().all(|&v| v == 0.0));
        assert!(q.iter().any(|&q| q != 0.0) && u.iter().any(|&u| u != 0.0));
        if first == 24 {
            for k in 0..i.len() {
                assert!(q[k].hypot(u[k]) <= 1.00001 * i[k]);
            }
        }
    }
}

#[test]
fn plans_say_what_scenes_need() {
    let bench = Bench::new();
    let arguments = [
        "plan",
        "--altitudes",
        "0..50",
        "--visibilities",
        "20..30",
        "--json",
    ];
    let output = bench.on_model(&arguments, "");
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let number = |key: &str| report[key].as_u64().unwrap();
    assert!(number("file_bytes") < number("model_bytes") && number("chunks") > 3);
    assert_eq!(report["bake_p95"], 0.0025);
    let text = bench.on_model(&["plan", "--rgb"], "");
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(
        text.contains("per baked sky") && text.contains("p95 at most 0.25 %"),
        "{text}"
    );
    let text = bench.run(&["plan", "--stokes"], "");
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(text.contains("of the degree    median 0.00"), "{text}");
    for bad in [
        ["--altitudes", "0..1e9"],
        ["--altitudes", "high"],
        ["--tolerance", "0"],
    ] {
        let output = bench.on_model(&["plan", bad[0], bad[1]], "");
        assert_eq!(output.status.code(), Some(2), "{bad:?}");
    }
}

/// Values of all channels of a landscape.
fn landscape(bench: &Bench, more: &[&str]) -> Vec<f32> {
    let scene = "render --terrain flat --sun-elevation 25 --view-azimuth 90 --visibility 100 --size 12 --out scene.exr";
    let arguments: Vec<&str> = scene.split(' ').chain(more.iter().copied()).collect();
    let output = bench.run(&arguments, "");
    assert!(output.status.success(), "{output:?}");
    let path = bench.folder.path().join("scene.exr");
    let image = exr::prelude::read_first_flat_layer_from_file(path).unwrap();
    let channels = &image.layer_data.channel_data.list;
    channels
        .iter()
        .flat_map(|c| c.sample_data.values_as_f32().collect::<Vec<_>>())
        .collect()
}

/// Every method shows nearly the same landscape, and none the very same.
#[test]
fn the_light_of_the_air_is_computed_by_any_method() {
    let bench = Bench::new();
    // Mostly ground, tens of kilometres away.
    let scene = "--altitude 250 --field-of-view 3 --pitch -1.2";
    let scene: Vec<&str> = scene.split(' ').collect();
    let picture = |method| {
        landscape(
            &bench,
            &[&scene[..], &["--aerial-perspective", method]].concat(),
        )
    };
    let source = picture("source");
    assert_eq!(source, landscape(&bench, &scene));
    let mut pictures = vec![source.clone()];
    for (method, limits) in [
        ("eq2", [0.002, 0.01]),
        ("blurred", [0.03, 0.08]),
        ("blend", [0.002, 0.01]),
    ] {
        let other = picture(method);
        let pairs = other.iter().zip(&source);
        let mut apart: Vec<f32> = pairs.map(|(o, s)| (o / s - 1.0).abs()).collect();
        apart.sort_by(f32::total_cmp);
        let [median, most] = [apart[apart.len() / 2], apart[apart.len() * 9 / 10]];
        println!("{method}: {median:.4} {most:.4} from the source");
        assert!(
            median < limits[0] && most < limits[1],
            "{method}: {median} {most}"
        );
        assert!(!pictures.contains(&other), "{method}");
        pictures.push(other);
    }
}

/// Two polarisers across each other share the light of a landscape; one of them lifts the aerial perspective.
#[test]
fn a_polariser_stands_before_a_landscape() {
    let bench = Bench::new();
    let picture = |polariser: &[&str]| {
        let altitude = ["--altitude", "800"];
        landscape(&bench, &[&altitude[..], polariser].concat())
    };
    let open = picture(&[]);
    let lifted = picture(&["--polariser", "65"]);
    let kept = picture(&["--polariser", "-25"]);
    for ((open, lifted), kept) in open.iter().zip(&lifted).zip(&kept) {
        assert!(
            (lifted + kept - open).abs() < 1e-3 * open,
            "{open} {lifted} {kept}"
        );
    }
    let sum = |values: &[f32]| values.iter().sum::<f32>();
    assert!(sum(&lifted) < 0.9 * sum(&kept));
}

#[test]
fn landscapes_and_froxel_volumes_are_written() {
    let bench = Bench::new();
    let run = |arguments: &[&str]| {
        let output = bench.run(arguments, "");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{arguments:?}: {text}");
    };
    let exists = |name: &str| bench.folder.path().join(name).metadata().unwrap().len();
    run(&[
        "render",
        "--terrain",
        "hills",
        "--size",
        "24",
        "--out",
        "hills",
    ]);
    assert!(exists("hills.png") > 500 && exists("hills.exr") > 500);
    // The picture itself is a height field.
    let field = ["--terrain", "hills.png", "--terrain-height", "900"];
    let rest = ["--size", "16", "--pitch", "-10", "--out", "field.png"];
    run(&[&["render"], &field[..], &rest].concat());
    run(&["froxels", "--size", "3x2x4", "--out", "volume.raw"]);
    let bytes = std::fs::read(bench.folder.path().join("volume.raw")).unwrap();
    assert_eq!(bytes.len(), 64 + 4 * 6 * 3 * 2 * 4);
    let value = |i: usize| f32::from_le_bytes(bytes[64 + 4 * i..][..4].try_into().unwrap());
    // Slice by slice the air takes light away and adds some.
    let slices = 6 * 3 * 2;
    for i in 0..slices {
        let grows = i % 6 < 3;
        let (near, far) = (value(i), value(3 * slices + i));
        assert!(
            if grows {
                far > near
            } else {
                far < near && near <= 1.0
            },
            "{i}: {near} {far}"
        );
    }
    run(&[
        "froxels",
        "--spectral",
        "--size",
        "3x2x4",
        "--out",
        "spectral.raw",
    ]);
    let bytes = std::fs::read(bench.folder.path().join("spectral.raw")).unwrap();
    let n = Model::default_model().unwrap().wavelengths().len();
    assert_eq!(bytes.len(), 64 + 4 * 2 * n * 3 * 2 * 4);
    assert_eq!(bytes[24..28], (2 * n as u32).to_le_bytes());
    let spectra = bytes[64..].chunks_exact(4 * 2 * n);
    for spectrum in spectra {
        let value = |i: usize| f32::from_le_bytes(spectrum[4 * i..][..4].try_into().unwrap());
        // Light in the first half, transmittance in the second, which grows with the wavelength at first.
        assert!((0..n).all(|i| value(i) > 0.0) && (n..2 * n).all(|i| value(i) <= 1.0));
        assert!(value(n) < value(n + 2));
    }
    run(&["froxels", "--size", "3x2x4", "--out", "volume.exr"]);
    assert!(exists("volume.exr") > 500);
    for wrong in [
        &["froxels", "--size", "0x2x2"][..],
        &["froxels", "--near", "10", "--far", "5"],
        &["froxels", "--out", "volume.png"],
        &["render", "--terrain", "nowhere.png"],
        &["render", "--terrain", "hills", "--spectral"],
        &["render", "--terrain", "hills", "--polariser", "NaN"],
        &[
            "render",
            "--terrain",
            "hills",
            "--aerial-perspective",
            "fog",
        ],
        &["render", "--aerial-perspective", "eq2"],
        &["render", "--polariser", "65"],
        &["render", "--terrain", "hills", "--field-of-view", "0"],
        &["render", "--terrain", "hills", "--terrain-height", "-3"],
    ] {
        bench.refusal(wrong, "");
    }
}

#[test]
fn query_answers_the_polarisation_of_segments() {
    let bench = Bench::new();
    let row = |quantity: &str, nm: f64| format!("{quantity},59.4,0.2,300,10,88,40,20000,{nm}");
    let quantities = ["in_scattering", "polarisation", "stokes_q", "stokes_u"];
    let mut rows: Vec<_> = quantities.iter().map(|q| row(q, 560.0)).collect();
    rows.extend([
        row("polarisation", 579.0),
        row("polarisation", 600.0),
        row("stokes_q", 2000.0),
    ]);
    let output = bench.run(&["query"], &format!("{HEADER}\n{}\n", rows.join("\n")));
    let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
    let answers: Vec<csv::StringRecord> = reader.records().map(|r| r.unwrap()).collect();
    let value = |i: usize| answers[i][9].parse::<f32>().unwrap();
    let model = welkin::Model::default_model().unwrap();
    let aerial = model
        .aerial_perspective(&welkin::Conditions {
            solar_elevation: 10f64.to_radians(),
            solar_azimuth: 0.0,
            visibility: 59.4e3,
            albedo: 0.2,
            altitude: 300.0,
        })
        .unwrap();
    let ((s, c), (y, x)) = (88f64.to_radians().sin_cos(), 40f64.to_radians().sin_cos());
    let to = [2e4 * s * x, 2e4 * s * y, 300.0 + 2e4 * c];
    let frame = PolarisationFrame::Vertical;
    let light = aerial
        .relative_stokes_at([0.0, 0.0, 300.0], to, frame, 560.0)
        .unwrap();
    let irradiance = model.head().solar_irradiance_at(560.0) as f32;
    let [i, q, u] = [light.i, light.q, light.u].map(|v| irradiance * v);
    for (got, expected) in [(value(0), i), (value(2), q), (value(3), u)] {
        assert!((got - expected).abs() < 1e-4 * i, "{got} {expected}");
    }
    // The sun-aligned frame holds nearly all of the polarisation in Q.
    let degree = light.degree();
    assert!(degree > 0.02 && value(1).abs() <= degree + 1e-5, "{degree}");
    assert!(
        (value(1) - value(4)) * (value(4) - value(5)) > 0.0,
        "in between"
    );
    assert!(answers[6][10].contains("wavelength must be in"));
}

#[test]
fn query_answers_finite_distances_and_the_sun() {
    let bench = Bench::new();
    let conditions = "59.4,0.2,300,10";
    let row = |quantity: &str, zenith: f64, azimuth: f64, distance: &str, nm: f64| {
        format!("{quantity},{conditions},{zenith},{azimuth},{distance},{nm}")
    };
    let rows = [
        row("transmittance", 92.0, 40.0, "0", 600.0),
        row("transmittance", 92.0, 40.0, "5000", 600.0),
        row("in_scattering", 92.0, 40.0, "5000", 600.0),
        row("in_scattering", 60.0, 40.0, "", 400.0),
        row("transmittance", 60.0, 40.0, "inf", 400.0),
        row("sun_radiance", 80.0, 0.0, "", 560.0),
        row("in_scattering", 92.0, 40.0, "5000", 571.0),
        row("in_scattering", 92.0, 40.0, "-1", 600.0),
        row("transmittance", 92.0, 40.0, "NaN", 600.0),
        row("sun_radiance", 80.0, 0.0, "7", 560.0),
        row("in_scattering", 92.0, 40.0, "1e12", 600.0),
        row("transmittance", 92.0, 40.0, "10", 2000.0),
    ];
    let output = bench.run(&["query"], &format!("{HEADER}\n{}\n", rows.join("\n")));
    assert!(output.status.success());
    let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
    let answers: Vec<csv::StringRecord> = reader.records().map(|r| r.unwrap()).collect();
    let value = |i: usize| answers[i][9].parse::<f32>().unwrap();
    let model = welkin::Model::default_model().unwrap();
    let place = welkin::Conditions {
        solar_elevation: 10f64.to_radians(),
        solar_azimuth: 0.0,
        visibility: 59.4e3,
        albedo: 0.2,
        altitude: 300.0,
    };
    let aerial = model.aerial_perspective(&place).unwrap();
    let along = |zenith: f64, distance: f64| -> [f64; 3] {
        let ((s, c), (y, x)) = (zenith.to_radians().sin_cos(), 40f64.to_radians().sin_cos());
        [distance * s * x, distance * s * y, distance * c]
    };
    let from = [0.0, 0.0, 300.0];
    let to = along(92.0, 5000.0);
    let end = [to[0], to[1], to[2] + 300.0];
    let air = aerial.transmittance();
    let through = air.transmittance_at(from, end, 600.0).unwrap();
    let light = |nm| aerial.in_scattering_at(from, end, nm).unwrap();
    let close =
        |got: f32, expected: f32| assert!((got / expected - 1.0).abs() < 1e-5, "{got} {expected}");
    assert_eq!(value(0), 1.0);
    close(value(1), through);
    close(value(2), light(600.0));
    assert!(value(6) < light(560.0) && value(6) > light(600.0));
    let up = along(60.0, 1.0);
    let beyond = std::array::from_fn(|k| from[k] + 1e6 * up[k]);
    close(
        value(3),
        aerial.in_scattering_at(from, beyond, 400.0).unwrap(),
    );
    close(
        value(4),
        air.transmittance_to_end_at(from, up, 400.0).unwrap(),
    );
    let disc = model.solar_disc(&place).unwrap();
    close(value(5), disc.radiance_at(disc.direction(), 560.0).unwrap());
    for (i, error) in [
        (7, "distance_m must not be negative"),
        (8, "distance_m must not be negative"),
        (9, "distance_m must be empty"),
        (10, "coordinates"),
        (11, "wavelength must be in"),
    ] {
        assert!(
            answers[i][9].is_empty() && answers[i][10].contains(error),
            "{}",
            &answers[i][10]
        );
    }
}
