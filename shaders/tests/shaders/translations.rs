//! What stands in `glsl` and `hlsl` is what naga makes of the sources, and other compilers take it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::readme::{compare, fill, table};
use welkin_shaders::{PROGRAMS, cost, translations};

fn room() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(program: &str) -> [PathBuf; 2] {
    ["glsl/comp", "hlsl/hlsl"].map(|kind| {
        let (folder, extension) = kind.split_once('/').unwrap();
        room().join(folder).join(format!("{program}.{extension}"))
    })
}

#[test]
fn files_are_what_naga_writes() {
    for program in &PROGRAMS {
        let out = translations(program).unwrap();
        let [glsl, hlsl] = files(program.name);
        compare(&glsl, &out.glsl);
        compare(&hlsl, &out.hlsl);
    }
}

/// With `WELKIN_REQUIRE_GPU=1` a tool that is missing is an error.
fn accepted(tool: &str, arguments: &[&str], path: &Path) {
    match Command::new(tool).args(arguments).arg(path).output() {
        Ok(output) => {
            let said = String::from_utf8_lossy(&output.stdout).into_owned()
                + &String::from_utf8_lossy(&output.stderr);
            assert!(
                output.status.success(),
                "{tool} refuses {}: {said}",
                path.display()
            );
        }
        Err(error) => {
            let required = std::env::var_os("WELKIN_REQUIRE_GPU").is_some_and(|v| v == "1");
            assert!(!required, "{tool}: {error}, and WELKIN_REQUIRE_GPU=1");
            eprintln!("SKIPPED: {tool}: {error}. apt-get install glslang-tools spirv-tools");
        }
    }
}

/// Without what sets local arrays to 0, as ` = (float4[4])0`.
fn without_zeros(hlsl: &str) -> String {
    let lines = hlsl.lines().map(|line| match line.split_once(" = (") {
        Some((before, after)) if after.ends_with("])0;") => format!("{before};\n"),
        _ => format!("{line}\n"),
    });
    lines.collect()
}

#[test]
fn other_compilers_take_them() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for program in &PROGRAMS {
        let [glsl, hlsl] = files(program.name);
        accepted("glslangValidator", &[], &glsl);
        // glslang reads HLSL of shader model 5, but no arrays that are set to 0; Debian has no dxc.
        let text = std::fs::read_to_string(&hlsl).unwrap();
        let hlsl = folder.join(format!("{}.hlsl", program.name));
        std::fs::write(&hlsl, without_zeros(&text)).unwrap();
        let out = folder.join("hlsl.spv");
        let out = out.to_str().unwrap();
        accepted(
            "glslangValidator",
            &["-D", "-V", "-S", "comp", "-e", "main", "-o", out],
            &hlsl,
        );
        let spirv = folder.join(program.name);
        let words = translations(program).unwrap().spirv;
        let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        std::fs::write(&spirv, bytes).unwrap();
        accepted("spirv-val", &["--target-env", "vulkan1.1"], &spirv);
    }
}

const FUNCTIONS: [(&str, &str, &str); 14] = [
    (
        "sky_directions",
        "sky_point",
        "a direction of a sky, looked up",
    ),
    ("sky_directions", "sky_group", "four channels there"),
    (
        "sky_directions",
        "sky_polarisation",
        "Q/I and U/I of four channels there",
    ),
    ("fish_eye", "sky_xyz", "a pixel of a colour sky, all in all"),
    (
        "fish_eye",
        "disc_point",
        "a direction on the disc, looked up",
    ),
    (
        "fish_eye",
        "disc_relative",
        "four wavelengths there (loops of 4 and 5 turns)",
    ),
    ("sampler_draws", "sampler_pdf", "the density of a direction"),
    (
        "sampler_draws",
        "sampler_sky",
        "a draw of the sky (bisections of 6 or 7 turns)",
    ),
    (
        "air_segments",
        "air_piece",
        "what a line crosses of a layer (a turn for four constituents)",
    ),
    ("fill_volume", "aerial_ray", "a ray of a volume, looked up"),
    ("fill_volume", "aerial_taps", "a distance along it"),
    ("fill_volume", "aerial_node", "a node of its distance"),
    ("fill_volume", "aerial_blend", "a slice between nodes"),
    (
        "fill_volume",
        "aerial_srgb_factors",
        "its factors in linear sRGB",
    ),
];

/// The table of the README is what is counted.
#[test]
fn costs() {
    let rows = FUNCTIONS.map(|(program, function, does)| {
        let program = PROGRAMS.iter().find(|p| p.name == program).unwrap();
        let cost = cost(&translations(program).unwrap().spirv)[function];
        assert!(cost.floating > 0);
        let counts = [
            cost.floating,
            cost.roots_and_powers,
            cost.other,
            cost.table_bytes,
        ];
        let [a, b, c, d] = counts.map(|n| n.to_string());
        [format!("`{function}`"), does.into(), a, b, c, d]
    });
    let heads = [
        "function",
        "does",
        "floating",
        "roots, powers",
        "other",
        "bytes",
    ];
    fill("costs", &table(&heads, &rows));
}
